"""Forces on a ball in newtons, each a callable of time, position, velocity and spin; and the torque that slows its
spin.

Each is data: a frozen dataclass whose fields are its numbers. Position (m), velocity (m/s), spin (rad/s,
counter-clockwise) and the fields are floats, or arrays of shape (n,) for many shots at once. A user's own force can be
any callable of this form.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import pi
from typing import Any, Protocol

from sandbox.physics.air import VISCOSITY, density_share
from sandbox.physics.coefficients import Coefficient, Constant
from sandbox.physics.elementwise import clip

Wind = Callable[[float, Any], tuple[Any, Any]]
Force = Callable[[float, Any, Any, Any], tuple[Any, Any]]

#: Avoids division by a speed of zero; negligible compared with any other speed (m/s).
_ALMOST_ZERO = 1e-30


class MassLoss(Protocol):
    """The mass in kg that a ball has lost by a time t (s), and the rate in kg/s at which it loses it. What it loses
    keeps its velocity and spin: the push that it gives is a force like any other."""

    def lost(self, t: Any) -> Any: ...
    def rate(self, t: Any) -> Any: ...


@dataclass(frozen=True)
class Gravity:
    """Weight, ``F = (0, -m g)``, of a mass m that may become less."""

    mass: float  # kg, at the start
    gravity: float  # m/s^2
    loss: MassLoss | None = None
    _force: tuple[float, float] = field(init=False, repr=False)  # N

    def __post_init__(self) -> None:
        object.__setattr__(self, "_force", (0.0, -self.mass * self.gravity))

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        if self.loss is None:
            return self._force
        return 0.0, (self.loss.lost(t) - self.mass) * self.gravity


@dataclass(frozen=True)
class _InAir:
    """The part that drag and lift share: the ball, the air, and the velocity relative to it."""

    radius: float  # m
    density: float  # kg/m^3, of the air
    coefficient: Coefficient
    wind: Wind | None = None
    area: float | None = None  # m^2; default: the sphere's cross-section
    viscosity: float = VISCOSITY  # Pa s
    _half_density_area: float = field(init=False, repr=False)
    _reynolds_per_speed: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        area = pi * self.radius * self.radius if self.area is None else self.area
        object.__setattr__(self, "_half_density_area", 0.5 * self.density * area)
        object.__setattr__(self, "_reynolds_per_speed", self.density * 2.0 * self.radius / self.viscosity)


def in_wind(wind: Wind, t: float, position: Any, velocity: Any) -> tuple[Any, Any]:
    """Velocity relative to the air, in m/s."""
    wx, wy = wind(t, position)
    return velocity[0] - wx, velocity[1] - wy


@dataclass(frozen=True)
class Drag(_InAir):
    """Quadratic drag, ``F = -1/2 rho Cd A |u| u`` with ``u = v - wind``. Clift, Grace & Weber 1978, chapter 5."""

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        ux, uy = velocity if self.wind is None else in_wind(self.wind, t, position, velocity)
        speed, coefficient = (ux * ux + uy * uy) ** 0.5, self.coefficient
        if type(coefficient) is Constant:
            value = coefficient.value
        else:
            spin_ratio = self.radius * abs(spin) / (speed + _ALMOST_ZERO)
            value = coefficient(self._reynolds_per_speed * speed, spin_ratio)
        k = -self._half_density_area * value * speed
        return k * ux, k * uy


@dataclass(frozen=True)
class Magnus(_InAir):
    """Magnus lift, ``F = 1/2 rho Cl A |u|^2``, at right angles to u, towards the side to which the spin moves the
    ball's front.

    With ``along_ground`` the speed, the spin ratio and the direction use the velocity over the ground, a textbook
    simplification. Source: Briggs 1959, Am. J. Phys. 27:589, for the direction; the magnitude is set by the
    coefficient.
    """

    along_ground: bool = False

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        wind = None if self.along_ground else self.wind
        ux, uy = velocity if wind is None else in_wind(wind, t, position, velocity)
        speed = (ux * ux + uy * uy) ** 0.5
        size = self.radius * abs(spin)
        spin_ratio = size / (speed + _ALMOST_ZERO)
        k = self._half_density_area * self.coefficient(self._reynolds_per_speed * speed, spin_ratio) * speed
        k = k * (self.radius * spin / (size + _ALMOST_ZERO))  # sign of the spin, 0 without spin
        return -k * uy, k * ux


@dataclass(frozen=True)
class Inside:
    """A force that acts inside a medium that ends at a line, such as the drag of water: times the share of a sphere's
    diameter that lies beyond the line.

    ``normal`` is the unit vector out of the medium. What a splash does is left out.
    """

    force: Force
    point: tuple[float, float]  # m, on the line
    normal: tuple[float, float]
    radius: float  # m, of the ball
    name: str  # where forces are listed

    @property
    def __name__(self) -> str:
        return self.name

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        (x, y), (px, py), (nx, ny) = position, self.point, self.normal
        share = clip(0.5 - ((x - px) * nx + (y - py) * ny) / (2.0 * self.radius), 0.0, 1.0)
        fx, fy = self.force(t, position, velocity, spin)
        return share * fx, share * fy


@dataclass(frozen=True)
class Thinning:
    """A force of air that grows thinner on the way up, times ``rho(y) / rho(0)`` of the standard atmosphere.

    Only the density falls: the Reynolds and Mach numbers stay those at the ground.
    """

    force: Force

    @property
    def __name__(self) -> str:
        return type(self.force).__name__

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        share = density_share(position[1])
        fx, fy = self.force(t, position, velocity, spin)
        return share * fx, share * fy


@dataclass(frozen=True)
class SpinDecay:
    """The air slows the spin, ``dw/dt = -k |u| w / r``, here as a torque in N m.

    k is about 2e-5 to 6e-5 for a golf ball. Source: Smits & Smith 1994 (2e-5), Tavares et al. 2001 (2.5e-5).
    """

    inertia: float  # kg m^2
    radius: float  # m
    rate: float  # k
    wind: Wind | None = None
    _k: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_k", self.inertia * self.rate / self.radius)

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> Any:
        ux, uy = velocity if self.wind is None else in_wind(self.wind, t, position, velocity)
        return -self._k * (ux * ux + uy * uy) ** 0.5 * spin
