"""Golf from the side: a wide sky, the ground cut open along the line of play, and the ball's path over it."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from sandbox.picture.palette import Colour, palette
from sandbox.picture.views import Box, Camera, Length, Painter, Sheet, SideRows, SideView, nice
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


class Picture(SideView[Parameters]):
    """One shot of golf."""

    LOOK = BALL
    HEADROOM = 40
    STRETCHES = 2.0
    LEAST_PATH = 0.2
    LEAST_IMPACT, SOFT = 1.0, 0.25
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

    def profile(self, left: float, right: float) -> np.ndarray:
        return self.course.between(left, right)

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
            text = f"pin {metres(distance, 0 if distance == int(distance) else None)}"
            sheet.label(text, "small", spots, sheet.ink, bold=True)

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
                sheet.chip(text, aside)
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
        lengths = [Length(f"total {twice(total, 'yd')}", 0.0, total)]
        lengths += [Length(f"carry {twice(carry, 'yd')}{why}", 0.0, carry, CARD["accent"])]
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

    @property
    def turf(self) -> Colour:
        return self.course.turf["fairway"]

    def on_map(self, painter: Painter, camera: Camera) -> None:
        """The flag."""
        pin, tall = self.parameters.pin.distance, 24 * self.unit
        (x, y), hole = camera.pixel(pin, self._under(pin)), COLOURS["hole"]
        painter.thread([(x, y), (x, y - tall)], max(1, round(1.6 * self.unit)), hole["pole"])
        painter.polygon([(x, y - tall), (x + 0.6 * tall, y - 0.8 * tall), (x, y - 0.6 * tall)], hole["flag"])
