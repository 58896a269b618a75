"""A chart of energy by cause: as bands over time what the balls have, and above it what each cause took."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pygame

from sandbox.engine.run import Run
from sandbox.picture.energy import Course, course
from sandbox.picture.palette import Colour, mix
from sandbox.picture.path import hardest
from sandbox.picture.plot import CHART, Plot, plotted
from sandbox.picture.sheet import CARD, Entry, Sheet
from sandbox.picture.vectors import colour_of

#: Causes that took less than this share of all energy are summed up as "other"; and at most so many are shown.
LEAST_SHARE, MOST_CAUSES = 0.004, 6
#: J; a run with less at the start has nothing to show.
LEAST_ENERGY = 1e-3
#: How dark what is lost is drawn.
LOST = 0.42
#: What was put in is hatched with lines this far apart, px on 720 rows.
HATCH = 6


class Band(NamedTuple):
    """What balls have or a cause took, in J over time; or what one put in, which reaches above the start."""

    name: str
    values: np.ndarray
    colour: Colour
    put_in: bool = False

    @property
    def light(self) -> Colour:
        """Its colour for words on dark ground."""
        return mix(self.colour, CARD["text"], 0.4)


def bands_of(energy: Course) -> list[Band]:
    """What the balls have, what the largest causes took, the largest first, and what was put in."""
    least = LEAST_SHARE * max(energy.start, 1e-12)
    colours: dict[str, Colour] = {}  # of each cause, as in every other chart; another one where two would look alike
    for name in sorted(energy.work):
        wanted = [CHART["cause"].get(name) or colour_of(name), *CHART["spare"]]
        colours[name] = next((colour for colour in wanted if colour not in colours.values()), wanted[0])
    lost = sorted(energy.taken.items(), key=lambda cause: -cause[1].max())
    shown = [(name, values) for name, values in lost[:MOST_CAUSES] if values.max() > least]
    rest = sum((values for _, values in lost[len(shown) :]), np.zeros(len(energy.times)))
    bands = [
        *(Band(name, values, CHART[name]) for name, values in energy.has.items()),
        *(Band(name, values, mix(colours[name], CHART["ground"], LOST)) for name, values in shown),
        Band("other", rest, CHART["other"]),
        *(Band(f"put in by {name}", values, colours[name], True) for name, values in energy.put_in.items()),
    ]
    return [band for band in bands if band.values.max() > least]


def energy_chart(run: Run, size: tuple[int, int] = (1280, 720)) -> pygame.Surface:
    """The course of a run's energy. Where something put energy in, bands reach above the start, and that part is
    hatched in its colour."""
    sheet, energy = Sheet(size, on_dark=True), course(run)
    sheet.surface.fill(CHART["ground"])
    bands = bands_of(energy)
    put_in = [(band.name, float(band.values[-1])) for band in bands if band.put_in]
    total = energy.start + sum(last for _, last in put_in)
    whole = " + ".join(f"{joules(last)} {name}" for name, last in [("at the start", energy.start), *put_in])
    shares = f"shares of {joules(total)}: {whole}" if put_in else f"shares of {whole}"
    sheet.headline("Where the energy goes", [shares, run.scene.title if run.scene else ""], sheet.frame.width)
    entries: list[Entry] = [("at the start", joules(energy.start))]
    entries += [(band.name, joules(band.values[-1]), band.light) for band in bands if band.put_in]
    for band in (band for band in bands if not band.put_in):
        share = 100 * band.values[-1] / max(total, 1e-12)
        if share >= 0.05:
            entries.append((band.name, f"{share:.1f} %", band.light))
    sheet.columns(sheet.card_row(), entries)
    written = (sheet.lettering.width(_said(band), "small", bold=True) for band in bands)
    right = sheet.frame.right - max(written, default=0) - 2 * sheet.gap
    top = sheet.top_row + 2 * sheet.gap
    rect = pygame.Rect(sheet.frame.left, top, right - sheet.frame.left, sheet.card_row() - sheet.gap - top)
    high = sum((band.values for band in bands if not band.put_in), np.zeros(len(energy.times)))
    plot = plotted(sheet, rect, max(run.duration, 1e-9), 0.0, max(float(high.max()), LEAST_ENERGY), joules)
    foot, start = np.zeros_like(high), np.full_like(high, energy.start)
    spots = []
    for band in bands:
        below = start if band.put_in else foot
        spots.append(_draw(sheet, plot, energy.times, band, below))
        below += band.values
    plot.mark(sheet, [event.t for event in hardest(run)])
    _name(sheet, plot.rect, bands, spots)
    if put_in:
        unit, row = sheet.unit, plot.row(energy.start)
        ends = [(plot.rect.left, row), (plot.rect.right, row)]
        sheet.painter.dashes(ends, max(1.0, 1.4 * unit), CARD["text"], 8 * unit, 5 * unit)
        places = (plot.rect.right - share * plot.rect.width for share in (0.01, 0.2, 0.4, 0.6))
        sheet.chip(f"{joules(energy.start)} at the start", [(x, row + 4 * unit, -1.0, 1.0) for x in places])
    return sheet.surface


def _draw(sheet: Sheet, plot: Plot, times: np.ndarray, band: Band, foot: np.ndarray) -> np.ndarray:
    """A band that stands on ``foot`` (J over time); its columns, the rows of its name, and how thick it is, in px."""
    columns, low, high = plot.column(times), plot.row(foot), plot.row(foot + band.values)
    edge, painter, unit = np.column_stack([columns, high]), sheet.painter, sheet.unit
    if not band.put_in:
        painter.polygon(np.concatenate([edge, np.column_stack([columns, low])[::-1]]), band.colour)
        painter.line(edge, max(1.0, 1.2 * unit), CHART["ground"], 0.8)
        return np.column_stack([columns, (low + high) / 2, low - high])
    apart = max(4.0, HATCH * unit)
    across = np.arange(columns[0] + apart, columns[-1], apart)
    ends = np.column_stack([across, np.interp(across, columns, low), across, np.interp(across, columns, high)])
    strokes = ends[ends[:, 1] - ends[:, 3] >= 1.0].reshape(-1, 2, 2)
    if len(strokes):
        painter.lines(strokes, max(1.0, 1.6 * unit), band.colour)
    painter.line(edge, max(1.0, 1.6 * unit), band.colour)
    return np.column_stack([columns, high, low - high])


def _name(sheet: Sheet, plot: pygame.Rect, bands: Sequence[Band], spots: Sequence[np.ndarray]) -> None:
    """Each band's name at its right end, moved apart where bands are thin; inside it where it has no right end."""
    tall, gap = sheet.lettering.height("small"), sheet.gap
    lasting = [(band, float(spot[-1, 1])) for band, spot in zip(bands, spots, strict=True) if spot[-1, 2] >= 1.0]
    row = plot.bottom - gap + tall // 2
    for i, (band, end) in enumerate(lasting):  # from the lowest up
        row = max(min(round(end), row - tall), plot.top + tall * (len(lasting) - i) - tall // 2)
        near, far = plot.right + gap / 2, plot.right + 2 * gap
        sheet.painter.line([(near, end), (far, row)], max(1.0, sheet.unit), band.colour)
        sheet.write(_said(band), "small", (far + gap / 2, row), band.light, "midleft", bold=True)
    for band, spot in zip(bands, spots, strict=True):
        columns, rows, thick = spot.T
        half = sheet.lettering.width(band.name, "small", bold=True) / 2 + gap
        room = [thick[np.abs(columns - x) <= half].min() for x in np.clip(columns, plot.left + half, plot.right - half)]
        widest = int(np.argmax(room))
        if thick[-1] < 1.0 and room[widest] > tall + gap:
            x = min(max(columns[widest], plot.left + half), plot.right - half)
            sheet.label(band.name, "small", [(x, rows[widest], "center")], CHART["ground"], bold=True)


def _said(band: Band) -> str:
    return f"{band.name} {joules(band.values[-1])}"


def joules(energy: float) -> str:
    """An energy as people write it."""
    if abs(energy) >= 999.5:
        return f"{energy / 1000:.3g} kJ"
    return f"{energy:.3g} J" if abs(energy) >= 0.0995 or energy == 0 else f"{1000 * energy:.3g} mJ"
