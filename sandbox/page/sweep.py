"""A sweep as a page: its map or curves, and the path of the point under the cursor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.axes import Axis, Normal, Span, spaced, unit_of
from sandbox.lab.chart import drawn
from sandbox.lab.maps import ChartData, axes_shown, chart_of, has_numbers, own_place
from sandbox.lab.plan import Plan
from sandbox.lab.row_file import cell
from sandbox.lab.runs import runs
from sandbox.page.parts import filled, html, packed
from sandbox.page.report import svg_of
from sandbox.picture.path import points, simplify
from sandbox.scene.scene_run import SceneRun
from sandbox.scene.writing import command
from sandbox.sport.amounts import amount, metres, round_number_above
from sandbox.text import argument

#: Most paths of a page, drawn for a picture of so many px; and most of them that are pale behind the chosen one.
MOST_POINTS, _PIXELS, _PALE = 6000, 420, 150
#: Width and height of the chart next to it, in inches.
WIDTH, HEIGHT = 5.8, 4.2


def check_page(plan: Plan) -> None:
    """Raise RequestError, before any work is done, if a sweep is too large for a page, or has too many parameters."""
    if len(plan.axes) > 2:
        raise RequestError(f"--html shows one or two parameters, not {len(plan.axes)}: {', '.join(plan.keys)}")
    if plan.size > MOST_POINTS:
        raise RequestError(f"--html: {plan.size:,} points are too many for a page; the limit is {MOST_POINTS:,}")


def page_of(plan: Plan, found: ChartData, of: str | None = None, family: str | None = None) -> str:
    """The page of what is shown of a sweep, which is the column ``of``."""
    chart = replace(chart_of(plan, found, family), height=HEIGHT)
    swept = list(plan.points(0, plan.size))
    done = list(runs(plan.scene, plan.keys, swept, asked=plan.facts_read))
    indices = axes_shown(plan, found, family)
    places = [found.axes[place] for place in indices]
    if len(indices) == 1:
        places.append(np.full(plan.size, 0.5) if found.numbers is None else found.numbers)
    with drawn([chart], width=WIDTH) as sheet:
        drawing = svg_of(sheet, chart.title)
        at = sheet.axes[0].transData.transform(np.column_stack(places))
        at = (at / (sheet.bbox.width, sheet.bbox.height)).round(5)
    lines, box = _paths(done)
    data = {
        "x": at[:, 0],
        "y": 1.0 - at[:, 1],
        "along": len(plan.axes) == 1,
        "chosen": _chosen(plan, indices, places),
        "texts": _texts(plan, done, swept),
        "starts": [0, *accumulate(map(len, lines))],
        "path": np.concatenate(lines).ravel(),
    }
    return filled(
        "sweep.html",
        title=html(chart.title),
        about=html(chart.about),
        chart=drawing,
        **_picture(done, lines, box),
        command=html(command(plan.scene, "sweep", *_options(plan, of, family))),
        data=packed(data),
    )


def _options(plan: Plan, of: str | None, family: str | None) -> list[str]:
    """The options of the command that makes the page."""
    over = [word for axis in plan.axes for word in ("--over", f"{axis.key}={_values(axis)}")]
    options = ["--points", "points.csv"] if plan.listed else over
    options += ["--samples", str(plan.samples), "--seed", str(plan.seed)] if plan.samples else []
    options += ["--check"] if plan.check else []
    options += ["--of", of] if of is not None else []
    options += ["--family", family] if family is not None else []
    return [*options, "--out", "sweep.csv", "--html", "sweep.html"]


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


def _chosen(plan: Plan, indices: Sequence[int], places: Sequence[np.ndarray]) -> int:
    """The point nearest to the scene file's own shot."""
    own = own_place(plan)
    if own is None:
        return 0
    away = sum(((axis - own[place]) / (np.ptp(axis) or 1.0)) ** 2 for place, axis in zip(indices, places, strict=False))
    return int(np.argmin(np.where(np.isfinite(places[-1]), away, np.inf)))


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


def _paths(done: Sequence[SceneRun | Exception]) -> tuple[list[np.ndarray], np.ndarray]:
    """The path of each run, shape (points, 2), in m, and what holds nearly all of them: left, bottom, right and top."""
    good = [(i, run) for i, run in enumerate(done) if isinstance(run, SceneRun)]
    lines = points([(run, run.setup.balls[0].name) for _, run in good]) if good else []
    flat = np.concatenate([line[:, 1:] for line in lines]) if lines else np.zeros((1, 2))
    low, high = np.percentile(flat, 0.5, axis=0), np.percentile(flat, 99.5, axis=0)
    high = np.maximum(high, low + 1e-3)
    px = float((high - low).max()) / _PIXELS  # m
    found = [np.zeros((0, 2))] * len(done)
    for (i, _), line in zip(good, lines, strict=True):
        found[i] = simplify((line[:, 1:] - low) / px).round() * px + low
    digits = int(np.ceil(-np.log10(px))) + 1
    return [line.round(digits) for line in found], np.array([*low, *high])


def _picture(done: Sequence[SceneRun | Exception], lines: Sequence[np.ndarray], box: np.ndarray) -> dict[str, str]:
    """The parts of the picture of paths, as SVG in m with y upwards: some paths, the straight surfaces of the first run
    with circles as lines without length, and a scale of a round length."""
    setup = next((run.setup for run in done if isinstance(run, SceneRun)), None)
    shapes = [surface.shape for surface in setup.surfaces] if setup is not None else []
    ends = [((*shape.ends[0], *shape.ends[1]), shape.radius) for shape in shapes]
    (left, bottom), size = box[:2], box[2:] - box[:2]
    edge = 0.06 * float(size.max())
    scale = round_number_above(float(size[0]) / 8.0)
    return {
        "box": " ".join(f"{v:.6g}" for v in (left - edge, -box[3] - edge, *(size + 2.0 * edge))),
        "pale": " ".join(map(_line, lines[:: max(1, -(-len(lines) // _PALE))])),
        "surfaces": "".join(
            f'<path d="M{a:.6g} {b:.6g}L{c:.6g} {d:.6g}" style="stroke-width: {2.0 * radius:.6g}"/>'
            f'<path class="thin" d="M{a:.6g} {b:.6g}L{c:.6g} {d:.6g}"/>'
            for (a, b, c, d), radius in ends
        ),
        "scale": f"M{left:.6g} {bottom - 0.6 * edge:.6g}h{scale:.6g}",
        "long": metres(scale),
    }


def _line(points: np.ndarray) -> str:
    """A path in SVG's words."""
    return "M" + "L".join(f"{x:g} {y:g}" for x, y in points.tolist()) if len(points) else ""
