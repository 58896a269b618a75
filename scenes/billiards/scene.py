"""Billiards from above: pool, snooker and carom on cloth, with draw, follow and english.

Models: sliding, rolling and spinning on cloth in closed form; the cue tip's offset, which gives follow, draw, stun and
english, and squirt; impacts of balls with restitution, that spring back along their contact, and with friction that
falls with their speed, so that cuts and english throw the object ball and spin passes on; racks and frozen balls that
share an impact (Hertz); cushions whose nose is above the ball's centre, as measured on several tables; jaws as real
shapes, and pockets that catch a ball whose centre is over the hole.
Leaves out, with the size of the effect: hops, as friction lifts a rolling ball that hits another straight on at 3 m/s
by 1.1 mm for 0.03 s; swerve, as every cue is held level (2.5 deg at the most english with a cue raised by 5 deg). And,
not measured: masse and jump shots; how long the cushions hold a ball; the nap of the cloth; the pockets' depth, out of
which a fast ball may rattle.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from math import asin, atan2, copysign, cos, degrees, dist, hypot, inf, pi, radians, sin, sqrt
from typing import Any, Literal

from sandbox.engine.contact.touch import Obstacle, touched
from sandbox.kit import (
    ENDED,
    Ball,
    Bounce,
    Cloth,
    ConstantBounce,
    ContactModel,
    Controls,
    Directed,
    Fact,
    Goal,
    Group,
    Handle,
    Moment,
    RequestError,
    Run,
    SceneParameters,
    SceneRun,
    Setup,
    Solid,
    Spin,
    Spread,
    Vector,
    cached_per_run,
    choice,
    fact_from,
    group,
    groups,
    one_of,
    quantity,
    roughly,
    text,
    travelled,
)
from sandbox.physics.cue import squirt_angle
from sandbox.physics.hertz import PHENOLIC
from sandbox.physics.throw import friction_by_speed, spring_back
from sandbox.sport.sliding import REST_TIME, all_collisions, collisions_of, in_play, removed_by

from .table import CUSHIONS, AnyTable, check, cushions, on_bed, traps


class PlacedBall(Group):
    """A ball and its position; the table's centre is the origin, x runs along its length."""

    name: str = text("name of the ball")
    x: float = quantity(0.0, "m", -10, 10, "along the table")
    y: float = quantity(0.0, "m", -10, 10, "across the table")


class Cue(Directed):
    """The stroke, with a level cue."""

    ball: str = text("name of the ball that is struck")
    speed: float = quantity(..., "m/s", 0, 30, "speed of the ball after the stroke")
    angle: float = quantity(..., "deg", -360, 360, "direction of the cue, from +x counter-clockwise")
    follow: float = quantity(..., "", -0.5, 0.5, "tip above the ball's centre in radii; 0.4 rolls at once")
    english: float = quantity(..., "", -0.5, 0.5, "tip to the right of the ball's centre in radii")
    end_mass: float = quantity(..., "kg", 0, 1, "of the tip's end, which english pushes aside; 0: no squirt")


class BallParameters(Group):
    """All balls alike, solid spheres."""

    mass: float = quantity(..., "kg", 0.001, 10, "mass")
    radius: float = quantity(..., "m", 0.002, 0.2, "radius")
    restitution: float = quantity(..., "", 0, 1, "of ball and ball")
    friction: float | None = quantity(None, "", 0, 10, "of two balls; left out: falls with sliding speed (Alciatore)")


class ClothParameters(Group):
    """The cloth."""

    sliding_friction: float = quantity(..., "", 0, 2, "deceleration of a sliding ball over gravity")
    rolling_friction: float = quantity(..., "", 0, 1, "deceleration of a rolling ball over gravity")
    spinning_friction: float = quantity(..., "", 0, 1, "torque on a ball spinning upright, over m g r")


class Cushion(Solid):
    """The cushions, jaws included."""

    model: Literal["nose", "vertical"] = choice(..., "a nose above the ball's centre, or a wall")
    nose_height: float = quantity(..., "m", 0.001, 0.4, "height of the nose above the cloth")
    tangential: float = quantity(..., "", 0, 1, "share of the slip that is reversed if the ball grips")

    @property
    def bounce(self) -> ConstantBounce:
        return ConstantBounce(Bounce(self.restitution, self.friction, tangential=self.tangential))

    def nose(self, radius: float) -> float | None:
        """Height in m of the nose, for balls of that radius; None for walls."""
        if self.model == "vertical":
            return None
        if radius <= self.nose_height < 2.0 * radius:
            return self.nose_height
        raise RequestError(
            f"cushion.nose_height = {self.nose_height:g} m: must be between the centre of a ball, at {radius:g} m, "
            f"and its top, at {2.0 * radius:g} m"
        )


class BallContact(Group):
    """The contact of balls that are pressed together while others can reach them."""

    model: Literal["auto", "rigid", "hertz"] = choice(..., "contact mechanics where it matters, never, or always")
    stiffness: float = quantity(..., "N/m^1.5", 1e5, 1e12, "of a pair of balls")


class Parameters(SceneParameters):
    """All parameters of a shot."""

    rack: Literal["nine-ball", "eight-ball", "none"] | None = choice(
        None, "balls on the foot spot; if left out, nine-ball if no balls are listed, none otherwise"
    )
    rack_gap: float = quantity(..., "m", 1e-7, 0.01, "between neighbours in the rack")
    rack_scatter: float = quantity(..., "m", 0, 0.01, "random displacement of a racked ball, at most")
    rack_seed: float = quantity(..., "", 0, 1e9, "which of the random racks")
    balls: list[PlacedBall] = groups(..., "balls placed one by one, in addition to the rack")
    cue: Cue = group(..., "the stroke")
    table: AnyTable = one_of(..., "the table", by="kind")
    ball: BallParameters = group(..., "the balls")
    cloth: ClothParameters = group(..., "the cloth")
    cushion: Cushion = group(..., "the cushions")
    contact: BallContact = group(..., "how balls meet")
    gravity: float = quantity(..., "m/s^2", 0, 100, "gravity")

    @classmethod
    def with_implied(cls, changes: Mapping[str, Any]) -> Mapping[str, Any]:
        """A table of another kind has cushions of its own."""
        table = changes.get("table")
        own = CUSHIONS.get(str(table.get("kind"))) if isinstance(table, Mapping) else None
        given = changes.get("cushion", {})
        return changes if own is None or not isinstance(given, Mapping) else {**changes, "cushion": {**own, **given}}


CONTROLS = Controls(
    speed="cue.speed",
    angle="cue.angle",
    full_pull_speed=12.0,
    spins=(Spin("cue.follow", 0.05), Spin("cue.english", 0.05)),
    ball="cue.ball",
    sliders=("cue.speed", "cue.angle", "cue.follow", "cue.english", "rack", "cloth.rolling_friction", "ball.friction"),
    handles=(Handle("balls[*].x", "balls[*].y", prerequisites=lambda parameters: changes_for(laid_out(parameters))),),
    goals=lambda parameters: goals(parameters),
    scores="scored",
    spread=(Spread("cue.speed", 0.03), Spread("cue.angle", minimum=0.2)),  # assumed
    next_start=lambda run, parameters: from_rest(run, parameters),
)

#: A shot still moving after this time in s is ended.
LONGEST = 300.0

#: More balls than these and the cue ball lie on the table only before the break of snooker.
MOST_OF_POOL = 15
#: Stiffness of a contact of two balls along it, over that across it.
ALONG = PHENOLIC.along

#: So many of the balls nearest to a pocket are tried when a shot into it is looked for.
TRIED = 3
#: A ball that is to go straight to a pocket is cut by no more than so many deg, and tried so many to either side.
THINNEST, NEARLY = 75.0, 1.5

#: Distance of the tip from the ball's centre, in radii, beyond which a chalked tip slips off: a miscue (Alciatore).
MISCUE = 0.5

#: Overlap in m that counts as rounding in the file; the balls are moved apart.
ROUNDING = 1e-5

#: With a rack the cue ball lies so many radii to the left of the head spot, if nothing else is said: a break straight
#: ahead would be its own mirror image to the end, which no real one is.
ASIDE = 0.35

#: Rows from the foot spot on, each from right to left as seen from the head.
RACKS = {
    "nine-ball": (("1",), ("2", "3"), ("4", "9", "5"), ("6", "7"), ("8",)),
    "eight-ball": (("1",), ("9", "2"), ("3", "8", "10"), ("11", "4", "12", "5"), ("6", "13", "7", "14", "15")),
    "none": (),
}


def build(parameters: Parameters) -> Setup:
    """Table, balls and the stroke. Raises RequestError for balls that do not fit, and for a miscue."""
    ball, cloth, cushion, table = parameters.ball, parameters.cloth, parameters.cushion, parameters.table
    check(table, ball.radius)
    surfaces = cushions(table, cushion.bounce, cushion.nose(ball.radius))
    spots = laid_out(parameters)
    check_spots(spots, parameters, [Obstacle(surface, ball.radius) for surface in surfaces])
    velocity, spin, rolling_spin = struck(parameters)
    balls = {name: Ball(name, ball.mass, ball.radius, place) for name, place in spots.items()}
    cue = balls[parameters.cue.ball]
    balls[cue.name] = replace(cue, velocity=velocity, spin=spin, rolling_spin=rolling_spin)
    gives = parameters.contact.model != "rigid"
    return Setup(
        list(balls.values()),
        surfaces,
        duration=LONGEST,
        between_balls=BallOnBall(ball.restitution, ball.friction, gives),
        plane=Cloth(cloth.sliding_friction, cloth.rolling_friction, cloth.spinning_friction, parameters.gravity),
        traps=traps(table),
        contact=ContactModel(parameters.contact.model, parameters.contact.stiffness, along=ALONG if gives else inf),
    )


@dataclass(frozen=True)
class BallOnBall:
    """An impact of two balls, which spring back along their contact if it gives. Their friction, where it is not given,
    falls with the speed at which they slip."""

    restitution: float
    friction: float | None
    gives: bool

    def __call__(self, normal_speed: float, slip_speed: float) -> Bounce:
        friction = friction_by_speed(slip_speed) if self.friction is None else self.friction
        most = friction * (1.0 + self.restitution) * normal_speed  # m/s, impulse over mass
        reversed_ = spring_back(2.0 / 7.0 * slip_speed / most) if self.gives and most > 0.0 else 0.0
        return Bounce(self.restitution, friction, tangential=reversed_)


def goals(parameters: Parameters) -> list[Goal]:
    """Each ball, to be potted; and each pocket, by the balls that are nearest to it. Where a ball has a free way to a
    pocket, and the cue ball to it, only directions near to that are tried."""
    spots, table, cue = laid_out(parameters), parameters.table, parameters.cue.ball
    start, holes = spots.pop(cue), traps(table)
    ranges, straight, aside = {}, {}, squirt(parameters)
    for name, place in spots.items():
        half = degrees(asin(min(1.0, 2.0 * parameters.ball.radius / dist(place, start))))
        ranges[name] = _around(start, place, half, aside)  # as far to either side as the ball is touched
        others = [other for other in spots.values() if other != place]
        for hole in holes:
            ghost = _ghost(start, place, hole.center, others, parameters.ball.radius)
            if ghost is not None:
                straight[name, hole.name] = _around(start, ghost, NEARLY, aside)
    found = []
    for name, place in spots.items():
        ways = [way for (ball, _), way in straight.items() if ball == name] or [ranges[name]]
        found += [Goal(f"ball {name}", {"pockets": name}, place, way) for way in ways]
    for hole in holes:
        near = sorted(spots, key=lambda name: dist(spots[name], hole.center))
        ways = [straight[name, hole.name] for name in near if (name, hole.name) in straight][:TRIED]
        ways = ways or [ranges[name] for name in near[:TRIED]]
        found += [Goal(hole.name, {"pockets": hole.name}, hole.center, way) for way in ways]
    return found


def _around(start: Vector, aim: Vector, half: float, aside: float) -> dict[str, tuple[float, float]]:
    """The directions of the cue that send a ball, ``aside`` deg to the left of them, from a place to another (m), and
    ``half`` deg to either side."""
    way = degrees(atan2(aim[1] - start[1], aim[0] - start[0])) - aside
    return {"cue.angle": (way - half, way + half)}


def _ghost(start: Vector, ball: Vector, hole: Vector, others: Sequence[Vector], radius: float) -> Vector | None:
    """The place of the cue ball (m) as it meets a ball that is to go straight to a hole; None where that is cut too
    thinly or a ball is in the way."""
    far = dist(ball, hole)
    x, y = (b - 2.0 * radius * (h - b) / far for b, h in zip(ball, hole, strict=True))
    ghost, reach = (x, y), dist(start, (x, y))
    ahead = sum((g - s) * (h - b) for s, g, b, h in zip(start, ghost, ball, hole, strict=True))
    if ahead < cos(radians(THINNEST)) * reach * far:
        return None
    if any(_way_off(other, *way) < 2.0 * radius for way in ((start, ghost), (ball, hole)) for other in others):
        return None
    return ghost


def _way_off(place: Vector, start: Vector, end: Vector) -> float:
    """The distance of a place from a stretch, in m."""
    (x, y), (px, py) = (end[0] - start[0], end[1] - start[1]), (place[0] - start[0], place[1] - start[1])
    share = min(max((px * x + py * y) / (x * x + y * y), 0.0), 1.0)
    return hypot(px - share * x, py - share * y)


def rack_of(parameters: Parameters) -> str:
    """The name of the rack that is broken, "none" for none."""
    return parameters.rack or ("none" if parameters.balls else "nine-ball")


def laid_out(parameters: Parameters) -> dict[str, Vector]:
    """The position of each ball at the start, in m: those listed, those racked, and with a rack a cue ball, a
    little to the left of the head spot.

    Raises RequestError for a name given twice and for a struck ball that is not there.
    """
    rack = rack_of(parameters)
    spots: dict[str, Vector] = {}
    for spot in parameters.balls:
        if spot.name in spots:
            raise RequestError(f'balls: two are named "{spot.name}"')
        spots[spot.name] = (spot.x, spot.y)
    for name, position in racked(RACKS[rack], parameters):
        if name in spots:
            raise RequestError(f'balls: "{name}" is in the rack already; rename it, or set rack = "none"')
        spots[name] = position
    if rack != "none":
        spots.setdefault("cue", (-0.25 * parameters.table.length, ASIDE * parameters.ball.radius))
    if parameters.cue.ball not in spots:
        there = ", ".join(spots) or "none"
        raise RequestError(f'cue.ball = "{parameters.cue.ball}": there is no such ball on the table; there are {there}')
    return spots


def racked(rows: Sequence[Sequence[str]], parameters: Parameters) -> Iterator[tuple[str, Vector]]:
    """The balls of a rack, its foremost on the foot spot.

    Neighbours lie ``rack_gap`` apart: a real rack is never quite tight, and while two balls touch they are pressed
    together by 0.1 mm and more.
    """
    scatter, chance = parameters.rack_scatter, random.Random(int(parameters.rack_seed))
    pitch = 2.0 * parameters.ball.radius + parameters.rack_gap + 2.0 * scatter
    for row, names in enumerate(rows):
        for place, name in enumerate(names):
            x = 0.25 * parameters.table.length + 0.5 * sqrt(3.0) * pitch * row
            y = pitch * (place - 0.5 * (len(names) - 1))
            away, angle = scatter * sqrt(chance.random()), 2.0 * pi * chance.random()
            yield name, (x + away * cos(angle), y + away * sin(angle))


def check_spots(spots: Mapping[str, Vector], parameters: Parameters, obstacles: Sequence[Obstacle]) -> None:
    """Raise RequestError for a ball that is not on the table, or in a cushion or another ball."""
    radius, x_most, y_most = parameters.ball.radius, 0.5 * parameters.table.length, 0.5 * parameters.table.width
    for name, place in spots.items():
        where = f'ball "{name}" at ({place[0]:g}, {place[1]:g}) m'
        if not on_bed(parameters.table, *place):
            raise RequestError(f"{where} is off the table, whose noses are at x = +-{x_most:g} m, y = +-{y_most:g} m")
        gap, cushion = min(
            ((touch.gap, wall.surface.name) for wall, touch in touched(obstacles, *place)), default=(0.0, "")
        )
        if gap < -ROUNDING:
            raise RequestError(f"{where} overlaps the {cushion} by {-1000.0 * gap:.3g} mm: its radius is {radius:g} m")
        for hole in traps(parameters.table):
            if dist(place, hole.center) < hole.radius:
                raise RequestError(f"{where} is over the hole of the {hole.name}")
    for (name, a), (other, b) in combinations(spots.items(), 2):
        overlap = 2.0 * radius - dist(a, b)
        if overlap > ROUNDING:
            raise RequestError(
                f'balls "{name}" at ({a[0]:g}, {a[1]:g}) m and "{other}" at ({b[0]:g}, {b[1]:g}) m overlap by '
                f"{1000.0 * overlap:.3g} mm: their centres must be {2.0 * radius:g} m apart"
            )


def struck(parameters: Parameters) -> tuple[Vector, float, Vector]:
    """Velocity (m/s), spin about the vertical and about x and y (rad/s) of the struck ball. RequestError for a miscue.

    The cue's impulse m v acts at the tip: ``(english, follow)`` radii to the right of and above the ball's centre, as
    seen along the cue. Its moment over 2/5 m r^2 is the spin, ``(5/2) v/r`` times the offset: for a tip above the
    centre about the level axis that points to the left of the way, where 2/5 rolls at once; for a tip to the right
    about the vertical, counter-clockwise from above.
    """
    cue = parameters.cue
    offset = hypot(cue.follow, cue.english)
    if offset > MISCUE + 1e-12:
        raise RequestError(
            f"cue.follow = {cue.follow:g}, cue.english = {cue.english:g}: the tip is {offset:.3g} radii off the ball's "
            f"centre, and beyond {MISCUE:g} it slips off"
        )
    (ux, uy), turn, aside = cue.velocity, 2.5 / parameters.ball.radius, radians(squirt(parameters))
    velocity = cos(aside) * ux - sin(aside) * uy, sin(aside) * ux + cos(aside) * uy
    return velocity, turn * cue.speed * cue.english, (-turn * cue.follow * uy, turn * cue.follow * ux)


def squirt(parameters: Parameters) -> float:
    """The angle in deg by which the struck ball leaves to the left of the cue's direction: ``squirt_angle``."""
    cue = parameters.cue
    return degrees(squirt_angle(cue.english, cue.follow, cue.end_mass / parameters.ball.mass))


def touches(run: Run, parameters: Parameters) -> list[str]:
    """The things that the struck ball met, in order: other balls, cushions and jaws, and the pocket it fell into."""
    return [name for name, _ in collisions_of(run, parameters.cue.ball)]


def others(run: Run, parameters: Parameters) -> set[str]:
    """The balls that are not struck."""
    return {ball.name for ball in run.setup.balls} - {parameters.cue.ball}


def first_contact(run: Run, parameters: Parameters) -> tuple[str, float] | None:
    """The first other ball that the struck one meets, and the speed in m/s at which they meet, along their surfaces
    included, as pictures say."""
    events = collisions_of(run, parameters.cue.ball)
    return next(((name, run.closing_speed(event)) for name, event in events if name in run.arcs), None)


def point(run: Run, parameters: Parameters) -> int | None:
    """A carom's point, on a table without pockets: how many cushions the struck ball met before the last of the other
    balls, of which there must be two at least; None where it did not meet them all."""
    missing, cushions = others(run, parameters), 0
    if run.setup.traps or len(missing) < 2:
        return None
    for name in touches(run, parameters):
        missing.discard(name)
        cushions += name.endswith(" cushion")
        if not missing:
            return cushions
    return None


def scored(run: Run, parameters: Parameters) -> bool:
    """A point, or a ball potted without a scratch."""
    caught = removed_by(run)
    return point(run, parameters) is not None or (bool(caught) and parameters.cue.ball not in caught)


@cached_per_run
def leaving(run: Run, parameters: Parameters) -> dict[str, tuple[Moment, Moment]]:
    """Each ball as it leaves its first meeting with ball or cushion: just after it, and with the velocity that it has
    once it rolls, if it meets nothing before: ``v - 2/7 s``, with its slip s over the cloth."""
    radius, ways = parameters.ball.radius, dict[str, tuple[Moment, Moment]]()
    for event in all_collisions(run):
        for name in {event.ball, event.partner} & (run.arcs.keys() - ways.keys()):
            arc = next((arc for arc in run.arcs[name] if arc.t1 > event.t), run.arcs[name][-1])
            _, t = arc.contact_span or (0.0, event.t)
            ball, (wx, wy) = Moment(t, *run.state(name, t)), run.rolling_spin(name, t)
            rolling = (5.0 * ball.vx + 2.0 * radius * wy) / 7.0, (5.0 * ball.vy - 2.0 * radius * wx) / 7.0
            ways[name] = ball, ball._replace(vx=rolling[0], vy=rolling[1])
    return {name: ways[name] for name in run.arcs if name in ways}


@cached_per_run
def bank(run: Run, parameters: Parameters) -> tuple[float, float | None] | None:
    """The angle in deg from the normal at which the struck ball leaves the first cushion it meets, and the distance in
    m along that to where it meets the one across, if that is the next; both positive the way it came."""
    ball = parameters.cue.ball
    met = [(name, event.t) for name, event in collisions_of(run, ball) if name.endswith(" cushion")]
    if not met:
        return None
    (name, t), (across, end) = met[0], met[min(1, len(met) - 1)]
    along = 0 if name.endswith("long cushion") else 1  # the axis of that cushion
    ball_at, way = run.state(ball, t), copysign(1.0, run.before(ball, t)[2 + along])
    angle = degrees(atan2(way * ball_at[2 + along], abs(ball_at[3 - along])))
    opposite = across != name and across.endswith("long cushion") is (along == 0)
    return angle, way * (run.before(ball, end)[along] - ball_at[along]) if opposite else None


def of_leaving(when: int, what: str) -> Callable[[Run, Parameters], dict[str, float]]:
    """The function that reads something of each ball just after it (0), or once it rolls (1)."""
    return lambda run, parameters: {name: getattr(ways[when], what) for name, ways in leaving(run, parameters).items()}


def tip(run: Run, parameters: Parameters) -> str:
    """The place where the tip hits the ball, in radii from its centre."""
    cue = parameters.cue
    offsets = (cue.follow, ("draw", "follow")), (cue.english, ("left", "right"))
    return ", ".join(f"{abs(off):.2g} {words[off > 0]}" for off, words in offsets if off) or "centre"


def _cushion_contacts(run: Run, parameters: Parameters) -> int:
    """The number of collisions of balls with cushions."""
    return sum(event.partner.endswith(" cushion") for event in all_collisions(run))


def driven(run: Run, parameters: Parameters) -> int:
    """The number of balls, the struck one aside, that met a cushion."""
    met = {event.ball for event in all_collisions(run) if event.partner.endswith(" cushion")}
    return len(met - {parameters.cue.ball})


FACTS = (
    Fact("pockets", "potted", "", lambda run, parameters: removed_by(run), names=True),
    Fact("first_contact", "first contact", "", fact_from(first_contact, lambda meeting, it: meeting[0]), names=True),
    Fact("stroke", "stroke", "m/s", lambda run, parameters: parameters.cue.speed, "start"),
    Fact("tip", "tip", "", tip, "start"),
    Fact("squirt", "", "deg", lambda run, parameters: squirt(parameters), "start"),
    Fact("cushions", "cushions", "", lambda run, it: sum(name.endswith(" cushion") for name in touches(run, it))),
    Fact("contact_speed", "contact", "m/s", fact_from(first_contact, lambda meeting, it: meeting[1])),
    Fact("path", "path", "m", lambda run, parameters: travelled(run, parameters.cue.ball)),
    REST_TIME,
    Fact("rails", "cushions, all balls", "", _cushion_contacts),
    Fact("driven", "", "", driven),
    Fact("potted", "", "", lambda run, parameters: list(removed_by(run)), in_order=False, names=True),
    Fact("scratch", "", "", lambda run, parameters: parameters.cue.ball in removed_by(run), most=1),
    Fact("point", "", "", point),
    Fact("scored", "", "", scored),
    Fact("positions", "", "m", lambda run, parameters: {name: [*place] for name, place in in_play(run).items()}),
    Fact("leaving_speed", "", "m/s", of_leaving(0, "speed")),
    Fact("leaving_direction", "", "deg", of_leaving(0, "direction")),
    Fact("rolling_speed", "", "m/s", of_leaving(1, "speed")),
    Fact("rolling_direction", "", "deg", of_leaving(1, "direction")),
    Fact("out_angle", "", "deg", fact_from(bank, lambda found, it: found[0])),
    Fact("landing", "", "m", fact_from(bank, lambda found, it: found[1])),
    Fact("touches", "", "", touches, names=True),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    result, cue = run.result, parameters.cue.ball
    potted = [name for name in result["potted"] if name != cue]
    if result["scratch"]:
        return f"Scratch in the {result['pockets'][cue]}" + (f", with {_named(potted)}" if potted else "")
    if len(potted) == 1:
        return f"The {potted[0]} into the {result['pockets'][potted[0]]}"
    if potted:
        return f"Potted {_named(potted)}"
    if result["first_contact"] is None:
        return "Hits no ball"
    if run.ended == "duration":
        return f"Still moving after {run.duration:.0f} s"
    if not run.setup.traps:
        return _carom(run, parameters)
    if rack_of(parameters) != "none" or len(others(run, parameters)) > MOST_OF_POOL:  # or of snooker
        return f"Break at {parameters.cue.speed:.1f} m/s, nothing potted"
    ways = {name: travelled(run, name) for name in others(run, parameters)}
    farthest = max(ways, key=lambda name: (ways[name], name))
    return f"Nothing potted, the {farthest} rolls {roughly(ways[farthest])}"


def _carom(run: SceneRun, parameters: Parameters) -> str:
    """On a table without pockets: whether the struck ball met all others, after how many cushions."""
    cushions = run.result["point"]
    if cushions is not None:
        return f"Point, after {cushions} cushion{'' if cushions == 1 else 's'}"
    balls = [name for name in dict.fromkeys(run.result["touches"]) if name in run.arcs]
    return f"No point: meets {_named(balls)} alone"


def _named(names: list[str]) -> str:
    """The 1, the 3 and the 7."""
    called = [f"the {name}" for name in names]
    return " and ".join([", ".join(called[:-1]), called[-1]] if len(called) > 1 else called)


def from_rest(run: SceneRun, parameters: Parameters) -> dict[str, Any]:
    """Positions of the balls for the next shot: a cleared table is racked, a potted cue ball spotted."""
    spots: dict[str, Vector] = {name: (x, y) for name, (x, y) in run.result["positions"].items()}
    cue = parameters.cue.ball
    if not set(spots) - {cue}:
        return {"rack": "nine-ball", "balls": []}
    if cue not in spots:
        spots[cue] = _free_spot(list(spots.values()), parameters)
    return changes_for(spots)


def changes_for(spots: Mapping[str, Vector]) -> dict[str, Any]:
    """The changes that put balls at these places."""
    return {"rack": "none", "balls": [{"name": name, "x": x, "y": y} for name, (x, y) in spots.items()]}


def _free_spot(taken: Sequence[Vector], parameters: Parameters) -> Vector:
    """The head spot, or the nearest place with room on the line through it."""
    head, room = -0.25 * parameters.table.length, 2.1 * parameters.ball.radius
    places = sorted((0.5 * step * room for step in range(-20, 21)), key=abs)
    free = (y for y in places if all(hypot(head - x, y - other) > room for x, other in taken))
    return head, next(y for y in free if abs(y) < 0.5 * parameters.table.width - room)
