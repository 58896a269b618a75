"""Validation rules for the fields of dataclasses: a wrong number is an error where it is given, by name."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

from sandbox.physics.elementwise import everywhere, finite

#: Each rule: a condition on a value, floats or arrays, and what is said where it does not hold.
_RULES = {
    "positive": (lambda x: everywhere((x > 0.0) & (x < inf)), "must be positive"),
    "not_negative": (lambda x: everywhere((x >= 0.0) & (x < inf)), "must not be negative"),
    "fractions": (lambda x: everywhere((x >= 0.0) & (x <= 1.0)), "must be from 0 to 1"),
    "finite": (finite, "must be finite"),
    "lists": (lambda x: isinstance(x, list | tuple), "must be a list: write it in [ ]"),
    "points": (lambda point: len(point) == 2 and all(map(finite, point)), "must be two finite numbers, (x, y)"),
}


def check(what: str, thing: Any, **fields: Sequence[str]) -> None:
    """Raise ValueError unless the fields of a thing obey their rule: ``check("cloth", law, positive=["gravity"])``."""
    for rule, names in fields.items():
        holds, words = _RULES[rule]
        for name in names:
            value = getattr(thing, name)
            if not holds(value):
                raise ValueError(f"{what}: {name} = {value} {words}")
