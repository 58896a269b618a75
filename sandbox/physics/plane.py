"""Planes that bodies slide and roll on, seen from above: a law of motion as data, the same everywhere or by strips.

A law divides a motion into phases. In one phase the accelerations are constant (a sliding ball on cloth, a puck on
ice), which gives the path in closed form, or they depend on the motion (a curling stone, anything that a force acts
on), which is integrated.

A force F on a body of mass m adds p = F/m. What lies still stays until p exceeds what friction holds, and what rolls
loses its grip where friction cannot turn it as fast as p moves it.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise
from math import copysign, hypot, inf, sqrt
from typing import Any, NamedTuple, Protocol

#: A body on a plane: (x, y, vx, vy, wz) in m, m/s, rad/s, wz about the vertical, counter-clockwise from above; one that
#: rolls has (..., wx, wy), too.
PlaneState = tuple[float, ...]

#: Speed in m/s below which sliding, rolling or spinning is rounding. A body this slow would move 1e-24 m.
STILL = 1e-12

#: Speed in m/s below which a motion that ends under a changing law, within ``_SHORT`` s, ends on a straight line.
CREEPING = 1e-4

#: Time in s within which friction ends a creeping motion; otherwise it is not ending.
_SHORT = 1e-3

#: A push that falls short of what friction holds by less than this share moves what rests, and ends a grip.
_HOLDS = 1.0 - 1e-9

#: The accelerations by the forces on a body, (ax, ay, alpha_z) in m/s^2 and rad/s^2, by time in s and state.
Applied = Callable[[float, PlaneState], tuple[Any, Any, Any]]


def no_force(t: float, state: PlaneState) -> tuple[Any, Any, Any]:
    """The accelerations of a body on which no force acts."""
    return 0.0, 0.0, 0.0


#: Distance in m from the edge of a strip within which a body that moves towards the edge is beyond it.
_AT_EDGE = 1e-9


class PlaneMode(Enum):
    """The kinds of motion of a body on a plane, one for each phase."""

    SLIDING = "sliding"
    """It slips where it touches the plane."""

    ROLLING = "rolling"
    """It moves without slip."""

    SPINNING = "spinning"
    """It turns about the vertical in its place."""

    RESTING = "resting"
    """Nothing of it moves."""


class PlanePhase(NamedTuple):
    """A phase of motion from a state on, lasting ``duration`` s (infinite if nothing ends it).

    The accelerations are constant, or those at its start if there is ``acceleration_at``: then
    ``acceleration_at(t, state)`` gives (ax, ay, alpha_z), and for what rolls alpha_x and alpha_y, too.
    """

    mode: PlaneMode
    state: PlaneState
    duration: float  # s
    ax: float  # m/s^2
    ay: float
    alpha_z: float  # rad/s^2
    alpha_x: float = 0.0
    alpha_y: float = 0.0
    radius: float = 0.0  # m
    ends_motion: bool = False  # at its end, sliding becomes rolling if it rolls, or motion becomes rest
    ends_spin: bool = False  # at its end, the spin about the vertical is zero
    acceleration_at: Callable[[float, PlaneState], tuple[Any, ...]] | None = None
    moves_for: float = 0.0  # s, for which it moves so whether it spins or not, if that is longer
    slows_in: float = inf  # s, in which the velocity that ends it would end at its present rate
    margin: Callable[[float, PlaneState], float] | None = None  # m/s^2; the phase ends where it falls below 0

    @classmethod
    def slowed(
        cls,
        mode: PlaneMode,
        state: PlaneState,
        stop: tuple[float, float, float],
        spin_deceleration: float,
        alphas: tuple[float, float] = (0.0, 0.0),
        radius: float = 0.0,
    ) -> PlanePhase:
        """The phase of a body that stops so (``stopping``), while its spin about the vertical is slowed by
        ``spin_deceleration`` (rad/s^2): until one of them ends."""
        time, wz, alpha_z, spin_time = stop[0], state[4], 0.0, inf
        if abs(wz) > STILL:
            mode = PlaneMode.SPINNING if mode is PlaneMode.RESTING else mode
            alpha_z = -copysign(spin_deceleration, wz)
            spin_time = abs(wz) / spin_deceleration if spin_deceleration > 0.0 else inf
        duration = min(time, spin_time)
        ends = duration == time < inf, duration == spin_time < inf
        return cls(mode, state, duration, *stop[1:], alpha_z, *alphas, radius, *ends, moves_for=time)

    @classmethod
    def integrated(
        cls,
        mode: PlaneMode,
        t: float,
        state: PlaneState,
        acceleration_at: Callable[[float, PlaneState], tuple[Any, ...]],
        radius: float = 0.0,
        margin: Callable[[float, PlaneState], float] | None = None,
        smooth: bool = False,
    ) -> PlanePhase:
        """The phase whose accelerations depend on time and motion, from time ``t`` on; its last
        creeping is a straight line, unless nothing in it is against the motion: then it is ``smooth``."""
        ax, ay, alpha_z, *alphas = acceleration_at(t, state)
        alpha_x, alpha_y = alphas or (0.0, 0.0)
        phase = cls(mode, state, inf, ax, ay, alpha_z, alpha_x, alpha_y, radius)
        phase = phase._replace(acceleration_at=acceleration_at, margin=margin)
        if smooth or mode in (PlaneMode.SPINNING, PlaneMode.RESTING):
            return phase
        velocity, rates = (state[2], state[3]), (ax, ay)
        if mode is PlaneMode.SLIDING and alphas:
            velocity, rates = slip(state, radius), (ax - radius * alpha_y, ay + radius * alpha_x)
        time = _slows_in(velocity, rates)
        if hypot(*velocity) < CREEPING and time < _SHORT:
            return phase._replace(duration=time, ends_motion=True, acceleration_at=None, margin=None, moves_for=time)
        return phase._replace(slows_in=time)

    @staticmethod
    def stopping(vx: float, vy: float, deceleration: float, sooner: float = 1.0) -> tuple[float, float, float]:
        """The time in s in which a deceleration (m/s^2) ends a velocity, or so many times ``sooner``, and its
        components; for a body at rest, never."""
        speed = sqrt(vx * vx + vy * vy)
        if speed <= STILL:
            return inf, 0.0, 0.0
        time = speed / (sooner * deceleration) if deceleration > 0.0 else inf
        return time, -deceleration * vx / speed, -deceleration * vy / speed

    def after(self, t: float) -> PlaneState:
        """The state ``t`` s into the phase with its accelerations constant; t is limited to its duration.

        At the end itself (t = duration) the constraints hold to the last bit: no slip where a ball begins to roll, no
        speed where it stops, no wz where the spin ends. With ``acceleration_at`` nothing is reversed.
        """
        x, y, vx, vy, wz, *rolling = self.state
        t = min(t, self.duration)
        x += t * (vx + 0.5 * t * self.ax)
        y += t * (vy + 0.5 * t * self.ay)
        ux, uy, spin = vx + t * self.ax, vy + t * self.ay, wz + t * self.alpha_z
        wx, wy = rolling or (0.0, 0.0)
        roll = wx + t * self.alpha_x, wy + t * self.alpha_y
        ended, would_reverse = t == self.duration, self.acceleration_at is not None and ux * vx + uy * vy <= 0.0
        if (ended and self.ends_spin) or (self.acceleration_at is not None and spin * wz <= 0.0):
            spin = 0.0
        if ended and self.ends_motion and rolling and self.mode is PlaneMode.SLIDING:
            roll = -uy / self.radius, ux / self.radius
        elif (ended and self.ends_motion) or would_reverse:
            ux = uy = 0.0
            roll = 0.0, 0.0
        return (x, y, ux, uy, spin, *roll) if rolling else (x, y, ux, uy, spin)


class Plane(Protocol):
    """A law of motion on a plane, the same everywhere."""

    @property
    def name(self) -> str:
        """Its name in reports of energy and forces."""

    @property
    def rolls(self) -> bool:
        """True if bodies on it roll as spheres, and their state has spins about x and y."""

    @property
    def in_closed_form(self) -> bool:
        """True if every phase has constant accelerations."""

    @property
    def strongest(self) -> float:
        """The largest deceleration in m/s^2 of a sliding body."""

    @property
    def TERMS(self) -> Mapping[str, str]:  # noqa: N802  (a constant of each law)
        """The fields that can be left out, and what they are called."""

    def phase(self, state: PlaneState, radius: float) -> PlanePhase:
        """The phase that starts at ``state`` for a body of ``radius`` m on which no force acts."""

    def phase_under(self, applied: Applied, t: float, state: PlaneState, radius: float) -> PlanePhase:
        """The phase that starts at time ``t`` in ``state`` for a body of ``radius`` m, with what forces add."""


def slip(state: PlaneState, radius: float) -> tuple[float, float]:
    """The velocity in m/s of the lowest point of a ball over the plane."""
    _, _, vx, vy, _, wx, wy = state
    return vx - radius * wy, vy + radius * wx


def holds(push: tuple[float, float], friction: float) -> bool:
    """Return True if friction of at most this strength balances a push (m/s^2)."""
    strength = hypot(*push)
    return strength == 0.0 or strength < _HOLDS * friction


def hold_margin(push: tuple[float, float], friction: float) -> float:
    """By how much (m/s^2) friction can hold more than a push."""
    return _HOLDS * friction - hypot(*push)


def against(velocity: tuple[float, float], push: tuple[float, float], friction: float) -> tuple[float, float]:
    """The acceleration of friction (m/s^2) against a velocity (m/s), or, where there is none, against a push."""
    speed = hypot(*velocity)
    if speed > STILL:
        return -friction * velocity[0] / speed, -friction * velocity[1] / speed
    strength = hypot(*push)
    share = min(1.0, friction / strength) if strength > 0.0 else 0.0
    return -share * push[0], -share * push[1]


def spun(side: float, torque: float, spin_deceleration: float) -> float:
    """The angular acceleration about the vertical (rad/s^2) of what spins to one ``side`` (its sign, 0 if it does not)
    under a torque over its moment of inertia and friction."""
    if side == 0.0:
        return torque - copysign(min(abs(torque), spin_deceleration), torque)
    return torque - side * spin_deceleration


def side_of(wz: float) -> float:
    """The sign of a spin about the vertical; 0 for one that is rounding."""
    return copysign(1.0, wz) if abs(wz) > STILL else 0.0


def _slows_in(velocity: tuple[float, float], rates: tuple[float, float]) -> float:
    """The time in s in which a velocity (m/s) that changes by these rates (m/s^2) would end; infinite if it grows."""
    along = velocity[0] * rates[0] + velocity[1] * rates[1]
    speed = hypot(*velocity)
    return speed * speed / -along if along < 0.0 and speed > STILL else inf


def without(plane: Any, term: str) -> Any:
    """The plane with one of its terms, such as "rolling", left out."""
    if isinstance(plane, Strips):
        return replace(plane, laws=[without(law, term) for law in plane.laws])
    return replace(plane, **{term: 0.0}) if term in plane.TERMS else plane


@dataclass(frozen=True)
class Strips:
    """A plane in strips across x: oil along a lane, ice that is swept. Law i ends at ``edges[i]`` (m)."""

    edges: Sequence[float]
    laws: Sequence[Plane]

    def __post_init__(self) -> None:
        in_order = all(edge < following for edge, following in pairwise(self.edges))
        if len(self.laws) != len(self.edges) + 1 or not in_order:
            needed = f"{len(self.laws)} laws need {len(self.laws) - 1} edges in growing order"
            raise ValueError(f"strips: {needed}, and these are {self.edges}")
        if len({law.rolls for law in self.laws}) > 1:
            raise ValueError("strips: bodies must roll on all of them, as on Cloth, or slide on all, as on Glide")

    @property
    def name(self) -> str:
        return self.laws[0].name

    @property
    def rolls(self) -> bool:
        return self.laws[0].rolls

    @property
    def in_closed_form(self) -> bool:
        return all(law.in_closed_form for law in self.laws)

    @property
    def TERMS(self) -> Mapping[str, str]:  # noqa: N802
        return self.laws[0].TERMS

    @property
    def strongest(self) -> float:
        return max(law.strongest for law in self.laws)

    def phase(self, state: PlaneState, radius: float) -> PlanePhase:
        return strip(self, state)[0].phase(state, radius)

    def phase_under(self, applied: Applied, t: float, state: PlaneState, radius: float) -> PlanePhase:
        return strip(self, state)[0].phase_under(applied, t, state, radius)


def strip(plane: Plane, state: PlaneState) -> tuple[Plane, float, float]:
    """The law where a body is, and between which x in m it holds; at an edge the one that it moves towards."""
    if not isinstance(plane, Strips):
        return plane, -inf, inf
    place = bisect_right(plane.edges, state[0] + copysign(_AT_EDGE, state[2]))
    ends = -inf, *plane.edges, inf
    return plane.laws[place], ends[place], ends[place + 1]
