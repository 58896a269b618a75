"""The event queue: what is predicted for each ball, in order of time."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from itertools import count
from math import inf
from typing import NamedTuple

from sandbox.engine.kernel.event_kind import EventKind
from sandbox.engine.motion.moving_ball import MovingBall

#: In place of the second ball of an event that has only one.
_NO_BALL = -1


class QueuedEvent(NamedTuple):
    """A predicted event. It is out of date, and skipped, once one of its balls has another arc."""

    t: float  # s
    order: int  # of two at the same time the one that was predicted first comes first
    kind: EventKind
    ball: int  # index into the balls of the setup
    version: int  # of that ball's arc when this was predicted
    other: int  # the second ball of a touch, or NO_BALL
    other_version: int

    @property
    def balls(self) -> list[int]:
        """The one or two balls."""
        return [self.ball] if self.other == _NO_BALL else [self.ball, self.other]


class EventQueue:
    """Predicted events of balls, earliest first."""

    def __init__(self, movers: Sequence[MovingBall]) -> None:
        self._movers = movers
        self._heap: list[QueuedEvent] = []
        self._order = count()

    def push(self, t: float, kind: EventKind, ball: int, other: int = _NO_BALL) -> None:
        """Add an event at t that holds as long as its balls are on their present arcs."""
        other_version = 0 if other == _NO_BALL else self._movers[other].version
        event = QueuedEvent(t, next(self._order), kind, ball, self._movers[ball].version, other, other_version)
        heapq.heappush(self._heap, event)

    def pop(self, until: float = inf) -> QueuedEvent | None:
        """Remove and return the earliest event up to ``until`` (s) that is not out of date; None if there is none."""
        while self._heap and self._heap[0].t <= until:
            event = heapq.heappop(self._heap)
            if self._holds(event):
                return event
        return None

    def pending(self) -> list[QueuedEvent]:
        """Return the events that are not out of date, in order."""
        return sorted(event for event in self._heap if self._holds(event))

    def restore(self, pending: Sequence[QueuedEvent]) -> None:
        """Have these events, in order, and no others."""
        self._heap = list(pending)
        self._order = count(1 + max((event.order for event in pending), default=-1))

    def _holds(self, event: QueuedEvent) -> bool:
        """Return True if the balls of an event are still on the arcs for which it was predicted."""
        _, _, _, ball, version, other, other_version = event
        return self._movers[ball].version == version and (
            other == _NO_BALL or self._movers[other].version == other_version
        )
