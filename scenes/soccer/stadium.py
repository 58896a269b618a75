"""The stadium as it is drawn: evening sky, stands, the pitch with its lines, goal, wall of players."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, lru_cache
from itertools import pairwise
from math import asin, ceil, floor, pi
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import Look, patches
from sandbox.picture.camera import Camera
from sandbox.picture.depth import Eye
from sandbox.picture.figures import KICKING, STANDING, draw_figure
from sandbox.picture.painter import Painter, blank, from_colours
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.sheet import Sheet, rows_of

GROUND, CARD = palette("soccer"), palette("card")

BALL = Look(GROUND["ball"], GROUND["ball_shade"], patches(GROUND["patch"], GROUND["ball_seam"]))

#: How much smaller things look at the boards on the far side of the pitch than in the plane of play.
FAR = 0.38
#: The eye is so many px (on 720 rows) above the ground, and looks at this share of the picture's width.
LEVEL, ASIDE = 152, 0.2
#: The pitch differs little from stripe to stripe, so a lower factor than for other shapes will do.
PITCH_OVERSAMPLING = 2
#: Stripes as wide as the goal area is deep, lines, and what they bound (Laws of the Game, law 1), in m.
STRIPE, LINE = 5.5, 0.12
GOAL_WIDTH, GOAL_AREA, PENALTY_AREA, SPOT, CIRCLE = 7.32, (5.5, 18.32), (16.5, 40.32), 11.0, 9.15
PITCH_LENGTH, PITCH_WIDTH = 105.0, 68.0
#: Players of the wall stand so far behind one another, in m; they are this tall unless they jump or the wall is low.
PLAYERS, ABREAST, TALL, LEAST_TALL = 4, 0.62, 1.88, 1.55
#: Goal and players are drawn larger where a goal would be less tall than this, px on 720 rows.
LEAST_HEIGHT = 22
#: The net's mesh in m, and the least in px on 720 rows.
MESH, LEAST_MESH = 0.12, 5.0


class Stadium:
    """The place of play, for pictures on which the ground is ``base`` px from the top."""

    def __init__(self, parameters: Any, size: tuple[int, int], base: int):
        self.goal, self.wall = parameters.goal, parameters.wall
        self.size, self.base = size, base
        self.unit = rows_of(size) / 720
        self.level = base - LEVEL * self.unit
        self.foot = round(self.level + LEVEL * self.unit * FAR)  # where the boards stand on the ground
        self.boards = [surface.shape for surface in _boards(parameters)]

    def eye(self, camera: Camera) -> Eye:
        """Sees the stadium in central perspective, the plane of play as the camera shows it."""
        return Eye(camera, ASIDE * self.size[0], self.level, self.size[0] / camera.scale)

    def enlarged(self, camera: Camera) -> float:
        """How many times their size goal and players are drawn."""
        return max(1.0, LEAST_HEIGHT * self.unit / (2.44 * camera.scale))

    def near(self, eye: Eye, x: float) -> Eye:
        """Sees what stands at x (m) in its place, larger where it would be too small to see."""
        factor = self.enlarged(eye.camera)
        if factor == 1.0:
            return eye
        return replace(eye, camera=Camera((x, 0.0), eye.camera.pixel(x, 0.0), eye.camera.scale * factor))

    def behind(self, painter: Painter, eye: Eye) -> None:
        """What stands on the pitch behind the ball."""
        self._hoardings(painter, eye)
        self._goal_behind(painter, eye)
        self._players(painter, eye)
        self._kicker(painter, eye)

    def before(self, painter: Painter, eye: Eye) -> None:
        """What stands before the ball: of the goal, the near side of the net, the near post."""
        if not self.goal.present:
            return
        eye = self.near(eye, self.goal.distance)
        front, back, high = self.goal.distance, self.goal.distance + self.goal.depth, self._bar
        net = [[(front, y, 0.0), (back, y, 0.0)] for y in self._mesh(eye, high)]
        net += [[(x, 0.0, 0.0), (x, high, 0.0)] for x in self._mesh(eye, back - front) + front]
        self._draw_net(painter, eye, net, 0.42)
        self._post(painter, eye, [(front, high, 0.0), (front, 0.0, 0.0)], GROUND["post"], 1.0)

    # The ground

    def draw(self, painter: Painter, eye: Eye, moved: float = 0.0) -> None:
        """Sky, stands, pitch and soil, as seen by an eye that has moved ``moved`` px to the right."""
        surface, width = painter.surface, self.size[0]
        surface.blit(_sky(self.size, self.foot), (0, 0))
        left = -(round(moved * 0.25) % width)
        for x in (left, left + width):
            surface.blit(_stands(self.size, self.foot), (x, 0))
        surface.blit(self._pitch(eye), (0, self.foot))
        surface.blit(_soil((width, self.size[1] - self.base)), (0, self.base))
        surface.fill(GROUND["edge"], (0, self.base, width, max(3, round(6 * self.unit))))

    def _pitch(self, eye: Eye) -> pygame.Surface:
        """The pitch behind the plane of play: mown stripes and lines."""
        width, rows = self.size[0], self.base - self.foot
        drawn = self._pitch_drawn
        stripe = STRIPE * max(1.0, 2.0 ** ceil(np.log2(12 * self.unit / (STRIPE * eye.camera.scale))))
        deepest = eye.depth(FAR)
        low, high = (eye.camera.world(eye.centre + (px - eye.centre) / FAR, 0)[0] for px in (0, width))
        line = self.goal.distance
        drawn.fill(GROUND["grass"][0])
        for i in range(floor((low - line) / stripe), ceil((high - line) / stripe)):
            if i % 2:
                a, b = line + i * stripe, line + (i + 1) * stripe
                corners = [(a, 0.0), (b, 0.0), (b, deepest), (a, deepest)]
                pygame.draw.polygon(drawn, GROUND["grass"][1], self._on_pitch(eye, corners))
        self._lines(drawn, eye)
        drawn.blit(self._haze, (0, 0))
        return pygame.transform.smoothscale(drawn, (width, rows))

    @cached_property
    def _pitch_drawn(self) -> pygame.Surface:
        """Where the pitch is drawn, larger: new memory is slow."""
        return blank((self.size[0] * PITCH_OVERSAMPLING, (self.base - self.foot) * PITCH_OVERSAMPLING))

    @cached_property
    def _haze(self) -> pygame.Surface:
        """What the pitch fades into with distance, as it is drawn."""
        width, rows = self._pitch_drawn.get_size()
        fade = np.linspace(150, 0, round(0.8 * rows)).astype(int)
        haze = blank((1, len(fade)), transparent=True)
        for row, opacity in enumerate(fade):
            haze.set_at((0, row), (*GROUND["grass_far"], int(opacity)))
        return pygame.transform.scale(haze, (width, len(fade)))

    def _lines(self, drawn: pygame.Surface, eye: Eye) -> None:
        """All lines of the pitch that lie behind the plane of play, which passes by the goal's near post."""
        end, middle = self.goal.distance, GOAL_WIDTH / 2
        far, start = middle + PITCH_WIDTH / 2, end - PITCH_LENGTH
        turn = asin((PENALTY_AREA[0] - SPOT) / CIRCLE)
        arc = [
            (end - SPOT - CIRCLE * np.cos(a), middle + CIRCLE * np.sin(a))
            for a in np.linspace(-(pi / 2 - turn), pi / 2 - turn, 40)
        ]
        half = (start + end) / 2
        circle = [(half + CIRCLE * np.cos(a), middle + CIRCLE * np.sin(a)) for a in np.linspace(0, 2 * pi, 60)]
        lines = [[(end, 0.0), (end, far), (start, far), (start, 0.0)], arc, circle, [(half, 0.0), (half, far)]]
        for deep, wide in (GOAL_AREA, PENALTY_AREA):
            for goal, way in ((end, -1), (start, 1)):
                lines.append(
                    [(goal + way * deep, 0.0), (goal + way * deep, middle + wide / 2), (goal, middle + wide / 2)]
                )
        for line in lines:
            self._line(drawn, eye, [(x, z) for x, z in line if z >= -0.01])

    def _line(self, drawn: pygame.Surface, eye: Eye, points: list[tuple[float, float]]) -> None:
        """A line on the grass, as wide as it is at its nearest."""
        scale = eye.camera.scale * PITCH_OVERSAMPLING
        for a, b in pairwise(points):
            share = eye.share(min(a[1], b[1]))
            along = abs(b[0] - a[0]) > abs(b[1] - a[1])
            thick = LINE * scale * share * (0.3 if along else 0.6)
            pygame.draw.lines(drawn, GROUND["line"], False, self._on_pitch(eye, [a, b]), max(2, round(thick)))

    def _on_pitch(self, eye: Eye, points: list[tuple[float, float]]) -> np.ndarray:
        """Points (x, z) of the ground in m as points of the pitch as it is drawn, in px."""
        seen = eye.points(np.array([(x, 0.0, z) for x, z in points]))
        return (seen - (0, self.foot)) * PITCH_OVERSAMPLING

    # Goal and players

    def _goal_behind(self, painter: Painter, eye: Eye) -> None:
        """Of the goal, what is behind the ball: roof, back and far side of the net, far post."""
        if not self.goal.present:
            return
        eye = self.near(eye, self.goal.distance)
        front, back, high = self.goal.distance, self.goal.distance + self.goal.depth, self._bar
        far = GOAL_WIDTH + 2 * self.goal.post_radius
        across, up, along = (self._mesh(eye, span) for span in (far, high, back - front))
        net = [[(back, y, 0.0), (back, y, far)] for y in up]
        net += [[(back, 0.0, z), (back, high, z), (front, high, z)] for z in across]
        net += [[(x, high, 0.0), (x, high, far)] for x in along + front]
        net += [[(front, y, far), (back, y, far)] for y in up]
        net += [[(x, 0.0, far), (x, high, far)] for x in along + front]
        self._draw_net(painter, eye, net, 0.20)
        frame = [(front, 0.0, far), (front, high, far)]
        self._post(painter, eye, frame, GROUND["post_shade"], eye.share(far))
        self._post(painter, eye, [(front, high, far), (front, high, 0.0)], GROUND["post_shade"], eye.share(far / 2))

    @property
    def _bar(self) -> float:
        """Height of the bar's middle in m."""
        return self.goal.height + self.goal.post_radius

    def _mesh(self, eye: Eye, span: float) -> np.ndarray:
        """Where the threads of the net are over a span in m."""
        mesh = max(MESH, LEAST_MESH * self.unit / eye.camera.scale)
        return np.linspace(0.0, span, max(2, round(span / mesh) + 1))

    def _draw_net(self, painter: Painter, eye: Eye, net: list[Any], opacity: float) -> None:
        ends = np.cumsum([len(thread) for thread in net])
        lines = np.split(eye.points(np.concatenate(net)), ends[:-1])
        painter.lines(lines, max(0.6, 0.8 * self.unit), GROUND["net"], opacity)

    def _post(self, painter: Painter, eye: Eye, ends: list[Any], colour: Colour, share: float) -> None:
        width = max(1.8 * self.unit, 2 * self.goal.post_radius * eye.camera.scale * share)
        painter.line(eye.points(np.array(ends)), width, colour)

    def _players(self, painter: Painter, eye: Eye) -> None:
        """The wall of players, the nearest in the plane of play."""
        if not self.wall.present:
            return
        eye = self.near(eye, self.wall.distance)
        height = self.wall.height
        tall = height if not LEAST_TALL <= height <= 2.6 else min(height, TALL)
        rows = max(1, round(self.wall.thickness / 0.5))
        colours = _kit(0)
        for i in reversed(range(PLAYERS)):
            z = i * ABREAST
            share = eye.share(z)
            dimmed = {part: mix(colour, GROUND["stands"][2], 0.12 * i) for part, colour in colours.items()}
            for row in range(rows):
                x = self.wall.distance + (row - (rows - 1) / 2) * 0.5
                foot = eye.point(x, height - tall, z)
                ground = eye.point(x, 0.0, z)
                wide = 0.30 * eye.camera.scale * share
                painter.shadow((ground[0], ground[1]), 1.2 * wide, 0.3 * wide, CARD["shadow"], 0.35)
                draw_figure(painter, foot, tall * eye.camera.scale * share, STANDING, dimmed, facing=-1)

    def _kicker(self, painter: Painter, eye: Eye) -> None:
        """The player who kicked, a little behind the place of the ball."""
        eye = self.near(eye, 0.0)
        foot = eye.point(-0.62, 0.0)
        scale = eye.camera.scale
        painter.shadow(foot, 0.42 * scale, 0.10 * scale, CARD["shadow"], 0.4)
        draw_figure(painter, foot, 1.82 * scale, KICKING, _kit(1))

    def _hoardings(self, painter: Painter, eye: Eye) -> None:
        """The advertising boards behind the ball and beyond the goal, where a ball is out of play."""
        for board in self.boards:
            (x, _), (_, top) = board.a, board.b
            edges = np.linspace(0.0, eye.depth(FAR), 9)
            for i in reversed(range(8)):
                z0, z1 = edges[i], edges[i + 1]
                corners = np.array([(x, 0.0, z0), (x, 0.0, z1), (x, top, z1), (x, top, z0)])
                seen = eye.points(corners)
                if seen[:, 0].max() > 0 and seen[:, 0].min() < self.size[0]:
                    painter.polygon(seen, mix(GROUND["boards"][i * 3 % 4], GROUND["grass_far"], 0.25))


def _boards(parameters: Any) -> list[Any]:
    from .scene import build

    return [surface for surface in build(parameters).surfaces if surface.name == "boards"]


def _kit(team: int) -> dict[str, Colour]:
    return {
        "body": GROUND["skin"],
        "far": GROUND["skin_far"],
        "shirt": GROUND["shirts"][team],
        "shorts": GROUND["shorts"][team],
    }


@lru_cache(maxsize=4)
def _sky(size: tuple[int, int], foot: int) -> pygame.Surface:
    """The evening sky down to row ``foot``."""
    width, unit = size[0], rows_of(size) / 720
    top, middle, low = (np.array(colour, float) for colour in GROUND["sky"])
    share = np.clip(np.arange(foot) / (foot - 90 * unit), 0, 1)[None, :, None]
    turn = 0.62
    upper = top + (middle - top) * np.clip(share / turn, 0, 1) ** 1.3
    sky = upper + (low - upper) * (np.clip((share - turn) / (1 - turn), 0, 1) ** 1.3)
    across = (np.arange(width)[:, None] - 0.70 * width) / (0.30 * width)
    down = (np.arange(foot)[None, :] - (foot - 120 * unit)) / (120 * unit)
    glow = np.exp(-(across**2) - down**2)[:, :, None] * 0.6
    sky = np.broadcast_to(sky, (width, foot, 3))
    return from_colours(sky + (np.array(GROUND["glow"], float) - sky) * glow)


@lru_cache(maxsize=4)
def _stands(size: tuple[int, int], foot: int) -> pygame.Surface:
    """Stands with their roof, people, lamps on masts, boards along the pitch: as wide as the picture, the ends join."""
    width, unit = size[0], rows_of(size) / 720
    stands = blank((width, foot), transparent=True)
    painter, random = Painter(stands), np.random.default_rng(11)
    roof, upper, lower = GROUND["stands"]
    boards, top = round(17 * unit), foot - round(124 * unit)
    sheet = Sheet(size)
    text = sheet.top_row - sheet.gap
    head = min(max(top - 74 * unit, text + 20 * unit), top - 30 * unit)  # lamps under the headline
    for x in np.array([0.14, 0.47, 0.80]) * width if text < head - 13 * unit else ():
        _mast(painter, (x, top), head, unit)
    stands.fill(upper, (0, top, width, foot - top))
    _roof(painter, top, width, unit)
    for i in range(9):
        row = top + (24 + i * 9.2) * unit
        share = i / 8
        if i == 4:
            stands.fill(lower, (0, round(row - 4 * unit), width, foot - round(row - 4 * unit)))
            stands.fill(roof, (0, round(row - 5 * unit), width, max(1, round(3 * unit))))
            continue
        seats = round(width / (9 * unit))
        for seat in range(seats):
            if random.uniform() < 0.82:
                colour = mix(GROUND["crowd"][random.integers(4)], lower, 0.35 * (1 - share))
                x = (seat + random.uniform(-0.2, 0.2) + i % 2 / 2) * width / seats
                painter.disc((x, row + random.uniform(-1, 1) * unit), 2.6 * unit, colour, 0.8)
    for i in range(12):
        left, right = round(i * width / 12), round((i + 1) * width / 12)
        stands.fill(GROUND["boards"][i * 7 % 4], (left, foot - boards, right - left, boards))
    stands.fill(mix(GROUND["boards"][0], (255, 255, 255), 0.2), (0, foot - boards, width, max(1, round(1.5 * unit))))
    return stands


def _roof(painter: Painter, top: int, width: int, unit: float) -> None:
    """The roof over the stands: a shallow vault over each part, carried by columns."""
    roof, upper, lower = GROUND["stands"]
    parts = 4
    for i in range(parts):
        left, right = i * width / parts, (i + 1) * width / parts
        turn = np.linspace(0, pi, 24)
        vault = [(left + (1 - np.cos(a)) / 2 * (right - left), top - 9 * unit * np.sin(a) ** 0.8) for a in turn]
        painter.polygon([*vault, (right, top + 9 * unit), (left, top + 9 * unit)], roof)
        for x in np.linspace(left, right, 4)[:-1]:
            painter.surface.fill(mix(upper, roof, 0.5), (round(x), top, max(1, round(2.5 * unit)), round(58 * unit)))


def _mast(painter: Painter, foot: tuple[float, float], head: float, unit: float) -> None:
    """A mast with lamps in row ``head`` and the light around them."""
    x, y = foot
    painter.line([(x, y), (x, head)], 4 * unit, GROUND["mast"])
    painter.shadow((x, head), 90 * unit, 62 * unit, GROUND["lamp"], 0.22)
    painter.panel(
        pygame.Rect(round(x - 24 * unit), round(head - 13 * unit), round(48 * unit), round(22 * unit)),
        GROUND["mast"],
        1.0,
        3 * unit,
    )
    for row in range(2):
        for lamp in range(5):
            painter.disc((x + (lamp - 2) * 9 * unit, head + (row * 9 - 6.5) * unit), 3.1 * unit, GROUND["lamp"], 0.95)


@lru_cache(maxsize=4)
def _soil(size: tuple[int, int]) -> pygame.Surface:
    """The ground cut open, darker with depth."""
    top, middle, low = (np.array(colour, float) for colour in GROUND["soil"])
    share = np.linspace(0, 2, size[1])[:, None]
    column = np.where(share < 1, top + (middle - top) * share, middle + (low - middle) * (share - 1))
    return from_colours(np.broadcast_to(column, (*size, 3)))
