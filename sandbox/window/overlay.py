"""Overlays on the picture, one at a time: rows that are chosen by mouse or by key, and scrolled; or
marks and paths in the picture itself."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Future
from typing import Any, NamedTuple

import numpy as np
import pygame

from sandbox.picture.palette import Colour, mix, palette
from sandbox.window.canvas import Canvas
from sandbox.window.layout import Layout
from sandbox.window.measure import away_from
from sandbox.window.stage import draw_line

_CARD, _TRACE = palette("card"), palette("trace")

#: Opacity of the pale panel under what is chosen, or under the mouse.
HOVERED = 0.27
#: From this distance in px on 720 rows a mark or a path is clicked.
_NEAR = 16.0
#: What keys do, in columns and rows.
_STEPS = {
    pygame.K_LEFT: (-1, 0), pygame.K_RIGHT: (1, 0), pygame.K_UP: (0, -1), pygame.K_DOWN: (0, 1),
    pygame.K_PAGEUP: (0, -10), pygame.K_PAGEDOWN: (0, 10),
}  # fmt: skip


class Row(NamedTuple):
    """A row of a list or a menu: what it does, its words, the key at its right end, and what the menu says of it."""

    action: str
    text: str
    key: str = ""
    about: str = ""


class Overlay:
    """An overlay on the picture: by default nothing in it can be chosen, and a click closes it."""

    name = ""  # of the command that opens and closes it

    def __init__(self, chosen: Any = None) -> None:
        """``chosen`` is the row that is chosen by key."""
        self.places: list[tuple[pygame.Rect, Any]] = []  # of what can be chosen
        self.chosen = chosen
        self.first, self.seen = 0, 1  # of the rows that are seen, and how many
        self.pictures: dict[str, Future[Any]] = {}  # that are made in the background
        self.kept: list[pygame.Rect] = []  # of the picture, in px: balls and what is aimed at

    @property
    def picture_count(self) -> int:
        """The number of its pictures that are there."""
        return sum(picture.done() for picture in self.pictures.values())

    @property
    def rows(self) -> Sequence[Any]:
        """All rows, in order."""
        return ()

    # What is done

    def at(self, position: tuple[int, int]) -> Any:
        """The choice at a place."""
        return next((what for rect, what in self.places if rect.collidepoint(position)), None)

    def pressed(self, at: tuple[int, int]) -> bool:
        """Do what a click does; returns whether the overlay stays, as it does for a click between its choices."""
        what = self.at(at)
        if what is None:
            return bool(self.places) and self.place(self.sheet).collidepoint(at)
        return self.do(what)

    def key(self, key: int) -> bool | None:
        """Do what a key does; returns whether the overlay stays, or None if the key does nothing here."""
        if not self.rows or (key not in _STEPS and key != pygame.K_RETURN):
            return None
        if key == pygame.K_RETURN:
            return self.chosen is None or self.do(self.chosen)
        across, down = _STEPS[key]
        if across:
            self.turn(across)
        else:
            self.step(down)
        return True

    def do(self, what: Any) -> bool:
        """Do what was chosen; returns whether the overlay stays."""
        raise NotImplementedError

    def turn(self, by: int) -> None:
        """Show other rows, or the same in another order."""

    def step(self, by: int) -> None:
        """Choose the row ``by`` rows on, and show it; after the last comes the first."""
        rows = self.rows
        if rows:
            place = by + (rows.index(self.chosen) if self.chosen in rows else -1 if by > 0 else len(rows))
            self.chosen = rows[place % len(rows) if abs(by) == 1 else min(max(place, 0), len(rows) - 1)]
            self.show(self.chosen)

    def show(self, row: Any) -> None:
        """Make a row one that is seen."""
        place = self.rows.index(row)
        self.first = min(max(self.first, place - self.seen + 1), place)

    def scroll(self, by: int) -> None:
        """Show the rows that come ``by`` rows later, as far as there are more."""
        self.first = min(max(self.first + by, 0), max(0, len(self.rows) - self.seen))

    # Drawing

    def place(self, sheet: Canvas) -> pygame.Rect:
        """The part of a sheet that it takes, where no card is drawn: by default all of it."""
        return sheet.surface.get_rect()

    def off_kept(self, sheet: Canvas, wanted: Sequence[pygame.Rect]) -> pygame.Rect:
        """The first of some rectangles that can be moved off what is kept clear, moved; or the first one as it is."""
        layout = Layout(sheet.surface.get_rect(), sheet.gap, self.kept)
        found = (layout.find(rect.size, rect.topleft, "topleft", layout.occupied) for rect in wanted)
        return next((rect for rect in found if rect is not None), wanted[0])

    def draw(self, sheet: Canvas, mouse: tuple[int, int], on: Collection[str] = ()) -> None:
        """Draw it; ``on`` are the actions that are switched on."""
        self.sheet, self.mouse, self.on = sheet, mouse, on
        self.hovered = self.at(mouse)
        self.places.clear()
        self.compose()

    def compose(self) -> None:
        """Draw its parts."""
        raise NotImplementedError

    def part(self, place: pygame.Rect, what: Any, text: str = "", colour: str = "text", **how: Any) -> None:
        """Draw a text, or nothing, on what can be chosen: lit under the mouse, or else if it is chosen by key."""
        self.places.append((place, what))
        here = place.collidepoint(self.mouse) or (what == self.chosen and self.hovered is None)
        colour = "text" if here and colour == "quiet" else colour
        self.sheet.item(place, text, _CARD[colour], max(how.pop("lit", 0.0), HOVERED * here), **how)

    def listed(self, room: pygame.Rect, tall: int) -> list[tuple[Any, pygame.Rect]]:
        """The rows for which a room has space, each with its place, ``tall`` px high; a bar at the right shows which
        of all they are."""
        self.seen = max(1, room.height // tall)
        self.scroll(0)
        width = room.width - self.scroll_bar(room, self.seen * tall)
        shown = self.rows[self.first : self.first + self.seen]
        return [(row, pygame.Rect(room.left, room.top + i * tall, width, tall)) for i, row in enumerate(shown)]

    def scroll_bar(self, room: pygame.Rect, tall: int) -> int:
        """Draw a bar, ``tall`` px high at the right of a room, that shows which of all rows are seen; returns how much
        room it takes in px, which is none if all are."""
        count, gap = len(self.rows), self.sheet.gap
        if count <= self.seen:
            return 0
        bar = pygame.Rect(room.right - gap // 2, room.top, max(2, gap // 2), tall)
        self.sheet.surface.fill(mix(_CARD["background"], _CARD["quiet"], 0.2), bar)
        bar.top, bar.height = bar.top + tall * self.first // count, tall * min(self.seen, count - self.first) // count
        self.sheet.surface.fill(_CARD["quiet"], bar)
        return gap

    def width_of_words(self, sheet: Canvas) -> int:
        """The width of the longest of the rows as a line, in px."""
        letters, gap = sheet.lettering, sheet.gap
        keys = [letters.width(row.key, "small", bold=True) + 2 * gap if row.key else 0 for row in self.rows]
        return max(letters.width(row.text, "small") + key for row, key in zip(self.rows, keys, strict=True)) + 4 * gap

    def words(self, row: Row, place: pygame.Rect) -> None:
        """One line: the text of a row, with a dot if it is switched on, and its key at the right end."""
        sheet, gap, on, right = self.sheet, self.sheet.gap, row.action in self.on, place.right - 2 * self.sheet.gap
        end = right - sheet.lettering.width(row.key, "small", bold=True) - 2 * gap if row.key else right
        self.part(place, row, row.text, "accent" if on else "quiet", left=place.left + 2 * gap, right=end)
        sheet.write(row.key, "small", (right, place.centery), _CARD["text"], "midright", bold=True)
        if on:
            sheet.painter.disc((place.left + gap, place.centery), 3.5 * sheet.unit, _CARD["accent"])


class Chart(Overlay):
    """A picture that is made in the background."""

    def __init__(self, work: Future[pygame.Surface]) -> None:
        super().__init__()
        self.pictures["chart"] = work

    def compose(self) -> None:
        if self.picture_count:
            surface, onto = self.pictures["chart"].result(), self.sheet.surface
            onto.blit(surface, surface.get_rect(center=onto.get_rect().center))


class Board(Overlay):
    """A list of rows next to the button that opened it."""

    def __init__(
        self,
        rows: Sequence[Row],
        choose: Callable[[str], object],
        foot: pygame.Rect,
        title: str = "",
        stays: bool = False,
        now: str = "",
    ) -> None:
        """``foot`` is the button; ``stays`` keeps it open after a choice; ``now`` is the action that is chosen."""
        super().__init__(next((row for row in rows if row.action == now), None))
        self._rows, self.choose, self.foot, self.title, self.stays = rows, choose, foot, title, stays

    @property
    def rows(self) -> Sequence[Row]:
        return self._rows

    def do(self, what: Row) -> bool:
        self.choose(what.action)
        return self.stays

    def place(self, sheet: Canvas) -> pygame.Rect:
        gap, letters, room = sheet.gap, sheet.lettering, sheet.surface.get_rect()
        tall = round(letters.height("small") + 1.3 * gap)
        title = letters.width(self.title, "small", bold=True) + 4 * gap if self.title else 0
        wide = max(self.width_of_words(sheet), title, self.foot.width - 2 * gap) + 3 * gap
        head = tall * bool(self.title)
        high = min(len(self.rows), (room.height - head - 4 * gap) // tall) * tall
        rect = pygame.Rect(self.foot.left, self.foot.bottom + gap // 2, min(wide, room.width), head + high + 2 * gap)
        if self.foot.top > room.height // 2:
            rect.bottom = min(self.foot.top, room.height) - gap
        return self.off_kept(sheet, [rect.clamp(room)])

    def compose(self) -> None:
        sheet, gap, rect = self.sheet, self.sheet.gap, self.place(self.sheet)
        tall = round(sheet.lettering.height("small") + 1.3 * gap)
        head = tall * bool(self.title)
        sheet.board(rect)
        if self.title:
            place = pygame.Rect(rect.left + gap, rect.top + gap, rect.width - 2 * gap, tall)
            sheet.item(place, self.title, _CARD["accent"], bold=True, left=place.left + 2 * gap)
        room = pygame.Rect(rect.left + gap, rect.top + gap + head, rect.width - 2 * gap, rect.height - head - 2 * gap)
        for row, place in self.listed(room, tall):
            self.words(row, place)


class PictureChoice(NamedTuple):
    """A choice in the picture: a line in the picture (px, shape (n, 2)), or a point; and its name there."""

    action: str
    line: np.ndarray
    name: str
    colour: Colour


class Choice(Board):
    """A list above a button of the bar, and marks that do the same."""

    def __init__(
        self,
        title: str,
        rows: Sequence[Row],
        choose: Callable[[str], object],
        foot: pygame.Rect,
        marks: Callable[[], Sequence[PictureChoice]],
    ) -> None:
        super().__init__(rows, choose, foot, title, now=rows[0].action)
        self.marks, self.near = marks, _NEAR

    def at(self, position: tuple[int, int]) -> Row | None:
        found: Row | None = super().at(position)
        marks = {} if found else {mark.action: away_from(mark.line, position)[0] for mark in self.marks()}
        nearest = min(marks, key=lambda action: marks[action], default="")
        near = [row for row in self.rows if row.action == nearest and marks[nearest] <= self.near]
        return near[0] if near else found

    def compose(self) -> None:
        sheet, unit, painter = self.sheet, self.sheet.unit, self.sheet.painter
        self.near = _NEAR * unit
        hovered = self.at(self.mouse) or self.chosen
        for mark in sorted(self.marks(), key=lambda mark: mark.action == hovered.action):
            here, middle = mark.action == hovered.action, tuple(mark.line[len(mark.line) // 2])
            colour = mark.colour if here else mix(mark.colour, _CARD["background"], 0.25)
            if len(mark.line) > 1:
                width = (4.0 if here else 2.5) * unit
                draw_line(sheet.surface, mark.line, width + 2, _TRACE["rim"])
                draw_line(sheet.surface, mark.line, width, colour)
            painter.disc(middle, 12 * unit, _CARD["background"], 0.85)
            painter.ring(middle, 11 * unit, 2.2 * unit, _CARD["accent"] if here else colour)
            sheet.lettering.write(sheet.surface, mark.name, "small", middle, _CARD["text"], "center", bold=True)
        super().compose()
