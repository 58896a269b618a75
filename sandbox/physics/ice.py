"""Bodies that slide on ice, seen from above: pucks, whose deceleration is constant, and curling stones.

A **puck** (``Glide``) slides on a straight path with ``dv/dt = -mu g - k v^2``, and its spin decays independently, by
``dw/dt = -+ 2 mu_sp g / r`` for a disc: in closed form where the air is left out, k = 0. With mu = 0 it is a puck on an
air table. Left out: that a spinning disc is slowed less along its path, and a sliding one less in its spin (Voyenli &
Eriksen 1985, American Journal of Physics 53, 1149).

A **curling stone** (``CurlingIce``) is slowed the more the slower it is, and turns towards its spin:

    dv/dt = -g (a / (v + b) + c),  d(theta)/dt = +- k v^-0.8,  dw/dt = -+ s / v,

with theta the direction of its path, whatever the size of its spin. Its last 0.1 mm/s are a straight line at constant
deceleration, 0.02 micrometres long. Source: the simulator FCV1 of the Digital Curling competition, after Kano et al.,
from stones filmed on the ice of a rink; valid up to about 3 m/s. Left out: that the curl depends on the spin (a stone
that does not turn goes straight, and one that turns ten times as fast curls as much), on the wear of the pebble and on
where the sheet has been swept before.

A **force** F adds p = F/m to dv/dt of either; a body at rest stays while p is below what slows it as it starts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import hypot
from typing import Any, ClassVar

from sandbox.physics.checks import check
from sandbox.physics.plane import (
    CREEPING,
    STILL,
    Applied,
    PlaneMode,
    PlanePhase,
    PlaneState,
    against,
    hold_margin,
    holds,
    no_force,
    side_of,
    spun,
)

#: Speed in m/s at which the spin of a stone that creeps or stands decays.
_SPINNING_IN_PLACE = 1e-3

#: Power of the speed in the rate at which a stone's path turns.
_TURNING = -0.8


def _pushed(
    applied: Applied,
    slowed_at: Callable[[PlaneState], tuple[float, float]],
    turned_at: Callable[[PlaneState], tuple[float, float]],
    t: float,
    state: PlaneState,
    radius: float,
) -> PlanePhase:
    """The phase of a body of ``radius`` m that forces push: friction is ``slowed_at`` a state by (m/s^2, rad/s^2), and
    what else the ice does there is an acceleration (m/s^2)."""
    side = side_of(state[4])

    def acceleration_at(t: float, state: PlaneState) -> tuple[Any, ...]:
        px, py, torque = applied(t, state)
        friction, spin_friction = slowed_at(state)
        fx, fy = against((state[2], state[3]), (px, py), friction)
        gx, gy = turned_at(state)
        return px + fx + gx, py + fy + gy, spun(side, torque, spin_friction)

    def rests(t: float, state: PlaneState) -> float:
        px, py, torque = applied(t, state)
        friction, spin_friction = slowed_at(state)
        margin = hold_margin((px, py), friction)
        return min(margin, radius * hold_margin((torque, 0.0), spin_friction)) if still else margin

    px, py, torque = applied(t, state)
    friction, spin_friction = slowed_at(state)
    if hypot(*state[2:4]) > STILL or not holds((px, py), friction):
        return PlanePhase.integrated(PlaneMode.SLIDING, t, state, acceleration_at, smooth=friction == 0.0)
    still = side == 0.0 and holds((torque, 0.0), spin_friction)
    mode = PlaneMode.RESTING if still else PlaneMode.SPINNING
    return PlanePhase.integrated(mode, t, state, acceleration_at, margin=rests)


@dataclass(frozen=True)
class Glide:
    """Constant friction and drag: mu is the deceleration over gravity, mu_sp the torque on the spin over m g r, and
    ``drag`` is k = rho Cd A / 2 m.

    >>> import sandbox
    >>> from sandbox import DISC, Ball, Glide, Setup
    >>> puck = Ball("puck", mass=0.17, radius=0.038, position=(0, 0), velocity=(2, 0), inertia_factor=DISC)
    >>> run = sandbox.simulate(Setup([puck], plane=Glide(sliding=0.1)))
    >>> round(run.state("puck", run.duration).x, 6)  # m, v^2 / (2 mu g)
    2.038736
    """

    sliding: float
    spinning: float = 0.0
    gravity: float = 9.81  # m/s^2
    name: str = "ice"  # what it is called in reports: ice, deck, table
    drag: float = 0.0  # 1/m

    rolls: ClassVar[bool] = False
    TERMS: ClassVar[Mapping[str, str]] = {
        "sliding": "sliding friction",
        "spinning": "spinning friction",
        "drag": "drag",
    }

    def __post_init__(self) -> None:
        check(self.name, self, not_negative=["sliding", "spinning", "gravity", "drag"])

    @property
    def in_closed_form(self) -> bool:
        return self.drag == 0.0

    @property
    def strongest(self) -> float:
        """The deceleration in m/s^2 without air."""
        return self.sliding * self.gravity

    def _spin_deceleration(self, radius: float) -> float:
        return 2.0 * self.spinning * self.gravity / radius

    def phase(self, state: PlaneState, radius: float) -> PlanePhase:
        """Slides until it stops or its spin ends."""
        if self.drag != 0.0:
            return self.phase_under(no_force, 0.0, state, radius)
        _, _, vx, vy, _ = state
        mode = PlaneMode.SLIDING if vx * vx + vy * vy > STILL * STILL else PlaneMode.RESTING
        return PlanePhase.slowed(
            mode, state, PlanePhase.stopping(vx, vy, self.strongest), self._spin_deceleration(radius)
        )

    def phase_under(self, applied: Applied, t: float, state: PlaneState, radius: float) -> PlanePhase:
        """Slides and spins under forces until it rests."""
        decelerations = self.strongest, self._spin_deceleration(radius)

        def dragged_at(state: PlaneState) -> tuple[float, float]:
            _, _, vx, vy, _ = state
            slowing = self.drag * hypot(vx, vy)
            return -slowing * vx, -slowing * vy

        return _pushed(applied, lambda state: decelerations, dragged_at, t, state, radius)


@dataclass(frozen=True)
class CurlingIce:
    """Pebbled ice: ``friction`` and ``curl`` multiply the deceleration and the turning, as sweeping does.

    The rest are the constants a (m/s), b (m/s), c, k (m^0.8 s^-1.8) and s (m/s^3) of the law.

    >>> import sandbox
    >>> from dataclasses import replace
    >>> from sandbox import DISC, Ball, CurlingIce, Setup
    >>> still = Ball("stone", mass=19.0, radius=0.145, position=(0, 0), inertia_factor=DISC)
    >>> stone = replace(still, velocity=(2.2, 0.0), spin=1.5)
    >>> run = sandbox.simulate(Setup([stone], plane=CurlingIce()))
    >>> run.state("stone", run.duration).y > 0.5  # m
    True
    """

    friction: float = 1.0
    curl: float = 1.0
    a: float = 0.00200985
    b: float = 0.06385782
    c: float = 0.00626286
    k: float = 0.00820
    s: float = 0.025
    gravity: float = 9.80665  # m/s^2
    name: str = "ice"

    rolls: ClassVar[bool] = False
    in_closed_form: ClassVar[bool] = False
    TERMS: ClassVar[Mapping[str, str]] = {"friction": "friction", "curl": "curl"}

    def __post_init__(self) -> None:
        check(self.name, self, not_negative=["friction", "curl", "a", "b", "c", "k", "s", "gravity"])

    @property
    def strongest(self) -> float:
        """The deceleration in m/s^2 of a stone about to stop."""
        return self.deceleration(0.0)

    def deceleration(self, speed: float) -> float:
        """In m/s^2, at a speed in m/s."""
        return self.friction * self.gravity * (self.a / (speed + self.b) + self.c)

    def phase(self, state: PlaneState, radius: float) -> PlanePhase:
        """Slides and turns towards the spin until one of them ends; spins in place."""
        return self.phase_under(no_force, 0.0, state, radius)

    def phase_under(self, applied: Applied, t: float, state: PlaneState, radius: float) -> PlanePhase:
        """Slides, turns and spins under forces until it rests."""
        side, creeps = side_of(state[4]), hypot(*state[2:4]) <= CREEPING

        def slowed_at(state: PlaneState) -> tuple[float, float]:
            speed = hypot(*state[2:4])
            return self.deceleration(speed), self.s / (_SPINNING_IN_PLACE if creeps else max(speed, STILL))

        def turned_at(state: PlaneState) -> tuple[float, float]:
            _, _, vx, vy, _ = state
            turning = side * self.curl * self.k * max(hypot(vx, vy), STILL) ** _TURNING
            return -turning * vy, turning * vx

        return _pushed(applied, slowed_at, turned_at, t, state, radius)
