"""A measured track: where balls were at known times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.fit.filmed import Filmed
from sandbox.scene import Scene
from sandbox.scene.points import Points


@dataclass(frozen=True)
class Track(Filmed):
    """Measured positions of balls at known times."""

    t: np.ndarray  # s, shape (points,), by the clock of the film

    names = ("x", "y")
    units = ("m", "m")

    @property
    def times(self) -> np.ndarray:
        """The time of each residual in s; where the launch is fitted, the greatest that its range allows."""
        return np.repeat(self.frame.latest(self.t), 2)

    def check(self, scene: Scene) -> None:
        """Raise RequestError if it is of a ball that the scene does not have, or begins before the launch."""
        super().check(scene)
        if not any(one.key == "track.time" for one in self.free) and self.t.min() < 0.0:
            place = int(np.flatnonzero(self.t < 0.0)[0])
            said = f"row {self.numbers[place]}, t = {self.t[place]:g} s is before the launch, which is at 0 s"
            raise RequestError(f"{self.where}: {said}; free time (--free time) fits when it was")

    def residuals(self, scene: Scene, keys: Sequence[str], values: np.ndarray, until: float) -> np.ndarray:
        """Measured minus computed places in m, shape (candidates, 2 points)."""
        times = np.array([np.clip(self.frame.elapsed(self.t, free), 0.0, until) for free in values[:, len(keys) :]])
        found = np.full((len(values), len(self), 2), np.nan)
        for candidate, run, ball, points, measured in self.flights(scene, keys, values, float(times.max())):
            states = run.states(ball, np.minimum(times[candidate, points], run.duration))
            found[candidate, points] = measured - states[:, :2]
        return found.reshape(len(values), -1)

    def points(self, scene: Scene, free: Sequence[float]) -> Points:
        """The measured places."""
        return Points(self.frame.elapsed(self.t, free), self.frame.places(self.positions, free), self.named(scene))

    def remarks(self, scene: Scene, free: Sequence[float]) -> tuple[str, ...]:
        """Sentences on how the table was read, and the number of points that were not compared with a flight."""
        early = int((self.frame.elapsed(self.t, free) < 0.0).sum())
        return (*self.notes, *([f"points before the launch, compared with where it is: {early}"] if early else []))
