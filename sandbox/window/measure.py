"""Measuring on the picture: a point of a trace under the mouse, and a tape between two places."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np
import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.palette import palette
from sandbox.picture.sheet import Entry
from sandbox.sport.amounts import metres
from sandbox.window.canvas import Canvas
from sandbox.window.layout import Layout
from sandbox.window.shots import Shot

_CARD = palette("card")

#: The mouse reads a trace from this distance, in px on 720 rows.
NEAR = 11.0


@dataclass(frozen=True)
class _Reading:
    """A ball at one time of its path, and where that is in px."""

    ball: str
    t: float  # s
    at: tuple[float, float]


def reading(
    shot: Shot,
    pixels: Callable[[np.ndarray], np.ndarray],
    mouse: tuple[int, int],
    near: float,
    until: float | None,
) -> _Reading | None:
    """The point of a trace nearest to the mouse, no farther than ``near`` px; up to the time ``until`` in s. ``pixels``
    gives the places in px of points in m, both of shape (n, 2)."""
    best: _Reading | None = None
    for ball in shot.movers:
        track = shot.track(ball)
        if until is not None:
            track = track[track[:, 0] <= until]
        if len(track) < 2:
            continue
        away, i, share = away_from(pixels(track[:, 1:]), mouse)
        if away <= near:
            t = float(track[i, 0] + share * (track[i + 1, 0] - track[i, 0]))
            ((x, y),) = pixels(np.array([shot.run.state(ball, t)[:2]])).tolist()
            near, best = away, _Reading(ball, t, (x, y))
    return best


def away_from(line: np.ndarray, at: tuple[float, float]) -> tuple[float, int, float]:
    """The distance from a line or a point (px, shape (n, 2)); the nearest piece, and the share along that."""
    along = np.diff(line, axis=0) if len(line) > 1 else np.zeros((1, 2))
    from_start = np.asarray(at) - line[: len(along)]
    squares = np.maximum((along**2).sum(axis=1), 1e-12)
    share = np.clip((from_start * along).sum(axis=1) / squares, 0.0, 1.0)
    away = np.hypot(*(from_start - share[:, None] * along).T)
    i = int(away.argmin())
    return float(away[i]), i, float(share[i])


def draw_reading(sheet: Canvas, layout: Layout, shot: Shot, read: _Reading, entries: Sequence[Entry]) -> None:
    """A mark on the trace, and next to it the ball's state there."""
    unit = sheet.unit
    sheet.painter.disc(read.at, 7 * unit, _CARD["background"], 0.9)
    sheet.painter.disc(read.at, 5 * unit, _CARD["text"])
    rows = [("time", f"{read.t:.3f} s"), *((e[0], e[1]) for e in entries if e[0] != "time")]
    if len(shot.movers) > 1:
        rows.insert(0, ("ball", read.ball))
    _beside(sheet, layout, "reading", rows, read.at)


def _beside(sheet: Canvas, layout: Layout, name: str, rows: Sequence[tuple[str, str]], at: tuple[float, float]) -> None:
    """A card of labels and values next to a place in px, on the side where there is room; the last rows go first."""
    middle, away = sheet.surface.get_rect().center, 16 * sheet.unit
    right, below = at[0] > 1.3 * middle[0], at[1] < middle[1]
    anchor = ("top" if below else "bottom") + ("right" if right else "left")
    mark = pygame.Rect(0, 0, round(away), round(away))
    mark.center = round(at[0]), round(at[1])
    layout.kept.append(mark)
    forms = [sheet.text(rows[:count])._replace(whole=count == len(rows)) for count in range(len(rows), 0, -1)]
    layout.put(name, forms, (at[0] + (-away if right else away), at[1] + (away if below else -away)), anchor)


@dataclass
class Tape:
    """A measuring tape between two places of the world, in m."""

    start: tuple[float, float]
    end: tuple[float, float]

    @property
    def length(self) -> float:
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    def draw(self, sheet: Canvas, layout: Layout, camera: Camera, upright: bool) -> None:
        a, b = camera.pixel(*self.start), camera.pixel(*self.end)
        unit = sheet.unit
        if hypot(b[0] - a[0], b[1] - a[1]) > 1:
            sheet.painter.line([a, b], 4.5 * unit, _CARD["background"], 0.75)
            sheet.painter.dashes([a, b], 2.2 * unit, _CARD["text"], 9 * unit, 5 * unit)
        for at in (a, b):
            sheet.painter.disc(at, 5.5 * unit, _CARD["background"], 0.9)
            sheet.painter.disc(at, 3.6 * unit, _CARD["accent"])
        along, across = self.end[0] - self.start[0], self.end[1] - self.start[1]
        names = ("along", "up") if upright else ("x", "y")
        lengths = [("tape", self.length), (names[0], along), (names[1], across)]
        _beside(sheet, layout, "tape", [(name, metres(length, 2)) for name, length in lengths], b)
