"""The report of a search: its solutions, and a chart of its tries."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from functools import partial
from math import ceil, floor, log10
from typing import Any

import numpy as np

from sandbox.lab.aim.question import Aim, Interval, Solution, Target, Trial
from sandbox.lab.axes import label, result_label, unit_of
from sandbox.lab.chart import mark
from sandbox.lab.report import Chart, Column, Notes, Panel, Report, Section, Table, words
from sandbox.lab.scatter import players_spread
from sandbox.scene.writing import command
from sandbox.sport.amounts import significant
from sandbox.text import argument, with_noun

#: Most solutions, and most jumps, in the text; a target met in narrow bands can have dozens.
_SHOWN = 12


def report_of(aim: Aim) -> Report:
    """The question, and every solution with its numerical error, or the nearest miss; all tries as a chart."""
    solutions = _solutions(aim)
    closing: list[str] = []
    for one, other in aim.jumps[:_SHOWN]:
        places = " and ".join(f"{side.values[0]:.10g}" for side in (one, other))
        closing.append(
            f"between {aim.spans[0].key} = {places} {aim.targets[0].name} jumps from {one.found[0]:.6g} to "
            f"{other.found[0]:.6g}, over the target"
        )
    if len(aim.jumps) > _SHOWN:
        closing.append(f"... {len(aim.jumps) - _SHOWN} more jumps; --json has them all")
    scatter = _scatter(aim)
    closing += scatter
    failures = f", {aim.failures} of which failed" if aim.failures else ""
    runs = f"{with_noun(len(aim.tries), 'place' if scatter else 'run')}{failures}{_resolution(aim)}"
    return Report(partial(document, aim), _question(aim), [*solutions, _chart(aim), Notes(closing), Notes([runs])],
                  command=_command(aim))  # fmt: skip


def _scatter(aim: Aim) -> list[str]:
    """The player whose share of shots is maximized; [] where a number is."""
    solution = aim.solutions[0] if aim.solutions else None
    name = aim.targets[0].name
    if (
        solution is None
        or not aim.targets[0].is_maximum
        or aim.scene.facts[name].unit
        or set(solution.result) != {name}
    ):
        return []
    spread = players_spread(aim.scene.changed(solution.values, "vary"))
    sds = ", ".join(f"{key} by {significant(sd)} {known.unit or ''}".rstrip() for key, (known, sd) in spread.items())
    return [f"{name}: the share of shots of a player who is off, in standard deviations, in {sds}; ± of a parameter is "
            "the step of the search, and places around the best are nearly as good"]  # fmt: skip


def _command(aim: Aim) -> str:
    """The command that makes the page of a search."""
    options = [
        word for span in aim.spans for word in ("--vary", f"{span.key}={argument(span.low)}:{argument(span.high)}")
    ]
    for target in aim.targets:
        options += (
            ["--maximize", target.name]
            if target.is_maximum
            else ["--target", f"{target.name}={argument(target.value)}"]
        )
    return command(aim.scene, "aim", *options, "--html", "aim.html")


def document(aim: Aim) -> dict[str, Any]:
    """For JSON; an unknown numerical error is null."""
    return {
        "scene": aim.scene.name,
        "preset": aim.scene.preset,
        "vary": {span.key: [span.low, span.high] for span in aim.spans},
        "target": {target.name: target.value for target in aim.targets if not target.is_maximum},
        "maximize": next((target.name for target in aim.targets if target.is_maximum), None),
        "solutions": [_solution(solution) for solution in aim.solutions],
        "nearest": None if aim.nearest is None else _try(aim, aim.nearest) | {"misses": aim.misses},
        "jumps": [[_try(aim, side) for side in jump] for jump in aim.jumps],
        "tries": len(aim.tries),
        "failures": aim.failures,
        "resolution": aim.resolution,
    }


def _solution(solution: Solution) -> dict[str, Any]:
    found = {key: value for key, value in asdict(solution).items() if value is not None}
    if solution.interval is not None:
        found["interval"]["width"] = solution.interval.width
    return {"parameters": found.pop("values"), **found}


def _try(aim: Aim, one: Trial) -> dict[str, Any]:
    result = {target.name: value for target, value in zip(aim.targets, one.found, strict=True)}
    return {"parameters": _named(aim, one.values), "result": result}


def _named(aim: Aim, values: tuple[float, ...]) -> dict[str, float]:
    return {span.key: value for span, value in zip(aim.spans, values, strict=True)}


# ---------------------------------------------------------------------------------------------------------------------
# Tables
# ---------------------------------------------------------------------------------------------------------------------


def _solutions(aim: Aim) -> list[Section]:
    """The solutions as a table, whose kind is that of the first; or the nearest miss."""
    if not aim.solutions:
        return [Notes(_no_solution(aim))]
    if aim.solutions[0].interval is not None:
        return _intervals(aim)
    return [_regions(aim) if aim.solutions[0].region is not None else _roots(aim)]


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
    ranges = [f"{span.key} from {span.low:g} to {span.high:g} {unit_of(aim.scene, span.key)}" for span in aim.spans]
    return f"{_goal(aim)} by {' and '.join(map(str.rstrip, ranges))}"


def _goal(aim: Aim) -> str:
    goals = (str(target) if target.is_maximum else f"{target.name} = {_value(target, aim)}" for target in aim.targets)
    return f"{aim.scene.title}: {' and '.join(goals)}"


def _value(target: Target, aim: Aim) -> str:
    if isinstance(target.value, bool):
        return "true" if target.value else "false"
    unit = aim.scene.units.get(target.name, "")
    return f"{target.value:g} {unit}".rstrip() if target.is_ordered else str(target.value)


def _roots(aim: Aim) -> Table:
    keys, names = [span.key for span in aim.spans], [target.name for target in aim.targets]
    units = [aim.scene.units.get(name) for name in names]
    headings = [label(aim.scene, key) for key in keys]
    headings += [f"{name} ({unit})" if unit else name for name, unit in zip(names, units, strict=True)]
    columns = [column for heading in headings for column in (Column(heading, write="{:.8g}".format), _ERROR)]
    rows = []
    for solution in aim.solutions:
        row = [part for key in keys for part in (solution.values[key], solution.errors[key])]
        rows.append(
            row + [part for name in names for part in (solution.result[name], solution.result_errors.get(name))]
        )
    unsure = any(error is None for solution in aim.solutions[:_SHOWN] for error in solution.errors.values())
    why = ["without ±: a finer run has no such result, or the result does not change there"]
    return Table(columns, rows, notes=why if unsure else [], most=_SHOWN)


def _intervals(aim: Aim) -> list[Section]:
    key = aim.spans[0].key
    number, rows = "{:.7g}".format, []
    for solution in aim.solutions:
        interval = solution.interval
        assert interval is not None  # the target has intervals
        errors = interval.low_error, interval.high_error
        unsure = "an end depends on the accuracy" if None in errors else ""
        cut = "continues beyond the range" if _is_cut(interval) else ""
        error = max((error for error in errors if error is not None), default=None)
        ends = interval.width, interval.low, interval.high
        rows.append([solution.values[key], *ends, error, "; ".join(filter(None, (cut, unsure)))])
    columns = [
        Column(f"middle, {unit_of(aim.scene, key)}".rstrip(", "), write=number),
        Column("width", write=partial(significant, digits=3)),
        *(Column(heading, write=number) for heading in ("from", "to")),
        _ERROR,
        words(),
    ]
    best = aim.solutions[0].interval
    assert best is not None
    room = _with_unit(aim, 0, significant(0.5 * best.width))
    side = "both sides" if best.open_low and best.open_high else "the lower side" if best.open_low else "the upper side"
    cut = f"; it continues beyond the range on {side}: widen the range to see its middle" if _is_cut(best) else ""
    return [Table(columns, rows, most=_SHOWN), Notes([f"{_forgiving(aim)}, with a margin of ±{room}{cut}"])]


def _regions(aim: Aim) -> Table:
    """Most forgiving points, with the room around them: both parameters may be off by it together as on an ellipse."""
    rows = []
    for solution in aim.solutions:
        assert solution.region is not None  # the target has regions
        room = solution.region.room
        row = [part for key, value in solution.values.items() for part in (value, room[key])]
        rows.append([*row, solution.region.share])
    columns = []
    for span in aim.spans:
        columns += [Column(label(aim.scene, span.key), write="{:.5g}".format), Column("room", write=significant)]
    share = Column("of the range", write=lambda share: f"{significant(100.0 * share, 2)} %")
    return Table([*columns, share], rows, "most forgiving points", most=_SHOWN)


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


#: Numerical errors.
_ERROR = Column("±", write=lambda error: significant(error, 1))


def _no_solution(aim: Aim) -> list[str]:
    notes = ["no solution in this range"]
    if aim.nearest is not None:
        place = ", ".join(f"{key} = {value:.6g}" for key, value in _named(aim, aim.nearest.values).items())
        got = ", ".join(
            f"{name} = {aim.nearest.found[index]:.6g} ({miss:+.3g})"
            for index, (name, miss) in enumerate(aim.misses.items())
        )
        notes.append(f"nearest: {got} at {place}")
    return notes


# ---------------------------------------------------------------------------------------------------------------------
# Chart
# ---------------------------------------------------------------------------------------------------------------------


def _chart(aim: Aim) -> Chart:
    """A chart of the tries, those of the scan muted and those of the solvers vivid, with the solutions."""
    what = "interval" if aim.solutions and aim.solutions[0].interval is not None else "solution"
    found = with_noun(len(aim.solutions), what) if aim.solutions else "no solution"
    target, ordinate = aim.targets[0], ""
    if len(aim.spans) == 2:
        panel, ordinate = (_draw_two if target.is_number else _draw_plane), label(aim.scene, aim.spans[1].key)
    elif target.is_number or target.is_maximum:
        panel, ordinate = _draw_one, result_label(aim.scene, target.name)
    else:
        panel = _draw_intervals
    panels = [Panel(partial(panel, aim), label(aim.scene, aim.spans[0].key), ordinate)]
    return Chart(panels, _goal(aim), f"{found}; {with_noun(len(aim.tries), 'run')}")


def _draw_one(aim: Aim, axes: Any, colours: Mapping[str, Any]) -> None:
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


def _draw_two(aim: Aim, axes: Any, colours: Mapping[str, Any]) -> None:
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


def _draw_plane(aim: Aim, axes: Any, colours: Mapping[str, Any]) -> None:
    """All tries by two parameters: whether they meet the target, or how great the number is."""
    card, target = colours["card"], aim.targets[0]
    if target.is_maximum:
        tries = [each for each in aim.tries if each.found[0] is not None]
        places, heights = list(zip(*(each.values for each in tries), strict=True)), [each.found[0] for each in tries]
        axes.figure.colorbar(axes.scatter(*places, c=heights, s=9), label=result_label(aim.scene, target.name))
    else:
        for _, colour, name, some in _met(aim, card):
            axes.scatter(some[:, 0], some[:, 1], s=9, color=colour, label=name)
    for solution in aim.solutions[:1]:
        place = tuple(solution.values.values())
        mark(axes, place, ", ".join(_with_unit(aim, axis, f"{value:.5g}") for axis, value in enumerate(place)), card)


def _draw_intervals(aim: Aim, axes: Any, colours: Mapping[str, Any]) -> None:
    card, key = colours["card"], aim.spans[0].key
    axes.set_xlim(aim.spans[0].low, aim.spans[0].high)
    for solution in aim.solutions:
        assert solution.interval is not None  # the target has intervals
        axes.axvspan(solution.interval.low, solution.interval.high, color=card["good"], alpha=0.35, linewidth=0)
    for met, colour, _, some in _met(aim, card):
        axes.scatter(some[:, 0], np.full(len(some), float(met)), s=14, color=colour, zorder=3)
    for solution in aim.solutions[:1]:
        mark(axes, (solution.values[key], 0.5), _forgiving(aim), card)
    axes.set_yticks([0.0, 1.0], ["not met", "met"])
    axes.set_ylim(-0.3, 1.3)


def _met(aim: Aim, card: Mapping[str, Any]) -> Iterator[tuple[bool, Any, str, np.ndarray]]:
    """The tries that do not meet the target, and those that do: colour, name, and values of shape (tries, axes)."""
    for met, colour, name in ((False, card["quiet"], "not met"), (True, card["good"], "met")):
        some = [each.values for each in aim.tries if aim.targets[0].met(each.found[0]) == met]
        yield met, colour, name, np.reshape(some, (-1, len(aim.spans)))
