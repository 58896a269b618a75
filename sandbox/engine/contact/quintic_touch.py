"""First touch of a ball on an arc of degree 5 with a fixed shape, in floats: what both Python and numba take.

A shape is a row of numbers, those of an ``Outline`` (``touch.py``): all positions of the ball's centre at the distance
``reach`` from the line from a to b, or from one point if its length is 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, sqrt

from sandbox.engine.model.tolerances import GAP_ROUNDING, TINY, TOUCHING_GAP
from sandbox.engine.paths.quintic import (
    Decic,
    Quintic,
    at,
    crossing,
    elevated,
    plus,
    squared_length,
    without_root_at_start,
)

#: Places in the row of a shape, as the fields of an ``Outline``.
_AX, _AY, _BX, _BY, REACH, LENGTH, _TX, _TY = range(8)


def first_touch(shape: Sequence[float], xs: Quintic, ys: Quintic, skin: float) -> float:
    """The first u in [0, 1] at which a ball on a path touches a shape, so that it overlaps it by ``skin`` (m); inf if
    it does not."""
    radius, length = shape[REACH] - skin, shape[LENGTH]
    if length == 0.0:
        return _first_within(xs, ys, shape[_AX], shape[_AY], radius)
    ax, ay, tx, ty = shape[_AX], shape[_AY], shape[_TX], shape[_TY]
    across = (
        (ys[0] - ay) * tx - (xs[0] - ax) * ty,
        (ys[1] - ay) * tx - (xs[1] - ax) * ty,
        (ys[2] - ay) * tx - (xs[2] - ax) * ty,
        (ys[3] - ay) * tx - (xs[3] - ax) * ty,
        (ys[4] - ay) * tx - (xs[4] - ax) * ty,
        (ys[5] - ay) * tx - (xs[5] - ax) * ty,
    )
    low, high = min(across), max(across)
    if low > shape[REACH] or high < -shape[REACH]:
        return inf
    touch = _first_within(xs, ys, ax, ay, radius)
    touch = min(touch, _touch_of_side(shape, xs, ys, across, low, high, skin))
    return min(touch, _first_within(xs, ys, shape[_BX], shape[_BY], radius))


def _first_within(xs: Quintic, ys: Quintic, cx: float, cy: float, radius: float) -> float:
    """The first u at which a path comes within ``radius`` of a point; inf if it does not."""
    dx0, dx1, dx2, dx3, dx4, dx5 = xs[0] - cx, xs[1] - cx, xs[2] - cx, xs[3] - cx, xs[4] - cx, xs[5] - cx
    if min(dx0, dx1, dx2, dx3, dx4, dx5) > radius or max(dx0, dx1, dx2, dx3, dx4, dx5) < -radius:
        return inf
    dy0, dy1, dy2, dy3, dy4, dy5 = ys[0] - cy, ys[1] - cy, ys[2] - cy, ys[3] - cy, ys[4] - cy, ys[5] - cy
    if min(dy0, dy1, dy2, dy3, dy4, dy5) > radius or max(dy0, dy1, dy2, dy3, dy4, dy5) < -radius:
        return inf
    dx, dy = (dx0, dx1, dx2, dx3, dx4, dx5), (dy0, dy1, dy2, dy3, dy4, dy5)
    # all control points are beyond a tangent of the circle, towards the path's middle or square to it: no touch
    ex, ey = dx5 - dx0, dy5 - dy0
    if dx0 * ey < dy0 * ex:
        ex, ey = -ex, -ey
    if _beyond(dx, dy, dx3, dy3, radius) or _beyond(dx, dy, ey, -ex, radius):
        return inf
    inner, over = radius * radius, 0.5 / radius
    s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10 = squared_length(dx, dy)
    gap = (
        over * (s0 - inner),
        over * (s1 - inner),
        over * (s2 - inner),
        over * (s3 - inner),
        over * (s4 - inner),
        over * (s5 - inner),
        over * (s6 - inner),
        over * (s7 - inner),
        over * (s8 - inner),
        over * (s9 - inner),
        over * (s10 - inner),
    )
    if gap[0] <= GAP_ROUNDING:
        gap = _closing_further(gap)
    return crossing(gap, -1.0)


def _beyond(dx: Quintic, dy: Quintic, mx: float, my: float, radius: float) -> bool:
    """True if all points are beyond the tangent of a circle about 0 that is square to (mx, my)."""
    most = radius * sqrt(mx * mx + my * my)
    return (
        dx[0] * mx + dy[0] * my > most
        and dx[1] * mx + dy[1] * my > most
        and dx[2] * mx + dy[2] * my > most
        and dx[3] * mx + dy[3] * my > most
        and dx[4] * mx + dy[4] * my > most
        and dx[5] * mx + dy[5] * my > most
    )


def _closing_further(gap: Decic) -> Decic:
    """A gap that is closed at the start, within rounding, as one that closes only where it closes further."""
    opening = without_root_at_start(gap)
    if opening[0] < -GAP_ROUNDING:
        # closing, but perhaps only by rounding, as when a ball that slides along a side passes its end
        return plus(plus(gap, -gap[0]), GAP_ROUNDING)
    return plus(opening, GAP_ROUNDING)


def _touch_of_side(
    shape: Sequence[float], xs: Quintic, ys: Quintic, across: Quintic, low: float, high: float, skin: float
) -> float:
    """The first u at which a path touches the side of a shape, between its ends; inf if it does not. ``across`` is its
    distance in m from the line, from ``low`` to ``high``."""
    first, reach, length = inf, shape[REACH], shape[LENGTH]
    for side in (1.0, -1.0):
        farthest = high if side > 0.0 else -low
        if farthest - reach + skin <= -GAP_ROUNDING and side * across[0] <= 0.0:
            continue  # entirely beyond the line
        flat = (
            side * across[0] - reach + skin,
            side * across[1] - reach + skin,
            side * across[2] - reach + skin,
            side * across[3] - reach + skin,
            side * across[4] - reach + skin,
            side * across[5] - reach + skin,
        )
        if min(flat) > 0.0:
            continue
        gap = elevated(flat)
        if side * across[0] > 0.0 and gap[0] <= GAP_ROUNDING:
            start = _along(shape, xs[0], ys[0])
            if -TOUCHING_GAP <= start <= length + TOUCHING_GAP:
                gap = _closing_further(gap)
        u = crossing(gap, -1.0)
        while u < first:
            if 0.0 <= _along(shape, at(xs, u), at(ys, u)) <= length:
                first = u
            else:
                u = crossing(gap, u)
    return first


def _along(shape: Sequence[float], x: float, y: float) -> float:
    """Distance in m from a towards b."""
    return (x - shape[_AX]) * shape[_TX] + (y - shape[_AY]) * shape[_TY]


def nearest(shape: Sequence[float], x: float, y: float) -> tuple[float, float, float, float]:
    """Gap in m between a shape and a ball at (x, y), the unit normal to the ball, and the curvature in 1/m of the
    path of a ball that stays in touch."""
    along, length, reach = _along(shape, x, y), shape[LENGTH], shape[REACH]
    if 0.0 <= along <= length and length > 0.0:
        across = (y - shape[_AY]) * shape[_TX] - (x - shape[_AX]) * shape[_TY]
        side = 1.0 if across >= 0.0 else -1.0
        return side * across - reach, -side * shape[_TY], side * shape[_TX], 0.0
    if along > length:
        dx, dy = x - shape[_BX], y - shape[_BY]
    else:
        dx, dy = x - shape[_AX], y - shape[_AY]
    distance = sqrt(dx * dx + dy * dy)
    over = distance + TINY
    return distance - reach, dx / over, dy / over, 1.0 / reach
