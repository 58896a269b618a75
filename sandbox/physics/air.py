"""Air: density, viscosity, and wind as a velocity field."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from random import Random
from typing import Any, ClassVar, NamedTuple

from sandbox.physics.elementwise import anywhere, clip, cos, exp, log, smooth


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
        profile = log_profile(position[1], self.roughness, self.ceiling)
        return self._x * profile, self._y * profile

    @property
    def row(self) -> tuple[float, float, float, float]:
        """Its velocity in m/s over the profile's, and the arguments of ``log_profile``."""
        return self._x, self._y, self.roughness, self.ceiling


def log_profile(height: Any, roughness: Any, ceiling: Any) -> Any:
    """``ln(1 + y / y0)`` at a height y in m, as in LogWind."""
    return log(1.0 + clip(height, 0.0, ceiling) / roughness)


class _Wave(NamedTuple):
    """One wave of the gusts: its wave number, and amplitude and phase of its velocity along the ground and upwards."""

    number: float  # rad/m
    along: float  # m/s
    phase_along: float  # rad
    up: float  # m/s
    phase_up: float  # rad


@dataclass(frozen=True)
class Gusts:
    """Gusts on a wind: a field of waves with Dryden's spectra, frozen, which the wind carries along.

    Along the ground ``S_u(k) = sd^2 (2 L_u / pi) / (1 + (L_u k)^2)``, upwards
    ``S_w(k) = sd_w^2 (L_w / pi) (1 + 3 (L_w k)^2) / (1 + (L_w k)^2)^2``. With ``height`` h in ft,
    ``c = 0.177 + 0.000823 h``: ``L_w = h``, ``L_u = h / c^1.2`` and ``sd_w = sd c^0.4``; over open ground sd is about
    ``0.1 / c^0.4`` of the wind at 20 ft. Source: MIL-F-8785C 1980, low altitudes (10 to 1,000 ft).

    It is a sum of cosines with random phases, the same for the same ``seed`` (Shinozuka and Deodatis 1991, Appl. Mech.
    Rev. 44:191), and smooth in time and place. Waves longer than 60 L_u or shorter than L_u / 5 (13 m at a height of
    10 m) are left out, with 8 % of the variance along the ground and 22 % of that upwards; so are gusts to the side,
    and that scale and strength change with height. Below a height of 1 m gusts fade, to nothing below 10 cm (assumed):
    what lies on the ground stays there.

    >>> from sandbox import Drag, Gusts, UniformWind
    >>> drag = Drag(coefficient=0.25, wind=Gusts(UniformWind(-5.0, 0.0), sd=1.0, height=10.0, seed=3))
    """

    time_scale: ClassVar[float] = 0.1  # s, in which a ball of 70 m/s crosses half of the shortest wave at 10 m
    mean: UniformWind | LogWind
    sd: float  # m/s, along the ground
    height: float = 10.0  # m, at which scales and speed of the field are taken
    seed: int = 0
    _carried: float = field(init=False, repr=False)  # m/s
    _waves: tuple[_Wave, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_carried", self.mean(0.0, (0.0, float(self.height)))[0])
        object.__setattr__(self, "_waves", _waves(self.sd, self.height, self.seed))

    def __call__(self, t: float, position: Any) -> tuple[Any, Any]:
        x, y = self.mean(t, position)
        share = smooth((position[1] - _STILL) / (_WHOLE - _STILL))
        if not anywhere(share > 0.0):
            return x, y
        place, along, up = position[0] - self._carried * t, 0.0, 0.0
        for wave in self._waves:
            angle = wave.number * place
            along = along + wave.along * cos(angle + wave.phase_along)
            up = up + wave.up * cos(angle + wave.phase_up)
        return x + share * along, y + share * up


#: Heights in m up to which there are no gusts, and from which they are whole.
_STILL, _WHOLE = 0.1, 1.0

#: Waves of the gusts, and the ends of their wave numbers times the scale along the ground.
_COUNT, _LONGEST, _SHORTEST = 24, 0.1, 30.0


def _waves(sd: float, height: float, seed: int) -> tuple[_Wave, ...]:
    """Waves whose numbers grow by the same factor, each with the variance of its band, and random phases."""
    feet, phases, waves = height / 0.3048, Random(seed), []
    c = 0.177 + 0.000823 * feet
    along, sd_up = height / c**1.2, sd * c**0.4
    factor = (_SHORTEST / _LONGEST) ** (1.0 / _COUNT)
    for place in range(_COUNT):
        low = _LONGEST / along * factor**place
        number, band = low * factor**0.5, low * (factor - 1.0)
        a, b = (along * number) ** 2, (height * number) ** 2
        of_u = sd**2 * 2.0 * along / pi / (1.0 + a)
        of_w = sd_up**2 * height / pi * (1.0 + 3.0 * b) / (1.0 + b) ** 2
        first, second = (phases.uniform(0.0, 2.0 * pi) for _ in range(2))
        waves.append(_Wave(number, (2.0 * of_u * band) ** 0.5, first, (2.0 * of_w * band) ** 0.5, second))
    return tuple(waves)
