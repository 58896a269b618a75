"""The net below a ring, which slows a ball that falls through it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from sandbox.physics.elementwise import anywhere, minimum, smooth

#: Sideways over downwards.
_HOLD = 4.0

#: The distance in m over which the force begins and ends.
EDGE = 0.05


@dataclass(frozen=True)
class NetDrag:
    """The net around a ball that passes through: ``F = -m k (4 vx, vy)`` inside a box below the ring, k in 1/s.

    It resists sideways motion more than falling. The force begins and ends over a short distance, so that it has no
    jumps. All of it is assumed: no measurement of a net was found.
    """

    EDGE: ClassVar = EDGE

    mass: float  # kg
    damping: float  # 1/s
    middle: tuple[float, float]  # m, of the ring
    half_width: float  # m
    length: float  # m

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        (x, y), (across, top) = position, self.middle
        hold = net_hold(x, y, across, top, self.half_width, self.length)
        return net_force(self.mass * self.damping * hold, *velocity)


def net_hold(x: Any, y: Any, across: Any, top: Any, half_width: Any, length: Any) -> Any:
    """The share of its force with which a net holds a ball at (x, y): 1 inside, 0 outside."""
    below = minimum(top - y, length - (top - y))
    if not anywhere(below > 0.0):
        return 0.0
    beside = half_width - abs(x - across)
    if not anywhere((below > 0.0) & (beside > -EDGE)):
        return 0.0
    return smooth(below / EDGE) * smooth(1.0 + beside / EDGE)


def net_force(rate: Any, vx: Any, vy: Any) -> tuple[Any, Any]:
    """The force in N of a net that takes momentum at a rate in kg/s from a ball that falls."""
    return _HOLD * -rate * vx, -rate * vy
