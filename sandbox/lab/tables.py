"""Tables and numbers as readable text."""

from __future__ import annotations

import io
import shutil
import textwrap
from collections.abc import Iterable, Sequence
from typing import Literal

from sandbox.sport.amounts import significant
from sandbox.text import one_line

#: Words up to this length are never wrapped.
_SHORT = 8

#: Units of length, with the length in m from which each is used.
_LENGTHS = (
    (1e3, "km", 1e-3),
    (1.0, "m", 1.0),
    (1e-2, "cm", 1e2),
    (1e-3, "mm", 1e3),
    (1e-6, "µm", 1e6),
    (0.0, "nm", 1e9),
)
_TIMES = ((60.0, "min", 1 / 60), (1.0, "s", 1.0), (1e-3, "ms", 1e3), (0.0, "µs", 1e6))


def width() -> int:
    """Maximum characters in a line: those of the terminal, or 80 if there is none."""
    return shutil.get_terminal_size((80, 24)).columns


def table(headings: Sequence[str], rows: Iterable[Sequence[str]], align: str, indent: str = "  ") -> list[str]:
    """Lines with columns aligned by ``align``, a letter for each: l or r. Headings and left-aligned cells are wrapped
    between words so that lines fit ``width``, right-aligned numbers never; empty headings give no heading line."""
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    cells = [[one_line(cell) for cell in row] for row in rows]
    widths = _widths(headings, cells, align, width() - len(indent))
    drawn = Table(box=None, padding=(0, 2, 0, 0), pad_edge=False, show_header=any(headings), header_style="")
    for heading, side, columns in zip(headings, align, widths, strict=True):
        justify: Literal["left", "right"] = "left" if side == "l" else "right"
        drawn.add_column(Text(heading), justify=justify, width=columns, vertical="top", overflow="fold")
    for row in cells:
        drawn.add_row(*map(Text, row))
    whole = len(indent) + sum(widths) + 2 * len(widths)
    console = Console(file=io.StringIO(), width=whole, color_system=None, legacy_windows=False)
    with console.capture() as captured:
        console.print(Padding(drawn, (0, 0, 0, len(indent)), expand=False))
    return [line.rstrip() for line in captured.get().splitlines()]


def _widths(headings: Sequence[str], rows: Sequence[Sequence[str]], align: str, room: int) -> list[int]:
    """The width of each column in characters: its content's, or less if all columns do not fit into ``room``; words,
    and above all numbers, are kept whole if possible."""
    widths, words, shortest = [], [], []
    for column, (heading, side) in enumerate(zip(headings, align, strict=True)):
        texts = [row[column] for row in rows]
        numbers = texts if side == "r" else []
        widths.append(max(map(len, [heading, *texts])))
        words.append(max(map(len, [*heading.split(), *(word for text in texts for word in text.split())]), default=0))
        shortest.append(max(map(len, numbers), default=min(words[-1], _SHORT)))
    for least in ([max(pair) for pair in zip(words, shortest, strict=True)], shortest):
        while sum(widths) + 2 * (len(widths) - 1) > room:
            excess = [has - needs for has, needs in zip(widths, least, strict=True)]
            if max(excess) <= 0:
                break
            widest = max((number for number in range(len(widths)) if excess[number] > 0), key=widths.__getitem__)
            widths[widest] -= 1
    return widths


def paragraph(text: str, indent: str = "  ") -> list[str]:
    """A text wrapped to ``width``; lines after the first are indented by two more."""
    return textwrap.wrap(
        one_line(text), width(), initial_indent=indent, subsequent_indent=indent + "  ", break_on_hyphens=False
    )


#: Lengths below this, in m, are rounding.
_ROUNDING = 1e-12


def length(metres: float | None) -> str:
    """``0.0032`` as ``3.2 mm``; less than rounding is 0."""
    return _scaled(0.0 if metres is not None and abs(metres) < _ROUNDING else metres, _LENGTHS)


def length_above(metres: float | None, least: float) -> str:
    """The same, but less than ``least`` (m), the resolution, as ``< 3.2 mm``."""
    if metres is None or metres >= least or least <= _ROUNDING:
        return length(metres)
    return f"< {length(least)}"


def time(seconds: float | None) -> str:
    """``0.0032`` as ``3.2 ms``."""
    return _scaled(seconds, _TIMES)


def percent(share: float) -> str:
    """``0.0032`` as ``0.3 %``; less than rounding is "none"."""
    return "none" if share < 1e-12 else f"{significant(100.0 * share, 1)} %"


def _scaled(value: float | None, units: Sequence[tuple[float, str, float]]) -> str:
    if value is None:
        return ""
    if value == 0.0:
        return f"0 {units[-1][1]}"
    for begins, unit, factor in units:
        if abs(value) >= begins:
            return f"{significant(value * factor)} {unit}"
    raise AssertionError("the smallest unit starts at 0")
