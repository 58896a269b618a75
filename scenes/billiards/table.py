"""The table's geometry: cushions, jaws and pockets, from above, with the origin at its centre and x along its length.

The shape of a rail, here at the corner pocket beyond its right end, mirrored for all others::

               . facing, the jaw: at the cut angle to the nose, as deep as the cushion is wide
              /
    ---------'   nose; where its line meets the facing's lies the pocket's point, rounded by the jaw radius

The mouth of a pocket is the distance between its two points, before they are rounded. The shelf is the bed beyond the
middle of the mouth, up to the edge of the hole; a ball drops when its centre is over that edge. The sizes of each kind
of table, with their sources, are in ``tables.toml``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import copy
from functools import reduce
from itertools import product
from math import cos, pi, sin, sqrt, tan
from operator import or_
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from pydantic import create_model

from sandbox.kit import ConstantBounce, Group, RequestError, Segment, Surface, Trap, choice, quantity, switch
from sandbox.toml import read_toml


class Table(Group):
    """The cushions' noses and the pockets between them."""

    kind: str = choice(..., "the table whose sizes stand where none are given")
    length: float = quantity(..., "m", 0.3, 20, "between the noses of the short rails")
    width: float = quantity(..., "m", 0.3, 20, "between the noses of the long rails")
    pockets: bool = switch(..., "whether there are pockets")
    corner_mouth: float = quantity(..., "m", 0.01, 1, "width of a corner pocket between its points")
    corner_angle: float = quantity(..., "deg", 135, 170, "cut angle at a corner pocket, from nose to facing")
    corner_jaw_radius: float = quantity(..., "m", 0, 0.5, "rounding of a corner pocket's points")
    corner_shelf: float = quantity(..., "m", -0.1, 0.5, "bed from the middle of the mouth to the hole's edge")
    corner_hole_radius: float = quantity(..., "m", 0.01, 0.5, "radius of a corner pocket's hole")
    side_mouth: float = quantity(..., "m", 0.01, 1, "width of a side pocket between its points")
    side_angle: float = quantity(..., "deg", 90, 170, "cut angle at a side pocket, from nose to facing")
    side_jaw_radius: float = quantity(..., "m", 0, 0.5, "rounding of a side pocket's points")
    side_shelf: float = quantity(..., "m", -0.1, 0.5, "bed from the middle of the mouth to the hole's edge")
    side_hole_radius: float = quantity(..., "m", 0.01, 0.5, "radius of a side pocket's hole")
    cushion_width: float = quantity(..., "m", 0.005, 0.5, "from nose to rail: how deep the facings go")


def _kind(kind: str, sizes: Mapping[str, Any]) -> type[Table]:
    """The group of a table of that kind, with its sizes as defaults."""
    fields: dict[str, Any] = {"kind": (Literal[kind], choice(kind, Table.model_fields["kind"].description or ""))}
    for name, default in sizes.items():
        if name == "cushion":
            continue
        field = copy(Table.model_fields[name])
        field.default = default
        fields[name] = (field.annotation, field)
    return create_model("Table_" + kind.replace("-", "_"), __base__=Table, __doc__=f"A table: {kind}.", **fields)


KINDS = read_toml(Path(__file__).parent / "tables.toml")

#: The cushion of each kind of table.
CUSHIONS = {kind: {**KINDS["9-ft"]["cushion"], **sizes.get("cushion", {})} for kind, sizes in KINDS.items()}

if TYPE_CHECKING:
    AnyTable = Table
else:
    AnyTable = reduce(or_, (_kind(kind, KINDS["9-ft"] | sizes) for kind, sizes in KINDS.items()))


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
        """The length of a nose that the pocket takes: from a side pocket's middle, or from the corner of the noses."""
        return self.tangent + (self.mouth / sqrt(2.0) if self.name == "corner" else 0.5 * self.mouth)

    def jaw(self, nose: float, lost: float, forward: float) -> Segment:
        """A facing as thick as its point is round, beyond the line of its nose at ``nose`` on the second axis.

        The nose runs towards the pocket along ``forward`` times the first axis, and ends at ``lost`` on it.
        """
        ax, ay, length = lost, nose + self.jaw_radius, self.facing - self.tangent
        b = (ax + forward * length * cos(self.turn), ay + length * sin(self.turn))
        return Segment((ax, ay), b, self.jaw_radius)


def pockets(table: Table) -> Iterator[Pocket]:
    """Corner and side pocket."""
    for name in ("corner", "side"):
        mouth, angle, jaw, shelf, hole = (
            getattr(table, f"{name}_{size}") for size in ("mouth", "angle", "jaw_radius", "shelf", "hole_radius")
        )
        yield Pocket(name, mouth, pi * (1.0 - angle / 180.0), jaw, shelf, hole, table.cushion_width)


def check(table: Table, ball_radius: float) -> None:
    """Raises RequestError for a table that does not close: rails without length, or a way past a hole."""
    for wrong in _faults(table, ball_radius):
        raise RequestError(wrong)


def _faults(table: Table, ball_radius: float) -> Iterator[str]:
    sizes = {"length": table.length, "width": table.width}
    if min(sizes.values()) <= 4.0 * ball_radius:
        said = ", ".join(f"table.{key} = {size:g} m" for key, size in sizes.items())
        yield f"{said}: too small for balls with ball.radius = {ball_radius:g} m"
    if not table.pockets:
        return
    corner, side = pockets(table)
    for key, need in (("width", 2.0 * corner.lost), ("length", 2.0 * (corner.lost + side.lost))):
        if sizes[key] <= need:
            yield f"table.{key} = {sizes[key]:g} m: the pockets leave no rail; it must be more than {need:g} m"
    for pocket, inward in ((corner, 0.25 * pi - corner.turn), (side, 0.5 * pi - side.turn)):
        half = max(0.5 * pocket.mouth - ball_radius, 0.0)  # how far from the pocket's axis a ball can pass
        widest, hole = pocket.facing / tan(0.5 * pocket.turn), pocket.hole_radius
        deepest = pocket.facing * cos(inward) - (hole - sqrt(max(0.0, hole**2 - half**2)))
        if pocket.jaw_radius >= widest:
            yield _fault(pocket, "jaw_radius", "the rounding is longer than the facing", f"less than {widest:g}")
        if hole <= half:
            yield _fault(pocket, "hole_radius", "balls pass beside the hole", f"more than {half:g}")
        if pocket.shelf > deepest:
            yield _fault(pocket, "shelf", "the hole lies behind the cushions", f"at most {deepest:.4g}")


def _fault(pocket: Pocket, key: str, wrong: str, bound: str) -> str:
    return f"table.{pocket.name}_{key} = {getattr(pocket, key):g} m: {wrong}; it must be {bound} m"


def on_bed(table: Table, x: float, y: float) -> bool:
    """True if a point (m) lies inside the noses or in the mouth of a pocket, up to the middle of its hole."""
    x, y = abs(x) - 0.5 * table.length, abs(y) - 0.5 * table.width  # beyond the noses
    if max(x, y) <= 0.0:
        return True
    corner, side = pockets(table)
    deep, aside = (x + y + corner.mouth / sqrt(2.0)) / sqrt(2.0), (x - y) / sqrt(2.0)
    in_corner = 0.0 <= deep <= corner.shelf + corner.hole_radius and abs(aside) < 0.5 * corner.mouth
    in_side = 0.0 <= y <= side.shelf + side.hole_radius and x + 0.5 * table.length < 0.5 * side.mouth
    return table.pockets and (in_corner or in_side)


def cushions(table: Table, law: ConstantBounce, nose: float | None = None) -> list[Surface]:
    """Noses, ``nose`` m over the cloth (None for walls), and then jaws.

    Head is at negative x, foot at positive x; left, seen from the head, is at positive y.
    """
    shapes = sorted(_rails(table), key=lambda rail: rail[0].endswith("jaw"))
    restitution, friction, _, tangential = law.bounce
    own = law if tangential > 0.0 else None
    return [Surface(name, shape, restitution, friction, nose_height=nose, law=own) for name, shape in shapes]


def _rails(table: Table) -> Iterator[tuple[str, Segment]]:
    """Each nose and each jaw, by name."""
    x, y = 0.5 * table.length, 0.5 * table.width
    flanks, ends = {"right": -1.0, "left": 1.0}, {"head": -1.0, "foot": 1.0}
    if not table.pockets:
        yield from ((f"{flank} long cushion", Segment((-x, sy * y), (x, sy * y))) for flank, sy in flanks.items())
        yield from ((f"{end} cushion", Segment((sx * x, -y), (sx * x, y))) for end, sx in ends.items())
        return
    corner, side = pockets(table)
    reach = y - corner.lost
    rail, facing = Segment((side.lost, y), (x - corner.lost, y)), side.jaw(y, side.lost, -1.0)
    facings = corner.jaw(y, x - corner.lost, 1.0), _swapped(corner.jaw(x, reach, 1.0))
    yield from ((f"{end} cushion", Segment((sx * x, -reach), (sx * x, reach))) for end, sx in ends.items())
    for (end, sx), (flank, sy) in product(ends.items(), flanks.items()):
        yield f"{flank} long cushion", _mirrored(rail, sx, sy)
        yield f"{flank} side jaw", _mirrored(facing, sx, sy)
        yield from ((f"{flank} {end} corner jaw", _mirrored(shape, sx, sy)) for shape in facings)


def _mirrored(shape: Segment, sx: float, sy: float) -> Segment:
    (ax, ay), (bx, by) = shape.a, shape.b
    return Segment((sx * ax, sy * ay), (sx * bx, sy * by), shape.radius)


def _swapped(shape: Segment) -> Segment:
    """With its axes exchanged, from a long rail to a short one."""
    return Segment(shape.a[::-1], shape.b[::-1], shape.radius)


def traps(table: Table) -> list[Trap]:
    """The holes."""
    if not table.pockets:
        return []
    corner, side = pockets(table)
    # from the crossing of the noses out along the diagonal; the mouth's middle lies half a mouth inside of it
    out = (corner.shelf + corner.hole_radius - 0.5 * corner.mouth) / sqrt(2.0)
    x, y, aside = 0.5 * table.length + out, 0.5 * table.width + out, 0.5 * table.width + side.shelf + side.hole_radius
    holes = (("head corner", -x, y, corner), ("side", 0.0, aside, side), ("foot corner", x, y, corner))
    return [
        Trap(f"{flank} {name} pocket", (across, sy * up), pocket.hole_radius)
        for name, across, up, pocket in holes
        for sy, flank in ((1.0, "left"), (-1.0, "right"))
    ]
