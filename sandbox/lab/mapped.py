"""The columns of a table that stand for parameters and results of a scene, in the units that the scene declares."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.axes import checked
from sandbox.lab.formats import (
    SIDEWAYS,
    ColumnMap,
    Entry,
    Source,
    advice,
    declared_units,
    device,
    parse_entry,
    recognized,
    stated,
)
from sandbox.lab.selection import LeftOut, Selection, rows_text, used
from sandbox.lab.table_file import Column, Table, split_unit
from sandbox.lab.where import Condition, conditions
from sandbox.parameters import walk
from sandbox.scene import Scene, load
from sandbox.text import nearest, shortened

#: No result of a shot is as large as this in any unit: some monitors write -21474836480 for what they did not measure.
_NO_VALUE = 1e8

#: Two shots that agree by chance in every cell do not have so many columns of measured numbers.
_TOLD_APART = 4

#: Cells of what was not measured, and of rows that sum others up.
MISSING = {"", "-", "--", "–", "n/a", "na", "null", "none"}
_SUMMARIES = {"avg", "average", "averages", "dev", "std dev", "std. dev", "deviation", "mean", "total", "consistency",
              "durchschnitt", "mittelwert", "promedio", "moyenne", "gemiddelde", "media", "medie"}  # fmt: skip


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
class Choices:
    """The rows and columns that are chosen of a table of shots."""

    entries: tuple[Entry, ...] = ()  # its columns; the known ones if there are none
    where: tuple[Condition, ...] = ()  # only rows for which these hold
    without: tuple[str, ...] = ()  # columns that are not used
    strict: bool = False  # refuse a row with a fault, which is otherwise left out
    beside: bool = False  # read results too that a monitor has of its own, such as the roll
    decided: tuple[str, ...] = ()  # parameters that are set or varied: not taken as usual where a table lacks them

    def __bool__(self) -> bool:
        """True if anything is chosen."""
        return bool(self.entries or self.where or self.without or self.strict)


#: All rows and known columns.
EVERYTHING = Choices()


def choices_of(
    columns: Mapping[str, str] | None, where: Mapping[str, str] | Sequence[str], without: Sequence[str], strict: bool
) -> Choices:
    """Choices as Python gives them. Raises RequestError."""
    entries = tuple(parse_entry(f"{key}={text}") for key, text in (columns or {}).items())
    unused = (without,) if isinstance(without, str) else tuple(without)
    return Choices(entries, conditions(where), unused, strict)


@dataclass(frozen=True)
class Mapped:
    """The quantities of each row of a table."""

    table: Table
    given: Mapping[str, Quantity]  # by parameter
    measured: Mapping[str, Quantity]  # by fact
    rows: tuple[int, ...]  # of the table, the first is 1
    notes: tuple[str, ...]  # on how it was read
    left_out: tuple[LeftOut, ...]
    unused: tuple[str, ...]  # the names of columns that are not used
    columns: Mapping[str, str]  # the column of each parameter and fact that is one

    @property
    def sentences(self) -> tuple[str, ...]:
        """Sentences on how it was read, and on the rows and columns that are not used."""
        shots = used(len(self.rows) + len(self.left_out), self.left_out, "shot")
        unused = f"columns that are not used: {', '.join(self.unused)}" if self.unused else ""
        return tuple(filter(None, (shots, *self.notes, unused)))

    def check_both(self) -> None:
        """Raise RequestError if it has nothing of the launch, or no result."""
        if not self.measured or not self.given:
            missing = "no result" if not self.measured else "nothing of the launch"
            used = ", ".join([*self.given, *self.measured]) or "none"
            raise RequestError(f"{self.table.where}: {missing} among the columns that are used: {used}")


def read_shots(scene: Scene, table: Table, choices: Choices = EVERYTHING, launches_only: bool = False) -> Mapped:
    """The parameters and results of each row of a table, by its known columns or those that are named; or the
    parameters alone. Raises RequestError; for a table that is not known it has the ``--map`` options to complete."""
    if choices.entries:
        found: ColumnMap | None = stated(choices.entries, table, scene, choices.without)
    else:
        found = recognized(table, scene, choices.without, choices.beside)
    if found is None:
        raise RequestError(f"{table.where}: {_unknown(table, scene)}")
    if launches_only:
        found = replace(found, sources=tuple(one for one in found.sources if one.key not in scene.facts))
    return mapped(scene, table, found, choices)


def _unknown(table: Table, scene: Scene) -> str:
    """Say of a table that is not known for a scene what it may be."""
    known = device(table)
    if known is not None and known.scene != scene.name:
        return (
            f"looks like {known.title}, whose columns are known for {known.scene}; for {scene.title} name them by --map"
        )
    meant = advice(table, scene) or f'name them, such as --map "{next(iter(scene.facts))}=COLUMN"'
    return f"its columns are not known; for {scene.title} {meant}; it has {shortened(', '.join(table.names), 200)}"


def mapped(scene: Scene, table: Table, column_map: ColumnMap, choices: Choices = EVERYTHING) -> Mapped:
    """The quantities of a table in those rows that are asked for and have them all, within the bounds of the scene's
    parameters. Raises RequestError; with ``strict`` also for a row with a fault."""
    where, strict = choices.where, choices.strict
    selection = _rows(table, column_map, where, strict)
    declared, notes = declared_units(scene), list(column_map.notes)
    found = {
        source.key: _quantity(table, column_map, source, selection.rows, declared[source.key], notes)
        for source in column_map.sources
    }
    found = _by_values(table, found, where, selection)
    measured = {key: one for key, one in found.items() if key in scene.facts}
    given = {key: one for key, one in found.items() if key not in scene.facts}
    if column_map.form is not None:
        notes.insert(0, column_map.sentence(scene))
    if where:
        asked = " and ".join(map(str, where))
        notes.insert(0, f"only rows with {asked}: {len(selection.rows)} of {len(table)}")
    before = list(selection.rows)
    _check_values(scene, column_map, selection, given, measured)
    if len(found) >= _TOLD_APART:
        leave_out_repeated(table, selection)
    kept = np.isin(before, selection.rows)
    given, measured = ({key: one.of(kept) for key, one in some.items()} for some in (given, measured))
    notes += _taken_as_zero(table, column_map, selection.rows)
    unused = table.others({name.lower() for name in (*column_map.used, *(one.name for one in where))})
    rows = tuple(row + 1 for row in selection.rows)
    given |= _usual(scene, given, choices.decided, notes)
    return Mapped(table, given, measured, rows, tuple(notes), selection.left_out, unused, column_map.columns)


def _usual(
    scene: Scene, given: Mapping[str, Quantity], decided: Sequence[str], notes: list[str]
) -> dict[str, Quantity]:
    """Values that the scene takes as usual where a table has no such column, and the parameter is neither decided nor
    changed."""
    usual = getattr(scene.module, "usual", None)
    if usual is None or not given:
        return {}
    own, default = ({one.key: one.value for one in walk(each.parameters)} for each in (scene, load(scene.name)))
    known = {*given, *decided, *(key for key, value in own.items() if value != default.get(key))}
    some = {key: one.values for key, one in given.items()}
    found = {key: values for key, values in usual(some, known).items() if key not in known}
    if found:
        notes.append(f"no column for {', '.join(found)}: taken as usual for such shots")
    count, declared = len(next(iter(given.values())).values), declared_units(scene)
    return {
        key: Quantity(full := np.broadcast_to(values, count), ("",) * count, full, declared[key])
        for key, values in found.items()
    }


def _check_values(
    scene: Scene,
    column_map: ColumnMap,
    selection: Selection,
    given: Mapping[str, Quantity],
    measured: Mapping[str, Quantity],
) -> None:
    """Leave out rows whose values the parameters cannot have, those in which a result is a number that stands for none,
    and those in which arithmetic has no result. Raises RequestError if no row is left."""
    text = {source.key: source.name for source in column_map.sources}
    outside = {key: _outside(scene, key, one.values[np.isfinite(one.values)]) for key, one in given.items()}
    for place, row in enumerate(list(selection.rows)):
        for key, one in [*given.items(), *measured.items()]:
            if not np.isfinite(one.values[place]):
                selection.leave_out(row, f"{text[key]} has no value")
                break
            if key in given:
                why = outside[key].get(float(one.values[place]), "")
            else:
                why = f"{key}: stands for no value" if abs(one.written[place]) >= _NO_VALUE else ""
            if why:
                written = f"{text[key]} = {one.written[place]:.12g} {one.units[place]}".rstrip()
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


def _rows(table: Table, column_map: ColumnMap, where: Sequence[Condition], strict: bool) -> Selection:
    """The rows that have all values that are used and that the scene describes. Raises RequestError if none is left."""
    selection = Selection(table, strict)
    for condition in where:
        _select(table, column_map, condition, selection)
    needed = [table.column(name) for name in dict.fromkeys(
        name for source in column_map.sources if source.key not in SIDEWAYS for name in source.expression.columns
    )]  # fmt: skip
    zeros, rules = (False, ()) if column_map.form is None else (column_map.form.zeros, column_map.form.leave_out)
    missing = MISSING | {"0", "0.0"} if zeros else MISSING
    for row in list(selection.rows):
        cells = {one.name: one.cells[row].strip().lower() for one in needed}
        if _sums_up(one.cells[row] for one in table.columns):
            selection.leave_out(row, "averages of other rows", fault=False)
        elif lacking := next((name for name, cell in cells.items() if cell in missing), None):
            selection.leave_out(row, f"{lacking} is missing", fault=False)
    selection.need_numbers(needed)
    for source in column_map.sources:
        if source.key in SIDEWAYS:
            columns = [table.column(name) for name in source.expression.columns]
            some = [row for row in selection.rows if not are_missing(columns, row)]
            selection.need_numbers(columns, some)
    for rule in rules:
        column = _column(table, rule.column)
        for row in list(selection.rows):
            if column is not None and rule.holds(table, column, row):
                selection.leave_out(row, rule.why, fault=False)
    selection.check_some()
    return selection


def _sums_up(row: Iterable[str]) -> bool:
    """True for a row of averages or the like: one of its cells says so, or its first one begins or ends with it, as in
    ``Driver Average``."""
    cells = [cell for cell in (cell.strip().lower().rstrip(".:") for cell in row) if cell]
    ends = {cells[0].split()[place].rstrip(".:") for place in (0, -1)} if cells else set()
    return not _SUMMARIES.isdisjoint({*cells, *(ends - {"total"})})


def are_missing(columns: Sequence[Column], row: int) -> bool:
    """True for a row in which any of the columns has no cell."""
    return any(column.cells[row].strip().lower() in {*MISSING, "nan"} for column in columns)


def leave_out_repeated(table: Table, selection: Selection) -> None:
    """Leave out each row that has all cells of an earlier one: a file that was joined from two has shots twice."""
    seen: dict[tuple[str, ...], int] = {}
    for row in list(selection.rows):
        first = seen.setdefault(tuple(column.cells[row] for column in table.columns), row)
        if first != row:
            selection.leave_out(row, f"repeats row {first + 1}", fault=False)


def _select(table: Table, column_map: ColumnMap, condition: Condition, selection: Selection) -> None:
    """Keep the rows for whose cells a condition holds; one on a parameter or result waits for its values. Where numbers
    are compared, a row without one is left out. Raises RequestError if none is left."""
    keys, columns = {source.key for source in column_map.sources}, column_map.columns
    if condition.name in keys and _column(table, condition.name) is None:
        return
    column = column_of(table, columns, condition.name, "--where")
    unit = column.unit or next((one.unit for one in column_map.sources if one.column == column.name), "")
    unit = unit if unit in units.KIND_OF else ""
    compares, kept = condition.compares_numbers(unit), []
    for row in list(selection.rows):
        cell, fault = column.cells[row].strip(), table.fault(column, row)
        if condition.holds(cell, None if fault else table.number(column, row), unit):
            kept.append(row)
        elif fault and compares:
            selection.leave_out(row, fault, fault=cell.lower() not in MISSING)
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


def _quantity(
    table: Table, column_map: ColumnMap, source: Source, rows: Sequence[int], unit: str, notes: list[str]
) -> Quantity:
    """The numbers of a source as they are written, and in the scene's unit. Raises RequestError."""
    columns = [table.column(name) for name in source.expression.columns]
    own = _own_unit(column_map, source, columns, unit)
    if source.column and own and source.unit and own != source.unit and column_map.form is None:
        raise RequestError(f"{table.where}: units are mixed: {source.column} is in {own}, but --map says {source.unit}")
    numbers = [_numbers(table, source, column, rows) for column in columns]
    if column_map.form is None or source.column:
        values = source.expression.values(numbers)
    else:  # a device's arithmetic is in its own unit
        mixed = [_in_unit(some, column.unit, source.unit) for some, column in zip(numbers, columns, strict=True)]
        values = _in_unit(source.expression.values(mixed), source.unit, own or source.unit)
    units_of = [own or source.unit] * len(rows)
    lengths = None if column_map.form is None else _column(table, column_map.form.length_unit)
    if lengths is not None and units.KIND_OF.get(unit) == "length":
        units_of = [units.suggestion(lengths.cells[row].strip()) or units_of[0] for row in rows]
    if not units_of[0] and unit:
        notes.append(f"{source.expression.text} has no unit: taken as {unit}")
    try:
        found = [units.convert(v, u, unit) if u else v for v, u in zip(values.tolist(), units_of, strict=True)]
    except ValueError as error:
        raise RequestError(f"{table.where}: {source.expression.text} for {source.key}: {error}") from None
    return Quantity(values, tuple(units_of), np.array(found), unit)


def _own_unit(column_map: ColumnMap, source: Source, columns: Sequence[Column], unit: str) -> str:
    """The unit in the file: of a column, or for arithmetic the one of all its columns that measure the same as the
    result, unless the user says another."""
    if source.column:
        return columns[0].unit
    alike = {one.unit for one in columns if unit and units.KIND_OF.get(one.unit) == units.KIND_OF[unit]}
    return alike.pop() if len(alike) == 1 and (column_map.form is not None or not source.unit) else ""


def _in_unit(values: np.ndarray, given: str, unit: str) -> np.ndarray:
    """Numbers in a unit, where theirs is of the same kind."""
    if given == unit or units.KIND_OF.get(given) != units.KIND_OF.get(unit):
        return values
    return np.array([units.convert(value, given, unit) for value in values.tolist()])


def _numbers(table: Table, source: Source, column: Column, rows: Sequence[int]) -> np.ndarray:
    """The numbers of a column in some rows; 0 for a missing one of what takes a shot out of the plane."""
    if source.key not in SIDEWAYS:
        return table.numbers(column, rows)
    return np.array([0.0 if are_missing([column], row) else table.number(column, row) for row in rows])


def _taken_as_zero(table: Table, column_map: ColumnMap, rows: Sequence[int]) -> Iterator[str]:
    """Say in which rows what takes a shot out of the plane is missing."""
    names = (name for one in column_map.sources if one.key in SIDEWAYS for name in one.expression.columns)
    for column in map(table.column, dict.fromkeys(names)):
        lacking = [row + 1 for row in rows if are_missing([column], row)]
        if lacking:
            yield f"{column.name} is missing in {rows_text(lacking)}: taken as 0"
