"""A film strip: a few frames of a run until its story is told, in rows that fit a page."""

from __future__ import annotations

from math import ceil
from typing import Any

import numpy as np
import pygame

from sandbox.engine.paths.run import Run
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import palette
from sandbox.picture.path import hardest
from sandbox.picture.view import View

FILM = palette("film")

#: Frames along the way, and samples by which they are spread.
FRAMES, _SAMPLES = 5, 400
#: So many of the hardest touches have a frame of their own, so far apart in time as a share of the run.
_TOUCHES, _APART = 8, 0.005
#: A frame along the way is left out where a touch is nearer than this share of the way between two of them.
NEAR = 0.4
#: Heights over a frame's: of the margin with the holes, of a hole; and the gap between frames.
_MARGIN, _HOLE, _GAP = 0.11, 0.05, 0.022
#: Holes along each frame, and frames in a row at most.
_HOLES, _ACROSS = 8, 4


def strip_times(run: Run, until: float) -> list[float]:
    """Times in s from 0 to ``until``: some between which all balls together go equally far, and the hardest touches."""
    times = np.linspace(0.0, until, _SAMPLES)
    way = np.zeros(_SAMPLES)
    for ball in run.setup.balls:
        places = np.array([run.state(ball.name, float(t))[:2] for t in times])
        way[1:] += np.cumsum(np.hypot(*np.diff(places, axis=0).T))
    even = np.interp(np.linspace(0.0, way[-1], FRAMES), way, times) if way[-1] > 0.0 else times[:: _SAMPLES // FRAMES]
    shown: list[float] = []
    for event in hardest(run, most=_TOUCHES, until=until):
        if all(abs(event.t - t) > _APART * until for t in shown):
            shown.append(event.t)
    near = NEAR * way[-1] / (FRAMES - 1)
    touched = np.interp(shown, times, way)
    between = [float(t) for t in even[1:-1] if np.all(abs(np.interp(t, times, way) - touched) > near)]
    return sorted([0.0, *between, *shown, until])


def full_rows(times: list[float]) -> tuple[list[float], int]:
    """The times in s with as many more, in the longest gaps, as fill the rows of a strip; and the frames in a row."""
    rows = ceil(len(times) / _ACROSS)
    columns = ceil(len(times) / rows)
    full = sorted(times)
    while len(full) < rows * columns:
        longest = int(np.argmax(np.diff(full))) if len(full) > 1 else 0
        full.insert(longest + 1, (full[longest] + full[min(longest + 1, len(full) - 1)]) / 2)
    return full, columns


def film_strip(picture: View[Any], run: Run) -> pygame.Surface:
    """The frames in full rows, in the order in which one reads; each is as large as the picture."""
    times, columns = full_rows(strip_times(run, picture.story_end))
    frames = [picture.frame(t) for t in times]
    width, height = frames[0].get_size()
    rows = len(frames) // columns
    margin, gap = round(_MARGIN * height), round(_GAP * height)
    wide, tall = columns * (width + gap) + gap, height + 2 * margin
    strip = blank((wide, rows * tall + (rows - 1) * gap))
    strip.fill(FILM["hole"])
    for row in range(rows):
        film = strip.subsurface((0, row * (tall + gap), wide, tall))
        _draw_film(film, (width + gap) / _HOLES, round(_HOLE * height), margin)
        for column, frame in enumerate(frames[row * columns : (row + 1) * columns]):
            film.blit(frame, (gap + column * (width + gap), margin))
    return strip


def _draw_film(film: pygame.Surface, pitch: float, hole: int, margin: int) -> None:
    """A row of film without frames: holes every ``pitch`` px, ``hole`` px high, in the middle of both margins."""
    film.fill(FILM["base"])
    painter = Painter(film)
    for row in (margin // 2, film.get_height() - margin // 2):
        for i in range(round(film.get_width() / pitch) + 1):
            rect = pygame.Rect(0, 0, round(1.25 * hole), hole)
            rect.center = round((i + 0.5) * pitch), row
            painter.panel(rect, FILM["hole"], 1.0, 0.25 * hole)
