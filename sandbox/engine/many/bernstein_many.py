"""The polynomials of bernstein.py for many paths at once.

Coefficients are along the first axis, paths along the last: shape (degree + 1, ..., paths); u has shape (paths,).
"""

from __future__ import annotations

from functools import lru_cache
from math import comb

import numpy as np

from sandbox.engine.paths.bernstein import CONVERGED, elevate, products, without_root_at_start

#: Bisections of a polynomial of which its signs do not tell how many roots it has.
_HALVINGS = 4

#: Most Newton steps to a root: four or five are typical, and bisection alone needs 53.
_MOST_STEPS = 60


def evaluate(b: np.ndarray, u: np.ndarray) -> np.ndarray:
    """f(u), shape (..., paths)."""
    n = len(b) - 1
    weights = _powers(u, n) * _binomials(n)
    found: np.ndarray = (b * weights.reshape(n + 1, *[1] * (b.ndim - 2), -1)).sum(axis=0)
    return found


def _powers(u: np.ndarray, n: int) -> np.ndarray:
    """u^k (1 - u)^(n - k) for k from 0 to n, shape (n + 1, paths)."""
    powers = np.ones((2, n + 1, len(u)))
    powers[0, 1:], powers[1, 1:] = u, 1.0 - u
    np.multiply.accumulate(powers, axis=1, out=powers)
    found: np.ndarray = powers[0] * powers[1, ::-1]
    return found


@lru_cache
def _binomials(n: int) -> np.ndarray:
    return np.array([comb(n, k) for k in range(n + 1)], float)[:, None]


def elevated(b: np.ndarray, degree: int) -> np.ndarray:
    """Return the same polynomials at a higher degree."""
    found: np.ndarray = _elevation(len(b) - 1, degree) @ b
    return found


@lru_cache
def _elevation(n: int, degree: int) -> np.ndarray:
    return np.array([elevate(one, degree) for one in np.eye(n + 1).tolist()]).T


def squared_length(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Coefficients of x^2 + y^2."""
    first, second, weights = _products(len(x))
    found: np.ndarray = weights @ (x[first] * x[second] + y[first] * y[second])
    return found


@lru_cache
def _products(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    first, second, weight = np.array(products(count)).T
    first, second = first.astype(int), second.astype(int)
    weights = np.zeros((2 * count - 1, len(weight)))
    weights[first + second, np.arange(len(weight))] = weight
    return first, second, weights


def without_root(b: np.ndarray) -> np.ndarray:
    """Coefficients of (f(u) - f(0)) / u, at the degree of f."""
    found: np.ndarray = _dividing(len(b) - 1) @ (b - b[0])
    return found


@lru_cache
def _dividing(n: int) -> np.ndarray:
    return np.array([without_root_at_start(one) for one in np.eye(n + 1).tolist()]).T


def first_part(b: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Coefficients on [0, u], by de Casteljau. A polynomial of a lower degree may come first in a longer column."""
    part, rest = b.copy(), 1.0 - u
    for level in range(1, len(b)):
        before = rest * part[level - 1 : -1]
        part[level:] *= u
        part[level:] += before
    return part


def first_downward_crossing(b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The u in [0, 1] where each f first goes from positive to negative, inf where none does; and a mask of
    those that are unclear. ``b`` has shape (degree + 1, paths); both arrays have shape (paths,)."""
    first, unclear = np.full(b.shape[1], np.inf), np.zeros(b.shape[1], dtype=bool)
    path, u, doubtful, start = downward_crossings(b)
    np.minimum.at(first, path, u)
    unclear[doubtful[start < first[doubtful]]] = True
    return first, unclear


def downward_crossings(b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The paths and the u in [0, 1] where f goes from positive to negative; and the pieces that are unclear: their
    paths, and the u where they start.

    A polynomial is clear if its coefficients change sign at most once and are never exactly zero, on [0, 1] or on its
    pieces after ``_HALVINGS`` bisections. ``b`` has shape (degree + 1, paths).
    """
    path, start, width = np.arange(b.shape[1]), np.zeros(b.shape[1]), 1.0  # of the pieces
    if not len(path):
        return path, start, path, start
    falling = []
    for halving in range(_HALVINGS + 1):
        positive = b > 0.0
        positive[0] |= (b[0] == 0.0) & positive[1]  # one that rises from zero does not cross it there
        changes = (positive[1:] != positive[:-1]).sum(axis=0)
        doubtful = (changes > 1) | ((changes > 0) & (b == 0.0).any(axis=0))
        falls = ((changes == 1) & ~positive[-1] & ~doubtful).nonzero()[0]
        falling.append((b[:, falls], path[falls], start[falls], np.full(len(falls), width)))
        some = doubtful.nonzero()[0]
        path, start = path[some], start[some]
        if not len(some) or halving == _HALVINGS:
            break
        width *= 0.5
        path, start = np.concatenate((path, path)), np.concatenate((start, start + width))
        b = (_halving(len(b) - 1) @ b[:, some]).reshape(2, len(b), -1).transpose(1, 0, 2).reshape(len(b), -1)
    pieces, whose, starts, widths = (np.concatenate(parts, axis=-1) for parts in zip(*falling, strict=True))
    return whose, starts + widths * _single_root(pieces), path, start


@lru_cache
def _halving(n: int) -> np.ndarray:
    """Return the matrix that makes the coefficients on [0, 1/2] and on [1/2, 1], shape (2 n + 2, n + 1)."""
    left = np.array([[comb(k, j) * 0.5**k for j in range(n + 1)] for k in range(n + 1)])
    return np.vstack((left, left[::-1, ::-1]))


@lru_cache
def _value_and_slope(n: int) -> np.ndarray:
    """Return the matrix that makes the factors of u^k (1 - u)^(n - k) in f and in df/du, shape (2 n + 2, n + 1)."""
    rise = np.zeros((n + 1, n + 1))
    for k in range(n + 1):  # the derivative's coefficients n (b[k + 1] - b[k]), elevated to degree n
        for at, share in ((k, k), (k + 1, n - k)):
            if share:
                rise[k, at] += share
                rise[k, at - 1] -= share
    return np.vstack((np.diag(np.ones(n + 1)), rise)) * np.tile(_binomials(n), (2, 1))


def _single_root(b: np.ndarray) -> np.ndarray:
    """The root of polynomials that fall through zero exactly once in [0, 1]: Newton, kept inside a bracket."""
    n, paths = len(b) - 1, b.shape[1]
    if not paths:
        return np.zeros(0)
    low, high = np.zeros(paths), np.ones(paths)
    both = (_value_and_slope(n) @ b).reshape(2, n + 1, paths)
    falls = (b > 0.0).argmin(axis=0)  # the first coefficient below zero: the control polygon falls just before
    above, below = b[falls - 1, np.arange(paths)], b[falls, np.arange(paths)]
    u = (falls - below / (below - above)) / n
    near = np.zeros(paths, dtype=bool)
    for _ in range(_MOST_STEPS):
        value, fall = (both * _powers(u, n)).sum(axis=1)
        above = value >= 0.0
        low, high = np.where(above, u, low), np.where(above, high, u)
        following = u - value / fall
        inside = (fall < 0.0) & (low <= following) & (following <= high)  # where it rises the root is only rounding
        before, u = u, np.where(near, u, np.where(inside, following, 0.5 * (low + high)))
        near |= (inside & (np.abs(following - before) <= CONVERGED)) | (high - low <= 1e-16)
        if near.all():
            break
    return u
