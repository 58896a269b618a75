"""Measured places of balls, which a scene file may name and pictures show: ``[measured] track = "throw.csv"``."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from math import isfinite, nan
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.files import from_here, read_given
from sandbox.toml import short_toml

#: The columns of such a file, and most bytes that it has.
_COLUMNS, _LARGEST = ("t", "x", "y", "ball"), 20_000_000


@dataclass(frozen=True)
class Points:
    """Measured places in the scene's coordinates."""

    t: np.ndarray  # s since the launch, shape (points,); NaN if not measured
    positions: np.ndarray  # m, shape (points, 2)
    balls: tuple[str, ...]  # the name of each point's ball

    def as_csv(self) -> str:
        """The file that a scene file names."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(_COLUMNS)
        for t, (x, y), ball in zip(self.t.tolist(), self.positions.tolist(), self.balls, strict=True):
            writer.writerow(("" if t != t else repr(t), repr(x), repr(y), ball))
        return out.getvalue()


def points_of(file: Path, written: Any) -> Points:
    """The points that the table ``[measured]`` of a scene file names. Raises RequestError."""
    where = from_here(file)
    named = written.get("track") if isinstance(written, dict) and len(written) == 1 else None
    if not isinstance(named, str) or not named:
        raise RequestError(f'{where}: measured = {short_toml(written)}: must be [measured] with track = "points.csv"')
    path = file.parent / named
    try:
        text = read_given(path, _LARGEST).decode("utf-8-sig")
        head, *rows = [row for row in csv.reader(io.StringIO(text), strict=True) if row] or [[]]
    except (UnicodeDecodeError, csv.Error):
        raise RequestError(f"{where}: measured.track: {path} is not a table") from None
    if tuple(head) != _COLUMNS or not rows:
        raise RequestError(f"{where}: measured.track: {path} must have rows with {', '.join(_COLUMNS)} (s, m, m, name)")
    return _points(f"{where}: measured.track: {path}", rows)


def _points(where: str, rows: list[list[str]]) -> Points:
    """The rows as points. Raises RequestError."""
    numbers: list[tuple[float, float, float]] = []
    for place, row in enumerate(rows, 1):
        try:
            t, x, y = (float(cell) if cell or column else nan for column, cell in enumerate(row[:3]))
            good = len(row) == len(_COLUMNS) and isfinite(x) and isfinite(y)
        except ValueError:
            good = False
        if not good:
            raise RequestError(f"{where}: row {place} is not t, x, y, ball")
        numbers.append((t, x, y))
    table = np.array(numbers)
    return Points(table[:, 0], table[:, 1:], tuple(row[3] for row in rows))
