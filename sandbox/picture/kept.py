"""Parts of a picture that are drawn once and then moved with the camera."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import ceil, floor

import pygame

from sandbox.picture.camera import Box, Camera
from sandbox.picture.painter import Painter, blank

#: A part is placed to this share of a px.
PHASE = 1 / 4


class Kept:
    """Keeps the latest drawing of each part, for as long as its scale stays the same."""

    def __init__(self) -> None:
        self.parts: dict[str, tuple[tuple[float, ...], pygame.Surface]] = {}

    def draw(
        self, surface: pygame.Surface, name: str, camera: Camera, box: Box, draw: Callable[[Painter, Camera], object]
    ) -> None:
        """Draw a part, all of which is inside the box (m), as ``draw`` does it in the plane of play."""
        (left, top), (right, bottom) = camera.pixel(box.left, box.top), camera.pixel(box.right, box.bottom)
        left, top = (round(value / PHASE) * PHASE for value in (left, top))
        column, row = floor(left), floor(top)
        key = camera.scale, camera.stretch, left - column, top - row
        if name not in self.parts or self.parts[name][0] != key:
            part = blank((ceil(right) - column + 1, ceil(bottom) - row + 1), transparent=True)
            draw(Painter(part), replace(camera, at=(box.left, box.top), anchor=(left - column, top - row)))
            self.parts[name] = key, part
        surface.blit(self.parts[name][1], (column, row))
