"""Runs of a scene at candidates of a fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sandbox.lab.runs import runs
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun

#: The shortest run in s: a track with points at the launch only.
SHORTEST = 1e-6


def flown(scene: Scene, keys: Sequence[str], values: np.ndarray, until: float) -> list[SceneRun | None]:
    """A run of each candidate up to a time in s, or to rest; None for one that failed.

    ``values`` has the shape (candidates, keys or more); candidates that are alike share a run.
    """
    points = [tuple(row) for row in values[:, : len(keys)].tolist()]
    distinct = list(dict.fromkeys(points))
    found = dict(zip(distinct, runs(scene, keys, distinct, until=max(until, SHORTEST)), strict=True))
    return [None if isinstance(run := found[point], Exception) else run for point in points]
