"""A chart of energy by cause: as bands over time what the balls have, and above it what each cause took."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pygame

from sandbox.files import SMALLEST
from sandbox.picture.chart import CHART, Curve, Plot, plotted
from sandbox.picture.energy import STORED, Course, course
from sandbox.picture.palette import Colour, mix
from sandbox.picture.path import hardest
from sandbox.picture.sheet import CARD, Entry, Sheet
from sandbox.picture.vectors import colour_of
from sandbox.scene.scene_run import SceneRun

#: Causes that took less than this share of all energy are summed up as "other"; and at most so many are shown.
LEAST_SHARE, _MOST_CAUSES = 0.004, 6
#: J; a run with less at the start has nothing to show.
_LEAST_ENERGY = 1e-3
#: For this share of a run the chart goes on after an impact that ends it: what that changed would have no width.
_AFTER_LAST = 0.04
#: Darkening of lost energy, and lightening of words in a band's colour.
_LOST, _LIGHT = 0.42, 0.4


def bands_of(energy: Course) -> tuple[list[Curve], list[Curve]]:
    """Bands of the energy that the balls have and that the largest causes took, the largest first, one on another;
    and, on what there was at the start, what was put in."""
    least, times = LEAST_SHARE * max(energy.start, 1e-12), energy.times
    colours: dict[str, Colour] = {}  # of each cause, as in every other chart; another one where two would look alike
    for name in sorted([*energy.work, *(name.removeprefix(STORED) for name in energy.has if STORED in name)]):
        wanted = [CHART["cause"].get(name) or colour_of(name), *CHART["spare"]]
        colours[name] = next((colour for colour in wanted if colour not in colours.values()), wanted[0])
    lost = sorted(energy.taken_by_cause.items(), key=lambda cause: -cause[1].max())
    shown = [(name, values) for name, values in lost[:_MOST_CAUSES] if values.max() > least]
    rest = sum((values for _, values in lost[len(shown) :]), np.zeros(len(times)))
    there = [
        Curve(name, times, values, CHART.get(name) or colours[name.removeprefix(STORED)])
        for name, values in energy.has.items()
    ]
    there += [Curve(name, times, values, mix(colours[name], CHART["ground"], _LOST)) for name, values in shown]
    there += [Curve("other", times, rest, CHART["other"])]
    put_in = [Curve(_put_in_by(name), times, values, colours[name]) for name, values in energy.put_in.items()]
    return list(_stacked(there, 0.0, least)), list(_stacked(put_in, energy.start, least))


def _put_in_by(cause: str) -> str:
    """The name of the energy that a cause put in; a surface that moves says by itself that it drives."""
    return cause if cause.startswith("driven by ") else f"put in by {cause}"


def _stacked(bands: Sequence[Curve], lowest: float, least: float) -> Iterator[Curve]:
    """One on another; none that is nowhere higher than ``least``."""
    foot = np.full(len(bands[0].times), lowest) if bands else np.empty(0)
    for band in bands:
        if band.values.max() > least:
            top = foot + band.values
            yield band._replace(values=top, foot=foot)
            foot = top


def energy_charts(runs: Sequence[SceneRun], size: tuple[int, int]) -> pygame.Surface:
    """The charts of runs that are compared, one below the other, each with its share of the height."""
    if len(runs) == 1:
        return energy_chart(runs[0], size)
    width, height = size[0], max(SMALLEST[1], size[1] // len(runs))
    surface = pygame.Surface((width, height * len(runs)))
    for place, run in enumerate(runs):
        surface.blit(energy_chart(run, (width, height)), (0, place * height))
    return surface


def energy_chart(run: SceneRun, size: tuple[int, int] = (1280, 720)) -> pygame.Surface:
    """The course of a run's energy. Where something put energy in, bands reach above the start, up to a line."""
    sheet, energy = Sheet(size, on_dark=True), held_at_the_end(run)
    sheet.surface.fill(CHART["ground"])
    bands, put_in = bands_of(energy)
    whole = [("at the start", energy.start), *((line.name, _last(line)) for line in put_in)]
    total = sum(amount for _, amount in whole)
    told = " + ".join(f"{joules(amount)} {name}" for name, amount in whole)
    shares = f"shares of {f'{joules(total)}: ' if put_in else ''}{told}"
    sheet.headline("Where the energy goes", [shares, run.scene.title], sheet.frame.width)
    entries: list[Entry] = [("at the start", joules(energy.start))]
    entries += [(line.name, joules(_last(line)), _light(line)) for line in put_in]
    parts = [(band, 100 * _last(band) / max(total, 1e-12)) for band in bands]
    entries += [(band.name, f"{share:.1f} %", _light(band)) for band, share in parts if share >= 0.05]
    sheet.columns(sheet.card_row(), entries)
    written = (sheet.lettering.width(_peak_text(band), "small", bold=True) for band in [*bands, *put_in])
    right = sheet.frame.right - max(written, default=0) - 2 * sheet.gap
    top = sheet.top_row + 2 * sheet.gap
    rect = pygame.Rect(sheet.frame.left, top, right - sheet.frame.left, sheet.card_row() - sheet.gap - top)
    high = max([_LEAST_ENERGY, *(float(band.values.max()) for band in bands)])
    plot = plotted(sheet, rect, max(float(energy.times[-1]), 1e-9), 0.0, high, joules)
    for curve in [*bands, *(line._replace(foot=None) for line in put_in)]:
        plot.draw(sheet, curve)
    plot.mark(sheet, [event.t for event in hardest(run)])
    _name(sheet, plot, bands, put_in)
    if put_in and energy.start > LEAST_SHARE * total:
        unit, row = sheet.unit, plot.row(energy.start)
        ends = [(plot.rect.left, row), (plot.rect.right, row)]
        sheet.painter.dashes(ends, max(1.0, 1.4 * unit), CARD["text"], 8 * unit, 5 * unit)
        places = (plot.rect.right - share * plot.rect.width for share in (0.01, 0.2, 0.4, 0.6))
        sheet.chip(f"{joules(energy.start)} at the start", [(x, row + 4 * unit, -1.0, 1.0) for x in places])
    return sheet.surface


def held_at_the_end(run: SceneRun) -> Course:
    """The course of a run's energy, held for a while at its last values if an impact ends the run."""
    energy = course(run)
    if not any(event.kind == "impact" and event.t >= run.duration for event in run.events):
        return energy

    def held(values: np.ndarray) -> np.ndarray:
        return np.append(values, values[-1])

    times = np.append(energy.times, (1.0 + _AFTER_LAST) * run.duration)
    has, work = ({name: held(values) for name, values in each.items()} for each in (energy.has, energy.work))
    return Course(times, has, work)


def _name(sheet: Sheet, plot: Plot, bands: Sequence[Curve], lines: Sequence[Curve]) -> None:
    """Each band's and line's name at its right end, moved apart where they are close, the largest if there is no room
    for all; a band's inside it where it has no right end."""
    tall, gap, rect = sheet.lettering.height("small"), sheet.gap, plot.rect
    edges = [(curve, plot.row(curve.foot), plot.row(curve.values)) for curve in (*bands, *lines)]
    ends = [high[-1] if i >= len(bands) else (low[-1] + high[-1]) / 2 for i, (_, low, high) in enumerate(edges)]
    heights = [low[-1] - high[-1] for _, low, high in edges]
    thick = [height >= 1.0 for height in heights]
    largest = sorted((i for i, seen in enumerate(thick) if seen), key=lambda i: -heights[i])
    lasting = [(edges[i][0], ends[i]) for i in sorted(largest[: (rect.height - gap) // tall])]
    row = rect.bottom - gap + tall // 2
    for i, (curve, end) in enumerate(lasting):  # from the lowest up
        row = max(min(round(end), row - tall), rect.top + tall * (len(lasting) - i) - tall // 2)
        near, far = rect.right + gap / 2, rect.right + 2 * gap
        sheet.painter.line([(near, end), (far, row)], max(1.0, sheet.unit), curve.colour)
        sheet.write(_peak_text(curve), "small", (far + gap / 2, row), _light(curve), "midleft", bold=True)
    for (band, low, high), seen in zip(edges[: len(bands)], thick, strict=False):
        half = sheet.lettering.width(band.name, "small", bold=True) / 2 + gap
        columns = np.arange(rect.left, rect.right + 1.0)
        low, high = (np.interp(columns, plot.column(band.times), rows) for rows in (low, high))
        under = [(x, np.abs(columns - x) <= half) for x in columns if rect.left + half <= x <= rect.right - half]
        rooms = [(low[part].min(), high[part].max(), x) for x, part in under]
        bottom, top, x = max(rooms, key=lambda room: room[0] - room[1])
        if not seen and bottom - top > tall + gap:
            sheet.label(band.name, "small", [(x, (bottom + top) / 2, "center")], CHART["ground"], bold=True)


def _last(band: Curve) -> float:
    """The last height of a band, in J."""
    assert band.foot is not None
    return float(band.values[-1] - band.foot[-1])


def _light(band: Curve) -> Colour:
    """Its colour for words on dark ground."""
    return mix(band.colour, CARD["text"], _LIGHT)


def _peak_text(band: Curve) -> str:
    return f"{band.name} {joules(_last(band))}"


def joules(energy: float) -> str:
    """An energy as people write it."""
    if abs(energy) >= 999.5:
        return f"{energy / 1000:.3g} kJ"
    return f"{energy:.3g} J" if abs(energy) >= 0.0995 or energy == 0 else f"{1000 * energy:.3g} mJ"
