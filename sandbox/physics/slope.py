"""A ball on a slope of cloth, seen from above: a ramp or a green as a field of force.

Gravity pulls with an acceleration p along the plane, downhill; on a twisted slope, whose height has a term in x y, p is
linear in the place. While the ball **slides**, with the velocity u of its
lowest point over the cloth,

    dv/dt = p - mu_s g u/|u|,  du/dt = p - (1 + 1/k) mu_s g u/|u|,

where k m r^2 is its moment of inertia; while it **rolls**,

    dv/dt = p / (1 + k) - mu_r g v/|v|.

It is integrated with error control. On an even slope the path of a ball that rolls has a closed form: with psi its
angle from straight downhill, ``v sin(psi) / tan(psi / 2)^n`` is constant, n = mu_r g (1 + k) / p.

Valid where the ball can roll: p below (1 + 1/k) mu_s g. Left out: that a slope is seen shorter from above (2 % at 1 in
5) and presses less on the ball (the same), and the edge where it begins: no ball jumps.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot
from typing import Any, ClassVar

from sandbox.physics.checks import check
from sandbox.physics.cloth import Cloth
from sandbox.physics.plane import Applied, Plane, PlanePhase, PlaneState, no_force


@dataclass(frozen=True)
class Slope(Cloth):
    """Cloth on a slope, on which gravity pulls by ``pull_x`` and ``pull_y`` (m/s^2): g times the height lost per metre.

    That is at the origin; at (x, y) it pulls by ``twist`` (1/s^2) times (y, x) more.

    >>> import sandbox
    >>> from sandbox import Ball, Setup, Slope
    >>> ball = Ball("ball", mass=0.046, radius=0.021, position=(0, 0), velocity=(1, 0), rolling_spin=(0, 1 / 0.021))
    >>> run = sandbox.simulate(Setup([ball], plane=Slope(rolling=0.0, pull_x=-0.7), duration=4.0))
    >>> round(run.state("ball", 2.0).x, 9), round(run.state("ball", 4.0).x, 9)  # m: up 1 m, and back
    (1.0, 0.0)
    """

    pull_x: float = 0.0  # m/s^2
    pull_y: float = 0.0
    twist: float = 0.0  # 1/s^2

    in_closed_form: ClassVar[bool] = False
    TERMS: ClassVar[Mapping[str, str]] = {
        **Cloth.TERMS,
        "pull_x": "slope along x",
        "pull_y": "slope across x",
        "twist": "twist of the slope",
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        check(self.name, self, finite=["pull_x", "pull_y", "twist"])
        steepest = (1.0 + 1.0 / self.inertia) * self.strongest
        if self.strongest > 0.0 and not hypot(self.pull_x, self.pull_y) < steepest:  # without friction all slide
            pull = hypot(self.pull_x, self.pull_y)
            raise ValueError(
                f"{self.name}: a slope that pulls by {pull:.3g} m/s^2 must pull by less than {steepest:.3g} m/s^2: "
                "no ball would roll"
            )

    def pull(self, x: float, y: float) -> tuple[float, float]:
        """The pull of gravity at a place in m, in m/s^2."""
        return self.pull_x + self.twist * y, self.pull_y + self.twist * x

    def phase(self, state: PlaneState, radius: float) -> PlanePhase:
        """The phase that starts at ``state`` for a ball of ``radius`` m: it slides, rolls, or rests."""
        return self.phase_under(no_force, 0.0, state, radius)

    def phase_under(self, applied: Applied, t: float, state: PlaneState, radius: float) -> PlanePhase:
        """The phase that starts at time ``t`` in ``state`` for a ball of ``radius`` m, with what forces add."""

        def pulled(t: float, state: PlaneState) -> tuple[Any, Any, Any]:
            ax, ay, torque = applied(t, state)
            px, py = self.pull(state[0], state[1])
            return ax + px, ay + py, torque

        return super().phase_under(pulled, t, state, radius)


def pull_of(plane: Plane, x: float, y: float) -> tuple[float, float]:
    """The pull of gravity (m/s^2) along a plane at a place in m: none on one that is level."""
    return plane.pull(x, y) if isinstance(plane, Slope) else (0.0, 0.0)
