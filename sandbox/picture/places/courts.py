"""Courts and pitches by their rules: their lines as points in m, along the plane of play and across it."""

from __future__ import annotations

from math import asin, cos, pi, sin

import numpy as np

from sandbox.picture.palette import Colour
from sandbox.picture.places.ground import Ground, Line, Stripes

#: Width of a tennis court, and of the part on either side that is for doubles, in m (ITF rules, rule 1).
COURT_WIDTH, _TRAMLINES = 10.97, 1.37

#: Laws of the Game, laws 1 and 2, in m: goal area and penalty area, each deep and wide; the penalty spot from
#: the goal line, the circles' radius, and the size of the pitch.
_GOAL_AREA, _PENALTY_AREA, PENALTY_SPOT, CIRCLE = (5.5, 18.32), (16.5, 40.32), 11.0, 9.15
_PITCH_LENGTH, PITCH_WIDTH = 105.0, 68.0

#: NBA rules, in m: length and half width of the key, circle, three-point line: its radius, and from the middle
#: where it is straight; from the middle to the side line, from the board to the end line, and from end to end.
_KEY_LENGTH, _KEY_HALF_WIDTH, _THROW_CIRCLE = 4.572, 2.438, 1.829
_ARC, _CORNER, _HALF_WIDTH, _BEHIND_BOARD, LENGTH = 7.24, 6.71, 7.62, 1.22, 28.65


def tennis_court(
    length: float,
    service: float,
    around: Colour,
    inside: Colour,
    line: Colour,
    edge: Colour,
    soil: tuple[Colour, Colour, Colour],
) -> Ground:
    """A tennis court from x = 0 on, its near line in the plane of play, service lines ``service`` m from the net."""
    width, tram, middle = COURT_WIDTH, _TRAMLINES, 0.5 * length
    outline = [(0.0, 0.0), (length, 0.0), (length, width), (0.0, width)]
    singles = [[(0.0, z), (length, z)] for z in (tram, width - tram)]
    across = [[(x, tram), (x, width - tram)] for x in (middle - service, middle + service)]
    centre = [(middle - service, 0.5 * width), (middle + service, 0.5 * width)]
    lines = [[*outline, outline[0]], *singles, *across, centre]
    surface, areas = Stripes((around, around), 4.0), [(outline, inside)]
    return Ground(surface, soil, edges=[(edge, 4)], areas=areas, lines=lines, line=(line, 0.06))


def pitch_lines(end: float, middle: float) -> list[Line]:
    """All lines of a pitch, with the middle of a goal line at (end, middle)."""
    start, half, aside = end - _PITCH_LENGTH, end - _PITCH_LENGTH / 2, PITCH_WIDTH / 2
    lines = [[(end, -aside), (end, aside), (start, aside), (start, -aside), (end, -aside)]]
    lines.append([(half, -aside), (half, aside)])
    for line, way in ((end, -1), (start, 1)):
        for deep, wide in (_GOAL_AREA, _PENALTY_AREA):
            front, side = line + way * deep, wide / 2
            lines.append([(line, -side), (front, -side), (front, side), (line, side)])
    turn = asin((_PENALTY_AREA[0] - PENALTY_SPOT) / CIRCLE)
    for x, low, high in ((end - PENALTY_SPOT, turn - pi / 2, pi / 2 - turn), (half, 0.0, 2 * pi)):
        lines.append([(x - CIRCLE * cos(a), CIRCLE * sin(a)) for a in np.linspace(low, high, 60)])
    return [[(x, middle + y) for x, y in line] for line in lines]


def basketball_key(board: float) -> Line:
    """The corners of the painted area, whose long side is in the plane of play, with the face of the board at x."""
    end, throw = board + _BEHIND_BOARD, board - _KEY_LENGTH
    return [(throw, 0.0), (throw, _KEY_HALF_WIDTH), (end, _KEY_HALF_WIDTH), (end, 0.0)]


def basketball_lines(board: float, ring: float) -> list[Line]:
    """The lines behind the plane of play, which goes through the middle of board and ring: key, circle, three-point
    line, end line and side line."""
    end, throw, turns = board + _BEHIND_BOARD, board - _KEY_LENGTH, np.linspace(pi, pi - asin(_CORNER / _ARC), 40)
    return [
        basketball_key(board)[:3],
        [(throw + _THROW_CIRCLE * cos(turn), _THROW_CIRCLE * sin(turn)) for turn in np.linspace(pi / 2, pi, 25)],
        [*((ring + _ARC * cos(turn), _ARC * sin(turn)) for turn in turns), (end, _CORNER)],
        [(end, 0.0), (end, _HALF_WIDTH), (end - LENGTH, _HALF_WIDTH)],
    ]
