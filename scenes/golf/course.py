"""The golf course: kinds of ground laid along a line of heights, and the cup."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

from sandbox.engine.model.bounce_laws import PennerTurf
from sandbox.kit import Group, RequestError, Segment, Surface, Vector, choice, group, groups, quantity, vectors
from sandbox.physics.turf import stimp_resistance

#: The course extends this far in m, behind and beyond: farther than a shot gets.
FAR = 2e5

#: Bounces lower than this, in m, are lost in the grass and the ball rolls (Penner 2002, Can. J. Phys. 80:931).
LOWEST_BOUNCE = 0.005

#: Restitution, friction and rolling resistance of the cup and its rim. Without restitution the fastest putt that it
#: holds crosses the near edge at 1.64 m/s; Holmes 1991, Am. J. Phys. 59:129, has 1.63 m/s (second-hand). The others are
#: assumed.
CUP = (0.0, 0.4, 0.1)


class Grass(Group):
    """The bounce of a ball on a kind of ground."""

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

    @property
    def resistance(self) -> float:
        """Deceleration of a rolling ball over gravity."""
        return stimp_resistance(self.stimp)


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

    @property
    def line(self) -> list[Vector]:
        """The ground's line, in m: level beyond the ends of what the file gives."""
        points = self.heights or [(0.0, 0.0)]
        return [(-FAR, points[0][1]), *points, (FAR, points[-1][1])]

    def height(self, x: float) -> float:
        """Height of the ground in m at x."""
        (x0, y0), (x1, y1) = next(piece for piece in pairwise(self.line) if x <= piece[1][0])
        return y0 + (y1 - y0) * (x - x0) / (x1 - x0)

    def point(self, x: float) -> Vector:
        """The point of the ground's line at x, in m."""
        return x, self.height(x)


class Pin(Group):
    """The flag and its cup."""

    distance: float = quantity(..., "m", -500, 2500, "from the tee to the middle of the cup")
    cup_width: float = quantity(..., "m", 0, 10, "width of the cup; 0 for none")
    cup_depth: float = quantity(..., "m", 0.01, 2, "depth of the cup")
    reach: float = quantity(
        ..., "m", 0, 100, "a ball that comes down within this meets the flag, and the run ends there; 0: the cup counts"
    )

    def around(self, width: float) -> Vector:
        """The ends in m of what is so wide, with the pin in its middle."""
        return self.distance - 0.5 * width, self.distance + 0.5 * width


def surfaces(ground: Ground, pin: Pin, radius: float) -> list[Surface]:
    """The cup, and the ground in pieces of one kind, for a ball of that radius in m that starts at x = 0."""
    _check(ground, pin, radius)
    left, right = pin.around(pin.cup_width)
    strips = (x for strip in ground.strips for x in (strip.start, strip.end))
    edges = sorted({left, right, *pin.around(ground.green.length), *strips, *(x for x, _ in ground.line)})
    pieces = [(a, b) for a, b in pairwise(map(ground.point, edges)) if not left <= a[0] < right]
    turf = [_turf(ground, kind_at(ground, pin, 0.5 * (a[0] + b[0])), Segment(a, b)) for a, b in pieces]
    if left == right:
        return turf
    bottom = min(ground.height(left), ground.height(right)) - pin.cup_depth
    walls = pairwise([ground.point(left), (left, bottom), (right, bottom), ground.point(right)])
    return [*(Surface("cup", Segment(*ends), *CUP) for ends in walls), *turf]


def kind_at(ground: Ground, pin: Pin, x: float) -> str:
    """Kind of ground at x: the green around the pin, or the last strip that covers x, or fairway."""
    if abs(x - pin.distance) < 0.5 * ground.green.length:
        return "green"
    covering = (strip.kind for strip in reversed(ground.strips) if strip.start <= x < strip.end)
    return next(covering, "fairway")


def _turf(ground: Ground, kind: str, shape: Segment) -> Surface:
    if kind == "water":
        return Surface("water", shape, 0.0, 0.0)
    grass: Turf | Green = getattr(ground, kind)
    law = PennerTurf(grass.bounce, grass.friction, grass.give)
    return Surface(kind, shape, law(0.0, 0.0).restitution, grass.friction, grass.resistance, LOWEST_BOUNCE, law)


def _check(ground: Ground, pin: Pin, radius: float) -> None:
    """Raise RequestError where the course makes no sense."""
    for (x0, _), (x1, _) in pairwise(ground.heights):
        if x1 <= x0:
            raise RequestError(f"ground.heights: x must grow from point to point, but {x1:g} m follows {x0:g} m")
    for kind, start, end in ((strip.kind, strip.start, strip.end) for strip in ground.strips):
        if end <= start:
            raise RequestError(f"ground.strips: the {kind} from {start:g} m to {end:g} m has no length")
    for place, strip in enumerate(ground.strips):
        reached = strip.start
        for over in sorted(ground.strips[place + 1 :], key=lambda over: over.start):
            reached = max(reached, over.end) if over.start <= reached else reached
        if reached >= strip.end:
            raise RequestError(
                f"ground.strips: the {strip.kind} from {strip.start:g} m to {strip.end:g} m lies under later ones: "
                "give it after them, or leave it out"
            )
    left, right = pin.around(pin.cup_width)
    if left < right and left < radius and right > -radius:
        raise RequestError(f"pin.distance: the cup at {pin.distance:g} m is where the ball starts, at 0 m")
