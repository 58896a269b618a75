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
from sandbox.lab.fit.flown import flown
from sandbox.lab.fit.measured import Free, Points
from sandbox.scene import Scene

#: Most points of a track: more is taken as a mistake in the request.
MOST_POINTS = 100_000


@dataclass(frozen=True)
class Track:
    """Measured positions of balls, in the order of the file."""

    t: np.ndarray  # s, shape (points,)
    positions: np.ndarray  # m, shape (points, 2): x, y
    balls: tuple[str, ...]  # the ball of each point; "" if the file names none

    what = "point"
    names = ("x", "y")
    units = ("m", "m")
    free: tuple[Free, ...] = ()

    def __len__(self) -> int:
        return len(self.t)

    @property
    def count(self) -> int:
        """The points."""
        return len(self)

    @property
    def rows(self) -> np.ndarray:
        """The row of each residual: x and y of the first point, of the second, and so on."""
        return np.repeat(np.arange(1, len(self) + 1), 2)

    @property
    def groups(self) -> np.ndarray:
        """0 for residuals in x, 1 in y."""
        return np.tile([0, 1], len(self))

    @property
    def times(self) -> np.ndarray:
        """The time of each residual in s."""
        return np.repeat(self.t, 2)

    def check(self, scene: Scene) -> None:
        """Raise RequestError if it is of a ball that the scene does not have."""
        names = [ball.name for ball in scene.build().balls]
        unknown = next((ball for ball in self.balls if ball and ball not in names), None)
        if unknown is not None:
            raise RequestError(f"track: no ball {unknown!r} in {scene.title}; it has {', '.join(names)}")

    def residuals(self, scene: Scene, keys: Sequence[str], values: np.ndarray, until: float) -> np.ndarray:
        """Measured minus computed places in m, shape (candidates, 2 points)."""
        balls, t = self._named(scene), np.minimum(self.t, until)
        found = np.full((len(values), len(self), 2), np.nan)
        for place, run in enumerate(flown(scene, keys, values, float(t.max()))):
            if run is not None:
                for ball in dict.fromkeys(balls):
                    rows = [row for row, name in enumerate(balls) if name == ball]
                    states = run.states(ball, np.minimum(t[rows], run.duration))
                    found[place, rows] = self.positions[rows] - states[:, :2]
        return found.reshape(len(values), -1)

    def points(self, scene: Scene, free: Sequence[float]) -> Points:
        """The measured places."""
        return Points(self.t, self.positions, self._named(scene))

    def remarks(self, scene: Scene, free: Sequence[float]) -> tuple[str, ...]:
        """What is odd about it."""
        return ()

    def _named(self, scene: Scene) -> tuple[str, ...]:
        """The ball of each point; the scene's first where none is named."""
        first = scene.build().balls[0].name
        return tuple(ball or first for ball in self.balls)


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
