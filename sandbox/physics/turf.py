"""Turf: bounce and roll of a golf ball on grass."""

from __future__ import annotations

from math import atan2, cos, degrees, radians, sin, sqrt

#: Speed in m/s at which a stimpmeter releases the ball. USGA, Stimpmeter Instruction Booklet (6 ft/s); second-hand.
STIMPMETER_SPEED = 1.83

#: Gravity in m/s^2 where stimpmeters are read.
_GRAVITY = 9.81


def penner_restitution(normal_speed: float) -> float:
    """Restitution of a golf ball on turf: ``e = 0.510 - 0.0375 v + 0.000903 v^2`` for v up to 20 m/s, 0.120 above.

    ``normal_speed`` v in m/s. Source: Penner 2002, Can. J. Phys. 80:931, from Haake's measurements on greens;
    second-hand.
    """
    if normal_speed > 20.0:
        return 0.120
    return 0.510 - 0.0375 * normal_speed + 0.000903 * normal_speed * normal_speed


def penner_tilt(normal_speed: float, tangential_speed: float, give: float = 1.0) -> float:
    """Angle in rad by which the turf deforms, so that the ball bounces off a slope it has made.

    ``give * 15.4 deg (v / 18.6 m/s) (phi / 44.4 deg)`` with the speed v of the impact and its angle phi from the
    vertical. Source: Penner 2002, as above, who draws a line through one of Haake's measurements on a green (18.6 m/s,
    44.4 deg); second-hand. The limit is ours, since a line through one point says nothing about balls that skim the
    ground: at most two thirds of the descent angle, and at most 45 deg. It affects balls that descend at less than
    about 35 deg; without it a topped ball would bounce straight up.
    """
    speed = sqrt(normal_speed * normal_speed + tangential_speed * tangential_speed)
    incidence = degrees(atan2(tangential_speed, normal_speed))
    return radians(min(give * 15.4 * (speed / 18.6) * (incidence / 44.4), (90.0 - incidence) / 1.5, 45.0))


def penner_bounce(normal_speed: float, tangential_speed: float, give: float = 1.0) -> tuple[float, float]:
    """Restitution, and the tilt in rad of the surface that the ball bounces off, for an impact on level turf.

    The turf tilts by penner_tilt; the restitution is that of the speed normal to the tilted surface. Speeds in m/s,
    both positive. Source: Penner 2002, as above.
    """
    tilt = penner_tilt(normal_speed, tangential_speed, give)
    return penner_restitution(normal_speed * cos(tilt) + tangential_speed * sin(tilt)), tilt


def stimp_resistance(stimp: float) -> float:
    """Deceleration divided by gravity of a ball rolling on a green with a stimpmeter reading of ``stimp`` m.

    A stimpmeter releases the ball at 1.83 m/s and measures how far it rolls: ``c = (1.83 m/s)^2 / (2 g stimp)``, which
    is 0.56 divided by the reading in feet. Source: Holmes 1991, Am. J. Phys. 59:129; second-hand.
    """
    return STIMPMETER_SPEED**2 / (2.0 * _GRAVITY * stimp)
