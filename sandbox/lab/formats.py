"""Columns of tables as parameters and results of a scene: as ``--map`` says, or by the names of a device."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.expression import Expression, parse
from sandbox.lab.table_file import PIXEL, Column, Table, split_unit
from sandbox.parameters import value_at, walk
from sandbox.scene import Scene
from sandbox.text import nearest, shortened

#: How an entry is written, for messages.
_HOW = 'write it as "KEY=EXPRESSION [UNIT]", for example --map "launch.speed=Ball Speed [mph]"'

#: What says of a shot how it leaves the plane: without any of it a scene has no result at the side.
SIDEWAYS = ("launch.axis", "launch.direction")

#: A name of a column, or of a function, in an entry of a known device.
_WORDS = re.compile(r"[^\W\d][\w.]*(?:(?: - | )[^\W\d][\w.]*)*")

_ENTRY = re.compile(r"\s*([^=]*?)\s*=\s*(.*?)\s*(?:\[([^\[\]]*)\])?\s*")


@dataclass(frozen=True)
class Entry:
    """A parameter or result by the columns of a table: ``launch.speed=Ball Speed [mph]``."""

    key: str  # of a parameter, or of a result
    text: str  # arithmetic with columns
    unit: str  # "" if it does not say

    def __str__(self) -> str:
        return f"{self.key}={self.text}" + (f" [{self.unit}]" if self.unit else "")


@dataclass(frozen=True)
class Source:
    """An entry with the columns of a table."""

    key: str
    expression: Expression
    unit: str

    @property
    def column(self) -> str:
        """The column that it is, "" for arithmetic."""
        return self.expression.columns[0] if self.expression.is_column else ""

    @property
    def name(self) -> str:
        """The column, or the arithmetic, for messages."""
        return self.column or shortened(self.expression.text, 40)


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
    """The columns of a known device."""

    title: str
    scene: str  # the scene, or preset, whose shots it measures
    source: str  # where its names are from
    columns: tuple[tuple[Entry, ...], ...]  # those of a group are taken together; the first group that can be is taken
    names: Mapping[str, tuple[str, ...]] = field(default_factory=dict)  # of columns in other languages
    needs: tuple[str, ...] = ()  # columns without which a table is none of this device
    club: tuple[str, ...] = ()  # columns with the club, or the kind of pitch
    beside: tuple[str, ...] = ()  # results that are compared only if the user names them
    across: str = ""  # the column, in ft, of where a pitch crosses the plate, to the side
    length_unit: str = ""  # the column that names the unit of lengths
    zeros: bool = False  # 0 stands for what was not measured
    leave_out: tuple[Rule, ...] = ()  # rows that the scene does not describe

    @property
    def known(self) -> set[str]:
        """All names of columns that it has, as they are compared."""
        words = (word for group in self.columns for entry in group for word in _WORDS.findall(entry.text))
        others = (name for names in self.names.values() for name in names)
        return {_letters(name) for name in (*words, *others)}


@dataclass(frozen=True)
class ColumnMap:
    """The columns of a table that are used, and how."""

    sources: tuple[Source, ...]
    form: Form | None = None  # None where the user says it
    notes: tuple[str, ...] = ()

    def sentence(self, scene: Scene) -> str:
        """Say how the table is read."""
        named = [f"{source.column} as {source.key}" for source in self.sources if source.column]
        computed = ", ".join(source.key for source in self.sources if not source.column)
        named += [f"{computed} by arithmetic (sandbox fit --formats)"] if computed and self.form is not None else []
        return f"read {f'for {scene.title}' if self.form is None else f'as {self.form.title}'}: {', '.join(named)}"

    @property
    def columns(self) -> Mapping[str, str]:
        """The column of each parameter and result that is one."""
        return {source.key: source.column for source in self.sources if source.column}

    @property
    def used(self) -> set[str]:
        """The names of all columns that are used."""
        names = {name for source in self.sources for name in source.expression.columns}
        rules = () if self.form is None else (self.form.length_unit, *(rule.column for rule in self.form.leave_out))
        return {*names, *rules}


def parse_entry(text: str) -> Entry:
    """``KEY=EXPRESSION [UNIT]``. Raises RequestError."""
    found = _ENTRY.fullmatch(text)
    if found is None or not found[1] or not found[2]:
        raise RequestError(f"--map {text}: {_HOW}")
    unit = (found[3] or "").strip()
    if unit and unit not in units.KIND_OF and unit != PIXEL:
        meant = units.suggestion(unit)
        raise RequestError(f"--map {text}: {unit} is not a known unit" + (f"; did you mean {meant}?" if meant else ""))
    return Entry(found[1], found[2], unit)


@cache
def forms() -> Mapping[str, Form]:
    """The known devices by name."""
    known = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
    return {name: _form(given) for name, given in known.items()}


def _form(given: dict[str, Any]) -> Form:
    """A known device, as the file writes it."""
    groups = ([group] if isinstance(group, str) else group for group in given.pop("columns"))
    rules = tuple(
        Rule(rule.pop("column"), rule.pop("why"), tuple(rule.pop("words", ())), **rule)
        for rule in given.pop("leave_out", ())
    )
    lists: dict[str, Any] = {name: tuple(given.pop(name, ())) for name in ("needs", "club", "beside")}
    return Form(
        columns=tuple(tuple(map(parse_entry, group)) for group in groups),
        names={name: tuple(others) for name, others in given.pop("names", {}).items()},
        leave_out=rules,
        **lists,
        **given,
    )


def as_text() -> str:
    """All known devices with their columns, as ``--map`` takes them, and where the names are from."""
    lines = [
        "Known columns of tables. Of several for one key the first that is there is taken; a unit in the file, in a",
        "name or in a row of units, comes before these.",
    ]
    for form in forms().values():
        lines += ["", f"{form.title}, for {form.scene}", f"  names: {form.source}"]
        lines += ["  " + " ".join(f'--map "{entry}"' for entry in group) for group in form.columns]
        lines += [f"  {name} is also {', '.join(others)}" for name, others in form.names.items()]
        lines += [f"  left out: {rule.text} ({rule.why})" for rule in form.leave_out]
    return "\n".join(lines)


# ---------------------------------------------------------------------------------------------------------------------
# A table read by a form
# ---------------------------------------------------------------------------------------------------------------------


def recognized(table: Table, scene: Scene, without: Sequence[str] = (), beside: bool = False) -> ColumnMap | None:
    """The table as that of the known device for this scene most of whose columns it has, launch and result both, or
    None. Columns ``without`` which it is read are named as in the table, or by what they stand for; with ``beside``
    results are read, too, that are not compared. Raises RequestError for a column that would not be used."""
    own = (form for form in forms().values() if form.scene in (scene.name, scene.title))
    fitting = [(form, _sources(form, table, scene, beside=beside)) for form in own]
    complete = [(form, sources) for form, sources in fitting if _is_complete(sources, scene)]
    if not complete:
        return None
    form, sources = max(complete, key=lambda pair: len(pair[1]))
    if not without:
        return ColumnMap(sources, form)
    _check_without(table, sources, without)
    left = _sources(form, table, scene, {name.lower() for name in without}, beside)
    return ColumnMap(left, form, tuple(_without_notes(scene, sources, left)))


def stated(entries: Sequence[Entry], table: Table, scene: Scene, without: Sequence[str] = ()) -> ColumnMap:
    """The table as the user says. Raises RequestError for a column or a key that does not exist."""
    known = declared_units(scene)
    for entry in entries:
        if entry.key not in known:
            raise RequestError(_unknown_key(entry, scene, known))
    for number, key in enumerate(keys := [entry.key for entry in entries]):
        if key in keys[:number]:
            raise RequestError(f"--map {key}: given twice")
    sources = in_table(entries, table)
    if without:
        _check_without(table, sources, without)
    names = {name.lower() for name in without}
    return ColumnMap(tuple(source for source in sources if not _is_without(source, names)))


def in_table(entries: Sequence[Entry], table: Table) -> tuple[Source, ...]:
    """The entries with the columns of a table; ``Speed (mph)`` is its column ``Speed`` too. Raises RequestError."""
    names, found = _names(table), []
    for entry in entries:
        plain = split_unit(entry.text)[0]
        try:
            expression = parse(plain if plain.lower() in names else entry.text, names)
        except ValueError as error:
            form = f" {_HOW[0].upper()}{_HOW[1:]}" if str(error).endswith("?") else f"; {_HOW}"
            raise RequestError(f"{table.where}: --map {entry}: {error}{form}") from None
        found.append(Source(entry.key, expression, entry.unit))
    return tuple(found)


def declared_units(scene: Scene) -> Mapping[str, str]:
    """The unit of every parameter and result, "" for a plain number."""
    parameters = {one.key: one.unit or "" for one in walk(scene.parameters)}
    return parameters | {key: fact.unit for key, fact in scene.facts.items()}


def _names(table: Table, form: Form | None = None, without: Collection[str] = ()) -> dict[str, str]:
    """The names of columns with any content, in lower case, with the columns that they stand for; those of a device
    too, whatever their signs between words."""
    some = (column for column in table.columns if any(map(str.strip, column.cells)))
    full = {one.name.lower(): one.name for one in some if one.name.lower() not in without}
    if form is not None:
        alike = {_letters(name): column for name, column in full.items()}
        for group in form.columns:
            for word in (word for entry in group for word in _WORDS.findall(entry.text)):
                known = (word, *form.names.get(word, ()))
                column = next((alike[_letters(name)] for name in known if _letters(name) in alike), None)
                if column is not None and word.lower() not in without:
                    full.setdefault(word.lower(), column)
    return full


def _letters(name: str) -> str:
    """A name without its case, and what stands between its words."""
    return re.sub(r"[\W_]+", "", name.lower())


def _sources(
    form: Form, table: Table, scene: Scene, without: Collection[str] = (), beside: bool = False
) -> tuple[Source, ...]:
    """The columns of a device that the table and the scene have, one for each key."""
    names, known = _names(table, form, without), declared_units(scene)
    if not set(map(_letters, form.needs)) <= set(map(_letters, table.names)):
        return ()
    taken: dict[str, Source] = {}
    for choice in form.columns:
        group = [entry for entry in choice if entry.key not in without]
        keys = {entry.key for entry in choice}
        if not group or (keys & set(form.beside) and not beside) or not keys <= known.keys() or keys & taken.keys():
            continue
        try:
            taken |= {entry.key: Source(entry.key, parse(entry.text, names), entry.unit) for entry in group}
        except ValueError:  # of a column that is not there
            continue
    if not taken.keys() & set(SIDEWAYS):
        taken.pop("side", None)
    return tuple(taken.values())


def _is_complete(sources: Sequence[Source], scene: Scene) -> bool:
    """True for the speed or more of the launch, and any result."""
    measured = [source.key in scene.facts for source in sources]
    return any(measured) and measured.count(False) >= 2


def _is_without(source: Source, names: Collection[str]) -> bool:
    return source.key in names or any(column.lower() in names for column in source.expression.columns)


def _check_without(table: Table, sources: Sequence[Source], without: Sequence[str]) -> None:
    columns = {name.lower() for name in table.names}
    for name in without:
        if name.lower() not in columns and not any(_is_without(source, {name.lower()}) for source in sources):
            used = ", ".join(f"{source.name} ({source.key})" for source in sources) or "none"
            raise RequestError(f"--without {name}: {table.where} is read by other columns: {shortened(used, 300)}")


def _without_notes(scene: Scene, before: Sequence[Source], after: Sequence[Source]) -> Iterator[str]:
    """Say what is used in place of columns that are left unused."""
    now = {source.key: source for source in after}
    for source in before:
        key, other = source.key, now.get(source.key)
        if other is not None and other.expression != source.expression:
            yield f"{key} is {other.name} in place of {source.name}"
        elif other is None and key in scene.facts:
            yield f"{key} ({source.name}) is not compared"
        elif other is None:
            value = value_at(scene.parameters, key)
            own = "which it does not set" if value is None else f"{value:g} {declared_units(scene)[key]}".rstrip()
            yield f"{key} is not read from {source.name}: it is the scene's, {own}, or what is fitted"


def _unknown_key(entry: Entry, scene: Scene, known: Mapping[str, str]) -> str:
    """The message for a key that the scene does not have; the other way round is what older versions took."""
    key, _, unit = entry.text.partition(" ")
    if key in known:
        return f'--map {entry}: the key comes first: --map "{Entry(key, entry.key, unit)}"'
    near = nearest(entry.key, [*known])
    hint = f"; did you mean {near}?" if near else f"; {_HOW}"
    return f"--map {entry}: no such parameter or result in {scene.title}{hint}"


# ---------------------------------------------------------------------------------------------------------------------
# A table that is not known
# ---------------------------------------------------------------------------------------------------------------------


def known_elsewhere(scene: Scene) -> set[str]:
    """The names, in lower case, of columns that devices have for other scenes: a pitch's file has that of the hit."""
    others = (form for form in forms().values() if form.scene != scene.name)
    return {entry.text.lower() for form in others for group in form.columns for entry in group}


def device(table: Table) -> Form | None:
    """The known device at least three of whose columns the table has, whatever the scene; or None."""
    names = set(map(_letters, table.names))
    counts = {name: len(form.known & names) for name, form in forms().items()}
    best = max(counts, key=lambda name: counts[name])
    return forms()[best] if counts[best] >= 3 else None


def advice(table: Table, scene: Scene) -> str:
    """Likely meanings of the columns of a table that is not known, as ``--map`` options to complete; "" if none is
    recognized."""
    known = declared_units(scene)
    meant: dict[str, str] = {}
    for form in forms().values():
        names = _names(table, form)
        for entry in (entry for group in form.columns for entry in group):
            if entry.key in known and entry.key not in meant and entry.text.lower() in names:
                meant[entry.key] = names[entry.text.lower()]
    for key in known:
        if key not in meant and (column := _alike(key, scene, table)) and column not in meant.values():
            meant[key] = column
    if not meant:
        return ""
    wanted = [key for key in ("launch.speed", "launch.angle") if key in known and key not in meant]
    wanted += [] if any(key in scene.facts for key in meant) else [next(iter(scene.facts))]
    maps = [f'--map "{key}={name}{"" if table.column(name).unit or not known[key] else " [UNIT]"}"'
            for key, name in meant.items()]  # fmt: skip
    maps += [f'--map "{key}=COLUMN{" [UNIT]" if known[key] else ""}"' for key in wanted]
    return f"{', '.join(meant.values())} seem known; complete and give {' '.join(maps)}"


def _alike(key: str, scene: Scene, table: Table) -> str:
    """The column whose name has the same words as a result, or as a parameter of the launch; "" if none has."""
    if key not in scene.facts and not key.startswith("launch."):
        return ""
    words = set(re.split(r"[\W_]+", key.removeprefix("launch.").lower()))
    own = {name: set(re.split(r"[\W_]+", name.lower())) - {""} for name in table.names}
    return next((name for name, has in own.items() if words == has or words == has - {"ball", "launch"}), "")
