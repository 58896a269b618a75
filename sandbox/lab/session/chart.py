"""The charts of a session: how far each group goes, where shots come down, the model, and what differs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from sandbox.lab.chart import PLATE
from sandbox.lab.report import Chart, Panel
from sandbox.lab.session.shots import Measure
from sandbox.lab.session.summary import Part, Session
from sandbox.lab.statistics import Share
from sandbox.text import with_noun

#: Inches for each group in a chart with a row for each, and for what is above and below them.
_ROW, _REST = 0.27, 0.9

#: Most panels of results against the model.
_MOST_RESULTS = 3

#: An interval of a group: its value, and its ends if it has them.
_Interval = tuple[float, float | None, float | None]


def charts(session: Session, title: str) -> list[Chart]:
    """Distances by group, dispersion, the model, and the differences between two sessions or airs."""
    tall = _REST + _ROW * len(session.first.groups)
    found = [
        *_bag(session.first, tall, f"{session.first.shots.path.name}: " if session.second is not None else ""),
        *_dispersion(session),
        *_against_model(session, tall),
        *_different(session),
    ]
    aside = sum(len(part.set_aside) for part in (session.first, session.second) if part is not None)
    about = f"{with_noun(aside, 'mishit')} set aside" if aside else "all shots count"
    return [replace(chart, title=title, about=about) for chart in found]


def _bag(part: Part, tall: float, name: str) -> list[Chart]:
    main = part.shots.main
    note = "Each dot is a shot, the bar the mean and one standard deviation to either side; on the right, the mean and "
    note += "the gap to the next."
    if main.is_share:
        note = "The share, with its 95 % interval (Wilson)."
    title = name + (f"{main.label} by {part.shots.by}" if part.shots.by else main.label)
    return [Chart([Panel(partial(_rows_of, part, main), title=_titled(title, main.unit))], height=tall, note=note)]


def _titled(title: str, unit: str) -> str:
    """A label with its unit, or the unit alone."""
    return f"{title} ({unit})" if title and unit else title or unit


def _rows_of(part: Part, main: Measure, axes: Any, colours: Mapping[str, Any]) -> None:
    """A row for each group: its shots, mean and scatter, and the gaps between rows."""
    names, card = list(part.groups), colours["card"]
    means: list[tuple[float, float]] = []
    for place, (name, colour) in enumerate(zip(names, shades(len(names), colours), strict=True)):
        found = part.summary(name, main)
        if isinstance(found, Share):
            low, high = found.interval
            axes.barh(place, found.value, height=0.5, color=colour, alpha=0.55)
            axes.plot([low, high], [place, place], color=card["ink"], linewidth=1.4)
            _beside(axes, f"{100 * found.value:.0f} % of {found.shots}", 1.01, place, fontsize=9.5)
        elif found is not None:
            axes.plot([found.mean - found.sd, found.mean + found.sd], [place, place], color=colour, linewidth=7.0,
                      alpha=0.35, solid_capstyle="round")  # fmt: skip
            axes.scatter(found.values, np.full(found.count, place), s=9, color=colour, alpha=0.75, zorder=3)
            axes.plot(found.mean, place, marker="|", markersize=13, markeredgewidth=2.2, color=card["ink"], zorder=4)
            mean = f"{found.mean:.0f}" if found.mean >= 20 else f"{found.mean:.1f}"
            _beside(axes, f"{mean} {main.unit}", 1.01, place, fontsize=9.5, fontweight="bold")
            means.append((place, found.mean))
    for (first, a), (second, b) in pairwise(means):
        gap = f"{a - b:.0f}" if abs(a - b) >= 9.95 else f"{a - b:.1f}"
        _beside(axes, gap, 1.1, 0.5 * (first + second), fontsize=8.5, color=card["ink_quiet"])
    for x, head in ((1.01, "mean"), (1.1, "gap")) if means else ():
        axes.annotate(head, (x, 1.02), xycoords="axes fraction", fontsize=8.5, color=card["ink_quiet"])
    _as_rows(axes, names)
    axes.grid(axis="x")
    if main.is_share:
        axes.set_xlim(0, 1)
        axes.xaxis.set_major_formatter(lambda share, place: f"{100 * share:.0f} %")


def _beside(axes: Any, text: str, x: float, y: float, **how: Any) -> None:
    """A text to the right of the axes, at a height in the unit of their rows."""
    axes.annotate(text, (x, y), xycoords=("axes fraction", "data"), va="center", **how)


def _as_rows(axes: Any, names: Sequence[str]) -> None:
    axes.set_yticks(range(len(names)), [name if len(name) <= 24 else f"{name[:23]}…" for name in names])
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)


def shades(count: int, colours: Mapping[str, Any]) -> list[Any]:
    """A colour for each group: those of curves while they last, else steps of a map from dark to light."""
    own = colours["trace"]["colours"]
    if count <= len(own):
        return list(own[:count])
    from matplotlib import colormaps

    return [colormaps["viridis"](share) for share in np.linspace(0.0, 0.8, count)]


def _dispersion(session: Session) -> list[Chart]:
    """The places where shots come down, from above, with their ellipses; those of both sessions."""
    parts = [part for part in (session.first, session.second) if part is not None and part.shots.places is not None]
    if not parts:
        return []
    upright = parts[0].shots.upright
    panels: list[Panel] = []
    names = list(dict.fromkeys(name for part in parts for name in part.groups))
    for part in parts:
        assert part.shots.places is not None
        across, along = part.shots.places
        x, y = (across.heading, along.heading) if upright else (along.heading, across.heading)
        name = f"{part.shots.path.name}: " if len(parts) > 1 else ""
        title = "where they come to" if upright else "where they come down, from above, hit to the right"
        panels.append(Panel(partial(_places, part, names, upright), x, y, f"{name}{title}"))
    note = "Ellipses hold 50 % and 95 % of shots that scatter normally as these do; crosses are mishits, set aside."
    return [
        Chart(
            panels,
            height=4.6 if upright else 3.4 if len(panels) == 1 else 2.5,
            across=len(panels) if upright else 1,
            note=note,
        )
    ]


def _places(part: Part, names: Sequence[str], upright: bool, axes: Any, colours: Mapping[str, Any]) -> None:
    assert part.shots.places is not None
    across, along = part.shots.places
    rows = {one.row for one in part.set_aside}
    shade = dict(zip(names, shades(len(names), colours), strict=True))
    for number, (name, inside) in enumerate(part.groups.items()):
        colour = shade[name]
        x, y = (across.values, along.values) if upright else (along.values, across.values)
        axes.scatter(x[inside], y[inside], s=12, color=colour, alpha=0.8, zorder=3)
        aside = part.shots.groups[name] & np.isin(part.shots.rows, list(rows))
        axes.scatter(x[aside], y[aside], s=22, marker="x", color=colour, linewidths=1.0, alpha=0.7, zorder=2)
        for ellipse in part.ellipses(name):
            outline = ellipse.outline() if upright else ellipse.outline()[:, ::-1]
            axes.plot(*outline.T, color=colour, linewidth=1.6 if ellipse.share < 0.9 else 1.0)
        if inside.any() and np.isfinite(x[inside]).any():
            above = number % 2 == 0
            place = _edge(part, name, upright, above) or (float(np.nanmean(x[inside])), float(np.nanmean(y[inside])))
            axes.annotate(name, place, xytext=(0, 3 if above else -3), textcoords="offset points", ha="center",
                          va="bottom" if above else "top", fontsize=9, fontweight="bold", color=colour, bbox=PLATE,
                          zorder=6)  # fmt: skip
    axes.set_aspect("equal")
    axes.set_adjustable("datalim")
    axes.grid()
    if not upright:
        axes.axhline(0.0, color=colours["card"]["ink_quiet"], linewidth=0.9)
        axes.invert_yaxis()  # to the right is down, as seen from above by who hits to the right


def _edge(part: Part, name: str, upright: bool, above: bool) -> tuple[float, float] | None:
    """The place where the wide ellipse of a group is highest in the picture, or lowest; None without one."""
    ellipses = part.ellipses(name)
    if not ellipses:
        return None
    outline = ellipses[-1].outline()
    height = outline[:, 1] if upright else -outline[:, 0]
    x, y = outline[(height if above else -height).argmax()].tolist()
    return (x, y) if upright else (y, x)


def _against_model(session: Session, tall: float) -> list[Chart]:
    found = session.model.results
    if found is None or session.second is not None:
        return []
    panels: list[Panel] = []
    for one in found.results[:_MOST_RESULTS]:
        rows = {}
        for name, inside in found.groups.items():
            off = one.of(inside).off
            rows[name] = (off.mean, *(off.interval or (None, None)))
        title = f"{one.result.replace('_', ' ')}, model minus monitor" if not panels else one.result.replace("_", " ")
        panels.append(Panel(partial(_intervals, rows, not panels), _titled("", one.unit), title=title))
    note = "Computed minus measured, with the 95 % interval of the mean if shots are independent."
    return [Chart(panels, across=len(panels), height=tall, note=note)]


def _different(session: Session) -> list[Chart]:
    """The second session minus the first by group, of what matters most."""
    if session.second is None:
        return []
    shots = session.first.shots
    keys = dict.fromkeys([shots.main.key, "side", "launch.speed", "launch.angle", "launch.spin"])
    by_group = {name: by for name in session.first.groups if (by := session.differences(name))}
    panels: list[Panel] = []
    for key in [key for key in keys if any(key in by for by in by_group.values())][:_MOST_RESULTS]:
        rows: dict[str, _Interval] = {
            name: (by[key].value, by[key].low, by[key].high) for name, by in by_group.items() if key in by
        }
        one = shots.measures[key]
        panels.append(
            Panel(partial(_intervals, rows, not panels), _titled("", one.unit), title=f"change of {one.label}")
        )
    minus = f"{session.second.shots.path.name} minus {shots.path.name}"
    note = f"Difference of the means, {minus}, with its 95 % interval; in colour where that does not hold 0."
    tall = _REST + _ROW * len(by_group)
    return [Chart(panels, across=len(panels), height=tall, note=note)] if panels else []


def _intervals(rows: Mapping[str, _Interval], is_named: bool, axes: Any, colours: Mapping[str, Any]) -> None:
    """A row for each group: a value and its interval, one that does not hold 0 in colour."""
    card = colours["card"]
    axes.axvline(0.0, color=card["ink_quiet"], linewidth=0.9)
    for place, (value, low, high) in enumerate(rows.values()):
        tells = low is not None and high is not None and (low > 0.0 or high < 0.0)
        colour = colours["trace"]["colours"][0] if tells else card["ink_quiet"]
        if low is not None and high is not None:
            axes.plot([low, high], [place, place], color=colour, linewidth=2.2, solid_capstyle="round")
        axes.plot(value, place, marker="o", markersize=5, color=colour)
    _as_rows(axes, list(rows) if is_named else [""] * len(rows))
    axes.grid(axis="x")
    axes.locator_params(axis="x", nbins=4)
