"""What lies over the picture for a while, one at a time."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Future
from typing import Any, NamedTuple

import pygame

from sandbox.picture.palette import palette
from sandbox.window.canvas import Canvas

CARD = palette("card")

#: Opacity of the pale panel under what is chosen, or under the mouse.
HOVERED = 0.27
#: The step of each in columns and rows.
ARROWS = {pygame.K_LEFT: (-1, 0), pygame.K_RIGHT: (1, 0), pygame.K_UP: (0, -1), pygame.K_DOWN: (0, 1)}


class Overlay:
    """What lies over the picture: by default nothing in it can be chosen, and a click closes it."""

    name = ""  # of the command that opens and closes it
    waiting = False  # whether something of it is still being made
    progress: object = 0  # changes when it must be drawn again

    def __init__(self) -> None:
        self.places: list[tuple[pygame.Rect, Any]] = []  # of what can be chosen
        self.chosen: Any = None  # by key

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
        self.sheet.item(place, text, CARD[colour], max(how.pop("lit", 0.0), HOVERED * here), **how)

    def at(self, position: tuple[int, int]) -> Any:
        """What can be chosen at a place."""
        return next((what for rect, what in self.places if rect.collidepoint(position)), None)

    def pressed(self, at: tuple[int, int]) -> bool:
        """Do what a click does; returns whether the overlay stays."""
        what = self.at(at)
        return what is not None and self.do(what)

    def key(self, key: int) -> bool | None:
        """Do what a key does; returns whether the overlay stays, or None if the key does nothing here."""
        if not self.places or (key not in ARROWS and key != pygame.K_RETURN):
            return None
        if key in ARROWS:
            self.move(*ARROWS[key])
            return True
        return self.chosen is None or self.do(self.chosen)

    def do(self, what: Any) -> bool:
        """Do what was chosen; returns whether the overlay stays."""
        raise NotImplementedError

    def move(self, across: int, down: int) -> None:
        """Choose by key: so many columns and rows on."""

    def scroll(self, by: int) -> None:
        """Show other rows, if there are more."""


class Chart(Overlay):
    """A picture that is made in the background."""

    def __init__(self, work: Future[pygame.Surface]) -> None:
        super().__init__()
        self.work = work

    @property
    def waiting(self) -> bool:  # type: ignore[override]
        return not self.work.done()

    @property
    def progress(self) -> bool:  # type: ignore[override]
        return self.work.done()

    def compose(self) -> None:
        if self.work.done():
            surface, onto = self.work.result(), self.sheet.surface
            onto.blit(surface, surface.get_rect(center=onto.get_rect().center))


class Scrolled(Overlay):
    """Rows of which some are seen."""

    def __init__(self) -> None:
        super().__init__()
        self.first, self.seen = 0, 1  # of the rows that are seen, and how many

    @property
    def rows(self) -> Sequence[Any]:
        """All rows, in order."""
        raise NotImplementedError

    @property
    def shown(self) -> Sequence[Any]:
        """Those that are seen."""
        self.scroll(0)
        return self.rows[self.first : self.first + self.seen]

    def scroll(self, by: int) -> None:
        self.first = min(max(self.first + by, 0), max(0, len(self.rows) - self.seen))

    def show(self, place: int) -> None:
        """Make a row one that is seen."""
        self.first = min(max(self.first, place - self.seen + 1), place)


class Row(NamedTuple):
    """A row of a board or a menu: what it does, its words, the key at its right end, and what the menu says of it."""

    action: str  # "" for a heading, or a gap
    text: str
    key: str = ""
    about: str = ""


class Board(Overlay):
    """Groups of rows in as many columns as they need, to be chosen by mouse, or by arrows and Enter."""

    def __init__(
        self,
        title: str,
        groups: Sequence[Sequence[Row]],
        choose: Callable[[str], object],
        foot: pygame.Rect | None = None,
        stays: bool = False,
        chosen: str | None = None,
    ) -> None:
        """With ``foot``, the button that opened it, it is a list beside it; ``stays`` keeps it open after a choice."""
        super().__init__()
        self.title, self.groups, self.choose, self.foot, self.stays = title, groups, choose, foot, stays
        self.chosen = chosen

    def do(self, what: str) -> bool:
        self.choose(what)
        return self.stays

    def scroll(self, by: int) -> None:
        self.move(0, by)

    def move(self, across: int, down: int) -> None:
        rects = {action: rect for rect, action in self.places}
        if self.chosen not in rects:
            self.chosen = next(iter(rects), None)
        elif down:
            names = list(rects)
            self.chosen = names[(names.index(self.chosen) + down) % len(names)]
        else:
            here = rects[self.chosen]
            columns = sorted({rect.left for rect in rects.values()})
            left = columns[(columns.index(here.left) + across) % len(columns)]
            there = [name for name, rect in rects.items() if rect.left == left]
            self.chosen = min(there, key=lambda name: abs(rects[name].top - here.top))

    # Drawing

    def compose(self) -> None:
        sheet, gap = self.sheet, self.sheet.gap
        head, row, columns, widths = self._fitted(sheet)
        rect = pygame.Rect(0, 0, sum(widths) + 2 * gap, head + row * max(map(len, columns)) + 2 * gap)
        if self.foot is None:
            sheet.veil(110)
            rect.center = sheet.surface.get_rect().center
        else:
            rect.topleft = self.foot.left, self.foot.bottom + gap // 2
            if self.foot.top > sheet.size[1] // 2:
                rect.bottom = min(self.foot.top, sheet.size[1]) - gap
        rect.clamp_ip(sheet.surface.get_rect())
        sheet.board(rect)
        if head:
            sheet.write(self.title, "medium", (rect.left + 3 * gap, rect.top + gap), CARD["text"], bold=True)
        left = rect.left + gap
        for column, width in zip(columns, widths, strict=True):
            for number, each in enumerate(column):
                self._row(each, pygame.Rect(left, rect.top + gap + head + number * row, width, row))
            left += width

    def _fitted(self, sheet: Canvas) -> tuple[int, int, list[list[Row]], list[int]]:
        """Heights of the title and of a row, the columns and their widths: the first that fit; in a small window the
        rows are lower, and the title makes room."""
        letters, gap = sheet.lettering, sheet.gap
        small, title = letters.height("small"), letters.height("medium") + 2 * gap if self.title else 0
        room, tall = (length - 4 * gap for length in sheet.size)
        rows = [(title, round(small + 1.3 * gap)), (title, round(small + 0.7 * gap)), (title, small), (0, small)]
        for head, row in rows:
            columns = self._columns((tall - head) // row)
            widths = [max(self._width(sheet, each) for each in column) for column in columns]
            if self.foot is not None and len(columns) == 1:  # as wide as the field that it is the list of
                widths = [max(widths[0], self.foot.width - 2 * gap)]
            if sum(widths) <= room:
                return head, row, columns, widths
        return head, row, columns, [room // len(columns)] * len(columns)

    def _row(self, row: Row, place: pygame.Rect) -> None:
        sheet, gap, right = self.sheet, self.sheet.gap, place.right - 2 * self.sheet.gap
        if not row.action:
            sheet.item(place, row.text, CARD["accent"], bold=True, left=place.left + 2 * gap)
            return
        on, key = row.action in self.on, sheet.lettering.width(row.key, "small", bold=True) + 2 * gap if row.key else 0
        self.part(
            place, row.action, row.text, "accent" if on else "quiet", left=place.left + 2 * gap, right=right - key
        )
        if on:
            sheet.painter.disc((place.left + gap, place.centery), 3.5 * sheet.unit, CARD["accent"])
        if row.key:
            sheet.write(row.key, "small", (right, place.centery), CARD["text"], "midright", bold=True)

    @staticmethod
    def _width(sheet: Canvas, row: Row) -> int:
        letters, gap = sheet.lettering, sheet.gap
        key = letters.width(row.key, "small", bold=True) + 4 * gap if row.key else 0
        return letters.width(row.text, "small", bold=not row.action) + key + 4 * gap

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
