"""Air: density, viscosity, and wind as a velocity field."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from sandbox.physics.elementwise import clip, exp, log


def viscosity(temperature: float) -> float:
    """Dynamic viscosity of air in Pa s at a temperature in K: ``1.458e-6 T^1.5 / (T + 110.4)``.

    Valid from 100 to 1,900 K. Source: Sutherland's law with the constants of the U.S. Standard Atmosphere 1976,
    equation 51.
    """
    return 1.458e-6 * temperature**1.5 / (temperature + 110.4)


def moist_density(temperature: float, pressure: float, humidity: float, elevation: float) -> float:
    """Density of air in kg/m^3: ``1.2929 (273 / T) (p exp(-h / 8217 m) - 0.3783 H p_v) / 101325``.

    ``temperature`` T in K, ``pressure`` p in Pa as weather stations give it (reduced to sea level), relative
    ``humidity`` H from 0 to 1, ``elevation`` h in m above the sea; p_v is the vapour pressure of water (Buck).
    Source: Nathan 2016, trajectory calculator, which has them in mm of mercury; second-hand (pybaseball).
    """
    celsius = temperature - 273.15
    vapour = 611.2 * exp((18.687 - celsius / 234.5) * celsius / (257.14 + celsius))
    here = pressure * exp(-0.0001217 * elevation) - 0.3783 * humidity * vapour
    return 1.2929 * 273.0 / temperature * here / 101325.0


def density_share(height: Any) -> Any:
    """Density of air at a height in m over that at the ground: ``(1 - h / 44331 m)^4.2559``.

    Valid up to 11,000 m over the sea, where the temperature falls by 6.5 K per km; the ground is at the sea.
    Source: U.S. Standard Atmosphere 1976, equations 33b and 42.
    """
    return clip(1.0 - height / 44331.0, 0.0, 1.0) ** 4.2559


#: Density in kg/m^3 of dry air at 15 C and sea level (U.S. Standard Atmosphere 1976).
DENSITY = 1.225

#: Dynamic viscosity in Pa s of air at 15 C.
VISCOSITY = viscosity(288.15)


@dataclass(frozen=True)
class UniformWind:
    """The same wind everywhere, at all times, in m/s.

    >>> from sandbox import UniformWind
    >>> UniformWind(-5.0, 0.0)(0.0, (0.0, 2.0))
    (-5.0, 0.0)
    """

    x: float
    y: float

    def __call__(self, t: float, position: Any) -> tuple[Any, Any]:
        return self.x, self.y


@dataclass(frozen=True)
class LogWind:
    """Wind that increases with height over rough ground: ``w(y) = w_ref ln(1 + y/y0) / ln(1 + y_ref/y0)``.

    ``reference`` is the velocity (m/s) at the height ``reference_height``; ``roughness`` y0 is about 0.03 m over mown
    grass. Valid in the lowest 100 m in neutral air; it is constant above ``ceiling``, and zero at and below
    the ground (y = 0). Source: Wieringa 1992, J. Wind Eng. Ind. Aerodyn. 41:357; the 1 added inside the logarithm
    keeps it finite at the ground.

    >>> from sandbox import Drag, LogWind
    >>> breeze = LogWind(reference=(-5.0, 0.0), reference_height=10.0, roughness=0.03)
    >>> drag = Drag(coefficient=0.25, wind=breeze)
    >>> round(breeze(0.0, (0.0, 10.0))[0], 9)  # m/s
    -5.0
    """

    reference: tuple[float, float]  # m/s
    reference_height: float  # m
    roughness: float  # m
    ceiling: float = 100.0  # m
    _x: float = field(init=False, repr=False)
    _y: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        scale = log(1.0 + self.reference_height / self.roughness)
        object.__setattr__(self, "_x", self.reference[0] / scale)
        object.__setattr__(self, "_y", self.reference[1] / scale)

    def __call__(self, t: float, position: Any) -> tuple[Any, Any]:
        profile = log(1.0 + clip(position[1], 0.0, self.ceiling) / self.roughness)
        return self._x * profile, self._y * profile
