"""The table's geometry: cushions, jaws and pockets, from above, with the origin at its centre and x along its length.

The shape of a rail, here at the corner pocket beyond its right end, mirrored for all others::

               . facing, the jaw: at the cut angle to the nose, as deep as the cushion is wide
              /
    ---------'   nose; where its line meets the facing's lies the pocket's point, rounded by the jaw radius

The mouth of a pocket is the distance between its two points, before they are rounded. The shelf is the bed beyond the
middle of the mouth, up to the edge of the hole; a ball drops when its centre is over that edge.

Source of names, angles and sizes of pool tables: World Pool-Billiard Association, Tournament Table & Equipment
Specifications: corner mouth 4.5 to 4.625 in, 142 deg, shelf 1 to 2.25 in; side mouth 5 to 5.125 in, 104 deg, shelf 0 to
0.375 in; cushions 1.875 to 2 in wide. The middle of each range is the default; roundings and holes are assumed.
"""

from __future__ import annotations

from itertools import product
from math import cos, pi, sin, sqrt, tan
from typing import Literal, NamedTuple

from sandbox.engine.setup import Catch, Segment, Surface
from sandbox.errors import RequestError
from sandbox.parameters import Group, choice, quantity, switch

Point = tuple[float, float]


class Table(Group):
    """The cushions' noses and the pockets between them."""

    length: float = quantity("100 in", "m", 0.3, 20, "between the noses of the short rails")
    width: float = quantity("50 in", "m", 0.3, 20, "between the noses of the long rails")
    pockets: bool = switch(True, "whether there are pockets")
    corner_mouth: float = quantity("4.5625 in", "m", 0.01, 1, "width of a corner pocket between its points")
    corner_angle: float = quantity(142.0, "deg", 135, 170, "cut angle at a corner pocket, from nose to facing")
    corner_jaw_radius: float = quantity("0.25 in", "m", 0, 0.5, "rounding of a corner pocket's points")
    corner_shelf: float = quantity("1.625 in", "m", -0.1, 0.5, "bed from the middle of the mouth to the hole's edge")
    corner_hole_radius: float = quantity("2.5 in", "m", 0.01, 0.5, "radius of a corner pocket's hole")
    side_mouth: float = quantity("5.0625 in", "m", 0.01, 1, "width of a side pocket between its points")
    side_angle: float = quantity(104.0, "deg", 90, 170, "cut angle at a side pocket, from nose to facing")
    side_jaw_radius: float = quantity("0.25 in", "m", 0, 0.5, "rounding of a side pocket's points")
    side_shelf: float = quantity("0.1875 in", "m", -0.1, 0.5, "bed from the middle of the mouth to the hole's edge")
    side_hole_radius: float = quantity("2.5 in", "m", 0.01, 0.5, "radius of a side pocket's hole")
    cushion_width: float = quantity("2 in", "m", 0.005, 0.5, "from nose to rail: how deep the facings go")


class NineFoot(Table):
    """A 9 ft pool table."""

    kind: Literal["9-ft"] = choice("9-ft", "the table whose sizes stand where none are given")


class EightFoot(Table):
    """An 8 ft pool table."""

    kind: Literal["8-ft"] = choice("8-ft", "the table whose sizes stand where none are given")
    length: float = quantity("92 in", "m", 0.3, 20, "between the noses of the short rails")
    width: float = quantity("46 in", "m", 0.3, 20, "between the noses of the long rails")


class SevenFoot(Table):
    """A 7 ft pool table."""

    kind: Literal["7-ft"] = choice("7-ft", "the table whose sizes stand where none are given")
    length: float = quantity("78 in", "m", 0.3, 20, "between the noses of the short rails")
    width: float = quantity("39 in", "m", 0.3, 20, "between the noses of the long rails")


class Snooker(Table):
    """A 12 ft snooker table: its jaws are wide curves into a throat with parallel sides. Sizes of pockets assumed."""

    kind: Literal["snooker"] = choice("snooker", "the table whose sizes stand where none are given")
    length: float = quantity("3569 mm", "m", 0.3, 20, "between the noses of the short rails")
    width: float = quantity("1778 mm", "m", 0.3, 20, "between the noses of the long rails")
    corner_mouth: float = quantity("85 mm", "m", 0.01, 1, "width of a corner pocket between its points")
    corner_angle: float = quantity(135.0, "deg", 135, 170, "cut angle at a corner pocket, from nose to facing")
    corner_jaw_radius: float = quantity("90 mm", "m", 0, 0.5, "rounding of a corner pocket's points")
    corner_shelf: float = quantity("5 mm", "m", -0.1, 0.5, "bed from the middle of the mouth to the hole's edge")
    corner_hole_radius: float = quantity("45 mm", "m", 0.01, 0.5, "radius of a corner pocket's hole")
    side_mouth: float = quantity("90 mm", "m", 0.01, 1, "width of a side pocket between its points")
    side_angle: float = quantity(90.0, "deg", 90, 170, "cut angle at a side pocket, from nose to facing")
    side_jaw_radius: float = quantity("40 mm", "m", 0, 0.5, "rounding of a side pocket's points")
    side_shelf: float = quantity("5 mm", "m", -0.1, 0.5, "bed from the middle of the mouth to the hole's edge")
    side_hole_radius: float = quantity("45 mm", "m", 0.01, 0.5, "radius of a side pocket's hole")


class Carom(Table):
    """A carom table, without pockets."""

    kind: Literal["carom"] = choice("carom", "the table whose sizes stand where none are given")
    length: float = quantity("2.84 m", "m", 0.3, 20, "between the noses of the short rails")
    width: float = quantity("1.42 m", "m", 0.3, 20, "between the noses of the long rails")
    pockets: bool = switch(False, "whether there are pockets")


class _Mouth(NamedTuple):
    """Half the table's opening at one kind of pocket, all in m and rad."""

    name: str
    mouth: float
    turn: float  # from the nose's direction into the pocket to the facing's
    inward: float  # by which a facing leans towards the pocket's axis
    jaw_radius: float
    shelf: float
    hole_radius: float
    facing: float  # length of a facing, from where its line meets the nose's

    @property
    def tangent(self) -> float:
        """From where the lines of nose and facing meet to where the rounding begins."""
        return self.jaw_radius * tan(0.5 * self.turn)


def _mouths(table: Table) -> tuple[_Mouth, _Mouth]:
    """Corner and side pocket."""
    corner_turn, side_turn = pi * (1.0 - table.corner_angle / 180.0), pi * (1.0 - table.side_angle / 180.0)
    return (
        _Mouth(
            "corner",
            table.corner_mouth,
            corner_turn,
            0.25 * pi - corner_turn,
            table.corner_jaw_radius,
            table.corner_shelf,
            table.corner_hole_radius,
            table.cushion_width / sin(corner_turn),
        ),
        _Mouth(
            "side",
            table.side_mouth,
            side_turn,
            0.5 * pi - side_turn,
            table.side_jaw_radius,
            table.side_shelf,
            table.side_hole_radius,
            table.cushion_width / sin(side_turn),
        ),
    )


def check(table: Table, ball_radius: float) -> None:
    """Raises RequestError for a table that does not close: rails without length, or a way past a hole."""
    if min(table.length, table.width) <= 4.0 * ball_radius:
        raise RequestError(
            f"table.length = {table.length:g} m, table.width = {table.width:g} m: too small for balls with "
            f"ball.radius = {ball_radius:g} m"
        )
    if not table.pockets:
        return
    corner, side = _mouths(table)
    lost = corner.mouth / sqrt(2.0) + corner.tangent
    for key, room, need in (
        ("table.width", 0.5 * table.width, lost),
        ("table.length", 0.5 * table.length, lost + 0.5 * side.mouth + side.tangent),
    ):
        if room <= need:
            raise RequestError(
                f"{key} = {2.0 * room:g} m: the pockets leave no rail; it must be more than {2.0 * need:g} m"
            )
    for pocket in (corner, side):
        if pocket.facing <= pocket.tangent:
            raise RequestError(
                f"table.{pocket.name}_jaw_radius = {pocket.jaw_radius:g} m: the rounding is longer than the facing; "
                f"it must be less than {pocket.facing / tan(0.5 * pocket.turn):g} m"
            )
        half = max(0.5 * pocket.mouth - ball_radius, 0.0)  # how far from the pocket's axis a ball can pass
        if pocket.hole_radius <= half:
            raise RequestError(
                f"table.{pocket.name}_hole_radius = {pocket.hole_radius:g} m: balls pass beside the hole; "
                f"it must be more than {half:g} m"
            )
        beyond = pocket.hole_radius - sqrt(pocket.hole_radius**2 - half**2)
        deepest = pocket.facing * cos(pocket.inward) - beyond
        if pocket.shelf > deepest:
            raise RequestError(
                f"table.{pocket.name}_shelf = {pocket.shelf:g} m: the hole lies behind the cushions; "
                f"it must be at most {deepest:.4g} m"
            )


def on_bed(table: Table, x: float, y: float) -> bool:
    """Whether a point (m) lies inside the noses or in the mouth of a pocket, up to the middle of its hole."""
    x, y = abs(x) - 0.5 * table.length, abs(y) - 0.5 * table.width  # beyond the noses
    if max(x, y) <= 0.0:
        return True
    if not table.pockets:
        return False
    corner, side = _mouths(table)
    deep, aside = (x + y + corner.mouth / sqrt(2.0)) / sqrt(2.0), (x - y) / sqrt(2.0)
    in_corner = 0.0 <= deep <= corner.shelf + corner.hole_radius and abs(aside) < 0.5 * corner.mouth
    in_side = 0.0 <= y <= side.shelf + side.hole_radius and x + 0.5 * table.length < 0.5 * side.mouth
    return in_corner or in_side


def cushions(table: Table, restitution: float, friction: float, nose: float | None = None) -> list[Surface]:
    """Noses, ``nose`` m over the cloth (None for walls), and jaws.

    Head is at negative x, foot at positive x; left, seen from the head, is at positive y.
    """
    x, y = 0.5 * table.length, 0.5 * table.width
    if not table.pockets:
        lines = {
            "left long cushion": Segment((-x, y), (x, y)),
            "right long cushion": Segment((-x, -y), (x, -y)),
            "head cushion": Segment((-x, -y), (-x, y)),
            "foot cushion": Segment((x, -y), (x, y)),
        }
        return [Surface(name, shape, restitution, friction, nose_height=nose) for name, shape in lines.items()]
    corner, side = _mouths(table)
    cut = corner.mouth / sqrt(2.0)  # from the crossing of two rails' noses to a corner pocket's point
    noses: list[tuple[str, Segment]] = []
    jaws: list[tuple[str, Segment]] = []
    for sx, end in ((-1.0, "head"), (1.0, "foot")):
        reach = y - cut - corner.tangent
        noses.append((f"{end} cushion", Segment((sx * x, -reach), (sx * x, reach))))
    for sx, sy in product((-1.0, 1.0), (-1.0, 1.0)):
        end, flank = ("head" if sx < 0.0 else "foot"), ("right" if sy < 0.0 else "left")
        near, far = 0.5 * side.mouth + side.tangent, x - cut - corner.tangent
        noses.append((f"{flank} long cushion", Segment((sx * near, sy * y), (sx * far, sy * y))))
        for (ax, ay), (bx, by), radius, name in (
            (*_facing(0.5 * side.mouth, y, -1.0, side), side.jaw_radius, f"{flank} side jaw"),
            (*_facing(x - cut, y, 1.0, corner), corner.jaw_radius, f"{flank} {end} corner jaw"),
        ):
            jaws.append((name, Segment((sx * ax, sy * ay), (sx * bx, sy * by), radius)))
        (ay, ax), (by, bx) = _facing(y - cut, x, 1.0, corner)
        jaws.append((f"{flank} {end} corner jaw", Segment((sx * ax, sy * ay), (sx * bx, sy * by), corner.jaw_radius)))
    return [Surface(name, shape, restitution, friction, nose_height=nose) for name, shape in (*noses, *jaws)]


def _facing(point: float, nose: float, forward: float, pocket: _Mouth) -> tuple[Point, Point]:
    """Ends of the middle line of a facing that is as thick as its point is round.

    (point, nose) is where its line meets that of the nose, which runs towards the pocket along ``forward`` times the
    first axis; the second axis points away from the table.
    """
    a = (point - forward * pocket.tangent, nose + pocket.jaw_radius)
    length = pocket.facing - pocket.tangent
    return a, (a[0] + forward * length * cos(pocket.turn), a[1] + length * sin(pocket.turn))


def catches(table: Table) -> list[Catch]:
    """The holes."""
    if not table.pockets:
        return []
    corner, side = _mouths(table)
    # from the crossing of the noses out along the diagonal; the mouth's middle lies half a mouth inside of it
    out = (corner.shelf + corner.hole_radius - 0.5 * corner.mouth) / sqrt(2.0)
    x, y = 0.5 * table.length + out, 0.5 * table.width + out
    side_y = 0.5 * table.width + side.shelf + side.hole_radius
    return [
        Catch("left head corner pocket", (-x, y), corner.hole_radius),
        Catch("right head corner pocket", (-x, -y), corner.hole_radius),
        Catch("left side pocket", (0.0, side_y), side.hole_radius),
        Catch("right side pocket", (0.0, -side_y), side.hole_radius),
        Catch("left foot corner pocket", (x, y), corner.hole_radius),
        Catch("right foot corner pocket", (x, -y), corner.hole_radius),
    ]
