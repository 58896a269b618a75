"""Basketball from the side: from the hand to the ring, directly or off rim and backboard.

Models: gravity; drag in flight, and lift if the scene file sets it; impacts with rim, bracket, backboard and floor,
with spin and friction; the net, which slows a ball that falls through it (its form and strength are assumed: no
measurement was found); wind if the scene file sets it. A shot that is off to the side (launch.side) is computed in
its own plane, in which the ring is two tubes as far apart as leaves the ball's centre the room that it has in the
round ring; off the board it goes on to the side with what friction leaves of that speed. Fan, map and spread scatter
to the side by launch.aside.
Leaves out: the ball's loss of spin in the air; what the side of the ring does, so a ball that falls on it misses,
while some of those go in, and one off the slope of a round ring goes elsewhere: of free throws that scatter by 1 % in
speed, 1 deg in angle and 1 deg to the side 68 % go in here, 73 % at a round ring in space, by 0.5 deg 86 and 84 %, and
straight ones alike (benchmarks/round_ring.py); the deformation of ball, rim and board.

Sizes of effects, measured on the default free throw as the shift of the point where the ball comes down to the ring:
1 m/s of headwind, 11 cm shorter; drag takes 44 cm, and 4 cm more or less for a coefficient of 0.55 or 0.45. Lift is
left out, as in textbooks: no basketball's was found measured. As large as the spin ratio, Cl = S, it would carry the
ball 9.6 cm further and make it 1.4 deg steeper. The swish is 9 cm wide: from 4.3 cm short of the middle of the ring
to 5.1 cm beyond it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from sandbox.kit import (
    DEGREE,
    ENDED,
    LAUNCH,
    Circle,
    Controls,
    EndsBy,
    Extent,
    Fact,
    Flight,
    ForceRegion,
    Group,
    Handle,
    Launch,
    Moment,
    Passes,
    RequestError,
    Rule,
    Run,
    SceneRun,
    Segment,
    Setup,
    Solid,
    Spin,
    Spread,
    State,
    Surface,
    Vector,
    anywhere,
    apex,
    below,
    cached_per_run,
    check_apart,
    disc,
    down_to,
    fact_from,
    first_time,
    group,
    level,
    maximum,
    minimum,
    of_each,
    quantity,
    rectangle,
    roughly,
    sin,
    switch,
    where,
)
from sandbox.physics.net import NetDrag


class Release(Group):
    """The place where the ball leaves the hand."""

    height: float = quantity(..., "m", 0, 100, "of the ball's centre above the floor")


class Hoop(Solid):
    """The ring, seen from the side: two tubes."""

    distance: float = quantity(..., "m", 0, 500, "from the release to the middle of the ring")
    height: float = quantity(..., "m", 0.1, 100, "of the tubes' middle above the floor")
    inner_diameter: float = quantity(..., "m", 0.01, 5, "between the inner edges of the tubes")
    tube_radius: float = quantity(..., "m", 0.0005, 0.2, "radius of the tube")

    @property
    def middle(self) -> Vector:
        """The middle of the ring, in m."""
        return self.distance, self.height

    def across(self, below: float = 0.0) -> tuple[Vector, Vector]:
        """The ring's inner edges, front and back, or places so many m below them."""
        half, y = 0.5 * self.inner_diameter, self.height - below
        return (self.distance - half, y), (self.distance + half, y)

    @property
    def rims(self) -> tuple[Vector, Vector]:
        """Middles of the front and the back tube, in m."""
        aside = 0.5 * self.inner_diameter + self.tube_radius
        return (self.distance - aside, self.height), (self.distance + aside, self.height)


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


class Shot(Launch):
    """The ball as it leaves the hand; to the side, too."""

    side: float = quantity(0.0, "deg", -45, 45, "direction to the side of the middle of the ring; 0 is straight at it")
    aside: float = quantity(..., "deg", 0, 20, "standard deviation of side, in fan, map and spread")


class Parameters(Flight):
    """All parameters of a shot."""

    launch: Shot = group(..., "the ball as it is launched")
    release: Release = group(..., "where the ball leaves the hand")
    hoop: Hoop = group(..., "the ring")
    backboard: Backboard = group(..., "the board")
    net: Net = group(..., "the net")
    floor: Solid = group(..., "the floor")

    @property
    def held(self) -> Any:
        """Height in m of the ball's centre at the release: no lower than where the ball lies on the floor."""
        return maximum(self.release.height, self.ball.radius)

    @property
    def beside(self) -> Any:
        """Distance in m of the middle of the ring from the plane in which the ball flies, which is that of the run."""
        return self.hoop.distance * sin(self.launch.side * DEGREE)

    @property
    def clearance(self) -> Any:
        """The greatest distance in m of the ball's centre from the middle of the ring, at its height, untouched."""
        return 0.5 * self.hoop.inner_diameter - self.ball.radius

    @property
    def free(self) -> Any:
        """The same along the plane in which the ball flies; 0 if it cannot pass without touching the ring's side."""
        clearance, beside = self.clearance, self.beside
        free = maximum(clearance * clearance - beside * beside, 0.0) ** 0.5
        return where(free > NARROWEST, free, 0.0)

    @property
    def section(self) -> Hoop:
        """The ring as a ball meets it that flies past its middle at a distance: two tubes nearer to each other, so that
        the ball's centre has as much room between them as in the round ring."""
        return self.hoop.model_copy(update={"inner_diameter": self.width})

    @property
    def width(self) -> Any:
        """The inner diameter of that section, in m."""
        if not anywhere(self.beside != 0.0):
            return self.hoop.inner_diameter
        narrows = (self.clearance > 0.0) & (self.free > 0.0) & (self.beside != 0.0)
        return self.hoop.inner_diameter - where(narrows, 2.0 * (self.clearance - self.free), 0.0)

    @property
    def board(self) -> tuple[float, float, float, float]:
        """Left (the face), bottom, right and top of the board, in m."""
        (_, (inner, _)), board = self.hoop.across(), self.backboard
        return inner + board.gap, board.bottom, inner + board.gap + board.thickness, board.top


CONTROLS = Controls(
    full_pull_speed=16.0,
    spins=(Spin("launch.spin", 20.0),),
    sliders=("launch.speed", "launch.angle", "launch.spin", "release.height", "hoop.distance", "air.wind", "gravity"),
    handles=(
        Handle("hoop.distance", "hoop.height", goal=True, with_y=("backboard.bottom", "backboard.top")),
        Handle(y="release.height"),
        Handle("backboard.gap", "backboard.top", at=lambda parameters: parameters.board[::3]),
    ),
    scores="made",
    spread=(
        *(Spread("launch.speed", 0.01), Spread("launch.angle", minimum=1.0), Spread("launch.spin", 0.2)),  # assumed
        Spread("launch.side", sd="launch.aside"),
    ),
    landing=("entry_offset", "entry_aside"),
)

#: A ball whose centre would have less room than this, in m, to either side is taken to miss: it flies past the middle
#: of the ring so far that it falls on its side.
NARROWEST = 0.01

#: A shot still moving after this time in s is ended.
LONGEST = 60.0

#: The run is over when the ball comes down on the floor no faster than 3 m/s: after a few bounces.
TIRED = (Rule(("floor",), fastest=3.0),)

#: Thickness of the bracket over that of the tube: a ball between ring and board rests on the tube. Assumed.
BRACKET_SHARE = 0.5


def net_regions(net: NetDrag) -> list[ForceRegion]:
    """The region where a net acts, and, inside, the one where it does so fully."""
    (x, y), aside, bottom, edge = net.middle, net.half_width, net.middle[1] - net.length, net.EDGE
    return [
        ForceRegion(x - aside - edge, bottom, x + aside + edge, y, step=0.02),
        ForceRegion(x - aside, bottom + edge, x + aside, y - edge, step=0.02),
    ]


def build(parameters: Parameters) -> Setup:
    """Ball, ring, board and floor. Raises RequestError if they overlap."""
    hoop, net, mass = parameters.hoop, parameters.net, parameters.ball.mass
    drag = [NetDrag(mass, net.damping, hoop.middle, 0.5 * hoop.inner_diameter, net.length)] if net.slows else []
    shot = parameters.launched((0.0, parameters.held), *drag)
    regions = [region for it in drag for region in net_regions(it)]
    return Setup([shot], court(parameters), LONGEST, EndsBy(TIRED), force_regions=regions)


def court(parameters: Parameters) -> list[Surface]:
    """Floor, ring and board. Raises RequestError for what is upside down, or in something else."""
    hoop, backboard, (front, back) = parameters.hoop, parameters.backboard, parameters.section.rims
    left, bottom, right, top = parameters.board
    if top <= bottom:
        raise RequestError(f"backboard.top = {top:g} m is not above backboard.bottom = {bottom:g} m: swap them")
    ring = ("hoop.distance", "hoop.height", "hoop.tube_radius")
    tubes = [disc("the ring", ring, *rim, hoop.tube_radius) for rim in (front, back)]
    glass = Extent("the board", ("backboard.gap", "backboard.bottom", "backboard.top"), *parameters.board)
    ball = disc("the ball", ("release.height", "ball.radius"), 0.0, parameters.held, parameters.ball.radius)
    for others in ((tubes[0], glass), (tubes[1], glass), (tubes[0], below("the floor"))):
        check_apart(parameters, ball, *others)
    return [
        parameters.floor.surface("floor", level()),
        hoop.surface("rim front", Circle(front, hoop.tube_radius)),
        hoop.surface("rim back", Circle(back, hoop.tube_radius)),
        hoop.surface("bracket", Segment(back, (left, back[1]), BRACKET_SHARE * hoop.tube_radius)),
        *backboard.outline("backboard", rectangle(left, bottom, right, top)),
    ]


def on_floor(run: Run) -> float:
    """The time in s at which the ball reaches the floor, or the run ends."""
    return run.until_meeting("floor")


def falls_to(run: Run, parameters: Parameters, below: float = 0.0) -> Iterator[tuple[float, State]]:
    """Each time and state at which the ball's centre falls to the ring's height, or so many m below it."""
    return run.crossings("ball", (0.0, parameters.hoop.height - below), (0.0, 1.0))


@cached_per_run
def out(run: Run, parameters: Parameters) -> Any:
    """The time in s at which the ball left the ring below, between its inner edges; inf if it did not before it
    reached the floor."""
    floor = on_floor(run)
    falls = falls_to(run, parameters, parameters.ball.radius)
    return first_time(falls, lambda t, state: inside(state, parameters) & (t <= floor))


@cached_per_run
def made(run: Run, parameters: Parameters) -> Any:
    """True if it had come down through the ring, and not up through it before (FIBA rules, art. 16: from above)."""
    left, up, through = out(run, parameters), 0.0, False
    for t, _ in run.crossings("ball", parameters.hoop.middle, (0.0, -1.0)):
        up = where(t < left, t, up)
    for t, state in falls_to(run, parameters):
        aside = on_side(t, run, parameters)
        through = through | ((up < t) & (t <= left) & inside(state, parameters) & (aside ^ True))
    return through & (left < inf) & (from_below(run, parameters) ^ True)


@cached_per_run
def from_below(run: Run, parameters: Parameters) -> Any:
    """True if the ball is first between the inner edges on its way up."""
    rises = run.crossings("ball", parameters.hoop.middle, (0.0, -1.0))
    first_up, first_down = (
        first_time(crossings, lambda _, state: inside(state, parameters))
        for crossings in (rises, falls_to(run, parameters))
    )
    return first_up < first_down


def inside(state: State, parameters: Parameters) -> Any:
    """True if the ball's centre is between the inner edges."""
    return abs(state[0] - parameters.hoop.distance) < 0.5 * parameters.width


def on_side(t: Any, run: Run, parameters: Parameters) -> Any:
    """True if the ball falls on the side of the ring instead, at time t in s."""
    beside = abs(aside_at(t, run, parameters))
    return (beside > 0.0) & ((parameters.free == 0.0) | (beside >= parameters.clearance))


def aside_at(t: Any, run: Run, parameters: Parameters) -> Any:
    """Return how far in m the ball is beside the middle of the ring at time t in s, positive to the left.

    It flies straight on to the side, and the ring is met near its middle. The board leaves it the share 1 / (1 + k) of
    its sideways speed, k its moment of inertia over m r^2: it grips, since that speed is small.
    """
    beside = parameters.beside
    if not anywhere((beside != 0.0) & (parameters.free != 0.0)):
        return beside
    hit = run.first_event("backboard")
    if hit is None:
        return beside
    further = hit.speed * (t - hit.t) / (1.0 + parameters.ball.inertia_factor)
    off_board = (hit.t < t) & (parameters.free != 0.0)
    return where(off_board, beside * (hit.x + further) / parameters.hoop.distance, beside)


@cached_per_run
def entry(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it first falls to the ring's height, or first touches something there if that is earlier."""
    return down_to(run, parameters.hoop.middle, on_floor(run))


def beyond_middle(ball: Moment, it: Parameters) -> float:
    """The distance in m of the ball beyond the middle of the ring."""
    return ball.x - it.hoop.distance


def aside_of_middle(run: Run, parameters: Parameters) -> float | None:
    """The distance in m of the ball to the side of the middle of the ring, as it comes down to it."""
    ball = entry(run, parameters)
    return None if ball is None else aside_at(ball.t, run, parameters)


def is_aside(run: Run, parameters: Parameters) -> bool:
    """True for a shot that is not straight at the ring."""
    return bool(parameters.launch.side != 0.0)


@cached_per_run
def touches(run: Run, parameters: Parameters) -> Any:
    """The surfaces touched until the shot was decided: by leaving the ring below, by reaching the floor, or because the
    ball stays between ring and board."""
    left, floor = out(run, parameters), on_floor(run)
    landing, over = run.first_event("floor"), where(left < inf, left, floor)
    never_down = (left == inf) & (True if landing is None else landing.t != landing.t)  # not a number: of many shots
    if anywhere(never_down):
        kept = run.first_start("ball", decided(parameters).stays, among=never_down)
        over = where(kept < inf, kept, over)
    return run.touched(over)


@dataclass(frozen=True)
class Stays:
    """True of a ball between ring and board that stays there: without wind its energy ``E / m = g y + v^2 / 2 + k r^2
    w^2 / 2``, k its moment of inertia over m r^2, never grows."""

    pocket: tuple[float, float, float] = (0.0, 0.0, 0.0)  # left, right and bottom, in m
    factors: tuple[float, float] = (0.0, 0.0)  # g in m/s^2, k r^2 in m^2
    needed: float = 0.0  # E / m to get out, in J/kg

    def __call__(self, state: Any) -> Any:
        (x, y, vx, vy, spin), (left, right, bottom), (gravity, gyration) = state, self.pocket, self.factors
        energy = gravity * y + 0.5 * (vx * vx + vy * vy + gyration * spin * spin)
        return (x > left) & (x < right) & (y > bottom) & (energy < self.needed)


@dataclass(frozen=True)
class Decided(Passes):
    """The ball is on the floor, has left the ring below, or stays between ring and board."""

    stays: Stays = Stays()

    def passed(self, start: State, end: State) -> Any:
        return super().passed(start, end) | self.stays(start)


def decided(parameters: Parameters) -> Decided:
    """The condition at which the shot is decided. In a wind, or with a way out below the board, no ball stays."""
    ball, hoop, (back, level), wind = parameters.ball, parameters.hoop, parameters.section.rims[1], parameters.air.wind
    face, bottom, _, top = parameters.board
    barrier = parameters.gravity * (minimum(level + hoop.tube_radius, top) + ball.radius)
    needed = where((wind[0] == 0.0) & (wind[1] == 0.0) & (bottom <= level), barrier, -inf)
    factors = parameters.gravity, ball.inertia_factor * ball.radius**2
    stays = Stays((back, face, level), factors, needed)
    return Decided("floor", 1, *parameters.section.across(ball.radius), stays)


def outcome(run: Run, parameters: Parameters) -> Any:
    """swish; bank, off the board first; rim, off the ring first; miss."""
    return where(made(run, parameters), of_each(touches(run, parameters), how_made), "miss")


def how_made(touched: Sequence[str]) -> str:
    """The word for a shot that went in and touched these on its way."""
    return "swish" if not touched else "bank" if touched[0] == "backboard" else "rim"


FACTS = (
    Fact("made", "", "", made, decided),
    Fact("verdict", "", "", outcome, decided),
    Fact("entry_angle", "entry angle", "deg", fact_from(entry, "descent"), decided),
    Fact("entry_speed", "entry speed", "m/s", fact_from(entry, "speed"), decided),
    Fact("entry_offset", "from centre", "m", fact_from(entry, beyond_middle), decided, sides=("short", "long")),
    Fact("entry_aside", "to the side", "m", aside_of_middle, decided, sides=("right", "left"), where=is_aside),
    Fact("apex", "apex above hand", "m", lambda run, it: apex(run, it) - it.held, decided),
    Fact("flight_time", "flight time", "s", fact_from(entry, "t"), decided),
    *LAUNCH,
    Fact("touches", "touches", "", touches, decided),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    result = run.result
    if result["made"]:
        how = {"swish": "nothing but net", "rim": "off the rim", "bank": "off the board"}
        return f"In, {how[result['verdict']]}"
    if abs(result["entry_aside"] or 0.0) >= parameters.clearance > 0.0:
        return "Off to the side"
    if from_below(run, parameters):
        return "Up through the ring: it does not count"
    touched = next((name for name in result["touches"] if name != "floor"), None)
    if touched:
        return "Off the board, and out" if touched == "backboard" else "Off the rim, and out"
    offset = result["entry_offset"]
    if offset is not None:
        return f"Air ball, {roughly(abs(offset))} {'short' if offset < 0 else 'too far'}"
    return "Did not come down" if run.ended == "duration" else "Air ball, never as high as the ring"
