"""Many setups as one: wherever they differ in a number, the combined setup has an array with an entry for each.

A setup is data, so they are combined field by field: dataclasses, tuples and lists are traversed, numbers may differ,
and everything else (names, functions, objects of other classes) must be equal.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

import numpy as np

_NUMBERS = (float, int, np.float64)


@cache
def _fields(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind)) if is_dataclass(kind) else ()


class Alike:
    """Tells which things can be stacked: those with the same key."""

    def __init__(self) -> None:
        self._known: dict[
            int, tuple[Any, Hashable]
        ] = {}  # by id; the thing is stored too, so that its id is not reused

    def key(self, thing: Any) -> Hashable:
        """A key that is equal for two things that differ only in numbers."""
        kind: Any = type(thing)
        if kind in _NUMBERS:
            return float
        if thing is None or kind is str or kind is bool:
            return thing
        if id(thing) in self._known:
            return self._known[id(thing)][1]
        key: Hashable
        if isinstance(thing, tuple | list):
            key = kind, *map(self.key, thing)
        elif names := _fields(kind):
            key = kind, *[self.key(getattr(thing, name)) for name in names]
        elif kind.__hash__ is None:
            key = kind, id(thing)
        else:
            key = thing
        self._known[id(thing)] = thing, key
        return key


def stacked(things: Sequence[Any]) -> Any:
    """One thing that combines all of these, which must have the same key."""
    first = things[0]
    if all(thing is first for thing in things):
        return first
    kind: Any = type(first)
    if kind in _NUMBERS:
        numbers = np.array(things, dtype=float)
        return numbers if (numbers != numbers[0]).any() else first
    if isinstance(first, tuple | list):
        return _tuple(kind, [stacked(column) for column in zip(*things, strict=True)])
    if names := _fields(kind):
        return _filled(first, {name: stacked([getattr(thing, name) for thing in things]) for name in names})
    return first


def chosen(stack: Any, places: np.ndarray) -> Any:
    """The stack restricted to these indices."""
    kind: Any = type(stack)
    if kind is np.ndarray:
        return stack[places]
    if isinstance(stack, tuple | list):
        items = [chosen(item, places) for item in stack]
        return stack if all(new is old for new, old in zip(items, stack, strict=True)) else _tuple(kind, items)
    if names := _fields(kind):
        held = {name: getattr(stack, name) for name in names}
        parts = {name: chosen(part, places) for name, part in held.items()}
        return stack if all(parts[name] is held[name] for name in names) else _filled(stack, parts)
    return stack


def _tuple(kind: Any, items: list[Any]) -> Any:
    return kind(*items) if hasattr(kind, "_fields") else kind(items)


def _filled(like: Any, parts: dict[str, Any]) -> Any:
    """A copy with these fields, without its class's checks, which each original has passed."""
    made = object.__new__(type(like))
    for name, part in parts.items():
        object.__setattr__(made, name, part)
    return made
