"""How the ball looks, and what is painted on a pitch (Laws of the Game, laws 1 and 2), from the side and from above."""

from __future__ import annotations

from math import asin, cos, pi, sin

import numpy as np

from sandbox.picture.palette import scene_colours
from sandbox.picture.views import Look, patches

COLOURS = scene_colours(__file__)
BALL, TRACE, EARLIER = COLOURS["ball"], COLOURS["trace"], COLOURS["earlier"]
LOOK = Look(BALL["colour"], patches(BALL["patch"]))

#: Stripes are as wide as the goal area is deep, in m; then lines, and what they bound.
STRIPE, LINE = 5.5, 0.12
GOAL_AREA, PENALTY_AREA, SPOT, CIRCLE = (5.5, 18.32), (16.5, 40.32), 11.0, 9.15
LENGTH, WIDTH = 105.0, 68.0

Line = list[tuple[float, float]]


def markings(end: float, middle: float) -> list[Line]:
    """All lines of a pitch in m, along it and across, with the middle of a goal line at (end, middle)."""
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
