"""The table as it stands in the room, from above: rails, cushions, pockets and cloth under a lamp. Drawn once."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from math import exp, hypot
from typing import Any

import numpy as np
import pygame

from sandbox.picture.camera import Box, Camera
from sandbox.picture.painter import blank, from_colours
from sandbox.picture.palette import Colour, mix, palette

BILLIARDS = palette("billiards")

#: Shapes are drawn so much larger and scaled down.
LARGER = 3
#: Wood beyond the cushions, at least, and what it is wider than the pockets, m.
RAIL, ROUND_POCKETS = 0.10, 0.032
#: How wide things are in m: the lip on the rails' inside, the leather round a pocket, a sight, a line on the cloth.
LIP, LEATHER, SIGHT, LINE = 0.009, 0.018, 0.010, 0.004
#: Light is computed at every so many px and smoothed between.
COARSE = 4
#: Streaks of grain on each rail.
GRAIN = 16
#: How much light is left at the table's corners and in the room's, of that in the middle.
LIGHT_AT_CORNER = 0.56
#: The cushions' shadow on the cloth: how dark, and how far it reaches in m.
SHADE, SHADE_REACH = 0.45, 0.022
#: The cloth between the jaws lies in the cushions' shadow.
THROAT = mix(BILLIARDS["cloth"], BILLIARDS["rim"], 0.5)
#: Snooker's markings (WPBSA): from the head cushion to the line, the D's radius, from the foot cushion to the black, m.
BAULK, D_RADIUS, BLACK_SPOT = 0.737, 0.292, 0.324


def rail_width(setup: Any, table: Any) -> float:
    """From the noses to the table's outer edge, in m."""
    half = 0.5 * table.length, 0.5 * table.width
    beyond = [
        max(abs(hole.center[0]) + hole.radius - half[0], abs(hole.center[1]) + hole.radius - half[1])
        for hole in setup.catches
    ]
    return max([table.cushion_width + RAIL, *(reach + ROUND_POCKETS for reach in beyond)])


def outside(setup: Any, table: Any) -> Box:
    """The table with its rails, in m."""
    rail = rail_width(setup, table)
    x, y = 0.5 * table.length + rail, 0.5 * table.width + rail
    return Box(-x, -y, x, y)


def backdrop(setup: Any, table: Any, camera: Camera, size: tuple[int, int]) -> pygame.Surface:
    """Room and table for a picture of ``size`` px. Not to be drawn on: it is shared."""
    shapes = tuple((s.name.endswith("cushion"), s.shape.a, s.shape.b, s.shape.radius) for s in setup.surfaces)
    holes = tuple((hole.center, hole.radius) for hole in setup.catches)
    noses = table.length, table.width, table.cushion_width, rail_width(setup, table)
    return _backdrop(shapes, holes, noses, table.kind, camera, size)


@lru_cache(maxsize=4)
def _backdrop(
    shapes: tuple[Any, ...],
    holes: tuple[Any, ...],
    measures: tuple[float, ...],
    kind: str,
    camera: Camera,
    size: tuple[int, int],
) -> pygame.Surface:
    return _Drawing(shapes, holes, measures, kind, camera, size).finished()


class _Drawing:
    """One table being drawn, ``LARGER`` than it will be seen."""

    def __init__(
        self, shapes: Any, holes: Any, measures: tuple[float, ...], kind: str, camera: Camera, size: tuple[int, int]
    ):
        self.noses = [(a, b) for nose, a, b, _ in shapes if nose]
        self.jaws = [(a, b, radius) for nose, a, b, radius in shapes if not nose]
        self.holes, self.kind, self.camera, self.size = holes, kind, camera, size
        length, width, self.cushion, rail = measures
        self.half = 0.5 * length, 0.5 * width
        self.outer = self.half[0] + rail, self.half[1] + rail
        self.back = self.half[0] + self.cushion, self.half[1] + self.cushion
        left, top = camera.pixel(-self.outer[0], self.outer[1])
        right, bottom = camera.pixel(self.outer[0], -self.outer[1])
        self.place = pygame.Rect(int(left) - 1, int(top) - 1, int(right - left) + 4, int(bottom - top) + 4)
        self.surface = blank((self.place.width * LARGER, self.place.height * LARGER), transparent=True)

    # World to the large surface

    def _at(self, x: float, y: float) -> tuple[float, float]:
        px, py = self.camera.pixel(x, y)
        return (px - self.place.left) * LARGER, (py - self.place.top) * LARGER

    def _px(self, metres: float) -> float:
        return metres * self.camera.scale * LARGER

    def _rect(self, half: tuple[float, float]) -> pygame.Rect:
        left, top = self._at(-half[0], half[1])
        right, bottom = self._at(*(half[0], -half[1]))
        return pygame.Rect(round(left), round(top), round(right) - round(left), round(bottom) - round(top))

    def _polygon(self, points: list[tuple[float, float]], colour: Colour) -> None:
        pygame.draw.polygon(self.surface, colour, [self._at(*point) for point in points])

    def _disc(self, centre: tuple[float, float], radius: float, colour: Colour) -> None:
        pygame.draw.circle(self.surface, colour, self._at(*centre), self._px(radius))

    def _line(self, a: tuple[float, float], b: tuple[float, float], width: float, colour: Colour) -> None:
        ax, ay = self._at(*a)
        bx, by = self._at(*b)
        half = max(self._px(width), LARGER * 1.0) / 2
        along = max(hypot(bx - ax, by - ay), 1e-9)
        nx, ny = (by - ay) / along * half, (ax - bx) / along * half
        pygame.draw.polygon(
            self.surface, colour, [(ax + nx, ay + ny), (bx + nx, by + ny), (bx - nx, by - ny), (ax - nx, ay - ny)]
        )

    # Parts

    def finished(self) -> pygame.Surface:
        self._wood()
        self._bed()
        for centre, radius in self.holes:
            self._pocket(centre, radius)
        self._cushions()
        self._sights()
        small = pygame.transform.smoothscale(self.surface, self.place.size)
        self._shade(small)
        surface = self._room()
        surface.blit(small, self.place)
        return surface

    def _wood(self) -> None:
        """Four rails with their grain, mitred, a lighter lip inside."""
        rect, corner = self._rect(self.outer), round(self._px(0.055))
        _, plain, dark = BILLIARDS["wood"]
        pygame.draw.rect(self.surface, plain, rect, border_radius=corner)
        chance = np.random.default_rng(3)
        (x, y), (back_x, back_y) = self.outer, self.back
        for side in (-1, 1):
            for _ in range(GRAIN):
                deep, *ends = self._streak(chance, back_x)
                self._grain(chance, *[(end, side * (back_y + deep)) for end in ends])
                deep, *ends = self._streak(chance, back_y)
                self._grain(chance, *[(side * (back_x + deep), end) for end in ends])
        edge = max(1, round(self._px(0.006)))
        pygame.draw.rect(self.surface, dark, rect, width=edge, border_radius=corner)
        for sx in (-1, 1):
            for sy in (-1, 1):
                self._line((sx * back_x, sy * back_y), (sx * (x - 0.02), sy * (y - 0.02)), 0.002, dark)
        lip = self._rect((back_x + LIP, back_y + LIP))
        pygame.draw.rect(self.surface, BILLIARDS["lip"], lip)

    def _streak(self, chance: np.random.Generator, half: float) -> tuple[float, float, float]:
        """A streak of the grain: how far behind the cushions, and its ends along a rail mitred at ``half``, in m."""
        deep = chance.uniform(0.05, 0.85) * (self.outer[0] - self.back[0])
        middle, length = chance.uniform(-1, 1) * half, chance.uniform(0.2, 0.8) * half
        return deep, max(middle - length, 0.02 - half - deep), min(middle + length, half + deep - 0.02)

    def _grain(self, chance: np.random.Generator, a: tuple[float, float], b: tuple[float, float]) -> None:
        lit, plain, dark = BILLIARDS["wood"]
        colour = mix(plain, dark if chance.random() < 0.6 else lit, chance.uniform(0.25, 0.6))
        self._line(a, b, chance.uniform(0.0015, 0.005), colour)

    def _bed(self) -> None:
        x, y = self.half
        self.surface.fill(THROAT, self._rect(self.back))
        self.surface.fill(BILLIARDS["cloth"], self._rect(self.half))
        line = mix(BILLIARDS["cloth"], BILLIARDS["marking"], 0.55)
        spots = [(-0.5 * x, 0.0), (0.0, 0.0), (0.5 * x, 0.0)]
        if self.kind == "snooker":
            baulk = BAULK - x
            self._line((baulk, -y), (baulk, y), LINE, line)
            turn = np.linspace(0.5 * np.pi, 1.5 * np.pi, 61)
            arc = [(baulk + D_RADIUS * np.cos(angle), D_RADIUS * np.sin(angle)) for angle in turn]
            for a, b in pairwise(arc):
                self._line(a, b, LINE, line)
            spots = [
                (baulk, -D_RADIUS),
                (baulk, 0.0),
                (baulk, D_RADIUS),
                (0.0, 0.0),
                (0.5 * x, 0.0),
                (x - BLACK_SPOT, 0.0),
            ]
        for spot in spots:
            self._disc(spot, 0.0055, line)

    def _pocket(self, centre: tuple[float, float], radius: float) -> None:
        """Leather behind the hole, cloth before it, and the hole."""
        x, y = centre
        away = (np.sign(x), np.sign(y)) if abs(x) > 1e-9 else (0.0, float(np.sign(y)))
        out = np.array(away) / hypot(*away)
        across = np.array([-out[1], out[0]])
        self._disc(centre, radius + LEATHER, BILLIARDS["liner_edge"])
        self._disc(centre, radius + 0.8 * LEATHER, BILLIARDS["liner"])
        wide = (radius + LEATHER) * 1.02
        front = [centre + across * wide, centre - across * wide]
        back = [point - out * 2.5 * radius for point in reversed(front)]
        for part, colour in ((self.back, THROAT), (self.half, BILLIARDS["cloth"])):
            self.surface.set_clip(self._rect(part))
            self._polygon([tuple(point) for point in (*front, *back)], colour)
        self.surface.set_clip(None)
        deep, edge = BILLIARDS["pocket"]
        self._disc(centre, radius, edge)
        self._disc(tuple(np.array(centre) + out * 0.10 * radius), 0.88 * radius, deep)

    def _cushions(self) -> None:
        """Each from its nose back to the wood, between its jaws; a lighter band along the nose."""
        front, behind = BILLIARDS["cushion"]
        self.surface.set_clip(self._rect(self.back))
        for a, b in self.noses:
            along = np.subtract(b, a) / hypot(b[0] - a[0], b[1] - a[1])
            out = np.array([-along[1], along[0]])
            out = out if out @ np.array(a) > 0 else -out
            ends = [self._end(np.array(a), out, -along), self._end(np.array(b), out, along)]
            for _, jaw in ends:
                if jaw is not None:
                    a_jaw, b_jaw, radius = jaw
                    self._disc(a_jaw, radius, behind)
                    self._disc(b_jaw, radius, behind)
                    self._line(a_jaw, b_jaw, 2 * radius, behind)
            outline = [tuple(a), tuple(b), *ends[1][0], *reversed(ends[0][0])]
            self._polygon(outline, behind)
            for share in (1.0, 0.75, 0.5, 0.25):  # light falls off towards the back
                band = 0.42 * self.cushion * share
                colour = mix(front, behind, share)
                self._polygon([tuple(a), tuple(b), tuple(b + out * band), tuple(a + out * band)], colour)
        self.surface.set_clip(None)

    def _end(self, nose: np.ndarray, out: np.ndarray, along: np.ndarray) -> tuple[list[tuple[float, float]], Any]:
        """The cushion's outline from the nose's end to the wood, and the jaw there (None at a closed corner)."""
        for a, b, radius in self.jaws:
            if np.hypot(*(nose + out * radius - a)) < 1e-9:
                return [a, b, tuple(np.array(b) + out * 3 * self.cushion)], (a, b, radius)
        corner = nose + (out + along) * self.cushion
        return [tuple(corner)], None

    def _sights(self) -> None:
        """Diamonds on the rails, at eighths along the table and quarters across; snooker has none."""
        if self.kind == "snooker":
            return
        (x, y), (back_x, back_y), (outer_x, outer_y) = self.half, self.back, self.outer
        long, short = 1.5 * SIGHT, 0.85 * SIGHT
        for i in range(-3, 4):
            if i or not self.holes:
                for side in (-1, 1):
                    self._sight(i / 4 * x, side * (0.55 * back_y + 0.45 * outer_y), long, short)
        for i in range(-1, 2):
            for side in (-1, 1):
                self._sight(side * (0.55 * back_x + 0.45 * outer_x), i / 2 * y, short, long)

    def _sight(self, x: float, y: float, half_wide: float, half_tall: float) -> None:
        self._polygon(
            [(x - half_wide, y), (x, y + half_tall), (x + half_wide, y), (x, y - half_tall)], BILLIARDS["sight"]
        )

    # Light

    def _room(self) -> pygame.Surface:
        """The floor, lit round the table, with the table's soft shadow on it."""
        across, up = self._coarse(pygame.Rect((0, 0), self.size))
        far = np.hypot(across / (1.35 * self.outer[0]), up / (1.5 * self.outer[1]))
        lit, dark = (np.array(colour, float) for colour in BILLIARDS["room"])
        floor = dark + (lit - dark) * np.exp(-1.1 * far**2)[:, :, None]
        beyond = np.hypot(
            np.maximum(abs(across - 0.012) - self.outer[0] + 0.05, 0),
            np.maximum(abs(up + 0.03) - self.outer[1] + 0.05, 0),
        )
        shadow = 0.75 * np.exp(-((beyond / 0.11) ** 2))[:, :, None]
        floor += (np.array(BILLIARDS["room_shadow"], float) - floor) * shadow
        return pygame.transform.smoothscale(from_colours(floor), self.size)

    def _coarse(self, rect: pygame.Rect) -> tuple[np.ndarray, np.ndarray]:
        """World coordinates in m of places in a part of the picture, ``COARSE`` px apart: light changes slowly."""
        left, top = self.camera.world(*rect.topleft)
        right, bottom = self.camera.world(*rect.bottomright)
        count = rect.width // COARSE, rect.height // COARSE
        across, up = ((np.arange(n) + 0.5) / n for n in count)
        return left + (right - left) * across[:, None], top + (bottom - top) * up[None, :]

    def _shade(self, table: pygame.Surface) -> None:
        """The lamp's light over the table, and the cushions' shadow on the cloth."""
        x, y = self.half
        across, up = self._coarse(self.place)
        far = np.hypot(across / (x * 1.12), up / (y * 1.35)) / np.hypot(1 / 1.12, 1 / 1.35)
        light = (LIGHT_AT_CORNER + (1 - LIGHT_AT_CORNER) * np.exp(-1.3 * far**2.4))[:, :, None]
        warm = np.array([1.0, 0.985, 0.955])
        light = pygame.transform.smoothscale(
            from_colours(255 * light * (warm + (1 - warm) * (1 - light))), table.get_size()
        )
        left, top = self.camera.pixel(-x, y)
        right, bottom = self.camera.pixel(x, -y)
        cloth = pygame.Rect(round(left), round(top), round(right - left), round(bottom - top)).move(
            -self.place.left, -self.place.top
        )
        shade = blank(cloth.size)
        shade.fill((255, 255, 255))
        inside = shade.get_rect()
        reach = SHADE_REACH * self.camera.scale
        for i in range(min(round(5 * reach), min(cloth.size) // 2)):
            level = round(255 * (1 - SHADE * exp(-(i + 0.5) / reach)))
            pygame.draw.rect(shade, (level, level, level), inside.inflate(-2 * i, -2 * i), 1)
        table.blit(light, (0, 0), special_flags=pygame.BLEND_RGB_MULT)
        table.blit(shade, cloth, special_flags=pygame.BLEND_RGB_MULT)
