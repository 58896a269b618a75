"""How ball and pitch look, from the side and from above: colours, stripes and lines."""

from __future__ import annotations

from math import asin, cos, pi, sin

import numpy as np

from sandbox.picture.palette import scene_colours
from sandbox.picture.places import Line
from sandbox.picture.views import Look, patches

COLOURS = scene_colours(__file__)
BALL, TRACE, EARLIER = COLOURS["ball"], COLOURS["trace"], COLOURS["earlier"]
LOOK = Look(BALL["colour"], patches(BALL["patch"]))
STRIPE, LINE = 5.5, 0.12  # m: as wide as the goal area is deep; the most that the Laws of the Game allow

#: Laws of the Game, laws 1 and 2, in m: goal area and penalty area, each deep and wide; the penalty spot from
#: the goal line, the circles' radius, and the size of the pitch.
GOAL_AREA, PENALTY_AREA, SPOT, CIRCLE = (5.5, 18.32), (16.5, 40.32), 11.0, 9.15
LENGTH, WIDTH = 105.0, 68.0


def pitch_lines(end: float, middle: float) -> list[Line]:
    """All lines of a pitch, with the middle of a goal line at (end, middle)."""
    start, half, aside = end - LENGTH, end - LENGTH / 2, WIDTH / 2
    lines = [[(end, -aside), (end, aside), (start, aside), (start, -aside), (end, -aside)]]
    lines.append([(half, -aside), (half, aside)])
    for line, way in ((end, -1), (start, 1)):
        for deep, wide in (GOAL_AREA, PENALTY_AREA):
            front, side = line + way * deep, wide / 2
            lines.append([(line, -side), (front, -side), (front, side), (line, side)])
    turn = asin((PENALTY_AREA[0] - SPOT) / CIRCLE)
    for x, low, high in ((end - SPOT, turn - pi / 2, pi / 2 - turn), (half, 0.0, 2 * pi)):
        lines.append([(x - CIRCLE * cos(a), CIRCLE * sin(a)) for a in np.linspace(low, high, 60)])
    return [[(x, middle + y) for x, y in line] for line in lines]
