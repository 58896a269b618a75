"""The data of a fit, from files or from columns in Python: a track, places without times, or a table of launches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from sandbox.errors import RequestError
from sandbox.lab.fit.frame import frame_of
from sandbox.lab.fit.launches import launches
from sandbox.lab.fit.measured import Measured
from sandbox.lab.fit.outline import Outline
from sandbox.lab.fit.parsing import NAMES, Film, flattened, has_positions, measurements, unknown_columns
from sandbox.lab.fit.track import Track
from sandbox.lab.formats import Entry, device, in_table, recognized, stated, without
from sandbox.lab.table_file import Column, Table, read_table, split_unit
from sandbox.lab.where import Condition
from sandbox.physics.forces import Gravity
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
    where: tuple[Condition, ...] = ()  # only rows for which these hold
    without: tuple[str, ...] = ()  # columns of launches that are not used
    strict: bool = False  # refuse a row with a fault, which is otherwise left out


def data_of(scene: Scene, tables: Sequence[tuple[str, Table]], how: Reading) -> Measured:
    """The data of tables, each with the name of its ball. Raises RequestError."""
    if how.entries and all(entry.key in NAMES for entry in how.entries):
        tables = [(name, renamed(table, how.entries)) for name, table in tables]
        how = replace(how, entries=())
    else:
        _check_named(tables[0][1])
    first = tables[0][1]
    if not how.entries and all(has_positions(table) for _, table in tables):
        if how.where:
            raise RequestError("--where is for tables of launches")
        if how.without:
            raise RequestError("--without is for tables of launches")
        return _track(scene, tables, how)
    form = stated(how.entries, first, scene) if how.entries else recognized(first, scene)
    if form is None and (known := device(first)) is not None:
        about = f"looks like {known.title}, whose columns are known for {known.scene}"
        raise RequestError(f"{first.where}: {about}; for {scene.title} name them by --map")
    if form is None:
        _check_positions(first)
        try:
            measurements(tables, how.film)  # says which column is missing
        except RequestError as error:
            raise RequestError(f"{error}; a table of launches needs --map, see --formats") from None
        raise AssertionError("a table with x and y is a track")
    if len(tables) > 1 or how.free or how.film != Film():
        raise RequestError(
            f"{first.where}: is a table of launches; options for films and several tracks do not apply to it"
        )
    return launches(scene, first, without(form, how.without, first), how.where, how.strict)


def _track(scene: Scene, tables: Sequence[tuple[str, Table]], how: Reading) -> Track | Outline:
    """The points of tracks. Raises RequestError."""
    setup = scene.build()
    gravity = next((float(force.gravity) for force in setup.balls[0].forces if isinstance(force, Gravity)), 9.81)
    flat = [(name, *flattened(table, setup.plane is not None, gravity)) for name, table in tables]
    found = measurements([(name, table) for name, table, _ in flat], how.film, how.strict)
    places = found.positions, found.balls, found.rows, frame_of(scene, found, how.free), found.where
    about: Any = {
        "left_out": found.left_out,
        "unused": tuple(dict.fromkeys(name for _, table, _ in flat for name in unknown_columns(table))),
        "notes": tuple(dict.fromkeys(note for *_, note in flat if note)),
    }
    if found.t is None:
        return Outline(*places, LONGER * simulate(scene).duration, **about)
    return Track(*places, found.t, **about)


def _check_named(table: Table) -> None:
    """Raise RequestError for a table without names of its columns, with the names that three columns may have."""
    if not table.is_named:
        begins = shortened(", ".join(column.cells[0] for column in table.columns), 40)
        meant = ("t", "x", "y") if len(table.columns) > 2 else ("x", "y")[: len(table.columns)]
        maps = " ".join(f"--map {place}={name}" for place, name in enumerate(meant, start=1))
        raise RequestError(
            f"{table.where}: begins with numbers ({begins}); its first line must name the columns, or name them by "
            f"their places: {maps}"
        )


def _check_positions(table: Table) -> None:
    """Raise RequestError for a table that has accelerations in place of positions."""
    named = [one.name for one in table.columns if "accel" in one.name.lower() or one.unit == "m/s^2"]
    if named and not has_positions(table):
        raise RequestError(
            f"{table.where}: has accelerations ({shortened(', '.join(named), 60)}), but no positions: there is nothing "
            "to fit. Such a file tells when something was hit, by its peaks, but not where"
        )


def renamed(table: Table, entries: Sequence[Entry]) -> Table:
    """The table of a track with the names, and units, that entries such as ``Zeit=t ms`` give. Raises RequestError."""
    named = {entry.column.lower(): entry for entry in in_table(entries, table)}
    taken = {name for entry in named.values() for name in NAMES[entry.key]}
    columns = [
        replace(one, name=named[one.name.lower()].key, unit=named[one.name.lower()].unit or one.unit)
        if one.name.lower() in named
        else one
        for one in table.columns
        if one.name.lower() in named or one.name.lower() not in taken  # another "Y" is none any more
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
