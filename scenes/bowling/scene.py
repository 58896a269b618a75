"""Bowling from above: a ball slides on the oil, hooks where it ends, and meets ten pins.

Models: sliding and rolling of the ball in closed form, with friction by strips of the lane; its own moment of inertia;
impacts of ball and pins, and of pins and the kickbacks, as discs that slide; gutters and pit.
Leaves out: how pins fall (they slide, and are down if pushed so far as to tip: not validated); flare; the axis's tilt.
An average ball loses 0.6 mph more here than is common, a released one 1.1 mph.
"""

from __future__ import annotations

from math import cos, dist, sin

from sandbox.kit import (
    DEGREE,
    ENDED,
    Ball,
    Cloth,
    Controls,
    Fact,
    Glide,
    Group,
    Handle,
    Moment,
    RequestError,
    Run,
    SceneRun,
    Segment,
    Setup,
    Spin,
    Spread,
    Strips,
    Surface,
    before,
    fact_from,
    group,
    groups,
    quantity,
    text,
)
from sandbox.sport.sliding import Slide, Sliding, SlidingDisc, beside, beyond, collisions_of, end_of, removed_by

#: USBC: from the foul line to the head pin, between pins and between their rows; from the head pin to the pit; half the
#: widths of lane and lane with gutters; in m.
HEAD, PITCH, ROW, PIT, LANE, KICKBACK = 18.288, 0.3048, 0.26396, 0.868, 0.52705, 0.7620
SPOTS = {
    str(i): (HEAD + row * ROW, PITCH * (0.5 * row - place))
    for i, (row, place) in enumerate(((row, place) for row in range(4) for place in range(row + 1)), 1)
}
ALL, ASIDE = " ".join(SPOTS), ("right", "left")


class Delivery(Slide):
    """The ball as it leaves the hand, at the foul line."""

    spin: float = quantity(..., "rpm", -1000, 1000, "revolutions; a positive number rolls ahead")
    axis: float = quantity(..., "deg", -90, 90, "its axis: 0 rolls straight ahead, 90 turns sideways, to the left")


class Oil(Group):
    """A strip of the lane that is oiled."""

    end: float = quantity(..., "m", 0, 20, "where it ends, from the foul line")
    friction: float = quantity(..., "", 0, 1, "of ball and lane")


class BowlingBall(Group):
    """The ball."""

    mass: float = quantity(..., "kg", 0.5, 20, "mass")
    radius: float = quantity(..., "m", 0.08, 0.3, "radius")
    gyration: float = quantity(..., "m", 0.01, 0.08, "radius of gyration")


class Pins(SlidingDisc):
    """The pins, all alike."""

    standing: str = text("the numbers of those that stand", may_be_empty=True)
    sliding: float = quantity(..., "", 0, 2, "friction of pin and deck")
    tips: float = quantity(..., "m", 0, 0.1, "a pin that is pushed further than this falls")


class Parameters(Sliding):
    """All parameters of a shot."""

    launch: Delivery = group(..., "the ball as it leaves the hand")
    oil: list[Oil] = groups(..., "the oiled strips")
    dry: float = quantity(..., "", 0, 1, "friction of ball and lane beyond the oil")
    ball: BowlingBall = group(..., "the ball")
    pin: Pins = group(..., "the pins")


CONTROLS = Controls(
    full_pull_speed=14.0,
    handles=(Handle(y="launch.aside"),),
    spins=(Spin("launch.spin", 20.0),),
    sliders=("launch.speed", "launch.angle", "launch.aside", "launch.spin", "launch.axis", "dry"),
    scores="strike",
    spread=(
        Spread("launch.speed", 0.015),
        Spread("launch.angle", minimum=0.25),
        Spread("launch.spin", 0.05),
    ),  # assumed
    next_start=lambda run, it: {"pin.standing": " ".join(run.result["leaves"]) or ALL},
)


def build(parameters: Parameters) -> Setup:
    """Ball and pins, the lane in strips, the kickbacks, gutters and pit."""
    it, ball, pin, launch = parameters, parameters.ball, parameters.pin, parameters.launch
    if unknown := set(pin.standing.split()) - set(SPOTS):
        raise RequestError(f"pin.standing: there is no pin {', '.join(sorted(unknown))}; there are {ALL}")
    launch.check(LANE)
    turn, axis = launch.turning, (launch.angle + launch.axis) * DEGREE  # about a level axis
    roll = -turn * sin(axis), turn * cos(axis)
    inertia = (ball.gyration / ball.radius) ** 2
    thrown = Ball("ball", ball.mass, ball.radius, (0.0, launch.aside), launch.velocity, 0.0, roll, inertia)
    oiled = sorted((oil.end, oil.friction) for oil in it.oil)
    lane = [Cloth(mu, 0.0, 0.0, it.gravity, inertia, "lane") for mu in (*(mu for _, mu in oiled), it.dry)]
    sides = [Segment((HEAD - 0.5, y), (HEAD + PIT + 0.5, y)) for y in (KICKBACK, -KICKBACK)]
    pit = beyond("pit", (HEAD + PIT, -2.0), (HEAD + PIT, 2.0), ball.radius)
    return Setup(
        [thrown, *(pin.at(name, SPOTS[name]) for name in SPOTS if name in pin.standing.split())],
        [Surface("kickback", side, pin.restitution, pin.friction) for side in sides],
        duration=20.0,
        between_balls=pin.bounce,
        plane=Glide(pin.sliding, pin.sliding, it.gravity, "deck"),
        planes=[("ball", Strips([end for end, _ in oiled], lane))],
        traps=[*beside("gutter", LANE, -1.0, HEAD + PIT, only=["ball"]), pit],
    )


def _leaves(run: Run, parameters: Parameters) -> list[str]:
    """The pins that stand in the end."""
    off, pins = removed_by(run), [ball.name for ball in run.setup.balls[1:]]
    return [name for name in pins if name not in off and dist(end_of(run, name), SPOTS[name]) <= parameters.pin.tips]


def _met(run: Run, parameters: Parameters) -> dict[str, Moment]:
    """The pins that the ball meets itself, in order, and the ball just before."""
    first: dict[str, Moment] = {}
    for name, event in collisions_of(run, "ball"):
        if name in SPOTS:
            first.setdefault(name, before(run, event.t))
    return first


def _entry(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it meets the first pin."""
    return next(iter(_met(run, parameters).values()), None)


FACTS = (
    Fact("pins", "pins", "", lambda run, it: len(run.setup.balls) - 1 - len(_leaves(run, it)), most=10),
    Fact("leaves", "leaves", "", _leaves, names=True),
    Fact("entry_angle", "entry", "deg", fact_from(_entry, "direction"), sides=ASIDE),
    Fact("offset", "off the centre", "m", fact_from(_entry, "y"), sides=ASIDE),
    Fact("entry_speed", "at the pins", "m/s", fact_from(_entry, "speed"), also="mph"),
    Fact("time", "to the pins", "s", fact_from(_entry, "t")),
    Fact("release", "release", "m/s", lambda run, it: it.launch.speed, "start", also="mph"),
    Fact("met", "", "", lambda run, it: list(_met(run, it)), names=True),
    Fact("strike", "", "", lambda run, it: len(run.setup.balls) > 10 and not _leaves(run, it)),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    leaves, pins = run.result["leaves"], run.result["pins"]
    if not pins:
        return "Gutter ball" if "ball" in removed_by(run) and removed_by(run)["ball"] == "gutter" else "No pin falls"
    if not leaves:
        return "Strike" if run.result["strike"] else "Spare"
    return f"{pins} down, leaves the {', '.join(leaves)}"
