"""The bench of a mechanics course: balls that meet, two or many, elastic or not, smooth or rough.

Models: impulses for a lone pair, Hertz's contact law where others are reached; friction; gravity; a floor or a bowl,
and balls that lie on one another; drag in the wind; strings of a cradle.
Leaves out: the third dimension; the rise of a ball on its string, 0.4 % of a swing's time at 15 deg; lift.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import cos, hypot, pi, radians, sin
from typing import Any, Literal, NamedTuple

from sandbox.engine.run import Run
from sandbox.engine.setup import Always, Ball, Bounce, ContactModel, Segment, Setup, Surface, kinetic
from sandbox.engine.track import PRESSED
from sandbox.parameters import Accuracy, Group, choice, group, groups, quantity
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity
from sandbox.physics.hertz import PHENOLIC, STEEL
from sandbox.sport.air import Air, wind_in
from sandbox.sport.controls import Controls, Handle
from sandbox.sport.facts import ENDED, Fact, once

SPHERE_DRAG = 0.47  # of a smooth sphere before its drag crisis (Clift, Grace & Weber 1978)


class Body(Group):
    """A ball on the bench."""

    mass: float = quantity(..., "kg", 1e-3, 100, "mass")
    radius: float = quantity(..., "m", 0.001, 1, "radius")
    x: float = quantity(..., "m", -50, 50, "of its centre, to the right")
    y: float = quantity(..., "m", -50, 50, "of its centre, upward, or across a level bench")
    speed: float = quantity(..., "m/s", 0, 50, "at the start")
    angle: float = quantity(..., "deg", -180, 180, "of its way, from +x counter-clockwise")


class Other(Body):
    """A ball that is met: what is left out is that of a pool ball at rest."""

    mass: float = quantity(0.17, "kg", 1e-3, 100, "mass")
    radius: float = quantity(0.028575, "m", 0.001, 1, "radius")
    x: float = quantity(0.0, "m", -50, 50, "of its centre, to the right")
    y: float = quantity(0.0, "m", -50, 50, "of its centre, upward, or across a level bench")
    speed: float = quantity(0.0, "m/s", 0, 50, "at the start")
    angle: float = quantity(0.0, "deg", -180, 180, "of its way, from +x counter-clockwise")


class Meeting(Group):
    """What happens between two balls."""

    restitution: float = quantity(..., "", 0, 1, "speed apart over speed of approach: 1 elastic, 0 inelastic")
    friction: float = quantity(..., "", 0, 10, "of the balls: 0 smooth")
    model: Literal["auto", "rigid", "hertz"] = choice(..., "contact mechanics where it matters, never, or always")
    material: Literal["phenolic", "steel"] = choice(..., "how stiff they are")


class Floor(Group):
    """What lies below."""

    shape: Literal["none", "flat", "bowl"] = choice(..., "a level bench needs none; a floor or a bowl at y = 0")
    radius: float = quantity(..., "m", 0.01, 50, "of the bowl")
    restitution: float = quantity(..., "", 0, 1, "of ball and floor")
    friction: float = quantity(..., "", 0, 10, "of ball and floor")
    resistance: float = quantity(..., "", 0, 1, "to rolling: deceleration over the acceleration that presses it on")


class Parameters(Group):
    """All parameters of a collision."""

    first: Body = group(..., "the ball that is played")
    others: list[Other] = groups(..., "the balls that it meets: second, 3, 4, ...")
    meet: Meeting = group(..., "between balls")
    floor: Floor = group(..., "what lies below")
    gravity: float = quantity(..., "m/s^2", 0, 30, "gravity, along -y; none along a level bench")
    strings: float = quantity(..., "m", 0, 50, "length of the strings of a cradle, in which the others hang; 0: none")
    air: Air = group(..., "the air; without density where it does not matter")
    duration: float = quantity(..., "s", 0.01, 60, "shown at most")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


CONTROLS = Controls(
    speed="first.speed",
    angle="first.angle",
    strongest=10.0,
    ball="first",
    handles=(Handle("first.x", "first.y"), Handle("others[*].x", "others[*].y")),
    sliders=("meet.restitution", "meet.friction", "first.mass", "first.y", "floor.restitution"),
)


@dataclass(frozen=True)
class String:
    """Draws a ball along x to where it hangs, as a pendulum does in small swings: ``F = -k (x - x0)``, k = m g / L."""

    place: float  # m
    stiffness: float  # N/m

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return -self.stiffness * (position[0] - self.place), 0.0


def hangs(it: Parameters) -> list[float]:
    """Where the balls of a cradle hang along x, in m: the others where they begin, the first ball beside the second."""
    others = [body.x for body in it.others]
    return [others[0] - it.first.radius - it.others[0].radius, *others] if others else [it.first.x]


def build(parameters: Parameters) -> Setup:
    """The balls, each with its forces, and what lies below."""
    it, balls = parameters, list[Ball]()
    bodies: list[Body] = [it.first, *it.others]
    for number, (body, hung) in enumerate(zip(bodies, hangs(it), strict=True), 1):
        forces: list[Any] = [Gravity(body.mass, it.gravity)] if it.gravity and not it.strings else []
        if it.strings:
            forces.append(String(hung, body.mass * it.gravity / it.strings))
        if it.air.density:
            forces.append(
                Drag(body.radius, it.air.density, Constant(SPHERE_DRAG), wind_in(it.air), viscosity=it.air.viscosity)
            )
        way = body.speed * cos(radians(body.angle)), body.speed * sin(radians(body.angle))
        name = {1: "first", 2: "second"}.get(number, str(number))
        balls.append(Ball(name, body.mass, body.radius, (body.x, body.y), way, forces=forces))
    floor, meet = it.floor, it.meet
    turns = [pi * part / 40 for part in range(41)]
    rim = [(-floor.radius * cos(turn), floor.radius * (1.0 - sin(turn))) for turn in turns]
    corners = {"none": [], "flat": [(-100.0, 0.0), (100.0, 0.0)], "bowl": rim}[floor.shape]
    surfaces = [
        Surface("floor", Segment(*ends), floor.restitution, floor.friction, floor.resistance)
        for ends in pairwise(corners)
    ]
    material = STEEL if meet.material == "steel" else PHENOLIC
    model = ContactModel(meet.model, material.between(*(body.radius for body in [*bodies, it.first][:2])))
    return Setup(
        balls, surfaces, it.duration, between_balls=Always(Bounce(meet.restitution, meet.friction)), contact=model
    )


States = dict[str, tuple[float, ...]]


class Blow(NamedTuple):
    """The first time that two balls meet: their names, left to right, and the states of all before and after it."""

    pair: list[str]
    before: States
    after: States

    @property
    def line(self) -> tuple[float, float]:
        """Unit vector along the line of action."""
        (x, y, *_), (u, v, *_) = (self.before[name] for name in self.pair)
        return (u - x) / hypot(u - x, v - y), (v - y) / hypot(u - x, v - y)

    def closing(self, states: States) -> float:
        """Speed in m/s at which the two approach along the line of action; negative where they part."""
        (_, _, ux, uy, _), (_, _, vx, vy, _) = (states[name] for name in self.pair)
        return (ux - vx) * self.line[0] + (uy - vy) * self.line[1]


@once
def blow(run: Run, parameters: Parameters) -> Blow | None:
    """The first blow, through to the end of the contact; None if no two balls meet."""
    names = [ball.name for ball in run.setup.balls]
    event = next((e for e in run.events if e.kind == "impact" and e.partner in names), None)
    if event is None:
        return None
    ends = [
        arc.t1 for name in names for arc in run.arcs[name] if arc.contact == PRESSED and arc.t0 <= event.t <= arc.t1
    ]
    before, after = (
        {name: how(name, t) for name in names}
        for how, t in ((run.before, event.t), (run.state, max(ends, default=event.t)))
    )
    return Blow(sorted((event.ball, event.partner), key=lambda name: before[name][0]), before, after)


def momentum(run: Run, states: States, axis: int) -> list[float]:
    """Of each ball along x (0) or y (1), in kg m/s."""
    return [ball.mass * states[ball.name][2 + axis] for ball in run.setup.balls]


def energy(run: Run, states: States) -> list[float]:
    """Kinetic energy of each ball, including rotation, in J."""
    return [kinetic(ball, states[ball.name]) for ball in run.setup.balls]


def _of(what: Any) -> Any:
    return lambda run, parameters: None if (met := blow(run, parameters)) is None else what(run, met)


def _share(had: float, has: float) -> float:
    """How much of what there was is not there any more, in %."""
    return round(100.0 * (1.0 - has / had), 9) if had > 0.0 else 0.0


FACTS = (
    Fact("lost", "energy lost", "%", _of(lambda run, met: _share(*(sum(energy(run, it)) for it in met[1:])))),
    Fact("approach", "approach", "m/s", _of(lambda run, met: met.closing(met.before))),
    Fact("separation", "separation", "m/s", _of(lambda run, met: -met.closing(met.after))),
    Fact("first_after", "first ball", "m/s", _of(lambda run, met: hypot(*met.after["first"][2:4]))),
    Fact("fastest", "fastest", "m/s", _of(lambda run, met: max(hypot(*state[2:4]) for state in met.after.values()))),
    ENDED,
)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
    said = run.result
    if said["lost"] is None:
        return "No two balls meet"
    loss = "nothing is lost" if said["lost"] < 0.05 else f"{said['lost']:.0f} % lost"
    rest = ", all at rest in the end" if said["ended"] == "rest" else ""
    return f"{said['approach']:.2f} m/s together, {said['separation']:.2f} apart; {loss}{rest}"
