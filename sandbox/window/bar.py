"""The bar along the bottom: the scene's name, playback buttons, the time line, and buttons for panel and lists."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import pygame

from sandbox.picture.lettering import Lettering
from sandbox.picture.painter import OVERSAMPLING, scratch
from sandbox.picture.palette import Colour, mix, palette
from sandbox.window.canvas import Canvas
from sandbox.window.keys import named

CARD, TRACE = palette("card"), palette("trace")
HEIGHT = 48  # px on 720 rows
APART = 8  # px, at least, between two marks on the time line
LEAST = 160  # px on 720 rows, of the time line
WIDEST_RATE = "×1/16"
#: What is left out in a narrow window until the time line has room, in this order: the scene's part of a preset's name,
#: the shot's duration, and buttons whose commands have a key or are in the list "more".
SPARED = (
    frozenset({"scene"}),
    frozenset({"duration"}),
    frozenset({"-next_shot", "next_shot"}),
    frozenset({"panel", "help"}),
    frozenset({"-faster", "rate", "faster"}),
    frozenset({"-step", "step"}),
)
GROOVE = mix(CARD["background"], CARD["quiet"], 0.35)

_RIGHT = [(0.22, 0.1), (0.86, 0.5), (0.22, 0.9)]
_LEFT = [(1 - x, y) for x, y in _RIGHT]


def _block(left: float, right: float) -> list[tuple[float, float]]:
    return [(left, 0.1), (right, 0.1), (right, 0.9), (left, 0.9)]


def _slim(points: list[tuple[float, float]], left: float, width: float) -> list[tuple[float, float]]:
    return [(left + x * width, y) for x, y in points]


#: Polygons in a square of 1 by 1.
ICONS = {
    "play": [_RIGHT],
    "pause": [_block(0.2, 0.42), _block(0.58, 0.8)],
    "step": [_block(0.08, 0.24), _slim(_RIGHT, 0.26, 0.74)],
    "-step": [_block(0.76, 0.92), _slim(_LEFT, 0.0, 0.74)],
    "restart": [_block(0.08, 0.22), _slim(_LEFT, 0.2, 0.8)],
    "-next_shot": [_slim(_LEFT, 0.0, 0.5), _slim(_LEFT, 0.45, 0.5)],
    "next_shot": [_slim(_RIGHT, 0.05, 0.5), _slim(_RIGHT, 0.5, 0.5)],
    "-faster": [[(0.15, 0.42), (0.85, 0.42), (0.85, 0.58), (0.15, 0.58)]],
    "faster": [[(0.15, 0.42), (0.85, 0.42), (0.85, 0.58), (0.15, 0.58)], _block(0.42, 0.58)],
}

#: What the buttons that open lists say; the others say what the help does.
HINTS = {
    "see": "what is shown: fan, map, arrows, charts, tape, accuracy",
    "keep": "pictures, replays, scene files",
    "more": "scenes, sound, full screen",
}


def hint_of(button: str) -> str:
    """What a button does, and by which key; a button with a minus does the opposite of its command."""
    if button in HINTS:
        return HINTS[button]
    command = named(button.removeprefix("-"))
    return f"{command.meaning} ({command.shown})"


@lru_cache(maxsize=64)
def _icon(name: str, side: int, colour: Colour) -> pygame.Surface:
    large = side * OVERSAMPLING
    mask = scratch((large, large), colour)
    for polygon in ICONS[name]:
        pygame.draw.polygon(mask, colour, [(x * large, y * large) for x, y in polygon])
    return pygame.transform.smoothscale(mask, (side, side))


@dataclass(frozen=True)
class Shown:
    """What the bar shows."""

    title: str
    playing: bool
    t: float | None  # s; None while aiming
    duration: float  # s
    ticks: tuple[float, ...]  # s, of impacts
    rate: float
    texts: tuple[str, ...]  # commands that are words, on the right
    on: frozenset[str] = frozenset()  # those of them that are open


class Bar:
    """The bar in ``rect`` of a window that is laid out for ``rows`` rows."""

    def __init__(self, rect: pygame.Rect, rows: int) -> None:
        self.rect, self.unit = rect, rows / 720
        self.lettering = Lettering(rows)
        self.places: dict[str, pygame.Rect] = {}  # of everything by name: commands, "rate", "line" and "time"
        self.title = ""  # cut to fit
        self._laid_out: tuple[str, tuple[str, ...], str] | None = None

    @property
    def line(self) -> pygame.Rect:
        return self.places.get("line", pygame.Rect(0, 0, 0, 0))

    @property
    def buttons(self) -> dict[str, pygame.Rect]:
        """Places by command."""
        return {name: rect for name, rect in self.places.items() if name not in ("rate", "line", "time")}

    def command_at(self, position: tuple[int, int]) -> str | None:
        return next((name for name, rect in self.buttons.items() if rect.collidepoint(position)), None)

    def share_at(self, position: tuple[int, int]) -> float | None:
        """The position of a point on the time line, 0 to 1; None if it is not on it."""
        if not self.line.inflate(16, self.rect.height - 12).collidepoint(position):
            return None
        return self.share(position)

    def share(self, position: tuple[int, int]) -> float:
        return min(1.0, max(0.0, (position[0] - self.line.left) / max(1, self.line.width)))

    # Places

    def _lay_out(self, shown: Shown) -> None:
        """Place everything that fits."""
        letters, least = self.lettering, round(LEAST * self.unit)
        time = "0" * max(2, len(f"{shown.duration:.0f}")) + ".00 s"
        if self._laid_out == (shown.title, shown.texts, time):
            return
        self._laid_out = shown.title, shown.texts, time
        without: frozenset[str] = frozenset()
        for spared in (frozenset(), *SPARED):
            without |= spared
            self.title = shown.title.rpartition("/")[2] if "scene" in without else shown.title
            self._place(shown, time if "duration" in without else f"{time[:-2]} / {time}", without)
            if self.line.width >= least:
                return
        room = letters.width(self.title, "small", bold=True) - (least - self.line.width)
        self.title = letters.cut(self.title, "small", room, bold=True)
        self._place(shown, time, without)

    def _place(self, shown: Shown, time: str, without: frozenset[str]) -> None:
        """Place everything except ``without``; the time line takes the rest."""
        gap, side, thick = round(8 * self.unit), round(30 * self.unit), max(3, round(4 * self.unit))
        places = self.places = {}

        def put(name: str, left: int, width: int, height: int = side) -> pygame.Rect:
            places[name] = pygame.Rect(left, self.rect.centery - height // 2, width, height)
            return places[name]

        left = put("menu", self.rect.left + 2 * gap, self._word_width(self.title, bold=True)).right + gap
        for name in ("-next_shot", "restart", "-step", "go", "step", "next_shot"):
            if name not in without:
                left = put(name, left, side).right + gap // 4
        right = self.rect.right - 2 * gap
        for name in reversed(shown.texts):
            if name not in without:
                width = self._word_width(name)
                right = put(name, right - width, width).left - gap // 2
        right -= gap
        rate = max(round(44 * self.unit), self.lettering.width(WIDEST_RATE, "small"))
        for name, width in (("faster", side), ("rate", rate), ("-faster", side)):
            if name not in without:
                right = put(name, right - width, width).left
        width = self.lettering.width(time, "small")
        right = put("time", right - 2 * gap - width, width).left
        put("line", left + gap, max(0, right - 12 - left - gap), thick)

    def _word_width(self, text: str, bold: bool = False) -> int:
        return self.lettering.width(text, "small", bold) + 2 * round(8 * self.unit)

    # Drawing

    def draw(self, sheet: Canvas, shown: Shown, mouse: tuple[int, int]) -> None:
        """Draw it on the window's sheet, with a hint at the button under the mouse."""
        sheet.surface.fill(CARD["background"], self.rect)
        self._lay_out(shown)
        for name, rect in self.buttons.items():
            here, on, bold = rect.collidepoint(mouse), name in shown.on, name == "menu"
            if bold or name in shown.texts:
                text, lit = self.title if bold else name, 0.22 if on or bold or here else 0.0
                sheet.item(rect, text, CARD["accent" if on else "text"], lit, bold, rect.left + 8 * self.unit)
                continue
            if here:
                sheet.painter.panel(rect, CARD["quiet"], 0.22, 6 * self.unit)
            icon = ("pause" if shown.playing else "play") if name == "go" else name
            image = _icon(icon, round(0.5 * rect.height), CARD["accent" if name == "go" else "text"])
            sheet.surface.blit(image, image.get_rect(center=rect.center))
        if "rate" in self.places:
            rate = f"×{shown.rate:g}" if shown.rate >= 1 else f"×1/{round(1 / shown.rate)}"
            sheet.lettering.write(sheet.surface, rate, "small", self.places["rate"].center, CARD["text"], "center")
        self._time(sheet, shown)
        hovered = self.command_at(mouse)
        if hovered is not None and hovered not in shown.on:
            at = self.places[hovered].centerx, self.rect.top - sheet.gap
            sheet.card([(hint_of(hovered), CARD["text"])], "midbottom", at)

    def _time(self, sheet: Canvas, shown: Shown) -> None:
        surface, room, thick = sheet.surface, self.places["time"], self.line.height
        times = [f"{shown.duration:.2f} s"]
        if shown.t is not None:
            times = [f"{shown.t:.2f} / {times[0]}", f"{shown.t:.2f} s"]
        text = next(text for text in times if text is times[-1] or self.lettering.width(text, "small") <= room.width)
        self.lettering.write(surface, text, "small", room.midright, CARD["quiet"], "midright")
        surface.fill(GROOVE, self.line)

        def column(t: float) -> int:
            return self.line.left + round(self.line.width * t / max(shown.duration, 1e-9))

        last = -APART
        for tick in map(column, shown.ticks):
            if tick - last >= APART:
                surface.fill(CARD["accent"], (tick - 1, self.line.top - thick, 2, 3 * thick))
                last = tick
        if shown.t is not None:
            at = column(shown.t)
            surface.fill(TRACE["colours"][0], (self.line.left, self.line.top, at - self.line.left, thick))
            sheet.painter.disc((at, self.rect.centery), 7 * self.unit, CARD["text"])
