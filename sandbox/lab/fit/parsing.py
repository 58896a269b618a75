"""From a table to a measured track: times in s and positions in m, whatever they were written in."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import hypot

import numpy as np

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.selection import LeftOut, Selection
from sandbox.lab.table_file import PIXEL, Column, Table
from sandbox.text import shortened

#: The columns of a track, by how programs name them: lower case, without what stands between words.
NAMES = {
    "t": ("t", "time", "timestamp", "zeit", "temps", "tiempo"),
    "x": ("x", "positionx", "xposition", "xpos", "posx", "xcoordinate"),
    "y": ("y", "positiony", "yposition", "ypos", "posy", "ycoordinate"),
    "ball": ("ball",),
    "frame": ("frame", "framenumber"),
    "z": ("z", "positionz", "zposition", "zpos", "posz", "zcoordinate"),
}

#: A coordinate is that of a falling ball if its acceleration is that of gravity within this share; it is taken from
#: parabolas through this share of the points, at least so many.
_FALLS, _PART, _FEWEST = 0.4, 0.25, 5

#: ``120 px = 1 m``, ``1 m = 120 px`` or ``120 px/m``.
_SCALE = re.compile(rf"\s*({units.NUMBER})\s*(\w+)\s*=\s*({units.NUMBER})\s*(\w+)\s*")
_PER = re.compile(rf"\s*({units.NUMBER})\s*px\s*/\s*(\w+)\s*")


@dataclass(frozen=True)
class Film:
    """The scale, origin and frame rate of a film, which turn the numbers of a file into s and m."""

    scale: float | None = None  # m in one px
    origin: tuple[float, float] = (0.0, 0.0)  # of the scene, in the coordinates of the file
    rate: float | None = None  # frames per second, where frames are given in place of times
    balls: Mapping[str, str] = field(default_factory=dict)  # the scene's ball by the file's name; "" for every name


@dataclass(frozen=True)
class _Measurements:
    """Measured positions in the order of the files."""

    t: np.ndarray | None  # s, shape (points,); None for places without times
    positions: np.ndarray  # m, shape (points, 2): x, y
    balls: tuple[str, ...]  # the ball of each point; "" if none is named
    rows: np.ndarray  # the row of each point in its file, the first is 1; shape (points,)
    where: str  # the option and the file, as messages begin with them
    names: frozenset[str] = frozenset()  # of the balls in the file
    left_out: tuple[LeftOut, ...] = ()

    def __len__(self) -> int:
        return len(self.positions)

    def of_balls(self, names: Collection[str]) -> tuple[_Measurements, tuple[str, ...]]:
        """The points of these balls, and the names of the others; all, if none is of these."""
        others = tuple(dict.fromkeys(ball for ball in self.balls if ball not in names))
        kept = [ball in names for ball in self.balls]
        if not others or not any(kept):
            return self, ()
        t, balls = None if self.t is None else self.t[kept], tuple(ball for ball in self.balls if ball in names)
        return replace(self, t=t, positions=self.positions[kept], balls=balls, rows=self.rows[kept]), others


def parse_scale(text: str) -> float:
    """Metres in one pixel, of ``120 px = 1 m``. Raises RequestError."""
    wrong = RequestError(f'--scale {text}: write it as "120 px = 1 m"')
    per, both = _PER.fullmatch(text), _SCALE.fullmatch(text)
    if per is not None:
        pixels, length, unit = float(per[1]), 1.0, per[2]
    elif both is not None and PIXEL in (both[2], both[4]):
        pair = [(float(both[1]), both[2]), (float(both[3]), both[4])]
        (pixels, _), (length, unit) = sorted(pair, key=lambda one: one[1] != PIXEL)
    else:
        raise wrong
    if units.KIND_OF.get(unit) != "length":
        raise RequestError(f"--scale {text}: {unit} is no unit of length; use {units.listed('m')}")
    if pixels <= 0.0 or length <= 0.0:
        raise RequestError(f"--scale {text}: both numbers must be greater than 0")
    return units.convert(length, unit, "m") / pixels


def parse_pair(option: str, text: str) -> tuple[float, float]:
    """Two finite numbers, of ``X,Y``. Raises RequestError."""
    parts = text.split(",")
    try:
        x, y = (float(part) for part in parts)
        if not (np.isfinite(x) and np.isfinite(y)):
            raise ValueError
    except ValueError:
        raise RequestError(f"{option} {text}: write it as X,Y, for example {option} 212,655") from None
    return x, y


def parse_ball(text: str) -> tuple[str, str]:
    """``NAME`` or ``GIVEN=NAME``: the file's name of a ball, "" for all, and the scene's."""
    given, equals, name = (part.strip() for part in text.partition("="))
    return (given, name) if equals else ("", given)


def has_positions(table: Table) -> bool:
    """True if the table has columns x and y."""
    return bool(_places(table, "x") and _places(table, "y"))


def has_some_position(table: Table) -> bool:
    """True if the table has a column x or y."""
    return bool(_places(table, "x") or _places(table, "y"))


def measurements(tables: Sequence[tuple[str, Table]], film: Film, strict: bool = False) -> _Measurements:
    """The points of one table, or of several, each with the name of its ball. Raises RequestError; with ``strict`` also
    for a row with a fault."""
    several = len(tables) > 1
    parts = [part for name, table in tables for part in _of_table(table, film, name if several else "", strict)]
    found = {name for part in parts for name in part.names}
    unused = next((name for name in film.balls if name and name not in found), None)
    if unused is not None:
        raise RequestError(f"{tables[0][1].where}: has no ball {unused!r}; it has {', '.join(sorted(found))}")
    timed = [part.t is not None for part in parts]
    if any(timed) and not all(timed):
        raise RequestError(f"{tables[timed.index(False)][1].where}: has no times, but another track has")
    every = _Measurements(
        np.concatenate([part.t for part in parts if part.t is not None]) if all(timed) else None,
        np.concatenate([part.positions for part in parts]),
        tuple(ball for part in parts for ball in part.balls),
        np.concatenate([part.rows for part in parts]),
        tables[0][1].where,
        left_out=tuple(each for part in parts for each in part.left_out),
    )
    if not len(every):
        raise RequestError(f"{tables[0][1].where}: has no points")
    return every


def plain(name: str) -> str:
    """A name as in ``NAMES``: Vernier writes "Latest: Time (s)"."""
    return re.sub(r"[\s_.-]", "", name.lower().rpartition(": ")[2])


def _places(table: Table, what: str) -> list[int]:
    """The places of the columns for t, x, y, z, ball or frame; for a coordinate also those of lengths with that letter
    in their name, such as ``Ort x (m)``."""
    found = [place for place, name in enumerate(table.names) if plain(name) in NAMES[what]]
    if found or what not in "xyz":
        return found
    lengths = (place for place, one in enumerate(table.columns) if one.unit == PIXEL or _is_length(one.unit))
    return [place for place in lengths if what in re.split(r"[\W_]+", table.names[place].lower())]


def _is_length(unit: str) -> bool:
    return units.KIND_OF.get(unit) == "length"


def clock_of(table: Table) -> Column | None:
    """The column of times; None if there is none, or several."""
    places = _places(table, "t")
    return table.columns[places[0]] if len(places) == 1 else None


def unknown_columns(table: Table) -> tuple[str, ...]:
    """The names of columns with any content that a track does not use."""
    known = (place for what in ("t", "x", "y", "ball", "frame") for place in _places(table, what))
    return table.others({table.names[place].lower() for place in known})


def flattened(table: Table, above: bool, gravity: float) -> tuple[Table, str]:
    """A table of places in space as one of places in the plane of a scene, and a sentence on it; any other as it is.

    Seen from above z is left out. From the side the height is the coordinate that falls with about ``gravity`` in
    m/s^2, or else z; the distance is the one of the others that changes most.
    """
    places = {axis: _places(table, axis) for axis in "xyz"}
    if any(len(found) != 1 for found in places.values()):
        return table, ""
    x, y, z = (table.columns[found[0]] for found in places.values())
    rows = [row for row in range(len(table)) if not any(table.fault(column, row) for column in (x, y, z))]
    spans = {column.name: float(np.ptp(table.numbers(column, rows))) if rows else 0.0 for column in (x, y, z)}
    if above:
        up, along, side = y, x, z
    else:
        falls = [_falls(table, column, rows, gravity) for column in (y, z)]
        up, level = (y, z) if falls == [True, False] else (z, y)
        along, side = (x, level) if spans[x.name] >= spans[level.name] else (level, x)
    longer = 100.0 * (hypot(1.0, spans[side.name] / spans[along.name]) - 1.0) if spans[along.name] else 0.0
    costs = f", which makes the distance {longer:.2g} % longer" if longer >= 0.05 and not above else ""
    unit = f" {side.unit or 'm'}"
    said = f"{along.name} is taken as x and {up.name} as y{'' if above else ', the height'}; {side.name} is not used: "
    kept = [
        replace(column, name="x" if column is along else "y" if column is up else column.name)
        for column in table.columns
        if column is not side
    ]
    named = f'; to choose others: --map "x={along.name}" --map "y={up.name}"'
    return replace(table, columns=tuple(kept)), f"{said}it spans {spans[side.name]:.3g}{unit}{costs}{named}"


def _falls(table: Table, column: Column, rows: Sequence[int], gravity: float) -> bool:
    """True if a coordinate has about the acceleration of gravity, at the median of parabolas through the points."""
    clock = _places(table, "t")
    timed = [row for row in rows if clock and not table.fault(table.columns[clock[0]], row)]
    count = max(_FEWEST, int(_PART * len(timed)))
    if len(timed) < count:
        return False
    t = table.numbers(table.columns[clock[0]], timed) * _factor(table, table.columns[clock[0]], "s")
    u = table.numbers(column, timed) * (1.0 if column.unit == PIXEL else _factor(table, column, "m"))
    fits = [np.polyfit(t[at : at + count] - t[at], u[at : at + count], 2)[0] for at in range(len(t) - count + 1)]
    return abs(2.0 * float(np.median(fits)) + gravity) < _FALLS * gravity


def _of_table(table: Table, film: Film, name: str, strict: bool) -> Iterable[_Measurements]:
    """The points of each ball of a table; Tracker writes several side by side, under their names."""
    xs, ys = (_places(table, what) for what in "xy")
    if len(xs) > 1 and len(xs) == len(ys) and table.groups:
        for x, y in zip(xs, ys, strict=True):
            yield _of_ball(table, film, x, y, table.groups[x], strict)
        return
    for what, places in (("x", xs), ("y", ys)):
        if len(places) != 1:
            found = shortened(", ".join(table.names), 60)
            clock, hint = clock_of(table), ""
            if not xs and len(ys) == 1 and clock is not None:
                height = table.names[ys[0]]
                hint = f'; for a fall straight down --map "x=0*{height}" --map "y={height}" --map "t={clock.name}"'
            raise RequestError(f"{table.where}: needs one column {what} in its first line, which has: {found}{hint}")
    yield _of_ball(table, film, xs[0], ys[0], name, strict)


def _of_ball(table: Table, film: Film, x: int, y: int, name: str, strict: bool) -> _Measurements:
    columns = table.columns[x], table.columns[y]
    selection = Selection(table, strict)
    # a program leaves a frame without a mark empty
    selection.only(row for row in selection.rows if any(column.cells[row].strip() for column in columns))
    selection.need_numbers([*columns, *_clock(table, film)])
    rows = selection.rows
    if selection.left_out:
        selection.check_some()
    factor = _metres(table, columns, film)
    positions = np.column_stack([table.numbers(column, rows) for column in columns]) - film.origin
    positions = positions * (factor if film.scale is None else (factor, -factor))  # y is downwards in a picture
    named = _places(table, "ball")
    given = [table.columns[named[0]].cells[row].strip() if named else name for row in rows]
    balls = [film.balls.get(one, film.balls.get("", one)) for one in given]
    times = _times(table, film, rows, balls)
    numbers, names = np.array(rows, dtype=int) + 1, frozenset(given)
    return _Measurements(times, positions, tuple(balls), numbers, table.where, names, selection.left_out)


def _clock(table: Table, film: Film) -> list[Column]:
    """The column of times, or of frames where their rate is known; none without one."""
    places = _places(table, "t" if film.rate is None else "frame")
    return [table.columns[places[0]]] if len(places) == 1 else []


def _metres(table: Table, columns: tuple[Column, Column], film: Film) -> float:
    """The metres in one unit of a position. Raises RequestError for units that do not go together."""
    x, y = columns
    if x.unit != y.unit:
        said = [f"{one.name} is in {one.unit}" if one.unit else f"{one.name} has no unit" for one in columns]
        raise RequestError(f"{table.where}: units are mixed: {said[0]}, but {said[1]}")
    if film.scale is not None:
        if x.unit not in ("", PIXEL):
            raise RequestError(f"{table.where}: units are mixed: x is in {x.unit}, but --scale is for pixels")
        return film.scale
    if x.unit == PIXEL:
        rate = _places(table, "frame") and not _places(table, "t") and film.rate is None
        more = ", and the frames per second, such as --fps 240" if rate else ""
        raise RequestError(f'{table.where}: x and y are in px; give --scale, such as --scale "120 px = 1 m"{more}')
    return _factor(table, x, "m")


def _times(table: Table, film: Film, rows: Sequence[int], balls: Sequence[str]) -> np.ndarray | None:
    """The times in s, checked to be in order; None if there are none. Raises RequestError."""
    t, frame = _places(table, "t"), _places(table, "frame")
    if len(t) > 1:
        raise RequestError(f"{table.where}: has {len(t)} columns of times")
    if t and film.rate is None:
        column = table.columns[t[0]]
        times = table.numbers(column, rows) * _factor(table, column, "s")
    elif frame and film.rate is not None:
        times = table.numbers(table.columns[frame[0]], rows) / film.rate
    elif film.rate is not None:
        raise RequestError(f"{table.where}: has no column frame, which --fps is for")
    elif frame:
        raise RequestError(f"{table.where}: has frames, but no times; give the frames per second, such as --fps 240")
    else:
        return None
    latest: dict[str, float] = {}
    for row, time, ball in zip(rows, times.tolist(), balls, strict=True):
        if time < latest.get(ball, time):
            raise RequestError(
                f"{table.where}: row {row + 1}, t = {time:g} s is before {latest[ball]:g} s in the row above"
            )
        latest[ball] = time
    return times


def _factor(table: Table, column: Column, unit: str) -> float:
    """The factor from the numbers of a column to this SI unit. Raises RequestError."""
    if not column.unit:
        return 1.0
    try:
        return units.convert(1.0, column.unit, unit)
    except ValueError as error:
        raise RequestError(f"{table.where}: {column.name} is in {column.unit}: {error}") from None
