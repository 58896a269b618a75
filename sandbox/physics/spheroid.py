"""Forces on an elongated body: drag by the direction of its long axis, and a torque that keeps its nose in its path."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from sandbox.physics.elementwise import clip, hypot
from sandbox.physics.forces import IN_WIND, Parts, Wind, in_wind


@dataclass(frozen=True)
class DragByAngle:
    """Quadratic drag that depends on the angle a between the long axis and the wind:
    ``F = -1/2 rho A (Cn cos^2 a + Cs sin^2 a) |u| u``, with A the round cross-section. The form is assumed."""

    timed: ClassVar = ("wind",)
    density: float  # kg/m^3
    area: float  # m^2
    nose: float  # Cn
    side: float  # Cs
    wind: Wind | None
    spiral: bool
    PARTS: ClassVar[Parts] = IN_WIND

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        ux, uy = velocity if self.wind is None else in_wind(self.wind, t, position, velocity)
        speed = hypot(ux, uy)
        along = speed if self.spiral else ux * cos(position.angle) + uy * sin(position.angle)
        nose = (along / (speed + 1e-30)) ** 2
        k = -0.5 * self.density * self.area * (self.nose * nose + self.side * (1.0 - nose)) * speed
        return k * ux, k * uy


@dataclass(frozen=True)
class Follows:
    """A stiff, damped torque that turns a spiral's nose with its path until it touches something."""

    inertia: float  # kg m^2
    rate: float = 12.0  # rad/s, of the turning towards the path; assumed
    lowest: float = 0.4  # m, below which it acts no more

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> Any:
        speed = hypot(*velocity) + 1e-30
        off = (velocity[1] * cos(position.angle) - velocity[0] * sin(position.angle)) / speed
        high = clip((position[1] - self.lowest) / 0.2, 0.0, 1.0)
        return high * self.inertia * (self.rate**2 * off - 2.0 * self.rate * spin)
