"""A cushion whose nose touches the ball above its centre, so that the rebound affects spin about all axes.

The nose at height h above the cloth touches the ball at an angle theta above the ball's centre,

    sin(theta) = (h - R) / R.

Per unit of mass the normal impulse there is ``Pn = (1 + e) v_n cos(theta)``, with v_n the ball's speed into the
cushion. Friction acts against the slip s of the ball's surface there, limited by ``mu Pn`` and by what brings the slip
to zero: ``Pt = min(mu Pn, 2/7 |s|)``. ``impulse.py`` has what they change.

Valid for a solid sphere that stays on the cloth, up to about 2.5 m/s. Left out: the duration of the contact, and
the jump of a fast ball. Source: the geometry of Han 2005, Dynamics in carom and three cushion billiards, J. Mech. Sci.
Technol. 19:976. With e = 0.88, mu = 0.265 and h = 37 mm for balls of 30.75 mm it matches 329 rebounds tracked on
carom tables to 1.4 deg rms (*ours*: fitted to published tracks).
"""

from __future__ import annotations


def nose_sine(radius: float, height: float) -> float:
    """Sine of the angle above its centre at which a ball of ``radius`` m touches a nose at ``height`` m."""
    return (height - radius) / radius
