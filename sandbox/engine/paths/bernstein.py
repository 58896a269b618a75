"""Polynomials on [0, 1] in Bernstein form: bounds for free, and no root missed.

A polynomial ``f(u) = sum_k b[k] C(n, k) u**k (1 - u)**(n - k)`` lies between the smallest and the largest of its
coefficients, and has at most as many roots in (0, 1) as they change sign (Descartes' rule). So if all
coefficients of a distance are positive, the path provably touches nothing; otherwise halving the interval isolates
each root.

Source: Farin, Curves and Surfaces for CAGD, 5th ed., chapters 4 to 6.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from math import comb, inf
from typing import Any

from sandbox.engine.paths import quintic
from sandbox.physics.elementwise import remade

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
    if 3 <= degree <= 5:  # as those of a ball's path: a coefficient depends only on those before it
        return [*quintic.first_part((*b, 0.0, 0.0)[:6], u)[: degree + 1]]  # type: ignore[arg-type]
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


def without_root_at_start(b: Sequence[float]) -> Sequence[float]:
    """Return the coefficients of (f(u) - f(0)) / u, at the degree of f."""
    n = len(b) - 1
    return elevate([(b[k + 1] - b[0]) * n / (k + 1) for k in range(n)] or [0.0], n)


def plus(b: Sequence[float], c: float) -> Sequence[float]:
    """Return the coefficients of f(u) + c."""
    return [value + c for value in b]


def times(b: Sequence[float], c: float) -> Sequence[float]:
    """Return the coefficients of c f(u)."""
    return [c * value for value in b]


def moved(b: Sequence[float], c: float) -> Sequence[float]:
    """Return the coordinate of a path as seen from a place."""
    return [value - c for value in b]


def across(xs: Sequence[float], ys: Sequence[float], tx: float, ty: float) -> Sequence[float]:
    """Return the distance of a path from the line through 0 along (tx, ty), positive to its left."""
    return [y * tx - x * ty for x, y in zip(xs, ys, strict=True)]


def as_squared(b: Sequence[float]) -> Sequence[float]:
    """Return a distance as it can be compared with squared ones: those of a quintic path are of degree 10."""
    return b


def halves(b: Sequence[float]) -> tuple[Sequence[float], Sequence[float]]:
    """Return the coefficients on [0, 1/2] and on [1/2, 1]."""
    return first_part(b, 0.5), last_part(b, 0.5)


def downward_crossings(b: Sequence[float]) -> Iterator[float]:
    """Yield every u in [0, 1] where f goes from positive to negative, in ascending order."""
    u = crossing(b, -1.0)
    while u < inf:
        yield u
        u = crossing(b, u)


def crossing(b: Any, after: float) -> float:
    """The first u > ``after`` in [0, 1] where f goes from positive to negative, inf if there is none: halving isolates
    each root, from left to right.

    The piece looked at is the ``place``-th of 2**depth, found by halving anew: a path that comes so near to a root
    twice that signs do not tell them apart is rare, and no list is needed."""
    if min(b) > 0.0 or max(b) <= 0.0:
        return inf
    depth, place = 0, 0
    while True:
        part, wide, starts = b, 1.0, False
        for level in range(depth - 1, -1, -1):
            left, right = halves(part)
            wide *= 0.5
            if (place >> level) % 2 == 0:
                part, starts = left, False
            else:
                part, starts = right, left[-1] == 0.0 and left[-2] > 0.0 > right[1]
        u0 = place * wide
        if starts and u0 > after:
            return u0
        changes, last = _sign_changes(part)
        if changes == 1:
            if last < 0.0:  # it ends negative, so it started positive
                u = u0 + wide * _single_root(part)
                if u > after:
                    return u
        elif changes > 1 and depth == _DEEPEST:
            if part[0] > 0.0 > part[-1] and u0 > after:
                return u0
        elif changes > 1:
            depth, place = depth + 1, 2 * place
            continue
        while place % 2 == 1:  # on to the next piece
            depth, place = depth - 1, place // 2
        if depth == 0:
            return inf
        place += 1


def _sign_changes(b: Sequence[float]) -> tuple[int, float]:
    """Return how often the coefficients change sign, and the last one that is not zero."""
    changes, last = 0, b[0]
    for value in b:
        if value > 0.0 > last or value < 0.0 < last:
            changes += 1
        if value != 0.0:
            last = value
    return changes, last


def _single_root(b: Any) -> float:
    """Return the root of a polynomial with exactly one in [0, 1], where it falls: Newton, kept inside a bracket."""
    slopes, low, high = derivative(b), 0.0, 1.0
    back, slopes_back = b[::-1], slopes[::-1]
    u = b[0] / (b[0] - b[-1]) if b[0] > 0.0 > b[-1] else 0.5
    for _ in range(100):
        w = 1.0 - u  # f and df/du, both over w^(n - 1) or u^(n - 1)
        if u <= w:
            value, fall = _value_and_slope(back, slopes_back, u / w)
            value = value * w
        else:
            value, fall = _value_and_slope(b, slopes, w / u)
            value = value * u
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


def _value_and_slope(b: Sequence[float], slopes: Sequence[float], r: float) -> tuple[float, float]:
    """Return both as ``_horner`` does."""
    return _horner(b, r), _horner(slopes, r)


#: Functions of this module that quintic.py has written out for a path of degree 5, or its distances of degree 10.
_WRITTEN_OUT: dict[Callable[..., Any], Callable[..., Any]] = {
    evaluate: quintic.evaluate,
    derivative: quintic.derivative,
    squared_length: quintic.squared_length,
    without_root_at_start: quintic.without_root_at_start,
    plus: quintic.plus,
    times: quintic.times,
    moved: quintic.moved,
    across: quintic.across,
    as_squared: quintic.as_squared,
    halves: quintic.halves,
    _value_and_slope: quintic.value_and_slope,
}


def of_quintics(function: Any) -> Any:
    """Return a function of paths as it is for tuples of degree 5: the same code, with what is written out for them, as
    numba takes it."""
    return remade(function, _WRITTEN_OUT)
