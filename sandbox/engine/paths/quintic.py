"""Polynomials of degree 5 and 10 on [0, 1] in Bernstein form, as tuples of floats: those of a ball's path after a step,
and of its distance from a fixed shape.

What ``bernstein.py`` does with loops for any degree is written out here for these, in what both Python and numba take.
"""

from __future__ import annotations

#: Coefficients of polynomials of degree 3, 4, 5, 9 and 10.
_Cubic = tuple[float, float, float, float]
_Quartic = tuple[float, float, float, float, float]
_Quintic = tuple[float, float, float, float, float, float]
_Nonic = tuple[float, float, float, float, float, float, float, float, float, float]
_Decic = tuple[float, float, float, float, float, float, float, float, float, float, float]


def evaluate(b: _Quintic, u: float) -> float:
    """Return f(u)."""
    return first_part(b, u)[5]


def moved(b: _Quintic, c: float) -> _Quintic:
    """Return the coordinate of a path as seen from a place."""
    return b[0] - c, b[1] - c, b[2] - c, b[3] - c, b[4] - c, b[5] - c


def across(xs: _Quintic, ys: _Quintic, tx: float, ty: float) -> _Quintic:
    """Return the distance of a path from the line through 0 along (tx, ty), positive to its left."""
    x0, x1, x2, x3, x4, x5 = xs
    y0, y1, y2, y3, y4, y5 = ys
    return (
        y0 * tx - x0 * ty,
        y1 * tx - x1 * ty,
        y2 * tx - x2 * ty,
        y3 * tx - x3 * ty,
        y4 * tx - x4 * ty,
        y5 * tx - x5 * ty,
    )


def first_part(b: _Quintic, u: float) -> _Quintic:
    """Return the coefficients on [0, u], by de Casteljau: each level takes the weighted mean of neighbours in the level
    before, and the first of each level is a coefficient."""
    w = 1.0 - u
    b0, b1, b2, b3, b4, b5 = b
    b1, b2, b3, b4, b5 = w * b0 + u * b1, w * b1 + u * b2, w * b2 + u * b3, w * b3 + u * b4, w * b4 + u * b5
    b2, b3, b4, b5 = w * b1 + u * b2, w * b2 + u * b3, w * b3 + u * b4, w * b4 + u * b5
    b3, b4, b5 = w * b2 + u * b3, w * b3 + u * b4, w * b4 + u * b5
    b4, b5 = w * b3 + u * b4, w * b4 + u * b5
    return b0, b1, b2, b3, b4, w * b4 + u * b5


def first_of_quartic(b: _Quartic, u: float) -> _Quartic:
    """The same of degree 4: a coefficient depends only on those before it."""
    b0, b1, b2, b3, b4, _ = first_part((b[0], b[1], b[2], b[3], b[4], 0.0), u)
    return b0, b1, b2, b3, b4


def first_of_cubic(b: _Cubic, u: float) -> _Cubic:
    """The same of degree 3."""
    b0, b1, b2, b3, _, _ = first_part((b[0], b[1], b[2], b[3], 0.0, 0.0), u)
    return b0, b1, b2, b3


def as_squared(b: _Quintic) -> _Decic:
    """Return the same polynomial at degree 10."""
    b0, b1, b2, b3, b4, b5 = b
    return (
        b0,
        0.5 * (b0 + b1),
        (2.0 * b0 + 5.0 * b1 + 2.0 * b2) / 9.0,
        (b0 + 5.0 * b1 + 5.0 * b2 + b3) / 12.0,
        (b0 + 10.0 * b1 + 20.0 * b2 + 10.0 * b3 + b4) / 42.0,
        (b0 + 25.0 * b1 + 100.0 * b2 + 100.0 * b3 + 25.0 * b4 + b5) / 252.0,
        (b1 + 10.0 * b2 + 20.0 * b3 + 10.0 * b4 + b5) / 42.0,
        (b2 + 5.0 * b3 + 5.0 * b4 + b5) / 12.0,
        (2.0 * b3 + 5.0 * b4 + 2.0 * b5) / 9.0,
        0.5 * (b4 + b5),
        b5,
    )


def squared_length(x: _Quintic, y: _Quintic) -> _Decic:
    """Return the coefficients of x^2 + y^2."""
    x0, x1, x2, x3, x4, x5 = x
    y0, y1, y2, y3, y4, y5 = y
    return (
        x0 * x0 + y0 * y0,
        x0 * x1 + y0 * y1,
        4 / 9 * (x0 * x2 + y0 * y2) + 5 / 9 * (x1 * x1 + y1 * y1),
        1 / 6 * (x0 * x3 + y0 * y3) + 5 / 6 * (x1 * x2 + y1 * y2),
        1 / 21 * (x0 * x4 + y0 * y4) + 10 / 21 * (x1 * x3 + y1 * y3) + 10 / 21 * (x2 * x2 + y2 * y2),
        1 / 126 * (x0 * x5 + y0 * y5) + 25 / 126 * (x1 * x4 + y1 * y4) + 50 / 63 * (x2 * x3 + y2 * y3),
        1 / 21 * (x1 * x5 + y1 * y5) + 10 / 21 * (x2 * x4 + y2 * y4) + 10 / 21 * (x3 * x3 + y3 * y3),
        1 / 6 * (x2 * x5 + y2 * y5) + 5 / 6 * (x3 * x4 + y3 * y4),
        4 / 9 * (x3 * x5 + y3 * y5) + 5 / 9 * (x4 * x4 + y4 * y4),
        x4 * x5 + y4 * y5,
        x5 * x5 + y5 * y5,
    )


def plus(b: _Decic, c: float) -> _Decic:
    """Return the coefficients of f(u) + c."""
    b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10 = b
    return b0 + c, b1 + c, b2 + c, b3 + c, b4 + c, b5 + c, b6 + c, b7 + c, b8 + c, b9 + c, b10 + c


def times(b: _Decic, c: float) -> _Decic:
    """Return the coefficients of c f(u)."""
    b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10 = b
    return c * b0, c * b1, c * b2, c * b3, c * b4, c * b5, c * b6, c * b7, c * b8, c * b9, c * b10


def derivative(b: _Decic) -> _Nonic:
    """Return the coefficients of df/du."""
    b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10 = b
    d0, d1, d2, d3, d4 = 10.0 * (b1 - b0), 10.0 * (b2 - b1), 10.0 * (b3 - b2), 10.0 * (b4 - b3), 10.0 * (b5 - b4)
    d5, d6, d7, d8 = 10.0 * (b6 - b5), 10.0 * (b7 - b6), 10.0 * (b8 - b7), 10.0 * (b9 - b8)
    return d0, d1, d2, d3, d4, d5, d6, d7, d8, 10.0 * (b10 - b9)


def value_and_slope(b: _Decic, d: _Nonic, r: float) -> tuple[float, float]:
    """Return sum_k C(10, k) b[k] r^(10 - k), and the same of the derivative d."""
    f = ((((b[0] * r + 10.0 * b[1]) * r + 45.0 * b[2]) * r + 120.0 * b[3]) * r + 210.0 * b[4]) * r + 252.0 * b[5]
    f = ((((f * r + 210.0 * b[6]) * r + 120.0 * b[7]) * r + 45.0 * b[8]) * r + 10.0 * b[9]) * r + b[10]
    s = (((d[0] * r + 9.0 * d[1]) * r + 36.0 * d[2]) * r + 84.0 * d[3]) * r + 126.0 * d[4]
    return f, ((((s * r + 126.0 * d[5]) * r + 84.0 * d[6]) * r + 36.0 * d[7]) * r + 9.0 * d[8]) * r + d[9]


def without_root_at_start(b: _Decic) -> _Decic:
    """Return the coefficients of (f(u) - f(0)) / u, at degree 10."""
    z, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10 = b
    c0, c1, c2, c3, c4 = (b1 - z) * 10.0, (b2 - z) * 5.0, (b3 - z) * 10.0 / 3.0, (b4 - z) * 2.5, (b5 - z) * 2.0
    c5, c6, c7, c8 = (b6 - z) * 10.0 / 6.0, (b7 - z) * 10.0 / 7.0, (b8 - z) * 1.25, (b9 - z) * 10.0 / 9.0
    c9 = b10 - z
    return (
        c0,
        (c0 + 9.0 * c1) / 10.0,
        (2.0 * c1 + 8.0 * c2) / 10.0,
        (3.0 * c2 + 7.0 * c3) / 10.0,
        (4.0 * c3 + 6.0 * c4) / 10.0,
        (5.0 * c4 + 5.0 * c5) / 10.0,
        (6.0 * c5 + 4.0 * c6) / 10.0,
        (7.0 * c6 + 3.0 * c7) / 10.0,
        (8.0 * c7 + 2.0 * c8) / 10.0,
        (9.0 * c8 + c9) / 10.0,
        c9,
    )


def halves(b: _Decic) -> tuple[_Decic, _Decic]:
    """Return the coefficients on [0, 1/2] and on [1/2, 1]: each level takes the means of neighbours in the level
    before; the first of each are those of one half, the last those of the other."""
    l0, r1, r2, r3, r4, r5, r6, r7, r8, r9, r10 = b
    r0, r1, r2, r3, r4 = 0.5 * (l0 + r1), 0.5 * (r1 + r2), 0.5 * (r2 + r3), 0.5 * (r3 + r4), 0.5 * (r4 + r5)
    r5, r6, r7, r8, r9 = 0.5 * (r5 + r6), 0.5 * (r6 + r7), 0.5 * (r7 + r8), 0.5 * (r8 + r9), 0.5 * (r9 + r10)
    l1 = r0
    r0, r1, r2, r3, r4 = 0.5 * (r0 + r1), 0.5 * (r1 + r2), 0.5 * (r2 + r3), 0.5 * (r3 + r4), 0.5 * (r4 + r5)
    r5, r6, r7, r8 = 0.5 * (r5 + r6), 0.5 * (r6 + r7), 0.5 * (r7 + r8), 0.5 * (r8 + r9)
    l2 = r0
    r0, r1, r2, r3, r4 = 0.5 * (r0 + r1), 0.5 * (r1 + r2), 0.5 * (r2 + r3), 0.5 * (r3 + r4), 0.5 * (r4 + r5)
    r5, r6, r7 = 0.5 * (r5 + r6), 0.5 * (r6 + r7), 0.5 * (r7 + r8)
    l3 = r0
    r0, r1, r2, r3, r4 = 0.5 * (r0 + r1), 0.5 * (r1 + r2), 0.5 * (r2 + r3), 0.5 * (r3 + r4), 0.5 * (r4 + r5)
    r5, r6 = 0.5 * (r5 + r6), 0.5 * (r6 + r7)
    l4 = r0
    r0, r1, r2, r3, r4 = 0.5 * (r0 + r1), 0.5 * (r1 + r2), 0.5 * (r2 + r3), 0.5 * (r3 + r4), 0.5 * (r4 + r5)
    r5 = 0.5 * (r5 + r6)
    l5 = r0
    r0, r1, r2, r3, r4 = 0.5 * (r0 + r1), 0.5 * (r1 + r2), 0.5 * (r2 + r3), 0.5 * (r3 + r4), 0.5 * (r4 + r5)
    l6 = r0
    r0, r1, r2, r3 = 0.5 * (r0 + r1), 0.5 * (r1 + r2), 0.5 * (r2 + r3), 0.5 * (r3 + r4)
    l7 = r0
    r0, r1, r2 = 0.5 * (r0 + r1), 0.5 * (r1 + r2), 0.5 * (r2 + r3)
    l8 = r0
    r0, r1 = 0.5 * (r0 + r1), 0.5 * (r1 + r2)
    l9, r0 = r0, 0.5 * (r0 + r1)
    return (l0, l1, l2, l3, l4, l5, l6, l7, l8, l9, r0), (r0, r1, r2, r3, r4, r5, r6, r7, r8, r9, r10)
