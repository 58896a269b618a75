"""Text: Noto Sans from assets/fonts, its figures all equally wide, in four sizes that go with the picture's height."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache, lru_cache
from math import ceil, cos, inf, sin
from typing import ClassVar

import numpy as np
import pygame

from sandbox.picture.painter import scratch
from sandbox.picture.palette import ASSETS, Colour
from sandbox.text import printable

#: Height of the letters in px on a picture of 720 rows, and the least at which they can be read.
_SIZES = {"small": (14.5, 11), "medium": (20, 14), "large": (40, 24), "huge": (72, 36)}


#: Height of a line in units of the letters' size, and what the font keeps free above it.
_LINE, _ABOVE = 1.21, 0.105
#: Letters are drawn this much larger and scaled down: set straight at 11 px they would be moved to whole px, and words
#: would run into each other.
_FINER = 4


@cache
def _font(pixels: int, bold: bool) -> pygame.font.Font:
    """The font, larger by ``_FINER``."""
    pygame.font.init()
    return pygame.font.Font(str(ASSETS / "fonts" / f"NotoSans-{'Bold' if bold else 'Regular'}.ttf"), pixels * _FINER)


@lru_cache(maxsize=4096)
def _width(text: str, pixels: int, bold: bool) -> int:
    """In px."""
    return ceil(_font(pixels, bold).size(printable(text))[0] / _FINER)


@lru_cache(maxsize=1024)
def _rendered(text: str, pixels: int, bold: bool, colour: Colour) -> pygame.Surface:
    drawn = _font(pixels, bold).render(printable(text), True, colour)
    width, height = (ceil(side / _FINER) for side in drawn.get_size())
    whole = scratch((width * _FINER, height * _FINER), colour)
    whole.blit(drawn, (0, 0))
    return pygame.transform.smoothscale(whole, (width, height))


def text_mask(text: str) -> np.ndarray:
    """A text in bold as coverage (0 to 1, shape (width, height)), cut to its edges: to be put on what is no picture."""
    alpha = pygame.surfarray.array_alpha(_font(16, True).render(printable(text), True, (255, 255, 255))) / 255.0
    columns, rows = (np.flatnonzero(alpha.max(axis=axis) > 0) for axis in (1, 0))
    return alpha[columns[0] : columns[-1] + 1, rows[0] : rows[-1] + 1]


class Lettering:
    """The four sizes for a picture of ``height`` px."""

    larger: ClassVar[float] = 1.0  # than usual, for those who need it

    def __init__(self, height: int):
        rows = self.larger * height / 720
        self.pixels = {
            name: max(round(self.larger * least), round(size * rows)) for name, (size, least) in _SIZES.items()
        }

    def height(self, size: str) -> int:
        """From the top of a tall letter to the bottom of a deep one, in px."""
        return round(self.pixels[size] * _LINE)

    def width(self, text: str, size: str, bold: bool = False) -> int:
        """In px."""
        return _width(text, self.pixels[size], bold)

    def rect(
        self, text: str, size: str, at: tuple[float, float], anchor: str = "topleft", bold: bool = False
    ) -> pygame.Rect:
        """The rectangle in which ``write`` would put the text."""
        rect = pygame.Rect(0, 0, self.width(text, size, bold), self.height(size))
        setattr(rect, anchor, (round(at[0]), round(at[1])))
        return rect

    def write(
        self,
        surface: pygame.Surface,
        text: str,
        size: str,
        at: tuple[float, float],
        colour: Colour,
        anchor: str = "topleft",
        bold: bool = False,
    ) -> pygame.Rect:
        """Write one line with the corner or side named ``anchor`` (as pygame.Rect names them) at a point in px."""
        rect = self.rect(text, size, at, anchor, bold)
        image = _rendered(text, self.pixels[size], bold, colour)
        surface.blit(image, (rect.left, rect.top - round(_ABOVE * self.pixels[size])))
        return rect

    def cut(self, text: str, size: str, room: float, bold: bool = False) -> str:
        """A text that is wider than ``room`` px, ended early."""
        if self.width(text, size, bold) <= room:
            return text
        while text and self.width(text + " ...", size, bold) > room:
            text = text[:-1]
        return text.rstrip() + " ..."

    def wrapped(self, text: str, size: str, room: float) -> list[str]:
        """Lines of at most ``room`` px: broken between words, and within one that is too long for a line."""
        lines = [""]
        for word in text.split():
            longer = f"{lines[-1]} {word}".strip()
            if self.width(longer, size) <= room:
                lines[-1] = longer
                continue
            if lines[-1]:
                lines.append("")
            for letter in word:
                if lines[-1] and self.width(lines[-1] + letter, size) > room:
                    lines.append("")
                lines[-1] += letter
        return lines


#: A point in px and the direction, across and down, in which a label lies beyond it.
LabelPlace = tuple[float, float, float, float]


def around(at: Iterable[float], distances: Iterable[float], turns: Sequence[float]) -> list[LabelPlace]:
    """Spots so far from a point, in px, in directions in rad, counter-clockwise from the right: the nearest first."""
    x, y = at
    return [(x + far * cos(turn), y - far * sin(turn), cos(turn), -sin(turn)) for far in distances for turn in turns]


class Labels:
    """Finds room for labels: inside the frame, off what is taken, off each other."""

    def __init__(self, frame: pygame.Rect, gap: int):
        self.frame, self.gap = frame, gap
        self.taken: list[pygame.Rect] = []
        self.avoided: list[pygame.Rect] = []

    def take(self, rect: pygame.Rect) -> pygame.Rect:
        """Nothing will be put here."""
        self.taken.append(rect.copy())
        return rect

    def avoid(self, rect: pygame.Rect) -> None:
        """Nothing will be put here that has room elsewhere."""
        self.avoided.append(rect.copy())

    def take_path(self, points: Iterable[tuple[float, float]], radius: float) -> None:
        """Nothing will be put within ``radius`` px of these points."""
        size = round(2 * radius) + 1
        self.taken += [pygame.Rect(round(x - radius), round(y - radius), size, size) for x, y in points]

    def place(self, candidates: Iterable[pygame.Rect]) -> pygame.Rect | None:
        """The first of the candidates with room that hides least of what is to be avoided, now taken; None where there
        is no room for any."""
        best, least = None, inf
        for rect in candidates:
            room = rect.inflate(2 * self.gap, 2 * self.gap)
            if self.frame.contains(rect) and room.collidelist(self.taken) < 0:
                hidden = sum(part.width * part.height for part in map(rect.clip, self.avoided))
                if hidden < least:
                    best, least = rect.copy(), hidden
                if hidden == 0:
                    break
        return best and self.take(best)
