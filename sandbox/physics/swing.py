"""A ball struck by a racket or a bat: its velocity and spin after the impact."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin


@dataclass(frozen=True)
class Rebound:
    """The rebound of a ball from a face that somebody holds, linear in its motion relative to the face before.

    Across the face ``v_n' = (normal - softer v_n) v_n``; along it ``v_t' = slide v_t + lift r w`` and
    ``r w' = kick v_t + turn r w``; the face is to the left of the ball, v_t is upwards, and w counter-clockwise.
    """

    normal: float
    slide: float
    lift: float
    kick: float
    turn: float
    softer: float = 0.0  # s/m


def gripping(normal: float, tangential: float, inertia_factor: float) -> Rebound:
    """The rebound off a hard face that the ball grips: the contact point returns ``tangential`` of its slip.

    Momentum along the face and angular momentum about the contact point are conserved, with the ball's moment of
    inertia ``inertia_factor m r^2``. Source: Cross 2002, Am. J. Phys. 70:1093, second-hand.
    """
    part = (1.0 + tangential) / (1.0 + inertia_factor)
    return Rebound(normal, 1.0 - inertia_factor * part, inertia_factor * part, part, 1.0 - part)


#: Coverings of a racket. Strings of a hand-held tennis racket: fitted to 39 filmed bounces, Cross 2005,
#: second-hand. Rubber: an offensive table tennis racket, number 1 of ten fitted to 8,184 filmed
#: bounces at 4 to 9 m/s (arXiv 2604.11349): the impulse along it is 0.681 of the slip times the ball's mass.
STRINGS = Rebound(0.420, 0.648, 0.300, 0.583, 0.400)
RUBBER = Rebound(0.917, 1.0 - 0.681, 0.681, 1.5 * 0.681, 1.0 - 1.5 * 0.681, softer=0.0217)


def apparent_restitution(restitution: float, ball: float, bat: float, inertia: float, offset: float) -> float:
    """Speed of a ball off a free bat at rest, over that with which it came: ``(e - r) / (1 + r)``.

    ``r = m (1/M + b^2 / I)`` with the masses of ball m and bat M (kg), the bat's moment of inertia I (kg m^2) about its
    centre of mass, and the distance b (m) of the impact from there. The hands are left out: the impact is over before
    they feel it. Source: Nathan 2003, Am. J. Phys. 71:134; second-hand.
    """
    recoil = ball * (1.0 / bat + offset * offset / inertia)
    return (restitution - recoil) / (1.0 + recoil)


def struck(
    rebound: Rebound,
    face: tuple[float, float],
    tilt: float,
    velocity: tuple[float, float],
    spin: float,
    radius: float,
) -> tuple[tuple[float, float], float]:
    """Velocity (m/s) and spin (rad/s, counter-clockwise) of a ball that is struck towards +x.

    ``face`` is the velocity of the face, which looks ``tilt`` rad above the horizontal. Raises ValueError where the two
    do not meet.
    """
    nx, ny = cos(tilt), sin(tilt)
    ux, uy = velocity[0] - face[0], velocity[1] - face[1]
    across, along, turning = -(ux * nx + uy * ny), uy * nx - ux * ny, radius * spin
    if across <= 0.0:
        raise ValueError("the face moves away from the ball")
    out = max(0.0, rebound.normal - rebound.softer * across) * across
    up = rebound.slide * along + rebound.lift * turning
    after = (face[0] + out * nx - up * ny, face[1] + out * ny + up * nx)
    return after, (rebound.kick * along + rebound.turn * turning) / radius
