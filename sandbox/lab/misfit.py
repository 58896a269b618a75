"""Launches of a user's own against the model, without tolerances: bias and scatter of each result, also by a column."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import floor, isfinite, log10
from typing import Any

import numpy as np

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.against import Shots
from sandbox.lab.many import simulate_many
from sandbox.lab.mapped import MISSING, Quantity, column_of
from sandbox.lab.report import Chart, Column, Notes, Panel, Report, Table, words
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.selection import LeftOut, reasons, used
from sandbox.lab.statistics import Numbers, round_number
from sandbox.lab.table_file import Column as TableColumn
from sandbox.lab.table_file import Table as FileTable
from sandbox.text import with_noun

#: A column of more different numbers than this is cut into bins; there are 4 to 11 of them.
_MOST_NUMBERS, _BINS = 8, 4


@dataclass(frozen=True)
class Compared:
    """One result of some launches, measured and computed, in the unit of the table."""

    result: str
    unit: str
    rows: np.ndarray  # of the table, the first is 1
    measured: np.ndarray
    computed: np.ndarray

    @property
    def off(self) -> Numbers:
        """Computed minus measured."""
        return Numbers(self.computed - self.measured)

    @property
    def worst(self) -> int:
        """The place of the launch that is farthest off."""
        return int(np.abs(self.off.values).argmax())

    def of(self, kept: np.ndarray) -> Compared:
        """The same for some of the launches, given by true and false."""
        return Compared(self.result, self.unit, self.rows[kept], self.measured[kept], self.computed[kept])


@dataclass(frozen=True)
class Misfit:
    """The results of all launches, and the groups of a column."""

    scene: str
    results: tuple[Compared, ...]
    left_out: tuple[LeftOut, ...]
    notes: tuple[str, ...]
    by: str = ""
    groups: Mapping[str, np.ndarray] = field(default_factory=dict)  # true for each launch that is in it

    @property
    def count(self) -> int:
        """The launches that are compared."""
        return len(self.results[0].rows)


def misfit(
    shots: Shots,
    changes: Mapping[str, Any] | None = None,
    by: str | None = None,
    strict: bool = False,
    progress: Progress = no_progress,
) -> Misfit:
    """Run all launches; ``changes`` override what the table gives, and ``by`` is a column, or what one stands for.

    A launch that has no such result in the scene is left out. Raises RequestError; with ``strict`` also for such a
    launch.
    """
    changes, found, table = changes or {}, shots.found, shots.found.table
    scene = shots.scene.changed(changes, "--set")
    points = {key: one.values for key, one in found.given.items() if key not in changes}
    if not points:
        raise RequestError(f"--set: gives all that {table.where} has of the launch: {', '.join(found.given)}")
    column = None if by is None else column_of(table, found.columns, by, "--by")
    runs = simulate_many(scene, points, tuple(found.measured), progress=progress)
    words_in = next((name for name in found.measured if runs[name].dtype == object), None)
    if words_in is not None:
        raise RequestError(f"{table.where}: {words_in} is no number in {scene.title}")
    computed = {name: np.asarray(runs[name], dtype=float) for name in found.measured}
    faults = [
        LeftOut(row, runs.errors.get(place) or f"{scene.title} has no {lacking[0]} for this launch")
        for place, row in enumerate(found.rows)
        if (lacking := [name for name, values in computed.items() if not isfinite(values[place])])
    ]
    left_out = tuple(sorted((*found.left_out, *faults), key=lambda each: each.row))
    if faults and strict:
        raise RequestError(f"{table.where}: row {faults[0].row}, {faults[0].why}")
    if len(faults) == len(found.rows):
        raise RequestError(f"{table.where}: no row can be used: {reasons(left_out)}")
    kept = ~np.isin(found.rows, [fault.row for fault in faults])
    rows = np.array(found.rows)
    results = tuple(_compared(name, one, rows, computed[name]).of(kept) for name, one in found.measured.items())
    if column is None:
        return Misfit(scene.title, results, left_out, shots.notes)
    unused = tuple(name for name in found.unused if name != column.name)
    notes = replace(shots, found=replace(found, unused=unused)).notes
    return Misfit(scene.title, results, left_out, notes, column.name, groups_of(table, column, rows[kept]))


def _compared(name: str, one: Quantity, rows: np.ndarray, computed: np.ndarray) -> Compared:
    """A result in the unit of the table, or in the scene's where rows have several."""
    unit = one.units[0] if len(set(one.units)) == 1 and one.units[0] else one.unit
    if unit == one.unit:
        return Compared(name, unit, rows, one.values, computed)
    own = np.array([units.convert(value, one.unit, unit) for value in computed.tolist()])
    return Compared(name, unit, rows, one.written, own)


def groups_of(table: FileTable, column: TableColumn, rows: np.ndarray) -> dict[str, np.ndarray]:
    """The launches of each word or number in these rows; of many numbers, those in each of some bins."""
    places = (rows - 1).tolist()
    if any(table.fault(column, place) for place in places):
        words_in = [column.cells[place].strip() for place in places]
        cells = np.array(["(empty)" if word.lower() in MISSING else word for word in words_in])
        return {word: cells == word for word in dict.fromkeys(cells.tolist())}
    numbers = table.numbers(column, places)
    different = np.unique(numbers)
    if len(different) <= _MOST_NUMBERS:
        return {f"{number:g} {column.unit}".rstrip(): numbers == number for number in different.tolist()}
    step = round_number(float(np.ptp(numbers)) / _BINS)
    bins = np.floor(numbers / step)
    return {
        f"{each * step:g} to {(each + 1) * step:g} {column.unit}".rstrip(): bins == each
        for each in np.unique(bins).tolist()
    }


# ------------------------------------------------------------------------------------------------------------- report


def report_of(found: Misfit) -> Report:
    """A table by result, one of the groups for each result, and measured against computed as a chart."""
    head = f"{found.scene}: {with_noun(found.count, 'shot')}, computed minus measured"
    shots = used(found.count + len(found.left_out), found.left_out, "shot")
    how = "bias: the mean, with the 95 % interval that it has if shots are independent; worst: the row farthest off"
    return Report(
        partial(document, found),
        head,
        [
            Table(_columns("result"), [_row(one.result, one) for one in found.results], notes=[how]),
            *_by_group(found),
            _chart(found),
            _each(found),
            Notes([*([shots] if shots else []), *found.notes]),
        ],
        more="the launches one by one",
    )


def document(found: Misfit) -> dict[str, Any]:
    """The numbers by result, in the unit of each, with those of the groups, and every launch."""
    return {
        "scene": found.scene,
        "rows": found.count + len(found.left_out),
        "used": found.count,
        "left_out": found.left_out,
        "results": {
            one.result: {
                "unit": one.unit,
                **_summary(one),
                "rows": [
                    {"row": row, "measured": measured, "computed": computed}
                    for row, measured, computed in zip(
                        one.rows.tolist(), one.measured.tolist(), one.computed.tolist(), strict=True
                    )
                ],
            }
            for one in found.results
        },
        "by": {
            name: {one.result: _summary(one.of(kept)) for one in found.results} for name, kept in found.groups.items()
        },
        "notes": found.notes,
    }


def _summary(one: Compared) -> dict[str, Any]:
    """Count, bias with its 95 % interval, sd, rms, and the launch that is farthest off."""
    off, worst = one.off, one.worst
    low, high = off.interval or (None, None)
    return {
        "n": off.count,
        "bias": off.mean,
        "low": low,
        "high": high,
        "sd": off.sd if off.count > 1 else None,
        "rms": off.rms,
        "worst": {"row": int(one.rows[worst]), "off": float(off.values[worst])},
    }


def _columns(first: str) -> list[Column]:
    n, bias, *others = map(Column, ("n", "bias", "95 % interval", "sd", "rms", "worst", "row"))
    return [words(first), n, bias, words(), *others]


def _row(name: str, one: Compared) -> tuple[Any, ...]:
    """A row of the table, with the digits that the scatter justifies."""
    off, worst = one.off, one.worst
    spread = off.sd or off.rms
    digits = min(max(1 - floor(log10(spread)), 0), 6) if spread > 0.0 else 0
    interval = f"{off.interval[0]:+z.{digits}f} to {off.interval[1]:+z.{digits}f}" if off.interval else ""
    return (
        name.replace("_", " "),
        f"{off.count:,}",
        f"{off.mean:+z.{digits}f}",
        one.unit,
        interval,
        f"{off.sd:.{digits}f}" if off.count > 1 else "",
        f"{off.rms:.{digits}f}",
        f"{off.values[worst]:+z.{digits}f}",
        str(one.rows[worst]),
    )


def _by_group(found: Misfit) -> Iterator[Table]:
    for one in found.results if found.groups else ():
        rows = [_row(name, one.of(kept)) for name, kept in found.groups.items()]
        yield Table(_columns(found.by), rows, f"{one.result.replace('_', ' ')} by {found.by}")


def _each(found: Misfit) -> Table:
    """All launches one by one."""
    rows = [
        (str(row), one.result.replace("_", " "), measured, computed, computed - measured, one.unit)
        for one in found.results
        for row, measured, computed in zip(one.rows.tolist(), one.measured.tolist(), one.computed.tolist(), strict=True)
    ]
    number = Column("measured", write="{:.5g}".format)
    numbers = [number, replace(number, heading="computed"), Column("off by", write="{:+.3g}".format)]
    return Table([Column("row"), words("result"), *numbers, words()], rows, "launches", detail=True)


def _chart(found: Misfit) -> Chart:
    """Computed over measured values of each result, with the line on which they are alike."""
    panels = [
        Panel(partial(_dots, found, one), f"measured ({one.unit})" if one.unit else "measured", "computed",
              one.result.replace("_", " "))
        for one in found.results
    ]  # fmt: skip
    return Chart(panels, "Computed and measured", across=min(2, len(panels)), height=3.6)


def _dots(found: Misfit, one: Compared, axes: Any, colours: Mapping[str, Any]) -> None:
    both = np.concatenate([one.measured, one.computed])
    ends = [both.min(), both.max()]
    axes.plot(ends, ends, color=colours["card"]["quiet"], linewidth=1.2, zorder=1)
    groups = found.groups or {"": np.ones(found.count, dtype=bool)}
    last = one is found.results[-1]
    for name, kept in groups.items():
        axes.scatter(one.measured[kept], one.computed[kept], s=16, label=name if name and last else None, zorder=3)
