"""The textbook collision formulas, in closed form: what pymunk's contacts are checked against."""

from __future__ import annotations

from math import cos, sin
from typing import NamedTuple


class Launch(NamedTuple):
    """A ball just after it is struck."""

    vx: float  # m/s
    vy: float  # m/s
    spin: float  # rad/s, counter-clockwise: backspin of a ball that flies towards +x


def club_on_ball(
    speed: float, loft: float, club_mass: float, ball_mass: float, radius: float, restitution: float
) -> Launch:
    """A free, not rotating club head meets a solid ball at rest, which rolls on the face before it leaves.

    Along the face's normal ``v_n = (1 + e) V cos L M / (M + m)``; along the face ``v_t = (2/7) V sin L / (1 + 2 m / (7 M))`` up it,
    with backspin ``w = (5/2) v_t / r``. ``speed`` V in m/s, ``loft`` L in rad, masses M and m in kg, ``radius`` r in m. Holds while the face
    grips: lofts up to about 45 deg with a dry face. Source: momentum and angular momentum at the contact; Penner 2003, Rep. Prog.
    Phys. 66:131, section 3.
    """
    normal = (1.0 + restitution) * speed * cos(loft) * club_mass / (club_mass + ball_mass)
    tangential = (2.0 / 7.0) * speed * sin(loft) / (1.0 + 2.0 * ball_mass / (7.0 * club_mass))
    return Launch(
        normal * cos(loft) + tangential * sin(loft),
        normal * sin(loft) - tangential * cos(loft),
        2.5 * tangential / radius,
    )
