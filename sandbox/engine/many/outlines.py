"""Touches of many shots and fixed shapes: touch.py's distances, in arrays.

Clear cases (nothing near, or one crossing) are computed here for all shots at once; unclear ones are left to
``Obstacle.first_touch``, pair by pair.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from sandbox.engine.contact.touch import Obstacle, Outline, Touching, flush
from sandbox.engine.many.bernstein_many import elevated, evaluate, first_downward_crossing, squared_length, without_root
from sandbox.engine.many.stacking import Stack
from sandbox.engine.model.tolerances import GAP_ROUNDING, SKIN, TOUCHING_GAP
from sandbox.engine.paths.arc import Arc


class _SurfaceProperties(NamedTuple):
    """Properties of many surfaces, with arrays for numbers."""

    restitution: Any
    friction: Any
    rolling_resistance: Any
    lowest_bounce: Any  # m
    kick: Any  # N s


class _Obstacles(Obstacle):
    """Many surfaces as one: that of each of some shots, with arrays for numbers."""

    def __init__(self, surface: Any, outline: Outline) -> None:
        self.surface = surface
        self.outline = outline


class BatchSurfaces:
    """The surfaces of many shots, each prepared for its ball; every shot has the same number and kinds.

    Inside, arrays have shape (surfaces, shots).
    """

    def __init__(self, setups: Stack, skin: float = SKIN) -> None:
        self._setups = setups
        self._skin = skin
        radii = np.broadcast_to(setups.whole.balls[0].radius, len(setups))
        surfaces = setups.whole.surfaces
        outlines = [Outline.of(surface.shape, radii) for surface in surfaces]
        properties = [[getattr(surface, name) for name in _SurfaceProperties._fields] for surface in surfaces]
        # of shape (parts of an outline or its properties, surfaces, shots)
        self._table, self._properties = (
            np.array([[np.broadcast_to(part, radii.shape) for part in row] for row in rows]).transpose(1, 0, 2)
            for rows in (outlines, properties)
        )
        self._boxes = np.array(Outline(*self._table).box())
        self._obstacles: dict[tuple[int, int], Obstacle] = {}

    def of(self, surfaces: np.ndarray, shots: np.ndarray) -> _Obstacles:
        """The surface with the given index, of each of these shots."""
        return _Obstacles(
            _SurfaceProperties(*self._properties[:, surfaces, shots]), Outline(*self._table[:, surfaces, shots])
        )

    def near(
        self, shots: np.ndarray, x: np.ndarray, y: np.ndarray, held: np.ndarray | int = -1
    ) -> tuple[np.ndarray, np.ndarray, Touching]:
        """Return how many surfaces touch the balls of these shots, centred at x and y (m), without those by which they
        are ``held`` (-1 for none), where flush ones count as one; the index of the first that does, or else of the
        nearest; and its Touching."""
        touching = Outline(*self._table[:, :, shots]).near(x, y)
        touches = (touching.gap <= TOUCHING_GAP) & (np.arange(len(touching.gap))[:, None] != held)
        first = np.where(touches.any(axis=0), touches.argmax(axis=0), touching.gap.argmin(axis=0))
        pick = (first, np.arange(len(shots)))
        center = touching.center[0][pick], touching.center[1][pick]
        gap, nx, ny, curvature = (part[pick] for part in touching[:4])
        picked = Touching(gap, nx, ny, curvature, center, touching.feature[pick])
        count = (touches & ~flush(touching, picked)).sum(axis=0) + touches.any(axis=0)
        return count, first, picked

    def first_touch(
        self,
        shots: np.ndarray,
        x: np.ndarray,
        y: np.ndarray,
        arc: Callable[[int], Arc],
        held: np.ndarray | int = -1,
    ) -> tuple[np.ndarray, np.ndarray]:
        """The first u in [0, 1] at which each shot's path touches anything but the surface by which it is ``held`` (-1
        for none), inf where it does not, and how many surfaces were checked; both of shape (paths,).

        ``x`` and ``y`` are coefficients in m, shape (6, paths), and ``arc(i)`` is the i-th of these paths.
        """
        touch = np.full(len(shots), np.inf)
        what, path = np.nonzero(self.in_reach(shots, x, y, held))
        if len(path):
            u, unclear = _first_touch(Outline(*self._table[:, what, shots[path]]), x[:, path], y[:, path], self._skin)
            for pair in unclear.nonzero()[0].tolist():
                found = self.obstacle(int(what[pair]), int(shots[path[pair]])).first_touch(arc(int(path[pair])))
                u[pair] = np.inf if found is None else found
            np.minimum.at(touch, path, u)
        return touch, np.bincount(path, minlength=len(shots))

    def in_reach(self, shots: np.ndarray, x: np.ndarray, y: np.ndarray, held: np.ndarray | int = -1) -> np.ndarray:
        """A mask of the surfaces near these paths, but those by which they are held, shape (surfaces, paths)."""
        left, bottom, right, top = self._boxes[:, :, shots]
        level = (x.min(axis=0) <= right) & (x.max(axis=0) >= left)
        reached = level & (y.min(axis=0) <= top) & (y.max(axis=0) >= bottom)
        found: np.ndarray = reached & (np.arange(len(left))[:, None] != held)
        return found

    def obstacle(self, surface: int, shot: int) -> Obstacle:
        """One surface, for the ball of one shot."""
        key = (surface, shot)
        if key not in self._obstacles:
            setup = self._setups[shot]
            self._obstacles[key] = Obstacle(setup.surfaces[surface], setup.balls[0].radius, self._skin)
        return self._obstacles[key]


def _first_touch(outline: Outline, x: np.ndarray, y: np.ndarray, skin: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the u at which each path first touches its shape, inf if it does not, and a mask of the unclear ones; both
    of shape (paths,)."""
    first, unclear = np.full(len(outline.reach), np.inf), np.zeros(len(outline.reach), dtype=bool)
    straight = (outline.length > 0.0).nonzero()[0]
    along, (corners, to_corner) = outline.along(x, y), _to_corners(outline, straight, x, y, skin)
    sides, to_side, starts = _to_sides(outline, straight, along[0], outline.across(x, y), skin)
    path = np.concatenate((corners, sides))
    if not len(path):
        return first, unclear
    gap = np.concatenate((to_corner, to_side), axis=1)
    u, doubtful = _closing(gap, np.concatenate((corners >= 0, starts)))
    found = np.isfinite(u[len(corners) :])
    there = evaluate(along[:, sides], np.where(found, u[len(corners) :], 0.0))
    missed = len(corners) + (found & ((there < 0.0) | (there > outline.length[sides]))).nonzero()[0]
    if len(missed):  # it may touch later, after passing beyond the side's end
        u[missed] = np.inf
        positive = gap[:, missed] > 0.0
        again = (positive[1:] != positive[:-1]).sum(axis=0) > 1
        doubtful[missed] |= again | (gap[0, missed] <= GAP_ROUNDING)
    np.minimum.at(first, path, u)
    np.logical_or.at(unclear, path, doubtful)
    return first, unclear


def _to_corners(
    outline: Outline, straight: np.ndarray, x: np.ndarray, y: np.ndarray, skin: float
) -> tuple[np.ndarray, np.ndarray]:
    """The paths that may come to touch a corner, and (d^2 - r^2) / 2 r of their distance d to it: near r their gap in
    m."""
    path = np.concatenate((np.arange(len(outline.reach)), straight))
    dx = x[:, path] - np.concatenate((outline.ax, outline.bx[straight]))
    dy = y[:, path] - np.concatenate((outline.ay, outline.by[straight]))
    radius = outline.reach[path] - skin
    apart = (dx.min(axis=0) > radius) | (dx.max(axis=0) < -radius)
    apart |= (dy.min(axis=0) > radius) | (dy.max(axis=0) < -radius)
    # all control points are beyond a tangent of the circle: no touch
    mx, my = dx[len(dx) // 2], dy[len(dy) // 2]
    length = np.hypot(mx, my)
    apart |= (length > radius) & ((dx * mx + dy * my).min(axis=0) > radius * length)
    some = (~apart).nonzero()[0]
    radius = radius[some]
    return path[some], (squared_length(dx[:, some], dy[:, some]) - radius * radius) / (2.0 * radius)


def _to_sides(
    outline: Outline, straight: np.ndarray, along: np.ndarray, across: np.ndarray, skin: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The paths that may come to touch a side, from either side of its line; their gaps to it, of the same degree as
    those to corners; and whether they may start in touch. ``along`` is where they start."""
    path = np.concatenate((straight, straight))
    across = np.concatenate((across[:, straight], -across[:, straight]), axis=1)
    reach, beside = outline.reach[path], across[0] > 0.0
    gap = across - (reach - skin)
    reached = (across.min(axis=0) <= reach) & (across.max(axis=0) >= -reach)
    some = (reached & (beside | (gap.max(axis=0) > -GAP_ROUNDING))).nonzero()[0]
    path = path[some]
    within = (along[path] >= -TOUCHING_GAP) & (along[path] <= outline.length[path] + TOUCHING_GAP)
    return path, elevated(gap[:, some], 2 * (len(gap) - 1)), within & beside[some]


def _closing(gap: np.ndarray, starts_touching: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the u at which gaps first close, and a mask of the unclear ones. One that is closed at the start, within
    rounding, counts only if it closes further."""
    closed = (starts_touching & (gap[0] <= GAP_ROUNDING)).nonzero()[0]
    opening = without_root(gap[:, closed])
    ahead = gap.copy()
    ahead[:, closed] = opening + GAP_ROUNDING
    u, unclear = first_downward_crossing(ahead)
    unclear[closed] |= opening[0] < -GAP_ROUNDING
    return u, unclear
