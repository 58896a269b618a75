"""The columns of a table that stand for parameters and results of a scene, in the units that the scene declares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, radians

import numpy as np

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.axes import checked
from sandbox.lab.formats import Entry, Form, declared_units
from sandbox.lab.selection import LeftOut, Selection
from sandbox.lab.table_file import Column, Table, split_unit
from sandbox.lab.where import Condition
from sandbox.scene import Scene
from sandbox.text import nearest, shortened

#: By how much a drive comes out too long that is computed in one plane with the backspin alone, in % of its carry, by
#: the tilt of its spin axis in deg: the error grows with the square. A test integrates the path in space.
TILTED = {10: 0.5, 20: 2.1, 30: 4.7}

#: No result of a shot is as large as this in any unit: some monitors write -21474836480 for what they did not measure.
_NO_VALUE = 1e8

#: A spin axis that is tilted by more deg is none.
_MOST_TILT = 90.0

#: Two shots that agree by chance in every cell do not have so many columns of measured numbers.
_TOLD_APART = 4

#: Cells of what was not measured, and of rows that sum others up.
_MISSING = {"", "-", "--", "–", "n/a", "null", "none"}
_SUMMARIES = {"avg", "avg.", "average", "averages", "dev", "dev.", "std dev", "std. dev.", "deviation", "mean", "total"}


@dataclass(frozen=True)
class Quantity:
    """One column: its numbers as written, with their units, and in the unit that the scene declares."""

    written: np.ndarray  # shape (rows,)
    units: tuple[str, ...]  # of each row; "" for a plain number
    values: np.ndarray  # shape (rows,)
    unit: str

    def of(self, kept: np.ndarray) -> Quantity:
        """The same in some of the rows, given by true and false."""
        units_of = tuple(unit for unit, is_kept in zip(self.units, kept.tolist(), strict=True) if is_kept)
        return Quantity(self.written[kept], units_of, self.values[kept], self.unit)


@dataclass(frozen=True)
class Mapped:
    """The quantities of each row of a table."""

    given: Mapping[str, Quantity]  # by parameter
    measured: Mapping[str, Quantity]  # by fact
    rows: tuple[int, ...]  # of the table, the first is 1
    notes: tuple[str, ...]  # on how it was read, and which columns are not used
    left_out: tuple[LeftOut, ...]
    unused: tuple[str, ...]  # the names of columns that are not used
    columns: Mapping[str, str]  # the column of each parameter and fact


def mapped(scene: Scene, table: Table, form: Form, where: Sequence[Condition], strict: bool = False) -> Mapped:
    """The columns of a form in those rows that are asked for and have them all, within the bounds of the scene's
    parameters. Raises RequestError; with ``strict`` also for a row with a fault."""
    selection = _rows(table, form, where, strict)
    declared, notes = declared_units(scene), list[str]()
    found = {
        entry.key: _quantity(table, form, entry, selection.rows, declared[entry.key], notes) for entry in form.entries
    }
    found = _by_values(table, found, where, selection)
    measured = {key: one for key, one in found.items() if key in scene.facts}
    given = {key: one for key, one in found.items() if key not in scene.facts}
    if not measured or not given:
        missing = "no result" if not measured else "nothing of the launch"
        raise RequestError(f"{table.where}: {missing} among the columns that are used: {', '.join(found) or 'none'}")
    notes += _in_one_plane(table, form, selection.rows)
    if form.title:
        notes.insert(0, f"read as {form.title}: {', '.join(f'{one.column} as {one.key}' for one in form.entries)}")
    if where:
        asked = " and ".join(map(str, where))
        notes.insert(0, f"only rows with {asked}: {len(selection.rows)} of {len(table)}")
    before = list(selection.rows)
    _check_bounds(scene, form, selection, given, measured)
    if len(form.entries) >= _TOLD_APART:
        _leave_out_repeated(table, selection)
    kept = np.isin(before, selection.rows)
    given, measured = ({key: one.of(kept) for key, one in some.items()} for some in (given, measured))
    taken = {name.lower() for name in (*(one.column for one in form.entries), *form.spin_axis, form.length_unit)}
    taken |= {rule.column.lower() for rule in form.leave_out} | {one.name.lower() for one in where}
    unused = table.others(taken)
    rows = tuple(row + 1 for row in selection.rows)
    columns = {one.key: one.column for one in form.entries}
    return Mapped(given, measured, rows, tuple(notes), selection.left_out, unused, columns)


def _check_bounds(
    scene: Scene,
    form: Form,
    selection: Selection,
    given: Mapping[str, Quantity],
    measured: Mapping[str, Quantity],
) -> None:
    """Leave out rows whose values the parameters cannot have, and those in which a result is a number that stands for
    none. Raises RequestError if no row is left."""
    columns = {entry.key: entry.column for entry in form.entries}
    outside = {key: _outside(scene, key, one.values) for key, one in given.items()}
    for place, row in enumerate(list(selection.rows)):
        for key, one in [*given.items(), *measured.items()]:
            if key in given:
                why = outside[key].get(float(one.values[place]), "")
            else:
                why = f"{key}: stands for no value" if abs(one.written[place]) >= _NO_VALUE else ""
            if why:
                written = f"{columns[key]} = {one.written[place]:.12g} {one.units[place]}".rstrip()
                selection.leave_out(row, f"{written} is out of range ({why})")
                break
    selection.check_some()


def _outside(scene: Scene, key: str, values: np.ndarray) -> dict[float, str]:
    """The values that a parameter cannot have, and why. What it can have is an interval, so that the rest need no check
    once one from either end has passed: checking a scene takes a third of a millisecond."""
    different, found = np.unique(values).tolist(), dict[float, str]()
    for inwards in (different, different[::-1]):
        for value in inwards:
            try:
                checked(scene, "", key, value)
                break
            except RequestError as error:
                found[value] = str(error).strip()
    return found


def column_of(table: Table, columns: Mapping[str, str], name: str, option: str) -> Column:
    """The column of this name, or that stands for the parameter or result of this name. Raises RequestError."""
    wanted = [name, split_unit(name)[0], columns.get(name, "")]
    found = next((column for each in wanted if (column := _column(table, each)) is not None), None)
    if found is None:
        near = nearest(name, [*table.names, *columns])
        has = f"did you mean {near}?" if near else f"it has {shortened(', '.join(table.names), 200)}"
        raise RequestError(f"{table.where}: has no column {name!r}, which {option} names; {has}")
    return found


def _column(table: Table, name: str) -> Column | None:
    return next((one for one in table.columns if one.name.lower() == name.lower()), None)


def _rows(table: Table, form: Form, where: Sequence[Condition], strict: bool) -> Selection:
    """The rows that have all values that are used and that the scene describes. Raises RequestError if none is left."""
    selection = Selection(table, strict)
    for condition in where:
        _select(table, form, condition, selection)
    columns = [column for entry in form.entries if (column := _column(table, entry.column)) is not None]
    missing = _MISSING | {"0", "0.0"} if form.zeros else _MISSING
    for row in list(selection.rows):
        cells = {one.name: one.cells[row].strip().lower() for one in columns}
        if any(one.cells[row].strip().lower() in _SUMMARIES for one in table.columns):
            selection.leave_out(row, "sums other rows up", fault=False)
        elif lacking := next((name for name, cell in cells.items() if cell in missing), None):
            selection.leave_out(row, f"{lacking} is missing", fault=False)
    selection.need_numbers(columns)
    axis = _axis(table, form)
    if axis is not None and any(entry.column in form.total_spin for entry in form.entries):
        selection.need_numbers([axis])
        for row in list(selection.rows):
            if abs(table.number(axis, row)) > _MOST_TILT:
                selection.leave_out(row, f"{axis.name} = {axis.cells[row]} deg is beyond {_MOST_TILT:g} deg")
    for rule in form.leave_out:
        column = _column(table, rule.column)
        for row in list(selection.rows):
            if column is not None and rule.holds(table, column, row):
                selection.leave_out(row, rule.why, fault=False)
    selection.check_some()
    return selection


def _leave_out_repeated(table: Table, selection: Selection) -> None:
    """Leave out each row that has all cells of an earlier one: a file that was joined from two has shots twice."""
    seen: dict[tuple[str, ...], int] = {}
    for row in list(selection.rows):
        first = seen.setdefault(tuple(column.cells[row] for column in table.columns), row)
        if first != row:
            selection.leave_out(row, f"repeats row {first + 1}", fault=False)


def _select(table: Table, form: Form, condition: Condition, selection: Selection) -> None:
    """Keep the rows for whose cells a condition holds; one on a parameter or result waits for its values. Where numbers
    are compared, a row without one is left out. Raises RequestError if none is left."""
    columns = {entry.key: entry.column for entry in form.entries}
    if condition.name in columns and _column(table, condition.name) is None:
        return
    column = column_of(table, columns, condition.name, "--where")
    unit = column.unit or next((one.unit for one in form.entries if one.column.lower() == column.name.lower()), "")
    unit = unit if unit in units.KIND_OF else ""
    compares, kept = condition.compares_numbers(unit), []
    for row in list(selection.rows):
        cell, fault = column.cells[row].strip(), table.fault(column, row)
        if condition.holds(cell, None if fault else table.number(column, row), unit):
            kept.append(row)
        elif fault and compares:
            selection.leave_out(row, fault, fault=cell.lower() not in _MISSING)
    selection.only(kept)
    if not kept:
        numbers = [table.number(column, row) for row in range(len(table)) if not table.fault(column, row)]
        has = f"has {', '.join(dict.fromkeys(filter(None, column.cells))) or 'nothing'}"
        if numbers:
            has = f"is from {min(numbers):g} to {max(numbers):g} {unit}".rstrip()
        raise RequestError(f"{table.where}: no row has {condition}; {column.name} {shortened(has, 200)}")


def _by_values(
    table: Table, found: dict[str, Quantity], where: Sequence[Condition], selection: Selection
) -> dict[str, Quantity]:
    """The quantities in the rows for which conditions on parameters and results hold. Raises RequestError if there is
    none."""
    before = list(selection.rows)
    for condition in where:
        if _column(table, condition.name) is None and (one := found.get(condition.name)) is not None:
            condition.check_number(one.unit)
            values = dict(zip(before, one.values.tolist(), strict=True))
            selection.only([row for row in selection.rows if condition.holds("", values[row], one.unit)])
            if not selection.rows:
                has = f"from {one.values.min():.6g} to {one.values.max():.6g} {one.unit}".rstrip()
                raise RequestError(f"{table.where}: no row has {condition}; {condition.name} is {has}")
    kept = np.isin(before, selection.rows)
    return {key: one.of(kept) for key, one in found.items()}


def _quantity(table: Table, form: Form, entry: Entry, rows: Sequence[int], unit: str, notes: list[str]) -> Quantity:
    """The numbers of a column, in the scene's unit too. Raises RequestError."""
    column = _column(table, entry.column)
    assert column is not None
    if column.unit and entry.unit and column.unit != entry.unit and not form.title:
        raise RequestError(
            f"{table.where}: units are mixed: {column.name} is in {column.unit}, but --map says {entry.unit}"
        )
    values = table.numbers(column, rows)
    own = [column.unit or entry.unit] * len(rows)
    if form.length_unit and units.KIND_OF.get(unit) == "length" and (named := _column(table, form.length_unit)):
        own = [units.suggestion(named.cells[row].strip()) or own[0] for row in rows]
    if not own[0] and unit:
        notes.append(f"{column.name} has no unit: taken as {unit}")
    try:
        found = [units.convert(v, u, unit) if u else v for v, u in zip(values.tolist(), own, strict=True)]
    except ValueError as error:
        raise RequestError(f"{table.where}: {column.name} for {entry.key}: {error}") from None
    return Quantity(values, tuple(own), np.array(found) * _share_of_spin(table, form, entry, rows), unit)


def _share_of_spin(table: Table, form: Form, entry: Entry, rows: Sequence[int]) -> np.ndarray | float:
    """The share of a total spin that is backspin: the cosine of the axis's tilt. 1 for all else."""
    axis = _axis(table, form)
    if axis is None or entry.column not in form.total_spin:
        return 1.0
    return np.array([cos(radians(table.number(axis, row))) for row in rows])


def _axis(table: Table, form: Form) -> Column | None:
    """The column with the tilt of the spin axis, ``11.4 L`` as 11.4 and nothing as 0; None without one."""
    found = next((column for name in form.spin_axis if (column := _column(table, name)) is not None), None)
    return found and replace(found, cells=tuple(cell.strip().rstrip(" LRlr") or "0" for cell in found.cells))


def _in_one_plane(table: Table, form: Form, rows: Sequence[int]) -> list[str]:
    """Say what it costs that a path with a tilted spin axis is taken as in one plane."""
    axis = _axis(table, form)
    if axis is None or not form.title:
        return []
    tilts = np.abs([table.number(axis, row) for row in rows if not table.fault(axis, row)])
    costs = ", ".join(f"{share:g} % at {tilt} deg" for tilt, share in TILTED.items())
    return [
        f"{axis.name}: only its cosine counts, and the path is taken as in one plane; a tour player's drive then comes "
        f"out too long by {costs}. Here it is {np.median(tilts):.2g} deg at the median, {tilts.max():.2g} at most"
    ]
