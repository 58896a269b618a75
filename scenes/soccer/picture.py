"""Soccer from the side: the kick's path over the wall to the goal, on an evening under the lamps."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import atan2, degrees, hypot, pi
from typing import Any

import numpy as np
import pygame

from sandbox.picture.ball import enlarged, least_radius, mark_radius
from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.chase import Chase
from sandbox.picture.ghosts import draw_ghost, draw_in_frame, ghosts_of, label_ghost
from sandbox.picture.painter import Painter
from sandbox.picture.palette import mix, palette
from sandbox.picture.path import Path, apart, chip, draw_trace, mark_impacts
from sandbox.picture.sheet import Entry, Sheet, metres, roughly, signed, times
from sandbox.picture.vectors import Vectors

from .stadium import BALL, Stadium

CARD, GROUND = palette("card"), palette("soccer")

#: Room for the kicker behind the ball, and least height that is shown, in m.
KICKER, LEAST_TOP = 1.5, 2.7
#: The goal is left out of the poster when the path would take up less than this share of the way to it.
LEAST_PATH = 0.15
#: The time between balls is chosen for the flight, or for this share of the whole path.
LEAST_SPAN = 0.25
#: Frames show this much of the world's length in m, where the poster shows more.
NEAREST_VIEW = 36.0
#: s of path that the trail behind the ball shows.
TRAIL = 0.6
#: Impacts are labelled down to this speed in m/s; slower ones are marked.
LEAST_LABELLED = 1.5


class Picture:
    """Draws one kick at ``size`` px: as a poster, or as it is at a time t."""

    #: Colours of other runs.
    EARLIER = GROUND["earlier"]

    def __init__(
        self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720), ghosts: Mapping[str, Any] | None = None
    ):
        self.run, self.parameters, self.size = run, parameters, size
        self.ghosts = ghosts_of(Picture, ghosts or {}, size)
        self.path = Path(run, "ball", self._settled(run))
        self.radius = self.path.radius
        self.wind: tuple[float, float] = parameters.air.wind
        sheet = Sheet(size)
        self.unit, self.rows = sheet.unit, sheet.rows
        self.rows_at = sheet.side_rows(len(self.ghosts), lengths=2)
        self.stadium = Stadium(parameters, size, self.rows_at.base)
        self._standing: tuple[Camera, pygame.Surface] | None = None

    @staticmethod
    def _settled(run: Any) -> float:
        """When the story is told, in s: a ball in the goal has come to the ground, any other has stopped."""
        if not run.result["goal"]:
            return float(run.duration)
        down = (
            e.t for e in run.events if e.kind == "impact" and e.partner == "ground" and e.t > run.result["flight_time"]
        )
        return float(next(down, run.duration))

    # Composition

    @cached_property
    def camera(self) -> Camera:
        """Shows the whole path, the kicker and the goal, unless that would make the path too small to see."""
        x, y = np.concatenate([self.path.points, *(ghost.picture.path.points for ghost in self.ghosts)]).T
        goal, side = self.parameters.goal, 0.085 * self.size[0]
        left, right = min(float(x.min()), -KICKER), float(x.max())
        top = max(float(y.max()) + self.radius, LEAST_TOP)
        reach = max(right, goal.distance + goal.depth)
        if max(right - left, top) >= LEAST_PATH * (reach - left):
            right = reach
            top = max(top, goal.height + 0.3) if goal.present else top
        area = Area(side, self.rows_at.top + 24 * self.unit, self.size[0] - side, self.stadium.base)
        return Camera.fit(Box(left, 0.0, right, top), area)

    # For the window

    def stage(self) -> pygame.Surface:
        """The place alone, as the poster's camera sees it."""
        sheet, eye = Sheet(self.size), self.stadium.eye(self.camera)
        self.stadium.draw(sheet.painter, eye)
        self.stadium.behind(sheet.painter, eye)
        self.stadium.before(sheet.painter, eye)
        return sheet.surface

    def view(self, t: float) -> Camera:
        """The camera of ``frame(t)``."""
        return self.chase.camera(t)

    def draw_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """The ball at time t in s, on the stage that the camera sees."""
        true = self.radius * camera.scale
        radius = max(true, self._smallest)
        x, y, *_ = self.run.state("ball", t)
        at = self._spot(camera, x, y, radius)
        BALL.draw(painter, at, radius, self.run.angle("ball", t), self.unit, radius > true)

    # The poster

    def poster(self) -> pygame.Surface:
        """The whole kick in one picture."""
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        camera, stadium, painter = self.camera, self.stadium, sheet.painter
        eye = stadium.eye(camera)
        stadium.draw(painter, eye)
        stadium.behind(painter, eye)
        self.trace = self.path.traced(camera)
        others = [(ghost, camera.pixels(ghost.picture.path.points)) for ghost in self.ghosts]
        for ghost, points in others:
            draw_ghost(sheet, ghost, points)
        draw_trace(sheet, self.trace, GROUND["trace"])
        stadium.before(painter, eye)
        self._distances(sheet, camera)
        sheet.ruler(camera, self.rows_at.ruler)
        self._clearances(sheet, camera)
        labelled = [mark for mark in self.path.marks() if mark.speed >= LEAST_LABELLED]
        mark_impacts(sheet, camera, labelled, lambda mark: True)
        every = self._balls(sheet, camera)
        right = sheet.frame.right
        if any(self.wind):
            right = sheet.wind(*self.wind, right, sheet.frame.top).left
        notes = [*(ghost.note for ghost in self.ghosts), f"a ball every {every:g} s"]
        if not self._in_sight(camera, self.parameters.goal.distance):
            notes.append(f"the goal is {roughly(self.parameters.goal.distance)} away")
        elif (factor := stadium.enlarged(camera)) > 1:
            wall, goal = self.parameters.wall.present, self.parameters.goal.present
            who = "players and goal" if wall and goal else "goal" if goal else "players"
            notes.append(f"{who} drawn {times(factor)} {'its' if who == 'goal' else 'their'} size")
        if (factor := enlarged(self.radius, camera, self.rows)) > 1:
            notes.append(f"ball drawn {times(factor)} its size")
        sheet.headline(self.verdict(), notes, right - sheet.frame.left - 2 * sheet.gap)
        sheet.columns(self.rows_at.card, self.numbers(), [ghost.row for ghost in self.ghosts])
        for ghost, points in others:
            label_ghost(sheet, ghost, points, self.trace)
        return sheet.surface

    def _in_sight(self, camera: Camera, x: float) -> bool:
        return 0 < camera.pixel(x, 0)[0] < self.size[0]

    @property
    def _smallest(self) -> float:
        """Least radius of the ball in px."""
        return least_radius(self.rows)

    def _spot(self, camera: Camera, x: float, y: float, radius: float) -> tuple[float, float]:
        """Where in px a ball drawn with ``radius`` px goes: on the path, and not into the ground."""
        px, py = camera.pixel(x, y)
        return px, min(py, self.stadium.base - radius)

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
            size = largest if last else radius
            at = self._spot(camera, x, y, size)
            BALL.draw(sheet.painter, at, size, self.run.angle("ball", t), self.unit, last and largest > true)
        return every

    def _distances(self, sheet: Sheet, camera: Camera) -> None:
        """How far wall and goal are, along the ground."""
        wall, goal, start = self.parameters.wall, self.parameters.goal, camera.pixel(0, 0)[0]
        for row, (name, thing) in zip(self.rows_at.lengths, (("goal", goal), ("wall", wall)), strict=False):
            end = camera.pixel(thing.distance, 0)[0]
            if thing.present and self._in_sight(camera, thing.distance) and end - start > 12 * self.unit:
                sheet.dimension(f"{name} {metres(thing.distance)}", row, start, end, CARD["text"])
                tall = round(8 * self.unit)
                sheet.labels.take(pygame.Rect(round(start), round(row) - tall // 2, round(end - start), tall))

    def _clearances(self, sheet: Sheet, camera: Camera) -> None:
        """How far the ball passes over the heads and under the bar."""
        wall, goal, result = self.parameters.wall, self.parameters.goal, self.run.result
        if wall.present and result["height_at_wall"] is not None:
            low = result["height_at_wall"] - self.radius
            if low > wall.height:
                self._clearance(sheet, camera, wall.distance, wall.height, low, "over the wall")
        if goal.present and result["height_at_goal"] is not None:
            high, low = result["height_at_goal"] + self.radius, result["height_at_goal"] - self.radius
            if high < goal.height:
                self._clearance(sheet, camera, goal.distance, high, goal.height, "under the bar")
            elif low > goal.height:
                bar = goal.height + 2 * goal.post_radius
                self._clearance(sheet, camera, goal.distance, bar, low, "over the bar")

    def _clearance(self, sheet: Sheet, camera: Camera, x: float, low: float, high: float, text: str) -> None:
        """A stroke from one height to another at x, all in m, and how long it is."""
        unit = self.unit
        (px, top), (_, bottom) = camera.pixel(x, high), camera.pixel(x, low)
        if bottom - top > 3 * unit:
            sheet.painter.line([(px, top), (px, bottom)], 1.6 * unit, CARD["accent"])
            for y in (top, bottom):
                sheet.painter.line([(px - 4 * unit, y), (px + 4 * unit, y)], 1.6 * unit, CARD["accent"])
        path = self.trace[np.argmin(np.abs(self.trace[:, 0] - px))]
        spots = [
            (px + side * aside * unit, edge + way * far * unit, side * 0.7 if aside else 0.0, way)
            for far in (12, 20, 32, 46)
            for edge, way in ((min(top, path[1]), -1), (max(bottom, path[1]), 1))
            for aside, side in ((0, 0), (10, -1), (10, 1))
        ]
        chip(sheet, f"{metres(high - low)} {text}", spots, CARD["accent"])

    def verdict(self) -> str:
        """What happened, in one line."""
        result, goal = self.run.result, self.parameters.goal
        verdict = result["verdict"]
        if verdict == "goal":
            height = result["height_at_goal"]
            under = None if height is None else goal.height - height - self.radius
            return "Goal" if under is None or under < 0 else f"Goal, {roughly(under)} under the bar"
        if verdict == "over":
            over = result["height_at_goal"] - self.radius - goal.height - 2 * goal.post_radius
            return f"Over the bar by {roughly(over)}" if over > 0 else "Just over the bar"
        if verdict in ("bar", "wall"):
            return "Off the bar" if verdict == "bar" else "Into the wall"
        x = self.run.state("ball", self.run.duration)[0]
        if verdict == "past":
            return f"{roughly(abs(x))} up the field"
        if result["ended"] == "duration":
            return f"Still under way after {self.run.duration:.0f} s"
        if x < 0:
            return f"Ends {roughly(-x)} behind the kick"
        away = goal.distance - x
        return f"Short, {roughly(away)} from the goal" if away > 0 else "Short of the goal"

    def numbers(self) -> list[Entry]:
        """The result for the card."""
        result, launch = self.run.result, self.parameters.launch
        at_wall, at_goal = result["height_at_wall"], result["height_at_goal"]
        numbers = []
        if at_goal is not None:
            numbers += [("height at goal", metres(at_goal)), ("speed at goal", f"{result['speed_at_goal']:.1f} m/s")]
        elif result["carry"] is not None:
            numbers.append(("carry", metres(result["carry"])))
        if self.parameters.wall.present and at_wall is not None:
            numbers.append(("height at wall", metres(at_wall)))
        return [
            *numbers,
            ("apex", metres(result["apex"])),
            ("flight time", "–" if result["flight_time"] is None else f"{result['flight_time']:.2f} s"),
            ("ball speed", f"{launch.speed:.1f} m/s"),
            ("launch", signed(f"{launch.angle:.1f}") + "°"),
            ("spin", _spin(launch.spin)),
        ]

    # Frames

    @cached_property
    def vectors(self) -> Vectors:
        return Vectors(self.run, "ball")

    @cached_property
    def chase(self) -> Chase:
        """The camera of the frames: the poster's, or nearer, and then along with the ball."""
        home, width = self.camera, self.size[0]
        columns = 0.1 * width, 0.9 * width
        if home.scale < width / NEAREST_VIEW:
            ahead = 0.25 if self.parameters.launch.angle <= 90 else 0.75
            home = Camera((0.0, 0.0), (ahead * width, self.stadium.base), width / NEAREST_VIEW)
            columns = 0.25 * width, 0.6 * width
        return Chase(self.run, "ball", home, columns, self.rows_at.top, np.zeros_like)

    def frame(self, t: float) -> pygame.Surface:
        """The scene at time t in s, seen by a camera that follows the ball."""
        t = min(max(t, 0.0), self.run.duration)
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        painter, unit, camera = sheet.painter, self.unit, self.view(t)
        sheet.surface.blit(self._backdrop(camera), (0, 0))
        x, y, *_ = self.run.state("ball", t)
        true = self.radius * camera.scale
        radius = max(true, 1.3 * self._smallest)
        at = self._spot(camera, x, y, radius)
        near = 1 / (1 + max(0.0, y - self.radius) * camera.scale / (80 * unit))
        painter.shadow(
            (at[0], self.stadium.base + unit), radius * (2.2 - near), 0.35 * radius, CARD["shadow"], 0.15 + 0.45 * near
        )
        for ghost in self.ghosts:
            other = ghost.picture
            there = other.run.state("ball", min(t, other.run.duration))
            place = self._spot(camera, there[0], there[1], true)
            draw_in_frame(sheet, ghost, camera.pixels(other.path.points), place)
        self._trail(sheet, camera, t, radius)
        self.vectors.draw(sheet, at, radius, t)
        BALL.draw(painter, at, radius, self.run.angle("ball", t), unit, radius > true)
        self.stadium.before(painter, self.stadium.eye(camera))
        sheet.ruler(camera, self.rows_at.ruler)
        right = sheet.frame.right
        if any(self.wind):
            right = sheet.wind(*self.wind, right, sheet.frame.top).left
        notes = [f"compared with {ghost.label}" for ghost in self.ghosts]
        notes += ["ball drawn larger than it is"] if radius > true else []
        if t >= self.path.until:
            sheet.headline(self.verdict(), notes, right - sheet.frame.left - 2 * sheet.gap)
        else:
            sheet.headline(metres(x), ["from the kick", *notes], self.size[0])
        sheet.columns(self.rows_at.card, self.live(t), [ghost.live(t) for ghost in self.ghosts])
        return sheet.surface

    def live(self, t: float) -> list[Entry]:
        """What a frame's card says at time t in s."""
        _, y, vx, vy, spin = self.run.state("ball", t)
        speed = hypot(vx, vy)
        return [
            ("time", f"{t:.2f} s"),
            ("height", metres(max(0.0, y - self.radius))),
            ("speed", f"{speed:.1f} m/s"),
            ("direction", signed(f"{degrees(atan2(vy, vx)):.0f}") + "°" if speed > 0.01 else "–"),
            ("spin", _spin(spin * 30 / pi)),
            *self.vectors.entries(t),
        ]

    def _backdrop(self, camera: Camera) -> pygame.Surface:
        """What stands still behind the ball; kept while the camera does."""
        if self._standing is None or self._standing[0] != camera:
            sheet, eye = Sheet(self.size), self.stadium.eye(camera)
            self.stadium.draw(sheet.painter, eye, (camera.at[0] - self.chase.home.at[0]) * self.chase.home.scale)
            self.stadium.behind(sheet.painter, eye)
            self._standing = camera, sheet.surface
        return self._standing[1]

    def _trail(self, sheet: Sheet, camera: Camera, t: float, width: float) -> None:
        """Where the ball has been: a thin line, and a thick one of late."""
        x, y, *_ = self.run.state("ball", t)
        earlier = camera.pixels(np.array([*self.path.points[self.path.samples[:, 0] < t], (x, y)]))
        if len(earlier) > 1:
            faint = mix(GROUND["trace"], GROUND["grass"][0], 0.4)
            sheet.painter.thread(earlier[apart(earlier, 3.0)], self.unit, faint)
        moments = np.linspace(max(0.0, t - TRAIL), t, 25)
        places = [self.run.state("ball", s)[:2] for s in moments]
        points = np.array([self._spot(camera, x, y, 0.4 * width) for x, y in places])
        if np.ptp(points, axis=0).max() > 2:
            sheet.painter.fading(points[apart(points, 2.0)], width, GROUND["trace"], 0.9)


def _spin(rpm: float) -> str:
    """Backspin is positive."""
    return f"{abs(rpm):.0f} rpm {'top' if rpm < 0 else 'back'}" if abs(rpm) >= 0.5 else "none"
