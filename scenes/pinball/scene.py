"""A pinball table: plunger, arch, bumpers that kick, slings, targets, and two flippers that the player moves.

Models: a steel ball that rolls down an inclined table; flippers driven at a constant rate, whatever they hit; the work
of flippers, bumpers, slings and of the spring that sends back a ball in the lane, which is in the energy ledger.
Leaves out: spin carried over between rolling and impacts, rolling resistance (some 1 % of gravity's share), the
acceleration of the flippers, nudging, ramps. Not validated: coils and rubber, whose numbers are assumed.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from math import cos, pi, sin

from sandbox.kit import (
    DEGREE,
    ENDED,
    Ball,
    Circle,
    Controls,
    Directed,
    Event,
    Fact,
    Gravity,
    Group,
    Handle,
    Held,
    InTurn,
    Moving,
    RequestError,
    Run,
    SceneParameters,
    SceneRun,
    Segment,
    Setup,
    Spread,
    Surface,
    Trap,
    Turning,
    Vector,
    apex,
    group,
    groups,
    quantity,
    vectors,
)

#: In m, the middle of the table's lower edge being the origin: half the width of the field, whose right wall is that of
#: the plunger's lane; the outer wall; where the arch begins; half the thickness of walls, of flippers and their pivots.
HALF, OUTER, ARCH, WALL, BAT = 0.235, 0.279, 0.74, 0.004, 0.009
#: The plunger: its height in m and the middle of its lane.
PLUNGER, LANE = 0.12, 0.5 * (HALF + OUTER)
#: A flipper's pivot and length in m, which leave room for the largest ball between the two; s after which a game ends.
PIVOT, LENGTH, LONGEST = (0.087, 0.130), 0.063, 600.0
#: A ball that rolls without slipping falls with so much of gravity's share along the table: 1 / (1 + 2/5).
ROLLING = 5.0 / 7.0


class Plunge(Directed):
    """The ball as it leaves the plunger."""

    speed: float = quantity(..., "m/s", 0, 10, "ball speed")
    angle: float = quantity(..., "deg", 80, 100, "direction; 90 is straight up the lane")


class SteelBall(Group):
    """The ball."""

    mass: float = quantity(..., "kg", 0.01, 1, "mass")
    radius: float = quantity(..., "m", 0.008, 0.0145, "radius")


class Table(Group):
    """The table and what all parts of it share."""

    incline: float = quantity(..., "deg", 0.5, 60, "of the table")
    gravity: float = quantity(..., "m/s^2", 0.1, 100, "gravity")
    restitution: float = quantity(..., "", 0, 1, "of ball and walls")
    friction: float = quantity(..., "", 0, 10, "of ball and walls, flippers, bumpers")


class Flippers(Group):
    """The two flippers, and when their buttons are held."""

    rest: float = quantity(..., "deg", -60, 0, "angle at rest, below level")
    up: float = quantity(..., "deg", 0, 60, "angle when held, above level")
    rise: float = quantity(..., "s", 0.005, 1, "time of a whole stroke up")
    fall: float = quantity(..., "s", 0.005, 1, "time of a whole stroke down")
    restitution: float = quantity(..., "", 0, 1, "of ball and flippers")
    left: list[tuple[float, float]] = vectors(..., 2, "s", 0, LONGEST, "when the left button is held: from, to")
    right: list[tuple[float, float]] = vectors(..., 2, "s", 0, LONGEST, "when the right button is held: from, to")


class Kicks(Group):
    """The bumpers and slings, which kick by an impulse along their normal in each impact."""

    restitution: float = quantity(..., "", 0, 1, "of ball and rubber")
    bumper: float = quantity(..., "N s", 0, 1, "of a bumper")
    sling: float = quantity(..., "N s", 0, 1, "of a sling, beside the flippers")
    plunger: float = quantity(..., "N s", 0, 1, "that sends a ball back into play that has come down the lane")


class Bumper(Group):
    """A round bumper."""

    x: float = quantity(0.0, "m", -0.2, 0.2, "its middle, to the right")
    y: float = quantity(0.7, "m", 0.3, 0.95, "its middle, up the table")
    radius: float = quantity(0.034, "m", 0.005, 0.1, "radius")


class Points(Group):
    """The points of a hit."""

    bumper: int = quantity(..., "", 0, 100000, "points for a bumper")
    sling: int = quantity(..., "", 0, 100000, "points for a sling")
    target: int = quantity(..., "", 0, 100000, "points for a target")


class Parameters(SceneParameters):
    """All parameters of a game with one ball."""

    launch: Plunge = group(..., "the ball as it leaves the plunger")
    ball: SteelBall = group(..., "the ball")
    table: Table = group(..., "the table")
    flippers: Flippers = group(..., "the flippers")
    kicks: Kicks = group(..., "what kicks")
    bumpers: list[Bumper] = groups(..., "the bumpers")
    points: Points = group(..., "what a hit scores")


CONTROLS = Controls(
    full_pull_speed=4.0,
    sliders=("launch.speed", "table.incline", "kicks.bumper", "kicks.sling", "flippers.rise", "table.restitution"),
    handles=(Handle("bumpers[*].x", "bumpers[*].y"),),
    spread=(Spread("launch.speed", 0.01),),  # assumed
    fan_fact="score",
    held=(Held("left", "flippers.left", "left flipper"), Held("right", "flippers.right", "right flipper")),
)


def same(point: Vector) -> Vector:
    return point


def mirrored(point: Vector) -> Vector:
    return -point[0], point[1]


def chain(*points: Vector) -> list[Segment]:
    """A bent wall through points."""
    return [Segment(a, b, WALL) for a, b in pairwise(points)]


def arch() -> list[Vector]:
    """Points of the arch over the table, from right to left: half an ellipse."""
    middle, wide, high = 0.5 * (OUTER - HALF), 0.5 * (OUTER + HALF), 0.26
    turns = [pi * i / 40 for i in range(41)]
    return [(middle + wide * cos(turn), ARCH + high * sin(turn)) for turn in turns]


def inlane(rest: float) -> list[Vector]:
    """The left guide, flush with a flipper at rest at an angle in rad: its post, its bend, its end at the pivot."""
    c, s, (x, y) = cos(rest), sin(rest), mirrored(PIVOT)
    over, back = BAT - WALL, 0.016
    end = x - back * c - over * s, y - back * s + over * c
    bend = -0.196, end[1] + (-0.196 - end[0]) * s / c
    return [(bend[0], bend[1] + 0.09), bend, end]


def sling(rest: float) -> tuple[Vector, Vector, Vector]:
    """The corners of the left sling: below, at the flipper, above; its kicking side joins the last two."""
    (_, _), (x, y), _ = inlane(rest)
    slope, outer, inner = sin(rest) / cos(rest), -0.152, -0.100
    below, tip = (at_x * slope - x * slope + y + 0.047 for at_x in (outer, inner))
    return (outer, below), (inner, tip), (outer, below + 0.10)


#: Where the arch ends on the left: what comes down there goes on among the bumpers.
DEFLECTOR = ((-HALF, 0.765), (-0.190, 0.70), (-HALF, 0.665))
#: The middles of the targets, and half the length of one, in m.
TARGETS = ((-HALF + 0.004, 0.48), (-HALF + 0.004, 0.58), (HALF - 0.008, 0.42))
TARGET = 0.02


@lru_cache(maxsize=4)
def standing(rest: float, rubber: float, kick: float, restitution: float, friction: float) -> tuple[Surface, ...]:
    """Slings, walls and targets, for flippers at rest at an angle in rad; they stay while a game is played."""
    guides, corners = inlane(rest), sling(rest)
    walls = chain((OUTER, PLUNGER - 0.05), *arch(), (-HALF, 0.0)) + chain((HALF, 0.0), (HALF, ARCH))
    walls += chain(*DEFLECTOR)
    surfaces = []
    for side in (same, mirrored):
        a, b, c = map(side, corners)
        walls += [*chain(*map(side, guides)), *chain(c, a, b)]
        surfaces.append(Surface("sling", Segment(b, c, WALL), rubber, friction, kick=kick))
    surfaces += [Surface("wall", shape, restitution, friction) for shape in walls]
    for x, y in TARGETS:
        surfaces.append(Surface("target", Segment((x, y - TARGET), (x, y + TARGET), WALL), restitution, friction))
    return tuple(surfaces)


def build(parameters: Parameters) -> Setup:
    """The ball on the plunger, the table, and the flippers as they are moved. Raises RequestError for times that do not
    follow one another."""
    it, table, kicks = parameters, parameters.table, parameters.kicks
    bounce, rest = (table.restitution, table.friction), it.flippers.rest * DEGREE
    pull = ROLLING * table.gravity * sin(table.incline * DEGREE)
    surfaces = [*standing(rest, kicks.restitution, kicks.sling, *bounce)]
    for spot in it.bumpers:
        round_ = Circle((spot.x, spot.y), spot.radius)
        surfaces.append(Surface("bumper", round_, kicks.restitution, table.friction, kick=kicks.bumper))
    spring = Segment((HALF, PLUNGER), (OUTER, PLUNGER))
    surfaces.append(Surface("plunger", spring, 0.2, table.friction, kick=kicks.plunger))
    surfaces += [_flipper(it, name, sign) for name, sign in (("left", 1.0), ("right", -1.0))]
    ball = Ball(
        "ball",
        it.ball.mass,
        it.ball.radius,
        (LANE, PLUNGER + it.ball.radius + 1e-3),
        it.launch.velocity,
        forces=[Gravity(pull, it.ball.mass)],
    )
    drain = Trap("drain", (-HALF, -0.03), 0.06, end=(HALF, -0.03))
    return Setup([ball], surfaces, duration=LONGEST, traps=[drain])


def _flipper(parameters: Parameters, name: str, sign: float) -> Surface:
    """A flipper, turned as its button is held: ``sign`` is 1 for the left one, -1 for its mirror image."""
    it, pivot = parameters.flippers, (-sign * PIVOT[0], PIVOT[1])
    shape = Segment(pivot, (pivot[0] + sign * LENGTH, pivot[1]), BAT)
    surface = Surface(f"{name} flipper", shape, it.restitution, parameters.table.friction)
    rest, up = it.rest * DEGREE, it.up * DEGREE
    return Moving(surface, strokes(f"flippers.{name}", getattr(it, name), pivot, sign, (rest, up), (it.rise, it.fall)))


def strokes(key: str, held: Sequence[Vector], pivot: Vector, sign: float, ends: Vector, lasts: Vector) -> InTurn:
    """Turning from one of the ``ends`` (rad) to the other in so many s while held, and back afterwards, from wherever
    it is then. Raises RequestError for times that do not follow one another."""
    times = [t for pair in held for t in pair]
    if any(later <= before for before, later in pairwise(times)):
        raise RequestError(f"{key} = {[list(pair) for pair in held]!r:.80} s: each time must be after the one before")
    (rest, up), (rise, fall) = ends, lasts
    rates = (up - rest) / rise, (rest - up) / fall
    pieces, angle = [(-1.0, Turning(pivot, 0.0, sign * rest))], rest
    for number, (t, until) in enumerate(pairwise([*times, 2.0 * LONGEST])):
        end, rate = (rest, rates[1]) if number % 2 else (up, rates[0])
        arrives = t + (end - angle) / rate
        if arrives > t:
            pieces.append((t, Turning(pivot, sign * rate, sign * angle, t)))
        angle = end if arrives <= until else angle + rate * (until - t)
        if t < arrives < until:
            pieces.append((arrives, Turning(pivot, 0.0, sign * end)))
    return InTurn(pieces)


def hits(events: Sequence[Event], name: str) -> int:
    """Count how often the ball hit things of this name."""
    return sum(event.kind == "impact" and event.partner == name for event in events)


def score(events: Sequence[Event], parameters: Parameters) -> int:
    """The points of all hits."""
    points = parameters.points
    return sum(getattr(points, name) * hits(events, name) for name in ("bumper", "sling", "target"))


def lost(run: Run, parameters: Parameters) -> bool:
    """True if the ball is in the drain."""
    return run.caught_at("ball") is not None


def flips(run: Run, parameters: Parameters) -> int:
    """Count the strokes up that struck the ball."""
    it, struck = parameters.flippers, 0
    for name, held in (("left flipper", it.left), ("right flipper", it.right)):
        times = [event.t for event in run.events if event.kind == "impact" and event.partner == name]
        struck += sum(any(start <= t <= min(end, start + it.rise) for t in times) for start, end in held)
    return struck


FACTS = (
    Fact("score", "score", "", lambda run, it: score(run.events, it)),
    Fact("bumpers", "bumpers", "", lambda run, _: hits(run.events, "bumper")),
    Fact("slings", "slings", "", lambda run, _: hits(run.events, "sling")),
    Fact("targets", "targets", "", lambda run, _: hits(run.events, "target")),
    Fact("flips", "struck by flippers", "", flips),
    Fact("highest", "highest", "m", apex),
    Fact("time", "time in play", "s", lambda run, _: run.duration),
    Fact("lost", "", "", lost),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    points = f"{run.result['score']:,} points"
    if run.result["lost"]:
        return f"{points}, lost after {run.duration:.0f} s"
    return f"{points}, the ball lies still" if run.result["ended"] == "rest" else f"{points} in {run.duration:.0f} s"
