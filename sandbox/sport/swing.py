"""A ball that begins with a blow: of a racket, or of a bat."""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians, sin

from sandbox.engine.model.ball import Ball
from sandbox.errors import RequestError
from sandbox.parameters import Group, quantity
from sandbox.physics.swing import Rebound, apparent_restitution, gripping, struck
from sandbox.sport.flight import RPM


class Swing(Group):
    """A swing, and the ball that it meets."""

    speed: float = quantity(..., "m/s", 0, 80, "speed at the point of impact")
    angle: float = quantity(..., "deg", -90, 90, "direction of the swing above the horizontal")
    face: float = quantity(..., "deg", -80, 80, "direction of the face at the impact above the horizontal")
    ball_speed: float = quantity(..., "m/s", 0, 100, "speed of the incoming ball")
    ball_angle: float = quantity(..., "deg", -90, 90, "angle at which the incoming ball falls")
    ball_spin: float = quantity(..., "rpm", -20000, 20000, "of the incoming ball; backspin positive, topspin negative")


class Bat(Swing):
    """A bat, and the ball that it meets."""

    mass: float = quantity(..., "kg", 0.1, 5, "mass")
    inertia: float = quantity(..., "kg m^2", 1e-3, 1, "moment of inertia about its centre of mass")
    offset: float = quantity(..., "m", 0, 0.5, "from the centre of mass to the point of impact")
    restitution: float = quantity(..., "", 0, 1, "of bat and ball")
    tangential: float = quantity(..., "", 0, 1, "share of the slip that is reversed")

    def rebound(self, ball_mass: float, inertia_factor: float) -> Rebound:
        """The value for a ball of that mass in kg."""
        normal = apparent_restitution(self.restitution, ball_mass, self.mass, self.inertia, self.offset)
        return gripping(normal, self.tangential, inertia_factor)


def struck_by(swing: Swing, key: str, rebound: Rebound, ball: Ball) -> Ball:
    """The ball as it leaves the face. Raises RequestError that names the group ``key`` if they do not meet."""
    path, fall = radians(swing.angle), radians(swing.ball_angle)
    face = swing.speed * cos(path), swing.speed * sin(path)
    incoming = -swing.ball_speed * cos(fall), -swing.ball_speed * sin(fall)
    try:
        velocity, spin = struck(rebound, face, radians(swing.face), incoming, -swing.ball_spin * RPM, ball.radius)
    except ValueError as error:
        raise RequestError(f"{key}.face = {swing.face:g} deg: {error}") from None
    return replace(ball, velocity=velocity, spin=spin)
