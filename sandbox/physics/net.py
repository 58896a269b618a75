"""The net below a ring, which slows a ball that falls through it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from sandbox.physics.elementwise import anywhere, minimum, smooth


@dataclass(frozen=True)
class NetDrag:
    """The net around a ball that passes through: ``F = -m k (4 vx, vy)`` inside a box below the ring, k in 1/s.

    It resists sideways motion more than falling. The force begins and ends over a short distance, so that it has no
    jumps. All of it is assumed: no measurement of a net was found.
    """

    #: Sideways over downwards.
    HOLD: ClassVar = 4.0

    #: The distance in m over which the force begins and ends.
    EDGE: ClassVar = 0.05

    mass: float  # kg
    damping: float  # 1/s
    middle: tuple[float, float]  # m, of the ring
    half_width: float  # m
    length: float  # m

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        (x, y), (across, top) = position, self.middle
        below = minimum(top - y, self.length - (top - y))
        if not anywhere(below > 0.0):
            return 0.0, 0.0
        beside = self.half_width - abs(x - across)
        if not anywhere((below > 0.0) & (beside > -self.EDGE)):
            return 0.0, 0.0
        hold = smooth(below / self.EDGE) * smooth(1.0 + beside / self.EDGE)
        k = -self.mass * self.damping * hold
        return self.HOLD * k * velocity[0], k * velocity[1]
