"""What lies over everything for a while: the list of keys, the list of scenes, a message."""

from __future__ import annotations

from itertools import groupby

import pygame

from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import Sheet
from sandbox.scene import Listing
from sandbox.window.keys import BINDINGS

CARD = palette("card")


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
    """All keys, in columns by what they are for."""
    groups = [(name, [b for b in rows if b.shown]) for name, rows in groupby(BINDINGS, lambda b: b.group)]
    letters, unit, gap = sheet.lettering, sheet.unit, sheet.gap
    row = round(letters.height("small") + 1.1 * gap)
    heights = [(len(rows) + 2) * row for _, rows in groups]
    columns: list[list[int]] = [[], []]
    for index in range(len(groups)):
        shorter = min((0, 1), key=lambda c: sum(heights[i] for i in columns[c]))
        columns[shorter].append(index)
    tall = max(sum(heights[i] for i in column) for column in columns)
    head = letters.height("large") + 4 * gap
    rect = _card(sheet, round(900 * unit), tall + head + 8 * gap)
    inset = 5 * gap
    letters.write(sheet.surface, "Keys", "large", (rect.left + inset, rect.top + 3 * gap), CARD["text"], bold=True)
    text = "Or by mouse: pull back from the ball, let go, and the ball flies the other way."
    letters.write(sheet.surface, text, "small", (rect.right - inset, rect.top + 6.5 * gap), CARD["quiet"], "topright")
    for number, column in enumerate(columns):
        left = rect.left + inset + number * (rect.width - 2 * inset) // 2
        top = rect.top + head + 2 * gap
        for index in column:
            name, rows = groups[index]
            letters.write(sheet.surface, name, "small", (left, top), CARD["accent"], bold=True)
            for binding in rows:
                top += row
                letters.write(sheet.surface, binding.shown, "small", (left, top), CARD["text"], bold=True)
                letters.write(sheet.surface, binding.meaning, "small", (left + 140 * unit, top), CARD["quiet"])
            top += 2 * row


class Menu:
    """Scenes and presets to choose from, by mouse; and which of them each place on the window is."""

    def __init__(self, listings: list[Listing]) -> None:
        self.listings = listings
        self.places: list[tuple[pygame.Rect, str]] = []

    def draw(self, sheet: Sheet, current: str, mouse: tuple[int, int]) -> None:
        letters, unit, gap = sheet.lettering, sheet.unit, sheet.gap
        groups = [(name, list(rows)) for name, rows in groupby(self.listings, lambda item: item.name.partition("/")[0])]
        row = round(letters.height("small") + 0.9 * gap)
        most = max(len(rows) for _, rows in groups)
        width = min(sheet.size[0] - 4 * gap, round(236 * unit) * len(groups) + 6 * gap)
        head = letters.height("medium") + letters.height("small") + 7 * gap
        rect = _card(sheet, width, most * row + head + 4 * gap)
        each = (rect.width - 6 * gap) // len(groups)
        letters.write(
            sheet.surface, "What shall we play?", "medium", (rect.left + 3 * gap, rect.top + 2 * gap), CARD["text"],
            bold=True,
        )  # fmt: skip
        about = ""
        self.places.clear()
        for number, (_, rows) in enumerate(groups):
            top = rect.top + head
            for item in rows:
                scene = "/" not in item.name
                place = pygame.Rect(rect.left + 3 * gap + number * each, top, each - gap, row)
                self.places.append((place, item.name))
                colour: Colour = CARD["text"] if scene else CARD["quiet"]
                if place.collidepoint(mouse):
                    sheet.painter.panel(place.inflate(gap, 0), CARD["quiet"], 0.25, 5 * unit)
                    about, colour = item.about, CARD["text"]
                if item.name == current:
                    colour = CARD["accent"]
                text = item.name if scene else item.name.partition("/")[2]
                at = (place.left, place.centery)
                letters.write(sheet.surface, text, "small", at, colour, "midleft", bold=scene)
                top += row
        below = (rect.left + 3 * gap, rect.top + 3 * gap + letters.height("medium"))
        letters.write(sheet.surface, _cut(sheet, about, rect.width - 6 * gap), "small", below, CARD["quiet"])

    def name_at(self, position: tuple[int, int]) -> str | None:
        return next((name for rect, name in self.places if rect.collidepoint(position)), None)


def draw_message(sheet: Sheet, text: str, bad: bool) -> None:
    """A message over the bottom of the picture, in as many lines as it needs, six at most."""
    letters, gap = sheet.lettering, sheet.gap
    room = round(0.8 * sheet.size[0])
    lines = [line for part in text.splitlines() for line in _wrapped(sheet, part, room)][-6:]
    row = letters.height("small") + gap // 2
    width = max(letters.width(line, "small") for line in lines)
    rect = pygame.Rect(0, 0, width + 6 * gap, row * len(lines) + 3 * gap)
    rect.midbottom = sheet.size[0] // 2, sheet.frame.bottom - sheet.card_height() - 2 * gap
    sheet.painter.panel(rect, CARD["background"], 0.95, 8 * sheet.unit)
    stripe = pygame.Rect(rect.left, rect.top + gap, max(3, gap // 2), rect.height - 2 * gap)
    sheet.surface.fill(CARD["bad"] if bad else CARD["good"], stripe)
    for number, line in enumerate(lines):
        at = (rect.left + 3 * gap, rect.top + 1.5 * gap + number * row)
        letters.write(sheet.surface, line, "small", at, CARD["text"])


def _wrapped(sheet: Sheet, text: str, room: int) -> list[str]:
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".strip()
        if sheet.lettering.width(longer, "small") <= room:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _cut(sheet: Sheet, text: str, room: int) -> str:
    """A text that is too long, ended early."""
    if sheet.lettering.width(text, "small") <= room:
        return text
    while text and sheet.lettering.width(text + " ...", "small") > room:
        text = text[:-1]
    return text.rstrip() + " ..."
