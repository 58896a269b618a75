"""Volleyball from the side: serves, spikes and sets, over the net and into the court or not.

Models: gravity; drag with its crisis; Magnus lift; net and floor as things to hit.
Leaves out: everything sideways, and with it the wobble of a float serve; the deformation of the net; players who touch
the ball; the ball's loss of spin. Lift equal to the spin ratio is assumed: of Kao, Sellens & Stevenson 1994 (J. Appl.
Biomech. 10:95), who measured it, and of Tamaru et al. 2021 (drag from 4 to 30 m/s) only the abstracts could be read.
"""

from __future__ import annotations

from sandbox.kit import (
    ENDED,
    LAUNCH,
    Controls,
    Fact,
    Handle,
    Launch,
    RequestError,
    Setup,
    Sphere,
    Spin,
    Spread,
    Surface,
    group,
    level,
    maximum,
    quantity,
)
from sandbox.physics.coefficients import VOLLEYBALL_DRAG
from sandbox.sport import net_game
from sandbox.sport.readings import coefficient_at_start


class Volleyball(Sphere, drag=VOLLEYBALL_DRAG):
    """The ball, a hollow sphere."""


class Hit(Launch):
    """The ball as it leaves the hand."""

    place: float = quantity(..., "m", -20, 30, "from the player's own end line towards the net")
    height: float = quantity(..., "m", 0, 10, "of the ball's centre above the floor")


class Parameters(net_game.NetGame):
    """All parameters of a shot."""

    launch: Hit = group(..., "the ball as it leaves the hand")
    ball: Volleyball = group(..., "the ball")


CONTROLS = Controls(
    full_pull_speed=35.0,
    spins=(Spin("launch.spin", 30.0),),
    sliders=("launch.place", "launch.height", "net.height", "court.length", "air.wind"),
    handles=(Handle("launch.place", "launch.height"), *net_game.HANDLES),
    scores="in",
    spread=(Spread("launch.speed", 0.03), Spread("launch.angle", minimum=1.0), Spread("launch.spin", 0.1)),  # assumed
)


def build(parameters: Parameters) -> Setup:
    """Ball, net and floor, where the run ends. Raises RequestError if the ball begins in the net."""
    launch, ball, middle = parameters.launch, parameters.ball, parameters.middle
    start = maximum(launch.height, ball.radius)
    if abs(launch.place - middle) <= ball.radius + 0.01 and start - ball.radius < parameters.net.height:
        raise RequestError(f"launch.place = {launch.place:g} m puts the ball on the net, at {middle:g} m: move it away")
    floor = Surface("floor", level(), parameters.court.restitution, parameters.court.friction)
    hit = parameters.launched((launch.place, start))
    return Setup([hit], [floor, net_game.net_of(parameters)], 20.0, net_game.Bounces())


FACTS = (
    *net_game.FACTS,
    *LAUNCH,
    Fact("drag_coefficient", "", "", coefficient_at_start("drag"), "start"),
    Fact("lift_coefficient", "", "", coefficient_at_start("lift"), "start"),
    ENDED,
)
verdict = net_game.verdict
