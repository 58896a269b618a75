"""What the fields of a thing must be, so that a wrong number is refused where it is given, by name."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

from sandbox.physics.elementwise import everywhere, finite

#: What each rule asks of a value, of floats or arrays, and says where it does not hold.
_RULES = {
    "positive": (lambda x: everywhere((x > 0.0) & (x < inf)), "must be positive"),
    "not_negative": (lambda x: everywhere((x >= 0.0) & (x < inf)), "must not be negative"),
    "shares": (lambda x: everywhere((x >= 0.0) & (x <= 1.0)), "must be from 0 to 1"),
    "finite": (finite, "must be finite"),
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
