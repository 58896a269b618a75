"""When and where a ball on an arc first touches a fixed shape or another ball.

Every shape is made of features: straight sides and round corners (or a whole circle). A ball of radius r touches a
feature when its centre reaches the feature's outline grown by r, which is a line or a circle. Along an arc the
distance to either is a polynomial in time, and its first downward crossing is the time of impact: nothing can tunnel,
at any speed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot, sqrt
from typing import NamedTuple

from sandbox.engine.accuracy import SKIN
from sandbox.engine.arc import Arc
from sandbox.engine.bernstein import downward_crossings, elevate, evaluate, piece, product, without_root_at_start
from sandbox.engine.setup import Circle, Surface

#: Largest gap in m at which shapes are taken to be in contact when an impact or a new contact is sorted out.
CONTACT = 1e-10

#: Distance in m along a side within which a ball is at the side's end.
_SEAM = 1e-11

#: Rounding in m that is not motion: a path nearer than this to parallel neither closes nor opens a gap.
NOISE = 1e-13


Point = tuple[float, float]

SIDE, CORNER_A, CORNER_B, WHOLE = range(4)


class Touching(NamedTuple):
    """A feature near a ball: the gap between them and the unit normal from the feature to the ball's centre."""

    gap: float  # m, negative where they overlap
    nx: float
    ny: float
    curvature: float  # 1/m, of the path of a ball that stays in touch: 0 along a side, 1 / (R + r) around a corner
    center: Point | None  # m, of a round feature
    feature: int  # SIDE, CORNER_A, CORNER_B or WHOLE

    def normal_at(self, x: float, y: float) -> tuple[float, float, float]:
        """Unit normal and curvature for a ball in touch with this feature at (x, y)."""
        if self.center is None:
            return self.nx, self.ny, 0.0
        dx = x - self.center[0]
        dy = y - self.center[1]
        distance = sqrt(dx * dx + dy * dy)
        return dx / distance, dy / distance, 1.0 / distance


class Obstacle:
    """A surface, prepared for one ball radius; touched where a ball overlaps it by ``skin`` (m)."""

    def __init__(self, surface: Surface, radius: float, skin: float = SKIN) -> None:
        shape = surface.shape
        self.surface = surface
        self._skin = skin
        self.reach = shape.radius + radius  # m, from the ball's centre to the shape's middle line when they touch
        self._a, b = (shape.center, shape.center) if isinstance(shape, Circle) else (shape.a, shape.b)
        self._b = b
        self._length = hypot(b[0] - self._a[0], b[1] - self._a[1])
        self._round = self._length == 0.0
        self._tx = 1.0 if self._round else (b[0] - self._a[0]) / self._length
        self._ty = 0.0 if self._round else (b[1] - self._a[1]) / self._length
        margin = self.reach + CONTACT
        self._left, self._right = min(self._a[0], b[0]) - margin, max(self._a[0], b[0]) + margin
        self._bottom, self._top = min(self._a[1], b[1]) - margin, max(self._a[1], b[1]) + margin

    def near(self, x: float, y: float) -> Touching:
        """How near a ball centred at (x, y) is to the feature nearest to it."""
        if self._round:
            return self._at(WHOLE, x, y)
        along = self._along(x, y)
        return self._at(CORNER_A if along < 0.0 else CORNER_B if along > self._length else SIDE, x, y)

    def ahead(self, touching: Touching, x: float, y: float, mx: float, my: float) -> Touching:
        """The feature that a ball touching here, and about to move along (mx, my), will be on: at the seam of side
        and corner both are touched."""
        if touching.feature == WHOLE:
            return touching
        along = self._along(x, y)
        forward = mx * self._tx + my * self._ty
        if abs(along) <= _SEAM:
            return self._at(CORNER_A if forward < 0.0 else SIDE, x, y)
        if abs(along - self._length) <= _SEAM:
            return self._at(CORNER_B if forward > 0.0 else SIDE, x, y)
        return touching

    def gap(self, touching: Touching, x: float, y: float) -> float:
        """Gap in m between a ball at (x, y) and the feature that it touches."""
        return self._at(touching.feature, x, y).gap

    def edge(self, feature: int, arc: Arc) -> float | None:
        """The first u at which a ball that stays on the feature reaches its end, or None."""
        if feature == WHOLE:
            return None
        along = [(x - self._a[0]) * self._tx + (y - self._a[1]) * self._ty for x, y in zip(arc.x, arc.y, strict=True)]
        if feature == CORNER_A:
            return next(downward_crossings([-s for s in along]), None)
        if feature == CORNER_B:
            return next(downward_crossings([s - self._length for s in along]), None)
        ends = [
            next(downward_crossings(along), None),
            next(downward_crossings([self._length - s for s in along]), None),
        ]
        return min((u for u in ends if u is not None), default=None)

    def _along(self, x: float, y: float) -> float:
        return (x - self._a[0]) * self._tx + (y - self._a[1]) * self._ty

    def _at(self, feature: int, x: float, y: float) -> Touching:
        if feature == SIDE:
            across = (y - self._a[1]) * self._tx - (x - self._a[0]) * self._ty
            side = 1.0 if across >= 0.0 else -1.0
            return Touching(side * across - self.reach, -side * self._ty, side * self._tx, 0.0, None, SIDE)
        center = self._b if feature == CORNER_B else self._a
        dx = x - center[0]
        dy = y - center[1]
        distance = hypot(dx, dy)
        nx, ny = (dx / distance, dy / distance) if distance > 0.0 else (0.0, 1.0)
        return Touching(distance - self.reach, nx, ny, 1.0 / self.reach, center, feature)

    def may_meet(self, box: tuple[float, float, float, float]) -> bool:
        """Whether a path inside the box (left, bottom, right, top) could touch."""
        return box[0] <= self._right and box[2] >= self._left and box[1] <= self._top and box[3] >= self._bottom

    def first_touch(self, arc: Arc) -> float | None:
        """The first u in [0, 1] of the arc at which the ball comes to touch, or None."""
        if self._round:
            return self._corner(arc, self._a)
        touches = (self._corner(arc, self._a), self._side(arc), self._corner(arc, self._b))
        return min((u for u in touches if u is not None), default=None)

    def _corner(self, arc: Arc, center: Point) -> float | None:
        (left, bottom, right, top), (x, y), reach = arc.box(), center, self.reach
        if x - reach > right or x + reach < left or y - reach > top or y + reach < bottom:
            return None
        return _round(arc.x, arc.y, center, reach - self._skin)

    def _side(self, arc: Arc) -> float | None:
        ax, ay = self._a
        across = [(y - ay) * self._tx - (x - ax) * self._ty for x, y in zip(arc.x, arc.y, strict=True)]
        low, high = min(across), max(across)
        if low > self.reach or high < -self.reach:
            return None
        first = None
        for side in (1.0, -1.0):
            gap = [side * d - self.reach + self._skin for d in across]
            if max(gap) <= -NOISE and side * across[0] <= 0.0:
                continue  # wholly beyond the line
            for u in _closings(gap, side * across[0] > 0.0 and self._within(arc.x[0], arc.y[0], CONTACT)):
                if first is not None and u >= first:
                    break
                if self._within(evaluate(arc.x, u), evaluate(arc.y, u)):
                    first = u
                    break
        return first

    def _within(self, x: float, y: float, margin: float = 0.0) -> bool:
        return -margin <= self._along(x, y) <= self._length + margin


def _round(xs: Sequence[float], ys: Sequence[float], center: Point, radius: float) -> float | None:
    """First u at which a path comes within ``radius`` of a point."""
    cx, cy = center
    dx = [x - cx for x in xs]
    dy = [y - cy for y in ys]
    if min(dx) > radius or max(dx) < -radius or min(dy) > radius or max(dy) < -radius:
        return None
    # the control points all lie beyond a tangent of the circle: no touch
    middle = len(dx) // 2
    mx, my = dx[middle], dy[middle]
    length = sqrt(mx * mx + my * my)
    if length > radius and min([x * mx + y * my for x, y in zip(dx, dy, strict=True)]) > radius * length:
        return None
    gap = [(p + q - radius * radius) / (2.0 * radius) for p, q in zip(product(dx, dx), product(dy, dy), strict=True)]
    return next(iter(_closings(gap, True)), None)


def _closings(gap: list[float], starts_beside: bool) -> Iterable[float]:
    """Times u at which a gap closes. One that is closed at the start, within rounding, counts only if it closes
    further.
    """
    if len(gap) == 1:
        return ()  # nothing moves
    if starts_beside and gap[0] <= NOISE:
        opening = without_root_at_start([g - gap[0] for g in gap])
        if opening[0] < -NOISE:
            # closing, but perhaps by no more than rounding, as where a ball that glides along a side passes its end
            return downward_crossings([g - gap[0] + NOISE for g in gap])
        return downward_crossings([g + NOISE for g in opening])
    return downward_crossings(gap)


def balls_touch(first: Arc, second: Arc, reach: float, t: float, skin: float = SKIN) -> float | None:
    """The first time from t on, while both arcs last, at which two balls overlap by ``skin``, or None.

    ``reach`` is the distance in m of their centres when they touch.
    """
    until = min(first.t1, second.t1)
    if until <= t:
        return None
    xs, ys = _between(first, t, until)
    us, vs = _between(second, t, until)
    degree = max(len(xs), len(us)) - 1
    dx = [a - b for a, b in zip(elevate(xs, degree), elevate(us, degree), strict=True)]
    dy = [a - b for a, b in zip(elevate(ys, degree), elevate(vs, degree), strict=True)]
    u = _round(dx, dy, (0.0, 0.0), reach - skin)
    return None if u is None else t + u * (until - t)


def _between(arc: Arc, t: float, until: float) -> tuple[Sequence[float], Sequence[float]]:
    h = arc.t1 - arc.t0
    u0 = max(0.0, (t - arc.t0) / h)
    u1 = min(1.0, (until - arc.t0) / h)
    return piece(arc.x, u0, u1), piece(arc.y, u0, u1)
