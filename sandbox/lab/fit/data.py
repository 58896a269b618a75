"""The data of a fit, from files or from columns in Python: a track, places without times, or a table of launches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from sandbox.errors import RequestError
from sandbox.lab.fit.formats import Entry, device, in_table, recognized, stated
from sandbox.lab.fit.frame import frame_of
from sandbox.lab.fit.launches import launches
from sandbox.lab.fit.measured import Measured
from sandbox.lab.fit.outline import Outline
from sandbox.lab.fit.reading import NAMES, Film, has_positions, measurements
from sandbox.lab.fit.track import Track
from sandbox.lab.table_file import Column, Table, read_table, split_unit
from sandbox.scene import Scene, simulate
from sandbox.text import shortened

#: A run of other values may take so many times as long as that of the scene.
LONGER = 2.0


@dataclass(frozen=True)
class Reading:
    """The choices by which files are read."""

    film: Film = Film()
    free: tuple[str, ...] = ()  # of the film: origin, time, tilt
    entries: tuple[Entry, ...] = ()  # columns of launches and results; known ones if there are none
    where: Mapping[str, str] = field(default_factory=dict)  # only rows with this text in a column


def data_of(scene: Scene, tables: Sequence[tuple[str, Table]], how: Reading) -> Measured:
    """The data of tables, each with the name of its ball. Raises RequestError."""
    if how.entries and all(entry.key in NAMES for entry in how.entries):
        tables = [(name, renamed(table, how.entries)) for name, table in tables]
        how = replace(how, entries=())
    first = tables[0][1]
    if not how.entries and all(has_positions(table) for _, table in tables):
        if how.where:
            raise RequestError("--where is for tables of launches")
        found = measurements(tables, how.film)
        frame = frame_of(scene, found, how.free)
        places = found.positions, found.balls, found.rows, frame, found.where
        return Outline(*places, LONGER * simulate(scene).duration) if found.t is None else Track(*places, found.t)
    form = stated(how.entries, first, scene) if how.entries else recognized(first, scene)
    if form is None and (known := device(first)) is not None:
        about = f"looks like {known.title}, whose columns are known for {known.scene}"
        raise RequestError(f"{first.where}: {about}; for {scene.title} name them by --map")
    if form is None:
        try:
            measurements(tables, how.film)  # says which column is missing
        except RequestError as error:
            raise RequestError(f"{error}; a table of launches needs --map, see --formats") from None
        raise AssertionError("a table with x and y is a track")
    if len(tables) > 1 or how.free or how.film != Film():
        raise RequestError(
            f"{first.where}: is a table of launches; options for films and several tracks do not apply to it"
        )
    return launches(scene, first, form, how.where)


def renamed(table: Table, entries: Sequence[Entry]) -> Table:
    """The table of a track with the names, and units, that entries such as ``Zeit=t ms`` give. Raises RequestError."""
    named = {entry.column.lower(): entry for entry in in_table(entries, table)}
    columns = [
        replace(one, name=named[one.name.lower()].key, unit=named[one.name.lower()].unit or one.unit)
        if one.name.lower() in named
        else one
        for one in table.columns
    ]
    return replace(table, columns=tuple(columns))


def read_data(scene: Scene, paths: Sequence[Path], how: Reading) -> Measured:
    """The data of files. Raises RequestError."""
    return data_of(scene, [(path.stem, read_table("track", path)) for path in paths], how)


def table_of(columns: Mapping[str, Sequence[Any]]) -> Table:
    """A table of columns from Python. Raises RequestError."""
    lengths = {name: len(cells) for name, cells in columns.items()}
    if len(set(lengths.values())) > 1:
        said = ", ".join(f"{name} has {count}" for name, count in lengths.items())
        raise RequestError(f"track: its columns must have equally many values: {shortened(said, 80)}")
    if not lengths:
        raise RequestError("track: has no columns")
    cells = {
        name: [value.item() if hasattr(value, "item") else value for value in column]
        for name, column in columns.items()
    }
    return Table("track", tuple(Column(*split_unit(name), tuple(map(str, column))) for name, column in cells.items()))
