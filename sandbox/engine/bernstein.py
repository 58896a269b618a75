"""Polynomials on [0, 1] in Bernstein form: bounds for free, and no root missed.

A polynomial ``f(u) = sum_k b[k] C(n, k) u**k (1 - u)**(n - k)`` lies between the smallest and the largest of its
coefficients, and has at most as many roots in (0, 1) as they change sign (Descartes' rule). So if all
coefficients of a distance are positive, the path provably touches nothing; otherwise halving the interval isolates
each root.

Source: Farin, Curves and Surfaces for CAGD, 5th ed., chapters 4 to 6.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import comb
from typing import Any

#: After a Newton step shorter than this, the error is its square times a moderate factor, which is rounding.
CONVERGED = 1e-12

#: Deepest halving of [0, 1]: two roots closer than 2**-40 of the interval count as a touch without crossing.
_DEEPEST = 40


@lru_cache
def binomials(n: int) -> list[int]:
    """C(n, 0) to C(n, n)."""
    return [comb(n, k) for k in range(n + 1)]


def evaluate(b: Sequence[float], u: float) -> float:
    """f(u), by Horner's rule in u / (1 - u) or its inverse, whichever is at most 1.

    Written out for the degrees of positions and velocities, which a run needs most: three times as fast as a loop.
    """
    n = len(b) - 1
    w = 1.0 - u
    if u > w:
        b, u, w = b[::-1], w, u
    r = u / w
    if n == 5:
        b0, b1, b2, b3, b4, b5 = b
        return (((((b5 * r + 5 * b4) * r + 10 * b3) * r + 10 * b2) * r + 5 * b1) * r + b0) * w**5
    if n == 4:
        b0, b1, b2, b3, b4 = b
        return ((((b4 * r + 4 * b3) * r + 6 * b2) * r + 4 * b1) * r + b0) * w**4
    return _horner([m * c for m, c in zip(binomials(n), b, strict=True)][::-1], r) * w**n


def _horner(scaled: Sequence[float], r: float) -> float:
    value = 0.0
    for c in scaled:
        value = value * r + c
    return value


def until(b: Sequence[Any], u: Any) -> list[Any]:
    """Coefficients on [0, u], by de Casteljau; of one polynomial, or of many with arrays as coefficients."""
    w, left = 1.0 - u, list(b)
    for level in range(1, len(left)):
        for k in range(len(left) - 1, level - 1, -1):
            left[k] = w * left[k - 1] + u * left[k]
    return left


def after(b: Sequence[float], u: float) -> list[float]:
    """Coefficients on [u, 1]."""
    w, right = 1.0 - u, list(b)
    for level in range(len(right) - 1, 0, -1):
        for k in range(level):
            right[k] = w * right[k] + u * right[k + 1]
    return right


def piece(b: Sequence[float], u0: float, u1: float) -> Sequence[float]:
    """Coefficients on [u0, u1]."""
    if u1 < 1.0:
        b = until(b, u1)
        u0 = u0 / u1
    if u0 > 0.0:
        b = after(b, u0)
    return b


def derivative(b: Sequence[float]) -> list[float]:
    """Coefficients of df/du."""
    n = len(b) - 1
    return [n * (b[k + 1] - b[k]) for k in range(n)] or [0.0]


def elevate(b: Sequence[Any], degree: int) -> Sequence[Any]:
    """The same polynomial at a higher degree; or many, with arrays as coefficients."""
    while len(b) - 1 < degree:
        n = len(b)
        b = [b[0], *((k * b[k - 1] + (n - k) * b[k]) / n for k in range(1, n)), b[-1]]
    return b


@lru_cache
def _square_weights(n: int) -> list[list[tuple[int, int, float]]]:
    """For each coefficient k of the square of a polynomial: which b[i] b[j] contribute, and with what weight."""
    rows: list[list[tuple[int, int, float]]] = [[] for _ in range(2 * n + 1)]
    for i in range(n + 1):
        for j in range(i, n + 1):
            both = 1 if i == j else 2  # b[i] b[j] and b[j] b[i]
            rows[i + j].append((i, j, both * comb(n, i) * comb(n, j) / comb(2 * n, i + j)))
    return rows


def squared_length(x: Sequence[float], y: Sequence[float]) -> list[float]:
    """Coefficients of x^2 + y^2."""
    rows = _square_weights(len(x) - 1)
    return [sum([weight * (x[i] * x[j] + y[i] * y[j]) for i, j, weight in row]) for row in rows]


def without_root_at_start(b: Sequence[Any]) -> list[Any]:
    """Coefficients of f(u) / u, where f(0) is taken as exactly zero; of one polynomial or of many."""
    n = len(b) - 1
    return [b[k + 1] * n / (k + 1) for k in range(n)]


def downward_crossings(b: Sequence[float]) -> Iterator[float]:
    """Every u in [0, 1] where f goes from positive to negative, in ascending order."""
    if min(b) > 0.0 or max(b) <= 0.0:
        return
    yield from _crossings(list(b), 0.0, 1.0, 0)


def _crossings(b: list[float], u0: float, u1: float, depth: int) -> Iterator[float]:
    changes = 0
    previous = b[0]
    for value in b:
        if value > 0.0:
            if previous < 0.0:
                changes += 1
            previous = value
        elif value < 0.0:
            if previous > 0.0:
                changes += 1
            previous = value
    if changes == 0:
        return
    if changes == 1:
        if previous < 0.0:  # it ends negative, so it started positive
            yield u0 + (u1 - u0) * _single_root(b)
        return
    if depth == _DEEPEST:
        if b[0] > 0.0 > b[-1]:
            yield u0
        return
    middle = 0.5 * (u0 + u1)
    left, right = until(b, 0.5), after(b, 0.5)
    yield from _crossings(left, u0, middle, depth + 1)
    if left[-1] == 0.0 and left[-2] > 0.0 > right[1]:  # the root is exactly at the split
        yield middle
    yield from _crossings(right, middle, u1, depth + 1)


def _single_root(b: list[float]) -> float:
    """The root of a polynomial with exactly one root in [0, 1], falling through it: Newton, kept inside a bracket."""
    n = len(b) - 1
    scaled = [m * c for m, c in zip(binomials(n), b, strict=True)]
    slopes = [m * c for m, c in zip(binomials(n - 1), derivative(b), strict=True)]
    backwards = scaled[::-1], slopes[::-1]
    low, high = 0.0, 1.0
    u = b[0] / (b[0] - b[-1]) if b[0] > 0.0 > b[-1] else 0.5
    for _ in range(100):
        w = 1.0 - u
        if u <= w:
            value, fall = _horner(backwards[0], u / w) * w, _horner(backwards[1], u / w)  # both over w^(n - 1)
        else:
            value, fall = _horner(scaled, w / u) * u, _horner(slopes, w / u)
        if value == 0.0 and fall < 0.0:
            return u
        if value < 0.0:
            high = u
        else:
            low = u
        following = u - value / fall if fall < 0.0 else low  # where it rises the root is only rounding
        if (fall < 0.0 and abs(following - u) <= CONVERGED) or high - low <= 1e-16:
            return min(max(following, low), high)
        if not low < following < high:
            following = 0.5 * (low + high)
        u = following
    return u
