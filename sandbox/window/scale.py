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

    def numbers(self, entries: Sequence[Entry]) -> None:
        """The card along the bottom; a number that is too long for it ends at the last comma there is room for."""
        room = self.frame.width - 6 * self.gap

        def shortened(entry: Entry) -> Entry:
            value = entry[1]
            while ", " in value and self.lettering.width(value, "medium", bold=True) > room:
                value = value.rpartition(", ")[0]
            return (entry[0], value) if value != entry[1] else entry

        self.columns(self.frame.bottom - self.card_height(), [shortened(entry) for entry in entries])
