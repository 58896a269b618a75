"""A sloping green or lane from above: lighter the higher it is, with contour lines, and arrows that point downhill."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import ceil, floor, hypot

import numpy as np
import pygame

from sandbox.picture.camera import Box, Camera
from sandbox.picture.painter import Painter, Point, from_colours
from sandbox.picture.palette import Colour
from sandbox.picture.places.plan import on_pixels
from sandbox.picture.places.things import unit_of
from sandbox.sport.amounts import round_number_above

#: The shade is computed at every so many px and smoothed between.
_COARSE = 6
#: At most so many contour lines where it is seen, places along each of them, arrows in a row, and the slope of the
#: longest arrow.
_LINES, _PLACES, _ROW, _STEEP = 8, 121, 9, 0.05


@dataclass(frozen=True)
class Relief:
    """A rectangle of height ``along x + across y + twist x y`` m, coloured from low to high in the part ``seen``."""

    box: Box
    seen: Box
    along: float
    across: float
    twist: float  # 1/m
    colours: tuple[Colour, Colour]
    line: Colour
    arrow: Colour

    def height(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Heights in m."""
        return self.along * x + self.across * y + self.twist * x * y

    @property
    def slopes(self) -> bool:
        """False if it is level."""
        return (self.along, self.across, self.twist) != (0.0, 0.0, 0.0)

    @property
    def step(self) -> float:
        """The height in m from one contour line to the next."""
        low, high = self._range
        return round_number_above((high - low) / _LINES)

    @property
    def _range(self) -> tuple[float, float]:
        """The least and the greatest height that is seen: in the corners, as it is linear along each side."""
        left, bottom, right, top = self.seen
        corners = self.height(np.array([left, left, right, right]), np.array([bottom, top, bottom, top]))
        return float(corners.min()), float(corners.max())

    def contours(self) -> list[np.ndarray]:
        """The contour lines, each as places in m of shape (n, 2)."""
        (low, high), step = self._range, self.step
        levels = (step * i for i in range(ceil((2 * low - high) / step), floor((2 * high - low) / step) + 1))
        return [branch for level in levels for branch in self._contour(level) if len(branch) > 1]

    def _contour(self, level: float) -> list[np.ndarray]:
        """The places at one height: a straight line, or branches of a hyperbola, along which x + y or x - y grows; none
        at the height of a saddle, where branches cross."""
        if self.twist and abs(level + self.along * self.across / self.twist) < 1e-6 * self.step:
            return []
        left, bottom, right, top = self.box
        x, y = np.linspace(left, right, _PLACES), np.linspace(bottom, top, _PLACES)
        with np.errstate(divide="ignore", invalid="ignore"):
            by_x = np.column_stack([x, (level - self.along * x) / (self.across + self.twist * x)])
            by_y = np.column_stack([(level - self.across * y) / (self.along + self.twist * y), y])
        places = np.concatenate([by_x, by_y])
        inside = (places >= (left, bottom)).all(axis=1) & (places <= (right, top)).all(axis=1)
        places = places[inside & np.isfinite(places).all(axis=1)]
        beyond = self.across + self.twist * places[:, 0] > 0.0
        falls = (self.along + self.twist * places[:, 1]) * (self.across + self.twist * places[:, 0]) > 0.0
        order = np.where(falls, places[:, 0] - places[:, 1], places[:, 0] + places[:, 1])
        return [places[side][np.argsort(order[side])] for side in (beyond, ~beyond)]

    def arrows(self) -> list[tuple[Point, Point]]:
        """Arrows from a place down its slope, in m, the longer the steeper."""
        left, bottom, right, top = self.seen
        gap, found = (right - left) / _ROW, []
        rows = max(1, round((top - bottom) / gap))
        for x, i in product(np.arange(left + 0.5 * gap, right, gap).tolist(), range(rows)):
            y = bottom + (top - bottom) * (i + 0.5) / rows
            down = -self.along - self.twist * y, -self.across - self.twist * x
            share = 0.6 * gap / max(_STEEP, hypot(*down))
            found.append(((x, y), (x + share * down[0], y + share * down[1])))
        return found

    def draw(self, painter: Painter, camera: Camera) -> None:
        whole = on_pixels(camera, self.box)
        rect, unit = whole.clip(painter.surface.get_rect()), unit_of(painter)
        if rect.width == 0 or rect.height == 0:
            return
        (left, top), (right, bottom) = camera.world(*rect.topleft), camera.world(*rect.bottomright)
        across, up = ((np.arange(n) + 0.5) / n for n in (max(2, px // _COARSE) for px in rect.size))
        heights = self.height(left + (right - left) * across[:, None], top + (bottom - top) * up[None, :])
        (least, greatest), (low, high) = self._range, np.array(self.colours, float)
        shade = np.clip((heights - least) / (greatest - least), 0.0, 1.0) if self.slopes else 0.5 + 0.0 * heights
        image = from_colours(low + (high - low) * shade[:, :, None])
        painter.surface.blit(pygame.transform.smoothscale(image, rect.size), rect.topleft)
        if not self.slopes:
            return
        painter.lines([camera.pixels(branch) for branch in self.contours()], 1.2 * unit, self.line, 0.8)
        for start, end in self.arrows():
            painter.arrow(camera.pixel(*start), camera.pixel(*end), 2.6 * unit, self.arrow, 0.75)
