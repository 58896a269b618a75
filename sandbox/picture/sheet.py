"""One picture in the making: its surface, and what the pictures of all scenes have in common."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cached_property
from math import ceil, floor, hypot
from typing import NamedTuple

import numpy as np
import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.lettering import LabelPlace, Labels, Lettering
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import Colour, palette
from sandbox.sport.amounts import amount, round_number_above, scale_unit, signed
from sandbox.units import convert

CARD = palette("card")

#: A number on the card: label, value, and its colour if it has one of its own.
Entry = tuple[str, str] | tuple[str, str, Colour]

#: Nearest that anything important comes to an edge, as a share of the picture's width and height.
_MARGIN = 0.05
YARD = 0.9144  # m
#: Letters and lines go with a picture's height; where it is narrower than this, width over height, with its width.
_SQUAREST = 4 / 3
#: Under so many rows a ruler has no second row of figures; under so few there is no room for a large headline, nor for
#: lengths between ground and ruler.
_ROWS_FOR_YARDS, ROWS_FOR_LENGTHS = 480, 240


#: Factor by which letters and lines are enlarged: more for a small screen with many px.
_DENSITY: ContextVar[float] = ContextVar("density", default=1.0)
#: True for pictures without headline and card.
_BARE: ContextVar[bool] = ContextVar("bare", default=False)


@contextmanager
def drawn_at(density: float, bare: bool = False) -> Iterator[None]:
    """Draw pictures with this density; ``bare`` ones have no room for headline and card, which stand beside them."""
    tokens = _DENSITY.set(density), _BARE.set(bare)
    try:
        yield
    finally:
        _DENSITY.reset(tokens[0])
        _BARE.reset(tokens[1])


def rows_of(size: tuple[int, int]) -> int:
    """The rows in px that letters and lines of a picture are made for: its own, or fewer where it is narrow."""
    width, height = size
    return round(_DENSITY.get() * min(height, width / _SQUAREST))


class SideRows(NamedTuple):
    """The rows of a picture from the side, in px from the top."""

    top: float  # under the headline and its notes
    base: int  # the ground
    lengths: list[float]  # under it, the lowest first; none in a low picture
    ruler: float


class Sheet:
    """A surface of ``size`` px with its painter and lettering; ``unit`` is what 1 px is on a picture of 720 rows.

    ``rows`` is how many it counts for: a tall picture for fewer than it has.

    ``ink``, ``quiet_ink`` and ``wind_ink`` are the colours of what stands straight on the picture, whose ground may be
    dark.
    """

    def __init__(self, size: tuple[int, int], on_dark: bool = False, surface: pygame.Surface | None = None):
        """``surface`` is drawn on where there is one, of that size, and else a new one."""
        width, height = size
        self.size, self.rows, self.bare = size, rows_of(size), _BARE.get()
        self.unit = self.rows / 720
        self.ink, self.quiet_ink = (CARD["text"], CARD["quiet"]) if on_dark else (CARD["ink"], CARD["ink_quiet"])
        self.wind_ink = palette("force")["wind"] if on_dark else CARD["wind"]
        self.gap = max(3, round(6 * self.unit))
        if surface is not None:
            self.surface = surface
        self.lettering = Lettering(self.rows)
        self.frame = pygame.Rect(0, 0, width, height).inflate(-2 * ceil(_MARGIN * width), -2 * ceil(_MARGIN * height))
        self.labels = Labels(self.frame, self.gap)
        self.written: list[tuple[str, pygame.Rect]] = []

    @cached_property
    def surface(self) -> pygame.Surface:
        """The surface that is drawn on. New memory is slow, and a sheet that only measures needs none."""
        return blank(self.size)

    @cached_property
    def painter(self) -> Painter:
        """The painter on it."""
        return Painter(self.surface)

    def write(
        self, text: str, size: str, at: tuple[float, float], colour: Colour, anchor: str = "topleft", bold: bool = False
    ) -> pygame.Rect:
        """Write one line of text; no label will be placed on it."""
        rect = self.lettering.write(self.surface, text, size, at, colour, anchor, bold)
        self.written.append((text, rect))
        return self.labels.take(rect)

    def label(
        self, text: str, size: str, spots: Iterable[tuple[float, float, str]], colour: Colour, bold: bool = False
    ) -> pygame.Rect | None:
        """Write a text at the first of the spots (x, y, anchor) with room for it; None if there is none."""
        rect = self.labels.place(self.lettering.rect(text, size, (x, y), anchor, bold) for x, y, anchor in spots)
        if rect:
            self.lettering.write(self.surface, text, size, rect.topleft, colour, bold=bold)
            self.written.append((text, rect))
        return rect

    def chip(self, text: str, spots: Iterable[LabelPlace], colour: Colour = CARD["text"]) -> pygame.Rect | None:
        """A text on a dark chip at the first spot with room, and where that is; None: there is none."""
        unit = self.unit
        width, height = self.lettering.width(text, "small", bold=True), self.lettering.height("small")
        rect = pygame.Rect(0, 0, width + round(12 * unit), height + round(4 * unit))
        chips = []
        for x, y, across, down in spots:
            aside, under = (max(-1.0, min(1.0, 1.6 * share)) / 2 for share in (across, down))
            rect.center = round(x + aside * rect.width), round(y + under * rect.height)
            chips.append(rect.clamp(self.labels.frame))
        placed = self.labels.place(chips)
        if placed:
            self.painter.panel(placed, CARD["background"], CARD["opacity"], 0.5 * placed.height)
            rect = self.lettering.write(self.surface, text, "small", placed.center, colour, "center", bold=True)
            self.written.append((text, rect))
        return placed

    @property
    def head(self) -> str:
        """The size of headlines."""
        return "large" if self.rows >= ROWS_FOR_LENGTHS else "medium"

    @property
    def top_row(self) -> int:
        """Under a headline and its notes, in px."""
        return (
            self.frame.top
            if self.bare
            else self.frame.top + self.lettering.height(self.head) + self.lettering.height("small") + 2 * self.gap
        )

    def card_row(self, others: int = 0) -> int:
        """The row at which the card along the bottom begins, in px, with so many rows of other values; without a card
        where the frame ends, and a little below."""
        if self.bare:
            return self.frame.bottom + 2 * self.gap
        tall = self.lettering.height("small") + (1 + others) * self.lettering.height("medium") + 4 * self.gap
        return self.frame.bottom - tall

    def side_rows(self, others: int, lengths: int) -> SideRows:
        """The rows of a picture from the side with so many rows of other values on its card, and of ``lengths``."""
        small, card = self.lettering.height("small"), self.card_row(others)
        above, below = self.ruler_heights()
        ruler = card - 2.2 * self.gap - below
        lowest = ruler - above - 0.8 * self.gap - small / 2
        rows = [lowest - i * (small + 0.7 * self.gap) for i in range(lengths if self.rows >= ROWS_FOR_LENGTHS else 0)]
        ground = rows[-1] - small / 2 if rows else ruler - above
        return SideRows(self.top_row, round(ground - 2.4 * self.gap), rows, ruler)

    def headline(self, text: str, notes: Sequence[str], room: float) -> None:
        """Write what happened, large, at the top left, and a line of notes below it; ``room`` px wide at most.

        What is too long in any size goes on in the line below. Notes for which there is no room are left out, the last
        first.
        """

        def fits(words: str, size: str) -> bool:
            return self.lettering.width(words, size, bold=True) <= room

        if not fits(text, "small"):  # the rest goes in front of the notes, from a comma on if it can
            parts = (text[:end].rpartition(mark) for mark in (", ", " ") for end in range(len(text), 0, -1))
            text, notes = next(
                (
                    (start, [text[len(start + mark) :], *notes])
                    for start, mark, _ in parts
                    if start and fits(start, "small")
                ),
                (text, notes),
            )
        size = next((size for size in (self.head, "medium") if fits(text, size)), "small")
        rect = self.write(text, size, self.frame.topleft, self.ink, bold=True)
        lines = ["   ·   ".join(notes[:count]) for count in range(len(notes), 0, -1)]
        line = next((line for line in lines if self.lettering.width(line, "small") <= room), "")
        ink = self.quiet_ink if self.rows >= ROWS_FOR_LENGTHS else self.ink  # in a low picture the sky is bright here
        self.write(line, "small", (rect.left, rect.bottom + self.gap), ink)

    def columns(
        self, top: float, entries: Sequence[Entry], others: Sequence[tuple[Colour, Sequence[Entry]]] = ()
    ) -> None:
        """A card along the bottom with a number in each column, the first in the accent's colour.

        Below them stand the values that ``others`` have for the same labels, each in its colour. Where there is no room
        for all, the last are left out.
        """
        rect = pygame.Rect(self.frame.left, top, self.frame.width, self.frame.bottom - top)
        self.painter.panel(rect, CARD["background"], CARD["opacity"], 10 * self.unit)
        inset, tall = round(2.6 * self.gap), self.lettering.height("medium")
        rows = [(colour, {label: value for label, value, *_ in row}) for colour, row in others]
        widths = [
            max(
                self.lettering.width(label, "small"),
                *(
                    self.lettering.width(text, "medium", bold=True)
                    for text in (value, *(row.get(label, "") for _, row in rows))
                ),
            )
            for label, value, *_ in entries
        ]
        room = rect.width - 2 * inset
        while sum(widths) + 2 * self.gap * (len(widths) - 1) > room:
            widths.pop()
        entries = entries[: len(widths)]
        columns = np.arange(len(entries)) * (room + self.gap) / len(entries)
        if np.any(np.diff([*columns, room + self.gap]) < np.array(widths) + 2.5 * self.gap):  # too narrow to be even
            between = (room - sum(widths)) / max(1, len(entries) - 1)
            columns = np.cumsum([0, *(width + between for width in widths[:-1])])
        middle = rect.centery - len(rows) * tall // 2
        for i, ((label, value, *own), x) in enumerate(zip(entries, rect.left + inset + columns, strict=True)):
            colour = own[0] if own else CARD["text"] if i else CARD["accent"]
            self.write(label, "small", (x, middle - 0.2 * self.gap), CARD["quiet"], "bottomleft")
            self.write(value, "medium", (x, middle), colour, "topleft", bold=True)
            for down, (colour, row) in enumerate(rows, 1):
                self.write(row.get(label, "–"), "medium", (x, middle + down * tall), colour, "topleft", bold=True)

    def ruler_heights(self) -> tuple[int, int]:
        """The heights of the ruler above and below its line, in px."""
        figures = self.lettering.height("small") + round(8 * self.unit)
        return figures, figures if self.rows >= _ROWS_FOR_YARDS else 0

    def ruler(self, camera: Camera, row: float, below: str = "yd") -> None:
        """A ruler along x over the frame's width, in metres and, where there is room, in another unit below."""
        thin = max(1, round(self.unit))
        y = round(row)
        self.surface.fill(CARD["rule"], (self.frame.left, y, self.frame.width, thin))
        self._scale(camera, y, thin, "m", 1.0, upward=True)
        if self.rows >= _ROWS_FOR_YARDS:
            self._scale(camera, y, thin, below, convert(1.0, below, "m"), upward=False)

    def _scale(self, camera: Camera, row: int, thin: int, unit: str, metre: float, upward: bool) -> None:
        room = max(self.lettering.width("−000.0 ", "small"), 104 * self.unit)
        step = round_number_above(room / camera.scale / metre)
        low, high = (camera.world(px, 0)[0] / metre / step * 5 for px in (self.frame.left, self.frame.right))
        for i in range(ceil(low), floor(high) + 1):
            x = camera.pixel(i / 5 * step * metre, 0)[0]
            tall = round((7 if i % 5 == 0 else 4) * self.unit)
            top = row - tall if upward else row + thin
            self.surface.fill(CARD["quiet"] if i % 5 == 0 else CARD["rule"], (round(x), top, thin, tall))
            if i % 5 == 0:
                text = signed(f"{i / 5 * step:g}") + (f" {unit}" if i == 0 else "")
                at = (x, row - 8 * self.unit) if upward else (x, row + thin + 8 * self.unit)
                anchor = "midbottom" if upward else "midtop"
                if self.frame.contains(self.lettering.rect(text, "small", at, anchor)):
                    self.write(text, "small", at, CARD["text"] if upward else CARD["quiet"], anchor)

    def dimension(self, text: str, row: float, start: float, end: float, colour: Colour) -> None:
        """A line from ``start`` to ``end`` (px along x) with strokes at its ends, its text in a gap or beside it."""
        thin = max(1, round(1.2 * self.unit))
        left, right = sorted((round(start), round(end)))
        y = round(row)
        rect = self.lettering.rect(text, "small", ((left + right) / 2, row), "center", bold=True)
        if right - left < rect.width + 6 * self.gap:
            beside = [(right + 2 * self.gap, "midleft"), (left - 2 * self.gap, "midright")]
            spots = [self.lettering.rect(text, "small", (x, row), anchor, bold=True) for x, anchor in beside]
            rect = next((spot for spot in spots if self.frame.contains(spot)), spots[0].clamp(self.frame))
        room = rect.inflate(2 * self.gap, 0)
        for a, b in ((left, min(right, room.left)), (max(left, room.right), right)):
            self.surface.fill(colour, (a, y, max(0, b - a), thin))
        tall = round(9 * self.unit)
        for x in (left, right):
            if not room.left < x < room.right:
                self.surface.fill(colour, (x, y - tall // 2, thin, tall + thin - 1))
        self.write(text, "small", rect.topleft, colour, bold=True)

    def wind(self, along: float, up: float, right: float, top: float) -> pygame.Rect:
        """An arrow with the wind's speed below it (m/s), its top right corner at the given point in px."""
        speed = hypot(along, up)
        text = f"wind {amount(speed, 'm/s', 1)}"
        size = max(self.lettering.width(text, "small", bold=True), round(84 * self.unit))
        tall = round(26 * self.unit)
        rect = pygame.Rect(round(right) - size, round(top), size, tall + self.lettering.height("small"))
        along, up = along / speed, up / speed
        half = min((size - 4 * self.unit) / max(abs(along), 1e-9), (tall - 8 * self.unit) / max(abs(up), 1e-9)) / 2
        middle = rect.centerx, rect.top + tall / 2
        tail, head = (
            (middle[0] - half * along, middle[1] + half * up),
            (middle[0] + half * along, middle[1] - half * up),
        )
        self.painter.arrow(tail, head, 3.6 * self.unit, self.wind_ink)
        self.write(text, "small", rect.midbottom, self.ink, "midbottom", bold=True)
        return rect

    def scale_bar(self, camera: Camera, left: float, bottom: float, room: float) -> None:
        """A bar of a round length, which stands over it, from a point in px to the right, at most ``room`` px long."""
        unit, metre = scale_unit(0.35 * room / camera.scale)
        number = round_number_above(0.35 * room / camera.scale / metre)
        length = number * metre
        wide, thin, tall = round(length * camera.scale), max(1, round(1.5 * self.unit)), round(7 * self.unit)
        row, start = round(bottom) - tall // 2 - 1, round(left)
        self.surface.fill(self.quiet_ink, (start, row, wide, thin))
        for x in (start, start + wide - thin):
            self.surface.fill(self.quiet_ink, (x, row - tall // 2, thin, tall + thin - 1))
        text = f"{number:g} {unit}"
        middle = start + max(wide, self.lettering.width(text, "small")) / 2
        self.write(text, "small", (middle, row - tall / 2), self.quiet_ink, "midbottom")
