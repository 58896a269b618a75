"""Where balls and bodies touch each other and what stands still, and how fast they move there; when two first do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache, partial
from math import atan2, cos, hypot, sin
from typing import NamedTuple

from sandbox.engine.accuracy import SKIN
from sandbox.engine.nearest import Pose, meeting_points, nearest
from sandbox.engine.setup import Ball, Circle, Segment, Vector, outline_of
from sandbox.engine.shapes import Polygon, Shape
from sandbox.engine.surfaces import PUSH, STILL, leaves_at, speeds_where_touching
from sandbox.engine.touch import Near, Obstacle, balls_touch, touched
from sandbox.engine.track import Track
from sandbox.engine.turning_touch import Mover, first_touch, fixed, pose_of
from sandbox.physics.integrators import Acceleration, State

Speeds = tuple[float, float, float]

#: Share of the speeds of two bodies that is rounding in that at which they part.
_ROUNDING = 1e-7

#: Share of the accelerations that is rounding in what presses a body on a side.
_SHARE = 1e-9

#: Way in m to a side's end that is rounding.
_END = 1e-11

#: Largest turn in rad in a bounce that is none.
_TURN = 0.1

_IN_PLACE = Pose(0.0, 0.0, 0.0)


class Meeting(NamedTuple):
    """What is between two balls or bodies, or one and a surface, that touch or nearly do."""

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


def discs(*balls: Ball) -> bool:
    """Whether these are all balls, whose distance is that of their centres."""
    return True not in [ball.turns for ball in balls]


def rounding(body: Ball, state: State) -> float:
    """The speed in m/s at which a body parts from another by rounding alone, when they do not bounce."""
    return STILL + _ROUNDING * (hypot(state[2], state[3]) + body.radius * abs(state[4]))


def meeting(one: Ball, state: State, other: Ball, other_state: State, within: float = 0.0) -> Meeting:
    """How two balls or bodies meet: at points where they are no farther apart than ``within`` (m), or else where they
    are nearest."""
    balls, states = (one, other), (state, other_state)
    if not discs(*balls):
        (first, second), (here, there) = map(outline_of, balls), map(pose_of, states)
        return meeting_at(balls, states, *_touching(first, here, second, there, within))
    dx, dy = state[0] - other_state[0], state[1] - other_state[1]
    distance = (dx**2 + dy**2) ** 0.5
    nx, ny = (dx / distance, dy / distance) if distance else (0.0, 0.0)  # centres may coincide at the start
    point = state[0] - one.radius * nx, state[1] - one.radius * ny
    return meeting_at(balls, states, distance - one.radius - other.radius, (nx, ny), [point])


def surface_met(ball: Ball, state: State, near: Near, within: float = 0.0) -> Meeting:
    """How a ball or body meets a surface that is prepared for its radius, and ``near`` its centre."""
    obstacle, (gap, nx, ny, *_) = near
    if ball.turns:
        shape = standing(obstacle.surface.shape).shape
        found = _touching(outline_of(ball), pose_of(state), shape, _IN_PLACE, within, atan2(ny, nx))
        return meeting_at((ball,), (state,), *found)
    return meeting_at((ball,), (state,), gap, (nx, ny), [(state[0] - ball.radius * nx, state[1] - ball.radius * ny)])


def surfaces_met(
    ball: Ball, obstacles: Sequence[Obstacle], state: State, within: float
) -> Iterator[tuple[Obstacle, Meeting]]:
    """How a ball or body meets those of these surfaces that are not farther than ``within`` (m)."""
    for near in touched(obstacles, state[0], state[1], within):
        found = surface_met(ball, state, near, within)
        if found.gap <= within:
            yield near[0], found


def returns(
    shapes: tuple[Shape, Shape],
    states: Sequence[State],
    applied: Sequence[Acceleration],
    met: Meeting,
    height: float,
) -> bool:
    """Whether two bodies, or one and what stands still, that part come back without rising higher than ``height`` (m),
    which takes 4 height / v: those that turn do so without a force, too."""
    lasts = min(4.0 * max(height, SKIN) / -met.closing, _TURN / max(1e-9, *(abs(state[4]) for state in states)))
    (one, other), (here, there) = shapes, [*map(partial(_later, lasts), states, applied), _IN_PLACE][:2]
    return nearest(one, here, other, there).gap < met.gap


def _later(lasts: float, state: State, applied: Acceleration) -> Pose:
    x, y, vx, vy, spin, *angle = state
    (ax, ay, turning), half = applied, 0.5 * lasts
    turned = [angle[0] + lasts * (spin + half * turning)] if angle else []
    return pose_of((x + lasts * (vx + half * ax), y + lasts * (vy + half * ay), vx, vy, spin, *turned))


def kept(
    body: Ball, obstacles: Sequence[Obstacle], state: State, within: float, applied: Acceleration, height: float
) -> list[tuple[Obstacle, Meeting, Vector]]:
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
        if straight(obstacle, found.normal) and (
            (slow and lifts(body, state, point, found.normal, applied))
            or (_bend(body, state, found.normal) == 0.0 and runs_out(body, state, obstacle, point, found.normal))
        ):
            return []
    return [(obstacle, found, found.points[at]) for obstacle, found, at in stay]


def _stays(
    body: Ball, state: State, obstacle: Obstacle, met: Meeting, at: int, applied: Acceleration, height: float
) -> bool:
    approach = met.speeds[at][0]
    height = max(height, obstacle.surface.lowest_bounce, SKIN)
    if -approach <= max(leaves_at(hypot(*applied[:2]), height), rounding(body, state)):
        return True
    shapes = outline_of(body), standing(obstacle.surface.shape).shape
    return approach == met.closing and returns(shapes, (state,), (applied,), met, height)


def farthest(ball: Ball, state: State, normal: Vector) -> Vector:
    """The point of a ball or body that is farthest against a normal, in m."""
    outline, (u, v, angle), (nx, ny) = outline_of(ball), pose_of(state), normal
    down, c, s = atan2(-ny, -nx) - angle, cos(angle), sin(angle)
    x, y = outline.support(outline.corner_towards(down), down)
    return u + c * x - s * y - outline.radius * nx, v + s * x + c * y - outline.radius * ny


def straight(obstacle: Obstacle, normal: Vector) -> bool:
    """Whether it is the straight side of a surface that has this normal."""
    outline = obstacle.outline
    return outline.length > 0.0 and abs(outline.tx * normal[0] + outline.ty * normal[1]) <= 1e-9


def runs_out(body: Ball, state: State, obstacle: Obstacle, point: Vector, normal: Vector) -> bool:
    """Whether the point at which a body touches a straight side is at the side's end, and moves beyond it."""
    outline, (nx, ny) = obstacle.outline, normal
    _, slip, _ = speeds_at((state,), point, normal)
    onward = (slip - state[4] * _bend(body, state, normal)) * (outline.tx * ny - outline.ty * nx)
    at = outline.along(*point)
    return bool((onward > 0.0 and at >= outline.length - _END) or (onward < 0.0 and at <= _END))


def _bend(body: Ball, state: State, normal: Vector) -> float:
    """The radius of curvature in m where a body touches a straight side; 0 at a sharp corner."""
    outline = outline_of(body)
    return outline.radius + outline.bend(atan2(-normal[1], -normal[0]) - state[5])


def lifts(body: Ball, state: State, point: Vector, normal: Vector, applied: Acceleration) -> bool:
    """Whether a body that its contact at a point of a straight side did not hold would be accelerated away from it."""
    (nx, ny), spin2 = normal, state[4] ** 2
    x, y, (ax, ay, turning) = point[0] - state[0], point[1] - state[1], applied
    bend = _bend(body, state, normal)
    away = ax * nx + ay * ny + (x * ny - y * nx) * turning - spin2 * (x * nx + y * ny + bend)
    most = abs(ax) + abs(ay) + body.radius * (abs(turning) + spin2)
    return bool(most > PUSH and away >= -_SHARE * most)


def meeting_at(
    balls: Sequence[Ball], states: Sequence[State], gap: float, normal: Vector, points: list[Vector]
) -> Meeting:
    """How one or two meet at these points; balls do at one."""
    if discs(*balls):
        return Meeting(gap, normal, points, [speeds_where_touching(balls, states, *normal)])
    return Meeting(gap, normal, points, [speeds_at(states, point, normal) for point in points])


@lru_cache(maxsize=64)
def _touching(
    one: Shape, here: Pose, other: Shape, there: Pose, within: float, direction: float | None = None
) -> tuple[float, Vector, list[Vector]]:
    """Gap, normal and points; asked for before and after each impact."""
    found = nearest(one, here, other, there, direction)
    normal = found.nx, found.ny
    return found.gap, normal, meeting_points(one, here, other, there, normal, max(0.0, within - found.gap))


def speeds_at(states: Sequence[State], point: Vector, normal: Vector) -> Speeds:
    """Of the first relative to the second, or to what stands still, where they touch."""
    ux = uy = 0.0
    for (x, y, vx, vy, spin, *_), way in zip(states, (1.0, -1.0), strict=False):
        ux += way * (vx - spin * (point[1] - y))
        uy += way * (vy + spin * (point[0] - x))
    nx, ny = normal
    return -(ux * nx + uy * ny), ux * ny - uy * nx, 0.0


def pair_touches(one: Track, other: Track, t: float, skin: float) -> float | None:
    """The first time from t on, while both arcs last, at which two balls or bodies overlap by ``skin``, or None."""
    reach = one.ball.radius + other.ball.radius
    if discs(one.ball, other.ball):
        return balls_touch(one.way, other.way, reach, t, skin)
    (x, y), (u, v) = one.arc.position(t), other.arc.position(t)
    if hypot(x - u, y - v) > reach:
        start = balls_touch(one.arc, other.arc, reach, t, skin)
        if start is None:
            return None
        t = start
    until = min(one.arc.t1, other.arc.t1)
    if until <= t:
        return None
    first, second = (Mover(outline_of(track.ball), track.arc) for track in (one, other))
    return first_touch(first, second, t, until, skin)


@lru_cache(maxsize=4096)
def standing(shape: Segment | Circle) -> Mover:
    """A fixed shape as an outline that stays in place."""
    points = (shape.center,) if isinstance(shape, Circle) else (shape.a, shape.b)
    return fixed(Polygon(tuple(dict.fromkeys(points)), shape.radius))
