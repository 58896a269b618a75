"""Polynomials on [0, 1] in Bernstein form: bounds for free, and no root missed.

A polynomial ``f(u) = sum_k b[k] C(n, k) u**k (1 - u)**(n - k)`` lies between the smallest and the largest of its
coefficients, and has at most as many roots in (0, 1) as they change sign (Descartes' rule). So if all
coefficients of a distance are positive, the path provably touches nothing; otherwise halving the interval isolates
each root.

Source: Farin, Curves and Surfaces for CAGD, 5th ed., chapters 4 to 6.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from math import comb

#: After a Newton step shorter than this, the error is its square times a moderate factor, which is rounding.
CONVERGED = 1e-12

#: Deepest halving of [0, 1]: two roots closer than 2**-40 of the interval count as a touch without crossing.
_DEEPEST = 40


def evaluate(b: Sequence[float], u: float) -> float:
    """Return f(u), by Horner's rule in u / (1 - u) or its inverse, whichever is at most 1."""
    w = 1.0 - u
    if u <= w:
        return _horner(b[::-1], u / w) * w ** (len(b) - 1)
    return _horner(b, w / u) * u ** (len(b) - 1)


def _horner(b: Sequence[float], r: float) -> float:
    """Return sum_k C(n, k) b[k] r^(n - k). The degrees of a ball's spin, velocity and position are written out: most
    are of these."""
    match len(b):
        case 6:
            return ((((b[0] * r + 5.0 * b[1]) * r + 10.0 * b[2]) * r + 10.0 * b[3]) * r + 5.0 * b[4]) * r + b[5]
        case 5:
            return (((b[0] * r + 4.0 * b[1]) * r + 6.0 * b[2]) * r + 4.0 * b[3]) * r + b[4]
        case 4:
            return ((b[0] * r + 3.0 * b[1]) * r + 3.0 * b[2]) * r + b[3]
    value = 0.0
    for binomial, coefficient in zip(_binomials(len(b) - 1), b, strict=False):
        value = value * r + binomial * coefficient
    return value


@cache
def _binomials(n: int) -> Sequence[float]:
    """Return C(n, k) for k from 0 to n."""
    return [float(comb(n, k)) for k in range(n + 1)]


def first_part(b: Sequence[float], u: float) -> list[float]:
    """Return the coefficients on [0, u], by de Casteljau: each level takes the weighted mean of neighbours in the level
    before, and the first of each level is a coefficient."""
    w, degree = 1.0 - u, len(b) - 1
    if 3 <= degree <= 5:  # as those of a ball's path, written out: a coefficient depends only on those before it
        b0, b1, b2, b3, b4, b5 = (*b, 0.0, 0.0, 0.0, 0.0, 0.0)[:6]
        b1, b2, b3, b4, b5 = w * b0 + u * b1, w * b1 + u * b2, w * b2 + u * b3, w * b3 + u * b4, w * b4 + u * b5
        b2, b3, b4, b5 = w * b1 + u * b2, w * b2 + u * b3, w * b3 + u * b4, w * b4 + u * b5
        b3, b4, b5 = w * b2 + u * b3, w * b3 + u * b4, w * b4 + u * b5
        b4, b5 = w * b3 + u * b4, w * b4 + u * b5
        return [b0, b1, b2, b3, b4, w * b4 + u * b5][: degree + 1]
    left = list(b)
    for level in range(1, degree + 1):
        for k in range(degree, level - 1, -1):
            left[k] = w * left[k - 1] + u * left[k]
    return left


def last_part(b: Sequence[float], u: float) -> list[float]:
    """Return the coefficients on [u, 1], which are the last of each level."""
    w, right, degree = 1.0 - u, list(b), len(b) - 1
    for level in range(degree, 0, -1):
        for k in range(level):
            right[k] = w * right[k] + u * right[k + 1]
    return right


def piece(b: Sequence[float], u0: float, u1: float) -> Sequence[float]:
    """Return the coefficients on [u0, u1]."""
    if u1 < 1.0:
        b = first_part(b, u1)
        u0 = u0 / u1
    if u0 > 0.0:
        b = last_part(b, u0)
    return b


def derivative(b: Sequence[float]) -> list[float]:
    """Return the coefficients of df/du."""
    n = len(b) - 1
    return [n * (b[k + 1] - b[k]) for k in range(n)] or [0.0]


def elevate(b: Sequence[float], degree: int) -> Sequence[float]:
    """Return the same polynomial at a higher degree."""
    while len(b) - 1 < degree:
        n = len(b)
        b = [b[0], *((k * b[k - 1] + (n - k) * b[k]) / n for k in range(1, n)), b[-1]]
    return b


def squared_length(x: Sequence[float], y: Sequence[float]) -> list[float]:
    """Return the coefficients of x^2 + y^2."""
    square = [0.0] * (2 * len(x) - 1)
    for i, j, weight in products(len(x)):
        square[i + j] += weight * (x[i] * x[j] + y[i] * y[j])
    return square


@cache
def products(count: int) -> Sequence[tuple[int, int, float]]:
    """Return each i and j, and the weight of b[i] b[j] in the (i + j)-th coefficient of the square of f."""
    n = count - 1
    return [
        (i, j, (1 if i == j else 2) * comb(n, i) * comb(n, j) / comb(2 * n, i + j))  # b[i] b[j] and b[j] b[i]
        for i in range(count)
        for j in range(i, count)
    ]


def without_root_at_start(b: Sequence[float]) -> list[float]:
    """Return the coefficients of f(u) / u, where f(0) is taken as exactly zero."""
    n = len(b) - 1
    return [b[k + 1] * n / (k + 1) for k in range(n)]


def downward_crossings(b: Sequence[float]) -> Iterator[float]:
    """Yield every u in [0, 1] where f goes from positive to negative, in ascending order."""
    if min(b) > 0.0 or max(b) <= 0.0:
        return
    pieces = [(b, 0.0, 1.0, 0, False)]  # coefficients on [u0, u1], halvings so far, and True if f crosses zero at u0
    while pieces:
        b, u0, u1, depth, crosses_at_start = pieces.pop()
        if crosses_at_start:
            yield u0
        changes, last = _sign_changes(b)
        if changes == 1:
            if last < 0.0:  # it ends negative, so it started positive
                yield u0 + (u1 - u0) * _single_root(b)
        elif changes > 1 and depth == _DEEPEST:
            if b[0] > 0.0 > b[-1]:
                yield u0
        elif changes > 1:
            middle = 0.5 * (u0 + u1)
            left, right = first_part(b, 0.5), last_part(b, 0.5)
            pieces.append((right, middle, u1, depth + 1, left[-1] == 0.0 and left[-2] > 0.0 > right[1]))
            pieces.append((left, u0, middle, depth + 1, False))  # the next to be looked at


def _sign_changes(b: Sequence[float]) -> tuple[int, float]:
    """Return how often the coefficients change sign, and the last one that is not zero."""
    changes, last = 0, b[0]
    for value in b:
        if value > 0.0 > last or value < 0.0 < last:
            changes += 1
        if value != 0.0:
            last = value
    return changes, last


def _single_root(b: Sequence[float]) -> float:
    """Return the root of a polynomial with exactly one in [0, 1], where it falls: Newton, kept inside a bracket."""
    slopes, low, high = derivative(b), 0.0, 1.0
    back, slopes_back = b[::-1], slopes[::-1]
    u = b[0] / (b[0] - b[-1]) if b[0] > 0.0 > b[-1] else 0.5
    for _ in range(100):
        w = 1.0 - u  # f and df/du, both over w^(n - 1) or u^(n - 1)
        if u <= w:
            value, fall = _horner(back, u / w) * w, _horner(slopes_back, u / w)
        else:
            value, fall = _horner(b, w / u) * u, _horner(slopes, w / u)
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
