"""Places without times, as digitised from a photograph: each is compared with the nearest place of the path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sandbox.lab.fit.filmed import Filmed
from sandbox.scene import Scene
from sandbox.scene.points import Points
from sandbox.scene.scene_run import SceneRun

#: Steps along a path between which the nearest place is looked for, and steps of Newton's method from there.
STEPS, _NEWTON = 96, 3


@dataclass(frozen=True)
class Outline(Filmed):
    """Measured places on the paths of balls."""

    until: float  # s, how long a run may take

    names = ("distance",)
    units = ("m",)

    @property
    def times(self) -> np.ndarray:
        """The order of the points, as if they had been measured one after the other at even times in s.

        It only says which part of the path is fitted first, so points are best in the order in which the ball passed.
        """
        return np.linspace(0.0, self.until, len(self))

    def residuals(self, scene: Scene, keys: Sequence[str], values: np.ndarray, until: float) -> np.ndarray:
        """Distances from the path in m, positive to its left, shape (candidates, points)."""
        found = np.full((len(values), len(self)), np.nan)
        for candidate, run, ball, points, measured in self.flights(scene, keys, values, self.until):
            found[candidate, points] = distances(run, ball, measured)
        return found

    def points(self, scene: Scene, free: Sequence[float]) -> Points:
        """The measured places."""
        return Points(np.full(len(self), np.nan), self.frame.places(self.positions, free), self.named(scene))

    def remarks(self, scene: Scene, free: Sequence[float]) -> tuple[str, ...]:
        """Sentences on how the table was read, and on how points without times are compared."""
        return (*self.notes, "no times: each point is compared with the nearest place of the path")


def distances(run: SceneRun, ball: str, places: np.ndarray) -> np.ndarray:
    """Distances of places, shape (points, 2), from the path of a ball, in m: positive to its left."""
    impacts = [event.t for event in run.events if event.t < run.duration]
    step = run.duration / STEPS
    nodes = np.unique(np.concatenate([np.linspace(0.0, run.duration, STEPS + 1), impacts]))
    path = run.states(ball, nodes)[:, :2]
    along = np.diff(path, axis=0)
    length2 = np.maximum((along**2).sum(axis=1), 1e-300)
    apart = places[:, None] - path[None, :-1]  # shape (points, steps, 2)
    share = np.clip((apart * along).sum(axis=2) / length2, 0.0, 1.0)
    best = ((apart - share[..., None] * along) ** 2).sum(axis=2).argmin(axis=1)
    low, high = nodes[best], nodes[best + 1]
    t = low + np.take_along_axis(share, best[:, None], axis=1)[:, 0] * (high - low)
    ends = np.concatenate([[0.0], impacts, [run.duration]])  # of smooth arcs
    after = np.clip(np.searchsorted(ends, t, side="right"), 1, len(ends) - 1)
    low, high = ends[after - 1], ends[after]
    for _ in range(_NEWTON):  # the nearest place is where the velocity is square to the way to the point
        state = run.states(ball, t)
        velocity, way = state[:, 2:4], places - state[:, :2]
        speed2 = np.maximum((velocity**2).sum(axis=1), 1e-300)
        t = np.clip(t + np.clip((way * velocity).sum(axis=1) / speed2, -step, step), low, high)
    state = run.states(ball, t)
    velocity, way = state[:, 2:4], places - state[:, :2]
    left = velocity[:, 0] * way[:, 1] - velocity[:, 1] * way[:, 0]
    return np.asarray(np.where(left < 0.0, -1.0, 1.0) * np.hypot(*way.T))
