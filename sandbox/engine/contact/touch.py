"""Time of impact of a ball on an arc with a fixed shape or another ball.

Every shape consists of features: straight sides and round corners (or a whole circle). A ball of radius r touches a
feature when its centre reaches the feature's outline expanded by r, which is a line or a circle. Along an arc the
distance to it is a polynomial in time, and its first downward crossing is the time of impact: no ball can tunnel, at
any speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import inf, sqrt
from typing import Any, NamedTuple

from sandbox.engine.contact.fixed_touch import first_touch, first_within
from sandbox.engine.model.surface import Circle, Segment, Surface
from sandbox.engine.model.tolerances import FLUSH, SEAM, SKIN, TINY, TOUCHING_GAP
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.bernstein import crossing, elevate, piece
from sandbox.physics.elementwise import hypot, maximum, minimum, where

Point = tuple[Any, Any]

SIDE, _CORNER_A, _CORNER_B = range(3)


class Touching(NamedTuple):
    """A feature near a ball: the gap between them and the unit normal from the feature to the ball's centre."""

    gap: Any  # m, negative where they overlap
    nx: Any
    ny: Any
    curvature: Any  # 1/m, of the path of a ball that stays in touch: 0 along a side, 1 / (R + r) around a corner
    center: Point  # m, of the corner
    feature: Any  # SIDE, CORNER_A or CORNER_B

    def normal_at(self, x: float, y: float) -> tuple[float, float, float]:
        """Unit normal and curvature for a ball in touch with this feature at (x, y)."""
        if self.feature == SIDE:
            return self.nx, self.ny, 0.0
        dx = x - self.center[0]
        dy = y - self.center[1]
        distance = sqrt(dx * dx + dy * dy)
        return dx / distance, dy / distance, 1.0 / distance


def flush(one: Touching, other: Touching) -> Any:
    """Return True if two features are pieces of one surface, as far as a ball can tell: their normals are the same."""
    return one.nx * other.nx + one.ny * other.ny > FLUSH


class Outline(NamedTuple):
    """The positions of a ball's centre when it touches a shape: all points at distance ``reach`` from the line from a
    to b, or from one point if a equals b. Floats, or arrays for many shapes at once."""

    ax: Any  # m
    ay: Any
    bx: Any
    by: Any
    reach: Any  # m
    length: Any  # m
    tx: Any  # unit vector from a to b
    ty: Any

    @classmethod
    def of(cls, shape: Segment | Circle, radius: Any) -> Outline:
        """The outline of a shape for balls of this radius (m)."""
        (start, end), zero = shape.ends, 0.0 * radius
        ax, ay, bx, by = (each + zero for each in (*start, *end))
        length = hypot(bx - ax, by - ay)
        point = length == 0.0  # then the direction is arbitrary
        over = length + point
        return cls(ax, ay, bx, by, shape.radius + radius, length, (bx - ax) / over + point, (by - ay) / over)

    def along(self, x: Any, y: Any) -> Any:
        """Distance in m from a towards b."""
        return (x - self.ax) * self.tx + (y - self.ay) * self.ty

    def across(self, x: Any, y: Any) -> Any:
        """Distance in m from the line, positive to its left."""
        return (y - self.ay) * self.tx - (x - self.ax) * self.ty

    def near(self, x: Any, y: Any) -> Touching:
        """The nearest feature to a ball centred at (x, y), with gap and normal."""
        along = self.along(x, y)
        beyond = along > self.length
        on_side = (along >= 0.0) & (beyond ^ True) & (self.length > 0.0)
        if isinstance(on_side, bool):
            return self.side(x, y) if on_side else self.corner(_CORNER_B if beyond else _CORNER_A, x, y)
        side, corner = self.side(x, y), self.corner(where(beyond, _CORNER_B, _CORNER_A), x, y)
        return Touching(*(where(on_side, *parts) for parts in zip(side, corner, strict=True)))

    def side(self, x: Any, y: Any) -> Touching:
        """Gap and normal of a ball to the side, or to its extension."""
        across = self.across(x, y)
        side = where(across >= 0.0, 1.0, -1.0)
        return Touching(side * across - self.reach, -side * self.ty, side * self.tx, 0.0, (self.ax, self.ay), SIDE)

    def corner(self, feature: Any, x: Any, y: Any) -> Touching:
        """Gap and normal of a ball to a corner."""
        at_b = feature == _CORNER_B
        cx, cy = where(at_b, self.bx, self.ax), where(at_b, self.by, self.ay)
        dx = x - cx
        dy = y - cy
        distance = hypot(dx, dy)
        over = distance + TINY
        return Touching(distance - self.reach, dx / over, dy / over, 1.0 / self.reach, (cx, cy), feature)

    def box(self) -> tuple[Any, Any, Any, Any]:
        """Left, bottom, right, top (m) of the positions of a ball's centre when it touches."""
        margin = self.reach + TOUCHING_GAP
        return (
            minimum(self.ax, self.bx) - margin,
            minimum(self.ay, self.by) - margin,
            maximum(self.ax, self.bx) + margin,
            maximum(self.ay, self.by) + margin,
        )


def _prepare(shape: Segment | Circle, radius: float) -> tuple[Outline, tuple[float, float, float, float]]:
    """An outline and its box."""
    outline = Outline.of(shape, radius)
    return outline, outline.box()


#: The same; cached, since a scene's shapes are the same in every run.
_prepared = lru_cache(maxsize=4096)(_prepare)


class Obstacle:
    """A surface, prepared for one ball radius; touched when a ball overlaps it by ``skin`` (m)."""

    moves = False

    def __init__(
        self, surface: Surface, radius: float, skin: float = SKIN, shape: Segment | Circle | None = None
    ) -> None:
        """``shape`` is where the surface is now, if it moves."""
        self.surface = surface
        self.skin = skin
        self.shape = shape or surface.shape
        self.outline, self.box = _prepared(self.shape, radius) if shape is None else _prepare(shape, radius)

    def at(self, t: float) -> Obstacle:
        """The obstacle where it is at time t in s."""
        return self

    def reaches(self, x: float, y: float, gap: float) -> bool:
        """False if a ball centred at (x, y) is farther from it than a ``gap`` in m, wherever it is."""
        left, bottom, right, top = self.box
        return left <= x + gap and x - gap <= right and bottom <= y + gap and y - gap <= top

    def velocity_at(self, point: Point) -> tuple[float, float]:
        """The velocity in m/s of the point of the surface that is at a place in m."""
        return 0.0, 0.0

    def near(self, x: float, y: float) -> Touching:
        """The nearest feature to a ball centred at (x, y), with gap and normal."""
        return self.outline.near(x, y)

    def next_feature(self, touching: Touching, x: float, y: float, mx: float, my: float) -> Touching:
        """The feature that a ball touching here will be on when it moves along (mx, my): at the seam of side and corner
        it touches both."""
        outline = self.outline
        if outline.length == 0.0:
            return touching
        along = outline.along(x, y)
        forward = mx * outline.tx + my * outline.ty
        if abs(along) <= SEAM:
            return self.on_feature(_CORNER_A if forward < 0.0 else SIDE, x, y)
        if abs(along - outline.length) <= SEAM:
            return self.on_feature(_CORNER_B if forward > 0.0 else SIDE, x, y)
        return touching

    def edge(self, feature: int, arc: Arc) -> float | None:
        """The first u at which a ball that stays on the feature reaches its end, or None."""
        length = self.outline.length
        if length == 0.0:
            return None
        along = [self.outline.along(x, y) for x, y in zip(arc.x, arc.y, strict=True)]
        ends = {
            SIDE: (along, [length - s for s in along]),
            _CORNER_A: ([-s for s in along],),
            _CORNER_B: ([s - length for s in along],),
        }
        u = min([crossing(end, -1.0) for end in ends[feature]])
        return u if u < inf else None

    def on_feature(self, feature: int, x: float, y: float) -> Touching:
        """Gap and normal of a ball centred at (x, y) to this feature."""
        return self.outline.side(x, y) if feature == SIDE else self.outline.corner(feature, x, y)

    def tilt_from_side(self, nx: float, ny: float) -> float:
        """Return how far a normal at its corner is tilted from its side's. Where surfaces share a corner, that with
        the least tilt acts, which the ball is more nearly above, however they are listed."""
        outline = self.outline
        return round(abs(nx * outline.tx + ny * outline.ty), 9) if outline.length > 0.0 else 0.0

    def first_touch(self, arc: Arc) -> float | None:
        """The first u in [0, 1] of the arc at which the ball starts to touch, or None."""
        u = first_touch(self.outline, arc.curves[0], arc.curves[1], self.skin)
        return u if u < inf else None


Near = tuple[Obstacle, Touching]


def touched(obstacles: Sequence[Obstacle], x: float, y: float, gap: float = TOUCHING_GAP) -> list[Near]:
    """Return those that a ball centred at (x, y) touches, up to a ``gap`` in m, each at its nearest feature."""
    found = []
    west, south, east, north = x - gap, y - gap, x + gap, y + gap
    for obstacle in obstacles:
        left, bottom, right, top = obstacle.box
        if right >= west and left <= east and bottom <= north and top >= south:
            touching = obstacle.near(x, y)
            if touching.gap <= gap:
                found.append((obstacle, touching))
    return found


def balls_touch(first: Arc, second: Arc, reach: float, t: float, skin: float = SKIN) -> float | None:
    """The first time from t on, while both arcs are followed, at which two balls overlap by ``skin``, or None.

    ``reach`` is the distance in m of their centres when they touch.
    """
    until = min(first.truncated_at, second.truncated_at)
    if until <= t:
        return None
    (ax, ay), (bx, by) = first.position(t), second.position(t)
    ex, ey = ax - bx, ay - by
    apart = sqrt(ex * ex + ey * ey)
    _, _, vx, vy, *_ = first.curves
    _, _, ux, uy, *_ = second.curves
    # along the line of their centres at t
    fastest = max([x * ex + y * ey for x, y in zip(ux, uy, strict=True)]) - min(
        [x * ex + y * ey for x, y in zip(vx, vy, strict=True)]
    )
    if (apart - reach) * apart > (until - t) * fastest:
        return None
    xs, ys = _between(first, t, until)
    us, vs = _between(second, t, until)
    degree = max(len(xs), len(us)) - 1
    dx = [a - b for a, b in zip(elevate(xs, degree), elevate(us, degree), strict=True)]
    dy = [a - b for a, b in zip(elevate(ys, degree), elevate(vs, degree), strict=True)]
    u = first_within(dx, dy, reach - skin)
    return t + u * (until - t) if u < inf else None


def _between(arc: Arc, t: float, until: float) -> tuple[Sequence[float], Sequence[float]]:
    if t <= arc.t0 and until >= arc.t1:
        return arc.x, arc.y
    h = arc.t1 - arc.t0
    u0 = max(0.0, (t - arc.t0) / h)
    u1 = min(1.0, (until - arc.t0) / h)
    return piece(arc.x, u0, u1), piece(arc.y, u0, u1)
