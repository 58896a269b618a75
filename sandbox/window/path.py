"""The path of a ball as points, quickly: for a line that is drawn anew in every frame."""

from __future__ import annotations

from functools import lru_cache
from math import comb
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from sandbox.engine.run import Run

#: Points on each arc of a path. The arcs of a drive are seconds long, and its line must still look smooth.
POINTS = 9


@lru_cache
def _basis(terms: int) -> np.ndarray:
    """Bernstein polynomials at POINTS even places, shape (POINTS, terms)."""
    u = np.linspace(0.0, 1.0, POINTS)[:, None]
    k = np.arange(terms)[None, :]
    return np.array([comb(terms - 1, i) for i in range(terms)]) * u**k * (1 - u) ** (terms - 1 - k)


def points(run: Run, ball: str) -> np.ndarray:
    """Points along a ball's path, shape (n, 3): t in s, x and y in m, in order of time."""
    arcs = run.arcs[ball]
    out = np.empty((len(arcs), POINTS, 3))
    spans = np.array([(arc.t0, min(arc.t1, run.duration)) for arc in arcs])
    u = np.linspace(0.0, 1.0, POINTS)
    out[:, :, 0] = spans[:, :1] + (spans[:, 1:] - spans[:, :1]) * u
    for column, curves in ((1, [arc.x for arc in arcs]), (2, [arc.y for arc in arcs])):
        lengths = np.array([len(curve) for curve in curves])
        for terms in set(lengths.tolist()):
            rows = np.flatnonzero(lengths == terms)
            coefficients = np.array([curves[row] for row in rows])
            out[rows, :, column] = coefficients @ _basis(terms).T
    return out.reshape(-1, 3)


def moves(run: Run, ball: str) -> bool:
    """Whether a ball leaves its place at all."""
    return any(len(arc.x) > 1 or len(arc.y) > 1 for arc in run.arcs[ball])


def apart(pixels: np.ndarray, least: float) -> np.ndarray:
    """Indices of points that are at least so many px from the one before, and the last."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(pixels, axis=0).T))])
    _, kept = np.unique(np.floor(along / least), return_index=True)
    return np.union1d(kept, [len(pixels) - 1])
