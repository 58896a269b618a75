"""The hall as it is drawn: wall and stands, floor with its lines, board, ring and net."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, lru_cache
from itertools import pairwise
from math import asin, ceil, cos, floor, pi, sin, tau
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import Look, seams
from sandbox.picture.camera import Camera
from sandbox.picture.depth import Eye
from sandbox.picture.painter import Painter, blank, from_colours
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.sheet import rows_of

from .scene import board, rims

COURT, CARD = palette("basketball"), palette("card")

BALL = Look(COURT["ball"], COURT["ball_shade"], seams(COURT["seam"]))

#: How much smaller things look at the wall than in the plane of play.
FAR = 0.44
#: The eye is so many px (on 720 rows) above the floor, and as far from the plane of play as the picture is wide.
LEVEL = 128
#: It looks at this share of the picture's width: from the thrower's side, so that it sees the board's face.
ASIDE = 0.25
#: The court of the NBA, in m: key, free-throw circle, three-point line, from the middle to the side line.
KEY_LENGTH, KEY_HALF_WIDTH, CIRCLE = 4.572, 2.438, 1.829
ARC, CORNER, HALF_WIDTH = 7.24, 6.71, 7.62
#: The end line is so far behind the face of the board; lines are so wide.
END_LINE, LINE = 1.22, 0.05
LENGTH = 28.65
ROWS_OF_PEOPLE = 8
#: The floor's boards differ little, so a lower factor than for other shapes will do.
FLOOR_OVERSAMPLING = 2
#: Width of the board, and size and height of the square on it, in m.
BOARD_WIDTH, SQUARE_WIDTH, SQUARE_HEIGHT = 1.83, 0.61, 0.46
#: Board, ring and stand are drawn larger where they would be less tall than this, px on 720 rows.
LEAST_HEIGHT = 80


class Hall:
    """The place of play, for pictures on which the floor is ``base`` px from the top."""

    def __init__(self, parameters: Any, size: tuple[int, int], base: int):
        self.parameters, self.size, self.base = parameters, size, base
        self.unit = rows_of(size) / 720
        self.level = base - LEVEL * self.unit
        self.foot = round(self.level + LEVEL * self.unit * FAR)  # where the wall meets the floor
        self.hoop = parameters.hoop.distance, parameters.hoop.height
        self.face, self.bottom, self.back, self.top = board(parameters)

    def eye(self, camera: Camera) -> Eye:
        """Sees the hall in central perspective, the plane of play as the camera shows it."""
        return Eye(camera, ASIDE * self.size[0], self.level, self.size[0] / camera.scale)

    # What stands still

    def draw(self, painter: Painter, eye: Eye, moved: float = 0.0) -> None:
        """Wall, floor, and what lies under it, as seen by an eye that has moved ``moved`` px to the right."""
        surface, width = painter.surface, self.size[0]
        surface.blit(_wall(self.size, self.foot), (0, 0))
        left = -(round(moved * FAR) % width)
        for x in (left, left + width):
            surface.blit(_crowd(self.size, self.foot), (x, 0))
        surface.blit(self._floor(eye), (0, self.foot))
        surface.blit(_ground((self.size[0], self.size[1] - self.base)), (0, self.base))
        surface.fill(COURT["edge"][1], (0, self.base, self.size[0], max(3, round(7 * self.unit))))
        surface.fill(COURT["edge"][0], (0, self.base, self.size[0], max(1, round(2 * self.unit))))

    def _floor(self, eye: Eye) -> pygame.Surface:
        """The floor behind the plane of play: boards, each in a tone of its own, and on them what lines there are."""
        larger, width, rows = FLOOR_OVERSAMPLING, self.size[0], self.base - self.foot
        drawn = self._floor_drawn
        self._boards(drawn, eye)
        end, throw = self.face + END_LINE, self.face - KEY_LENGTH
        key = [(throw, 0.0), (end, 0.0), (end, KEY_HALF_WIDTH), (throw, KEY_HALF_WIDTH)]
        circle = [(throw + CIRCLE * cos(turn), CIRCLE * sin(turn)) for turn in np.linspace(pi / 2, pi, 25)]
        turns = np.linspace(pi, pi - asin(CORNER / ARC), 40)
        arc = [(self.hoop[0] + ARC * cos(turn), ARC * sin(turn)) for turn in turns]
        side = [(end, 0.0), (end, HALF_WIDTH), (end - LENGTH, HALF_WIDTH)]
        pygame.draw.polygon(drawn, COURT["key"], self._on_floor(eye, key))
        for line in ([key[0], *key[:1:-1]], circle, [*arc, (end, CORNER)], side):
            share = sum(eye.share(z) for _, z in line) / len(line)
            thick = max(1.1 * self.unit, 0.5 * LINE * eye.camera.scale * share) * larger
            pygame.draw.lines(drawn, COURT["line"], False, self._on_floor(eye, line), max(2, round(thick)))
        return pygame.transform.smoothscale(drawn, (width, rows))

    @cached_property
    def _floor_drawn(self) -> pygame.Surface:
        """Where the floor is drawn, larger: new memory is slow."""
        return blank((self.size[0] * FLOOR_OVERSAMPLING, (self.base - self.foot) * FLOOR_OVERSAMPLING))

    def _on_floor(self, eye: Eye, points: list[tuple[float, float]]) -> np.ndarray:
        """Points (x, z) of the floor in m as points of the floor as it is drawn, in px."""
        seen = eye.points(np.array([(x, 0.0, z) for x, z in points]))
        return (seen - (0, self.foot)) * FLOOR_OVERSAMPLING

    def _boards(self, drawn: pygame.Surface, eye: Eye) -> None:
        """Boards that run along the court, so low on the picture that their slanting ends may stand upright."""
        width, larger = self.size[0], FLOOR_OVERSAMPLING
        plank, length = eye.distance * 0.04, eye.distance * 0.30
        far, near = COURT["floor"]
        for i in range(ceil(eye.depth(FAR) / plank)):
            shares = eye.share(i * plank), eye.share((i + 1) * plank)
            low, top = (round((self.level - self.foot + LEVEL * self.unit * share) * larger) for share in shares)
            middle, shift = sum(shares) / 2, i * 0.618 % 1
            colour = mix(far, near, (middle - FAR) / (1 - FAR))
            ends = (eye.camera.world(eye.centre + (px - eye.centre) / middle, 0)[0] for px in (0, width))
            first, last = (floor(end / length - shift) for end in ends)
            edges = [(eye.point((j + shift) * length, 0.0)[0], j) for j in range(first, last + 2)]
            for (a, j), (b, _) in pairwise(edges):
                left, right = (round((eye.centre + (px - eye.centre) * middle) * larger) for px in (a, b))
                tone = (i * 0.7549 + j * 0.5698) % 1
                drawn.fill(mix(colour, COURT["board"], tone), (left, top, right - left, low - top))

    def stand(self, painter: Painter, eye: Eye) -> None:
        """What carries the board."""
        scale = eye.camera.scale
        lit, shaded = COURT["stand"]
        foot, head = self.back + 1.45, self.back + 0.95  # m, the mast leans towards the ring
        height = self.top - self.bottom
        top = self.bottom + 0.30 * height

        def line(a: tuple[float, float], b: tuple[float, float], width: float, colour: Colour) -> None:
            painter.line([eye.point(*a), eye.point(*b)], width * scale, colour)

        painter.shadow(eye.point(foot + 0.1, 0.0), 0.9 * scale, 0.07 * scale, CARD["shadow"], 0.4)
        line((foot + 0.75, 0.25), (head + 0.02, top), 0.08, shaded)
        for share in (0.15, 0.55):
            line((self.back, self.bottom + share * height), (head, top - 0.06), 0.06, lit)
        line((foot, 0.2), (head, top), 0.16, lit)
        sides = ((-0.62, 0.0), (-0.55, 0.36), (0.95, 0.36), (0.95, 0.0))
        painter.polygon([eye.point(foot + x, y) for x, y in sides], lit)

    def board(self, painter: Painter, eye: Eye) -> None:
        """The glass board with its square, and the far half of the ring: what is behind the ball."""
        thin = max(1.2 * self.unit, 0.022 * eye.camera.scale)
        half = BOARD_WIDTH / 2
        glass = self._on_board(eye, self.bottom, self.top, half)
        painter.polygon(glass, COURT["glass"], 0.30)
        low = max(self.bottom, self.hoop[1])
        square = self._on_board(eye, low, max(low, min(self.top, low + SQUARE_HEIGHT)), SQUARE_WIDTH / 2)
        for corners in (glass, square):
            painter.lines([[*corners, *corners[:2]]], thin, COURT["glass_edge"], 0.92)
        colour = mix(COURT["ring"], CARD["shadow"], 0.35)
        back = rims(self.parameters)[1]
        painter.line([eye.point(*back), eye.point(self.face, back[1])], 0.9 * self._tube(eye), colour)
        painter.line(self._ring(eye, 0.0, pi), self._tube(eye), colour)

    def _on_board(self, eye: Eye, bottom: float, top: float, half: float) -> np.ndarray:
        """Corners in px of a rectangle on the board's face, ``half`` m to either side of the plane of play."""
        corners = ((bottom, -half), (bottom, half), (top, half), (top, -half))
        return eye.points(np.array([(self.face, y, z) for y, z in corners]))

    def _tube(self, eye: Eye) -> float:
        """Width of the ring's tube in px."""
        return max(2.4 * self.unit, 2 * self.parameters.hoop.tube_radius * eye.camera.scale)

    def _ring(self, eye: Eye, start: float, end: float) -> np.ndarray:
        """A part of the ring in px, from one angle to another; from 0 to pi it lies behind the plane of play."""
        turn = np.linspace(start, end, 33)
        radius = self.ring_radius
        ring = [self.hoop[0] + radius * np.cos(turn), np.full(33, self.hoop[1]), radius * np.sin(turn)]
        return eye.points(np.column_stack(ring))

    @property
    def ring_radius(self) -> float:
        """From the ring's middle to the middle of its tube, in m."""
        (front, _), (back, _) = rims(self.parameters)
        return (back - front) / 2

    def near_ring(self, painter: Painter, eye: Eye) -> None:
        """The near half of the ring, which is before the ball."""
        painter.line(self._ring(eye, pi, tau), self._tube(eye), COURT["ring"])

    def hoop_eye(self, eye: Eye) -> Eye:
        """Sees board, ring and stand in their place, larger where they would be too small to see."""
        factor = self.enlarged(eye.camera)
        if factor == 1.0:
            return eye
        foot = self.hoop[0], 0.0
        return replace(eye, camera=Camera(foot, eye.camera.pixel(*foot), eye.camera.scale * factor))

    def enlarged(self, camera: Camera) -> float:
        """How many times their size board, ring and stand are drawn."""
        return max(1.0, LEAST_HEIGHT * self.unit / (max(self.hoop[1], self.top) * camera.scale))


@lru_cache(maxsize=4)
def _wall(size: tuple[int, int], foot: int) -> pygame.Surface:
    """The wall down to row ``foot``, lit from above on the right."""
    width = size[0]
    top, low = (np.array(colour, float) for colour in COURT["wall"])
    wall = np.broadcast_to(top + (low - top) * np.linspace(0, 1, foot)[None, :, None] ** 1.2, (width, foot, 3))
    across = (np.arange(width)[:, None] - 0.62 * width) / (0.42 * width)
    down = (np.arange(foot)[None, :] - 0.30 * foot) / (0.75 * foot)
    glow = np.exp(-(across**2) - down**2)[:, :, None] * 0.55
    return from_colours(wall + (np.array(COURT["light"], float) - wall) * glow)


@lru_cache(maxsize=4)
def _crowd(size: tuple[int, int], foot: int) -> pygame.Surface:
    """Rows of people who watch, the less told from the wall the farther they are, and boards before them.

    As wide as the picture, down to row ``foot``; the ends join.
    """
    width, unit = size[0], rows_of(size) / 720
    crowd = blank((width, foot), transparent=True)
    painter, random = Painter(crowd), np.random.default_rng(3)
    tall, apart = round(50 * unit), 24 * unit
    count = round(width / apart)
    for i in reversed(range(ROWS_OF_PEOPLE)):
        share = i / (ROWS_OF_PEOPLE - 1)
        row = foot - tall - (i + 1) * 27 * unit
        opacity = 0.8 * (1 - share) ** 1.1
        for seat in range(count):
            if random.uniform() > 0.9 - 0.25 * share:
                continue
            colour = COURT["crowd"][random.integers(len(COURT["crowd"]))]
            aside, up = random.uniform(-3, 3, 2) * unit
            x, y = (seat + i % 2 / 2) * width / count + aside, row + 0.7 * up
            for turn in (-width, 0, width):
                painter.disc((x + turn, y), 5.8 * unit, colour, opacity)
                painter.shadow((x + turn, y + 16 * unit), 9 * unit, 9.5 * unit, colour, opacity)
        crowd.fill((*CARD["shadow"], round(40 * opacity)), (0, round(row + 22 * unit), width, max(1, round(unit))))
    thin = max(1, round(2 * unit))
    crowd.fill(COURT["padding"], (0, foot - tall, width, tall))
    crowd.fill(mix(COURT["padding"], (255, 255, 255), 0.14), (0, foot - tall, width, thin))
    for x in np.linspace(0, width, 12)[:-1]:
        crowd.fill(mix(COURT["padding"], CARD["shadow"], 0.16), (round(x), foot - tall, max(1, thin // 2), tall))
    return crowd


@lru_cache(maxsize=4)
def _ground(size: tuple[int, int]) -> pygame.Surface:
    """What lies under the floor, darker with depth."""
    top, middle, low = (np.array(colour, float) for colour in COURT["ground"])
    share = np.linspace(0, 2, size[1])[:, None]
    column = np.where(share < 1, top + (middle - top) * share, middle + (low - middle) * (share - 1))
    return from_colours(np.broadcast_to(column, (*size, 3)))
