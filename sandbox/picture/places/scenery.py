"""What lies behind the ground: stands under an evening sky, a hall with people who watch."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import Protocol

import numpy as np
import pygame

from sandbox.picture.painter import Painter, blank, from_colours
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.sheet import Sheet, rows_of

HALL, SHADOW, WHITE = palette("hall"), palette("card")["shadow"], (255, 255, 255)

#: Heads larger than this, in px, have shoulders below them.
SHOULDERS = 4


class Scenery(Protocol):
    """What is drawn down to the row ``foot`` (px), as seen by an eye that has moved ``moved`` px to the right."""

    def draw(self, surface: pygame.Surface, foot: int, moved: float) -> None: ...


@dataclass(frozen=True)
class Stands:
    """Stands with their roof, people, lamps on masts, and boards along their foot, under an evening sky."""

    sky: tuple[Colour, Colour, Colour]  # top, middle, over the stands
    glow: Colour  # where the sun went down
    stands: tuple[Colour, Colour, Colour]  # roof, upper tier, lower tier
    crowd: tuple[Colour, ...]
    boards: tuple[Colour, ...]
    mast: Colour
    lamp: Colour

    def draw(self, surface: pygame.Surface, foot: int, moved: float) -> None:
        size = surface.get_size()
        surface.blit(_evening(self, size, foot), (0, 0))
        beside_itself(surface, _stands(self, size, foot), 0.25 * moved)


@dataclass(frozen=True)
class Hall:
    """A wall lit from above on the right, rows of people before it, and padding along its foot."""

    wall: tuple[Colour, Colour] = HALL["wall"]  # top, foot
    light: Colour = HALL["light"]
    crowd: tuple[Colour, ...] = HALL["crowd"]
    padding: Colour = HALL["padding"]

    def draw(self, surface: pygame.Surface, foot: int, moved: float) -> None:
        size = surface.get_size()
        surface.blit(_wall(self, size, foot), (0, 0))
        beside_itself(surface, _audience(self, size, foot), 0.44 * moved)


def beside_itself(surface: pygame.Surface, layer: pygame.Surface, moved: float, top: int = 0) -> None:
    """A layer at least as wide as the picture, whose ends join, moved to the left."""
    width = layer.get_width()
    left = -(round(moved) % width)
    for x in (left, left + width):
        if x < surface.get_width():
            surface.blit(layer, (x, top))


def glowing(
    sky: np.ndarray, colour: Colour, middle: tuple[float, float], reach: tuple[float, float], share: float = 0.58
) -> np.ndarray:
    """Colours of shape (width, height, 3) with a soft light in them, around a point in px."""
    across = (np.arange(sky.shape[0])[:, None] - middle[0]) / reach[0]
    down = (np.arange(sky.shape[1])[None, :] - middle[1]) / reach[1]
    glow = share * np.exp(-(across**2) - down**2)[:, :, None]
    return sky + (np.array(colour, float) - sky) * glow


def _row_of_people(
    painter: Painter, random: np.random.Generator, row: float, head: float, colours: tuple[Colour, ...], share: float
) -> None:
    """Heads with a radius of ``head`` px, side by side over the whole width; so many of the seats are taken."""
    width = painter.surface.get_width()
    seats, odd = round(width / (3.5 * head)), random.uniform()
    for seat in range(seats):
        if random.uniform() > share:
            continue
        colour = colours[random.integers(len(colours))]
        x = (seat + odd + random.uniform(-0.15, 0.15)) * width / seats
        y = row + random.uniform(-0.4, 0.4) * head
        for turn in (-width, 0):  # the ends join
            painter.disc((x + turn, y), head, colour, 0.8)
            if head > SHOULDERS:
                painter.shadow((x + turn, y + 2.8 * head), 1.6 * head, 1.65 * head, colour, 0.8)


@lru_cache(maxsize=4)
def _evening(stands: Stands, size: tuple[int, int], foot: int) -> pygame.Surface:
    """The sky down to row ``foot``."""
    width, unit = size[0], rows_of(size) / 720
    top, middle, low = (np.array(colour, float) for colour in stands.sky)
    share = np.clip(np.arange(foot) / (foot - 90 * unit), 0, 1)[None, :, None]
    turn = 0.62
    upper = top + (middle - top) * np.clip(share / turn, 0, 1) ** 1.3
    sky = upper + (low - upper) * (np.clip((share - turn) / (1 - turn), 0, 1) ** 1.3)
    sky = np.broadcast_to(sky, (width, foot, 3))
    return from_colours(glowing(sky, stands.glow, (0.70 * width, foot - 120 * unit), (0.30 * width, 120 * unit)))


@lru_cache(maxsize=4)
def _stands(stands: Stands, size: tuple[int, int], foot: int) -> pygame.Surface:
    """As wide as the picture; the ends join."""
    width, unit = size[0], rows_of(size) / 720
    drawn = blank((width, foot), transparent=True)
    painter, random = Painter(drawn), np.random.default_rng(11)
    roof, upper, lower = stands.stands
    boards, top = round(17 * unit), foot - round(124 * unit)
    sheet = Sheet(size)
    text = sheet.top_row - sheet.gap
    head = min(max(top - 74 * unit, text + 20 * unit), top - 30 * unit)  # lamps under the headline
    for x in np.array([0.14, 0.47, 0.80]) * width if text < head - 13 * unit else ():
        _mast(painter, stands, (x, top), head, unit)
    drawn.fill(upper, (0, top, width, foot - top))
    _roof(painter, stands, top, unit)
    aisle = round(top + 56.8 * unit)
    drawn.fill(lower, (0, aisle, width, foot - aisle))
    drawn.fill(roof, (0, aisle - round(unit), width, max(1, round(3 * unit))))
    for i in (0, 1, 2, 3, 5, 6, 7, 8):
        colours = tuple(mix(colour, lower, 0.35 * (1 - i / 8)) for colour in stands.crowd)
        _row_of_people(painter, random, top + (24 + i * 9.2) * unit, 2.6 * unit, colours, 0.82)
    for i in range(12):
        left, right = round(i * width / 12), round((i + 1) * width / 12)
        drawn.fill(stands.boards[i * 7 % 4], (left, foot - boards, right - left, boards))
    drawn.fill(mix(stands.boards[0], WHITE, 0.2), (0, foot - boards, width, max(1, round(1.5 * unit))))
    return drawn


def _roof(painter: Painter, stands: Stands, top: int, unit: float) -> None:
    """A shallow vault over each part of the stands, carried by columns."""
    (roof, upper, _), width, parts = stands.stands, painter.surface.get_width(), 4
    for i in range(parts):
        left, right = i * width / parts, (i + 1) * width / parts
        turn = np.linspace(0, pi, 24)
        vault = [(left + (1 - np.cos(a)) / 2 * (right - left), top - 9 * unit * np.sin(a) ** 0.8) for a in turn]
        painter.polygon([*vault, (right, top + 9 * unit), (left, top + 9 * unit)], roof)
        for x in np.linspace(left, right, 4)[:-1]:
            painter.surface.fill(mix(upper, roof, 0.5), (round(x), top, max(1, round(2.5 * unit)), round(58 * unit)))


def _mast(painter: Painter, stands: Stands, foot: tuple[float, float], head: float, unit: float) -> None:
    """A mast with lamps in row ``head`` and the light around them."""
    x, y = foot
    painter.line([(x, y), (x, head)], 4 * unit, stands.mast)
    painter.shadow((x, head), 90 * unit, 62 * unit, stands.lamp, 0.22)
    box = pygame.Rect(round(x - 24 * unit), round(head - 13 * unit), round(48 * unit), round(22 * unit))
    painter.panel(box, stands.mast, 1.0, 3 * unit)
    for row in range(2):
        for lamp in range(5):
            at = x + (lamp - 2) * 9 * unit, head + (row * 9 - 6.5) * unit
            painter.disc(at, 3.1 * unit, stands.lamp, 0.95)


@lru_cache(maxsize=4)
def _wall(hall: Hall, size: tuple[int, int], foot: int) -> pygame.Surface:
    """The wall down to row ``foot``."""
    width = size[0]
    top, low = (np.array(colour, float) for colour in hall.wall)
    wall = np.broadcast_to(top + (low - top) * np.linspace(0, 1, foot)[None, :, None] ** 1.2, (width, foot, 3))
    return from_colours(glowing(wall, hall.light, (0.62 * width, 0.30 * foot), (0.42 * width, 0.75 * foot)))


@lru_cache(maxsize=4)
def _audience(hall: Hall, size: tuple[int, int], foot: int) -> pygame.Surface:
    """Rows of people, the less to be told from the wall the farther they are, and the padding before them."""
    width, unit, rows = size[0], rows_of(size) / 720, 8
    drawn = blank((width, foot), transparent=True)
    random, tall = np.random.default_rng(3), round(50 * unit)
    for i in reversed(range(rows if hall.crowd else 0)):
        share = i / (rows - 1)
        row, opacity = foot - tall - (i + 1) * 27 * unit, (1 - share) ** 1.1
        people = blank((width, foot), transparent=True)
        _row_of_people(Painter(people), random, row, 6.2 * unit, hall.crowd, 0.9 - 0.25 * share)
        people.fill((*SHADOW, 50), (0, round(row + 22 * unit), width, max(1, round(unit))))
        people.set_alpha(round(255 * opacity))
        drawn.blit(people, (0, 0))
    thin = max(1, round(2 * unit))
    drawn.fill(hall.padding, (0, foot - tall, width, tall))
    drawn.fill(mix(hall.padding, WHITE, 0.14), (0, foot - tall, width, thin))
    for x in np.linspace(0, width, 12)[:-1]:
        drawn.fill(mix(hall.padding, SHADOW, 0.16), (round(x), foot - tall, max(1, thin // 2), tall))
    return drawn
