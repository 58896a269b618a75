"""Where many shots touch fixed shapes: touch.py's distances, in arrays.

What is plain (nothing near, or one crossing) is settled here for all shots at once; anything else is left to
``Obstacle.first_touch``, pair by pair.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from sandbox.engine.accuracy import SKIN
from sandbox.engine.arc import Arc
from sandbox.engine.bernstein_many import evaluate, first_downward_crossing, squared_length, without_root_at_start
from sandbox.engine.setup import Circle, Setup
from sandbox.engine.touch import CONTACT, NOISE, Obstacle

#: First crossing of each path, and where it is not plain; both of shape (paths,).
Crossings = tuple[np.ndarray, np.ndarray]


class Nearest(NamedTuple):
    """What touches each of some balls; arrays of shape (balls,)."""

    touching: np.ndarray  # how many surfaces
    obstacle: np.ndarray  # the nearest surface, by its place in the setup
    gap: np.ndarray  # m, to it
    nx: np.ndarray  # unit normal from it to the ball
    ny: np.ndarray
    curvature: np.ndarray  # 1/m, of the path of a ball that stays in touch with it


class Outlines:
    """The surfaces of shots, each prepared for its ball; as many for every shot, and of the same kinds.

    Inside, arrays have shape (surfaces, shots).
    """

    def __init__(self, setups: Sequence[Setup], skin: float = SKIN) -> None:
        self._setups = setups
        self._skin = skin
        places = [
            [
                (*shape.center, *shape.center, shape.radius + setup.balls[0].radius)
                if isinstance(shape, Circle)
                else (*shape.a, *shape.b, shape.radius + setup.balls[0].radius)
                for shape in (surface.shape for surface in setup.surfaces)
            ]
            for setup in setups
        ]
        table = np.array(places).reshape(len(setups), -1, 5).transpose(2, 1, 0)
        self._ax, self._ay, self._bx, self._by, self._reach = np.ascontiguousarray(table)
        self._length = np.hypot(self._bx - self._ax, self._by - self._ay)
        self._round = self._length == 0.0
        over = np.where(self._round, 1.0, self._length)
        self._tx = np.where(self._round, 1.0, (self._bx - self._ax) / over)
        self._ty = (self._by - self._ay) / over
        margin = self._reach + CONTACT
        self._left, self._right = np.minimum(self._ax, self._bx) - margin, np.maximum(self._ax, self._bx) + margin
        self._bottom, self._top = np.minimum(self._ay, self._by) - margin, np.maximum(self._ay, self._by) + margin
        self._obstacles: dict[tuple[int, int], Obstacle] = {}

    def near(self, shots: np.ndarray, x: np.ndarray, y: np.ndarray) -> Nearest:
        """What touches the balls of these shots, centred at x and y (m)."""
        ax, ay, tx, ty, length = (part[:, shots] for part in (self._ax, self._ay, self._tx, self._ty, self._length))
        along = (x - ax) * tx + (y - ay) * ty
        beside = (along >= 0.0) & (along <= length) & ~self._round[:, shots]
        dx = x - np.where(along > length, self._bx[:, shots], ax)
        dy = y - np.where(along > length, self._by[:, shots], ay)
        across = (y - ay) * tx - (x - ax) * ty
        side = np.where(across >= 0.0, 1.0, -1.0)
        distance = np.where(beside, side * across, np.hypot(dx, dy))
        gap = distance - self._reach[:, shots]
        nearest = gap.argmin(axis=0)
        pick = (nearest, np.arange(len(shots)))
        nx = np.where(beside, -side * ty, dx / distance)[pick]
        ny = np.where(beside, side * tx, dy / distance)[pick]
        curvature = np.where(beside, 0.0, 1.0 / self._reach[:, shots])[pick]
        return Nearest((gap <= CONTACT).sum(axis=0), nearest, gap[pick], nx, ny, curvature)

    def first_touch(
        self, shots: np.ndarray, x: np.ndarray, y: np.ndarray, arc: Callable[[int], Arc]
    ) -> tuple[np.ndarray, np.ndarray]:
        """The first u in [0, 1] at which each shot's path touches anything, inf where it does not, and how many
        surfaces were looked at; both of shape (paths,).

        ``x`` and ``y`` are coefficients in m, shape (6, paths), and ``arc(i)`` is the i-th of these paths.
        """
        touch = np.full(len(shots), np.inf)
        what, path = np.nonzero(
            (x.min(axis=0) <= self._right[:, shots])
            & (x.max(axis=0) >= self._left[:, shots])
            & (y.min(axis=0) <= self._top[:, shots])
            & (y.max(axis=0) >= self._bottom[:, shots])
        )
        if len(path):
            at, xs, ys = (what, shots[path]), x[:, path], y[:, path]
            u, unclear = _round(xs - self._ax[at], ys - self._ay[at], self._reach[at] - self._skin)
            straight = np.flatnonzero(~self._round[at])
            if len(straight):
                some = (what[straight], shots[path[straight]])
                radius = self._reach[some] - self._skin
                corner = _round(xs[:, straight] - self._bx[some], ys[:, straight] - self._by[some], radius)
                for other, doubtful in (corner, self._side(some, xs[:, straight], ys[:, straight])):
                    u[straight] = np.minimum(u[straight], other)
                    unclear[straight] |= doubtful
            for pair in np.flatnonzero(unclear).tolist():
                found = self._obstacle(int(what[pair]), int(shots[path[pair]])).first_touch(arc(int(path[pair])))
                u[pair] = np.inf if found is None else found
            np.minimum.at(touch, path, u)
        return touch, np.bincount(path, minlength=len(shots))

    def _obstacle(self, surface: int, shot: int) -> Obstacle:
        key = (surface, shot)
        if key not in self._obstacles:
            setup = self._setups[shot]
            self._obstacles[key] = Obstacle(setup.surfaces[surface], setup.balls[0].radius, self._skin)
        return self._obstacles[key]

    def _side(self, at: tuple[np.ndarray, np.ndarray], x: np.ndarray, y: np.ndarray) -> Crossings:
        ax, ay, tx, ty, reach = self._ax[at], self._ay[at], self._tx[at], self._ty[at], self._reach[at]
        dx, dy = x - ax, y - ay
        across = dy * tx - dx * ty
        along = dx * tx + dy * ty
        length = self._length[at]
        first, unclear = np.full(len(reach), np.inf), np.zeros(len(reach), dtype=bool)
        within = (along[0] >= -CONTACT) & (along[0] <= length + CONTACT)
        reached = (across.min(axis=0) <= reach) & (across.max(axis=0) >= -reach)
        for side in (1.0, -1.0):
            gap = side * across - reach + self._skin
            beside = side * across[0] > 0.0
            some = np.flatnonzero(reached & ((gap.max(axis=0) > -NOISE) | beside))
            if not len(some):
                continue
            gap = gap[:, some]
            u, doubtful = _closing(gap, (within & beside)[some])
            there = evaluate(along[:, some], np.where(np.isfinite(u), u, 0.0))
            missed = np.isfinite(u) & ((there < 0.0) | (there > length[some]))
            u[missed] = np.inf
            positive = gap > 0.0
            again = (positive[1:] != positive[:-1]).sum(axis=0) > 1  # perhaps: having passed beyond the side's end
            first[some] = np.minimum(first[some], u)
            unclear[some] |= doubtful | (missed & (again | (gap[0] <= NOISE)))
        return first, unclear


def _round(dx: np.ndarray, dy: np.ndarray, radius: np.ndarray) -> Crossings:
    """Where paths, given from the middle of a round feature, come within ``radius`` of it."""
    first, unclear = np.full(len(radius), np.inf), np.zeros(len(radius), dtype=bool)
    apart = (dx.min(axis=0) > radius) | (dx.max(axis=0) < -radius)
    apart |= (dy.min(axis=0) > radius) | (dy.max(axis=0) < -radius)
    # the control points all lie beyond a tangent of the circle: no touch
    mx, my = dx[len(dx) // 2], dy[len(dy) // 2]
    length = np.hypot(mx, my)
    apart |= (length > radius) & ((dx * mx + dy * my).min(axis=0) > radius * length)
    some = np.flatnonzero(~apart)
    if len(some):
        radius = radius[some]
        gap = (squared_length(dx[:, some], dy[:, some]) - radius * radius) / (2.0 * radius)
        first[some], unclear[some] = _closing(gap, np.ones(len(some), dtype=bool))
    return first, unclear


def _closing(gap: np.ndarray, starts_beside: np.ndarray) -> Crossings:
    """When gaps close. One that is closed at the start, within rounding, counts only if it closes further."""
    starts_closed = starts_beside & (gap[0] <= NOISE)
    u, unclear = first_downward_crossing(gap)
    if starts_closed.any():
        opening = without_root_at_start(gap[:, starts_closed] - gap[0, starts_closed])
        u[starts_closed], doubtful = first_downward_crossing(opening + NOISE)
        unclear[starts_closed] = doubtful | (opening[0] < -NOISE)
    return u, unclear
