"""The golf course as it is drawn: field, ground, hole and ball."""

from __future__ import annotations

from functools import cached_property, lru_cache
from math import ceil, floor, sin
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import Look
from sandbox.picture.camera import Box, Camera
from sandbox.picture.landscape import Landscape
from sandbox.picture.painter import OVERSAMPLING, Painter, blank
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.sheet import rows_of

GOLF, CARD = palette("golf"), palette("card")
MOON = GOLF | palette("moon")

FLAGSTICK = 2.13  # m
#: How much smaller things look at the far side of the fairway than on the line of play.
FAR = 0.42
#: The horizon's height above the line of play, px on 720 rows.
FIELD = 58
#: The field's stripes differ little, so a lower factor than for other shapes will do.
FIELD_OVERSAMPLING = 2


class Course:
    """The place that the ball flies over, for pictures on which the lowest ground is ``base`` px from the top."""

    def __init__(self, setup: Any, pin: float, size: tuple[int, int], base: int, moon: bool = False):
        self.pin, self.size, self.base, self.moon = pin, size, base, moon
        self.colours = MOON if moon else GOLF
        self.unit = rows_of(size) / 720
        self.horizon = base - round(FIELD * self.unit)
        turf = [s for s in setup.surfaces if s.name != "cup"]
        line = sorted({point for s in turf for point in (s.shape.a, s.shape.b)})
        self.line = np.array(line, float)  # m, the ground from left to right
        self.pieces = _pieces(turf)
        corners = [point for s in setup.surfaces if s.name == "cup" for point in (s.shape.a, s.shape.b)]
        self.cup = Box(*np.min(corners, axis=0), *np.max(corners, axis=0)) if corners else None

    def height(self, x: float) -> float:
        """Height of the ground in m at x, across the cup too."""
        return float(np.interp(x, self.line[:, 0], self.line[:, 1]))

    def lowest_and_highest(self, left: float, right: float) -> tuple[float, float]:
        """Of the ground between two places, in m."""
        heights = self.between(left, right)[:, 1]
        return float(heights.min()), float(heights.max())

    def between(self, left: float, right: float) -> np.ndarray:
        """The ground's line from one place to another, in m."""
        inner = self.line[(self.line[:, 0] > left) & (self.line[:, 0] < right)]
        return np.array([(left, self.height(left)), *inner, (right, self.height(right))])

    @property
    def landscape(self) -> Landscape:
        return _landscape(self.size, self.horizon, self.moon)

    @cached_property
    def soil(self) -> pygame.Surface:
        """The ground cut open along the line of play, darker with depth."""
        rows = self.size[1] - self.base
        top, middle, low = (np.array(colour, float) for colour in self.colours["soil"])
        share = np.linspace(0, 2, rows)[:, None]
        column = np.where(share < 1, top + (middle - top) * share, middle + (low - middle) * (share - 1))
        soil = blank((self.size[0], rows))
        pygame.surfarray.blit_array(soil, np.broadcast_to(column.round().astype(np.uint8), (self.size[0], rows, 3)))
        return soil

    # The ground

    def draw(self, painter: Painter, camera: Camera, stripe: float, moved: float = 0.0) -> int:
        """Landscape, field and ground; mown stripes are ``stripe`` m wide; the eye has ``moved`` px to the right.

        Returns the row of the lowest ground in sight; there is nothing but soil below it.
        """
        self.landscape.draw(painter.surface, moved)
        low, high = camera.world(0, 0)[0], camera.world(self.size[0], 0)[0]
        outline = camera.pixels(self.between(low, high))
        deepest = min(self.size[1], max(self.base, round(outline[:, 1].max())))
        self._field(painter.surface, camera, stripe, deepest)
        painter.surface.blit(self.soil, (0, deepest))
        if outline[:, 1].min() < deepest - 1:
            under = np.add(outline, (0, self._turf_depth / 2))  # so that its rough edge is hidden
            pygame.draw.polygon(
                painter.surface, self.colours["soil"][0], [*under, (self.size[0], deepest), (0, deepest)]
            )
        light = self._light(camera, stripe)
        for name, a, b in self.pieces:
            left, right = max(a, low), min(b, high)
            if left >= right:
                continue
            self._turf(painter, camera, left, right, self.colours[name])
            if name == "fairway":
                for band in _bands(left, right, stripe):
                    self._turf(painter, camera, *band, light)
            elif name in ("bunker", "water"):
                self._hollow(painter, camera, a, b, self.colours[name])
        return deepest

    def _field(self, surface: pygame.Surface, camera: Camera, stripe: float, deepest: int) -> None:
        """The ground behind the line of play, from the horizon to row ``deepest``: rough, before it mown fairway."""
        larger = FIELD_OVERSAMPLING
        width, rows = self.size[0], deepest - self.horizon
        field = self._field_drawn.subsurface((0, 0, width * larger, rows * larger))
        line = (self.base - self.horizon) * larger  # the row where things are as large as on the line of play
        top, bottom = round(line * FAR), rows * larger
        middle = camera.world(width / 2, 0)[0]

        def column(x: float, row: float) -> float:
            return (width / 2 + (x - middle) * camera.scale * row / line) * larger

        def across(a: float, b: float, colour: Colour) -> None:
            """A strip from one side of the fairway to the other."""
            corners = ((a, top), (b, top), (b, bottom), (a, bottom))
            pygame.draw.polygon(field, colour, [(column(x, row), row) for x, row in corners])

        field.fill(self.colours["fairway"], (0, top, width * larger, bottom - top))
        reach = width / 2 / FAR / camera.scale
        light = self._light(camera, stripe)
        for a, b in _bands(middle - reach, middle + reach, stripe):
            across(a, b, light)
        for name, a, b in self.pieces:
            if name in ("rough", "tee"):
                across(max(a, middle - reach), min(b, middle + reach), self.colours[name])
            elif name != "fairway":
                left, right = column(a, line), column(b, line)
                tall = min(0.5 * line, max(0.16 * (right - left), 8.0 * self.unit))
                x = np.linspace(max(left, -width), min(right, 3 * width), 61)
                away = np.clip((2 * x - left - right) / (right - left), -1, 1)
                edge = line - tall * np.sqrt(1 - away**2)
                if x[0] < x[-1]:
                    pygame.draw.polygon(
                        field, self.colours[name], [*zip(x, edge, strict=True), (x[-1], bottom), (x[0], bottom)]
                    )
        surface.blit(pygame.transform.smoothscale(field, (width, rows)), (0, self.horizon))

    @cached_property
    def _field_drawn(self) -> pygame.Surface:
        """Where the field is drawn, larger; the far rough is on it already, paler with distance."""
        rows = self.size[1] - self.horizon
        field = blank((self.size[0] * FIELD_OVERSAMPLING, rows * FIELD_OVERSAMPLING))
        far = round((self.base - self.horizon) * FAR * FIELD_OVERSAMPLING)
        for row in range(far):
            field.fill(mix(self.colours["rough_far"], self.colours["rough"], row / far), (0, row, field.get_width(), 1))
        return field

    def _light(self, camera: Camera, stripe: float) -> Colour:
        """The lighter stripes' colour; it goes over into the darker one's where stripes are too narrow to see."""
        fade = min(1.0, max(0.0, stripe * camera.scale / (12 * self.unit) - 0.5))
        return mix(self.colours["fairway"], self.colours["fairway_stripe"], fade)

    @property
    def _turf_depth(self) -> int:
        """In px."""
        return max(3, round(7 * self.unit))

    def _turf(self, painter: Painter, camera: Camera, a: float, b: float, colour: Colour) -> None:
        thick = self._turf_depth
        lighter = mix(colour, (255, 255, 255), 0.13)
        outline = camera.pixels(self.between(a, b))
        if np.ptp(outline[:, 1]) < 0.01:
            left, right = round(outline[0, 0]), round(outline[-1, 0])
            painter.surface.fill(lighter, (left, round(outline[0, 1]), right - left, thick))
        else:
            painter.polygon([*outline, *np.add(outline[::-1], (0, thick))], lighter)

    def _hollow(self, painter: Painter, camera: Camera, a: float, b: float, colour: Colour) -> None:
        """Sand or water lies in a shallow bowl."""
        outline = camera.pixels(self.between(a, b))
        (left, top), (right, end) = outline[0], outline[-1]
        deep = min(16 * self.unit, 0.2 * (right - left))
        turn = np.linspace(0, np.pi, 25)
        x, y = (left + right) / 2 + np.cos(turn) * (right - left) / 2, np.sin(turn) ** 0.7 * deep
        painter.polygon([*outline, *zip(x, y + np.interp(x, [left, right], [top, end]), strict=True)], colour)

    # The hole and the ball

    def hole(self, painter: Painter, camera: Camera, t: float, wind: float) -> pygame.Rect | None:
        """Cup and flag, larger than they are where they would be too small to see; the flag flutters in the wind (m/s).

        Returns the place that the flag takes.
        """
        unit = self.unit
        x, ground = camera.pixel(self.pin, self.height(self.pin))
        tall = min(max(FLAGSTICK * camera.scale, 66 * unit), 190 * unit)
        cloth = 30 * unit
        if not -cloth < x < self.size[0] + cloth:
            return None
        foot = ground
        if self.cup is not None and (self.cup.right - self.cup.left) * camera.scale > 10 * unit:
            left, right = (round(camera.pixel(edge, 0)[0]) for edge in (self.cup.left, self.cup.right))
            foot = camera.pixel(0, self.cup.bottom)[1]
            deep = round(foot - ground)
            painter.surface.fill(self.colours["liner"], (left, round(ground), right - left, deep))
            thin = max(1, round(1.6 * unit))
            painter.surface.fill(
                self.colours["cup"], (left + thin, round(ground), right - left - 2 * thin, deep - thin)
            )
        elif self.cup is not None:
            foot += 3 * unit
            painter.shadow((x, foot), 7 * unit, 2.5 * unit, self.colours["cup"], 0.9)
        painter.shadow((x + 12 * unit, ground - unit), 16 * unit, 2.5 * unit, CARD["shadow"], 0.3)
        pole = max(2.0, 2.6 * unit)
        painter.line([(x, foot), (x, ground - tall)], pole + 1.4 * unit, CARD["shadow"], 0.3)
        painter.line([(x, foot), (x, ground - tall)], pole, self.colours["pole"])
        side = -1 if wind < 0 else 1
        share = np.linspace(0, 1, 9)
        along = x + side * cloth * share
        wave = ground - tall + np.array([1.6 * unit * s * sin(5 * s - 9 * t) for s in share])
        upper, lower = wave + 9 * unit * share, wave + (19 - 9 * share) * unit
        painter.polygon(
            [*zip(along, upper, strict=True), *zip(along[::-1], lower[::-1], strict=True)], self.colours["flag"]
        )
        return pygame.Rect(round(x - cloth), round(ground - tall), round(2 * cloth), round(tall))


@lru_cache(maxsize=4)
def _landscape(size: tuple[int, int], horizon: int, moon: bool) -> Landscape:
    """Shared by all pictures of the same shape."""
    return Landscape(size, horizon, MOON if moon else GOLF)


def _pieces(turf: list[Any]) -> list[tuple[str, float, float]]:
    """Kind and ends in m of each stretch of ground, from left to right; the two sides of the cup make one."""
    merged: list[tuple[str, float, float]] = []
    for a, b, name in sorted((s.shape.a[0], s.shape.b[0], s.name) for s in turf):
        start = merged.pop()[1] if merged and merged[-1][0] == name else a
        merged.append((name, start, b))
    return merged


def _bands(low: float, high: float, stripe: float) -> list[tuple[float, float]]:
    """Every second stripe between two places in m."""
    first, last = floor(low / stripe), ceil(high / stripe)
    even = range(first + first % 2, last, 2)
    return [(max(low, i * stripe), min(high, (i + 1) * stripe)) for i in even]


def _dimples(face: pygame.Surface, radius: float) -> None:
    """Dimples and a stripe, where there is room for them."""
    if radius < 6 * OVERSAMPLING:
        return
    middle, apart = face.get_width() // 2, radius / 3.4
    for row in range(-4, 5):
        for place in range(-4, 5):
            x, y = (place + row % 2 / 2) * apart, row * apart * 0.87
            if np.hypot(x, y) < radius * 0.93:
                pygame.draw.circle(face, GOLF["dimple"], (middle + x, middle + y), apart * 0.30)
    band = pygame.Rect(0, 0, round(1.36 * radius), round(0.26 * radius))
    band.center = (middle, middle)
    pygame.draw.rect(face, GOLF["ball_mark"], band, border_radius=band.height // 2)


BALL = Look(GOLF["ball"], GOLF["ball_shade"], _dimples)
