"""The path of one ball: its arcs, and queries on them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from math import inf
from typing import Any, NamedTuple, Protocol

from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.bernstein import downward_crossings
from sandbox.physics.integrators import State

#: Time in s, and state.
Passage = tuple[float, State]


class Curve(Protocol):
    """A polynomial along an arc. Also accepts arrays, for many arcs at once."""

    def __call__(self, arc: Arc, /) -> Sequence[Any]: ...


class Above(NamedTuple):
    """The distance in m of a ball's centre beyond the line through a point with this normal."""

    x: float  # m
    y: float
    nx: float
    ny: float

    @classmethod
    def line(cls, point: tuple[Any, Any], normal: tuple[Any, Any]) -> Above:
        """A line; of a level or an upright one the coordinate that does not matter is 0, so that equal lines compare
        equal."""
        (x, y), (nx, ny) = point, normal
        level, upright = (type(part) is float and part == 0.0 for part in normal)
        return cls(0.0 if level else x, 0.0 if upright else y, nx, ny)

    def __call__(self, arc: Arc) -> list[Any]:
        return [(x - self.x) * self.nx + (y - self.y) * self.ny for x, y in zip(arc.x, arc.y, strict=True)]


def climb(arc: Arc) -> Sequence[Any]:
    """The upward velocity, in m/s."""
    return arc.curves[3]


def height(passage: Passage) -> float:
    """The height in m of a passage."""
    return passage[1][1]


class Path:
    """Arcs in order of time, without gaps; at least one."""

    def __init__(self, arcs: Sequence[Arc]) -> None:
        self._arcs = arcs

    def __len__(self) -> int:
        return len(self._arcs)

    def __getitem__(self, index: int) -> Arc:
        return self._arcs[index]

    def __iter__(self) -> Iterator[Arc]:
        return iter(self._arcs)

    @cached_property
    def starts(self) -> Sequence[float]:
        """The time in s at which each arc begins."""
        return [arc.t0 for arc in self]

    @cached_property
    def stops(self) -> Sequence[float]:
        """The time in s at which each arc ends."""
        return [arc.t1 for arc in self]

    def at(self, t: float) -> Arc:
        """The arc at t, the later one of two; the last one after the end."""
        return self[max(bisect_right(self.starts, t) - 1, 0)]

    def before(self, t: float) -> Arc:
        """The arc that ends at t; the one at t if none does."""
        index = bisect_left(self.stops, t)
        return self[index] if index < len(self) and self.stops[index] == t else self.at(t)

    def state_before(self, t: float) -> State:
        """The state just before t."""
        return self.before(t).state(t)[:5]

    def pieces(self) -> Iterable[tuple[float, float, Sequence[float], Sequence[float]]]:
        """Begin and end in s of each arc, and its curves of x and y."""
        return ((arc.t0, arc.t1, arc.x, arc.y) for arc in self)

    def ends(self) -> Iterable[Passage]:
        """Time and state at the end of each arc."""
        return ((arc.t1, arc.state(arc.t1)[:5]) for arc in self)

    def highest(self, until: float = inf) -> Passage:
        """Time and state where it is highest, up to a time at which it is not."""
        top = max([self[0].y[0], *(arc.y[-1] for arc in self if arc.t1 <= until)])
        near = Path([arc for arc in self if max(arc.y) >= top])  # by their coefficients the others are lower
        turns = [(self[0].t0, self[0].start[:5]), *near.passages(climb), *near.ends()]
        return max((turn for turn in turns if turn[0] <= until), key=height)

    def passages(self, curve: Curve) -> Iterable[Passage]:
        """Each time and state at which a curve becomes negative: within an arc, or where one arc ends and the next
        begins."""
        above = False  # where the last arc ended, or came from to end at zero
        for arc in self:
            values = curve(arc)
            signs = [value > 0.0 for value in values if value != 0.0]
            if above and signs and not signs[0]:
                yield arc.t0, arc.state(arc.t0)[:5]
            for u in downward_crossings(values):
                t = arc.t0 + u * (arc.t1 - arc.t0)
                yield t, arc.state(t)[:5]
            above = signs[-1] if signs else above
