"""A ball that is launched into the air: its parameters, the forces on it, and the ball itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi
from typing import Protocol

from sandbox.engine.setup import HOLLOW_SPHERE, Ball, Force, Surface, Vector
from sandbox.engine.touch import Obstacle
from sandbox.parameters import Group, either, quantity
from sandbox.physics.coefficients import Scaled
from sandbox.physics.elementwise import cos, sin
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
from sandbox.sport.air import Air, ConstantDrag, ConstantLift, Lift, Model, NoDrag, NoLift, SpinRatioLift, wind_in

RPM = pi / 30.0  # rad/s
DEGREE = pi / 180.0  # rad


class Launch(Group):
    """The ball as it leaves hand, foot or club, seen from the side."""

    speed: float = quantity(..., "m/s", 0, 340, "ball speed")
    angle: float = quantity(..., "deg", -90, 180, "direction above the horizontal")
    spin: float = quantity(..., "rpm", -20000, 20000, "backspin positive, topspin negative")


class Release(Group):
    """Where the ball leaves hand or racket."""

    place: float = quantity(..., "m", -20, 20, "from the player's own line, forward")
    height: float = quantity(..., "m", 0.01, 10, "of the ball's centre above the ground")


class Sphere(Group):
    """A ball."""

    mass: float = quantity(..., "kg", 0.0001, 20, "mass")
    radius: float = quantity(..., "m", 0.0005, 0.5, "radius")
    cross_section: float | None = quantity(None, "m^2", 1e-7, 1, "frontal area, if it does not follow from the radius")


class FlyingBall(Sphere):
    """A hollow sphere whose drag and lift have one coefficient for all speeds."""

    drag: ConstantDrag | NoDrag = either(..., "drag of the air")
    lift: NoLift | ConstantLift | SpinRatioLift = either(..., "Magnus lift")


class Flying(Protocol):
    """A Sphere with the sport's models of drag and lift."""

    @property
    def mass(self) -> float: ...
    @property
    def radius(self) -> float: ...
    @property
    def cross_section(self) -> float | None: ...
    @property
    def drag(self) -> Model: ...
    @property
    def lift(self) -> Model: ...


class Launched(Protocol):
    """Speed in m/s, angle in deg, spin in rpm."""

    @property
    def speed(self) -> float: ...
    @property
    def angle(self) -> float: ...
    @property
    def spin(self) -> float: ...


def forces_in_flight(ball: Flying, air: Air, gravity: float = 0.0, lift_share: float = 1.0) -> list[Force]:
    """Weight, drag and Magnus lift; those that are zero are left out.

    Only ``lift_share`` of the lift is in the scene's plane, less than 1 if the spin axis is tilted.
    """
    forces: list[Force] = [Gravity(ball.mass, gravity)] if gravity > 0.0 else []
    if air.density == 0.0:
        return forces
    about = (wind_in(air), ball.cross_section, air.viscosity)
    drag, lift = ball.drag.coefficient_in(air, ball.radius), ball.lift.coefficient_in(air, ball.radius)
    if drag is not None:
        forces.append(Drag(ball.radius, air.density, drag, *about))
    if lift is not None:
        lift = lift if lift_share == 1.0 else Scaled(lift, lift_share)
        along_ground = isinstance(ball.lift, Lift) and ball.lift.velocity == "ground"
        forces.append(Magnus(ball.radius, air.density, lift, *about, along_ground=along_ground))
    return forces


def height_on(surfaces: Sequence[Surface], radius: float, x: float = 0.0, above: float = 0.0) -> float:
    """Height in m of the centre of a ball that lies on surfaces at x, found from ``above`` m down to 1e-12 m."""
    obstacles, y = [Obstacle(surface, radius) for surface in surfaces], above + radius
    while (gap := min(obstacle.near(x, y).gap for obstacle in obstacles)) > 1e-12:
        y -= gap  # it cannot have reached anything on that way
    return y


def launched_ball(
    launch: Launched, ball: Flying, place: Vector, forces: Sequence[Force], inertia_factor: float = HOLLOW_SPHERE
) -> Ball:
    """The ball ``"ball"`` as it leaves ``place`` (m)."""
    angle = launch.angle * DEGREE
    return Ball(
        "ball",
        ball.mass,
        ball.radius,
        position=place,
        velocity=(launch.speed * cos(angle), launch.speed * sin(angle)),
        spin=launch.spin * RPM,
        inertia_factor=inertia_factor,
        forces=forces,
    )


def with_spin_decay(ball: Ball, rate: float, air: Air) -> Ball:
    """The ball, whose spin the air slows: ``rate`` k of ``dw/dt = -k |u| w / r``."""
    if air.density == 0.0 or rate == 0.0:
        return ball
    return replace(ball, torques=[*ball.torques, SpinDecay(ball.inertia, ball.radius, rate, wind_in(air))])
