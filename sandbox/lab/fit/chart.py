"""The charts of a fit: the points on the fitted path, and the residuals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from sandbox.engine.model.surface import Segment
from sandbox.lab.fit.flown import flown
from sandbox.lab.fit.squares import Fit
from sandbox.lab.report import Chart, Panel
from sandbox.lab.tables import length, unit_of_length
from sandbox.scene.points import Points
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import significant

#: Width, and heights of the path and of a panel of residuals, in inches; the path's is between these two.
_WIDTH, _LOWEST, _HIGHEST, _PANEL = 9.6, 1.6, 4.6, 1.25

#: Samples of a path; how far beyond its points is seen, as a share of their extent, and at least in radii of a ball.
_SAMPLES, _BEYOND, _ROOM = 800, 0.06, 2.5

#: Most values under the title, the others are in the report.
_MOST = 6


def charts(found: Fit, title: str, values: Sequence[Sequence[str]]) -> list[Chart]:
    """Points and path, if places were measured, and a panel with the residuals of each group."""
    points, names = found.measured.points(found.scene, found.free), found.measured.names
    about, shown = _about(values), []
    if points is not None:
        note = "Points are black where one ball was measured, outliers red crosses."
        path = Panel(partial(_path, found, points), "x (m)", "y (m)")
        shown.append(Chart([path], title, about, height=_height(points) + 0.5, note=note))
    x = "t (s)" if _has_times(found, points) else f"row of the {found.measured.what}"
    last = len(names) - 1
    panels = [
        Panel(partial(_residuals, found, points, place), x if place == last else "", _unit(found, place),
              _headline(found, place))
        for place in range(len(names))
    ]  # fmt: skip
    note = (
        "The band is two standard deviations of the residuals. A 95 % interval holds the true value in 95 of 100 "
        "cases, if the model is right and errors are as assumed."
    )
    return [*shown, Chart(panels, title, about, height=_PANEL + 0.35, note=note)]


def _about(values: Sequence[Sequence[str]]) -> str:
    rows = [f"{key} = {value} {unit}".rstrip() + f" (95 %: {interval})" for key, value, unit, interval, _ in values]
    more = f" and {len(rows) - _MOST} more" if len(rows) > _MOST else ""
    pairs = [",   ".join(rows[place : place + 2]) for place in range(0, min(len(rows), _MOST), 2)]
    return "\n".join(pairs) + more


def _height(points: Points) -> float:
    """The height of the path's panel in inches, so that lengths along x and y are alike."""
    across, up = np.ptp(points.positions, axis=0).tolist()
    return float(np.clip((_WIDTH - 1.0) * up / max(across, 1e-9), _LOWEST, _HIGHEST))


def _has_times(found: Fit, points: Points | None) -> bool:
    return points is not None and not bool(np.isnan(points.t).any())


def _path(found: Fit, points: Points, axes: Any, colours: Mapping[str, Any]) -> None:
    """Draw the path of each ball that was measured, up to the last point, with the points and what the ball meets."""
    card, traces = colours["card"], colours["trace"]["colours"]
    (run,) = flown(found.scene, (), np.empty((1, 0)), _last(found, points))
    low, high = points.positions.min(axis=0), points.positions.max(axis=0)
    margin = _BEYOND * max(float((high - low).max()), 1e-9)
    if run is not None:
        margin = max(margin, _ROOM * max(ball.radius for ball in run.setup.balls))
        _surfaces(axes, run, card)
    outlying = np.isin(_rows(found, len(points.positions)), found.outliers)
    dots = _dots(points, colours)
    for ball, colour in zip(dict.fromkeys(points.balls), traces * 4, strict=False):
        own = np.array([name == ball for name in points.balls]) & ~outlying
        if run is not None:
            times = np.linspace(0.0, run.duration, _SAMPLES)
            axes.plot(*run.states(ball, times)[:, :2].T, color=colour, linewidth=1.4, zorder=2)
        axes.scatter(*points.positions[own].T, s=16, color=dots[own], zorder=3,
                     label=ball if len(set(points.balls)) > 1 else None)  # fmt: skip
    axes.scatter(*points.positions[outlying].T, s=34, color=card["bad"], marker="x", linewidth=1.4, zorder=4)
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal", adjustable="box")


def _dots(points: Points, colours: Mapping[str, Any]) -> np.ndarray:
    """The colour of each point: that of its ball's path, where there are several balls."""
    names = list(dict.fromkeys(points.balls))
    if len(names) == 1:
        return np.array([colours["card"]["ink"]] * len(points.balls))
    traces = colours["trace"]["colours"]
    return np.array([traces[names.index(ball) % len(traces)] for ball in points.balls])


def _last(found: Fit, points: Points) -> float:
    """The time in s up to which the path is drawn."""
    return float(found.end) if np.isnan(points.t).any() and np.isfinite(found.end) else float(np.nanmax(points.t))


def _surfaces(axes: Any, run: SceneRun, card: dict[str, str]) -> None:
    """Draw what balls meet, as lines that do not widen the picture."""
    for surface in run.setup.surfaces:
        shape = surface.at(0.0).shape
        if isinstance(shape, Segment):
            axes.plot(*zip(shape.a, shape.b, strict=True), color=card["quiet"], linewidth=1.2, zorder=1)
        else:
            turn = np.linspace(0.0, 2.0 * np.pi, 40)
            around = np.array(shape.center)[:, None] + shape.radius * np.array([np.cos(turn), np.sin(turn)])
            axes.fill(*around, color=card["quiet"], linewidth=0.0, zorder=1)


def _rows(found: Fit, count: int) -> np.ndarray:
    """The row of each point."""
    rows = found.measured.rows
    return rows[:: len(rows) // count]


def _residuals(found: Fit, points: Points | None, place: int, axes: Any, colours: Mapping[str, Any]) -> None:
    """Draw the residuals of one group, with a band of two standard deviations."""
    card, measured = colours["card"], found.measured
    own = measured.groups == place
    sd, rows = found.residual_sd[measured.names[place]], measured.rows[own]
    at = points.t if points is not None and _has_times(found, points) else rows
    outlying = np.isin(rows, found.outliers)
    left = found.residuals[own]
    reach = 1.15 * max(float(np.abs(left[~outlying]).max(initial=0.0)), 2.2 * sd, 1e-12)
    axes.axhspan(-2.0 * sd, 2.0 * sd, color=card["quiet"], alpha=0.22, linewidth=0.0)
    axes.axhline(0.0, color=card["quiet"], linewidth=1.0)
    dots = np.array([card["ink"]] * len(left)) if points is None else _dots(points, colours)
    axes.scatter(at[~outlying], left[~outlying], s=13, color=dots[~outlying], zorder=3)
    axes.scatter(at[outlying], np.clip(left[outlying], -0.93 * reach, 0.93 * reach), s=30, color=card["bad"],
                 marker="x", linewidth=1.4, zorder=4)  # fmt: skip
    axes.set_ylim(-reach, reach)
    axes.locator_params(axis="y", nbins=5)
    if measured.units[place] == "m":
        shown, factor = unit_of_length(reach)
        axes.yaxis.set_major_formatter(lambda value, position: f"{value * factor:g} {shown}" if value else "0")


def _unit(found: Fit, place: int) -> str:
    """The unit of a group, for its axis; lengths have it at each number."""
    unit = found.measured.units[place]
    return "" if unit == "m" else unit


def _headline(found: Fit, place: int) -> str:
    name, unit = found.measured.names[place], found.measured.units[place]
    sd = found.residual_sd[name]
    return f"{name}: measured − computed, sd {length(sd) if unit == 'm' else f'{significant(sd)} {unit}'}"
