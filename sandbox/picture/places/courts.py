"""What is painted on pitches and courts, as lines of points in m: along the plane of play, and across it."""

from __future__ import annotations

from math import asin, cos, pi, sin

import numpy as np

Line = list[tuple[float, float]]

#: Soccer (Laws of the Game, laws 1 and 2), in m: goal area and penalty area, each deep and wide; the penalty spot from
#: the goal line, the circles' radius, and the size of the pitch.
GOAL_AREA, PENALTY_AREA, SPOT, CIRCLE = (5.5, 18.32), (16.5, 40.32), 11.0, 9.15
SOCCER_LENGTH, SOCCER_WIDTH = 105.0, 68.0
#: Basketball (NBA), in m: length and half width of the key, circle, three-point line: its radius, and from the middle
#: where it is straight; from the middle to the side line, from the board to the end line, and from end to end.
KEY_LENGTH, KEY_HALF_WIDTH, THROW_CIRCLE = 4.572, 2.438, 1.829
ARC, CORNER, HALF_WIDTH, BEHIND_BOARD, LENGTH = 7.24, 6.71, 7.62, 1.22, 28.65


def soccer_lines(end: float, middle: float) -> list[Line]:
    """All lines of a pitch, with the middle of a goal line at (end, middle)."""
    start, half, aside = end - SOCCER_LENGTH, end - SOCCER_LENGTH / 2, SOCCER_WIDTH / 2
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


def basketball_key(board: float) -> Line:
    """The corners of the painted area, whose long side is in the plane of play, with the face of the board at x."""
    end, throw = board + BEHIND_BOARD, board - KEY_LENGTH
    return [(throw, 0.0), (throw, KEY_HALF_WIDTH), (end, KEY_HALF_WIDTH), (end, 0.0)]


def basketball_lines(board: float, ring: float) -> list[Line]:
    """The lines behind the plane of play, which goes through the middle of board and ring: key, circle, three-point
    line, end line and side line."""
    end, throw, turns = board + BEHIND_BOARD, board - KEY_LENGTH, np.linspace(pi, pi - asin(CORNER / ARC), 40)
    return [
        basketball_key(board)[:3],
        [(throw + THROW_CIRCLE * cos(turn), THROW_CIRCLE * sin(turn)) for turn in np.linspace(pi / 2, pi, 25)],
        [*((ring + ARC * cos(turn), ARC * sin(turn)) for turn in turns), (end, CORNER)],
        [(end, 0.0), (end, HALF_WIDTH), (end - LENGTH, HALF_WIDTH)],
    ]
