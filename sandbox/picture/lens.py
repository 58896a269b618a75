"""A side view with a lens in its upper right corner: what happens at one place, from near by."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import ClassVar

import numpy as np
import pygame

from sandbox.picture.camera import Box, Camera
from sandbox.picture.depth import Eye
from sandbox.picture.lettering import Labels
from sandbox.picture.painter import around_corners
from sandbox.picture.palette import Colour, palette
from sandbox.picture.path import Mark, draw_trace, mark_impacts
from sandbox.picture.sheet import Sheet
from sandbox.picture.side import SideView
from sandbox.picture.view import P

CARD = palette("card")
#: There is no lens if the whole would have to be drawn smaller than this for it, or if it were no larger than this.
LEAST_SHRINK, LEAST_LENS = 0.85, 1.5


class LensView(SideView[P]):
    """The lens shows what is around ``datum``, if the ball comes there."""

    # What a scene may say

    #: It shows so much of the world, in m, on so many px (of 720 rows), on this ground.
    LENS_VIEW: ClassVar[float] = 1.2
    LENS: ClassVar[float] = 286
    LENS_GROUND: ClassVar[Colour] = CARD["background"]
    #: Its middle lies so far from ``datum``, in m.
    OFF_MIDDLE: ClassVar[tuple[float, float]] = (0.0, 0.0)

    @property
    def uncovered(self) -> Box:
        """What the lens must not hide, in m: frames in which it would have none."""
        raise NotImplementedError

    def in_lens(self, sheet: Sheet) -> None:
        """Draw what only this sport draws in the lens of its poster."""

    # The same for all

    @cached_property
    def lens(self) -> pygame.Rect:
        """Where it is, in px."""
        side, frame = round(self.LENS * self.unit), self.sheet.frame
        return pygame.Rect(frame.right - side, frame.top, side, side)

    @cached_property
    def near(self) -> Camera:
        """Its camera."""
        (x, y), (right, up) = self.datum[0], self.OFF_MIDDLE
        return Camera((x + right, y + up), self.lens.center, self.lens.width / self.LENS_VIEW)

    @cached_property
    def has_lens(self) -> bool:
        """Whether the ball comes there, and the picture shows that from near by."""
        alone, beside = self.fitted(self.area).scale, self._beside_lens.scale
        comes = np.abs(self.path.points - self.datum[0]).max(axis=1).min() < 0.45 * self.LENS_VIEW
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
        marks, half = super().impacts(camera), self.LENS_VIEW / 2
        inside = [bool(np.abs(np.subtract(mark.at, self.datum[0])).max() < half) for mark in marks]
        here = camera == self.near
        return [mark for mark, near in zip(marks, inside, strict=True) if near == here or not self.has_lens]

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        if self.has_lens:
            sheet.labels.take(self.lens)

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect | None:
        """The lens, unless it would hide what it shows: how the ball comes, and on the poster what it touches."""
        box = self.uncovered
        (left, high), (right, low) = camera.pixel(box.left, box.top), camera.pixel(box.right, box.bottom)
        hidden = self.lens.colliderect((round(left), round(high), round(right - left), round(low - high)))
        if not self.has_lens or (t is not None and hidden):
            return None
        near, painter, moment = self.near, sheet.painter, self.moment if t is None else t
        corners = around_corners(sheet.surface, self.lens, 10 * self.unit)
        sheet.surface.fill(self.LENS_GROUND, self.lens)
        sheet.surface.set_clip(self.lens)
        self.draw_things(painter, self.eye(near), near=False)
        self.behind(painter, near, moment)
        outside, sheet.labels = sheet.labels, Labels(self.lens.inflate(-2 * sheet.gap, -2 * sheet.gap), sheet.gap)
        if t is None:
            points = near.pixels(self.path.points)
            seen = np.flatnonzero(np.abs(points - self.lens.center).max(axis=1) < self.lens.width)
            draw_trace(sheet, points[seen[0] : seen[-1] + 1], self.TRACE)
            self.in_lens(sheet)
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
