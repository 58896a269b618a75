"""Impacts: pymunk computes the impulses of touching balls.

The touching balls are placed in a small Space, each fixed shape as a short piece of its tangent plane (which is
equivalent for contact with a ball), and one step of almost zero length lets Chipmunk's solver apply restitution,
Coulomb friction and spin. Nothing moves in that step, so its length does not matter, nor does position correction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import Any

import pymunk

from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball, Bounce

#: Length in s of the step in which impulses are exchanged: at 340 m/s a ball moves 3e-13 m in it.
_INSTANT = 1e-15

#: Balls overlap by this fraction of their distances during the exchange, so that Chipmunk sees the contact. The
#: impulse of round shapes depends only on the directions of their contacts, which scaling does not change.
_OVERLAP = 1e-6

#: Solver iterations. One contact of round shapes is exact after one; a cluster of 16 balls needs 50 for 1e-7 m/s.
_ITERATIONS, _CLUSTER_ITERATIONS = 1, 200

#: Collision type of the balls' shapes in pymunk; planes have the default, 0.
_BALL = 1


@dataclass(slots=True)
class BallAtImpact:
    """A ball at the instant of an impact."""

    index: int  # which ball of the setup
    x: float  # m
    y: float
    vx: float  # m/s
    vy: float
    spin: float  # rad/s


@dataclass(slots=True)
class Contact:
    """A contact in an impact. The unit normal points to the first ball, from the surface or from the second ball."""

    first: int  # index into the cluster
    second: int | None  # index into the cluster, or None for a fixed surface
    nx: float
    ny: float
    bounce: Bounce  # with the friction in the plane
    approach: float  # m/s, normal speed of approach, positive when closing
    forward: float = 1.0  # sign of the motion of the first ball along (ny, -nx)
    partner: str = ""  # name of the surface or of the second ball
    friction: float = 0.0  # of the pair, in all directions
    slip: tuple[float, float] = (0.0, 0.0)  # m/s, of the surfaces, in the plane and upward


#: Two shapes that touch, in any order: the ids of both.
_Pair = frozenset[int]


def _pair(first: pymunk.Shape, second: pymunk.Shape) -> _Pair:
    return frozenset((id(first), id(second)))


class ImpulseSpace:
    """The pymunk Space in which impulses are computed; one per run."""

    def __init__(self, balls: Sequence[Ball], numerics: Numerics) -> None:
        self._numerics = numerics
        self._space = pymunk.Space()
        self._space.collision_slop = 1.0
        self._space.collision_bias = 1.0
        self._space.collision_persistence = 1
        self._balls = balls
        self._bodies: list[pymunk.Body] = []
        self._discs: list[pymunk.Circle] = []
        self._planes: list[pymunk.Segment] = []
        self.normal_impulses: list[float] = []  # N s, of the contacts of the last exchange
        self._bounces: dict[_Pair, Bounce] = {}  # of balls that touch
        self._spread = 100.0 * max(ball.radius for ball in balls)  # m, between balls that are not involved
        for index, ball in enumerate(balls):
            body = pymunk.Body(ball.mass, ball.inertia)
            disc = pymunk.Circle(body, ball.radius)
            disc.elasticity = disc.friction = 1.0  # pymunk multiplies them by those of the planes
            disc.collision_type = _BALL
            self._space.add(body, disc)
            self._bodies.append(body)
            self._discs.append(disc)
            self._park(index)
        if len(balls) > 1:
            self._space.on_collision(_BALL, _BALL, pre_solve=self._set_bounce)

    def _set_bounce(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        """Set restitution and friction of a pair of balls, which the product of two values cannot express."""
        bounce = self._bounces.get(_pair(*arbiter.shapes))
        if bounce is None:  # close enough to overlap here, but not in contact
            arbiter.process_collision = False
        else:
            arbiter.restitution, arbiter.friction = bounce.restitution, bounce.friction

    def exchange(self, cluster: Sequence[BallAtImpact], contacts: Sequence[Contact]) -> None:
        """Give each ball of the cluster its velocity and spin after the impact."""
        origin = cluster[0]
        scale = 1.0 - _OVERLAP
        for moving in cluster:
            body = self._bodies[moving.index]
            body.position = (scale * (moving.x - origin.x), scale * (moving.y - origin.y))
            body.velocity = (moving.vx, moving.vy)
            body.angular_velocity = moving.spin
        planes = 0
        self._bounces.clear()
        for contact in contacts:
            if contact.second is None:
                self._lay_plane(planes, cluster[contact.first], contact)
                planes += 1
            else:
                first, second = (self._discs[cluster[place].index] for place in (contact.first, contact.second))
                self._bounces[_pair(first, second)] = contact.bounce
        self._space.iterations = _ITERATIONS if len(contacts) == 1 else _CLUSTER_ITERATIONS
        self._space.step(_INSTANT)
        self.normal_impulses = self._read_impulses(cluster, contacts)
        for moving in cluster:
            body = self._bodies[moving.index]
            moving.vx, moving.vy = body.velocity
            moving.spin = body.angular_velocity
            self._park(moving.index)
        for plane in self._planes[:planes]:
            self._remove(plane)
        self._space.step(_INSTANT)  # moved apart: pymunk drops the contact, so that the next impact starts fresh
        self._numerics.pymunk_steps += 2

    def _read_impulses(self, cluster: Sequence[BallAtImpact], contacts: Sequence[Contact]) -> list[float]:
        """The normal impulse of each contact in N s, before the velocities are read back into the cluster."""
        if len(contacts) == 1:
            contact = contacts[0]
            moving = cluster[contact.first]
            vx, vy = self._bodies[moving.index].velocity
            gain = (vx - moving.vx) * contact.nx + (vy - moving.vy) * contact.ny
            return [self._balls[moving.index].mass * gain]
        by_shapes: dict[_Pair, float] = {}

        def read(arbiter: pymunk.Arbiter) -> None:
            jx, jy = arbiter.total_impulse
            nx, ny = arbiter.normal
            by_shapes[_pair(*arbiter.shapes)] = abs(jx * nx + jy * ny)

        for moving in cluster:
            self._bodies[moving.index].each_arbiter(read)
        impulses = []
        planes = iter(self._planes)
        for contact in contacts:
            disc = self._discs[cluster[contact.first].index]
            other = next(planes) if contact.second is None else self._discs[cluster[contact.second].index]
            impulses.append(by_shapes.get(_pair(disc, other), 0.0))
        return impulses

    def _lay_plane(self, number: int, moving: BallAtImpact, contact: Contact) -> None:
        radius = self._balls[moving.index].radius
        nx, ny = contact.nx, contact.ny
        if contact.bounce.tilt != 0.0:
            c, s = cos(contact.bounce.tilt), contact.forward * sin(contact.bounce.tilt)
            nx, ny = c * nx - s * ny, c * ny + s * nx
        x, y = self._bodies[moving.index].position
        depth = radius * (1.0 - _OVERLAP)
        x -= depth * nx
        y -= depth * ny
        half = 0.1 * radius
        a, b = (x + half * ny, y - half * nx), (x - half * ny, y + half * nx)
        if number == len(self._planes):
            plane = pymunk.Segment(self._space.static_body, a, b, 0.0)
            self._space.add(plane)
            self._planes.append(plane)
        else:
            plane = self._planes[number]
            plane.unsafe_set_endpoints(a, b)
            self._space.reindex_shape(plane)
        plane.elasticity = contact.bounce.restitution
        plane.friction = contact.bounce.friction

    def _park(self, index: int) -> None:
        body = self._bodies[index]
        body.position = ((index + 1) * self._spread, self._spread)
        body.velocity = (0.0, 0.0)
        body.angular_velocity = 0.0

    def _remove(self, plane: pymunk.Segment) -> None:
        plane.unsafe_set_endpoints((0.0, -self._spread), (self._spread * 1e-3, -self._spread))
        self._space.reindex_shape(plane)
