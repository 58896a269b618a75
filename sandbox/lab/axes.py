"""Axes of a sweep or search: the parameters to vary, and the scene with other values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, log10, ulp
from typing import Any

import numpy as np

from sandbox import parameters as declared
from sandbox.errors import RequestError
from sandbox.parameters import Group, Quantity, SceneParameters, path_of, value_at
from sandbox.scene import Scene
from sandbox.toml import toml_value

#: Most values along one axis, and most points of a sweep: more is taken as a mistake in the request.
MOST_VALUES, MOST_POINTS = 1_000_000, 100_000_000

#: Cached combinations of words and switches, since each takes milliseconds to check.
_CACHED = 64

Path = tuple[str | int, ...]


@dataclass(frozen=True)
class Values:
    """One parameter and its values, in its declared unit: numbers, words or switches."""

    key: str
    values: tuple[Any, ...]


@dataclass(frozen=True)
class Span:
    """One numeric parameter and the range to search or sample, in its declared unit."""

    key: str
    low: float
    high: float


Axis = Values | Span


# ---------------------------------------------------------------------------------------------------------------------
# Reading
# ---------------------------------------------------------------------------------------------------------------------


def parse_axis(scene: Scene, option: str, text: str) -> Axis:
    """``KEY=LO:HI:N``, ``KEY=LO:HI`` or ``KEY=A,B,C``; the ends may have units. Raises RequestError."""
    key, equals, body = (part.strip() for part in text.partition("="))
    if not key or not equals or not body:
        raise RequestError(f"{option} {text}: write it as KEY=LO:HI:N, for example {option} launch.angle=10:60:51")
    parts = [part.strip() for part in body.split(":")]
    if len(parts) == 1:
        values = toml_value(f"[{body}]")
        listed = values if isinstance(values, list) else [toml_value(part.strip()) for part in body.split(",")]
        return as_axis(scene, key, listed, option)
    if len(parts) > 3:
        raise RequestError(f"{option} {text}: {len(parts)} parts, but a range has two or three: LO:HI:N")
    low, high = (checked(scene, option, key, toml_value(part)) for part in parts[:2])
    if not isinstance(low, float) or not isinstance(high, float):
        raise RequestError(f"{option} {key}: only numbers can have a range; list values, separated by commas")
    if len(parts) == 2:
        return span(option, key, low, high)
    count = int(parts[2]) if parts[2].isdecimal() and len(parts[2]) < 9 else 0
    if not 1 <= count <= MOST_VALUES:
        raise RequestError(f"{option} {text}: {parts[2]!r} is not a number of points from 1 to {MOST_VALUES:,}")
    return Values(key, spaced(low, high, count))


def spaced(low: float, high: float, count: int) -> tuple[float, ...]:
    """So many evenly spaced numbers from low to high; -28.8 where rounding would give -28.799999999999997."""
    if count < 2 or low == high:
        return (low,) * count
    largest = max(abs(low), abs(high))
    digits = 12 - ceil(log10(largest))
    rounding = 4.0 * ulp(largest)
    values = (np.linspace(low, high, count) + 0.0).tolist()
    rounded = ((round(value, digits) + 0.0, value) for value in values)  # + 0.0: no -0.0
    return tuple(short if abs(short - value) <= rounding else value for short, value in rounded)


def parse_span(scene: Scene, option: str, text: str) -> Span:
    """``KEY=LO:HI``. Raises RequestError."""
    if text.count(":") != 1:
        raise RequestError(f"{option} {text}: write it as KEY=LO:HI, for example {option} launch.angle=5:75")
    axis = parse_axis(scene, option, text)
    assert isinstance(axis, Span)  # of two parts
    return axis


def as_axis(scene: Scene, key: str, given: Any, option: str = "over") -> Axis:
    """An axis from Python: a pair as a tuple is a span, any other sequence or array is a list of values."""
    given = given.tolist() if isinstance(given, np.ndarray) else given
    if isinstance(given, str | Mapping) or not isinstance(given, Iterable):
        raise RequestError(f"{option} {key}: {given!r} is neither a list of values nor a range (low, high)")
    if isinstance(given, tuple) and len(given) == 2 and not isinstance(given[0], bool):
        low, high = (checked(scene, option, key, end) for end in given)
        if isinstance(low, float) and isinstance(high, float):
            return span(option, key, low, high)
        return Values(key, (low, high))
    values = list(given)
    if not values:
        raise RequestError(f"{option} {key}: no values")
    if len(values) > 2 and all(isinstance(value, int | float) and not isinstance(value, bool) for value in values):
        low, high = (checked(scene, option, key, end) for end in (min(values), max(values)))
        if isinstance(low, float):  # both ends are within bounds, so all of it is
            return Values(key, tuple(float(value) for value in values))
    return Values(key, tuple(checked(scene, option, key, value) for value in values))


def span(option: str, key: str, low: float, high: float) -> Span:
    """A range. Raises RequestError if it is empty."""
    if low >= high:
        raise RequestError(f"{option} {key}: the range from {low:g} to {high:g} is empty; write the lower end first")
    return Span(key, low, high)


def checked(scene: Scene, option: str, key: str, value: Any) -> Any:
    """The value that the scene's parameter takes for ``value``, in its declared unit. Raises RequestError."""
    found = value_at(declared.changed(scene.parameters, {key: value}, option), key)
    if isinstance(found, Group):
        raise RequestError(f"{option} {key}: is a group of parameters, not a parameter")
    return found


def unit_of(scene: Scene, key: str) -> str:
    """The declared unit of a parameter; empty if none."""
    plain = key.partition("[")[0]
    return next((found.unit or "" for found in declared.walk(scene.parameters) if found.key == plain), "")


def label(scene: Scene, key: str) -> str:
    """A parameter with its unit, for charts and tables: ``"launch.speed (m/s)"``."""
    unit = unit_of(scene, key)
    return f"{key} ({unit})" if unit else key


def result_label(scene: Scene, name: str) -> str:
    """A number of the result with its unit, for charts: ``"flight time (s)"``."""
    fact = scene.facts.get(name.removesuffix("_error"))
    if fact is None:
        return name.replace("_", " ")
    said = (fact.label or fact.key.replace("_", " ")) + name[len(fact.key) :].replace("_", " ")
    return f"{said} ({fact.unit})" if fact.unit else said


# ---------------------------------------------------------------------------------------------------------------------
# A scene with other values
# ---------------------------------------------------------------------------------------------------------------------


class Varied:
    """The parameters of a scene with other values at some keys.

    Numbers are set without further checks, since the bounds of both ends were checked when the axes were read. Words
    and switches may change which other keys exist, so each of their combinations is checked as a whole, and cached.
    """

    def __init__(self, scene: Scene, keys: Sequence[str]) -> None:
        self._scene = scene
        self._paths = [path_of("over", key) for key in keys]
        self._keys = list(keys)
        self._quick = [_can_set_unchecked(scene.parameters, path) for path in self._paths]
        self._bases: dict[str, SceneParameters] = {}

    def parameters(self, values: Sequence[Any]) -> SceneParameters:
        """The scene's parameters with ``values`` at the keys, in their order. Raises RequestError."""
        slow = {key: value for key, value, quick in zip(self._keys, values, self._quick, strict=True) if not quick}
        parameters = self._base(slow) if slow else self._scene.parameters
        changes: dict[str | int, Any] = {}
        for path, value, quick in zip(self._paths, values, self._quick, strict=True):
            if quick:
                node = changes
                for step in path[:-1]:
                    node = node.setdefault(step, {})
                node[path[-1]] = value
        return _changed(parameters, changes)

    def together(self, points: Sequence[Sequence[Any]]) -> Iterator[tuple[list[int], SceneParameters | Exception]]:
        """The places of points that differ only in numbers, and their parameters in one, with arrays for the numbers
        that differ; or the exception that explains why there are none."""
        groups: dict[str, list[int]] = {}
        for place, values in enumerate(points):
            words = repr([value for value, quick in zip(values, self._quick, strict=True) if not quick])
            groups.setdefault(words, []).append(place)
        for places in groups.values():
            columns = zip(*(points[place] for place in places), strict=True)
            merged = [
                np.array(column) if quick and any(value != column[0] for value in column) else column[0]
                for column, quick in zip(columns, self._quick, strict=True)
            ]
            try:
                yield places, self.parameters(merged)
            except RequestError as error:
                yield places, error

    def _base(self, changes: Mapping[str, Any]) -> SceneParameters:
        name = repr(changes)
        if name not in self._bases:
            if len(self._bases) >= _CACHED:
                self._bases.clear()
            self._bases[name] = declared.changed(self._scene.parameters, changes, "over")
        return self._bases[name]


def _can_set_unchecked(parameters: Any, path: Path) -> bool:
    """True if a number may be set at ``path`` unchecked: no group on the path has checks of its own.

    The accuracy may not: it is one for all shots that are computed together.
    """
    node, quantity = parameters, None
    for step in path:
        if isinstance(step, int):
            node = node[step]
            continue
        if not isinstance(node, Group) or isinstance(node, declared.Accuracy):
            return False
        checks = type(node).__pydantic_decorators__
        if checks.model_validators or checks.field_validators or checks.root_validators or checks.validators:
            return False
        quantity = type(node).model_fields[step].json_schema_extra
        node = getattr(node, step)
    return isinstance(quantity, Quantity) and (isinstance(node, float) or node is None)


def _changed(node: Any, changes: Any) -> Any:
    """A group, list or tuple with nested changes applied."""
    if not isinstance(changes, dict):
        return changes
    if isinstance(node, Group):
        return node.model_copy(update={key: _changed(getattr(node, key), inner) for key, inner in changes.items()})
    return type(node)(_changed(item, changes.get(place, item)) for place, item in enumerate(node))
