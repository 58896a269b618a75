"""The rows of a table that are used, and those that are left out, each with its reason."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from sandbox.errors import RequestError
from sandbox.lab.table_file import Column, Table
from sandbox.text import with_noun

#: Most reasons that a report lists, and most rows of each.
_REASONS, _ROWS = 6, 8


@dataclass(frozen=True)
class LeftOut:
    """A row that is not used, and why."""

    row: int  # of the file, the first is 1
    why: str


class Selection:
    """The rows of a table that are used, by their places; a fault in one is its reason to be left out, or with
    ``strict`` a RequestError."""

    def __init__(self, table: Table, strict: bool = False) -> None:
        self.table, self.strict = table, strict
        self.rows = list(range(len(table)))
        self._left_out: dict[int, str] = {}
        for row, why in table.broken.items():
            self.leave_out(row, why)

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """The rows that are left out, in the order of the file."""
        return tuple(LeftOut(row + 1, why) for row, why in sorted(self._left_out.items()))

    def only(self, rows: Iterable[int]) -> None:
        """Use only these rows; the others are not the question, and have no reason."""
        kept = set(rows)
        self.rows = [row for row in self.rows if row in kept]

    def leave_out(self, row: int, why: str, fault: bool = True) -> None:
        """Leave out a row. Raises RequestError if it is a ``fault`` and faults are refused."""
        if fault and self.strict:
            raise RequestError(f"{self.table.where}: row {row + 1}, {why}")
        self._left_out[row] = why
        self.rows.remove(row)

    def need_numbers(self, columns: Sequence[Column], rows: Sequence[int] | None = None) -> None:
        """Leave out rows, all or of some, without a number in one of these columns."""
        for row in list(self.rows if rows is None else rows):
            fault = next((why for column in columns if (why := self.table.fault(column, row))), "")
            if fault:
                self.leave_out(row, fault)

    def check_some(self) -> None:
        """Raise RequestError with the first reasons if no row is left."""
        if not self.rows:
            raise RequestError(f"{self.table.where}: no row can be used: {reasons(self.left_out)}")


def reasons(left_out: Sequence[LeftOut]) -> str:
    """``row 41, Spin Rate is empty; rows 3 and 7, sum other rows up``."""
    by_why: dict[str, list[int]] = {}
    for each in left_out:
        by_why.setdefault(each.why, []).append(each.row)
    parts = [f"{rows_text(rows)}, {why}" for why, rows in by_why.items()]
    more = f"; and {with_noun(len(parts) - _REASONS, 'other reason')}" if len(parts) > _REASONS else ""
    return "; ".join(parts[:_REASONS]) + more


def used(total: int, left_out: Sequence[LeftOut], what: str = "row") -> str:
    """``used 78 of 80 shots: row 41, ...``; "" if none is left out."""
    return f"used {total - len(left_out):,} of {with_noun(total, what)}: {reasons(left_out)}" if left_out else ""


def rows_text(rows: Sequence[int]) -> str:
    """``rows 3, 7 and 9``, ``row 41``."""
    if len(rows) > _ROWS:
        return f"rows {', '.join(map(str, rows[:_ROWS]))} and {len(rows) - _ROWS} more"
    *most, last = map(str, rows)
    return f"rows {', '.join(most)} and {last}" if most else f"row {last}"
