"""Golf from the side: from the tee, through the air, over the turf, to rest or into the cup.

Models: gravity; drag and Magnus lift with coefficients by Reynolds number and spin ratio; wind, uniform or growing with
height; spin decay; the strike of the club head, a collision with springs along and across the face, damped along it;
bounces on turf that gives way (Penner 2002), sliding, rolling, slopes, water, and a cup with real walls, which a fast
ball skips over; the drift of a flight with a tilted spin axis (hook, slice) or wind across, to its landing.

Leaves out, with the effect on the carry of the default drive: air that thins with height (0.2 m), buoyancy (0.2 m), the
turning Earth (less than 0.1 m). And, not measured: what goes sideways on the ground (the break of a green), the
deformation of the ball, the flagstick, grain and moisture of the grass.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import cos, hypot, inf, radians, sin
from typing import Any, Literal

from sandbox.kit import (
    GOLF_DRAG,
    GOLF_LIFT,
    LAUNCH,
    LAUNCH_SPIN,
    SOLID_SPHERE,
    Ball,
    Bounds,
    ConstantDrag,
    Controls,
    Event,
    Fact,
    Flight,
    Goal,
    Group,
    Handle,
    Moment,
    NoForce,
    OutdoorAir,
    RequestError,
    Rule,
    Run,
    SceneRun,
    Setup,
    Spin,
    Spread,
    Touches,
    Until,
    amount,
    cached_per_run,
    choice,
    down_to,
    fact_from,
    group,
    height_on,
    one_of,
    quantity,
    roughly,
    where,
)
from sandbox.physics.club import Head, book_strike, strike
from sandbox.sport.flight import SlowedSphere
from sandbox.sport.readings import whole_rpm
from sandbox.sport.sideways import Crosswind, GroundPlace, SidewaysLaunch, ground_track, side

from .course import FAR, Ground, Pin, surfaces


class Swing(SidewaysLaunch):
    """The ball as it leaves the club."""

    vx: float = quantity(..., "m/s", -340, 340, 'speed along x, if start is "components"')
    vy: float = quantity(..., "m/s", -340, 340, 'speed up, if start is "components"')


class Club(Group):
    """The head that strikes the ball, if start is \"club\"."""

    model: Literal["springs", "book"] = choice(..., "springs in the contact, or the textbook's closed form")
    speed: float = quantity(..., "m/s", 0, 150, "speed of the head")
    mass: float = quantity(..., "kg", 0.01, 10, "mass of the head")
    loft: float = quantity(..., "deg", 0, 80, "angle of the face from the vertical")
    attack: float = quantity(..., "deg", -45, 45, "direction of the head above the horizontal; negative is downwards")
    restitution: float = quantity(..., "", 0, 1, "of head and ball")
    friction: float = quantity(..., "", 0, 10, "of face and ball; if too low, the ball slides up the face")
    stiffness: float = quantity(..., "", 0.1, 100, "of the ball along the face over that normal to it")
    damping: float = quantity(..., "", 0, 2, "of the ball along the face, over that at which it swings no more")
    depth: float = quantity(..., "m", 0, 0.2, "of the head's centre of mass behind the face")
    inertia: float = quantity(..., "kg m^2", 1e-5, 1, "of the head about the axis from heel to toe")
    height: float = quantity(..., "m", -0.03, 0.03, "of the impact point above the centre of mass")


class DimpledDrag(ConstantDrag):
    """One drag coefficient for all speeds."""

    coefficient: float = quantity(0.25, "", 0, 10, "drag coefficient")


class GolfBall(SlowedSphere, drag=GOLF_DRAG, lift=GOLF_LIFT):
    """The golf ball, a solid sphere."""

    INERTIA = SOLID_SPHERE
    drag: DimpledDrag | NoForce = one_of(..., "drag of the air")


class GolfAir(Crosswind, OutdoorAir):
    """The air over the course."""


class Parameters(Flight):
    """All numbers of a golf shot."""

    start: Literal["launch", "components", "club"] = choice(
        ..., "begin with the ball's speed and angle, with vx and vy, or with the club head"
    )
    launch: Swing = group(..., "the ball as it is launched")
    club: Club = group(..., "the club head")
    air: GolfAir = group(..., "the air")
    ball: GolfBall = group(..., "the ball")
    ground: Ground = group(..., "the course")
    pin: Pin = group(..., "the flag and its cup")

    @classmethod
    def with_implied(cls, changes: Mapping[str, Any]) -> Mapping[str, Any]:
        """Who gives vx or vy begins with the components, and who gives speed or angle with those."""
        launch = changes.get("launch")
        if "start" in changes or not isinstance(launch, Mapping):
            return changes
        starts = {"components": ("vx", "vy"), "launch": ("speed", "angle")}
        given = (start for start, keys in starts.items() if any(key in launch for key in keys))
        start = next(given, None)
        return changes if start is None else {**changes, "start": start}


#: Slowest and fastest putt that is tried, in m/s.
PUTTS = 0.1, 8.0
CONTROLS = Controls(
    full_pull_speed=100.0,
    spins=(Spin("launch.spin", 100.0),),
    set_on_pull={"start": "launch"},
    sliders=("launch.speed", "launch.angle", "launch.spin", "air.wind", "gravity", "pin.distance"),
    handles=(Handle("pin.distance", at=lambda it: it.ground.point(it.pin.distance)),),
    goals=lambda parameters: goals(parameters),
    scores="holed",
    spread=(Spread("launch.speed", 0.015), Spread("launch.angle", 0.08), Spread("launch.spin", 0.06)),  # assumed
    fan_fact="total",
)

#: A shot that has not come to rest after this time in s is ended.
LONGEST = 300.0

#: A ball that ends less than this, in m, short of the farthest place it reached has not come back.
LEAST_BACK = 0.5

#: Speed of ball over that of the head for a driver, on the tours (TrackMan: 1.49 for both, of men and of women).
TOUR_SMASH_FACTOR = 1.49


def build(parameters: Parameters) -> Setup:
    """The ball on the tee, and the course. Raises RequestError where the course makes no sense."""
    course = surfaces(parameters.ground, parameters.pin, parameters.ball.radius)
    highest = max(y for _, y in parameters.ground.line)
    ball = parameters.launched((0.0, height_on(course, parameters.ball.radius, above=highest)))
    if parameters.start == "club":
        ball = parameters.launch.tilted(struck(parameters.club, ball))
    elif parameters.start == "components":
        ball = replace(ball, velocity=(parameters.launch.vx, parameters.launch.vy))
    water = Touches("water") if any(surface.name == "water" for surface in course) else None
    until = ComesDown() if parameters.pin.reach > 0.0 else water
    return Setup([ball], course, LONGEST, until, bounds=Bounds(-FAR, -FAR, FAR, FAR))


@dataclass(frozen=True)
class ComesDown(Until):
    """Ends a run when the ball touches anything on its way down."""

    def over(self, events: Sequence[Event]) -> bool:
        return events[-1].kind != "leave" and events[-1].t > 0.0

    def rules(self) -> Sequence[Rule]:
        return [Rule(after=0.0)]


def struck(club: Club, ball: Ball) -> Ball:
    """The ball as it leaves the face."""
    if club.loft - club.attack > 90.0:
        raise RequestError(
            f"club.attack = {club.attack:g} deg: with club.loft = {club.loft:g} deg the face moves away from the ball"
        )
    angles = radians(club.loft), radians(club.attack)
    if club.model == "book":
        vx, vy, spin = book_strike(club.mass, club.restitution, club.speed, *angles, ball.mass, ball.radius)
        return replace(ball, velocity=(vx, vy), spin=spin)
    head = Head(club.mass, club.restitution, club.friction, club.stiffness, club.damping, club.depth, club.inertia)
    vx, vy, spin = strike(head, club.speed, *angles, club.height, ball.mass, ball.radius)
    return replace(ball, velocity=(vx, vy), spin=spin)


def goals(parameters: Parameters) -> list[Goal]:
    """The cup for a putt, which may be hit at several speeds; else where the ball lands, by speed or by angle."""
    pin = parameters.pin.distance
    place = parameters.ground.point(pin)
    if parameters.launch.angle < 3.0:
        return [Goal("the cup", {"holed": True}, place, {"launch.speed": PUTTS})]
    ways = {"launch.speed": (PUTTS[0], CONTROLS.full_pull_speed), "launch.angle": (5.0, 80.0)}
    return [Goal("a landing at the pin", {"carry": pin}, place, {key: ends}) for key, ends in ways.items()]


@cached_per_run
def landing(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it returns to launch height, or lands on higher ground before that: carry is how far that is."""
    return down_to(run, run.setup.balls[0].position)


def flew(run: Run, parameters: Parameters) -> bool:
    """True if the ball flew: a putt does not."""
    landed = landing(run, parameters)
    return landed is not None and landed.t > 0.02


def apex(run: Run, parameters: Parameters) -> float:
    """Greatest height in m above the launch: of the flight, or of the whole run if the flight does not end."""
    landed = landing(run, parameters)
    until = inf if landed is None else where(landed.t > 0.0, landed.t, inf)
    return run.highest("ball", until)[1][1] - run.setup.balls[0].position[1]


def smash_factor(run: Run, parameters: Parameters) -> float | None:
    """Speed of the ball over that of the head."""
    club = parameters.club.speed
    return hypot(*run.setup.balls[0].velocity) / club if parameters.start == "club" and club > 0.0 else None


def compared_with_tour(run: Run, parameters: Parameters) -> str | None:
    """The speed of a driver's ball compared with those of tour players, which the model does not quite meet."""
    smash = smash_factor(run, parameters)
    if smash is None or parameters.club.depth == 0.0 or parameters.club.model == "book":  # without depth
        return None
    apart = 100.0 * (smash / TOUR_SMASH_FACTOR - 1.0)
    how = "slower" if apart < 0.0 else "faster"
    return f"{abs(apart):.0f} % {how} than TrackMan measures with tour players' drivers" if abs(apart) > 0.5 else None


def total(run: Run, parameters: Parameters) -> float:
    """The final position of the ball, in m."""
    return run.state("ball", run.duration)[0]


def roll_back(run: Run, parameters: Parameters) -> float | None:
    """The distance in m from the farthest place that the ball reached to its end: spun back, or rolled back down."""
    end = total(run, parameters)
    way = 1.0 if end >= 0.0 else -1.0
    back = max(way * state[0] for _, state in run.ends("ball")) - way * end  # it turns within 1 cm of an arc's end
    return back if back > LEAST_BACK else None


def track(run: Run, parameters: Parameters) -> list[GroundPlace]:
    """The track of the ball over the ground up to where its carry ends, if it leaves the plane."""
    return ground_track(run, parameters, landing(run, parameters))


def distance_to_pin(run: Run, parameters: Parameters) -> float:
    """In m, to where the ball ends; one that left the plane rolls on in the direction of its launch."""
    end, landed, over = total(run, parameters), landing(run, parameters), track(run, parameters)
    if landed is None or not over:
        return abs(end - parameters.pin.distance)
    direction = radians(parameters.launch.direction or 0.0)
    return hypot(end * cos(direction) - parameters.pin.distance, over[-1].side + (end - landed.x) * sin(direction))


def holed(run: Run, parameters: Parameters) -> bool:
    """True if the ball lies in the cup; or where it counts that it comes down at the flag, if it does."""
    away, y, pin = distance_to_pin(run, parameters), run.state("ball", run.duration)[1], parameters.pin
    if pin.reach > 0.0:
        return run.ended == "until" and away <= pin.reach
    return away < 0.5 * pin.cup_width and y < parameters.ground.height(pin.distance)


def ended(run: Run, parameters: Parameters) -> str:
    """cup; water; down, where that is all that counts; or how the run ended otherwise."""
    if parameters.pin.reach > 0.0:
        return "down" if run.ended == "until" else run.ended
    return "cup" if holed(run, parameters) else "water" if run.ended == "until" else run.ended


#: A fact of the flight: known when the ball first touches something, and not shown for a putt.
InFlight = partial(Fact, final_when="ball", where=flew)

FACTS = (
    InFlight("carry", "carry", "m", fact_from(landing, "x"), also="yd"),
    Fact("total", "total", "m", total, also="yd"),
    replace(side(track, "ball"), where=flew),
    InFlight("apex", "apex", "m", apex),
    InFlight("flight_time", "flight time", "s", fact_from(landing, "t")),
    *LAUNCH,
    Fact("smash_factor", "smash factor", "", smash_factor, "start"),
    Fact("compared", "compared", "", compared_with_tour, "start"),
    InFlight("landing_angle", "landing", "deg", fact_from(landing, "descent")),
    InFlight("landing_speed", "landing speed", "m/s", fact_from(landing, "speed")),
    InFlight("landing_spin", "landing spin", "rpm", fact_from(landing, whole_rpm), sides=LAUNCH_SPIN.sides),
    Fact("comes_back", "comes back", "m", roll_back),
    Fact("distance_to_pin", "", "m", distance_to_pin),
    Fact("holed", "", "", holed),
    Fact("ended", "", "", ended),
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    result, pin = run.result, parameters.pin.distance
    carry, total = result["carry"], result["total"]
    where = "from" if result["side"] else "short of" if (pin - total) * pin > 0.0 else "past"
    if result["ended"] == "down":
        down = f"{amount(result['distance_to_pin'], 'm', 1)} {where} the flag at {roughly(abs(pin))}"
        return f"Meets the flag: down {down}" if result["holed"] else f"Comes down {down}"
    if result["holed"]:
        return f"Holed from {roughly(abs(pin))}"
    if carry is None:
        return "Did not come down"
    if result["ended"] == "duration":
        return f"Still moving after {run.duration:.0f} s, {roughly(abs(total))} from the start"
    if abs(carry) < 0.05 * abs(total):
        story = f"Rolls {roughly(abs(total))}" + (" backwards" if total < 0.0 else "")
    else:
        story = f"Flies {roughly(-carry)} backwards" if carry < 0.0 else f"{roughly(carry)} carry"
        story += f", comes back {roughly(result['comes_back'])}" if result["comes_back"] else ""
    if result["side"]:
        story += f", {roughly(abs(result['side']))} to the {'right' if result['side'] > 0.0 else 'left'}"
    if result["ended"] == "water":
        return f"{story}, into the water"
    return f"{story}, stops {roughly(result['distance_to_pin'])} {where} the pin"
