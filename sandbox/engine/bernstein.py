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
from typing import Any

from sandbox.physics.straight import straight

#: After a Newton step shorter than this, the error is its square times a moderate factor, which is rounding.
CONVERGED = 1e-12

#: Deepest halving of [0, 1]: two roots closer than 2**-40 of the interval count as a touch without crossing.
_DEEPEST = 40


def evaluate(b: Sequence[float], u: float) -> float:
    """f(u), by Horner's rule in u / (1 - u) or its inverse, whichever is at most 1."""
    value: float = _written_out("evaluate", len(b))(b, u)
    return value


def until(b: Sequence[float], u: float) -> list[float]:
    """Coefficients on [0, u], by de Casteljau."""
    left: list[float] = _written_out("until", len(b))(b, u)
    return left


def after(b: Sequence[float], u: float) -> list[float]:
    """Coefficients on [u, 1]."""
    right: list[float] = _written_out("after", len(b))(b, u)
    return right


@cache
def _written_out(what: str, count: int) -> Any:
    """A function of a polynomial with so many coefficients, and of u, as straight Python."""
    n = count - 1
    names = _names("b", count)
    swap = ["if u > w:", "  b, d, u, w = b[::-1], d[::-1], w, u", "r = u / w", f"{names} = b"]
    part = [f"b{k} = w * b{k - 1} + u * b{k}" for level in range(1, count) for k in range(n, level - 1, -1)]
    rest = [f"b{k} = w * b{k} + u * b{k + 1}" for level in range(n, 0, -1) for k in range(level)]
    lines = {
        "evaluate": [*swap, f"return ({_horner('b', n)}) * w**{n}"],
        "value_and_slope": [*swap, f"{_names('d', n)} = d", f"return ({_horner('b', n)}) * w, {_horner('d', n - 1)}"],
        "until": [f"{names} = b", *part, f"return [{names}]"],
        "after": [f"{names} = b", *rest, f"return [{names}]"],
    }
    return straight(f"{what}(b, u, d=())", ["w = 1.0 - u", *lines[what]], __file__)


def _names(of: str, count: int) -> str:
    return ", ".join(f"{of}{k}" for k in range(count)) + ","


def _horner(of: str, n: int) -> str:
    """f over (1 - u)^n, with r = u / (1 - u)."""
    written = f"{of}{n}"
    for k in reversed(range(n)):
        written = f"({written}) * r + {comb(n, k)} * {of}{k}"
    return written


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


def elevate(b: Sequence[float], degree: int) -> Sequence[float]:
    """The same polynomial at a higher degree."""
    while len(b) - 1 < degree:
        n = len(b)
        b = [b[0], *((k * b[k - 1] + (n - k) * b[k]) / n for k in range(1, n)), b[-1]]
    return b


def squared_length(x: Sequence[float], y: Sequence[float]) -> list[float]:
    """Coefficients of x^2 + y^2."""
    squares: list[float] = _squares(len(x))(x, y)
    return squares


def products(count: int) -> Iterator[tuple[int, int, float]]:
    """Each i and j, and the weight of b[i] b[j] in the (i + j)-th coefficient of the square of f."""
    n = count - 1
    for i in range(count):
        for j in range(i, count):
            both = 1 if i == j else 2  # b[i] b[j] and b[j] b[i]
            yield i, j, both * comb(n, i) * comb(n, j) / comb(2 * n, i + j)


@cache
def _squares(count: int) -> Any:
    """The sum of the squares of two polynomials with so many coefficients, as straight Python."""
    rows: list[str] = [""] * (2 * count - 1)
    for i, j, weight in products(count):
        rows[i + j] += f" + {weight!r} * (x{i} * x{j} + y{i} * y{j})"
    lines = [f"{_names(name, count)} = {name}" for name in "xy"]
    return straight("squares(x, y)", [*lines, f"return [{', '.join(row[3:] for row in rows)}]"], __file__)


def without_root_at_start(b: Sequence[float]) -> list[float]:
    """Coefficients of f(u) / u, where f(0) is taken as exactly zero."""
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
    slopes, value_and_slope = derivative(b), _written_out("value_and_slope", len(b))
    low, high = 0.0, 1.0
    u = b[0] / (b[0] - b[-1]) if b[0] > 0.0 > b[-1] else 0.5
    for _ in range(100):
        value, fall = value_and_slope(b, u, slopes)  # both over (1 - u)^(n - 1), or u^(n - 1)
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
