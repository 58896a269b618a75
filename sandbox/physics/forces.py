"""Forces on a ball in newtons, each a callable of time, position, velocity and spin; and the torque that slows its
spin.

Position (m), velocity (m/s) and spin (rad/s, counter-clockwise) are floats, or arrays of shape (n,) for many shots at
once. A user's own force is any callable of this form, listed beside these.
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

from sandbox.physics.air import VISCOSITY
from sandbox.physics.coefficients import Coefficient

Wind = Callable[[float, Any], tuple[Any, Any]]

#: Keeps quotients by a speed finite where the speed is zero, and is nothing beside any other speed (m/s).
_ALMOST_ZERO = 1e-30


class Gravity:
    """Weight, ``F = (0, -m g)``."""

    def __init__(self, mass: float, gravity: float) -> None:
        self._force = (0.0, -mass * gravity)

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return self._force


class _InAir:
    """What drag, lift and the air's torque share: the ball, the air, and the velocity relative to it."""

    def __init__(
        self,
        radius: float,
        density: float,
        coefficient: Coefficient,
        wind: Wind | None = None,
        area: float | None = None,
        viscosity: float = VISCOSITY,
    ) -> None:
        self._radius = radius
        self._half_density_area = 0.5 * density * (pi * radius * radius if area is None else area)
        self._reynolds_per_speed = density * 2.0 * radius / viscosity
        self._coefficient = coefficient
        self._wind = wind

    def _air_velocity(self, t: float, position: Any, velocity: Any) -> tuple[Any, Any]:
        ux, uy = velocity
        if self._wind is not None:
            wx, wy = self._wind(t, position)
            ux = ux - wx
            uy = uy - wy
        return ux, uy


class Drag(_InAir):
    """Quadratic drag, ``F = -1/2 rho Cd A |u| u`` with ``u = v - wind``. Clift, Grace & Weber 1978, chapter 5."""

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        ux, uy = self._air_velocity(t, position, velocity)
        speed = (ux * ux + uy * uy) ** 0.5
        spin_ratio = self._radius * abs(spin) / (speed + _ALMOST_ZERO)
        k = -self._half_density_area * self._coefficient(self._reynolds_per_speed * speed, spin_ratio) * speed
        return k * ux, k * uy


class Magnus(_InAir):
    """Magnus lift, ``F = 1/2 rho Cl A |u|^2``, at right angles to u, towards the side to which the spin carries its
    front.

    With ``along_ground`` the speed, the spin ratio and the direction are those of the velocity over the ground, the
    textbook's shortcut. Source: Briggs 1959, Am. J. Phys. 27:589, for the direction; the size is the coefficient's.
    """

    def __init__(self, *args: Any, along_ground: bool = False, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        if along_ground:
            self._wind = None

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        ux, uy = self._air_velocity(t, position, velocity)
        speed = (ux * ux + uy * uy) ** 0.5
        size = self._radius * abs(spin)
        spin_ratio = size / (speed + _ALMOST_ZERO)
        k = self._half_density_area * self._coefficient(self._reynolds_per_speed * speed, spin_ratio) * speed
        k = k * (self._radius * spin / (size + _ALMOST_ZERO))  # sign of the spin, 0 without spin
        return -k * uy, k * ux


class SpinDecay:
    """The air slows the spin, ``dw/dt = -k |u| w / r``, here as a torque in N m.

    k is about 2e-5 to 6e-5 for a golf ball. Source: Smits & Smith 1994 (2e-5), Tavares et al. 2001 (2.5e-5).
    """

    def __init__(self, inertia: float, radius: float, rate: float, wind: Wind | None = None) -> None:
        self._k = inertia * rate / radius
        self._wind = wind

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> Any:
        ux, uy = velocity
        if self._wind is not None:
            wx, wy = self._wind(t, position)
            ux = ux - wx
            uy = uy - wy
        return -self._k * (ux * ux + uy * uy) ** 0.5 * spin
