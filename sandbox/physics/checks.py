"""Validation rules for the fields of dataclasses: a wrong number is an error where it is given, by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from functools import wraps
from math import inf
from numbers import Real
from typing import Any, TypeVar, cast

from sandbox.physics.elementwise import everywhere, finite

T = TypeVar("T")

#: Most characters of a value in a message.
_LONGEST = 60


def _is_number(x: Any) -> bool:
    """Return True if x is a real number, or an array of them."""
    kind = getattr(x, "dtype", None)
    return isinstance(x, float | int | Real) if kind is None else kind.kind in "biuf"


def _is_point(point: Any) -> bool:
    in_order = isinstance(point, Sequence) or hasattr(point, "dtype")
    return in_order and len(point) == 2 and all(_is_number(x) and finite(x) for x in point)


#: Each rule: a condition on a value, floats or arrays, and what is said where it does not hold.
_RULES: dict[str, tuple[Callable[[Any], bool], str]] = {
    "positive": (lambda x: _is_number(x) and everywhere((x > 0.0) & (x < inf)), "must be positive"),
    "not_negative": (lambda x: _is_number(x) and everywhere((x >= 0.0) & (x < inf)), "must not be negative"),
    "fractions": (lambda x: _is_number(x) and everywhere((x >= 0.0) & (x <= 1.0)), "must be from 0 to 1"),
    "finite": (lambda x: _is_number(x) and finite(x), "must be finite"),
    "lists": (lambda x: isinstance(x, list | tuple), "must be a list: write it in [ ]"),
    "points": (_is_point, "must be two finite numbers, (x, y)"),
    "names": (lambda x: isinstance(x, str), "must be text"),
    "laws": (callable, "must be a function of the normal and the tangential speed that returns a Bounce"),
}


def check(what: str, thing: Any, **rules: Sequence[str]) -> None:
    """Raise ValueError unless the fields of a thing obey their rule: ``check("cloth", law, positive=["gravity"])``."""
    for rule, names in rules.items():
        holds, words = _RULES[rule]
        for name in names:
            value = getattr(thing, name)
            try:
                right = holds(value)
            except TypeError:  # such as text in place of a number
                right = False
            if not right:
                shown = value if isinstance(value, float | int) else short(value)
                raise ValueError(f"{what}: {name} = {shown} {words}")


def with_fields_named(cls: type[T]) -> type[T]:
    """Return a dataclass whose TypeError for an unknown argument names the fields that it has."""
    made, known = cls.__init__, [field.name for field in fields(cast(Any, cls)) if field.init]

    @wraps(made)
    def init(self: Any, *arguments: Any, **named: Any) -> None:
        try:
            made(self, *arguments, **named)
        except TypeError:
            wrong = next((name for name in named if name not in known), None)
            if wrong is None:
                raise
            message = f"unexpected keyword argument {wrong!r}; it takes {', '.join(known)}"
            raise TypeError(f"{cls.__name__}: {message}") from None

    cast(Any, cls).__init__ = init
    return cls


def short(value: Any) -> str:
    """Return a value for a message, in one line."""
    text = " ".join(repr(value).split())
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
