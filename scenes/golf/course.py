"""Drawing of the golf course: field, ground, hole and ball."""

from __future__ import annotations

from math import ceil, floor, pi, sin

import numpy as np
import pygame

from sandbox.engine.setup import Segment, Setup
from sandbox.picture.ball import Look, Mark, near
from sandbox.picture.camera import Box, Camera
from sandbox.picture.depth import Eye
from sandbox.picture.painter import Painter, Point
from sandbox.picture.palette import Colour, mix, palette, scene_colours
from sandbox.picture.places import Ground, Landscape, Line, Stripes
from sandbox.picture.sheet import rows_of

CARD, COLOURS = palette("card"), scene_colours(__file__)

FLAGSTICK = 2.13  # m
#: Scale of things at the far side of the fairway, compared with the line of play.
FAR = 0.42


class Course:
    """The course, for pictures of one size."""

    def __init__(self, setup: Setup, pin: float, size: tuple[int, int], moon: bool = False):
        self.pin, self.size = pin, size
        self.colours = COLOURS["moon" if moon else "earth"]
        self.turf = self.colours["turf"]
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
        camera, width = eye.camera, self.size[0]
        low, high = camera.world(0, 0)[0], camera.world(width, 0)[0]
        outline = camera.pixels(self.between(low, high))
        deepest = min(self.size[1], max(round(eye.base), round(outline[:, 1].max())))
        ground = self._ground(eye, stripe)
        Landscape(**self.colours["landscape"]).draw(painter.surface, ground.foot(eye), moved)
        ground.draw(painter, eye, deepest)
        if outline[:, 1].min() < deepest - 1:
            under = np.add(outline, (0, self._turf_depth / 2))  # so that its rough edge is hidden
            pygame.draw.polygon(painter.surface, self.turf["soil"][0], [*under, (width, deepest), (0, deepest)])
        light = self._light(camera, stripe)
        for name, a, b in self.pieces:
            left, right = max(a, low), min(b, high)
            if left >= right:
                continue
            self._turf(painter, camera, left, right, self.turf[name])
            if name == "fairway":
                for i in range(floor(left / stripe), ceil(right / stripe)):
                    if i % 2:
                        band = max(left, i * stripe), min(right, (i + 1) * stripe)
                        self._turf(painter, camera, *band, light)
            elif name in ("bunker", "water"):
                self._hollow(painter, camera, a, b, self.turf[name])
        self._hole(painter, camera)

    def _ground(self, eye: Eye, stripe: float) -> Ground:
        """The field behind the line of play: rough along the horizon, in front of it fairway, green and bunkers."""
        far, near = eye.depth(FAR), eye.depth(2.0)
        low, high = eye.along(0, far), eye.along(self.size[0], far)
        areas: list[tuple[Line, Colour]] = []
        for name, a, b in self.pieces:
            if name in ("rough", "tee"):
                left, right = max(a, low), min(b, high)
                areas.append(([(left, near), (right, near), (right, far), (left, far)], self.turf[name]))
            elif name != "fairway":
                deep = min(0.5, max(0.16 * (b - a) * eye.camera.scale, 8.0 * self.unit) / (eye.base - eye.level))
                turn = np.linspace(0.0, pi, 41)
                x, z = (a + b) / 2 + np.cos(turn) * (b - a) / 2, np.sin(turn) * eye.depth(1 - deep)
                areas.append(([(b, near), *zip(x, z, strict=True), (a, near)], self.turf[name]))
        stripes = Stripes((self.turf["fairway"], self._light(eye.camera, stripe)), stripe)
        beyond = self.turf["rough_far"], self.turf["rough"]
        return Ground(stripes, self.turf["soil"], areas=areas, far=FAR, beyond=beyond)

    def _light(self, camera: Camera, stripe: float) -> Colour:
        """The colour of the lighter stripes; it fades to the darker one where stripes are too narrow to see."""
        fade = min(1.0, max(0.0, stripe * camera.scale / (12 * self.unit) - 0.5))
        return mix(self.turf["fairway"], self.turf["fairway_stripe"], fade)

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
        """Sand or water in a shallow hollow."""
        outline = camera.pixels(self.between(a, b))
        (left, top), (right, end) = outline[0], outline[-1]
        deep = min(16 * self.unit, 0.2 * (right - left))
        turn = np.linspace(0, pi, 25)
        x, y = (left + right) / 2 + np.cos(turn) * (right - left) / 2, np.sin(turn) ** 0.7 * deep
        painter.polygon([*outline, *zip(x, y + np.interp(x, [left, right], [top, end]), strict=True)], colour)

    # The hole

    def _hole(self, painter: Painter, camera: Camera) -> None:
        """The cup, and a shadow at the flagstick's foot; enlarged if it would be too small to see."""
        if self.cup is None:
            return
        unit, (x, ground), (_, foot) = self.unit, self._foot(camera), camera.pixel(0, self.cup.bottom)
        if (self.cup.right - self.cup.left) * camera.scale <= 10 * unit:
            painter.shadow((x, ground + 3 * unit), 7 * unit, 2.5 * unit, COLOURS["hole"]["cup"], 0.9)
            return
        left, right = (round(camera.pixel(edge, 0)[0]) for edge in (self.cup.left, self.cup.right))
        deep, thin = round(foot - ground), max(1, round(1.6 * unit))
        painter.surface.fill(COLOURS["hole"]["liner"], (left, round(ground), right - left, deep))
        painter.surface.fill(COLOURS["hole"]["cup"], (left + thin, round(ground), right - left - 2 * thin, deep - thin))

    def _foot(self, camera: Camera) -> tuple[float, float]:
        """Where the flagstick meets the ground, in px."""
        return camera.pixel(self.pin, float(self.heights(np.array(self.pin))))

    def flag_box(self, camera: Camera) -> pygame.Rect:
        """The place that the flag takes."""
        x, ground = self._foot(camera)
        tall, cloth = min(max(FLAGSTICK * camera.scale, 66 * self.unit), 190 * self.unit), 30 * self.unit
        return pygame.Rect(round(x - cloth), round(ground - tall), round(2 * cloth), round(tall))

    def flag(self, painter: Painter, camera: Camera, t: float, wind: float) -> None:
        """The flag, enlarged if it would be too small to see; it flutters in the wind (m/s)."""
        unit, box, (x, ground) = self.unit, self.flag_box(camera), self._foot(camera)
        if not box.colliderect(painter.surface.get_rect()):
            return
        deep = self.cup_depth * camera.scale
        foot, top = ground + (deep if deep > 10 * unit else 3 * unit if deep else 0.0), ground - box.height
        painter.shadow((x + 12 * unit, ground - unit), 16 * unit, 2.5 * unit, CARD["shadow"], 0.3)
        pole = max(2.0, 2.6 * unit)
        painter.line([(x, foot), (x, top)], pole + 1.4 * unit, CARD["shadow"], 0.3)
        painter.line([(x, foot), (x, top)], pole, COLOURS["hole"]["pole"])
        share = np.linspace(0, 1, 9)
        along = x + (-1 if wind < 0 else 1) * 30 * unit * share
        wave = top + np.array([1.6 * unit * s * sin(5 * s - 9 * t) for s in share])
        upper, lower = wave + 9 * unit * share, wave + (19 - 9 * share) * unit
        painter.polygon(
            [*zip(along, upper, strict=True), *zip(along[::-1], lower[::-1], strict=True)], COLOURS["hole"]["flag"]
        )


def _pieces(turf: list[tuple[str, Point, Point]]) -> list[tuple[str, float, float]]:
    """Kind and ends in m of each stretch of ground, from left to right; the two sides of the cup are joined."""
    merged: list[tuple[str, float, float]] = []
    for a, b, name in sorted((a[0], b[0], name) for name, a, b in turf):
        start = merged.pop()[1] if merged and merged[-1][0] == name else a
        merged.append((name, start, b))
    return merged


def _dimples(at: np.ndarray) -> np.ndarray:
    """A spiral of them, evenly spread (Fibonacci)."""
    z, turn = np.linspace(-1, 1, 240), np.arange(240) * pi * (3 - 5**0.5)
    wide = np.sqrt(1 - z**2)
    return near(np.column_stack([wide * np.cos(turn), wide * np.sin(turn), z]), 0.07)(at)


def _stripe(at: np.ndarray) -> np.ndarray:
    """The line that players draw around half of it."""
    return ((abs(at[..., 1]) < 0.13) & (at[..., 2] > 0.0) & (abs(at[..., 0]) < 0.7)).astype(float)


BALL = Look(
    COLOURS["ball"]["colour"],
    Mark(COLOURS["ball"]["mark"], _stripe, least=6),
    Mark(COLOURS["ball"]["dimple"], _dimples, least=12),
)
