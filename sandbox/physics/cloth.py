"""A ball on cloth: sliding, rolling, spinning in place and rest, each in closed form.

Seen from above, with angular velocity (wx, wy, wz), wz about the vertical. The ball's lowest point slides over the
cloth with velocity

    u = (vx - r wy, vy + r wx),

and friction of the cloth opposes it. While the ball **slides**, ``m a = -mu_s m g u/|u|``, so that

    dv/dt = -mu_s g u/|u|,  d(wx, wy)/dt = (5 mu_s g / 2 r) (-u_y, u_x)/|u|,  du/dt = -(7/2) mu_s g u/|u|.

The direction of u is constant, hence so are all accelerations: the path is a parabola, and after ``2 |u| / (7 mu_s g)``
the ball **rolls**: u stays 0, and the ball decelerates by ``mu_r g`` on a straight path. Spin about the vertical decays
independently, ``dwz/dt = -+ 5 mu_sp g / 2 r``, in every phase, at last with the ball spinning **in place**.

A **force** F adds p = F/m to dv/dt of a ball that slides, and p / (1 + k) to that of one that rolls, which it does as
long as p is below ``(1 + 1/k) mu_s g``; a ball at rest stays while p / (1 + k) is below ``mu_r g``. So a steady push
along its path gives a rolling ball a constant acceleration.

With another moment of inertia ``k m r^2`` than the 2/5 of a solid sphere, 5/2 becomes 1/k and 7/2 becomes 1 + 1/k.

Valid for a sphere that never leaves level, dry cloth, with friction that does not depend on speed. Left out: the
nap, the ball's sinking into the cloth, and the effect of spin about the vertical on the path of a rolling ball.
Sources: Marlow 1995, The Physics of Pocket Billiards; Leckie & Greenspan 2006, An Event-Based Pool Physics Simulator,
Lecture Notes in Computer Science 4250, 247; Alciatore, technical proof TP A.4 to The Illustrated Principles of Pool and
Billiards.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot, inf
from typing import Any, ClassVar

from sandbox.physics.checks import check
from sandbox.physics.plane import (
    STILL,
    Applied,
    PlaneMode,
    PlanePhase,
    PlaneState,
    against,
    hold_margin,
    holds,
    side_of,
    slip,
    spun,
)


@dataclass(frozen=True)
class Cloth:
    """The cloth's friction, and gravity in m/s^2.

    ``sliding`` mu_s and ``rolling`` mu_r are deceleration divided by gravity. ``spinning`` mu_sp is the torque about
    the vertical divided by m g r; 0.0127 slows a pool ball by 10.9 rad/s^2, and 5 to 15 is typical of tables
    (Alciatore).

    >>> import sandbox
    >>> from sandbox import Ball, Cloth, Setup
    >>> cue = Ball("cue", mass=0.17, radius=0.0286, position=(0, 0), velocity=(1, 0))
    >>> run = sandbox.simulate(Setup([cue], plane=Cloth(sliding=0.2, rolling=0.01)))
    >>> run.ended
    'rest'
    """

    sliding: float = 0.2
    rolling: float = 0.01
    spinning: float = 0.0127
    gravity: float = 9.81  # m/s^2
    inertia: float = 0.4  # moment of inertia over m r^2 of what rolls on it
    name: str = "cloth"  # what it is called in reports: cloth, lane

    rolls: ClassVar[bool] = True
    in_closed_form: ClassVar[bool] = True
    TERMS: ClassVar[Mapping[str, str]] = {
        "sliding": "sliding friction",
        "rolling": "rolling friction",
        "spinning": "spinning friction",
    }

    @property
    def strongest(self) -> float:
        """The deceleration in m/s^2 of a sliding ball."""
        return self.sliding * self.gravity

    def __post_init__(self) -> None:
        check(self.name, self, not_negative=["sliding", "rolling", "spinning", "gravity"])
        if not 0.0 < self.inertia <= 1.0:
            raise ValueError(f"{self.name}: inertia = {self.inertia} must be above 0, and at most 1")

    def phase(self, state: PlaneState, radius: float) -> PlanePhase:
        """The phase that starts at ``state`` for a ball of ``radius`` m, until its mode changes or its spin ends.

        Slides for ``2 |u| / (7 mu_s g)``, rolls for ``|v| / (mu_r g)``, spins for ``2 r |wz| / (5 mu_sp g)``.
        """
        turn = 1.0 / self.inertia
        _, _, vx, vy, _, _, _ = state
        ux, uy = slip(state, radius)
        mode, stop, alphas = PlaneMode.RESTING, (inf, 0.0, 0.0), (0.0, 0.0)
        if ux * ux + uy * uy > STILL * STILL:
            mode, stop = PlaneMode.SLIDING, PlanePhase.stopping(ux, uy, self.strongest, 1.0 + turn)  # as it also turns
            # torque of the force at the lowest point, over the moment of inertia
            alphas = turn * stop[2] / radius, -turn * stop[1] / radius
        elif vx * vx + vy * vy > STILL * STILL:
            mode, stop = PlaneMode.ROLLING, PlanePhase.stopping(vx, vy, self.rolling * self.gravity)
            alphas = -stop[2] / radius, stop[1] / radius
        return PlanePhase.slowed(mode, state, stop, turn * self.spinning * self.gravity / radius, alphas, radius)

    def phase_under(self, applied: Applied, t: float, state: PlaneState, radius: float) -> PlanePhase:
        """The phase that starts at time ``t`` in ``state`` for a ball of ``radius`` m, with what forces add."""
        turn, share = 1.0 / self.inertia, 1.0 / (1.0 + self.inertia)
        slowing, spin_slowing = self.rolling * self.gravity, turn * self.spinning * self.gravity / radius
        gripping = (1.0 + turn) * self.strongest
        px, py, torque = applied(t, state)
        side = side_of(state[4])

        def slides(t: float, state: PlaneState) -> tuple[Any, ...]:
            px, py, torque = applied(t, state)
            fx, fy = against(slip(state, radius), (px / (1.0 + turn), py / (1.0 + turn)), self.strongest)
            spin = spun(side, torque, spin_slowing)
            return px + fx, py + fy, spin, turn * fy / radius, -turn * fx / radius

        def rolls(t: float, state: PlaneState) -> tuple[Any, ...]:
            px, py, torque = applied(t, state)
            push = share * px, share * py
            fx, fy = against((state[2], state[3]), push, slowing)
            ax, ay = push[0] + fx, push[1] + fy
            return ax, ay, spun(side, torque, spin_slowing), -ay / radius, ax / radius

        def grips(t: float, state: PlaneState) -> float:
            return hold_margin(applied(t, state)[:2], gripping)

        def rests(t: float, state: PlaneState) -> float:
            px, py, torque = applied(t, state)
            margin = hold_margin((share * px, share * py), slowing)
            return min(margin, radius * hold_margin((torque, 0.0), spin_slowing)) if still else margin

        if hypot(*slip(state, radius)) > STILL or not holds((px, py), gripping):
            return PlanePhase.integrated(PlaneMode.SLIDING, t, state, slides, radius, smooth=self.strongest == 0.0)
        if hypot(*state[2:4]) > STILL or not holds((share * px, share * py), slowing):
            return PlanePhase.integrated(PlaneMode.ROLLING, t, state, rolls, radius, grips, smooth=slowing == 0.0)
        still = side == 0.0 and holds((torque, 0.0), spin_slowing)
        mode = PlaneMode.RESTING if still else PlaneMode.SPINNING
        return PlanePhase.integrated(mode, t, state, rolls, radius, rests)
