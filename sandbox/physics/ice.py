"""What slides on ice, seen from above: pucks, whose deceleration is constant, and curling stones.

A **puck** (``Glide``) slides on a straight path with ``dv/dt = -mu g``, and its spin decays independently, by
``dw/dt = -+ 2 mu_sp g / r`` for a disc: in closed form. With mu = 0 it is a puck on an air table. Left out: that a
spinning disc is slowed less along its path, and a sliding one less in its spin (Voyenli & Eriksen 1985, American
Journal of Physics 53, 1149).

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

from sandbox.physics.plane import STILL, Phase, PlaneState

#: Speed in m/s below which a stone comes to rest on a straight line, and below which its spin decays as at this speed.
_CREEPING, _SPINNING_IN_PLACE = 1e-4, 1e-3

#: Power of the speed in the rate at which a stone's path turns.
_TURNING = -0.8


def _not_negative(law: Any, *names: str) -> None:
    for name in names:
        if not 0.0 <= getattr(law, name) < inf:
            raise ValueError(f"{law.name}: {name} = {getattr(law, name)} must not be negative")


def _after(state: PlaneState, phase: Phase, t: float) -> PlaneState:
    """The state ``t`` s into a phase with constant accelerations, at most at its end."""
    x, y, vx, vy, wz = state
    t = min(t, phase.duration)
    x += t * (vx + 0.5 * t * phase.ax)
    y += t * (vy + 0.5 * t * phase.ay)
    ended = t == phase.duration
    wz = 0.0 if ended and phase.ends_spin else wz + t * phase.alpha_z
    if ended and phase.ends_motion:
        return x, y, 0.0, 0.0, wz
    return x, y, vx + t * phase.ax, vy + t * phase.ay, wz


def _straight(state: PlaneState, deceleration: float, spin_deceleration: float) -> Phase:
    """The phase of a body with these constant decelerations (m/s^2, rad/s^2), until its motion or its spin ends."""
    _, _, vx, vy, wz = state
    speed = sqrt(vx * vx + vy * vy)
    mode, time, ax, ay = "resting", inf, 0.0, 0.0
    if speed > STILL:
        mode, time = "sliding", speed / deceleration if deceleration > 0.0 else inf
        ax, ay = -deceleration * vx / speed, -deceleration * vy / speed
    alpha, spin_time = 0.0, inf
    if abs(wz) > STILL:
        mode = "spinning" if mode == "resting" else mode
        alpha = -copysign(spin_deceleration, wz)
        spin_time = abs(wz) / spin_deceleration if spin_deceleration > 0.0 else inf
    duration = min(time, spin_time)
    ends = duration == time < inf, duration == spin_time < inf
    return Phase(mode, duration, ax, ay, alpha, ends_motion=ends[0], ends_spin=ends[1])


@dataclass(frozen=True)
class Glide:
    """Constant friction: mu is the deceleration over gravity, mu_sp the torque on the spin over m g r."""

    sliding: float
    spinning: float = 0.0
    gravity: float = 9.81  # m/s^2
    name: str = "ice"  # what it is called in reports: ice, deck, table

    rolls: ClassVar[bool] = False
    in_closed_form: ClassVar[bool] = True
    TERMS: ClassVar[Mapping[str, str]] = {"sliding": "sliding friction", "spinning": "spinning friction"}

    def __post_init__(self) -> None:
        _not_negative(self, "sliding", "spinning", "gravity")

    @property
    def strongest(self) -> float:
        """The deceleration in m/s^2."""
        return self.sliding * self.gravity

    def phase(self, state: PlaneState, radius: float) -> Phase:
        """Slides until it stops or its spin ends."""
        return _straight(state, self.strongest, 2.0 * self.spinning * self.gravity / radius)

    def after(self, state: PlaneState, phase: Phase, t: float) -> PlaneState:
        """The state ``t`` s into ``phase``."""
        return _after(state, phase, t)


@dataclass(frozen=True)
class CurlingIce:
    """Pebbled ice: ``friction`` and ``curl`` multiply the deceleration and the turning, as sweeping does.

    The rest are the constants a (m/s), b (m/s), c, k (m^0.8 s^-1.8) and s (m/s^3) of the law.
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
        _not_negative(self, "friction", "curl", "a", "b", "c", "k", "s", "gravity")

    @property
    def strongest(self) -> float:
        """The deceleration in m/s^2 of a stone about to stop."""
        return self.deceleration(0.0)

    def deceleration(self, speed: float) -> float:
        """In m/s^2, at a speed in m/s."""
        return self.friction * self.gravity * (self.a / (speed + self.b) + self.c)

    def phase(self, state: PlaneState, radius: float) -> Phase:
        """Slides and turns towards the spin until one of them ends; spins in place."""
        _, _, vx, vy, wz = state
        speed = sqrt(vx * vx + vy * vy)
        if speed <= _CREEPING:
            slowing = self.deceleration(speed)
            return _straight(state, slowing, self.s / _SPINNING_IN_PLACE)
        side = copysign(1.0, wz) if abs(wz) > STILL else 0.0

        def law(t: float, state: PlaneState) -> tuple[Any, Any, Any]:
            _, _, vx, vy, _ = state
            speed = sqrt(vx * vx + vy * vy)
            slowing = self.deceleration(speed) / speed
            turning = side * self.curl * self.k * speed**_TURNING
            return -slowing * vx - turning * vy, -slowing * vy + turning * vx, -side * self.s / speed

        return Phase("sliding", inf, *law(0.0, state), law=law)

    def after(self, state: PlaneState, phase: Phase, t: float) -> PlaneState:
        """The state ``t`` s into ``phase``, along its first accelerations; at rest or without spin where they would
        reverse it."""
        after = _after(state, phase, t)
        if phase.law is None:
            return after
        x, y, vx, vy, wz = after
        if vx * state[2] + vy * state[3] <= 0.0:
            vx = vy = 0.0
        return x, y, vx, vy, wz if wz * state[4] > 0.0 else 0.0
