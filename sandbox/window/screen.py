"""The window's surface: where picture, panel and bar are on it, and how it reaches the display."""

from __future__ import annotations

import pygame

from sandbox.picture.sheet import rows_of
from sandbox.window.bar import HEIGHT, Bar
from sandbox.window.canvas import Canvas
from sandbox.window.panel import Panel

_SIZE = (1280, 720)
#: A window takes this share of the desktop's width and height, or SIZE if that is more, and leaves so many px of them,
#: for its title and what else lies along the edges of a desktop.
_SHARE, _EDGES = 2 / 3, (16, 80)
#: Everything is drawn at least this large, and shrunk for a smaller window.
SMALLEST = (480, 400)


def size_for(desktop: tuple[int, int], before: tuple[int, int] | None = None) -> tuple[int, int]:
    """The size of a new window on a desktop, both in px: the one that it had ``before``, as far as there is room."""
    usual = before or [max(usual, round(_SHARE * room)) for usual, room in zip(_SIZE, desktop, strict=True)]
    least = SMALLEST if before else (1, 1)
    width, height = (
        max(1, min(max(least, px), room - edges))
        for least, px, room, edges in zip(least, usual, desktop, _EDGES, strict=True)
    )
    return width, height


class Screen:
    """Holds ``canvas``, on which everything is drawn, and the places on it in px: ``area`` of the picture, and ``bar``
    along the bottom."""

    def __init__(self, surface: pygame.Surface) -> None:
        self.surface = surface  # of the window
        self.area = pygame.Rect(0, 0, 0, 0)
        self.frame_cost = 0.0  # s, smoothed
        self._windowed = surface.get_size()  # its size before full screen
        self._caption = ""
        self.lay_out(None)

    def lay_out(self, panel: Panel | None) -> None:
        """Places for everything, for the window's size; the picture leaves room for a panel."""
        self.size = self.surface.get_size()
        self.shrunk = max(1.0, *(least / px for least, px in zip(SMALLEST, self.size, strict=True)))
        width, height = (round(self.shrunk * px) for px in self.size)
        self.canvas: pygame.Surface = self.surface if self.shrunk == 1.0 else pygame.Surface((width, height))
        rows = rows_of((width, height))
        tall = round(HEIGHT * rows / 720)
        self.bar = Bar(pygame.Rect(0, height - tall, width, tall), rows)
        self.area = pygame.Rect(0, 0, width, self.bar.rect.top)
        if panel is not None:
            panel.lay_out(Canvas(self.canvas), self.bar.rect.top)
            self.area.width = panel.rect.left

    @property
    def sheet(self) -> Canvas:
        """The picture's part."""
        return Canvas(self.canvas.subsurface(self.area))

    @property
    def whole(self) -> Canvas:
        """All of the window above the bar, over which lists and menus lie."""
        return Canvas(self.canvas.subsurface((0, 0), (self.canvas.get_width(), self.area.height)))

    def from_window(self, at: tuple[float, float]) -> tuple[int, int]:
        """The place on the canvas of a place in the window, in px."""
        return round(self.shrunk * at[0]), round(self.shrunk * at[1])

    def resized(self) -> bool:
        """Take the window's surface if its size has changed; returns whether it has."""
        surface = pygame.display.get_surface()
        if surface is None or self.size == surface.get_size():  # it may be the same surface, now larger
            return False
        self.surface = surface
        return True

    @property
    def windowed(self) -> tuple[int, int]:
        """The size of the window when it does not fill the screen, in px."""
        return self._windowed if pygame.display.is_fullscreen() else self.size

    def toggle_full_screen(self) -> None:
        """Switch between full screen and the window."""
        if pygame.display.is_fullscreen():
            pygame.display.set_mode(self._windowed, pygame.RESIZABLE)
        else:
            self._windowed = self.size
            pygame.display.set_mode((0, 0), pygame.FULLSCREEN)

    def present(self, title: str) -> None:
        """Bring what was drawn to the window, which has a title."""
        if self.canvas is not self.surface:
            self.surface.blit(pygame.transform.smoothscale(self.canvas, self.size), (0, 0))
        if self._caption != title:
            self._caption = title
            pygame.display.set_caption(f"{title} – Sports sandbox")
