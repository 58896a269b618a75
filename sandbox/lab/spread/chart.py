"""The charts of a spread: histograms, where balls come to lie, and the causes."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from sandbox.lab.axes import result_label
from sandbox.lab.report import Chart, Panel
from sandbox.lab.spread.spreading import Spread
from sandbox.lab.spread.texts import mean_and_deviation, name_of, percent
from sandbox.lab.statistics import Ellipse

#: Most histograms, and most rows of causes.
_MOST, _ROWS = 6, 7


def charts(spread: Spread, about: str) -> list[Chart]:
    """Histograms of the most important numbers, those of shots that score in another colour; the ellipse of one ball;
    and how much of the variance each cause accounts for."""
    names = [name for name in spread.displayed if name in spread.numbers][:_MOST]
    ellipses = list(spread.ellipses.items())[: max(0, _MOST - len(names))]
    panels = [_histogram(spread, name) for name in names] + [_ellipse(*each) for each in ellipses]
    found = []
    if panels:
        note = (
            "Green bars are shots that score; the dashed lines hold 95 % of the shots. The interval of a share is "
            "Wilson's, for so many random shots."
        )
        found.append(Chart(panels, _headline(spread), about, min(3, len(panels)), 2.3, note))
    if any(len(by) > 1 for by in spread.causes.values()):
        panel = Panel(partial(_causes, spread), title="share of the variance that each cause makes alone")
        note = "What several causes do together is grey (Sobol's indices)."
        found.append(Chart([panel], _headline(spread), about, height=2.6, note=note))
    return found


def _headline(spread: Spread) -> str:
    scores = spread.scene.controls.scores
    if scores in spread.shares:
        share = spread.shares[scores]
        low, high = share.interval
        word = name_of(spread, scores)
        return f"{spread.scene.title}: {percent(share.value)} {word} (95 %: {100 * low:.1f} to {percent(high)})"
    return f"{spread.scene.title}: how it scatters"


def _histogram(spread: Spread, name: str) -> Panel:
    found = spread.numbers[name]
    title = mean_and_deviation(spread, name, found.mean, found.sd)
    return Panel(partial(_bars, spread, name), result_label(spread.scene, name), title=title)


def _bars(spread: Spread, name: str, axes: Any, colours: Mapping[str, Any]) -> None:
    """Bars; of shots that score green, if some score and some do not."""
    found, card = spread.numbers[name], colours["card"]
    _, edges = found.histogram()
    scores, values = spread.scene.controls.scores, spread.values(name)
    share = spread.shares.get(scores)
    known = spread.hits(scores) if share is not None and 0 < share.hits < share.shots else None
    hits = None if known is None else known[: spread.samples]
    groups = [(values, colours["trace"]["colours"][0])]
    if hits is not None:
        groups = [(values[hits == 1.0], card["good"]), (values[hits == 0.0], card["quiet"])]
    base = np.zeros(len(edges) - 1)
    for part, colour in groups:
        counts = np.histogram(part[np.isfinite(part)], edges)[0]
        axes.bar(edges[:-1], counts, np.diff(edges), bottom=base, align="edge", color=colour, linewidth=0.0)
        base = base + counts
    axes.axvline(found.mean, color=card["ink"], linewidth=1.0)
    for end in found.quantiles((0.025, 0.975)).values():
        axes.axvline(end, color=card["ink"], linewidth=0.9, linestyle=(0, (2, 2)))
    axes.set(yticks=[], ylim=(0, 1.08 * max(float(base.max()), 1.0)))
    axes.spines["left"].set_visible(False)
    axes.locator_params(axis="x", nbins=5)


def _ellipse(name: str, ellipse: Ellipse) -> Panel:
    long, short = ellipse.axes
    return Panel(partial(_points, ellipse), "x (m)", "y (m)", f"{name}: {long:.2g} m by {short:.2g} m")


def _points(ellipse: Ellipse, axes: Any, colours: Mapping[str, Any]) -> None:
    """The points where a ball comes to lie, and the ellipse that holds 95 % of them."""
    size = float(np.clip(4000 / len(ellipse.points), 2.0, 20.0))
    axes.scatter(*ellipse.points.T, s=size, color=colours["trace"]["colours"][0], alpha=0.5)
    axes.plot(*ellipse.outline().T, color=colours["card"]["ink"], linewidth=1.2)
    axes.set_aspect("equal")
    axes.set_adjustable("datalim")
    axes.locator_params(nbins=5)


def _causes(spread: Spread, axes: Any, colours: Mapping[str, Any]) -> None:
    """A bar for each fact, divided by what each cause makes alone; the rest is what several do together."""
    names = [name for name, by in spread.causes.items() if len(by) > 1 and name in spread.displayed]
    first = [name for name in names if name in spread.shares]
    rows = [*first, *(name for name in names if name not in first)][:_ROWS][::-1]
    left, labels = np.zeros(len(rows)), [name_of(spread, name) for name in rows]
    keys = [each.key for each in spread.by]
    for key, colour in zip(keys, colours["trace"]["colours"], strict=False):
        shares = np.array([max(spread.causes[name][key].first, 0.0) for name in rows])
        axes.barh(labels, shares, left=left, color=colour, height=0.62, label=key)
        left = left + shares
    rest = np.maximum(1.0 - left, 0.0)
    axes.barh(labels, rest, left=left, color=colours["card"]["quiet"], alpha=0.35, height=0.62, label="together")
    axes.set_xlim(0, 1)
    axes.xaxis.set_major_formatter(lambda share, place: f"{100 * share:.0f} %")
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
