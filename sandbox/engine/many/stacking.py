"""Many setups as one: wherever they differ in a number, the combined setup has an array with an entry for each.

A setup is data, so they are combined field by field: dataclasses, tuples and lists are traversed, numbers may differ,
and everything else (names, functions, objects of other classes) must be equal.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from math import isclose
from typing import Any

import numpy as np

_NUMBERS = (float, int, np.float64)

#: Fewer shots than this are quicker one at a time: one step with arrays costs as much as about thirty single steps.
FEWEST = 24

#: Relative and absolute difference of numbers that differ only by rounding.
_RELATIVE, _ABSOLUTE = 1e-12, 1e-15


@cache
def _fields(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind)) if is_dataclass(kind) else ()


class NotStackable(ValueError):
    """Things that differ in more than numbers."""


def stacked(things: Sequence[Any]) -> Any:
    """One thing that combines all of these. Raises NotStackable if they differ in more than numbers."""
    first = things[0]
    if all(thing is first for thing in things):
        return first
    kind: Any = type(first)
    kinds = {type(thing) for thing in things}
    if kinds.issubset(_NUMBERS):
        numbers = np.array(things, dtype=float)
        return numbers if (numbers != numbers[0]).any() else first
    if len(kinds) == 1 and isinstance(first, tuple | list) and len({len(thing) for thing in things}) == 1:
        return _tuple(kind, [stacked(column) for column in zip(*things, strict=True)])
    if len(kinds) == 1 and (names := _fields(kind)):
        return _changed(first, {name: stacked([getattr(thing, name) for thing in things]) for name in names})
    if all(thing == first for thing in things):
        return first
    raise NotStackable


class Stack(Sequence[Any]):
    """Things that differ only in numbers: ``whole`` combines them."""

    def __init__(self, whole: Any, count: int, each: Sequence[Any] | None = None) -> None:
        """So many things, made from the combination when they are asked for unless ``each`` is given."""
        self.whole = whole
        self._count = count
        self._each = each
        self._selectors: dict[str, Callable[[int], Any]] = {}
        self._made: dict[int, Any] = {}  # each once, since parts of them are told apart by identity

    @classmethod
    def of(cls, things: Sequence[Any], names: Sequence[str]) -> Stack:
        """A stack of dataclass instances, which combines the fields with these names. Raises NotStackable."""
        combined = {name: stacked([getattr(thing, name) for thing in things]) for name in names}
        return cls(_changed(things[0], combined), len(things), things)

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, place: Any) -> Any:
        """The thing at this place, by itself."""
        if self._each is not None:
            return self._each[place]
        if place >= self._count:
            raise IndexError(place)
        if place not in self._made:
            self._made[place] = self._single("", self.whole)(place)
        return self._made[place]

    def part(self, name: str, place: int) -> Any:
        """A field of the thing at this place."""
        if self._each is None:
            return self._single(name, getattr(self.whole, name))(place)
        return getattr(self._each[place], name)

    def _single(self, name: str, whole: Any) -> Callable[[int], Any]:
        if name not in self._selectors:
            self._selectors[name] = selector(whole, single=True)
        return self._selectors[name]


def selector(stack: Any, single: bool = False) -> Callable[[Any], Any]:
    """A function that restricts the stack to some indices; or, if ``single``, that gives the thing at one index."""
    selects = _selector(stack, single)
    return (lambda places: stack) if selects is None else selects


def _selector(stack: Any, single: bool) -> Callable[[Any], Any] | None:
    """Return the same as ``selector``; None if the stack is the same everywhere."""
    kind: Any = type(stack)
    if kind is np.ndarray:
        return stack.tolist().__getitem__ if single else stack.__getitem__
    if isinstance(stack, tuple | list):
        items = [(_selector(item, single), item) for item in stack]
        if all(selects is None for selects, _ in items):
            return None
        return lambda at: _tuple(kind, [item if selects is None else selects(at) for selects, item in items])
    parts = {name: _selector(getattr(stack, name), single) for name in _fields(kind)}
    differing = [(name, selects) for name, selects in parts.items() if selects is not None]
    if not differing:
        return None
    return lambda at: _changed(stack, {name: selects(at) for name, selects in differing})


def agree(one: Any, other: Any) -> bool:
    """True if two things are equal, apart from rounding of their numbers."""
    kind: Any = type(one)
    names = _fields(kind)
    if kind in _NUMBERS and type(other) in _NUMBERS:
        return isclose(one, other, rel_tol=_RELATIVE, abs_tol=_ABSOLUTE)
    if kind is not type(other):
        return False
    if isinstance(one, tuple | list):
        return len(one) == len(other) and all(map(agree, one, other))
    return all(agree(getattr(one, name), getattr(other, name)) for name in names) if names else bool(one == other)


def _tuple(kind: Any, items: list[Any]) -> Any:
    return kind(*items) if hasattr(kind, "_fields") else kind(items)


def _changed(like: Any, parts: dict[str, Any]) -> Any:
    """A copy with other values in these fields, without its class's checks, which each original has passed."""
    kind: Any = type(like)
    made = object.__new__(kind)
    for name in _fields(kind):
        object.__setattr__(made, name, parts[name] if name in parts else getattr(like, name))
    return made
