"""Response of a surface to a ball: the bounce of an impact, and whether the ball stays in contact.

Speeds and accelerations are floats, or arrays for many shots at once, except for a scene's own law.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, hypot, inf, isfinite
from numbers import Real
from typing import Any

from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import UserFunctionError, call_user_function
from sandbox.engine.model.surface import Bounce, BounceLaw, Surface
from sandbox.engine.model.tolerances import STILL
from sandbox.physics.elementwise import cos, sin, where
from sandbox.physics.impulse import after_impulse, surface_speeds
from sandbox.physics.integrators import Acceleration, State
from sandbox.tracebacks import defined_at

_FLOATS = [float] * len(Bounce._fields)


def bounce_off(surface: Surface, approach: float, along: float) -> Bounce:
    """Return a surface's bounce in an impact at these speeds (m/s). Raises RunError for invalid values."""
    if surface.law is None or approach <= 0.0:
        return Bounce(surface.restitution, surface.friction)
    return _bounce_by(surface.law, surface.name, approach, abs(along))


def bounce_of_balls(setup: Setup, approach: float, slip: float, ball: str, partner: str) -> Bounce:
    """The bounce of two balls at these speeds (m/s)."""
    return _bounce_by(setup.between(ball, partner), partner, max(approach, 0.0), slip)


def _bounce_by(law: BounceLaw, partner: str, approach: float, along: float) -> Bounce:
    """The bounce off ``partner`` by a scene's law. Raises UserFunctionError if it is invalid: Chipmunk would abort the
    program."""
    bounce = call_user_function(
        law, f"the law for {partner!r} is called as law(normal_speed, tangential_speed)", approach, along
    )
    # floats first: Real takes five times as long
    numbers = isinstance(bounce, Bounce) and [*map(type, bounce)] == _FLOATS
    if not numbers and not (isinstance(bounce, Bounce) and all(isinstance(value, Real) for value in bounce)):
        raise UserFunctionError(
            f"a ball hit {partner!r}: the scene's law must return a Bounce of numbers, such as "
            f"Bounce(restitution=0.7, friction=0.3), and returned {bounce!r:.60}{defined_at(law)}"
        )
    restitution, friction, tilt, tangential = bounce
    if not 0.0 <= restitution <= 1.0:
        problem = f"restitution {restitution:g}: must be from 0 to 1"
    elif not 0.0 <= friction < inf:
        problem = f"friction {friction:g}: must be finite, and not negative"
    elif not isfinite(tilt):
        problem = f"tilt {tilt:g}: must be finite"
    elif not 0.0 <= tangential <= 1.0:
        problem = f"tangential {tangential:g}: must be from 0 to 1"
    else:
        return bounce
    raise UserFunctionError(f"the scene's law for {partner!r} returned {problem}{defined_at(law)}")


def tilted(nx: Any, ny: Any, tilt: Any, along: Any) -> tuple[Any, Any]:
    """The normal of a surface that deforms: turned by ``tilt`` (rad) against a motion ``along`` it."""
    tilt = where(along >= 0.0, tilt, -tilt)
    c, s = cos(tilt), sin(tilt)
    return c * nx - s * ny, c * ny + s * nx


def friction_in_plane(friction: float, along: float, upward: float) -> float:
    """The part of a friction coefficient that acts in the plane, for a slip (m/s) along and upward.

    Friction acts against the total slip, and a sphere responds equally in all directions along its surface, so the
    fraction in the plane is that of the slip, sticking or sliding.
    """
    return friction * abs(along) / hypot(along, upward) if upward != 0.0 else friction


def speeds_where_touching(
    balls: Sequence[Ball], states: Sequence[State], nx: float, ny: float, sine: float = 0.0
) -> tuple[float, float, float]:
    """Speed of approach, and slip along and upward, in m/s, of a ball and a surface or of two balls.

    The unit normal points to the first ball; ``sine`` is that of the angle above its centre at which it is touched.
    """
    approach, along, upward = surface_speeds(states[0][2:], nx, ny, balls[0].radius, sine)
    if len(balls) == 1:
        return approach, along, upward
    other = surface_speeds(states[1][2:], -nx, -ny, balls[1].radius)
    return approach + other[0], along + other[1], upward - other[2]


def after_impulses(
    balls: Sequence[Ball],
    states: Sequence[State],
    nx: float,
    ny: float,
    impulse: tuple[float, float, float],
    sine: float = 0.0,
) -> list[State]:
    """The states of one or two balls after impulses (N s) along the normal, along the surface and upward."""
    after = []
    for ball, state, side in zip(balls, states, (1.0, -1.0), strict=False):
        push, along, upward = impulse
        impulses = push / ball.mass, along / ball.mass, side * upward / ball.mass
        motion = after_impulse(state[2:], side * nx, side * ny, ball.radius, ball.inertia_factor, impulses, sine)
        after.append((*state[:2], *motion))
    return after


def after_vertical_friction(
    balls: Sequence[Ball], states: Sequence[State], nx: float, ny: float, slip: tuple[float, float], most: float
) -> list[State]:
    """The states after the upward part of the friction, for a slip (m/s) before it along and upward.

    ``most`` is the impulse in N s of sliding friction, in all directions.
    """
    along, upward = slip
    stopping = abs(upward) / sum((1.0 + 1.0 / ball.inertia_factor) / ball.mass for ball in balls)
    impulse = -copysign(min(most * abs(upward) / hypot(along, upward), stopping), upward)
    return after_impulses(balls, states, nx, ny, (0.0, 0.0, impulse))


def press(state: State, acceleration: Acceleration, nx: Any, ny: Any, curvature: Any) -> Any:
    """Acceleration in m/s^2 that presses a ball on a surface with this normal; ``curvature`` (1/m) is that of its
    path."""
    along = state[2] * ny - state[3] * nx
    return -(acceleration[0] * nx + acceleration[1] * ny) - curvature * along * along


def takeoff_speed(press: Any, height: Any) -> Any:
    """Speed in m/s away from a surface above which a ball flies off: it would rise higher than ``height`` (m).

    ``press`` in m/s^2 drives it back; if negative, its size does not matter.
    """
    return (2.0 * where(press > 0.0, press, 0.0) * height) ** 0.5 + STILL
