"""Billiards from above: the table under its lamp, the way of each ball, and what was struck where."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import floor, hypot, pi
from typing import Any

import numpy as np
import pygame

from sandbox.picture import sphere
from sandbox.picture.ball import SMALLEST
from sandbox.picture.camera import Camera
from sandbox.picture.ghosts import draw_ghost, draw_in_frame, ghosts_of, label_ghost
from sandbox.picture.painter import Painter
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.path import Path, apart, draw_mark, label_mark
from sandbox.picture.sheet import Entry, Sheet, nice
from sandbox.picture.vectors import Vectors
from sandbox.sport.amounts import signed

from . import balls
from .backdrop import backdrop, outside

CARD, TRACE, BILLIARDS = palette("card"), palette("trace"), palette("billiards")

#: s of path that the trails behind the balls show.
TRAIL = 0.5
#: The path is sampled this often in s; of a long run, in so many pieces.
SAMPLING, MOST_SAMPLES = 1 / 60, 3000
#: A ball that goes no further than this, in radii, has no trace of its own.
LEAST_WAY = 0.3
#: Width of traces, px on 720 rows: of the struck ball, of the others.
LOUD, QUIET = 4.2, 2.4
#: Balls are lit from the left above, so their shadows lie to the right below; in radii.
SHADOW = (0.34, 0.42)


class Picture:
    """Draws one run of billiards at ``size`` px: as a poster, or as it is at a time t."""

    def __init__(
        self, run: Any, parameters: Any, size: tuple[int, int] = (1280, 720), ghosts: Mapping[str, Any] | None = None
    ):
        self.run, self.parameters, self.size = run, parameters, size
        self.ghosts = ghosts_of(Picture, ghosts or {}, size)
        self.struck = parameters.cue.ball
        self.radius = run.setup.balls[0].radius
        self.names = [ball.name for ball in run.setup.balls]
        sheet = self.sheet = Sheet(size, on_dark=True)
        self.unit = sheet.unit
        self.head_row, self.card_row = sheet.top_row - sheet.gap, sheet.card_row(len(self.ghosts))

    @cached_property
    def camera(self) -> Camera:
        """The whole table between headline and card, in their middle."""
        table = outside(self.run.setup, self.parameters.table)
        frame, gap = self.sheet.frame, 2 * self.sheet.gap
        width, height = frame.width, self.card_row - self.head_row - 2 * gap
        scale = min(width / (table.right - table.left), height / (table.top - table.bottom))
        return Camera((0.0, 0.0), (self.size[0] / 2, (self.head_row + self.card_row) / 2), scale)

    def view(self, t: float) -> Camera:
        """The camera of the frame at time t: the table stands still."""
        return self.camera

    def stage(self) -> pygame.Surface:
        """Room and table, without balls and text."""
        return self._backdrop.copy()

    @property
    def _backdrop(self) -> pygame.Surface:
        return backdrop(self.run.setup, self.parameters.table, self.camera, self.size)

    # Balls

    def _radius(self, camera: Camera) -> float:
        """Of a ball as it is drawn, in px."""
        return max(self.radius * camera.scale, SMALLEST / 2)

    @cached_property
    def _turnings(self) -> dict[str, sphere.Turning]:
        return {name: balls.turning(self.run, name) for name in self.names}

    def _on_table(self, t: float) -> list[str]:
        caught = {name: self.run.caught_at(name) for name in self.names}
        return [name for name, at in caught.items() if at is None or t < at]

    def draw_balls(self, painter: Painter, camera: Camera, t: float) -> None:
        """The balls that are on the table at time t, turned as they are."""
        radius = self._radius(camera)
        present = [(name, camera.pixel(*self.run.state(name, t)[:2])) for name in self._on_table(t)]
        for _, (x, y) in present:
            at = x + SHADOW[0] * radius, y + SHADOW[1] * radius
            painter.shadow(at, 1.02 * radius, 0.98 * radius, BILLIARDS["room_shadow"], 0.62)
        for name, at in present:
            self._ball(painter, at, radius, name, self._turnings[name].at(t))

    @staticmethod
    def _ball(painter: Painter, at: tuple[float, float], radius: float, name: str, matrix: np.ndarray) -> None:
        painter.disc(at, radius + 0.4, BILLIARDS["rim"], 0.5)
        sphere.draw(painter, at, radius, balls.skin(name), matrix)

    # Paths

    @cached_property
    def paths(self) -> dict[str, np.ndarray]:
        """Of each ball that moved, t, x and y (s and m) until it rests or is caught."""
        return {name: path for name in self.names if len(path := self._path(name)) > 1}

    def _path(self, name: str) -> np.ndarray:
        """Until it rests; straight pieces have no points between."""
        run = self.run
        every = max(SAMPLING, run.duration / MOST_SAMPLES)
        times = [0.0]
        for arc in run.arcs[name]:
            if hypot(*arc.state(arc.t0)[2:4]) > 0 or hypot(*arc.state(arc.t1)[2:4]) > 0:
                pieces = 1 + floor((arc.t1 - arc.t0) / every)
                times += [arc.t0 + (arc.t1 - arc.t0) * (i + 1) / pieces for i in range(pieces)]
        points = np.array([(t, *run.state(name, t)[:2]) for t in times])
        return points if np.hypot(*np.ptp(points[:, 1:], axis=0)) > LEAST_WAY * self.radius else points[:1]

    @cached_property
    def colours(self) -> dict[str, Colour]:
        """Of each trace: the struck ball's the loudest, the others' in the order in which they set off."""
        first, *others = BILLIARDS["traces"]
        movers = sorted(
            (path[min(1, len(path) - 1), 0], name) for name, path in self.paths.items() if name != self.struck
        )
        return {self.struck: first} | {name: others[i % len(others)] for i, (_, name) in enumerate(movers)}

    # The poster

    def poster(self) -> pygame.Surface:
        """The whole run in one picture."""
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        sheet.surface.blit(self._backdrop, (0, 0))
        painter, camera, unit = sheet.painter, self.camera, self.unit
        radius = self._radius(camera)
        for name in self.paths:
            at = camera.pixel(*self.run.state(name, 0.0)[:2])
            painter.ring(at, radius - 0.5 * unit, max(1.0, 1.1 * unit), BILLIARDS["start"], 0.75)
        for name, path in self.paths.items():
            if name != self.struck:
                self._trace(painter, path, QUIET * unit, self.colours[name])
        every = 0.0
        others = [
            (ghost, camera.pixels(ghost.picture.paths[ghost.picture.struck][:, 1:]))
            for ghost in self.ghosts
            if ghost.picture.struck in ghost.picture.paths
        ]
        for ghost, points in others:
            draw_ghost(sheet, ghost, points)
        if self.struck in self.paths:
            self._trace(painter, self.paths[self.struck], LOUD * unit, self.colours[self.struck])
            every = self._marks(painter)
        self.draw_balls(painter, camera, self.run.duration)
        self._impacts(sheet, radius)
        self._scale(sheet)
        right = self._head(sheet, self.run.duration)
        notes = [ghost.note for ghost in self.ghosts]
        notes += [f"a dot every {every:g} s"] if every else []
        sheet.headline(
            self.run.scene.verdict(self.run), [*notes, *self._notes()], right - sheet.frame.left - 3 * sheet.gap
        )
        sheet.columns(self.card_row, self.run.scene.rows(self.run), [ghost.row for ghost in self.ghosts])
        own = camera.pixels(self.paths.get(self.struck, np.zeros((1, 3)))[:, 1:])
        for ghost, points in others:
            label_ghost(sheet, ghost, points, own)
        return sheet.surface

    def _notes(self) -> list[str]:
        factor = self._radius(self.camera) / (self.radius * self.camera.scale)
        return [f"balls drawn {factor:.1f} times their size"] if factor > 1.001 else []

    def _trace(self, painter: Painter, path: np.ndarray, width: float, colour: Colour) -> None:
        points = self.camera.pixels(path[:, 1:])
        painter.trace(points[apart(points, 1.0)], max(1.2, width), colour, BILLIARDS["rim"], max(0.6, 0.9 * self.unit))

    def _marks(self, painter: Painter) -> float:
        """Dots on the struck ball's trace at even times; returns the time between in s."""
        path = self.paths[self.struck]
        every = nice(path[-1, 0] / 16)
        last = (-1e9, 0.0)
        for i in range(1, floor(path[-1, 0] / every) + 1):
            at = self.camera.pixel(*self.run.state(self.struck, i * every)[:2])
            if hypot(at[0] - last[0], at[1] - last[1]) > 7 * self.unit:
                painter.disc(at, max(1.4, 2.3 * self.unit), BILLIARDS["rim"])
                painter.disc(at, max(0.9, 1.5 * self.unit), BILLIARDS["ivory"])
                last = at
        return every

    def _impacts(self, sheet: Sheet, radius: float) -> None:
        """What the struck ball met, and how hard."""
        camera = self.camera
        sheet.labels.take(pygame.Rect(0, self.card_row, *self.size))
        for path in self.paths.values():
            points = camera.pixels(path[:, 1:])
            sheet.labels.take_path(_evenly(points, 5 * self.unit), 2 * self.unit)
        for name in self._on_table(self.run.duration):
            x, y = camera.pixel(*self.run.state(name, self.run.duration)[:2])
            sheet.labels.take(pygame.Rect(x - radius, y - radius, 2 * radius, 2 * radius))
        marked: list[tuple[float, float]] = []
        for mark in sorted(Path(self.run, self.struck).marks(), key=lambda mark: -mark.speed):
            at = camera.pixel(*mark.at)
            if all(hypot(at[0] - x, at[1] - y) > 2 * radius for x, y in marked):  # of several the hardest
                marked.append(at)
                draw_mark(sheet, at)
                label_mark(sheet, at, mark.towards, f"{mark.speed:.1f} m/s")

    def _scale(self, sheet: Sheet) -> None:
        """A scale bar on the floor beside the table, where there is room."""
        table = outside(self.run.setup, self.parameters.table)
        right, bottom = self.camera.pixel(table.left, table.bottom)
        room = right - sheet.frame.left - 4 * sheet.gap
        if room > 5 * sheet.lettering.height("small"):
            sheet.scale_bar(self.camera, sheet.frame.left, bottom, room)

    def _head(self, sheet: Sheet, t: float) -> float:
        """At the top right where the tip meets the ball, and what is potted; returns where it begins, in px."""
        painter, unit, frame = sheet.painter, self.unit, sheet.frame
        label = frame.top + sheet.lettering.height("small")
        radius = (self.head_row - label - sheet.gap) / 2
        centre = frame.right - radius, self.head_row - radius
        self._tip(painter, centre, radius)
        sheet.write("tip", "small", (centre[0], label), CARD["quiet"], "midbottom")
        left = centre[0] - radius
        potted = [name for name in self.run.result["potted"] if self.run.caught_at(name) <= t]
        if not potted:
            return left
        size = max(5.0, 12 * unit)
        wide = (2.25 * len(potted) + 0.75) * size
        rect = pygame.Rect(0, 0, round(max(wide, sheet.lettering.width("potted", "small"))), round(3 * size))
        rect.midright = round(left - 4 * sheet.gap), round(centre[1])
        painter.panel(rect, CARD["background"], CARD["opacity"], rect.height / 2)
        sheet.write("potted", "small", (rect.centerx, label), CARD["quiet"], "midbottom")
        for i, name in enumerate(potted):
            at = rect.centerx + (i - (len(potted) - 1) / 2) * 2.25 * size, rect.centery
            self._ball(painter, at, size, name, balls.NUMBER_UP)
        return rect.left

    def _tip(self, painter: Painter, centre: tuple[float, float], radius: float) -> None:
        """The struck ball from behind, with a dot where the tip meets it."""
        x, y = centre
        painter.disc(centre, radius, BILLIARDS["ivory"])
        painter.ring(centre, radius / 2, max(1.0, self.unit), BILLIARDS["numeral"], 0.2)
        for dx, dy in ((radius, 0.0), (0.0, radius)):
            ends = [(x - 0.8 * dx, y - 0.8 * dy), (x + 0.8 * dx, y + 0.8 * dy)]
            painter.line(ends, max(1.0, self.unit), BILLIARDS["numeral"], 0.25)
        cue = self.parameters.cue
        painter.disc((x + cue.english * radius, y - cue.follow * radius), max(2.0, 0.2 * radius), BILLIARDS["chalk"])

    # Frames

    @cached_property
    def vectors(self) -> Vectors:
        """Of the struck ball."""
        return Vectors(self.run, self.struck)

    def frame(self, t: float) -> pygame.Surface:
        """The table at time t in s."""
        t = min(max(t, 0.0), self.run.duration)
        sheet = self.sheet = Sheet(self.size, on_dark=True)
        sheet.surface.blit(self._backdrop, (0, 0))
        painter, camera = sheet.painter, self.camera
        radius = self._radius(camera)
        for ghost in self.ghosts:
            other = ghost.picture
            if other.struck in other.paths:
                place = camera.pixel(*other.run.state(other.struck, min(t, other.run.duration))[:2])
                draw_in_frame(sheet, ghost, camera.pixels(other.paths[other.struck][:, 1:]), place)
        self._earlier(painter, t)
        for name in self.paths:
            self._trail(painter, name, t, radius)
        if self.struck in self._on_table(t):
            self.vectors.draw(sheet, camera.pixel(*self.run.state(self.struck, t)[:2]), radius, t)
        self.draw_balls(painter, camera, t)
        right = self._head(sheet, t)
        headline = self.run.scene.verdict(self.run) if t >= self.run.duration else self._story(t)
        notes = [*self._notes(), *(f"compared with {ghost.label}" for ghost in self.ghosts)]
        sheet.headline(headline, notes, right - sheet.frame.left - 3 * sheet.gap)
        sheet.columns(self.card_row, self.live(t), [ghost.live(t) for ghost in self.ghosts])
        return sheet.surface

    @cached_property
    def _tracks(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Of each path times in s and points in px; the struck ball's last, to be drawn over the others."""
        tracks = {}
        for name in sorted(self.paths, key=lambda name: name == self.struck):
            path = self.paths[name]
            points = self.camera.pixels(path[:, 1:])
            kept = apart(points, 2.0)
            tracks[name] = path[kept, 0], points[kept]
        return tracks

    def _earlier(self, painter: Painter, t: float) -> None:
        """Where the balls have been: a thin line each."""
        for name, (times, points) in self._tracks.items():
            past = int(np.searchsorted(times, t))
            if past > 0:
                here = np.interp(t, times, points[:, 0]), np.interp(t, times, points[:, 1])
                faint = mix(self.colours[name], BILLIARDS["cloth"], 0.35 if name == self.struck else 0.55)
                painter.thread(np.vstack([points[:past], here]), self.unit, faint)

    def _trail(self, painter: Painter, name: str, t: float, radius: float) -> None:
        path = self.paths[name]
        end = min(t, path[-1, 0])
        if t - end >= TRAIL or end <= 0:
            return
        start = max(0.0, t - TRAIL)
        inside = (path[:, 0] > start) & (path[:, 0] < end)
        times = np.array([start, *path[inside, 0], end])
        points = self.camera.pixels(np.column_stack([np.interp(times, path[:, 0], path[:, i]) for i in (1, 2)]))
        kept = points[apart(points, 1.5)]
        if np.hypot(*np.diff(kept, axis=0).T).sum() > 2:
            painter.fading(kept, 1.1 * radius, self.colours[name], 0.85)

    def _story(self, t: float) -> str:
        """The last thing that is worth telling."""
        said = f"Struck at {self.parameters.cue.speed:.1f} m/s"
        first = self._first_contact
        for event in self.run.events:
            if event.t > t:
                break
            if event.kind == "caught":
                said = f"{_called(event.ball)} into the {event.partner}"
            elif event is first:
                said = f"Meets {_called(self.run.result['first_contact'])} at {event.speed:.1f} m/s"
        return said[0].upper() + said[1:]

    @property
    def _first_contact(self) -> Any:
        """The first impact of the struck ball on another, or None."""
        pair = {self.struck, self.run.result["first_contact"]}
        return next((e for e in self.run.events if e.kind == "impact" and {e.ball, e.partner} == pair), None)

    def live(self, t: float) -> list[Entry]:
        """What a frame's card says at time t in s."""
        run = self.run
        present = self._on_table(t)
        speeds = {name: hypot(*run.state(name, t)[2:4]) for name in present}
        entries: list[Entry] = [("time", f"{t:.2f} s")]
        spin = run.state(self.struck, t)[4]
        if self.struck in present:
            entries += [
                ("speed", f"{speeds[self.struck]:.2f} m/s"),
                ("side spin", signed(f"{-spin * 30 / pi:.0f}") + " rpm"),
            ]
        else:
            entries += [("speed", "–"), ("side spin", "–")]
        entries.append(("moving", str(sum(speed > 0 for speed in speeds.values()))))
        rails = sum(e.kind == "impact" and e.partner.endswith(" cushion") and e.t <= t for e in run.events)
        entries.append(("cushions", str(rails)))
        return entries + (self.vectors.entries(t) if self.struck in present else [("cloth", "–")])


def _evenly(points: np.ndarray, step: float) -> np.ndarray:
    """Points every ``step`` px along a line."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    at = np.arange(0.0, along[-1] + step, step)
    return np.column_stack([np.interp(at, along, points[:, axis]) for axis in (0, 1)])


def _called(name: str) -> str:
    return f"the {name}"
