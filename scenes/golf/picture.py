"""Golf from the side: a wide sky, the ground cut open along the line of play, and the ball's path over it."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import pygame

from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.painter import Painter
from sandbox.picture.palette import palette
from sandbox.picture.path import apart, chip
from sandbox.picture.sheet import Sheet, SideRows, nice
from sandbox.picture.side import Length, SideView
from sandbox.sport.amounts import metres, signed, yards

from .course import BALL, COLOURS, Course
from .scene import Parameters

CARD, TRACE = palette("card"), palette("trace")

#: Carry is measured at launch height; a ball that is then at least this far above the ground (px on 720 rows) shows so.
LEAST_DROP = 14
#: Without air, and with gravity below this in m/s^2, it is the Moon.
LEAST_GRAVITY = 5.0
#: Mown stripes are about so wide, and the dashed line under the apex is at least so long, in px on 720 rows.
STRIPE, LEAST_APEX = 70, 44
#: Frames show at most this much of the world's length, in m.
WIDEST_VIEW = 64.0


class Picture(SideView[Parameters]):
    """One shot of golf."""

    LOOK = BALL
    HEADROOM = 40
    STRETCHES = True
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

    def ground(self, x: np.ndarray) -> np.ndarray:
        return self.course.heights(x)

    # The place

    @cached_property
    def course(self) -> Course:
        return Course(self.run.setup, self.parameters.pin.distance, self.size, self.moon)

    def base(self, rows: SideRows, scale: float) -> int:
        """Higher where the cup can be seen, for lengths and ruler are below it."""
        pin = self.parameters.pin.distance
        deep = self.course.cup_depth * scale - 4 * self.unit if self.subject.left <= pin <= self.subject.right else 0.0
        return rows.base - round(min(max(0.0, deep), 0.15 * self.size[1]))

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        scale = camera.scale if camera == self.camera else self.home.scale
        self.course.draw(painter, self.eye(camera), nice(STRIPE * self.unit / scale), self.moved(camera))

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        self.course.flag(painter, camera, t, self.wind[0])

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        """Nothing: the ball is in front of all of the course."""

    def landmarks(self, sheet: Sheet, camera: Camera) -> None:
        """How far the pin is."""
        flag = self.course.flag_box(camera)
        if flag.colliderect(sheet.surface.get_rect()):
            sheet.labels.take(flag.inflate(0, 2 * sheet.gap))
            spots = [(flag.centerx, flag.top - lift * self.unit, "midbottom") for lift in (8, 14)]
            distance = signed(f"{self.parameters.pin.distance:g}")
            sheet.label(f"pin {distance} m", "small", spots, sheet.ink, bold=True)

    # The poster

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The apex, with a dashed line down to the ground, and where carry ends in the air."""
        unit, (_, x, y, *_) = self.unit, self.path.samples[self.path.points[:, 1].argmax()]
        (px, py), (_, ground) = camera.pixel(x, y), camera.pixel(x, self._under(x))
        if ground - py >= LEAST_APEX * unit:
            text, middle = f"apex {metres(self.run.result['apex'])}", (py + ground) / 2
            above = [(px, py - lift * unit, "midbottom") for lift in (12, 18, 24)]
            aside = [(px + side * 10 * unit, middle, side, 0.0) for side in (1.0, -1.0)]
            if sheet.label(text, "small", above, sheet.ink, bold=True) or chip(sheet, text, aside):
                ends = [(px, py + 10 * unit), (px, ground - 4 * unit)]
                sheet.painter.dashes(ends, 1.3 * unit, sheet.ink, 4 * unit, 5 * unit, 0.5)
                sheet.labels.take_path([(px, row) for row in np.linspace(py, ground, 20)], 2 * unit)
        if self.rows_at.lengths and self._drop(camera) >= LEAST_DROP * unit:
            end = camera.pixel(self.run.result["carry"], self.path.points[0, 1])
            down = end[0], self.rows_at.lengths[-1] - 0.6 * sheet.gap
            sheet.painter.dashes([end, down], 1.3 * unit, CARD["accent"], 4 * unit, 4 * unit)
            sheet.painter.disc(end, 4.2 * unit, TRACE["rim"], 0.8)
            sheet.painter.disc(end, 3.0 * unit, CARD["accent"])
            sheet.labels.take_path(np.linspace(end, down, 20), 4 * unit)

    def lengths(self) -> list[Length]:
        """Total, and carry."""
        result, lengths = self.run.result, []
        for name, colour in (("total", CARD["text"]), ("carry", CARD["accent"])):
            if result[name]:
                high = name == "carry" and self._drop(self.camera) >= LEAST_DROP * self.unit
                text = f"{name} {metres(result[name])}   {yards(result[name])}" + (
                    "   at launch height" if high else ""
                )
                lengths.append(Length(text, 0.0, result[name], colour))
        return lengths

    def _drop(self, camera: Camera) -> float:
        """How far over lower ground the ball is where its carry ends, in px."""
        carry = self.run.result["carry"]
        if carry is None:
            return 0.0
        start = self.path.points[0, 1] - self.radius
        return (start - self._under(carry)) * camera.scale * camera.stretch

    # Frames

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect | None:
        """A map in frames: the whole path, small, and where on it the ball is."""
        if t is None:
            return None
        rect, small, ground, kept = self._map
        painter, unit, thin = sheet.painter, self.unit, max(1, round(1.6 * self.unit))
        painter.panel(rect, CARD["background"], CARD["opacity"], 8 * unit)
        sheet.surface.set_clip(rect)
        painter.thread(ground, thin, self.course.turf["fairway"])
        for ghost in self.ghosts:
            points = small.pixels(ghost.points)
            painter.thread(points[apart(points, 1.5)], 1, ghost.light)
        path, past = small.pixels(self.path.points[kept]), self.path.samples[kept, 0] <= t
        at = small.pixel(*self.run.state(self.ball, t)[:2])
        painter.thread(path, 1, CARD["quiet"])
        painter.thread([*path[past], at], thin + 1, TRACE["colours"][0])
        pin = self.parameters.pin.distance
        (px, py), tall = small.pixel(pin, self._under(pin)), 24 * unit
        pygame.draw.line(sheet.surface, COLOURS["hole"]["pole"], (px, py), (px, py - tall), thin)
        painter.polygon(
            [(px, py - tall), (px + 0.6 * tall, py - 0.8 * tall), (px, py - 0.6 * tall)], COLOURS["hole"]["flag"]
        )
        painter.disc(at, max(2.5, 4 * unit), CARD["accent"])
        sheet.surface.set_clip(None)
        return rect

    @cached_property
    def _map(self) -> tuple[pygame.Rect, Camera, np.ndarray, list[int]]:
        """The map's place, its camera, the ground in px, and which points of the path can be told apart."""
        sheet, inset = self.sheet, 2.4 * self.sheet.gap
        left, (right, top) = self.points[:, 0].min(), self.points.max(axis=0)
        pin = self.parameters.pin.distance
        left, right = min(left, pin), max(right, pin, left + 60 * self.radius)
        line = self.course.between(left, right)[:, 1]
        world = Box(left, line.min(), right, max(top, line.max()))
        width = round(0.24 * self.size[0])
        area = Area(inset, 0, width - 2 * inset, 0.11 * self.size[1])  # on the right the flag needs room too
        camera = Camera.fit(world, area, self.camera.stretch)
        rise = max((world.top - world.bottom) * camera.scale * camera.stretch, 26 * self.unit)
        rect = pygame.Rect(0, 0, width, round(rise + 2 * inset))
        rect.topright = sheet.frame.topright
        anchor = rect.left + camera.anchor[0], rect.bottom - inset
        camera = Camera(camera.at, anchor, camera.scale, camera.stretch)
        edges = (camera.world(px, 0)[0] for px in (rect.left + sheet.gap, rect.right - sheet.gap))
        ground = np.add(camera.pixels(self.course.between(*edges)), (0, 1))
        return rect, camera, ground, apart(camera.pixels(self.path.points), 1.5)
