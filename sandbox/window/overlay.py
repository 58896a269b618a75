"""What lies over the picture for a while, one at a time: rows to choose from, or a picture; and the messages."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Future
from typing import NamedTuple, Protocol

import pygame

from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import Sheet

CARD = palette("card")


#: The step of each in columns and rows.
ARROWS = {pygame.K_LEFT: (-1, 0), pygame.K_RIGHT: (1, 0), pygame.K_UP: (0, -1), pygame.K_DOWN: (0, 1)}


class Row(NamedTuple):
    """A row of a board: what it does, its words, and the key at its right end; ``about`` is shown at the top."""

    action: str  # "" for a heading that does nothing
    text: str
    key: str = ""
    about: str = ""
    heading: bool = False


class Overlay(Protocol):
    """What lies over the picture."""

    name: str  # of the command that opens and closes it

    @property
    def progress(self) -> object:
        """Changes when it must be drawn again."""
        ...

    @property
    def waiting(self) -> bool:
        """Whether something of it is still being made."""
        ...

    def draw(self, sheet: Sheet, mouse: tuple[int, int], on: Collection[str]) -> None:
        """Draw it; ``on`` are the actions that are switched on."""
        ...

    def pressed(self, at: tuple[int, int]) -> bool:
        """Do what a click does; returns whether the overlay stays."""
        ...

    def key(self, key: int) -> bool | None:
        """Do what a key does; returns whether the overlay stays, or None if the key does nothing here."""
        ...

    def scroll(self, by: int) -> None:
        """Show other rows, if there are more."""
        ...


class Chart:
    """A picture that is made in the background."""

    name = ""

    def __init__(self, work: Future[pygame.Surface]) -> None:
        self.work = work

    @property
    def waiting(self) -> bool:
        return not self.work.done()

    @property
    def progress(self) -> bool:
        return self.work.done()

    def draw(self, sheet: Sheet, mouse: tuple[int, int], on: Collection[str]) -> None:
        if self.work.done():
            surface = self.work.result()
            sheet.surface.blit(surface, surface.get_rect(center=sheet.surface.get_rect().center))

    def pressed(self, at: tuple[int, int]) -> bool:
        return False

    def key(self, key: int) -> bool | None:
        return None

    def scroll(self, by: int) -> None:
        pass


class Board:
    """Groups of rows in as many columns as they need, to be chosen by mouse, or by arrows and Enter."""

    name, waiting, progress = "", False, 0

    def __init__(
        self,
        title: str,
        groups: Sequence[Sequence[Row]],
        choose: Callable[[str], object],
        foot: pygame.Rect | None = None,
        stays: bool = False,
        chosen: str = "",
    ) -> None:
        """With ``foot``, the button that opened it, it is a list above that; ``stays`` keeps it open after a choice."""
        self.title, self.groups, self.choose, self.foot, self.stays = title, groups, choose, foot, stays
        self.chosen = chosen  # by key
        self.places: list[tuple[pygame.Rect, Row]] = []  # of what can be chosen

    # Choosing

    def at(self, position: tuple[int, int]) -> str | None:
        """The action at a place."""
        return next((row.action for rect, row in self.places if rect.collidepoint(position)), None)

    def pressed(self, at: tuple[int, int]) -> bool:
        action = self.at(at)
        if action is not None:
            self.choose(action)
        return action is not None and self.stays

    def key(self, key: int) -> bool | None:
        if key in ARROWS:
            self.move(*ARROWS[key])
        elif key != pygame.K_RETURN:
            return None
        elif self.chosen:
            self.choose(self.chosen)
            return self.stays
        return True

    def scroll(self, by: int) -> None:
        self.move(0, by)

    def move(self, across: int, down: int) -> None:
        """Choose by key: so many columns and rows on."""
        rects = {row.action: rect for rect, row in self.places}
        here = rects.get(self.chosen)
        if here is None:
            self.chosen = next(iter(rects), "")
        elif down:
            names = list(rects)
            self.chosen = names[(names.index(self.chosen) + down) % len(names)]
        else:
            columns = sorted({rect.left for rect in rects.values()})
            left = columns[(columns.index(here.left) + across) % len(columns)]
            there = [name for name, rect in rects.items() if rect.left == left]
            self.chosen = min(there, key=lambda name: abs(rects[name].top - here.top))

    # Drawing

    def draw(self, sheet: Sheet, mouse: tuple[int, int], on: Collection[str]) -> None:
        letters, gap = sheet.lettering, sheet.gap
        small = letters.height("small")
        abouts = any(row.about for rows in self.groups for row in rows)
        head = letters.height("medium") + 2 * gap + (small + gap) * abouts if self.title else 0
        most = min((self.foot.top if self.foot else sheet.size[1]) - 2 * gap, sheet.size[1]) - 2 * gap
        for row in (round(small + 1.3 * gap), round(small + 0.7 * gap), small):
            columns = self._columns((most - head) // row)
            widths = [max(self._width(sheet, each) for each in column) for column in columns]
            if sum(widths) <= sheet.size[0] - 4 * gap:
                break
            if row == small and head:  # a small window: the title makes room
                head = 0
                columns = self._columns(most // row)
        room = (sheet.size[0] - 4 * gap) // len(columns)
        if sum(widths) > sheet.size[0] - 4 * gap:
            widths = [room] * len(columns)
        rect = pygame.Rect(0, 0, sum(widths) + 2 * gap, head + row * max(map(len, columns)) + 2 * gap)
        if self.foot is None:
            veil = pygame.Surface(sheet.size, pygame.SRCALPHA)
            veil.fill((*CARD["background"], 110))
            sheet.surface.blit(veil, (0, 0))
            rect.center = sheet.surface.get_rect().center
        else:
            rect.midbottom = self.foot.centerx, sheet.size[1] - gap
        rect.clamp_ip(sheet.surface.get_rect())
        sheet.painter.panel(rect, CARD["background"], 0.97, 10 * sheet.unit)
        hovered = self.at(mouse) or self.chosen
        if head:
            at = rect.left + 3 * gap, rect.top + gap
            letters.write(sheet.surface, self.title, "medium", at, CARD["text"], bold=True)
            about = next((r.about for _, r in self.places if r.action == hovered), "")
            about = letters.cut(about, "small", rect.width - 6 * gap)
            letters.write(sheet.surface, about, "small", (at[0], at[1] + letters.height("medium")), CARD["quiet"])
        self.places.clear()
        left = rect.left + gap
        for column, width in zip(columns, widths, strict=True):
            for number, each in enumerate(column):
                place = pygame.Rect(left, rect.top + gap + head + number * row, width, row)
                self._row(sheet, each, place, each.action == hovered, each.action in on)
            left += width

    def _row(self, sheet: Sheet, row: Row, place: pygame.Rect, hovered: bool, on: bool) -> None:
        letters, gap = sheet.lettering, sheet.gap
        colour: Colour = CARD["text"] if row.heading or hovered else CARD["quiet"]
        if row.action:
            self.places.append((place, row))
            if hovered:
                sheet.painter.panel(place, CARD["quiet"], 0.25, 5 * sheet.unit)
        elif row.heading:
            colour = CARD["accent"]
        if on:
            sheet.painter.disc((place.left + gap, place.centery), 3.5 * sheet.unit, CARD["accent"])
            colour = CARD["accent"]
        key = letters.width(row.key, "small", bold=True) + 2 * gap if row.key else 0
        text = letters.cut(row.text, "small", place.width - 4 * gap - key, bold=row.heading)
        at = place.left + 2 * gap, place.centery
        letters.write(sheet.surface, text, "small", at, colour, "midleft", row.heading)
        if row.key:
            at = place.right - 2 * gap, place.centery
            letters.write(sheet.surface, row.key, "small", at, CARD["text"], "midright", bold=True)

    @staticmethod
    def _width(sheet: Sheet, row: Row) -> int:
        letters, gap = sheet.lettering, sheet.gap
        key = letters.width(row.key, "small", bold=True) + 4 * gap if row.key else 0
        return letters.width(row.text, "small", bold=row.heading) + key + 4 * gap

    def _columns(self, most: int) -> list[list[Row]]:
        """The rows in columns of at most so many; a group is split only if it is longer than a column."""
        columns: list[list[Row]] = [[]]
        for group in self.groups:
            gap = [Row("", "")] if columns[-1] else []
            if len(columns[-1]) + len(gap) + len(group) > most and columns[-1]:
                columns.append([])
                gap = []
            columns[-1] += gap
            for row in group:
                if len(columns[-1]) >= max(most, 1):
                    columns.append([])
                columns[-1].append(row)
        return columns


def draw_note(sheet: Sheet, lines: Sequence[tuple[str, Colour]], top: float, avoid: pygame.Rect) -> float:
    """A small card at the right, below ``avoid`` if they overlap; returns the row below it."""
    letters, gap = sheet.lettering, sheet.gap
    row = letters.height("small") + gap // 2
    room = sheet.frame.width - 4 * gap
    lines = [(part, colour) for text, colour in lines for part in letters.wrapped(text, "small", room)]
    width = max(letters.width(text, "small") for text, _ in lines)
    rect = pygame.Rect(0, 0, width + 4 * gap, len(lines) * row + 2 * gap)
    rect.topright = sheet.frame.right, round(top)
    if rect.colliderect(avoid):
        rect.top = avoid.bottom + gap
    sheet.painter.panel(rect, CARD["background"], 0.85, 8 * sheet.unit)
    for number, (text, colour) in enumerate(lines):
        at = (rect.left + 2 * gap, rect.top + gap + number * row)
        letters.write(sheet.surface, text, "small", at, colour)
    return float(rect.bottom + gap)


def draw_messages(sheet: Sheet, messages: Sequence[tuple[str, bool]]) -> None:
    """Messages over the bottom of the picture, each with whether it is bad, in up to ten lines."""
    letters, gap = sheet.lettering, sheet.gap
    room, row = round(0.8 * sheet.size[0]), letters.height("small") + gap // 2
    foot = sheet.frame.bottom - sheet.card_height() - 2 * gap
    for text, bad in reversed(messages):
        lines = [line for part in text.splitlines() for line in letters.wrapped(part, "small", room)][-10:]
        width = max(letters.width(line, "small") for line in lines)
        rect = pygame.Rect(0, 0, width + 6 * gap, row * len(lines) + 3 * gap)
        rect.midbottom = sheet.size[0] // 2, foot
        sheet.painter.panel(rect, CARD["background"], 0.95, 8 * sheet.unit)
        stripe = pygame.Rect(rect.left, rect.top + gap, max(3, gap // 2), rect.height - 2 * gap)
        sheet.surface.fill(CARD["bad"] if bad else CARD["good"], stripe)
        for number, line in enumerate(lines):
            at = (rect.left + 3 * gap, rect.top + 1.5 * gap + number * row)
            letters.write(sheet.surface, line, "small", at, CARD["text"])
        foot = rect.top - gap
