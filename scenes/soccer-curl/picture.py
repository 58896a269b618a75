"""Soccer from above: how far the kick bends from its straight line, round the wall and past the keeper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from math import atan2, cos, degrees, hypot, pi, radians, sin, tan
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import enlarged, least_radius, mark_radius
from sandbox.picture.camera import Camera, Follow
from sandbox.picture.ghosts import draw_ghost, draw_in_frame, ghosts_of, label_ghost
from sandbox.picture.painter import Painter
from sandbox.picture.palette import mix, palette
from sandbox.picture.path import MOST_SAMPLES, Path, apart, chip, draw_trace, mark_impacts
from sandbox.picture.sheet import Entry, Sheet
from sandbox.picture.vectors import Vectors
from sandbox.sport.amounts import metres, times

from .pitch import BALL, Pitch

CARD, PITCH = palette("card"), palette("soccer-curl")

#: Room for the kicker behind the ball, in m.
KICKER = 1.3
#: The poster follows a ball that was stopped for so long, in s.
AFTERMATH = 0.6
#: The time between balls is chosen for the flight, or for this share of the whole path.
LEAST_SPAN = 0.6
#: Frames show this much of the world's length in m, where the poster shows more.
NEAREST_VIEW = 34.0
#: s of path that the trail behind the ball shows.
TRAIL = 0.4


class Picture:
    """Draws one kick at ``size`` px: as a poster, or as it is at a time t."""

    #: Colours of other runs.
    EARLIER = PITCH["earlier"]

    def __init__(
        self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720), ghosts: Mapping[str, Any] | None = None
    ):
        self.run, self.parameters, self.size = run, parameters, size
        self.ghosts = ghosts_of(Picture, ghosts or {}, size)
        touched = next((e.t for e in run.events if "ball" in (e.ball, e.partner)), run.duration)
        until = run.duration if run.result["goal"] else min(run.duration, touched + AFTERMATH)
        self.path = Path(run, "ball", until)
        self.radius = self.path.radius
        self.wind: tuple[float, float] = parameters.air.wind
        self.pitch = Pitch(parameters, size)
        sheet = Sheet(size)
        self.unit, self.rows = sheet.unit, sheet.rows
        self.top_row, self.card_row = sheet.top_row, sheet.card_row(len(self.ghosts))
        self.bar_row = self.card_row - 2.0 * sheet.gap
        self._standing: tuple[Camera, pygame.Surface] | None = None

    # Composition

    @cached_property
    def straight(self) -> tuple[float, float] | None:
        """Where the straight line of the launch meets the goal line, in m; None where it does not."""
        angle, line = self.parameters.launch.angle, self.parameters.goal.distance
        if abs(angle) >= 89.0 or self.run.result["deviation"] is None:
            return None
        return line, line * tan(radians(angle))

    @cached_property
    def camera(self) -> Camera:
        """Shows the whole path, its straight line, the kicker and the goal."""
        goal = self.parameters.goal
        half = goal.width / 2 + 0.4
        points = [
            *self.path.points,
            (-KICKER, 0.0),
            *(point for ghost in self.ghosts for point in ghost.picture.path.points),
            (goal.distance + goal.depth, goal.offset - half),
        ]
        points += [(goal.distance, goal.offset + half)] + ([self.straight] if self.straight else [])
        (left, bottom), (right, top) = np.min(points, axis=0), np.max(points, axis=0)
        side, low, high = 0.085 * self.size[0], self.top_row + 16 * self.unit, self.bar_row - 26 * self.unit
        scale = min((self.size[0] - 2 * side) / (right - left), (high - low) / (top - bottom))
        return Camera(((left + right) / 2, (bottom + top) / 2), (self.size[0] / 2, (low + high) / 2), scale)

    # For the window

    def stage(self) -> pygame.Surface:
        """The place alone, as the poster's camera sees it, without the keeper."""
        surface = Sheet(self.size).surface
        self.pitch.draw(surface, self.camera)
        self.pitch.people(surface, self.camera)
        return surface

    def draw_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """Ball and keeper at time t in s, on the stage that the camera sees."""
        if self.parameters.keeper.present:
            self.pitch.draw_keeper(painter, camera, self.run.state("keeper", t)[:2])
        true = self.radius * camera.scale
        radius = max(true, self._smallest)
        x, y, *_ = self.run.state("ball", t)
        BALL.draw(painter, camera.pixel(x, y), radius, self.run.angle("ball", t), self.unit, radius > true)

    # The poster

    def poster(self) -> pygame.Surface:
        """The whole kick in one picture."""
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        camera, pitch = self.camera, self.pitch
        pitch.draw(sheet.surface, camera)
        pitch.people(sheet.surface, camera)
        self._keeper(sheet, camera)
        self._take_people(sheet, camera)
        self.trace = self.path.traced(camera)
        sheet.labels.take_path(self.trace, 4 * self.unit)
        self._straight_line(sheet, camera)
        others = [(ghost, camera.pixels(ghost.picture.path.points)) for ghost in self.ghosts]
        for ghost, points in others:
            draw_ghost(sheet, ghost, points)
        draw_trace(sheet, self.trace, PITCH["trace"])
        sheet.scale_bar(camera, sheet.frame.left, self.bar_row, 0.3 * sheet.frame.width)
        sheet.labels.take(pygame.Rect(0, self.card_row, *self.size))
        self._deviation(sheet, camera)
        mark_impacts(sheet, camera, self.path.marks(), lambda mark: True)
        every = self._balls(sheet, camera)
        right = sheet.frame.right
        if any(self.wind):
            right = sheet.wind(*self.wind, right, sheet.frame.top).left
        notes = [*(ghost.note for ghost in self.ghosts), f"a ball every {every:g} s"]
        if (factor := pitch.enlarged(camera)) > 1:
            notes.append(f"players drawn {times(factor)} their size")
        if (factor := enlarged(self.radius, camera, self.rows)) > 1:
            notes.append(f"ball drawn {times(factor)} its size")
        sheet.headline(self.run.scene.verdict(self.run), notes, right - sheet.frame.left - 2 * sheet.gap)
        sheet.columns(self.card_row, self.run.scene.rows(self.run), [ghost.row for ghost in self.ghosts])
        for ghost, points in others:
            label_ghost(sheet, ghost, points, self.trace)
        return sheet.surface

    @property
    def _smallest(self) -> float:
        """Least radius of the ball in px."""
        return least_radius(self.rows)

    def _keeper(self, sheet: Sheet, camera: Camera) -> None:
        """The keeper when the ball is at the goal line or touched, and where he stood at the kick."""
        if not self.parameters.keeper.present:
            return
        start, end = self.run.state("keeper", 0.0)[:2], self._keeper_at_end
        if hypot(end[0] - start[0], end[1] - start[1]) * camera.scale > 4 * self.unit:
            sheet.painter.dashes(
                [camera.pixel(*start), camera.pixel(*end)],
                1.3 * self.unit,
                PITCH["shirts"][2],
                4 * self.unit,
                5 * self.unit,
                0.6,
            )
            sheet.painter.ring(
                camera.pixel(*start),
                self.parameters.keeper.radius * camera.scale,
                1.3 * self.unit,
                PITCH["shirts"][2],
                0.5,
            )
        self.pitch.draw_keeper(sheet.painter, camera, end)

    def _take_people(self, sheet: Sheet, camera: Camera) -> None:
        """No label will be put on wall, keeper or kicker."""
        wall, keeper = self.parameters.wall, self.parameters.keeper
        places = [(0.0, 0.0, 1.0, 1.0)]
        if wall.present:
            places.append((wall.distance, wall.offset, 0.4, wall.width / 2))
        if keeper.present:
            places.append((*self._keeper_at_end, keeper.radius, keeper.radius))
        for x, y, ahead, aside in places:
            (left, top), (right, bottom) = camera.pixel(x - ahead, y + aside), camera.pixel(x + ahead, y - aside)
            sheet.labels.take(pygame.Rect(round(left), round(top), round(right - left), round(bottom - top)))

    @property
    def _keeper_at_end(self) -> tuple[float, float]:
        """Where the keeper is when the ball is at the goal line or touched, in m."""
        t = self.run.result["flight_time"]
        x, y, *_ = self.run.state("keeper", self.run.duration if t is None else t)
        return x, y

    def _straight_line(self, sheet: Sheet, camera: Camera) -> None:
        """Where the ball would have gone without spin: to the goal line, or as far as it went."""
        angle = radians(self.parameters.launch.angle)
        end = self.straight
        if end is None:
            far = float(np.hypot(*self.path.points.T).max())
            end = far * cos(angle), far * sin(angle)
        points = camera.pixels(np.array([(0.0, 0.0), end]))
        sheet.painter.dashes(points, 1.5 * self.unit, PITCH["straight"], 7 * self.unit, 6 * self.unit, 0.6)
        self.line = np.linspace(points[0], points[1], 80)
        sheet.labels.take_path(self.line, 2 * self.unit)

    def _balls(self, sheet: Sheet, camera: Camera) -> float:
        """The ball at even times, and at the end; returns the time between in s."""
        true = self.radius * camera.scale
        largest = max(true, self._smallest)
        radius = max(true, mark_radius(self.rows))
        span = max(self.run.result["flight_time"] or 0.0, LEAST_SPAN * self.path.until)
        every, moments = self.path.even_times(span)
        for t in [*moments, self.path.until]:
            x, y, *_ = self.run.state("ball", t)
            last = t == self.path.until
            size, angle = largest if last else radius, self.run.angle("ball", t)
            BALL.draw(sheet.painter, camera.pixel(x, y), size, angle, self.unit, last and largest > true)
        return every

    def _deviation(self, sheet: Sheet, camera: Camera) -> None:
        """How far from its straight line the ball comes to the goal line."""
        deviation = self.run.result["deviation"]
        if self.straight is None or deviation is None:
            return
        unit, accent = self.unit, CARD["accent"]
        start = camera.pixel(*self.straight)
        end = camera.pixel(self.straight[0], self.straight[1] + deviation)
        if abs(end[1] - start[1]) > 12 * unit:
            sheet.painter.arrow(start, end, 2.6 * unit, accent)
        sheet.painter.line([(start[0] - 6 * unit, start[1]), (start[0] + 6 * unit, start[1])], 2.0 * unit, accent)
        sheet.labels.take_path(np.linspace(start, end, 30), 3 * unit)
        way = 1.0 if end[1] < start[1] else -1.0
        spots = [(start[0], start[1] + way * far * unit, 0.0, way) for far in (12, 20)]
        spots += [
            (start[0] + side * far * unit, start[1] + (end[1] - start[1]) * share, side, 0.0)
            for far in (14, 24, 40)
            for share in (0.0, 0.25, 0.5, 0.75)
            for side in (1.0, -1.0)
        ]
        chip(sheet, f"{metres(abs(deviation))} to the {_side(deviation)}", spots, accent)
        beside = [
            (self.line[round(79 * share), 0], self.line[round(79 * share), 1] + way * far * unit)
            for share in (0.62, 0.5, 0.75, 0.38)
            for far in (10, 16, 24)
        ]
        anchor = "midtop" if way > 0 else "midbottom"
        sheet.label("without spin", "small", [(*spot, anchor) for spot in beside], sheet.ink)

    # Frames

    @cached_property
    def vectors(self) -> Vectors:
        return Vectors(self.run, "ball")

    @cached_property
    def follow(self) -> Follow:
        """The camera of the frames: the poster's, or nearer and along with the ball."""
        home, width = self.camera, self.size[0]
        anchor = width / 2, (self.top_row + self.bar_row) / 2
        scale = width / NEAREST_VIEW
        moments = np.linspace(0.0, self.run.duration, max(2, min(MOST_SAMPLES, round(self.run.duration * 60))))
        states = np.array([self.run.state("ball", t) for t in moments])
        if home.scale >= scale:
            scale, anchor, middle = home.scale, home.anchor, home.at
        else:
            middle = self.parameters.goal.distance / 2, self.parameters.goal.offset / 2
        reach = np.array([0.36 * width, 0.36 * (self.bar_row - self.top_row)]) / scale
        at = np.clip(middle, states[:, :2] - reach, states[:, :2] + reach)
        fastest = max(float(np.hypot(states[:, 2], states[:, 3]).max()), 1e-9)
        return Follow(moments, at, np.full(len(moments), scale), anchor, min(0.25, 0.05 * width / scale / fastest))

    def view(self, t: float) -> Camera:
        """The camera of ``frame(t)``, on whole px."""
        camera = self.follow.camera(t)
        at = round(camera.at[0] * camera.scale) / camera.scale, round(camera.at[1] * camera.scale) / camera.scale
        return replace(camera, at=at)

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s, seen by a camera that follows the ball."""
        t = min(max(t, 0.0), self.run.duration)
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        painter, unit, camera = sheet.painter, self.unit, self.view(t)
        if self._standing is None or self._standing[0] != camera:
            self._standing = camera, Sheet(self.size).surface
            self.pitch.draw(self._standing[1], camera)
            self.pitch.people(self._standing[1], camera)
        sheet.surface.blit(self._standing[1], (0, 0))
        if self.parameters.keeper.present:
            self.pitch.draw_keeper(painter, camera, self.run.state("keeper", t)[:2])
        x, y, *_ = self.run.state("ball", t)
        radius = max(self.radius * camera.scale, 1.3 * self._smallest)
        at = camera.pixel(x, y)
        for ghost in self.ghosts:
            other = ghost.picture
            place = camera.pixel(*other.run.state("ball", min(t, other.run.duration))[:2])
            draw_in_frame(sheet, ghost, camera.pixels(other.path.points), place)
        self._trail(sheet, camera, t, radius)
        painter.shadow((at[0] + 0.5 * radius, at[1] + 0.6 * radius), 1.1 * radius, 0.9 * radius, CARD["shadow"], 0.5)
        self.vectors.draw(sheet, at, radius, t)
        large = radius > self.radius * camera.scale
        BALL.draw(painter, at, radius, self.run.angle("ball", t), unit, large)
        sheet.scale_bar(camera, sheet.frame.left, self.bar_row, 0.3 * sheet.frame.width)
        right = sheet.frame.right
        if any(self.wind):
            right = sheet.wind(*self.wind, right, sheet.frame.top).left
        notes = [f"compared with {ghost.label}" for ghost in self.ghosts]
        notes += ["ball drawn larger than it is"] if large else []
        if t >= self.path.until:
            sheet.headline(self.run.scene.verdict(self.run), notes, right - sheet.frame.left - 2 * sheet.gap)
        else:
            away = self.parameters.goal.distance - x
            where = "to the goal line" if away >= 0 else "behind the goal line"
            sheet.headline(metres(abs(away)), [where, *notes], self.size[0])
        sheet.columns(self.card_row, self.live(t), [ghost.live(t) for ghost in self.ghosts])
        return sheet.surface

    def live(self, t: float) -> list[Entry]:
        """What a frame's card says at time t in s."""
        x, y, vx, vy, spin = self.run.state("ball", t)
        angle = radians(self.parameters.launch.angle)
        aside = y * cos(angle) - x * sin(angle)
        return [
            ("time", f"{t:.2f} s"),
            ("off the straight", f"{metres(abs(aside))} {_side(aside)}" if abs(aside) >= 0.005 else "–"),
            ("speed", f"{hypot(vx, vy):.1f} m/s"),
            ("direction", f"{abs(degrees(atan2(vy, vx))):.0f}° {_side(vy)}" if hypot(vx, vy) > 0.01 else "–"),
            ("spin", f"{abs(spin) * 30 / pi:.0f} rpm"),
            *self.vectors.entries(t),
        ]

    def _trail(self, sheet: Sheet, camera: Camera, t: float, width: float) -> None:
        """The straight line of the launch, where the ball has been, and where it was of late."""
        painter, angle = sheet.painter, radians(self.parameters.launch.angle)
        x, y, *_ = self.run.state("ball", t)
        far = hypot(x, y)
        if far * camera.scale > 20 * self.unit:
            ends = [camera.pixel(0.0, 0.0), camera.pixel(far * cos(angle), far * sin(angle))]
            painter.thread(ends, self.unit, mix(PITCH["straight"], PITCH["grass"][0], 0.5))
        earlier = camera.pixels(np.array([*self.path.points[self.path.samples[:, 0] < t], (x, y)]))
        if len(earlier) > 1:
            faint = mix(PITCH["trace"], PITCH["grass"][0], 0.3)
            sheet.painter.thread(earlier[apart(earlier, 3.0)], self.unit, faint)
        moments = np.linspace(max(0.0, t - TRAIL), t, 25)
        points = camera.pixels(np.array([self.run.state("ball", s)[:2] for s in moments]))
        if np.ptp(points, axis=0).max() > 2:
            painter.fading(points[apart(points, 2.0)], width, PITCH["trace"], 0.9)


def _side(amount: float) -> str:
    return "right" if amount < 0.0 else "left"
