"""Forces on a ball in newtons, each a callable of time, position, velocity and spin; and the torque that slows its
spin.

Each is data: a frozen dataclass whose fields are its numbers. Position (m), velocity (m/s), spin (rad/s,
counter-clockwise) and the fields are floats, or arrays of shape (n,) for many shots at once. A user's own force can be
any callable of this form.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import pi
from typing import Any, ClassVar, NamedTuple, Protocol

from sandbox.physics.air import DENSITY, VISCOSITY, density_share
from sandbox.physics.checks import check
from sandbox.physics.coefficients import Coefficient, Constant, spin_ratio_lift
from sandbox.physics.elementwise import anywhere, clip, sqrt
from sandbox.physics.of_ball import OfBall, on_ball

Wind = Callable[[float, Any], tuple[Any, Any]]
Force = Callable[[float, Any, Any, Any], tuple[Any, Any]]

#: The fields of a force that ``sandbox trade`` may leave out, each with the value that leaves it out; the ``PARTS`` of
#: its class. Nothing else of a force is changed.
Parts = Mapping[str, Any]
IN_WIND: Parts = {"wind": None}

#: Avoids division by a speed of zero; negligible compared with any other speed (m/s).
ALMOST_ZERO = 1e-30


class MassLoss(Protocol):
    """The mass in kg that a ball has lost by a time t (s), and the rate in kg/s at which it loses it. What it loses
    keeps its velocity and spin: the push that it gives is a force like any other. It may have ``discontinuities`` and a
    ``time_scale`` (``timing.py``)."""

    def lost(self, t: Any) -> Any: ...
    def rate(self, t: Any) -> Any: ...


def _computed() -> Any:
    """A field that follows from the others, and from the ball."""
    return field(init=False, repr=False, compare=False)


@dataclass(frozen=True)
class Gravity(OfBall):
    """Weight, ``F = (0, -m g)``, of the ball's mass m, which may become less, or of another ``mass``.

    >>> from sandbox import Ball, Gravity
    >>> ball = Ball("ball", mass=0.5, radius=0.1, position=(0, 1), forces=[Gravity(9.81)])
    >>> ball.forces[0](0.0, (0.0, 1.0), (0.0, 0.0), 0.0)
    (0.0, -4.905)
    """

    timed: ClassVar = ("_loss",)
    gravity: float  # m/s^2
    mass: float | None = None  # kg, at the start; default: the ball's, and what it loses
    loss: MassLoss | None = field(default=None, kw_only=True)
    _mass: float = _computed()  # kg
    _loss: MassLoss | None = _computed()
    _force: tuple[float, float] = _computed()  # N

    def __post_init__(self) -> None:
        check("Gravity", self, finite=["gravity"])
        if self.mass is not None:
            self._weigh(self.mass, self.loss)

    def _weigh(self, mass: float, loss: MassLoss | None) -> None:
        for name, value in {"_mass": mass, "_loss": loss, "_force": (0.0, -mass * self.gravity)}.items():
            object.__setattr__(self, name, value)

    def on(self, ball: Any) -> Gravity:
        if self.mass is not None:
            return self
        made = replace(self)
        made._weigh(ball.mass, ball.loss)
        return made

    @property
    def is_constant(self) -> bool:
        """True if nothing is lost of the mass."""
        return self._loss is None

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        if self._loss is None:
            return self._force
        return 0.0, (self._loss.lost(t) - self._mass) * self.gravity


class _AirRow(NamedTuple):
    """The numbers of a drag or lift, and its coefficient."""

    half_density_area: Any  # kg/m
    law: Coefficient
    reynolds_per_speed: Any  # s/m
    radius: Any  # m


@dataclass(frozen=True)
class _InAir(OfBall):
    """The part that drag and lift share: the ball, the air, and the velocity relative to it."""

    radius: float | None = None  # m; default: the ball's
    density: float = DENSITY  # kg/m^3, of the air
    coefficient: Coefficient | float = 0.0  # a function of Reynolds number and spin ratio, or a number
    wind: Wind | None = None
    area: float | None = None  # m^2; default: the sphere's cross-section
    viscosity: float = VISCOSITY  # Pa s
    PARTS: ClassVar[Parts] = IN_WIND
    _row: _AirRow = _computed()

    def __post_init__(self) -> None:
        check(type(self).__name__, self, not_negative=["density"], positive=["viscosity"])
        if not callable(self.coefficient):
            check(type(self).__name__, self, finite=["coefficient"])
        if self.radius is not None:
            self._measure(self.radius)

    def _measure(self, radius: float) -> None:
        area = pi * radius * radius if self.area is None else self.area
        law = self.coefficient if callable(self.coefficient) else Constant(self.coefficient)
        row = _AirRow(0.5 * self.density * area, law, self.density * 2.0 * radius / self.viscosity, radius)
        object.__setattr__(self, "_row", row)

    @property
    def row(self) -> _AirRow:
        """The arguments of ``through_air``."""
        return self._row

    def on(self, ball: Any) -> Any:
        if self.radius is not None:
            if not ball.rotates and self.area is None and not anywhere(self.radius == ball.radius):
                kind, it = type(self).__name__, f"ball {ball.name!r}, {ball.radius} m"
                remedy = f"leave it out; a coefficient is {kind}(coefficient=...)"
                raise ValueError(f"{kind}: radius = {self.radius} m is not that of {it}: {remedy}")
            return self
        made = replace(self)
        made._measure(ball.radius)
        return made


def in_wind(wind: Wind, t: float, position: Any, velocity: Any) -> tuple[Any, Any]:
    """Velocity relative to the air, in m/s."""
    wx, wy = wind(t, position)
    return velocity[0] - wx, velocity[1] - wy


@dataclass(frozen=True)
class Drag(_InAir):
    """Quadratic drag, ``F = -1/2 rho Cd A |u| u`` with ``u = v - wind``. Clift, Grace & Weber 1978, chapter 5.

    The default coefficient, 0.47, is that of a smooth sphere at Reynolds numbers from 1e4 to 2e5 (Hoerner 1965, chapter
    3); the default density is that of air at 15 C at sea level.

    >>> from sandbox import Ball, Drag, UniformWind
    >>> ball = Ball("ball", mass=0.62, radius=0.12, position=(0, 2), forces=[Drag(wind=UniformWind(-5.0, 0.0))])
    >>> fx, fy = ball.forces[0](0.0, (0.0, 2.0), (5.0, 0.0), 0.0)
    >>> round(fx, 3)  # N, against 10 m/s
    -1.302
    """

    timed: ClassVar = ("wind",)
    coefficient: Coefficient | float = 0.47

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        ux, uy = velocity if self.wind is None else in_wind(self.wind, t, position, velocity)
        return through_air(self._row, None, None, ux, uy, spin)[:2]


@dataclass(frozen=True)
class Magnus(_InAir):
    """Magnus lift, ``F = 1/2 rho Cl A |u|^2``, at right angles to u, towards the side to which the spin moves the
    ball's front.

    With ``along_ground`` the speed, the spin ratio and the direction use the velocity over the ground, a textbook
    simplification. Source: Briggs 1959, Am. J. Phys. 27:589, for the direction; the magnitude is set by the
    coefficient, by default the spin ratio itself.

    >>> from sandbox import Ball, Magnus
    >>> ball = Ball("ball", mass=0.43, radius=0.11, position=(0, 0), forces=[Magnus(coefficient=0.2)])
    >>> fx, fy = ball.forces[0](0.0, (0.0, 0.0), (20.0, 0.0), 60.0)
    >>> round(fy, 3)  # N: backspin lifts
    1.863
    """

    timed: ClassVar = ("wind",)
    coefficient: Coefficient | float = spin_ratio_lift
    along_ground: bool = False

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        wind = None if self.along_ground else self.wind
        ux, uy = velocity if wind is None else in_wind(wind, t, position, velocity)
        return through_air(None, self._row, None, ux, uy, spin)[:2]


@dataclass(frozen=True)
class Inside(OfBall):
    """A force that acts inside a medium that ends at a line, such as the drag of water: times the share of a sphere's
    diameter that lies beyond the line.

    ``normal`` is the unit vector out of the medium. What a splash does is left out.
    """

    timed: ClassVar = ("force",)
    force: Force
    point: tuple[float, float]  # m, on the line
    normal: tuple[float, float]
    radius: float  # m, of the ball
    name: str  # where forces are listed

    @property
    def __name__(self) -> str:
        return self.name

    def on(self, ball: Any) -> Inside:
        return replace(self, force=on_ball(self.force, ball))

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        (x, y), (px, py), (nx, ny) = position, self.point, self.normal
        share = clip(0.5 - ((x - px) * nx + (y - py) * ny) / (2.0 * self.radius), 0.0, 1.0)
        fx, fy = self.force(t, position, velocity, spin)
        return share * fx, share * fy


@dataclass(frozen=True)
class Thinning(OfBall):
    """A force of air that grows thinner on the way up, times ``rho(y) / rho(0)`` of the standard atmosphere.

    Only the density falls: the Reynolds and Mach numbers stay those at the ground.
    """

    timed: ClassVar = ("force",)
    force: Force

    @property
    def __name__(self) -> str:
        return type(self.force).__name__

    def on(self, ball: Any) -> Thinning:
        return replace(self, force=on_ball(self.force, ball))

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        share = density_share(position[1])
        fx, fy = self.force(t, position, velocity, spin)
        return share * fx, share * fy


@dataclass(frozen=True)
class SpinDecay(OfBall):
    """The air slows the spin, ``dw/dt = -k |u| w / r``, here as a torque in N m.

    k is about 2e-5 to 6e-5 for a golf ball. Source: Smits & Smith 1994 (2e-5), Tavares et al. 2001 (2.5e-5).

    >>> from sandbox import Ball, SpinDecay
    >>> ball = Ball("ball", mass=0.0459, radius=0.02135, position=(0, 0), torques=[SpinDecay(rate=2e-5)])
    >>> ball.torques[0](0.0, (0.0, 0.0), (70.0, 0.0), 300.0) < 0.0
    True
    """

    timed: ClassVar = ("wind",)
    inertia: float | None = None  # kg m^2; default: the ball's
    radius: float | None = None  # m; default: the ball's
    rate: float = 2e-5  # k
    wind: Wind | None = None
    PARTS: ClassVar[Parts] = IN_WIND
    _k: float = _computed()

    @property
    def row(self) -> float:
        """The arguments of ``through_air``, in kg m."""
        return self._k

    def __post_init__(self) -> None:
        if self.inertia is not None and self.radius is not None:
            self._scale(self.inertia, self.radius)

    def _scale(self, inertia: float, radius: float) -> None:
        object.__setattr__(self, "_k", inertia * self.rate / radius)

    def on(self, ball: Any) -> SpinDecay:
        if self.inertia is not None and self.radius is not None:
            return self
        made = replace(self)
        made._scale(
            ball.inertia if self.inertia is None else self.inertia, ball.radius if self.radius is None else self.radius
        )
        return made

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> Any:
        ux, uy = velocity if self.wind is None else in_wind(self.wind, t, position, velocity)
        return through_air(None, None, self._k, ux, uy, spin)[2]


def drag_rate(half_density_area: Any, value: Any, speed: Any) -> Any:
    """Drag over the velocity relative to the air, ``-1/2 rho Cd A |u|`` in N s/m."""
    return -half_density_area * value * speed


def lift_rate(half_density_area: Any, value: Any, speed: Any, radius: Any, spin: Any) -> Any:
    """Lift over the velocity relative to the air turned by a quarter to the left, ``1/2 rho Cl A |u|`` in N s/m with
    the sign of the spin; 0 without spin."""
    return half_density_area * value * speed * (radius * spin / (radius * abs(spin) + ALMOST_ZERO))


def through_air(
    drag: _AirRow | None,
    lift: _AirRow | None,
    decay: Any,
    ux: Any,
    uy: Any,
    spin: Any,
    fx: Any = 0.0,
    fy: Any = 0.0,
) -> tuple[Any, Any, Any]:
    """Force in N, with what else acts, fx and fy, and torque in N m, on a ball with this velocity relative to the air:
    by drag, lift and spin decay (its k, in kg m), as far as they are given."""
    speed, torque = sqrt(ux * ux + uy * uy), 0.0
    if drag is not None:
        half_density_area, law, reynolds_per_speed, radius = drag
        if type(law) is Constant:
            value = law.value
        else:
            value = law(reynolds_per_speed * speed, radius * abs(spin) / (speed + ALMOST_ZERO))
        k = drag_rate(half_density_area, value, speed)
        fx, fy = fx + k * ux, fy + k * uy
    if lift is not None:
        half_density_area, law, reynolds_per_speed, radius = lift
        value = law(reynolds_per_speed * speed, radius * abs(spin) / (speed + ALMOST_ZERO))
        k = lift_rate(half_density_area, value, speed, radius, spin)
        fx, fy = fx - k * uy, fy + k * ux
    if decay is not None:
        torque = -decay * speed * spin
    return fx, fy, torque
