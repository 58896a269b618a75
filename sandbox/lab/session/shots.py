"""The shots of a session: those columns of a table that are known, whatever else it has or lacks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.formats import (
    ColumnMap,
    Entry,
    Source,
    declared_units,
    device,
    in_table,
    known_elsewhere,
    recognized,
    stated,
)
from sandbox.lab.mapped import EVERYTHING, Choices, are_missing, column_of, leave_out_repeated, mapped
from sandbox.lab.misfit import groups_of
from sandbox.lab.selection import LeftOut, Selection, reasons, used
from sandbox.lab.table_file import Column, Table, read_table
from sandbox.scene import Scene, load
from sandbox.text import shortened

#: Cells that say whether something is true, in lower case.
_TRUE = {"true", "yes", "y", "made", "make", "in", "hit"}
_FALSE = {"false", "no", "n", "missed", "miss", "out"}

#: The parameters of a launch, in the order of a report.
LAUNCH = ("launch.speed", "launch.angle", "launch.spin", "launch.direction", "launch.axis")

#: The facts that are the distance of a shot, the first that there is; and that to the side.
_DISTANCES = ("carry", "distance", "total", "landing")
SIDE = "side"

#: A group of fewer shots has no mishits: its median deviation says too little.
FEWEST = 6

#: A group scatters by at least this share of its speed or distance: assumed. A few shots may lie closer together by
#: chance, and one that is some yards off them is no mishit.
NARROW = 0.03

#: The shares of the shots that ellipses hold.
SHARES = (0.5, 0.95)

#: Where a pitch crosses the plate: the name of a column, and the fact of its height.
_ACROSS, _HEIGHT = "side at the plate", "plate_height"

#: Columns of numbers from which on two rows with the same cells are one shot twice.
_TOLD_APART = 4


@dataclass(frozen=True)
class Measure:
    """One column: what it stands for, and its numbers in the unit of the table."""

    key: str  # a parameter or result of the scene, or the column's own name
    label: str
    unit: str  # "" for a plain number
    values: np.ndarray  # shape (shots,), NaN where there is none
    is_share: bool = False  # if it is 1 for true and 0 for false

    @property
    def heading(self) -> str:
        """The label with its unit."""
        return f"{self.label} ({self.unit})" if self.unit else self.label

    def of(self, kept: np.ndarray) -> np.ndarray:
        """The numbers of some of the shots, given by true and false, without NaN."""
        chosen = self.values[kept]
        return np.asarray(chosen[np.isfinite(chosen)])


@dataclass(frozen=True)
class Shots:
    """The shots of a file, and the groups that they are in."""

    path: Path
    scene: Scene
    table: Table
    column_map: ColumnMap
    choices: Choices
    rows: np.ndarray  # of the file, the first is 1
    measures: Mapping[str, Measure]
    by: str  # the column of the groups; "" if all shots are one
    groups: Mapping[str, np.ndarray]  # true for each shot that is in it
    left_out: tuple[LeftOut, ...]
    notes: tuple[str, ...] = ()

    @cached_property
    def distance(self) -> Measure | None:
        """The distance of each shot, if the file has it."""
        return next((self.measures[key] for key in _DISTANCES if key in self.measures), None)

    @cached_property
    def main(self) -> Measure:
        """The column that tells groups apart first: the distance, the share that scores, the speed, or any."""
        shares = [one for one in self.measures.values() if one.is_share]
        speed = [self.measures[key] for key in ("launch.speed",) if key in self.measures]
        return next(iter([*([self.distance] if self.distance else []), *shares, *speed, *self.measures.values()]))

    @cached_property
    def places(self) -> tuple[Measure, Measure] | None:
        """The places where shots come down, or cross the plate: to the right, and forward or up; None without."""
        if _ACROSS in self.measures and _HEIGHT in self.measures:
            return self.measures[_ACROSS], self.measures[_HEIGHT]
        side = self.measures.get(SIDE)
        return None if side is None or self.distance is None else (side, self.distance)

    @property
    def upright(self) -> bool:
        """True if ``places`` are in a plane that stands."""
        return _ACROSS in self.measures


def read_session(
    path: Path,
    scene: str | None = None,
    by: str | None = None,
    of: Sequence[str] = (),
    choices: Choices = EVERYTHING,
) -> Shots:
    """Read a session. Raises RequestError; if the choices are strict also for a row with a fault.

    Columns are those that are named, of a known device, and those that have the name of a parameter or a result; and
    the columns ``of`` numbers that stand for nothing in the scene. Groups are the words, or numbers, of the column
    ``by``. A shot need not have all of them.
    """
    table = _plain(read_table("session", path))
    known = device(table)
    if scene is None and known is None:
        raise RequestError(
            f"{table.where}: has the columns of no known device; name the sport, and what its columns are: "
            f'--scene golf --map "carry={table.names[-1]} [yd]" ({shortened(", ".join(table.names), 100)})'
        )
    chosen = load(scene or (known.scene if known is not None else ""))
    column_map = _column_map(table, chosen, choices)
    rows, left_out = _rows(chosen, table, column_map, choices)
    notes: list[str] = []
    every = {source.key: _measure(chosen, table, column_map, source, rows, notes) for source in column_map.sources}
    form = column_map.form
    across = [(_ACROSS, form.across, "ft")] if form is not None and form.across in table.names else []
    for key, name, unit in [*((name, name, "") for name in of), *across]:
        column = column_of(table, {}, name, "--of")
        every[key] = _numbers(table, key, column, column.unit or unit, rows)
    measures = {key: one for key, one in every.items() if np.isfinite(one.values).any()}
    if not measures:
        raise RequestError(f"{table.where}: has no column of a known meaning; name them by --map, or numbers by --of")
    some = np.any([np.isfinite(one.values) for one in measures.values()], axis=0)  # a pitch that nobody hit is no hit
    left_out += tuple(LeftOut(row, "no value in any column that is used") for row in np.array(rows)[~some].tolist())
    rows = np.array(rows)[some].tolist()
    measures = {key: replace(one, values=one.values[some]) for key, one in measures.items()}
    group = _group_column(table, column_map, by)
    places = np.array(rows)
    groups = {"all": np.ones(len(rows), dtype=bool)} if group is None else groups_of(table, group, places)
    name = "" if group is None else group.name
    shots = Shots(path, chosen, table, column_map, choices, places, measures, name, groups, left_out)
    return replace(shots, groups=_ordered(shots), notes=tuple(_notes(shots, of, notes)))


def _plain(table: Table) -> Table:
    """The table with 1 and 0 in columns that say yes and no."""

    def changed(column: Column) -> Column:
        words = {cell.strip().lower() for cell in column.cells} - {"", "-"}
        if words and words <= _TRUE | _FALSE:
            cells = (cell.strip().lower() for cell in column.cells)
            return replace(
                column, cells=tuple("1" if cell in _TRUE else "0" if cell in _FALSE else "" for cell in cells)
            )
        return column

    return replace(table, columns=tuple(map(changed, table.columns)))


def _column_map(table: Table, scene: Scene, choices: Choices) -> ColumnMap:
    """The columns that are used, one for each key: those that are given, of the device, and named as their keys."""
    found = ColumnMap(()) if not choices.entries else stated(choices.entries, table, scene)
    known = recognized(table, scene, beside=True)
    taken = {source.key: source for source in found.sources}
    for source in known.sources if known is not None else ():
        taken.setdefault(source.key, source)
    declared, used_names = declared_units(scene), {name for one in taken.values() for name in one.expression.columns}
    elsewhere = set() if known is None else known_elsewhere(scene)
    for name in table.names:
        key = name.lower().replace(" ", "_")
        if key in declared and key not in taken and name not in used_names and name.lower() not in elsewhere:
            taken |= {source.key: source for source in in_table([Entry(key, f"`{name}`", "")], table)}
    dropped = {name.lower() for name in choices.without}
    kept = (one for one in taken.values() if not {one.key, one.column.lower()} & dropped)
    return ColumnMap(tuple(kept), None if known is None else known.form)


def _rows(scene: Scene, table: Table, column_map: ColumnMap, choices: Choices) -> tuple[list[int], tuple[LeftOut, ...]]:
    """The rows that are asked for, the first is 1, and those that are left out whatever is asked of them."""
    selection = Selection(table, choices.strict)
    if len(column_map.sources) >= _TOLD_APART:
        leave_out_repeated(table, selection)
    rows, left_out = {row + 1 for row in selection.rows}, {one.row: one for one in selection.left_out}
    sources = {source.key: source for source in column_map.sources}
    names = {name.lower() for name in table.names}
    for condition in choices.where:
        own = condition.name in sources and condition.name.lower() not in names
        needed = (sources[condition.name],) if own else ()
        asked = Choices(where=(condition,), strict=choices.strict)
        rows &= set(mapped(scene, table, replace(column_map, sources=needed, notes=()), asked).rows)
    whole = mapped(scene, table, replace(column_map, sources=(), notes=()), Choices(strict=choices.strict))
    left_out = {one.row: one for one in whole.left_out} | left_out
    rows &= set(whole.rows)
    if not rows:
        raise RequestError(f"{table.where}: no row has all of {' and '.join(map(str, choices.where))}")
    return sorted(rows), tuple(left_out[row] for row in sorted(left_out))


def _measure(
    scene: Scene, table: Table, column_map: ColumnMap, source: Source, rows: Sequence[int], notes: list[str]
) -> Measure:
    """The numbers of a source in these rows: NaN where it has none, or one that stands for none, which is noted."""
    fact, values = scene.facts.get(source.key), np.full(len(rows), np.nan)
    label = fact.label if fact is not None and fact.label else _label(source.key)
    columns = [table.column(name) for name in source.expression.columns]
    there = [row for row in rows if not are_missing(columns, row - 1)]
    try:
        one = mapped(scene, table, replace(column_map, sources=(source,), notes=()))
    except RequestError as error:
        notes.append(f"{source.expression.text}: {str(error).removeprefix(f'{table.where}: ')}")
        return Measure(source.key, label, "", values)
    faults = [fault for fault in one.left_out if fault.row in there]
    notes += [f"{source.key}: not in {reasons(faults)}"] if faults else []
    notes += [note for note in one.notes if "no unit" in note]
    quantity = {**one.measured, **one.given}[source.key]
    unit = quantity.units[0] if len(set(quantity.units)) == 1 and quantity.units[0] else quantity.unit
    numbers = quantity.values if unit == quantity.unit else quantity.written
    known = dict(zip(one.rows, numbers.tolist(), strict=True))
    values = np.array([known.get(row, np.nan) if row in set(there) else np.nan for row in rows])
    some = values[np.isfinite(values)]
    is_share = fact is not None and not fact.unit and bool(np.isin(some, (0.0, 1.0)).all())
    return Measure(source.key, label, unit, values, is_share)


def _numbers(table: Table, key: str, column: Column, unit: str, rows: Sequence[int]) -> Measure:
    """The numbers of a column that stands for nothing in the scene."""
    values = [np.nan if table.fault(column, row - 1) else table.number(column, row - 1) for row in rows]
    return Measure(key, _label(key), unit, np.array(values))


def _label(key: str) -> str:
    """``club.speed`` as ``club speed``."""
    return key.removeprefix("launch.").replace("_", " ").replace(".", " ")


def _group_column(table: Table, column_map: ColumnMap, by: str | None) -> Column | None:
    """The column of the groups: the one that is asked for, that of the device, or the first of words that repeat."""
    if by is not None:
        return column_of(table, column_map.columns, by, "--by")
    names = {column.name.lower(): column for column in table.columns}
    club = () if column_map.form is None else column_map.form.club
    known = [names[name.lower()] for name in club if name.lower() in names]
    for column in known or table.columns:
        words = [cell.strip() for cell in column.cells if cell.strip()]
        if (known and words) or _repeat(table, column, words):
            return column
    return None


def _repeat(table: Table, column: Column, words: Sequence[str]) -> bool:
    """True for a column of a few words, each for some rows."""
    return all(table.fault(column, row) for row in range(len(table))) and 0 < 2 * len(set(words)) <= len(words)


def _ordered(shots: Shots) -> dict[str, np.ndarray]:
    """The groups from the longest shots, or fastest, to the shortest; those without any last."""

    def size(name: str) -> float:
        some = shots.main.of(shots.groups[name])
        middle = np.mean if shots.main.is_share else np.median  # which mishits hardly move
        return float(middle(some)) if len(some) else -np.inf

    return {name: shots.groups[name] for name in sorted(shots.groups, key=size, reverse=True)}


def _notes(shots: Shots, of: Sequence[str], notes: Sequence[str]) -> list[str]:
    """Sentences on how the table was read."""
    form = shots.column_map.form
    taken = {name.lower() for name in (*shots.column_map.used, *of, shots.by, "" if form is None else form.across)}
    unused = shots.table.others(taken | {one.name.lower() for one in shots.choices.where})
    asked = f"only rows with {' and '.join(map(str, shots.choices.where))}: {len(shots.rows)} of {len(shots.table)}"
    return [
        *([sentence] if (sentence := used(len(shots.rows) + len(shots.left_out), shots.left_out)) else []),
        *([asked] if shots.choices.where else []),
        shots.column_map.sentence(shots.scene),
        *dict.fromkeys(notes),
        *([f"columns that are not used: {', '.join(unused)}"] if unused else []),
    ]
