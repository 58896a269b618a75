"""Where many shots touch fixed shapes: touch.py's distances, in arrays.

Clear cases (nothing near, or one crossing) are computed here for all shots at once; unclear ones are left to
``Obstacle.first_touch``, pair by pair.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from sandbox.engine.accuracy import SKIN
from sandbox.engine.arc import Arc
from sandbox.engine.bernstein import without_root_at_start
from sandbox.engine.bernstein_many import evaluate, first_downward_crossing, squared_length
from sandbox.engine.stacking import Stack
from sandbox.engine.touch import NOISE, TOUCHING_GAP, Obstacle, Outline, Touching, flush

#: First crossing of each path, and a mask of the unclear ones; both of shape (paths,).
Crossings = tuple[np.ndarray, np.ndarray]


class Grip(NamedTuple):
    """What lasting contact asks of many surfaces."""

    friction: Any
    rolling_resistance: Any
    lowest_bounce: Any  # m


class Obstacles(Obstacle):
    """Many surfaces as one: that of each of some shots, with arrays for numbers."""

    def __init__(self, surface: Any, outline: Outline) -> None:
        self.surface = surface
        self.outline = outline


class Outlines:
    """The surfaces of many shots, each prepared for its ball; every shot has the same number and kinds.

    Inside, arrays have shape (surfaces, shots).
    """

    def __init__(self, setups: Stack, skin: float = SKIN) -> None:
        self._setups = setups
        self._skin = skin
        radii = np.broadcast_to(setups.whole.balls[0].radius, len(setups))
        surfaces = setups.whole.surfaces
        outlines = [Outline.of(surface.shape, radii) for surface in surfaces]
        grips = [[getattr(surface, name) for name in Grip._fields] for surface in surfaces]
        # of shape (parts of an outline or a grip, surfaces, shots)
        self._table, self._grips = (
            np.array([[np.broadcast_to(part, radii.shape) for part in row] for row in rows]).transpose(1, 0, 2)
            for rows in (outlines, grips)
        )
        self._boxes = np.array(Outline(*self._table).box())
        self._obstacles: dict[tuple[int, int], Obstacle] = {}

    def of(self, surfaces: np.ndarray, shots: np.ndarray) -> Obstacles:
        """The surface with the given index, of each of these shots."""
        return Obstacles(Grip(*self._grips[:, surfaces, shots]), Outline(*self._table[:, surfaces, shots]))

    def near(
        self, shots: np.ndarray, x: np.ndarray, y: np.ndarray, held: np.ndarray | int = -1
    ) -> tuple[np.ndarray, np.ndarray, Touching]:
        """How many surfaces touch the balls of these shots, centred at x and y (m), without those by which they are
        ``held`` (-1 for none), and of which flush ones count as one; the index of the first that does, or else of the
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
            xs, ys = x[:, path], y[:, path]
            outlines = self._table[:, what, shots[path]]
            outline = Outline(*outlines)
            straight = np.flatnonzero(outline.length > 0.0)
            u, unclear = _first_within(
                np.concatenate((xs - outline.ax, xs[:, straight] - outline.bx[straight]), axis=1),
                np.concatenate((ys - outline.ay, ys[:, straight] - outline.by[straight]), axis=1),
                np.concatenate((outline.reach, outline.reach[straight])) - self._skin,
            )
            (u, u_b), (unclear, unclear_b) = np.split(u, [len(path)]), np.split(unclear, [len(path)])
            if len(straight):
                sides = Outline(*outlines[:, straight])
                u_side, unclear_side = _side(sides, xs[:, straight], ys[:, straight], self._skin)
                u[straight] = np.minimum(np.minimum(u[straight], u_b), u_side)
                unclear[straight] |= unclear_b | unclear_side
            for pair in np.flatnonzero(unclear).tolist():
                found = self.obstacle(int(what[pair]), int(shots[path[pair]])).first_touch(arc(int(path[pair])))
                u[pair] = np.inf if found is None else found
            np.minimum.at(touch, path, u)
        return touch, np.bincount(path, minlength=len(shots))

    def in_reach(self, shots: np.ndarray, x: np.ndarray, y: np.ndarray, held: np.ndarray | int = -1) -> np.ndarray:
        """Which surfaces are near these paths, but those by which they are held, shape (surfaces, paths)."""
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


def _side(outline: Outline, x: np.ndarray, y: np.ndarray, skin: float) -> Crossings:
    """Where paths come to touch a side, from either side of its line."""
    across, along = outline.across(x, y), outline.along(x, y)
    count = len(outline.reach)
    first, unclear = np.full(count, np.inf), np.zeros(count, dtype=bool)
    reached = (across.min(axis=0) <= outline.reach) & (across.max(axis=0) >= -outline.reach)
    gap = np.concatenate((across, -across), axis=1)
    beside = gap[0] > 0.0
    gap = gap - (np.tile(outline.reach, 2) - skin)
    some = np.flatnonzero(np.tile(reached, 2) & (beside | (gap.max(axis=0) > -NOISE)))
    if not len(some):
        return first, unclear
    gap, path = gap[:, some], some % count
    along, length = along[:, path], outline.length[path]
    within = (along[0] >= -TOUCHING_GAP) & (along[0] <= length + TOUCHING_GAP)
    u, doubtful = _closing(gap, within & beside[some])
    there = evaluate(along, np.where(np.isfinite(u), u, 0.0))
    missed = np.isfinite(u) & ((there < 0.0) | (there > length))
    if missed.any():  # it may touch later, after passing beyond the side's end
        u[missed] = np.inf
        positive = gap > 0.0
        again = (positive[1:] != positive[:-1]).sum(axis=0) > 1
        doubtful |= missed & (again | (gap[0] <= NOISE))
    np.minimum.at(first, path, u)
    np.logical_or.at(unclear, path, doubtful)
    return first, unclear


def _first_within(dx: np.ndarray, dy: np.ndarray, radius: np.ndarray) -> Crossings:
    """Where paths, given from the middle of a round feature, come within ``radius`` of it."""
    first, unclear = np.full(len(radius), np.inf), np.zeros(len(radius), dtype=bool)
    apart = (dx.min(axis=0) > radius) | (dx.max(axis=0) < -radius)
    apart |= (dy.min(axis=0) > radius) | (dy.max(axis=0) < -radius)
    # all control points are beyond a tangent of the circle: no touch
    mx, my = dx[len(dx) // 2], dy[len(dy) // 2]
    length = np.hypot(mx, my)
    apart |= (length > radius) & ((dx * mx + dy * my).min(axis=0) > radius * length)
    some = np.flatnonzero(~apart)
    if len(some):
        radius = radius[some]
        gap = (squared_length(dx[:, some], dy[:, some]) - radius * radius) / (2.0 * radius)
        first[some], unclear[some] = _closing(gap, np.ones(len(some), dtype=bool))
    return first, unclear


def _closing(gap: np.ndarray, starts_touching: np.ndarray) -> Crossings:
    """When gaps close. One that is closed at the start, within rounding, counts only if it closes further."""
    starts_closed = starts_touching & (gap[0] <= NOISE)
    u, unclear = first_downward_crossing(gap)
    if starts_closed.any():
        opening = np.array(without_root_at_start(gap[:, starts_closed] - gap[0, starts_closed]))
        u[starts_closed], doubtful = first_downward_crossing(opening + NOISE)
        unclear[starts_closed] = doubtful | (opening[0] < -NOISE)
    return u, unclear
