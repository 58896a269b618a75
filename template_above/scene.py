"""A putt on a minigolf lane, seen from above: past a block, off the boards and into the cup.

Models: sliding on felt until the ball rolls, rolling, bouncing off boards and block, and a cup that catches the ball.
Leaves out: slopes; the cup's lip, which a fast ball would jump over.
"""

from __future__ import annotations

from itertools import pairwise
from math import dist

from sandbox.kit import (
    ENDED,
    Ball,
    Cloth,
    Controls,
    Directed,
    Fact,
    Group,
    Handle,
    Run,
    SceneParameters,
    SceneRun,
    Segment,
    Setup,
    Surface,
    Trap,
    group,
    quantity,
    rectangle,
)

MASS, RADIUS, FROM_END = 0.0459, 0.02135, 0.4  # of a golf ball, in kg and m; of tee and cup from the ends, in m


# Parameters: quantity(default, unit, lowest, highest, meaning). A default of ... is in template_above.toml.
class Putt(Directed):
    """The ball as it leaves the putter."""

    speed: float = quantity(..., "m/s", 0, 20, "ball speed")
    angle: float = quantity(..., "deg", -180, 180, "direction, to the left of straight along the lane")
    roll: float = quantity(..., "", -1, 1, "share of its roll that the ball has at once; 1 does not slide at all")


class Lane(Group):
    """The lane, its middle the origin; the tee is at one end, the cup near the other."""

    length: float = quantity(..., "m", 1, 50, "between the boards at its ends")
    width: float = quantity(..., "m", 0.3, 20, "between the boards at its sides")
    block: float = quantity(..., "m", 0.05, 10, "width of the block in the middle")
    felt: float = quantity(..., "", 0.001, 1, "deceleration of a rolling ball over gravity")


class Parameters(SceneParameters):
    """All parameters of a putt."""

    launch: Putt = group(..., "the ball as it leaves the putter")
    lane: Lane = group(..., "the lane")


CONTROLS = Controls(handles=(Handle(y="lane.block", at=lambda p: (0.0, 0.5 * p.lane.block)),), scores="holed")


def build(parameters: Parameters) -> Setup:
    """Return what the engine simulates: the ball, boards and block, the felt, and the cup."""
    launch, lane, (vx, vy) = parameters.launch, parameters.lane, parameters.launch.velocity
    x, y = 0.5 * lane.length, 0.5 * lane.width
    roll = (-launch.roll * vy / RADIUS, launch.roll * vx / RADIUS)  # rad/s, about x and about y
    shapes = [("board", Segment(*ends)) for ends in pairwise(rectangle(-x, -y, x, y))]
    shapes.append(("block", Segment((0.0, -0.5 * lane.block), (0.0, 0.5 * lane.block), 0.04)))
    return Setup(
        [Ball("ball", MASS, RADIUS, (FROM_END - x, 0.0), (vx, vy), rolling_spin=roll)],
        [Surface(name, shape, restitution=0.75, friction=0.2) for name, shape in shapes],
        plane=Cloth(sliding=0.4, rolling=lane.felt, spinning=0.01),
        traps=[Trap("cup", (x - FROM_END, 0.0), 0.054)],
    )


def _to_cup(run: Run, parameters: Parameters) -> float | None:
    """Return the distance in m from the ball at rest to the cup; None if it is in the cup."""
    stop, cup = run.state("ball", run.duration)[:2], run.setup.traps[0].center
    return None if run.caught_at("ball") is not None else dist(stop, cup)


# Fact(key, label, unit, compute): the card, JSON, pictures, the window and charts are made from this list.
FACTS = (
    Fact("to_cup", "to the cup", "m", _to_cup),
    Fact("bounces", "bounces", "", lambda run, _: sum(event.kind == "impact" for event in run.events)),
    Fact("time", "time", "s", lambda run, _: run.duration),
    Fact("holed", "", "", lambda run, _: run.caught_at("ball") is not None),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Say what happened in a sentence."""
    return "In the cup" if run.result["holed"] else f"Stops {run.result['to_cup']:.2f} m from the cup"
