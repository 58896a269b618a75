"""How large letters and lines are in a window: as large as both its sides allow."""

from __future__ import annotations

from collections.abc import Sequence

import pygame

from sandbox.picture.lettering import Lettering
from sandbox.picture.sheet import Entry, Sheet

#: Width over height below which it is the width that decides.
SQUAREST = 4 / 3


def rows(size: tuple[int, int]) -> int:
    """The height in px for which things are made: in a tall window less than it has."""
    return min(size[1], round(size[0] / SQUAREST))


class Canvas(Sheet):
    """A sheet on a part of the window."""

    def __init__(self, surface: pygame.Surface) -> None:
        super().__init__(surface.get_size(), surface=surface)
        tall = rows(self.size)
        self.unit = tall / 720
        self.gap = max(3, round(6 * self.unit))
        self.lettering = Lettering(tall)

    def ended(self, text: str, size: str, room: float, bold: bool = False) -> str:
        """As much of a text as ``room`` px hold, up to a comma where there is one."""
        while ", " in text and self.lettering.width(text, size, bold) > room:
            text = text.rpartition(", ")[0]
        return self.lettering.cut(text, size, room, bold)

    def numbers(self, entries: Sequence[Entry]) -> None:
        """The card along the bottom; of a number that is too long for it the beginning."""
        room = self.frame.width - 6 * self.gap
        ended = [self.ended(entry[1], "medium", room, bold=True) for entry in entries]
        kept = [e if text == e[1] else (e[0], text) for e, text in zip(entries, ended, strict=True)]
        self.columns(self.frame.bottom - self.card_height(), kept)
