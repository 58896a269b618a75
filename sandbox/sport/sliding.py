"""Bodies that slide or roll on a plane seen from above: launch, collisions, removal, and the positions at the end."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, dist, hypot, pi, sin
from typing import TYPE_CHECKING, Any

from sandbox.engine.model.ball import DISC, Ball
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Trap
from sandbox.engine.motion.on_plane import slowest_hop
from sandbox.errors import RequestError
from sandbox.parameters import SceneParameters, group, quantity
from sandbox.sport.facts import Fact
from sandbox.sport.flight import DEGREE, RPM, Directed
from sandbox.sport.solids import Solid

if TYPE_CHECKING:
    from sandbox.engine.paths.run import Event, Run


#: Chords of a rounded corner: their directions are 0.7 deg off at most.
_CHORDS = 64

#: Bodies are removed up to this distance beyond a line, in m.
_REACH = 2.0


class Slide(Directed):
    """The launch of a body."""

    speed: float = quantity(..., "m/s", 0, 80, "speed")
    angle: float = quantity(..., "deg", -180, 180, "direction, to the left of straight ahead")
    spin: float = quantity(..., "rpm", -5000, 5000, "counter-clockwise positive, as seen from above")
    aside: float = quantity(..., "m", -50, 50, "where it starts, to the left of the middle")

    @property
    def turning(self) -> float:
        """Its spin in rad/s."""
        return self.spin * RPM

    def check(self, side: float) -> None:
        """Raise RequestError if it starts further aside than ``side`` (m)."""
        if abs(self.aside) > side:
            raise RequestError(f"launch.aside = {self.aside:g} m: must be between {-side:.3g} and {side:.3g} m")


class Sliding(SceneParameters):
    """Parameters of bodies that slide on a plane seen from above; a sport adds its own."""

    launch: Slide = group(..., "the one that is sent on its way")
    gravity: float = quantity(..., "m/s^2", 0.1, 30, "gravity")


class SlidingDisc(Solid):
    """A disc that slides, such as a stone or a puck."""

    mass: float = quantity(..., "kg", 0.001, 100, "mass")
    radius: float = quantity(..., "m", 0.002, 0.5, "radius")

    def at(self, name: str, place: Vector, velocity: Vector = (0.0, 0.0), spin: float = 0.0) -> Ball:
        """A disc at a place in m, with a velocity in m/s and a spin in rad/s."""
        return Ball(name, self.mass, self.radius, place, velocity, spin, inertia_factor=DISC)


def beyond(name: str, a: Vector, b: Vector, gap: float = 0.0, only: Sequence[str] = ()) -> Trap:
    """A trap that removes bodies whose centre is more than ``gap`` m beyond a line, to its right from a to b."""
    length = dist(a, b)
    nx, ny = (b[1] - a[1]) / length, (a[0] - b[0]) / length
    out = gap + _REACH
    return Trap(name, (a[0] + out * nx, a[1] + out * ny), _REACH, (b[0] + out * nx, b[1] + out * ny), only)


def beside(name: str, side: float, near: float, far: float, gap: float = 0.0, only: Sequence[str] = ()) -> list[Trap]:
    """Traps that remove bodies more than ``gap`` m beyond a line on either side: y = +-side, x = near to far (m)."""
    return [
        beyond(name, (far, side), (near, side), gap, only),
        beyond(name, (near, -side), (far, -side), gap, only),
    ]


def rounded(length: float, width: float, corner: float, opening: float) -> list[Vector]:
    """Points of a rectangle with rounded corners about the origin, each of CHORDS chords, counter-clockwise from one
    side of an ``opening`` in the middle of the end at +x to the other; lengths in m."""
    x, y, r = 0.5 * length, 0.5 * width, min(corner, 0.5 * length, 0.5 * width)
    middles = (x - r, y - r), (r - x, y - r), (r - x, r - y), (x - r, r - y)
    turns = [
        (middle, 0.5 * pi * (i + step / _CHORDS)) for i, middle in enumerate(middles) for step in range(_CHORDS + 1)
    ]
    corners = [(a + r * cos(turn), b + r * sin(turn)) for (a, b), turn in turns]
    return [*dict.fromkeys([(x, 0.5 * opening), *corners, (x, -0.5 * opening)])]  # corners may meet


def all_collisions(run: Run) -> list[Event]:
    """Every collision of two bodies, of a body with a surface, and of one with a trap. The hops of bodies that are
    pressed together count as one."""
    hop = 1.001 * slowest_hop(run.setup, run.accuracy.hop)
    last: dict[str, str] = {}  # with what each body collided last
    found = []
    for event in (event for event in run.events if event.kind in ("impact", "caught")):
        if event.speed > hop or last.get(event.ball) != event.partner:
            found.append(event)
        last[event.ball], last[event.partner] = event.partner, event.ball
    return found


def collisions_of(run: Run, name: str) -> list[tuple[str, Event]]:
    """The collisions of a body in order, up to its removal: the name of the other, and the event."""
    return [(e.partner if e.ball == name else e.ball, e) for e in all_collisions(run) if name in (e.ball, e.partner)]


def check_inside(balls: Sequence[Ball], length: float, width: float, corner: float) -> None:
    """Raise RequestError for a body that starts outside a rectangle with rounded corners about the origin, in m."""
    for ball in balls:
        (x, y), r = ball.position, min(corner, 0.5 * length, 0.5 * width)
        over_x, over_y = (abs(at) - 0.5 * size + r for at, size in ((x, length), (y, width)))
        out = hypot(max(over_x, 0.0), max(over_y, 0.0)) + min(max(over_x, over_y), 0.0) - r
        if out + ball.radius > 1e-9:
            raise RequestError(
                f"{ball.name} at ({x:g}, {y:g}) m is outside the boards: it has a radius of {ball.radius:g} m"
            )


def removed_by(run: Run) -> dict[str, str]:
    """The names of the traps that removed bodies, by the names of these, in order."""
    return {event.ball: event.partner for event in run.events if event.kind == "caught"}


def end_of(run: Run, name: str) -> Vector:
    """The final position of a body, or that of its removal, in m."""
    t = run.caught_at(name)
    x, y = run.state(name, run.duration if t is None else t)[:2]
    return x, y


def in_play(run: Run) -> dict[str, Vector]:
    """The final position of each body that was not removed, in m."""
    off = removed_by(run)
    return {ball.name: end_of(run, ball.name) for ball in run.setup.balls if ball.name not in off}


def lateral_offset(run: Run, name: str, launch: Slide) -> float:
    """The distance in m by which a body ends to the left of the line on which it was launched."""
    (x, y), (x0, y0) = end_of(run, name), run.state(name, 0.0)[:2]
    way = launch.angle * DEGREE
    return (y - y0) * cos(way) - (x - x0) * sin(way)


def _rest_time(run: Run, parameters: Any) -> float | None:
    """Time in s after which nothing moves any more; None for a single ball that was caught: it did not come to rest."""
    caught_alone = len(run.arcs) == 1 and run.caught_at(*run.arcs) is not None
    return run.duration if run.ended == "rest" and not caught_alone else None


REST_TIME = Fact("rest_time", "at rest after", "s", _rest_time)
