"""A measured track: where balls were at known times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.fit.flown import flown
from sandbox.lab.fit.frame import Frame
from sandbox.lab.fit.measured import Free
from sandbox.lab.fit.reading import Measurements
from sandbox.scene import Scene
from sandbox.scene.points import Points


@dataclass(frozen=True)
class Track:
    """Measured positions of balls, in the order of the file."""

    t: np.ndarray  # s, shape (points,), by the clock of the film
    positions: np.ndarray  # m, shape (points, 2): x, y, in the axes of the film
    balls: tuple[str, ...]  # the ball of each point; "" if the file names none
    numbers: np.ndarray  # the row of each point in its file, the first is 1; shape (points,)
    frame: Frame = Frame()
    where: str = "track"  # as messages begin

    what = "point"
    runs = 1
    names = ("x", "y")
    units = ("m", "m")

    def __len__(self) -> int:
        return len(self.t)

    @property
    def count(self) -> int:
        """The points."""
        return len(self)

    @property
    def free(self) -> tuple[Free, ...]:
        """What is not known of clock and axes of the film."""
        return self.frame.free

    @property
    def rows(self) -> np.ndarray:
        """The row of each residual: x and y of the first point, of the second, and so on."""
        return np.repeat(self.numbers, 2)

    @property
    def groups(self) -> np.ndarray:
        """0 for residuals in x, 1 in y."""
        return np.tile([0, 1], len(self))

    @property
    def times(self) -> np.ndarray:
        """The time of each residual in s; where the launch is fitted, the greatest that its range allows."""
        return np.repeat(self.frame.latest(self.t), 2)

    def check(self, scene: Scene) -> None:
        """Raise RequestError if it is of a ball that the scene does not have, or begins before the launch."""
        check_balls(self.where, self.balls, scene)
        if not any(one.key == "track.time" for one in self.free) and self.t.min() < 0.0:
            place = int(np.flatnonzero(self.t < 0.0)[0])
            said = f"row {self.numbers[place]}, t = {self.t[place]:g} s is before the launch, which is at 0 s"
            raise RequestError(f"{self.where}: {said}; free time (--free time) fits when it was")

    def residuals(self, scene: Scene, keys: Sequence[str], values: np.ndarray, until: float) -> np.ndarray:
        """Measured minus computed places in m, shape (candidates, 2 points)."""
        balls = named(self.balls, scene)
        free = values[:, len(keys) :]
        times = [np.clip(self.frame.elapsed(self.t, one), 0.0, until) for one in free]
        found = np.full((len(values), len(self), 2), np.nan)
        for place, run in enumerate(flown(scene, keys, values, max(float(t.max()) for t in times))):
            if run is None:
                continue
            measured = self.frame.places(self.positions, free[place])
            for ball in dict.fromkeys(balls):
                rows = [row for row, name in enumerate(balls) if name == ball]
                states = run.states(ball, np.minimum(times[place][rows], run.duration))
                found[place, rows] = measured[rows] - states[:, :2]
        return found.reshape(len(values), -1)

    def points(self, scene: Scene, free: Sequence[float]) -> Points:
        """The measured places."""
        return Points(
            self.frame.elapsed(self.t, free), self.frame.places(self.positions, free), named(self.balls, scene)
        )

    def remarks(self, scene: Scene, free: Sequence[float]) -> tuple[str, ...]:
        """Points that were not compared with a flight."""
        early = int((self.frame.elapsed(self.t, free) < 0.0).sum())
        return (f"points before the launch, compared with where it is: {early}",) if early else ()


def check_balls(where: str, balls: Sequence[str], scene: Scene) -> None:
    """Raise RequestError for a ball that the scene does not have."""
    names = [ball.name for ball in scene.build().balls]
    unknown = next((ball for ball in balls if ball and ball not in names), None)
    if unknown is not None:
        hint = f'; say which one it is, as --ball "{unknown}={names[0]}"' if len(names) > 1 else ""
        raise RequestError(f"{where}: no ball {unknown!r} in {scene.title}; it has {', '.join(names)}{hint}")


def named(balls: Sequence[str], scene: Scene) -> tuple[str, ...]:
    """The ball of each point; the scene's first where none is named."""
    first = scene.build().balls[0].name
    return tuple(ball or first for ball in balls)


def track_of(measured: Measurements, frame: Frame) -> Track:
    """A track of measurements with times."""
    assert measured.t is not None
    return Track(measured.t, measured.positions, measured.balls, measured.rows, frame, measured.where)
