"""The one piece that draws a chart over time: axes with round numbers, curves, bands, and marks of instants.

Graphs (``graph.py``), the energy chart (``energy_chart.py``) and the window's panels are made of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil, floor
from typing import Any, NamedTuple

import numpy as np
import pygame

from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import CARD, Sheet
from sandbox.sport.amounts import round_number_above, signed

CHART = palette("energy")


class Curve(NamedTuple):
    """A line over times in s: values, NaN where there is none; with a ``foot`` the upper edge of a band that stands on
    those values."""

    name: str
    times: np.ndarray
    values: np.ndarray
    colour: Colour
    opacity: float = 1.0
    foot: np.ndarray | None = None


class Plot(NamedTuple):
    """A rectangle in px that shows the time from 0 to ``until`` in s and values from ``low`` to ``high``."""

    rect: pygame.Rect
    until: float
    low: float
    high: float

    def column(self, t: Any) -> Any:
        """The column of a time in s, in px."""
        return self.rect.left + self.rect.width * t / self.until

    def row(self, value: Any) -> Any:
        """The row of a value, in px."""
        return self.rect.bottom - self.rect.height * (value - self.low) / (self.high - self.low)

    def draw(self, sheet: Sheet, curve: Curve) -> None:
        """A curve or a band."""
        painter, unit = sheet.painter, sheet.unit
        line = np.column_stack([self.column(curve.times), self.row(curve.values)])
        if curve.foot is None:
            for piece in np.split(line, np.flatnonzero(~np.isfinite(curve.values))):
                if len(known := piece[np.isfinite(piece[:, 1])]) > 1:
                    painter.line(known, max(1.2, 2.0 * unit), curve.colour, curve.opacity)
            return
        foot = np.column_stack([line[:, 0], self.row(curve.foot)])
        painter.polygon(np.concatenate([line, foot[::-1]]), curve.colour)
        painter.line(line, max(1.0, 1.2 * unit), CHART["ground"], 0.8)

    def mark(self, sheet: Sheet, hits: Sequence[float]) -> None:
        """Dashed lines at these times in s."""
        for hit in hits:
            ends = [(self.column(hit), row) for row in (self.rect.top, self.rect.bottom)]
            thin, dash = max(1, round(sheet.unit)), 4 * sheet.unit
            sheet.painter.dashes(ends, thin, CARD["text"], dash, dash, 0.3)


def _number(value: float) -> str:
    return signed(f"{value:.10g}")


def plotted(
    sheet: Sheet, rect: pygame.Rect, until: float, low: float, high: float, write: Callable[[float], str] = _number
) -> Plot:
    """Draw axes with round values and times inside a rectangle."""
    letters, gap, thin = sheet.lettering, sheet.gap, max(1, round(sheet.unit))
    small = letters.height("small")
    step = round_number_above(max(1.9 * small / max(1, rect.height - small - gap), 0.15) * (high - low))
    levels = [i * step for i in range(ceil(low / step - 1e-9), floor(high / step + 1e-9) + 1)]
    if len(levels) == 1:  # a low chart: round numbers near its ends
        levels = [_rounded(end) for end in (low, high)]
    texts = [write(level) for level in levels]
    left = max(letters.width(text, "small") for text in ["0000", *texts]) + gap  # mostly the same: charts in line
    plot = Plot(pygame.Rect(rect.left + left, rect.top, rect.width - left - gap, rect.height), until, low, high)
    plot.rect.height -= small + 2 * gap
    for level, text in zip(levels, texts, strict=True):
        sheet.surface.fill(CHART["rule"], (plot.rect.left, round(plot.row(level)), plot.rect.width, thin))
        letters.write(sheet.surface, text, "small", (plot.rect.left - gap, plot.row(level)), CARD["quiet"], "midright")
    every = round_number_above(letters.width("00.0 s  ", "small") / plot.rect.width * until)
    for i in range(floor(until / every + 1e-9) + 1):
        at = plot.column(i * every), plot.rect.bottom + gap / 2
        text, anchor = (f"{i * every:g}", "midtop") if i else ("0 s", "topleft")
        letters.write(sheet.surface, text, "small", at, CARD["quiet"], anchor)
    return plot


def _rounded(value: float) -> float:
    """The last number of a nice step before a value, at least half of it."""
    step = round_number_above(abs(value) / 2.5) if value else 1.0
    return int(value / step) * step
