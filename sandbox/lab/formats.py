"""Columns of tables as parameters and results of a scene: as ``--map`` says, or by the names of a device."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.table_file import PIXEL, Column, Table, split_unit
from sandbox.parameters import walk
from sandbox.scene import Scene
from sandbox.text import nearest, shortened


@dataclass(frozen=True)
class Entry:
    """One column: ``Ball Speed=launch.speed mph``."""

    column: str
    key: str  # of a parameter, or of a result
    unit: str  # "" if it does not say


@dataclass(frozen=True)
class Rule:
    """Rows that a scene does not describe, by one of their columns: those with a word, or with less than a number."""

    column: str
    why: str
    words: tuple[str, ...] = ()
    below: float | None = None

    @property
    def text(self) -> str:
        """``launch_angle below 10``."""
        return f"{self.column} " + (f"below {self.below:g}" if self.below is not None else " or ".join(self.words))

    def holds(self, table: Table, column: Column, row: int) -> bool:
        """True for a row that is left out by this rule."""
        cell = column.cells[row].strip().lower()
        less = self.below is not None and not table.fault(column, row) and table.number(column, row) < self.below
        return cell in self.words or less


@dataclass(frozen=True)
class Form:
    """The columns of a table that are used."""

    entries: tuple[Entry, ...]
    title: str = ""  # of a known device; "" where the user says it
    scene: str = ""  # the scene whose shots it measures
    source: str = ""  # where its names are from
    total_spin: tuple[str, ...] = ()  # columns whose spin, times the cosine of the axis's tilt, is the backspin
    spin_axis: tuple[str, ...] = ()  # columns of that tilt in deg, of which a file has one
    length_unit: str = ""  # the column that names the unit of lengths
    zeros: bool = False  # 0 stands for what was not measured
    leave_out: tuple[Rule, ...] = ()  # rows that the scene does not describe


def parse_entry(text: str) -> Entry:
    """``COLUMN=KEY [UNIT]``. Raises RequestError."""
    column, equals, rest = text.rpartition("=")
    key, _, unit = rest.strip().partition(" ")
    if not equals or not column.strip() or not key:
        raise RequestError(f'--map {text}: write it as "COLUMN=KEY UNIT", for example "Ball Speed=launch.speed mph"')
    unit = unit.strip()
    if unit and unit not in units.KIND_OF and unit != PIXEL:
        meant = units.suggestion(unit)
        raise RequestError(f"--map {text}: {unit} is not a known unit" + (f"; did you mean {meant}?" if meant else ""))
    return Entry(column.strip(), key, unit)


@cache
def forms() -> Mapping[str, Form]:
    """The known devices by name."""
    known = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
    return {name: _form(given) for name, given in known.items()}


def _form(given: dict[str, Any]) -> Form:
    """A known device, as the file writes it."""
    columns, total = given.pop("columns"), tuple(given.pop("total_spin", ()))
    rules = tuple(
        Rule(rule.pop("column"), rule.pop("why"), tuple(rule.pop("words", ())), **rule)
        for rule in given.pop("leave_out", ())
    )
    entries = tuple(parse_entry(f"{column}={to}") for column, to in columns.items())
    return Form(entries, total_spin=total, leave_out=rules, spin_axis=tuple(given.pop("spin_axis", ())), **given)


def as_text() -> str:
    """All known devices with their columns, as ``--map`` takes them, and where the names are from."""
    lines = ["Known columns of tables. A unit in the file, in a name or in a row of units, comes before these."]
    for form in forms().values():
        lines += ["", f"{form.title}, for {form.scene}", f"  names: {form.source}"]
        lines += [f'  --map "{one.column}={one.key} {one.unit}"' for one in form.entries]
        if form.spin_axis:
            total = " or ".join(form.total_spin)
            axis = " or ".join(form.spin_axis)
            lines += [f"  {total} times the cosine of {axis} is the backspin"] if total else []
        lines += [f"  left out: {rule.text} ({rule.why})" for rule in form.leave_out]
    return "\n".join(lines)


def recognized(table: Table, scene: Scene) -> Form | None:
    """The form of the known device for this scene most of whose columns the table has, launch and result both, or
    None."""
    found = [_usable(form, table, scene) for form in forms().values() if form.scene == scene.name]
    complete = [form for form in found if _is_complete(form, scene)]
    return max(complete, key=lambda form: len(form.entries), default=None)


def device(table: Table) -> Form | None:
    """The known device at least three of whose columns the table has, whatever the scene; or None."""
    names = {name.lower() for name in table.names}
    counts = {form: sum(entry.column.lower() in names for entry in form.entries) for form in forms().values()}
    best = max(counts, key=lambda form: counts[form])
    return best if counts[best] >= 3 else None


def _usable(form: Form, table: Table, scene: Scene) -> Form:
    """The form with those of its entries that the table and the scene have, one for each key."""
    names = {name.lower() for name in table.names}
    known = declared_units(scene)
    taken: dict[str, Entry] = {}
    for entry in form.entries:
        if entry.column.lower() in names and entry.key in known:
            taken.setdefault(entry.key, entry)
    return replace(form, entries=tuple(taken.values()))


def _is_complete(form: Form, scene: Scene) -> bool:
    measured = [entry.key in scene.facts for entry in form.entries]
    return any(measured) and measured.count(False) >= 2


def in_table(entries: Sequence[Entry], table: Table) -> tuple[Entry, ...]:
    """The entries with columns as the table names them: ``Speed (mph)`` is its column ``Speed`` too.

    Raises RequestError for a column that it does not have.
    """
    names, found = {name.lower() for name in table.names}, []
    for entry in entries:
        plain = split_unit(entry.column)[0]
        found.append(replace(entry, column=plain) if plain.lower() in names else entry)
        if found[-1].column.lower() not in names:
            near = nearest(entry.column, table.names)
            has = f"did you mean {near}?" if near else f"it has {shortened(', '.join(table.names), 80)}"
            raise RequestError(f"{table.where}: has no column {entry.column!r}, which --map names; {has}")
    return tuple(found)


def stated(entries: Sequence[Entry], table: Table, scene: Scene) -> Form:
    """The form that the user gave. Raises RequestError for a column or a key that does not exist."""
    entries = in_table(entries, table)
    known = declared_units(scene)
    for entry in entries:
        if entry.key not in known:
            near = nearest(entry.key, [*known])
            hint = f"; did you mean {near}?" if near else ""
            raise RequestError(f"--map {entry.column}={entry.key}: no such parameter or result in {scene.title}{hint}")
    for number, key in enumerate(keys := [entry.key for entry in entries]):
        if key in keys[:number]:
            raise RequestError(f"--map: two columns are {key}")
    return Form(entries)


def without(form: Form, names: Sequence[str], table: Table) -> Form:
    """The form without these columns, each named as in the table or by what it stands for. Raises RequestError for one
    that it does not use."""
    for name in names:
        kept = tuple(entry for entry in form.entries if name.lower() not in (entry.column.lower(), entry.key))
        if len(kept) == len(form.entries):
            used = ", ".join(f"{entry.column} ({entry.key})" for entry in form.entries) or "none"
            raise RequestError(f"--without {name}: {table.where} is read by other columns: {shortened(used, 200)}")
        form = replace(form, entries=kept)
    return form


def declared_units(scene: Scene) -> Mapping[str, str]:
    """The unit of every parameter and result, "" for a plain number."""
    parameters = {one.key: one.unit or "" for one in walk(scene.parameters)}
    return parameters | {key: fact.unit for key, fact in scene.facts.items()}
