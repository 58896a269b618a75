"""Prediction: the first event on a ball's new arc, alone or with other balls."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from sandbox.engine.contact.manifold import pair_touches
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.event_queue import EventQueue
from sandbox.engine.kernel.event_kind import EventKind
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.run import Numerics

#: True for what a ball is in contact with and so does not meet: obstacles, and balls by index.
_InContact = Callable[[Obstacle | int], bool]


class Prediction:
    """Predicts events of the balls of a run and puts them into its queue."""

    def __init__(self, movers: Sequence[MovingBall], queue: EventQueue, numerics: Numerics, skin: float) -> None:
        """``skin`` is the overlap in m at which two shapes touch."""
        self._movers = movers
        self._queue = queue
        self._numerics = numerics
        self._skin = skin

    def predict(self, index: int, t: float, kind: EventKind, in_contact: _InContact, others: Sequence[int]) -> None:
        """Predict the first event from t on a ball's new arc, which ends as ``kind`` says: alone, or with ``others``.
        It does not meet what it is ``in_contact`` with."""
        mover = self._movers[index]
        arc = mover.predicted_path
        at = arc.t1
        touch = self.first_touch(index, arc, mover.obstacles, at, in_contact)
        if touch is not None:
            at, kind = touch, EventKind.TOUCH
        if mover.traps and (caught := self.first_touch(index, arc, mover.open_traps, at)) is not None:
            at, kind = caught, EventKind.TRAP
        self._queue.push(at, kind, index)
        if mover.arc.t1 < at:
            self._queue.push(mover.arc.t1, EventKind.SPIN_END, index)
        if others:
            self._predict_pairs(index, t, at, in_contact, others)

    def _predict_pairs(self, index: int, t: float, until: float, in_contact: _InContact, others: Sequence[int]) -> None:
        """Predict where a ball first touches each of the others, from t until ``until``."""
        mover = self._movers[index]
        left, bottom, right, top = mover.predicted_path.box()
        for other in others:
            neighbour = self._movers[other]
            if other == index or neighbour.caught:
                continue
            reach = mover.ball.radius + neighbour.ball.radius
            a, b, c, d = neighbour.predicted_path.box()
            if left <= c + reach and right >= a - reach and bottom <= d + reach and top >= b - reach:
                dx, dy = max(0.0, left - c, a - right), max(0.0, bottom - d, b - top)
                if dx * dx + dy * dy > reach * reach or in_contact(other):
                    continue
                self._numerics.queries += 1
                at = pair_touches(mover, neighbour, max(t, neighbour.arc.t0), self._skin)
                if at is not None and at <= until:
                    self._queue.push(at, EventKind.TOUCH, index, other)

    def first_touch(
        self,
        index: int,
        arc: Arc,
        obstacles: Sequence[Obstacle],
        until: float,
        in_contact: _InContact = lambda obstacle: False,
    ) -> float | None:
        """The first time up to ``until`` (s) at which a ball touches one of these obstacles on an arc, or None."""
        first, (left, bottom, right, top) = None, arc.box()
        for obstacle in obstacles:
            west, south, east, north = obstacle.box
            if right >= west and left <= east and bottom <= north and top >= south and not in_contact(obstacle):
                self._numerics.queries += 1
                touch = self._movers[index].first_touch(obstacle, arc)
                if touch is not None and touch <= until:
                    first = until = touch
                    arc.truncate_at(touch)
                    left, bottom, right, top = arc.box()
        return first

    def neighbours(self, stepped: Collection[int], t: float) -> dict[int, list[int]]:
        """For each ball of a heap that was ``stepped`` the others that it may meet on its new arc from t; of two in the
        heap for the first.

        Found by sweeping along x.
        """
        lasts = [self._movers[index].arc.t1 - t for index in stepped]
        ranges, longest = [], max(lasts, default=0.0)  # at rest, to the run's end
        for index, mover in enumerate(self._movers):
            if not mover.caught:
                arc, radius = mover.arc, mover.ball.radius
                left, bottom, right, top = arc.box() if index in stepped else arc.box_within(t, longest)
                ranges.append((left - radius, right + radius, bottom - radius, top + radius, index))
        found: dict[int, list[int]] = {index: [] for index in stepped}
        passing: list[tuple[float, float, float, float, int]] = []
        for here in sorted(ranges):
            left, _, bottom, top, index = here
            passing = [there for there in passing if there[1] >= left]
            for _, _, low, high, other in passing:
                if low <= top and high >= bottom:
                    first, second = (index, other) if index < other else (other, index)
                    if first in found:
                        found[first].append(second)
                    elif second in found:
                        found[second].append(first)
            passing.append(here)
        return {index: sorted(others) for index, others in found.items()}
