"""Motion on cloth, seen from above: exact arcs, one per phase of sliding, rolling, spinning or rest."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, hypot, isfinite

from sandbox.engine.arc import Arc, still
from sandbox.engine.motion import LastingContact
from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball, Bounce
from sandbox.engine.track import Track
from sandbox.errors import RunError
from sandbox.physics.cloth import Cloth
from sandbox.physics.cushion import rebound
from sandbox.physics.integrators import State


def slowest_hop(cloth: Cloth, hop: float) -> float:
    """Minimum speed in m/s at which bodies that the cloth presses together separate, for an accuracy's ``hop`` (m).

    A steady push then becomes a series of equal hops instead of an endless series of smaller and smaller ones. The
    energy of the first hop of such a series, half the reduced mass times this speed squared (2e-7 J for pool balls at
    "balanced"), is removed from the motion of all balls.
    """
    return float((2.0 * cloth.sliding * cloth.gravity * hop) ** 0.5)


class OnCloth:
    """One ball and the cloth it moves on."""

    def __init__(self, ball: Ball, cloth: Cloth, numerics: Numerics) -> None:
        self.ball = ball
        self._cloth = cloth
        self._numerics = numerics

    def advance(self, t: float, until: float, state: State, contact: LastingContact | None) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``: a whole phase, of any length."""
        phase = self._cloth.phase(state, self.ball.radius)
        self._numerics.steps += 1
        if phase.mode == "resting":
            return still(t, until, state), ""
        h = min(phase.duration, until - t)
        end = self._cloth.after(state, phase, h)
        if not all(map(isfinite, end)):
            raise RunError(
                f"t = {t:.6g} s, ball {self.ball.name!r}: its motion on the cloth cannot be computed; "
                "check its radius and speed, and the cloth's friction"
            )
        x, y, vx, vy, spin, wx, wy = state
        x1, y1, vx1, vy1, spin1, wx1, wy1 = end
        half = 0.5 * h
        arc = Arc(
            t,
            t + h,
            state,
            (x, x + half * vx, x1),
            (y, y + half * vy, y1),
            (vx, vx + h * phase.ax),
            (vy, vy + h * phase.ay),
            (spin, spin + h * phase.alpha_z),
            None,
            ((wx, wx + h * phase.alpha_x), (wy, wy + h * phase.alpha_y)),
            end,
        )
        return arc, ""

    def settle(self, t: float, state: State, track: Track, height: float) -> tuple[State, LastingContact | None]:
        """Unchanged: on cloth there is no lasting contact with a cushion."""
        return state, None

    def conclude(self, state: State, contact: LastingContact | None, reason: str) -> State:
        """Unchanged: phases end exactly."""
        return state

    def rests(self, arc: Arc) -> bool:
        """Whether the ball is at rest on this arc."""
        return arc.t1 > arc.t0 and len(arc.x) == 1 and len(arc.spin) == 1


def slip_over(ball: Ball, state: State, nx: float, ny: float) -> float:
    """Upward velocity in m/s of a ball's surface where it touches something against the normal (nx, ny)."""
    return ball.radius * (state[6] * nx - state[5] * ny) if len(state) > 5 else 0.0


def in_plane(friction: float, flat: float, upward: float) -> float:
    """The part of a friction coefficient that acts in the plane, for these slips (m/s) in the plane and upward.

    Friction acts against the total slip, and a sphere responds equally in all directions along its surface, so the
    fraction in the plane is that of the slip, sticking or sliding.
    """
    return friction * abs(flat) / hypot(flat, upward) if upward != 0.0 else friction


def rubbed(
    balls: Sequence[Ball], states: Sequence[State], normal: tuple[float, float], slip: tuple[float, float], most: float
) -> list[State]:
    """The states of the one or two balls of a contact after the upward part of its friction.

    ``normal`` points to the first of them, ``slip`` is the slip before, in the plane and upward, and ``most`` the
    impulse in N s of sliding friction. Its effect on the height is ignored.
    """
    nx, ny = normal
    flat, upward = slip
    stopping = abs(upward) / sum((1.0 + 1.0 / ball.inertia_factor) / ball.mass for ball in balls)
    impulse = -copysign(min(most * abs(upward) / hypot(flat, upward), stopping), upward)
    after = []
    for ball, (x, y, vx, vy, spin, wx, wy) in zip(balls, states, strict=True):
        turn = ball.radius * impulse / ball.inertia
        after.append((x, y, vx, vy, spin, wx - turn * ny, wy + turn * nx))
    return after


def off_nose(ball: Ball, state: State, normal: tuple[float, float], height: float, bounce: Bounce) -> State:
    """The state after a ball has met a cushion's nose at ``height`` (m)."""
    x, y, vx, vy, spin, wx, wy = state
    motion = rebound((vx, vy, spin, wx, wy), normal, ball.radius, height, bounce.restitution, bounce.friction)
    return (x, y, *motion)
