"""Time of impact of outlines that move and turn: conservative advancement.

Two outlines are apart as long as one strip lies between them. Let the strip be fixed to one of the two, at right angles
to their nearest points, and turn with it. Seen from there each point p_i of the other's core comes nearer on a path of
its own: with its distance s_i, its speed s_i' now and a bound K on s_i'' for the rest of the arc,

    s_i(t + h) >= s_i + s_i' h - K h^2 / 2.

The first zero of the least of these is a time up to which nothing touches, whatever turns; there the strip is chosen
anew. It converges quadratically, and misses nothing: no grazing touch, no fast spin. Of the two outlines that which
allows the longer step carries the strip: where a long side turns away from a small body, it has to be the side.

Mirtich 1996 (conservative advancement), Catto 2013 (``b2TimeOfImpact``). The bound here is of second order, in place
of one by speed alone.
"""

from __future__ import annotations

from math import atan2, cos, hypot, inf, sin, sqrt
from typing import NamedTuple

from sandbox.engine.model.nearest import Nearest, Pose, nearest
from sandbox.engine.model.shapes import Shape
from sandbox.engine.model.tolerances import CLOSING, EQUALLY_NEAR, GAP_ROUNDING, NEGLIGIBLE_OVERLAP, SKIN
from sandbox.engine.paths.arc import Arc, resting_arc
from sandbox.engine.paths.bernstein import derivative
from sandbox.physics.integrators import State

#: Most advances. A touch needs five to ten; outlines that stay within rounding of each other need many.
_MOST = 20_000

#: A time in s that no run reaches.
_EVER = 1e300


class OutlineOnArc(NamedTuple):
    """An outline, and its path; or its place, if it does not move."""

    shape: Shape
    arc: Arc

    def bounds(self) -> _Bounds:
        """Return bounds that are not exceeded on the arc."""
        arc = self.arc
        h = arc.t1 - arc.t0
        if h <= 0.0:
            return _Bounds(0.0, (), 0.0, 0.0, 0.0)
        _, _, vx, vy, spin, *_ = arc.curves
        ax, ay, turning = ([slope / h for slope in derivative(curve)] for curve in (vx, vy, spin))
        largest, fastest_turn, turning_up = max(map(hypot, ax, ay)), max(map(abs, spin)), max(map(abs, turning))
        return _Bounds(arc.fastest(), tuple(zip(ax, ay, strict=True)), largest, fastest_turn, turning_up)


class _Bounds(NamedTuple):
    """Bounds of a body's motion."""

    speed: float  # m/s
    accelerations: tuple[tuple[float, float], ...]  # m/s^2; it is always between these
    largest: float  # m/s^2, of these
    spin: float  # rad/s
    turning: float  # rad/s^2

    def acceleration(self, nx: float, ny: float) -> float:
        """The largest along a fixed normal, in m/s^2."""
        return max([abs(ax * nx + ay * ny) for ax, ay in self.accelerations], default=0.0)


def fixed(shape: Shape) -> OutlineOnArc:
    """An outline that stays where it is."""
    return OutlineOnArc(shape, resting_arc(_EVER, _EVER, (0.0, 0.0, 0.0, 0.0, 0.0)))


def pose_of(state: State) -> Pose:
    """Return the position and angle of a ball or body; a ball has none."""
    return Pose(state[0], state[1], state[5] if len(state) == 6 else 0.0)


def first_touch(
    one: OutlineOnArc, other: OutlineOnArc, t: float, until: float, skin: float = SKIN, direction: float | None = None
) -> float | None:
    """The first time from t on at which two outlines overlap by ``skin`` (m), or None. Where they overlap by more at
    t, it is when they come to overlap by more than then. ``direction`` is a guess of that of the normal, in rad."""
    bounds, found = (one.bounds(), other.bounds()), None
    for _ in range(_MOST):
        motion, other_motion = one.arc.state(t), other.arc.state(t)
        here, there = pose_of(motion), pose_of(other_motion)
        noise = GAP_ROUNDING * (1.0 + 0.1 * (abs(here.x) + abs(here.y)))
        if found is None:
            found = nearest(one.shape, here, other.shape, there, direction)
            skin = max(skin, noise - found.gap)
        else:
            found = nearest(one.shape, here, other.shape, there, found.direction)
        gap, rest = found.gap + skin, until - t
        step, approach, bound = _safe_step(one.shape, motion, other_motion, found, -1.0, gap, bounds, rest)
        if step < rest:
            seen = _safe_step(other.shape, other_motion, motion, found, 1.0, gap, bounds[::-1], rest)
            step, approach, bound = max(step, seen[0]), min(approach, seen[1]), min(bound, seen[2])
        if gap <= 2.0 * noise:
            if approach > CLOSING:
                return t
            step = max(step, sqrt(2.0 * NEGLIGIBLE_OVERLAP / bound)) if bound > 0.0 else inf
        if t + step >= until:
            return None
        if t + step == t:
            return t
        t += step
    return t


def _safe_step(
    shape: Shape,
    motion: State,
    frame: State,
    found: Nearest,
    side: float,
    gap: float,
    bounds: tuple[_Bounds, ...],
    until: float,
) -> tuple[float, float, float]:
    """Return the time, up to ``until`` s, in which nothing of an outline reaches the strip that another carries; the
    speed in m/s at which the nearest points approach; and the bound K in m/s^2.

    The strip is ahead along the normal if ``side`` is 1, against it if it is -1.
    """
    x, y, vx, vy, spin, *turned = motion
    u, v, ux, uy, frame_spin, *_ = frame
    c, s = (cos(turned[0]), sin(turned[0])) if turned else (1.0, 0.0)
    nx, ny = side * found.nx, side * found.ny
    bx, by = c * nx + s * ny, c * ny - s * nx  # the normal, seen from the body
    # of the body's centre, as seen from the frame
    forward = (vx - ux) * nx + (vy - uy) * ny + frame_spin * ((y - v) * nx - (x - u) * ny)
    turns = spin - frame_spin
    ahead = [(px * bx + py * by, px * by - py * bx) for px, py in shape.candidates(atan2(by, bx))]
    front = max(ahead)[0]

    own, others = bounds
    size = max(shape.reach - shape.radius, shape.straightest)  # of the core: a disc's spin moves no point of it
    apart = hypot(x - u, y - v) + until * (own.speed + others.speed)
    bound = _acceleration_bound(own, others, size, apart, nx, ny)
    step, approach = until, -inf
    for distance, across in ahead:
        behind, speed = front - distance, forward + turns * across
        if behind <= EQUALLY_NEAR:
            approach = max(approach, speed)
        room = max(gap + behind, 0.0)
        if room - speed * step - 0.5 * bound * step * step < 0.0:
            root = sqrt(speed * speed + 2.0 * bound * room)
            step = min(step, 2.0 * room / (root + speed) if speed > 0.0 else (root - speed) / bound)
    return step, approach, bound


def _acceleration_bound(own: _Bounds, others: _Bounds, size: float, apart: float, nx: float, ny: float) -> float:
    """Return the bound K in m/s^2 on s_i'', for points at most ``size`` (m) from the centre of their own outline, which
    is at most so far ``apart`` (m) from the centre of the strip's; with the normal of the strip."""
    bound = size * (own.spin**2 + own.turning)
    if others.spin == 0.0:  # the normal does not turn
        return bound + (own.acceleration(nx, ny) + others.acceleration(nx, ny))
    bound += own.largest + others.largest
    bound += 2.0 * others.spin * (own.speed + others.speed + size * own.spin)
    return bound + (others.spin**2 + others.turning) * (apart + size)
