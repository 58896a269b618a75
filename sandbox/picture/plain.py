"""The picture of a scene that has none of its own: surfaces, balls and their paths, as the setup has them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import hypot
from typing import Any

import numpy as np
import pygame

from sandbox.engine.setup import Circle, Segment
from sandbox.picture.ball import Look, least_radius, mark_radius, seams
from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.ghosts import Ghost, draw_ghost, draw_in_frame, ghosts_of, label_ghost
from sandbox.picture.painter import Painter, blank, from_colours
from sandbox.picture.palette import palette
from sandbox.picture.path import Path, draw_trace
from sandbox.picture.sheet import Sheet, metres, rows_of

COLOURS, TRACES = palette("plain"), palette("trace")["colours"]
#: Of a ball alone, and of several, each in the colour of its path.
ALONE, *SEVERAL = (Look(colour, COLOURS["shade"], seams(COLOURS["marks"])) for colour in (COLOURS["ball"], *TRACES))

#: The place shown is at least so many radii of a ball wide, and goes so far beyond the paths, as a share.
LEAST, BEYOND = 12.0, 0.06


class Picture:
    """One run at ``size`` px, seen by a camera that stands still."""

    def __init__(
        self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720), ghosts: Mapping[str, Any] | None = None
    ):
        self.run, self.parameters, self.size = run, parameters, size
        self.ghosts = ghosts_of(Picture, ghosts or {}, size)
        self.rows = rows_of(size)
        self.unit = self.rows / 720  # what 1 px is on a picture of 720 rows
        self.paths = [Path(run, ball.name) for ball in run.setup.balls]
        self.several = len(self.paths) > 1
        sheet = Sheet(size)
        self.card_row = sheet.card_row(len(self.ghosts))
        area = Area(0.07 * size[0], 150 * self.unit, 0.93 * size[0], self.card_row - 89 * self.unit)
        self.camera = Camera.fit(self._place(), area)

    def _place(self) -> Box:
        """All paths, and the surfaces that do not reach far beyond them."""
        others = [path for ghost in self.ghosts for path in ghost.picture.paths]
        points = np.concatenate([path.points for path in (*self.paths, *others)])
        radius = max(path.radius for path in self.paths)
        low, high = points.min(axis=0) - radius, points.max(axis=0) + radius
        reach = max(LEAST * radius, *(high - low))
        for surface in self.run.setup.surfaces:
            corners = np.array(_corners(surface.shape))
            if np.all(corners > low - reach) and np.all(corners < high + reach):
                low, high = np.minimum(low, corners.min(axis=0)), np.maximum(high, corners.max(axis=0))
        more = BEYOND * (high - low) + 0.5 * np.maximum(0.0, LEAST * radius - (high - low))
        (left, bottom), (right, top) = low - more, high + more
        return Box(left, bottom, right, top)

    def poster(self) -> pygame.Surface:
        """The whole run in one picture."""
        return self.frame(self.run.duration)

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s, with the paths behind the balls."""
        sheet, over = Sheet(self.size), t >= self.run.duration
        sheet.surface.blit(self.standing, (0, 0))
        for ghost in self.ghosts:
            self._ghost(sheet, ghost, t)
        for i, path in enumerate(self.paths):
            past = path.points[path.samples[:, 0] <= t]
            if len(past) > 1:
                draw_trace(sheet, self.camera.pixels(past), TRACES[i % len(TRACES)])
        notes = [ghost.note if over else f"beside {ghost.label}" for ghost in self.ghosts]
        if not self.several:
            (path,), radius = self.paths, max(self.paths[0].radius * self.camera.scale, mark_radius(self.rows))
            every, times = path.even_times(self.camera, radius)
            for s in (time for time in times if time < t):
                self._ball(sheet.painter, self.camera, s, 0, radius)
            notes.append(f"a ball every {every:g} s")
        self.draw_balls(sheet.painter, self.camera, t)
        sheet.scale_bar(self.camera, sheet.frame.left, self.card_row - 28 * self.unit, 0.2 * self.size[0])
        sheet.headline(self.verdict() if over else f"{t:.2f} s", notes, self.size[0])
        numbers = self.numbers() if over else self.live(t)
        if numbers:
            sheet.columns(self.card_row, numbers, [ghost.row if over else ghost.live(t) for ghost in self.ghosts])
        for ghost in self.ghosts if over and not self.several else ():
            there, here = (self.camera.pixels(picture.paths[0].points) for picture in (ghost.picture, self))
            label_ghost(sheet, ghost, there, here)
        return sheet.surface

    def _ghost(self, sheet: Sheet, ghost: Ghost, t: float) -> None:
        """Another run, pale: its path, and in a frame where its balls are."""
        for path in ghost.picture.paths:
            points = self.camera.pixels(path.points)
            if t >= self.run.duration and not self.several:
                draw_ghost(sheet, ghost, points)
                continue
            x, y = path.run.state(path.name, min(t, path.run.duration))[:2]
            draw_in_frame(sheet, ghost, points, self.camera.pixel(x, y), 0.0)

    def verdict(self) -> str:
        """What happened, in a line: the verdict on the scene's card, or how long it took."""
        verdict = dict(self._card).get("verdict") or f"{self.run.duration:.2f} s"
        return verdict[:1].upper() + verdict[1:]

    def numbers(self) -> list[tuple[str, str]]:
        """The rest of the scene's card."""
        return [(label, text) for label, text in self._card if label != "verdict"]

    @cached_property
    def _card(self) -> list[tuple[str, str]]:
        return list(self.run.scene.card(self.run.result))

    def live(self, t: float) -> list[tuple[str, str]]:
        """Numbers at time t in s."""
        now = [("time", f"{t:.2f} s")]
        if not self.several:
            x, y, vx, vy, _ = self.run.state(self.paths[0].name, t)
            now += [("x", metres(x)), ("y", metres(y)), ("speed", f"{hypot(vx, vy):.1f} m/s")]
        return now

    @cached_property
    def standing(self) -> pygame.Surface:
        """The stage, drawn once for all frames."""
        return self.stage()

    def stage(self) -> pygame.Surface:
        """What stands still: a light ground, and every surface as a line or a disc."""
        top, foot = np.array(COLOURS["ground"], float)
        stage = blank(self.size)
        stage.blit(from_colours(np.broadcast_to(np.linspace(top, foot, self.size[1]), (*self.size, 3))), (0, 0))
        painter, scale = Painter(stage), self.camera.scale
        for shape in (surface.shape for surface in self.run.setup.surfaces):
            thick = max(shape.radius * scale, 1.5 * self.unit)
            if isinstance(shape, Circle):
                painter.disc(self.camera.pixel(*shape.center), thick, COLOURS["surface"])
                continue
            seen = _clipped(self.camera.pixel(*shape.a), self.camera.pixel(*shape.b), self.size)
            if seen is not None:
                painter.line(seen, 2 * thick, COLOURS["surface"])
        return stage

    def view(self, t: float) -> Camera:
        """The camera of ``frame(t)``."""
        return self.camera

    def draw_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """What moves."""
        for i, path in enumerate(self.paths):
            self._ball(painter, camera, t, i, max(path.radius * camera.scale, least_radius(self.rows)))

    def _ball(self, painter: Painter, camera: Camera, t: float, i: int, radius: float) -> None:
        name = self.paths[i].name
        at = camera.pixel(*self.run.state(name, t)[:2])
        look = SEVERAL[i % len(SEVERAL)] if self.several else ALONE
        look.draw(painter, at, radius, self.run.angle(name, t), self.unit)


def _corners(shape: Segment | Circle) -> list[tuple[float, float]]:
    """What must be seen for a shape to be seen, in m."""
    if isinstance(shape, Segment):
        return [shape.a, shape.b]
    (x, y), r = shape.center, shape.radius
    return [(x - r, y - r), (x + r, y + r)]


def _clipped(
    a: tuple[float, float], b: tuple[float, float], size: tuple[int, int], edge: float = 50.0
) -> list[tuple[float, float]] | None:
    """The part of a line that is on a picture of ``size`` px, or no more than ``edge`` px outside; None if none is."""
    first, last = 0.0, 1.0
    for start, end, most in zip(a, b, size, strict=True):
        for along, room in ((start - end, start + edge), (end - start, most + edge - start)):
            if along == 0.0:
                if room < 0.0:
                    return None
            elif along > 0.0:
                last = min(last, room / along)
            else:
                first = max(first, room / along)
    if first >= last:
        return None
    return [(a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1])) for u in (first, last)]
