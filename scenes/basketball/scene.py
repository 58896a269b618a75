"""Basketball from the side: from the hand to the ring, directly or off rim and backboard.

Models: gravity; drag and lift in flight; impacts with rim, bracket, backboard and floor, with spin and friction; the
net, which slows a ball that falls through it (its form and strength are assumed: no measurement was found); wind if
the scene file sets it.
Leaves out: the ball's loss of spin in the air; everything sideways, so the ring is two tubes and a shot is never off to
the side; the deformation of ball, rim and board.

Sizes of effects, measured on the default free throw as the shift of the point where the ball comes down to the ring:
1 m/s of headwind, 7.5 cm shorter. Of what is modelled, drag takes 45 cm, and lift as large as the spin ratio (assumed),
Cl = S = 0.3, carries it 9.5 cm further and makes it 1.4 deg steeper: without it the same shot takes 0.07 m/s more. The
swish is 10 cm wide: from 4.7 cm short of the middle of the ring to 5.3 cm beyond it. The net costs 76 % more force
evaluations (524 instead of 298, 60 % more time), and a swish lands 1.6 m nearer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from sandbox.engine.run import Event, Run
from sandbox.engine.setup import Circle, Patch, Segment, Setup, Surface, Until, Vector
from sandbox.errors import RequestError
from sandbox.parameters import Accuracy, Group, group, quantity, switch
from sandbox.physics.elementwise import anywhere, clip
from sandbox.physics.integrators import State
from sandbox.sport.air import Air
from sandbox.sport.amounts import roughly
from sandbox.sport.controls import Controls, Handle, Spin, Spread
from sandbox.sport.facts import ENDED, Fact, once
from sandbox.sport.flight import FlyingBall, Launch, forces_in_flight, launched_ball
from sandbox.sport.readings import LAUNCH, Moment, at, before
from sandbox.sport.solids import Extent, Solid, below, check_apart, disc


class Release(Group):
    """Where the ball leaves the hand."""

    height: float = quantity(..., "m", 0, 100, "of the ball's centre above the floor")


class Hoop(Solid):
    """The ring, seen from the side: two tubes."""

    distance: float = quantity(..., "m", 0, 500, "from the release to the middle of the ring")
    height: float = quantity(..., "m", 0.1, 100, "of the tubes' middle above the floor")
    inner_diameter: float = quantity(..., "m", 0.01, 5, "between the inner edges of the tubes")
    tube_radius: float = quantity(..., "m", 0.0005, 0.2, "radius of the tube")


class Backboard(Solid):
    """The board behind the ring."""

    gap: float = quantity(..., "m", 0, 5, "from the inner edge of the ring to the face of the board")
    bottom: float = quantity(..., "m", 0, 100, "lower edge above the floor")
    top: float = quantity(..., "m", 0, 100, "upper edge above the floor")
    thickness: float = quantity(..., "m", 0.001, 1, "thickness")


class Net(Group):
    """The net below the ring."""

    slows: bool = switch(..., "whether it slows the ball, or is only drawn")
    length: float = quantity(..., "m", 0.1, 2, "length")
    damping: float = quantity(..., "1/s", 0, 100, "deceleration over speed of a ball falling through it")


class Parameters(Group):
    """All parameters of a shot."""

    launch: Launch = group(..., "the ball just after it leaves the hand")
    release: Release = group(..., "where it leaves the hand")
    gravity: float = quantity(..., "m/s^2", 0, 30, "gravity")
    air: Air = group(..., "the air")
    ball: FlyingBall = group(..., "the ball")
    hoop: Hoop = group(..., "the ring")
    backboard: Backboard = group(..., "the board")
    net: Net = group(..., "the net")
    floor: Solid = group(..., "the floor")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


CONTROLS = Controls(
    strongest=16.0,
    spins=(Spin("launch.spin", 20.0),),
    sliders=("launch.speed", "launch.angle", "launch.spin", "release.height", "hoop.distance", "air.wind", "gravity"),
    handles=(
        Handle("hoop.distance", "hoop.height", goal=True),
        Handle(y="release.height"),
        Handle("backboard.gap", "backboard.top", at=lambda parameters: board(parameters)[::3]),
    ),
    scores="made",
    spread=(Spread("launch.speed", 0.01), Spread("launch.angle", least=1.0), Spread("launch.spin", 0.2)),  # assumed
)

#: A shot still moving after this time in s is ended.
LONGEST = 60.0

#: The floor reaches this far in both directions, in m: as far as the fastest ball gets in that time.
FAR = 25_000.0

#: The run is over when the ball comes down on the floor no faster than this, in m/s: after a few bounces.
TIRED = 3.0

#: Thickness of the bracket over that of the tube: a ball between ring and board rests on the tube. Assumed.
BRACKET_SHARE = 0.5


@dataclass(frozen=True)
class NetDrag:
    """The net around a ball that passes through: ``F = -m k (4 vx, vy)`` inside a box below the ring, k in 1/s.

    It resists sideways motion more than falling. The force begins and ends over a short distance, so that it has no
    jumps. All of it is assumed: no measurement of a net was found.
    """

    #: Sideways over downwards.
    HOLD = 4.0

    #: The distance in m over which the force begins and ends.
    EDGE = 0.05

    mass: float  # kg
    damping: float  # 1/s
    middle: Vector  # m
    half_width: float  # m
    length: float  # m

    @property
    def patch(self) -> Patch:
        """Where it acts: no integration step may skip it."""
        (x, y), aside = self.middle, self.half_width + self.EDGE
        return Patch(x - aside, y - self.length, x + aside, y, step=0.02)

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        x, y = position
        depth = self.middle[1] - y
        inside = self.half_width - abs(x - self.middle[0])
        if not anywhere((depth > 0.0) & (depth < self.length) & (inside > -self.EDGE)):
            return 0.0, 0.0
        hold = (
            _smooth(depth / self.EDGE) * _smooth((self.length - depth) / self.EDGE) * _smooth(1.0 + inside / self.EDGE)
        )
        k = -self.mass * self.damping * hold
        return self.HOLD * k * velocity[0], k * velocity[1]


def _smooth(x: Any) -> Any:
    """0 below 0, 1 above 1, smooth between."""
    s = clip(x, 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)


def build(parameters: Parameters) -> Setup:
    """Ball, ring, board and floor. Raises RequestError if they overlap."""
    _check(parameters)
    ball, hoop, net = parameters.ball, parameters.hoop, parameters.net
    forces = forces_in_flight(ball, parameters.air, parameters.gravity)
    drag = NetDrag(ball.mass, net.damping, (hoop.distance, hoop.height), 0.5 * hoop.inner_diameter, net.length)
    if net.slows:
        forces.append(drag)
    shot = launched_ball(parameters.launch, ball, (0.0, parameters.release.height), forces)
    patches = [drag.patch] if net.slows else []
    return Setup([shot], _court(parameters), duration=LONGEST, until=_is_tired, patches=patches)


def _is_tired(event: Event) -> bool:
    return event.partner == "floor" and event.speed <= TIRED


def rims(parameters: Parameters) -> tuple[Vector, Vector]:
    """Middles of the front and the back tube, in m."""
    hoop = parameters.hoop
    aside = 0.5 * hoop.inner_diameter + hoop.tube_radius
    return (hoop.distance - aside, hoop.height), (hoop.distance + aside, hoop.height)


def board(parameters: Parameters) -> tuple[float, float, float, float]:
    """Left (the face), bottom, right and top of the board, in m."""
    hoop, backboard = parameters.hoop, parameters.backboard
    face = hoop.distance + 0.5 * hoop.inner_diameter + backboard.gap
    return face, backboard.bottom, face + backboard.thickness, backboard.top


def _check(parameters: Parameters) -> None:
    """Raise RequestError for what is upside down, or in something else."""
    hoop, backboard = parameters.hoop, parameters.backboard
    if backboard.top <= backboard.bottom:
        raise RequestError(
            f"backboard.top = {backboard.top:g} m is not above backboard.bottom = {backboard.bottom:g} m: swap them"
        )
    place, tube = ("hoop.distance", "hoop.height", "hoop.tube_radius"), hoop.tube_radius
    front, back = (disc("the ring", place, *rim, tube) for rim in rims(parameters))
    glass = Extent("the board", ("backboard.gap", "backboard.bottom", "backboard.top"), *board(parameters))
    release = ("release.height", "ball.radius")
    ball = disc("the ball", release, 0.0, parameters.release.height, parameters.ball.radius)
    for others in ((front, glass), (back, glass), (front, below("the floor"))):
        check_apart(parameters, ball, *others)


def _court(parameters: Parameters) -> list[Surface]:
    hoop, backboard = parameters.hoop, parameters.backboard
    front, back = rims(parameters)
    left, bottom, right, top = board(parameters)
    corners = [(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)]
    return [
        parameters.floor.surface("floor", Segment((-FAR, 0.0), (FAR, 0.0))),
        hoop.surface("rim front", Circle(front, hoop.tube_radius)),
        hoop.surface("rim back", Circle(back, hoop.tube_radius)),
        hoop.surface("bracket", Segment(back, (left, back[1]), BRACKET_SHARE * hoop.tube_radius)),
        *backboard.outline("backboard", corners),
    ]


@once
def _through(run: Run, parameters: Parameters) -> float | None:
    """When the ball left the ring below, in s, having come down through it between its inner edges; None if never."""
    hoop, radius = parameters.hoop, parameters.ball.radius
    half = 0.5 * hoop.inner_diameter
    inside = [t for t, state in _downs(run, parameters) if abs(state[0] - hoop.distance) < half]
    for t in inside:
        back_up = next((at for at, _ in run.crossings("ball", (0.0, hoop.height), (0.0, -1.0)) if at > t), run.duration)
        below = (at for at, _ in run.crossings("ball", (0.0, hoop.height - radius), (0.0, 1.0)) if t < at <= back_up)
        left = next(below, None)
        if left is not None:
            return left
    return None


def _downs(run: Run, parameters: Parameters) -> Iterator[tuple[float, State]]:
    """Each time and state at which the ball's centre falls to the ring's height."""
    return run.crossings("ball", (parameters.hoop.distance, parameters.hoop.height), (0.0, 1.0))


def _on_floor(run: Run) -> float:
    """When the ball reaches the floor, or the run ends."""
    return next((event.t for event in run.events if event.partner == "floor"), run.duration)


@once
def entry(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it first falls to the ring's height, or first touches something there if that is earlier."""
    down = next((Moment(t, *state) for t, state in _downs(run, parameters)), None)
    first = next((event.t for event in run.events if event.partner != "floor"), None)
    floor = _on_floor(run)
    if first is not None and first <= floor and (down is None or first < down.t):
        down = before(run, first)
    return down if down is not None and down.t <= floor else None


@once
def _touches(run: Run, parameters: Parameters) -> list[str]:
    """The surfaces touched until the shot was decided: by leaving the ring below, or by reaching the floor."""
    through = _through(run, parameters)
    decided = _on_floor(run) if through is None else through
    return [event.partner for event in run.events if event.kind in ("impact", "contact") and event.t <= decided]


@dataclass(frozen=True)
class Decided(Until):
    """The ball is on the floor; or it has left the ring below, falling faster than a ball that rose into the ring from
    below can."""

    middle: Vector  # m, of the ring
    half_width: float  # m, between the middle and the inner edges
    below: float  # m, from the middle
    fastest: float  # m/s, at which a ball falls that was no higher than the ring

    def over(self, events: Sequence[Event]) -> bool:
        return events[-1].partner == "floor"

    def passed(self, start: State, end: State) -> Any:
        (x, height), (x0, y0, *_), (x1, y1, _, vy, _) = self.middle, start, end
        inside = (abs(x0 - x) < self.half_width) & (abs(x1 - x) < self.half_width)
        return inside & (y0 >= height - self.below) & (y1 < height - self.below) & (vy < -self.fastest)


def decided(parameters: Parameters) -> Decided:
    """When a shot is decided."""
    hoop, radius = parameters.hoop, parameters.ball.radius
    fastest = 1.1 * (2.0 * parameters.gravity * radius) ** 0.5  # drag only slows it; the rest is for lift and wind
    return Decided((hoop.distance, hoop.height), 0.5 * hoop.inner_diameter, radius, fastest)


def _made(run: Run, parameters: Parameters) -> bool:
    return _through(run, parameters) is not None


def _word(run: Run, parameters: Parameters) -> str:
    """swish; bank, off the board first; rim, off the ring first; miss."""
    if not _made(run, parameters):
        return "miss"
    touches = _touches(run, parameters)
    if not touches:
        return "swish"
    return "bank" if touches[0] == "backboard" else "rim"


def _offset(run: Run, parameters: Parameters) -> float | None:
    down = entry(run, parameters)
    return None if down is None else down.x - parameters.hoop.distance


def _apex(run: Run, parameters: Parameters) -> float:
    return run.highest("ball")[1][1] - parameters.release.height


FACTS = (
    Fact("made", "", "", _made, decided),
    Fact("verdict", "", "", _word, decided),
    Fact("entry_angle", "entry angle", "deg", at(entry, lambda ball: ball.descent), decided),
    Fact("entry_speed", "entry speed", "m/s", at(entry, lambda ball: ball.speed), decided),
    Fact("entry_offset", "from centre", "m", _offset, decided, sides=("short", "long")),
    Fact("apex", "apex above hand", "m", _apex, decided),
    Fact("flight_time", "flight time", "s", at(entry, lambda ball: ball.t), decided),
    *LAUNCH,
    Fact("touches", "touches", "", _touches, decided),
    ENDED,
)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
    result = run.result
    if result["made"]:
        how = {"swish": "nothing but net", "rim": "off the rim", "bank": "off the board"}
        return f"In, {how[result['verdict']]}"
    touched = next((name for name in result["touches"] if name != "floor"), None)
    if touched:
        return "Off the board, and out" if touched == "backboard" else "Off the rim, and out"
    offset = result["entry_offset"]
    if offset is not None:
        return f"Air ball, {roughly(abs(offset))} {'short' if offset < 0 else 'too far'}"
    return "Air ball, never as high as the ring" if "floor" in result["touches"] else "Did not come down"
