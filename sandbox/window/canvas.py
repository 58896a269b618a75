"""A part of the window as a sheet to draw on, with lines and small cards of text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import pygame

from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.sheet import Entry, Sheet
from sandbox.window.layout import Form, Layout

_CARD = palette("card")


class Canvas(Sheet):
    """A sheet on a surface of the window."""

    def __init__(self, surface: pygame.Surface) -> None:
        super().__init__(surface.get_size(), surface=surface)

    def shortened(self, text: str, size: str, room: float, bold: bool = False) -> str:
        """The text cut to ``room`` px, at a comma if there is one."""
        while ", " in text and self.lettering.width(text, size, bold) > room:
            text = text.rpartition(", ")[0]
        return self.lettering.cut(text, size, room, bold)

    def numbers(self, entries: Sequence[Entry]) -> None:
        """The card along the bottom; a value that is too long is cut."""
        room = self.frame.width - 6 * self.gap
        short = [self.shortened(entry[1], "medium", room, bold=True) for entry in entries]
        shown = [e if text == e[1] else (e[0], text, *e[2:]) for e, text in zip(entries, short, strict=True)]
        self.columns(self.card_row(), shown)

    def board(self, rect: pygame.Rect) -> None:
        """A panel with a rim, for what lies over all else."""
        self.painter.panel(rect.inflate(2, 2), mix(_CARD["background"], _CARD["quiet"], 0.5), 1.0, 10 * self.unit)
        self.painter.panel(rect, _CARD["background"], 1.0, 10 * self.unit)

    def dim(self, opacity: int) -> None:
        """Dim what is drawn; the opacity is from 0 to 255."""
        dark = pygame.Surface(self.size, pygame.SRCALPHA)
        dark.fill((*_CARD["background"], opacity))
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
            self.painter.panel(place, _CARD["quiet"], lit, 5 * self.unit)
        left, right = place.left + self.gap if left is None else left, place.right if right is None else right
        text = self.lettering.cut(text, "small", right - left, bold)
        rect = self.lettering.write(self.surface, text, "small", (left, place.centery), colour, "midleft", bold)
        if mark:
            x, y, half = rect.right + 1.6 * self.gap, place.centery, 0.7 * self.gap
            tip = 0.6 * mark * half
            self.painter.polygon([(x - half, y - tip), (x + half, y - tip), (x, y + tip)], colour)

    def text(self, lines: Iterable[tuple[str, Any]], least: int = 0, below: int = 0) -> Form:
        """A small card of lines: each is a text with its colour, or a label and a value; at ``least`` so wide, with so
        much room ``below`` them, in px."""
        letters, gap, lines = self.lettering, self.gap, list(lines)
        row = letters.height("small") + gap // 2
        values = [letters.width(value, "small", bold=True) + 3 * gap for _, value in lines if isinstance(value, str)]
        wide = max(least, max(letters.width(text, "small") for text, _ in lines) + max(values, default=0) + 4 * gap)

        def draw(rect: pygame.Rect) -> None:
            self.painter.panel(rect, _CARD["background"], 0.9, 8 * self.unit)
            for number, (text, value) in enumerate(lines):
                left, right, top = rect.left + 2 * gap, rect.right - 2 * gap, rect.top + gap + number * row
                is_value = isinstance(value, str)
                letters.write(self.surface, text, "small", (left, top), _CARD["quiet"] if is_value else value)
                if is_value:
                    letters.write(self.surface, value, "small", (right, top), _CARD["text"], "topright", bold=True)

        return Form((wide, len(lines) * row + 2 * gap - gap // 2 + below), draw)

    def card(self, lines: Iterable[tuple[str, Any]], anchor: str, at: tuple[float, float]) -> None:
        """A small card whose side or corner ``anchor`` (named as by pygame.Rect) is at a place in px, moved inside."""
        form = self.text(lines)
        rect = pygame.Rect((0, 0), form.size)
        setattr(rect, anchor, (round(at[0]), round(at[1])))
        form.draw(rect.clamp(self.surface.get_rect()))

    def notes(self, lines: Sequence[tuple[str, Colour]], least: int = 0, below: int = 0) -> list[Form]:
        """A small card of texts with their colours: wide, narrower and higher, and with less and less of it; at
        ``least`` so wide, with so much room ``below`` them, in px."""
        wrapped = self.lettering.wrapped
        rooms = [round(share * self.frame.width) - 4 * self.gap for share in (1.0, 0.45, 0.3, 0.2)]
        texts = [[(part, ink) for text, ink in lines for part in wrapped(text, "small", room)] for room in rooms]
        (first, ink), *_ = lines
        shorter = [[(part, ink) for part in wrapped(first, "small", room)] for room in rooms]
        shortest = [[(self.shortened(first, "small", room), ink)] for room in rooms]
        less = [self.text(each)._replace(whole=False) for each in (*shorter, *shortest)]
        return [*(self.text(each, least, below) for each in texts), *less]

    def messages(self, layout: Layout, messages: Sequence[tuple[str, bool]]) -> None:
        """Messages over the bottom of the picture, each with whether it is bad, in up to ten lines; where there is no
        room even for one they lie over all else."""
        room, foot = round(0.8 * self.size[0]), self.card_row() - 2 * self.gap
        for number, (text, bad) in enumerate(reversed(messages)):
            lines = [line for part in text.splitlines() for line in self.lettering.wrapped(part, "small", room)][-10:]
            fewer = [self._message(lines[-count:], bad)._replace(whole=False) for count in range(len(lines) - 1, 0, -1)]
            forms = [self._message(lines, bad), *fewer]
            at = self.size[0] // 2, foot
            rect = layout.put(f"message {number}", forms, at, "midbottom")
            if rect is None:
                rect = pygame.Rect((0, 0), forms[0].size)
                rect.midbottom = at
                forms[0].draw(rect)
            foot = rect.top - self.gap

    def _message(self, lines: Sequence[str], bad: bool) -> Form:
        """A card of text with a stripe that says whether it is bad."""
        form = self.text([(line, _CARD["text"]) for line in lines])

        def draw(rect: pygame.Rect) -> None:
            form.draw(rect)
            stripe = pygame.Rect(rect.left, rect.top + self.gap, max(3, self.gap // 2), rect.height - 2 * self.gap)
            self.surface.fill(_CARD["bad" if bad else "good"], stripe)

        return Form(form.size, draw)
