"""Stand, board and ring."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from sandbox.picture.palette import mix, palette, scene_colours
from sandbox.picture.places import Post, Shape, Thing

from .scene import Parameters

COLOURS, SHADOW = scene_colours(__file__)["hoop"], palette("card")["shadow"]

#: Half the width of the board and of the square on it, and the square's height, in m.
BOARD, SQUARE, SQUARE_HEIGHT = 0.915, 0.305, 0.46


def stand(parameters: Parameters) -> list[Thing]:
    """What carries the board: a mast that leans towards the ring, on a heavy foot."""
    _, bottom, back, top = parameters.board
    foot, head, height = back + 1.45, back + 0.95, top - bottom
    up = bottom + 0.30 * height
    bars = [((foot + 0.75, 0.25), (head + 0.02, up), 0.04, "strut"), ((foot, 0.2), (head, up), 0.08, "stand")]
    bars += [((back, bottom + share * height), (head, up - 0.06), 0.03, "stand") for share in (0.15, 0.55)]
    base = [(foot + x, y, 0.0) for x, y in ((-0.62, 0.0), (-0.55, 0.36), (0.95, 0.36), (0.95, 0.0))]
    posts = [Post([(*a, 0.0), (*b, 0.0)], radius, COLOURS[part]) for a, b, radius, part in bars]
    return [*posts, Shape(base, COLOURS["stand"])]


def hoop(parameters: Parameters) -> list[Thing]:
    """The glass board with its square, and the ring, whose near half is in front of the ball."""
    face, bottom, _, top = parameters.board
    (front, height), (back, _) = parameters.hoop.rims
    middle, radius, tube = (front + back) / 2, (back - front) / 2, parameters.hoop.tube_radius
    low = max(bottom, height)
    high, shaded = max(low, min(top, low + SQUARE_HEIGHT)), mix(COLOURS["ring"], SHADOW, 0.35)
    glass, square = (
        [(face, y, z) for y, z in ((down, -half), (down, half), (up, half), (up, -half), (down, -half))]
        for down, up, half in ((bottom, top, BOARD), (low, high, SQUARE))
    )
    behind, before = (
        [(middle + radius * cos(turn), height, radius * sin(turn)) for turn in np.linspace(start, start + pi, 33)]
        for start in (0.0, pi)
    )
    return [
        Shape(glass, COLOURS["glass"], 0.30),
        *(Post(edge, 0.011, COLOURS["edge"]) for edge in (glass, square)),
        Post([(back, height, 0.0), (face, height, 0.0)], tube, shaded),
        Post(behind, tube, shaded),
        Post(before, tube, COLOURS["ring"], near=True),
    ]
