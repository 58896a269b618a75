"""The bench of a mechanics course: balls that meet, two or many, elastic or not, smooth or rough.

Models: impulses for a lone pair, Hertz's contact law where others are reached; friction; gravity; a floor or a bowl,
and balls that lie on one another; drag in the wind; strings of a cradle; boxes, ellipses, capsules and bowling pins,
whose blows are impulses at one or two points. With ``stepping.step``, beside the exact run: rules of games that look at
a fixed step, and find two balls that overlap already.
Leaves out: the third dimension; the rise of a ball on its string (only drawn), 0.4 % of a swing's time at 15 deg; lift.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import accumulate, pairwise
from math import cos, dist, hypot, inf, pi, sin, sqrt
from typing import Any, Literal, NamedTuple

from sandbox.engine.contact.manifold import ContactManifold, meeting
from sandbox.engine.model.ball import kinetic
from sandbox.kit import (
    ENDED,
    AirByDensity,
    Ball,
    Constant,
    ContactModel,
    Controls,
    Directed,
    Drag,
    Fact,
    Force,
    Gravity,
    Group,
    Handle,
    RequestError,
    Run,
    SceneParameters,
    SceneRun,
    Setup,
    Solid,
    State,
    Vector,
    cached_per_run,
    choice,
    fact_from,
    group,
    groups,
    quantity,
    text,
    wind_in,
)

from .boxes import TOUCH, Box, Moving, body_of
from .stepping import RULES, Stepped, step_through

SPHERE_DRAG = 0.47  # of a smooth sphere before its drag crisis (Clift, Grace & Weber 1978)


class Body(Moving):
    """A ball on the bench; what is left out is that of a pool ball at rest."""

    spin: float = quantity(0.0, "rad/s", -10000, 10000, "counter-clockwise")
    radius: float = quantity(0.028575, "m", 0.001, 1, "radius")


class Stroke(Directed):
    """The ball that is played."""

    ball: str = text("its name; without a ball of that name none is launched", may_be_empty=True)
    speed: float = quantity(..., "m/s", 0, 50, "speed")
    angle: float = quantity(..., "deg", -180, 180, "direction, from +x counter-clockwise")


class BallContact(Solid):
    """The contact of two balls: restitution 1 is elastic, friction 0 smooth."""

    model: Literal["auto", "rigid", "hertz"] = choice(..., "contact mechanics where it matters, never, or always")
    stiffness: float = quantity(..., "N/m^1.5", 1e3, 1e12, "of a pair of balls")


class Floor(Solid):
    """The floor."""

    shape: Literal["none", "flat", "bowl"] = choice(..., "a level bench needs none; a floor or a bowl at y = 0")
    radius: float = quantity(..., "m", 0.01, 50, "of the bowl")
    resistance: float = quantity(..., "", 0, 1, "to rolling: deceleration over the acceleration that presses it on")


class Stepping(Group):
    """Rules at a fixed step, to compare with the exact run: for two balls alone, smooth, on a level bench."""

    step: float | None = quantity(None, "s", 1e-3, 1, "between two looks whether they overlap; left out: no such rules")
    first: float = quantity(..., "s", 0, 60, "the first step, if it is longer, as when a game stalls")


class Parameters(SceneParameters):
    """All parameters of a collision."""

    TOGETHER = ("balls", "boxes")
    balls: list[Body] = groups(..., "the balls")
    boxes: list[Box] = groups(..., "what is not round: boxes, ellipses, capsules, bowling pins")
    launch: Stroke = group(..., "the ball that is played")
    contact: BallContact = group(..., "between balls")
    floor: Floor = group(..., "what lies below")
    gravity: float = quantity(..., "m/s^2", 0, 100, "gravity, along -y; none along a level bench")
    strings: float = quantity(
        ..., "m", 0, 50, "length of a cradle's strings, in which the balls hang in touch; 0: none"
    )
    air: AirByDensity = group(..., "the air; without density where it does not matter")
    stepping: Stepping = group(..., "rules at a fixed step beside it")
    duration: float = quantity(..., "s", 0.01, 60, "shown at most")


def speed_on_string(it: Parameters, aside: float = 0.0) -> float:
    """The speed in m/s with which a ball of a cradle, so many m aside, swings as high as its string is long: it can be
    thrown no faster. Infinite without strings, or without gravity."""
    if not it.strings or not it.gravity:
        return inf
    return sqrt(max(0.0, it.gravity * (it.strings - aside * aside / it.strings)))


def speed_limit(it: Parameters) -> float:
    """The speed in m/s of the strongest pull at the ball that is played: a little below what its string allows."""
    hung = dict(zip([body.name for body in it.balls], hangs(it), strict=True)) if it.balls else {}
    aside = [abs(body.x - hung[body.name]) for body in it.balls if body.name == it.launch.ball]
    return max(0.01, 0.99 * speed_on_string(it, *aside))


CONTROLS = Controls(
    full_pull_speed=10.0,
    speed_limit=speed_limit,
    ball="launch.ball",
    sliders=(
        *("contact.restitution", "contact.friction", "balls[0].mass", "balls[1].mass"),
        *("launch.speed", "launch.angle", "floor.restitution"),
    ),
    handles=(Handle("balls[*].x", "balls[*].y"),),
)


@dataclass(frozen=True)
class String:
    """Draws a ball along x to where it hangs, as a pendulum does in small swings: ``F = -k (x - x0)``, k = m g / L."""

    place: float  # m
    stiffness: float  # N/m

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return -self.stiffness * (position[0] - self.place), 0.0


def hangs(it: Parameters) -> list[float]:
    """The places along x where the balls of a cradle hang, in m: in touch, the last where it begins."""
    radii = [body.radius for body in reversed(it.balls)]
    return [*accumulate((-a - b for a, b in pairwise(radii)), initial=it.balls[-1].x)][::-1]


def build(it: Parameters) -> Setup:
    """The balls, each with its forces, and what lies below."""
    balls, floor, launch = list[Ball](), it.floor, it.launch
    names = [*(ball.name for ball in it.balls), *(box.name for box in it.boxes)]
    if len({*names}) < len(names) or not names:
        raise RequestError("balls and boxes: needs one at least, and for each a name of its own")
    if it.boxes and it.contact.model == "hertz":
        raise RequestError('contact.model = "hertz": is for balls alone; with boxes it must be "auto" or "rigid"')
    if it.stepping.step is not None:
        _check_bare(it)
    for body, hung in zip(it.balls, hangs(it) if it.balls else (), strict=True):
        weight, forces = body.mass * it.gravity, list[Force]()
        if weight:
            forces.append(String(hung, weight / it.strings) if it.strings else Gravity(it.gravity))
        if it.air.density:
            forces.append(Drag(body.radius, it.air.density, Constant(SPHERE_DRAG), wind_in(it.air)))
        velocity = _velocity(body, launch)
        if it.strings:
            velocity = _on_string(body, hung, velocity, it)
        start = (body.x, body.y), velocity, body.spin
        balls.append(Ball(body.name, body.mass, body.radius, *start, forces=forces))
    for box in it.boxes:
        weight_of_box = [Gravity(it.gravity)] if it.gravity else []
        balls.append(body_of(box, _velocity(box, launch), weight_of_box))
    turns = [pi * part / 40 for part in range(41)]
    rim = [(-floor.radius * cos(turn), floor.radius * (1.0 - sin(turn))) for turn in turns]
    corners = {"none": [], "flat": [(-100.0, 0.0), (100.0, 0.0)], "bowl": rim}[floor.shape]
    return Setup(
        balls,
        floor.outline("floor", corners, rolling_resistance=floor.resistance),
        it.duration,
        between_balls=it.contact.bounce,
        contact=ContactModel(it.contact.model, it.contact.stiffness),
    )


def _check_bare(it: Parameters) -> None:
    """Raise RequestError for what the rules at a fixed step do not have."""
    if len(it.balls) != 2 or it.boxes:
        raise RequestError("stepping.step: must be left out unless there are two balls, and no boxes")
    others = {
        "gravity": it.gravity,
        "strings": it.strings,
        "air.density": it.air.density,
        "contact.friction": it.contact.friction,
        "floor.shape": "" if it.floor.shape == "none" else it.floor.shape,
    }
    if too_much := next((f"{key} = {value}" for key, value in others.items() if value), None):
        raise RequestError(f"{too_much}: the rules of stepping.step have none; leave one of the two out")


def _velocity(it: Moving, launch: Stroke) -> Vector:
    """The velocity at the start in m/s: as listed, or that of the launch."""
    if it.name == launch.ball and it.vx is None and it.vy is None:
        return launch.velocity
    return it.vx or 0.0, it.vy or 0.0


def _on_string(body: Body, hung: float, velocity: Vector, it: Parameters) -> Vector:
    """The velocity in m/s that a string leaves a ball: along x, of a launch the part along it. Raises RequestError for
    a ball above or below the others, one that is thrown up or down, and one that would swing over its string's end."""
    level, who = it.balls[-1].y, f"ball {body.name!r} hangs on a string"
    if body.y != level:
        raise RequestError(f"{who}: y = {body.y:g} m must be {level:g} m, that of the others; to lift it, move x")
    if body.vy:
        raise RequestError(f"{who}: vy = {body.vy:g} m/s must be 0: it moves along x")
    aside, speed = abs(body.x - hung), abs(velocity[0])
    rise = 0.5 * (aside * aside / it.strings + (speed * speed / it.gravity if it.gravity else 0.0))
    if rise > 0.5 * it.strings:
        raise RequestError(
            f"{who} of {it.strings:g} m: {aside:.3g} m aside with {speed:.3g} m/s it swings over the string's end; "
            f"at most {speed_on_string(it):.3g} m/s where it hangs, or {it.strings:g} m aside at rest"
        )
    return velocity[0], 0.0


States = dict[str, State]


class Blow(NamedTuple):
    """The first time that two balls meet: their names, left to right, and the states of all before and after it."""

    pair: list[str]
    before: States
    after: States
    t: float  # s
    run: Run

    def touching(self, states: States) -> ContactManifold:
        """The contact of the two, with the speeds that they have in these states."""
        (one, here), (other, there) = (
            (ball, (*self.before[ball.name][:2], *states[ball.name][2:]))
            for name in self.pair
            for ball in self.run.setup.balls
            if ball.name == name
        )
        return meeting(one, here, other, there, TOUCH)


@cached_per_run
def blow(run: Run, parameters: Parameters) -> Blow | None:
    """The first blow, through to the end of the contact; None if no two balls meet."""
    event = next((e for e in run.events if e.kind == "impact" and e.partner in run.arcs), None)
    if event is None:
        return None
    spans = {arc.contact_span for arcs in run.arcs.values() for arc in arcs if arc.contact_span is not None}
    end = max((end for start, end in spans if start <= event.t <= end), default=event.t)
    before = {name: path.before(event.t).state(event.t) for name, path in run.arcs.items()}
    pair = sorted((event.ball, event.partner), key=lambda name: before[name][0])
    return Blow(pair, before, {name: path.at(end).state(end) for name, path in run.arcs.items()}, event.t, run)


#: What stays, if nothing from outside acts and nothing is lost: its unit, and how much of it a ball has.
#: Angular momentum is about the scene's origin.
AMOUNTS: dict[str, tuple[str, Callable[[Ball, State], float]]] = {
    "momentum x": ("kg m/s", lambda ball, state: ball.mass * state[2]),
    "momentum y": ("kg m/s", lambda ball, state: ball.mass * state[3]),
    "energy": ("J", kinetic),
    "ang. momentum": ("kg m²/s", lambda it, s: it.mass * (s[0] * s[3] - s[1] * s[2]) + it.inertia * s[4]),
}


def shares(run: Run, states: States, what: str) -> list[float]:
    """The share of each ball in one of these amounts."""
    return [AMOUNTS[what][1](ball, states[ball.name]) for ball in run.setup.balls]


@cached_per_run
def stepped(run: Run, parameters: Parameters) -> dict[str, Stepped]:
    """The run of each rule at a fixed step, until the exact one ends; none without ``stepping.step``."""
    it = parameters.stepping
    if it.step is None:
        return {}
    one, other = run.setup.balls
    first = max(it.step, it.first)
    return {
        name: step_through((one, other), parameters.contact.restitution, rule, it.step, first, run.duration)
        for name, rule in RULES.items()
    }


def _exchanges(run: Run, parameters: Parameters) -> dict[str, int] | None:
    """The number of exchanges under each rule, and in the exact run."""
    rules = {name: len(each.exchanges) for name, each in stepped(run, parameters).items()}
    return {**rules, "exact": sum(event.kind == "impact" for event in run.events)} if rules else None


def _gaps(run: Run, parameters: Parameters) -> dict[str, float] | None:
    """The gap of the two at the end under each rule, and in the exact run, in m; negative where they overlap."""
    rules = {name: each.at(run.duration).tolist() for name, each in stepped(run, parameters).items()}
    if not rules:
        return None
    one, other = run.setup.balls
    exact = [run.state(ball.name, run.duration)[:2] for ball in (one, other)]
    return {name: dist(*ends) - one.radius - other.radius for name, ends in {**rules, "exact": exact}.items()}


def _lost(run: Run, parameters: Parameters) -> float | None:
    """The share of the energy before the blow that is lost in it, in %."""
    if (met := blow(run, parameters)) is None:
        return None
    had, has = (sum(shares(run, states, "energy")) for states in (met.before, met.after))
    return round(100.0 * (1.0 - has / had), 9) if had > 0.0 else 0.0


def _falls(run: Run, parameters: Parameters) -> int | None:
    """The number of impacts on the floor, where no two balls meet."""
    return None if blow(run, parameters) else sum(event.kind == "impact" for event in run.events)


def _at_end(part: Callable[[State], Any]) -> Callable[[Run, Parameters], dict[str, Any]]:
    """A part of the state of each ball at the end."""
    return lambda run, parameters: {name: part(run.state(name, run.duration)) for name in run.arcs}


def _sums(what: str) -> tuple[Fact, Fact]:
    """Facts of an amount at the start and at the end: a number, or two along x and y."""
    names = [name for name in AMOUNTS if name.startswith(what)]

    def at_time(run: Run, t: float) -> Any:
        states: States = {name: run.state(name, t) for name in run.arcs}
        found = [sum(shares(run, states, name)) for name in names]
        return found if len(found) > 1 else found[0]

    unit = AMOUNTS[names[0]][0]
    return (
        Fact(f"{what}_before", "", unit, lambda run, parameters: at_time(run, 0.0)),
        Fact(f"{what}_after", "", unit, lambda run, parameters: at_time(run, run.duration)),
    )


FACTS = (
    Fact("lost", "energy lost", "%", _lost),
    Fact("approach", "approach, normal", "m/s", fact_from(blow, lambda met, _: met.touching(met.before).closing)),
    Fact("separation", "separation, normal", "m/s", fact_from(blow, lambda met, _: -met.touching(met.after).closing)),
    Fact(
        "first_after", "first ball", "m/s", fact_from(blow, lambda met, _: hypot(*next(iter(met.after.values()))[2:4]))
    ),
    Fact(
        "fastest",
        "fastest",
        "m/s",
        fact_from(blow, lambda met, _: max(hypot(*state[2:4]) for state in met.after.values())),
    ),
    Fact("falls", "blows of the floor", "", _falls),
    Fact("positions", "", "m", _at_end(lambda state: list(state[:2]))),
    Fact("velocities", "", "m/s", _at_end(lambda state: list(state[2:4]))),
    Fact("spins", "", "rad/s", _at_end(lambda state: state[4])),
    *_sums("energy"),
    *_sums("momentum"),
    Fact("exchanges", "", "", _exchanges),
    Fact("gaps", "", "m", _gaps),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    result = run.result
    if result["exchanges"]:
        return f"Exchanges: {', '.join(f'{name} {count}' for name, count in result['exchanges'].items())}"
    if result["lost"] is None:
        falls = result["falls"]
        rest = ", and comes to rest" if falls and result["ended"] == "rest" else ""
        return f"Strikes the floor {falls} times{rest}" if falls > 1 else "No two balls meet"
    loss = "nothing" if result["lost"] < 0.05 else f"{result['lost']:.0f} %"
    several = sum(event.kind == "impact" for event in run.events) > 1
    when = ", later all of it" if result["ended"] == "rest" else " in the first hit" if several else ""
    return f"{result['approach']:.2f} m/s together, {result['separation']:.2f} apart; {loss} lost{when}"
