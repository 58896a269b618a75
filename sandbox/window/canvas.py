"""A part of the window as a sheet to draw on."""

from __future__ import annotations

from collections.abc import Sequence

import pygame

from sandbox.picture.sheet import Entry, Sheet


class Canvas(Sheet):
    """A sheet on a surface of the window."""

    def __init__(self, surface: pygame.Surface) -> None:
        super().__init__(surface.get_size(), surface=surface)

    def ended(self, text: str, size: str, room: float, bold: bool = False) -> str:
        """The text cut to ``room`` px, at a comma if there is one."""
        while ", " in text and self.lettering.width(text, size, bold) > room:
            text = text.rpartition(", ")[0]
        return self.lettering.cut(text, size, room, bold)

    def numbers(self, entries: Sequence[Entry]) -> None:
        """The card along the bottom; a value that is too long is cut."""
        room = self.frame.width - 6 * self.gap
        ended = [self.ended(entry[1], "medium", room, bold=True) for entry in entries]
        shown = [e if text == e[1] else (e[0], text) for e, text in zip(entries, ended, strict=True)]
        self.columns(self.frame.bottom - self.card_height(), shown)
