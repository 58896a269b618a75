"""Golf from the side: a wide sky, the ground cut open along the line of play, and the ball's path over it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import atan2, degrees, floor, hypot, pi
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import enlarged, least_radius, mark_radius
from sandbox.picture.camera import Area, Box, Camera, Follow
from sandbox.picture.ghosts import draw_ghost, draw_in_frame, ghosts_of, label_ghost
from sandbox.picture.painter import Painter
from sandbox.picture.palette import palette
from sandbox.picture.path import Mark, Path, apart, chip, mark_impacts
from sandbox.picture.sheet import Entry, Sheet, metres, nice, roughly, signed, times, yards
from sandbox.picture.vectors import Vectors

from .course import BALL, Course

CARD, TRACE, GOLF = palette("card"), palette("trace"), palette("golf")

#: The pin is left out of the poster when the path would take up less than this share of the way to it.
LEAST_PATH = 0.2
#: A flight that rises at least this much (px on 720 rows) and leaves most of the sky empty is drawn twice as high.
LEAST_RISE = 24
#: Impacts at less than this, in m/s, and at less than this share of the hardest are not marked.
LEAST_IMPACT, SOFT = 1.0, 0.25
#: Frames show at most this much of the world's length in m, until the ball flies too high for it.
WIDEST_VIEW = 64.0
#: Frames are so wide that the ball takes this long, in s, over the middle of them.
SIGHT = 0.5
#: s of path that the trail behind the ball shows.
TRAIL = 1.4
#: Carry is measured at launch height; a ball that is then at least this far above the ground (px on 720 rows) shows so.
LEAST_DROP = 14
#: Without air, and with gravity below this in m/s^2, it is the Moon.
LEAST_GRAVITY = 5.0
#: The path is sampled this often in s; of a long run, in so many pieces.
SAMPLING, MOST_SAMPLES = 1 / 120, 5000


class Picture:
    """Draws one run of golf at ``size`` px: as a poster, or as it is at a time t."""

    def __init__(
        self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720), ghosts: Mapping[str, Any] | None = None
    ):
        self.run, self.size = run, size
        self.ghosts = ghosts_of(Picture, ghosts or {}, size)
        ball = run.setup.balls[0]
        self.name, self.radius = ball.name, ball.radius
        self.path = run.trajectory(self.name, every=max(SAMPLING, run.duration / MOST_SAMPLES))
        self.pin = parameters.pin.distance
        self.wind: tuple[float, float] = parameters.air.wind
        self.moon = parameters.air.density == 0.0 and parameters.gravity < LEAST_GRAVITY
        sheet = Sheet(size)
        self.unit, self.rows = sheet.unit, sheet.rows
        self.rows_at = sheet.side_rows(len(self.ghosts), lengths=2)
        self.frame_base = sheet.side_rows(len(self.ghosts), lengths=0).base

    # The poster

    def _course(self, base: int, scale: float) -> Course:
        """The course at ``scale`` px/m: where a cup can be seen, the ground is higher, for the ruler is below it."""
        course = Course(self.run.setup, self.pin, self.size, base, self.moon)
        ends = float(self.path[:, 1].min()), float(self.path[:, 1].max())
        near = 0.5 * self.size[0] / scale
        if course.cup is None or not ends[0] - near < self.pin < ends[1] + near:
            return course
        deep = (course.cup.top - course.cup.bottom) * scale - 4 * self.unit
        if deep <= 0:
            return course
        return Course(self.run.setup, self.pin, self.size, round(base - min(deep, 0.15 * self.size[1])), self.moon)

    @cached_property
    def poster_course(self) -> Course:
        course = Course(self.run.setup, self.pin, self.size, self.rows_at.base, self.moon)
        return self._course(self.rows_at.base, self._composed(course).scale)

    @cached_property
    def camera(self) -> Camera:
        """The poster's camera."""
        return self._composed(self.poster_course)

    def _composed(self, course: Course) -> Camera:
        """Shows the whole path, and the pin unless that would make the path too small to see."""
        x, y = np.concatenate([self.path, *(ghost.picture.path for ghost in self.ghosts)])[:, 1:3].T
        left, right, top = float(x.min()), float(x.max()), float(y.max())
        least = 60 * self.radius
        if right - left < least:
            left, right = (left + right - least) / 2, (left + right + least) / 2
        wide = min(left, self.pin), max(right, self.pin)
        if max(right - left, top) >= LEAST_PATH * (wide[1] - wide[0]):
            left, right = wide
        bottom, hill = course.lowest_and_highest(left, right)
        side = 0.085 * self.size[0]
        area = Area(side, self.rows_at.top + 40 * self.unit, self.size[0] - side, course.base)
        box = Box(left, bottom, right, max(top, hill))
        camera = Camera.fit(box, area)
        rise, room = (box.top - box.bottom) * camera.scale, area.bottom - area.top
        if enlarged(self.radius, camera, self.rows) > 3 and LEAST_RISE * self.unit < rise < 0.45 * room:
            return Camera.fit(box, area, stretch=2.0)
        return camera

    def stage(self) -> pygame.Surface:
        """The place alone, as the poster's camera sees it."""
        sheet = Sheet(self.size, on_dark=self.moon)
        self._place(sheet)
        return sheet.surface

    def _place(self, sheet: Sheet) -> pygame.Rect | None:
        """Draw the course; returns where its flag is."""
        self.poster_course.draw(sheet.painter, self.camera, nice(70 * self.unit / self.camera.scale))
        return self.poster_course.hole(sheet.painter, self.camera, 0.4, self.wind[0])

    def draw_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """The ball at time t in s, on the stage that the camera sees."""
        true = self.radius * camera.scale
        radius = max(true, self._smallest)
        x, y = self.run.state(self.name, t)[:2]
        at = self._spot(self.poster_course, camera, x, y, radius)
        painter.shadow((at[0] + 2 * self.unit, at[1] + radius), 1.5 * radius, 0.4 * radius, CARD["shadow"], 0.4)
        BALL.draw(painter, at, radius, self.run.angle(self.name, t), self.unit, radius > true)

    def view(self, t: float) -> Camera:
        """The camera of ``frame(t)``."""
        return self.follow.camera(t)

    def poster(self) -> pygame.Surface:
        """The whole run in one picture."""
        sheet = self.sheet = Sheet(self.size, on_dark=self.moon)
        camera, course = self.camera, self.poster_course
        flag = self._place(sheet)
        if flag:
            sheet.labels.take(flag.inflate(0, 2 * sheet.gap))
        path = self._lifted(course, camera, self.path[:, 1:3])
        self.trace = path[apart(path, 1.5)]
        sheet.labels.take_path(self.trace, 4 * self.unit)
        sheet.labels.take(pygame.Rect(0, course.base, self.size[0], self.size[1]))  # distances and ruler
        others = [(ghost, self._lifted(course, camera, ghost.picture.path[:, 1:3])) for ghost in self.ghosts]
        for ghost, points in others:
            draw_ghost(sheet, ghost, points)
        self._apex(sheet, camera)
        if flag:
            above = [(flag.centerx, flag.top - lift * self.unit, "midbottom") for lift in (8, 14)]
            sheet.label(f"pin {signed(f'{self.pin:g}')} m", "small", above, sheet.ink, bold=True)
        width = max(2.5, 4.5 * self.unit)
        sheet.painter.trace(self.trace, width, TRACE["colours"][0], TRACE["rim"], max(0.75, self.unit))
        every = self._balls_at_even_times(sheet, camera)
        self._distances(sheet, camera)
        mark_impacts(sheet, camera, self._hard_impacts(camera), lambda mark: True)
        sheet.ruler(camera, self.rows_at.ruler)
        right = sheet.frame.right
        if any(self.wind):
            right = sheet.wind(*self.wind, sheet.frame.right, sheet.frame.top).left
        notes = [f"a ball every {every:g} s"]
        if camera.stretch != 1:
            notes.append(f"heights drawn {camera.stretch:g} times as large as lengths")
        if (factor := enlarged(self.radius, camera, self.rows)) > 1:
            notes.append(f"ball drawn {times(factor)} its size")
        notes = [ghost.note for ghost in self.ghosts] + notes
        sheet.headline(self.verdict(), notes, right - sheet.frame.left - 2 * sheet.gap)
        sheet.columns(self.rows_at.card, self.numbers(), [ghost.row for ghost in self.ghosts])
        for ghost, points in others:
            label_ghost(sheet, ghost, points, self.trace)
        return sheet.surface

    @property
    def _smallest(self) -> float:
        """Least radius of the ball in px."""
        return least_radius(self.rows)

    def _apex(self, sheet: Sheet, camera: Camera) -> None:
        """The highest point: a dashed line down to the ground, and its height over the start."""
        top = self.path[self.path[:, 2].argmax()]
        x, y = camera.pixel(top[1], top[2])
        unit = self.unit
        ground = camera.pixel(top[1], self.poster_course.height(top[1]))[1]
        if ground - y < 44 * unit:
            return
        text, middle = f"apex {metres(self.run.result['apex'])}", (y + ground) / 2
        above = [(x, y - lift * unit, "midbottom") for lift in (12, 18, 24)]
        beside = [(x + side * 10 * unit, middle, side, 0.0) for side in (1.0, -1.0)]
        if sheet.label(text, "small", above, sheet.ink, bold=True) or chip(sheet, text, beside):
            ends = [(x, y + 10 * unit), (x, ground - 4 * unit)]
            sheet.painter.dashes(ends, 1.3 * unit, sheet.ink, 4 * unit, 5 * unit, 0.5)
            sheet.labels.take_path([(x, row) for row in np.linspace(y, ground, 20)], 2 * unit)

    def _lifted(self, course: Course, camera: Camera, points: np.ndarray) -> np.ndarray:
        """Path in px for points in m, raised so that balls drawn too large along it lie on the ground and not in it."""
        path = camera.pixels(points)
        on_ground = points[:, 1] > np.interp(points[:, 0], *course.line.T)
        path[:, 1] -= np.where(on_ground, max(0.0, mark_radius(self.rows) - self.radius * camera.scale), 0.0)
        return path

    def _spot(self, course: Course, camera: Camera, x: float, y: float, radius: float) -> tuple[float, float]:
        """Where in px a ball drawn with ``radius`` px goes: on the path, and not into the ground."""
        ground = camera.pixel(x, course.height(x))[1]
        px, py = self._lifted(course, camera, np.array([(x, y)]))[0]
        return float(px), float(py if y < course.height(x) else min(py, ground - radius))

    def _balls_at_even_times(self, sheet: Sheet, camera: Camera) -> float:
        """The ball at even times, where there is room for it, and at the end; returns the time between in s."""
        course, run = self.poster_course, self.run
        flight = run.result["flight_time"] or 0.0
        seen = run.result["apex"] * camera.scale * camera.stretch > 60 * self.unit
        every = nice(max(flight if flight and seen else run.duration, 0.01) / 14)
        true = self.radius * camera.scale
        radius, largest = max(true, mark_radius(self.rows)), max(true, self._smallest)
        x, y = run.state(self.name, run.duration)[:2]
        end = self._spot(course, camera, x, y, largest)
        last = (-1e9, 0.0)
        for i in range(floor(run.duration / every) + 1):
            x, y = run.state(self.name, i * every)[:2]
            at = self._spot(course, camera, x, y, radius)
            far = hypot(at[0] - last[0], at[1] - last[1])
            if far > 2.6 * radius and hypot(at[0] - end[0], at[1] - end[1]) > largest + 2 * radius:
                BALL.draw(sheet.painter, at, radius, run.angle(self.name, i * every), self.unit)
                last = at
        sheet.painter.shadow(
            (end[0] + 2 * self.unit, end[1] + largest), 1.5 * largest, 0.4 * largest, CARD["shadow"], 0.5
        )
        BALL.draw(sheet.painter, end, largest, run.angle(self.name, run.duration), self.unit, largest > true)
        return every

    def _hard_impacts(self, camera: Camera) -> list[Mark]:
        """Where the ball came down hard, against its hardest, and not beside another such place."""
        marks = list(Path(self.run, self.name).marks())
        least = max([LEAST_IMPACT, *(SOFT * mark.speed for mark in marks)])
        kept: list[Mark] = []
        for mark in marks:
            far = abs(mark.at[0] - kept[-1].at[0]) * camera.scale if kept else self.size[0]
            if mark.speed >= least and far > 30 * self.unit:
                kept.append(mark)
        return kept

    def _distances(self, sheet: Sheet, camera: Camera) -> None:
        """Carry and total, measured along the ground."""
        start = camera.pixel(0, 0)[0]
        colours = {"total": CARD["text"], "carry": CARD["accent"]}
        for row, (name, colour) in zip(self.rows_at.lengths, colours.items(), strict=False):
            value = self.run.result[name]
            if value and abs(value) * camera.scale > 4:
                text = f"{name} {metres(value)}   {yards(value)}"
                if name == "carry" and self._carry_ends_in_the_air(sheet, camera, value, row - 0.6 * sheet.gap):
                    text += "   at launch height"
                sheet.dimension(text, row, start, camera.pixel(value, 0)[0], colour)

    def _carry_ends_in_the_air(self, sheet: Sheet, camera: Camera, carry: float, row: float) -> bool:
        """Whether the ball is clearly above lower ground where its carry (m) ends; then this is marked, down to row."""
        course = self.poster_course
        x, y = self._lifted(course, camera, np.array([(carry, self.path[0, 2])]))[0]
        ground = camera.pixel(carry, course.height(carry))[1]
        if ground - y < LEAST_DROP * self.unit:
            return False
        sheet.painter.dashes([(x, y), (x, row)], 1.3 * self.unit, CARD["accent"], 4 * self.unit, 4 * self.unit)
        sheet.painter.disc((x, y), 4.2 * self.unit, TRACE["rim"], 0.8)
        sheet.painter.disc((x, y), 3.0 * self.unit, CARD["accent"])
        sheet.labels.take_path([(x, y), (x, (y + ground) / 2), (x, ground)], 4 * self.unit)
        return True

    def numbers(self) -> list[tuple[str, str]]:
        """What the poster's card says."""
        result = self.run.result
        ball = self.run.setup.balls[0]  # before it touches anything, which it may do at once
        vx, vy = ball.velocity
        landed = self._landed
        return [
            ("carry", metres(result["carry"]) if landed else "–"),
            ("total", metres(result["total"])),
            ("apex", metres(result["apex"]) if result["apex"] >= 0.005 else "–"),
            ("flight time", f"{result['flight_time']:.2f} s" if landed else "–"),
            ("ball speed", f"{hypot(vx, vy):.1f} m/s"),
            ("launch", signed(f"{degrees(atan2(vy, vx)):.1f}") + "°"),
            ("backspin", signed(f"{ball.spin * 30 / pi:.0f}") + " rpm"),
            ("landing", signed(f"{result['landing_angle']:.0f}") + "°" if landed else "–"),
        ]

    @property
    def _landed(self) -> bool:
        """Whether it flew at all, and came down."""
        return (self.run.result["flight_time"] or 0.0) > 0.02

    def verdict(self) -> str:
        """What happened, in one line."""
        result = self.run.result
        carry, total, away = result["carry"], result["total"], result["distance_to_pin"]
        if result["holed"]:
            return f"Holed from {roughly(abs(self.pin))}"
        if carry is None:
            return "Did not come down"
        if result["ended"] == "duration":
            return f"Still rolling after {self.run.duration:.0f} s, {roughly(abs(total))} from the start"
        if abs(carry) < 0.05 * abs(total):
            story = f"Rolls {roughly(abs(total))}"
        else:
            story = f"Flies {roughly(-carry)} backwards" if carry < 0 else f"{roughly(carry)} carry"
        if result["ended"] == "water":
            return f"{story}, into the water"
        side = "short of" if (self.pin - total) * self.pin > 0 else "past"
        return f"{story}, stops {roughly(away)} {side} the pin"

    # Frames

    @cached_property
    def vectors(self) -> Vectors:
        return Vectors(self.run, self.name)

    @cached_property
    def nearest(self) -> float:
        """The nearest that the camera of the frames goes, in px/m."""
        span = float(np.ptp(self.path[:, 1]))
        return self.size[0] / min(WIDEST_VIEW, max(0.35 * span, 100 * self.radius))

    @cached_property
    def frame_course(self) -> Course:
        return self._course(self.frame_base, self.nearest)

    @cached_property
    def follow(self) -> Follow:
        """The camera of the frames: near the ball, far enough for the ground to stay in sight."""
        course, width = self.frame_course, self.size[0]
        times = np.linspace(0.0, self.run.duration, max(2, min(MOST_SAMPLES, round(self.run.duration * 60))))
        states = np.array([self.run.state(self.name, t) for t in times])
        ground = np.interp(states[:, 0], course.line[:, 0], course.line[:, 1])
        room = 0.8 * (course.base - self.rows_at.top)
        high = room / np.maximum(states[:, 1] - ground, 1e-9)
        fast = 0.6 * width / (SIGHT * np.maximum(np.hypot(states[:, 2], states[:, 3]), 1e-9))
        scales = np.minimum(self.nearest, np.minimum(high, fast))
        ahead = 0.10 * width / scales * np.tanh(states[:, 2] / 3)
        return Follow(times, np.column_stack([states[:, 0] + ahead, ground]), scales, (width / 2, course.base))

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s, seen by a camera that follows the ball."""
        t = min(max(t, 0.0), self.run.duration)
        sheet = self.sheet = Sheet(self.size, on_dark=self.moon)
        painter, unit, course = sheet.painter, self.unit, self.frame_course
        camera = self.follow.camera(t)
        x, y, *_ = self.run.state(self.name, t)
        lowest = course.draw(painter, camera, nice(110 * unit / self.nearest), camera.at[0] * self.nearest)
        course.hole(painter, camera, t, self.wind[0])
        true = self.radius * camera.scale
        radius = max(true, 1.4 * self._smallest)
        at = self._spot(course, camera, x, y, radius)
        height = y - self.radius - course.height(x)
        if height > -0.5 * self.radius:
            near = 1 / (1 + height * camera.scale / (80 * unit))
            below = at[0], camera.pixel(x, course.height(x))[1] + 1
            painter.shadow(below, radius * (2.2 - near), 0.35 * radius, CARD["shadow"], 0.15 + 0.45 * near)
        for ghost in self.ghosts:
            other = ghost.picture
            there = other.run.state(other.name, min(t, other.run.duration))
            place = self._spot(course, camera, there[0], there[1], radius)
            draw_in_frame(sheet, ghost, self._lifted(course, camera, other.path[:, 1:3]), place, self.rows_at.top)
        self._trail(sheet, camera, t, radius)
        self.vectors.draw(sheet, at, radius, t)
        BALL.draw(painter, at, radius, self.run.angle(self.name, t), self.unit, radius > true)
        over, under = sheet.ruler_heights()
        if lowest > self.rows_at.ruler - over:  # the ruler would stand on bright turf
            backing = pygame.Rect(sheet.frame.left, self.rows_at.ruler - over, sheet.frame.width, over + under)
            painter.panel(backing, CARD["background"], 0.5, 10 * unit)
        sheet.ruler(camera, self.rows_at.ruler)
        corner = self._map(sheet, t)
        if any(self.wind):
            sheet.wind(*self.wind, corner.right, corner.bottom + 2 * sheet.gap)
        notes = [f"beside {ghost.label}" for ghost in self.ghosts]
        notes += ["ball drawn larger than it is"] if radius > true else []
        if t >= self.run.duration:
            sheet.headline(self.verdict(), notes, corner.left - sheet.frame.left - 2 * sheet.gap)
        else:
            sheet.headline(metres(x - self.path[0, 1], self._digits), ["from the start", *notes], self.size[0])
        sheet.columns(self.rows_at.card, self.live(t), [ghost.live(t) for ghost in self.ghosts])
        return sheet.surface

    @property
    def _digits(self) -> int:
        """Digits after the point of lengths in m."""
        return 1 if self.run.result["apex"] >= 10 else 2

    def live(self, t: float) -> list[Entry]:
        """What a frame's card says at time t in s."""
        _, y, vx, vy, spin = self.run.state(self.name, t)
        speed = hypot(vx, vy)
        return [
            ("time", f"{t:.2f} s"),
            ("height", metres(max(0.0, y - self.path[0, 2]) if y > 0 else y - self.path[0, 2], self._digits)),
            ("speed", f"{speed:.1f} m/s"),
            ("direction", signed(f"{degrees(atan2(vy, vx)):.0f}") + "°" if speed > 0.01 else "–"),
            ("backspin", signed(f"{spin * 30 / pi:.0f}") + " rpm"),
            *self.vectors.entries(t),
        ]

    def _trail(self, sheet: Sheet, camera: Camera, t: float, radius: float) -> None:
        """Where the ball has just been; kept out of the header."""
        times = np.linspace(max(0.0, t - TRAIL), t, 41)
        points = self._lifted(self.frame_course, camera, np.array([self.run.state(self.name, s)[:2] for s in times]))
        above = np.flatnonzero(points[:, 1] < self.rows_at.top)
        points = points[above[-1] + 1 :] if len(above) else points
        if len(points) > 1:
            sheet.painter.fading(points[apart(points, 2.0)], 1.1 * radius, TRACE["colours"][0], 0.9)

    def _map(self, sheet: Sheet, t: float) -> pygame.Rect:
        """The whole path, small, in the upper right corner, and where on it the ball is."""
        rect, camera, ground, times, path = self._mapped
        others = [(ghost, camera.pixels(ghost.picture.path[:, 1:3])) for ghost in self.ghosts]
        surface, painter, unit = sheet.surface, sheet.painter, self.unit
        thin = max(1, round(1.6 * unit))
        painter.panel(rect, CARD["background"], CARD["opacity"], 8 * unit)
        surface.set_clip(rect)
        painter.thread(ground, thin, self.frame_course.colours["fairway"])
        for ghost, points in others:
            painter.thread(points[apart(points, 1.5)], 1, ghost.light)
        painter.thread(path, 1, CARD["quiet"])
        x, y, *_ = self.run.state(self.name, t)
        at = camera.pixel(x, y)
        painter.thread([*path[times <= t], at], thin + 1, TRACE["colours"][0])
        px, py = camera.pixel(self.pin, self.frame_course.height(self.pin))
        tall = 24 * unit
        pygame.draw.line(surface, GOLF["pole"], (px, py), (px, py - tall), thin)
        painter.polygon([(px, py - tall), (px + 0.6 * tall, py - 0.8 * tall), (px, py - 0.6 * tall)], GOLF["flag"])
        painter.disc(at, max(2.5, 4 * unit), CARD["accent"])
        surface.set_clip(None)
        return rect

    @cached_property
    def _mapped(self) -> tuple[pygame.Rect, Camera, np.ndarray, np.ndarray, np.ndarray]:
        """The map's place, its camera, the ground in px, and times (s) and points (px) of the path."""
        sheet, course = Sheet(self.size, on_dark=self.moon), self.frame_course
        inset = 2.4 * sheet.gap
        x, y = np.concatenate([self.path, *(ghost.picture.path for ghost in self.ghosts)])[:, 1:3].T
        left, right = min(float(x.min()), self.pin), max(float(x.max()), self.pin)
        low, high = course.lowest_and_highest(left, right)
        world = Box(left, low, max(right, left + 60 * self.radius), max(high, float(y.max())))
        width = round(0.24 * self.size[0])
        area = Area(inset, 0, width - 2 * inset, 0.11 * self.size[1])  # on the right the flag needs room too
        camera = Camera.fit(world, area, self.camera.stretch)
        rise = max((world.top - world.bottom) * camera.scale * camera.stretch, 26 * self.unit)
        rect = pygame.Rect(0, 0, width, round(rise + 2 * inset))
        rect.topright = sheet.frame.topright
        anchor = rect.left + camera.anchor[0], rect.bottom - inset
        camera = Camera(camera.at, anchor, camera.scale, camera.stretch)
        edges = (camera.world(px, 0)[0] for px in (rect.left + sheet.gap, rect.right - sheet.gap))
        ground = np.add(camera.pixels(course.between(*edges)), (0, 1))
        path = camera.pixels(self.path[:, 1:3])
        kept = apart(path, 1.5)
        return rect, camera, ground, self.path[kept, 0], path[kept]
