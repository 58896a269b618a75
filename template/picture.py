"""The hall from the side: poster() shows the whole run, frame(t) the scene at time t in s."""

from __future__ import annotations

from functools import cached_property
from math import cos, hypot, sin
from typing import Any

import numpy as np
import pygame

from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.painter import from_colours
from sandbox.picture.sheet import Sheet, metres

WALL, FLOOR = ((207, 221, 224), (247, 236, 214)), ((176, 122, 74), (92, 58, 40))  # from the top down
WINDOW, MAT, AIR, SHADOW = (255, 250, 236), (38, 139, 120), (96, 160, 190), (40, 24, 16)
BALL, SEAM, TRACE = (255, 200, 50), (38, 84, 160), (213, 94, 0)
EVERY = 0.2  # s, between the balls along the path


class Picture:
    """One run at ``size`` px, seen by a camera that stands still."""

    def __init__(self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720)):
        self.run, self.parameters, self.size = run, parameters, size
        self.unit = size[1] / 720  # what 1 px is on a picture of 720 rows
        path, floor = run.trajectory("ball", every=1 / 60)[:, :3], parameters.floor  # t in s, x and y in m
        left, right = min(0.0, path[:, 1].min()), max(path[:, 1].max(), floor.mat + floor.mat_length)
        area = Area(0.09 * size[0], 150 * self.unit, 0.91 * size[0], size[1] - 178 * self.unit)
        self.camera = Camera.fit(Box(left, 0.0, right, path[:, 2].max()), area)
        self.times, self.path = path[:, 0], self.camera.pixels(path[:, 1:])
        self.radius = max(parameters.ball.radius * self.camera.scale, 7 * self.unit)

    def poster(self) -> pygame.Surface:
        """The whole run in one picture."""
        return self.frame(self.run.duration)

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s, with the path behind the ball."""
        sheet, result = Sheet(self.size), self.run.result
        sheet.surface.blit(self.hall, (0, 0))
        self._fan(sheet, t)
        self._path(sheet, t)
        sheet.ruler(self.camera, self.size[1] - 132 * self.unit)
        _, y, vx, vy, _ = self.run.state("ball", t)
        distance = result["distance"]
        verdict = "On the mat" if result["hit"] else "Beside the mat"
        notes = [f"a ball every {EVERY:g} s"]
        if self.radius > self.parameters.ball.radius * self.camera.scale:
            notes.append("ball drawn larger than it is")
        sheet.headline(verdict if t >= self.run.duration else f"{t:.2f} s", notes, self.size[0])
        numbers = [
            ("first bounce", "–" if distance is None else metres(distance)),
            ("apex", metres(result["apex"])),
            ("time", f"{t:.2f} s"),
            ("height", metres(y)),
            ("speed", f"{hypot(vx, vy):.1f} m/s"),
        ]
        sheet.columns(sheet.frame.bottom - sheet.card_height(), numbers)
        return sheet.surface

    @cached_property
    def hall(self) -> pygame.Surface:
        """What stands still, drawn once."""
        sheet, (width, height) = Sheet(self.size), self.size
        ground = round(self.camera.pixel(0, 0)[1])
        sheet.surface.blit(_gradient(width, ground, WALL), (0, 0))
        for i in range(5):
            window = pygame.Rect((0.04 + 0.2 * i) * width, 0.24 * ground, 0.12 * width, 0.5 * ground)
            sheet.painter.panel(window, WINDOW, 0.55, 8 * self.unit)
        sheet.surface.blit(_gradient(width, height - ground, FLOOR), (0, ground))
        floor = self.parameters.floor
        left, right = (self.camera.pixel(floor.mat + side * floor.mat_length / 2, 0)[0] for side in (-1, 1))
        sheet.painter.panel(pygame.Rect(left, ground, right - left, 10 * self.unit), MAT, 1.0, 4 * self.unit)
        return sheet.surface

    def _fan(self, sheet: Sheet, t: float) -> None:
        """Streaks of air that rise and spread, the longer the stronger the push."""
        fan = self.parameters.fan
        for i in range(40):
            side, age = i * 0.7549 % 1 * 2 - 1, (i * 0.5698 + 0.5 * t) % 1  # these two numbers scatter evenly
            x, y = self.camera.pixel(fan.place + side * fan.width * (0.7 + 0.6 * age), 3.2 * age)
            streak = [(x, y), (x, y - min(12 * fan.push, 90) * self.unit)]
            sheet.painter.fading(streak, 5 * self.unit, AIR, 1 - age)

    def _path(self, sheet: Sheet, t: float) -> None:
        behind = self.path[self.times <= t]
        sheet.painter.trace(behind, 3.5 * self.unit, TRACE, SHADOW, self.unit)
        for s in np.arange(0.0, t, EVERY):
            self._ball(sheet, s, 0.7)
        self._ball(sheet, t, 1.0)

    def _ball(self, sheet: Sheet, t: float, size: float) -> None:
        x, y, *_ = self.run.state("ball", t)
        (px, py), (_, ground) = self.camera.pixel(x, y), self.camera.pixel(x, 0)
        radius = size * self.radius
        if size == 1.0:
            sheet.painter.shadow((px, ground + 3), 1.5 * radius, 0.4 * radius, SHADOW, 0.6)
        sheet.painter.disc((px, py), radius + self.unit, SHADOW, 0.8)
        sheet.painter.disc((px, py), radius, BALL)
        for i in range(3):  # seams, which turn with the ball
            angle = self.run.angle("ball", t) + i * 2.094
            edge = px + 0.85 * radius * cos(angle), py - 0.85 * radius * sin(angle)
            sheet.painter.line([(px, py), edge], 0.25 * radius, SEAM)


def _gradient(width: int, height: int, colours: Any) -> pygame.Surface:
    top, foot = np.array(colours, float)
    return from_colours(np.broadcast_to(np.linspace(top, foot, height), (width, height, 3)))
