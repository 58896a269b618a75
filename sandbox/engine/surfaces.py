"""How a surface acts on a ball: the bounce of an impact, and whether the ball stays in contact.

Speeds and accelerations are floats, or arrays for many shots at once, except for a scene's own law.
"""

from __future__ import annotations

from math import inf, isfinite
from numbers import Real
from typing import Any

from sandbox.engine.setup import Bounce, Setup, Surface
from sandbox.errors import RunError
from sandbox.physics.elementwise import choose
from sandbox.physics.integrators import Acceleration, State

#: Approach speed in m/s below which it is rounding and not an impact.
STILL = 1e-9

#: Speed in m/s away from a surface below which it is rounding.
_AWAY = 1e-10


def bounce_off(surface: Surface, approach: float, along: float) -> Bounce:
    """Restitution, friction and tilt of an impact at these speeds (m/s). Raises RunError for invalid values."""
    if surface.law is None or approach <= 0.0:
        return Bounce(surface.restitution, surface.friction)
    return _valid(surface.law(approach, abs(along)), surface.name)


def bounce_of_balls(setup: Setup, approach: float, slip: float, ball: str, partner: str) -> Bounce:
    """The bounce of two balls at these speeds (m/s)."""
    return _valid(setup.between(ball, partner)(max(approach, 0.0), slip), partner)


def _valid(bounce: Bounce, partner: str) -> Bounce:
    """The bounce off ``partner``, unchanged. Raises RunError if it is invalid: Chipmunk would abort the program."""
    if not isinstance(bounce, Bounce) or not all(isinstance(value, Real) for value in bounce):
        raise RunError(
            f"a ball meets {partner!r}: the scene's law must return a Bounce of numbers, such as "
            f"Bounce(restitution=0.7, friction=0.3), and returned {bounce!r:.60}"
        )
    if 0.0 <= bounce.restitution < inf and 0.0 <= bounce.friction < inf and isfinite(bounce.tilt):
        return bounce
    raise RunError(f"{bounce} off {partner!r} is invalid: check the scene's law for it")


def press(state: State, acceleration: Acceleration, nx: Any, ny: Any, curvature: Any) -> Any:
    """Acceleration in m/s^2 that presses a ball on a surface with this normal; ``curvature`` (1/m) is that of its
    path."""
    along = state[2] * ny - state[3] * nx
    return -(acceleration[0] * nx + acceleration[1] * ny) - curvature * along * along


def leaves_at(press: Any, height: Any) -> Any:
    """Speed in m/s away from a surface above which a ball flies off: it would rise higher than ``height`` (m).

    ``press`` in m/s^2 drives it back; if negative, its size does not matter.
    """
    return (2.0 * choose(press > 0.0, press, 0.0) * height) ** 0.5 + _AWAY
