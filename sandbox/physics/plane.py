"""Planes that bodies slide and roll on, seen from above: a law of motion as data, the same everywhere or by strips.

A law divides a motion into phases. In one phase the accelerations are constant (a sliding ball on cloth, a puck on
ice), which gives the path in closed form, or they depend on the motion (a curling stone), which is integrated.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise
from math import copysign, inf, sqrt
from typing import Any, NamedTuple, Protocol

#: A body on a plane: (x, y, vx, vy, wz) in m, m/s, rad/s, wz about the vertical, counter-clockwise from above; one that
#: rolls has (..., wx, wy), too.
PlaneState = tuple[float, ...]

#: Speed in m/s below which sliding, rolling or spinning is rounding. A body this slow would move 1e-24 m.
STILL = 1e-12

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
    ``acceleration_at(t, state)`` gives (ax, ay, alpha_z).
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
    acceleration_at: Callable[[float, PlaneState], tuple[Any, Any, Any]] | None = None
    moves_for: float = 0.0  # s, for which it moves so whether it spins or not, if that is longer

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
        """The phase that starts at ``state`` for a body of ``radius`` m."""


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


def strip(plane: Plane, state: PlaneState) -> tuple[Plane, float, float]:
    """The law where a body is, and between which x in m it holds; at an edge the one that it moves towards."""
    if not isinstance(plane, Strips):
        return plane, -inf, inf
    place = bisect_right(plane.edges, state[0] + copysign(_AT_EDGE, state[2]))
    ends = -inf, *plane.edges, inf
    return plane.laws[place], ends[place], ends[place + 1]
