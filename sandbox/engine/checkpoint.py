"""Checkpoints: the whole state of a running simulation, from which it goes on exactly as before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from sandbox.engine.event_queue import QueuedEvent
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Setup, Until
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.run import Numerics

if TYPE_CHECKING:
    from sandbox.engine.heap.stepping import HeapState


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """The state of a simulation between two events.

    It shares what never changes with the simulation: setups, arcs, and the beginnings of paths and lists, which only
    grow. So it takes little memory and time.
    """

    t: float  # s, of the last event
    eras: Sequence[tuple[float, Setup]]  # the setups so far, each with the time in s from which it is valid
    changes: int  # made so far
    movers: Sequence[MovingBall]  # copies
    arcs: Sequence[int]  # in the path of each
    events: list[Event]
    noted: int  # events so far
    numerics: Numerics
    moving: frozenset[int]
    pending: Sequence[QueuedEvent]
    over: bool
    ended: str
    standstill: tuple[float, int]
    heap: HeapState | None

    def alone(self, history: bool = True) -> Checkpoint:
        """Return the same without what the simulation did later, to be written to a file; without ``history`` also
        without what it did before: then paths begin with their last arc, and only events that ``until`` may count are
        left."""
        setup, ends = self.eras[-1][1], zip(self.movers, self.arcs, strict=True)
        begins = 0 if history else -1
        movers = [mover.copy(mover.path[:count][begins:], self.numerics) for mover, count in ends]
        alone = replace(self, movers=movers, events=self.events[: self.noted])
        if history:
            return alone
        events = alone.events if isinstance(setup.until, Until) else []
        arcs = [len(mover.path) for mover in movers]
        return replace(alone, eras=((0.0, setup),), changes=0, arcs=arcs, events=events, noted=len(events))
