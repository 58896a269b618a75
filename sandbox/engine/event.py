"""What happens to a ball at one instant."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened to a ball at one instant.

    ``kind`` is ``"impact"`` (``speed`` is the normal approach speed in m/s), ``"contact"`` (from here on it slides or
    rolls on the surface), ``"leave"`` (it lost the surface), ``"rest"``, or a kind of the scene's own.
    """

    t: float  # s
    kind: str
    ball: str
    partner: str  # name of the surface or of the other ball; "" where there is none
    speed: float  # m/s
    x: float  # m, the ball's centre
    y: float  # m
