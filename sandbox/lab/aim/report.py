"""Reports of a search: text for the terminal, JSON, and a chart of its tries."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from math import ceil, floor, log10
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.files import json_text
from sandbox.lab.aim.question import MAXIMIZE, Aim, Interval, Solution, Target, Trial
from sandbox.lab.axes import label, result_label, unit_of
from sandbox.lab.chart import chart, legend, mark
from sandbox.lab.tables import paragraph, table
from sandbox.sport.amounts import significant

#: Most solutions, and most jumps, in the text; a target met in narrow bands can have dozens.
_SHOWN = 12


# ---------------------------------------------------------------------------------------------------------------------
# JSON
# ---------------------------------------------------------------------------------------------------------------------


def as_json(aim: Aim) -> str:
    """One JSON object; an unknown numerical error is null."""
    told: dict[str, Any] = {
        "scene": aim.scene.name,
        "preset": aim.scene.preset,
        "vary": {span.key: [span.low, span.high] for span in aim.spans},
        "target": {target.name: target.value for target in aim.targets if target.value is not MAXIMIZE},
        "maximize": next((target.name for target in aim.targets if target.value is MAXIMIZE), None),
        "solutions": [_solution(solution) for solution in aim.solutions],
        "nearest": None if aim.nearest is None else _try(aim, aim.nearest) | {"misses": aim.misses},
        "jumps": [[_try(aim, side) for side in jump] for jump in aim.jumps],
        "tries": len(aim.tries),
        "failures": aim.failures,
        "resolution": aim.resolution,
    }
    return json_text(told)


def _solution(solution: Solution) -> dict[str, Any]:
    told = {key: value for key, value in asdict(solution).items() if value is not None}
    if solution.interval is not None:
        told["interval"]["width"] = solution.interval.width
    return {"parameters": told.pop("values"), **told}


def _try(aim: Aim, one: Trial) -> dict[str, Any]:
    result = {target.name: value for target, value in zip(aim.targets, one.found, strict=True)}
    return {"parameters": _named(aim, one.values), "result": result}


def _named(aim: Aim, values: tuple[float, ...]) -> dict[str, float]:
    return {span.key: value for span, value in zip(aim.spans, values, strict=True)}


# ---------------------------------------------------------------------------------------------------------------------
# Text
# ---------------------------------------------------------------------------------------------------------------------


def as_text(aim: Aim) -> list[str]:
    """Lines for the terminal: the question, and every solution with its numerical error, or the nearest miss."""
    lines = [*paragraph(_question(aim), ""), ""]
    if not aim.solutions:
        lines += _no_solution(aim)
    elif aim.solutions[0].interval is not None:
        lines += _interval_lines(aim)
    elif aim.solutions[0].region is not None:
        lines += _region_lines(aim)
    else:
        lines += _root_lines(aim)
    for one, other in aim.jumps[:_SHOWN]:
        places = " and ".join(f"{side.values[0]:.10g}" for side in (one, other))
        lines += paragraph(
            f"between {aim.spans[0].key} = {places} {aim.targets[0].name} jumps from {one.found[0]:.6g} to "
            f"{other.found[0]:.6g}, over the target"
        )
    lines += _more(len(aim.jumps), " jumps")
    failures = f", {aim.failures} of which failed" if aim.failures else ""
    return [*lines, "", *paragraph(f"{len(aim.tries):,} runs{failures}{_resolution(aim)}")]


def _resolution(aim: Aim) -> str:
    """The widths below which something may be missed, rounded up, as the end of a sentence; "" for numbers."""
    if not aim.resolution:
        return ""
    widths = [_with_unit(aim, axis, _above(width)) for axis, width in enumerate(aim.resolution.values())]
    kind = "gaps and intervals" if len(widths) == 1 else "gaps and regions"
    return f"; {kind} narrower than {' by '.join(widths)} may be missed"


def _above(width: float) -> str:
    """A width rounded up to one digit."""
    power = 10.0 ** floor(log10(width))
    return f"{ceil(width / power * (1.0 - 1e-9)) * power:.1g}"


def _question(aim: Aim) -> str:
    wanted = " and ".join(_wanted(target, aim) for target in aim.targets)
    ranges = [f"{span.key} from {span.low:g} to {span.high:g} {unit_of(aim.scene, span.key)}" for span in aim.spans]
    return f"{aim.scene.title}: {wanted} by {' and '.join(map(str.rstrip, ranges))}"


def _wanted(target: Target, aim: Aim) -> str:
    return str(target) if target.value is MAXIMIZE else f"{target.name} = {_value(target, aim)}"


def _value(target: Target, aim: Aim) -> str:
    if isinstance(target.value, bool):
        return "true" if target.value else "false"
    unit = aim.scene.units.get(target.name, "")
    return f"{target.value:g} {unit}".rstrip() if target.is_ordered else str(target.value)


def _root_lines(aim: Aim) -> list[str]:
    keys, names = [span.key for span in aim.spans], [target.name for target in aim.targets]
    headings = [part for key in keys for part in (label(aim.scene, key), "±")]
    rows = []
    for solution in aim.solutions[:_SHOWN]:
        row = [part for key in keys for part in (f"{solution.values[key]:.8g}", _error(solution.errors[key]))]
        for name in names:
            row += [f"{solution.result[name]:.8g}", _error(solution.result_errors.get(name))]
        rows.append(row)
    headings += [part for name in names for part in (_heading(aim, name), "±")]
    unsure = any(error is None for solution in aim.solutions[:_SHOWN] for error in solution.errors.values())
    why = "without ±: a finer run has no such result, or the result does not change there"
    return [
        *table(headings, rows, "r" * len(headings)),
        *_more(len(aim.solutions)),
        *(paragraph(why) if unsure else []),
    ]


def _heading(aim: Aim, name: str) -> str:
    unit = aim.scene.units.get(name)
    return f"{name} ({unit})" if unit else name


def _interval_lines(aim: Aim) -> list[str]:
    key = aim.spans[0].key
    rows = []
    for solution in aim.solutions[:_SHOWN]:
        interval = solution.interval
        assert interval is not None  # the target has intervals
        low, high = f"{interval.low:.7g}", f"{interval.high:.7g}"
        error = max((e for e in (interval.low_error, interval.high_error) if e is not None), default=None)
        unsure = "" if None not in (interval.low_error, interval.high_error) else "an end depends on the accuracy"
        cut = "continues beyond the range" if _is_cut(interval) else ""
        middle = f"{solution.values[key]:.7g}"
        rows.append(
            [middle, significant(interval.width, 3), low, high, _error(error), "; ".join(filter(None, (cut, unsure)))]
        )
    headings = [f"middle, {unit_of(aim.scene, key)}".rstrip(", "), "width", "from", "to", "±", ""]
    best = aim.solutions[0].interval
    assert best is not None
    room = _with_unit(aim, 0, significant(0.5 * best.width))
    side = "both sides" if best.open_low and best.open_high else "the lower side" if best.open_low else "the upper side"
    cut = f"; it continues beyond the range on {side}: widen the range to see its middle" if _is_cut(best) else ""
    forgiving = paragraph(f"{_forgiving(aim)}, with a margin of ±{room}{cut}")
    return [*table(headings, rows, "rrrrrl"), *_more(len(aim.solutions)), "", *forgiving]


def _region_lines(aim: Aim) -> list[str]:
    """Most forgiving points, with the room around them: both parameters may be off by it together as on an ellipse."""
    rows = []
    for solution in aim.solutions[:_SHOWN]:
        assert solution.region is not None  # the target has regions
        room = solution.region.room
        row = [part for key, value in solution.values.items() for part in (f"{value:.5g}", significant(room[key], 2))]
        rows.append([*row, f"{significant(100.0 * solution.region.share, 2)} %"])
    headings = [part for span in aim.spans for part in (label(aim.scene, span.key), "room")]
    return ["  most forgiving points", *table([*headings, "of the range"], rows, "rrrrr"), *_more(len(aim.solutions))]


def _is_cut(interval: Interval) -> bool:
    return interval.open_low or interval.open_high


def _forgiving(aim: Aim) -> str:
    """The middle of the widest interval within the range."""
    best, key = aim.solutions[0], aim.spans[0].key
    assert best.interval is not None
    within = " within this range" if _is_cut(best.interval) else ""
    return f"most forgiving{within}: {key} = {_with_unit(aim, 0, f'{best.values[key]:.6g}')}"


def _with_unit(aim: Aim, axis: int, number: str) -> str:
    return f"{number} {unit_of(aim.scene, aim.spans[axis].key)}".rstrip()


def _more(count: int, kind: str = "") -> list[str]:
    left = count - _SHOWN
    return [f"  ... {left} more{kind}; --json has them all"] if left > 0 else []


def _error(error: float | None) -> str:
    if error is None:
        return ""
    return significant(error, 1) if error > 0.0 else "0"


def _no_solution(aim: Aim) -> list[str]:
    lines = ["  no solution in this range"]
    if aim.nearest is not None:
        place = ", ".join(f"{key} = {value:.6g}" for key, value in _named(aim, aim.nearest.values).items())
        got = ", ".join(
            f"{name} = {aim.nearest.found[index]:.6g} ({miss:+.3g})"
            for index, (name, miss) in enumerate(aim.misses.items())
        )
        lines += paragraph(f"nearest: {got} at {place}")
    return lines


# ---------------------------------------------------------------------------------------------------------------------
# Chart
# ---------------------------------------------------------------------------------------------------------------------


def draw(aim: Aim, path: Path) -> None:
    """A chart of the tries, those of the scan muted and those of the solvers vivid, with the solutions."""
    title = _question(aim).partition(" by ")[0]
    what = "interval" if aim.solutions and aim.solutions[0].interval is not None else "solution"
    found = f"{len(aim.solutions)} {what}{'' if len(aim.solutions) == 1 else 's'}" if aim.solutions else "no solution"
    with chart(path, title, f"{found}; {len(aim.tries):,} runs") as (axes, colours):
        if len(aim.spans) == 2 and aim.targets[0].is_number:
            _draw_two(axes, aim, colours)
        elif len(aim.spans) == 2:
            _draw_plane(axes, aim, colours)
        elif aim.targets[0].is_number or aim.targets[0].value is MAXIMIZE:
            _draw_one(axes, aim, colours)
        else:
            _draw_intervals(axes, aim, colours)
        axes.set_xlabel(label(aim.scene, aim.spans[0].key))


def _draw_one(axes: Any, aim: Aim, colours: Mapping[str, Any]) -> None:
    card, target = colours["card"], aim.targets[0]
    axes.set_xlim(aim.spans[0].low, aim.spans[0].high)
    for solving, colour, size in ((False, card["quiet"], 14.0), (True, colours["trace"]["colours"][0], 22.0)):
        tries = [each for each in aim.tries if each.phase.startswith("solve") == solving and each.found[0] is not None]
        places, found = [each.values[0] for each in tries], [each.found[0] for each in tries]
        axes.scatter(places, found, s=size, color=colour, zorder=2 + solving, label=("scan", "solver")[solving])
    if target.is_number:
        axes.axhline(target.value, color=card["ink"], linewidth=1.0, linestyle=(0, (4, 3)), zorder=1, label="target")
    for solution in aim.solutions:
        place = solution.values[aim.spans[0].key]
        mark(axes, (place, solution.result[target.name]), _with_unit(aim, 0, f"{place:.6g}"), card)
    axes.set_ylabel(result_label(aim.scene, target.name))
    legend(axes)


def _draw_two(axes: Any, aim: Aim, colours: Mapping[str, Any]) -> None:
    card, traces = colours["card"], colours["trace"]["colours"]
    scan = [each for each in aim.tries if each.phase == "scan"]
    places = [sorted({each.values[axis] for each in scan}) for axis in range(2)]
    for index, target in enumerate(aim.targets):
        heights = np.full((len(places[1]), len(places[0])), np.nan)
        for each in scan:
            if each.found[index] is not None:
                heights[places[1].index(each.values[1]), places[0].index(each.values[0])] = each.found[index]
        colour = traces[1 + index]
        if np.nanmin(heights) <= target.value <= np.nanmax(heights):
            axes.contour(*places, np.ma.masked_invalid(heights), levels=[target.value], colors=[colour], linewidths=1.8)
        axes.plot([], [], color=colour, linewidth=1.8, label=f"{target.name} = {_value(target, aim)}")
    axes.scatter(*zip(*(each.values for each in scan), strict=True), s=5, color=card["quiet"], label="scan")
    for number, phase in enumerate(dict.fromkeys(each.phase for each in aim.tries if each.phase.startswith("solve "))):
        steps = [each.values for each in aim.tries if each.phase == phase]
        axes.plot(*zip(*steps, strict=True), color=traces[0], linewidth=0.8, marker="o", markersize=3.5,
                  label="solver" if number == 0 else None)  # fmt: skip
    for solution in aim.solutions:
        place = tuple(solution.values.values())
        mark(axes, place, ", ".join(_with_unit(aim, axis, f"{value:.5g}") for axis, value in enumerate(place)), card)
    axes.set_ylabel(label(aim.scene, aim.spans[1].key))
    legend(axes)


def _draw_plane(axes: Any, aim: Aim, colours: Mapping[str, Any]) -> None:
    """All tries by two parameters: whether they meet the target, or how great the number is."""
    card, target = colours["card"], aim.targets[0]
    if target.value is MAXIMIZE:
        tries = [each for each in aim.tries if each.found[0] is not None]
        places, heights = list(zip(*(each.values for each in tries), strict=True)), [each.found[0] for each in tries]
        axes.figure.colorbar(axes.scatter(*places, c=heights, s=9), label=result_label(aim.scene, target.name))
    else:
        for _, colour, name, some in _met(aim, card):
            axes.scatter(some[:, 0], some[:, 1], s=9, color=colour, label=name)
        legend(axes)
    for solution in aim.solutions[:1]:
        place = tuple(solution.values.values())
        mark(axes, place, ", ".join(_with_unit(aim, axis, f"{value:.5g}") for axis, value in enumerate(place)), card)
    axes.set_ylabel(label(aim.scene, aim.spans[1].key))


def _draw_intervals(axes: Any, aim: Aim, colours: Mapping[str, Any]) -> None:
    card, key = colours["card"], aim.spans[0].key
    axes.set_xlim(aim.spans[0].low, aim.spans[0].high)
    for solution in aim.solutions:
        assert solution.interval is not None  # the target has intervals
        axes.axvspan(solution.interval.low, solution.interval.high, color=card["good"], alpha=0.35, linewidth=0)
    for met, colour, name, some in _met(aim, card):
        axes.scatter(some[:, 0], np.full(len(some), float(met)), s=14, color=colour, label=name, zorder=3)
    for solution in aim.solutions[:1]:
        mark(axes, (solution.values[key], 0.5), _forgiving(aim), card)
    axes.set_yticks([0.0, 1.0], ["not met", "met"])
    axes.set_ylim(-0.3, 1.3)


def _met(aim: Aim, card: Mapping[str, Any]) -> Iterator[tuple[bool, Any, str, np.ndarray]]:
    """The tries that do not meet the target, and those that do: colour, name, and values of shape (tries, axes)."""
    for met, colour, name in ((False, card["quiet"], "not met"), (True, card["good"], "met")):
        some = [each.values for each in aim.tries if aim.targets[0].met(each.found[0]) == met]
        yield met, colour, name, np.reshape(some, (-1, len(aim.spans)))
