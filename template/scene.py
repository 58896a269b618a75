"""A ball tossed across a hall, over a fan in the floor.

Models: gravity; drag, and Magnus lift where it is asked for; the fan's push; bouncing, sliding and rolling.
Leaves out: everything sideways; how the fan's air spreads as it rises.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sandbox.engine.run import Run
from sandbox.engine.setup import Segment, Setup, Surface
from sandbox.parameters import Accuracy, Group, either, group, quantity
from sandbox.sport.air import Air, ConstantDrag, ConstantLift, NoDrag, NoLift, SpinRatioLift
from sandbox.sport.controls import Controls, Spin
from sandbox.sport.facts import ENDED, Fact, once
from sandbox.sport.flight import Launch, Sphere, forces_in_flight, launched_ball
from sandbox.sport.readings import LAUNCH, Moment, at, before

# Parameters: quantity(default, unit, lowest, highest, meaning). A default of ... is in template.toml.


class Toss(Launch):
    """The ball as it leaves the hand."""

    height: float = quantity(..., "m", 0, 100, "of the ball's centre above the floor, or lying on it if that is higher")


class Ball(Sphere):
    """The ball, a hollow sphere."""

    drag: ConstantDrag | NoDrag = either(..., "drag of the air")
    lift: NoLift | ConstantLift | SpinRatioLift = either(..., "Magnus lift")


class FanParameters(Group):
    """The fan in the floor."""

    place: float = quantity(..., "m", -100, 100, "from the hand to the fan's middle")
    width: float = quantity(..., "m", 0.05, 50, "from the middle to where the push is half as strong")
    push: float = quantity(..., "N", 0, 100, "force on the ball over the middle")


class Floor(Group):
    """The floor, with a mat to hit."""

    restitution: float = quantity(..., "", 0, 1, "of ball and floor")
    friction: float = quantity(..., "", 0, 10, "of ball and floor")
    rolling_resistance: float = quantity(..., "", 0, 10, "deceleration of a rolling ball over gravity")
    mat: float = quantity(..., "m", -100, 100, "from the hand to the middle of the mat")
    mat_length: float = quantity(..., "m", 0, 100, "length of the mat")


class Parameters(Group):
    """All numbers of a toss."""

    launch: Toss = group(..., "the ball as it leaves the hand")
    gravity: float = quantity(..., "m/s^2", 0, 30, "gravity")
    air: Air = group(..., "the air")
    ball: Ball = group(..., "the ball")
    fan: FanParameters = group(..., "the fan")
    floor: Floor = group(..., "the floor")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


CONTROLS = Controls(
    strongest=20.0,  # m/s, of a full pull with the mouse
    spins=(Spin("launch.spin", 20.0),),
    sliders=("launch.height", "fan.place", "fan.push", "air.wind", "floor.restitution"),
    scores="hit",
)


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
        return 0.0, self.push / (1.0 + ((position[0] - self.place) / self.width) ** 2)


def build(parameters: Parameters) -> Setup:
    """What the engine simulates: balls with their forces, surfaces, and when the run is over."""
    ball, fan, floor = parameters.ball, parameters.fan, parameters.floor
    forces = [*forces_in_flight(ball, parameters.air, parameters.gravity), Fan(fan.place, fan.width, fan.push)]
    tossed = launched_ball(parameters.launch, ball, (0.0, max(parameters.launch.height, ball.radius)), forces)
    ground = Segment((-1e4, 0.0), (1e4, 0.0))
    surface = Surface("floor", ground, floor.restitution, floor.friction, floor.rolling_resistance)
    return Setup([tossed], [surface], duration=20.0)


@once  # several facts read it
def landing(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it first comes down on the floor."""
    return next((before(run, event.t) for event in run.events if event.partner == "floor"), None)


def hit(run: Run, parameters: Parameters) -> bool:
    """Whether it comes down on the mat."""
    landed, floor = landing(run, parameters), parameters.floor
    return landed is not None and abs(landed.x - floor.mat) <= 0.5 * floor.mat_length


#: Fact(key, label, unit, how): what a run says of itself, the most important first; None for what did not happen.
FACTS = (
    Fact("distance", "distance", "m", at(landing, lambda ball: ball.x), settled="floor"),
    Fact("apex", "apex", "m", lambda run, parameters: run.highest("ball")[1][1]),
    Fact("flight_time", "flight time", "s", at(landing, lambda ball: ball.t), settled="floor"),
    Fact("landing_speed", "landing speed", "m/s", at(landing, lambda ball: ball.speed), settled="floor"),
    *LAUNCH,
    Fact("hit", "", "", hit, settled="floor"),
    ENDED,
)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
    return "On the mat" if run.result["hit"] else "Beside the mat"
