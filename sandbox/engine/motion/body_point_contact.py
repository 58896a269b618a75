"""A body that stays on a straight side at one point: it rolls on a curved side or about a corner, or slides.

With n the side's normal, t = (ny, -nx) along it, and the point of contact at ``l t - h n`` from the centre, the body
does not enter the side and, if it rolls, does not slip:

    vn + w l = 0,        vt + w h = 0,        l' = w (h - r),        h' = -w l

where r is the radius of curvature at the point. The accelerations of both, with the normal force N and the friction F
as unknowns, are two linear equations:

    An + N/m + l (A + (l N + h F) / I) + w^2 (h - r) = 0,        At + F/m + h (A + (l N + h F) / I) - w^2 l = 0

with A the acceleration by other forces. Sliding has ``F = -mu N`` against the slip in place of the second. So a body
tips over, rocks and rolls as accurately as it flies. A curved side that rolls on a surface with resistance c has N act
``c (h + I / (m h))`` ahead of the point: a disc is slowed by c N / m, as a ball is. Where that would take more friction
than there is, N acts less far ahead, so that the body still rolls.
"""

from __future__ import annotations

from math import atan2, copysign, cos, inf, remainder, sin
from typing import NamedTuple

from sandbox.engine.contact.manifold import ContactManifold, is_straight_side, lifts_off, slides_off_end
from sandbox.engine.contact.touch import SIDE, Obstacle, Touching
from sandbox.engine.model.ball import Ball, outline_of
from sandbox.engine.model.shapes import Polygon, Vector
from sandbox.engine.model.tolerances import GAP_ROUNDING, PUSH, ROUNDING, STILL
from sandbox.engine.motion.sustained_contact import SustainedContact
from sandbox.engine.paths.arc import Arc, crossing
from sandbox.engine.paths.phase import Phase
from sandbox.physics.integrators import Acceleration, State

#: Share of the inertia against the normal force that friction may take away from a sliding body. Where it takes all of
#: it (Painleve's paradox: a slim rod on a rough floor) no force keeps the body from entering.
_JAMS = 0.9

#: Largest turn in rad in one arc, and the spin in rad/s at which a body counts as turning.
_LONGEST_TURN, _SLOW = 0.35, 0.7


class _Arm(NamedTuple):
    """The point of contact, seen from the centre."""

    along: float  # l, m
    height: float  # h, m
    bend: float  # r, m


class BodyPointContact(SustainedContact):
    """The contact; ``touching.center`` is the corner of the body's core that is at the point, as the body sees it."""

    __slots__ = ()

    def arm(self, ball: Ball, state: State) -> _Arm:
        """Return the arm from the centre to where the body is touched."""
        outline, (nx, ny), angle = outline_of(ball), self.touching[1:3], state[5]
        down = atan2(-ny, -nx) - angle
        px, py = self.touching.center if isinstance(outline, Polygon) else outline.support(0, down)
        c, s = cos(angle), sin(angle)
        x, y = c * px - s * py, s * px + c * py
        return _Arm(x * ny - y * nx, outline.radius - x * nx - y * ny, outline.radius + outline.bend(down))

    def longest(self, state: State) -> float:
        """The longest step in s."""
        return float(_LONGEST_TURN / (abs(state[4]) + _SLOW))

    def progress(self, ball: Ball, state: State) -> float:
        """Return the slip in m/s, or a spin in rad/s that is resisted: when it falls to zero this motion ends."""
        surface = self.obstacle.surface
        if self.phase is Phase.SLIDING:
            return self.direction * self.slip(ball, state) if surface.friction > 0.0 else inf
        resisted = surface.rolling_resistance > 0.0 and self.arm(ball, state).bend > 0.0
        return self.direction * float(state[4]) if resisted else inf

    def slip(self, ball: Ball, state: State) -> float:
        """Speed in m/s of the body along the side where it touches."""
        return float(
            state[2] * self.touching.ny - state[3] * self.touching.nx + state[4] * self.arm(ball, state).height
        )

    def forces(self, ball: Ball, applied: Acceleration, state: State) -> tuple[Acceleration, float, float]:
        """Acceleration in contact; the normal force and the remaining grip, both divided by the mass, in m/s^2."""
        if self.phase is Phase.RESTING:
            return (0.0, 0.0, 0.0), inf, inf
        nx, ny = self.touching.nx, self.touching.ny
        (ax, ay, turning), (along, height, bend) = applied, self.arm(ball, state)
        surface, spin2, inertia = self.obstacle.surface, state[4] * state[4], ball.inertia / ball.mass
        friction, lever = surface.friction, along * height / inertia
        into = -(ax * nx + ay * ny + along * turning + spin2 * (height - bend))
        against = -(ax * ny - ay * nx + height * turning - spin2 * along)

        def rolling(pressing: float) -> tuple[float, float, float]:
            """Normal force, friction, and the moment of a normal force that acts so far along."""
            across, level = 1.0 + along * pressing / inertia, 1.0 + height * height / inertia
            determinant = across * level - lever * pressing * height / inertia
            normal = (into * level - against * lever) / determinant
            rub = (against * across - into * pressing * height / inertia) / determinant
            return normal, rub, pressing * normal

        if self.phase is Phase.SLIDING:
            normal = into / (1.0 + along * along / inertia - self.direction * friction * lever)
            rub, moment, grip_margin = -self.direction * friction * normal, along * normal, 0.0
        else:
            normal, rub, moment = rolling(along)
            grip_margin = friction * normal * (1.0 + ROUNDING) - abs(rub)
            if grip_margin >= 0.0 and bend > 0.0 and surface.rolling_resistance > 0.0:
                ahead = self.direction * surface.rolling_resistance * (height + inertia / height)
                normal, rub, moment = rolling(along - ahead)
                if abs(rub) > friction * normal:  # which passes on no more of the resistance than its own
                    slope = copysign(friction, rub)
                    normal = (height * into - along * against) / (height - along * slope)
                    rub = slope * normal
                    moment = (against - rub) * inertia / height - height * rub
        turning += (moment + height * rub) / inertia
        return (ax + normal * nx + rub * ny, ay + normal * ny - rub * nx, turning), normal, grip_margin

    def distance_to_end(self, ball: Ball, state: State) -> float:
        """Return the turn in rad until the next corner lies on the side, or the distance in m to the side's end: when
        it falls to zero the contact at this point ends."""
        outline, reach = outline_of(ball), self.obstacle.outline
        at = reach.along(state[0], state[1]) + self.arm(ball, state).along * self._direction_of_side()
        room = float(min(at, reach.length - at))
        if isinstance(outline, Polygon) and len(outline.corners) > 1:
            down = atan2(-self.touching.ny, -self.touching.nx) - state[5]
            corner = outline.corners.index(self.touching.center)
            for side, sign in ((corner, 1.0), (corner - 1, -1.0)):
                room = min(room, sign * remainder(outline.normals[side] - down, 6.283185307179586))
        return room

    def edge(self, ball: Ball, arc: Arc) -> float | None:
        """The time in s at which the point of contact changes, or None."""
        if self.distance_to_end(ball, arc.state(arc.t1)) >= 0.0:
            return None
        return crossing(arc, lambda t, state: self.distance_to_end(ball, state), GAP_ROUNDING)

    def _direction_of_side(self) -> float:
        """1 if the side runs along t, -1 if against it."""
        outline = self.obstacle.outline
        return 1.0 if outline.tx * self.touching.ny - outline.ty * self.touching.nx > 0.0 else -1.0

    def projected_onto_surface(self, ball: Ball, state: State) -> State:
        """The state exactly on the side, after the impulse at the point that ends speed away from it, and the slip if
        it rolls: it leaves the angular momentum about the point, and takes energy, as any impulse that ends motion."""
        x, y, vx, vy, spin, angle = state
        nx, ny = self.touching.nx, self.touching.ny
        along, height, _ = self.arm(ball, state)
        outline = self.obstacle.outline
        gap = abs(outline.across(x, y)) - (outline.reach - ball.radius) - height
        x, y = x - gap * nx, y - gap * ny
        if self.phase is Phase.RESTING:
            return x, y, 0.0, 0.0, 0.0, angle
        inertia, vn, vt = ball.inertia / ball.mass, vx * nx + vy * ny, vx * ny - vy * nx
        level = height if self.phase is Phase.ROLLING else 0.0
        spin = (inertia * spin - along * vn - level * vt) / (inertia + along * along + level * level)
        vn, vt = -along * spin, -height * spin if self.phase is Phase.ROLLING else vt
        return x, y, vn * nx + vt * ny, vn * ny - vt * nx, spin, angle


def body_point_contact(
    ball: Ball,
    state: State,
    obstacle: Obstacle,
    met: ContactManifold,
    point: Vector,
    applied: Acceleration,
    slips: bool = False,
) -> BodyPointContact | None:
    """Return the contact of a body that stays on a surface at one point: None if that is no straight side, or its end,
    or if nothing presses it on. One that ``slips`` has just lost its grip, whatever rounding says."""
    if not is_straight_side(obstacle, met.normal) or slides_off_end(ball, state, obstacle, point, met.normal):
        return None
    (nx, ny), shape = met.normal, outline_of(ball)
    down = atan2(-ny, -nx) - state[5]
    core = min(shape.candidates(down), key=lambda it: _distance_squared(it, state, point, shape.radius, met.normal))
    touching = Touching(met.gap, nx, ny, 0.0, core, SIDE)
    rolling = BodyPointContact(Phase.ROLLING, obstacle, touching)
    if lifts_off(ball, state, point, met.normal, applied):
        return None
    slip, speed = rolling.slip(ball, state), abs(state[2] * ny - state[3] * nx) + ball.radius * abs(state[4])
    if abs(slip) > STILL * (1.0 + speed):
        return _sliding(rolling, ball, state, 1.0 if slip > 0.0 else -1.0)
    at_rest = speed <= STILL
    starts = rolling.forces(ball, applied, state)[0][2] if at_rest else state[4]
    rolling = rolling._replace(direction=copysign(1.0, starts))
    (ax, ay, turning), _, grip_margin = rolling.forces(ball, applied, state)
    if slips or grip_margin < 0.0 or obstacle.surface.friction == 0.0:
        rub = (ax - applied[0]) * ny - (ay - applied[1]) * nx  # against the direction in which it starts to slip
        return _sliding(rolling, ball, state, -1.0 if rub > 0.0 else 1.0)
    if at_rest and ball.radius * rolling.direction * turning <= PUSH:
        return BodyPointContact(Phase.RESTING, obstacle, touching)
    return rolling


def _sliding(rolling: BodyPointContact, ball: Ball, state: State, direction: float) -> BodyPointContact | None:
    """The same contact, sliding; None if it would jam."""
    arm = rolling.arm(ball, state)
    inertia, lever = ball.inertia / ball.mass, rolling.obstacle.surface.friction * arm.along * arm.height
    if direction * lever > _JAMS * (inertia + arm.along**2):
        return None
    return rolling._replace(phase=Phase.SLIDING, direction=direction)


def _distance_squared(core: Vector, state: State, point: Vector, radius: float, normal: Vector) -> float:
    """Return the squared distance in m^2 of a point of the core from where the body is touched."""
    c, s = cos(state[5]), sin(state[5])
    x, y = state[0] + c * core[0] - s * core[1], state[1] + s * core[0] + c * core[1]
    return float((x - radius * normal[0] - point[0]) ** 2 + (y - radius * normal[1] - point[1]) ** 2)
