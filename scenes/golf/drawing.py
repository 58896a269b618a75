"""Drawing of the golf course: the field, the ground cut open along the line of play, the hole and its flag."""

from __future__ import annotations

from functools import cached_property
from math import pi, sin

import numpy as np
import pygame

from sandbox.engine.setup import Segment, Setup
from sandbox.picture.palette import Colour, mix, palette, scene_colours
from sandbox.picture.places import Ground, Landscape, Line, Stripes
from sandbox.picture.views import Box, Camera, Eye, Look, Mark, Painter, dimples

CARD, COLOURS = palette("card"), scene_colours(__file__)

FLAGSTICK = 2.13  # m
#: Scale of things at the far side of the fairway, compared with the line of play.
FAR = 0.42
#: How deep the turf is that is cut open, and a hollow at most, in px on 720 rows; a cup is drawn that is so wide.
TURF, HOLLOW, LEAST_CUP = 7, 16, 10


class Course:
    """The course of a setup."""

    def __init__(self, setup: Setup, pin: float, moon: bool = False):
        self.setup, self.pin = setup, pin
        self.colours = COLOURS["moon" if moon else "earth"]
        self.turf = self.colours["turf"]

    @cached_property
    def pieces(self) -> list[tuple[str, Segment]]:
        """The ground, from left to right, each piece with its kind."""
        found = ((s.name, s.shape) for s in self.setup.surfaces if isinstance(s.shape, Segment) and s.name != "cup")
        return sorted(found, key=lambda piece: piece[1].a)

    @cached_property
    def cup(self) -> Box:
        """The cup; without height where there is none."""
        corners = [s.shape.a for s in self.setup.surfaces if isinstance(s.shape, Segment) and s.name == "cup"]
        corners = corners or [(self.pin, float(self.heights(np.array(self.pin))))]
        return Box(*np.min(corners, axis=0), *np.max(corners, axis=0))

    @cached_property
    def line(self) -> np.ndarray:
        """The ground's line in m, from left to right, shape (n, 2)."""
        return np.array([point for _, shape in self.pieces for point in (shape.a, shape.b)], float)

    def heights(self, x: np.ndarray) -> np.ndarray:
        """Height of the ground in m at x, across the cup too."""
        return np.interp(x, *self.line.T)

    def between(self, left: float, right: float) -> np.ndarray:
        """The ground's line from one place to another, in m."""
        inner = self.line[(self.line[:, 0] > left) & (self.line[:, 0] < right)]
        low, high = self.heights(np.array([left, right]))
        return np.array([(left, low), *inner, (right, high)])

    def draw(self, painter: Painter, eye: Eye, stripe: float, moved: float) -> None:
        """Landscape, field and ground; mown stripes are ``stripe`` m wide; the eye has ``moved`` px to the right."""
        camera, (width, height) = eye.camera, painter.surface.get_size()
        low, high = camera.world(0, 0)[0], camera.world(width, 0)[0]
        outline = camera.pixels(self.between(low, high))
        deepest = min(height, max(round(eye.base), round(outline[:, 1].max())))
        field, thick = self._field(eye, stripe), max(3, round(TURF * eye.unit))
        Landscape(**self.colours["landscape"]).draw(painter.surface, min(field.foot(eye), height), moved)
        field.draw(painter, eye, deepest)
        if outline[:, 1].min() < deepest - 1:
            under = np.add(outline, (0, thick / 2))  # so that its rough edge is hidden
            pygame.draw.polygon(painter.surface, self.turf["soil"][0], [*under, (width, deepest), (0, deepest)])
        for name, shape in self.pieces:
            left, right = max(shape.a[0], low), min(shape.b[0], high)
            if left < right:
                top = camera.pixels(self.between(left, right)).round()
                painter.polygon([*top, *np.add(top[::-1], (0, thick))], mix(self.turf[name], (255, 255, 255), 0.13))
            if left < right and name in ("bunker", "water"):
                self._hollow(painter, eye, camera.pixels(np.array([shape.a, shape.b])), self.turf[name])
        self._hole(painter, eye)

    def _field(self, eye: Eye, stripe: float) -> Ground:
        """What is behind the line of play: rough along the horizon, in front of it fairway, green and bunkers."""
        far, close = eye.depth(FAR), eye.depth(2.0)
        areas: list[tuple[Line, Colour]] = []
        for name, shape in self.pieces:
            a, b = shape.a[0], shape.b[0]
            if name in ("rough", "tee"):
                left, right = max(a, eye.along(0, far)), min(b, eye.along(2 * eye.centre, far))
                areas.append(([(left, close), (right, close), (right, far), (left, far)], self.turf[name]))
            elif name != "fairway":
                deep = min(0.5, max(0.16 * (b - a) * eye.camera.scale, 8.0 * eye.unit) / (eye.base - eye.level))
                turn = np.linspace(0.0, pi, 41)
                x, z = (a + b) / 2 + np.cos(turn) * (b - a) / 2, np.sin(turn) * eye.depth(1 - deep)
                areas.append(([(b, close), *zip(x, z, strict=True), (a, close)], self.turf[name]))
        stripes = Stripes((self.turf["fairway"], self.turf["fairway_stripe"]), stripe)
        beyond = self.turf["rough_far"], self.turf["rough"]
        return Ground(stripes, self.turf["soil"], areas=areas, far=FAR, beyond=beyond)

    def _hollow(self, painter: Painter, eye: Eye, ends: np.ndarray, colour: Colour) -> None:
        """Sand or water in a shallow hollow between two points in px."""
        (left, top), (right, end) = ends
        turn = np.linspace(0, pi, 25)
        x = (left + right) / 2 + np.cos(turn) * (right - left) / 2
        deep = np.sin(turn) ** 0.7 * min(HOLLOW * eye.unit, 0.2 * (right - left))
        painter.polygon([*ends, *zip(x, np.interp(x, [left, right], [top, end]) + deep, strict=True)], colour)

    def _hole(self, painter: Painter, eye: Eye) -> None:
        """The cup, or a shadow where it would be too small to see."""
        (left, low), (right, top) = eye.camera.pixel(*self.cup[:2]), eye.camera.pixel(*self.cup[2:])
        if self.cup.left < self.cup.right and right - left <= LEAST_CUP * eye.unit:
            painter.shadow(((left + right) / 2, top + 3 * eye.unit), 7 * eye.unit, 2.5 * eye.unit, CUP, 0.9)
        elif left < right:
            thin = max(1, round(1.6 * eye.unit))
            liner = pygame.Rect(round(left), round(top), round(right - left), round(low - top))
            painter.surface.fill(COLOURS["hole"]["liner"], liner)
            painter.surface.fill(CUP, (liner.left + thin, liner.top, liner.width - 2 * thin, liner.height - thin))

    def flag_box(self, camera: Camera, unit: float) -> pygame.Rect:
        """The place that the flag takes; it is drawn larger where it would be too small to see."""
        x, ground = camera.pixel(self.pin, self.cup.top)
        tall, cloth = min(max(FLAGSTICK * camera.scale, 66 * unit), 190 * unit), 30 * unit
        return pygame.Rect(round(x - cloth), round(ground - tall), round(2 * cloth), round(tall))

    def flag(self, painter: Painter, camera: Camera, unit: float, t: float, wind: float) -> None:
        """The flag, which flutters in the wind (m/s), at time t in s."""
        x, ground = camera.pixel(self.pin, self.cup.top)
        top, deep = self.flag_box(camera, unit).top, (self.cup.top - self.cup.bottom) * camera.scale
        foot = ground + (deep if deep > LEAST_CUP * unit else 3 * unit if deep else 0.0)
        painter.shadow((x + 12 * unit, ground - unit), 16 * unit, 2.5 * unit, CARD["shadow"], 0.3)
        painter.trace([(x, foot), (x, top)], max(2.0, 2.6 * unit), COLOURS["hole"]["pole"], CARD["shadow"], 0.7 * unit)
        share = np.linspace(0, 1, 9)
        along = x + (-1 if wind < 0 else 1) * 30 * unit * share
        wave = top + np.array([1.6 * unit * s * sin(5 * s - 9 * t) for s in share])
        edges = np.concatenate([wave + 9 * unit * share, (wave + (19 - 9 * share) * unit)[::-1]])
        painter.polygon(np.column_stack([[*along, *along[::-1]], edges]), COLOURS["hole"]["flag"])


def _stripe(at: np.ndarray) -> np.ndarray:
    """The line that players draw around half of it."""
    return ((abs(at[..., 1]) < 0.13) & (at[..., 2] > 0.0) & (abs(at[..., 0]) < 0.7)).astype(float)


CUP, INK = COLOURS["hole"]["cup"], COLOURS["ball"]
BALL = Look(INK["colour"], Mark(INK["mark"], _stripe, least=6), dimples(INK["dimple"]))
