"""Paths as rows of numbers. Arcs are created on demand, since most arcs of a sweep are never read; what the facts of
all shots ask of their paths is computed once for all."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import overload

import numpy as np

from sandbox.engine.arc import Arc, passages_of
from sandbox.engine.bernstein import downward_crossings
from sandbox.engine.bernstein_many import evaluate, only_downward_crossing
from sandbox.physics.integrators import State

#: Positions of an arc's parts in its row: times, state at the start, curves, state at the end.
T0, T1 = 0, 1
START = slice(2, 7)
X, Y, VX, VY, SPIN = slice(7, 13), slice(13, 19), slice(19, 24), slice(24, 29), slice(29, 33)
CURVES = {"x": X, "y": Y, "vx": VX, "vy": VY, "spin": SPIN}
END = slice(33, 38)
COLUMNS = END.stop

#: A line through (px, py) with the normal (nx, ny), in m; for ``UPWARDS`` it is the velocity that passes zero.
Line = tuple[float, float, float, float]
UPWARDS = (0.0, 0.0, 0.0, 0.0)

#: Time and state.
Passage = tuple[float, State]


class Paths:
    """The paths of many balls in flight, one after another. ``rows`` has shape (arcs, 38): t0, t1, start, coefficients,
    end; ``ends`` has the number of rows up to the end of each path."""

    def __init__(self, rows: np.ndarray, ends: Sequence[int]) -> None:
        self.rows = rows
        self._bounds = [0, *ends]
        self._asked: dict[Line, int] = {}
        self._passages: dict[Line, list[list[Passage]]] = {}

    def __getitem__(self, number: int) -> ArcRows:
        return ArcRows(self, number, *self._bounds[number : number + 2])

    def passages(self, path: ArcRows, line: Line) -> list[Passage]:
        """Each time and state at which a path passes the line against its normal, or turns downwards. All paths are
        computed together as soon as a second one is asked for the same line."""
        if line not in self._passages and self._asked.setdefault(line, path.number) == path.number:
            return [passage for _, passage in self._passing(path.first, path.last, line)]
        if line not in self._passages:
            found: list[list[Passage]] = [[] for _ in self._bounds]
            for number, passage in self._passing(0, len(self.rows), line):
                found[number].append(passage)
            self._passages[line] = found
        return self._passages[line][path.number]

    def _passing(self, first: int, last: int, line: Line) -> Iterator[tuple[int, Passage]]:
        """The number of the path, and the passage, for the arcs in these rows, in order."""
        rows = self.rows[first:last]
        px, py, nx, ny = line
        gap = (rows[:, VY] if line == UPWARDS else (rows[:, X] - px) * nx + (rows[:, Y] - py) * ny).T
        at_ends = first + np.flatnonzero(gap[-1] == 0.0)  # a passage may be just where one arc ends and the next begins
        special = set((np.searchsorted(self._bounds, at_ends, side="right") - 1).tolist())
        for number in special:
            for passage in passages_of(list(self[number]), _gap_of(line)):
                yield number, passage
        some = np.flatnonzero((gap.min(axis=0) <= 0.0) & (gap.max(axis=0) > 0.0))
        gap, rows = gap[:, some], rows[some]
        paths = (np.searchsorted(self._bounds, first + some, side="right") - 1).tolist()
        u, unclear = only_downward_crossing(gap)
        passing = np.isfinite(u)
        u = np.where(passing, u, 0.0)
        t = (rows[:, T0] + u * (rows[:, T1] - rows[:, T0])).tolist()
        states = np.array([evaluate(rows[:, curve].T, u) for curve in CURVES.values()]).T.tolist()
        for place in np.flatnonzero(passing | unclear).tolist():
            if paths[place] in special:
                continue
            if not unclear[place]:
                yield paths[place], (t[place], tuple(states[place]))
                continue
            arc = arc_of(rows[place].tolist())
            for root in downward_crossings(gap[:, place].tolist()):
                at = arc.t0 + root * (arc.t1 - arc.t0)
                yield paths[place], (at, arc.state(at))


def _gap_of(line: Line) -> Callable[[Arc], Sequence[float]]:
    """The gap of an arc to the line, as a polynomial; or its upward velocity."""
    px, py, nx, ny = line
    if line == UPWARDS:
        return lambda arc: arc.vy
    return lambda arc: [(x - px) * nx + (y - py) * ny for x, y in zip(arc.x, arc.y, strict=True)]


class ArcRows(Sequence[Arc]):
    """The arcs of one ball in flight: some rows of ``paths``."""

    def __init__(self, paths: Paths, number: int, first: int, last: int) -> None:
        self.paths, self.number, self.first, self.last = paths, number, first, last

    def __len__(self) -> int:
        return self.last - self.first

    @overload
    def __getitem__(self, index: int) -> Arc: ...
    @overload
    def __getitem__(self, index: slice) -> list[Arc]: ...
    def __getitem__(self, index: int | slice) -> Arc | list[Arc]:
        if isinstance(index, slice):
            return [arc_of(row) for row in self._rows[index].tolist()]
        return arc_of(self._rows[index].tolist())

    def __iter__(self) -> Iterator[Arc]:
        return map(arc_of, self._rows.tolist())

    @property
    def _rows(self) -> np.ndarray:
        return self.paths.rows[self.first : self.last]

    @property
    def starts(self) -> list[float]:
        """When each arc begins, in s."""
        times: list[float] = self._rows[:, T0].tolist()
        return times

    @property
    def stops(self) -> list[float]:
        """When each arc ends, in s."""
        times: list[float] = self._rows[:, T1].tolist()
        return times

    def passages(self, line: Line) -> list[Passage]:
        """Each time and state at which the ball passes the line against its normal."""
        return self.paths.passages(self, line)

    def tops(self) -> list[Passage]:
        """Each time and state at which the ball begins to fall."""
        return self.paths.passages(self, UPWARDS)

    def ends(self) -> list[Passage]:
        """Time and state at the end of each arc."""
        rows = self._rows
        return list(zip(rows[:, T1].tolist(), map(tuple, rows[:, END].tolist()), strict=True))


def arc_of(row: list[float]) -> Arc:
    """The arc of one row."""
    start, end = tuple(row[START]), tuple(row[END])
    return Arc(row[0], row[1], start, row[X], row[Y], row[VX], row[VY], row[SPIN], end=end)
