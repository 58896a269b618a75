"""A result as people and programs see it: a list of sections that every output walks.

Next to a result, a dataclass with its numbers, a function returns its ``Report``. From that come the text of the
terminal and JSON (here), a PNG (``chart.py``), and a notebook's output and a page (``sandbox/page/report.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sandbox.files import json_text
from sandbox.lab.tables import paragraph, table
from sandbox.sport.amounts import amount
from sandbox.sport.facts import Fact

#: Draws into axes of matplotlib, with the colours of assets/palette.toml.
Draw = Callable[[Any, Mapping[str, Any]], None]


@dataclass(frozen=True)
class Column:
    """A column of a table. Its words stand as they are; its numbers are written by ``write``, or as values of a
    ``fact``, or in a ``unit`` with so many ``digits`` after the point."""

    heading: str = ""
    unit: str = ""
    digits: int | None = None
    fact: Fact | None = None
    write: Callable[[Any], str] | None = None
    align: str = "r"  # or "l", for words

    def text(self, value: Any) -> str:
        """A value as text; "" for None."""
        if value is None or isinstance(value, str):
            return value or ""
        if self.write is not None:
            return self.write(value)
        return amount(value, self.unit, self.digits) if self.fact is None else self.fact.text(value)


def words(heading: str = "") -> Column:
    """A column of words."""
    return Column(heading, align="l")


@dataclass(frozen=True)
class Table:
    """Rows of values, each as long as ``columns``; without rows it is left out, with its notes.

    Text has the first ``most`` rows, and then says how many more there are; what is a ``detail`` is left out of a short
    text.
    """

    columns: Sequence[Column]
    rows: Sequence[Sequence[Any]]
    title: str = ""
    notes: Sequence[str] = ()
    most: int | None = None
    detail: bool = False

    @property
    def cells(self) -> list[list[str]]:
        """The texts of all rows."""
        return [[column.text(value) for column, value in zip(self.columns, row, strict=True)] for row in self.rows]


@dataclass(frozen=True)
class Notes:
    """Sentences, each a paragraph of its own."""

    notes: Sequence[str]
    title: str = ""
    detail: bool = False


@dataclass(frozen=True)
class Panel:
    """Axes with what is drawn into them; what has a label there is in the legend."""

    draw: Draw
    x: str = ""  # labels of the axes, with their units
    y: str = ""
    title: str = ""


@dataclass(frozen=True)
class Chart:
    """Panels in rows, as part of a picture; text has none."""

    panels: Sequence[Panel]
    title: str = ""
    about: str = ""  # below the title; lines
    across: int = 1  # panels next to each other; those below one another share an axis that only the last one names
    height: float = 5.0  # of a row of panels, in inches; the width is that of the picture
    note: str = ""  # how to read it, for those who see it on a page


Section = Table | Notes | Chart


@dataclass(frozen=True)
class Report:
    """A ``document`` for JSON, made on request: the result, or its numbers by key; and sections for people."""

    document: Callable[[], Any]
    title: str
    sections: Sequence[Section]
    more: str = ""  # what --all shows
    command: str = ""  # that makes this page

    def charts(self) -> list[Chart]:
        """The parts of its picture."""
        return [section for section in self.sections if isinstance(section, Chart)]


def as_json(report: Report) -> str:
    """One JSON value; NaN and infinities are null."""
    return json_text(report.document())


def as_text(report: Report, everything: bool = False) -> list[str]:
    """Lines for the terminal: the title, and the sections with an empty line between them; details only where
    ``everything`` is asked for."""
    lines = paragraph(report.title, "")
    for section in report.sections:
        if not isinstance(section, Chart) and (everything or not section.detail):
            own = list(_lines(section))
            lines += [*([""] if own else []), *own]
    return lines if everything or not report.more else [*lines, "", *paragraph(f"--all shows {report.more}")]


def _lines(section: Table | Notes) -> Iterator[str]:
    if isinstance(section, Table) and not section.rows:
        return
    yield from paragraph(section.title, "")
    if isinstance(section, Table):
        columns, cells = section.columns, section.cells[: section.most]
        yield from table([column.heading for column in columns], cells, "".join(column.align for column in columns))
        if len(cells) < len(section.rows):
            yield f"  ... {len(section.rows) - len(cells)} more; --json has them all"
    for note in section.notes:
        yield from paragraph(note)
