"""The golf course as it is drawn: field, ground, hole and ball."""

from __future__ import annotations

from functools import lru_cache
from math import ceil, floor, sin

import numpy as np
import pygame

from sandbox.engine.setup import Segment, Setup
from sandbox.picture.ball import Look
from sandbox.picture.camera import Box, Camera
from sandbox.picture.depth import Eye
from sandbox.picture.landscape import Landscape
from sandbox.picture.painter import OVERSAMPLING, Painter, Point, blank, soil
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.sheet import rows_of

GOLF, CARD = palette("golf"), palette("card")
MOON = GOLF | palette("moon")

FLAGSTICK = 2.13  # m
#: How much smaller things look at the far side of the fairway than on the line of play.
FAR = 0.42
#: The field's stripes differ little, so a lower factor than for other shapes will do.
FIELD_OVERSAMPLING = 2


class Course:
    """The place that the ball flies over, for pictures of one size."""

    def __init__(self, setup: Setup, pin: float, size: tuple[int, int], moon: bool = False):
        self.pin, self.size, self.moon = pin, size, moon
        self.colours = MOON if moon else GOLF
        self.unit = rows_of(size) / 720
        lines = [(s.name, s.shape.a, s.shape.b) for s in setup.surfaces if isinstance(s.shape, Segment)]
        turf = [line for line in lines if line[0] != "cup"]
        self.line = np.array(sorted({point for _, *ends in turf for point in ends}), float)  # m, from left to right
        self.pieces = _pieces(turf)
        corners = [point for name, *ends in lines if name == "cup" for point in ends]
        self.cup = Box(*np.min(corners, axis=0), *np.max(corners, axis=0)) if corners else None

    def heights(self, x: np.ndarray) -> np.ndarray:
        """Height of the ground in m at x, across the cup too."""
        return np.interp(x, self.line[:, 0], self.line[:, 1])

    def between(self, left: float, right: float) -> np.ndarray:
        """The ground's line from one place to another, in m."""
        inner = self.line[(self.line[:, 0] > left) & (self.line[:, 0] < right)]
        (low, high) = self.heights(np.array([left, right]))
        return np.array([(left, low), *inner, (right, high)])

    @property
    def cup_depth(self) -> float:
        """In m; 0 where there is no cup."""
        return 0.0 if self.cup is None else self.cup.top - self.cup.bottom

    # The ground

    def draw(self, painter: Painter, eye: Eye, stripe: float, moved: float = 0.0) -> None:
        """Landscape, field and ground; mown stripes are ``stripe`` m wide; the eye has ``moved`` px to the right."""
        camera, horizon, base = eye.camera, round(eye.level), round(eye.camera.anchor[1])
        _landscape(self.size, horizon, self.moon).draw(painter.surface, moved)
        low, high = camera.world(0, 0)[0], camera.world(self.size[0], 0)[0]
        outline = camera.pixels(self.between(low, high))
        deepest = min(self.size[1], max(base, round(outline[:, 1].max())))
        self._field(painter.surface, eye, base, stripe, deepest)
        painter.surface.blit(soil((self.size[0], self.size[1] - base), tuple(self.colours["soil"])), (0, deepest))
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
        self._hole(painter, camera)

    def _field(self, surface: pygame.Surface, eye: Eye, base: int, stripe: float, deepest: int) -> None:
        """The ground behind the line of play, from the horizon to row ``deepest``: rough, before it mown fairway."""
        larger, camera, horizon = FIELD_OVERSAMPLING, eye.camera, round(eye.level)
        width, rows = self.size[0], deepest - horizon
        line = (base - horizon) * larger  # the row where things are as large as on the line of play
        field = _far_rough(self.size, horizon, base, self.moon).subsurface((0, 0, width * larger, rows * larger))
        top, bottom = round(line * FAR), rows * larger
        middle = camera.world(eye.centre, 0)[0]

        def column(x: float, row: float) -> float:
            return (eye.centre + (x - middle) * camera.scale * row / line) * larger

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
        surface.blit(pygame.transform.smoothscale(field, (width, rows)), (0, horizon))

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

    # The hole

    def _hole(self, painter: Painter, camera: Camera) -> None:
        """The cup, and a shadow at the flagstick's foot; larger than it is where it would be too small to see."""
        if self.cup is None:
            return
        unit, (x, ground), (_, foot) = self.unit, self._foot(camera), camera.pixel(0, self.cup.bottom)
        if (self.cup.right - self.cup.left) * camera.scale <= 10 * unit:
            painter.shadow((x, ground + 3 * unit), 7 * unit, 2.5 * unit, self.colours["cup"], 0.9)
            return
        left, right = (round(camera.pixel(edge, 0)[0]) for edge in (self.cup.left, self.cup.right))
        deep, thin = round(foot - ground), max(1, round(1.6 * unit))
        painter.surface.fill(self.colours["liner"], (left, round(ground), right - left, deep))
        painter.surface.fill(self.colours["cup"], (left + thin, round(ground), right - left - 2 * thin, deep - thin))

    def _foot(self, camera: Camera) -> tuple[float, float]:
        """Where the flagstick meets the ground, in px."""
        return camera.pixel(self.pin, float(self.heights(np.array(self.pin))))

    def flag_box(self, camera: Camera) -> pygame.Rect:
        """The place that the flag takes."""
        x, ground = self._foot(camera)
        tall, cloth = min(max(FLAGSTICK * camera.scale, 66 * self.unit), 190 * self.unit), 30 * self.unit
        return pygame.Rect(round(x - cloth), round(ground - tall), round(2 * cloth), round(tall))

    def flag(self, painter: Painter, camera: Camera, t: float, wind: float) -> None:
        """The flag, larger than it is where it would be too small to see; it flutters in the wind (m/s)."""
        unit, box, (x, ground) = self.unit, self.flag_box(camera), self._foot(camera)
        if not box.colliderect(painter.surface.get_rect()):
            return
        deep = self.cup_depth * camera.scale
        foot, top = ground + (deep if deep > 10 * unit else 3 * unit if deep else 0.0), ground - box.height
        painter.shadow((x + 12 * unit, ground - unit), 16 * unit, 2.5 * unit, CARD["shadow"], 0.3)
        pole = max(2.0, 2.6 * unit)
        painter.line([(x, foot), (x, top)], pole + 1.4 * unit, CARD["shadow"], 0.3)
        painter.line([(x, foot), (x, top)], pole, self.colours["pole"])
        share = np.linspace(0, 1, 9)
        along = x + (-1 if wind < 0 else 1) * 30 * unit * share
        wave = top + np.array([1.6 * unit * s * sin(5 * s - 9 * t) for s in share])
        upper, lower = wave + 9 * unit * share, wave + (19 - 9 * share) * unit
        painter.polygon(
            [*zip(along, upper, strict=True), *zip(along[::-1], lower[::-1], strict=True)], self.colours["flag"]
        )


@lru_cache(maxsize=4)
def _far_rough(size: tuple[int, int], horizon: int, base: int, moon: bool) -> pygame.Surface:
    """Where the field is drawn, larger; the far rough is on it already, paler with distance."""
    colours = MOON if moon else GOLF
    field = blank((size[0] * FIELD_OVERSAMPLING, (size[1] - horizon) * FIELD_OVERSAMPLING))
    far = round((base - horizon) * FAR * FIELD_OVERSAMPLING)
    for row in range(far):
        field.fill(mix(colours["rough_far"], colours["rough"], row / far), (0, row, field.get_width(), 1))
    return field


@lru_cache(maxsize=4)
def _landscape(size: tuple[int, int], horizon: int, moon: bool) -> Landscape:
    """Shared by all pictures of the same shape."""
    return Landscape(size, horizon, MOON if moon else GOLF)


def _pieces(turf: list[tuple[str, Point, Point]]) -> list[tuple[str, float, float]]:
    """Kind and ends in m of each stretch of ground, from left to right; the two sides of the cup make one."""
    merged: list[tuple[str, float, float]] = []
    for a, b, name in sorted((a[0], b[0], name) for name, a, b in turf):
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
