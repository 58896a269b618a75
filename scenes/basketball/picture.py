"""Basketball from the side: the shot's arc in a quiet hall, to the ring and down to the floor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from math import atan2, cos, degrees, hypot, pi, sin
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import enlarged, least_radius
from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.chase import Chase
from sandbox.picture.depth import Eye
from sandbox.picture.figures import REACHING, SHOOTING, draw_figure
from sandbox.picture.ghosts import draw_ghost, draw_in_frame, ghosts_of, label_ghost
from sandbox.picture.kept import Kept
from sandbox.picture.lettering import Labels
from sandbox.picture.painter import Painter, around_corners, rounded
from sandbox.picture.palette import mix, palette
from sandbox.picture.path import Path, apart, draw_trace, mark_impacts
from sandbox.picture.sheet import Entry, Sheet, metres, roughly, signed, times
from sandbox.picture.vectors import Vectors

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

    #: Colours of other runs.
    EARLIER = COURT["earlier"]

    def __init__(
        self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720), ghosts: Mapping[str, Any] | None = None
    ):
        self.run, self.parameters, self.size = run, parameters, size
        self.ghosts = ghosts_of(Picture, ghosts or {}, size)
        floor = next((event.t for event in run.events if event.partner == "floor"), run.duration)
        self.path = Path(run, "ball", floor)
        self.radius = self.path.radius
        self.wind: tuple[float, float] = parameters.air.wind
        sheet = Sheet(size)
        self.unit, self.rows = sheet.unit, sheet.rows
        self.rows_at = sheet.side_rows(len(self.ghosts), lengths=1)
        self.hall, self.net = Hall(parameters, size, self.rows_at.base), Net(run, parameters)
        side = round(LENS * self.unit)
        self.kept = Kept()
        self._standing: tuple[Camera, pygame.Surface] | None = None
        self.lens = pygame.Rect(sheet.frame.right - side, sheet.frame.top, side, side)

    # Composition

    @cached_property
    def composed(self) -> tuple[Camera, bool]:
        """The poster's camera, and whether there is a lens beside what it shows."""
        x, y = np.concatenate([self.path.points, *(ghost.picture.path.points for ghost in self.ghosts)]).T
        hall, side = self.hall, 0.085 * self.size[0]
        left, right = min(float(x.min()), -THROWER if self._figure else 0.0), float(x.max())
        top = float(y.max()) + self.radius
        wide = min(left, hall.face), max(right, hall.back + STAND)
        if max(right - left, top) >= LEAST_PATH * (wide[1] - wide[0]):
            (left, right), top = wide, max(top, hall.top)
        box = Box(left, 0.0, right, top)
        area = Area(side, self.rows_at.top + 24 * self.unit, self.size[0] - side, hall.base)
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
        return least_radius(self.rows)

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

    # For the window

    def stage(self) -> pygame.Surface:
        """The place alone, as the poster's camera sees it."""
        sheet, eye = Sheet(self.size), self.hall.eye(self.camera)
        self._place(sheet, eye, 0.0)
        self._before(sheet, eye, 0.0)
        return sheet.surface

    def view(self, t: float) -> Camera:
        """The camera of ``frame(t)``."""
        return self.chase.camera(t)

    def draw_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """The ball at time t in s, on the stage that the camera sees."""
        true = self.radius * camera.scale
        radius = max(true, self._smallest)
        x, y, *_ = self.run.state("ball", t)
        BALL.draw(painter, camera.pixel(x, y), radius, self.run.angle("ball", t), self.unit, radius > true)

    # The poster

    def poster(self) -> pygame.Surface:
        """The whole shot in one picture."""
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        camera, hall = self.camera, self.hall
        eye = hall.eye(camera)
        self._place(sheet, eye, self.net.fullest)
        self.trace = self.path.traced(camera)
        self._bounce(sheet, camera)
        others = [(ghost, camera.pixels(ghost.picture.path.points)) for ghost in self.ghosts]
        for ghost, points in others:
            draw_ghost(sheet, ghost, points)
        draw_trace(sheet, self.trace, COURT["trace"])
        every = self._balls(sheet, camera)
        self._before(sheet, eye, self.net.fullest)
        sheet.ruler(camera, self.rows_at.ruler, "ft")
        self._distance(sheet, camera)
        mark_impacts(sheet, camera, self.path.marks(), lambda mark: not (self.composed[1] and self._in_lens(mark.at)))
        right = sheet.frame.right
        if self.composed[1]:
            self._draw_lens(sheet, eye)
            right = self.lens.left
        if any(self.wind):
            right = sheet.wind(*self.wind, right - 2 * sheet.gap, sheet.frame.top).left
        notes = [*(ghost.note for ghost in self.ghosts), f"a ball every {every:g} s"]
        if not 0 < camera.pixel(hall.hoop[0], 0)[0] < self.size[0]:
            notes.append(f"the ring is {roughly(hall.hoop[0])} away")
        elif (factor := hall.enlarged(camera)) > 1:
            notes.append(f"ring and board drawn {times(factor)} their size")
        if (factor := enlarged(self.radius, camera, self.rows)) > 1:
            notes.append(f"ball drawn {times(factor)} its size")
        sheet.headline(self.verdict(), notes, right - sheet.frame.left - 2 * sheet.gap)
        sheet.columns(self.rows_at.card, self.numbers(), [ghost.row for ghost in self.ghosts])
        for ghost, points in others:
            label_ghost(sheet, ghost, points, self.trace)
        return sheet.surface

    def _place(self, sheet: Sheet, eye: Eye, t: float) -> None:
        """Everything behind the ball, the net as it hangs at time t in s."""
        self.hall.draw(sheet.painter, eye)
        self._behind(sheet, eye)
        self.net.draw(sheet.painter, self.hall.hoop_eye(eye), self.unit, True, t)

    def _behind(self, sheet: Sheet, eye: Eye) -> None:
        """What stands still behind the ball: thrower, stand, board, the far half of the ring."""
        near, hall = self.hall.hoop_eye(eye), self.hall
        box = Box(hall.back - 0.2, -0.2, hall.back + STAND + 0.5, hall.top)
        self.kept.draw(
            sheet.surface, "stand", near.camera, box, lambda painter, camera: hall.stand(painter, hall.eye(camera))
        )
        if self._figure:
            pose, tall, (x, y) = self._figure

            def thrower(painter: Painter, camera: Camera) -> None:
                width = 0.3 * tall * camera.scale
                painter.shadow(camera.pixel(x, 0.0), width, 0.16 * width, CARD["shadow"], 0.45)
                draw_figure(painter, camera.pixel(x, y), tall * camera.scale, pose, FIGURE)

            box = Box(x - 0.5 * tall, -0.2, x + 0.5 * tall, y + 1.3 * tall)
            self.kept.draw(sheet.surface, "thrower", eye.camera, box, thrower)
        hall.board(sheet.painter, near)

    def _before(self, sheet: Sheet, eye: Eye, t: float) -> None:
        """What is before the ball: the near half of net and ring."""
        near = self.hall.hoop_eye(eye)
        self.net.draw(sheet.painter, near, self.unit, False, t)
        self.hall.near_ring(sheet.painter, near)

    def _balls(self, sheet: Sheet, camera: Camera) -> float:
        """The ball at even times, and where it came down; returns the time between in s."""
        true = self.radius * camera.scale
        radius = max(true, self._smallest)
        every, times = self.path.even_times()
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
        for row in self.rows_at.lengths if abs(end - start) > 4 else ():
            text = f"{metres(distance)} to the ring, {metres(height)} up"
            sheet.dimension(text, row, start, end, CARD["text"])
            line = pygame.Rect(round(start), round(row - 4 * self.unit), round(end - start), round(8 * self.unit))
            sheet.labels.take(line)

    def _in_lens(self, point: tuple[float, float], beyond: float = 0.0) -> bool:
        """Whether a place in m is seen in the lens, or no more than ``beyond`` m outside it."""
        x, y = point
        return max(abs(x - self.hall.hoop[0]), abs(y - self.hall.hoop[1])) < LENS_VIEW / 2 + beyond

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
        seen = np.flatnonzero(np.abs(points - self.lens.center).max(axis=1) < self.lens.width)
        draw_trace(sheet, points[seen[0] : seen[-1] + 1], COURT["trace"])
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

    def numbers(self) -> list[Entry]:
        """The result for the card."""
        result, launch = self.run.result, self.parameters.launch
        entered = result["entry_angle"] is not None
        offset = result["entry_offset"]
        return [
            ("entry angle", signed(f"{result['entry_angle']:.1f}") + "°" if entered else "–"),
            ("entry speed", f"{result['entry_speed']:.1f} m/s" if entered else "–"),
            ("from centre", _from_centre(offset) if entered else "–"),
            ("apex", metres(result["apex"] + self.parameters.release.height)),
            ("flight time", f"{result['flight_time']:.2f} s" if entered else "–"),
            ("ball speed", f"{launch.speed:.2f} m/s"),
            ("launch", signed(f"{launch.angle:.1f}") + "°"),
            ("backspin", signed(f"{launch.spin:.0f}") + " rpm"),
        ]

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

    # Frames

    @cached_property
    def vectors(self) -> Vectors:
        return Vectors(self.run, "ball")

    @cached_property
    def decided(self) -> float:
        """When it is clear how the shot ends, in s."""
        return self.net.left if self.run.result["made"] else self.path.until

    @cached_property
    def chase(self) -> Chase:
        """The camera of the frames: it shows thrower and ring, and goes along when the ball leaves them."""
        hall, home = self.hall, self.camera
        columns = 0.1 * self.size[0], self.lens.left - 40 * self.unit if self.composed[1] else 0.9 * self.size[0]
        box = Box(-THROWER, 0.0, hall.back + STAND, 1.25 * hall.top)
        near = Camera.fit(box, Area(columns[0], self.rows_at.top, columns[1], hall.base))
        return Chase(
            self.run, "ball", near if near.scale > home.scale else home, columns, self.rows_at.top, np.zeros_like
        )

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s, seen by a camera that follows the ball."""
        t = min(max(t, 0.0), self.run.duration)
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        painter, unit, camera = sheet.painter, self.unit, self.view(t)
        eye = self.hall.eye(camera)
        sheet.surface.blit(self._backdrop(camera), (0, 0))
        x, y, *_ = self.run.state("ball", t)
        self.net.draw(painter, self.hall.hoop_eye(eye), unit, True, t)
        true = self.radius * camera.scale
        radius = max(true, 1.3 * self._smallest)
        at = camera.pixel(x, y)
        near = 1 / (1 + (y - self.radius) * camera.scale / (80 * unit))
        below = at[0], self.hall.base + unit
        painter.shadow(below, radius * (2.2 - near), 0.35 * radius, CARD["shadow"], 0.15 + 0.45 * near)
        for ghost in self.ghosts:
            other = ghost.picture
            place = camera.pixel(*other.run.state("ball", min(t, other.run.duration))[:2])
            draw_in_frame(sheet, ghost, camera.pixels(other.path.points), place)
        self._trail(sheet, camera, t, 0.7 * radius)
        self.vectors.draw(sheet, at, radius, t)
        BALL.draw(painter, at, radius, self.run.angle("ball", t), unit, radius > true)
        self._before(sheet, eye, t)
        sheet.ruler(camera, self.rows_at.ruler, "ft")
        right = sheet.frame.right
        if self.composed[1]:
            right = self.lens.left - 2 * sheet.gap
            if not self._under_lens(camera):
                self._frame_lens(sheet, t)
        if any(self.wind):
            right = sheet.wind(*self.wind, right, sheet.frame.top).left
        notes = [f"compared with {ghost.label}" for ghost in self.ghosts]
        notes += ["ball drawn larger than it is"] if radius > true else []
        if t >= self.decided:
            sheet.headline(self.verdict(), notes, right - sheet.frame.left - 2 * sheet.gap)
        else:
            sheet.headline(metres(y), ["above the floor", *notes], self.size[0])
        sheet.columns(self.rows_at.card, self.live(t), [ghost.live(t) for ghost in self.ghosts])
        return sheet.surface

    def live(self, t: float) -> list[Entry]:
        """What a frame's card says at time t in s."""
        x, _, vx, vy, spin = self.run.state("ball", t)
        speed = hypot(vx, vy)
        return [
            ("time", f"{t:.2f} s"),
            ("to the ring", metres(self.hall.hoop[0] - x)),
            ("speed", f"{speed:.1f} m/s"),
            ("direction", signed(f"{degrees(atan2(vy, vx)):.0f}") + "°" if speed > 0.01 else "–"),
            ("backspin", signed(f"{spin * 30 / pi:.0f}") + " rpm"),
            *self.vectors.entries(t),
        ]

    def _backdrop(self, camera: Camera) -> pygame.Surface:
        """What stands still behind the ball; kept while the camera does."""
        if self._standing is None or self._standing[0] != camera:
            sheet, eye = Sheet(self.size), self.hall.eye(camera)
            self.hall.draw(sheet.painter, eye, (camera.at[0] - self.chase.home.at[0]) * self.chase.home.scale)
            self._behind(sheet, eye)
            self._standing = camera, sheet.surface
        return self._standing[1]

    def _trail(self, sheet: Sheet, camera: Camera, t: float, width: float) -> None:
        """Where the ball has been: a thin line, and a thick one of late."""
        x, y, *_ = self.run.state("ball", t)
        earlier = camera.pixels(np.array([*self.path.points[self.path.samples[:, 0] < t], (x, y)]))
        if t <= self.path.until and len(earlier) > 1:
            faint = mix(COURT["trace"], COURT["wall"][1], 0.45)
            sheet.painter.thread(earlier[apart(earlier, 3.0)], self.unit, faint)
        times = np.linspace(max(0.0, t - TRAIL), t, 25)
        points = camera.pixels(np.array([self.run.state("ball", s)[:2] for s in times]))
        if np.ptp(points, axis=0).max() > 2:
            sheet.painter.fading(points[apart(points, 2.0)], width, COURT["trace"], 0.9)

    def _under_lens(self, camera: Camera) -> bool:
        """Whether the lens would hide the ring and board that it shows: the camera has gone along with the ball."""
        hall = self.hall
        (left, top), (right, bottom) = (
            camera.pixel(hall.hoop[0] - 0.6, hall.top),
            camera.pixel(hall.back + 1.0, hall.bottom),
        )
        board = pygame.Rect(round(left), round(top), round(right - left), round(bottom - top))
        return bool(self.lens.colliderect(board))

    def _frame_lens(self, sheet: Sheet, t: float) -> None:
        """The ring from near by, at time t in s."""
        x, y, *_ = self.run.state("ball", t)
        inside = self._in_lens((x, y), self.radius)
        if not inside and self.net.rests(t):
            sheet.surface.blit(self._empty_lens, self.lens)
            return
        eye = self._lens_eye(self.hall.eye(self.camera))
        camera, painter = eye.camera, sheet.painter
        corners = around_corners(sheet.surface, self.lens, 10 * self.unit)
        sheet.surface.set_clip(self.lens)
        sheet.surface.blit(self._lens_backdrop, self.lens)
        self.net.draw(painter, eye, self.unit, True, t)
        if inside:
            self._trail(sheet, camera, t, 8 * self.unit)
            BALL.draw(painter, camera.pixel(x, y), self.radius * camera.scale, self.run.angle("ball", t), self.unit)
        self.net.draw(painter, eye, self.unit, False, t)
        self.hall.near_ring(painter, eye)
        sheet.surface.set_clip(None)
        sheet.surface.blit(corners, self.lens)

    @cached_property
    def _lens_backdrop(self) -> pygame.Surface:
        """What stands still in the lens behind the ball."""
        sheet = Sheet(self.size)
        sheet.surface.fill(COURT["lens"], self.lens)
        self.hall.board(sheet.painter, self._lens_eye(self.hall.eye(self.camera)))
        return sheet.surface.subsurface(self.lens)

    @cached_property
    def _empty_lens(self) -> pygame.Surface:
        """The lens while nothing moves in it, with round corners."""
        sheet = Sheet(self.size)
        eye = self._lens_eye(self.hall.eye(self.camera))
        sheet.surface.blit(self._lens_backdrop, self.lens)
        for behind in (True, False):
            self.net.draw(sheet.painter, eye, self.unit, behind, 0.0)
        self.hall.near_ring(sheet.painter, eye)
        return rounded(sheet.surface, self.lens, 10 * self.unit)


def _from_centre(length: float) -> str:
    """How far beyond the middle of the ring, with its sign, as one says it near a ring."""
    return signed(f"{100 * length:+.1f}") + " cm" if abs(length) < 0.995 else signed(f"{length:+.1f}") + " m"
