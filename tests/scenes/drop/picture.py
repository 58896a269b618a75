"""The smallest picture there can be: a dot that falls."""

from __future__ import annotations

from typing import Any

import pygame

from sandbox.picture.views import AboveView


class Picture(AboveView[Any]):
    def __init__(self, run: Any, parameters: Any, size: tuple[int, int] = (32, 18), ghosts: Any = None):
        super().__init__(run, parameters, size, ghosts)

    def poster(self) -> pygame.Surface:
        return self.frame(self.run.duration)

    def frame(self, t: float) -> pygame.Surface:
        surface = pygame.Surface(self.size)
        height = self.run.state("ball", t)[1]
        surface.set_at((16, max(0, 17 - round(8 * height))), (255, 255, 255))
        return surface
