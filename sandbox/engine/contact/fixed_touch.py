"""First touch of a ball on an arc with a fixed shape, in floats: for paths of any degree; and, from the same code, for
those of degree 5, as tuples, which numba takes, too.

A shape is a row of numbers, those of an ``Outline`` (``touch.py``): all positions of the ball's centre at the distance
``reach`` from the line from a to b, or from one point if its length is 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, sqrt
from typing import Any

from sandbox.engine.model.tolerances import GAP_ROUNDING, TINY, TOUCHING_GAP
from sandbox.engine.paths.bernstein import (
    across,
    as_squared,
    crossing,
    evaluate,
    moved,
    of_quintics,
    plus,
    squared_length,
    times,
    without_root_at_start,
)

#: Places in the row of a shape, as the fields of an ``Outline``.
_AX, _AY, _BX, _BY, REACH, LENGTH, _TX, _TY = range(8)


def first_touch(shape: Sequence[float], xs: Any, ys: Any, skin: float) -> float:
    """The first u in [0, 1] at which a ball on a path touches a shape, so that it overlaps it by ``skin`` (m); inf if
    it does not."""
    radius, reach, length = shape[REACH] - skin, shape[REACH], shape[LENGTH]
    dx, dy = moved(xs, shape[_AX]), moved(ys, shape[_AY])
    if length == 0.0:
        return first_within(dx, dy, radius)
    tx, ty = shape[_TX], shape[_TY]
    beside = across(dx, dy, tx, ty)
    low, high = min(beside), max(beside)
    if low > reach or high < -reach:
        return inf
    along = across(dx, dy, ty, -tx)
    least, most = min(along), max(along)
    if most < -reach or least > length + reach:
        return inf
    first = _touch_of_side(along, beside, reach, length, skin)
    if least <= reach:
        first = min(first, first_within(dx, dy, radius))
    if most >= length - reach:
        first = min(first, first_within(moved(xs, shape[_BX]), moved(ys, shape[_BY]), radius))
    return first


def first_within(dx: Any, dy: Any, radius: float) -> float:
    """The first u at which a path, as seen from a point, comes within ``radius`` of it; inf if it does not."""
    if min(dx) > radius or max(dx) < -radius or min(dy) > radius or max(dy) < -radius:
        return inf
    # all control points are beyond a tangent of the circle, towards the path's middle or square to it: no touch
    middle, ex, ey = len(dx) // 2, dx[-1] - dx[0], dy[-1] - dy[0]
    if dx[0] * ey < dy[0] * ex:
        ex, ey = -ex, -ey
    if _beyond(dx, dy, dx[middle], dy[middle], radius) or _beyond(dx, dy, ey, -ex, radius):
        return inf
    gap = times(plus(squared_length(dx, dy), -(radius * radius)), 0.5 / radius)
    return crossing(_closing_further(gap) if gap[0] <= GAP_ROUNDING else gap, -1.0)


def _beyond(dx: Any, dy: Any, mx: float, my: float, radius: float) -> bool:
    """True if all points are beyond the tangent of a circle about 0 that is square to (mx, my)."""
    return min(across(dx, dy, my, -mx)) > radius * sqrt(mx * mx + my * my)


def _closing_further(gap: Any) -> Any:
    """A gap that is closed at the start, within rounding, as one that closes only where it closes further."""
    opening = without_root_at_start(gap)
    if opening[0] < -GAP_ROUNDING:
        # closing, but perhaps only by rounding, as when a ball that slides along a side passes its end
        return plus(plus(gap, -gap[0]), GAP_ROUNDING)
    return plus(opening, GAP_ROUNDING)


def _touch_of_side(along: Any, beside: Any, reach: float, length: float, skin: float) -> float:
    """The first u at which a path touches the side of a shape, between its ends; inf if it does not. The path is that
    ``along`` the side, from its start, and ``beside`` it, both in m."""
    first, low, high = inf, min(beside), max(beside)
    for side in (1.0, -1.0):
        nearest, farthest = (low, high) if side > 0.0 else (-high, -low)
        if nearest - reach + skin > 0.0 or (farthest - reach + skin <= -GAP_ROUNDING and side * beside[0] <= 0.0):
            continue  # it comes nowhere near, or is entirely beyond the line
        gap = plus(plus(times(as_squared(beside), side), -reach), skin)
        if side * beside[0] > 0.0 and gap[0] <= GAP_ROUNDING and -TOUCHING_GAP <= along[0] <= length + TOUCHING_GAP:
            gap = _closing_further(gap)
        u = crossing(gap, -1.0)
        while u < first:
            if 0.0 <= evaluate(along, u) <= length:
                first = u
            else:
                u = crossing(gap, u)
    return first


#: The same of paths of degree 5, as tuples.
first_touch_of_quintics = of_quintics(first_touch)


def nearest(shape: Sequence[float], x: float, y: float) -> tuple[float, float, float, float]:
    """Gap in m between a shape and a ball at (x, y), the unit normal to the ball, and the curvature in 1/m of the
    path of a ball that stays in touch."""
    dx, dy, length, reach = x - shape[_AX], y - shape[_AY], shape[LENGTH], shape[REACH]
    along = dx * shape[_TX] + dy * shape[_TY]
    if 0.0 <= along <= length and length > 0.0:
        beside = dy * shape[_TX] - dx * shape[_TY]
        side = 1.0 if beside >= 0.0 else -1.0
        return side * beside - reach, -side * shape[_TY], side * shape[_TX], 0.0
    if along > length:
        dx, dy = x - shape[_BX], y - shape[_BY]
    distance = sqrt(dx * dx + dy * dy)
    over = distance + TINY
    return distance - reach, dx / over, dy / over, 1.0 / reach
