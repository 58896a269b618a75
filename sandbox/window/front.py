"""The first screen: a tile for each sport with its picture; and what can be played in one: tasks, games, the scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import date
from pathlib import Path
from typing import NamedTuple

import pygame

from sandbox.errors import RequestError
from sandbox.picture.palette import mix, palette
from sandbox.scene import load as load_scene
from sandbox.scene.discovery import docstring, installed_folders
from sandbox.tasks import Task, load
from sandbox.tasks.daily import task_of_day
from sandbox.tasks.file import LEVELS, read_task_file
from sandbox.tasks.games import game_names, game_of
from sandbox.tasks.sports import TILE, Sport, easiest, sports
from sandbox.text import title_of, with_noun
from sandbox.window.best import BestList
from sandbox.window.contest import STRENGTHS, AtMatch, AtTask, AtTaskOfDay, Contest
from sandbox.window.decathlon import EVENTS, Decathlon
from sandbox.window.game import Game
from sandbox.window.menu import tile_of
from sandbox.window.overlay import HOVERED, Overlay
from sandbox.window.prediction import Prediction
from sandbox.window.scoreboard import SMALL_STAR, star, stars

_CARD = palette("card")

#: Width of a tile in px on 720 rows, at most.
_WIDEST = 240
#: And in lines of letters at least; and how much farther apart lines of tiles are where there is room.
_NARROWEST, _SPREAD = 5.5, 1.3
START_HERE, _TODAY = "Start here", "Today"


class Entry(NamedTuple):
    """Something that can be played: a ``task``, ``two`` at a task, a ``game`` of a scene, to ``predict`` in a scene,
    one of its ``presets``, or the ``scene`` itself; the task of a ``day``, or a ``decathlon``."""

    kind: str
    source: str  # the task, the scene, or the day (ISO)
    game: str = ""
    title: str = ""
    about: str = ""
    level: int = 0  # of a task; of a game the strength of the computer, 0 for two players


def first_task() -> Task:
    """The task to begin with: the easiest of the first sport that has one."""
    return load(easiest(next(sport for sport in sports() if sport.tasks)))


def entries_of(sport: Sport) -> list[Entry]:
    """All that can be played in a sport: its tasks in rising order, games for two, and the scene. A task or a game that
    is damaged says so instead of what it is about."""
    found = []
    for name, path in zip(sport.tasks, sport.files, strict=True):
        try:
            file = read_task_file(path)
            found.append(Entry("task", name, "", title_of(path.stem), file.goal, file.level))
        except RequestError as error:
            found.append(Entry("task", name, "", title_of(path.stem), str(error), LEVELS + 1))
    entries = sorted(found, key=lambda entry: (entry.level, entry.source))
    for name in game_names(sport.folder):
        try:
            rules = game_of(sport.folder, name)
            entries.append(Entry("game", sport.name, name, f"{rules.title}, for two", rules.goal))
            for level, strength in enumerate(STRENGTHS if rules.opponents else (), 1):
                title = f"{rules.title} against the computer, {strength}"
                entries.append(Entry("game", sport.name, name, title, rules.goal, level))
        except RequestError as error:
            entries.append(Entry("game", sport.name, name, title_of(name), str(error)))
    entries.append(Entry("predict", sport.name, "", "Predict first", "Mark where it will land, then see"))
    presets = [title_of(file.stem) for file in sorted((sport.folder / "presets").glob("*.toml"))]
    if presets and not sport.own:
        entries.append(Entry("presets", sport.name, "", with_noun(len(presets), "preset"), ", ".join(presets)))
    about = docstring(sport.folder / "scene.py")
    return [*entries, Entry("scene", sport.name, "", "Just play", about)]


def events() -> list[str]:
    """The tasks of a decathlon: the easiest of each of the first ten sports."""
    return [easiest(sport) for sport in sports() if sport.tasks][:EVENTS]


def begin(game: Game, entry: Entry) -> None:
    """Play what was chosen."""
    if entry.kind == "scene":
        game.opening.open(entry.source)
        return

    def new_contest() -> Contest:
        if entry.kind == "game":
            return AtMatch(installed_folders().get(entry.source, Path(entry.source)), entry.game, opponent=entry.level)
        if entry.kind == "predict":
            return Prediction(load_scene(entry.source))
        if entry.kind == "day":
            return AtTaskOfDay(date.fromisoformat(entry.source))
        if entry.kind == "decathlon":
            return Decathlon(events())
        return AtTask(load(entry.source), 2 if entry.kind == "two" else 1)

    game.messages.reporting_errors(lambda: game.referee.begin(new_contest()))


class Front(Overlay):
    """The tiles, or once one was chosen what can be played in that sport."""

    def __init__(self, begin: Callable[[Entry], object], best: BestList, day: date) -> None:
        """The task of the day is that of ``day``."""
        super().__init__()
        self.begin, self.best, self.all, self.day = begin, best, sports(), day
        today = Entry("day", day.isoformat(), "", title_of(task_of_day(day)))
        self.others = [today, Entry("decathlon", "", "", "Decathlon")]
        self.sport: Sport | None = None
        self.entries: list[Entry] = []
        self.across = 1  # tiles in a row
        self.with_stars = True  # there is room under the tiles for the stars that were got
        self.first_sport = next((sport for sport in self.all if sport.tasks), None)
        if self.first_sport is not None and self.best.of(easiest(self.first_sport)):
            self.first_sport = None  # it was played
        self.chosen: Sport | Entry = self.all[0]
        self._images: dict[tuple[str, tuple[int, int]], pygame.Surface | None] = {}

    @property
    def rows(self) -> Sequence[Sport | Entry]:
        return self.entries if self.sport is not None else [*self.all, *self.others]

    def do(self, what: Sport | Entry | str) -> bool:
        if isinstance(what, Sport):
            if what is self.first_sport:
                self.begin(Entry("task", easiest(self.first_sport)))
                return False
            self.sport, self.entries, self.first = what, entries_of(what), 0
            self.chosen = self.entries[0]
        elif isinstance(what, str):
            self._to_tiles()
        else:
            self.begin(what)
            return False
        return True

    def _to_tiles(self) -> None:
        self.chosen, self.sport, self.first = self.sport or self.all[0], None, 0

    def key(self, key: int) -> bool | None:
        if self.sport is not None and key in (pygame.K_ESCAPE, pygame.K_LEFT, pygame.K_BACKSPACE):
            self._to_tiles()
            return True
        if self.sport is None and key in (pygame.K_UP, pygame.K_DOWN):
            place = self.rows.index(self.chosen) + (self.across if key == pygame.K_DOWN else -self.across)
            self.chosen = self.rows[min(max(place, 0), len(self.rows) - 1)]
            self.show(self.chosen)
            return True
        return super().key(key)

    def turn(self, by: int) -> None:
        if self.sport is None:
            self.step(by)

    def show(self, row: Sport | Entry) -> None:
        line = self.rows.index(row) // self.across * self.across
        self.first = min(max(self.first, line - self.seen + self.across), line)

    def scroll(self, by: int) -> None:
        hidden = max(0, len(self.rows) - self.seen)
        self.first = min(max(self.first + by * self.across, 0), -(-hidden // self.across) * self.across)

    # Drawing

    def compose(self) -> None:
        sheet, gap = self.sheet, self.sheet.gap
        rect = sheet.surface.get_rect()
        sheet.surface.fill(_CARD["background"])
        title = "Choose a sport" if self.sport is None else self.sport.title
        at = rect.left + 4 * gap, rect.top + 3 * gap
        head = sheet.write(title, "medium", at, _CARD["text"], bold=True)
        room = pygame.Rect(at[0], head.bottom + 2 * gap, rect.width - 8 * gap, 0)
        room.height = rect.bottom - 2 * gap - room.top
        if self.sport is None:
            self._tiles(room)
        else:
            self._page(self.sport, room)

    def _tiles(self, room: pygame.Rect) -> None:
        """The tiles, as large as they all fit, but not too small."""
        sheet, gap = self.sheet, self.sheet.gap
        below = sheet.lettering.height("small") + gap
        self.across, size = self._fitting(room, below)
        tall = size[1] + below + gap
        lines = max(1, (room.height + gap) // tall)
        if len(self.rows) <= self.across * lines:  # all are seen: they spread over the room
            lines = -(-len(self.rows) // self.across)
            tall = min(round(_SPREAD * tall), room.height // lines)
        self.seen = self.across * lines
        self.scroll(0)
        self.scroll_bar(room, lines * tall)
        self.with_stars = all(self._wide(row) <= size[0] for row in self.rows)  # names first
        for i, row in enumerate(self.rows[self.first : self.first + self.seen]):
            place = pygame.Rect(
                room.left + i % self.across * (size[0] + 2 * gap), room.top + i // self.across * tall, *size
            )
            self._tile(row, place, below)

    def _wide(self, row: Sport | Entry) -> float:
        """The width in px of what is written under a tile."""
        letters, (text, lit) = self.sheet.lettering, self._got(row)
        star_wide = (lit is not None) * (2 * SMALL_STAR * self.sheet.unit + self.sheet.gap)
        return letters.width(row.title, "small", True) + letters.width(text, "small") + star_wide

    def _fitting(self, room: pygame.Rect, below: int) -> tuple[int, tuple[int, int]]:
        """The number of tiles in a row, and the size of their pictures in px."""
        gap = self.sheet.gap
        for across in range(1, 12):
            wide = min((room.width - gap + 2 * gap) // across - 2 * gap, round(_WIDEST * self.sheet.unit))
            tall = wide * TILE[1] // TILE[0]
            lines = -(-len(self.rows) // across)
            if lines * (tall + below + gap) <= room.height + gap or wide < max(120, _NARROWEST * below):
                break
        return across, (wide, tall)

    def _tile(self, row: Sport | Entry, place: pygame.Rect, below: int) -> None:
        sheet, gap, unit = self.sheet, self.sheet.gap, self.sheet.unit
        whole = pygame.Rect(place.left, place.top, place.width, place.height + below).inflate(gap, gap)
        self.part(whole, row)
        if isinstance(row, Sport):
            self._picture(row, place)
        else:
            self._mosaic(row, place)
        here = whole.collidepoint(self.mouse) or (row == self.chosen and self.hovered is None)
        if here:
            pygame.draw.rect(sheet.surface, _CARD["accent"], place.inflate(4, 4), 3, border_radius=round(5 * unit))
        y, right, (text, lit) = place.bottom + below // 2, place.right, self._got(row)
        if not self.with_stars:
            text, lit = "", None
        if text:
            written = sheet.write(text, "small", (right, y), _CARD["quiet"], "midright")
            right = written.left - gap
        if lit is not None:
            star(sheet, (right - 0.6 * SMALL_STAR * unit, y), SMALL_STAR * unit, lit)
            right -= round(2 * SMALL_STAR * unit)
        name = sheet.lettering.cut(row.title, "small", right - place.left, True)
        sheet.write(name, "small", (place.left, y), _CARD["text"], "midleft", bold=True)
        said = START_HERE if row is self.first_sport else _TODAY if row is self.others[0] else ""
        if said:
            wide = sheet.lettering.width(said, "small", True) + 4 * gap
            badge = pygame.Rect(place.right - wide, place.top, wide, below + gap)  # balls come from the left
            sheet.painter.panel(badge, _CARD["accent"], 1.0, 5 * unit)
            sheet.write(said, "small", badge.center, _CARD["background"], "center", bold=True)

    def _got(self, row: Sport | Entry) -> tuple[str, bool | None]:
        """The best in a sport, at the task of the day, or in a decathlon, in a few words; and whether there is
        a lit star before them, None for no star."""
        if isinstance(row, Sport):
            got = sum(self.best.stars(task) for task in row.tasks)
            return (f"{got}/{3 * len(row.tasks)}", got > 0) if row.tasks else ("", None)
        if row.kind == "day":
            got = self.best.stars(AtTaskOfDay.name_of(self.day))
            return f"{got}/3", got > 0
        best = self.best.of(Decathlon.name)
        return (f"{best[0].score:,.0f}" if best else ""), None

    def _mosaic(self, entry: Entry, place: pygame.Rect) -> None:
        """Draw the picture of its sport for the task of the day, and for a decathlon those of nine of its sports."""
        if entry.kind == "day":
            task = task_of_day(self.day)
            self._picture(next(sport for sport in self.all if task in sport.tasks), place)
            return
        gap = max(1, self.sheet.gap // 4)
        wide, tall = (place.width - 2 * gap) // 3, (place.height - 2 * gap) // 3
        for i, sport in enumerate([sport for sport in self.all if sport.tasks][: min(9, EVENTS)]):
            left, top = place.left + i % 3 * (wide + gap), place.top + i // 3 * (tall + gap)
            self._picture(sport, pygame.Rect(left, top, wide, tall))

    def _picture(self, sport: Sport, place: pygame.Rect) -> None:
        """The picture of a sport, or a pale panel where it has none."""
        image = self._image(sport, place.size)
        if image is not None:
            self.sheet.surface.blit(image, place)
        else:
            self.sheet.painter.panel(place, _CARD["quiet"], 0.12, 4 * self.sheet.unit)

    def _image(self, sport: Sport, size: tuple[int, int]) -> pygame.Surface | None:
        key = sport.name, size
        if key not in self._images:
            self._images[key] = tile_of(sport.folder, size)
        return self._images[key]

    def _page(self, sport: Sport, room: pygame.Rect) -> None:
        """The page of a sport: its picture, and a row for each thing that can be played."""
        gap, letters = self.sheet.gap, self.sheet.lettering
        small = letters.height("small")
        wide = min(room.width // 3, TILE[0] * 4 // 3)
        place = pygame.Rect(room.left, room.top, wide, wide * TILE[1] // TILE[0])
        self._picture(sport, place)
        back = pygame.Rect(
            room.left, place.bottom + 2 * gap, letters.width("Esc  all sports", "small") + 4 * gap, 2 * small
        )
        self.part(back, "back", "Esc  all sports", "quiet", left=back.left + 2 * gap)
        self.across = 1
        left = place.right + 4 * gap
        listed = self.listed(pygame.Rect(left, room.top, room.right - left, room.height), 2 * small + 4 * gap)
        for entry, row in listed:
            row.height -= gap
            self._row(entry, row)

    def _row(self, entry: Entry, row: pygame.Rect) -> None:
        sheet, gap, letters, unit = self.sheet, self.sheet.gap, self.sheet.lettering, self.sheet.unit
        right, two = row.right, None
        if entry.kind == "task":
            label = "for two"
            two = pygame.Rect(0, 0, letters.width(label, "small") + 4 * gap, row.height)
            two.topright = row.topright
            self.part(two, entry._replace(kind="two"), label, "quiet", left=two.left + 2 * gap)
            right = two.left - gap
        main = pygame.Rect(row.left, row.top, right - row.left, row.height)
        self.part(main, entry, lit=0.5 * HOVERED)
        x, small = row.left + 2 * gap, letters.height("small")
        if entry.kind == "task":
            stars(sheet, (x + SMALL_STAR * unit, row.centery), SMALL_STAR * unit, self.best.stars(entry.source))
        x += round(8 * SMALL_STAR * unit)
        if entry.level:
            right = min(right, self._level(entry.level, right, row.centery) - gap)
        y = row.centery - small - gap // 4
        sheet.write(letters.cut(entry.title, "small", right - x, True), "small", (x, y), _CARD["text"], bold=True)
        about = letters.cut(entry.about, "small", right - x - gap)
        sheet.write(about, "small", (x, row.centery + gap // 4), _CARD["quiet"])

    def _level(self, level: int, right: float, y: float) -> int:
        """Draw the level of a task, as one to five bars that grow; returns where they begin, in px."""
        wide, gap, unit = round(4 * self.sheet.unit), round(2 * self.sheet.unit), self.sheet.unit
        left = round(right - 2 * self.sheet.gap - LEVELS * (wide + gap))
        for place in range(LEVELS):
            tall = round((5 + 3 * place) * unit)
            lit = _CARD["accent"] if place < level else mix(_CARD["background"], _CARD["quiet"], 0.35)
            self.sheet.surface.fill(lit, (left + place * (wide + gap), round(y + 8 * unit) - tall, wide, tall))
        return left
