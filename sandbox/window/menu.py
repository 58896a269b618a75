"""The menu: every scene with its presets, each with what it is and looks like; recent and own files first."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future

import pygame

from sandbox.errors import SandboxError
from sandbox.picture.palette import palette
from sandbox.scene import load, simulate
from sandbox.window.overlay import HOVERED, Row, Scrolled

CARD = palette("card")

#: Size of a thumbnail in px, and width of the column of scenes in px on 720 rows.
THUMBNAIL, COLUMN = (160, 90), 170
TITLE = "What shall we play?"


def thumbnail(source: str) -> bytes:
    """The poster of a scene, in RGB; empty if it cannot be run or drawn."""
    try:
        scene = load(source)
        large = scene.picture(simulate(scene), (4 * THUMBNAIL[0], 4 * THUMBNAIL[1])).poster()
        return pygame.image.tobytes(pygame.transform.smoothscale(large, THUMBNAIL), "RGB")
    except (SandboxError, ArithmeticError, AttributeError, LookupError, TypeError, ValueError):
        return b""


class Menu(Scrolled):
    """A column of scenes, and the presets of the one that is chosen."""

    def __init__(
        self,
        groups: Mapping[str, Sequence[Row]],
        play: Callable[[str], object],
        picture_of: Callable[[str], Future[bytes]],
        now: str,
    ) -> None:
        """``now`` is the source of what is played."""
        super().__init__()
        self.groups, self.play, self.picture_of = dict(groups), play, picture_of
        self.pictures: dict[str, Future[bytes]] = {}
        self.turn_to(next(iter(self.groups)))
        for group, row in ((group, row) for group, rows in self.groups.items() for row in rows if row.action == now):
            self.group, self.chosen = group, row

    @property
    def rows(self) -> Sequence[Row]:
        return self.groups[self.group]

    @property
    def progress(self) -> int:  # type: ignore[override]
        """How many thumbnails there are."""
        return sum(picture.done() for picture in self.pictures.values())

    @property
    def waiting(self) -> bool:  # type: ignore[override]
        return self.progress < len(self.pictures)

    def turn_to(self, group: str) -> None:
        """Show another group."""
        self.group, self.first = group, 0
        self.chosen = self.rows[0]

    def do(self, what: Row | str) -> bool:
        if isinstance(what, str):
            self.turn_to(what)
        else:
            self.play(what.action)
        return isinstance(what, str)

    def move(self, across: int, down: int) -> None:
        if across:
            names = list(self.groups)
            self.turn_to(names[(names.index(self.group) + across) % len(names)])
        else:
            place = (self.rows.index(self.chosen) + down) % len(self.rows)
            self.chosen = self.rows[place]
            self.show(place)

    def compose(self) -> None:
        sheet, letters, gap, unit = self.sheet, self.sheet.lettering, self.sheet.gap, self.sheet.unit
        rect = sheet.surface.get_rect().inflate(-4 * gap, -4 * gap)
        sheet.board(rect)
        small, top = letters.height("small"), rect.top + letters.height("medium") + 3 * gap
        at, title = (rect.left + 3 * gap, rect.top + 2 * gap), letters.cut(TITLE, "medium", rect.width, bold=True)
        sheet.write(title, "medium", at, CARD["text"], bold=True)
        wide = max(round(COLUMN * unit), max(letters.width(name, "small", True) for name in self.groups) + 4 * gap)
        wide = min(wide, rect.width // 3)
        tall = min(small + gap, (rect.bottom - top - gap) // len(self.groups))
        for number, name in enumerate(self.groups):
            place = pygame.Rect(rect.left + gap, top + number * tall, wide, tall)
            here = name == self.group
            self.part(place, name, name, "accent" if here else "quiet", lit=HOVERED * here, left=place.left + 2 * gap)
        frame = pygame.Rect((0, 0), [round(length * max(0.6, min(1.0, unit))) for length in THUMBNAIL])
        left, row_height = rect.left + wide + 3 * gap, max(frame.height + 2 * gap, 3 * small)
        self.seen = max(1, (rect.bottom - top - gap) // row_height)
        for number, row in enumerate(self.shown):
            place = pygame.Rect(left, top + number * row_height, rect.right - gap - left, row_height - gap)
            self.part(place, row)
            frame.midleft = place.left + gap, place.centery
            self._picture(row.action, frame)
            x, y, room = frame.right + 2 * gap, place.top + gap, place.right - frame.right - 3 * gap
            colour = CARD["accent" if row.action in self.on else "text"]
            sheet.write(letters.cut(row.text, "small", room, True), "small", (x, y), colour, bold=True)
            lines, most = letters.wrapped(row.about, "small", room), max(1, (place.height - gap) // small - 1)
            if len(lines) > most:
                lines = [*lines[: most - 1], letters.cut(" ".join(lines[most - 1 :]), "small", room)]
            for line, text in enumerate(lines, 1):
                sheet.write(text, "small", (x, y + line * small), CARD["quiet"])
        if len(self.rows) > self.seen:
            text = f"{self.first + 1} to {self.first + len(self.shown)} of {len(self.rows)}"
            sheet.write(text, "small", (rect.right - 2 * gap, rect.top + 2 * gap), CARD["quiet"], "topright")

    def _picture(self, source: str, frame: pygame.Rect) -> None:
        """A thumbnail, asked for once it is seen."""
        if source not in self.pictures:
            self.pictures[source] = self.picture_of(source)
        picture = self.pictures[source]
        pixels = picture.result() if picture.done() and not picture.cancelled() and not picture.exception() else b""
        if pixels:
            image = pygame.image.frombuffer(pixels, THUMBNAIL, "RGB")
            self.sheet.surface.blit(pygame.transform.smoothscale(image, frame.size), frame)
        else:
            self.sheet.painter.panel(frame, CARD["quiet"], 0.12, 4 * self.sheet.unit)
