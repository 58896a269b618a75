"""What is drawn over the picture for a while: the list of keys, the list of scenes, messages."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import groupby
from math import ceil
from pathlib import Path

import pygame

from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import Sheet
from sandbox.scene import Listing
from sandbox.window.keys import listed

CARD = palette("card")

#: Groups of keys in two columns of the help, and all its layouts, of which the first that fits is used.
TWO = ("Play", "Watch", "See"), ("Keep", "More", "Panel")
LAYOUTS = (("Play", "Keep", "Watch"), ("See", "Panel"), ("More",)), TWO, ((*TWO[0], *TWO[1]),)


def _card(sheet: Sheet, width: int, height: int) -> pygame.Rect:
    """A card in the middle of a darkened picture."""
    veil = pygame.Surface(sheet.size, pygame.SRCALPHA)
    veil.fill((*CARD["background"], 110))
    sheet.surface.blit(veil, (0, 0))
    rect = pygame.Rect(0, 0, min(width, sheet.size[0]), min(height, sheet.size[1]))
    rect.center = sheet.size[0] // 2, sheet.size[1] // 2
    sheet.painter.panel(rect, CARD["background"], 0.95, 12 * sheet.unit)
    return rect


def draw_help(sheet: Sheet) -> None:
    """All keys, in columns by group: in the first layout that fits, or in two columns with lines cut."""
    letters, gap = sheet.lettering, sheet.gap
    row, between = letters.height("small") + max(1, gap // 2), 2 * gap
    for layout in (*LAYOUTS, TWO):
        columns = [[(name, listed(name)) for name in names] for names in layout]
        bindings = [[binding for _, rows in column for binding in rows] for column in columns]
        keys = [max(letters.width(b.shown, "small", bold=True) for b in column) + between for column in bindings]
        wide = [max(letters.width(b.meaning, "small") for b in column) + 2 * between for column in bindings]
        over = sum(keys) + sum(wide) + between - sheet.size[0]
        tall = max(sum(len(rows) + 1.5 for _, rows in column) for column in columns) - 0.5
        if over <= 0 and tall * letters.height("small") + 4 * gap <= sheet.size[1]:
            break
    wide = [room - ceil(max(0, over) / len(wide)) for room in wide]
    head = letters.height("medium") + gap
    if tall * row + head + 4 * gap > sheet.size[1]:  # a small window: the title makes room
        row, head = letters.height("small"), 0
    rect = _card(sheet, sum(keys) + sum(wide) + between, round(tall * row) + head + 4 * gap)
    left, top = float(rect.left + between), rect.top + 2 * gap
    if head:
        letters.write(sheet.surface, "Keys", "medium", (left, top), CARD["text"], bold=True)
        at = (rect.right - between, top + letters.height("medium") / 2)
        text = "Or by mouse: pull back anywhere, and let go."
        letters.write(sheet.surface, text, "small", at, CARD["quiet"], "midright")
    for column, room, width in zip(columns, keys, wide, strict=True):
        y = float(top + head)
        for name, rows in column:
            letters.write(sheet.surface, name, "small", (left, y), CARD["accent"], bold=True)
            for binding in rows:
                y += row
                letters.write(sheet.surface, binding.shown, "small", (left, y), CARD["text"], bold=True)
                meaning = letters.cut(binding.meaning, "small", width - between)
                letters.write(sheet.surface, meaning, "small", (left + room, y), CARD["quiet"])
            y += 1.5 * row
        left += room + width


class Choices:
    """A list above a button of the bar: the commands of one group, with their keys, to be chosen by mouse."""

    def __init__(self, group: str) -> None:
        self.group = group.lower()
        self.bindings = listed(group)
        self.stays = group == "See"  # so that several can be switched in turn
        self.places: list[tuple[pygame.Rect, str]] = []

    def command_at(self, position: tuple[int, int]) -> str | None:
        return next((command for rect, command in self.places if rect.collidepoint(position)), None)

    def draw(
        self,
        sheet: Sheet,
        button: pygame.Rect,
        on: Collection[str],
        words: Mapping[str, str],
        mouse: tuple[int, int],
    ) -> None:
        """At the bottom of the picture, above its button; ``words`` replace the help's text of a command."""
        letters, unit, gap = sheet.lettering, sheet.unit, sheet.gap
        row = round(letters.height("small") + 1.6 * gap)
        texts = [words.get(binding.command, binding.meaning) for binding in self.bindings]
        wide = max(letters.width(text, "small") for text in texts)
        keys = max(letters.width(binding.shown, "small", bold=True) for binding in self.bindings)
        rect = pygame.Rect(0, 0, wide + keys + 14 * gap, row * len(self.bindings) + 2 * gap)
        rect.midbottom = button.centerx, sheet.size[1] - gap
        rect.clamp_ip(sheet.surface.get_rect().inflate(-2 * gap, -2 * gap))
        sheet.painter.panel(rect, CARD["background"], 1.0, 10 * unit)
        self.places.clear()
        for number, (binding, text) in enumerate(zip(self.bindings, texts, strict=True)):
            place = pygame.Rect(rect.left + gap, rect.top + gap + number * row, rect.width - 2 * gap, row)
            self.places.append((place, binding.command))
            if place.collidepoint(mouse):
                sheet.painter.panel(place, CARD["quiet"], 0.25, 5 * unit)
            switched = binding.command in on
            if switched:
                sheet.painter.disc((place.left + 2 * gap, place.centery), 4 * unit, CARD["accent"])
            colour: Colour = CARD["accent"] if switched else CARD["text"]
            at = (place.left + 4 * gap, place.centery)
            letters.write(sheet.surface, text, "small", at, colour, "midleft")
            at = (place.right - 2 * gap, place.centery)
            letters.write(sheet.surface, binding.shown, "small", at, CARD["quiet"], "midright", bold=True)


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


class Menu:
    """Scenes and presets to choose from, by mouse or key: the installed ones in a column for each sport, and the user's
    files in a column before them."""

    def __init__(self, listings: Sequence[Listing], own: Sequence[str] = ()) -> None:
        by_scene = groupby(listings, lambda item: item.name.partition("/")[0])
        self.columns = [[(item.name, item.name.partition("/")[2] or item.name, item.about) for item in rows]
                        for _, rows in by_scene]  # fmt: skip
        known = {name for column in self.columns for name, *_ in column}
        files = [(source, Path(source).name, source) for source in own if source not in known]
        if files:
            self.columns.insert(0, files)
        self.places: list[tuple[pygame.Rect, str]] = []
        self.chosen = ""  # by key

    def draw(self, sheet: Sheet, current: str, mouse: tuple[int, int]) -> None:
        letters, unit, gap = sheet.lettering, sheet.unit, sheet.gap
        row = round(letters.height("small") + 0.9 * gap)
        most = max(map(len, self.columns))
        width = min(sheet.size[0] - 4 * gap, round(236 * unit) * len(self.columns) + 6 * gap)
        head = letters.height("medium") + letters.height("small") + 7 * gap
        if most * row + head + 4 * gap > sheet.size[1]:  # a small window
            row = letters.height("small")
        rect = _card(sheet, width, most * row + head + 4 * gap)
        each = (rect.width - 6 * gap) // len(self.columns)
        letters.write(
            sheet.surface, "What shall we play?", "medium", (rect.left + 3 * gap, rect.top + 2 * gap), CARD["text"],
            bold=True,
        )  # fmt: skip
        about = ""
        self.places.clear()
        for number, rows in enumerate(self.columns):
            top = rect.top + head
            for name, text, said in rows:
                scene = text == name
                place = pygame.Rect(rect.left + 3 * gap + number * each, top, each - gap, row)
                self.places.append((place, name))
                colour: Colour = CARD["text"] if scene else CARD["quiet"]
                if place.collidepoint(mouse) or name == self.chosen:
                    sheet.painter.panel(place.inflate(gap, 0), CARD["quiet"], 0.25, 5 * unit)
                    about, colour = said, CARD["text"]
                if name == current:
                    colour = CARD["accent"]
                at = (place.left, place.centery)
                text = letters.cut(text, "small", place.width, bold=scene)
                letters.write(sheet.surface, text, "small", at, colour, "midleft", bold=scene)
                top += row
        below = (rect.left + 3 * gap, rect.top + 3 * gap + letters.height("medium"))
        letters.write(sheet.surface, letters.cut(about, "small", rect.width - 6 * gap), "small", below, CARD["quiet"])

    def move(self, across: int, down: int, current: str) -> None:
        """Choose by key: so many columns and rows on, from what is played."""
        columns = [[name for name, *_ in rows] for rows in self.columns]
        start = self.chosen or current
        column = next((i for i, names in enumerate(columns) if start in names), 0)
        row = columns[column].index(start) if start in columns[column] else 0
        column = (column + across) % len(columns)
        names = columns[column]
        self.chosen = names[(row + down) % len(names) if down else min(row, len(names) - 1)]

    def name_at(self, position: tuple[int, int]) -> str | None:
        return next((name for rect, name in self.places if rect.collidepoint(position)), None)


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
