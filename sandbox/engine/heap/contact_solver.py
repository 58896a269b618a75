"""Impulses of many contacts at once, for heaps whose masses differ so much that Chipmunk's iterations do not end.

Each contact has an impulse P >= 0 along its normal and a friction of at most mu P. With v the speeds at the contacts,
``v = A z + b`` and z all impulses, this is a complementarity problem: P > 0 only where the bodies would close, friction
below its bound only where they do not slip. Its solution is the z that stays as it is when a step against v takes it
back into its bounds: ``z = bounded(z - v)``, with ones on the diagonal of A.

Two methods take turns (Silcowitz, Niebe & Erleben 2010, projected Gauss-Seidel subspace minimization). The formula says
of each impulse whether it is at a bound: with these at their bounds, friction at mu P, the others are a linear system.
It ends at the solution once all are guessed right. Where that brings no progress, gradient steps with Nesterov's
momentum (Mazhar et al. 2015, ACM Trans. Graph. 34:32) get nearer from anywhere. Where neither comes to an end, as where
contacts share a load in many ways, what is left of the fastest approach is small, and energy is right as far as that.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sandbox.engine.model.shapes import Vector

#: Share of the diagonal that is added to it, so that contacts at both ends of a side have one result. Larger: bodies
#: creep into each other; smaller: rounding decides how a load is shared.
_REGULAR = 1e-11

#: Shares of the fastest approach: what is rounding, and what may be left where one of the methods has not got there.
_ROUNDING, _ENOUGH = 1e-9, 1e-6

#: Turns of the two methods, gradient steps in one, and the share of what was left that a linear system has to leave at
#: most for another. More: blows on large heaps take longer; fewer: they are less exact.
_TURNS, _STEPS, _PROGRESS = 8, 40, 0.5


class SolverBody(NamedTuple):
    """A ball or body in a heap, in the middle of a step."""

    x: float  # m
    y: float  # m
    inverse_mass: float  # 1/kg
    inverse_inertia: float  # 1/(kg m^2)
    velocity: tuple[float, float, float]  # m/s, m/s, rad/s, by forces alone
    brake: float  # N m s, the largest impulse of rolling resistance


class ContactPoint(NamedTuple):
    """A point of contact. The unit normal points from the first body to the second, or to what is fixed."""

    first: int  # index of a body
    second: int | None
    point: Vector  # m
    normal: Vector
    friction: float


#: Of each body: along x and y in m or m/s, and turning in rad or rad/s.
Motions = list[list[float]]


class Contacts:
    """The contacts of some bodies that touch one another, directly or through others."""

    def __init__(self, bodies: Sequence[SolverBody], points: Sequence[ContactPoint]) -> None:
        self._count = len(points)
        self._rubs = np.array([number for number, point in enumerate(points) if point.friction > 0.0], int)
        braked = [index for index, body in enumerate(bodies) if body.brake > 0.0]
        self._velocity = np.array([body.velocity for body in bodies]).ravel()
        inverse = np.array([(body.inverse_mass, body.inverse_mass, body.inverse_inertia) for body in bodies]).ravel()
        parting, slip = np.zeros((2, len(points), 3 * len(bodies)))
        for number, (first, second, (x, y), (nx, ny), _) in enumerate(points):
            for index, way in ((first, -1.0), (second, 1.0)):
                if index is not None:
                    dx, dy, at = x - bodies[index].x, y - bodies[index].y, slice(3 * index, 3 * index + 3)
                    parting[number, at] = way * nx, way * ny, way * (dx * ny - dy * nx)
                    slip[number, at] = -way * ny, way * nx, way * (dx * nx + dy * ny)
        turn = np.zeros((len(braked), 3 * len(bodies)))
        turn[range(len(braked)), [3 * index + 2 for index in braked]] = 1.0
        self._rows = np.concatenate([parting, slip[self._rubs], turn])
        self._moved = inverse[:, None] * self._rows.T
        matrix = self._rows @ self._moved
        self._scale = 1.0 / np.sqrt(np.diag(matrix))
        self._matrix = self._scale[:, None] * matrix * self._scale  # with ones on the diagonal
        self._matrix[np.diag_indices_from(matrix)] += _REGULAR
        friction = np.array([points[number].friction for number in self._rubs.tolist()])
        brakes = np.array([bodies[index].brake for index in braked])
        over, rubbing = self._scale[: self._count], self._scale[self._count : self._count + len(friction)]
        self._friction = friction * over[self._rubs] / rubbing
        self._brakes = brakes / self._scale[self._count + len(friction) :]

    def impulses(self, partings: Sequence[float], guess: Sequence[float]) -> tuple[Motions, list[float]]:
        """The velocities in m/s and rad/s after impulses with which the points part at these speeds (m/s) at least, and
        the normal impulses in N s, of which a guess is given."""
        speeds = self._rows @ self._velocity
        speeds[: self._count] -= partings
        bounds = Bounds(self._count, self._rubs, self._friction, self._brakes)
        start = np.zeros(len(speeds))
        start[: self._count] = np.array(guess) / self._scale[: self._count]
        found = self._scale * _complementary(self._matrix, self._scale * speeds, bounds, start)
        after = self._velocity + self._moved @ found
        return after.reshape(-1, 3).tolist(), found[: self._count].tolist()

    def moved_apart(self, depths: Sequence[float]) -> Motions:
        """The least movement, in m and rad, that takes the points apart by these depths (m)."""
        count, scale, none = self._count, self._scale[: self._count], np.zeros(0)
        bounds, deep = Bounds(count, np.zeros(0, int), none, none), np.array(depths)
        found = _complementary(self._matrix[:count, :count], -scale * deep, bounds, np.maximum(deep, 0.0))
        return (self._moved[:, :count] @ (scale * found)).reshape(-1, 3).tolist()


class Bounds(NamedTuple):
    """The bounds of impulses: so many ``normal`` ones, which are not negative; then friction of those in ``rubs``, up
    to a share of them; then others."""

    normal: int
    rubs: np.ndarray
    friction: np.ndarray
    most: np.ndarray

    def around(self, impulses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The least and the largest values, for the normal ones among these."""
        high = np.concatenate([self.friction * np.maximum(impulses[self.rubs], 0.0), self.most])
        return np.concatenate([np.zeros(self.normal), -high]), np.concatenate([np.full(self.normal, np.inf), high])

    def bounded(self, impulses: np.ndarray) -> np.ndarray:
        """These within their bounds."""
        return np.clip(impulses, *self.around(impulses))


def _complementary(matrix: np.ndarray, offset: np.ndarray, bounds: Bounds, start: np.ndarray) -> np.ndarray:
    """The z within its bounds for which ``A z + offset`` is zero where z is between them, not negative where it is low
    and not positive where it is high; a guess of it is given."""
    fastest, length = float(np.abs(offset).max()), 1.0 / np.abs(matrix).sum(axis=1).max()
    found = bounds.bounded(start)
    for _ in range(_TURNS):
        left = _left(matrix, offset, bounds, found)
        while left > _ROUNDING * fastest:
            next_found = bounds.bounded(_by_states(matrix, offset, bounds, found))
            next_left = _left(matrix, offset, bounds, next_found)
            if not next_left < _PROGRESS * left:
                break
            found, left = next_found, next_left
        if left <= _ENOUGH * fastest:
            break
        found = _descended(matrix, offset, bounds, found, length)
    return found


def _left(matrix: np.ndarray, offset: np.ndarray, bounds: Bounds, found: np.ndarray) -> float:
    """The distance of these impulses from the solution, as a speed."""
    return float(np.abs(found - bounds.bounded(found - matrix @ found - offset)).max())


def _by_states(matrix: np.ndarray, offset: np.ndarray, bounds: Bounds, found: np.ndarray) -> np.ndarray:
    """The solution if those are at a bound which seem so by these impulses."""
    count, rubs, friction, most = bounds
    wanted = found - matrix @ found - offset
    high = np.concatenate([friction * np.maximum(found[rubs], 0.0), most])
    state = np.concatenate([(wanted[:count] > 0.0) - 1, np.sign(wanted[count:]) * (np.abs(wanted[count:]) > high)])
    rubbing = slice(count, count + len(rubs))
    state[rubbing] = np.where(wanted[rubs] > 0.0, state[rubbing], 2)
    slides = np.flatnonzero(np.abs(state[rubbing]) == 1)
    free, fixed = np.flatnonzero(state == 0), np.zeros(len(found))
    fixed[count + len(rubs) :] = state[count + len(rubs) :] * most
    columns, share = matrix[:, free], state[count + slides] * friction[slides]
    columns[:, np.searchsorted(free, rubs[slides])] += matrix[:, count + slides] * share
    try:
        fixed[free] = np.linalg.solve(columns[free], -(matrix @ fixed + offset)[free])
    except np.linalg.LinAlgError:  # so much friction that it jams
        return found
    fixed[count + slides] = share * fixed[rubs[slides]]
    return fixed


def _descended(matrix: np.ndarray, offset: np.ndarray, bounds: Bounds, found: np.ndarray, length: float) -> np.ndarray:
    """The impulses after gradient steps of this length from these, with Nesterov's momentum."""
    ahead, weight = found, 1.0
    for _ in range(_STEPS):
        slope = matrix @ ahead + offset
        last, found = found, bounds.bounded(ahead - length * slope)
        moved = found - last
        if slope @ moved > 0.0:
            ahead, weight = found, 1.0
        else:
            grown = 0.5 + (0.25 + weight * weight) ** 0.5
            ahead, weight = found + (weight - 1.0) / grown * moved, grown
    return found
