"""A film strip: a few frames of a run side by side, from its first to its last."""

from __future__ import annotations

import numpy as np
import pygame

from sandbox.engine.run import Run
from sandbox.picture.frames import Picture, frame_of
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import palette

FILM = palette("film")

#: Frames on a strip, and samples by which they are spread.
FRAMES, SAMPLES = 5, 400
#: All touches together count for this share of the way; a frame shows the touch that is nearer than this share of the
#: way between two frames.
TOUCHES, NEAR = 0.5, 0.4
#: Heights over a frame's: of the margin with the holes, of a hole; and the gap between frames.
MARGIN, HOLE, GAP = 0.11, 0.05, 0.022
#: Holes along each frame.
HOLES = 8


def strip_times(run: Run) -> list[float]:
    """Times in s, the first and the last among them, between which all balls together go equally far.

    Where something is struck, that counts as a part of the way, the more the harder, and the frame next to it shows it.
    """
    impacts = [event for event in run.events if event.kind == "impact" and 0.0 < event.t < run.duration]
    hits, hardness = np.array([event.t for event in impacts]), np.cumsum([0.0, *(event.speed for event in impacts)])
    times = np.union1d(np.linspace(0.0, run.duration, SAMPLES), hits)
    way = np.zeros(len(times))
    for ball in run.setup.balls:
        places = np.array([run.state(ball.name, float(t))[:2] for t in times])
        way[1:] += np.cumsum(np.hypot(*np.diff(places, axis=0).T))
    if way[-1] == 0.0:
        return [float(t) for t in np.linspace(0.0, run.duration, FRAMES)]
    way += TOUCHES * way[-1] * hardness[np.searchsorted(hits, times, side="right")] / max(hardness[-1], 1e-9)
    shares = np.linspace(0.0, way[-1], FRAMES)
    near = shares[1] * NEAR
    inner = []
    for share in shares[1:-1]:
        away = np.abs(np.interp(hits, times, way) - share)
        touch = len(hits) > 0 and away.min() < near
        inner.append(float(hits[away.argmin()] if touch else np.interp(share, way, times)))
    return [0.0, *inner, run.duration]


def film_strip(picture: Picture, run: Run) -> pygame.Surface:
    """The strip; each of its frames is as large as the picture's."""
    frames = [frame_of(picture, t) for t in strip_times(run)]
    width, height = frames[0].get_size()
    margin, gap = round(MARGIN * height), round(GAP * height)
    strip = blank((len(frames) * (width + gap) + gap, height + 2 * margin))
    strip.fill(FILM["base"])
    for i, frame in enumerate(frames):
        strip.blit(frame, (gap + i * (width + gap), margin))
    painter, tall = Painter(strip), round(HOLE * height)
    pitch = (width + gap) / HOLES
    for row in (margin // 2, strip.get_height() - margin // 2):
        for i in range(round(strip.get_width() / pitch) + 1):
            hole = pygame.Rect(0, 0, round(1.25 * tall), tall)
            hole.center = round((i + 0.5) * pitch), row
            painter.panel(hole, FILM["hole"], 1.0, 0.25 * tall)
    return strip
