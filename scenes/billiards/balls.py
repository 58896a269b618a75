"""The look of the balls: colours, stripes, numbers and dots, and how they turn."""

from __future__ import annotations

import random
from functools import cache
from math import cos, dist, radians
from typing import Any

import numpy as np

from sandbox.picture import sphere
from sandbox.picture.lettering import stamp
from sandbox.picture.palette import Colour, mix, scene_colours

COLOURS = scene_colours(__file__)

#: Half the angle of a number's white disc, a dot and a stripe, as seen from the ball's centre, deg.
DISC, DOT, STRIPE = 27, 14, 38
#: A figure's height over the ball's radius.
FIGURE = 0.52
#: Least difference between a path and the cloth, as a distance between colours of 0 to 255.
LEAST_CONTRAST = 130
#: The dots of a ball without a number: its own six axes.
AXES = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float)


@cache
def skin(name: str) -> np.ndarray:
    """The surface of a ball by its name: 1 to 15 as in pool, colours as in snooker and carom, others in one colour."""
    number = int(name) if name.isdecimal() and 1 <= int(name) <= 15 else None
    if number is not None:
        return sphere.skin(lambda at: _numbered(at, number))
    colour = colour_of(name)
    white = colour == COLOURS["ivory"]
    dot = COLOURS["mark"] if white else mix(colour, (255, 255, 255), 0.30)
    return sphere.skin(lambda at: _dotted(at, colour, dot))


def colour_of(name: str) -> Colour:
    """The colour of a ball by its name."""
    if name.isdecimal() and 1 <= int(name) <= 15:
        return COLOURS["pool"][(int(name) - 1) % 8]
    named = COLOURS["named"]
    found = next((colour for word, colour in named.items() if word in name.lower().split()), None)
    return found or COLOURS["other"][sum(name.encode()) % len(COLOURS["other"])]


def on_cloth(colour: Colour) -> Colour:
    """The colour, lighter if it would be hard to see on the cloth."""
    lighter = (mix(colour, (255, 255, 255), share) for share in np.arange(0.0, 1.0, 0.05))
    return next(shade for shade in lighter if dist(shade, COLOURS["cloth"]) > LEAST_CONTRAST)


def striped(name: str) -> bool:
    """Whether a ball is striped: a coloured band between white sides."""
    return name.isdecimal() and 9 <= int(name) <= 15


def turning(run: Any, name: str) -> sphere.Turning:
    """The orientation of a ball at any time: random at first, different for each ball, then turned by its spin."""
    arcs = run.arcs[name]

    def spin(t: float) -> tuple[float, float, float]:
        return (*run.rolling_spin(name, t), run.state(name, t)[4])

    return sphere.Turning(spin, [*(arc.t0 for arc in arcs), arcs[-1].t1], lying(name))


def lying(name: str) -> np.ndarray:
    """The orientation of a ball before the shot: its number roughly up."""
    chance = random.Random(name)
    lean = sphere.turned([radians(chance.uniform(-38, 38)), radians(chance.uniform(-38, 38)), 0.0])
    return lean @ sphere.turned([0.0, 0.0, radians(chance.uniform(-60, 60))]) @ NUMBER_UP


#: The ball's own x, where its number is, towards the eye; its z up.
NUMBER_UP = np.array([(0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)])


def _numbered(at: np.ndarray, number: int) -> np.ndarray:
    """One colour, or from 9 on a stripe on white; a number on either side."""
    ivory, colour = np.array(COLOURS["ivory"], float), np.array(COLOURS["pool"][(number - 1) % 8], float)
    colours = np.broadcast_to(colour, at.shape).copy()
    if number > 8:
        colours[abs(at[..., 2]) > np.sin(radians(STRIPE))] = ivory
    disc = abs(at[..., 0]) > cos(radians(DISC))
    colours[disc] = ivory
    glyph = stamp(str(number))  # shape (width, height), 0 to 1
    tall = FIGURE
    wide = tall * glyph.shape[0] / glyph.shape[1]
    across = at[..., 1] * np.sign(at[..., 0])  # to the right as seen from outside
    column = np.floor((across / wide + 0.5) * glyph.shape[0]).astype(int)
    row = np.floor((0.5 - at[..., 2] / tall) * glyph.shape[1]).astype(int)
    on = disc & (column >= 0) & (column < glyph.shape[0]) & (row >= 0) & (row < glyph.shape[1])
    ink = glyph[column[on], row[on]][:, None]
    colours[on] += (np.array(COLOURS["numeral"], float) - colours[on]) * ink
    return colours


def _dotted(at: np.ndarray, colour: Colour, dot: Colour) -> np.ndarray:
    """One colour, with six dots that show how the ball turns."""
    near = (at @ AXES.T).max(axis=-1) > cos(radians(DOT))
    return np.where(near[..., None], np.array(dot, float), np.array(colour, float))
