"""An open landscape: sky, sun, clouds, three lines of hills that fade with distance, trees. Drawn once, then moved."""

from __future__ import annotations

from dataclasses import dataclass
from math import tau

import numpy as np
import pygame

from sandbox.picture.painter import blank, from_colours, from_coverage
from sandbox.picture.palette import Colour, mix
from sandbox.picture.places.scenery import Layer, Scenery, glowing, shaded
from sandbox.picture.sheet import rows_of

WHITE = (255, 255, 255)
#: How far each layer moves when the eye moves by 1 px: the far hills hardly, the near trees most.
CLOUDS, HILLS, TREES = 0.01, (0.02, 0.04, 0.08), 0.16


@dataclass(frozen=True)
class Landscape(Scenery):
    """Its colours: hills and trees from far to near; stars in place of clouds, and no trees, where there is no air."""

    sky: tuple[Colour, Colour]  # top, horizon
    sun: Colour
    hills: tuple[Colour, Colour, Colour]
    haze: Colour
    trees: tuple[Colour, ...] = ()
    cloud: Colour | None = None
    star: Colour | None = None

    def layers(self, size: tuple[int, int], foot: int) -> tuple[Layer, ...]:
        """Twice as wide as the picture, so that a camera may move for ever."""
        width, artist = size[0], _Artist(self, 2 * size[0], foot, rows_of(size) / 720)
        sky = shaded(width, np.linspace(0, 1, foot), self.sky, 1.15)
        sky = glowing(sky, self.sun, (0.74 * width, 0.80 * foot), (0.34 * width, 0.62 * foot), 0.75)
        found = [(from_colours(sky), 0, 0.0), (*(artist.clouds(self.cloud) if self.cloud else artist.stars()), CLOUDS)]
        found += [(*artist.hills(i), speed) for i, speed in enumerate(HILLS)]
        return (*found, *([(*artist.trees(), TREES)] if self.trees else []))


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
        """Where there is no air."""
        cover = np.zeros((self.width, self.foot), np.float32)
        places = self.random.uniform((0, 0), (self.width, self.foot), (260, 2))
        for (x, y), faint in zip(places, self.random.uniform(0, 1, len(places)), strict=True):
            self._heap(cover, x, y, (1.7 - faint) * self.unit, rows=1.0 - 0.75 * faint)
        return from_coverage(cover, self.of.star or WHITE), 0

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
