"""A part of the window as a sheet to draw on, with lines and small cards of text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import pygame

from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.sheet import Entry, Sheet

CARD = palette("card")


class Canvas(Sheet):
    """A sheet on a surface of the window."""

    def __init__(self, surface: pygame.Surface) -> None:
        super().__init__(surface.get_size(), surface=surface)
        self.avoid = pygame.Rect(0, 0, 0, 0)  # where no card is stacked
        self.start_cards(self.frame.top)

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
        self.columns(self.card_row(), shown)

    def board(self, rect: pygame.Rect) -> None:
        """A panel with a rim, for what lies over all else."""
        self.painter.panel(rect.inflate(2, 2), mix(CARD["background"], CARD["quiet"], 0.5), 1.0, 10 * self.unit)
        self.painter.panel(rect, CARD["background"], 1.0, 10 * self.unit)

    def veil(self, opacity: int) -> None:
        """Dim what is drawn; the opacity is from 0 to 255."""
        dark = pygame.Surface(self.size, pygame.SRCALPHA)
        dark.fill((*CARD["background"], opacity))
        self.surface.blit(dark, (0, 0))

    def item(
        self,
        place: pygame.Rect,
        text: str,
        colour: Colour,
        lit: float = 0.0,
        bold: bool = False,
        left: float | None = None,
        right: float | None = None,
        mark: int = 0,
    ) -> None:
        """One line of text in the middle of ``place``, cut to what is between ``left`` and ``right`` px; on a pale
        panel of the opacity ``lit``, and before a triangle that points down or, with a ``mark`` of -1, up."""
        if lit:
            self.painter.panel(place, CARD["quiet"], lit, 5 * self.unit)
        left, right = place.left + self.gap if left is None else left, place.right if right is None else right
        text = self.lettering.cut(text, "small", right - left, bold)
        rect = self.lettering.write(self.surface, text, "small", (left, place.centery), colour, "midleft", bold)
        if mark:
            x, y, half = rect.right + 1.6 * self.gap, place.centery, 0.7 * self.gap
            tip = 0.6 * mark * half
            self.painter.polygon([(x - half, y - tip), (x + half, y - tip), (x, y + tip)], colour)

    def card(
        self,
        lines: Iterable[tuple[str, Any]],
        anchor: str = "",
        at: tuple[float, float] = (0.0, 0.0),
        within: pygame.Rect | None = None,
    ) -> pygame.Rect:
        """A small card whose side or corner ``anchor`` (named as by pygame.Rect) is at a place in px, or the next card
        down the right side; where it is.

        Each line is a text with its colour, or a label and a value. The card is moved inside ``within``.
        """
        letters, gap, lines = self.lettering, self.gap, list(lines)
        row = letters.height("small") + gap // 2
        values = [letters.width(value, "small", bold=True) + 3 * gap for _, value in lines if isinstance(value, str)]
        wide = max(letters.width(text, "small") for text, _ in lines) + max(values, default=0) + 4 * gap
        size = wide, len(lines) * row + 2 * gap - gap // 2
        rect = pygame.Rect((0, 0), size) if anchor else self.stacked(size)
        if anchor:
            setattr(rect, anchor, (round(at[0]), round(at[1])))
        rect.clamp_ip(within or self.surface.get_rect())
        self.painter.panel(rect, CARD["background"], 0.9, 8 * self.unit)
        for number, (text, value) in enumerate(lines):
            left, right, top = rect.left + 2 * gap, rect.right - 2 * gap, rect.top + gap + number * row
            is_value = isinstance(value, str)
            letters.write(self.surface, text, "small", (left, top), CARD["quiet"] if is_value else value)
            if is_value:
                letters.write(self.surface, value, "small", (right, top), CARD["text"], "topright", bold=True)
        return rect

    def start_cards(self, top: float) -> None:
        """Stack the next cards down the right side from here on, in px."""
        self.column = pygame.Rect(self.frame.right, round(top) - self.gap, 0, 0)

    def stacked(self, size: tuple[int, int]) -> pygame.Rect:
        """The place of the next card down the right side, below ``avoid`` if they overlap; where it would reach the
        numbers along the bottom, in another column to the left."""
        top, foot, column = self.column.top, self.card_row() - self.gap, self.column
        rect = pygame.Rect((0, 0), size)
        rect.topright = column.right, column.bottom + self.gap
        if rect.bottom > foot and column.height:
            rect.topright = column.left - self.gap, top + self.gap
            self.column = column = pygame.Rect(rect.right, top, 0, 0)
        if rect.colliderect(self.avoid):
            rect.top = self.avoid.bottom + self.gap
        left = min(rect.left, column.left)
        self.column = pygame.Rect(left, top, column.right - left, rect.bottom - top)
        return rect

    def note(self, *lines: tuple[str, Colour]) -> None:
        """A small card down the right side."""
        room = self.frame.width - 4 * self.gap
        self.card((part, colour) for text, colour in lines for part in self.lettering.wrapped(text, "small", room))

    def messages(self, messages: Sequence[tuple[str, bool]]) -> None:
        """Messages over the bottom of the picture, each with whether it is bad, in up to ten lines."""
        room, foot = round(0.8 * self.size[0]), self.card_row() - 2 * self.gap
        for text, bad in reversed(messages):
            lines = [line for part in text.splitlines() for line in self.lettering.wrapped(part, "small", room)][-10:]
            rect = self.card([(line, CARD["text"]) for line in lines], "midbottom", (self.size[0] // 2, foot))
            stripe = pygame.Rect(rect.left, rect.top + self.gap, max(3, self.gap // 2), rect.height - 2 * self.gap)
            self.surface.fill(CARD["bad" if bad else "good"], stripe)
            foot = rect.top - self.gap
