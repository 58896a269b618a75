"""Basketball from the side: the shot's arc in a quiet hall, to the ring and down to the floor."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from math import atan2, cos, degrees, hypot, pi, sin
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import least_radius
from sandbox.picture.camera import Area, Box, Camera, Follow
from sandbox.picture.depth import Eye
from sandbox.picture.figures import REACHING, SHOOTING, draw_figure
from sandbox.picture.lettering import Labels
from sandbox.picture.painter import around_corners
from sandbox.picture.palette import palette
from sandbox.picture.path import Path, draw_trace, mark_impacts
from sandbox.picture.sheet import Sheet, metres, roughly, signed, times

from .hall import BALL, Hall
from .net import Net

CARD, TRACE, COURT = palette("card"), palette("trace"), palette("basketball")
FIGURE = dict(zip(("body", "far", "shirt", "shorts"), COURT["figure"], strict=True))

#: How far behind the board the stand reaches, and before the release the thrower, in m.
STAND, THROWER = 2.5, 0.7
#: The lens shows so much of the world around the ring, in m, on so many px (of 720 rows).
LENS_VIEW, LENS = 1.22, 286
#: There is no lens if the whole would have to be drawn smaller than this for it.
LEAST_SHRINK = 0.85
#: The ring is left out of the poster when the path would take up less than this share of the way to it.
LEAST_PATH = 0.15
#: s of path that the trail behind the ball shows.
TRAIL = 0.5


class Picture:
    """Draws one shot at ``size`` px: as a poster, or as it is at a time t."""

    def __init__(self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720)):
        self.run, self.parameters, self.size = run, parameters, size
        floor = next((event.t for event in run.events if event.partner == "floor"), run.duration)
        self.path = Path(run, "ball", floor)
        self.radius = self.path.radius
        self.wind = parameters.air.wind
        sheet = Sheet(size)
        self.unit = sheet.unit
        small = sheet.lettering.height("small")
        above, below = sheet.ruler_heights()
        self.card_row = sheet.frame.bottom - sheet.card_height()
        self.ruler_row = self.card_row - 2.2 * sheet.gap - below
        self.distance_row = self.ruler_row - above - 0.8 * sheet.gap - small / 2
        base = round(self.distance_row - small / 2 - 2.4 * sheet.gap)
        self.top_row = sheet.frame.top + sheet.lettering.height("large") + small + 2 * sheet.gap
        self.hall, self.net = Hall(parameters, size, base), Net(run, parameters)
        side = round(LENS * self.unit)
        self.lens = pygame.Rect(sheet.frame.right - side, sheet.frame.top, side, side)

    # Composition

    @cached_property
    def composed(self) -> tuple[Camera, bool]:
        """The poster's camera, and whether there is a lens beside what it shows."""
        x, y = self.path.points.T
        hall, side = self.hall, 0.085 * self.size[0]
        left, right = min(float(x.min()), -THROWER if self._figure else 0.0), float(x.max())
        top = float(y.max()) + self.radius
        wide = min(left, hall.face), max(right, hall.back + STAND)
        if max(right - left, top) >= LEAST_PATH * (wide[1] - wide[0]):
            (left, right), top = wide, max(top, hall.top)
        box = Box(left, 0.0, right, top)
        area = Area(side, self.top_row + 24 * self.unit, self.size[0] - side, hall.base)
        alone = Camera.fit(box, area)
        beside = Camera.fit(box, area._replace(left=0.06 * self.size[0], right=self.lens.left - 24 * self.unit))
        if self._near_ring and beside.scale >= LEAST_SHRINK * alone.scale and self._lens_factor(beside) > 1.5:
            return beside, True
        return alone, False

    @property
    def camera(self) -> Camera:
        return self.composed[0]

    @property
    def _near_ring(self) -> bool:
        """Whether the ball comes where the lens looks."""
        away = np.abs(self.path.points - self.hall.hoop).max(axis=1)
        return bool(away.min() < 0.45 * LENS_VIEW)

    def _lens_factor(self, camera: Camera) -> float:
        return self.lens.width / LENS_VIEW / camera.scale

    def _lens_eye(self, eye: Eye) -> Eye:
        """Sees the ring and what is around it as the eye does, in the lens."""
        factor = self._lens_factor(eye.camera)
        middle = self.hall.hoop[0] - 0.02, self.hall.hoop[1] + 0.08
        (px, py), (ax, ay) = eye.camera.pixel(*middle), self.lens.center
        camera = Camera(middle, (ax, ay), eye.camera.scale * factor)
        return replace(eye, camera=camera, centre=ax + (eye.centre - px) * factor, level=ay + (eye.level - py) * factor)

    @property
    def _smallest(self) -> float:
        """Least radius of the ball in px."""
        return least_radius(self.size[1])

    @cached_property
    def _figure(self) -> Any:
        """Pose, height in m and feet (x, y) in m of the thrower, where a person can have thrown from there."""
        height = self.parameters.release.height
        if not 1.6 <= height <= 3.1 or abs(self.parameters.launch.angle - 45) > 50:
            return None
        if height <= 2.2:
            tall = height / 1.075
            return SHOOTING, tall, (-0.20 * tall, 0.0)
        tall = min(2.05, height / 1.27)
        return REACHING, tall, (-0.20 * tall, height - 1.27 * tall)

    # The poster

    def poster(self) -> pygame.Surface:
        """The whole shot in one picture."""
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        camera, hall, painter = self.camera, self.hall, sheet.painter
        eye = hall.eye(camera)
        hall.draw(painter, eye)
        self._behind(sheet, eye, self.net.fullest)
        self.trace = self.path.traced(camera)
        self._bounce(sheet, camera)
        draw_trace(sheet, self.trace, COURT["trace"])
        every = self._balls(sheet, camera)
        self._before(sheet, eye, self.net.fullest)
        sheet.ruler(camera, self.ruler_row, "ft")
        self._distance(sheet, camera)
        mark_impacts(sheet, camera, self.path.marks(), lambda mark: not (self.composed[1] and self._in_lens(mark.at)))
        right = sheet.frame.right
        if self.composed[1]:
            self._draw_lens(sheet, eye)
            right = self.lens.left
        if any(self.wind):
            right = sheet.wind(*self.wind, right - 2 * sheet.gap, sheet.frame.top).left
        notes = [f"a ball every {every:g} s"]
        if not 0 < camera.pixel(hall.hoop[0], 0)[0] < self.size[0]:
            notes.append(f"the ring is {roughly(hall.hoop[0])} away")
        elif (factor := hall.enlarged(camera)) > 1:
            notes.append(f"ring and board drawn {times(factor)} their size")
        if (factor := self._enlarged(camera)) > 1:
            notes.append(f"ball drawn {times(factor)} its size")
        sheet.headline(self.verdict(), notes, right - sheet.frame.left - 2 * sheet.gap)
        sheet.columns(self.card_row, self._numbers())
        return sheet.surface

    def _enlarged(self, camera: Camera) -> float:
        """How many times its size the ball is drawn."""
        return max(1.0, self._smallest / (self.radius * camera.scale))

    def _behind(self, sheet: Sheet, eye: Eye, t: float) -> None:
        """What is behind the ball: thrower, stand, board, the far half of ring and net."""
        painter = sheet.painter
        near = self.hall.hoop_eye(eye)
        self.hall.stand(painter, near)
        if self._figure:
            pose, tall, feet = self._figure
            foot = eye.point(*feet)
            width = 0.3 * tall * eye.camera.scale
            painter.shadow((foot[0], eye.point(0, 0)[1]), width, 0.16 * width, CARD["shadow"], 0.45)
            draw_figure(painter, foot, tall * eye.camera.scale, pose, FIGURE)
        self.hall.board(painter, near)
        self.net.draw(painter, near, self.unit, True, t)

    def _before(self, sheet: Sheet, eye: Eye, t: float) -> None:
        """What is before the ball: the near half of net and ring."""
        near = self.hall.hoop_eye(eye)
        self.net.draw(sheet.painter, near, self.unit, False, t)
        self.hall.near_ring(sheet.painter, near)

    def _balls(self, sheet: Sheet, camera: Camera) -> float:
        """The ball at even times, and where it came down; returns the time between in s."""
        true = self.radius * camera.scale
        radius = max(true, self._smallest)
        every, times = self.path.even_times(camera, radius)
        for t in [*times, self.path.until]:
            x, y, *_ = self.run.state("ball", t)
            large = radius > true and t == self.path.until
            BALL.draw(sheet.painter, camera.pixel(x, y), radius, self.run.angle("ball", t), self.unit, large)
        return every

    def _bounce(self, sheet: Sheet, camera: Camera) -> None:
        """How the ball goes on from the floor, fading."""
        times = np.linspace(self.path.until, min(self.run.duration, self.path.until + 0.45), 30)
        points = camera.pixels(np.array([self.run.state("ball", t)[:2] for t in times]))
        if np.ptp(points, axis=0).max() > 2:
            sheet.painter.fading(points[::-1], 4 * self.unit, COURT["trace"], 0.6)

    def _distance(self, sheet: Sheet, camera: Camera) -> None:
        """From the release to the ring, along the floor."""
        distance, height = self.hall.hoop
        start, end = (camera.pixel(x, 0)[0] for x in (0.0, distance))
        if not sheet.frame.left <= end <= sheet.frame.right:
            return
        if abs(end - start) > 4:
            text = f"{metres(distance)} to the ring, {metres(height)} up"
            sheet.dimension(text, self.distance_row, start, end, CARD["text"])
            line = pygame.Rect(
                round(start), round(self.distance_row - 4 * self.unit), round(end - start), round(8 * self.unit)
            )
            sheet.labels.take(line)

    def _in_lens(self, point: tuple[float, float]) -> bool:
        x, y = point
        return max(abs(x - self.hall.hoop[0]), abs(y - self.hall.hoop[1])) < LENS_VIEW / 2

    def _draw_lens(self, sheet: Sheet, eye: Eye) -> None:
        """The ring from near by: how the ball came, what it touched, how fast."""
        sheet_camera = eye.camera
        eye = self._lens_eye(eye)
        camera, painter, hall = eye.camera, sheet.painter, self.hall
        corners = around_corners(sheet.surface, self.lens, 10 * self.unit)
        sheet.surface.fill(COURT["lens"], self.lens)
        sheet.surface.set_clip(self.lens)
        outside, sheet.labels = sheet.labels, Labels(self.lens.inflate(-2 * sheet.gap, -2 * sheet.gap), sheet.gap)
        hall.board(painter, eye)
        self.net.draw(painter, eye, self.unit, True, self.net.fullest)
        points = camera.pixels(self.path.points)
        inside = [self.lens.inflate(60, 60).collidepoint(*point) for point in points]
        first, last = inside.index(True), len(inside) - inside[::-1].index(True)
        draw_trace(sheet, points[first:last], COURT["trace"])
        self._entry(sheet, camera)
        self.net.draw(painter, eye, self.unit, False, self.net.fullest)
        hall.near_ring(painter, eye)
        inside = [mark for mark in self.path.marks() if self._in_lens(mark.at)]
        mark_impacts(sheet, camera, inside, lambda mark: True)
        corner = self.lens.left + 2 * sheet.gap, self.lens.bottom - 1.6 * sheet.gap
        factor = f"{self._lens_factor(sheet_camera):.1f}×"
        sheet.label(factor, "small", [(*corner, "bottomleft")], CARD["quiet"])
        sheet.labels = outside
        sheet.labels.take(self.lens)
        sheet.surface.set_clip(None)
        sheet.surface.blit(corners, self.lens)

    def _entry(self, sheet: Sheet, camera: Camera) -> None:
        """The ball as it comes to the ring, and the angle at which it does."""
        t, angle = self.run.result["flight_time"], self.run.result["entry_angle"]
        if t is None:
            return
        x, y, vx, vy, _ = self.run.before("ball", t)
        px, py = camera.pixel(x, y)
        unit, radius = self.unit, self.radius * camera.scale
        side = -1 if vx > 0 else 1
        far = radius + 26 * unit
        turn = np.linspace(0, atan2(-vy, abs(vx)), 25)
        if self.lens.collidepoint(px + side * far, py) and angle > 5:
            anchor, middle = "midright" if side < 0 else "midleft", turn[-1] / 2
            spots = [
                (px + side * (far + out * unit) * cos(middle), py - (far + out * unit) * sin(middle), anchor)
                for out in (6, 12, 20, 30)
            ]
            if sheet.label(f"{angle:.1f}°", "small", spots, CARD["accent"], bold=True):
                level = [(px, py), (px + side * (far + 8 * unit), py)]
                sheet.painter.dashes(level, 1.3 * unit, CARD["accent"], 4 * unit, 4 * unit)
                arc = np.column_stack([px + side * far * np.cos(turn), py - far * np.sin(turn)])
                sheet.painter.line(arc, 1.8 * unit, CARD["accent"])
                sheet.labels.take_path(arc, 2 * unit)
        BALL.draw(sheet.painter, (px, py), radius, self.run.angle("ball", t), unit)
        sheet.labels.take(pygame.Rect(round(px - radius), round(py - radius), round(2 * radius), round(2 * radius)))

    def verdict(self) -> str:
        """What happened, in one line."""
        result = self.run.result
        if result["made"]:
            return {"swish": "In, nothing but net", "rim": "In, off the rim", "bank": "In, off the board"}[
                result["verdict"]
            ]
        touched = next((name for name in result["touches"] if name != "floor"), None)
        if touched:
            return "Off the board, and out" if touched == "backboard" else "Off the rim, and out"
        offset = result["entry_offset"]
        if offset is not None:
            return f"Air ball, {roughly(abs(offset))} {'short' if offset < 0 else 'too far'}"
        return "Air ball, never as high as the ring" if "floor" in result["touches"] else "Did not come down"

    def _numbers(self) -> list[tuple[str, str]]:
        result, launch = self.run.result, self.parameters.launch
        entered = result["entry_angle"] is not None
        offset = result["entry_offset"]
        return [
            ("entry angle", signed(f"{result['entry_angle']:.1f}") + "°" if entered else "–"),
            ("entry speed", f"{result['entry_speed']:.1f} m/s" if entered else "–"),
            ("short of centre" if entered and offset < 0 else "beyond centre", _short(abs(offset)) if entered else "–"),
            ("apex", metres(result["apex"] + self.parameters.release.height)),
            ("flight time", f"{result['flight_time']:.2f} s" if entered else "–"),
            ("ball speed", f"{launch.speed:.2f} m/s"),
            ("launch", signed(f"{launch.angle:.1f}") + "°"),
            ("backspin", signed(f"{launch.spin:.0f}") + " rpm"),
        ]


def _short(length: float) -> str:
    """A length of 0 or more as one says it near a ring."""
    return f"{100 * length:.1f} cm" if length < 0.995 else metres(length)
