"""Balls: a face whose marks turn, light from above the left shoulder, and a ring around one that is drawn too large."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import ceil, cos, pi, sin, tau

import numpy as np
import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.painter import OVERSAMPLING, Painter, Point, blank, from_coverage
from sandbox.picture.palette import Colour, palette

CARD, TRACE = palette("card"), palette("trace")

#: A smaller ball is drawn this large, in px across on 360 rows and in proportion on more.
SMALLEST = 7.0
#: The balls along a path are so much smaller than the one at its end, where they are all drawn too large.
MARK = 0.62

#: Marks on a ball that is smaller than this, px in radius, are fewer, or nothing would be left of its colour.
FEWER = 8 * OVERSAMPLING

#: Draws marks on a surface whose middle is the ball's; the number is the ball's radius on it in px.
Marks = Callable[[pygame.Surface, float], None]


def least_radius(rows: int) -> float:
    """Least radius of a ball in px on a picture of so many rows."""
    return SMALLEST / 2 * max(1.0, rows / 360)


def enlarged(radius: float, camera: Camera, rows: int) -> float:
    """How many times its size a ball of ``radius`` (m) is drawn on a picture of so many rows."""
    return max(1.0, least_radius(rows) / (radius * camera.scale))


def mark_radius(rows: int) -> float:
    """Least radius in px of the balls along a path."""
    return max(SMALLEST / 2, MARK * least_radius(rows))


class Look:
    """How a ball looks: its colour, its marks, and the colour of its shaded side."""

    def __init__(self, colour: Colour, shade: Colour, marks: Marks):
        self.colour, self.shade, self.marks = colour, shade, marks

    def draw(
        self, painter: Painter, centre: Point, radius: float, angle: float, unit: float, enlarged: bool = False
    ) -> None:
        """Draw it turned by ``angle`` rad counter-clockwise; the ring says that it is enlarged."""
        painter.disc(centre, radius + max(0.7, 0.8 * unit), TRACE["rim"], 0.65)
        radius = round(radius * 8) / 8  # so that few faces are made and kept
        painter.turned(_face(self, radius), centre, angle)
        painter.centred(_light(radius, self.shade), centre)
        if enlarged:
            painter.ring(centre, radius + 4.5 * unit, max(1.2, 1.7 * unit), CARD["accent"])


@lru_cache(maxsize=32)
def _face(look: Look, radius: float) -> pygame.Surface:
    """The ball straight on, larger by OVERSAMPLING."""
    large = radius * OVERSAMPLING
    reach = ceil(large)
    face = blank((2 * reach + 1, 2 * reach + 1), transparent=True)
    face.fill(look.colour)
    look.marks(face, large)
    grid = np.arange(-reach, reach + 1)
    alpha = pygame.surfarray.pixels_alpha(face)
    alpha[...] = np.clip(large - np.hypot(grid[:, None], grid[None, :]) + 0.5, 0, 1) * 255
    del alpha  # unlocks the surface
    face.set_at((0, 0), (*look.colour, 0))
    return face


@lru_cache(maxsize=32)
def _light(radius: float, shade: Colour) -> pygame.Surface:
    """A soft shade over the ball's lower right."""
    reach = ceil(radius) + 1
    grid = np.arange(-reach, reach + 1)
    inside = np.clip(radius - np.hypot(grid[:, None], grid[None, :]) + 0.5, 0, 1)
    away = np.hypot(grid[:, None] / radius + 0.38, grid[None, :] / radius + 0.45) / 1.5
    return from_coverage(inside * np.clip(away - 0.42, 0, 1) ** 1.3 * 0.85, shade)


def seams(colour: Colour) -> Marks:
    """The seams of a basketball: a cross, and an arc on either side."""

    def draw(face: pygame.Surface, radius: float) -> None:
        middle = face.get_width() / 2
        width = max(3, round(0.11 * radius))
        few = radius < FEWER
        pygame.draw.line(face, colour, (middle, middle - radius), (middle, middle + radius), width)
        pygame.draw.line(face, colour, (middle - radius, middle), (middle + radius, middle), width)
        for side in () if few else (-1, 1):
            pygame.draw.circle(face, colour, (middle + side * 1.28 * radius, middle), 0.82 * radius, width)

    return draw


def patches(colour: Colour, seam: Colour) -> Marks:
    """The patches of a soccer ball: a five-sided one in the middle, five more at the edge, seams between them."""

    def draw(face: pygame.Surface, radius: float) -> None:
        middle = face.get_width() / 2

        def at(away: float, turn: float) -> Point:
            return middle + away * radius * sin(turn), middle - away * radius * cos(turn)

        if radius < 1.5 * FEWER:
            for turn in (0, tau / 3, 2 * tau / 3):
                pygame.draw.circle(face, colour, at(0.56, turn), 0.26 * radius)
            return
        width = max(2, round(0.06 * radius))
        for i in range(5):
            turn = i * tau / 5
            pygame.draw.line(face, seam, at(0.3, turn), at(0.8, turn), width)
            between = turn + pi / 5
            pygame.draw.line(face, seam, at(0.66, turn), at(0.72, between), width)
            pygame.draw.line(face, seam, at(0.72, between), at(0.66, turn + tau / 5), width)
            pygame.draw.line(face, seam, at(0.72, between), at(1.0, between), width)
            corners = [at(0.68, turn), at(0.86, turn - 0.36), at(1.1, turn - 0.3), at(1.1, turn + 0.3)]
            pygame.draw.polygon(face, colour, [*corners, at(0.86, turn + 0.36)])
        pygame.draw.polygon(face, colour, [at(0.36, i * tau / 5) for i in range(5)])

    return draw
