"""Tables of a user's own in place of the published ones: as those are written, or with columns that are mapped."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from sandbox import units
from sandbox.errors import RequestError
from sandbox.files import from_here
from sandbox.lab.mapped import EVERYTHING, Choices, Mapped, Quantity, read_shots
from sandbox.lab.published import KINDS, Case, assignments, cases_by_form, form_of, tables_of, with_preset
from sandbox.lab.selection import used
from sandbox.lab.table_file import Table, read_table
from sandbox.scene import Scene, load
from sandbox.scene.discovery import is_path
from sandbox.text import argument, no_such_result, shortened

#: The columns that such a table needs, and what the others are where they are missing.
_NEEDED = ("result", "value", "tolerance")
OTHERS = {"scene": "", "preset": "", "case": "", "set": "", "unit": "", "source": "", "reason": "", "kind": "measured",
          "tests": "", "tolerance_from": ""}  # fmt: skip


class Given(NamedTuple):
    """The numbers of a table, a sentence on the rows that are left out of it, and others on how it was read."""

    cases: list[Case]
    left_out: str = ""
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Shots:
    """The launches of a table and what was measured of each."""

    scene: Scene
    path: Path
    found: Mapped

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on how the table was read."""
        unused = f"columns that are not used: {', '.join(self.found.unused)}" if self.found.unused else ""
        return tuple(filter(None, (*self.found.notes, unused)))


def read_against(path: Path, source: str | None, choices: Choices = EVERYTHING) -> list[Case] | Shots:
    """The numbers of a user's table. Raises RequestError.

    Without columns that are named it has those of the published tables; ``source`` is the scene of rows that name none,
    or of which only those of this scene are wanted. With them, or with columns that are known, each row is a launch and
    its results.
    """
    table = read_table("--against", path)
    if not choices.entries and any(name in table.names for name in _NEEDED[1:]):
        if choices.where or choices.without:
            raise RequestError("--where and --without are for tables of launches")
        if (missing := next((name for name in _NEEDED if name not in table.names), None)) is not None:
            raise RequestError(f"{table.where}: has no column {missing}")
        return _published(table, path, source)
    if source is None:
        raise RequestError(f"--against {path}: name the scene that its launches are for")
    scene = load(source)
    found = read_shots(scene, table, choices)
    found.check_both()
    return Shots(scene, path, found)


def cases_of_shots(shots: Shots, within: Mapping[str, str]) -> Given:
    """Each measured result with its tolerance from ``within``: a number with a unit, or a percentage. Raises
    RequestError."""
    found = shots.found
    unknown = next((name for name in within if name not in found.measured), None)
    if unknown is not None:
        raise RequestError(f"--within {unknown}: is no result of the table, which has {', '.join(found.measured)}")
    settings = [_settings(found.given, place) for place in range(len(found.rows))]
    cases = [
        _case(shots.scene, shots.path, row, settings[place], name, one, place, within)
        for place, row in enumerate(found.rows)
        for name, one in found.measured.items()
    ]
    return Given(cases, used(len(found.rows) + len(found.left_out), found.left_out), shots.notes)


def own_cases(scene: str, folder: Path) -> list[Case]:
    """The published numbers in the folder of a user's own scene, checked. Raises RequestError."""
    found: list[Case] = []
    for path in tables_of(folder):
        form = form_of(path)
        if form is not None:
            found += cases_by_form(scene, path, form)
            continue
        table = read_table("", Path(from_here(path)))
        missing = next((name for name in _NEEDED if name not in table.names), None)
        if missing is not None:
            raise RequestError(f"{table.where}: has no column {missing}")
        found += _published(table, path, scene)
    return found


def _settings(given: Mapping[str, Quantity], place: int) -> str:
    return "; ".join(f"{key}={argument(float(one.values[place]))}" for key, one in given.items())


def _case(
    scene: Scene, path: Path, row: int, settings: str, name: str, one: Quantity, place: int, within: Mapping[str, str]
) -> Case:
    value, unit = float(one.written[place]), one.units[place]
    if name not in within:
        raise RequestError(f"--against {path}: say how far off {name} may be: --within {name}=2%, or a number")
    tolerance = _tolerance(f"--within {name}={within[name]}", within[name], value, unit)
    return Case(scene.title, settings, f"row {row}", name, repr(value).removesuffix(".0"), tolerance, unit, path.name,
                "", "measured", "", f"--within {name}={within[name]}")  # fmt: skip


def _tolerance(at: str, text: str, value: float, unit: str) -> float:
    """A tolerance in the unit of the value: a number, with a unit or in that of the value, or a share of it in %.
    ``at`` is as messages begin. Raises RequestError."""
    try:
        share = units.parse(text, "%") if text.strip().endswith("%") else None
        found = units.parse(text, unit) if share is None else abs(value) * share / 100.0
    except ValueError as error:
        raise RequestError(f"{at}: {error}") from None
    if not found >= 0.0:
        raise RequestError(f"{at}: must be 0 or more")
    return found


def _published(table: Table, path: Path, source: str | None) -> list[Case]:
    """The rows of a table as the published ones are written."""
    known = {*_NEEDED, *OTHERS}
    if table.broken:
        place, why = next(iter(table.broken.items()))
        raise RequestError(f"{table.where}: row {place + 1} {why}")
    unknown = next((name for name in table.names if name not in known), None)
    if unknown is not None:
        raise RequestError(f"{table.where}: column {unknown!r} is none of {', '.join(sorted(known))}")
    columns = {column.name: column.cells for column in table.columns}
    found = []
    for place in range(len(table)):
        row = {name: columns[name][place].strip() for name in columns}
        case = _row(table, place + 1, {**OTHERS, **row}, path, source)
        if source is None or source in (case.scene, case.sport):
            found.append(case)
    if not found:
        raise RequestError(f"{table.where}: has no rows" + (f" of {source}" if source is not None else ""))
    return found


def _row(table: Table, number: int, row: dict[str, str], path: Path, source: str | None) -> Case:
    """One number of the user's, checked. Raises RequestError."""
    at = f"{table.where}: row {number},"
    row["scene"] = with_preset(row["scene"] or source or "", row["preset"])
    row["preset"] = row["preset"] or ("" if is_path(row["scene"]) else row["scene"].partition("/")[2])
    row["source"], row["case"] = row["source"] or path.name, row["case"] or f"row {number}"
    if not row["scene"]:
        raise RequestError(f"{at} names no scene; give one: sandbox validate SCENE --against {path}")
    if row["kind"] not in KINDS:
        raise RequestError(f"{at} kind = {shortened(row['kind'], 40)!r} is none of {', '.join(KINDS)}")
    try:
        scene = load(row["scene"], assignments(row["set"]), overrides_from="set")
    except RequestError as error:
        raise RequestError(f"{at} {error}") from None
    name = row["result"].partition(".")[0]
    if name not in scene.facts:
        raise RequestError(f"{at} result = {shortened(name, 40)}: {no_such_result(name, list(scene.facts))}")
    tolerance = None
    if row["tolerance"]:
        value = table.number(next(column for column in table.columns if column.name == "value"), number - 1)
        _check_unit(at, row, scene.facts[name].unit)
        wide = row["tolerance"].replace(",", ".") if table.comma else row["tolerance"]
        tolerance = _tolerance(f"{at} tolerance = {shortened(wide, 40)}", wide, value, row["unit"])
        row["value"] = repr(value)
    row["value"] = row["value"].removesuffix(".0")
    return Case(name=row.pop("case"), tolerance=tolerance, **{k: v for k, v in row.items() if k != "tolerance"})


def _check_unit(at: str, row: Mapping[str, str], own: str) -> None:
    """Raise RequestError if the row's unit is not one that the result can have."""
    unit = row["unit"]
    if unit not in units.KIND_OF or (own and units.KIND_OF[unit] != units.KIND_OF[own]):
        raise RequestError(
            f"{at} unit = {shortened(unit, 40)!r} is no unit of {row['result']}; use {units.listed(own)}"
        )
