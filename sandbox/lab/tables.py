"""Tables and numbers as readable text."""

from __future__ import annotations

import io
import shutil
import textwrap
from collections.abc import Iterable, Sequence
from itertools import compress
from typing import Literal

from sandbox.sport.amounts import significant
from sandbox.text import one_line

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
    """Lines with columns aligned by ``align``, a letter for each: l or r.

    Headings and left-aligned cells are wrapped between words so that lines fit ``width``; right-aligned numbers never,
    even if lines are longer then. Empty headings give no heading line; a column without any text is left out.
    """
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    cells = [[one_line(cell) for cell in row] for row in rows]
    drawn = Table(box=None, padding=(0, 2, 0, 0), pad_edge=False, show_header=any(headings), header_style="")
    used = [any(column) for column in zip(headings, *cells, strict=True)]
    columns = list(compress(zip(headings, align, *cells, strict=True), used))
    widest = [max(map(len, (heading, *column))) for heading, _, *column in columns]
    is_wide = len(indent) + sum(widest) + 2 * len(columns) - 2 > width()
    least = len(indent)
    for heading, side, *column in columns:
        justify: Literal["left", "right"] = "left" if side == "l" else "right"
        if side == "r":
            whole = max(map(len, (*column, *heading.split())), default=0)
            heading = "\n".join(textwrap.wrap(heading, whole)) if is_wide and heading else heading
            least += 2 + whole
        drawn.add_column(Text(heading), justify=justify, no_wrap=side == "r", overflow="fold")
    for row in cells:
        drawn.add_row(*map(Text, compress(row, used)))
    console = Console(file=io.StringIO(), width=max(width(), least), color_system=None, legacy_windows=False)
    with console.capture() as captured:
        console.print(Padding(drawn, (0, 0, 0, len(indent)), expand=False))
    return [line.rstrip() for line in captured.get().splitlines()]


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
