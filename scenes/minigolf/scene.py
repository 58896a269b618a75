"""Minigolf from above: a putt off boards, past blades that turn and gates that move, up ramps, into the hole.

Models: sliding on felt until the ball rolls, rolling, a strip of slower felt; a ramp, and a tilt of the whole lane, as
the pull of gravity along them; boards; blades and gates driven as given, whatever meets them; a hole that holds a ball
only if it is slow enough, the slower the farther from its middle (Holmes 1991, Penner 2002).
Leaves out: jumps, that a ramp is seen shorter from above (0.5 % at 1 in 10), and the lip of the hole, which turns a
ball that just misses or is just too fast. Not validated:
boards and blades, whose numbers are assumed, and ramps.
"""

from __future__ import annotations

from itertools import pairwise
from math import cos, dist, pi, sin

from sandbox.kit import (
    DEGREE,
    ENDED,
    Cloth,
    Controls,
    Fact,
    Group,
    Handle,
    Moving,
    RequestError,
    Run,
    SceneParameters,
    SceneRun,
    Segment,
    Setup,
    Slope,
    Spread,
    Strips,
    Surface,
    Swinging,
    Trap,
    Turning,
    Vector,
    group,
    groups,
    quantity,
    rectangle,
    roughly,
)
from sandbox.physics.turf import stimp_resistance
from sandbox.sport.putting import PERCENT, GolfBall, Putt, holed, next_putt

#: Half the thickness in m of boards within the lane, of blades and of gates; s after which a putt is ended.
BOARD, BLADE, LONGEST = 0.02, 0.015, 60.0


class Lane(Group):
    """The lane, its boards and its felt."""

    length: float = quantity(..., "m", 1, 50, "between the boards at its ends")
    width: float = quantity(..., "m", 0.3, 20, "between the boards at its sides")
    restitution: float = quantity(..., "", 0, 1, "of ball and boards")
    friction: float = quantity(..., "", 0, 10, "of ball and boards")


class Felt(Group):
    """The felt, and a strip of slower felt across the lane."""

    stimp: float = quantity(..., "m", 0.3, 12, "reading of a stimpmeter")
    sliding: float = quantity(..., "", 0.01, 10, "friction of a sliding ball")
    spinning: float = quantity(..., "", 0, 1, "torque about the vertical over m g r")
    rough_start: float = quantity(..., "m", -25, 25, "where the strip begins")
    rough_end: float = quantity(..., "m", -25, 25, "where it ends; not beyond its start: there is none")
    rough_stimp: float = quantity(..., "m", 0.05, 12, "reading of a stimpmeter on the strip")
    ramp_start: float = quantity(..., "m", -25, 25, "where a ramp across the lane begins")
    ramp_end: float = quantity(..., "m", -25, 25, "where it ends; not beyond its start: there is none")
    ramp_rise: float = quantity(..., "m", -2, 2, "how much higher its end is than its start")
    grade: float = quantity(..., "%", -20, 20, "rise of the whole lane along it")
    cross: float = quantity(..., "%", -20, 20, "rise of the whole lane to its left")


class Hole(Group):
    """The hole."""

    x: float = quantity(..., "m", -25, 25, "its middle, along the lane")
    y: float = quantity(..., "m", -10, 10, "its middle, to the left")
    radius: float = quantity(..., "m", 0.02, 1, "radius")
    fastest: float = quantity(..., "m/s", 0.01, 100, "the highest speed over its middle at which it holds a ball")


class Wall(Group):
    """A board within the lane."""

    x1: float = quantity(0.0, "m", -25, 25, "one end, along the lane")
    y1: float = quantity(0.0, "m", -10, 10, "one end, to the left")
    x2: float = quantity(0.0, "m", -25, 25, "other end, along the lane")
    y2: float = quantity(0.3, "m", -10, 10, "other end, to the left")


class Mill(Group):
    """Blades that turn about a post."""

    x: float = quantity(0.0, "m", -25, 25, "the post, along the lane")
    y: float = quantity(0.0, "m", -10, 10, "the post, to the left")
    blades: int = quantity(3, "", 1, 8, "number of blades")
    length: float = quantity(0.37, "m", 0.05, 10, "of a blade, from the post")
    rate: float = quantity(-20.0, "rpm", -600, 600, "how fast they turn, counter-clockwise positive")
    angle: float = quantity(38.0, "deg", -360, 360, "of the first blade from along the lane, when the ball is struck")


class Gate(Group):
    """A board across the lane that goes to and fro across it."""

    x: float = quantity(0.0, "m", -25, 25, "where it is, along the lane")
    y: float = quantity(0.0, "m", -10, 10, "the middle of its motion, to the left")
    width: float = quantity(0.3, "m", 0.02, 10, "of the gate")
    travel: float = quantity(0.22, "m", 0, 10, "how far it goes to each side")
    period: float = quantity(2.0, "s", 0.1, 100, "time to and fro")
    phase: float = quantity(0.0, "deg", -360, 360, "of its motion when the ball is struck; 90: at the left")


class Parameters(SceneParameters):
    """All parameters of a putt."""

    gravity: float = quantity(..., "m/s^2", 0.1, 100, "gravity")
    launch: Putt = group(..., "the ball as it leaves the putter")
    ball: GolfBall = group(..., "the ball; the middle of the lane is the origin")
    hole: Hole = group(..., "the hole")
    lane: Lane = group(..., "the lane")
    felt: Felt = group(..., "the felt")
    mills: list[Mill] = groups(..., "blades that turn")
    gates: list[Gate] = groups(..., "gates that move")
    walls: list[Wall] = groups(..., "boards within the lane")
    restitution: float = quantity(..., "", 0, 1, "of ball and blades or gates")
    friction: float = quantity(..., "", 0, 10, "of ball and blades or gates")
    putt: int = quantity(..., "", 1, 1000, "which putt of this lane it is")


CONTROLS = Controls(
    full_pull_speed=8.0,
    sliders=("launch.speed", "launch.angle", "mills[0].angle", "mills[0].rate", "felt.stimp", "felt.ramp_rise"),
    handles=(
        Handle("hole.x", "hole.y"),
        Handle("ball.x", "ball.y"),
        Handle("mills[*].x", "mills[*].y"),
        Handle("gates[*].x", "gates[*].y"),
    ),
    scores="holed",
    spread=(Spread("launch.speed", 0.02), Spread("launch.angle", minimum=0.4)),  # assumed
    next_start=next_putt,
)


def build(parameters: Parameters) -> Setup:
    """The ball, the boards, what moves, the felt and the hole. Raises RequestError if the hole is not on the lane, or
    a wall has no length."""
    it, ball, hole, lane = parameters, parameters.ball, parameters.hole, parameters.lane
    x, y = 0.5 * lane.length, 0.5 * lane.width
    for name, place, half in (("x", hole.x, x), ("y", hole.y, y)):
        if abs(place) > half:
            raise RequestError(f"hole.{name} = {place:g} m: the lane is from {-half:g} to {half:g} m")
    for i, wall in enumerate(it.walls):
        if (wall.x1, wall.y1) == (wall.x2, wall.y2):
            raise RequestError(f"walls[{i}]: both ends are at ({wall.x1:g}, {wall.y1:g}) m: a wall needs a length")
    boards = [Segment(*ends) for ends in pairwise(rectangle(-x, -y, x, y))]
    boards += [Segment((wall.x1, wall.y1), (wall.x2, wall.y2), BOARD) for wall in it.walls]
    return Setup(
        [ball.putted(it.launch)],
        [*(Surface("board", shape, lane.restitution, lane.friction) for shape in boards), *_driven(it)],
        duration=LONGEST,
        plane=_felt(it),
        traps=[Trap("hole", (hole.x, hole.y), hole.radius, fastest=hole.fastest)],
    )


def _driven(parameters: Parameters) -> list[Surface]:
    """The blades and the gates."""
    bounce = parameters.restitution, parameters.friction
    moving = []
    for mill in parameters.mills:
        post, rate = (mill.x, mill.y), mill.rate * pi / 30.0
        for i in range(mill.blades):
            turn = 2.0 * pi * i / mill.blades
            tip = mill.x + mill.length * cos(turn), mill.y + mill.length * sin(turn)
            motion = Turning(post, rate, mill.angle * DEGREE)
            moving.append(Moving(Surface("blade", Segment(post, tip, BLADE), *bounce), motion))
    for gate in parameters.gates:
        ends = (gate.x, gate.y - 0.5 * gate.width), (gate.x, gate.y + 0.5 * gate.width)
        to_and_fro = Swinging((gate.x, gate.y), 0.0, gate.period, gate.phase * DEGREE, shift=(0.0, gate.travel))
        moving.append(Moving(Surface("gate", Segment(*ends, BLADE), *bounce), to_and_fro))
    return moving


def _felt(parameters: Parameters) -> Cloth | Strips:
    """The felt, the strip, the ramp and the tilt. Raises RequestError for a ramp on which no ball would roll."""
    felt, gravity = parameters.felt, parameters.gravity
    rough, ramp = (felt.rough_start, felt.rough_end), (felt.ramp_start, felt.ramp_end)
    uphill = felt.ramp_rise / (ramp[1] - ramp[0]) if ramp[1] > ramp[0] else 0.0

    def law(x: float) -> Cloth:
        """Return the felt at x m along the lane."""
        resistance = stimp_resistance(felt.rough_stimp if rough[0] < x < rough[1] else felt.stimp)
        usual = felt.sliding, resistance, felt.spinning, gravity
        on_ramp = ramp[0] < x < ramp[1] and uphill != 0.0
        rise = PERCENT * felt.grade + on_ramp * uphill
        if rise == felt.cross == 0.0:
            return Cloth(*usual, name="felt")
        try:
            return Slope(*usual, name="felt", pull_x=-gravity * rise, pull_y=-PERCENT * gravity * felt.cross)
        except ValueError as error:
            tilt = f"felt.grade = {felt.grade:g} %, felt.cross = {felt.cross:g} %"
            raise RequestError(f"{f'felt.ramp_rise = {felt.ramp_rise:g} m' if on_ramp else tilt}: {error}") from None

    edges = sorted({edge for ends in (rough, ramp) if ends[1] > ends[0] for edge in ends})
    if not edges:
        return law(0.0)
    middles = [edges[0] - 1.0, *(0.5 * (a + b) for a, b in pairwise(edges)), edges[-1] + 1.0]
    return Strips(edges, [law(x) for x in middles])


def _to_hole(run: Run, parameters: Parameters) -> float | None:
    """The distance in m from the ball at the end to the middle of the hole; None if it is in the hole."""
    stop: Vector = run.state("ball", run.duration)[:2]
    return None if holed(run, parameters) else dist(stop, (parameters.hole.x, parameters.hole.y))


def _hits(run: Run, *names: str) -> int:
    """Count how often the ball hit one of these."""
    return sum(event.kind == "impact" and event.partner in names for event in run.events)


def _over_hole(run: Run, parameters: Parameters) -> float | None:
    """The speed in m/s at which the ball entered the hole."""
    return next((event.speed for event in run.events if event.kind == "caught"), None)


FACTS = (
    Fact("to_hole", "to the hole", "m", _to_hole),
    Fact("bounces", "off boards", "", lambda run, _: _hits(run, "board")),
    Fact("struck", "struck by blades", "", lambda run, _: _hits(run, "blade", "gate")),
    Fact("speed_at_hole", "speed at the hole", "m/s", _over_hole),
    Fact("putts", "putts", "", lambda run, it: it.putt, "start"),
    Fact("time", "time", "s", lambda run, _: run.duration),
    Fact("holed", "", "", holed),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    result = run.result
    ways = [f"off {result['bounces']} board{'s'[: result['bounces'] > 1]}"] if result["bounces"] else []
    ways += ["struck on its way"] if result["struck"] else []
    way = ", ".join(["", *ways])
    if result["holed"]:
        return ("Hole in one" if parameters.putt == 1 else f"Holed with putt {parameters.putt}") + way
    if result["ended"] == "duration":
        return f"Still moving after {run.duration:.0f} s{way}"
    return f"Stops {roughly(result['to_hole'])} from the hole{way}"
