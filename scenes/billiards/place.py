"""Drawing of the table in the room: its parts, their places and colours."""

from __future__ import annotations

from sandbox.engine.setup import Setup
from sandbox.picture.palette import mix, scene_colours
from sandbox.picture.places.plan import Ground, Line, Plan, Point, Spot, arc
from sandbox.picture.places.table import Lamp, Pocket, Rails, Room, around, cushions, sights

from .table import Table

COLOURS = scene_colours(__file__)

#: Least width of the wood beyond the cushions, and beyond the pockets; of a line on the cloth and of a spot, in m.
WOOD, ROUND_POCKETS, LINE, SPOT = 0.10, 0.032, 0.004, 0.0055
#: The maker's plate on the head rail: its width and length, and how far from the table's edge its middle lies, in m.
PLATE, PLATE_LENGTH, PLATE_INSIDE = 0.013, 0.16, 0.026
#: Head spot, centre spot and foot spot, as shares of half the length.
SPOTS = (-0.5, 0.0, 0.5)
#: Snooker's markings (WPBSA): from the head cushion to the line, the D's radius, from the foot cushion to the black, m.
BAULK, D_RADIUS, BLACK_SPOT = 0.737, 0.292, 0.324

MARKING = mix(COLOURS["cloth"], COLOURS["marking"], 0.55)
#: The cloth between the jaws lies in the cushions' shadow.
THROAT = mix(COLOURS["cloth"], COLOURS["rim"], 0.5)


def outside(setup: Setup, table: Table) -> Point:
    """Half the length and half the width of the table with its rails, in m."""
    x, y = 0.5 * table.length, 0.5 * table.width
    reach = [max(abs(h.center[0]) - x, abs(h.center[1]) - y) + h.radius + ROUND_POCKETS for h in setup.catches]
    rail = max([table.cushion_width + WOOD, *reach])
    return x + rail, y + rail


def place(setup: Setup, table: Table) -> Plan:
    """Room, rails, cloth with its markings, pockets, cushions, sights, and the lamp over them."""
    bed, outer = (0.5 * table.length, 0.5 * table.width), outside(setup, table)
    back = bed[0] + table.cushion_width, bed[1] + table.cushion_width
    beds = (back, THROAT), (bed, COLOURS["cloth"])
    middle = 0.55 * back[0] + 0.45 * outer[0], 0.55 * back[1] + 0.45 * outer[1]
    snooker = table.kind == "snooker"
    head = PLATE_INSIDE - outer[0]
    plate = Line(((head, -0.5 * PLATE_LENGTH), (head, 0.5 * PLATE_LENGTH)), PLATE, COLOURS["plate"])
    return (
        Room(outer, COLOURS["room"], COLOURS["room_shadow"]),
        Rails(back, outer, COLOURS["wood"], COLOURS["lip"]),
        *(Ground(around(half), colour) for half, colour in beds),
        *(_snooker_markings(bed[0], bed[1]) if snooker else _spots(*((share * bed[0], 0.0) for share in SPOTS))),
        *(Pocket(h.center, h.radius, beds, COLOURS["leather"], COLOURS["pocket"]) for h in setup.catches),
        *cushions(setup.surfaces, back, COLOURS["cushion"]),
        *(() if snooker else sights(bed, middle, COLOURS["sight"], bool(setup.catches))),
        plate,
        Lamp(bed, outer),
    )


def _snooker_markings(x: float, y: float) -> Plan:
    """Baulk line, D and spots, on a bed of half sizes x and y."""
    baulk = BAULK - x
    d = arc((baulk, 0.0), D_RADIUS, 90.0, 270.0)
    spots = [(baulk, side * D_RADIUS) for side in (-1, 0, 1)] + [(0.0, 0.0), (0.5 * x, 0.0), (x - BLACK_SPOT, 0.0)]
    return (Line(((baulk, -y), (baulk, y)), LINE, MARKING), Line(d, LINE, MARKING), *_spots(*spots))


def _spots(*places: Point) -> Plan:
    return tuple(Spot(at, SPOT, MARKING) for at in places)
