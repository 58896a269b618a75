"""The data of a fit, from files or from columns in Python: a track, places without times, or a table of launches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.fit.bounces import BOUNCES, bounces_of, has_bounces, phyphox_events
from sandbox.lab.fit.frame import frame_of
from sandbox.lab.fit.launches import launches
from sandbox.lab.fit.measured import Measured
from sandbox.lab.fit.outline import Outline
from sandbox.lab.fit.parsing import (
    NAMES,
    Film,
    clock_of,
    flattened,
    has_positions,
    has_some_position,
    measurements,
    plain,
    unknown_columns,
)
from sandbox.lab.fit.track import Track
from sandbox.lab.formats import Source, advice, declared_units, in_table, recognized
from sandbox.lab.mapped import EVERYTHING, Choices, read_shots
from sandbox.lab.table_file import Column, Table, read_table, split_unit
from sandbox.physics.forces import Gravity
from sandbox.scene import Scene, simulate
from sandbox.text import shortened

#: A run of other values may take so many times as long as that of the scene.
LONGER = 2.0

#: What --map may name in a track, or in a table of bounces.
_KEYS = {*NAMES, *BOUNCES}


@dataclass(frozen=True)
class Reading:
    """The choices by which files are read."""

    film: Film = Film()
    free: tuple[str, ...] = ()  # of the film: origin, time, tilt
    choices: Choices = EVERYTHING  # of the columns and rows


def data_of(scene: Scene, tables: Sequence[tuple[str, Table]], how: Reading) -> Measured:
    """The data of tables, each with the name of its ball. Raises RequestError."""
    choices = how.choices
    notes: list[str] = []
    swapped = any(entry.text.partition(" ")[0] in declared_units(scene) for entry in choices.entries)
    if choices.entries and not swapped and all(entry.key in _KEYS for entry in choices.entries):
        tables = [(name, renamed(table, in_table(choices.entries, table))) for name, table in tables]
        choices = replace(choices, entries=())
    elif not choices.entries:
        tables = [(name, _with_names(table, notes)) for name, table in tables]
    first = tables[0][1]
    if not choices.entries and all(has_positions(table) for _, table in tables):
        for option, given in (("--where", choices.where), ("--without", choices.without)):
            if given:
                raise RequestError(f"{option} is for tables of launches")
        return _track(scene, tables, how, notes)
    if not choices.entries and len(tables) == 1 and (events := phyphox_events(first)) is not None:
        return bounces_of(scene, events, how.free or ("time",), choices.strict)
    if not choices.entries and len(tables) == 1 and has_bounces(first):
        return bounces_of(scene, first, how.free, choices.strict)
    if not choices.entries and recognized(first, scene) is None:
        _check_track(first, scene)
    if len(tables) > 1 or how.free or how.film != Film():
        raise RequestError(
            f"{first.where}: is a table of launches; options for films and several tracks do not apply to it"
        )
    return launches(scene, read_shots(scene, first, choices), choices.strict)


def _track(scene: Scene, tables: Sequence[tuple[str, Table]], how: Reading, notes: list[str]) -> Track | Outline:
    """The points of tracks. Raises RequestError."""
    setup = scene.build()
    gravity = next((float(force.gravity) for force in setup.balls[0].forces if isinstance(force, Gravity)), 9.81)
    flat = [(name, *flattened(table, setup.plane is not None, gravity)) for name, table in tables]
    found = measurements([(name, table) for name, table, _ in flat], how.film, how.choices.strict)
    if how.film.balls:
        found, others = found.of_balls({"", *(ball.name for ball in setup.balls)})
        notes += [f"balls that are not used: {', '.join(others)}"] if others else []
    places = (
        found.positions,
        found.balls,
        found.rows,
        frame_of(scene, found.where, found.t, found.positions, how.free),
        found.where,
    )
    about: Any = {
        "left_out": found.left_out,
        "unused": tuple(dict.fromkeys(name for _, table, _ in flat for name in unknown_columns(table))),
        "notes": tuple(dict.fromkeys([*notes, *(note for *_, note in flat if note)])),
    }
    if found.t is None:
        return Outline(*places, LONGER * simulate(scene).duration, **about)
    return Track(*places, found.t, **about)


def _with_names(table: Table, notes: list[str]) -> Table:
    """The table with names of its columns. Of three without a name the first is the time, if it always grows, and the
    others are x and y; notes say so. Raises RequestError for others without names."""
    if table.is_named:
        return table
    meant = ("t", "x", "y") if len(table.columns) > 2 else ("x", "y")[: len(table.columns)]
    maps = " ".join(f"--map {name}={place}" for place, name in enumerate(meant, start=1))
    faults = any(table.fault(column, row) for column in table.columns for row in range(len(table)))
    if len(table.columns) != 3 or faults or (np.diff(table.numbers(table.columns[0])) <= 0.0).any():
        begins = shortened(", ".join(column.cells[0] for column in table.columns), 40)
        raise RequestError(
            f"{table.where}: begins with numbers ({begins}); its first line must name the columns, or name them by "
            f"their places: {maps}"
        )
    notes.append(f"columns without names, taken as t in s, x and y in m; to choose others: {maps}")
    columns = (replace(column, name=name) for column, name in zip(table.columns, meant, strict=True))
    return replace(table, columns=tuple(columns), is_named=True)


def _check_track(table: Table, scene: Scene) -> None:
    """Raise RequestError for a table of a track, or of bounces, that lacks what one needs, such as one of
    accelerations."""
    if has_some_position(table) and not has_positions(table):
        measurements([("", table)], Film())  # says which column is missing
    named = [one.name for one in table.columns if "accel" in one.name.lower() or one.unit == "m/s^2"]
    if named and not has_positions(table):
        raise RequestError(
            f"{table.where}: has accelerations ({shortened(', '.join(named), 60)}), but no positions: there is nothing "
            "to fit. Its peaks tell when something was hit: write their times as a table with the columns bounce (1, "
            "2, ...) and t, and fit collisions/bouncing-ball to it with --vary floor.restitution --free time"
        )

    clock = clock_of(table)
    if clock is not None and not advice(table, scene):
        others = [one.name for one in table.columns if one is not clock]
        clocked = f'--map "t={clock.name}"'
        track = f'; for a track name them, {clocked} --map "x={others[0]}" --map "y={others[1]}"' if others[1:] else ""
        bounces = f'; for times of bounces {clocked} --map "bounce={others[0]}"' if others else ""
        raise RequestError(f"{table.where}: has times, but no columns x and y{track}{bounces}")


def renamed(table: Table, sources: Sequence[Source]) -> Table:
    """The table of a track with the names, and units, of sources such as ``t=Zeit [ms]``."""
    used = {name.lower() for source in sources for name in source.expression.columns}
    meant = {name for source in sources for name in NAMES.get(source.key, ())}  # another "Position Y" is none any more
    others = (one for one in table.columns if one.name.lower() not in used and plain(one.name) not in meant)
    return replace(table, columns=(*(_computed(table, source) for source in sources), *others), groups=())


def _computed(table: Table, source: Source) -> Column:
    """The column of a source: one of the table as it is, or arithmetic, with the first fault in place of a number, in
    the unit that its columns have in common."""
    columns = [table.column(name) for name in source.expression.columns]
    if source.column:
        return replace(columns[0], name=source.key, unit=source.unit or columns[0].unit)
    rows = range(len(table))
    faults = [next((one.cells[row] for one in columns if table.fault(one, row)), None) for row in rows]
    good = [row for row in rows if faults[row] is None]
    values = dict(zip(good, source.expression.values([table.numbers(one, good) for one in columns]), strict=True))
    cells = (repr(float(values[row])) if row in values else faults[row] or "" for row in rows)
    common = {one.unit for one in columns}
    return Column(source.key, source.unit or (common.pop() if len(common) == 1 else ""), tuple(cells))


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
