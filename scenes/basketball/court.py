"""What is painted on the court, as lines of points in m: along the plane of play, and across it."""

from __future__ import annotations

from math import asin, cos, pi, sin

import numpy as np

from sandbox.picture.places import Line

#: NBA rules, in m: length and half width of the key, circle, three-point line: its radius, and from the middle
#: where it is straight; from the middle to the side line, from the board to the end line, and from end to end.
KEY_LENGTH, KEY_HALF_WIDTH, THROW_CIRCLE = 4.572, 2.438, 1.829
ARC, CORNER, HALF_WIDTH, BEHIND_BOARD, LENGTH = 7.24, 6.71, 7.62, 1.22, 28.65


def key(board: float) -> Line:
    """The corners of the painted area, whose long side is in the plane of play, with the face of the board at x."""
    end, throw = board + BEHIND_BOARD, board - KEY_LENGTH
    return [(throw, 0.0), (throw, KEY_HALF_WIDTH), (end, KEY_HALF_WIDTH), (end, 0.0)]


def lines(board: float, ring: float) -> list[Line]:
    """The lines behind the plane of play, which goes through the middle of board and ring: key, circle, three-point
    line, end line and side line."""
    end, throw, turns = board + BEHIND_BOARD, board - KEY_LENGTH, np.linspace(pi, pi - asin(CORNER / ARC), 40)
    return [
        key(board)[:3],
        [(throw + THROW_CIRCLE * cos(turn), THROW_CIRCLE * sin(turn)) for turn in np.linspace(pi / 2, pi, 25)],
        [*((ring + ARC * cos(turn), ARC * sin(turn)) for turn in turns), (end, CORNER)],
        [(end, 0.0), (end, HALF_WIDTH), (end - LENGTH, HALF_WIDTH)],
    ]
