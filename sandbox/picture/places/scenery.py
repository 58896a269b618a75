"""Scenery behind the ground: stands under an evening sky, a hall with people who watch, an open landscape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import pi, tau

import numpy as np
import pygame

from sandbox.picture.painter import Painter, blank, from_colours, from_coverage
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.sheet import Sheet, rows_of

_HALL, _STANDS, _LANDSCAPE = palette("hall"), palette("stands"), palette("landscape")
_SHADOW, _WHITE = palette("card")["shadow"], (255, 255, 255)

#: Heads larger than this, in px, have shoulders below them.
_SHOULDERS = 4
#: Height of an evening sky's middle colour, as a share of the way down to the stands.
_TURN = 0.62
#: Motion of each layer of a landscape in px when the eye moves by 1 px: the far hills least, the near trees most.
_CLOUDS, _HILLS, _TREES = 0.01, (0.02, 0.04, 0.08), 0.16

#: A surface at least as wide as the picture, whose ends join; the row of its top in px; how far it moves to the left
#: when the eye moves by 1 px to the right: what is far away hardly, what is near most.
_Layer = tuple[pygame.Surface, int, float]


class Scenery:
    """Scenery: a frozen dataclass, so that its layers can be kept."""

    def layers(self, size: tuple[int, int], foot: int) -> tuple[_Layer, ...]:
        """Down to the row ``foot`` (px) of a picture of ``size`` px, the farthest first."""
        raise NotImplementedError

    def draw(self, surface: pygame.Surface, foot: int, moved: float) -> None:
        """As seen by an eye that has moved ``moved`` px to the right; nothing where its foot is above the picture."""
        if foot <= 0:
            return
        for layer, top, speed in _layers(self, surface.get_size(), foot):
            width = layer.get_width()
            left = -(round(speed * moved) % width)
            for x in (left, left + width):
                if x < surface.get_width():
                    surface.blit(layer, (x, top))


@lru_cache(maxsize=4)
def _layers(scenery: Scenery, size: tuple[int, int], foot: int) -> tuple[_Layer, ...]:
    """Shared by all pictures of one shape."""
    return scenery.layers(size, foot)


@dataclass(frozen=True)
class Stands(Scenery):
    """Stands with their roof, people, lamps on masts, and boards along their foot, under an evening sky."""

    sky: tuple[Colour, Colour, Colour] = _STANDS["sky"]  # top, middle, over the stands
    glow: Colour = _STANDS["glow"]  # where the sun went down
    stands: tuple[Colour, Colour, Colour] = _STANDS["stands"]  # roof, upper tier, lower tier
    crowd: tuple[Colour, ...] = _STANDS["crowd"]
    boards: tuple[Colour, ...] = _STANDS["boards"]
    mast: Colour = _STANDS["mast"]
    lamp: Colour = _STANDS["lamp"]

    def layers(self, size: tuple[int, int], foot: int) -> tuple[_Layer, ...]:
        width, unit = size[0], rows_of(size) / 720
        sky = _shaded(width, np.clip(np.arange(foot) / max(1.0, foot - 90 * unit), 0, 1), self.sky, 1.3)
        sky = _glowing(sky, self.glow, (0.70 * width, foot - 120 * unit), (0.30 * width, 120 * unit))
        return (from_colours(sky), 0, 0.0), (_stands(self, size, foot), 0, 0.25)


@dataclass(frozen=True)
class Hall(Scenery):
    """A wall lit from above on the right, rows of people before it, and padding along its foot."""

    wall: tuple[Colour, Colour] = _HALL["wall"]  # top, foot
    light: Colour = _HALL["light"]
    crowd: tuple[Colour, ...] = _HALL["crowd"]
    padding: Colour = _HALL["padding"]

    def layers(self, size: tuple[int, int], foot: int) -> tuple[_Layer, ...]:
        wall, width = _shaded(size[0], np.linspace(0, 1, foot), self.wall, 1.2), size[0]
        wall = _glowing(wall, self.light, (0.62 * width, 0.30 * foot), (0.42 * width, 0.75 * foot))
        return (from_colours(wall), 0, 0.0), (_audience(self, size, foot), 0, 0.44)


def _shaded(width: int, share: np.ndarray, colours: Sequence[Colour], power: float) -> np.ndarray:
    """Colours of shape (width, rows, 3): from the first at share 0 to the last at 1, over the middle one at TURN."""
    found, turns = np.array(colours[0], float), (0.0, _TURN, 1.0) if len(colours) > 2 else (0.0, 1.0)
    for colour, (start, end) in zip(colours[1:], pairwise(turns), strict=True):
        part = np.clip((share - start) / (end - start), 0, 1)[None, :, None] ** power
        found = found + (np.array(colour, float) - found) * part
    return np.broadcast_to(found, (width, len(share), 3))


def _glowing(
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
            if head > _SHOULDERS:
                painter.shadow((x + turn, y + 2.8 * head), 1.6 * head, 1.65 * head, colour, 0.8)


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
    drawn.fill(mix(stands.boards[0], _WHITE, 0.2), (0, foot - boards, width, max(1, round(1.5 * unit))))
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
        people.fill((*_SHADOW, 50), (0, round(row + 22 * unit), width, max(1, round(unit))))
        people.set_alpha(round(255 * opacity))
        drawn.blit(people, (0, 0))
    thin = max(1, round(2 * unit))
    drawn.fill(hall.padding, (0, foot - tall, width, tall))
    drawn.fill(mix(hall.padding, _WHITE, 0.14), (0, foot - tall, width, thin))
    for x in np.linspace(0, width, 12)[:-1]:
        drawn.fill(mix(hall.padding, _SHADOW, 0.16), (round(x), foot - tall, max(1, thin // 2), tall))
    return drawn


@dataclass(frozen=True)
class Landscape(Scenery):
    """Sky, sun, clouds, three lines of hills that fade with distance, trees: drawn once, then moved.

    Hills and trees are from far to near; with a colour of stars there is no air, so neither clouds nor trees.
    """

    sky: tuple[Colour, Colour] = _LANDSCAPE["sky"]  # top, horizon
    sun: Colour = _LANDSCAPE["sun"]
    hills: tuple[Colour, Colour, Colour] = _LANDSCAPE["hills"]
    haze: Colour = _LANDSCAPE["haze"]
    trees: tuple[Colour, ...] = _LANDSCAPE["trees"]
    cloud: Colour = _LANDSCAPE["cloud"]
    star: Colour | None = None

    def layers(self, size: tuple[int, int], foot: int) -> tuple[_Layer, ...]:
        """Twice as wide as the picture, so that a camera may move for ever."""
        width, artist = size[0], _Artist(self, 2 * size[0], foot, rows_of(size) / 720)
        sky = _shaded(width, np.linspace(0, 1, foot), self.sky, 1.15)
        sky = _glowing(sky, self.sun, (0.74 * width, 0.80 * foot), (0.34 * width, 0.62 * foot), 0.75)
        found = [(from_colours(sky), 0, 0.0), (*(artist.stars() if self.star else artist.clouds(self.cloud)), _CLOUDS)]
        found += [(*artist.hills(i), speed) for i, speed in enumerate(_HILLS)]
        return (*found, *([(*artist.trees(), _TREES)] if self.trees and not self.star else []))


class _Artist:
    """Draws layers ``width`` px wide, down to the row ``foot``."""

    def __init__(self, of: Landscape, width: int, foot: int, unit: float):
        self.of, self.width, self.foot, self.unit = of, width, foot, unit
        self.random = np.random.default_rng(7)

    def _wave(self, periods: tuple[int, ...], weights: tuple[float, ...]) -> np.ndarray:
        """A soft line over the layer's width that joins at its ends; between 0 and 1."""
        x = np.arange(self.width) / self.width * tau
        line = sum(
            weight * np.sin(period * x + phase)
            for period, weight, phase in zip(periods, weights, self.random.uniform(0, tau, len(periods)), strict=True)
        )
        return (line - line.min()) / (line.max() - line.min())

    def hills(self, layer: int) -> tuple[pygame.Surface, int]:
        periods = ((3, 5, 8, 13), (4, 7, 11, 17), (3, 7, 12, 19))[layer]
        height = (104, 70, 44)[layer] * self.unit
        line = (0.35 + 0.65 * self._wave(periods, (1.0, 0.7, 0.3, 0.14))) * height
        rows = int(height) + 2
        depth = np.arange(rows)[None, :] + 0.5 - (rows - line[:, None])  # px below the crest
        crest, foot = self.of.hills[layer], mix(self.of.hills[layer], self.of.haze, 0.55)
        surface = from_coverage(depth + 0.5, crest)
        fade = np.clip(depth / height, 0, 1)[:, :, None]
        pixels = pygame.surfarray.pixels3d(surface)
        pixels[...] = np.array(crest) + (np.array(foot) - np.array(crest)) * fade
        del pixels
        return surface, self.foot - rows

    def clouds(self, colour: Colour) -> tuple[pygame.Surface, int]:
        """Flat underneath, heaped above, hardly brighter than the sky."""
        rows = int(self.foot * 0.72)
        cover = np.zeros((self.width, rows), np.float32)
        for centre in np.linspace(0.08, 0.94, 7):
            x = (centre + self.random.uniform(-0.04, 0.04)) * self.width
            base = self.random.uniform(0.22, 0.92) * rows
            size = self.random.uniform(0.6, 1.25) * 26 * self.unit
            for offset in np.linspace(-3.2, 3.2, 9):
                radius = size * (1.25 - 0.25 * abs(offset) + self.random.uniform(-0.2, 0.2))
                height = base - np.arange(rows) + 0.5  # px over the cloud's foot
                fading = 0.75 - 0.45 * np.clip(1 - height / (1.3 * size), 0, 1)
                self._heap(cover, x + offset * size * 0.9, base, radius, 1.25, np.clip(height, 0, 1) * fading)
        return from_coverage(cover * 0.8, colour), int(self.foot * 0.08)

    def stars(self) -> tuple[pygame.Surface, int]:
        """A sky without air."""
        cover = np.zeros((self.width, self.foot), np.float32)
        places = self.random.uniform((0, 0), (self.width, self.foot), (260, 2))
        for (x, y), faint in zip(places, self.random.uniform(0, 1, len(places)), strict=True):
            self._heap(cover, x, y, (1.7 - faint) * self.unit, rows=1.0 - 0.75 * faint)
        return from_coverage(cover, self.of.star or _WHITE), 0

    def _heap(
        self, cover: np.ndarray, x: float, y: float, radius: float, flat: float = 1.0, rows: np.ndarray | float = 1.0
    ) -> None:
        """Add a disc, ``flat`` times wider than high, to the cover, over the layer's ends; ``rows`` weighs each row."""
        reach = int(radius) + 2
        across = np.arange(-reach, reach + 1)
        down = (np.arange(cover.shape[1])[None, :] - y) * flat
        disc = np.clip(radius - np.hypot(across[:, None] + int(x) - x, down) + 0.5, 0, 1) * rows
        columns = (int(x) + across) % self.width
        cover[columns] = np.maximum(cover[columns], disc)

    def trees(self) -> tuple[pygame.Surface, int]:
        """Woods along the horizon: a far and paler line with gaps, and groups before it."""
        rows = round(40 * self.unit)
        layer = blank((self.width, rows), transparent=True)
        for colour, count, groups, small, large in zip(
            self.of.trees, (260, 70), (15, 12), (3, 5), (8, 12), strict=True
        ):
            cover = np.zeros((self.width, rows), np.float32)
            middles = (np.arange(groups) + self.random.uniform(0.0, 1.0, groups)) / groups * self.width
            for _ in range(count):
                x = self.random.choice(middles) + self.random.normal(0, 42) * self.unit
                radius = self.random.uniform(small, large) * self.unit
                y = rows - radius * self.random.uniform(0.4, 1.1)
                self._heap(cover, x, y, radius, self.random.uniform(0.75, 1.15))
            layer.blit(from_coverage(cover, colour), (0, 0))
        return layer, self.foot - rows + round(2 * self.unit)
