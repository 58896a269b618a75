"""Strip charts: speed, height and spin of the ball that is played, over the time of the shot."""

from __future__ import annotations

from itertools import pairwise
from math import pi
from typing import Any

import numpy as np
import pygame

from sandbox.picture.palette import palette
from sandbox.picture.sheet import Sheet
from sandbox.sport.amounts import signed
from sandbox.window.shot import Shot

CARD, ENERGY = palette("card"), palette("energy")

#: Points of a line; width of the card, usually and next to a table, and height of a strip, px on 720 rows.
SAMPLES, WIDTH, NARROW, STRIP = 200, 280, 170, 46
#: The card is at most this share of the picture's width, unless its text is wider.
SHARE = 0.22
#: Before the largest value of all, of either sign.
PEAK = "peak "

#: Name, unit, values over time, and digits after the point.
Strip = tuple[str, str, np.ndarray, int]


class Charts:
    """The strips of one shot."""

    def __init__(self, shot: Shot, picture: Any = None) -> None:
        """Heights are above the ground of ``picture``, if it has one."""
        self.shot = shot
        end = shot.run.duration
        #: A moment before each impact, and the impact, so that steps are vertical.
        hits = [e.t for e in shot.run.events if e.kind == "impact" and e.ball == shot.ball][:100]
        times = np.union1d(np.linspace(0.0, end, SAMPLES), [t for hit in hits for t in (max(0.0, hit - 1e-6), hit)])
        self.times = times
        x, y, vx, vy, spin = np.array([shot.run.state(shot.ball, float(t)) for t in times]).T
        self.strips: list[Strip] = [("speed", "m/s", np.hypot(vx, vy), 2)]
        if shot.upright:
            self.strips.append(("height", "m", heights(shot, picture, x, y), 2))
        else:
            way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
            self.strips.append(("way", "m", way, 2))
        self.strips.append(("spin", "rpm", spin * 30 / pi, 0))

    def draw(self, sheet: Sheet, top: float, t: float | None, avoid: pygame.Rect) -> None:
        """A card at the right below the row ``top``, or at the left in a view from above.

        ``t`` in s is marked.
        """
        unit, gap, letters = sheet.unit, sheet.gap, sheet.lettering
        row = letters.height("small") + gap // 2
        tall = round(STRIP * unit)
        shown = [
            float(values[np.abs(values).argmax()] if t is None else np.interp(t, self.times, values))
            for _, _, values, _ in self.strips
        ]
        texts = [_text(value, strip) for value, strip in zip(shown, self.strips, strict=True)]
        written = max(
            letters.width(strip[0], "small") + letters.width(_text(value, strip), "small", bold=True)
            for strip in self.strips
            for value in (strip[2].min(), strip[2].max())
        )
        wide = min((WIDTH if self.shot.upright else NARROW) * unit, SHARE * sheet.size[0])
        wide = max(round(wide), written + 5 * gap)
        rect = pygame.Rect(0, 0, wide, len(self.strips) * (row + tall + gap) + 3 * gap)
        if t is None and wide >= written + letters.width(PEAK, "small", bold=True) + 5 * gap:
            texts = [PEAK + text for text in texts]
        if self.shot.upright:
            rect.topright = sheet.frame.right, round(top)
            if rect.colliderect(avoid):
                rect.top = avoid.bottom + gap
        else:
            rect.bottomleft = sheet.frame.left, round(sheet.frame.bottom - sheet.card_height() - gap)
        sheet.painter.panel(rect, CARD["background"], 0.85, 10 * unit)
        end = max(self.shot.run.duration, 1e-9)
        for number, (name, _, values, _) in enumerate(self.strips):
            y = rect.top + 1.5 * gap + number * (row + tall + gap)
            plot = pygame.Rect(rect.left + 2 * gap, round(y) + row, rect.width - 4 * gap, tall)
            low, high = min(0.0, float(values.min())), float(values.max())
            scale = (plot.height - 2) / max(high - low, 1e-9)
            columns = plot.left + plot.width * self.times / end
            rows = plot.bottom - 1 - (values - low) * scale
            sheet.surface.fill(ENERGY["rule"], (plot.left, round(plot.bottom - 1 + low * scale), plot.width, 1))
            for a, b in pairwise(np.column_stack([columns, rows])):
                pygame.draw.aaline(sheet.surface, CARD["accent"], a, b, max(2, round(1.6 * unit)))
            letters.write(sheet.surface, name, "small", (plot.left, y), CARD["quiet"])
            letters.write(sheet.surface, texts[number], "small", (plot.right, y), CARD["text"], "topright", bold=True)
            if t is not None:
                at = plot.left + plot.width * t / end
                sheet.surface.fill(CARD["quiet"], (round(at), plot.top, 1, plot.height))
                sheet.painter.disc((at, plot.bottom - 1 - (shown[number] - low) * scale), 4 * unit, CARD["text"])


def heights(shot: Shot, picture: Any, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """How high the played ball is above the ground at places in m, as in the pictures."""
    ground = getattr(picture, "ground", None)  # in a picture from the side
    if ground is None:
        return y
    radius = next(ball.radius for ball in shot.run.setup.balls if ball.name == shot.ball)
    return np.asarray(np.maximum(0.0, y - radius - ground(x)))


def _text(value: float, strip: Strip) -> str:
    _, unit, _, digits = strip
    return signed(f"{value:.{digits}f}") + f" {unit}"
