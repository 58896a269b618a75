"""The hall from the side.

``poster()`` shows the whole run and ``frame(t)`` the scene at time t in s: that is all that a picture must have. The
window draws by the rest while you aim: what stands still, the balls, the camera, and what to write.
"""

from __future__ import annotations

from functools import cached_property
from math import hypot
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import Look, least_radius, seams
from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.figures import SHOOTING, draw_figure
from sandbox.picture.painter import Painter, blank, from_colours
from sandbox.picture.path import Path, draw_trace
from sandbox.picture.sheet import Sheet, rows_of
from sandbox.sport.amounts import metres

WALL, FLOOR = ((207, 221, 224), (247, 236, 214)), ((176, 122, 74), (92, 58, 40))  # from the top down
WINDOW, MAT, AIR, SHADOW = (255, 250, 236), (38, 139, 120), (96, 160, 190), (40, 24, 16)
BALL, TRACE = Look((255, 200, 50), (90, 60, 10), seams((38, 84, 160))), (213, 94, 0)
PERSON = {"body": (150, 166, 170), "far": (176, 190, 192), "shirt": (120, 146, 152), "shorts": (134, 154, 158)}


class Picture:
    """One run at ``size`` px, seen by a camera that stands still."""

    def __init__(self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720)):
        self.run, self.parameters, self.size = run, parameters, size
        self.unit = rows_of(size) / 720  # what 1 px is on a picture of 720 rows
        self.path, floor = Path(run), parameters.floor
        points = self.path.points  # m
        left, right = min(-0.5, points[:, 0].min()), max(points[:, 0].max(), floor.mat + floor.mat_length)
        area = Area(0.06 * size[0], 150 * self.unit, 0.94 * size[0], size[1] - 178 * self.unit)
        self.camera = Camera.fit(Box(left, 0.0, right, points[:, 1].max()), area)

    def poster(self) -> pygame.Surface:
        """The whole run in one picture."""
        return self.frame(self.run.duration)

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s, with the path behind the ball."""
        sheet, path, over = Sheet(self.size), self.path, t >= self.run.duration
        sheet.surface.blit(self.standing, (0, 0))
        draw_trace(sheet, self.camera.pixels(path.points[path.samples[:, 0] <= t]), TRACE)
        every, times = path.even_times()
        for s in (time for time in times if time < t):
            self._ball(sheet.painter, self.camera, s, 0.75)
        self.draw_balls(sheet.painter, self.camera, t)
        sheet.ruler(self.camera, self.size[1] - 132 * self.unit)
        sheet.headline(
            self.run.scene.verdict(self.run) if over else f"{t:.2f} s", [f"a ball every {every:g} s"], self.size[0]
        )
        _, y, vx, vy, _ = self.run.state("ball", t)
        now = [("time", f"{t:.2f} s"), ("height", metres(y)), ("speed", f"{hypot(vx, vy):.1f} m/s")]
        sheet.columns(sheet.frame.bottom - sheet.card_height(), self.run.scene.rows(self.run) if over else now)
        return sheet.surface

    @cached_property
    def standing(self) -> pygame.Surface:
        """The stage, drawn once for all frames."""
        return self.stage()

    def stage(self) -> pygame.Surface:
        """What stands still: wall with windows, floor, mat, and who tossed the ball."""
        surface, (width, height) = blank(self.size), self.size
        painter, floor, ground = Painter(surface), self.parameters.floor, round(self.camera.pixel(0, 0)[1])
        surface.blit(_gradient((width, ground), WALL), (0, 0))
        for i in range(5):
            window = pygame.Rect((0.04 + 0.2 * i) * width, 0.24 * ground, 0.12 * width, 0.5 * ground)
            painter.panel(window, WINDOW, 0.55, 8 * self.unit)
        surface.blit(_gradient((width, height - ground), FLOOR), (0, ground))
        left, right = (self.camera.pixel(floor.mat + side * floor.mat_length / 2, 0)[0] for side in (-1, 1))
        painter.panel(pygame.Rect(left, ground, right - left, 10 * self.unit), MAT, 1.0, 4 * self.unit)
        tall = max(0.8, self.parameters.launch.height)  # m; the pose holds the ball at its own height
        draw_figure(painter, self.camera.pixel(-0.15 * tall, 0), tall * self.camera.scale, SHOOTING, PERSON)
        return surface

    def view(self, t: float) -> Camera:
        """The camera of ``frame(t)``."""
        return self.camera

    def draw_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """What moves: the fan's air, in streaks that rise and spread, and the ball with its shadow."""
        fan, (x, *_), radius = self.parameters.fan, self.run.state("ball", t), self._radius(camera)
        for i in range(40):
            side, age = i * 0.7549 % 1 * 2 - 1, (i * 0.5698 + 0.5 * t) % 1  # these two numbers scatter evenly
            px, py = camera.pixel(fan.place + side * fan.width * (0.7 + 0.6 * age), 3.2 * age)
            painter.fading([(px, py), (px, py - min(12 * fan.push, 90) * self.unit)], 5 * self.unit, AIR, 1 - age)
        painter.shadow(camera.pixel(x, -0.02), 1.5 * radius, 0.4 * radius, SHADOW, 0.6)
        self._ball(painter, camera, t, 1.0)

    def _ball(self, painter: Painter, camera: Camera, t: float, size: float) -> None:
        x, y, *_ = self.run.state("ball", t)
        BALL.draw(painter, camera.pixel(x, y), size * self._radius(camera), self.run.angle("ball", t), self.unit)

    def _radius(self, camera: Camera) -> float:
        """Of the ball in px: never too small to be seen."""
        return max(self.parameters.ball.radius * camera.scale, least_radius(self.size[1]))


def _gradient(size: tuple[int, int], colours: Any) -> pygame.Surface:
    top, foot = np.array(colours, float)
    return from_colours(np.broadcast_to(np.linspace(top, foot, size[1]), (*size, 3)))
