"""What only rinks have, seen from above: ice with its lines, creases and goals; and the table of air hockey.

Parts of a plan, as in ``plan.py``; the middle of the rink is the origin, lengths are in m. Where the lines are follows
NHL rule 1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain, product
from typing import Any

import numpy as np

from sandbox.picture.camera import Box
from sandbox.picture.places.plan import Ground, Line, Plan, Point, Spot, Worn, arc
from sandbox.picture.places.things import Shape, goal

#: From the middle to the blue lines and to the spots of the neutral zone; from the goal lines to the spots of the ends;
#: across to all of them; radii of circles, creases and spots; widths of the wide and the thin lines; depth of a goal.
BLUE, NEUTRAL, END, ASIDE, RING, CREASE = 7.62, 6.1, 6.1, 6.706, 4.572, 1.83
SPOT, WIDE, THIN, DEPTH = 0.3, 0.3, 0.05, 1.0
#: How thick the boards are, as a share of the rink's width; how far the hall goes on; a post's radius; a goal's height;
#: between the holes of an air table.
BOARDS, FAR, POST, HEIGHT, HOLES = 0.025, 200.0, 0.03, 1.22, 0.075

BOTH = (-1, 1)


def _walls(around: Sequence[Point], hall: Any, boards: Any, floor: Any) -> Plan:
    """The hall, the boards along an outline, and what is inside."""
    x, y = (max(point[axis] for point in around) for axis in (0, 1))
    thick = 2.0 * BOARDS * y
    outer = tuple((a * (1.0 + thick / x), b * (1.0 + thick / y)) for a, b in around)
    return Ground(Box(-FAR, -FAR, FAR, FAR), hall), Shape(outer, boards), Shape(tuple(around), floor)


def _across(around: Sequence[Point], x: float) -> tuple[Point, Point]:
    """The line across at x, between the boards."""
    side = min(around, key=lambda point: (abs(point[0] - x), -point[1]))[1]
    return (x, -abs(side)), (x, abs(side))


def ice_rink(around: Sequence[Point], line: float, goal_width: float, colours: Mapping[str, Any]) -> Plan:
    """A rink inside an outline, with its goals on lines ``line`` m from the middle."""
    (red, blue, post, net), half = (colours[part] for part in ("red", "blue", "post", "net")), 0.5 * goal_width
    ends = (-line, -DEPTH), (line, DEPTH)
    end, neutral = ([(sx * x, sy * ASIDE) for sx, sy in product(BOTH, BOTH)] for x in (line - END, NEUTRAL))
    creases = [arc((side * line, 0.0), CREASE, 90.0 * side, 90.0 * side + 180.0) for side in BOTH]
    return (
        *_walls(around, colours["hall"], colours["boards"], colours["ice"]),
        *(Worn((x, 4.0), 7.0, 4.5, colours["lamp"], 0.5) for x in (-20, -7, 7, 20)),
        *(Shape(crease, colours["crease"]) for crease in creases),
        *(Line(_across(around, x), WIDE, blue) for x in (-BLUE, BLUE)),
        Line(_across(around, 0.0), WIDE, red),
        *(Line(_across(around, x), THIN, red) for x in (-line, line)),
        Spot((0.0, 0.0), RING, blue, THIN),
        *(Spot(spot, RING, red, THIN) for spot in end),
        *(Spot(spot, SPOT, red) for spot in (*end, *neutral)),
        Line((*around, around[0]), 0.15, colours["kick"]),
        *chain(*(goal(x, deep, HEIGHT, goal_width, POST, post, post, net, -half, 0.5) for x, deep in ends)),
    )


def air_table(around: Sequence[Point], goal_width: float, colours: Mapping[str, Any]) -> Plan:
    """A table inside an outline, with a slot in its far end for a goal."""
    end, half, thin, marking = max(point[0] for point in around), 0.5 * goal_width, 0.006, colours["marking"]
    side = max(point[1] for point in around)
    holes = product(np.arange(-0.96 * end, 0.97 * end, HOLES), np.arange(-0.94 * side, 0.95 * side, HOLES))
    return (
        *_walls(around, colours["hall"], colours["rail"], colours["table"]),
        Worn((-0.1 * end, 0.2 * side), 0.6 * end, 0.55 * side, colours["lamp"], 0.16),
        *(Spot((float(x), float(y)), 0.004, colours["hole"]) for x, y in holes),
        Line(_across(around, 0.0), thin, marking),
        Spot((0.0, 0.0), half, marking, thin),
        *(Line(arc((side * end, 0.0), half, 90.0 * side, 90.0 * side + 180.0), thin, marking) for side in BOTH),
        Ground(Box(end, -half, 1.02 * end, half), colours["slot"]),
    )
