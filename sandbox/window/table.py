"""The table of shots over the picture: sorted, pinned, deleted, written as CSV, and the statistics of a column."""

from __future__ import annotations

from collections.abc import Callable, Collection

import numpy as np
import pygame

from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import Sheet
from sandbox.sport.amounts import amount
from sandbox.window.shots import Played, share_of, values_of

CARD = palette("card")

#: Keys of the table: what each does with the chosen shot, or with all of them.
ACTIONS = {pygame.K_RETURN: "aim as it", pygame.K_p: "pin", pygame.K_DELETE: "delete", pygame.K_c: "csv"}
#: How they are written.
WRITTEN = {"aim as it": "Enter  aim as it", "pin": "P  pin", "delete": "Del  delete", "csv": "C  CSV file"}
STEPS = {pygame.K_UP: -1, pygame.K_DOWN: 1, pygame.K_PAGEUP: -10, pygame.K_PAGEDOWN: 10}
#: Share of the picture that it takes; width of a column of numbers, and height of the histogram, in px on 720 rows.
SHARE, COLUMN, TALL = (0.92, 0.86), 104, 74
BINS = 24


class Table:
    """The shots of the current scene; ``act`` carries out an action with a shot."""

    name, waiting, progress = "shots", False, 0

    def __init__(
        self,
        rows: Callable[[], list[Played]],
        act: Callable[[str, Played], object],
        colour_of: Callable[[int], Colour],
    ) -> None:
        self.rows, self.act, self.colour_of = rows, act, colour_of
        self.by, self.falling = "", True  # sorted by a number, or by the order of shots
        self.chosen: Played | None = None
        self.first = 0  # of the rows that are seen
        self.seen = 1  # rows
        self.places: list[tuple[pygame.Rect, str | Played]] = []  # actions, columns as "=key", shots

    @property
    def sorted(self) -> list[Played]:
        """The shots in order; those without the number last."""
        rows = self.rows()
        with_it = [row for row in rows if not self.by or self.by in row.numbers]
        with_it.sort(key=lambda row: row.numbers[self.by] if self.by else row.number, reverse=self.falling)
        return with_it + [row for row in rows if row not in with_it]

    @property
    def columns(self) -> list[str]:
        """The numbers that the shots have."""
        return list(dict.fromkeys(key for row in self.rows() for key in row.numbers))

    # Choosing

    def pressed(self, at: tuple[int, int]) -> bool:
        for rect, what in self.places:
            if rect.collidepoint(at):
                if isinstance(what, Played):
                    self.chosen = what
                elif what.startswith("="):
                    self.sort(what[1:])
                else:
                    return self.do(what)
                return True
        return bool(self.places) and self.places[0][0].unionall([rect for rect, _ in self.places]).collidepoint(at)

    def key(self, key: int) -> bool | None:
        """Do what a key does; returns whether the table stays, or None if the key does nothing here."""
        rows, columns = self.sorted, ["", *self.columns]
        if key in ACTIONS:
            return self.do(ACTIONS[key])
        if key in (pygame.K_LEFT, pygame.K_RIGHT):
            self.by = columns[(columns.index(self.by) + (1 if key == pygame.K_RIGHT else -1)) % len(columns)]
        elif key in STEPS and rows:
            now = rows.index(self.chosen) if self.chosen in rows else -1
            now = min(max(now + STEPS[key], 0), len(rows) - 1)
            self.chosen = rows[now]
            self.first = min(max(self.first, now - self.seen + 1), now)
        else:
            return None
        return True

    def sort(self, key: str) -> None:
        """Sort by another number, or the other way round."""
        self.by, self.falling = key, not self.falling if key == self.by else True

    def scroll(self, by: int) -> None:
        """Show other rows."""
        self.first = min(max(self.first + by, 0), max(0, len(self.rows()) - self.seen))

    def do(self, action: str) -> bool:
        """Carry out an action; returns whether the table stays."""
        rows = self.sorted
        row = self.chosen if self.chosen in rows else rows[0] if rows and action == "csv" else None
        if row is not None:
            if action == "delete":
                place = rows.index(row)
                self.chosen = rows[place + 1] if place + 1 < len(rows) else rows[place - 1] if place else None
            self.act(action, row)
        return action != "aim as it" or row is None

    # Drawing

    def draw(self, sheet: Sheet, mouse: tuple[int, int], on: Collection[str]) -> None:
        gap, unit, letters = sheet.gap, sheet.unit, sheet.lettering
        self.places.clear()
        rect = pygame.Rect(0, 0, round(SHARE[0] * sheet.size[0]), round(SHARE[1] * sheet.size[1]))
        rect.center = sheet.surface.get_rect().center
        sheet.painter.panel(rect, CARD["background"], 1.0, 10 * unit)
        inner, row = rect.inflate(-4 * gap, -3 * gap), round(letters.height("small") + gap)
        rows = self.sorted
        letters.write(sheet.surface, f"{len(rows)} shots", "medium", inner.topleft, CARD["text"], bold=True)
        right = inner.right
        for action, text in reversed(WRITTEN.items()):
            place = letters.rect(text, "small", (right, inner.top), "topright", bold=True).inflate(2 * gap, gap)
            self._button(sheet, place, text, action, mouse)
            right = place.left - 2 * gap
        top = inner.top + letters.height("medium") + gap
        foot = inner.bottom - round(TALL * unit) - 2 * gap
        width = round(COLUMN * unit)
        columns = ["", *self.columns[: max(1, (inner.width - 4 * width) // width)]]
        lefts = [inner.left, *(inner.left + width * (0.7 + i) for i in range(len(columns) - 1))]
        wides = [0.7 * width, *[width] * (len(columns) - 1)]
        for key, left, wide in zip(columns, lefts, wides, strict=True):
            place = pygame.Rect(round(left), top, round(wide), row)
            label = letters.cut(self._label(key, rows), "small", wide - gap)
            mark = "" if key != self.by else " ↓" if self.falling else " ↑"
            self._button(sheet, place, label + mark, f"={key}", mouse, on=key == self.by)
        self.seen = max(1, (foot - top - row) // row)
        self.scroll(0)
        for number, played in enumerate(rows[self.first : self.first + self.seen]):
            place = pygame.Rect(inner.left, top + row * (number + 1), inner.width, row)
            self._row(sheet, played, place, columns, lefts, mouse)
        self._statistics(sheet, rows, pygame.Rect(inner.left, foot + gap, inner.width, inner.bottom - foot - gap))

    def _button(
        self, sheet: Sheet, place: pygame.Rect, text: str, action: str, mouse: tuple[int, int], on: bool = False
    ) -> None:
        self.places.append((place, action))
        if place.collidepoint(mouse):
            sheet.painter.panel(place, CARD["quiet"], 0.25, 5 * sheet.unit)
        at = place.left + sheet.gap, place.centery
        sheet.lettering.write(
            sheet.surface, text, "small", at, CARD["accent"] if on else CARD["quiet"], "midleft", bold=True
        )

    def _row(
        self,
        sheet: Sheet,
        played: Played,
        place: pygame.Rect,
        columns: list[str],
        lefts: list[float],
        mouse: tuple[int, int],
    ) -> None:
        gap, unit, letters = sheet.gap, sheet.unit, sheet.lettering
        self.places.append((place, played))
        if played is self.chosen or place.collidepoint(mouse):
            sheet.painter.panel(place, CARD["quiet"], 0.35 if played is self.chosen else 0.15, 5 * unit)
        if played.shot is not None:  # its path is kept
            spot, line = (place.left + 2 * gap, place.centery), self.colour_of(played.number)
            if played.pinned:
                sheet.painter.disc(spot, 5 * unit, line)
            else:
                sheet.painter.ring(spot, 4.5 * unit, 1.8 * unit, line)
        texts = [str(played.number), *(self._text(key, played) for key in columns[1:])]
        for text, left in zip(texts, lefts, strict=True):
            at = left + gap + (3 * gap if left == lefts[0] else 0), place.centery
            text = letters.cut(text, "small", COLUMN * unit - 2 * gap)
            letters.write(sheet.surface, text, "small", at, CARD["text"], "midleft")
        left = lefts[-1] + round(COLUMN * unit)
        colour = CARD["good"] if played.scored else CARD["quiet"]
        text = letters.cut(played.verdict, "small", place.right - left - gap)
        letters.write(sheet.surface, text, "small", (left, place.centery), colour, "midleft")

    def _statistics(self, sheet: Sheet, rows: list[Played], room: pygame.Rect) -> None:
        """Mean and standard deviation of the column that the table is sorted by, its histogram, and who scores."""
        letters, gap, unit = sheet.lettering, sheet.gap, sheet.unit
        lines, share = [], share_of(rows)
        if share is not None:
            low, high = share.interval
            lines.append(f"{share.scored} of {share.total} score: {100 * share.scored / share.total:.0f} %, "
                         f"{100 * low:.0f} to {100 * high:.0f} % with 95 % confidence")  # fmt: skip
        values = values_of(rows, self.by) if self.by else np.array([])
        if len(values) > 1:
            mean, spread = (self._amount(self.by, rows, float(value)) for value in (values.mean(), values.std(ddof=1)))
            lines.append(f"{self._label(self.by, rows)}: mean {mean}, standard deviation {spread}")
        elif not self.by:
            lines.append("sort by a number for its mean, standard deviation and histogram")
        for number, text in enumerate(lines):
            at = room.left, room.top + number * (letters.height("small") + gap)
            letters.write(sheet.surface, letters.cut(text, "small", 0.62 * room.width), "small", at, CARD["text"])
        if len(values) > 1:
            counts, ends = np.histogram(values, BINS)
            plot = pygame.Rect(0, room.top, round(0.32 * room.width), room.height - letters.height("small"))
            plot.right = room.right
            wide = plot.width / BINS
            for number, count in enumerate(counts):
                tall = round(plot.height * count / counts.max())
                bar = pygame.Rect(
                    round(plot.left + number * wide), plot.bottom - tall, max(1, round(wide - unit)), tall
                )
                sheet.surface.fill(CARD["accent"], bar)
            for value, anchor, x in ((ends[0], "topleft", plot.left), (ends[-1], "topright", plot.right)):
                text = self._amount(self.by, rows, float(value))
                letters.write(sheet.surface, text, "small", (x, plot.bottom), CARD["quiet"], anchor)

    @staticmethod
    def _label(key: str, rows: list[Played]) -> str:
        """What a column is called."""
        fact = rows[0].scene.facts.get(key) if rows else None
        return fact.label if fact is not None else key.rpartition(".")[2].replace("_", " ") or "shot"

    @staticmethod
    def _amount(key: str, rows: list[Played], value: float) -> str:
        scene = rows[0].scene
        fact, controls = scene.facts.get(key), scene.controls
        unit = fact.unit if fact is not None else "m/s" if key == controls.speed else "deg"
        return amount(value, unit)

    def _text(self, key: str, played: Played) -> str:
        """A number of a shot."""
        value = played.numbers.get(key)
        return "" if value is None else self._amount(key, [played], value)
