"""The table of shots over the picture: sorted, pinned, deleted, written as CSV, and the statistics of a column."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pygame

from sandbox.picture.palette import Colour, palette
from sandbox.sport.amounts import amount
from sandbox.window.canvas import Canvas
from sandbox.window.overlay import HOVERED, Overlay
from sandbox.window.shots import Played, interval

_CARD = palette("card")

#: What is done with the chosen shot, or with all of them: its key, and how that is written.
_ACTIONS = {
    "aim as it": (pygame.K_RETURN, "Enter  aim as it"),
    "pin": (pygame.K_p, "P  pin"),
    "delete": (pygame.K_DELETE, "Del  delete"),
    "csv": (pygame.K_c, "C  CSV file"),
}
_FEWEST = 3  # rows that are seen
#: Share of the picture that it takes at most; width of a column, and height of the histogram, in px on 720 rows.
_SHARE, _COLUMN, _TALL = (0.92, 0.86), 104, 74
_BINS = 24


class Table(Overlay):
    """The shots of the current scene; ``act`` carries out an action with a shot."""

    def __init__(
        self,
        played: Callable[[], list[Played]],
        act: Callable[[str, Played], object],
        colour_of: Callable[[int], Colour],
    ) -> None:
        super().__init__()
        self.played, self.act, self.colour_of = played, act, colour_of
        self.by, self.falling = "", True  # sorted by a number, or by the order of shots

    @property
    def rows(self) -> list[Played]:
        """The shots, sorted; those without the number last."""
        found = self.played()
        with_it = [row for row in found if not self.by or self.by in row.numbers]
        with_it.sort(key=lambda row: row.numbers[self.by] if self.by else row.number, reverse=self.falling)
        return with_it + [row for row in found if row not in with_it]

    @property
    def columns(self) -> list[str]:
        """The numbers that the shots have, after their own number."""
        return ["", *dict.fromkeys(key for row in self.played() for key in row.numbers)]

    # Choosing

    def key(self, key: int) -> bool | None:
        action = next((action for action, (named, _) in _ACTIONS.items() if named == key), None)
        return self.do(action) if action is not None else super().key(key)

    def turn(self, by: int) -> None:
        """Sort by another number."""
        columns = self.columns
        self.by = columns[(columns.index(self.by) + by) % len(columns)]

    def sort(self, key: str) -> None:
        """Sort by another number, or the other way round."""
        self.by, self.falling = key, not self.falling if key == self.by else True

    def do(self, what: Played | str) -> bool:
        """Choose a shot, sort by a column (written as "=key"), or carry out an action."""
        rows = self.rows
        row = self.chosen if self.chosen in rows else rows[0] if rows and what == "csv" else None
        if isinstance(what, Played):
            self.chosen = what
        elif what.startswith("="):
            self.sort(what[1:])
        elif what in _ACTIONS and row is not None:
            if what == "delete":
                place = rows.index(row)
                self.chosen = next(iter([*rows[place + 1 :], *rows[:place][-1:]]), None)
            self.act(what, row)
        return what != "aim as it" or row is None

    # Drawing

    def place(self, sheet: Canvas) -> pygame.Rect:
        """In the middle, or with fewer rows seen where balls and what is aimed at stay in sight."""
        row = sheet.lettering.height("small") + sheet.gap
        wide, most = (round(share * side) for share, side in zip(_SHARE, sheet.size, strict=True))
        rest = sheet.lettering.height("medium") + row + round(_TALL * sheet.unit) + 7 * sheet.gap
        full = min(rest + len(self.rows) * row, most)
        sizes = [(wide, tall) for tall in range(full, min(full, rest + _FEWEST * row) - 1, -row)]
        rects = [pygame.Rect((0, 0), size) for size in sizes]
        for rect in rects:
            rect.center = sheet.surface.get_rect().center
        return self.off_kept(sheet, rects)

    def compose(self) -> None:
        sheet, gap, unit, letters = self.sheet, self.sheet.gap, self.sheet.unit, self.sheet.lettering
        rows, row = self.rows, letters.height("small") + gap
        rect = self.place(sheet)
        sheet.board(rect)
        inner = rect.inflate(-4 * gap, -3 * gap)
        title = f"{len(rows)} shots" if len(rows) != 1 else "1 shot"
        sheet.write(title, "medium", inner.topleft, _CARD["text"], bold=True)
        right = inner.right
        for action, (_, text) in reversed(_ACTIONS.items()):
            place = letters.rect(text, "small", (right, inner.top), "topright", bold=True).inflate(2 * gap, gap)
            self.part(place, action, text, "quiet", bold=True)
            right = place.left - 2 * gap
        top = inner.top + letters.height("medium") + gap
        columns: dict[str, tuple[int, int]] = {}  # left end and width of each
        left, usual = inner.left, round(_COLUMN * unit)
        for key in self.columns:
            label = self._label(key, rows)
            wide = max(usual if key else round(0.7 * usual), letters.width(label, "small", bold=True) + 4 * gap)
            if len(columns) > 1 and left + wide > inner.right - 3 * usual:
                break
            columns[key] = left, wide
            mark = 0 if key != self.by else 1 if self.falling else -1
            colour = "accent" if mark else "quiet"
            self.part(pygame.Rect(left, top, wide, row), f"={key}", label, colour, bold=True, mark=mark)
            left += wide
        foot = inner.bottom - round(_TALL * unit) - 2 * gap
        for played, place in self.listed(pygame.Rect(inner.left, top + row, inner.width, foot - top - row), row):
            self._row(played, place, columns)
        self.places.append((rect, ""))  # a click beside them does nothing
        self._statistics(rows, pygame.Rect(inner.left, foot + gap, inner.width, inner.bottom - foot - gap))

    def _row(self, played: Played, place: pygame.Rect, columns: dict[str, tuple[int, int]]) -> None:
        sheet, gap, unit = self.sheet, self.sheet.gap, self.sheet.unit
        left = sum(list(columns.values())[-1])
        lit, ink = HOVERED * (played is self.chosen), "good" if played.scored else "quiet"
        self.part(place, played, played.verdict, ink, lit=lit, left=left + gap)
        if played.shot is not None:  # its path is kept
            spot, colour = (place.left + 2 * gap, place.centery), self.colour_of(played.number)
            if played.pinned:
                sheet.painter.disc(spot, 5 * unit, colour)
            else:
                sheet.painter.ring(spot, 4.5 * unit, 1.8 * unit, colour)
        for key, (left, wide) in columns.items():
            value = played.numbers.get(key)
            text = str(played.number) if not key else "" if value is None else self._amount(key, [played], value)
            cell = pygame.Rect(left, place.top, wide, place.height)
            sheet.item(cell, text, _CARD["text"], left=left + (gap if key else 4 * gap))

    def _statistics(self, rows: Sequence[Played], room: pygame.Rect) -> None:
        """Mean and standard deviation of the column that the table is sorted by, its histogram, and who scores."""
        sheet, letters, unit = self.sheet, self.sheet.lettering, self.sheet.unit
        small = letters.height("small")
        lines, values = list[str](), np.array([row.numbers[self.by] for row in rows if self.by in row.numbers])
        if known := [row.scored for row in rows if row.scored is not None]:
            scored, count = sum(known), len(known)
            low, high = interval(scored, count)
            lines.append(f"{scored} of {count} score: {100 * scored / count:.0f} %, "
                         f"{100 * low:.0f} to {100 * high:.0f} % with 95 % confidence")  # fmt: skip
        if not self.by:
            lines.append("sort by a number for its mean, standard deviation and histogram")
        elif len(values) > 1:
            mean, spread = (self._amount(self.by, rows, float(value)) for value in (values.mean(), values.std(ddof=1)))
            lines.append(f"{self._label(self.by, rows)}: mean {mean}, standard deviation {spread}")
        for number, text in enumerate(lines):
            at = room.left, room.top + number * (small + sheet.gap)
            sheet.write(letters.cut(text, "small", 0.62 * room.width), "small", at, _CARD["text"])
        if len(values) < 2:
            return
        counts, ends = np.histogram(values, _BINS)
        plot = pygame.Rect(0, room.top, round(0.32 * room.width), room.height - small)
        plot.right, wide = room.right, plot.width / _BINS
        for number, count in enumerate(counts):
            bar = pygame.Rect(0, 0, max(1, round(wide - unit)), round(plot.height * count / counts.max()))
            bar.bottomleft = round(plot.left + number * wide), plot.bottom
            sheet.surface.fill(_CARD["accent"], bar)
        for value, anchor, x in ((ends[0], "topleft", plot.left), (ends[-1], "topright", plot.right)):
            text = self._amount(self.by, rows, float(value))
            sheet.write(text, "small", (x, plot.bottom), _CARD["quiet"], anchor)

    @staticmethod
    def _label(key: str, rows: Sequence[Played]) -> str:
        """The name of a column."""
        fact = rows[0].scene.facts.get(key) if rows else None
        return fact.label if fact is not None else key.rpartition(".")[2].replace("_", " ") or "shot"

    @staticmethod
    def _amount(key: str, rows: Sequence[Played], value: float) -> str:
        scene = rows[0].scene
        fact = scene.facts.get(key)
        return amount(value, fact.unit if fact is not None else "m/s" if key == scene.controls.speed else "deg")
