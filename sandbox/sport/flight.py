"""A ball that is launched into the air: its parameters, the forces on it, and the ball itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import Any, ClassVar

from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.model.ball import HOLLOW_SPHERE, Ball, Force
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Surface
from sandbox.parameters import Group, SceneParameters, group, one_of, quantity
from sandbox.physics.coefficients import Coefficient, OfWholeSpin, Scaled
from sandbox.physics.elementwise import anywhere, cos, maximum, sin
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
from sandbox.sport.air import Air, AnyDrag, AnyLift, Lift, Model, model_of, wind_in

RPM = pi / 30.0  # rad/s
DEGREE = pi / 180.0  # rad

#: Coefficients of drag or lift by name, or a group of parameters that has such ones.
_Laws = Mapping[str, Coefficient] | type[Model]


class Directed(Group):
    """Something that is sent on its way with a ``speed`` in m/s, at an ``angle`` in deg."""

    speed: float
    angle: float

    @property
    def velocity(self) -> Vector:
        """In m/s."""
        return self.speed * cos(self.angle * DEGREE), self.speed * sin(self.angle * DEGREE)


class Launch(Directed):
    """The ball as it leaves hand, foot or club, seen from the side."""

    speed: float = quantity(..., "m/s", 0, 340, "ball speed")
    angle: float = quantity(..., "deg", -90, 180, "direction above the horizontal")
    spin: float = quantity(0.0, "rpm", -20000, 20000, "backspin positive, topspin negative")

    @property
    def active_spin(self) -> float:
        """The spin in rpm that the ball is simulated with."""
        return self.spin if self.spin_share is None else self.spin * self.spin_share

    @property
    def lift_share(self) -> float | None:
        """The share of the lift in the scene's plane, less than 1 if the spin axis is tilted; None for all of it."""
        return None

    @property
    def spin_share(self) -> float | None:
        """The share of the whole spin, by which drag and lift go, that the ball is simulated with; None for all."""
        return None

    def in_plane(self, air: Air) -> Air:
        """The air with its wind as it blows in the plane of the flight."""
        return air


class Release(Group):
    """The place where the ball leaves hand or racket."""

    place: float = quantity(..., "m", -20, 20, "from the player's own line, forward")
    height: float = quantity(..., "m", 0, 10, "of the ball's centre above the ground")

    def of(self, ball: Sphere) -> Vector:
        """That place in m; no lower than where the ball lies on the ground."""
        return self.place, maximum(self.height, ball.radius)


class Sphere(Group):
    """The ball.

    It is hollow by default. ``class GolfBall(Sphere, drag=GOLF_DRAG, lift=GOLF_LIFT)`` may have the coefficients of
    these dictionaries by name, besides those that any ball may have.
    """

    #: Moment of inertia over m r^2.
    INERTIA: ClassVar[float] = HOLLOW_SPHERE

    mass: float = quantity(..., "kg", 0.0001, 20, "mass")
    radius: float = quantity(..., "m", 0.0005, 0.5, "radius")
    cross_section: float | None = quantity(None, "m^2", 1e-7, 1, "frontal area, if it does not follow from the radius")
    drag: AnyDrag = one_of(..., "drag of the air")
    lift: AnyLift = one_of(..., "Magnus force")

    def __init_subclass__(cls, drag: _Laws | None = None, lift: _Laws | None = None, **options: Any) -> None:
        super().__init_subclass__(**options)

    @classmethod
    def __pydantic_init_subclass__(cls, drag: _Laws | None = None, lift: _Laws | None = None, **options: Any) -> None:
        super().__pydantic_init_subclass__(**options)
        for name, laws, base in (("drag", drag, Model), ("lift", lift, Lift)):
            if laws is not None:
                own = laws if isinstance(laws, type) else model_of(cls.__name__ + name.capitalize(), laws, base)
                kinds: Any = own | cls.model_fields[name].annotation
                cls.model_fields[name].annotation = kinds

    @property
    def inertia_factor(self) -> float:
        """Moment of inertia over m r^2."""
        return self.INERTIA

    def decay_in(self, air: Air) -> float:
        """k of ``dw/dt = -k |u| w / r``, by which the air slows its spin; 0 where a sport leaves that out."""
        return 0.0


class SlowedSphere(Sphere):
    """A ball whose spin the air slows, the less the thinner it is."""

    spin_decay: float = quantity(..., "", 0, 0.01, "k of dw/dt = -k |u| w / r, in air of 1.204 kg/m^3")

    def decay_in(self, air: Air) -> float:
        """In proportion to the density."""
        return self.spin_decay * air.density / 1.204


class Flight(SceneParameters):
    """Parameters of a ball that flies, seen from the side; a sport adds its own, and says which ball and air it has."""

    launch: Launch = group(..., "the ball as it is launched")
    gravity: float = quantity(..., "m/s^2", 0, 100, "gravity")
    air: Air = group(..., "the air")
    ball: Sphere = group(..., "the ball")

    def launched(self, place: Vector, *forces: Force) -> Ball:
        """The ball ``"ball"`` as it leaves ``place`` (m), with its weight, drag, lift and these forces."""
        launch, ball = self.launch, self.ball
        air = launch.in_plane(self.air.air)
        own = forces_in_flight(ball, air, self.gravity, launch.lift_share, launch.spin_share)
        return launched_ball(launch, ball, air, place, [*own, *forces])


def forces_in_flight(
    ball: Sphere, air: Air, gravity: float = 0.0, lift_share: float | None = None, spin_share: float | None = None
) -> list[Force]:
    """Weight, drag and Magnus lift; those that are zero are left out.

    Only ``lift_share`` of the lift is in the scene's plane, less than 1 if the spin axis is tilted, and only
    ``spin_share`` of the whole spin is that of the simulated ball; None for all.
    """
    forces: list[Force] = [Gravity(gravity)] if gravity > 0.0 else []
    if _is_zero(air.density):
        return forces
    about = (wind_in(air), ball.cross_section, air.viscosity)
    drag, lift = ball.drag.coefficient_in(air, ball), ball.lift.coefficient_in(air, ball)
    if spin_share is not None:
        drag, lift = (None if law is None else OfWholeSpin(law, spin_share) for law in (drag, lift))
    if drag is not None:
        forces.append(Drag(ball.radius, air.density, drag, *about))
    if lift is not None:
        lift = lift if lift_share is None else Scaled(lift, lift_share)
        along_ground = isinstance(ball.lift, Lift) and ball.lift.velocity == "ground"
        forces.append(Magnus(ball.radius, air.density, lift, *about, along_ground=along_ground))
    return forces


def _is_zero(value: Any) -> bool:
    """True for 0. Of many shots at once, where it is 0 in some, raises ValueError: they are not built alike."""
    zero = value == 0.0
    return anywhere(zero) and bool(zero)


def height_on(surfaces: Sequence[Surface], radius: float, above: float) -> float:
    """Height in m of the centre of a ball that lies on surfaces at x = 0, found from ``above`` m down to 1e-12 m."""
    obstacles, y = [Obstacle(surface, radius) for surface in surfaces], above + radius
    while (gap := min(obstacle.near(0.0, y).gap for obstacle in obstacles)) > 1e-12:
        y -= gap  # it cannot have reached anything on that way
    return y


def launched_ball(launch: Launch, ball: Sphere, air: Air, place: Vector, forces: Sequence[Force]) -> Ball:
    """The ball ``"ball"`` as it leaves ``place`` (m); the air slows its spin where the sport says how."""
    start = place, launch.velocity, launch.active_spin * RPM
    sent = Ball("ball", ball.mass, ball.radius, *start, inertia_factor=ball.inertia_factor, forces=forces)
    rate = ball.decay_in(air)
    if _is_zero(air.density) or _is_zero(rate):
        return sent
    return replace(sent, torques=[SpinDecay(sent.inertia, ball.radius, rate, wind_in(air))])
