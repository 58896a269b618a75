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

from copy import copy
from functools import reduce
from itertools import product
from math import cos, pi, sin, sqrt, tan
from operator import or_
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from pydantic import create_model

from sandbox.engine.setup import Catch, Segment, Surface
from sandbox.errors import RequestError
from sandbox.parameters import Group, choice, quantity, switch


class Table(Group):
    """The cushions' noses and the pockets between them: a 9 ft pool table, where a kind does not say otherwise."""

    kind: str = choice("9-ft", "the table whose sizes stand where none are given")
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


#: The kinds of tables, by what differs from a 9 ft pool table. Those of snooker have jaws that are wide curves into a
#: throat with parallel sides; the sizes of its pockets are assumed.
KINDS: dict[str, dict[str, Any]] = {
    "9-ft": {},
    "8-ft": {"length": "92 in", "width": "46 in"},
    "7-ft": {"length": "78 in", "width": "39 in"},
    "snooker": {
        "length": "3569 mm",
        "width": "1778 mm",
        "corner_mouth": "85 mm",
        "corner_angle": 135.0,
        "corner_jaw_radius": "90 mm",
        "corner_shelf": "5 mm",
        "corner_hole_radius": "45 mm",
        "side_mouth": "90 mm",
        "side_angle": 90.0,
        "side_jaw_radius": "40 mm",
        "side_shelf": "5 mm",
        "side_hole_radius": "45 mm",
    },
    "carom": {"length": "2.84 m", "width": "1.42 m", "pockets": False},
}


def _kind(kind: str, sizes: dict[str, Any]) -> type[Table]:
    """The group of a table of that kind."""
    fields: dict[str, Any] = {}
    for name, default in sizes.items():
        field = copy(Table.model_fields[name])
        field.default = default
        fields[name] = (field.annotation, field)
    fields["kind"] = (Literal[kind], choice(kind, Table.model_fields["kind"].description or ""))
    return create_model("Table_" + kind.replace("-", "_"), __base__=Table, __doc__=f"A table: {kind}.", **fields)


if TYPE_CHECKING:
    AnyTable = Table
else:
    AnyTable = reduce(or_, (_kind(kind, sizes) for kind, sizes in KINDS.items()))


class Pocket(NamedTuple):
    """A kind of pocket; lengths in m, angles in rad."""

    name: str
    mouth: float
    turn: float  # from the nose's direction into the pocket to the facing's
    jaw_radius: float
    shelf: float
    hole_radius: float
    deep: float  # how far facings go into the pocket, across their noses

    @property
    def facing(self) -> float:
        """Length of a facing, from where its line meets the nose's."""
        return self.deep / sin(self.turn)

    @property
    def tangent(self) -> float:
        """From where the lines of nose and facing meet to where the rounding begins."""
        return self.jaw_radius * tan(0.5 * self.turn)

    @property
    def lost(self) -> float:
        """How much of a nose the pocket takes, from the middle of a side pocket or from the corner of the noses."""
        return self.tangent + (self.mouth / sqrt(2.0) if self.name == "corner" else 0.5 * self.mouth)

    def jaw(self, nose: float, lost: float, forward: float) -> Segment:
        """A facing as thick as its point is round, beyond the line of its nose at ``nose`` on the second axis.

        The nose runs towards the pocket along ``forward`` times the first axis, and ends at ``lost`` on it.
        """
        ax, ay, length = lost, nose + self.jaw_radius, self.facing - self.tangent
        b = (ax + forward * length * cos(self.turn), ay + length * sin(self.turn))
        return Segment((ax, ay), b, self.jaw_radius)


def pockets(table: Table) -> tuple[Pocket, Pocket]:
    """Corner and side pocket."""

    def pocket(name: str) -> Pocket:
        mouth, angle, jaw, shelf, hole = (
            getattr(table, f"{name}_{size}") for size in ("mouth", "angle", "jaw_radius", "shelf", "hole_radius")
        )
        return Pocket(name, mouth, pi * (1.0 - angle / 180.0), jaw, shelf, hole, table.cushion_width)

    return pocket("corner"), pocket("side")


def check(table: Table, ball_radius: float) -> None:
    """Raises RequestError for a table that does not close: rails without length, or a way past a hole."""
    if min(table.length, table.width) <= 4.0 * ball_radius:
        raise RequestError(
            f"table.length = {table.length:g} m, table.width = {table.width:g} m: too small for balls with "
            f"ball.radius = {ball_radius:g} m"
        )
    if not table.pockets:
        return
    corner, side = pockets(table)
    for key, size, need in (("width", table.width, corner.lost), ("length", table.length, corner.lost + side.lost)):
        if size <= 2.0 * need:
            raise RequestError(
                f"table.{key} = {size:g} m: the pockets leave no rail; it must be more than {2.0 * need:g} m"
            )
    for pocket, inward in ((corner, 0.25 * pi - corner.turn), (side, 0.5 * pi - side.turn)):
        half = max(0.5 * pocket.mouth - ball_radius, 0.0)  # how far from the pocket's axis a ball can pass
        widest = pocket.facing / tan(0.5 * pocket.turn)
        beyond = pocket.hole_radius - sqrt(max(0.0, pocket.hole_radius**2 - half**2))
        deepest = pocket.facing * cos(inward) - beyond
        for key, fits, wrong, bound in (
            (
                "jaw_radius",
                pocket.jaw_radius < widest,
                "the rounding is longer than the facing",
                f"less than {widest:g}",
            ),
            ("hole_radius", pocket.hole_radius > half, "balls pass beside the hole", f"more than {half:g}"),
            ("shelf", pocket.shelf <= deepest, "the hole lies behind the cushions", f"at most {deepest:.4g}"),
        ):
            if not fits:
                value = f"table.{pocket.name}_{key} = {getattr(pocket, key):g} m"
                raise RequestError(f"{value}: {wrong}; it must be {bound} m")


def on_bed(table: Table, x: float, y: float) -> bool:
    """Whether a point (m) lies inside the noses or in the mouth of a pocket, up to the middle of its hole."""
    x, y = abs(x) - 0.5 * table.length, abs(y) - 0.5 * table.width  # beyond the noses
    if max(x, y) <= 0.0:
        return True
    if not table.pockets:
        return False
    corner, side = pockets(table)
    deep, aside = (x + y + corner.mouth / sqrt(2.0)) / sqrt(2.0), (x - y) / sqrt(2.0)
    in_corner = 0.0 <= deep <= corner.shelf + corner.hole_radius and abs(aside) < 0.5 * corner.mouth
    in_side = 0.0 <= y <= side.shelf + side.hole_radius and x + 0.5 * table.length < 0.5 * side.mouth
    return in_corner or in_side


def cushions(table: Table, restitution: float, friction: float, nose: float | None = None) -> list[Surface]:
    """Noses, ``nose`` m over the cloth (None for walls), and jaws.

    Head is at negative x, foot at positive x; left, seen from the head, is at positive y.
    """
    x, y = 0.5 * table.length, 0.5 * table.width
    noses: list[tuple[str, Segment]] = []
    jaws: list[tuple[str, Segment]] = []
    if table.pockets:
        corner, side = pockets(table)
        ends, flanks, reach = ((-1.0, "head"), (1.0, "foot")), ((-1.0, "right"), (1.0, "left")), y - corner.lost
        rail, facing = Segment((side.lost, y), (x - corner.lost, y)), side.jaw(y, side.lost, -1.0)
        facings = corner.jaw(y, x - corner.lost, 1.0), _swapped(corner.jaw(x, reach, 1.0))
        noses += [(f"{end} cushion", Segment((sx * x, -reach), (sx * x, reach))) for sx, end in ends]
        for (sx, end), (sy, flank) in product(ends, flanks):
            noses.append((f"{flank} long cushion", _mirrored(rail, sx, sy)))
            jaws.append((f"{flank} side jaw", _mirrored(facing, sx, sy)))
            jaws += [(f"{flank} {end} corner jaw", _mirrored(shape, sx, sy)) for shape in facings]
    else:
        noses += [("left long cushion", Segment((-x, y), (x, y))), ("right long cushion", Segment((-x, -y), (x, -y)))]
        noses += [("head cushion", Segment((-x, -y), (-x, y))), ("foot cushion", Segment((x, -y), (x, y)))]
    return [Surface(name, shape, restitution, friction, nose_height=nose) for name, shape in (*noses, *jaws)]


def _mirrored(shape: Segment, sx: float, sy: float) -> Segment:
    (ax, ay), (bx, by) = shape.a, shape.b
    return Segment((sx * ax, sy * ay), (sx * bx, sy * by), shape.radius)


def _swapped(shape: Segment) -> Segment:
    """With its axes exchanged, from a long rail to a short one."""
    return Segment(shape.a[::-1], shape.b[::-1], shape.radius)


def catches(table: Table) -> list[Catch]:
    """The holes."""
    if not table.pockets:
        return []
    corner, side = pockets(table)
    # from the crossing of the noses out along the diagonal; the mouth's middle lies half a mouth inside of it
    out = (corner.shelf + corner.hole_radius - 0.5 * corner.mouth) / sqrt(2.0)
    x, y, aside = 0.5 * table.length + out, 0.5 * table.width + out, 0.5 * table.width + side.shelf + side.hole_radius
    holes = (("head corner", -x, y, corner), ("side", 0.0, aside, side), ("foot corner", x, y, corner))
    return [
        Catch(f"{flank} {name} pocket", (across, sy * up), pocket.hole_radius)
        for name, across, up, pocket in holes
        for sy, flank in ((1.0, "left"), (-1.0, "right"))
    ]
