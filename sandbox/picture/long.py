"""A long place from above: all of it as a strip, and under that the part that matters from near by.

A lane or a sheet of ice is so long that what happens at its end would be too small to see.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import hypot
from typing import ClassVar

import numpy as np
import pygame

from sandbox.picture.above import AboveView
from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.marks import mark_impacts
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import Colour, palette
from sandbox.picture.path import ImpactMark
from sandbox.picture.places.plan import Ground, drawn
from sandbox.picture.sheet import Sheet
from sandbox.picture.view import P
from sandbox.sport.amounts import metres, times

_CARD = palette("card")

#: The strip takes this share of the room between headline and card, at most; gaps and the room around letters, in px
#: on 720 rows.
_STRIP, _GAP, _AROUND = 0.42, 8.0, 7.0
#: The surroundings of the place, in m, as far as a lens may show them.
_EVERYWHERE = Box(-1e3, -1e3, 1e3, 1e3)
#: A ball that goes no further than this, in m, has no path.
_LEAST_WAY = 1e-6


class LongView(AboveView[P]):
    """One run in a long place; a scene declares the ``whole`` and the part ``near``, both in m."""

    #: The colour around the strip.
    ROOM_COLOUR: ClassVar[Colour] = (22, 30, 38)
    #: Scale of widths over that of lengths in the strip.
    WIDTH_SCALE: ClassVar[float] = 1.0
    STRETCHED = "widths"
    OTHER_WIDTH = 0.25
    STANDS_UPRIGHT = True

    @property
    def whole(self) -> Box:
        """The part of the world that the strip shows."""
        raise NotImplementedError

    @property
    def near(self) -> Box:
        """The part of the world that must be seen from near by."""
        raise NotImplementedError

    @property
    def lines(self) -> Mapping[str, float]:
        """Lines across the place by their names, at x in m."""
        return {}

    @property
    def moment(self) -> float:
        return self.story_end

    def fitted(self, area: Area) -> Camera:
        """The strip's camera."""
        return self._whole

    @cached_property
    def _whole(self) -> Camera:
        """Shows all of the strip, which keeps its room where the window's camera shows a part of it from near by."""
        left, right = self.sheet.frame.left, self.sheet.frame.right
        box, top, most = self.whole, self.area.top, _STRIP * (self.area.bottom - self.area.top)
        scale = min((right - left) / (box.right - box.left), most / (box.top - box.bottom) / self.WIDTH_SCALE)
        tall = scale * self.WIDTH_SCALE * (box.top - box.bottom)
        middle = (box.left + box.right) / 2, (box.bottom + box.top) / 2
        return Camera(middle, ((left + right) / 2, top + tall / 2), scale, self.WIDTH_SCALE)

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """The strip in a dark room."""
        painter.surface.fill(self.ROOM_COLOUR)
        (left, top), (right, bottom) = (camera.pixel(*corner) for corner in (self.whole[::3], self.whole[2:0:-1]))
        painter.surface.set_clip(pygame.Rect(round(left), round(top), round(right - left), round(bottom - top)))
        painter.surface.blit(drawn((Ground(_EVERYWHERE, self.ROOM_COLOUR), *self.plan), camera, self.size), (0, 0))
        painter.surface.set_clip(None)

    def landmarks(self, sheet: Sheet, camera: Camera) -> None:
        """Write the names of the lines across the strip under it, where there is room."""
        taken = 0
        for name, x in sorted(self.lines.items(), key=lambda line: line[1]):
            at = camera.pixel(x, 0.0)[0], self._row.centery
            if sheet.lettering.rect(name, "small", at, "center").left > taken:
                taken = sheet.write(name, "small", at, sheet.quiet_ink, "center").right + sheet.gap

    @cached_property
    def _row(self) -> pygame.Rect:
        """Under the strip, where it is labelled."""
        low = self._whole.pixel(0.0, self.whole.bottom)[1]
        tall = self.sheet.lettering.height("small") + _AROUND * self.unit
        return pygame.Rect(0, round(low), self.size[0], round(tall))

    @cached_property
    def lens(self) -> pygame.Rect:
        """The part of the picture with the near part, in px."""
        low = self._row.bottom + _GAP * self.unit
        frame = self.sheet.frame
        return pygame.Rect(frame.left, round(low), frame.width, round(self.card_row - _GAP * self.unit - low))

    @cached_property
    def near_camera(self) -> Camera:
        """The camera of the near part; where there is room it shows more on the side that the balls come from."""
        box, lens = self.near, self.lens
        scale = min(lens.width / (box.right - box.left), lens.height / (box.top - box.bottom))
        across = (box.bottom + box.top) / 2
        return Camera((box.right, across), (lens.right, lens.centery), scale)

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        """The near part, with the paths up to time t in s or farther ``ahead``; and where in the strip it is."""
        until = max(t, self.ahead)
        lens, near = self.lens, self.near_camera
        left, right = (near.world(x, 0.0)[0] for x in (lens.left, lens.right))
        (x, top), (end, bottom) = camera.pixel(left, self.whole.top), camera.pixel(right, self.whole.bottom)
        part = pygame.Rect(round(x), round(top), round(end - x), round(bottom - top))
        pygame.draw.rect(painter.surface, _CARD["quiet"], part, max(1, round(self.unit)))
        around = pygame.Rect(lens).inflate(2, 2)
        beam = [part.bottomleft, part.bottomright, around.topright, around.topleft]
        painter.polygon(beam, _CARD["quiet"], 0.12)
        local, surface = self._in_lens, painter.surface.subsurface(lens)
        self._lens_place(surface, t)
        inside = Painter(surface)
        for ball in self.run.setup.balls:
            if (
                ball.name != self.ball and np.ptp(self.paths[ball.name].points, axis=0).max() > _LEAST_WAY
            ):  # where it lay
                at = local.pixel(*ball.position)
                inside.ring(at, ball.radius * local.scale, 1.5 * self.unit, self.colour_of(ball.name), 0.8)
        for name, path in self.paths.items():
            some = path.points[path.samples[:, 0] <= until]
            if len(some) and np.ptp(some, axis=0).max() > _LEAST_WAY:
                points = np.vstack([some, self.run.state(name, min(until, path.until))[:2]])
                inside.line(
                    self.traced(local, points),
                    (3.4 if name == self.ball else 2.2) * self.unit,
                    self.colour_of(name),
                    0.8,
                )
        for ghost in self.ghosts:
            inside.line(self.traced(local, ghost.points), 2.4 * self.unit, ghost.colour, 0.8)
        self.place_balls(inside, local, t)
        pygame.draw.rect(painter.surface, _CARD["quiet"], around, max(1, round(self.unit)))

    @property
    def _in_lens(self) -> Camera:
        """The camera of the near part, from the lens' own corner."""
        near, lens = self.near_camera, self.lens
        return Camera(near.at, (near.anchor[0] - lens.left, near.anchor[1] - lens.top), near.scale)

    def _lens_place(self, surface: pygame.Surface, t: float) -> None:
        """Draw the place of the near part on a surface of the lens' size."""
        plan = (Ground(_EVERYWHERE, self.ROOM_COLOUR), *self.plan)
        surface.blit(drawn(plan, self._in_lens, self.lens.size), (0, 0))
        self.behind(Painter(surface), self._in_lens, t)

    def empty_lens(self) -> pygame.Surface:
        """The near part without what moves, for a page that draws that itself."""
        surface = blank(self.lens.size)
        self._lens_place(surface, 0.0)
        return surface

    def kept_clear(self, camera: Camera, t: float) -> list[pygame.Rect]:
        """In the strip and in the near part."""
        near = [rect.clip(self.lens) for rect in super().kept_clear(self.near_camera, t)]
        return [*super().kept_clear(camera, t), *(rect for rect in near if rect.width and rect.height)]

    def dimensions(self, sheet: Sheet, camera: Camera) -> None:
        """None; but no label goes on the strip or on a ball in the near part."""
        self.keep_off(sheet, self.near_camera, self._row.top)

    def progress(self, t: float) -> tuple[str, str]:
        (x, y), what = self.datum
        at = self.run.state(self.ball, t)
        return f"{hypot(*at[2:4]):.2f} m/s", f"{metres(hypot(at[0] - x, at[1] - y))} from {what}"

    def impacts(self, camera: Camera) -> list[ImpactMark]:
        """In the near part."""
        return [] if camera == self.camera else super().impacts(camera)

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """Impacts that are in the near part, with their speeds."""
        near = self.near_camera
        marks = [mark for mark in self.impacts(near) if self.lens.collidepoint(near.pixel(*mark.at))]
        mark_impacts(sheet, near, marks, self.last(near))

    def scale(self, sheet: Sheet, camera: Camera) -> None:
        """A scale bar under the strip."""
        sheet.scale_bar(camera, sheet.frame.left + 2 * sheet.gap, self._row.bottom, 0.12 * sheet.frame.width)

    def notes(self, camera: Camera) -> list[str]:
        """Notes on the near part; in the strip balls are only marks."""
        factor = self.near_camera.scale / camera.scale
        return [*self._stretched(camera), *self._caveat, *self.remarks(camera), f"below, {times(factor)} as large"]
