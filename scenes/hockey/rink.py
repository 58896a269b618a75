"""The ice with its lines, creases and goals, and the table of air hockey: parts of a plan, from above.

The middle of the rink is the origin, lengths are in m. Where the lines are follows NHL rule 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, product

import numpy as np

from sandbox.picture.palette import Colour, scene_colours
from sandbox.picture.places import Shape, goal
from sandbox.picture.places.plan import Ground, Line, Plan, Point, Spot, Worn, arc
from sandbox.picture.views import Box

from .scene import Rink

COLOURS = scene_colours(__file__)

#: From the middle to the blue lines and to the spots of the neutral zone; from the goal lines to the spots of the ends;
#: across to all of them; radii of circles, creases and spots; widths of the wide and the thin lines; depth of a goal.
BLUE, NEUTRAL, END, ASIDE, RING, CREASE = 7.62, 6.1, 6.1, 6.706, 4.572, 1.83
SPOT, WIDE, THIN, DEPTH = 0.3, 0.3, 0.05, 1.0
#: How thick the boards are, as a share of the rink's width; how far the hall goes on; a post's radius; a goal's height;
#: between the holes of an air table.
BOARDS, FAR, POST, HEIGHT, HOLES = 0.025, 200.0, 0.03, 1.22, 0.075

BOTH = (-1, 1)


def _walls(around: Sequence[Point], boards: Colour, floor: Colour) -> Plan:
    """The hall, the boards along an outline, and what is inside."""
    x, y = (max(point[axis] for point in around) for axis in (0, 1))
    thick = 2.0 * BOARDS * y
    outer = tuple((a * (1.0 + thick / x), b * (1.0 + thick / y)) for a, b in around)
    return Ground(Box(-FAR, -FAR, FAR, FAR), COLOURS["hall"]), Shape(outer, boards), Shape(tuple(around), floor)


def _across(around: Sequence[Point], x: float) -> tuple[Point, Point]:
    """The line across at x, between the boards."""
    side = min(around, key=lambda point: (abs(point[0] - x), -point[1]))[1]
    return (x, -abs(side)), (x, abs(side))


def ice_rink(rink: Rink) -> Plan:
    """Ice inside the boards."""
    red, blue, post, net = (COLOURS[part] for part in ("red", "blue", "post", "net"))
    around, line, half = rink.outline, rink.line, 0.5 * rink.goal_width
    ends = (-line, -DEPTH), (line, DEPTH)
    end, neutral = ([(sx * x, sy * ASIDE) for sx, sy in product(BOTH, BOTH)] for x in (line - END, NEUTRAL))
    creases = [arc((side * line, 0.0), CREASE, 90.0 * side, 90.0 * side + 180.0) for side in BOTH]
    return (
        *_walls(around, COLOURS["boards"], COLOURS["ice"]),
        *(Worn((x, 4.0), 7.0, 4.5, COLOURS["lamp"], 0.5) for x in (-20, -7, 7, 20)),
        *(Shape(crease, COLOURS["crease"]) for crease in creases),
        *(Line(_across(around, x), WIDE, blue) for x in (-BLUE, BLUE)),
        Line(_across(around, 0.0), WIDE, red),
        *(Line(_across(around, x), THIN, red) for x in (-line, line)),
        Spot((0.0, 0.0), RING, blue, THIN),
        *(Spot(spot, RING, red, THIN) for spot in end),
        *(Spot(spot, SPOT, red) for spot in (*end, *neutral)),
        Line((*around, around[0]), 0.15, COLOURS["kick"]),
        *chain(*(goal(x, deep, HEIGHT, rink.goal_width, POST, post, post, net, -half, 0.5) for x, deep in ends)),
    )


def air_table(rink: Rink) -> Plan:
    """A table, with a slot in its far end for a goal."""
    around, half, thin, marking = rink.outline, 0.5 * rink.goal_width, 0.006, COLOURS["marking"]
    end = max(point[0] for point in around)
    side = max(point[1] for point in around)
    holes = product(np.arange(-0.96 * end, 0.97 * end, HOLES), np.arange(-0.94 * side, 0.95 * side, HOLES))
    return (
        *_walls(around, COLOURS["rail"], COLOURS["table"]),
        Worn((-0.1 * end, 0.2 * side), 0.6 * end, 0.55 * side, COLOURS["lamp"], 0.16),
        *(Spot((float(x), float(y)), 0.004, COLOURS["hole"]) for x, y in holes),
        Line(_across(around, 0.0), thin, marking),
        Spot((0.0, 0.0), half, marking, thin),
        *(Line(arc((side * end, 0.0), half, 90.0 * side, 90.0 * side + 180.0), thin, marking) for side in BOTH),
        Ground(Box(end, -half, 1.02 * end, half), COLOURS["slot"]),
    )
