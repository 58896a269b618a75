"""Conditions on the rows of a table: ``Club=Driver``, ``launch_angle=15:50``, ``launch.speed > 60 m/s``."""

from __future__ import annotations

import operator
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from sandbox import units
from sandbox.errors import RequestError

_FORM = re.compile(r"\s*(.+?)\s*(<=|>=|!=|<|>|=)\s*(.+?)\s*")
_ORDERS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}


@dataclass(frozen=True)
class Condition:
    """Rows in which a column, or what one stands for, is a text, a number, in a range with both its ends, or less or
    more than a number; a number without a unit is in that of the column."""

    name: str
    sign: str
    text: str

    def __str__(self) -> str:
        return f"{self.name} {self.sign} {self.text}"

    def compares_numbers(self, unit: str) -> bool:
        """True if it is about numbers alone, for which a number in this unit is checked. Raises RequestError."""
        if self.sign in _ORDERS:
            self.check_number(unit)
        return self.sign in _ORDERS or _ends(self.text, unit, ranges_only=True) is not None

    def check_number(self, unit: str) -> None:
        """Raise RequestError if it names no number, or range, in this unit."""
        try:
            if self.sign in _ORDERS or _ends(self.text, unit) is None:
                units.parse(self.text, unit)
        except ValueError as error:
            raise RequestError(f"--where {self}: {error}") from None

    def holds(self, cell: str, number: float | None, unit: str) -> bool:
        """True for a row with this cell, and number in this unit if it is one."""
        if self.sign in _ORDERS:
            return number is not None and bool(_ORDERS[self.sign](number, units.parse(self.text, unit)))
        same = cell.strip().lower() == self.text.lower()
        if not same and number is not None and (ends := _ends(self.text, unit)) is not None:
            same = ends[0] <= number <= ends[1]
        return same == (self.sign == "=")


def _ends(text: str, unit: str, ranges_only: bool = False) -> tuple[float, float] | None:
    """The ends of a range such as ``15:50``, or a number twice; None for other texts."""
    low, colon, high = text.partition(":")
    try:
        return None if ranges_only and not colon else (units.parse(low, unit), units.parse(high or low, unit))
    except ValueError:
        return None


def parse_condition(text: str) -> Condition:
    """``COLUMN=TEXT``, ``COLUMN=LOW:HIGH``, or with ``!=``, ``<``, ``<=``, ``>``, ``>=``. Raises RequestError."""
    found = _FORM.fullmatch(text)
    if found is None:
        raise RequestError(f'--where {text}: write it as COLUMN=TEXT, COLUMN=LOW:HIGH, "COLUMN<NUMBER" or COLUMN!=TEXT')
    return Condition(found[1], found[2], found[3])


def conditions(where: Mapping[str, str] | Sequence[str]) -> tuple[Condition, ...]:
    """Conditions from Python: texts by column, or as they are written for ``--where``. Raises RequestError."""
    if isinstance(where, Mapping):
        return tuple(Condition(name, "=", str(text)) for name, text in where.items())
    return tuple(map(parse_condition, [where] if isinstance(where, str) else where))
