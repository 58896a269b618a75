"""Parts that only tables have: wooden rails with cushions, pockets and sights, from above under a lamp in a dark room.

Parts of a plan, as in ``plan.py``; the middle of the table is the origin and half sizes are (along x, along y), in m.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import exp, hypot

import numpy as np
import pygame

from sandbox.engine.model.surface import Segment, Surface
from sandbox.picture.camera import Box, Camera
from sandbox.picture.painter import Painter, Point, around_corners, blank, from_colours
from sandbox.picture.palette import Colour, mix
from sandbox.picture.places.plan import Line, on_pixels
from sandbox.picture.places.things import Shape

#: Light is computed at every so many px and smoothed between.
_COARSE = 4
#: Share of the light in the middle that reaches the table's corners, and the colour of white there.
_AT_CORNER, _WARM = 0.56, (1.0, 0.985, 0.955)
#: Streaks of grain on each rail.
_GRAIN = 16
#: Radius of the rails' outer corners, in m.
_CORNER = 0.055
#: Widths in m: of the lip on the rails' inside, the leather round a pocket, a sight.
_LIP, _LEATHER, _SIGHT = 0.009, 0.018, 0.010
#: The cushions' shadow on the bed: how dark, and how far it reaches in m.
_SHADE, _SHADE_REACH = 0.45, 0.022


def around(half: Point) -> Box:
    """The rectangle of those half sizes about the origin."""
    return Box(-half[0], -half[1], half[0], half[1])


@dataclass(frozen=True)
class Room:
    """The floor, lit round the table, with the table's soft shadow on it."""

    table: Point  # half sizes
    colours: tuple[Colour, Colour]  # under the lamp, away from it
    shadow: Colour

    def draw(self, painter: Painter, camera: Camera) -> None:
        x, y = self.table
        across, up = _coarse(camera, painter.surface.get_rect())
        lit, dark = np.array(self.colours, float)
        far = np.hypot(across / (1.35 * x), up / (1.5 * y))
        floor = dark + (lit - dark) * np.exp(-1.1 * far**2)[:, :, None]
        beyond = np.hypot(np.maximum(abs(across - 0.012) - x + 0.05, 0), np.maximum(abs(up + 0.03) - y + 0.05, 0))
        floor += (np.array(self.shadow, float) - floor) * 0.75 * np.exp(-((beyond / 0.11) ** 2))[:, :, None]
        painter.surface.blit(pygame.transform.smoothscale(from_colours(floor), painter.surface.get_size()), (0, 0))


@dataclass(frozen=True)
class Rails:
    """Four boards with their grain, mitred, from ``inner`` to ``outer``, a lighter lip on their inside."""

    inner: Point
    outer: Point
    wood: tuple[Colour, Colour, Colour]  # lit, plain, in the grain
    lip: Colour

    def draw(self, painter: Painter, camera: Camera) -> None:
        _, plain, dark = self.wood
        edge, rect = 0.006 * camera.scale, on_pixels(camera, around(self.outer))
        painter.panel(rect, dark, 1.0, _CORNER * camera.scale)
        painter.panel(rect.inflate(-2 * edge, -2 * edge), plain, 1.0, (_CORNER - 0.006) * camera.scale)
        chance = np.random.default_rng(3)
        for side, axis, _ in product((-1, 1), (0, 1), range(_GRAIN)):
            self._streak(painter, camera, chance, side, axis)
        for sx, sy in product((-1, 1), (-1, 1)):
            a, b = self.inner, (self.outer[0] - 0.02, self.outer[1] - 0.02)
            Line(((sx * a[0], sy * a[1]), (sx * b[0], sy * b[1])), 0.002, dark).draw(painter, camera)
        lip = on_pixels(camera, around((self.inner[0] + _LIP, self.inner[1] + _LIP)))
        painter.surface.fill(self.lip, lip)

    def _streak(self, painter: Painter, camera: Camera, chance: np.random.Generator, side: int, axis: int) -> None:
        """A streak of grain on the rail along an axis, on one side of the table, no further than the mitre."""
        lit, plain, dark = self.wood
        half, deep = self.inner[axis], chance.uniform(0.05, 0.85) * (self.outer[0] - self.inner[0])
        middle, length = chance.uniform(-1, 1) * half, chance.uniform(0.2, 0.8) * half
        colour = mix(plain, dark if chance.random() < 0.6 else lit, chance.uniform(0.25, 0.6))
        row, reach = side * (self.inner[1 - axis] + deep), half + deep - 0.02
        ends = [(max(middle - length, -reach), row), (min(middle + length, reach), row)]
        width = max(0.35, chance.uniform(0.0015, 0.005) * camera.scale)
        painter.line([camera.pixel(*(end if axis == 0 else end[::-1])) for end in ends], width, colour)


@dataclass(frozen=True)
class Pocket:
    """Leather behind a hole, bed before it, and the hole."""

    centre: Point
    radius: float
    beds: tuple[tuple[Point, Colour], ...]  # half sizes and colour, the widest first
    leather: tuple[Colour, Colour]  # its edge, the rest
    hole: tuple[Colour, Colour]  # deep down, at its edge

    def draw(self, painter: Painter, camera: Camera) -> None:
        centre, at = np.array(self.centre), camera.pixel(*self.centre)
        radius, leather = self.radius * camera.scale, _LEATHER * camera.scale
        out = np.sign(np.where(abs(centre) > 1e-9, centre, 0.0))
        out /= hypot(*out) or 1.0
        across = np.array([-out[1], out[0]]) * (self.radius + _LEATHER) * 1.02
        painter.disc(at, radius + leather, self.leather[0])
        painter.disc(at, radius + 0.8 * leather, self.leather[1])
        back = centre - 2.5 * self.radius * out
        front = camera.pixels(np.array([centre + across, centre - across, back - across, back + across]))
        for half, colour in self.beds:
            painter.surface.set_clip(on_pixels(camera, around(half)))
            pygame.draw.polygon(painter.surface, colour, front.tolist())  # smooth edges would show on their own colour
        painter.surface.set_clip(None)
        painter.disc(at, radius, self.hole[1])
        painter.disc(camera.pixel(*(centre + 0.1 * self.radius * out)), 0.88 * radius, self.hole[0])


@dataclass(frozen=True)
class _Cushion:
    """From its nose back to the rail, between two jaws (middle line and radius), brighter along the nose."""

    nose: tuple[Point, Point]
    jaws: tuple[tuple[Point, Point, float] | None, tuple[Point, Point, float] | None]  # None: a closed corner
    back: Point  # half sizes of the rails' inside
    colours: tuple[Colour, Colour]  # at the nose, at the back

    def draw(self, painter: Painter, camera: Camera) -> None:
        (a, b), out = np.array(self.nose), _outward(*self.nose)
        along = (b - a) / hypot(*(b - a))
        deep = float(abs(out) @ (np.array(self.back) - abs(a)))
        front, behind = self.colours
        painter.surface.set_clip(on_pixels(camera, around(self.back)))
        ends = []
        for end, way, jaw in ((a, -along, self.jaws[0]), (b, along, self.jaws[1])):
            if jaw is None:
                ends.append([end + (out + way) * deep])
                continue
            inner, outer, radius = jaw
            painter.line([camera.pixel(*inner), camera.pixel(*outer)], 2 * radius * camera.scale, behind)
            ends.append([np.array(inner), np.array(outer), np.array(outer) + 3 * deep * out])
        painter.polygon(camera.pixels(np.array([a, b, *ends[1], *reversed(ends[0])])), behind)
        for share in (1.0, 0.75, 0.5, 0.25):  # light falls off towards the back
            band = 0.42 * deep * share * out
            painter.polygon(camera.pixels(np.array([a, b, b + band, a + band])), mix(front, behind, share))
        painter.surface.set_clip(None)


def cushions(surfaces: Sequence[Surface], back: Point, colours: tuple[Colour, Colour]) -> tuple[_Cushion, ...]:
    """The cushions of segments named "... cushion", which are noses, each between the jaws that begin at its ends."""
    shapes = [(s.name.endswith("cushion"), s.shape) for s in surfaces if isinstance(s.shape, Segment)]
    jaws = [(shape.a, shape.b, shape.radius) for nose, shape in shapes if not nose]
    found = []
    for shape in (shape for nose, shape in shapes if nose):
        out = _outward(shape.a, shape.b)
        ends = [
            next((jaw for jaw in jaws if hypot(*(end + jaw[2] * out - jaw[0])) < 1e-9), None)
            for end in (shape.a, shape.b)
        ]
        found.append(_Cushion((shape.a, shape.b), (ends[0], ends[1]), back, colours))
    return tuple(found)


def _outward(a: Point, b: Point) -> np.ndarray:
    """Across a line, away from the origin."""
    across = np.array([a[1] - b[1], b[0] - a[0]]) / hypot(b[0] - a[0], b[1] - a[1])
    return across if across @ a > 0 else -across


def sights(half: Point, rails: Point, colour: Colour, pockets: bool) -> tuple[Shape, ...]:
    """Diamonds in the rails' middle lines ``rails``, at eighths along a table and quarters across."""
    places = [(i / 4 * half[0], side * rails[1], 0) for i in range(-3, 4) if i or not pockets for side in (-1, 1)]
    places += [(side * rails[0], i / 2 * half[1], 1) for i in (-1, 0, 1) for side in (-1, 1)]
    found = []
    for x, y, turned in places:
        wide, tall = (0.85 * _SIGHT, 1.5 * _SIGHT) if turned else (1.5 * _SIGHT, 0.85 * _SIGHT)
        found.append(Shape(((x - wide, y), (x, y + tall), (x + wide, y), (x, y - tall)), colour))
    return tuple(found)


@dataclass(frozen=True)
class Lamp:
    """The light over the middle of a table whose bed is darkened along the cushions, by their shadow."""

    bed: Point
    outer: Point

    def draw(self, painter: Painter, camera: Camera) -> None:
        surface, table = painter.surface, on_pixels(camera, around(self.outer))
        lit = table.clip(surface.get_rect())
        if not lit:
            return
        floor = around_corners(surface, table, _CORNER * camera.scale)
        across, up = _coarse(camera, lit)
        far = np.hypot(across / (self.bed[0] * 1.12), up / (self.bed[1] * 1.35)) / hypot(1 / 1.12, 1 / 1.35)
        light = (_AT_CORNER + (1 - _AT_CORNER) * np.exp(-1.3 * far**2.4))[:, :, None]
        colours = from_colours(255 * light * (np.array(_WARM) + (1 - np.array(_WARM)) * (1 - light)))
        surface.blit(pygame.transform.smoothscale(colours, lit.size), lit, special_flags=pygame.BLEND_RGB_MULT)
        whole = on_pixels(camera, around(self.bed))
        bed = whole.clip(surface.get_rect())
        shade, reach = blank(bed.size), _SHADE_REACH * camera.scale
        shade.fill((255, 255, 255))
        for i in range(min(round(5 * reach), min(whole.size) // 2)):
            level = round(255 * (1 - _SHADE * exp(-(i + 0.5) / reach)))
            edge = whole.move(-bed.left, -bed.top).inflate(-2 * i, -2 * i)
            pygame.draw.rect(shade, (level, level, level), edge, 1)
        surface.blit(shade, bed, special_flags=pygame.BLEND_RGB_MULT)
        surface.blit(floor, lit)


def _coarse(camera: Camera, rect: pygame.Rect) -> tuple[np.ndarray, np.ndarray]:
    """World coordinates in m of places in a part of the picture, ``_COARSE`` px apart: light changes slowly."""
    (left, top), (right, bottom) = camera.world(*rect.topleft), camera.world(*rect.bottomright)
    across, up = ((np.arange(n) + 0.5) / n for n in (max(1, px // _COARSE) for px in rect.size))
    return left + (right - left) * across[:, None], top + (bottom - top) * up[None, :]
