"""The end of a pitch from above, as it is drawn: grass under the lamps, lines, goal, wall, keeper."""

from __future__ import annotations

from functools import lru_cache
from math import acos, ceil, floor, pi, radians
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import Look, patches
from sandbox.picture.camera import Box, Camera
from sandbox.picture.figures import draw_from_above
from sandbox.picture.kept import Kept
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import rows_of

from .scene import BOARDS_ASIDE, BOARDS_BEHIND, BOARDS_BEYOND

PITCH, CARD = palette("soccer-curl"), palette("card")

BALL = Look(PITCH["ball"], PITCH["ball_shade"], patches(PITCH["patch"], PITCH["ball_seam"]))

#: Stripes as wide as the goal area is deep, lines, and what they bound (Laws of the Game, law 1), in m.
STRIPE, LINE = 5.5, 0.12
GOAL_AREA, PENALTY_AREA, SPOT, CIRCLE, CORNER = (5.5, 18.32), (16.5, 40.32), 11.0, 9.15, 1.0
PITCH_LENGTH, PITCH_WIDTH = 105.0, 68.0
#: The net's mesh in m, and the least in px on 720 rows.
MESH, LEAST_MESH = 0.12, 5.0
#: Players of the wall are about this broad; the kicker is so broad and stands so far behind the ball; in m.
BREADTH, KICKER, BEHIND = 0.5, 0.5, 0.75
#: Goal and players are drawn larger where a player would be less broad than this, px on 720 rows.
LEAST_BREADTH = 9
#: Opacity of the dusk at the edges of the picture.
DUSK = 0.92


class Pitch:
    """The place of play, for pictures of one size."""

    def __init__(self, parameters: Any, size: tuple[int, int]):
        self.parameters, self.size = parameters, size
        self.goal, self.wall, self.keeper = parameters.goal, parameters.wall, parameters.keeper
        self.unit = rows_of(size) / 720
        self.kept = Kept()

    def enlarged(self, camera: Camera) -> float:
        """How many times their size players are drawn."""
        return max(1.0, LEAST_BREADTH * self.unit / (BREADTH * camera.scale))

    # The ground

    def draw(self, surface: pygame.Surface, camera: Camera) -> None:
        """Grass, lines, boards, the goal's net, dusk."""
        self._grass(surface, camera)
        self._lines(surface, camera)
        self._goal(surface, camera)
        surface.blit(_dusk(self.size), (0, 0))

    def _fill(
        self,
        surface: pygame.Surface,
        camera: Camera,
        colour: Colour,
        left: float,
        bottom: float,
        right: float,
        top: float,
    ) -> None:
        """A rectangle given in m."""
        (x0, y0), (x1, y1) = camera.pixel(left, top), camera.pixel(right, bottom)
        x0, x1 = (min(max(x, -9.0), self.size[0] + 9.0) for x in (x0, x1))
        y0, y1 = (min(max(y, -9.0), self.size[1] + 9.0) for y in (y0, y1))
        surface.fill(colour, (round(x0), round(y0), round(x1) - round(x0), round(y1) - round(y0)))

    def _grass(self, surface: pygame.Surface, camera: Camera) -> None:
        (low, top), (high, bottom) = camera.world(0, 0), camera.world(*self.size)
        stripe = STRIPE * max(1.0, 2.0 ** ceil(np.log2(10 * self.unit / (STRIPE * camera.scale))))
        line = self.goal.distance
        surface.fill(PITCH["grass"][0])
        for i in range(floor((low - line) / stripe), ceil((high - line) / stripe)):
            if i % 2:
                self._fill(surface, camera, PITCH["grass"][1], line + i * stripe, bottom, line + (i + 1) * stripe, top)
        left, right, aside = BOARDS_BEHIND, line + BOARDS_BEYOND, BOARDS_ASIDE
        board = max(0.4, 3 * self.unit / camera.scale)
        for x0, y0, x1, y1 in (
            (low, bottom, left, top),
            (right, bottom, high, top),
            (low, aside, high, top),
            (low, bottom, high, -aside),
        ):
            if x1 > x0 and y1 > y0:
                self._fill(surface, camera, PITCH["beyond"], x0, y0, x1, y1)
        for i, start in enumerate(np.arange(-aside, aside, 6.0)):
            colour = PITCH["boards"][i % 4]
            self._fill(surface, camera, colour, right, start, right + board, start + 6.0)
            self._fill(surface, camera, colour, left - board, start, left, start + 6.0)

    def _lines(self, surface: pygame.Surface, camera: Camera) -> None:
        """The lines of the pitch, as far as there is any of them between the boards."""
        end, middle = self.goal.distance, self.goal.offset
        half = max(LINE, 1.3 * self.unit / camera.scale) / 2
        start = max(end - PITCH_LENGTH, BOARDS_BEHIND)
        side = min(PITCH_WIDTH / 2, BOARDS_ASIDE - abs(middle))

        def line(x0: float, y0: float, x1: float, y1: float) -> None:
            self._fill(
                surface,
                camera,
                PITCH["line"],
                max(min(x0, x1), start) - half,
                min(y0, y1) - half,
                max(x0, x1) + half,
                max(y0, y1) + half,
            )

        line(end, middle - side, end, middle + side)
        for way in (-1, 1):
            line(start, middle + way * side, end, middle + way * side)
        for deep, wide in (GOAL_AREA, PENALTY_AREA):
            for way in (-1, 1):
                line(end - deep, middle + way * wide / 2, end, middle + way * wide / 2)
            line(end - deep, middle - wide / 2, end - deep, middle + wide / 2)
        if end - PITCH_LENGTH / 2 > start:
            line(end - PITCH_LENGTH / 2, middle - side, end - PITCH_LENGTH / 2, middle + side)
        self._curves(surface, camera, 2 * half)

    def _curves(self, surface: pygame.Surface, camera: Camera, width: float) -> None:
        """The arc at the penalty area and the spot."""
        spot = self.goal.distance - SPOT, self.goal.offset
        turn = acos((PENALTY_AREA[0] - SPOT) / CIRCLE)
        turns = pi + np.linspace(-turn, turn, 60)
        arc = np.column_stack([spot[0] + CIRCLE * np.cos(turns), spot[1] + CIRCLE * np.sin(turns)])

        def draw(painter: Painter, camera: Camera) -> None:
            painter.lines([camera.pixels(arc)], width * camera.scale, PITCH["line"])
            painter.disc(camera.pixel(*spot), max(1.5, 0.12 * camera.scale), PITCH["line"])

        box = Box(spot[0] - CIRCLE - 0.5, spot[1] - CIRCLE, spot[0] + 0.5, spot[1] + CIRCLE)
        self.kept.draw(surface, "arc", camera, box, draw)

    def _goal(self, surface: pygame.Surface, camera: Camera) -> None:
        """The worn grass before the goal, the net from the goal line back, bar and posts over the line."""
        goal, painter = self.goal, Painter(surface)
        aside, radius = goal.width / 2 + goal.post_radius, goal.post_radius
        front, back = goal.distance, goal.distance + goal.depth
        left, right = goal.offset + aside, goal.offset - aside
        worn = camera.pixel(front - 0.3, goal.offset)
        painter.shadow(worn, 1.2 * camera.scale, 0.42 * goal.width * camera.scale, PITCH["worn"], 0.4)
        corners = [camera.pixel(x, y) for x, y in ((front, right), (back, right), (back, left), (front, left))]
        painter.polygon(corners, CARD["shadow"], 0.12)
        mesh = max(MESH, LEAST_MESH * self.unit / camera.scale)
        along = np.linspace(front, back, max(2, round(goal.depth / mesh) + 1))
        across = np.linspace(right, left, max(2, round(2 * aside / mesh) + 1))
        net = [[camera.pixel(x, right), camera.pixel(x, left)] for x in along]
        net += [[camera.pixel(front, y), camera.pixel(back, y)] for y in across]
        thin = max(0.6, 0.8 * self.unit)
        painter.lines(net, thin, PITCH["net"], 0.42)
        painter.lines([corners], 1.6 * thin, PITCH["net"], 0.8)
        width = max(2.6 * self.unit, 2 * radius * camera.scale)
        painter.line([corners[0], corners[3]], width + 1.5 * self.unit, CARD["shadow"], 0.35)
        painter.line([corners[0], corners[3]], width, PITCH["post"])
        for corner in (corners[0], corners[3]):
            painter.disc(corner, 0.5 * width + 1.6 * self.unit, PITCH["post"])

    # People

    def people(self, surface: pygame.Surface, camera: Camera) -> None:
        """The wall and the kicker."""
        if self.wall.present:
            wall = self.wall
            count = max(1, round(wall.width / BREADTH))

            def players(painter: Painter, camera: Camera) -> None:
                breadth = wall.width / count
                factor = self.enlarged(camera)
                for i in range(count):
                    y = wall.offset + (i - (count - 1) / 2) * breadth
                    draw_from_above(
                        painter, camera.pixel(wall.distance, y), breadth * factor * camera.scale, pi, _kit(0)
                    )

            edge = 1.5 * self.enlarged(camera)
            low, high = wall.offset - wall.width / 2 - edge, wall.offset + wall.width / 2 + edge
            box = Box(wall.distance - edge, low, wall.distance + edge, high)
            self.kept.draw(surface, "wall", camera, box, players)

        def kicker(painter: Painter, camera: Camera) -> None:
            turn = radians(self.parameters.launch.angle)
            away = -BEHIND * self.enlarged(camera)
            at = camera.pixel(away * np.cos(turn), away * np.sin(turn))
            draw_from_above(painter, at, KICKER * self.enlarged(camera) * camera.scale, turn, _kit(1))

        edge = 2.0 * self.enlarged(camera)
        self.kept.draw(surface, "kicker", camera, Box(-edge, -edge, edge, edge), kicker)

    def draw_keeper(self, painter: Painter, camera: Camera, at: tuple[float, float]) -> None:
        """The keeper at a place in m, his arms as far out as he reaches, and the disc that he is to the ball."""
        factor = self.enlarged(camera)
        reach = self.keeper.radius * camera.scale
        breadth = min(BREADTH * factor * camera.scale, 1.25 * reach * factor)
        px = camera.pixel(*at)
        painter.disc(px, reach, PITCH["shirts"][2], 0.25)
        painter.ring(px, reach, max(1.0, 1.2 * self.unit), PITCH["shirts"][2], 0.7)
        draw_from_above(painter, px, breadth, pi, _kit(2), arms=max(reach, 0.75 * breadth))


def _kit(team: int) -> dict[str, Colour]:
    return {
        "body": PITCH["skin"],
        "far": PITCH["skin_far"],
        "hair": PITCH["hair"],
        "shirt": PITCH["shirts"][team],
        "gloves": PITCH["gloves"],
    }


@lru_cache(maxsize=4)
def _dusk(size: tuple[int, int]) -> pygame.Surface:
    """Darkness that grows from the middle of the picture to its edges, most above and below, where text stands."""
    width, height = size
    across = abs(np.arange(width)[:, None] / width * 2 - 1)
    down = abs(np.arange(height)[None, :] / height * 2 - 1.04)
    dark = np.clip(0.40 * across**3 + 2.6 * np.clip(down - 0.52, 0, 1), 0, 1)
    dusk = blank(size, transparent=True)
    dusk.fill((*PITCH["dusk"], 0))
    alpha = pygame.surfarray.pixels_alpha(dusk)
    alpha[...] = dark * 255 * DUSK
    del alpha  # unlocks the surface
    return dusk
