"""Draws a fan as a cloud of faint paths."""

from __future__ import annotations

import numpy as np
import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import Sheet
from sandbox.window.fan import Fan
from sandbox.window.path import simplify
from sandbox.window.worker import FanShot

CARD = palette("card")

#: Number of paths that are drawn in one frame; the others follow in the next.
PER_FRAME = 6
#: Opacity of a path, of 255, if it scores and if it misses.
FAINT, FAINT_MISS = 70, 50


class FanLayer:
    """The paths of one fan as one camera sees them, drawn a few in each frame."""

    def __init__(self, fan: Fan, camera: Camera, size: tuple[int, int]) -> None:
        self.fan, self.camera = fan, camera
        self.surface = blank(size, transparent=True)
        self.drawn = 0

    @property
    def complete(self) -> bool:
        """Whether all paths so far are drawn."""
        return self.drawn >= len(self.fan.shots)

    def draw(self, sheet: Sheet) -> None:
        """The cloud under the path; those that score in the colour of success."""
        for shot in self.fan.shots[self.drawn : self.drawn + PER_FRAME]:
            self._add(shot, sheet.unit)
            self.drawn += 1
        sheet.surface.blit(self.surface, (0, 0))

    def _add(self, shot: FanShot, unit: float) -> None:
        pixels = simplify(np.clip(self.camera.pixels(shot.points[:, 1:]), -2000, 6000))
        colour: Colour = CARD["good"] if shot.scored else CARD["text"]
        low, high = pixels.min(axis=0) - 2, pixels.max(axis=0) + 3
        box = pygame.Rect(*low.astype(int), *(high - low).astype(int)).clip(self.surface.get_rect())
        if box.width and box.height and len(pixels) > 1:
            line = blank(box.size, transparent=True)
            line.fill((*colour, 0))
            faint = FAINT if shot.scored else FAINT_MISS
            pygame.draw.lines(line, (*colour, faint), False, pixels - box.topleft, max(1, round(1.6 * unit)))
            self.surface.blit(line, box)
        Painter(self.surface).disc(tuple(pixels[-1]), 2.2 * unit, colour, 0.75)
