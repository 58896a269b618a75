"""Rockets: a motor's thrust by time, the mass that it burns, and the push along the way that the rocket points."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import inf
from typing import Any, ClassVar

from sandbox.physics.elementwise import clip, smooth, where
from sandbox.physics.forces import IN_WIND, Parts, Wind, in_wind


@dataclass(frozen=True)
class Motor:
    """A solid motor: its thrust F(t) on straight lines between measured points, none before the first and after the
    last.

    It burns its propellant in proportion to the impulse, ``dm/dt = -m_p F / J`` with the total impulse J: what leaves
    it has one speed ``c = J / m_p``. Without other forces the rocket gains ``c ln(m_start / m_end)`` (Tsiolkovsky
    1903). Source of curves and of that rule: static tests as the RASP format has them.
    """

    depends_on_time: ClassVar = True
    time_scale: ClassVar = inf  # it bends at its points, and is straight between them
    times: Sequence[Any]  # s, growing
    thrusts: Sequence[Any]  # N
    propellant: Any  # kg
    impulse: Any = field(init=False, repr=False)  # N s
    _pieces: Any = field(init=False, repr=False)  # start and end, thrust and slope, impulse so far

    def __post_init__(self) -> None:
        pieces, total = [], 0.0
        points = zip(self.times, self.thrusts, strict=True)
        for (start, before), (end, after) in pairwise(points):
            pieces.append((start, end, before, (after - before) / (end - start), total))
            total = total + 0.5 * (before + after) * (end - start)
        object.__setattr__(self, "_pieces", tuple(pieces))
        object.__setattr__(self, "impulse", total)

    @property
    def discontinuities(self) -> Sequence[Any]:
        """The times in s of its points."""
        return self.times

    def _piece(self, t: float) -> Any:
        """The piece of the curve at time t, or the one nearest to it."""
        return self._pieces[max(0, min(bisect_right(self.times, t), len(self._pieces)) - 1)]

    def _impulse(self, t: Any) -> Any:
        """Up to time t, in N s."""
        total, pieces = 0.0, self._pieces
        if isinstance(t, float):
            pieces = (self._piece(t),)
            total = pieces[0][-1]
        for start, end, before, slope, _ in pieces:
            burning = clip(t, start, end) - start
            total = total + burning * (before + 0.5 * slope * burning)
        return total

    def thrust(self, t: Any) -> Any:
        """In N at time t in s."""
        if isinstance(t, float):
            start, end, before, slope, _ = self._piece(t)
            return before + slope * (t - start) if start <= t < end else 0.0
        force = 0.0
        for start, end, before, slope, _ in self._pieces:
            force = where((start <= t) & (t < end), before + slope * (t - start), force)
        return force

    def lost(self, t: Any) -> Any:
        """Propellant burnt up to time t in s, in kg."""
        return self.propellant * self._impulse(t) / self.impulse

    def rate(self, t: Any) -> Any:
        """At which it burns at time t in s, in kg/s."""
        return self.propellant * self.thrust(t) / self.impulse


@dataclass(frozen=True)
class Thrust:
    """A motor's thrust on a rocket that points along its rail for the first ``rail`` m, and then into the flow:
    ``F = F(t) u / |u|`` with ``u = v - wind``.

    It turns from the one to the other while it goes as far again. In truth a rocket with fins swings about the
    direction of the flow, by how much depends on its length and fins, and loses some height.
    """

    timed: ClassVar = ("motor", "wind")
    motor: Motor
    start: tuple[Any, Any]  # m
    along: tuple[Any, Any]  # unit vector of the rail
    rail: Any  # m
    wind: Wind | None = None
    PARTS: ClassVar[Parts] = IN_WIND

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        (x, y), (ex, ey) = position, self.along
        ux, uy = velocity if self.wind is None else in_wind(self.wind, t, position, velocity)
        speed = (ux * ux + uy * uy) ** 0.5 + 1e-30
        turned = smooth(((x - self.start[0]) * ex + (y - self.start[1]) * ey) / self.rail - 1.0)
        ux, uy = ex + turned * (ux / speed - ex), ey + turned * (uy / speed - ey)
        force = self.motor.thrust(t) / ((ux * ux + uy * uy) ** 0.5 + 1e-30)
        return force * ux, force * uy
