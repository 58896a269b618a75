"""A club head meets a ball, as a real contact of two bodies in pymunk."""

from __future__ import annotations

from math import cos, inf, sin

import pymunk

from sandbox.engine.setup import SOLID_SPHERE
from sandbox.physics.impulse import Launch

#: Length in s of the step in which the impulse is exchanged; nothing moves in it.
_INSTANT = 1e-15

#: Ball and face overlap by this share of the ball's radius, so that Chipmunk sees the contact.
_OVERLAP = 1e-6

#: Solver rounds; a single contact is exact after one.
_ROUNDS = 10


def strike(
    speed: float,
    loft: float,
    club_mass: float,
    ball_mass: float,
    radius: float,
    restitution: float,
    attack: float = 0.0,
    friction: float = 1.0,
) -> Launch:
    """Velocity and spin that a free club head gives to a solid ball at rest.

    The face is a straight piece leaning back by ``loft`` (rad), on a body of ``club_mass`` kg that moves at ``speed``
    m/s,
    ``attack`` rad above the horizontal, and cannot rotate. Restitution and friction are those of ball and face. The
    same as ``sandbox.physics.impulse.club_on_ball``. Raises ValueError where the face moves away from the ball.
    """
    if speed * cos(loft - attack) < 0.0:
        raise ValueError("the face moves away from the ball")
    nx, ny = cos(loft), sin(loft)
    space = pymunk.Space()
    space.iterations = _ROUNDS
    space.collision_slop = radius  # no position correction: the overlap is part of the method
    ball = pymunk.Body(ball_mass, SOLID_SPHERE * ball_mass * radius * radius)
    disc = pymunk.Circle(ball, radius)
    disc.elasticity = disc.friction = 1.0  # pymunk multiplies the two shapes' values: the face has the pair's
    head = pymunk.Body(club_mass, inf)
    head.position = (-radius * (1.0 - _OVERLAP) * nx, -radius * (1.0 - _OVERLAP) * ny)
    head.velocity = (speed * cos(attack), speed * sin(attack))
    face = pymunk.Segment(head, (-radius * ny, radius * nx), (radius * ny, -radius * nx), 0.0)
    face.elasticity = restitution
    face.friction = friction
    space.add(ball, disc, head, face)
    space.step(_INSTANT)
    return Launch(*ball.velocity, ball.angular_velocity)
