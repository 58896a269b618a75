"""Looks of the balls: colours, stripes, numbers and dots."""

from __future__ import annotations

import random
from functools import cache
from math import cos, dist, radians, sin

import numpy as np

from sandbox.kit import Colour, Look, Mark, mix, near, scene_colours, text_mask, turned

COLOURS = scene_colours(__file__)

#: Half the angle of a number's white disc, a dot and a stripe, as seen from the ball's centre, deg.
DISC, DOT, STRIPE = 27, 14, 38
#: Brightness of the lamp's image on a ball.
GLOSS = 0.75
#: A figure's height over the ball's radius.
FIGURE = 0.52
#: Least difference between a path and the cloth, as a distance between colours of 0 to 255.
LEAST_CONTRAST = 130


@cache
def look(name: str) -> Look:
    """A ball by its name: 1 to 15 as in pool, colours as in snooker and carom, others in one colour."""
    colour, ivory = colour_of(name), COLOURS["ivory"]
    if not _in_pool(name):
        dot = COLOURS["mark"] if colour == ivory else mix(colour, (255, 255, 255), 0.30)
        return Look(colour, Mark(dot, near(np.concatenate([np.eye(3), -np.eye(3)]), radians(DOT))), gloss=GLOSS)
    sides = [Mark(ivory, lambda at: abs(at[..., 1]) > sin(radians(STRIPE)))] if striped(name) else []
    number = Mark(ivory, _disc), Mark(COLOURS["numeral"], lambda at: _figure(at, text_mask(name)))
    return Look(colour, *sides, *number, gloss=GLOSS)


def _in_pool(name: str) -> bool:
    return name.isdecimal() and 1 <= int(name) <= 15


def striped(name: str) -> bool:
    """True if a ball is striped: a coloured band between white sides."""
    return _in_pool(name) and int(name) > 8


def colour_of(name: str) -> Colour:
    """The colour of a ball by its name."""
    if _in_pool(name):
        return COLOURS["pool"][(int(name) - 1) % 8]
    named = COLOURS["named"]
    found = next((colour for word, colour in named.items() if word in name.lower().split()), None)
    return found or COLOURS["other"][sum(name.encode()) % len(COLOURS["other"])]


def on_cloth(colour: Colour) -> Colour:
    """The colour, lighter if it would be hard to see on the cloth."""
    lighter = (mix(colour, (255, 255, 255), share) for share in np.arange(0.0, 1.0, 0.05))
    return next(shade for shade in lighter if dist(shade, COLOURS["cloth"]) > LEAST_CONTRAST)


def lying(name: str) -> np.ndarray:
    """The orientation of a ball before the shot: its number roughly up."""
    chance = random.Random(name)
    lean = turned([radians(chance.uniform(-38, 38)), radians(chance.uniform(-38, 38)), 0.0])
    return lean @ turned([0.0, 0.0, radians(chance.uniform(-60, 60))])


def _disc(at: np.ndarray) -> np.ndarray:
    """The white discs of a number, on either side."""
    return abs(at[..., 2]) > cos(radians(DISC))


def _figure(at: np.ndarray, glyph: np.ndarray) -> np.ndarray:
    """A number on its discs; ``glyph`` is its ink (0 to 1, shape (width, height))."""
    tall, (width, height) = FIGURE, glyph.shape
    across = at[..., 0] * np.sign(at[..., 2])  # to the right as seen from outside
    column = np.floor((across / tall * height / width + 0.5) * width).astype(int)
    row = np.floor((0.5 - at[..., 1] / tall) * height).astype(int)
    inside = _disc(at) & (column >= 0) & (column < width) & (row >= 0) & (row < height)
    return np.where(inside, glyph[np.clip(column, 0, width - 1), np.clip(row, 0, height - 1)], 0.0)
