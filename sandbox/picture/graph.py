"""Graphs over time: where a ball is, how fast, what acts on it, and its energy; several runs laid over each other.

``draw_panel`` draws one of them anywhere: a panel is data.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import ceil, hypot, pi
from typing import Any, NamedTuple

import numpy as np
import pygame

from sandbox.engine.paths.phase import Phase
from sandbox.picture.chart import CHART, Curve, plotted
from sandbox.picture.energy import course
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.path import hardest, instants
from sandbox.picture.sheet import CARD, Sheet
from sandbox.picture.side import SideView
from sandbox.picture.vectors import colour_of
from sandbox.picture.view import View
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import ladder
from sandbox.units import convert

_TRACES = palette("trace")["colours"]
#: A run is sampled at so many even times.
_PIECES = 300
#: Panels next to each other, whichever leaves fewer gaps; on a picture narrower than so many px per row, two.
_COLUMNS, _NARROW = (3, 4), 1.3
#: Share of its colour that another run's curve has; lightening of a curve on dark ground, compared with its trace.
_PALE, _LIGHTER = 0.75, 0.25


class Panel(NamedTuple):
    """One graph over time; the names of its curves are written where ``named``."""

    title: str
    unit: str
    curves: Sequence[Curve] = ()
    named: bool = False

    @property
    def in_chosen_units(self) -> Panel:
        """The same in the units that were chosen."""
        largest = max((float(np.nanmax(np.abs(curve.values), initial=0.0)) for curve in self.curves), default=0.0)
        steps = [step for step in ladder(self.unit) if step.unit not in ("km", "cm", "mN", "kN")]
        unit = next((step.unit for step in steps if largest >= step.least), steps[-1].unit if steps else self.unit)
        factor = convert(1.0, self.unit, unit)
        return self._replace(unit=unit, curves=[curve._replace(values=curve.values * factor) for curve in self.curves])


def panels_of(runs: Mapping[str, SceneRun]) -> list[Panel]:
    """The panels of runs of one scene by name, the first on top."""
    found: dict[str, Panel] = {}
    for i, (name, run) in reversed(list(enumerate(runs.items()))):
        for panel in _panels(run, Curve(name, np.empty(0), np.empty(0), _colour(i), _PALE if i else 1.0)):
            before = found.get(panel.title, panel._replace(curves=()))
            found[panel.title] = before._replace(curves=[*before.curves, *panel.curves])
    return list(found.values())


def _colour(number: int) -> Colour:
    """The colour of a run's curves."""
    return mix(_TRACES[number % len(_TRACES)], CARD["text"], _LIGHTER)


def motion(run: SceneRun, view: View[Any]) -> tuple[np.ndarray, dict[str, tuple[str, np.ndarray]]]:
    """Times in s until the ball is caught, and over them by name what it does: unit and values."""
    ball = view.ball
    times = instants(run, _PIECES, [ball])
    times = times[times <= (run.caught_at(ball) or run.duration)]
    x, y, vx, vy, spin = run.states(ball, times).T[:5]
    if isinstance(view, SideView):
        places = {"height": ("m", np.maximum(0.0, y - view.radius - view.ground(x)))}
    else:
        way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        places = {"y": ("m", y), "distance": ("m", way)}
    speeds = {"v_x": ("m/s", vx), "v_y": ("m/s", vy), "speed": ("m/s", np.hypot(vx, vy))}
    return times, {"x": ("m", x), **places, **speeds, "spin": ("rpm", spin * 30 / pi)}


def _panels(run: SceneRun, curve: Curve) -> Iterator[Panel]:
    """The panels of one run, each of its curves as that one is: those of forces have their own names and colours."""
    view = run.scene.picture(run, (1280, 720))
    times, moves = motion(run, view)
    for name, (unit, values) in moves.items():
        yield Panel(name, unit, [curve._replace(times=times, values=values)])
    yield Panel("acceleration", "m/s^2", [curve._replace(times=times, values=_accelerations(run, view.ball, times))])
    forces = view.vectors.over(times).items()
    if forces:
        sizes = (Curve(name, times, np.hypot(*force.T), colour_of(name), curve.opacity) for name, force in forces)
        yield Panel("forces", "N", list(sizes), named=True)
    energy, whose = course(run), "energy" if len(run.setup.balls) == 1 else "energy of all balls"
    yield Panel(whose, "J", [curve._replace(times=energy.times, values=np.sum(list(energy.has.values()), axis=0))])


def _accelerations(run: SceneRun, ball: str, times: np.ndarray) -> np.ndarray:
    """The acceleration of a ball in m/s^2; an impact itself has none."""
    arcs = [run.arcs[ball].at(t) for t in times.tolist()]
    lasting = [arc.t1 > arc.t0 and arc.phase is not Phase.CLUSTER for arc in arcs]
    sizes = (hypot(*arc.acceleration(t)) for arc, t in zip(arcs, times.tolist(), strict=True))
    return np.where(lasting, list(sizes), np.nan)


def draw_panel(
    sheet: Sheet,
    rect: pygame.Rect,
    panel: Panel,
    until: float,
    t: float | None = None,
    hits: Sequence[float] = (),
    said: str = "",
) -> None:
    """One graph with its axes in a rectangle: time from 0 to ``until`` s; ``t`` and the times of impacts are marked,
    ``said`` is written over it at the right.
    """
    unit, gap, letters = sheet.unit, sheet.gap, sheet.lettering
    panel = panel.in_chosen_units
    known = np.concatenate([curve.values[np.isfinite(curve.values)] for curve in panel.curves] or [np.zeros(1)])
    low, high = min(0.0, float(known.min(initial=0.0))), float(known.max(initial=0.0))
    high = high if high - low > 1e-9 else low + 1.0
    title = letters.height("small") + 2 * gap
    place = pygame.Rect(rect.left, rect.top + title, rect.width, rect.height - title)
    plot = plotted(sheet, place, until, low, high)
    plot.mark(sheet, hits)
    for curve in panel.curves:
        plot.draw(sheet, curve)
        if t is not None and len(curve.times):
            value = float(np.interp(t, curve.times, curve.values))
            if np.isfinite(value):
                sheet.painter.disc((plot.column(min(t, until)), plot.row(value)), 4 * unit, curve.colour)
    if t is not None:
        thin = max(1, round(unit))
        sheet.surface.fill(CARD["quiet"], (round(plot.column(t)), plot.rect.top, thin, plot.rect.height))
    letters.write(sheet.surface, said, "small", rect.topright, CARD["text"], "topright", bold=True)
    heading = f"{panel.title} ({panel.unit})"
    end = letters.write(sheet.surface, heading, "small", (rect.left, rect.top), CARD["text"], bold=True).right
    for name, colour in {curve.name: curve.colour for curve in panel.curves if panel.named}.items():
        if end + 2 * gap + letters.width(name, "small") <= rect.right:
            end = letters.write(sheet.surface, name, "small", (end + 2 * gap, rect.top), colour).right


def graph(
    run: SceneRun, size: tuple[int, int] = (1280, 720), others: Mapping[str, SceneRun] | None = None
) -> pygame.Surface:
    """All graphs of a run, with other runs by name laid over them."""
    sheet = Sheet(size, on_dark=True)
    sheet.surface.fill(CHART["ground"])
    runs = {run.scene.title: run, **(others or {})}
    panels = panels_of(runs)
    until = max(max(each.duration for each in runs.values()), 1e-9)
    sheet.headline(run.scene.verdict(run), [], sheet.frame.width)
    gap, letters, across = sheet.gap, sheet.lettering, sheet.frame.left
    row = sheet.frame.top + letters.height(sheet.head) + gap
    for i, name in enumerate(runs):
        across = sheet.write(name, "small", (across, row), _colour(i), bold=True).right + 3 * gap
    wide_enough = size[0] > _NARROW * size[1]
    columns = min(_COLUMNS, key=lambda count: (-len(panels) % count, -count)) if wide_enough else 2
    rows = ceil(len(panels) / columns)
    top = row + letters.height("small") + 3 * gap
    wide, tall = (sheet.frame.width + 3 * gap) / columns, (sheet.frame.bottom - top + 2 * gap) / rows
    hits = [event.t for event in hardest(run, [run.scene.picture(run, size).ball])]
    for i, panel in enumerate(panels):
        rect = pygame.Rect(
            round(sheet.frame.left + i % columns * wide), round(top + i // columns * tall),
            round(wide - 3 * gap), round(tall - 2 * gap),
        )  # fmt: skip
        draw_panel(sheet, rect, panel, until, hits=hits)
    return sheet.surface
