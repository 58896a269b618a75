"""Golf from the side: from the tee, through the air, over the turf, to rest or into the cup.

Models: gravity; drag and Magnus lift with coefficients by Reynolds number and spin ratio; wind, uniform or growing with
height; spin decay; the strike of the club head, a collision with springs along and across the face; bounces on turf
that gives way (Penner 2002), sliding, rolling, slopes, water, and a cup with real walls, which a fast ball skips over.

Leaves out, with the effect on the carry of the default drive: the fading of lift below the drag crisis (2.6 m if half
of it went), air that thins with height (0.2 m), buoyancy (0.1 m), the turning Earth (less than 0.05 m). And, not
measured: everything sideways (hook, slice, the break of a green), the deformation of the ball, the flagstick, grain and
moisture of the grass.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import hypot, inf, radians
from typing import Literal

from sandbox.engine.run import Event, Run
from sandbox.engine.setup import SOLID_SPHERE, Bounce, Bounds, Segment, Setup, Surface
from sandbox.errors import RequestError
from sandbox.parameters import Accuracy, Group, choice, either, group, groups, quantity, vectors
from sandbox.physics.club import Head, strike
from sandbox.physics.club import Launch as Struck
from sandbox.physics.coefficients import GOLF_DRAG, GOLF_LIFT
from sandbox.physics.forces import SpinDecay
from sandbox.physics.turf import penner_bounce, penner_restitution, stimp_resistance
from sandbox.sport.air import (
    ConstantDrag,
    ConstantLift,
    Lift,
    Measured,
    NoDrag,
    NoLift,
    OutdoorAir,
    SpinRatioLift,
    wind_in,
)
from sandbox.sport.amounts import roughly
from sandbox.sport.controls import Controls, Goal, Handle, Spin, Spread
from sandbox.sport.facts import Fact, once
from sandbox.sport.flight import RPM, Launch, Sphere, forces_in_flight, height_on, launched_ball
from sandbox.sport.readings import BALL_SPEED, LAUNCH_ANGLE, LAUNCH_SPIN, Moment, at, before


class Club(Group):
    """The head that strikes the ball, if start is \"club\"."""

    speed: float = quantity(..., "m/s", 0, 150, "speed of the head")
    mass: float = quantity(..., "kg", 0.01, 10, "mass of the head")
    loft: float = quantity(..., "deg", 0, 80, "angle of the face from the vertical")
    attack: float = quantity(..., "deg", -45, 45, "direction of the head above the horizontal; negative is downwards")
    restitution: float = quantity(..., "", 0, 1, "of head and ball")
    friction: float = quantity(..., "", 0, 10, "of face and ball; if too low, the ball slides up the face")
    stiffness: float = quantity(..., "", 0.1, 100, "of the ball along the face over that normal to it")
    depth: float = quantity(..., "m", 0, 0.2, "of the head's centre of mass behind the face")
    inertia: float = quantity(..., "kg m^2", 1e-5, 1, "of the head about the axis from heel to toe")
    height: float = quantity(..., "m", -0.03, 0.03, "of the impact point above the centre of mass")


class GolfDrag(Measured):
    """Drag by a model of the golf ball."""

    LAWS = GOLF_DRAG
    model: Literal["tour-fit", "smits-smith", "lyu", "usga", "quadratic", "power-law"] = choice(
        ..., "drag coefficient by its source"
    )


class DimpledDrag(ConstantDrag):
    """One drag coefficient for all speeds."""

    coefficient: float = quantity(0.25, "", 0, 10, "drag coefficient")


class GolfLift(Measured, Lift):
    """Lift by a model of the golf ball."""

    LAWS = GOLF_LIFT
    model: Literal["tour-fit", "smits-smith", "lyu", "usga", "quadratic", "power-law"] = choice(
        ..., "lift coefficient by its source"
    )


class GolfBall(Sphere):
    """The golf ball, a solid sphere."""

    spin_decay: float = quantity(..., "", 0, 0.01, "k of dw/dt = -k |u| w / r, in air of 1.204 kg/m^3")
    drag: GolfDrag | DimpledDrag | NoDrag = either(..., "drag of the air")
    lift: GolfLift | SpinRatioLift | ConstantLift | NoLift = either(..., "Magnus lift")


class Grass(Group):
    """How a ball bounces on a kind of ground."""

    bounce: float = quantity(..., "", 0, 2, "restitution over that of Penner's green")
    friction: float = quantity(..., "", 0, 10, "friction of ball and ground")
    give: float = quantity(..., "", 0, 2, "how far it gives way under a bounce, over Penner's green")


class Turf(Grass):
    """A kind of ground."""

    resistance: float = quantity(..., "", 0, 10, "deceleration of a rolling ball over gravity")


class Green(Grass):
    """The green around the pin."""

    length: float = quantity(..., "m", 0, 200, "length, the pin in its middle")
    stimp: float = quantity(..., "m", 0.3, 12, "reading of a stimpmeter")


class Strip(Group):
    """A stretch of another kind of ground."""

    kind: Literal["tee", "fairway", "rough", "bunker", "water"] = choice("rough", "kind of ground")
    start: float = quantity(0.0, "m", -1000, 3000, "where it begins")
    end: float = quantity(10.0, "m", -1000, 3000, "where it ends")


class Ground(Group):
    """The course, from the side."""

    tee: Turf = group(..., "tee")
    fairway: Turf = group(..., "fairway")
    rough: Turf = group(..., "rough")
    bunker: Turf = group(..., "bunker")
    green: Green = group(..., "green")
    strips: list[Strip] = groups(..., "stretches laid over the fairway, later ones on top; the green lies over all")
    heights: list[tuple[float, float]] = vectors(
        ..., 2, "m", -1000, 3000, "points (x, height) of the ground's line, level beyond its ends; empty: level at 0"
    )


class Pin(Group):
    """The flag and its cup."""

    distance: float = quantity(..., "m", -500, 2500, "from the tee to the middle of the cup")
    cup_width: float = quantity(..., "m", 0, 10, "width of the cup; 0 for none")
    cup_depth: float = quantity(..., "m", 0.01, 2, "depth of the cup")


class Parameters(Group):
    """All numbers of a golf shot."""

    start: Literal["launch", "club"] = choice(..., "begin with the ball's launch, or with the club head")
    launch: Launch = group(..., "the ball just after it was struck")
    club: Club = group(..., "the club head")
    gravity: float = quantity(..., "m/s^2", 0, 30, "gravity")
    air: OutdoorAir = group(..., "the air")
    ball: GolfBall = group(..., "the ball")
    ground: Ground = group(..., "the course")
    pin: Pin = group(..., "the flag and its cup")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


CONTROLS = Controls(
    strongest=100.0,
    spins=(Spin("launch.spin", 100.0),),
    also={"start": "launch"},
    sliders=("launch.speed", "launch.angle", "launch.spin", "air.wind", "gravity", "pin.distance"),
    handles=(Handle("pin.distance", at=lambda p: (p.pin.distance, height(p, p.pin.distance))),),
    goals=lambda parameters: _goals(parameters),
    scores="holed",
    spread=(Spread("launch.speed", 0.015), Spread("launch.angle", 0.08), Spread("launch.spin", 0.06)),  # assumed
    fan_fact="total",
)

#: Density in kg/m^3 of the air that the spin decay is given for; thinner air slows the spin less, in proportion.
STANDARD_DENSITY = 1.204

#: The course extends this far in m, behind and beyond: farther than a shot gets in LONGEST.
FAR = 2e5

#: A shot that has not come to rest after this time in s is ended.
LONGEST = 300.0

#: A ball that ends less than this, in m, short of the farthest place it reached has not come back.
LEAST_BACK = 0.5

#: Bounces lower than this, in m, are lost in the grass and the ball rolls (Penner 2002, Can. J. Phys. 80:931).
LOWEST_BOUNCE = 0.005

#: Speed of ball over that of the head for a driver, on the tours (TrackMan: 1.49 for both, of men and of women).
TOUR_SMASH_FACTOR = 1.49

#: Restitution, friction and rolling resistance of the cup and its rim. Without restitution the fastest putt that it
#: holds crosses the near edge at 1.64 m/s; Holmes 1991, Am. J. Phys. 59:129, has 1.63 m/s (second-hand). The others are
#: assumed.
CUP = (0.0, 0.4, 0.1)


def build(parameters: Parameters) -> Setup:
    """Ball, course, and the forces that this shot needs. Raises RequestError where the course makes no sense."""
    air, ball, course = parameters.air, parameters.ball, _course(parameters)
    forces = forces_in_flight(ball, air, parameters.gravity)
    tee = height_on(course, ball.radius, above=max(y for _, y in _line(parameters)))
    teed = launched_ball(parameters.launch, ball, (0.0, tee), forces, SOLID_SPHERE)
    if parameters.start == "club":
        struck = _struck(parameters.club, ball)
        teed = replace(teed, velocity=(struck.vx, struck.vy), spin=struck.spin)
    if air.density > 0.0 and ball.spin_decay > 0.0:
        rate = ball.spin_decay * air.density / STANDARD_DENSITY
        teed = replace(teed, torques=[SpinDecay(teed.inertia, ball.radius, rate, wind_in(air))])
    return Setup([teed], course, duration=LONGEST, until=_is_in_water, bounds=Bounds(-FAR, -FAR, FAR, FAR))


def _goals(parameters: Parameters) -> list[Goal]:
    """The cup for a putt, which may be hit at several speeds; else where the ball lands, by speed or by angle."""
    pin, speed = parameters.pin.distance, parameters.launch.speed
    at = pin, height(parameters, pin)
    if parameters.launch.angle < 3.0:
        return [Goal("the cup", {"holed": True}, at, {"launch.speed": (0.2 * speed, 3.0 * speed)})]
    ways = {"launch.speed": (0.2 * speed, min(2.0 * speed, CONTROLS.strongest)), "launch.angle": (5.0, 80.0)}
    return [Goal("a landing at the pin", {"carry": pin}, at, {key: ends}) for key, ends in ways.items()]


def _struck(club: Club, ball: GolfBall) -> Struck:
    """The ball as it leaves the face."""
    if club.loft - club.attack > 90.0:
        raise RequestError(
            f"club.attack = {club.attack:g} deg: with club.loft = {club.loft:g} deg the face moves away from the ball"
        )
    head = Head(club.mass, club.restitution, club.friction, club.stiffness, club.depth, club.inertia)
    return strike(head, club.speed, radians(club.loft), radians(club.attack), club.height, ball.mass, ball.radius)


def _is_in_water(event: Event) -> bool:
    return event.partner == "water"


def _line(parameters: Parameters) -> list[tuple[float, float]]:
    """The ground's line, in m: level beyond the ends of what the file gives."""
    points = parameters.ground.heights or [(0.0, 0.0)]
    return [(-FAR, points[0][1]), *points, (FAR, points[-1][1])]


def height(parameters: Parameters, x: float) -> float:
    """Height of the ground in m at x."""
    (x0, y0), (x1, y1) = next(piece for piece in pairwise(_line(parameters)) if x <= piece[1][0])
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0)


def kind_at(parameters: Parameters, x: float) -> str:
    """Kind of ground at x: the green around the pin, or the last strip that covers x, or fairway."""
    if abs(x - parameters.pin.distance) < 0.5 * parameters.ground.green.length:
        return "green"
    for strip in reversed(parameters.ground.strips):
        if strip.start <= x < strip.end:
            return strip.kind
    return "fairway"


def _course(parameters: Parameters) -> list[Surface]:
    """The ground in pieces of one kind, and the cup."""
    ground, pin, radius = parameters.ground, parameters.pin, parameters.ball.radius
    for (x0, _), (x1, _) in pairwise(ground.heights):
        if x1 <= x0:
            raise RequestError(f"ground.heights: x must grow from point to point, but {x1:g} m follows {x0:g} m")
    for strip in ground.strips:
        if strip.end <= strip.start:
            raise RequestError(
                f"ground.strips: the {strip.kind} from {strip.start:g} m to {strip.end:g} m has no length"
            )
    left, right = pin.distance - 0.5 * pin.cup_width, pin.distance + 0.5 * pin.cup_width
    if left < right and left < radius and right > -radius:
        raise RequestError(f"pin.distance: the cup at {pin.distance:g} m is where the ball starts, at 0 m")
    green = pin.distance - 0.5 * ground.green.length, pin.distance + 0.5 * ground.green.length
    strips = (x for strip in ground.strips for x in (strip.start, strip.end))
    edges = sorted({left, right, *green, *strips, *(x for x, _ in _line(parameters))})
    line = [(x, height(parameters, x)) for x in edges]
    pieces = [(a, b) for a, b in pairwise(line) if not left <= a[0] < right]
    cup: list[Surface] = []
    if left < right:
        top_left, top_right = (left, height(parameters, left)), (right, height(parameters, right))
        bottom = min(top_left[1], top_right[1]) - pin.cup_depth
        corners = [top_left, (left, bottom), (right, bottom), top_right]
        cup = [Surface("cup", Segment(a, b), *CUP) for a, b in pairwise(corners)]
    return [*cup, *(_turf(parameters, kind_at(parameters, 0.5 * (a[0] + b[0])), a, b) for a, b in pieces)]


@dataclass(frozen=True)
class PennerTurf:
    """The response of turf to an impact: Penner's restitution times ``bounce``, and a tilt times ``give``."""

    bounce: float
    friction: float
    give: float

    def __call__(self, normal_speed: float, tangential_speed: float) -> Bounce:
        restitution, tilt = penner_bounce(normal_speed, tangential_speed, self.give)
        return Bounce(min(1.0, self.bounce * restitution), self.friction, tilt)


def _turf(parameters: Parameters, kind: str, a: tuple[float, float], b: tuple[float, float]) -> Surface:
    if kind == "water":
        return Surface("water", Segment(a, b), 0.0, 0.0)
    turf: Turf | Green = getattr(parameters.ground, kind)
    resistance = stimp_resistance(turf.stimp) if isinstance(turf, Green) else turf.resistance
    law = PennerTurf(turf.bounce, turf.friction, turf.give)
    slow = min(1.0, turf.bounce * penner_restitution(0.0))
    return Surface(kind, Segment(a, b), slow, turf.friction, resistance, LOWEST_BOUNCE, law)


@once
def landing(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it returns to launch height, or lands on higher ground before that."""
    touched = next((event.t for event in run.events if event.kind != "leave"), inf)
    back = next(iter(run.crossings("ball", run.setup.balls[0].position, (0.0, 1.0))), None)
    if touched < (inf if back is None else back[0]):
        return before(run, touched)
    return None if back is None else Moment(back[0], *back[1])


def _flew(run: Run, parameters: Parameters) -> bool:
    """Whether the ball flew: a putt does not."""
    landed = landing(run, parameters)
    return landed is not None and landed.t > 0.02


def _apex(run: Run, parameters: Parameters) -> float:
    """Greatest height in m above the launch: of the flight, or of the whole run if the flight does not end."""
    landed = landing(run, parameters)
    until = landed.t if landed is not None and landed.t > 0.0 else inf
    return run.highest("ball", until)[1][1] - run.setup.balls[0].position[1]


def _smash_factor(run: Run, parameters: Parameters) -> float | None:
    """Speed of the ball over that of the head."""
    club = parameters.club.speed
    return hypot(*run.setup.balls[0].velocity) / club if parameters.start == "club" and club > 0.0 else None


def _compared_with_tour(run: Run, parameters: Parameters) -> str | None:
    """How fast the ball of a driver is compared with those of tour players, which the model does not quite meet."""
    smash = _smash_factor(run, parameters)
    if smash is None or parameters.club.depth == 0.0:  # an iron's centre of mass is in its face
        return None
    apart = 100.0 * (smash / TOUR_SMASH_FACTOR - 1.0)
    how = "slower" if apart < 0.0 else "faster"
    return f"{abs(apart):.0f} % {how} than TrackMan measures with tour players' drivers" if abs(apart) > 0.5 else None


def _total(run: Run, parameters: Parameters) -> float:
    return run.state("ball", run.duration)[0]


def _comes_back(run: Run, parameters: Parameters) -> float | None:
    """How far in m the ball ends short of the farthest place that it reached: spun back, or rolled back down."""
    end = _total(run, parameters)
    way = 1.0 if end >= 0.0 else -1.0
    back = max(way * state[0] for _, state in run.ends("ball")) - way * end  # it turns within 1 cm of an arc's end
    return back if back > LEAST_BACK else None


def _holed(run: Run, parameters: Parameters) -> bool:
    x, y = run.state("ball", run.duration)[:2]
    pin = parameters.pin
    return abs(x - pin.distance) < 0.5 * pin.cup_width and y < height(parameters, pin.distance)


def _ended(run: Run, parameters: Parameters) -> str:
    if _holed(run, parameters):
        return "cup"
    return "water" if any(_is_in_water(event) for event in run.events) else run.ended


FACTS = (
    Fact("carry", "carry", "m", at(landing, lambda ball: ball.x), "ball", also="yd", where=_flew),
    Fact("total", "total", "m", _total, also="yd"),
    Fact("apex", "apex", "m", _apex, "ball", where=_flew),
    Fact("flight_time", "flight time", "s", at(landing, lambda ball: ball.t), "ball", where=_flew),
    BALL_SPEED,
    LAUNCH_ANGLE,
    LAUNCH_SPIN,
    Fact("smash_factor", "smash factor", "", _smash_factor, "start"),
    Fact("compared", "compared", "", _compared_with_tour, "start"),
    Fact("landing_angle", "landing", "deg", at(landing, lambda ball: ball.descent), "ball", where=_flew),
    Fact("landing_speed", "landing speed", "m/s", at(landing, lambda ball: ball.speed), "ball", where=_flew),
    Fact(
        "landing_spin",
        "landing spin",
        "rpm",
        at(landing, lambda ball: ball.spin / RPM),
        "ball",
        sides=LAUNCH_SPIN.sides,
        where=_flew,
    ),
    Fact("comes_back", "comes back", "m", _comes_back),
    Fact("distance_to_pin", "", "m", lambda run, p: abs(_total(run, p) - p.pin.distance)),
    Fact("holed", "", "", _holed),
    Fact("ended", "", "", _ended),
)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
    result, pin = run.result, parameters.pin.distance
    carry, total = result["carry"], result["total"]
    if result["holed"]:
        return f"Holed from {roughly(abs(pin))}"
    if carry is None:
        return "Did not come down"
    if result["ended"] == "duration":
        return f"Still rolling after {run.duration:.0f} s, {roughly(abs(total))} from the start"
    if abs(carry) < 0.05 * abs(total):
        story = f"Rolls {roughly(abs(total))}" + (" backwards" if total < 0.0 else "")
    else:
        story = f"Flies {roughly(-carry)} backwards" if carry < 0.0 else f"{roughly(carry)} carry"
        story += f", comes back {roughly(result['comes_back'])}" if result["comes_back"] else ""
    if result["ended"] == "water":
        return f"{story}, into the water"
    side = "short of" if (pin - total) * pin > 0.0 else "past"
    return f"{story}, stops {roughly(result['distance_to_pin'])} {side} the pin"
