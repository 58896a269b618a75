"""Contact manifolds: where balls, bodies and surfaces touch, and how fast they move there; when two first do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache, partial
from math import atan2, cos, hypot, sin
from typing import NamedTuple, Protocol

from sandbox.engine.contact.surfaces import speeds_where_touching, takeoff_speed
from sandbox.engine.contact.touch import Near, Obstacle, balls_touch, touched
from sandbox.engine.contact.turning_touch import OutlineOnArc, first_touch, fixed, pose_of
from sandbox.engine.model.ball import Ball, outline_of
from sandbox.engine.model.nearest import Pose, meeting_points, nearest
from sandbox.engine.model.shapes import Polygon, Shape, Vector
from sandbox.engine.model.surface import Circle, Segment
from sandbox.engine.model.tolerances import PARTING, PUSH, ROUNDING, SEAM, SKIN, STILL, TINY
from sandbox.engine.paths.arc import Arc
from sandbox.physics.integrators import Acceleration, State

Speeds = tuple[float, float, float]

#: Largest turn in rad in a bounce that is none.
_TURN = 0.1

_IN_PLACE = Pose(0.0, 0.0, 0.0)


class ContactManifold(NamedTuple):
    """The gap, normal and points between two balls or bodies, or one and a surface, that touch or nearly do."""

    gap: float  # m
    normal: Vector  # unit vector to the first
    points: list[Vector]  # one or two, m, halfway between the two
    speeds: list[Speeds]  # m/s, at each: of approach, and of the slip along (ny, -nx) and upward

    @property
    def fastest(self) -> int:
        """The number of the point at which they approach fastest."""
        return self.speeds.index(max(self.speeds))

    @property
    def closing(self) -> float:
        """The fastest approach in m/s."""
        return max(self.speeds)[0]


def all_round(*balls: Ball) -> bool:
    """Return True if these are all balls, whose distance is that of their centres."""
    return True not in [ball.rotates for ball in balls]


def rounding(body: Ball, state: State) -> float:
    """The speed in m/s at which a body parts from another by rounding alone, when they do not bounce."""
    return STILL + PARTING * (hypot(state[2], state[3]) + body.radius * abs(state[4]))


def meeting(one: Ball, state: State, other: Ball, other_state: State, within: float = 0.0) -> ContactManifold:
    """Return the manifold of two balls or bodies: of points where they are no farther apart than ``within`` (m), or
    else where they are nearest."""
    balls, states = (one, other), (state, other_state)
    if not all_round(*balls):
        (first, second), (here, there) = map(outline_of, balls), map(pose_of, states)
        return meeting_at(balls, states, *_touching(first, here, second, there, within))
    dx, dy = state[0] - other_state[0], state[1] - other_state[1]
    distance = (dx**2 + dy**2) ** 0.5
    nx, ny = (dx / distance, dy / distance) if distance else (0.0, 0.0)  # centres may coincide at the start
    point = state[0] - one.radius * nx, state[1] - one.radius * ny
    return meeting_at(balls, states, distance - one.radius - other.radius, (nx, ny), [point])


def surface_met(ball: Ball, state: State, near: Near, within: float = 0.0) -> ContactManifold:
    """Return the manifold of a ball or body and a surface that is prepared for its radius, and ``near`` its centre."""
    obstacle, (gap, nx, ny, *_) = near
    normal, points = (nx, ny), [(state[0] - ball.radius * nx, state[1] - ball.radius * ny)]
    if ball.rotates:
        shape = fixed_outline(obstacle.shape).shape
        gap, normal, points = _touching(outline_of(ball), pose_of(state), shape, _IN_PLACE, within, atan2(ny, nx))
    if not obstacle.moves:
        return meeting_at((ball,), (state,), gap, normal, points)
    seen = [relative(state, obstacle.velocity_at(point)) for point in points]
    speeds = [meeting_at((ball,), (each,), gap, normal, [at]).speeds[0] for each, at in zip(seen, points, strict=True)]
    return ContactManifold(gap, normal, points, speeds)


def relative(state: State, velocity: Vector) -> State:
    """A state as seen by what has a velocity in m/s."""
    x, y, vx, vy, *rest = state
    return x, y, vx - velocity[0], vy - velocity[1], *rest


def surfaces_met(
    ball: Ball, obstacles: Sequence[Obstacle], state: State, within: float
) -> Iterator[tuple[Obstacle, ContactManifold]]:
    """Yield the manifolds of a ball or body with those of these surfaces that are not farther than ``within`` (m)."""
    for near in touched(obstacles, state[0], state[1], within):
        found = surface_met(ball, state, near, within)
        if found.gap <= within:
            yield near[0], found


def touches_again(
    shapes: tuple[Shape, Shape],
    states: Sequence[State],
    applied: Sequence[Acceleration],
    met: ContactManifold,
    height: float,
) -> bool:
    """Return True if two bodies, or one and what stands still, that part come back without rising higher than
    ``height`` (m), which takes 4 height / v: those that turn do so without a force, too."""
    lasts = min(4.0 * max(height, SKIN) / -met.closing, _TURN / max(TINY, *(abs(state[4]) for state in states)))
    (one, other), (here, there) = shapes, [*map(partial(_later, lasts), states, applied), _IN_PLACE][:2]
    return nearest(one, here, other, there).gap < met.gap


def _later(lasts: float, state: State, applied: Acceleration) -> Pose:
    x, y, vx, vy, spin, *angle = state
    (ax, ay, turning), half = applied, 0.5 * lasts
    turned = [angle[0] + lasts * (spin + half * turning)] if angle else []
    return pose_of((x + lasts * (vx + half * ax), y + lasts * (vy + half * ay), vx, vy, spin, *turned))


def resting_points(
    body: Ball, obstacles: Sequence[Obstacle], state: State, within: float, applied: Acceleration, height: float
) -> list[tuple[Obstacle, ContactManifold, Vector]]:
    """The points at which a body that touches surfaces, or is within that gap (m) of them, stays on them: it rises no
    higher than for a bounce of ``height`` (m), or than the overlap by which a touch is found."""
    stay = [
        (obstacle, found, at)
        for obstacle, found in surfaces_met(body, obstacles, state, within)
        for at in range(len(found.points))
        if _stays(body, state, obstacle, found, at, applied, height)
    ]
    if len(stay) == 1:  # with two, what one pushes may press the body on the other
        obstacle, found, at = stay[0]
        point, slow = found.points[at], found.speeds[at][0] <= STILL
        if is_straight_side(obstacle, found.normal) and (
            (slow and lifts_off(body, state, point, found.normal, applied))
            or (_bend(body, state, found.normal) == 0.0 and slides_off_end(body, state, obstacle, point, found.normal))
        ):
            return []
    return [(obstacle, found, found.points[at]) for obstacle, found, at in stay]


def _stays(
    body: Ball, state: State, obstacle: Obstacle, met: ContactManifold, at: int, applied: Acceleration, height: float
) -> bool:
    approach = met.speeds[at][0]
    height = max(height, obstacle.surface.lowest_bounce, SKIN)
    if -approach <= max(takeoff_speed(hypot(*applied[:2]), height), rounding(body, state)):
        return True
    shapes = outline_of(body), fixed_outline(obstacle.shape).shape
    return approach == met.closing and touches_again(shapes, (state,), (applied,), met, height)


def farthest(ball: Ball, state: State, normal: Vector) -> Vector:
    """The point of a ball or body that is farthest against a normal, in m."""
    outline, (u, v, angle), (nx, ny) = outline_of(ball), pose_of(state), normal
    down, c, s = atan2(-ny, -nx) - angle, cos(angle), sin(angle)
    x, y = outline.support(outline.corner_towards(down), down)
    return u + c * x - s * y - outline.radius * nx, v + s * x + c * y - outline.radius * ny


def is_straight_side(obstacle: Obstacle, normal: Vector) -> bool:
    """Return True if it is the straight side of a surface that has this normal."""
    outline = obstacle.outline
    return outline.length > 0.0 and abs(outline.tx * normal[0] + outline.ty * normal[1]) <= ROUNDING


def slides_off_end(body: Ball, state: State, obstacle: Obstacle, point: Vector, normal: Vector) -> bool:
    """Return True if the point at which a body touches a straight side is at the side's end, and moves beyond it."""
    outline, (nx, ny) = obstacle.outline, normal
    _, slip, _ = speeds_at((state,), point, normal)
    onward = (slip - state[4] * _bend(body, state, normal)) * (outline.tx * ny - outline.ty * nx)
    at = outline.along(*point)
    return bool((onward > 0.0 and at >= outline.length - SEAM) or (onward < 0.0 and at <= SEAM))


def _bend(body: Ball, state: State, normal: Vector) -> float:
    """The radius of curvature in m where a body touches a straight side; 0 at a sharp corner."""
    outline = outline_of(body)
    return outline.radius + outline.bend(atan2(-normal[1], -normal[0]) - state[5])


def lifts_off(body: Ball, state: State, point: Vector, normal: Vector, applied: Acceleration) -> bool:
    """Return True if a body that its contact at a point of a straight side did not hold would be accelerated away."""
    (nx, ny), spin2 = normal, state[4] ** 2
    x, y, (ax, ay, turning) = point[0] - state[0], point[1] - state[1], applied
    bend = _bend(body, state, normal)
    away = ax * nx + ay * ny + (x * ny - y * nx) * turning - spin2 * (x * nx + y * ny + bend)
    most = abs(ax) + abs(ay) + body.radius * (abs(turning) + spin2)
    return bool(most > PUSH and away >= -ROUNDING * most)


def meeting_at(
    balls: Sequence[Ball], states: Sequence[State], gap: float, normal: Vector, points: list[Vector]
) -> ContactManifold:
    """Return the manifold of one or two at these points; that of balls has one."""
    if all_round(*balls):
        return ContactManifold(gap, normal, points, [speeds_where_touching(balls, states, *normal)])
    return ContactManifold(gap, normal, points, [speeds_at(states, point, normal) for point in points])


@lru_cache(maxsize=1024)
def _touching(
    one: Shape, here: Pose, other: Shape, there: Pose, within: float, direction: float | None = None
) -> tuple[float, Vector, list[Vector]]:
    """Gap, normal and points; asked for before and after each impact."""
    found = nearest(one, here, other, there, direction)
    normal = found.nx, found.ny
    return found.gap, normal, meeting_points(one, here, other, there, normal, max(0.0, within - found.gap))


def speeds_at(states: Sequence[State], point: Vector, normal: Vector) -> Speeds:
    """Return the speeds of the first relative to the second, or to what stands still, where they touch."""
    ux = uy = 0.0
    for (x, y, vx, vy, spin, *_), sign in zip(states, (1.0, -1.0), strict=False):
        ux += sign * (vx - spin * (point[1] - y))
        uy += sign * (vy + spin * (point[0] - x))
    nx, ny = normal
    return -(ux * nx + uy * ny), ux * ny - uy * nx, 0.0


class Mover(Protocol):
    """A ball or body during a run."""

    @property
    def ball(self) -> Ball: ...
    @property
    def arc(self) -> Arc: ...
    @property
    def predicted_path(self) -> Arc: ...


def pair_touches(one: Mover, other: Mover, t: float, skin: float) -> float | None:
    """The first time from t on, while both arcs last, at which two balls or bodies overlap by ``skin``, or None."""
    reach = one.ball.radius + other.ball.radius
    if all_round(one.ball, other.ball):
        return balls_touch(one.predicted_path, other.predicted_path, reach, t, skin)
    (x, y), (u, v) = one.arc.position(t), other.arc.position(t)
    if hypot(x - u, y - v) > reach:
        start = balls_touch(one.arc, other.arc, reach, t, skin)
        if start is None:
            return None
        t = start
    until = min(one.arc.t1, other.arc.t1)
    if until <= t:
        return None
    first, second = (OutlineOnArc(outline_of(mover.ball), mover.arc) for mover in (one, other))
    return first_touch(first, second, t, until, skin)


@lru_cache(maxsize=4096)
def fixed_outline(shape: Segment | Circle) -> OutlineOnArc:
    """A fixed shape as an outline that stays in place."""
    return fixed(Polygon(tuple(dict.fromkeys(shape.ends)), shape.radius))
