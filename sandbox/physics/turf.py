"""Turf: how a golf ball bounces and rolls on grass."""

from __future__ import annotations

from math import atan2, degrees, radians


def penner_restitution(normal_speed: float) -> float:
    """Restitution of a golf ball on turf: ``e = 0.510 - 0.0375 v + 0.000903 v^2`` for v up to 20 m/s, 0.120 above.

    ``normal_speed`` v in m/s. Source: Penner 2002, Can. J. Phys. 80:931, equation 6.
    """
    if normal_speed > 20.0:
        return 0.120
    return 0.510 - 0.0375 * normal_speed + 0.000903 * normal_speed * normal_speed


def penner_tilt(normal_speed: float, tangential_speed: float) -> float:
    """Angle in rad by which the turf gives way, so that the ball bounces off a slope of its own making.

    ``15.4 deg (v / 18.6 m/s) (phi / 44.4 deg)`` with the impact speed v and its angle phi from the vertical. Held at 45 deg.
    Source: Penner 2002, Can. J. Phys. 80:931, equation 5, with the values measured by Haake for a firm green.
    """
    speed = (normal_speed * normal_speed + tangential_speed * tangential_speed) ** 0.5
    incidence = degrees(atan2(tangential_speed, normal_speed))
    return radians(min(15.4 * (speed / 18.6) * (incidence / 44.4), 45.0))


def stimp_resistance(stimp: float) -> float:
    """Deceleration over gravity of a ball rolling on a green of the given stimpmeter reading in feet: ``0.56 / stimp``.

    A stimpmeter lets the ball go at 1.83 m/s and reads how far it rolls, so ``a = 1.83^2 / (2 * 0.3048 stimp)``.
    Source: USGA, Stimpmeter Instruction Booklet; Holmes 1991, Am. J. Phys. 59:129.
    """
    return 0.56 / stimp
