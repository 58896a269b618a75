"""Impulses of contacts, computed by pymunk: one step of a Space, in which nothing moves, applies restitution and
Coulomb friction.

A single contact does not depend on place, direction or size: in units of the reduced mass it is the impact of a disc
of radius 1 and mass 1 on level ground, whose centre of mass is elsewhere if bodies meet. For contacts that close
together the balls are placed as they are.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from math import copysign, hypot, log, sqrt
from typing import Any, NamedTuple

import pymunk

from sandbox.engine.contact.manifold import relative
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Bounce
from sandbox.physics.integrators import State

#: Length in s of the step in which impulses are exchanged: at 340 m/s a ball moves 3e-13 m in it. No contact in it is
#: deep enough for Chipmunk to correct positions.
_INSTANT = 1e-15

#: A disc and its ground overlap by this fraction of the radius during the exchange, so that Chipmunk sees the contact;
#: where several contacts close together by much less, as the arm of the friction is off by as much. There discs are as
#: small as this, so that those of different contacts hardly meet.
OVERLAP, _CLOSE, _SMALL = 1e-6, 1e-11, 1e-2

#: Solver iterations for contacts that close together: a cluster of 16 balls needs 50 for 1e-7 m/s. One is exact for a
#: single contact of a ball. Two contacts of a slim body help each other: a rod of 1 x 30 on end needs 1,000.
_ITERATIONS, _ITERATIONS_TURNING = 200, 2_000

#: Height at which a disc waits that is not in use, in radii.
_PARKED = 1.5

#: From a disc's centre to the ground.
_DOWN: Vector = (0.0, -1.0)


def _still_space(iterations: int) -> pymunk.Space:
    """A Space that never corrects positions and forgets a contact in the step after it."""
    space = pymunk.Space()
    space.collision_slop = space.collision_bias = 1.0
    space.collision_persistence = 1
    space.iterations = iterations
    return space


def _enough(inertia: float, arm: Vector, friction: float) -> int:
    """Iterations after which a contact that sticks or slides is known to rounding: each leaves a fraction of the error,
    as pushing makes a body slip."""
    (along, down), both = arm, abs(arm[0] * arm[1])
    left = max(both / sqrt((inertia + along**2) * (inertia + down**2)), friction * both / (inertia + along**2))
    if left == 0.0:
        return 1
    return min(_ITERATIONS_TURNING, int(-36.0 / log(left)) + 2) if left < 1.0 else _ITERATIONS_TURNING


def _disc_over_ground(space: pymunk.Space, x: float, y: float) -> tuple[pymunk.Circle, pymunk.Body]:
    """A disc of radius 1 and mass 1 that waits above its own piece of level ground at (x, y), and its body."""
    ground = pymunk.Segment(space.static_body, (x - 0.1, y), (x + 0.1, y), 0.0)
    ground.elasticity = ground.friction = 1.0  # pymunk multiplies both shapes' values: the disc has the pair's
    body = pymunk.Body(1.0, 1.0)
    body.position = x, y + 1.0 + _PARKED
    disc = pymunk.Circle(body, 1.0)
    space.add(ground, body, disc)
    return disc, body


class DiscOnGround:
    """A disc of radius 1 and mass 1 above level ground: the reduced form of a single contact."""

    def __init__(self) -> None:
        self._space = _still_space(1)
        self._disc, self._body = _disc_over_ground(self._space, 0.0, 0.0)
        self._pair = 0.0, 0.0, 1.0  # restitution, friction, moment of inertia
        self._arm = _DOWN  # from the centre of mass to the ground

    def exchange(
        self, approach: float, slip: float, inertia: float, restitution: float, friction: float, arm: Vector = _DOWN
    ) -> tuple[float, float]:
        """The impulses away from the ground and along it, if the disc approaches at this speed and its surface slips at
        that speed; all in m/s. ``inertia`` is its moment of inertia, ``arm`` leads from its centre of mass to the
        ground.
        """
        body, pair = self._body, (restitution, friction, inertia)
        if pair != self._pair or arm != self._arm:
            self._pair, self._arm = pair, arm
            self._disc.elasticity, self._disc.friction, body.moment = pair
            self._disc.unsafe_set_offset((arm[0], arm[1] + 1.0))
            self._space.iterations = _enough(inertia, arm, friction)
        x, y = -arm[0], -arm[1] - OVERLAP
        try:
            if arm is not _DOWN:
                body.angle = 0.0  # in which the offset is
            body.position, body.velocity, body.angular_velocity = (x, y), (slip, -approach), 0.0
            self._space.step(_INSTANT)
            along, away = body.velocity
            return away + approach, along - slip
        finally:  # apart, so that pymunk forgets the contact
            body.position = x, y + _PARKED
            self._space.step(_INSTANT)


_made = threading.local()


def disc_on_ground() -> DiscOnGround:
    """The disc of this thread, made once: a contact leaves no trace in it."""
    disc: DiscOnGround | None = getattr(_made, "disc", None)
    if disc is None:
        disc = _made.disc = DiscOnGround()
    return disc


class ImpactContact(NamedTuple):
    """A contact in an impact. The unit normal points to the first ball, from the surface or from the second ball."""

    balls: tuple[int, ...]  # one or two, as indices into the balls of the setup
    partner: str  # name of the surface or of the second ball
    nx: float
    ny: float
    sine: float  # of the angle above the ball's centre at which a cushion's nose touches it
    bounce: Bounce
    speed: float  # m/s, at which the centres approach, positive when closing
    speeds: tuple[float, float, float]  # m/s, where they touch: of approach, and of the slip along and upward
    point: Vector  # m, where they touch
    drive: Vector = (0.0, 0.0)  # m/s, of the surface there, if it moves
    kick: float = 0.0  # N s, that the surface adds along the normal

    def relative_states(self, states: Mapping[int, State]) -> list[State]:
        """The states of its balls, as seen from the surface that they meet."""
        met = [states[index] for index in self.balls]
        return met if self.drive == (0.0, 0.0) else [relative(met[0], self.drive)]


def after_kick(ball: Ball, state: State, contact: ImpactContact) -> State:
    """The state of a ball or body after the kick of the surface that it has hit."""
    x, y, vx, vy, spin, *more = state
    px, py = contact.kick * contact.nx, contact.kick * contact.ny
    turn = 0.0
    if ball.rotates:
        turn = ((contact.point[0] - x) * py - (contact.point[1] - y) * px) / ball.inertia
    return x, y, vx + px / ball.mass, vy + py / ball.mass, spin + turn, *more


def after_contact_of_bodies(
    balls: Sequence[Ball], states: dict[int, State], contact: ImpactContact, bounce: Bounce
) -> tuple[dict[int, State], list[float], float]:
    """The states after a single contact of bodies, its normal impulse in N s, and the work in J that a moving surface
    does.

    A push at the contact makes it move by ``K P``, with a symmetric matrix K. One body with the smaller eigenvalue of K
    as 1/m, and its centre of mass at the right place, moves as all of them do.
    """
    nx, ny = contact.nx, contact.ny
    arms = [(contact.point[0] - states[index][0], contact.point[1] - states[index][1]) for index in contact.balls]
    away = along = both = 0.0  # K, in 1/kg
    for index, (x, y) in zip(contact.balls, arms, strict=True):
        across, down = x * ny - y * nx, x * nx + y * ny
        away += 1.0 / balls[index].mass + across * across / balls[index].inertia
        along += 1.0 / balls[index].mass + down * down / balls[index].inertia
        both -= across * down / balls[index].inertia
    larger = 0.5 * (away + along + hypot(away - along, 2.0 * both))
    smaller = (away * along - both * both) / larger
    arm = sqrt(max(0.0, away / smaller - 1.0)), -sqrt(max(0.0, along / smaller - 1.0))
    approach, slip, _ = contact.speeds
    slip *= 1.0 + contact.bounce.tangential  # ending that much is reversing a share of what there is
    arm = copysign(arm[0], both), arm[1]
    push, rub = disc_on_ground().exchange(approach, slip, 1.0, bounce.restitution, bounce.friction, arm)
    px, py = (push * nx + rub * ny) / smaller, (push * ny - rub * nx) / smaller
    after = dict(states)
    for index, (x, y), sign in zip(contact.balls, arms, (1.0, -1.0), strict=False):
        u, v, vx, vy, spin, *more = states[index]
        share, turn = sign / balls[index].mass, sign / balls[index].inertia
        after[index] = (u, v, vx + share * px, vy + share * py, spin + turn * (x * py - y * px), *more)
    return after, [push / smaller], px * contact.drive[0] + py * contact.drive[1]


def _disc_on_plane(
    contact: ImpactContact, point: pymunk.Vec2d, size: float, first: pymunk.Body, second: pymunk.Body
) -> tuple[pymunk.Circle, pymunk.Segment]:
    """A disc on the first body, of ``size`` (m), and a piece of its tangent plane on the second, that overlap at the
    point of a contact."""
    normal, small = pymunk.Vec2d(contact.nx, contact.ny), _SMALL * size
    disc = pymunk.Circle(first, small, point + small * normal - first.position)
    foot, along = point + _CLOSE * size * normal - second.position, small * normal.perpendicular()
    return disc, pymunk.Segment(second, foot - along, foot + along, 0.0)


def after_contacts_at_once(
    balls: Sequence[Ball], states: dict[int, State], contacts: Sequence[ImpactContact], bounces: Sequence[Bounce]
) -> tuple[dict[int, State], list[float], float]:
    """The states of balls and bodies, by their index, after contacts that close together with these bounces, the normal
    impulse in N s of each, and the work in J that moving surfaces do.

    In place of the shapes, which pymunk would examine again, each contact has a disc on the first body and a piece of
    its tangent plane on the second, or on what is fixed; they overlap at its point, and have its normal.
    """
    turning = any(balls[index].rotates for index in states)
    space = _still_space(_ITERATIONS_TURNING if turning else _ITERATIONS)
    bodies: dict[int, pymunk.Body] = {}
    left, bottom, *_ = next(iter(states.values()))
    for index, (x, y, vx, vy, spin, *_) in states.items():
        body = bodies[index] = pymunk.Body(balls[index].mass, balls[index].inertia)
        body.position, body.velocity, body.angular_velocity = (x - left, y - bottom), (vx, vy), spin
        space.add(body)
    pairs: dict[frozenset[pymunk.Shape], int] = {}
    for number, contact in enumerate(contacts):
        first, *others = (bodies[index] for index in contact.balls)
        point = pymunk.Vec2d(contact.point[0] - left, contact.point[1] - bottom)
        second = others[0] if others else _surface(space, contact.drive)
        pair = _disc_on_plane(contact, point, balls[contact.balls[0]].radius, first, second)
        space.add(*pair)
        pairs[frozenset(pair)] = number
    impulses, work = [0.0] * len(contacts), 0.0

    def bounce(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        number = pairs.get(frozenset(arbiter.shapes))
        if number is None:  # of another contact
            arbiter.process_collision = False
        else:
            arbiter.restitution, arbiter.friction, *_ = bounces[number]

    def read(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        nonlocal work
        number, total = pairs[frozenset(arbiter.shapes)], arbiter.total_impulse
        contact, impulses[number] = contacts[number], abs(total.dot(arbiter.normal))
        away = 1.0 if total.dot((contact.nx, contact.ny)) >= 0.0 else -1.0  # of the two: on the first ball
        work += away * total.dot(contact.drive)

    space.on_collision(pre_solve=bounce, post_solve=read)
    space.step(_INSTANT)
    after = {}
    for index, (x, y, _, _, _, *more) in states.items():
        after[index] = (x, y, *bodies[index].velocity, bodies[index].angular_velocity, *more)
    return after, impulses, work


def _surface(space: pymunk.Space, drive: Vector) -> pymunk.Body:
    """A body in the space for a surface, of infinite mass: one that stands still, or moves at this velocity."""
    if drive == (0.0, 0.0):
        return space.static_body
    body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    body.velocity = drive
    space.add(body)
    return body
