"""Supercavitation: the drag of a body of which only a flat nose, the cavitator, touches the water, and how large the
cavity behind it is."""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi
from typing import Any

from sandbox.physics.elementwise import clip, maximum, smooth

#: Drag coefficient of a disc in a cavity whose cavitation number is 0, and how much of the cavitation number at which
#: the cavity closes it takes until the whole body is wet (assumed).
DISC, CLOSING = 0.82, 0.05

#: Avoids division by a speed of zero (Pa).
_ALMOST_ZERO = 1e-30


def cavitator_drag(cavitation: Any) -> Any:
    """Drag coefficient of a disc across the flow, of its face: ``Cd = 0.82 (1 + sigma)``, up to about sigma = 1.

    Source: Reichardt 1946; May 1975, Water entry and the cavity-running behavior of missiles; second-hand.
    """
    return DISC * (1.0 + cavitation)


def cavity_width(cavitation: float) -> float:
    """Greatest diameter of the cavity behind a disc, over the disc's: ``(Cd / sigma)^(1/2)``.

    Source: Garabedian 1956, Pacific J. Math. 6:611, for small sigma; second-hand.
    """
    return (cavitator_drag(cavitation) / cavitation) ** 0.5


def cavity_length(cavitation: float) -> float:
    """Length of the cavity behind a disc, over the disc's diameter: ``(Cd ln(1 / sigma))^(1/2) / sigma``, 0 from
    sigma = 1. Source: as for ``cavity_width``."""
    return (cavitator_drag(cavitation) * log(1.0 / cavitation)) ** 0.5 / cavitation if cavitation < 1.0 else 0.0


def closing_cavitation(width: float, length: float) -> float:
    """The cavitation number above which a cavity is too thin or too short for a body, its ``width`` and ``length``
    over the cavitator's diameter; below 1."""
    low, high = 0.0, 1.0
    while low < (middle := 0.5 * (low + high)) < high:
        holds = cavity_width(middle) >= width and cavity_length(middle) >= length
        low, high = (middle, high) if holds else (low, middle)
    return high


@dataclass(frozen=True)
class CavityDrag:
    """Drag in water below y = 0 of a body that runs in a cavity of vapour until that closes on it, then of all of it.

    ``F = -1/2 rho Cd A |v| v``, in the cavity with ``cavitator_drag`` and the cavitator's area, later with
    ``coefficient`` and the body's. The cavitation number is ``sigma = (p + rho g depth) / (rho v^2 / 2)``. The cavity
    is at every moment that of a steady flow.
    """

    density: float  # kg/m^3
    diameter: float  # m, of the body
    coefficient: float  # of the wet body
    cavitator: float  # m, its diameter
    closes: float  # cavitation number at which the cavity closes
    pressure: float  # Pa at the surface, above that of the vapour
    gravity: float  # m/s^2

    def cavitation(self, position: Any, velocity: Any) -> Any:
        """The cavitation number at a position in m and a velocity in m/s."""
        (_, y), (vx, vy) = position, velocity
        pressure = self.pressure + self.density * self.gravity * maximum(-y, 0.0)
        return pressure / (0.5 * self.density * (vx * vx + vy * vy) + _ALMOST_ZERO)

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        vx, vy = velocity
        over = self.cavitation(position, velocity) / self.closes
        dry = cavitator_drag(self.closes * clip(over, 0.0, 2.0)) * self.cavitator**2
        wet = self.coefficient * self.diameter**2
        area = 0.25 * pi * (dry + smooth((over - 1.0) / CLOSING) * (wet - dry))
        k = -0.5 * self.density * area * (vx * vx + vy * vy) ** 0.5
        return k * vx, k * vy
