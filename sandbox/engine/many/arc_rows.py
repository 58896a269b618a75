"""Paths as rows of numbers. Arcs are created on demand, since most arcs of a sweep are never read; what the facts of
all shots ask of their paths is computed once for all."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import chain
from math import inf
from typing import Any

import numpy as np

from sandbox.engine.many.bernstein_many import downward_crossings as crossings_of_many
from sandbox.engine.many.bernstein_many import evaluate, first_part
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.bernstein import downward_crossings, elevate
from sandbox.engine.paths.path import Curve, Passage, Path, climb, height
from sandbox.engine.paths.phase import ArcContact
from sandbox.physics.integrators import State

#: Positions of an arc's parts in its row: times, state at the start, curves, state at the end, number of the contact.
T0, T1 = 0, 1
START = slice(2, 7)
CURVES = X, Y, VX, VY, SPIN = slice(7, 13), slice(13, 19), slice(19, 24), slice(24, 29), slice(29, 33)
END = slice(33, 38)
CONTACT = END.stop
COLUMNS = CONTACT + 1

#: Positions of the coefficients, a column for each curve, and whether there is one: of x and y there are most.
_COEFFICIENTS = np.add.outer(np.arange(X.stop - X.start), [curve.start for curve in CURVES])
_HELD = np.less(_COEFFICIENTS, [curve.stop for curve in CURVES])
_OF_CURVES = _COEFFICIENTS[_HELD]


#: So many paths that are asked for one curve are taken as a sign that all are.
_MANY = 12


class Paths:
    """The paths of many balls, one after another. ``rows`` has shape (arcs, 39): t0, t1, start, coefficients, end, and
    a place in ``contacts`` or -1; ``ends`` has the number of rows up to the end of each path."""

    def __init__(self, rows: np.ndarray, ends: Sequence[int], contacts: Sequence[ArcContact | None] = ()) -> None:
        self.rows = rows
        self.contacts = contacts
        self._bounds = [0, *ends]
        self._asked: dict[Curve, dict[int, list[Passage]]] = {}
        self._of_all: dict[Curve, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}

    def __getitem__(self, number: int) -> ArcRows:
        return ArcRows(self, number, *self._bounds[number : number + 2])

    @cached_property
    def stops(self) -> list[float]:
        """The time in s at which each arc of all paths ends."""
        times: list[float] = self.rows[:, T1].tolist()
        return times

    @cached_property
    def lengths(self) -> np.ndarray:
        """The number of arcs of each path."""
        return np.diff(self._bounds)

    @cached_property
    def _as_one(self) -> Arc:
        """All arcs as one with arrays; the curves that are asked for most lie together in memory."""
        columns = self.rows.T
        arc = arc_of(columns)
        kept: list[Any] = [
            np.ascontiguousarray(columns[part]) if part in (X, Y, VY) else columns[part] for part in CURVES
        ]
        arc.curves = tuple(kept)
        return arc

    def summits(self, until: Any = inf) -> tuple[np.ndarray, np.ndarray]:
        """The time in s and the state where each path is highest, up to a time of its own or of all, shapes (paths,)
        and (5, paths); NaN without arcs. It is the start, the end of an arc, or where it turns downwards."""
        limits, numbers = np.broadcast_to(until, len(self.lengths)), np.flatnonzero(self.lengths)  # that have arcs
        first, ends = np.array(self._bounds)[numbers], self.rows[:, T1] <= np.repeat(limits, self.lengths)
        y = np.where(ends, self.rows[:, END.start + 1], -inf)
        highest = np.flatnonzero(y == np.repeat(np.maximum.reduceat(y, first), self.lengths[numbers]))
        top = highest[np.searchsorted(highest, first)]  # the first of equal ones
        turning, t, states = self.passages_of_all(climb)
        of = np.concatenate((numbers, numbers, turning))
        t = np.concatenate((self.rows[first, T0], self.rows[top, T1], t))
        states = np.concatenate((self.rows[first, START], self.rows[top, END], states))
        of, t, states = (each[t <= limits[of]] for each in (of, t, states))
        order = np.lexsort((-states[:, 1], of))  # stable: the first of equal ones
        best = order[np.unique(of[order], return_index=True)[1]]
        return self.spread(of[best], t[best], states[best])

    def spread(self, numbers: np.ndarray, t: np.ndarray, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Times in s and states, shape (numbers, 5), of the paths with these numbers as those of all, shapes (paths,)
        and (5, paths), with NaN for the others."""
        count = len(self.lengths)
        times, found = np.full(count, np.nan), np.full((states.shape[1], count), np.nan)
        times[numbers], found[:, numbers] = t, states.T
        return times, found

    def steps(self, until: Any) -> tuple[np.ndarray, np.ndarray]:
        """The duration in s of each arc of all paths up to a time of its own, shape (arcs, paths), and time and state
        at its start, middle and end, shape (6, arcs, 3, paths): a path with fewer arcs has its last again, with a
        duration of 0; NaN where ``until`` is."""
        limits, first = np.broadcast_to(until, len(self.lengths)), np.array(self._bounds[:-1])
        counts = np.bincount(self.numbers[self.rows[:, T0] < np.repeat(limits, self.lengths)], minlength=len(limits))
        turn = np.arange(counts.max(initial=0))[:, None]
        rows = self.rows[np.minimum(first + np.clip(turn, 0, np.maximum(counts - 1, 0)), len(self.rows) - 1)]
        t0, t1 = rows[..., T0], rows[..., T1]
        h = np.where(turn < counts, np.minimum(t1, limits) - t0, 0.0 * limits)
        states = np.stack((rows[..., START], rows[..., START], rows[..., END]))
        for place, part, some in ((1, 0.5, t1 > t0), (2, 1.0, t1 > limits)):
            u = part * (np.minimum(t1, limits) - t0)[some] / (t1 - t0)[some]
            states[place, some] = np.array([evaluate(rows[some][:, curve].T, u) for curve in CURVES]).T
        times = t0 + np.multiply.outer((0.0, 0.5, 1.0), h)
        return h, np.moveaxis(np.concatenate((times[..., None], states), axis=-1), (3, 1, 0, 2), (0, 1, 2, 3))

    @cached_property
    def numbers(self) -> np.ndarray:
        """The number of the path of each row."""
        return np.repeat(np.arange(len(self.lengths)), self.lengths)

    @cached_property
    def _summits(self) -> list[Passage]:
        t, states = self.summits()
        return _listed(t, states.T)

    def summit(self, number: int) -> Passage:
        """Time in s and state where a path is highest."""
        return self._summits[number]

    def passages(self, path: ArcRows, curve: Curve) -> list[Passage]:
        """Each time and state at which a curve becomes negative along a path. All paths are computed together as soon
        as many are asked for the same curve."""
        asked = self._asked.setdefault(curve, {})
        if path.number not in asked:
            if curve in self._of_all or len(asked) >= _MANY:
                numbers, t, states = self.passages_of_all(curve)
                first, last = np.searchsorted(numbers, (path.number, path.number + 1))
                asked[path.number] = _listed(t[first:last], states[first:last])
            else:
                asked[path.number] = _listed(*self.passing(curve, path.first, path.last)[1:])
        return asked[path.number]

    def passages_of_all(self, curve: Curve) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The passages of all paths, as ``passing`` gives them, computed once."""
        if curve not in self._of_all:
            self._of_all[curve] = self.passing(curve)
        return self._of_all[curve]

    def passing(
        self, curve: Curve, first: int = 0, last: int | None = None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The passages on the arcs in these rows, as in ``Path.passages``: the number of the path, the time in s, and
        the state, shape (passages, 5); those of each path in order."""
        values = np.array(curve(self._as_one if last is None else arc_of(self.rows[first:last].T)))
        starts, ends = _first_signs(values), _first_signs(values[::-1])
        falls = np.flatnonzero(starts < 0.0)
        signed = np.where(starts != 0.0, np.arange(len(starts)), -1)
        before = np.append(-1, np.maximum.accumulate(signed))[falls]  # the last arc before that is not zero
        jumps = (before >= 0) & (ends[before] > 0.0)
        falls, before = falls[jumps], before[jumps]
        turned = falls[self.numbers[first + before] == self.numbers[first + falls]]
        some = np.flatnonzero((values.min(axis=0) <= 0.0) & (values.max(axis=0) > 0.0))
        among, u, doubtful, _ = crossings_of_many(values[:, some])
        clear = ~np.isin(among, doubtful)
        found: list[tuple[Any, Any]] = [(turned, 0.0), (some[among[clear]], u[clear])]
        for place in some[np.unique(doubtful)].tolist():
            found += [([place], u) for u in downward_crossings(values[:, place].tolist())]
        at = np.concatenate([where for where, _ in found]).astype(int)
        u = np.concatenate([np.broadcast_to(u, len(where)) for where, u in found])
        order = np.lexsort((u, at))
        at, u = at[order], u[order]
        rows = self.rows[first + at]
        t = rows[:, T0] + u * (rows[:, T1] - rows[:, T0])
        return self.numbers[first + at], t, _states(rows, u)


class ArcRows(Path):
    """The arcs of one ball: some rows of ``paths``."""

    def __init__(self, paths: Paths, number: int, first: int, last: int) -> None:
        self.paths, self.number, self.first, self.last = paths, number, first, last

    def __len__(self) -> int:
        return self.last - self.first

    def __getitem__(self, index: int) -> Arc:
        return arc_of(self._rows[index].tolist(), self.paths.contacts)

    def __iter__(self) -> Iterator[Arc]:
        return (arc_of(row, self.paths.contacts) for row in self._rows.tolist())

    @property
    def _rows(self) -> np.ndarray:
        return self.paths.rows[self.first : self.last]

    @cached_property
    def starts(self) -> Sequence[float]:
        """The time in s at which each arc begins."""
        times: list[float] = self._rows[:, T0].tolist()
        return times

    @cached_property
    def stops(self) -> Sequence[float]:
        """The time in s at which each arc ends."""
        return self.paths.stops[self.first : self.last]

    def state_before(self, t: float) -> State:
        """The state just before t; where an arc ends, as its row has it."""
        stops = self.paths.stops
        row = bisect_left(stops, t, self.first, self.last)
        if row < self.last and stops[row] == t:
            return tuple(self.paths.rows[row, END].tolist())
        return super().state_before(t)

    def pieces(self) -> Iterator[tuple[float, float, list[float], list[float]]]:
        """Return the same as in Path, without the arcs."""
        return zip(self.starts, self.stops, *(self._rows[:, part].tolist() for part in (X, Y)), strict=True)

    def ends(self) -> list[Passage]:
        """Time and state at the end of each arc."""
        return list(zip(self.stops, map(tuple, self._rows[:, END].tolist()), strict=True))

    def highest(self, until: float = inf) -> Passage:
        """Time and state where it is highest, up to a time at which it is not."""
        if until == inf:
            return self.paths.summit(self.number)
        rows = self._rows
        at = int(np.where(rows[:, T1] <= until, rows[:, END.start + 1], -inf).argmax())  # of the ends
        ends = [(float(rows[at, T1]), tuple(rows[at, END].tolist()))]
        turns = [(float(rows[0, T0]), tuple(rows[0, START].tolist())), *ends, *self.passages(climb)]
        return max((turn for turn in turns if turn[0] <= until), key=height)

    def passages(self, curve: Curve) -> list[Passage]:
        """Each time and state at which a curve becomes negative."""
        return self.paths.passages(self, curve)


def _states(rows: np.ndarray, u: np.ndarray) -> np.ndarray:
    """The states on these rows' arcs where their parameter is u, shape (rows, 5): two curves of a degree at once."""
    place, speed = (rows[:, first.start : second.stop] for first, second in ((X, Y), (VX, VY)))
    pairs = (pair.reshape(len(rows), 2, pair.shape[1] // 2).T for pair in (place, speed))
    return np.vstack((*(evaluate(pair, u) for pair in pairs), evaluate(rows[:, SPIN].T, u))).T


def _listed(t: np.ndarray, states: np.ndarray) -> list[Passage]:
    return list(zip(t.tolist(), map(tuple, states.tolist()), strict=True))


def _first_signs(values: np.ndarray) -> np.ndarray:
    """The sign of the first value in each column that is not zero."""
    signs: np.ndarray = np.sign(values[0])
    zero = np.flatnonzero(signs == 0.0)
    if len(zero):
        some = np.sign(values[:, zero])
        signs[zero] = some[(some != 0.0).argmax(axis=0), np.arange(len(zero))]
    return signs


def cut(rows: np.ndarray, t: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Arcs as columns that end at t (s), where their parameter is u."""
    rows[T1] = t
    rows[_OF_CURVES] = first_part(rows[_COEFFICIENTS], u)[_HELD]
    rows[END] = rows[[curve.stop - 1 for curve in CURVES]]
    return rows


def columns_of(arcs: Sequence[Arc], contacts: Sequence[int]) -> np.ndarray:
    """Arcs as columns; their contacts have these numbers."""
    rows = []
    for arc, contact in zip(arcs, contacts, strict=True):
        curves = (elevate(curve, part.stop - part.start - 1) for curve, part in zip(arc.curves, CURVES, strict=True))
        rows.append([arc.t0, arc.t1, *arc.start, *chain(*curves), *arc.state(arc.t1), contact])
    return np.array(rows, float).reshape(-1, COLUMNS).T


def stepped(arc: Arc, contacts: np.ndarray) -> np.ndarray:
    """Arcs as columns, from one arc with arrays in place of numbers, as after a step."""
    columns = np.empty((COLUMNS, len(contacts)))
    columns[T0], columns[T1], columns[CONTACT] = arc.t0, arc.t1, contacts
    columns[START], columns[END] = arc.start, arc.end
    columns[START.stop : END.start] = list(chain(*arc.curves))
    return columns


def resting_columns(t: np.ndarray, state: np.ndarray) -> np.ndarray:
    """Arcs without duration, as columns."""
    x, y, _, _, spin = state
    return np.vstack((t, t, state, *[x] * 6, *[y] * 6, *[0.0 * x] * 10, *[spin] * 4, state, 0.0 * x - 1.0))


def arc_of(row: Any, contacts: Sequence[ArcContact | None] = ()) -> Arc:
    """The arc of one row; of many rows as columns, one with arrays."""
    start, end = tuple(row[START]), tuple(row[END])
    contact = contacts[int(row[CONTACT])] if contacts and row[CONTACT] >= 0.0 else None
    return Arc(row[T0], row[T1], start, (row[X], row[Y], row[VX], row[VY], row[SPIN]), contact, end)
