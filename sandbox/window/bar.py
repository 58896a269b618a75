"""The bar along the bottom: the scene's name, playback buttons, the time line, and buttons for panel and lists."""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache

import pygame

from sandbox.picture.lettering import Lettering
from sandbox.picture.painter import OVERSAMPLING, scratch
from sandbox.picture.palette import Colour, mix, palette
from sandbox.window.canvas import Canvas
from sandbox.window.shots import Playback, Shot

_CARD, _TRACE = palette("card"), palette("trace")
HEIGHT = 48  # px on 720 rows
_PLAYER = "-next_shot", "restart", "-step", "go", "step", "next_shot"  # commands that are icons, on the left
WORDS = "see", "keep", "more", "panel", "help"  # commands that are words, on the right
_MOST_TICKS = 200  # on the time line
_APART = 8  # px, at least, between two marks on the time line
LEAST = 160  # px on 720 rows, of the time line
_WIDEST_RATE = "×1/16"
#: What is left out in a narrow window until the time line has room, in this order: the scene's part of a preset's name,
#: the shot's duration, and buttons whose commands have a key or are in the list "more".
_HIDE_ORDER = (
    frozenset({"scene"}),
    frozenset({"duration"}),
    frozenset({"-next_shot", "next_shot"}),
    frozenset({"panel", "help"}),
    frozenset({"-faster", "rate", "faster"}),
    frozenset({"-step", "step"}),
)
_Pixel = tuple[int, int]  # px
_GROOVE = mix(_CARD["background"], _CARD["quiet"], 0.35)

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


@lru_cache(maxsize=64)
def _icon(name: str, side: int, colour: Colour) -> pygame.Surface:
    large = side * OVERSAMPLING
    mask = scratch((large, large), colour)
    for polygon in ICONS[name]:
        pygame.draw.polygon(mask, colour, [(x * large, y * large) for x, y in polygon])
    return pygame.transform.smoothscale(mask, (side, side))


class Bar:
    """The bar in ``rect`` of a window that is laid out for ``rows`` rows."""

    def __init__(self, rect: pygame.Rect, rows: int) -> None:
        self.rect, self.unit = rect, rows / 720
        self.lettering = Lettering(rows)
        self.places: dict[str, pygame.Rect] = {}  # of everything by name: commands, "rate", "line" and "time"
        self.title = ""  # cut to fit

    @property
    def line(self) -> pygame.Rect:
        return self.places.get("line", pygame.Rect(0, 0, 0, 0))

    @property
    def buttons(self) -> dict[str, pygame.Rect]:
        """Places by command."""
        return {name: rect for name, rect in self.places.items() if name not in ("rate", "line", "time")}

    def command_at(self, position: _Pixel) -> str | None:
        return next((name for name, rect in self.buttons.items() if rect.collidepoint(position)), None)

    def on_line(self, position: _Pixel) -> bool:
        """True if a place is on the time line, or near it."""
        return self.line.inflate(16, self.rect.height - 12).collidepoint(position)

    def share(self, position: _Pixel) -> float:
        """The position of a place along the time line, 0 to 1."""
        return min(1.0, max(0.0, (position[0] - self.line.left) / max(1, self.line.width)))

    def _lay_out(self, title: str, duration: float) -> None:
        """Place everything that fits."""
        time, least = "0" * max(2, len(f"{duration:.0f}")) + ".00 s", round(LEAST * self.unit)
        without: frozenset[str] = frozenset()
        for spared in (frozenset(), *_HIDE_ORDER):
            without |= spared
            self.title = title.rpartition("/")[2] if "scene" in without else title
            self._place(time if "duration" in without else f"{time[:-2]} / {time}", without)
            if self.line.width >= least:
                return
        room = self.lettering.width(self.title, "small", bold=True) - (least - self.line.width)
        self.title = self.lettering.cut(self.title, "small", room, bold=True)
        self._place(time, without)

    def _place(self, time: str, without: frozenset[str]) -> None:
        """Place everything except ``without``, from left to right; the time line takes what is left over."""
        gap, side, thick = round(8 * self.unit), round(30 * self.unit), max(3, round(4 * self.unit))

        def width(text: str, bold: bool = False) -> int:
            return self.lettering.width(text, "small", bold)

        # Each with what is free before it, its width, and what is free after it.
        parts = [
            ("menu", 0, width(self.title, bold=True) + 2 * gap, gap),
            *((name, 0, side, gap // 4) for name in _PLAYER),
            ("line", gap, 0, 12),
            ("time", 0, width(time), 2 * gap),
            ("-faster", 0, side, 0),
            ("rate", 0, max(round(44 * self.unit), width(_WIDEST_RATE)), 0),
            ("faster", 0, side, 0),
            *((name, gap // 2 + gap * (name == WORDS[0]), width(name) + 2 * gap, 0) for name in WORDS),
        ]
        parts = [part for part in parts if part[0] not in without]
        left, over = self.rect.left + 2 * gap, self.rect.width - 4 * gap - sum(sum(part[1:]) for part in parts)
        self.places = {}
        for name, before, wide, after in parts:
            size = (max(0, over), thick) if name == "line" else (wide, side)
            self.places[name] = pygame.Rect((left + before, self.rect.centery - size[1] // 2), size)
            left += before + size[0] + after

    # Drawing

    def draw(
        self,
        sheet: Canvas,
        title: str,
        shot: Shot | None,
        playback: Playback | None,
        on: Collection[str],
        mouse: _Pixel,
    ) -> None:
        """Draw it on the window's sheet, for a shot and its clock; ``on`` are the commands whose lists are open."""
        sheet.surface.fill(_CARD["background"], self.rect)
        duration, rate = shot.run.duration if shot is not None else 0.0, playback.rate if playback is not None else 1.0
        self._lay_out(title, duration)
        for name, rect in self.buttons.items():
            here, bold = rect.collidepoint(mouse), name == "menu"
            if bold or name in WORDS:
                text, lit = self.title if bold else name, 0.22 if name in on or bold or here else 0.0
                sheet.item(rect, text, _CARD["accent" if name in on else "text"], lit, bold, rect.left + 8 * self.unit)
                continue
            if here:
                sheet.painter.panel(rect, _CARD["quiet"], 0.22, 6 * self.unit)
            playing = playback is not None and playback.playing
            icon = ("pause" if playing else "play") if name == "go" else name
            image = _icon(icon, round(0.5 * rect.height), _CARD["accent" if name == "go" else "text"])
            sheet.surface.blit(image, image.get_rect(center=rect.center))
        if "rate" in self.places:
            text = f"×{rate:g}" if rate >= 1 else f"×1/{round(1 / rate)}"
            sheet.lettering.write(sheet.surface, text, "small", self.places["rate"].center, _CARD["text"], "center")
        impacts = [event.t for event in shot.run.events if event.kind == "impact"] if shot is not None else []
        self._time(sheet, duration, impacts[:_MOST_TICKS], playback.t if playback is not None else None)

    def _time(self, sheet: Canvas, duration: float, impacts: list[float], now: float | None) -> None:
        surface, room, thick = sheet.surface, self.places["time"], self.line.height
        times = [f"{duration:.2f} s"]
        if now is not None:
            times = [f"{now:.2f} / {times[0]}", f"{now:.2f} s"]
        text = next(text for text in times if text is times[-1] or self.lettering.width(text, "small") <= room.width)
        self.lettering.write(surface, text, "small", room.midright, _CARD["quiet"], "midright")
        surface.fill(_GROOVE, self.line)

        def column(t: float) -> int:
            return self.line.left + round(self.line.width * t / max(duration, 1e-9))

        last = -_APART
        for tick in map(column, impacts):
            if tick - last >= _APART:
                surface.fill(_CARD["accent"], (tick - 1, self.line.top - thick, 2, 3 * thick))
                last = tick
        if now is not None:
            at = column(now)
            surface.fill(_TRACE["colours"][0], (self.line.left, self.line.top, at - self.line.left, thick))
            sheet.painter.disc((at, self.rect.centery), 7 * self.unit, _CARD["text"])
