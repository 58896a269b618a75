"""Any parameters of a scene that its declarations allow, as a strategy: from their bounds, words and switches."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, get_args, get_origin

from hypothesis import strategies as st
from pydantic.fields import FieldInfo

from sandbox.parameters import Accuracy, Group, Quantity, groups_of, walk, words_of

Overrides = dict[str, Any]

#: What is nearby: as shares of a number.
_NEAR = (0.8, 1.2)


def overrides(schema: type[Group], most: int = 6) -> st.SearchStrategy[Overrides]:
    """Dotted keys with values inside their bounds: up to ``most`` of them, the rest as the scene has it."""
    space = dict(_keys(schema))
    return st.lists(st.sampled_from(sorted(space)), min_size=1, max_size=most, unique=True).flatmap(
        lambda keys: st.fixed_dictionaries({key: space[key] for key in keys})
    )


def everything(schema: type[Group]) -> st.SearchStrategy[Overrides]:
    """A value for every key at once."""
    return st.fixed_dictionaries(dict(_keys(schema)))


def nearby(parameters: Group) -> st.SearchStrategy[Overrides]:
    """Every number within a fifth of what the scene has, as far as its bounds allow; words as they are."""
    numbers = [p for p in walk(parameters) if p.low is not None and p.high is not None and isinstance(p.value, float)]
    return st.fixed_dictionaries(
        {p.key: st.floats(*sorted(min(max(share * p.value, p.low), p.high) for share in _NEAR)) for p in numbers}
    )


def _keys(schema: type[Group], prefix: str = "") -> Iterator[tuple[str, st.SearchStrategy[Any]]]:
    for name, field in schema.model_fields.items():
        groups = groups_of(field.annotation)
        if groups == (Accuracy,):
            yield f"{prefix}{name}.level", st.sampled_from(["fast", "balanced", "precise"])
        elif len(groups) == 1 and get_origin(field.annotation) is not list:
            yield from _keys(groups[0], f"{prefix}{name}.")
        else:
            yield prefix + name, _values(field)


def _values(field: FieldInfo) -> st.SearchStrategy[Any]:
    declared, groups, words = field.json_schema_extra, groups_of(field.annotation), words_of(field.annotation)
    if isinstance(declared, Quantity):
        return _quantities(declared, field.default)
    if groups and get_origin(field.annotation) is list:
        return st.lists(_tables(groups[0]), max_size=4)
    if groups:  # one of several, by a word
        return st.one_of([_tables(group) for group in groups])
    if words:
        optional = type(None) in get_args(field.annotation)
        return st.sampled_from([*words, *([None] if optional else [])])
    if field.annotation is bool:
        return st.booleans()
    return st.sampled_from(["cue", "1", "2", "9"])  # names


def _tables(schema: type[Group]) -> st.SearchStrategy[Any]:
    return st.fixed_dictionaries({name: _values(field) for name, field in schema.model_fields.items()})


def _quantities(declared: Quantity, default: Any) -> st.SearchStrategy[Any]:
    middle = default if isinstance(default, int | float) else None
    one = _numbers(declared.low, declared.high, middle)
    if declared.length is not None:
        vector = st.tuples(*[one] * declared.length)
        return st.lists(vector, max_size=4) if declared.several else vector
    return st.none() | one if declared.optional else one


def _numbers(low: float, high: float, default: float | None) -> st.SearchStrategy[float]:
    """The bounds, around the default, small ones, and any."""
    special = [x for x in (low, high, 0.0, 1e-9, 1.0, default) if x is not None and low <= x <= high]
    kinds = [st.sampled_from(special), st.floats(low, high)]
    if default:
        kinds.append(st.floats(0.5, 1.5).map(lambda share: min(max(share * default, low), high)))
    return st.one_of(kinds)
