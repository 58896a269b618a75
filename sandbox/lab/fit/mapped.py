"""The columns of a table that stand for parameters and results of a scene, in the units that the scene declares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, radians

import numpy as np

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.fit.formats import Entry, Form, declared_units
from sandbox.lab.table_file import Column, Table
from sandbox.scene import Scene

#: Cells of what was not measured, and of rows that sum others up.
MISSING = {"", "-", "--", "–", "n/a", "null", "none"}
SUMMARIES = {"avg", "avg.", "average", "averages", "dev", "dev.", "std dev", "std. dev.", "deviation", "mean", "total"}


@dataclass(frozen=True)
class Quantity:
    """One column: its numbers as written, with their units, and in the unit that the scene declares."""

    written: np.ndarray  # shape (rows,)
    units: tuple[str, ...]  # of each row; "" for a plain number
    values: np.ndarray  # shape (rows,)
    unit: str


@dataclass(frozen=True)
class Mapped:
    """The quantities of each row of a table."""

    given: Mapping[str, Quantity]  # by parameter
    measured: Mapping[str, Quantity]  # by fact
    rows: tuple[int, ...]  # of the table, the first is 1
    notes: tuple[str, ...]  # on how it was read, and what was left out


def mapped(scene: Scene, table: Table, form: Form, where: Mapping[str, str]) -> Mapped:
    """The columns of a form in those rows that have them all. Raises RequestError."""
    rows, notes = _rows(table, form, where)
    declared = declared_units(scene)
    found = {entry.key: _quantity(table, form, entry, rows, declared[entry.key], notes) for entry in form.entries}
    measured = {key: one for key, one in found.items() if key in scene.facts}
    given = {key: one for key, one in found.items() if key not in scene.facts}
    if not measured or not given:
        missing = "no result" if not measured else "nothing of the launch"
        raise RequestError(f"{table.where}: {missing} among the columns that are used: {', '.join(found) or 'none'}")
    if form.title:
        notes.insert(0, f"read as {form.title}: {', '.join(f'{one.column} as {one.key}' for one in form.entries)}")
    return Mapped(given, measured, tuple(row + 1 for row in rows), tuple(notes))


def _column(table: Table, name: str) -> Column | None:
    return next((one for one in table.columns if one.name.lower() == name.lower()), None)


def _rows(table: Table, form: Form, where: Mapping[str, str]) -> tuple[list[int], list[str]]:
    """The rows that have all values that are used, and sentences on the others. Raises RequestError if none has."""
    rows = list(range(len(table)))
    for name, wanted in where.items():
        column = _column(table, name)
        if column is None:
            raise RequestError(f"{table.where}: has no column {name!r}, which --where names")
        rows = [row for row in rows if column.cells[row].strip().lower() == wanted.lower()]
        if not rows:
            raise RequestError(f"{table.where}: no row has {name} = {wanted}")
    sums = {row for row in rows if any(one.cells[row].strip().lower() in SUMMARIES for one in table.columns)}
    columns = [column for entry in form.entries if (column := _column(table, entry.column)) is not None]
    missing = MISSING | {"0", "0.0"} if form.zeros else MISSING
    kept = [row for row in rows if row not in sums]
    whole = [row for row in kept if not any(one.cells[row].strip().lower() in missing for one in columns)]
    notes = [f"left out {len(sums)} rows that sum others up"] if sums else []
    if len(whole) < len(kept):
        notes.append(f"left out {len(kept) - len(whole)} of {len(kept)} rows that lack a value")
    if not whole:
        raise RequestError(f"{table.where}: no row has a value in all of {', '.join(one.name for one in columns)}")
    return whole, notes


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
    axis = _column(table, form.spin_axis) if form.spin_axis else None
    if axis is None or entry.column not in form.total_spin:
        return 1.0
    plain = Column(axis.name, axis.unit, tuple(cell.rstrip(" LRlr") or "0" for cell in axis.cells))  # "11.4 L"
    return np.array([cos(radians(table.number(plain, row))) for row in rows])
