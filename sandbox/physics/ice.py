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
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import copysign, inf, sqrt
from typing import Any, ClassVar

from sandbox.physics.checks import check
from sandbox.physics.plane import STILL, PlaneMode, PlanePhase, PlaneState

#: Speed in m/s below which a stone comes to rest on a straight line, and below which its spin decays as at this speed.
_CREEPING, _SPINNING_IN_PLACE = 1e-4, 1e-3

#: Power of the speed in the rate at which a stone's path turns.
_TURNING = -0.8


def _straight(state: PlaneState, deceleration: float, spin_deceleration: float) -> PlanePhase:
    """The phase of a body with these constant decelerations (m/s^2, rad/s^2), until its motion or its spin ends."""
    _, _, vx, vy, _ = state
    mode = PlaneMode.SLIDING if vx * vx + vy * vy > STILL * STILL else PlaneMode.RESTING
    return PlanePhase.slowed(mode, state, PlanePhase.stopping(vx, vy, deceleration), spin_deceleration)


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

    def phase(self, state: PlaneState, radius: float) -> PlanePhase:
        """Slides until it stops or its spin ends."""
        _, _, vx, vy, wz = state
        spin_deceleration = 2.0 * self.spinning * self.gravity / radius
        if self.drag == 0.0 or vx * vx + vy * vy <= _CREEPING * _CREEPING:
            return _straight(state, self.strongest, spin_deceleration)
        turning = -copysign(spin_deceleration, wz) if abs(wz) > STILL else 0.0

        def acceleration_at(t: float, state: PlaneState) -> tuple[Any, Any, Any]:
            _, _, vx, vy, _ = state
            speed = sqrt(vx * vx + vy * vy)
            slowing = self.strongest / speed + self.drag * speed
            return -slowing * vx, -slowing * vy, turning

        return PlanePhase(PlaneMode.SLIDING, state, inf, *acceleration_at(0.0, state), acceleration_at=acceleration_at)


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
        _, _, vx, vy, wz = state
        speed = sqrt(vx * vx + vy * vy)
        if speed <= _CREEPING:
            slowing = self.deceleration(speed)
            return _straight(state, slowing, self.s / _SPINNING_IN_PLACE)
        side = copysign(1.0, wz) if abs(wz) > STILL else 0.0

        def acceleration_at(t: float, state: PlaneState) -> tuple[Any, Any, Any]:
            _, _, vx, vy, _ = state
            speed = sqrt(vx * vx + vy * vy)
            slowing = self.deceleration(speed) / speed
            turning = side * self.curl * self.k * speed**_TURNING
            return -slowing * vx - turning * vy, -slowing * vy + turning * vx, -side * self.s / speed

        return PlanePhase(PlaneMode.SLIDING, state, inf, *acceleration_at(0.0, state), acceleration_at=acceleration_at)
