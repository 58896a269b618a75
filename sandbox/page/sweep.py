"""A sweep as a page: its map or curves, and the path of the point under the cursor."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import accumulate
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.axes import Axis, Normal, Span, Values, label, spaced, unit_of
from sandbox.lab.maps import ChartData, Row, coded, has_numbers, own_place, read
from sandbox.lab.plan import Plan
from sandbox.lab.row_file import cell
from sandbox.lab.runs import runs
from sandbox.page.parts import css, filled, fonts, html, packed, save
from sandbox.page.replay import command
from sandbox.picture.palette import palette
from sandbox.picture.path import points, simplify
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import amount, significant
from sandbox.text import argument

#: A page holds so many paths at most, drawn for a picture of so many px.
MOST_POINTS, PIXELS = 6000, 420
#: Shades of a number's colours.
SHADES = 64


def check_page(plan: Plan) -> None:
    """Raise RequestError, before any work is done, if a sweep is too large for a page, or has too many parameters."""
    if len(plan.axes) > 2:
        raise RequestError(f"--html shows one or two parameters, not {len(plan.axes)}: {', '.join(plan.keys)}")
    if plan.size > MOST_POINTS:
        raise RequestError(f"--html: {plan.size:,} points are too many for a page; the limit is {MOST_POINTS:,}")


def save_page(plan: Plan, rows: Iterable[Row], path: Path, of: str | None = None) -> None:
    """Write the page of these rows, as ``page_of`` makes it."""
    save(page_of(plan, rows, of), path)


def page_of(plan: Plan, rows: Iterable[Row], of: str | None = None) -> str:
    """The page of these rows; ``of`` names the column, by default the verdict or the first result."""
    found = read(plan, rows, of)
    scene, swept = plan.scene, list(plan.points(0, plan.size))
    done = list(runs(scene, plan.keys, swept, asked=plan.facts_read))
    palette_, codes, legend = _coloured(found)
    title = f"{scene.title}: {found.label.partition(' (')[0]}"
    is_curve = found.numbers is not None and len(plan.axes) == 1
    upright = found.numbers if is_curve else found.axes[1] if len(plan.axes) == 2 else np.zeros(plan.size)
    assert upright is not None
    order = np.argsort(found.axes[0])
    order = order[np.isfinite(upright[order])]  # the points that have a number, along the axis
    axes = [_axis(plan, 0), _axis(plan, 1) if len(plan.axes) == 2 else _range(found.label if is_curve else "", upright)]
    places = [np.nan_to_num(found.axes[0]), np.nan_to_num(upright)]
    own = own_place(plan)
    if own is not None and len(plan.axes) == 1:
        own.append(float(np.interp(own[0], places[0][order], places[1][order])))  # on the drawn curve
    data = {
        "kind": "curves" if is_curve else "cells" if plan.is_grid else "dots",
        "axes": axes,
        "places": places,
        "colours": codes,
        "palette": palette_,
        "curves": [{"colour": palette("trace")["colours"][0], "points": order.tolist()}] if is_curve else [],
        "own": own,
        "chosen": 0 if own is None else _nearest(own, places),
        "said": _texts(plan, done, swept),
        **_paths(done),
        "surfaces": _surfaces(done),
        "radius": next((run.setup.balls[0].radius for run in done if isinstance(run, SceneRun)), 0.0),
        "fonts": fonts(),
    }
    return filled(
        "sweep.html",
        title=html(title),
        about=html(f"{plan.size:,} shots; all other parameters as in the scene file"),
        legend=legend,
        command=html(command(scene, "sweep", *_options(plan, of))),
        data=packed(data),
    )


def _options(plan: Plan, of: str | None) -> list[str]:
    """The options of the command that makes the page."""
    over = [word for axis in plan.axes for word in ("--over", f"{axis.key}={_values(axis)}")]
    options = ["--points", "points.csv"] if plan.listed else over
    options += ["--samples", str(plan.samples), "--seed", str(plan.seed)] if plan.samples else []
    options += ["--check"] if plan.check else []
    options += ["--of", of] if of is not None else []
    return [*options, "--out", "sweep.csv", "--html", "sweep.html"]


def _axis(plan: Plan, number: int) -> dict[str, Any]:
    axis = plan.axes[number]
    values: Sequence[Any] = axis.values if isinstance(axis, Values) else (axis.low, axis.high)
    if not has_numbers(axis):
        words = [cell(value) for value in dict.fromkeys(values)]
        return {"label": axis.key, "low": -0.5, "high": len(words) - 0.5, "step": 1.0, "words": words}
    in_steps = isinstance(axis, Values) and not plan.listed
    step = float(np.ptp(values)) / max(1, len(values) - 1) if in_steps else 0.0
    edge = step / 2 or 0.02 * float(np.ptp(values))
    low, high = float(min(values)) - edge, float(max(values)) + edge
    return {"label": label(plan.scene, axis.key), "low": low, "high": high, "step": step, "words": None}


def _range(name: str, values: np.ndarray) -> dict[str, Any]:
    """The axis of what is shown; without a ``name`` it is a strip."""
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    edge = 0.05 * (high - low) or 0.5
    return {"label": name, "low": low - edge, "high": high + edge, "step": 2 * edge, "words": None}


def _values(axis: Axis) -> str:
    """The values of an axis as ``--over`` takes them."""
    if isinstance(axis, Span):
        return f"{argument(axis.low)}:{argument(axis.high)}"
    if isinstance(axis, Normal):
        return f"{argument(axis.mean)}~{argument(axis.sd)}"
    first, last, count = axis.values[0], axis.values[-1], len(axis.values)
    if count > 2 and has_numbers(axis) and axis.values == spaced(first, last, count):
        return f"{argument(first)}:{argument(last)}:{count}"
    return ",".join(map(argument, axis.values))


def _coloured(found: ChartData) -> tuple[list[str], list[int], str]:
    """The colours, the number of each point's, and a legend."""
    if found.words:
        colours = {key: list(map(css, value)) if isinstance(value[0], tuple) else css(value)
                   for key, value in palette("sweep").items()}  # fmt: skip
        chosen, codes = coded(found, {"sweep": colours})
        counts = Counter(codes.tolist())
        entries = (
            f'<li><i style="background: {colour}"></i>{html(word)} {100 * counts[i] / len(codes):.1f} %</li>'
            for i, (word, colour) in enumerate(chosen.items())
        )
        return list(chosen.values()), codes.tolist(), f'<ul class="legend">{"".join(entries)}</ul>'
    import matplotlib

    assert found.numbers is not None
    shades = [matplotlib.colors.to_hex(matplotlib.colormaps["viridis"](i / (SHADES - 1))) for i in range(SHADES)]
    low, high = float(np.nanmin(found.numbers)), float(np.nanmax(found.numbers))
    share = (found.numbers - low) / (high - low or 1.0)
    codes = np.where(np.isfinite(share), np.nan_to_num(share) * (SHADES - 1), SHADES).round().astype(int)
    scale = f'<li class="scale" style="background: linear-gradient(90deg, {", ".join(shades[::9])})"></li>'
    name = html(found.label)
    ends = f"<li>{name} {significant(low, 3)}</li>{scale}<li>{significant(high, 3)}</li>"
    return [*shades, "#888888"], codes.tolist(), f'<ul class="legend">{ends}</ul>'


def _nearest(own: Sequence[float], places: Sequence[np.ndarray]) -> int:
    """The point nearest to the scene file's own shot."""
    away = sum(((axis - value) / (np.ptp(axis) or 1.0)) ** 2 for axis, value in zip(places, own, strict=True))
    return int(np.argmin(away))


def _texts(plan: Plan, done: Sequence[SceneRun | Exception], swept: Sequence[Sequence[Any]]) -> list[dict[str, Any]]:
    """Return the texts for each point: its parameters, and the facts of its run, or why it failed."""
    columns = []
    for key, values in zip(plan.keys, zip(*swept, strict=True), strict=True):
        unit = unit_of(plan.scene, key)
        texts = [amount(value, unit) if isinstance(value, float) else cell(value) for value in values]
        columns.append({"label": key, "texts": texts})
    for key, fact in plan.scene.facts.items():
        if fact.label or key == "verdict":
            texts = [fact.text(run.result.get(key)) if isinstance(run, SceneRun) else "" for run in done]
            columns.append({"label": fact.label or key, "texts": texts})
    errors = ["" if isinstance(run, SceneRun) else str(run) for run in done]
    return [*columns, {"label": "failed", "texts": errors}]


def _paths(done: Sequence[SceneRun | Exception]) -> dict[str, Any]:
    """Points of all paths one after another, in px from the lower left; where each begins; and what holds them in m."""
    good = [(i, run) for i, run in enumerate(done) if isinstance(run, SceneRun)]
    lines = points([(run, run.setup.balls[0].name) for _, run in good]) if good else []
    flat = np.concatenate([line[:, 1:] for line in lines]) if lines else np.zeros((1, 2))
    low, high = np.percentile(flat, 0.5, axis=0), np.percentile(flat, 99.5, axis=0)
    scale = PIXELS / max(float((high - low).max()), 1e-6)
    drawn = dict.fromkeys(range(len(done)), np.zeros((0, 2)))
    for (i, _), line in zip(good, lines, strict=True):
        drawn[i] = simplify((line[:, 1:] - low) * scale).round()
    together = np.concatenate(list(drawn.values()))
    return {
        "starts": [0, *accumulate(len(line) for line in drawn.values())],
        "x": together[:, 0].astype(int),
        "y": together[:, 1].astype(int),
        "scale": scale,
        "box": [*low, *np.maximum(high, low + 1e-3)],
    }


def _surfaces(done: Sequence[SceneRun | Exception]) -> list[list[float]]:
    """Ends in m and half thickness of the straight surfaces, a circle being one without length; of the first run."""
    setup = next((run.setup for run in done if isinstance(run, SceneRun)), None)
    shapes = [surface.shape for surface in setup.surfaces] if setup is not None else []
    return [[*shape.ends[0], *shape.ends[1], shape.radius] for shape in shapes]
