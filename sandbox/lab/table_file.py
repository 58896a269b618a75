"""Reading a table that another program wrote: columns with names and units, whatever it separates them with.

Tabs, semicolons, commas or spaces; decimal commas; a title above the names, as Tracker writes it; units in the names,
as ``x (cm)``, ``t [ms]`` and ``x/cm``, or in a row of their own, as launch monitors write them; ``sep=;`` as Excel
does; JSON, as GSPro's Open Connect sends it.
"""

from __future__ import annotations

import csv
import json
import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from sandbox import units
from sandbox.errors import RequestError
from sandbox.files import is_given, read_given
from sandbox.text import one_line, shortened

#: Most bytes of a table, and most rows.
LARGEST, _MOST_ROWS = 50_000_000, 100_000

#: Lines at the beginning in which the names of the columns are looked for.
_HEAD = 30

#: As much of a first line is looked at, in characters.
_LONGEST_LINE = 100_000

#: A control character that no text has.
_BINARY = re.compile(r"[\x00-\x08\x0e-\x1a\x1c-\x1f]")

#: A name with its unit: ``x (cm)``, ``x[cm]``, ``x / cm``, ``x in cm``; and a unit alone in its row: ``[mph]``.
_WITH_UNIT = re.compile(r"(.+?)\s*(?:\(([^()]*)\)|\[([^\[\]]*)\])\s*|(.+?)(?:\s*/\s*|\s+in\s+)(\S+)\s*")
_UNIT_CELL = re.compile(r"(?:\[[^\]]*\]|\([^)]*\))?")

_NUMBER = re.compile(rf"\s*{units.NUMBER}\s*")
_THOUSANDS = re.compile(r"\s*[+-]?\d{1,3}(,\d{3})+(\.\d*)?\s*")
#: ``12.4 R``, ``R12.4``: to the left is negative.
_SIDE = re.compile(r"([+-]?[\d.,]+)\s*([LRlr])|([LRlr])\s*([\d.,]+)")
#: ``0:00:01:04`` and ``1:02.25``: hours, minutes, seconds and decimals, as on the clock of a film.
_CLOCK = re.compile(r"(?:(\d+):)??(?:(\d+):)(\d{1,2})(?:[:.,](\d{1,3}))?")
_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*")

#: Units as devices spell them, in other languages too.
_SPELLED = {"°": "deg", "º": "deg", "yds": "yd", "g/L": "kg/m^3", "ms^-1": "m/s", "km/u": "km/h"}

#: The unit of positions in a picture. It is no unit of ``sandbox.units``, since it stands for no length.
PIXEL = "px"


@dataclass(frozen=True)
class Column:
    """One column: its name, its unit as ``sandbox.units`` writes it ("" if none is given), and its cells."""

    name: str
    unit: str
    cells: tuple[str, ...]


@dataclass(frozen=True)
class Table:
    """The columns of a file; names may occur twice, as those of several tracks do."""

    where: str  # the option and the file, as messages begin with them
    columns: tuple[Column, ...]
    groups: tuple[str, ...] = ()  # a heading above each column, such as the track's name; empty if there are none
    comma: bool = False  # numbers have a decimal comma
    broken: Mapping[int, str] = field(default_factory=dict)  # rows with other than one value per column, and why
    is_named: bool = True  # False if its first line has numbers: columns are then named by their places, from 1

    def __len__(self) -> int:
        return len(self.columns[0].cells)

    @property
    def names(self) -> list[str]:
        return [column.name for column in self.columns]

    def column(self, name: str) -> Column:
        """The first column of this name, whatever its case."""
        return next(column for column in self.columns if column.name.lower() == name.lower())

    def others(self, taken: Collection[str]) -> tuple[str, ...]:
        """The names of columns with any content that are not among those taken, which are in lower case."""
        some = (column for column in self.columns if any(cell.strip() for cell in column.cells))
        return tuple(column.name for column in some if column.name.lower() not in taken)

    def number(self, column: Column, row: int) -> float:
        """The number in a row, the first is 0. Raises RequestError for what is none, and for NaN and infinities."""
        fault = self.fault(column, row)
        if fault:
            raise RequestError(f"{self.where}: row {row + 1}, {fault}")
        return self._parsed(column.cells[row].strip())

    def fault(self, column: Column, row: int) -> str:
        """The reason why a cell is no finite number; "" if it is one."""
        text = column.cells[row].strip()
        try:
            return "" if isfinite(self._parsed(text)) else f"{column.name} = {text} is not finite"
        except ValueError:
            what = "is empty" if not text else f"= {shortened(text, 40)!r} is not a number"
            return f"{column.name} {what}"

    def _parsed(self, text: str) -> float:
        side = _SIDE.fullmatch(text)
        if side is not None:
            return (-1.0 if (side[2] or side[3]) in "Ll" else 1.0) * self._parsed(side[1] or side[4])
        clock = _CLOCK.fullmatch(text) if ":" in text else None
        if clock is not None:
            hours, minutes, seconds = (int(part or 0) for part in clock.groups()[:3])
            return 3600.0 * hours + 60.0 * minutes + float(f"{seconds}.{clock[4] or 0}")
        thousands = not self.comma and _THOUSANDS.fullmatch(text)
        return float(text.replace(",", "") if thousands else text.replace(",", ".") if self.comma else text)

    def numbers(self, column: Column, rows: Sequence[int] | None = None) -> np.ndarray:
        """The numbers of a column, or of some rows of it. Raises RequestError."""
        return np.array([self.number(column, row) for row in (range(len(self)) if rows is None else rows)], dtype=float)


def read_table(option: str, path: Path) -> Table:
    """Read a table from a text file. Raises RequestError with one line that names the file."""
    where = f"{option} {path}".strip()
    try:
        text = _decoded(where, read_given(path, LARGEST))
    except RequestError as error:
        raise RequestError(f"{option} {error}") if not str(error).startswith(where) else error from None
    if not text.strip():
        raise RequestError(f"{where}: is empty")
    if text.lstrip()[0] == "<":
        raise RequestError(f"{where}: is no table but XML or HTML; in Tracker it is File, Export, Data File")
    if text.lstrip()[0] in "{[":
        return _of_json(where, text)
    rows, separator = _rows(where, text)
    return _of_rows(where, rows, separator)


def first_cells(path: Path) -> list[str] | None:
    """The cells of a file's first line, as far as it is read; None for what cannot be, such as a pipe."""
    try:
        is_given(path)
        with path.open(encoding="utf-8-sig", errors="replace", newline="") as file:
            return [cell.strip() for cell in next(csv.reader([file.readline(_LONGEST_LINE)]), [])]
    except (RequestError, OSError, csv.Error):
        return None


def _decoded(where: str, data: bytes) -> str:
    """The text of a file in UTF-8, UTF-16 with its mark, or, as older programs write, Windows-1252."""
    encodings = ("utf-16",) if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "cp1252")
    for encoding in encodings:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if not _BINARY.search(text):
            return text
    raise RequestError(f"{where}: is no table but a binary file; save it as CSV or text")


def _rows(where: str, text: str) -> tuple[list[list[str]], str]:
    """The cells of all lines that have any, and what separates them."""
    lines = text.splitlines()
    given = re.fullmatch(r"sep=(.)", lines[0].strip()) if lines else None
    lines = lines[1:] if given else lines
    separator = given[1] if given else _separator(lines)
    if separator == " ":
        rows = [line.split() for line in lines]
    else:
        try:
            rows = list(csv.reader(lines, delimiter=separator, strict=True))
        except csv.Error:
            raise RequestError(f"{where}: is no table: a quote in it is not closed, or a cell is too long") from None
    rows = [[cell.strip() for cell in row] for row in rows]
    return [row for row in rows if any(row)], separator


def _separator(lines: Sequence[str]) -> str:
    """The one of tab, semicolon, comma and space that most lines have; the first of these if two are alike."""
    seen = [line for line in lines[: 4 * _HEAD] if line.strip()]
    best, most = " ", 0
    for candidate in "\t;,":
        count = sum(candidate in line.strip() for line in seen)
        if count > most:
            best, most = candidate, count
    return best if 2 * most >= len(seen) else " "


def is_number(cell: str) -> bool:
    """True for a number with a decimal point or comma, or with thousands separated."""
    return any(form.fullmatch(cell) for form in (_NUMBER, _COMMA, _THOUSANDS)) or cell.strip().lower() == "nan"


def _is_data(row: Sequence[str]) -> bool:
    """True for a row of numbers, perhaps with a word or some empty cells among them."""
    filled = [cell for cell in row if cell]
    numbers = sum(map(is_number, filled))
    return numbers >= 2 or (numbers == len(filled) > 0)


def _of_rows(where: str, rows: list[list[str]], separator: str) -> Table:
    """The table: of the lines before the first line of numbers the longest has the names."""
    first = next((place for place, row in enumerate(rows[:_HEAD]) if _is_data(row)), None)
    if first == 0:  # no names: those of the places, for a --map to give others
        rows, first = [[str(place) for place in range(1, len(_without_tail(rows[0])) + 1)], *rows], 1
        is_named = False
    else:
        is_named = True
    head, data = (rows[:1], rows[1:]) if first is None else (rows[:first], rows[first:])
    data = [row for row in data if not row[0].startswith("#")]
    head = [[row[0].removeprefix("#").strip(), *row[1:]] for row in head]
    given = head.pop() if len(head) > 1 and _are_units(head[-1]) else []
    place = _place_of_names(head, data, separator)
    names = _without_tail(head[place])
    if len(names) < 2 and is_named:
        found = shortened(one_line(" ".join(names)), 50)
        raise RequestError(f"{where}: is no table: it has no line that names columns, but begins with {found!r}")
    above = head[place - 1] if place and len(head[place - 1]) > 1 else []
    groups = tuple(_spread(above, len(names))) if above else ()
    data = [row for row in head[place + 1 :] if any(row)] + data
    # a last column without a name, if the head has a cell for it: more would be decimal commas between commas
    names += [""] * (min(_usual_width(data), max(map(len, [*head, given]))) - len(names))
    names = [name or f"column {number}" for number, name in enumerate(names, start=1)]
    cells, broken = [(*row, *[""] * len(names))[: len(names)] for row in data], _broken(data, len(names))
    if 2 * len(broken) > len(data):
        number, why = next(iter(broken.items()))
        raise RequestError(f"{where}: row {number + 1} {why}")
    if len(cells) > _MOST_ROWS:
        raise RequestError(f"{where}: has {len(cells):,} rows; a table has at most {_MOST_ROWS:,}")
    columns = []
    for place, name in enumerate(names):
        plain, unit = split_unit(name)
        own = given[place].strip("[]() ") if place < len(given) else ""
        columns.append(Column(plain, _known_unit(own) if own else unit, tuple(row[place] for row in cells)))
    comma = separator != "," or _has_decimal_comma(cells)
    return Table(where, tuple(columns), groups, comma, broken, is_named)


def _place_of_names(head: Sequence[Sequence[str]], data: Sequence[Sequence[str]], separator: str) -> int:
    """The place of the line with the names of columns: the first of the longest; where blanks separate, a title has as
    many as it has words, and the last that is as long as most rows comes before it."""
    width = _usual_width(data) if separator == " " else 0
    fitting = [place for place in range(len(head)) if len(_without_tail(head[place])) == width]
    return fitting[-1] if fitting else max(range(len(head)), key=lambda place: sum(map(bool, head[place])))


def _are_units(row: Sequence[str]) -> bool:
    """True for a row of units such as ``[mph]`` or ``m``, some empty, and perhaps with one title among them."""
    filled = [cell for cell in row if cell]
    units_in = sum(_UNIT_CELL.fullmatch(cell) is not None or bool(units.suggestion(cell)) for cell in filled)
    return units_in >= max(len(filled) - 1, 1) and (units_in == len(filled) or units_in > 1)


def _has_decimal_comma(cells: Sequence[Sequence[str]]) -> bool:
    """True if commas in quoted cells cannot be those of thousands."""
    return any(_COMMA.fullmatch(cell) and not _THOUSANDS.fullmatch(cell) for row in cells for cell in row)


def _without_tail(row: Sequence[str]) -> list[str]:
    """The row without empty cells at its end."""
    count = max((place for place, cell in enumerate(row, start=1) if cell), default=0)
    return list(row[:count])


def _usual_width(rows: Sequence[Sequence[str]]) -> int:
    """The number of cells that most rows have, without empty ones at their ends; 0 if none is that common."""
    widths = Counter(len(_without_tail(row)) for row in rows)
    width, count = max(widths.items(), key=lambda item: item[1], default=(0, 0))
    return width if 2 * count > len(rows) else 0


def _broken(rows: Sequence[Sequence[str]], count: int) -> dict[int, str]:
    """The places of rows that do not have a cell for each column, and why: empty ones at their ends do not count."""
    filled = {place: len(_without_tail(row)) for place, row in enumerate(rows)}
    return {
        place: f"has {width} values, but there are {count} columns"
        for place, width in filled.items()
        if width > count or (len(rows[place]) < count and width < count)
    }


def _spread(row: Sequence[str], count: int) -> Iterator[str]:
    """Headings that stand over the first of their columns, for each column."""
    last = ""
    for place in range(count):
        last = (row[place] if place < len(row) else "") or last
        yield last


def split_unit(name: str) -> tuple[str, str]:
    """Name and unit of a heading: ``"x (cm)"`` is ``("x", "cm")``; "" where it has none."""
    found = _WITH_UNIT.fullmatch(name)
    if found is None:
        return name, ""
    if found[1]:
        return found[1].strip(), _known_unit(found[2] or found[3] or "")
    unit = _known_unit(found[5])
    return (found[4].strip(), unit) if unit in units.KIND_OF or unit == PIXEL else (name, "")


def _known_unit(text: str) -> str:
    """A unit as ``sandbox.units`` writes it, if it is another spelling of one; else as it is."""
    plain = text.strip()
    if plain.lower() in ("px", "pixel", "pixels", "pix"):
        return PIXEL
    plain = _SPELLED.get(plain, plain)
    spelled = plain.replace("²", "^2").replace("³", "^3")
    return units.suggestion(spelled) or units.suggestion(spelled.partition(" ")[0]) or plain  # "rpm l-/r+"


def _of_json(where: str, text: str) -> Table:
    """A table of JSON: a list of objects, one object for each line, or an object with such a list in it; a value inside
    an object has its keys joined by dots as its name, as in ``BallData.Speed``. Or of an object with a list for each
    column."""
    try:
        try:
            found = json.loads(text)
        except json.JSONDecodeError:
            found = [json.loads(line) for line in text.splitlines() if line.strip()]
    except (ValueError, RecursionError):
        raise RequestError(
            f"{where}: is neither a table nor JSON: it begins with {shortened(text.strip(), 20)!r}"
        ) from None
    if isinstance(found, Mapping):
        lists = [value for value in found.values() if isinstance(value, list) and value]
        if len(lists) == len(found) > 1 and len(set(map(len, lists))) == 1:  # a list for each column
            found = [dict(zip(found, row, strict=True)) for row in zip(*lists, strict=True)]
        else:
            found = lists[0] if len(lists) == 1 and all(isinstance(item, Mapping) for item in lists[0]) else [found]
    if not found or not all(isinstance(item, Mapping) for item in found):
        raise RequestError(f"{where}: is JSON, but no list of objects with a value for each column")
    rows = [dict(_flat("", item)) for item in found]
    names = list(dict.fromkeys(name for row in rows for name in row))
    if not names:
        raise RequestError(f"{where}: is JSON without any values")
    return Table(where, tuple(Column(*split_unit(name), tuple(row.get(name, "") for row in rows)) for name in names))


def _flat(prefix: str, item: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for key, value in item.items():
        if isinstance(value, Mapping):
            yield from _flat(f"{prefix}{key}.", value)
        elif not isinstance(value, list):
            yield f"{prefix}{key}", "" if value is None else str(value)
