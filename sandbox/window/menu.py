"""The menu: every scene with its presets, each with what it is and looks like. And all keys, by what they are for."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path

import pygame

from sandbox.errors import SandboxError
from sandbox.picture.palette import palette
from sandbox.scene import load, simulate
from sandbox.scene.discovery import folder_of, is_installed
from sandbox.tasks.sports import TILE_FILE
from sandbox.window.canvas import Canvas
from sandbox.window.overlay import HOVERED, Overlay, Row
from sandbox.workers import Processes

_CARD = palette("card")

#: Size of a thumbnail in px, and width of the column of groups in px on 720 rows.
THUMBNAIL, _COLUMN = (160, 90), 170
#: The opacity (of 255) of a scene's tile in place of a thumbnail that is still made.
_UNTIL_THEN = 90


def tile_of(folder: Path | None, size: tuple[int, int]) -> pygame.Surface | None:
    """The picture in the folder of a scene, in px of that size; None if there is none."""
    try:
        return pygame.transform.smoothscale(pygame.image.load((folder or Path()) / TILE_FILE).convert(24), size)
    except (OSError, pygame.error):
        return None


def thumbnail(source: str) -> bytes:
    """The poster of a scene, in RGB; empty if it cannot be run or drawn."""
    try:
        scene = load(source)
        large = scene.picture(simulate(scene), (4 * THUMBNAIL[0], 4 * THUMBNAIL[1])).poster()
        return pygame.image.tobytes(pygame.transform.smoothscale(large, THUMBNAIL), "RGB")
    except (SandboxError, ArithmeticError, AttributeError, LookupError, TypeError, ValueError):
        return b""


class Thumbnails:
    """The thumbnails of scenes, made by a worker once they are asked for."""

    def __init__(self, worker: Processes) -> None:
        self.worker = worker
        self.made: dict[str, Future[bytes]] = {}

    def of(self, source: str) -> Future[bytes]:
        """The thumbnail of a scene; an empty one if it is not installed: no code runs only because it lies here."""
        if source not in self.made:
            folder = folder_of(source)
            safe = folder is not None and is_installed(folder)
            tile = tile_of(folder, THUMBNAIL) if folder is not None and source == folder.name else None
            if tile is not None:  # of the scene itself
                self.made[source] = Future()
                self.made[source].set_result(pygame.image.tobytes(tile, "RGB"))
                return self.made[source]
            self.made[source] = self.worker.submit(thumbnail, source) if safe else self.worker.submit(bytes)
        return self.made[source]

    def cancel(self) -> None:
        """Drop those that nobody waits for any more."""
        self.made = {source: work for source, work in self.made.items() if not work.cancel()}


class Menu(Overlay):
    """A column of groups, and the rows of the one that is chosen: lines, or with ``picture_of`` a picture and what is
    said of each; or tiles, pictures with their names below."""

    def __init__(
        self,
        title: str,
        groups: Mapping[str, Sequence[Row]],
        choose: Callable[[str], object],
        now: str = "",
        picture_of: Callable[[str], Future[bytes]] | None = None,
        tiles: str = "",
    ) -> None:
        """``now`` is the action that is chosen in the first group, which is shown; ``tiles`` the group of tiles."""
        super().__init__()
        self.title, self.groups, self.choose, self.picture_of = title, dict(groups), choose, picture_of
        self.tiles, self.across = tiles, 1  # tiles in a row
        self.turn_to(next(iter(self.groups)))
        self.chosen = next((row for row in self.rows if row.action == now), self.chosen)

    @property
    def rows(self) -> Sequence[Row]:
        return self.groups[self.group]

    def turn_to(self, group: str) -> None:
        """Show another group."""
        self.group, self.first = group, 0
        self.chosen = self.rows[0]

    def turn(self, by: int) -> None:
        names = list(self.groups)
        self.turn_to(names[(names.index(self.group) + by) % len(names)])

    def show(self, row: Row) -> None:
        line = self.rows.index(row) // self.across * self.across
        self.first = min(max(self.first, line - self.seen + self.across), line)

    def scroll(self, by: int) -> None:
        hidden = max(0, len(self.rows) - self.seen)
        self.first = min(max(self.first + by * self.across, 0), -(-hidden // self.across) * self.across)

    def do(self, what: Row | str) -> bool:
        if isinstance(what, str):
            self.turn_to(what)
        else:
            self.choose(what.action)
        return isinstance(what, str)

    def place(self, sheet: Canvas) -> pygame.Rect:
        return sheet.surface.get_rect().inflate(-4 * sheet.gap, -4 * sheet.gap)

    def compose(self) -> None:
        sheet, letters, gap, unit = self.sheet, self.sheet.lettering, self.sheet.gap, self.sheet.unit
        rect = self.place(sheet)
        sheet.board(rect)
        small, top = letters.height("small"), rect.top + letters.height("medium") + 3 * gap
        at, title = (rect.left + 3 * gap, rect.top + 2 * gap), letters.cut(self.title, "medium", rect.width, bold=True)
        sheet.write(title, "medium", at, _CARD["text"], bold=True)
        wide = max(round(_COLUMN * unit), max(letters.width(name, "small", True) for name in self.groups) + 4 * gap)
        wide = min(wide, rect.width // 3)
        tall = min(small + gap, (rect.bottom - top - gap) // len(self.groups))
        for number, name in enumerate(self.groups):
            place = pygame.Rect(rect.left + gap, top + number * tall, wide, tall)
            here = name == self.group
            self.part(place, name, name, "accent" if here else "quiet", lit=HOVERED * here, left=place.left + 2 * gap)
        left = rect.left + wide + 3 * gap
        room = pygame.Rect(left, top, rect.right - gap - left, rect.bottom - top - gap)
        frame = pygame.Rect((0, 0), [round(length * max(0.6, min(1.0, unit))) for length in THUMBNAIL])
        self.across = 1
        if self.picture_of is not None and self.group == self.tiles:
            self._tiles(self.picture_of, room, frame)
            return
        if self.picture_of is None:
            room.width = min(room.width, max(room.width // 2, self.width_of_words(self.sheet) + gap))
            for row, place in self.listed(room, round(small + 1.3 * gap)):
                self.words(row, place)
            return
        for row, place in self.listed(room, max(frame.height + 2 * gap, 3 * small)):
            place.height -= gap
            self.part(place, row)
            frame.midleft = place.left + gap, place.centery
            self._picture(self.picture_of, row.action, frame)
            x, y, wide = frame.right + 2 * gap, place.top + gap, place.right - frame.right - 3 * gap
            colour = _CARD["accent" if row.action in self.on else "text"]
            sheet.write(letters.cut(row.text, "small", wide, True), "small", (x, y), colour, bold=True)
            lines, most = letters.wrapped(row.about, "small", wide), max(1, (place.height - gap) // small - 1)
            if len(lines) > most:
                lines = [*lines[: most - 1], letters.cut(" ".join(lines[most - 1 :]), "small", wide)]
            for line, text in enumerate(lines, 1):
                sheet.write(text, "small", (x, y + line * small), _CARD["quiet"])

    def _tiles(self, picture_of: Callable[[str], Future[bytes]], room: pygame.Rect, frame: pygame.Rect) -> None:
        """The rows as pictures with their names below, as many in a row as there is room for."""
        sheet, letters, gap = self.sheet, self.sheet.lettering, self.sheet.gap
        wide, tall = frame.width + 2 * gap, frame.height + letters.height("small") + 3 * gap
        self.across = max(1, (room.width - gap) // (wide + gap))
        lines = max(1, room.height // (tall + gap))
        self.seen = self.across * lines
        self.scroll(0)
        self.scroll_bar(room, lines * (tall + gap))
        for i, row in enumerate(self.rows[self.first : self.first + self.seen]):
            place = pygame.Rect(room.left, room.top, wide, tall)
            place.move_ip(i % self.across * (wide + gap), i // self.across * (tall + gap))
            self.part(place, row)
            frame.midtop = place.centerx, place.top + gap
            self._picture(picture_of, row.action, frame)
            colour = _CARD["accent" if row.action in self.on else "text"]
            name = letters.cut(row.text, "small", frame.width, True)
            sheet.write(name, "small", (place.centerx, frame.bottom + gap), colour, "midtop", bold=True)

    def _picture(self, picture_of: Callable[[str], Future[bytes]], source: str, frame: pygame.Rect) -> None:
        """A thumbnail, asked for once it is seen."""
        if source not in self.pictures:
            self.pictures[source] = picture_of(source)
        picture = self.pictures[source]
        pixels = picture.result() if picture.done() and not picture.cancelled() and not picture.exception() else b""
        if pixels:
            image = pygame.image.frombuffer(pixels, THUMBNAIL, "RGB")
            self.sheet.surface.blit(pygame.transform.smoothscale(image, frame.size), frame)
            return
        self.sheet.painter.panel(frame, _CARD["quiet"], 0.12, 4 * self.sheet.unit)
        tile = None if picture.done() else tile_of(folder_of(source), frame.size)
        if tile is not None:
            tile.set_alpha(_UNTIL_THEN)
            self.sheet.surface.blit(tile, frame)
