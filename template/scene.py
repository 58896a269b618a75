"""A ball tossed across a hall, over a fan in the floor.

Models: gravity; drag, and Magnus lift where it is asked for; the fan's push; the first bounces.
Leaves out: everything sideways; how the fan's air spreads as it rises.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sandbox.kit import (
    ENDED,
    LAUNCH,
    Controls,
    Fact,
    Flight,
    Group,
    Handle,
    Launch,
    SceneRun,
    Setup,
    Solid,
    Spin,
    Touches,
    apex,
    fact_from,
    first_contact_with,
    group,
    level,
    quantity,
    roughly,
)


# Parameters: quantity(default, unit, lowest, highest, meaning). A default of ... is in template.toml.
class Toss(Launch):
    """The ball as it leaves the hand."""

    height: float = quantity(..., "m", 0, 100, "of the ball's centre above the floor, or lying on it if that is higher")


class FanParameters(Group):
    """The fan in the floor."""

    place: float = quantity(..., "m", -100, 100, "from the hand to the fan's middle")
    width: float = quantity(..., "m", 0.05, 50, "from the middle to where the push is half as strong")
    push: float = quantity(..., "N", 0, 100, "force on the ball over the middle")


class Parameters(Flight):
    """All numbers of a toss; a Flight has launch, gravity, air and ball."""

    launch: Toss = group(..., "the ball as it leaves the hand")
    fan: FanParameters = group(..., "the fan")
    floor: Solid = group(..., "the floor")


CONTROLS = Controls(full_pull_speed=20.0, spins=(Spin("launch.spin", 20.0),), handles=(Handle("fan.place"),))


@dataclass(frozen=True)
class Fan:
    """A force of our own: upwards, ``F = push / (1 + ((x - place) / width)^2)``; floats, or arrays for many balls."""

    place: float  # m
    width: float  # m
    push: float  # N

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return 0.0, self.push / (1.0 + ((position[0] - self.place) / self.width) ** 2)


def build(parameters: Parameters) -> Setup:
    """Return what the engine simulates: balls with their forces, surfaces, and when the run is over."""
    fan, start = parameters.fan, max(parameters.launch.height, parameters.ball.radius)
    tossed = parameters.launched((0.0, start), Fan(fan.place, fan.width, fan.push))
    floor = parameters.floor.surface("floor", level())
    return Setup([tossed], [floor], duration=20.0, until=Touches("floor", 4))


landing = first_contact_with("floor")  # the ball just before it first comes down

#: Fact(key, label, unit, compute): the results of a run, the most important first; None for what did not happen.
FACTS = (
    Fact("distance", "distance", "m", fact_from(landing, "x"), final_when="floor"),
    Fact("apex", "apex", "m", apex),
    Fact("flight_time", "flight time", "s", fact_from(landing, "t"), final_when="floor"),
    *LAUNCH,
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Say what happened in a sentence."""
    landed = run.result["distance"]
    return "Never comes down" if landed is None else f"Comes down {roughly(landed)} away"
