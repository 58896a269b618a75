"""Arithmetic with the columns of a table, such as ``SpinRate*cos(radians(SpinAxis))``: nothing else is computed."""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from sandbox.text import nearest, shortened

#: Longest text; nesting is bounded by it.
_LONGEST = 300

_FUNCTIONS: dict[str, tuple[Callable[..., Any], int]] = {  # with the number of their arguments
    "sin": (np.sin, 1),
    "cos": (np.cos, 1),
    "tan": (np.tan, 1),
    "asin": (np.arcsin, 1),
    "acos": (np.arccos, 1),
    "atan": (np.arctan, 1),
    "atan2": (np.arctan2, 2),
    "hypot": (np.hypot, 2),
    "sqrt": (np.sqrt, 1),
    "abs": (np.abs, 1),
    "exp": (np.exp, 1),
    "log": (np.log, 1),
    "radians": (np.radians, 1),
    "degrees": (np.degrees, 1),
    "min": (np.minimum, 2),
    "max": (np.maximum, 2),
}
_CONSTANTS = {"pi": np.pi}
_SIGNS: dict[type, Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}

_QUOTED = re.compile(r"`([^`]*)`|'([^']*)'|\"([^\"]*)\"")
_WORD = re.compile(r"[^\W\d][\w.]*")
_OTHER = re.compile(r"\d[\d.]*(?:[eE][+-]?\d+)?|\*\*|[-+*/(),.]")


@dataclass(frozen=True)
class Expression:
    """Arithmetic with columns, or one column alone."""

    text: str  # as it was written
    columns: tuple[str, ...]  # by their names in the table, in the order of _0, _1, ... in the source
    source: str  # of Python, checked

    @property
    def is_column(self) -> bool:
        """True if it is one column as it is."""
        return self.source == "_0"

    def values(self, columns: Sequence[np.ndarray]) -> np.ndarray:
        """The value in each row, of shape (rows,) as the numbers of the columns; NaN or infinite if there is none."""
        names: dict[str, Any] = {f"_{place}": numbers for place, numbers in enumerate(columns)}
        with np.errstate(all="ignore"):
            found = _value(ast.parse(self.source, mode="eval").body, _CONSTANTS | names)
        return np.broadcast_to(np.asarray(found, dtype=float), columns[0].shape)


def parse(text: str, names: Mapping[str, str]) -> Expression:
    """Arithmetic with columns, given as ``names`` in lower case with the columns that they stand for. A name stands as
    it is, in whatever quotes, or in backticks; it must be quoted where it does not begin with a letter.

    Raises ValueError with the place and the reason.
    """
    text = text.strip()
    if not text or len(text) > _LONGEST:
        raise ValueError("names no column" if not text else f"is longer than {_LONGEST} characters")
    if (alone := names.get(text.lower())) is not None:
        return Expression(text, (alone,), "_0")
    found: list[str] = []
    source, places = "", list[int]()  # of each character of the source in the text
    at = 0
    while at < len(text):
        column, part, end = _next(text, at, names)
        if column is not None:
            found += [] if column in found else [column]
            part = f"_{found.index(column)}"
        places += [at] * len(part)
        source += part
        at = end
    try:
        tree = ast.parse(source.strip(), mode="eval").body
    except SyntaxError as error:
        offset = min(max((error.offset or 1) - 1, 0) + len(source) - len(source.lstrip()), len(places))
        raise ValueError(_at(text, places[offset] if offset < len(places) else len(text), "does not parse")) from None
    _check(tree)
    if not found:
        raise ValueError("names no column")
    return Expression(text, tuple(found), source.strip())


def _next(text: str, at: int, names: Mapping[str, str]) -> tuple[str | None, str, int]:
    """The column that is named at a place, or None; what else stands there; and where it ends. Raises ValueError."""
    if text[at].isspace():
        return None, " ", at + 1
    quoted = _QUOTED.match(text, at)
    if quoted is not None:
        name = next(part for part in quoted.groups() if part is not None)
        return _column(text, at, name, names), "", quoted.end()
    word = _WORD.match(text, at)
    if word is not None:
        is_call = word[0] in _FUNCTIONS and text[word.end() :].lstrip().startswith("(")
        longest = max((name for name in names if _stands(name, text, at)), key=len, default="")
        if longest and not is_call:
            return names[longest], "", at + len(longest)
        if is_call or word[0] in _CONSTANTS:
            return None, word[0], word.end()
        if text[word.end() :].lstrip().startswith("("):
            raise ValueError(_at(text, at, f"{word[0]} is no function; there are {', '.join(_FUNCTIONS)}"))
        return _column(text, at, word[0], names), "", word.end()
    other = _OTHER.match(text, at)
    if other is None:
        raise ValueError(_at(text, at, f"{text[at]!r} does not belong there; put the name of a column in quotes"))
    return None, other[0], other.end()


def _stands(name: str, text: str, at: int) -> bool:
    """True if a name stands at a place of the text, and ends there."""
    end = at + len(name)
    ends = end >= len(text) or not (text[end].isalnum() or text[end] == "_") or not name[-1].isalnum()
    return ends and text[at:end].lower() == name


def _column(text: str, at: int, name: str, names: Mapping[str, str]) -> str:
    """The column of a name. Raises ValueError for one that the table does not have."""
    if name.lower() not in names:
        near = nearest(name, [*names.values()])
        has = f"did you mean {near}?" if near else f"it has {shortened(', '.join(dict.fromkeys(names.values())), 200)}"
        raise ValueError(_at(text, at, f"has no column {name!r}; {has}"))
    return names[name.lower()]


def _at(text: str, at: int, why: str) -> str:
    """A reason with its place, where that is not the beginning."""
    return f"at {shortened(text[at:], 20)!r} (character {at + 1}): {why}" if 0 < at < len(text) else why


def _check(node: ast.expr) -> None:
    """Raise ValueError for anything but arithmetic."""
    match node:
        case ast.BinOp(left, op, right) if type(op) in _SIGNS:
            _check(left)
            _check(right)
        case ast.UnaryOp(op, operand) if type(op) in _SIGNS:
            _check(operand)
        case ast.Call(ast.Name(name), args, []) if name in _FUNCTIONS:
            if len(args) != (count := _FUNCTIONS[name][1]):
                raise ValueError(f"{name} takes {count} {'number' if count == 1 else 'numbers'}, not {len(args)}")
            for each in args:
                _check(each)
        case ast.Constant(int() | float()) | ast.Name():
            pass
        case _:
            raise ValueError("is no arithmetic with columns and numbers")


def _value(node: ast.expr, names: Mapping[str, Any]) -> Any:
    """The value of checked arithmetic; numbers are floats, so that no power of integers grows without bound."""
    match node:
        case ast.BinOp(left, op, right):
            return _SIGNS[type(op)](_value(left, names), _value(right, names))
        case ast.UnaryOp(op, operand):
            return _SIGNS[type(op)](_value(operand, names))
        case ast.Call(ast.Name(name), args, _):
            return _FUNCTIONS[name][0](*(_value(each, names) for each in args))
        case ast.Name(name):
            return names[name]
        case ast.Constant(value):
            return np.float64(value)  # type: ignore[arg-type]
    raise AssertionError(node)
