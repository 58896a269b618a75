"""Reading a measured track: where balls were at known times, from a CSV file."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy as np

from sandbox.errors import RequestError
from sandbox.files import reason

#: Most points of a track: more is taken as a mistake in the request.
MOST_POINTS = 100_000


@dataclass(frozen=True)
class Track:
    """Measured positions of balls, in the order of the file."""

    t: np.ndarray  # s, shape (points,)
    positions: np.ndarray  # m, shape (points, 2): x, y
    balls: tuple[str, ...]  # the ball of each point; "" if the file names none

    def __len__(self) -> int:
        return len(self.t)

    def first(self, count: int) -> Track:
        """The earliest points, in the order of time."""
        rows = np.argsort(self.t, kind="stable")[:count]
        return (
            self
            if count >= len(self)
            else Track(self.t[rows], self.positions[rows], tuple(self.balls[n] for n in rows))
        )


def read_track(option: str, path: Path) -> Track:
    """Read a CSV file with the columns t, x, y in s and m, and optionally ball. Raises RequestError."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = [row for row in csv.reader(file, strict=True) if row]
    except OSError as error:
        raise RequestError(f"{option} {path}: {reason(error)}") from None
    except (UnicodeDecodeError, csv.Error):
        raise RequestError(f"{option} {path}: is not a table: it must be a CSV file with columns t, x, y") from None
    names = [name.strip() for name in rows[0]] if rows else []
    missing = [name for name in ("t", "x", "y") if names.count(name) != 1]
    if missing:
        found = ", ".join(names)[:60] if names else "nothing"
        raise RequestError(f"{option} {path}: needs one column {missing[0]} in its first line, which has: {found}")
    for number, row in enumerate(rows[1:], start=1):
        if len(row) != len(names):
            raise RequestError(
                f"{option} {path}: row {number} has {len(row)} values, but there are {len(names)} columns"
            )
    columns = dict(zip(names, zip(*rows[1:], strict=True), strict=True)) if rows[1:] else {}
    numbers = {name: _numbers(f"{option} {path}", name, columns.get(name, ())) for name in ("t", "x", "y")}
    balls = [text.strip() for text in columns.get("ball", ("",) * len(rows[1:]))]
    return _checked(f"{option} {path}", numbers, balls)


def as_track(given: Mapping[str, Sequence[float]]) -> Track:
    """A track from Python: columns t (s), x, y (m), and optionally ball. Raises RequestError."""
    for name in ("t", "x", "y"):
        if name not in given:
            raise RequestError(f"track: needs t, x and y, but has {', '.join(map(str, given)) or 'nothing'}")
    count = len(given["t"])
    if any(len(column) != count for column in given.values()):
        raise RequestError("track: t, x, y and ball must have equally many values")
    numbers = {name: _numbers("track", name, [str(value) for value in given[name]]) for name in ("t", "x", "y")}
    return _checked("track", numbers, [str(name) for name in given.get("ball", ("",) * count)])


def _numbers(where: str, name: str, texts: Sequence[str]) -> np.ndarray:
    """The numbers of a column. Raises RequestError."""
    values = []
    for number, text in enumerate(texts, start=1):
        try:
            values.append(float(text))
        except ValueError:
            raise RequestError(f"{where}: row {number}, {name} = {text.strip()[:40]!r} is not a number") from None
        if not isfinite(values[-1]):
            raise RequestError(f"{where}: row {number}, {name} = {text.strip()} is not finite")
    return np.array(values)


def _checked(where: str, numbers: Mapping[str, np.ndarray], balls: Sequence[str]) -> Track:
    """The track, if its times are in order. Raises RequestError."""
    t = numbers["t"]
    if not 1 <= len(t) <= MOST_POINTS:
        raise RequestError(f"{where}: has {len(t):,} points; a track has 1 to {MOST_POINTS:,}")
    latest: dict[str, float] = {}
    for number, (time, ball) in enumerate(zip(t.tolist(), balls, strict=True), start=1):
        if time < 0.0:
            raise RequestError(f"{where}: row {number}, t = {time:g} s is before the launch, which is at 0 s")
        if time < latest.get(ball, 0.0):
            raise RequestError(f"{where}: row {number}, t = {time:g} s is before {latest[ball]:g} s in the row above")
        latest[ball] = time
    return Track(t, np.column_stack([numbers["x"], numbers["y"]]), tuple(balls))
