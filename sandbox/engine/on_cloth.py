"""Motion on cloth, seen from above: exact arcs, one for each phase of sliding, rolling, spinning or rest."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, hypot, isfinite

from sandbox.engine.arc import Arc, still
from sandbox.engine.motion import Contact
from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball, Bounce
from sandbox.engine.track import Track
from sandbox.errors import RunError
from sandbox.physics.cloth import Cloth
from sandbox.physics.cushion import rebound
from sandbox.physics.integrators import State


def slowest_hop(cloth: Cloth, hop: float) -> float:
    """Speed in m/s with which what the cloth presses together parts at least, for an accuracy's ``hop`` (m).

    A steady push is then a run of even hops, and not an endless series of ever smaller ones. The energy of the first
    hop of such a run, half the reduced mass times this squared (2e-7 J for pool balls at "balanced"), is taken
    from all motion of the balls.
    """
    return float((2.0 * cloth.sliding * cloth.gravity * hop) ** 0.5)


class OnCloth:
    """One ball and the cloth it moves on."""

    def __init__(self, ball: Ball, cloth: Cloth, numerics: Numerics) -> None:
        self.ball = ball
        self._cloth = cloth
        self._numerics = numerics

    def advance(self, t: float, until: float, state: State, contact: Contact | None) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``: a whole phase, however long."""
        phase = self._cloth.phase(state, self.ball.radius)
        self._numerics.steps += 1
        if phase.mode == "resting":
            return still(t, until, state), ""
        h = min(phase.duration, until - t)
        end = self._cloth.after(state, phase, h)
        if not all(map(isfinite, end)):
            raise RunError(
                f"t = {t:.6g} s, ball {self.ball.name!r}: its motion on the cloth is beyond what can be computed with; "
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

    def settle(self, t: float, state: State, track: Track, height: float) -> tuple[State, Contact | None]:
        """As it is: cloth knows no lasting contact with a cushion."""
        return state, None

    def conclude(self, state: State, contact: Contact | None, reason: str) -> State:
        """As it is: phases end exactly."""
        return state

    def rests(self, arc: Arc) -> bool:
        """Whether the ball lies still on this arc."""
        return arc.t1 > arc.t0 and len(arc.x) == 1 and len(arc.spin) == 1


def slip_over(ball: Ball, state: State, nx: float, ny: float) -> float:
    """Upward velocity in m/s of a ball's surface where it touches something against the normal (nx, ny)."""
    return ball.radius * (state[6] * nx - state[5] * ny) if len(state) > 5 else 0.0


def in_plane(friction: float, flat: float, upward: float) -> float:
    """The plane's share of a friction, where surfaces slip by so much (m/s) in the plane and upward.

    Friction acts against the whole slip and all directions of a sphere's surface give way alike, so its part in the
    plane is to the whole as that part of the slip is, sticking or sliding.
    """
    return friction * abs(flat) / hypot(flat, upward) if upward != 0.0 else friction


def rubbed(
    balls: Sequence[Ball], states: Sequence[State], normal: tuple[float, float], slip: tuple[float, float], most: float
) -> list[State]:
    """The states of the one or two balls of a contact after the upward share of its friction.

    ``normal`` points to the first of them, ``slip`` is that in the plane and upward before, and ``most`` the impulse in
    N s of friction that slides. What it does to the height is left out.
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
