"""Putting from above: the break of a sloping green, how fast it is, and the hole that holds a ball slow enough.

Models: sliding until the ball rolls; rolling that slows as a stimpmeter says; the pull of gravity along a green that
slopes evenly, or whose slope across turns over on the way; a hole that holds a ball only if it is slow enough, the
slower the farther from its middle (Holmes 1991, Penner 2002).
Leaves out: what the rim does to a ball that it does not hold, which turns a lip-out aside and slows it; that the hole
holds a ball that is faster uphill, by 1 % at a grade of 3 %; that a slope is seen shorter from above (0.1 % at 5 %);
grain; and the small hops of a ball just struck. No measured break of a putt was found.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, hypot, sin
from typing import Any, NamedTuple

from sandbox.kit import (
    DEGREE,
    ENDED,
    Controls,
    Event,
    Fact,
    Group,
    Handle,
    RequestError,
    Run,
    SceneParameters,
    SceneRun,
    Setup,
    Slope,
    Spread,
    State,
    Trap,
    Until,
    cached_per_run,
    group,
    quantity,
    roughly,
)
from sandbox.physics.turf import stimp_resistance
from sandbox.sport.putting import PERCENT, GolfBall, Putt, holed, next_putt

LONGEST = 60.0  # s, after which a putt is ended
#: The green ends so far from the hole, in m.
EDGE = 15.0
#: A putt that breaks less than this, in m, is said to be straight.
STRAIGHT = 0.02


class Hole(Group):
    """The hole, at the origin."""

    radius: float = quantity(..., "m", 0.02, 1, "radius")
    fastest: float = quantity(..., "m/s", 0.01, 100, "the highest speed over its middle at which it holds a ball")


class Green(Group):
    """The green: how fast it is, and how it slopes at the hole."""

    stimp: float = quantity(..., "m", 0.3, 12, "reading of a stimpmeter")
    sliding: float = quantity(..., "", 0.01, 10, "friction of a sliding ball")
    spinning: float = quantity(..., "", 0, 1, "torque about the vertical over m g r")
    grade: float = quantity(..., "%", -15, 15, "rise along x")
    cross: float = quantity(..., "%", -15, 15, "rise to the left")
    twist: float = quantity(..., "%", -15, 15, "by which the rise to the left grows in each metre along x")


class Parameters(SceneParameters):
    """All parameters of a putt."""

    gravity: float = quantity(..., "m/s^2", 0.1, 100, "gravity")
    launch: Putt = group(..., "the ball as it leaves the putter")
    ball: GolfBall = group(..., "the ball; the hole is the origin")
    hole: Hole = group(..., "the hole")
    green: Green = group(..., "the green")
    putt: int = quantity(..., "", 1, 1000, "which putt of this green it is")


CONTROLS = Controls(
    full_pull_speed=5.0,
    sliders=("launch.speed", "launch.angle", "green.stimp", "green.grade", "green.cross", "green.twist"),
    handles=(Handle("ball.x", "ball.y"),),
    scores="holed",
    spread=(Spread("launch.speed", 0.03), Spread("launch.angle", minimum=0.6)),  # assumed
    next_start=next_putt,
)


@dataclass(frozen=True)
class OffGreen(Until):
    """Ends a run when the ball is off the green."""

    def passed(self, start: State, end: State) -> Any:
        return end[0] * end[0] + end[1] * end[1] > EDGE * EDGE


def build(parameters: Parameters) -> Setup:
    """The ball, the green and the hole. Raises RequestError if the ball is not on the green, or cannot roll there."""
    it, green, hole = parameters, parameters.green, parameters.hole
    if (far := hypot(it.ball.x, it.ball.y)) > EDGE:
        raise RequestError(f"ball.x, ball.y: it lies {far:.1f} m from the hole: the green ends at {EDGE:g} m")
    usual = green.sliding, stimp_resistance(green.stimp), green.spinning, it.gravity
    rise = [-PERCENT * it.gravity * slope for slope in (green.grade, green.cross, green.twist)]
    try:
        plane = Slope(*usual, 0.4, "green", *rise)
    except ValueError as error:
        raise RequestError(f"green.grade = {green.grade:g} %, green.cross = {green.cross:g} %: {error}") from None
    return Setup(
        [it.ball.putted(it.launch)],
        duration=LONGEST,
        until=OffGreen(),
        plane=plane,
        traps=[Trap("hole", (0.0, 0.0), hole.radius, fastest=hole.fastest)],
    )


class Arrival(NamedTuple):
    """The ball as its centre comes to the hole's edge, or else to the height of the hole."""

    along: float  # speed in m/s
    aside: float  # m, to the left of the hole's middle that it is bound to pass
    broken: float  # m, to the left of the line on which it was struck, there


def met_hole(run: Run) -> Event | None:
    """The event with which the ball first comes over the hole's edge: "caught" or "over"; None if it never does."""
    return next((event for event in run.events if event.kind in ("caught", "over")), None)


@cached_per_run
def arrival(run: Run, parameters: Parameters) -> Arrival | None:
    """The ball at the hole; None if it is short of it. Both distances are across the line from ball to hole."""
    it, event = parameters, met_hole(run)
    bearing = atan2(-it.ball.y, -it.ball.x)
    ex, ey = cos(bearing), sin(bearing)
    if event is not None:
        x, y, vx, vy = run.before("ball", event.t)[:4]
    elif (found := run.first_crossing("ball", (0.0, 0.0), (-ex, -ey))) is not None:
        x, y, vx, vy = found[1][:4]
    else:
        return None
    short, aside = -(x * ex + y * ey), y * ex - x * ey
    ahead, left = vx * ex + vy * ey, vy * ex - vx * ey
    aside += short * left / ahead if ahead > 0.0 else 0.0
    off, far = it.launch.angle * DEGREE - bearing, hypot(it.ball.x, it.ball.y)
    line = far * sin(off) / cos(off) if cos(off) > 0.0 else 0.0
    return Arrival(hypot(vx, vy), aside, aside - line)


def _of_arrival(run: Run, parameters: Parameters, name: str) -> float | None:
    found = arrival(run, parameters)
    return None if found is None else float(getattr(found, name))


def _to_hole(run: Run, parameters: Parameters) -> float | None:
    """The distance in m from the ball at the end to the middle of the hole; None if it is in the hole."""
    stop = run.state("ball", run.duration)[:2]
    return None if holed(run, parameters) else hypot(*stop)


def _word(run: Run, parameters: Parameters) -> str:
    """holed; lip out: slow enough for the middle of the hole, but not for where it came; over; short; wide."""
    event = met_hole(run)
    if event is None:
        return "short" if arrival(run, parameters) is None else "wide"
    if event.kind == "caught":
        return "holed"
    return "holed after all" if holed(run, parameters) else ("lip out", "over")[event.speed > parameters.hole.fastest]


FACTS = (
    Fact("break", "break", "m", lambda run, it: _of_arrival(run, it, "broken"), sides=("right", "left")),
    Fact("speed_at_hole", "speed at the hole", "m/s", lambda run, it: _of_arrival(run, it, "along")),
    Fact("aside", "off the middle", "m", lambda run, it: _of_arrival(run, it, "aside"), sides=("right", "left")),
    Fact("to_hole", "to the hole", "m", _to_hole),
    Fact("putts", "putts", "", lambda run, it: it.putt, "start"),
    Fact("time", "time", "s", lambda run, _: run.duration),
    Fact("holed", "", "", holed),
    Fact("verdict", "", "", _word),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    result, event = run.result, met_hole(run)
    bend = result["break"]
    bends = "straight" if bend is None or abs(bend) < STRAIGHT else f"breaking {roughly(abs(bend))} to the "
    way = bends if bends == "straight" else bends + ("left" if bend > 0.0 else "right")
    if result["holed"]:
        return f"{'Holed' if parameters.putt == 1 else f'Holed with putt {parameters.putt}'}, {way}"
    if result["ended"] != "rest":
        return "Runs off the green" if result["ended"] == "until" else f"Still moving after {run.duration:.0f} s"
    end = f"stops {roughly(result['to_hole'])} from the hole"
    if event is not None:
        said = {"lip out": f"Lips out {roughly(abs(result['aside']))} off the middle", "over": "Runs over the hole"}
        return f"{said[result['verdict']]} at {event.speed:.1f} m/s, {end}"
    if result["verdict"] == "short":
        return f"Short: {end}"
    side = "left" if result["aside"] > 0.0 else "right"
    return f"Passes {roughly(abs(result['aside']))} {side} of the hole, stops {roughly(result['to_hole'])} from it"
