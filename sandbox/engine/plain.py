"""The plain method: pymunk at a fixed step, as somebody who knows pymunk would use it. The baseline for comparison.

``pymunk_space`` builds and steps the Space; here the path is recorded, and what happens. What the method fails at has a
name (``MethodFailed``).
"""

from __future__ import annotations

from collections.abc import Callable
from math import ceil, dist
from time import perf_counter

from sandbox.engine.contact.touch import Outline
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Setup
from sandbox.engine.paths.arc import Arc, hermite_arc
from sandbox.engine.paths.path import Path
from sandbox.engine.paths.run import Numerics, Run
from sandbox.engine.pymunk_space import Hit, Mover, SetupSpace
from sandbox.errors import RunError
from sandbox.physics.integrators import State

#: Interval in s at which the path is recorded and balls are checked for rest.
_RECORD_EVERY = 1 / 240

#: Most steps in one run: some minutes of computing.
MOST_STEPS = 10_000_000

#: A ball rests once it is slower than this (m/s, and r w as well) for this long (s) while touching something.
_REST_SPEED, _REST_TIME = 0.01, 0.25


class _Tracked:
    """The recorded path of a ball."""

    def __init__(self, mover: Mover) -> None:
        self.mover = mover
        self.name = mover.ball.name
        self.path: list[Arc] = []
        self.since = 0.0  # s, start of the current arc
        self.start = mover.state()
        self.parts = 0  # steps of Chipmunk by then
        self.caught = False
        self.over: set[str] = set()  # traps that it was too fast for, since it last hit something
        self.moved = 0.0  # s, when it last moved, or touched nothing

    def record(self, t: float, parts: int, after: State) -> None:
        """Add the path up to this state, ``parts`` steps of Chipmunk after the start."""
        h, start = t - self.since, self.start
        if h > 0.0 and self.mover.touched <= self.parts:  # free
            ax, ay, alpha = ((new - old) / h for new, old in zip(after[2:5], start[2:5], strict=True))
            self.path.append(hermite_arc(self.since, h, start, (ax, ay, alpha), after, (ax, ay, alpha)))
        elif h > 0.0 or not self.path:
            self.path.append(Arc(self.since, t, start, tuple(zip(start, after, strict=True)), end=after))
        self.begin(t, parts, after)

    def begin(self, t: float, parts: int, state: State) -> None:
        """Begin an arc with this state."""
        self.since, self.parts, self.start = t, parts, state


class PlainSimulation:
    """One run at ``accuracy.step``. Raises RunError, and what the scene's own forces raise."""

    def __init__(
        self, setup: Setup, accuracy: Accuracy, progress: Callable[[float, float], None] | None = None
    ) -> None:
        """``progress`` is called regularly with the time simulated and the most that it can become, in s."""
        self._setup = setup
        self._accuracy = accuracy
        self._progress = progress
        self._events: list[Event] = []
        self._over = False
        self._space = SetupSpace(setup)
        self._tracked = {mover.ball.name: _Tracked(mover) for mover in self._space.movers.values()}

    def run(self) -> Run:
        started, space = perf_counter(), self._space
        ended = self._loop()
        for tracked in self._tracked.values():
            if not tracked.caught:
                tracked.record(space.time, space.parts, tracked.mover.state())
        impacts = sum(event.kind == "impact" for event in self._events)
        numerics = Numerics(space.evaluations, space.parts, 0, impacts, space.parts, wall_s=perf_counter() - started)
        arcs = {name: Path(tracked.path) for name, tracked in self._tracked.items()}
        return Run(self._setup, self._accuracy, arcs, self._events, numerics, space.time, ended)

    def _loop(self) -> str:
        step, duration, space = self._accuracy.step, self._setup.duration, self._space
        next_record, steps = 0.0, 0
        while space.time < duration:
            steps += 1
            if steps > MOST_STEPS:
                raise RunError(
                    f"t = {space.time:.3g} s of {duration:g} s: {MOST_STEPS:,} steps of {step:.3g} s; lengthen "
                    'accuracy.step, shorten the duration, or use accuracy.method = "exact"'
                )
            for hits in space.advance(min(steps * step, duration)):
                for hit in hits:
                    self._hit(hit)
                if self._over:
                    return "until"
            if space.time >= next_record:
                next_record = space.time + _RECORD_EVERY
                if self._record_all():
                    return "duration" if space.time >= duration else "rest"
                if self._over:
                    return "until"
        return "duration"

    def _hit(self, hit: Hit) -> None:
        """Record the balls of an impact up to it and from it on."""
        space = self._space
        for name, before in hit.before.items():
            tracked = self._tracked[name]
            tracked.over.clear()
            tracked.record(space.time, space.parts, before)
            tracked.begin(space.time, space.parts, tracked.mover.state())
        self._note(Event(space.time, "impact", hit.ball, hit.partner, hit.speed, *hit.before[hit.ball][:2]))

    def _record_all(self) -> bool:
        """Record the state of all balls. Returns whether all are at rest."""
        space = self._space
        if self._progress is not None:
            self._progress(space.time, min(self._setup.duration, MOST_STEPS * self._accuracy.step))
        rest = True
        for tracked in self._tracked.values():
            if not tracked.caught:
                before, after = tracked.start, tracked.mover.state()
                tracked.record(space.time, space.parts, after)
                self._catch(tracked, before, after)
                rest = self._rests(tracked, after) and rest
        return rest

    def _catch(self, tracked: _Tracked, before: State, after: State) -> None:
        """Remove a ball that has come into a pocket; noticed at the next recording, so up to one interval late."""
        (x0, y0), (x1, y1) = before[:2], after[:2]
        for trap in self._setup.traps:
            if not trap.takes(tracked.name) or trap.name in tracked.over:
                continue
            outline, looks = Outline.of(trap.shape, 0.0), ceil(2.0 * dist(before[:2], after[:2]) / trap.radius) or 1
            places = [(x1 + (x0 - x1) * k / looks, y1 + (y0 - y1) * k / looks) for k in range(looks)]
            if any(outline.near(*place).gap <= 0.0 for place in places):
                tracked.caught, speed = trap.holds(after), (after[2] ** 2 + after[3] ** 2) ** 0.5
                kind = "caught" if tracked.caught else "over"
                self._note(Event(self._space.time, kind, tracked.name, trap.name, speed, x1, y1))
                if tracked.caught:
                    self._space.remove_ball(tracked.mover)
                    return
                tracked.over.add(trap.name)

    def _rests(self, tracked: _Tracked, state: State) -> bool:
        _, _, vx, vy, spin = state[:5]
        slow = (vx * vx + vy * vy) ** 0.5 + tracked.mover.ball.radius * abs(spin) < _REST_SPEED
        held = self._setup.plane is not None or self._space.parts - tracked.mover.touched <= 1
        if not (slow and held):
            tracked.moved = self._space.time
        return not tracked.mover.ball.timing.depends and self._space.time - tracked.moved >= _REST_TIME

    def _note(self, event: Event) -> None:
        self._events.append(event)
        if self._setup.ends_with(self._events):
            self._over = True
