"""The path of a ball as points, computed fast enough to be drawn in every frame."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from sandbox.engine.bernstein_many import evaluate

if TYPE_CHECKING:
    from sandbox.engine.run import Run

#: Points on each arc of a path. The arcs of a drive are seconds long, and its line must still look smooth.
POINTS = 9
#: A drawn line has no points nearer to each other than this, none farther, in px, and bends by no more at one, in rad.
CLOSEST, LONGEST, BEND = 3.0, 60.0, 0.12


def points(paths: Sequence[tuple[Run, str]]) -> list[np.ndarray]:
    """Points along the paths of balls of runs, each of shape (n, 3): t in s, x and y in m, in order of time."""
    pieces = [[*run.arcs[ball].pieces()] for run, ball in paths]
    starts, stops, *both = (list(part) for part in zip(*chain(*pieces), strict=True))
    counts = [len(each) for each in pieces]
    out = np.empty((len(starts), POINTS, 3))
    u = np.linspace(0.0, 1.0, POINTS)
    first, last = np.array(starts), np.minimum(stops, np.repeat([run.duration for run, _ in paths], counts))
    out[:, :, 0] = first[:, None] + (last - first)[:, None] * u
    for column, curves in enumerate(both, 1):
        lengths = np.array([len(curve) for curve in curves])
        for terms in set(lengths.tolist()):
            rows = np.flatnonzero(lengths == terms)
            out[rows, :, column] = evaluate(np.array([curves[row] for row in rows]).T[:, :, None], u)
    return np.split(out.reshape(-1, 3), POINTS * np.cumsum(counts)[:-1])


def moves(run: Run, ball: str) -> bool:
    """Whether a ball moves at all."""
    return any(len(arc.x) > 1 or len(arc.y) > 1 for arc in run.arcs[ball])


def simplify(pixels: np.ndarray) -> np.ndarray:
    """As few of the points (px, shape (n, 2)) as give the same visible line: more where it bends, and each corner.

    Joints would show between short pieces of a smooth line.
    """
    pixels = pixels[_apart(pixels)]
    steps = np.diff(pixels, axis=0)
    heading = np.arctan2(steps[:, 1], steps[:, 0])
    turn = np.abs((np.diff(heading) + np.pi) % (2 * np.pi) - np.pi)
    along = np.hypot(*steps.T) / LONGEST
    along[1:] += turn / BEND
    return pixels[_firsts(np.cumsum(along), len(pixels))]


def _apart(pixels: np.ndarray) -> np.ndarray:
    """Indices of points that are at least CLOSEST px from the one before, and the last."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(pixels, axis=0).T))])
    return _firsts(along / CLOSEST, len(pixels))


def _firsts(growing: np.ndarray, count: int) -> np.ndarray:
    """Indices of the first of ``count`` points, those at which a growing value passes a whole number, and the last."""
    passed = np.flatnonzero(np.diff(np.floor(growing))) + 1
    return np.concatenate([[0], passed, [count - 1]] if not len(passed) or passed[-1] < count - 1 else [[0], passed])
