"""Surfaces that are driven: their motion as arcs, where they are at a time, and when a ball or body meets them.

A motion becomes arcs of degree 7 that match place and rates at four times each, within 1e-11 m of it: a ball meets the
arcs, so that times of impact are those of two paths, exact to rounding. A ball that stays on a surface which does not
turn is computed as seen from it: that is a ``Frame``.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from functools import cache
from math import comb, cos, hypot, isfinite, sin
from numbers import Real
from typing import Any, NamedTuple

from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.contact.turning_touch import OutlineOnArc, first_touch
from sandbox.engine.model.ball import Ball, outline_of
from sandbox.engine.model.motion import Motion, Placing, piece_of, stands_until, stays_within
from sandbox.engine.model.setup_errors import call_user_function
from sandbox.engine.model.shapes import Polygon, Vector
from sandbox.engine.model.surface import Circle, Segment, Surface
from sandbox.engine.model.tolerances import SKIN, TOUCHING_GAP
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.bernstein import derivative, elevate, evaluate, piece
from sandbox.errors import RunError
from sandbox.physics.integrators import Acceleration, State

#: How far an arc may be from the motion, as a share of its size, and of its speed; what rounding makes of the slope of
#: a size; the shortest and the longest in s.
_FITS, _DRIFT, _ROUNDING, _SHORTEST, _LONGEST = 1e-11, 1e-9, 1e-13, 1e-7, 1.0

#: A piece of a motion that lasts no longer than this, in s, and as a share of the time, is rounding.
_INSTANT = 1e-13

#: Most arcs of one motion, beyond which it is too fast for the run: some 20 s of computing.
_MOST_ARCS = 100_000

#: Degree of the arcs; they match the motion at so many nodes.
_DEGREE, _NODES = 7, (0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0)

#: Where on an arc it is compared with the motion.
_PROBES = (0.12, 0.31, 0.5, 0.78, 0.93)


class DrivenPath:
    """The motion of one surface as arcs, made as far as they are asked for. Their state has the angle, too."""

    def __init__(self, surface: Surface) -> None:
        assert surface.motion is not None
        self.about = surface.motion.about
        self.outline = _outline(surface.shape, self.about)
        self.box = stays_within(surface.motion, _points(surface.shape))  # m, of its line or centre
        self._name = surface.name
        self._motion = surface.motion
        self._arcs: list[Arc] = []
        self._starts: list[float] = []
        self._next = _LONGEST  # s, to try

    def at(self, t: float) -> Arc:
        """The arc at time t, of two that which begins then. None is made before the first time asked for."""
        while not self._arcs or self._arcs[-1].t1 <= t:
            start = self._arcs[-1].t1 if self._arcs else t
            arc = self._arc_from(start)
            self._arcs.append(arc)
            self._starts.append(start)
        return self._arcs[max(0, bisect_right(self._starts, t) - 1)]

    def between(self, start: float, end: float) -> Iterator[Arc]:
        """The arcs from one time to another."""
        t = start
        while t < end:
            arc = self.at(t)
            yield arc
            t = arc.t1

    def stands_until(self, t: float) -> float:
        """Until when in s it stands still from time t on; t if it moves."""
        return stands_until(self._motion, t)

    def breaks_at(self, arc: Arc) -> bool:
        """True if the velocity may jump where this arc ends: another motion takes over."""
        return piece_of(self._motion, arc.t0)[1] <= arc.t1

    def _arc_from(self, t: float) -> Arc:
        if len(self._arcs) >= _MOST_ARCS:
            what = f"the motion of {self._name!r} has taken {_MOST_ARCS:,} pieces of path"
            raise RunError(f"t = {t:.6g} s: {what}, the last {self._next:.2g} s long; shorten the duration")
        motion, until = piece_of(self._motion, t)
        if until - t <= _INSTANT * (1.0 + t):
            motion, until = piece_of(self._motion, until)
        h = min(self._next, until - t)
        while h > _SHORTEST or h == until - t:
            arc, fits = self._fitted(motion, t, h)
            if fits:
                self._next = min(2.0 * h, _LONGEST)
                if until - (t + h) < 1e-9 * h:
                    arc.t1 = until
                return arc
            h *= 0.5
        raise RunError(
            f"t = {t:.6g} s: the motion of {self._name!r} is not smooth, or its velocity is not the derivative of its "
            "place"
        )

    def _fitted(self, motion: Motion, t: float, h: float) -> tuple[Arc, bool]:
        """The arc from t for h s, and whether it follows the motion."""
        times = [t + node * h for node in _NODES]
        places, rates = [self._place(motion, at) for at in times], [self._rates(motion, at) for at in times]
        curves = [_interpolated([p[k] for p in places], [h * r[k] for r in rates]) for k in range(3)]
        speeds = [[slope / h for slope in derivative(curve)] for curve in curves]
        (x, y, angle), (vx, vy, spin) = curves, speeds
        start, end = (
            (place.x, place.y, rate.x, rate.y, rate.angle, place.angle)
            for place, rate in ((places[0], rates[0]), (places[-1], rates[-1]))
        )
        arc = Arc(t, t + h, start, (x, y, vx, vy, spin, angle), None, end)
        reach = self.outline.reach
        size = 1.0 + max(abs(place.x) + abs(place.y) + reach * abs(place.angle) for place in places)
        speed = 1.0 + max(abs(rate.x) + abs(rate.y) + reach * abs(rate.angle) for rate in rates)
        for probe in _PROBES:
            place, rate = self._place(motion, t + probe * h), self._rates(motion, t + probe * h)
            u, v, ux, uy, turning, turned = (evaluate(curve, probe) for curve in arc.curves)
            off = max(hypot(u - place.x, v - place.y), reach * abs(turned - place.angle))
            drift = max(hypot(ux - rate.x, uy - rate.y), reach * abs(turning - rate.angle))
            if off > _FITS * size or drift > _DRIFT * speed + _ROUNDING * size / h:
                return arc, False
        return arc, True

    def _place(self, motion: Motion, t: float) -> Placing:
        return self._checked(call_user_function(motion.place, "a motion's place is called as place(t)", t), t, "place")

    def _rates(self, motion: Motion, t: float) -> Placing:
        return self._checked(call_user_function(motion.rates, "a motion's rates are called as rates(t)", t), t, "rates")

    def _checked(self, found: Any, t: float, what: str) -> Placing:
        if not isinstance(found, Placing) or not all(isinstance(each, Real) and isfinite(each) for each in found):
            raise RunError(
                f"t = {t:.6g} s: the {what} of {self._name!r} must be a Placing of finite numbers, and is {found!r:.60}"
            )
        return found


@cache
def _matrix() -> Any:
    """The matrix from values and slopes at the nodes to Bernstein coefficients, shape (8, 8)."""
    import numpy as np  # here, not above: only runs with moving surfaces need it

    n = _DEGREE
    values = [[comb(n, k) * u**k * (1.0 - u) ** (n - k) for k in range(n + 1)] for u in _NODES]
    lower = [[comb(n - 1, k) * u**k * (1.0 - u) ** (n - 1 - k) for k in range(n)] for u in _NODES]
    slopes = [[n * (before - after) for before, after in zip([0.0, *row], [*row, 0.0], strict=True)] for row in lower]
    return np.linalg.inv(np.array(values + slopes))


def _interpolated(values: Sequence[float], slopes: Sequence[float]) -> list[float]:
    """The Bernstein coefficients of the polynomial with these values and slopes at the nodes."""
    first = values[0]
    found = [first + c for c in (_matrix() @ [*(v - first for v in values), *slopes]).tolist()]
    return [first, *found[1:-1], values[-1]]


class _Drive(NamedTuple):
    """The velocity field of a rigid surface at one time."""

    x: float  # m, of the point that has the velocity
    y: float
    vx: float  # m/s
    vy: float
    spin: float  # rad/s

    def velocity_at(self, point: Vector) -> Vector:
        """The velocity in m/s of what is at a point."""
        return self.vx - self.spin * (point[1] - self.y), self.vy + self.spin * (point[0] - self.x)


class MovingObstacle(Obstacle):
    """A surface that moves, prepared for one ball radius. Its outline is where it would be without its motion."""

    moves = True

    def __init__(self, surface: Surface, path: DrivenPath, radius: float, skin: float = SKIN) -> None:
        super().__init__(surface, radius, skin)
        self.path = path
        left, bottom, right, top = path.box
        margin = self.outline.reach + TOUCHING_GAP
        self.box = left - margin, bottom - margin, right + margin, top + margin
        self._posed: tuple[float, Obstacle] | None = None

    def at(self, t: float) -> Obstacle:
        """The same where it is at time t, with the velocities of its points."""
        if self._posed is None or self._posed[0] != t:
            self._posed = t, PosedObstacle(self, t)
        return self._posed[1]

    def first_touch_of(self, ball: Ball, arc: Arc) -> float | None:
        """The time in s at which a ball or body first touches it on an arc, or None."""
        outline = outline_of(ball)
        for own in self.path.between(arc.t0, arc.truncated_at):
            start, end = max(own.t0, arc.t0), min(own.t1, arc.truncated_at)
            at = first_touch(OutlineOnArc(outline, arc), OutlineOnArc(self.path.outline, own), start, end, self.skin)
            if at is not None:
                return at
        return None

    def frame(self, t: float) -> Frame:
        """The frame that moves with it from t on."""
        return Frame(self.path.at(t), self.path.about)


class PosedObstacle(Obstacle):
    """A moving surface at one time: while it ``stands_until`` a later one, in s, it is like any that stands."""

    def __init__(self, source: MovingObstacle, t: float) -> None:
        arc = source.path.at(t)
        x, y, vx, vy, spin, _ = arc.state(t)
        frame = source.frame(t)
        shape = source.surface.shape
        if isinstance(shape, Circle):
            there: Segment | Circle = Circle(frame.out(t, shape.center), shape.radius)
        else:
            there = Segment(frame.out(t, shape.a), frame.out(t, shape.b), shape.radius)
        super().__init__(source.surface, source.outline.reach - shape.radius, source.skin, there)
        self.source = source
        self.stands_until = source.path.stands_until(t)
        self.moves = self.stands_until <= t
        self._drive = _Drive(x, y, vx, vy, spin)

    def velocity_at(self, point: Vector) -> Vector:
        return self._drive.velocity_at(point)


class Frame:
    """The frame that moves with a surface along one arc of its motion; in it the surface stands still."""

    def __init__(self, arc: Arc, about: Vector) -> None:
        self.arc = arc
        self._about = about

    @property
    def turns(self) -> bool:
        """True if it turns along the arc."""
        return any(spin != 0.0 for spin in self.arc.curves[4])

    def out(self, t: float, point: Vector) -> Vector:
        """The place in m of a point of the frame at time t."""
        x, y, *_, angle = self.arc.state(t)
        c, s, dx, dy = cos(angle), sin(angle), point[0] - self._about[0], point[1] - self._about[1]
        return x + c * dx - s * dy, y + s * dx + c * dy

    def into(self, t: float, state: State) -> State:
        """A ball's state as seen in it, which does not turn."""
        x, y, vx, vy, _, angle = self.arc.state(t)
        (dx, dy), (ux, uy) = _turned(-angle, state[0] - x, state[1] - y), _turned(-angle, state[2] - vx, state[3] - vy)
        return dx + self._about[0], dy + self._about[1], ux, uy, state[4]

    def out_of(self, t: float, state: State) -> State:
        """A state seen in it, as seen from outside."""
        x, y, vx, vy, _, angle = self.arc.state(t)
        dx, dy = _turned(angle, state[0] - self._about[0], state[1] - self._about[1])
        ux, uy = _turned(angle, state[2], state[3])
        return x + dx, y + dy, vx + ux, vy + uy, state[4]

    def relative_acceleration(self, t: float, acceleration: Acceleration) -> Acceleration:
        """An acceleration as seen in it."""
        (ax, ay), angle = self.arc.acceleration(t), self.arc.state(t)[5]
        return *_turned(-angle, acceleration[0] - ax, acceleration[1] - ay), acceleration[2]

    def unseen(self, t: float, acceleration: Acceleration) -> Vector:
        """An acceleration in it as seen from outside, in m/s^2."""
        (ax, ay), (bx, by) = self.arc.acceleration(t), _turned(self.arc.state(t)[5], *acceleration[:2])
        return ax + bx, ay + by

    def angular_acceleration(self, t: float) -> float:
        """In rad/s^2."""
        h = self.arc.t1 - self.arc.t0
        return evaluate(derivative(self.arc.curves[4]), min(1.0, max(0.0, (t - self.arc.t0) / h))) / h

    def carried(self, arc: Arc) -> Arc:
        """An arc in it as an arc outside, while this motion lasts."""
        h = self.arc.t1 - self.arc.t0
        u0, u1 = max(0.0, (arc.t0 - self.arc.t0) / h), min(1.0, (arc.t1 - self.arc.t0) / h)
        own = [piece(curve, u0, u1) for curve in self.arc.curves[:4]]
        x, y = ([each - at for each in curve] for curve, at in zip(arc.curves[:2], self._about, strict=True))
        angle = self.arc.start[5]
        c, s = cos(angle), sin(angle)
        vx, vy, *spins = arc.curves[2:]
        curves = (*_sums(own[:2], x, y, c, s), *_sums(own[2:], vx, vy, c, s), *spins)
        return Arc(arc.t0, arc.t1, self.out_of(arc.t0, arc.start), curves, arc.contact)


def _turned(angle: float, x: float, y: float) -> Vector:
    c, s = cos(angle), sin(angle)
    return c * x - s * y, s * x + c * y


def _sums(
    own: Sequence[Sequence[float]], x: Sequence[float], y: Sequence[float], c: float, s: float
) -> tuple[list[float], list[float]]:
    """A path turned and added to another, as curves of one degree."""
    degree = max(len(curve) for curve in (*own, x, y)) - 1
    (u, v), x, y = (elevate(curve, degree) for curve in own), elevate(x, degree), elevate(y, degree)
    return (
        [a + c * dx - s * dy for a, dx, dy in zip(u, x, y, strict=True)],
        [a + s * dx + c * dy for a, dx, dy in zip(v, x, y, strict=True)],
    )


def _outline(shape: Segment | Circle, about: Vector) -> Polygon:
    """The outline of a shape as seen from a point."""
    points = dict.fromkeys((x - about[0], y - about[1]) for x, y in _points(shape))
    return Polygon(tuple(points), shape.radius)


def _points(shape: Segment | Circle) -> Sequence[Vector]:
    """The ends of its line in m, or its centre."""
    return (shape.center,) if isinstance(shape, Circle) else (shape.a, shape.b)
