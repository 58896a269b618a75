"""The stroke of a cue off the ball's centre, which sends the ball aside: squirt, also called cue-ball deflection."""

from __future__ import annotations

from typing import Any

from sandbox.physics.elementwise import atan2, maximum


def squirt_angle(english: Any, follow: Any, end_mass: Any) -> Any:
    """Angle in rad by which the ball leaves to the left of the cue's direction, for a tip to its right.

    The tip holds on to the ball. As the ball begins to turn, its surface pushes the end of the cue to the right, and
    that pushes the ball to the left:

        tan(a) = (5/2) x c / (1 + m/m_e + (5/2) c^2),  c^2 = 1 - x^2 - y^2.

    ``english`` x and ``follow`` y are the tip's offsets to the right and upward in radii; ``end_mass`` m_e/m is the
    mass of the part of the cue that moves aside with the tip, over the ball's. Source: Alciatore, Squirt II,
    second-hand, for y = 0; with y, *ours* by the same derivation. Valid for a solid ball, a level cue, and a tip that
    does not slip. Left out: that the push takes a tenth of the side spin.
    """
    deep = maximum(1.0 - english * english - follow * follow, 0.0 * english)
    return atan2(2.5 * english * deep**0.5 * end_mass, 1.0 * end_mass + 1.0 + 2.5 * deep * end_mass)
