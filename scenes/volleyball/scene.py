"""Volleyball from the side: serves, spikes and sets, over the net and into the court or not.

Models: gravity; drag with its crisis; Magnus lift; net and floor as things to hit.
Leaves out: everything sideways, and with it the wobble of a float serve; the deformation of the net; players who touch
the ball; the ball's loss of spin.
"""

from __future__ import annotations

from typing import Any, Literal

from sandbox.engine.run import Run
from sandbox.engine.setup import Segment, Setup, Surface
from sandbox.errors import RequestError
from sandbox.parameters import Accuracy, Group, choice, either, group, quantity
from sandbox.physics.coefficients import Coefficient
from sandbox.physics.elementwise import clip, exp
from sandbox.sport.air import Air, ConstantDrag, ConstantLift, Model, NoDrag, NoLift, SpinRatioLift
from sandbox.sport.controls import Controls, Handle, Spin, Spread
from sandbox.sport.facts import ENDED
from sandbox.sport.flight import Launch, Sphere, forces_in_flight, launched_ball
from sandbox.sport.net_game import NET_HANDLES, Bounces, Court, Net, net_facts, net_of, sentence
from sandbox.sport.readings import LAUNCH


class Hit(Launch):
    """The ball as it leaves the hand."""

    place: float = quantity(..., "m", -20, 30, "from the player's own end line towards the net")
    height: float = quantity(..., "m", 0.2, 10, "of the ball's centre above the floor")


class CrisisDrag(Model):
    """Drag of a volleyball, which falls as its boundary layer turns turbulent."""

    model: Literal["hong"] = choice(..., "drag coefficient by its source")

    def coefficient_law(self) -> Coefficient:
        return hong_drag


class Volleyball(Sphere):
    """The ball, a hollow sphere."""

    drag: CrisisDrag | ConstantDrag | NoDrag = either(..., "drag of the air")
    lift: SpinRatioLift | ConstantLift | NoLift = either(..., "Magnus lift")


class Parameters(Group):
    """All parameters of a shot."""

    launch: Hit = group(..., "the ball as it leaves the hand")
    gravity: float = quantity(..., "m/s^2", 0, 30, "gravity")
    air: Air = group(..., "the air")
    ball: Volleyball = group(..., "the ball")
    net: Net = group(..., "the net")
    court: Court = group(..., "the court")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


CONTROLS = Controls(
    strongest=35.0,
    spins=(Spin("launch.spin", 30.0),),
    sliders=("launch.place", "launch.height", "net.height", "court.length", "air.wind"),
    handles=(Handle("launch.place", "launch.height"), *NET_HANDLES),
    scores="in",
    spread=(Spread("launch.speed", 0.03), Spread("launch.angle", least=1.0), Spread("launch.spin", 0.1)),  # assumed
)


def hong_drag(reynolds: Any, spin_ratio: Any) -> Any:
    """0.47 for a slow ball, 0.16 for a fast one, past the drag crisis at Re = 2.3e5 (16 m/s).

    After Hong, Ozaki, Watanabe & Asai 2020, Appl. Sci. 10:3256 (Mikasa V200W: 0.15 to 0.17 at Re = 2.6e5 to 2.9e5);
    the curve between is our own fit.
    """
    return 0.16 + 0.31 / (1.0 + exp(clip((reynolds - 2.3e5) / 0.2e5, -50.0, 50.0)))


def build(parameters: Parameters) -> Setup:
    """Ball, net and floor, where the run ends. Raises RequestError if the ball begins in the net."""
    launch, ball, net, court = parameters.launch, parameters.ball, parameters.net, parameters.court
    middle, start = 0.5 * court.length, max(launch.height, ball.radius)
    if abs(launch.place - middle) <= ball.radius + 0.01 and start - ball.radius < net.height:
        raise RequestError(f"launch.place = {launch.place:g} m puts the ball on the net, at {middle:g} m: move it away")
    forces = forces_in_flight(ball, parameters.air, parameters.gravity)
    hit = launched_ball(launch, ball, (launch.place, start), forces)
    floor = Surface("floor", Segment((-1e4, 0.0), (1e4, 0.0)), court.restitution, court.friction)
    return Setup([hit], [floor, net_of(parameters)], 20.0, Bounces())


FACTS = (*net_facts(lambda parameters: parameters.court.length), *LAUNCH, ENDED)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
    return sentence(run, parameters, parameters.court.length, "end line")
