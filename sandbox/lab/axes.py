"""Axes of a sweep or search: the parameters to vary, and the scene with other values."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, inf, log10, ulp
from pathlib import Path as FilePath
from statistics import NormalDist
from typing import Any

import numpy as np

from sandbox import parameters as declared
from sandbox import units
from sandbox.errors import RequestError
from sandbox.files import read_given
from sandbox.parameters import Group, Quantity, SceneParameters, path_of, value_at
from sandbox.scene import Scene
from sandbox.text import shortened
from sandbox.toml import toml_value

#: Most values along one axis, and most points of a sweep: more is taken as a mistake in the request.
_MOST_VALUES, MOST_POINTS = 1_000_000, 100_000_000

#: Most bytes of a file of points.
_LARGEST = 1_000_000_000

#: Cached combinations of words and switches, since each takes milliseconds to check.
_CACHED = 64

Path = tuple[str | int, ...]


@dataclass(frozen=True)
class Values:
    """One parameter and its values, in its declared unit: numbers, words or switches."""

    key: str
    values: tuple[Any, ...]

    @property
    def distinct(self) -> tuple[Any, ...]:
        """The values, each once, in order."""
        return tuple(dict.fromkeys(self.values))


@dataclass(frozen=True)
class Span:
    """One numeric parameter and the range to search or sample, in its declared unit."""

    key: str
    low: float
    high: float


@dataclass(frozen=True)
class Normal:
    """One numeric parameter that is normally distributed, within its bounds; all in its declared unit."""

    key: str
    mean: float
    sd: float
    bounds: tuple[float, float]

    @property
    def low(self) -> float:
        """Three standard deviations below the mean, or its lower bound: where an axis of a chart begins."""
        return max(self.mean - 3.0 * self.sd, self.bounds[0])

    @property
    def high(self) -> float:
        """Three standard deviations above the mean, or its upper bound: where an axis of a chart ends."""
        return min(self.mean + 3.0 * self.sd, self.bounds[1])

    @cached_property
    def _shares(self) -> tuple[float, float]:
        """The shares of the whole distribution below the bounds."""
        return self._standard(self.bounds[0]), self._standard(self.bounds[1])

    def _standard(self, value: float) -> float:
        return NormalDist().cdf((value - self.mean) / self.sd)

    def value(self, share: float) -> float:
        """The value with this share of the distribution below it."""
        below, up_to = self._shares
        share = min(max(below + share * (up_to - below), _LEAST_SHARE), 1.0 - _LEAST_SHARE)
        return min(max(self.mean + self.sd * NormalDist().inv_cdf(share), self.bounds[0]), self.bounds[1])


#: The share of a normal distribution beyond 8.2 standard deviations, where rounding ends it.
_LEAST_SHARE = 2.0**-53

Axis = Values | Span | Normal


# ---------------------------------------------------------------------------------------------------------------------
# Reading
# ---------------------------------------------------------------------------------------------------------------------


def parse_axis(scene: Scene, option: str, text: str) -> Axis:
    """``KEY=LO:HI:N``, ``KEY=LO:HI``, ``KEY=MEAN~SD`` or ``KEY=A,B,C``; numbers may have units. Raises RequestError."""
    key, equals, body = (part.strip() for part in text.partition("="))
    if not key or not equals or not body:
        raise RequestError(f"{option} {text}: write it as KEY=LO:HI:N, for example {option} launch.angle=10:60:51")
    if "~" in body:
        return _normal(scene, option, key, body)
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
    if not 1 <= count <= _MOST_VALUES:
        raise RequestError(f"{option} {text}: {parts[2]!r} is not a number of points from 1 to {_MOST_VALUES:,}")
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


def _normal(scene: Scene, option: str, key: str, body: str) -> Normal:
    """``MEAN~SD``. Raises RequestError."""
    before, _, after = (part.strip() for part in body.partition("~"))
    mean = checked(scene, option, key, toml_value(before))
    if not isinstance(mean, float):
        raise RequestError(
            f"{option} {key}: only numbers can be normally distributed; list values, separated by commas"
        )
    try:
        sd = units.parse(after, unit_of(scene, key))
    except ValueError as error:
        raise RequestError(f'{option} {key}={body}: the standard deviation "{after}" {error}') from None
    if not 0.0 < sd < inf:
        raise RequestError(f"{option} {key}={body}: the standard deviation must be more than 0, and finite")
    known = next((it for it in declared.walk(scene.parameters) if it.key == key.partition("[")[0]), None)
    return Normal(key, mean, sd, (-inf, inf) if known is None else known.bounds)


def parse_span(scene: Scene, option: str, text: str) -> Span:
    """``KEY=LO:HI``. Raises RequestError."""
    if text.count(":") != 1:
        raise RequestError(f"{option} {text}: write it as KEY=LO:HI, for example {option} launch.angle=5:75")
    axis = parse_axis(scene, option, text)
    assert isinstance(axis, Span)  # of two parts
    return axis


def as_axis(scene: Scene, key: str, given: Any, option: str = "over") -> Axis:
    """An axis from Python: a pair as a tuple is a span, ``"MEAN~SD"`` a normal distribution, any other sequence or
    array a list of values."""
    given = given.tolist() if isinstance(given, np.ndarray) else given
    if isinstance(given, str) and "~" in given:
        return _normal(scene, option, key, given)
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
    return _values(scene, key, values, lambda place: option)


def points_given(scene: Scene, given: Mapping[str, Any]) -> tuple[Values, ...]:
    """The values of each parameter at points in order, from Python. Raises RequestError."""
    axes: list[Values] = []
    for key, column in given.items():
        if isinstance(column, np.ndarray) and column.ndim != 1:
            raise RequestError(f"{key}: an array of shape {column.shape}; its shape must be (points,)")
        column = column.tolist() if isinstance(column, np.ndarray) else column
        if isinstance(column, str | Mapping) or not isinstance(column, Iterable):
            raise RequestError(f"{key} = {shortened(repr(column))}: must be an array or a list, with a value per point")
        values = list(column)
        if not values:
            raise RequestError(f"{key}: no values")
        axes.append(_values(scene, key, values, "point {},".format))
        if len(axes[-1].values) != len(axes[0].values):
            lengths = f"{key} has {len(axes[-1].values)} values, but {axes[0].key} has {len(axes[0].values)}"
            raise RequestError(f"{lengths}: each needs one per point")
    return tuple(axes)


def points_in(scene: Scene, option: str, path: FilePath) -> tuple[Values, ...]:
    """The values of each parameter at points in order, from a CSV file with the parameters' keys in its first line.
    Raises RequestError."""
    try:
        text = read_given(path, _LARGEST).decode("utf-8-sig")
        keys, *rows = [row for row in csv.reader(io.StringIO(text, newline=""), strict=True) if row] or [[]]
    except RequestError as error:
        raise RequestError(f"{option} {error}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise RequestError(f"{option} {path}: {error}") from None
    keys = [key.strip() for key in keys]
    if not rows:
        raise RequestError(f"{option} {path}: no points: the first line has keys, each line after it a point")
    for number, row in enumerate(rows):
        if len(row) != len(keys):
            raise RequestError(f"{option} {path}: point {number} has {len(row)} values, but there are {len(keys)} keys")
    columns = zip(keys, zip(*rows, strict=True), strict=True)
    where = f"{option} {path}: point {{}},".format
    return tuple(_values(scene, key, [toml_value(text.strip()) for text in texts], where) for key, texts in columns)


def _values(scene: Scene, key: str, values: list[Any], where: Callable[[int], str]) -> Values:
    """Values of a parameter in its declared unit. Raises RequestError, which says ``where`` by their places."""
    if len(values) > 2 and all(isinstance(value, int | float) and not isinstance(value, bool) for value in values):
        numbers = range(len(values))
        least, most = (best(numbers, key=values.__getitem__) for best in (min, max))
        odd = next((place for place in numbers if values[place] != values[place]), least)  # not a number
        low, *_ = (checked(scene, where(place), key, values[place]) for place in sorted({odd, least, most}))
        if isinstance(low, float):  # both ends are within bounds, so all of it is
            return Values(key, tuple(float(value) for value in values))
    return Values(key, tuple(checked(scene, where(place), key, value) for place, value in enumerate(values)))


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
    keys = {key, key.partition("[")[0]}  # balls[0].y has its own unit, air.wind[0] that of air.wind
    return next(
        (found.unit for found in declared.walk(scene.parameters, entries=True) if found.key in keys and found.unit), ""
    )


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
        implied = {key: value_at(scene.parameters, key) for key in keys}  # given at all, a key may imply others
        self._scene = scene = scene.changed({key: value for key, value in implied.items() if value is not None})
        self._paths = [path_of("over", key) for key in keys]
        self._keys = list(keys)
        self._quick = [_can_set_unchecked(scene.parameters, path) for path in self._paths]
        self._slow = [place for place, quick in enumerate(self._quick) if not quick]
        self._places: dict[str | int, Any] = {}  # of the values that are set unchecked, nested as the parameters are
        for place, path in enumerate(self._paths):
            if self._quick[place]:
                node = self._places
                for step in path[:-1]:
                    node = node.setdefault(step, {})
                node[path[-1]] = place
        self._bases: dict[str, SceneParameters] = {}

    def parameters(self, values: Sequence[Any]) -> SceneParameters:
        """The scene's parameters with ``values`` at the keys, in their order. Raises RequestError."""
        slow = {self._keys[place]: values[place] for place in self._slow}
        return _changed(self._base(slow) if slow else self._scene.parameters, self._places, values)

    def together(self, points: Sequence[Sequence[Any]]) -> Iterator[tuple[list[int], SceneParameters | Exception]]:
        """The places of points that differ only in numbers, and their parameters in one, with arrays for the numbers
        that differ; or the exception that explains why there are none."""
        groups: dict[str, list[int]] = {}
        for place, values in enumerate(points if self._slow else ()):
            groups.setdefault(repr([values[slow] for slow in self._slow]), []).append(place)
        for places in groups.values() if self._slow else [[*range(len(points))]] if len(points) else ():
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


def _changed(node: Any, places: Any, values: Sequence[Any]) -> Any:
    """A group, list or tuple with the values that have ``places`` in it, nested."""
    if isinstance(places, int):
        return values[places]
    if isinstance(node, Group):
        own = node.__dict__
        changed = {key: _changed(own[key], inner, values) for key, inner in places.items()}
        return _with(node, {**own, **changed})
    return type(node)(_changed(item, places[at], values) if at in places else item for at, item in enumerate(node))


def _with(group: Group, values: dict[str, Any]) -> Group:
    """A group with these values, as pydantic's own copy makes one, in a quarter of the time: a sweep needs millions."""
    made = object.__new__(type(group))
    object.__setattr__(made, "__dict__", values)
    for name in ("__pydantic_fields_set__", "__pydantic_extra__", "__pydantic_private__"):
        object.__setattr__(made, name, getattr(group, name))
    return made
