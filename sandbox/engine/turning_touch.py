"""When outlines that move and turn first touch: conservative advancement.

Two outlines are apart as long as one strip of fixed direction n lies between them. Its width is a sum of paths of
points,

    s(t) = n . (c1 - c2) + min_i n . R1 p_i - max_j n . R2 q_j - r1 - r2,

with the points p_i and q_j of the two cores, each of which has, from its speed now and a bound K on its acceleration
for the rest of the arc, the bound ``s_ij(t + h) >= s_ij + s_ij' h - K h^2 / 2``. The first zero of the least of them is
a time up to which nothing touches, whatever turns; there n is chosen anew. It converges quadratically, and misses
nothing: no grazing touch, no fast spin. Mirtich 1996 (conservative advancement), Catto 2013 (``b2TimeOfImpact``); the
bound is second order here, in place of one by speed alone.
"""

from __future__ import annotations

from math import atan2, cos, hypot, inf, sin, sqrt
from typing import NamedTuple

from sandbox.engine.accuracy import SKIN
from sandbox.engine.arc import Arc, still
from sandbox.engine.nearest import Nearest, Pose, nearest
from sandbox.engine.shapes import Shape
from sandbox.physics.integrators import State

#: Gap in m that is rounding, for coordinates of up to some metres; speed of approach in m/s that is.
_NOISE, _STILL = 1e-13, 1e-9

#: Depth in m by which outlines that touch and do not approach may overlap before that is noticed.
_UNSEEN = 1e-12

#: Most advances. A touch needs five to ten; outlines that stay within rounding of each other need many.
_MOST = 20_000


#: A time in s that no run reaches.
_EVER = 1e300

#: Distance in m within which two points of an outline are equally near.
_SAME = 1e-10

Points = list[tuple[float, float]]


class Mover(NamedTuple):
    """An outline, and its path; or its place, if it does not move."""

    shape: Shape
    arc: Arc

    def at(self, t: float) -> tuple[Pose, State]:
        """Where it is at t, and how it moves."""
        state = self.arc.state(t)
        return pose_of(state), state

    def hurry(self) -> float:
        """A bound in m/s^2 on the acceleration of any of its points, seen from a fixed direction."""
        arc = self.arc
        h, shape = arc.t1 - arc.t0, self.shape
        if h <= 0.0:
            return 0.0
        ax, ay, turning = (
            max((abs(b - a) for a, b in zip(curve, curve[1:], strict=False)), default=0.0) * (len(curve) - 1) / h
            for curve in (arc.vx, arc.vy, arc.spin)
        )
        spin = max(map(abs, arc.spin))
        return hypot(ax, ay) + spin * spin * max(shape.reach, shape.straightest) + turning * shape.reach


def pose_of(state: State) -> Pose:
    """Where a ball or body is; balls do not say how far they are turned."""
    return Pose(state[0], state[1], state[5] if len(state) == 6 else 0.0)


def fixed(shape: Shape) -> Mover:
    """An outline that stays where it is."""
    return Mover(shape, still(_EVER, _EVER, (0.0, 0.0, 0.0, 0.0, 0.0)))


def first_touch(one: Mover, other: Mover, t: float, until: float, skin: float = SKIN) -> float | None:
    """The first time from t on at which two outlines overlap by ``skin`` (m), or None. Where they overlap by more at
    t, it is when they come to overlap by more than then."""
    hurry = one.hurry() + other.hurry()
    least = sqrt(2.0 * _UNSEEN / hurry) if hurry > 0.0 else inf
    found: Nearest | None = None
    for _ in range(_MOST):
        (here, motion), (there, other_motion) = one.at(t), other.at(t)
        noise = _NOISE * (1.0 + 0.1 * (abs(here.x) + abs(here.y)))
        if found is None:
            found = nearest(one.shape, here, other.shape, there)
            skin = max(skin, noise - found.gap)
        else:
            found = nearest(one.shape, here, other.shape, there, found.direction)
        normal = found.nx, found.ny
        gap = found.gap + skin
        sides = _points(one.shape, here, motion, normal, -1.0), _points(other.shape, there, other_motion, normal, 1.0)
        step, approach = _apart_for(gap, *sides, hurry, until - t)
        if gap <= 2.0 * noise:
            if approach > _STILL:
                return t
            step = max(step, least)
        if t + step >= until:
            return None
        if t + step == t:
            return t
        t += step
    return t


def _points(shape: Shape, at: Pose, motion: State, normal: tuple[float, float], way: float) -> Points:
    """Of each point of a core that may be the nearest: how far it is behind the nearest, in m, and the speed in m/s at
    which it moves towards the other outline, which lies ``way`` along the normal."""
    c, s = way * cos(at.angle), way * sin(at.angle)
    nx, ny = c * normal[0] + s * normal[1], c * normal[1] - s * normal[0]
    forward = way * (motion[2] * normal[0] + motion[3] * normal[1])
    spin = motion[4]
    points = [(x * nx + y * ny, forward + spin * (x * ny - y * nx)) for x, y in shape.candidates(atan2(ny, nx))]
    front = max(ahead for ahead, _ in points)
    return [(front - ahead, speed) for ahead, speed in points]


def _apart_for(
    gap: float, ones: Points, others: Points, hurry: float, until: float
) -> tuple[float, float]:
    """For how long, up to ``until`` s, the strip stays open; and the speed at which it closes now.

    The bound is concave in time, so the zeros of its parts, each at the time of the last, come down to its first.
    """
    approach = max(v for behind, v in ones if behind <= _SAME) + max(v for behind, v in others if behind <= _SAME)
    h = until
    for _ in range(len(ones) + len(others) + 2):
        behind, speed = min(ones, key=lambda point: point[0] - point[1] * h)
        behind_too, speed_too = min(others, key=lambda point: point[0] - point[1] * h)
        room, closing = max(gap + behind + behind_too, 0.0), speed + speed_too
        if room - closing * h - 0.5 * hurry * h * h >= 0.0:
            break
        root = sqrt(closing * closing + 2.0 * hurry * room)
        closer = 2.0 * room / (root + closing) if closing > 0.0 else (root - closing) / hurry
        if closer >= h:
            break
        h = closer
    return h, approach
