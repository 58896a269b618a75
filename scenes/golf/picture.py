"""Golf from the side: a wide sky, the ground cut open along the line of play, and the ball's path over it."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import pygame

from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.painter import Painter
from sandbox.picture.palette import palette
from sandbox.picture.path import FINEST, apart, chip
from sandbox.picture.sheet import Sheet, SideRows, nice
from sandbox.picture.side import Length, SideView
from sandbox.sport.amounts import metres, twice

from .drawing import BALL, COLOURS, Course
from .scene import Parameters

CARD = palette("card")

#: Carry is measured at launch height; a ball that is then at least this far above the ground (px on 720 rows) shows so.
LEAST_DROP = 14
#: Without air, and with gravity below this in m/s^2, it is the Moon.
LEAST_GRAVITY = 5.0
#: Mown stripes are about so wide, and the dashed line under the apex is at least so long, in px on 720 rows.
STRIPE, LEAST_APEX = 70, 44
#: Frames show at most this much of the world's length, in m.
WIDEST_VIEW = 64.0
#: Size of the map in frames, as shares of the picture's width and height.
MAP = 0.24, 0.15


class Picture(SideView[Parameters]):
    """One shot of golf."""

    LOOK = BALL
    HEADROOM = 40
    STRETCHES = 2.0
    LEAST_PATH = 0.2
    LEAST_IMPACT, SOFT, APART = 1.0, 0.25, 30
    TRAIL = 1.4
    LEVEL, ASIDE = 58, 0.5

    @property
    def on_dark(self) -> bool:
        return self.moon

    @cached_property
    def moon(self) -> bool:
        return self.parameters.air.density == 0.0 and self.parameters.gravity < LEAST_GRAVITY

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (self.parameters.pin.distance, 0.0), "the pin"

    @cached_property
    def span(self) -> float:
        """The flight, where there is one to be seen."""
        result, camera = self.run.result, self.camera
        seen = result["apex"] * camera.scale * camera.stretch > 60 * self.unit
        return result["flight_time"] if result["flight_time"] and seen else self.run.duration

    @property
    def target(self) -> Box:
        pin = self.parameters.pin.distance
        return Box(pin, 0.0, pin, 0.0)

    @property
    def near_view(self) -> float:
        return min(WIDEST_VIEW, max(0.35 * float(np.ptp(self.path.points[:, 0])), 100 * self.radius))

    # The place

    @cached_property
    def course(self) -> Course:
        return Course(self.run.setup, self.parameters.pin.distance, self.moon)

    def ground(self, x: np.ndarray) -> np.ndarray:
        return self.course.heights(x)

    def base(self, rows: SideRows, scale: float) -> int:
        """Higher where the cup can be seen, for lengths and ruler are below it."""
        cup, seen = self.course.cup, self.subject.left <= self.parameters.pin.distance <= self.subject.right
        deep = (cup.top - cup.bottom) * scale - 4 * self.unit if seen else 0.0
        return rows.base - round(min(max(0.0, deep), 0.15 * self.size[1]))

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        scale = camera.scale if camera == self.camera else self.home.scale
        self.course.draw(painter, self.eye(camera), nice(STRIPE * self.unit / scale), self.moved(camera))

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        self.course.flag(painter, camera, self.unit, t, self.wind[0])

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        """Nothing: the ball is in front of all of the course."""

    def landmarks(self, sheet: Sheet, camera: Camera) -> None:
        """How far the pin is."""
        flag = self.course.flag_box(camera, self.unit)
        if flag.colliderect(sheet.surface.get_rect()):
            sheet.labels.take(flag.inflate(0, 2 * sheet.gap))
            spots = [(flag.centerx, flag.top - lift * self.unit, "midbottom") for lift in (8, 14)]
            distance = self.parameters.pin.distance
            sheet.label(
                f"pin {metres(distance, 0 if distance == int(distance) else None)}",
                "small",
                spots,
                sheet.ink,
                bold=True,
            )

    # The poster

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The apex, with a dashed line down to the ground, and where carry ends in the air."""
        unit, (_, x, y) = self.unit, self.path.samples[self.path.points[:, 1].argmax()]
        (px, py), (_, ground) = camera.pixel(x, y), camera.pixel(x, self._under(x))
        if ground - py >= LEAST_APEX * unit:
            above = [(px, py - lift * unit, "midbottom") for lift in (12, 18, 24)]
            aside = [(px + side * 10 * unit, (py + ground) / 2, side, 0.0) for side in (1.0, -1.0)]
            text = f"apex {metres(self.run.result['apex'])}"
            if not sheet.label(text, "small", above, sheet.ink, bold=True):
                chip(sheet, text, aside)
            sheet.painter.dashes([(px, py + 8 * unit), (px, ground)], 1.2 * unit, sheet.quiet_ink, 5 * unit, 4 * unit)
            sheet.labels.take_path([(px, row) for row in np.linspace(py, ground, 20)], 2 * unit)
        if self.rows_at.lengths and self._ends_high:
            end = camera.pixel(self.run.result["carry"], self.path.points[0, 1])
            down = end[0], self.rows_at.lengths[-1] - 0.6 * sheet.gap
            sheet.painter.dashes([end, down], 1.3 * unit, CARD["accent"], 4 * unit, 4 * unit)
            sheet.painter.disc(end, 3.0 * unit, CARD["accent"])
            sheet.labels.take_path(np.linspace(end, down, 20), 4 * unit)

    def lengths(self) -> list[Length]:
        """Total, and carry."""
        why = "   at launch height" if self._ends_high else ""
        total, carry = self.run.result["total"], self.run.result["carry"] or 0.0
        lengths = [
            Length(f"total {twice(total, 'yd')}", 0.0, total),
            Length(f"carry {twice(carry, 'yd')}{why}", 0.0, carry, CARD["accent"]),
        ]
        return [length for length in lengths if length.end]

    @property
    def _ends_high(self) -> bool:
        """Whether the ball is seen to be above lower ground where its carry ends."""
        carry, camera = self.run.result["carry"], self.camera
        if carry is None:
            return False
        drop = self.path.points[0, 1] - self.radius - self._under(carry)
        return bool(drop * camera.scale * camera.stretch >= LEAST_DROP * self.unit)

    # Frames

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect | None:
        """A map in frames: the whole path, small, and where on it the ball is."""
        if t is None:
            return None
        (rect, small, ground, kept), painter = self._map, sheet.painter
        thin, hole = max(1, round(1.6 * self.unit)), COLOURS["hole"]
        painter.panel(rect, CARD["background"], CARD["opacity"], 8 * self.unit)
        painter.thread(ground, thin, self.course.turf["fairway"])
        for ghost in self.ghosts:
            points = small.pixels(ghost.points)
            painter.thread(points[apart(points, FINEST)], 1, ghost.light)
        path, past = small.pixels(self.path.points[kept]), self.path.samples[kept, 0] <= t
        at, pin = small.pixel(*self.run.state(self.ball, t)[:2]), self.parameters.pin.distance
        painter.thread(path, 1, CARD["quiet"])
        painter.thread([*path[past], at], thin + 1, self.TRACE)
        (px, py), tall = small.pixel(pin, self._under(pin)), 24 * self.unit
        painter.thread([(px, py), (px, py - tall)], thin, hole["pole"])
        painter.polygon([(px, py - tall), (px + 0.6 * tall, py - 0.8 * tall), (px, py - 0.6 * tall)], hole["flag"])
        painter.disc(at, max(2.5, 4 * self.unit), CARD["accent"])
        return rect

    @cached_property
    def _map(self) -> tuple[pygame.Rect, Camera, np.ndarray, list[int]]:
        """The map's place, its camera, the ground in px, and which points of the path can be told apart."""
        sheet, inset, pin = self.sheet, 2.4 * self.sheet.gap, self.parameters.pin.distance
        rect = pygame.Rect(0, 0, *(round(share * side) for share, side in zip(MAP, self.size, strict=True)))
        rect.topright = sheet.frame.topright
        (left, _), (right, top) = self.points.min(axis=0), self.points.max(axis=0)
        left, right = min(left, pin), max(right, pin, left + 60 * self.radius)
        heights = self.course.between(left, right)[:, 1]
        area = Area(rect.left + inset, rect.top + inset, rect.right - 2 * inset, rect.bottom - inset)
        camera = Camera.fit(Box(left, heights.min(), right, max(top, heights.max())), area, self.camera.stretch)
        edges = (camera.world(px, 0)[0] for px in (rect.left + sheet.gap, rect.right - sheet.gap))
        return rect, camera, camera.pixels(self.course.between(*edges)), apart(camera.pixels(self.path.points), FINEST)
