"""The forces of many shots as one: what differs in them becomes an array with an entry for each shot.

Two shots' forces are alike if they are built alike: the same classes and functions, nested alike, differing in nothing
but floats. Then one of them, with arrays in place of those floats, stands for all. What cannot be looked into (a
compiled function, a bound method, a module, a class with slots) is alike only if it is one and the same.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from types import CellType, FunctionType
from typing import Any

import numpy as np

_FLOATS = (float, np.float64)

#: Objects nested deeper than this are not looked into.
_DEEPEST = 10


def structure(thing: Any, numbers: list[float], depth: int = 0) -> Hashable:
    """How a thing is built; its floats are added to ``numbers`` in a fixed order."""
    kind = type(thing)
    if kind in _FLOATS:
        numbers.append(thing)
        return float
    if thing is None or kind in (int, bool, str):
        return kind, thing
    if depth > _DEEPEST:
        return kind, id(thing)
    if kind in (tuple, list):
        return kind, *[structure(item, numbers, depth + 1) for item in thing]
    if kind is dict:
        return kind, *[(key, structure(value, numbers, depth + 1)) for key, value in thing.items()]
    if kind is FunctionType:
        held = (*[cell.cell_contents for cell in thing.__closure__ or ()], thing.__defaults__, thing.__kwdefaults__)
        return kind, thing.__code__, *[structure(item, numbers, depth + 1) for item in held]
    inside = getattr(thing, "__dict__", None)
    if type(inside) is not dict or not _is_plain(kind):
        return kind, id(thing)
    return kind, *[(name, structure(value, numbers, depth + 1)) for name, value in inside.items()]


def _is_plain(kind: type) -> bool:
    """Whether all there is to such an object stands in its ``__dict__``: not so with what has slots or is made in C,
    as functools.partial, bound methods, modules and what derives from dict or list."""
    made_by: object = kind.__new__
    return made_by is object.__new__ and not any(getattr(base, "__slots__", ()) for base in kind.__mro__)


class Stack:
    """Things that are built alike, as one thing whose floats are arrays where they differ."""

    def __init__(self, template: Any, numbers: Sequence[Sequence[float]]) -> None:
        """``template`` is one of them, ``numbers`` the floats of each, as ``structure`` gives them."""
        self._template = template
        self._numbers = np.array(numbers)  # shape (things, floats)
        self._varies: list[bool] = (self._numbers != self._numbers[:1]).any(axis=0).tolist()

    def of(self, chosen: np.ndarray) -> Any:
        """The one thing that stands for those chosen, by their places; arrays have the shape of ``chosen``."""
        if not any(self._varies):
            return self._template
        columns = iter(zip(self._varies, self._numbers[chosen].T, strict=True))
        return _filled(self._template, columns, 0)[0]


def _filled(thing: Any, columns: Any, depth: int) -> tuple[Any, bool]:
    """The thing with the next columns in place of its floats, and whether anything in it differs from shot to shot."""
    kind = type(thing)
    if kind in _FLOATS:
        varies, column = next(columns)
        return (column, True) if varies else (thing, False)
    if thing is None or kind in (int, bool, str) or depth > _DEEPEST:
        return thing, False
    if kind in (tuple, list):
        items = [_filled(item, columns, depth + 1) for item in thing]
        return (kind(item for item, _ in items), True) if any(new for _, new in items) else (thing, False)
    if kind is dict:
        entries = {key: _filled(value, columns, depth + 1) for key, value in thing.items()}
        new = any(varies for _, varies in entries.values())
        return ({key: value for key, (value, _) in entries.items()}, True) if new else (thing, False)
    if kind is FunctionType:
        cells = [_filled(cell.cell_contents, columns, depth + 1) for cell in thing.__closure__ or ()]
        defaults, keywords = (_filled(held, columns, depth + 1) for held in (thing.__defaults__, thing.__kwdefaults__))
        if not any(new for _, new in (*cells, defaults, keywords)):
            return thing, False
        closure = tuple(CellType(value) for value, _ in cells) or None
        copy = FunctionType(thing.__code__, thing.__globals__, thing.__name__, defaults[0], closure)
        copy.__kwdefaults__ = keywords[0]
        return copy, True
    inside = getattr(thing, "__dict__", None)
    if type(inside) is not dict or not _is_plain(kind):
        return thing, False
    parts = {name: _filled(value, columns, depth + 1) for name, value in inside.items()}
    if not any(new for _, new in parts.values()):
        return thing, False
    filled = object.__new__(kind)
    filled.__dict__.update({name: value for name, (value, _) in parts.items()})
    return filled, True
