"""The menu: every scene with its presets, each with what it is and looks like; recent and own files first."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import Future

import pygame

from sandbox.errors import SandboxError
from sandbox.picture.palette import palette
from sandbox.picture.sheet import Sheet
from sandbox.scene import load, simulate
from sandbox.window.overlay import ARROWS, Row

CARD = palette("card")

#: Size of a thumbnail in px, and of the column of scenes in px on 720 rows.
THUMBNAIL, COLUMN = (160, 90), 170
TITLE = "What shall we play?"


def thumbnail(source: str) -> bytes:
    """The poster of a scene, in RGB; empty if it cannot be run or drawn."""
    try:
        scene = load(source)
        large = scene.picture(simulate(scene), (4 * THUMBNAIL[0], 4 * THUMBNAIL[1])).poster()
        return pygame.image.tobytes(pygame.transform.smoothscale(large, THUMBNAIL), "RGB")
    except (
        SandboxError,
        ArithmeticError,
        AttributeError,
        LookupError,
        TypeError,
        ValueError,
    ):
        return b""


class Menu:
    """A column of scenes, and the presets of the one that is chosen."""

    name = "menu"

    def __init__(
        self,
        groups: Mapping[str, Sequence[Row]],
        choose: Callable[[str], object],
        picture_of: Callable[[str], Future[bytes]],
        chosen: str,
    ) -> None:
        self.groups, self.choose, self.picture_of = dict(groups), choose, picture_of
        last = [name for name, rows in self.groups.items() if any(row.action == chosen for row in rows)]
        self.group = last[-1] if last else next(iter(self.groups))
        self.chosen = chosen if last else self.groups[self.group][0].action
        self.first, self.seen = 0, 1  # of the rows that are seen, and how many
        self.places: list[tuple[pygame.Rect, Row]] = []
        self.columns: list[tuple[pygame.Rect, str]] = []
        self.pictures: dict[str, Future[bytes]] = {}

    @property
    def rows(self) -> Sequence[Row]:
        """The rows of the group that is shown."""
        return self.groups[self.group]

    @property
    def progress(self) -> int:
        """How many thumbnails there are."""
        return sum(picture.done() for picture in self.pictures.values())

    @property
    def waiting(self) -> bool:
        """Whether thumbnails are still being made."""
        return self.progress < len(self.pictures)

    # Choosing

    def pressed(self, at: tuple[int, int]) -> bool:
        for rect, group in self.columns:
            if rect.collidepoint(at):
                self.turn_to(group)
                return True
        row = next((row for rect, row in self.places if rect.collidepoint(at)), None)
        if row is not None:
            self.choose(row.action)
        return False

    def key(self, key: int) -> bool | None:
        if key == pygame.K_RETURN:
            self.choose(self.chosen)
            return False
        if key not in ARROWS:
            return None
        across, down = ARROWS[key]
        names, actions = list(self.groups), [row.action for row in self.rows]
        if across:
            self.turn_to(names[(names.index(self.group) + across) % len(names)])
        else:
            now = (actions.index(self.chosen) + down) % len(actions)
            self.chosen = actions[now]
            self.first = min(max(self.first, now - self.seen + 1), now)
        return True

    def turn_to(self, group: str) -> None:
        """Show another group."""
        self.group, self.first = group, 0
        self.chosen = self.rows[0].action

    def scroll(self, by: int) -> None:
        self.first = min(max(self.first + by, 0), max(0, len(self.rows) - self.seen))

    # Drawing

    def draw(self, sheet: Sheet, mouse: tuple[int, int], on: Collection[str]) -> None:
        letters, gap, unit = sheet.lettering, sheet.gap, sheet.unit
        rect = sheet.surface.get_rect().inflate(-4 * gap, -4 * gap)
        sheet.painter.panel(rect, CARD["background"], 0.97, 10 * unit)
        small, head = letters.height("small"), letters.height("medium") + 3 * gap
        at = rect.left + 3 * gap, rect.top + 2 * gap
        letters.write(
            sheet.surface, letters.cut(TITLE, "medium", rect.width, True), "medium", at, CARD["text"], bold=True
        )
        self.columns.clear()
        self.places.clear()
        wide = max(round(COLUMN * unit), max(letters.width(name, "small", True) for name in self.groups) + 4 * gap)
        wide = min(wide, rect.width // 3)
        tall = min(small + gap, (rect.height - head - gap) // len(self.groups))
        for number, name in enumerate(self.groups):
            place = pygame.Rect(rect.left + gap, rect.top + head + number * tall, wide, tall)
            self.columns.append((place, name))
            here = name == self.group
            if here or place.collidepoint(mouse):
                sheet.painter.panel(place, CARD["quiet"], 0.3 if here else 0.15, 5 * unit)
            colour = CARD["accent"] if here else CARD["quiet"]
            text = letters.cut(name, "small", wide - 3 * gap, bold=here)
            letters.write(sheet.surface, text, "small", (place.left + 2 * gap, place.centery), colour, "midleft", here)
        width, height = (round(length * max(0.6, min(1.0, unit))) for length in THUMBNAIL)
        left, row_height = rect.left + wide + 3 * gap, max(height + 2 * gap, 3 * small)
        self.seen = max(1, (rect.height - head - gap) // row_height)
        self.scroll(0)
        for number, row in enumerate(self.rows[self.first : self.first + self.seen]):
            place = pygame.Rect(left, rect.top + head + number * row_height, rect.right - gap - left, row_height - gap)
            self.places.append((place, row))
            if row.action == self.chosen or place.collidepoint(mouse):
                sheet.painter.panel(place, CARD["quiet"], 0.25, 6 * unit)
            frame = pygame.Rect(place.left + gap, place.centery - height // 2, width, height)
            self._picture(sheet, row.action, frame)
            at = frame.right + 2 * gap, place.top + gap
            room = place.right - at[0] - gap
            colour = CARD["accent"] if row.action in on else CARD["text"]
            letters.write(sheet.surface, letters.cut(row.text, "small", room, True), "small", at, colour, bold=True)
            lines = letters.wrapped(row.about, "small", room) if row.about else []
            most = max(1, (place.height - gap) // small - 1)
            if len(lines) > most:
                lines = [*lines[: most - 1], letters.cut(" ".join(lines[most - 1 :]), "small", room)]
            for line, text in enumerate(lines, 1):
                letters.write(sheet.surface, text, "small", (at[0], at[1] + line * small), CARD["quiet"])
        if len(self.rows) > self.seen:
            text = f"{self.first + 1} to {self.first + len(self.places)} of {len(self.rows)}"
            letters.write(
                sheet.surface, text, "small", (rect.right - 2 * gap, rect.top + 2 * gap), CARD["quiet"], "topright"
            )

    def _picture(self, sheet: Sheet, source: str, frame: pygame.Rect) -> None:
        """A thumbnail, asked for once it is seen."""
        if source not in self.pictures:
            self.pictures[source] = self.picture_of(source)
        picture = self.pictures[source]
        pixels = picture.result() if picture.done() and not picture.cancelled() and not picture.exception() else b""
        if pixels:
            image = pygame.image.frombuffer(pixels, THUMBNAIL, "RGB")
            sheet.surface.blit(pygame.transform.smoothscale(image, frame.size), frame)
        else:
            sheet.painter.panel(frame, CARD["quiet"], 0.12, 4 * sheet.unit)
