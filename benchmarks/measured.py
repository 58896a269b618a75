"""Parts that the benchmarks share: their command line, a clock, and how numbers are shown and kept."""

from __future__ import annotations

import json
import sys
from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from string import Formatter
from time import thread_time
from typing import Any, TypeVar

from sandbox.lab.tables import table

Done = TypeVar("Done")


def command_line(about: str | None, repeats: int = 1, options: Mapping[str, Mapping[str, Any]] = {}) -> Namespace:
    """The command line: ``--json``, ``--repeats`` and ``--quick``, which repeats nothing, besides other ``options``."""
    parser = ArgumentParser(description=about, formatter_class=RawDescriptionHelpFormatter)
    parser.add_argument("--json", type=Path, metavar="F", help="write the numbers here")
    parser.add_argument("--repeats", type=int, default=repeats)
    parser.add_argument("--quick", action="store_true", help="the smallest settings, once, as a test")
    for option, how in options.items():
        parser.add_argument(option, **how)
    found = parser.parse_args()
    if found.quick:
        found.repeats = 1
    return found


def timed(work: Callable[..., Done], *given: Any, clock: Callable[[], float] = thread_time) -> tuple[float, Done]:
    """Seconds, of processor time unless by another ``clock``, and the result."""
    started = clock()
    done = work(*given)
    return clock() - started, done


def say(*lines: str) -> None:
    sys.stdout.write("".join(f"{line}\n" for line in lines))
    sys.stdout.flush()


def show(title: str, rows: Iterable[Mapping[str, Any]], columns: Mapping[str, str]) -> None:
    """A table below its title. Each column has a format for a row, such as ``"{error_m:.1e} m"``, or ``"{method}"`` for
    a text; what a row lacks stays empty."""
    align = "".join("r" if ":" in form else "l" for form in columns.values())
    say("", title, *table(list(columns), [[_cell(row, form) for form in columns.values()] for row in rows], align))


def keep(where: Path | None, found: Any) -> None:
    """Write the numbers as JSON."""
    if where is not None:
        where.write_text(json.dumps(found, indent=1))


class _Cell(Formatter):
    """Numbers for people: ``.1f ms`` of a time in s; ``short`` for two digits, or an integer."""

    def format_field(self, value: Any, how: str) -> str:
        if how == "short":
            return f"{value:,.0f}" if value >= 9.95 else f"{value:.1f}"
        number, _, unit = how.partition(" ")
        return f"{1e3 * value:{number}} ms" if unit == "ms" else format(value, how)


def _cell(row: Mapping[str, Any], form: str) -> str:
    lacks = any(row.get(name) is None for _, name, _, _ in _CELL.parse(form) if name)
    return "" if lacks else _CELL.vformat(form, (), row)


_CELL = _Cell()
