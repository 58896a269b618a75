"""Motion on cloth, seen from above: exact arcs, one per phase of sliding, rolling, spinning or rest."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from sandbox.engine.arc import Arc, still
from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball
from sandbox.engine.touch import Obstacle
from sandbox.engine.track import Track
from sandbox.errors import RunError
from sandbox.physics.cloth import Cloth
from sandbox.physics.integrators import State


def slowest_hop(cloth: Cloth, hop: float) -> float:
    """Minimum speed in m/s at which bodies that the cloth presses together separate, for an accuracy's ``hop`` (m).

    A steady push then becomes a series of equal hops instead of an endless series of smaller and smaller ones. The
    energy of the first hop of such a series, half the reduced mass times this speed squared (2e-7 J for pool balls at
    "balanced"), is removed from the motion of all balls.
    """
    return float((2.0 * cloth.sliding * cloth.gravity * hop) ** 0.5)


class OnCloth(Track):
    """A ball on cloth, where there is no lasting contact with a cushion."""

    def __init__(
        self,
        ball: Ball,
        state: State,
        obstacles: Sequence[Obstacle],
        catches: Sequence[Obstacle],
        cloth: Cloth,
        numerics: Numerics,
    ) -> None:
        super().__init__(ball, state, obstacles, catches)
        self._cloth = cloth
        self._numerics = numerics

    def advance(self, t: float, until: float) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``: a whole phase, of any length."""
        state = self.state
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

    def rests(self) -> bool:
        """Whether the ball is at rest on its current arc."""
        return self.arc.t1 > self.arc.t0 and len(self.arc.x) == len(self.arc.spin) == 1
