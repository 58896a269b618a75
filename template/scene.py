"""A ball tossed across a hall, over a fan in the floor.

Models: gravity; drag, and Magnus lift where it is asked for; the fan's push; bouncing, sliding and rolling.
Leaves out: everything sideways; how the fan's air spreads as it rises.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin
from typing import Any

from sandbox.aerodynamics import Air, ConstantDrag, ConstantLift, NoDrag, NoLift, SpinRatioLift, aerodynamic_forces

from sandbox.engine.run import Run
from sandbox.engine.setup import HOLLOW_SPHERE, Ball, Segment, Setup, Surface
from sandbox.parameters import Accuracy, Group, either, group, quantity
from sandbox.physics.forces import Gravity
from sandbox.sport.controls import Controls, Spin
from sandbox.sport.facts import ENDED, Fact, once
from sandbox.sport.readings import LAUNCH, RPM, Moment, at, before

# --------------------------------------------------------------------------------------------------------- parameters
# quantity(default, unit, lowest, highest, meaning) is all that the file, --set, the sliders and sweep need to know.


class Launch(Group):
    """The ball as it leaves the hand."""

    speed: float = quantity(10.0, "m/s", 0, 340, "ball speed")
    angle: float = quantity(62.0, "deg", -90, 180, "direction above the horizontal")
    spin: float = quantity(60.0, "rpm", -20000, 20000, "backspin positive")
    height: float = quantity(1.8, "m", 0, 100, "of the ball's centre above the floor, or lying on it if that is higher")


class BallParameters(Group):
    """The ball, a hollow sphere."""

    mass: float = quantity(0.27, "kg", 0.001, 10, "mass")
    radius: float = quantity(0.105, "m", 0.01, 0.5, "radius")
    drag: ConstantDrag | NoDrag = either(ConstantDrag(coefficient=0.45), "drag of the air")
    lift: NoLift | ConstantLift | SpinRatioLift = either(NoLift(), "Magnus lift")


class FanParameters(Group):
    """The fan in the floor."""

    place: float = quantity(6.0, "m", -100, 100, "from the hand to the fan's middle")
    width: float = quantity(0.8, "m", 0.05, 50, "from the middle to where the push is half as strong")
    push: float = quantity(4.0, "N", 0, 100, "force on the ball over the middle")


class Floor(Group):
    """The floor, with a mat to hit."""

    restitution: float = quantity(0.7, "", 0, 1, "of ball and floor")
    friction: float = quantity(0.5, "", 0, 10, "of ball and floor")
    rolling_resistance: float = quantity(0.1, "", 0, 10, "deceleration of a rolling ball over gravity")
    mat: float = quantity(10.0, "m", -100, 100, "from the hand to the middle of the mat")
    mat_length: float = quantity(1.5, "m", 0, 100, "length of the mat")


class Parameters(Group):
    """All numbers of a toss."""

    launch: Launch = group(Launch(), "the ball as it leaves the hand")
    gravity: float = quantity(9.81, "m/s^2", 0, 30, "gravity")
    air: Air = group(Air(), "the air")
    ball: BallParameters = group(BallParameters(), "the ball")
    fan: FanParameters = group(FanParameters(), "the fan")
    floor: Floor = group(Floor(), "the floor")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


#: What a pull of the mouse and the wheel set in the window, and which sliders come first.
CONTROLS = Controls(
    strongest=20.0,
    spins=(Spin("launch.spin", 20.0),),
    sliders=("launch.height", "fan.place", "fan.push", "air.wind", "floor.restitution"),
    scores="hit",
)


# -------------------------------------------------------------------------------------------------------------- build


@dataclass(frozen=True)
class Fan:
    """A force of our own: upwards, ``F = push / (1 + ((x - place) / width)^2)``.

    The engine asks it for newtons at a time t (s), position (m), velocity (m/s) and spin (rad/s, counter-clockwise):
    floats for one ball, arrays when a sweep lets many fly at once. So use arithmetic that works on both.
    """

    place: float  # m
    width: float  # m
    push: float  # N

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        x, _ = position
        return 0.0, self.push / (1.0 + ((x - self.place) / self.width) ** 2)


def build(parameters: Parameters) -> Setup:
    """What the engine simulates: balls with their forces, surfaces, and when the run is over."""
    launch, ball, floor = parameters.launch, parameters.ball, parameters.floor
    angle = radians(launch.angle)
    tossed = Ball(
        "ball",
        ball.mass,
        ball.radius,
        position=(0.0, max(launch.height, ball.radius)),
        velocity=(launch.speed * cos(angle), launch.speed * sin(angle)),
        spin=launch.spin * RPM,
        inertia_factor=HOLLOW_SPHERE,
        forces=[
            Gravity(ball.mass, parameters.gravity),
            *aerodynamic_forces(parameters.air, ball.radius, ball.drag, ball.lift),
            Fan(parameters.fan.place, parameters.fan.width, parameters.fan.push),
        ],
    )
    ground = Surface(
        "floor", Segment((-1e4, 0.0), (1e4, 0.0)), floor.restitution, floor.friction, floor.rolling_resistance
    )
    return Setup([tossed], [ground], duration=20.0)


# -------------------------------------------------------------------------------------------------------------- facts
# Fact(key, label, unit, how): how(run, parameters) reads it from the run; None for what did not happen. The card, JSON,
# pictures, the window and charts follow from this list, the most important first.


@once
def landing(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it first comes down on the floor."""
    return next((before(run, event.t) for event in run.events if event.partner == "floor"), None)


def _hit(run: Run, parameters: Parameters) -> bool:
    landed, floor = landing(run, parameters), parameters.floor
    return landed is not None and abs(landed.x - floor.mat) <= 0.5 * floor.mat_length


FACTS = (
    Fact("distance", "distance", "m", at(landing, lambda ball: ball.x), settled="floor"),
    Fact("apex", "apex", "m", lambda run, parameters: run.highest("ball")[1][1]),
    Fact("flight_time", "flight time", "s", at(landing, lambda ball: ball.t), settled="floor"),
    Fact("landing_speed", "landing speed", "m/s", at(landing, lambda ball: ball.speed), settled="floor"),
    *LAUNCH,
    Fact("hit", "", "", _hit, settled="floor"),
    ENDED,
)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
    return "On the mat" if run.result["hit"] else "Beside the mat"
