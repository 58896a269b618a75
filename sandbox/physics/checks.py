"""Validation rules for the fields of dataclasses: a wrong number is an error where it is given, by name."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

from sandbox.physics.elementwise import everywhere, finite

#: Most characters of a value in a message.
_LONGEST = 60


def _finite(x: Any) -> bool:
    """Return True if x is a finite number, or an array of them."""
    kind = getattr(x, "dtype", None)
    return (isinstance(x, float | int) if kind is None else kind.kind in "biuf") and finite(x)


#: Each rule: a condition on a value, floats or arrays, and what is said where it does not hold.
_RULES = {
    "positive": (lambda x: everywhere((x > 0.0) & (x < inf)), "must be positive"),
    "not_negative": (lambda x: everywhere((x >= 0.0) & (x < inf)), "must not be negative"),
    "fractions": (lambda x: everywhere((x >= 0.0) & (x <= 1.0)), "must be from 0 to 1"),
    "finite": (_finite, "must be finite"),
    "lists": (lambda x: isinstance(x, list | tuple), "must be a list: write it in [ ]"),
    "points": (lambda point: len(point) == 2 and all(map(_finite, point)), "must be two finite numbers, (x, y)"),
    "names": (lambda x: isinstance(x, str), "must be text"),
}


def check(what: str, thing: Any, **fields: Sequence[str]) -> None:
    """Raise ValueError unless the fields of a thing obey their rule: ``check("cloth", law, positive=["gravity"])``."""
    for rule, names in fields.items():
        holds, words = _RULES[rule]
        for name in names:
            value = getattr(thing, name)
            try:
                right = holds(value)
            except TypeError:  # such as text in place of a number
                right = False
            if not right:
                shown = value if isinstance(value, float | int | tuple) else short(value)
                raise ValueError(f"{what}: {name} = {shown} {words}")


def short(value: Any) -> str:
    """Return a value for a message, in one line."""
    text = " ".join(repr(value).split())
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
