"""The picture of a fit: the points on the fitted path, and the residuals below; with matplotlib (extra ``lab``)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from sandbox.engine.model.surface import Segment
from sandbox.lab.chart import figure
from sandbox.lab.fit.flown import flown
from sandbox.lab.fit.report import title, value_rows
from sandbox.lab.fit.squares import Fit
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


def draw(found: Fit, path: Path) -> None:
    """Draw points and path, if places were measured, and a panel with the residuals of each group."""
    points, groups = found.measured.points(found.scene, found.free), found.measured.names
    tall = 0.0 if points is None else _height(points)
    about = _about(found)
    heights = [tall] * (points is not None) + [_PANEL] * len(groups)
    size = (_WIDTH, 1.2 + 0.25 * about.count("\n") + sum(heights) + 0.35 * len(heights))
    with figure(path, title(found), about, size) as (sheet, colours):
        panels = sheet.subplots(len(heights), 1, height_ratios=heights, squeeze=False).ravel().tolist()
        if points is not None:
            _path(panels.pop(0), found, points, colours)
        for place, axes in enumerate(panels):
            _residuals(axes, found, points, place, colours)
            axes.sharex(panels[0])
            axes.tick_params(labelbottom=axes is panels[-1])
        panels[-1].set_xlabel("t (s)" if _has_times(found, points) else f"row of the {found.measured.what}")


def _about(found: Fit) -> str:
    rows = [f"{key} = {value} {unit}".rstrip() + f" (95 %: {interval})"
            for key, value, unit, interval, _ in value_rows(found)]  # fmt: skip
    more = f" and {len(rows) - _MOST} more" if len(rows) > _MOST else ""
    pairs = [",   ".join(rows[place : place + 2]) for place in range(0, min(len(rows), _MOST), 2)]
    return "\n".join(pairs) + more


def _height(points: Points) -> float:
    """The height of the path's panel in inches, so that lengths along x and y are alike."""
    across, up = np.ptp(points.positions, axis=0).tolist()
    return float(np.clip((_WIDTH - 1.0) * up / max(across, 1e-9), _LOWEST, _HIGHEST))


def _has_times(found: Fit, points: Points | None) -> bool:
    return points is not None and not bool(np.isnan(points.t).any())


def _path(axes: Any, found: Fit, points: Points, colours: dict[str, Any]) -> None:
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
        axes.scatter(*points.positions[own].T, s=16, color=dots[own], zorder=3, label=ball)
    axes.scatter(*points.positions[outlying].T, s=34, color=card["bad"], marker="x", linewidth=1.4, zorder=4)
    axes.set(xlabel="x (m)", ylabel="y (m)")
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal", adjustable="box")
    if len(set(points.balls)) > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), markerscale=1.5)


def _dots(points: Points, colours: dict[str, Any]) -> np.ndarray:
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


def _residuals(axes: Any, found: Fit, points: Points | None, place: int, colours: dict[str, Any]) -> None:
    """Draw the residuals of one group, with a band of two standard deviations."""
    card, measured = colours["card"], found.measured
    own = measured.groups == place
    name, unit = measured.names[place], measured.units[place]
    sd, rows = found.residual_sd[name], measured.rows[own]
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
    axes.set_title(f"{name}: measured − computed, sd {length(sd) if unit == 'm' else f'{significant(sd)} {unit}'}",
                   loc="left", fontsize=10, fontweight="bold")  # fmt: skip
    axes.locator_params(axis="y", nbins=5)
    if unit == "m":
        shown, factor = unit_of_length(reach)
        axes.yaxis.set_major_formatter(lambda value, position: f"{value * factor:g} {shown}" if value else "0")
    else:
        axes.set_ylabel(unit)
