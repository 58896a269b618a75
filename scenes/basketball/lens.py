"""The lens in the upper right corner: what happens at the ring, from near by."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from math import atan2, cos, sin

import numpy as np
import pygame

from sandbox.picture.lettering import Labels
from sandbox.picture.marks import draw_trace, mark_impacts
from sandbox.picture.painter import around_corners
from sandbox.picture.palette import palette, scene_colours
from sandbox.picture.path import Mark
from sandbox.picture.views import Camera, Eye, Sheet, SideView

from .scene import Parameters

CARD, GROUND = palette("card"), scene_colours(__file__)["lens"]

#: It shows so much of the world, in m, on so many px (of 720 rows); its middle lies so far from the ring's, in m.
SHOWN, SIDE, OFF_MIDDLE = 1.22, 286, (-0.02, 0.08)
#: There is no lens if the whole would have to be drawn smaller than this for it, or if it were no larger than this.
LEAST_SHRINK, LEAST_LENS = 0.85, 1.5


class LensView(SideView[Parameters]):
    """Has a lens if the ball comes to the ring."""

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return self.parameters.hoop.middle, "the ring"

    @cached_property
    def lens(self) -> pygame.Rect:
        """Where it is, in px."""
        side, frame = round(SIDE * self.unit), self.sheet.frame
        return pygame.Rect(frame.right - side, frame.top, side, side)

    @cached_property
    def near(self) -> Camera:
        """Its camera."""
        at = np.add(self.datum[0], OFF_MIDDLE).tolist()
        return Camera((at[0], at[1]), self.lens.center, self.lens.width / SHOWN)

    def _away(self, points: np.ndarray) -> np.ndarray:
        """How far points are from the ring, as shares of half of what the lens shows."""
        return np.abs(points - self.datum[0]).max(axis=1) / (SHOWN / 2)

    @cached_property
    def has_lens(self) -> bool:
        """Whether the ball comes there, and the picture shows that from near by."""
        alone, beside = self.fitted(self.area).scale, self._beside_lens.scale
        comes = self._away(self.path.points).min() < 0.9
        return bool(comes and beside >= LEAST_SHRINK * alone and self.near.scale > LEAST_LENS * beside)

    @cached_property
    def camera(self) -> Camera:
        """Leaves room for the lens if there is one."""
        return self._beside_lens if self.has_lens else self.fitted(self.area)

    @cached_property
    def _beside_lens(self) -> Camera:
        right = self.lens.left - 24 * self.unit
        return self.fitted(self.area._replace(left=0.06 * self.size[0], right=right))

    @cached_property
    def columns(self) -> tuple[float, float]:
        low, high = super().columns
        return low, min(high, self.lens.left - 40 * self.unit) if self.has_lens else high

    def eye(self, camera: Camera) -> Eye:
        if camera != self.near:
            return super().eye(camera)
        eye = super().eye(self.camera)  # the same eye sees what is in the lens
        centre, level = camera.pixel(*self.camera.world(eye.centre, eye.level))
        return replace(eye, camera=camera, centre=centre, level=level)

    def impacts(self, camera: Camera) -> list[Mark]:
        """Those that this camera shows; the rest are in the lens."""
        marks, here = super().impacts(camera), camera == self.near
        return [mark for mark in marks if not self.has_lens or here == (self._away(np.array([mark.at]))[0] < 1.0)]

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect | None:
        """The lens, unless it would hide what it shows: how the ball comes, and on the poster what it touches."""
        _, bottom, back, top = self.parameters.board
        (left, high), (right, low) = camera.pixel(self.datum[0][0] - 0.6, top), camera.pixel(back + 1.0, bottom)
        hidden = self.lens.colliderect((round(left), round(high), round(right - left), round(low - high)))
        if not self.has_lens or (t is not None and hidden):
            return None
        near, painter, moment = self.near, sheet.painter, self.moment if t is None else t
        corners = around_corners(sheet.surface, self.lens, 10 * self.unit)
        sheet.surface.fill(GROUND, self.lens)
        sheet.surface.set_clip(self.lens)
        self.draw_things(painter, self.eye(near), near=False)
        self.behind(painter, near, moment)
        outside, sheet.labels = sheet.labels, Labels(self.lens.inflate(-2 * sheet.gap, -2 * sheet.gap), sheet.gap)
        if t is None:
            points = near.pixels(self.path.points)
            seen = np.flatnonzero(np.abs(points - self.lens.center).max(axis=1) < self.lens.width)
            draw_trace(sheet, points[seen[0] : seen[-1] + 1], self.TRACE)
            self._entry(sheet)
        else:
            self.trail(painter, near, self.ball, t)
            self.draw_ball(painter, near, self.ball, t, *self._placed(near, t, 1.0)[self.ball])
        self.before(painter, near, moment)
        if t is None:
            mark_impacts(sheet, near, self.impacts(near))
            corner = self.lens.left + 2 * sheet.gap, self.lens.bottom - 1.6 * sheet.gap
            larger = f"{near.scale / self.camera.scale:.1f}×"
            sheet.label(larger, "small", [(*corner, "bottomleft")], CARD["quiet"])
        sheet.labels = outside
        sheet.surface.set_clip(None)
        sheet.surface.blit(corners, self.lens)
        return self.lens

    def _entry(self, sheet: Sheet) -> None:
        """The ball as it comes to the ring, and the angle at which it does."""
        t, angle = self.run.result["flight_time"], self.run.result["entry_angle"]
        if t is None:
            return
        x, y, vx, vy, _ = self.run.before("ball", t)
        (px, py), unit, accent, side = self.near.pixel(x, y), self.unit, CARD["accent"], -1 if vx > 0 else 1
        radius = self.radius * self.near.scale
        far, turn = radius + 26 * unit, np.linspace(0, atan2(-vy, abs(vx)), 25)
        across, down = side * cos(turn[-1] / 2), -sin(turn[-1] / 2)
        anchor = "midright" if side < 0 else "midleft"
        spots = [(px + across * (far + out * unit), py + down * (far + out * unit), anchor) for out in (6, 12, 20, 30)]
        shown = self.lens.collidepoint(px + side * far, py) and angle > 5
        if shown and sheet.label(f"{angle:.1f}°", "small", spots, accent, bold=True):
            level = [(px, py), (px + side * (far + 8 * unit), py)]
            sheet.painter.dashes(level, 1.3 * unit, accent, 4 * unit, 4 * unit)
            arc = np.column_stack([px + side * far * np.cos(turn), py - far * np.sin(turn)])
            sheet.painter.line(arc, 1.8 * unit, accent)
            sheet.labels.take_path(arc, 2 * unit)
        self.LOOK.draw(sheet.painter, (px, py), radius, self.turn("ball", t), unit)
        sheet.labels.take_path([(px, py)], radius)
