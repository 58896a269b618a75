"""The distance of two outlines, its direction, and the points at which they touch.

For a unit vector n from one outline to the other let ``s(n) = n . (q - p)`` with p and q their supports towards each
other: they lie on different sides of a strip of that width. Their distance is the largest s. Where s > 0 it has one
maximum, and it is found exactly: n turns towards w = q - p, from one pair of features to the next, until it is parallel
to w (two corners, or curved sides) or w changes to its other side where the support jumps (a straight side). The
starting direction is that of the last call, so mostly the features are known at once.

Valid for outlines apart or in touch; for outlines that overlap, s is minus the least depth. Compare Gilbert, Johnson &
Keerthi 1988, IEEE J. Robot. Autom. 4:193, which finds the same points for any convex sets.
"""

from __future__ import annotations

from math import atan2, cos, inf, pi, sin
from typing import NamedTuple

from sandbox.engine.model.shapes import Ellipse, Shape, Vector
from sandbox.engine.model.tolerances import EQUALLY_NEAR, SHALLOW

#: Most pieces to walk over and most Newton steps; each of them needs two or three.
_MOST = 200

#: After a Newton step shorter than this (rad) the error is rounding.
_CONVERGED = 1e-8


class Pose(NamedTuple):
    """The position of an outline's origin, and its angle."""

    x: float  # m
    y: float  # m
    angle: float  # rad


class Nearest(NamedTuple):
    """The distance of two outlines: the unit normal points from the second to the first."""

    gap: float  # m, negative where they overlap
    nx: float
    ny: float
    direction: float  # rad, of the normal; a start for the next time


def nearest(one: Shape, here: Pose, other: Shape, there: Pose, direction: float | None = None) -> Nearest:
    """The distance and direction of two outlines. ``direction`` is a guess of that of the normal, in rad."""
    start = atan2(here.y - there.y, here.x - there.x) if direction is None else direction
    found = _climbed(one, here, other, there, start)
    if found.gap > -SHALLOW or found.gap + one.radius + other.radius > 0.0:
        return found
    # not certain to be the best. Where cores overlap, that of polygons has the normal of a side; of ellipses any
    sides = [pi + here.angle + normal for normal in one.normals]
    sides += [there.angle + normal for normal in other.normals]
    starts = [max(sides, key=lambda at: _strip(one, here, other, there, at))] if sides else []
    if isinstance(one, Ellipse) or isinstance(other, Ellipse):
        starts = [*sides, *(start + 0.25 * pi * k for k in range(1, 8))]
    return max((found, *(_climbed(one, here, other, there, start) for start in starts)), key=lambda it: it.gap)


def _strip(one: Shape, here: Pose, other: Shape, there: Pose, at: float) -> float:
    """The width in m of the strip between the cores whose normal has this direction."""
    (x, y, turned), (u, v, turn) = here, there
    nx, ny, near, far = cos(at), sin(at), at - turned + pi, at - turn
    px, py = one.support(one.corner_towards(near), near)
    qx, qy = other.support(other.corner_towards(far), far)
    c, s, k, z = cos(near), sin(near), cos(far), sin(far)
    return (x - u) * nx + (y - v) * ny - c * px - s * py - k * qx - z * qy


def _climbed(one: Shape, here: Pose, other: Shape, there: Pose, at: float) -> Nearest:
    """The largest separation that is reached by turning the normal from the direction ``at``."""
    (x, y, turned), (u, v, turn) = here, there
    c, s, k, z, turned = cos(turned), sin(turned), cos(turn), sin(turn), turned - pi

    def strip(at: float) -> tuple[float, float, float, float]:
        """The normal, and the parts of w along it and at right angles."""
        px, py = one.support(i, at - turned)
        qx, qy = other.support(j, at - turn)
        wx, wy = x - u + c * px - s * py - k * qx + z * qy, y - v + s * px + c * py - z * qx - k * qy
        nx, ny = cos(at), sin(at)
        return nx, ny, nx * wx + ny * wy, nx * wy - ny * wx

    i, j = one.corner_towards(at - turned), other.corner_towards(at - turn)
    way, low, high = 0.0, -inf, inf  # the way to turn; directions between which the best is, where a side is curved
    for _ in range(_MOST):
        nx, ny, apart, slope = strip(at)
        if slope * way < 0.0 or slope == 0.0:  # past a straight side, whose normal this is; or parallel
            return Nearest(apart - one.radius - other.radius, nx, ny, at)
        way = 1.0 if slope > 0.0 else -1.0
        left, right = one.to_next(i, at - turned, way), other.to_next(j, at - turn, way)
        room, bend = min(left, right), one.bend(at - turned) + other.bend(at - turn)
        if bend == 0.0:
            by = abs(atan2(slope, apart))
            if by <= room:
                at += way * by
                break
        else:
            low, high = (at, high) if way > 0.0 else (low, at)
            by = min(abs(slope) / max(apart + bend, abs(slope)), high - at if way > 0.0 else at - low)
            if by < room or (room > 0.0 and strip(at + way * room)[3] * way <= 0.0):
                if by >= room:
                    low, high = (low, at + way * room) if way > 0.0 else (at + way * room, high)
                best = at + way * by
                if by <= _CONVERGED:
                    at = best
                    break
                at = best if low < best < high else 0.5 * (low + high)
                way = 0.0
                continue
        at += way * room
        if left <= right:
            i = one.after(i, way)
        else:
            j = other.after(j, way)
        low, high = -inf, inf
    nx, ny, apart, _ = strip(at)
    return Nearest(apart - one.radius - other.radius, nx, ny, at)


def meeting_points(one: Shape, here: Pose, other: Shape, there: Pose, normal: Vector, slack: float) -> list[Vector]:
    """One or two points where outlines touch, or are nearest: halfway between the two, in m. Sides that are parallel,
    so that no end is farther by more than ``slack`` (m), touch at both ends of the length that they share."""
    nx, ny = normal
    ends = []
    for shape, (x, y, angle), way in ((one, here, -1.0), (other, there, 1.0)):
        c, s = cos(angle), sin(angle)
        toward = atan2(way * ny, way * nx) - angle
        places = []
        for px, py in shape.candidates(toward):
            px, py = x + c * px - s * py, y + s * px + c * py
            places.append((px * ny - py * nx, px * nx + py * ny + way * shape.radius))  # along, and across the normal
        far = max(way * across for _, across in places)
        near = sorted(place for place in places if way * place[1] >= far - slack - EQUALLY_NEAR)
        ends.append((near[0], near[-1]))
    first, second = ends
    start, end = max(first[0][0], second[0][0]), min(first[1][0], second[1][0])
    sharp = first[0] == first[1] or second[0] == second[1] or end <= start  # a corner, or a curved side
    found = []
    for along in (0.5 * (start + end),) if sharp else (start, end):
        across, below = (_across(*pair, along) for pair in ends)
        middle = 0.5 * (across + below)
        found.append((across - below, (middle * nx + along * ny, middle * ny - along * nx)))
    least = min(found)[0]
    return [point for gap, point in found if gap <= least + slack + EQUALLY_NEAR]


def _across(start: Vector, end: Vector, along: float) -> float:
    """Return how far across a straight side is at a place along it."""
    length = end[0] - start[0]
    share = (along - start[0]) / length if length > 0.0 else 0.0
    return start[1] + min(max(share, 0.0), 1.0) * (end[1] - start[1])
