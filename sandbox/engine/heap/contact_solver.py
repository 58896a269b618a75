"""Impulses of many contacts at once, solved directly: for heaps whose masses differ so much that iterations do not end.

Each contact has an impulse P >= 0 along its normal and a friction of at most mu P. With v the speeds at the contacts,
``v = A z + b`` and z all impulses, this is a linear complementarity problem: P > 0 only where the bodies would close,
friction below its bound only where they do not slip. For given bounds of friction it is convex, has one result, and
that never adds energy: ``z v <= 0``. The bounds are found by repetition (Kaufman et al. 2008, ACM Trans. Graph. 27:164,
staggered projections). Where it does not converge, friction is a share off; energy and non-penetration are still right.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sandbox.engine.model.shapes import Vector

#: Share of the diagonal that is added to it, so that contacts at both ends of a side have one result. Larger: bodies
#: creep into each other; smaller: rounding decides how a load is shared.
_REGULAR = 1e-11

#: Share of the largest impulse or speed below which it is rounding.
_ROUNDING = 1e-9

#: Most repetitions for the bounds of friction, and change of an impulse, as a share of the largest, that ends them.
_ROUNDS, _SAME = 40, 1e-4

#: Attempts at changing all contacts that are wrong before they are changed one by one, and most changes.
_ATTEMPTS, _MOST = 8, 400


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
        self._brakes = np.array([body.brake for body in bodies])
        self._friction = np.array([point.friction for point in points])
        self._velocity = np.array([body.velocity for body in bodies]).ravel()
        inverse = np.array([(body.inverse_mass, body.inverse_mass, body.inverse_inertia) for body in bodies]).ravel()
        rows = np.zeros((2 * len(points) + len(bodies), 3 * len(bodies)))  # speeds of parting, of slip, of rotation
        for number, (first, second, (x, y), (nx, ny), *_) in enumerate(points):
            for index, way in ((first, -1.0), (second, 1.0)):
                if index is not None:
                    dx, dy, at = x - bodies[index].x, y - bodies[index].y, slice(3 * index, 3 * index + 3)
                    rows[number, at] = way * nx, way * ny, way * (dx * ny - dy * nx)
                    rows[self._count + number, at] = -way * ny, way * nx, way * (dx * nx + dy * ny)
        for index in range(len(bodies)):
            rows[2 * self._count + index, 3 * index + 2] = 1.0
        self._rows, self._moved = rows, inverse[:, None] * rows.T
        matrix = rows @ self._moved
        self._scale = 1.0 / np.sqrt(np.diag(matrix))
        self._matrix = self._scale[:, None] * matrix * self._scale  # with ones on the diagonal
        self._matrix[np.diag_indices_from(matrix)] += _REGULAR

    def impulses(self, partings: Sequence[float], guess: Sequence[float]) -> tuple[Motions, list[float]]:
        """The velocities in m/s and rad/s after impulses with which the points part at these speeds (m/s) at least, and
        the normal impulses in N s, of which a guess is given."""
        count = self._count
        speeds, pushes = self._rows @ self._velocity, np.array(guess)
        speeds[:count] -= partings
        high = np.concatenate([np.full(count, np.inf), np.zeros(count), self._brakes])
        low = np.concatenate([np.zeros(count), np.zeros(count), -self._brakes])
        states = np.where(np.concatenate([pushes > 0.0, self._friction * pushes > 0.0, self._brakes > 0.0]), 0, -1)
        for _ in range(_ROUNDS):
            bounds = self._friction * pushes
            high[count : 2 * count], low[count : 2 * count] = bounds, -bounds
            states[count : 2 * count] = np.where(bounds > 0.0, states[count : 2 * count], -1)
            found, states = complementary(self._matrix, self._scale, speeds, low, high, states)
            before, pushes = pushes, found[:count]
            if (self._friction * np.abs(pushes - before)).max() <= _SAME * pushes.max():
                break
        after = self._velocity + self._moved @ found
        return after.reshape(-1, 3).tolist(), pushes.tolist()

    def moved_apart(self, depths: Sequence[float]) -> Motions:
        """The least movement, in m and rad, that takes the points apart by these depths (m)."""
        count = self._count
        low, high, states = np.zeros(count), np.full(count, np.inf), np.where(np.array(depths) > 0.0, 0, -1)
        found, _ = complementary(
            self._matrix[:count, :count], self._scale[:count], -np.array(depths), low, high, states
        )
        return (self._moved[:, :count] @ found).reshape(-1, 3).tolist()


def complementary(
    matrix: np.ndarray, scale: np.ndarray, offset: np.ndarray, low: np.ndarray, high: np.ndarray, states: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The z between ``low`` and ``high`` for which ``A z + offset`` is zero where z is between them, not negative
    where it is low and not positive where it is high; and the states: 0 between, -1 low, 1 high, of which a guess is
    given. ``matrix`` is ``scale A scale``.

    By block principal pivoting (Judice & Pires 1994, Comput. Oper. Res. 21:587).
    """
    offset, low, high, states = scale * offset, low / scale, high / scale, states.copy()
    little = _ROUNDING * np.abs(offset).max()
    fewest, attempts = len(offset) + 1, _ATTEMPTS
    for _ in range(_MOST):
        between = np.flatnonzero(states == 0)
        found = np.where(states > 0, high, low)
        found[between] = 0.0
        found[between] = np.linalg.solve(matrix[np.ix_(between, between)], -(offset + matrix @ found)[between])
        rest = matrix @ found + offset
        too_low, too_high = (states == 0) & (found < low - little), (states == 0) & (found > high + little)
        freed = ((states < 0) & (rest < -little) & (high > low)) | ((states > 0) & (rest > little))
        wrong = np.flatnonzero(too_low | too_high | freed)
        if len(wrong) == 0:
            break
        if len(wrong) < fewest:
            fewest, attempts = len(wrong), _ATTEMPTS
        elif attempts > 0:
            attempts -= 1
        else:
            wrong = wrong[-1:]
        states[wrong] = np.where(too_low, -1, np.where(too_high, 1, 0))[wrong]
    return scale * np.clip(found, low, high), states
