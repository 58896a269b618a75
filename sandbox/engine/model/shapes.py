"""Convex outlines of bodies that move: polygons, rounded or not, capsules, discs and ellipses.

An outline is a core and a rounding radius around it. The core of a polygon is its corners, of a capsule two points, of
a disc one; that of an ellipse is the ellipse itself. All questions about an outline are answered by its support: the
point of the core that lies farthest in a direction. Along the directions the support of a polygon stays at a corner
and jumps at the normal of each side; the support of an ellipse moves smoothly.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import atan2, cos, hypot, inf, isfinite, pi, sin, sqrt
from numbers import Integral
from types import SimpleNamespace
from typing import NamedTuple

from sandbox.engine.model.tolerances import ROUNDING
from sandbox.physics.checks import check, short

Vector = tuple[float, float]

#: Share of the distance of a side from the centre that rounding its corners may take.
_SHALLOW = 1e-3

#: Corners of the polygon that stands for an ellipse where only polygons will do.
_CORNERS = 64


class _MassProperties(NamedTuple):
    """The mass properties of an outline, per unit of mass per area."""

    area: float  # m^2
    center: Vector  # m, of mass
    moment: float  # m^4, about the centre


@dataclass(frozen=True)
class Polygon:
    """A convex polygon, rounded by a disc of ``radius`` that runs along its sides: it is larger by that much all
    around. Its corners go around counter-clockwise; two are a capsule, one is a disc.

    >>> from sandbox import Body, Polygon
    >>> wedge = Body("wedge", position=(0, 0), shape=Polygon([(0, 0), (0.4, 0), (0, 0.3)]), density=10.0)
    >>> round(wedge.mass, 6)  # kg
    0.6
    """

    corners: Sequence[Vector]  # m
    radius: float = 0.0  # m
    normals: tuple[float, ...] = field(init=False, repr=False, compare=False)  # rad, of each corner's next side
    reach: float = field(init=False, repr=False, compare=False)  # m, from the origin to the farthest point

    def __post_init__(self) -> None:
        try:
            corners = [(float(x), float(y)) for x, y in self.corners]
        except (TypeError, ValueError):
            corners = []
        if not corners or not all(map(isfinite, (x for corner in corners for x in corner))):
            raise ValueError(f"polygon: corners = {short(self.corners)} must be points in m, [(x, y), ...], and finite")
        check("polygon", self, not_negative=["radius"])
        if _area(corners) < 0.0:
            corners.reverse()
        normals: list[float] = []
        for (ax, ay), (bx, by) in _sides(corners):
            normal = atan2(ax - bx, by - ay)
            normals.append(normal if not normals else normals[-1] + (normal - normals[-1]) % (2.0 * pi))
        turns = [
            (after - before) % (2.0 * pi) for before, after in zip(normals, normals[1:] + normals[:1], strict=True)
        ]
        if len(corners) > 1 and (
            len({*corners}) < len(corners)
            or abs(sum(turns) - 2.0 * pi) > 1e-6
            or any(sin(turn) < ROUNDING for turn in turns if len(corners) > 2)
        ):
            raise ValueError(f"{self}: must be convex, each corner turning the same way")
        object.__setattr__(self, "corners", tuple(corners))
        object.__setattr__(self, "normals", tuple(normals))
        object.__setattr__(self, "reach", max(hypot(x, y) for x, y in corners) + self.radius)

    def moved(self, dx: float, dy: float) -> Polygon:
        """The same outline elsewhere."""
        return replace(self, corners=tuple((x + dx, y + dy) for x, y in self.corners))

    def rounded(self, by: float) -> Polygon:
        """The same sides, with corners rounded by up to ``by`` (m) more: the core is smaller by as much."""
        out = [(cos(normal), sin(normal)) for normal in self.normals]
        reaches = [x * nx + y * ny for (x, y), (nx, ny) in zip(self.corners, out, strict=False)]
        by = min([by, *(_SHALLOW * reach for reach in reaches)])
        if len(self.corners) < 3 or by <= 0.0:
            return self
        corners = []
        for (x, y), (ax, ay), (cx, cy) in zip(self.corners, [out[-1], *out], out, strict=False):
            inward = by / (1.0 + ax * cx + ay * cy)
            corners.append((x - inward * (ax + cx), y - inward * (ay + cy)))
        return Polygon(corners, self.radius + by)

    def mass_properties(self) -> _MassProperties:
        """The sum of the polygon, a rectangle along each side, and a sector of a disc at each corner."""
        r = self.radius
        parts: list[_MassProperties] = []
        (ox, oy), corners = self.corners[0], self.corners
        for (ax, ay), (bx, by) in pairwise(corners[1:]):
            ax, ay, bx, by = ax - ox, ay - oy, bx - ox, by - oy  # a triangle at the first corner
            area, x, y = 0.5 * (ax * by - ay * bx), (ax + bx) / 3.0, (ay + by) / 3.0
            about_corner = area * (ax * (ax + bx) + bx * bx + ay * (ay + by) + by * by) / 6.0
            parts.append(_MassProperties(area, (ox + x, oy + y), about_corner - area * (x * x + y * y)))
        for number, ((ax, ay), (bx, by)) in enumerate(_sides(corners)):
            if r == 0.0:
                break
            length, normal = hypot(bx - ax, by - ay), self.normals[number]
            center = 0.5 * (ax + bx + r * cos(normal)), 0.5 * (ay + by + r * sin(normal))
            parts.append(_MassProperties(length * r, center, length * r * (length * length + r * r) / 12.0))
            turn = (normal - self.normals[number - 1]) % (2.0 * pi)
            middle, out = normal - 0.5 * turn, 4.0 * r * sin(0.5 * turn) / (3.0 * turn)
            area = 0.5 * turn * r * r
            center = ax + out * cos(middle), ay + out * sin(middle)
            parts.append(_MassProperties(area, center, area * (0.5 * r * r - out * out)))
        if len(corners) == 1:
            parts.append(_MassProperties(pi * r * r, (ox, oy), 0.5 * pi * r**4))
        area = sum(part.area for part in parts)
        if area == 0.0:
            return _MassProperties(0.0, self.corners[0], 0.0)
        x, y = (sum(part.area * part.center[axis] for part in parts) / area for axis in (0, 1))
        moment = sum(
            part.moment + part.area * ((part.center[0] - x) ** 2 + (part.center[1] - y) ** 2) for part in parts
        )
        return _MassProperties(area, (x, y), moment)

    def corner_towards(self, angle: float) -> int:
        """Return the number of the corner that is farthest in a direction (rad)."""
        if not self.normals:
            return 0
        first = self.normals[0]
        return bisect_right(self.normals, first + (angle - first) % (2.0 * pi)) % len(self.normals)

    def to_next(self, corner: int, angle: float, way: float) -> float:
        """Return the angle in rad by which a direction may turn, counter-clockwise if ``way`` is 1, clockwise if -1,
        until another corner is the farthest."""
        if not self.normals:
            return inf
        side = corner if way > 0.0 else corner - 1
        left = way * (self.normals[side] - angle) % (2.0 * pi)
        return left if left < 1.5 * pi else 0.0  # rounding: it has just passed

    def after(self, corner: int, way: float) -> int:
        """The next corner that way around."""
        return (corner + int(way)) % len(self.corners)

    def support(self, corner: int, angle: float) -> Vector:
        """The point of the core that is farthest in a direction, of which the corner is known; in m."""
        return self.corners[corner]

    def candidates(self, angle: float) -> Sequence[Vector]:
        """The points of the core that may be the farthest, after it has turned."""
        return self.corners

    def bend(self, angle: float) -> float:
        """Radius in m of the core's curvature at the support."""
        return 0.0

    @property
    def straightest(self) -> float:
        """The largest radius in m of the core's curvature."""
        return 0.0

    def rim(self, within: float) -> list[Vector]:
        """Points around the outline, counter-clockwise, in m, that leave less than ``within`` (m) of an arc out."""
        if self.radius == 0.0:
            return list(self.corners)
        r = self.radius
        points: list[Vector] = []
        normals = self.normals or (0.0,)
        for number, (x, y) in enumerate(self.corners):
            start = normals[number - 1]
            turn = (normals[number] - start) % (2.0 * pi) or 2.0 * pi
            count = _parts(r, turn, within)
            points += [
                (x + r * cos(start + turn * k / count), y + r * sin(start + turn * k / count)) for k in range(count + 1)
            ]
        return points if self.normals else points[:-1]

    def as_polygon(self) -> Polygon:
        """Itself."""
        return self


@dataclass(frozen=True)
class Ellipse:
    """An ellipse with semi-axes ``a`` along its own x and ``b`` along its own y.

    >>> from sandbox import Ellipse
    >>> round(Ellipse(0.14, 0.085).mass_properties().area, 6)  # m^2
    0.037385
    """

    a: float  # m
    b: float  # m
    center: Vector = (0.0, 0.0)  # m
    radius: float = field(init=False, repr=False, compare=False, default=0.0)  # m, of the rounding: none
    normals: tuple[float, ...] = field(init=False, repr=False, compare=False, default=())  # of straight sides: none
    reach: float = field(init=False, repr=False, compare=False)  # m, from the origin at least to the farthest point

    def __post_init__(self) -> None:
        check("ellipse", self, positive=["a", "b"], points=["center"])
        object.__setattr__(self, "reach", hypot(*self.center) + max(self.a, self.b))

    def moved(self, dx: float, dy: float) -> Ellipse:
        """The same outline elsewhere."""
        return replace(self, center=(self.center[0] + dx, self.center[1] + dy))

    def mass_properties(self) -> _MassProperties:
        """``pi a b``, and ``m (a^2 + b^2) / 4``."""
        area = pi * self.a * self.b
        return _MassProperties(area, self.center, 0.25 * area * (self.a**2 + self.b**2))

    def corner_towards(self, angle: float) -> int:
        """Its one piece."""
        return 0

    def to_next(self, corner: int, angle: float, way: float) -> float:
        """There is no other piece."""
        return inf

    def after(self, corner: int, way: float) -> int:
        """Its one piece."""
        return 0

    def support(self, corner: int, angle: float) -> Vector:
        """The point that is farthest in a direction, in m."""
        x, y = self.a * cos(angle), self.b * sin(angle)
        size = sqrt(x * x + y * y)
        return self.center[0] + self.a * x / size, self.center[1] + self.b * y / size

    def candidates(self, angle: float) -> Sequence[Vector]:
        """The support: it moves smoothly."""
        return (self.support(0, angle),)

    def bend(self, angle: float) -> float:
        """Radius in m of curvature at the support, ``a^2 b^2 / h^3`` with h the distance of the tangent."""
        return self.a**2 * self.b**2 / hypot(self.a * cos(angle), self.b * sin(angle)) ** 3

    @property
    def straightest(self) -> float:
        """The largest radius of curvature in m."""
        return max(self.a, self.b) ** 2 / min(self.a, self.b)

    def rim(self, within: float) -> list[Vector]:
        """Points around the outline, counter-clockwise, in m, that leave less than ``within`` (m) of an arc out."""
        (x, y), count = self.center, _parts(max(self.a, self.b), 2.0 * pi, within)
        turns = [2.0 * pi * k / count for k in range(count)]
        return [(x + self.a * cos(turn), y + self.b * sin(turn)) for turn in turns]

    def as_polygon(self) -> Polygon:
        """A polygon of the same area."""
        (x, y), turn = self.center, pi / _CORNERS
        out = sqrt(turn / sin(turn) / cos(turn))
        turns = [2.0 * turn * k for k in range(_CORNERS)]
        return Polygon([(x + out * self.a * cos(at), y + out * self.b * sin(at)) for at in turns])


Shape = Polygon | Ellipse


def box(width: float, height: float, rounding: float = 0.0) -> Polygon:
    """A rectangle, whose corners are rounded with this radius; lengths in m.

    >>> from sandbox import box
    >>> box(0.4, 0.3).corners
    ((-0.2, -0.15), (0.2, -0.15), (0.2, 0.15), (-0.2, 0.15))
    """
    sides = SimpleNamespace(width=width, height=height, rounding=rounding)
    check("box", sides, positive=["width", "height"], not_negative=["rounding"])
    x, y = 0.5 * width - rounding, 0.5 * height - rounding
    if min(x, y) < 0.0:
        raise ValueError(f"box of {width} m x {height} m: rounding = {rounding} m is more than half of a side")
    corners = {(-x, -y): None, (x, -y): None, (x, y): None, (-x, y): None}
    return Polygon(tuple(corners), rounding)


def capsule(length: float, radius: float) -> Polygon:
    """A straight rod with round ends, of this length in all; lengths in m.

    >>> from sandbox import capsule
    >>> capsule(0.4, 0.05).reach  # m
    0.2
    """
    check("capsule", SimpleNamespace(length=length, radius=radius), positive=["length", "radius"])
    return box(length, 2.0 * radius, radius)


def disc(radius: float) -> Polygon:
    """A disc; lengths in m.

    >>> from sandbox import disc
    >>> disc(0.1).reach  # m
    0.1
    """
    return Polygon(((0.0, 0.0),), radius)


def regular(count: int, radius: float, rounding: float = 0.0) -> Polygon:
    """A regular polygon whose corners lie on a circle of this radius (m).

    >>> from sandbox import regular
    >>> len(regular(6, 0.1).corners)
    6
    """
    check("regular polygon", SimpleNamespace(radius=radius), positive=["radius"])
    if not isinstance(count, int | Integral) or count < 3:
        raise ValueError(f"regular polygon: count = {short(count)} must be a whole number, 3 or more")
    turns = [2.0 * pi * k / count for k in range(count)]
    return Polygon([(radius * cos(turn), radius * sin(turn)) for turn in turns], rounding)


def _sides(corners: Sequence[Vector]) -> list[tuple[Vector, Vector]]:
    """The ends of each side, from each corner to the next; a single corner has none."""
    return list(zip(corners, [*corners[1:], corners[0]], strict=True)) if len(corners) > 1 else []


def _area(corners: Sequence[Vector]) -> float:
    return 0.5 * sum(ax * by - ay * bx for (ax, ay), (bx, by) in _sides(corners))


def _parts(radius: float, turn: float, within: float) -> int:
    """In how many straight parts to draw an arc."""
    return max(1, int(turn * sqrt(radius / (8.0 * within)) + 1.0))
