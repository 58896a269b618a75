"""A simulation in which a single ball among fixed surfaces flies through the kernel, many events at a time."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial
from math import inf

from sandbox.engine.event_queue import QueuedEvent
from sandbox.engine.impact.impulses import disc_on_ground
from sandbox.engine.kernel.event_kind import EventKind
from sandbox.engine.kernel.flight import Next, fly
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.tolerances import CLOSING
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.simulation import Simulation
from sandbox.physics.integrators import State

#: Events that a flight may go through.
_OF_FLIGHT = EventKind.ARC_END, EventKind.TOUCH


class FlightSimulation(Simulation):
    """A run; where it has one ball, and nothing that moves or kicks, plain events of its flight take a short way."""

    _until = inf  # s, up to which events are resolved now
    _at_once = 1  # events that the last one, and those after it in the same flight, were

    @property
    def _most_at_once(self) -> int:
        """So many events may be resolved in one flight."""
        return sys.maxsize

    def _set_up(self, setup: Setup) -> None:
        super()._set_up(setup)
        still = all(each.motion is None and each.nose_height is None and each.kick == 0.0 for each in setup.surfaces)
        self._is_alone = still and [type(mover) for mover in self._movers] == [MovingBall]

    def _loop(self, until: float = inf) -> None:
        self._until = until
        super()._loop(until)

    def _resolve(self, event: QueuedEvent) -> None:
        self._at_once = 1
        if not (self._is_alone and event.kind in _OF_FLIGHT and self._movers[0].flies and self._fly(event)):
            super()._resolve(event)

    def _fly(self, event: QueuedEvent) -> bool:
        """Follow the only ball from this event through others, while it flies and has plain impacts. Returns False if
        the event is none of these."""
        mover, touches = self._movers[0], event.kind is EventKind.TOUCH
        first_touch = partial(self._prediction.first_touch, 0)
        flight = mover.flight(disc_on_ground().exchange, first_touch, self._check, self._note_impact)
        resolved, after, at = fly(flight, mover, event.t, touches, self._until, self._most_at_once)
        if resolved == 0:
            return False
        self._at_once = resolved
        mover.version += resolved
        if after is Next.ARC:
            self._plan(0, at)
        elif after is Next.CONTACT:
            self._resume(0, at)
        else:
            self._queue.push(at, after, 0)
        return True

    def _check(self, t: float) -> None:
        """Be at an event of the only ball at t in s. Raises RunError if the run has stalled."""
        self._t = t
        self._guard.check(t, self._movers[0], self._numerics, self._events)

    def _note_impact(self, t: float, surface: str, at: State, speed: float) -> bool:
        """Note an impact of the only ball on a surface; return True if the run is over."""
        self._note(t, "impact", self._movers[0], surface, at, speed)
        return self._over

    def _collide(self, t: float, seeds: Sequence[int]) -> None:
        if not self._is_alone:
            super()._collide(t, seeds)
            return
        mover = self._movers[0]
        x, y, vx, vy, _ = state = mover.arc.state(t)
        if any(-(vx * near.nx + vy * near.ny) > CLOSING for _, near in mover.near(t, x, y)):
            super()._collide(t, seeds)
        else:  # it stays on what it touches, or leaves it
            mover.arrive(t, state)
            mover.passed = ()
            self._resume(0, t)
