"""A place seen from above, as data: parts that draw themselves, the lowest first; lengths in m, x to the right, y up.

Pitches, tables, lanes and sheets of ice are made of the same few parts; what only tables have is in ``table.py``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, cos, floor, log2, radians, sin
from typing import Any, NamedTuple

import numpy as np
import pygame

from sandbox.picture.camera import Box, Camera
from sandbox.picture.painter import Painter, Point, blank, from_coverage
from sandbox.picture.palette import Colour
from sandbox.picture.places.things import SHADOW, unit_of

#: The smallest width of a line, a stripe and a person, in px on 720 rows.
_LEAST_LINE, LEAST_STRIPE, LEAST_PERSON = 1.3, 10.0, 26.0
#: Shoulders are so broad, in m.
BREADTH = 0.5

#: Parts with ``draw(painter, camera)``: those below, and things that are seen from the side, too.
Plan = tuple[Any, ...]


@lru_cache(maxsize=8)
def drawn(plan: Plan, camera: Camera, size: tuple[int, int]) -> pygame.Surface:
    """The place on a picture of ``size`` px. Not to be drawn on: it is shared."""
    surface = blank(size)
    draw_moving(surface, plan, camera)
    return surface


def draw_moving(surface: pygame.Surface, plan: Plan, camera: Camera) -> None:
    """Draw the place as a camera sees it that will see it once only."""
    painter = Painter(surface)
    for part in plan:
        part.draw(painter, camera)


def on_pixels(camera: Camera, box: Box) -> pygame.Rect:
    """A rectangle of the place, its edges on whole px."""
    edges = (*camera.pixel(box.left, box.top), *camera.pixel(box.right, box.bottom))
    left, top, right, bottom = (floor(edge + 0.5) for edge in edges)
    return pygame.Rect(left, top, right - left, bottom - top)


# ---------------------------------------------------------------------------------------------- what lies on the ground


@dataclass(frozen=True)
class Ground:
    """A rectangle of one colour."""

    box: Box
    colour: Colour

    def draw(self, painter: Painter, camera: Camera) -> None:
        painter.surface.fill(self.colour, on_pixels(camera, self.box).clip(painter.surface.get_rect()))


@dataclass(frozen=True)
class Stripes:
    """A rectangle in stripes of ``width`` m across x, or with ``along`` along it, counted from ``start``.

    Mown grass, boards, planks. Too narrow to be told apart, they are twice as wide, or four times and so on.
    """

    box: Box
    colours: tuple[Colour, ...]
    width: float
    start: float = 0.0
    along: bool = False

    def draw(self, painter: Painter, camera: Camera) -> None:
        least = LEAST_STRIPE * unit_of(painter) / camera.scale
        width = self.width * 2.0 ** max(0, ceil(log2(least / self.width)))
        low, high = ("bottom", "top") if self.along else ("left", "right")
        first, last = getattr(self.box, low), getattr(self.box, high)
        for i in range(floor((first - self.start) / width), ceil((last - self.start) / width)):
            a, b = self.start + i * width, self.start + (i + 1) * width
            stripe = self.box._replace(**{low: max(a, first), high: min(b, last)})
            Ground(stripe, self.colours[i % len(self.colours)]).draw(painter, camera)


@dataclass(frozen=True)
class Line:
    """A painted line through points; one along x or y has its edges on whole px."""

    points: tuple[Point, ...]
    width: float
    colour: Colour

    def draw(self, painter: Painter, camera: Camera) -> None:
        width = max(self.width, max(1.0, _LEAST_LINE * unit_of(painter)) / camera.scale)
        x, y = zip(*self.points, strict=True)
        box = Box(min(x) - width / 2, min(y) - width / 2, max(x) + width / 2, max(y) + width / 2)
        if len(self.points) == 2 and (x[0] == x[1] or y[0] == y[1]):
            Ground(box, self.colour).draw(painter, camera)
        elif on_pixels(camera, box).colliderect(painter.surface.get_rect()):
            painter.lines([camera.pixels(np.array(self.points))], width * camera.scale, self.colour)


@dataclass(frozen=True)
class Spot:
    """A painted disc, or with ``ring`` a circle of that width in m."""

    centre: Point
    radius: float
    colour: Colour
    ring: float = 0.0

    def draw(self, painter: Painter, camera: Camera) -> None:
        least = max(1.0, _LEAST_LINE * unit_of(painter))
        radius, ring = self.radius * camera.scale, self.ring and max(self.ring * camera.scale, least)
        painter.disc(camera.pixel(*self.centre), max(radius, least), self.colour, width=ring)


@dataclass(frozen=True)
class Worn:
    """A place that fades into its ground: where many feet have been, or a light falls."""

    centre: Point
    half_length: float
    half_width: float
    colour: Colour
    opacity: float

    def draw(self, painter: Painter, camera: Camera) -> None:
        half = self.half_length * camera.scale, self.half_width * camera.scale
        painter.shadow(camera.pixel(*self.centre), *half, self.colour, self.opacity)


def arc(centre: Point, radius: float, start: float, end: float) -> tuple[Point, ...]:
    """Points of an arc between two directions in deg, counter-clockwise from x."""
    turns = np.radians(np.linspace(start, end, max(2, ceil(abs(end - start) / 2) + 1)))
    return tuple((centre[0] + radius * cos(turn), centre[1] + radius * sin(turn)) for turn in turns)


# ---------------------------------------------------------------------------------------------------------- what stands


class Kit(NamedTuple):
    """A person's colours from above."""

    body: Colour
    far: Colour
    hair: Colour
    shirt: Colour
    gloves: Colour


@dataclass(frozen=True)
class Person:
    """Someone who stands ``behind`` m behind a point and looks past it, in the direction ``facing`` (deg,
    counter-clockwise from the right), the hands before the body or held out."""

    at: Point
    facing: float
    kit: Kit
    breadth: float = BREADTH
    behind: float = 0.0
    arms: float = 0.0  # how far each hand is held out, in m
    stretched: bool = False  # in a dive: the arms ahead, the legs behind

    def draw(self, painter: Painter, camera: Camera) -> None:
        (x, y), turn, kit = self.place(camera, unit_of(painter)), radians(self.facing), self.kit
        wide = self.breadth * enlarged(camera, unit_of(painter)) * camera.scale
        reach = max(self.arms * camera.scale / wide, 0.75) if self.arms else 0.0

        def at(ahead: float, aside: float) -> Point:
            """In px, from so many breadths of the shoulders."""
            return (
                x + wide * (ahead * cos(turn) - aside * sin(turn)), y - wide * (ahead * sin(turn) + aside * cos(turn))
            )  # fmt: skip

        painter.shadow((x + 0.16 * wide, y + 0.2 * wide), 0.5 * wide, 0.34 * wide, SHADOW, 0.5)
        if self.stretched:
            self._diving(painter, at, wide)
            return
        elbow, wrist = ((0.14, 0.6 * reach), (0.10, reach - 0.09)) if reach else ((0.22, 0.38), (0.36, 0.08))
        for side in (-1, 1):
            arm = [at(ahead, side * aside) for ahead, aside in ((0.0, 0.36), elbow, wrist)]
            painter.line(arm, 0.15 * wide, kit.body)
            if reach:
                painter.disc(arm[-1], 0.13 * wide, kit.gloves)
        shoulders, rim = [at(0.0, -0.34), at(0.0, 0.34)], 0.32 * wide + 2.4 * unit_of(painter)
        painter.line(shoulders, rim, SHADOW, 0.6)  # so that it stands out on any ground
        painter.line(shoulders, 0.32 * wide, kit.shirt)
        painter.disc(at(0.03, 0.0), 0.19 * wide, kit.far)
        painter.disc(at(-0.01, 0.0), 0.18 * wide, kit.hair)

    def _diving(self, painter: Painter, at: Callable[[float, float], Point], wide: float) -> None:
        """Draw someone stretched out in a dive; a place ``at`` is so many breadths of the shoulders ahead and aside."""
        kit = self.kit
        for side in (-1, 1):
            painter.line([at(-0.45, 0.14 * side), at(-1.05, 0.24 * side)], 0.17 * wide, kit.body)
            painter.line([at(0.1, 0.24 * side), at(0.55, 0.3 * side), at(0.92, 0.15 * side)], 0.14 * wide, kit.body)
            painter.disc(at(0.98, 0.14 * side), 0.14 * wide, kit.gloves)
        painter.line([at(-0.42, 0.0), at(0.14, 0.0)], 0.52 * wide, kit.shirt)
        painter.disc(at(0.42, 0.0), 0.19 * wide, kit.far)
        painter.disc(at(0.38, 0.0), 0.18 * wide, kit.hair)

    def place(self, camera: Camera, unit: float) -> Point:
        """The person's place, in px."""
        turn, back = radians(self.facing), self.behind * enlarged(camera, unit)
        return camera.pixel(self.at[0] - back * cos(turn), self.at[1] - back * sin(turn))


def enlarged(camera: Camera, unit: float) -> float:
    """The factor by which people are drawn larger, so as to be seen."""
    return max(1.0, LEAST_PERSON * unit / (BREADTH * camera.scale))


# ------------------------------------------------------------------------------------------------------------ the light


@lru_cache(maxsize=4)
def dusk(size: tuple[int, int], colour: Colour) -> pygame.Surface:
    """Darkness that grows from the middle of a picture to its edges, most above and below, where text stands."""
    width, height = size
    across = abs(np.arange(width)[:, None] / width * 2 - 1)
    down = abs(np.arange(height)[None, :] / height * 2 - 1.04)
    return from_coverage(0.92 * np.clip(0.40 * across**3 + 2.6 * np.clip(down - 0.52, 0, 1), 0, 1), colour)
