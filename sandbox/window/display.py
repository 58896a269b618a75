"""Opening and closing the window."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pygame

from sandbox.errors import RequestError

#: What SDL falls back to if there is no display.
UNSEEN = ("offscreen", "dummy")
#: Variables of which one names the display or the driver.
SEEN_BY = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
NO_DISPLAY = "no display to open a window on; without one use sandbox run SCENE with --poster F.png or --gif F.gif"


@contextmanager
def opened(size: tuple[int, int], title: str) -> Iterator[pygame.Surface]:
    """A window that can be resized. Raises RequestError if there is no display."""
    os.environ.setdefault("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")  # no scaling on high-resolution displays
    if sys.platform == "linux" and not any(os.environ.get(name) for name in SEEN_BY):
        raise RequestError(NO_DISPLAY)
    try:
        try:
            pygame.display.init()
            if "SDL_VIDEODRIVER" not in os.environ and pygame.display.get_driver() in UNSEEN:
                raise RequestError(NO_DISPLAY)
            screen = pygame.display.set_mode(size, pygame.RESIZABLE)
        except pygame.error:
            raise RequestError(NO_DISPLAY) from None
        pygame.display.set_caption(title)
        pygame.key.set_repeat(350, 40)
        yield screen
    finally:
        pygame.display.quit()  # but not the fonts, which the next window uses again
