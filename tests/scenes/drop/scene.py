"""A ball dropped on the floor: the smallest scene there can be, for tests of everything around scenes.

Models: gravity, bounces. Leaves out: air.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.parameters import Group, SceneParameters, choice, group, groups, one_of, quantity, switch, vector
from sandbox.sport.facts import Fact


class Throw(Group):
    height: float = quantity(2.0, "m", low=0.1, high=100, meaning="of the ball's centre above the floor")
    speed: float = quantity(0.0, "m/s", low=0, high=340, meaning="upwards")
    spin: float = quantity(0.0, "rpm", low=-20000, high=20000, meaning="backspin")
    angle: float = quantity(90.0, "deg", low=-90, high=180, meaning="above the horizontal")


class NoDrag(Group):
    model: Literal["none"] = choice("none", "no drag at all")


class ConstantDrag(Group):
    model: Literal["constant"] = choice("constant", "one coefficient for all speeds")
    coefficient: float = quantity(0.47, "", low=0, high=5, meaning="drag coefficient")


class DroppedBall(Group):
    mass: float = quantity(0.1, "kg", low=1e-6, high=1e3, meaning="mass")
    radius: float = quantity(0.05, "m", low=1e-4, high=10, meaning="radius")
    drag: NoDrag | ConstantDrag = one_of(NoDrag(), "drag of the air")


class Air(Group):
    temperature: float = quantity(20.0, "C", low=-90, high=60, meaning="of the air")
    wind: tuple[float, float] = vector((0.0, 0.0), "m/s", low=-100, high=100, meaning="along x and y")


class Floor(Group):
    restitution: float = quantity(0.8, "", low=0, high=1, meaning="of the pair ball and floor")
    present: bool = switch(True, "whether there is a floor")


class Marker(Group):
    name: str = "mark"
    x: float = quantity(0.0, "m", low=-10, high=10, meaning="where it lies")


class Parameters(SceneParameters):
    gravity: float = quantity(9.81, "m/s^2", low=0, high=30, meaning="downwards")
    duration: float = quantity(1.0, "s", low=0.01, high=100, meaning="of the run")
    launch: Throw = group(Throw(), "how the ball starts")
    ball: DroppedBall = group(DroppedBall(mass=0.2), "the ball")
    air: Air = group(Air(), "the air")
    floor: Floor = group(Floor(), "the floor")
    marks: list[Marker] = groups([], "what lies about")


@dataclass(frozen=True)
class Gravity:
    """Force in N on a mass in kg."""

    mass: float
    gravity: float

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return 0.0 * velocity[0], -self.mass * self.gravity + 0.0 * velocity[1]


def build(parameters: Parameters) -> Setup:
    ball = Ball(
        "ball",
        parameters.ball.mass,
        parameters.ball.radius,
        (0.0, parameters.launch.height),
        (0.0, parameters.launch.speed),
        forces=(Gravity(parameters.ball.mass, parameters.gravity),),
    )
    floor = Surface("floor", Segment((-100.0, 0.0), (100.0, 0.0)), parameters.floor.restitution, friction=0.5)
    return Setup((ball,), (floor,) if parameters.floor.present else (), duration=parameters.duration)


def first_touch(run: Any, parameters: Parameters) -> float | None:
    return next((event.t for event in run.events if event.kind == "impact"), None)


def bounces(run: Any, parameters: Parameters) -> int:
    return sum(event.kind == "impact" for event in run.events)


FACTS = (
    Fact("bounces", "bounces", "", bounces),
    Fact("first_touch", "", "", first_touch),
    Fact("bounced", "", "", lambda run, parameters: bounces(run, parameters) > 0),
    Fact("final_height", "final height", "m", lambda run, parameters: float(run.state("ball", run.duration)[1])),
)


def verdict(run: Any, parameters: Parameters) -> str:
    return "Bounced" if run.result["bounced"] else "Fell"
