"""A body that moves and turns in the plane of the picture. Its state has the angle as a sixth component.

The angle is the integral of the spin. Forces may depend on it: a step is made with the angle that the spin at its start
predicts, and made again with that of the spin it found, until both agree within the error aimed at.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import accumulate
from math import hypot

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.acting import checked
from sandbox.engine.arc import Arc
from sandbox.engine.bernstein import evaluate
from sandbox.engine.in_plane import InPlane
from sandbox.engine.nearest import Nearest, Pose, meeting_points, nearest
from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball, Body, Circle, Segment, Setup, Vector, outline_of
from sandbox.engine.shapes import Polygon
from sandbox.engine.step_control import LOCAL_SHARE
from sandbox.engine.touch import Obstacle, balls_touch
from sandbox.engine.track import Track
from sandbox.engine.turning_touch import Mover, first_touch, fixed, pose_of
from sandbox.physics.integrators import Acceleration, State

#: Repetitions of a step until its angle agrees with its spin, after which it is halved.
_PATIENCE = 5


class Turning(InPlane):
    """A body: its path, and when it touches what stands still."""

    ball: Body

    def __init__(
        self,
        body: Body,
        state: State,
        obstacles: Sequence[Obstacle],
        catches: Sequence[Obstacle],
        setup: Setup,
        accuracy: Accuracy,
        numerics: Numerics,
    ) -> None:
        super().__init__(body, state, obstacles, catches, setup, accuracy, numerics)
        self.outline = body.outline
        self._skin = accuracy.skin
        self._angle_error = LOCAL_SHARE * accuracy.tolerance / body.radius  # rad

    def advance(self, t: float, until: float) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``; it ends only because of its length."""
        start, known = self.state, self._known[0]
        flat, angle = known if known == start[:5] else start[:5], start[5]
        curve: Sequence[float] = (angle, angle + (until - t) * start[4])
        t1 = until

        def law(at: float, state: State) -> Acceleration:
            return checked(self.ball, at, (*state, evaluate(curve, (at - t) / (t1 - t))))

        for count in range(1, 1000):
            self.state = flat
            arc = self._integrate(t, until, law)
            h = arc.t1 - t
            found = list(accumulate((h * spin / len(arc.spin) for spin in arc.spin), initial=angle))
            off = max(abs(evaluate(curve, share * h / (t1 - t)) - evaluate(found, share)) for share in (0.5, 1.0))
            curve, t1 = found, arc.t1
            if off <= self._angle_error:
                break
            until = t + 0.5 * h if count % _PATIENCE == 0 else arc.t1
        self.state, arc.start, arc.rolling_spin = start, start, (curve,)
        arc.end = (*(arc.end or arc.state(arc.t1))[:5], curve[-1])
        return arc, ""

    def settle(self, t: float, height: float) -> None:
        """It never stays on a surface by itself."""
        self.contact = None

    def first_touch(self, obstacle: Obstacle) -> float | None:
        """The time in s at which the body starts to touch on its current arc, or None.

        ``obstacle`` is prepared for a ball around the body: nothing touches the body before it touches that.
        """
        arc = self.arc
        start = arc.t0
        if obstacle in self.catches:
            return super().first_touch(obstacle)
        if obstacle.near(*arc.start[:2]).gap > 0.0:
            u = obstacle.first_touch(arc)
            if u is None:
                return None
            start += u * (arc.t1 - arc.t0)
        return first_touch(Mover(self.outline, arc), standing(obstacle.surface.shape), start, arc.t1, self._skin)


def pair_touches(one: Track, other: Track, t: float, skin: float) -> float | None:
    """The first time from t on, while both arcs last, at which two balls or bodies overlap by ``skin``, or None."""
    reach = one.ball.radius + other.ball.radius
    (x, y), (u, v) = one.arc.position(t), other.arc.position(t)
    round_ones = discs(one.ball, other.ball)
    if round_ones or hypot(x - u, y - v) > reach:
        start = balls_touch(one.arc, other.arc, reach, t, skin)
        if round_ones or start is None:
            return start
        t = start
    until = min(one.arc.t1, other.arc.t1)
    if until <= t:
        return None
    movers = (Mover(outline_of(track.ball), track.arc) for track in (one, other))
    return first_touch(*movers, t, until, skin)


@lru_cache(maxsize=4096)
def standing(shape: Segment | Circle) -> Mover:
    """A fixed shape as an outline that stays in place."""
    points = (shape.center,) if isinstance(shape, Circle) else (shape.a, shape.b)
    return fixed(Polygon(tuple(dict.fromkeys(points)), shape.radius))


def discs(*balls: Ball) -> bool:
    """Whether these are all balls, whose distance is that of their centres."""
    return not any(isinstance(ball, Body) for ball in balls)


def separation(one: Ball, state: State, other: Ball, other_state: State) -> Nearest:
    """What separates two balls or bodies; the normal points to the first."""
    return nearest(outline_of(one), pose_of(state), outline_of(other), pose_of(other_state))


def touching_bodies(balls: Sequence[Ball], states: Sequence[State], gap: float) -> tuple[Vector, list[Vector]]:
    """The normal to the first of two bodies, and the points where they touch, up to a gap in m; none if they do not."""
    found = separation(balls[0], states[0], balls[1], states[1])
    normal = found.nx, found.ny
    if found.gap > gap:
        return normal, []
    (one, other), (here, there) = map(outline_of, balls), map(pose_of, states)
    return normal, [point for point, _ in meeting_points(one, here, other, there, normal, gap)]


def touching_surfaces(track: Track, state: State, gap: float) -> Iterator[tuple[Obstacle, Vector, list[Vector]]]:
    """The surfaces that a body touches, up to a gap in m: normal, and points of contact."""
    outline, here = outline_of(track.ball), pose_of(state)
    for obstacle, _ in track.near(here.x, here.y, gap):
        fixed_one, there = standing(obstacle.surface.shape).shape, Pose(0.0, 0.0, 0.0)
        found = nearest(outline, here, fixed_one, there)
        if found.gap <= gap:
            normal = found.nx, found.ny
            yield (
                obstacle,
                normal,
                [point for point, _ in meeting_points(outline, here, fixed_one, there, normal, max(gap, found.gap))],
            )


def speeds_at(
    balls: Sequence[Ball], states: Sequence[State], point: Vector, normal: Vector
) -> tuple[float, float, float]:
    """Speed of approach, slip along the tangent (ny, -nx), and none upward, in m/s, where one body touches a surface or
    two touch each other."""
    ux = uy = 0.0
    for (x, y, vx, vy, spin, *_), way in zip(states, (1.0, -1.0), strict=False):
        ux += way * (vx - spin * (point[1] - y))
        uy += way * (vy + spin * (point[0] - x))
    nx, ny = normal
    return -(ux * nx + uy * ny), ux * ny - uy * nx, 0.0
