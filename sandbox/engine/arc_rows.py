"""A path as rows of numbers. Arcs are created on demand, since most arcs of a sweep are never read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import overload

import numpy as np

from sandbox.engine.arc import Arc

#: Positions of an arc's parts in its row: times, state at the start, curves, state at the end.
START = slice(2, 7)
X, Y, VX, VY, SPIN = slice(7, 13), slice(13, 19), slice(19, 24), slice(24, 29), slice(29, 33)
CURVES = {"x": X, "y": Y, "vx": VX, "vy": VY, "spin": SPIN}
END = slice(33, 38)
COLUMNS = END.stop


class ArcRows(Sequence[Arc]):
    """Arcs of one ball in flight, from rows of shape (arcs, 38): t0, t1, start, coefficients, end."""

    def __init__(self, rows: np.ndarray) -> None:
        self._rows = rows

    def __len__(self) -> int:
        return len(self._rows)

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

    def passing(self, px: float, py: float, nx: float, ny: float) -> list[Arc]:
        """The arcs that may pass the line through (px, py) with the normal (nx, ny)."""
        gap = (self._rows[:, X] - px) * nx + (self._rows[:, Y] - py) * ny
        return [self[i] for i in np.flatnonzero((gap.min(axis=1) <= 0.0) & (gap.max(axis=1) > 0.0)).tolist()]

    def topmost(self) -> list[Arc]:
        """The arcs that may contain the path's highest point."""
        y = self._rows[:, Y]
        return [self[i] for i in np.flatnonzero(y.max(axis=1) >= max(y[:, 0].max(), y[:, -1].max())).tolist()]


def arc_of(row: list[float]) -> Arc:
    """The arc of one row."""
    start, end = tuple(row[START]), tuple(row[END])
    return Arc(row[0], row[1], start, row[X], row[Y], row[VX], row[VY], row[SPIN], end=end)
