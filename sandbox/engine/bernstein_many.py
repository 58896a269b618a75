"""The polynomials of bernstein.py for many paths at once.

Coefficients are along the first axis, paths along the last: shape (degree + 1, ..., paths); u has shape (paths,).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from sandbox.engine.bernstein import CONVERGED, binomials

#: Most Newton steps to a root: four or five are typical, and bisection alone needs 53.
_MOST_STEPS = 60


def evaluate(b: np.ndarray, u: np.ndarray) -> np.ndarray:
    """f(u), shape (..., paths)."""
    n = len(b) - 1
    return _summed(_scaled(b), _powers(u, n), _powers(1.0 - u, n))


def _scaled(b: np.ndarray) -> np.ndarray:
    """Coefficients times their binomials."""
    return np.array(binomials(len(b) - 1), float).reshape(-1, *[1] * (b.ndim - 1)) * b


def _powers(u: np.ndarray, n: int) -> np.ndarray:
    """u^0 to u^n, shape (n + 1, paths)."""
    powers = np.ones((n + 1, len(u)))
    for k in range(n):
        np.multiply(powers[k], u, out=powers[k + 1])
    return powers


def _summed(scaled: np.ndarray, powers: np.ndarray, backwards: np.ndarray) -> np.ndarray:
    """f from scaled coefficients, and the powers of u and of 1 - u at least up to its degree."""
    n = len(scaled) - 1
    weights = powers[: n + 1] * backwards[n::-1]
    found: np.ndarray = (scaled * weights.reshape(n + 1, *[1] * (scaled.ndim - 2), -1)).sum(axis=0)
    return found


def squared_length(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Coefficients of x^2 + y^2, shape (2 degree + 1, paths)."""
    m = len(x)
    products = x[:, None] * x[None, :] + y[:, None] * y[None, :]
    return _product_weights(m - 1) @ products.reshape(m * m, -1)


@lru_cache
def _product_weights(n: int) -> np.ndarray:
    c, d = binomials(n), binomials(2 * n)
    weights = np.zeros((2 * n + 1, n + 1, n + 1))
    for i in range(n + 1):
        for j in range(n + 1):
            weights[i + j, i, j] = c[i] * c[j] / d[i + j]
    return weights.reshape(2 * n + 1, -1)


def first_downward_crossing(b: np.ndarray, halvings: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """The u in [0, 1] where each f first goes from positive to negative, inf where none does; and a mask of
    those that are unclear.

    A polynomial is clear if its coefficients change sign at most once and are never exactly zero, on [0, 1] or on its
    pieces after ``halvings`` bisections. ``b`` has shape (degree + 1, paths); both arrays have shape (paths,).
    """
    u = np.full(b.shape[1], np.inf)
    positive = b > 0.0
    changes = (positive[1:] != positive[:-1]).sum(axis=0)
    unclear = (changes > 1) | ((b == 0.0).any(axis=0) & (changes > 0))
    falling = np.flatnonzero((changes == 1) & ~positive[-1] & ~unclear)
    if len(falling):
        u[falling] = _single_root(b[:, falling])
    some = np.flatnonzero(unclear)
    if len(some) and halvings:
        early, late = _halves(b[:, some])
        u1, unclear1 = first_downward_crossing(early, halvings - 1)
        u2, unclear2 = first_downward_crossing(late, halvings - 1)
        u[some] = np.where(np.isfinite(u1), 0.5 * u1, 0.5 + 0.5 * u2)
        unclear[some] = unclear1 | (np.isinf(u1) & unclear2)
    return u, unclear


def _halves(b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients on [0, 1/2] and on [1/2, 1]."""
    left, right = np.empty_like(b), np.empty_like(b)
    left[0], right[-1] = b[0], b[-1]
    for k in range(1, len(left)):
        b = 0.5 * (b[:-1] + b[1:])
        left[k], right[-1 - k] = b[0], b[-1]
    return left, right


def _single_root(b: np.ndarray) -> np.ndarray:
    """The root of polynomials that fall through zero exactly once in [0, 1]: Newton, kept inside a bracket."""
    low, high = np.zeros(b.shape[1]), np.ones(b.shape[1])
    n = len(b) - 1
    scaled, slope = _scaled(b), _scaled(n * (b[1:] - b[:-1]))
    u = b[0] / (b[0] - b[-1])
    near = np.zeros(b.shape[1], dtype=bool)
    for _ in range(_MOST_STEPS):
        powers = _powers(u, n), _powers(1.0 - u, n)
        value, fall = _summed(scaled, *powers), _summed(slope, *powers)
        low, high = np.where(value >= 0.0, u, low), np.where(value < 0.0, u, high)
        before, following = u, u - value / fall
        falls = fall < 0.0  # where it rises the root is only rounding
        inside = falls & (low <= following) & (following <= high)
        u = np.where(near, u, np.where(inside, following, 0.5 * (low + high)))
        near |= (inside & (np.abs(following - before) <= CONVERGED)) | (high - low <= 1e-16)
        if near.all():
            break
    return u
