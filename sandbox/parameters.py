"""Parameters of a scene: each number declared once, with unit, bounds and meaning.

A scene declares its parameters as nested groups::

    class Throw(Group):
        speed: float = quantity(76.44, "m/s", low=0, high=340, meaning="ball speed after impact")
        angle: float = quantity(10.4, "deg", low=-90, high=180, meaning="above the horizontal")

    class Parameters(SceneParameters):
        launch: Throw = group(Throw(), "how the ball starts")

That declaration feeds the reading of scene files, ``--set``, the JSON schema, sliders and documentation. A default of
``...`` is in the scene's own file, ``<name>.toml``, on which every other file of the scene is based.
Values are floats in the declared unit; a string may carry a unit of its own (``"171 mph"``).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Sized
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import takewhile
from numbers import Real
from pathlib import Path
from types import EllipsisType
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, TypeVar, get_args, get_origin

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError
from pydantic.errors import PydanticUndefinedAnnotation, PydanticUserError
from pydantic.fields import FieldInfo

from sandbox import units
from sandbox.errors import RequestError
from sandbox.files import from_here
from sandbox.physics.integrators import INTEGRATORS
from sandbox.text import check_mapping, nearest
from sandbox.toml import short_toml, toml_value

# ---------------------------------------------------------------------------------------------------------------------
# Declaring
# ---------------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Quantity:
    """The declaration of a number: its unit, its inclusive bounds, and its shape."""

    unit: str
    low: float
    high: float
    length: int | None = None  # of a vector; None for a single number
    several: bool = False  # a list of vectors
    optional: bool = False

    def read(self, value: Any) -> Any:
        """``value`` in the declared unit; ValueError says what is wrong with it."""
        if value is None and self.optional:
            return None
        if self.length is None:
            return self._number(value)
        if not self.several:
            return self._vector(value, self.length)
        if not _is_list(value):
            raise ValueError(f"must be a list such as [{[0.0] * self.length}, {[1.0] * self.length}]")
        return list(_each(value, partial(self._vector, length=self.length)))

    def _vector(self, value: Any, length: int) -> tuple[float, ...]:
        if not _is_list(value) or len(value) != length:
            raise ValueError(f"must be a list of {length} numbers, each {self.range}, such as {[0.0] * length}")
        return tuple(_each(value, self._number))

    def _number(self, value: Any) -> float:
        if isinstance(value, str):
            number = units.parse(value, self.unit)
        elif isinstance(value, Real) and not isinstance(value, bool):
            try:
                number = float(value)
            except OverflowError:
                number = math.inf
        else:
            raise ValueError(f"must be a number {self.range}")
        if not math.isfinite(number):
            raise ValueError(f"must be a finite number {self.range}")
        if not self.low <= number <= self.high:
            found = f", and this is {number:.10g} {self.unit}".rstrip() if isinstance(value, str) else ""
            raise ValueError(f"must be {self.range}{found}")
        return number

    @property
    def range(self) -> str:
        """The bounds for people: ``"from 0 to 340 m/s"``."""
        return f"from {self.low:.10g} to {self.high:.10g} {self.unit}".rstrip()

    def __call__(self, schema: dict[str, Any]) -> None:
        """Write the JSON schema of this number; ``schema`` is what pydantic knows of it."""
        number: dict[str, Any] = {"type": "number", "minimum": self.low, "maximum": self.high}
        ending = "|".join(other.replace("^", r"\^") for other in units.alternatives(self.unit) if other)
        signed = self.low < 0.0 or units.has_offsets(self.unit)
        value = units.NUMBER if signed else units.NUMBER.replace("[+-]?", r"\+?", 1)
        text = {"type": "string", "pattern": rf"^\s*{value}\s*({ending})?\s*$"}
        either: dict[str, Any] = {"anyOf": [number, text]}
        if self.length is not None:
            either = {"type": "array", "items": either, "minItems": self.length, "maxItems": self.length}
        if self.several:
            either = {"type": "array", "items": either}
        description = f"{schema.get('description', '')} ({self.range})".strip()
        default = schema.get("default")
        schema.clear()
        schema.update(description=description, **({} if default is None else {"default": default}), **either)
        schema["unit"] = self.unit


def quantity(default: float | str | EllipsisType | None, unit: str, low: float, high: float, meaning: str) -> Any:
    """A number with ``unit`` and inclusive bounds ``low`` and ``high``; a default of None makes it optional."""
    return _declared(default, meaning, Quantity(unit, float(low), float(high), optional=default is None))


def vector(default: tuple[float | str, ...] | EllipsisType, unit: str, low: float, high: float, meaning: str) -> Any:
    """A tuple as long as ``default`` (two for ``...``), each number with ``unit`` and bounds; declare it as
    ``tuple[float, float]``."""
    length = 2 if isinstance(default, EllipsisType) else len(default)
    return _declared(default, meaning, Quantity(unit, float(low), float(high), length=length))


def vectors(
    default: list[tuple[float, ...]] | EllipsisType, length: int, unit: str, low: float, high: float, meaning: str
) -> Any:
    """A list of vectors of ``length`` numbers, such as points; declare it as ``list[tuple[float, float]]``."""
    return _declared(default, meaning, Quantity(unit, float(low), float(high), length=length, several=True))


def _is_list(value: Any) -> bool:
    return isinstance(value, Iterable) and isinstance(value, Sized) and not isinstance(value, str | bytes | Mapping)


_Read = TypeVar("_Read")


def _each(values: Iterable[Any], read: Callable[[Any], _Read]) -> Iterator[_Read]:
    """Every item as it is read; an error names the item, since the message shows the whole list."""
    for item in values:
        try:
            yield read(item)
        except ValueError as error:
            raise ValueError(f"{short_toml(item)}: {error}") from None


def _declared(default: Any, meaning: str, kind: Quantity) -> Any:
    if kind.unit not in units.KIND_OF:
        meant = units.suggestion(kind.unit)
        known = f"did you mean {meant}?" if meant else f"use one of {', '.join(filter(None, units.KIND_OF))}."
        raise ValueError(f'"{kind.unit}" is not a known unit: {known} A number without a unit has ""')
    if kind.low > kind.high:
        raise ValueError(f"the lowest value, {kind.low:g}, is above the highest, {kind.high:g}")
    field = Field(default, description=meaning, json_schema_extra=kind)
    field.metadata.append(BeforeValidator(kind.read))
    return field


def choice(default: str | EllipsisType | None, meaning: str) -> Any:
    """One of several words; declare it as ``Literal["launch", "club"]``."""
    return Field(default, description=meaning)


def text(meaning: str, may_be_empty: bool = False) -> Any:
    """A text of 40 characters at most, such as a name; declare it as ``str``."""
    return Field(description=meaning, min_length=0 if may_be_empty else 1, max_length=40)


def switch(default: bool | EllipsisType, meaning: str) -> Any:
    """True or false; declare it as ``bool``."""
    return Field(default, description=meaning, strict=True)


def group(default: Group | EllipsisType, meaning: str) -> Any:
    """A group of parameters with its own heading; keys that a file leaves out are those of ``default``."""
    return Field(default, description=meaning)


def groups(default: list[Any] | EllipsisType, meaning: str) -> Any:
    """A list of groups, ``[[balls]]`` in a file; declare it as ``list[Target]``. A file replaces the whole list."""
    return Field(default, description=meaning)


def one_of(default: Group | EllipsisType, meaning: str, by: str = "model") -> Any:
    """One of several groups, chosen by the word at the key ``by``; declare it as ``ConstantDrag | NoDrag``.

    Each group declares its word as ``model: Literal["constant"] = choice("constant", "...")``.
    """
    return Field(default, description=meaning, discriminator=by)


class Group(BaseModel):
    """Base of all groups of parameters: frozen, unknown keys refused, defaults checked like any other value."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, validate_default=True, protected_namespaces=(), defer_build=True
    )

    @classmethod
    def with_implied(cls, changes: Mapping[str, Any]) -> Mapping[str, Any]:
        """Nested ``changes`` with others that they imply, such as how a shot begins where its components are given."""
        return changes


if TYPE_CHECKING:
    IntegratorName = str
else:
    IntegratorName = Literal[tuple(INTEGRATORS)]


class Accuracy(Group):
    """The computing time to spend; common to all scenes. A key left out follows from the level."""

    level: Literal["fast", "balanced", "precise"] = choice("balanced", "the speed-accuracy trade-off")
    tolerance: float | None = quantity(None, "m", 1e-12, 1.0, "error allowed in each step of the motion")
    method: Literal["exact", "plain"] | None = choice(
        None, "exact: stop at the moment of contact; plain: pymunk alone, at a fixed step"
    )
    integrator: IntegratorName | None = choice(None, "the integrator of the motion")
    step: float | None = quantity(None, "s", 1e-6, 0.1, "fixed step, instead of one that follows the tolerance")


class SceneParameters(Group):
    """Base of the Parameters of a scene: what all scenes have."""

    #: Lists that belong together: a scene file that has one of them has only those that it gives.
    TOGETHER: ClassVar[Sequence[str]] = ()

    accuracy: Accuracy = group(Accuracy(), "the speed-accuracy trade-off")

    @classmethod
    def layered(cls, values: Mapping[str, Any], file: Mapping[str, Any]) -> dict[str, Any]:
        """Nested ``values`` with those of a scene file over them."""
        missing = [name for name in cls.TOGETHER if name not in file]
        emptied = {name: list[Any]() for name in missing} if len(missing) < len(cls.TOGETHER) else {}
        return _with_changes(cls, values, {**file, **emptied})


def problem_with(schema: type[Group]) -> str | None:
    """Return the error in the types that a group declares, in a line; None if there is none."""
    try:
        schema.model_rebuild()
    except (PydanticUserError, PydanticUndefinedAnnotation) as error:
        return str(error).partition("\n")[0]
    return None


# ---------------------------------------------------------------------------------------------------------------------
# Looking at what was declared
# ---------------------------------------------------------------------------------------------------------------------


class Parameter(NamedTuple):
    """One parameter with its declaration, for sliders, sweeps and documentation."""

    key: str  # dotted
    value: Any  # in ``unit``
    unit: str | None  # None for words and switches, "" for a number without a unit
    low: float | None
    high: float | None
    choices: tuple[Any, ...]  # of a word; empty for numbers
    meaning: str
    optional: bool = False  # whether it may be left out

    @property
    def bounds(self) -> tuple[float, float]:
        """Lowest and highest value, infinite where there is no bound."""
        return -math.inf if self.low is None else self.low, math.inf if self.high is None else self.high

    def within(self, number: float) -> float:
        """The number, or the bound that it exceeds."""
        assert self.low is not None
        assert self.high is not None
        return min(max(number, self.low), self.high)


def walk(parameters: Group, prefix: str = "", entries: bool = False) -> Iterator[Parameter]:
    """All parameters in order of declaration with their values, accuracy last; ``walk(Parameters())`` gives the
    defaults. With ``entries`` those of lists stand in place of the list: ``balls[0].mass``, ``air.wind[0]``."""
    for name, field in sorted(type(parameters).model_fields.items(), key=lambda item: item[0] == "accuracy"):
        value, key = getattr(parameters, name), prefix + name
        if isinstance(value, Group):
            yield from walk(value, f"{key}.", entries)
            continue
        if entries and isinstance(value, list) and all(isinstance(entry, Group) for entry in value):
            for place, entry in enumerate(value):
                yield from walk(entry, f"{key}[{place}].", entries)
            continue
        declared = field.json_schema_extra
        unit, low, high = (
            (declared.unit, declared.low, declared.high) if isinstance(declared, Quantity) else (None,) * 3
        )
        meaning, optional = field.description or "", type(None) in get_args(field.annotation)
        vector = entries and isinstance(value, tuple)
        numbers = {f"{key}[{place}]": number for place, number in enumerate(value)} if vector else {key: value}
        for each, number in numbers.items():
            yield Parameter(each, number, unit, low, high, words_of(field.annotation), meaning, optional)


def value_at(parameters: Any, key: str) -> Any:
    """The value at a dotted key; None where there is none."""
    for part in key.replace("[", ".").replace("]", "").split("."):
        if isinstance(parameters, list | tuple):
            parameters = parameters[int(part)] if int(part) < len(parameters) else None
        else:
            parameters = getattr(parameters, part, None)
    return parameters


def words_of(annotation: Any) -> tuple[Any, ...]:
    """The words that a field of this type may hold."""
    if get_origin(annotation) is Literal:
        return get_args(annotation)
    return tuple(word for part in get_args(annotation) for word in words_of(part))


def groups_of(annotation: Any) -> tuple[type[Group], ...]:
    """The groups that a field of this type may hold: one, several to choose from, or those of a list."""
    hashable: Any = annotation
    return _groups_in(hashable)


@lru_cache(maxsize=4096)
def _groups_in(annotation: Any) -> tuple[type[Group], ...]:
    if isinstance(annotation, type) and issubclass(annotation, Group):
        return (annotation,)
    return tuple(found for part in get_args(annotation) for found in _groups_in(part))


def known_keys(schema: type[Group], values: Any = None, prefix: str = "") -> list[str]:
    """Every dotted key that a scene file may have, headings included; its ``values`` choose between groups."""
    keys: dict[str, None] = {}
    for name, field in schema.model_fields.items():
        keys[prefix + name] = None
        table = values.get(name) if isinstance(values, Mapping) else None
        for inner in groups_of(field.annotation):
            if _chosen(field, inner, table):
                keys |= dict.fromkeys(known_keys(inner, table, f"{prefix}{name}."))
    return list(keys)


def _chosen(field: FieldInfo, inner: type[Group], table: Any) -> bool:
    """True if the ``table`` of a file is for the group ``inner``, one of those that the field may have."""
    tag = field.discriminator
    word = table.get(tag) if isinstance(tag, str) and isinstance(table, Mapping) else None
    return word is None or word in get_args(inner.model_fields[str(tag)].annotation)


def every_key(schema: type[Group], prefix: str = "") -> Iterator[str]:
    """The dotted key of every single parameter, whichever groups are chosen; a list of groups is one parameter."""
    for name, field in schema.model_fields.items():
        inner = groups_of(field.annotation)
        if not inner or get_origin(field.annotation) is list:
            yield prefix + name
        else:
            for chosen in inner:
                yield from every_key(chosen, f"{prefix}{name}.")


# ---------------------------------------------------------------------------------------------------------------------
# Reading
# ---------------------------------------------------------------------------------------------------------------------


def parse_assignment(text: str) -> tuple[str, Any]:
    """``key.path=value`` as a dotted key and a value, read as TOML, or as a string if it is not valid TOML."""
    key, equals, value = text.partition("=")
    key, value = key.strip(), value.strip()
    if not equals or not all(part.strip() for part in key.split(".")):
        raise RequestError(f'--set {text}: write it as key.path=value, for example --set launch.speed="171 mph"')
    return key, toml_value(value)


def merged(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """``base`` with ``changes`` applied: tables are merged, all other values, lists too, are replaced."""
    result = dict(base)
    for key, value in changes.items():
        old = result.get(key)
        result[key] = merged(old, value) if isinstance(old, Mapping) and isinstance(value, Mapping) else value
    return result


def _with_changes(schema: type[Group], values: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Nested ``values`` with nested ``changes`` applied, and what these imply; where they choose another drag model,
    say, the keys of the old one are dropped."""
    changes = schema.with_implied(changes)
    return _without_leftovers(schema, merged(values, changes), changes)


_Schema = TypeVar("_Schema", bound=Group)


def validate(
    schema: type[_Schema],
    values: Mapping[str, Any],
    source: str | Path = "",
    changes: Mapping[str, Any] | None = None,
    changed_by: str = "override",
) -> _Schema:
    """Check the nested ``values`` of ``source`` (a file, or its name in messages) with ``changes`` applied.

    Raises RequestError with a line that names file (or ``changed_by``), key, value, bound and unit.
    """
    tables = _with_changes(schema, _defaults(schema), values)
    changes = _nested(changes or {}, tables, changed_by)
    combined = _with_changes(schema, tables, changes)
    try:
        return schema.model_validate(combined)
    except ValidationError as failure:
        errors = failure.errors(include_url=False)
    source = from_here(source) if isinstance(source, Path) else source
    lines = dict.fromkeys(_explained(schema, error, combined, source, changes, changed_by) for error in errors)
    first, *others = lines
    more = f"\n(and {len(others)} more: {others[0]}{', ...' if len(others) > 1 else ''})" if others else ""
    raise RequestError(first + more)


def changed(parameters: _Schema, changes: Mapping[str, Any], by: str = "override") -> _Schema:
    """The parameters with some of them changed, by key. Raises RequestError for an invalid value."""
    check_mapping("parameters", changes, '{"launch.speed": 70.0}')
    return validate(type(parameters), parameters.model_dump(), "", changes, by)


def without_indices(parameters: Group, changes: Mapping[str, Any], by: str = "override") -> dict[str, Any]:
    """The same changes without indices in their keys: for ``air.wind[0]`` the whole list ``air.wind`` is given."""
    after = changed(parameters, changes, by)
    return {
        key.partition("[")[0]: value_at(after, key.partition("[")[0]) if "[" in key else value
        for key, value in changes.items()
    }


@lru_cache(maxsize=1024)
def _defaults(schema: type[Group]) -> Mapping[str, Any]:
    """Return the defaults, which a file may leave out; not to be changed."""
    tables: dict[str, Any] = {}
    for name, field in schema.model_fields.items():
        if isinstance(field.default, Group):
            tables[name] = field.default.model_dump()
        elif not field.is_required():
            tables[name] = field.default
        elif isinstance(field.annotation, type) and issubclass(field.annotation, Group):
            tables[name] = _defaults(field.annotation)
    return {name: value for name, value in tables.items() if value != {}}


def _nested(changes: Mapping[str, Any], tables: Mapping[str, Any], by: str) -> dict[str, Any]:
    """``{"launch.speed": 70}`` as ``{"launch": {"speed": 70}}``; later keys override earlier ones. For ``air.wind[0]``
    the whole list is given, with the other entries that it has in ``tables`` or by an earlier key."""
    found: dict[str, Any] = {}
    for key, value in changes.items():
        steps = path_of(by, key)
        names = list(takewhile(lambda step: isinstance(step, str), steps))
        _check_keys(value, f"{by} {key}")
        if len(names) < len(steps):
            node: Any = merged(tables, found)
            for name in names:
                node = node.get(name, _UNKNOWN) if isinstance(node, Mapping) else _UNKNOWN
            if node is not _UNKNOWN:  # else it is refused like any unknown key
                value = _with_value_at(node, steps[len(names) :], value, f"{by} {key}")
        for name in reversed(names):
            value = {name: value}
        found = merged(found, value)
    return found


def _check_keys(value: Any, what: str) -> None:
    """Raise RequestError for a table with a key that is not a string, which is possible in Python only."""
    if isinstance(value, Mapping):
        for key, inside in value.items():
            if not isinstance(key, str):
                raise RequestError(f"{what}: {key!r} in it is not a key; a key is a string, such as speed")
            _check_keys(inside, f"{what}.{key}")


_UNKNOWN = object()
_STEP = re.compile(r"([^.\[\]]+)|\[(\d+)\]")


def path_of(option: str, key: str) -> tuple[str | int, ...]:
    """``"air.wind[0]"`` as ``("air", "wind", 0)``."""
    if not isinstance(key, str):
        raise RequestError(f"{option} {key!r}: a key is a string, such as launch.speed")
    steps = tuple(name or int(number) for name, number in _STEP.findall(key))
    if "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps) != f".{key}":
        raise RequestError(f"{option} {key}: a key is written like launch.speed, or air.wind[0] for one of a list")
    return steps


def choices_of(parameters: Any, key: str) -> tuple[Any, ...]:
    """The words that a parameter can be, also those that make another kind of group of the one it is in."""
    try:
        *groups, name = path_of("models", key)
    except RequestError:
        return ()
    kinds: tuple[Any, ...] = (type(parameters),)
    for step in groups:
        fields = [kind.model_fields[step] for kind in kinds if step in kind.model_fields]
        kinds = tuple(kind for field in fields for kind in groups_of(field.annotation))
    words = [words_of(kind.model_fields[name].annotation) for kind in kinds if name in kind.model_fields]
    return tuple(dict.fromkeys(word for some in words for word in some))


def _with_value_at(node: Any, path: Sequence[str | int], value: Any, what: str) -> Any:
    """``node``, a list or a group in one, with ``value`` at ``path``."""
    if not path:
        return value
    head, *rest = path
    if isinstance(head, str):
        table = node.model_dump() if isinstance(node, Group) else node if isinstance(node, Mapping) else {}
        return {**table, head: _with_value_at(table.get(head), rest, value, what)}
    if not isinstance(node, list | tuple):
        raise RequestError(f"{what}: is not a list, so it has no [{head}]")
    if head >= len(node):
        length = f"the list has {len(node)}, the first is [0]" if node else "the list is empty"
        raise RequestError(f"{what}: there is no [{head}]; {length}")
    return [*node[:head], _with_value_at(node[head], rest, value, what), *node[head + 1 :]]


def _without_leftovers(schema: type[Group], tables: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Drop the keys of the old kind where ``changes`` choose another kind of group."""
    result = dict(tables)
    for name, field in schema.model_fields.items():
        table, change = result.get(name), changes.get(name)
        if not isinstance(table, dict) or not isinstance(change, Mapping):
            continue
        for inner in groups_of(field.annotation):
            if field.discriminator is None:
                result[name] = _without_leftovers(inner, table, change)
            elif field.discriminator in change and _chosen(field, inner, change):
                result[name] = {k: v for k, v in table.items() if k in inner.model_fields or k in change}
    return result


# ---------------------------------------------------------------------------------------------------------------------
# Explaining
# ---------------------------------------------------------------------------------------------------------------------


def _explained(
    schema: type[Group],
    error: Any,
    values: Mapping[str, Any],
    source: str,
    changes: Mapping[str, Any],
    changed_by: str,
) -> str:
    """One line for one error of pydantic's."""
    key, dotted = _path(error["loc"], values, missing=error["type"] == "missing")
    value = error["input"]
    if error["type"] == "union_tag_invalid":
        word = error["ctx"]["discriminator"].strip("'")
        key, dotted, value = f"{key}.{word}", (*dotted, word), value[word]
    prefix = f"{changed_by} " if _holds(changes, dotted) else f"{source}: " if source else ""
    if error["type"] == "extra_forbidden":
        return f"{prefix}{key}: unknown key{_suggestion(key, '.'.join(dotted), schema, values)}"
    if error["type"] == "missing":
        return f"{prefix}{key}: missing"
    problem = f"{_problem(error)}{_key_that_takes(value, schema, dotted)}"
    return f"{prefix}{key} = {short_toml(value)}: {problem}" if key else f"{prefix}{problem}"


def _path(loc: tuple[int | str, ...], values: Any, missing: bool) -> tuple[str, tuple[str, ...]]:
    """Return the place in the file: as shown (``balls[1].x``) and without positions in lists (``("balls", "x")``).

    pydantic puts the word that chose a group between its key and the group's own; the file has no such level.
    """
    shown, dotted = "", []
    for index, item in enumerate(loc):
        if isinstance(item, int):
            shown += f"[{item}]"
            values = values[item] if isinstance(values, list) and item < len(values) else None
        elif (isinstance(values, Mapping) and item in values) or (missing and index == len(loc) - 1):
            shown += f".{item}" if shown else item
            dotted.append(item)
            values = values.get(item) if isinstance(values, Mapping) else None
    return shown, tuple(dotted)


def _key_that_takes(word: Any, schema: type[Group], path: Sequence[str]) -> str:
    """The end of a message about a word in place of a group: its key that takes this word; "" if there is none."""
    inside: list[type[Group]] = [schema]
    for part in path:
        inside = [
            g for group in inside if part in group.model_fields for g in groups_of(group.model_fields[part].annotation)
        ]
    fields = ((name, field) for group in inside for name, field in group.model_fields.items())
    name = next((name for name, field in fields if isinstance(word, str) and word in words_of(field.annotation)), None)
    return f"; did you mean {'.'.join(path)}.{name} = {short_toml(word)}?" if name is not None else ""


def _holds(tables: Any, path: tuple[str, ...]) -> bool:
    """True if the nested tables have something at ``path`` (inside a list: anywhere in it)."""
    for part in path:
        if isinstance(tables, list):
            return True
        if not isinstance(tables, Mapping) or part not in tables:
            return False
        tables = tables[part]
    return bool(path)


def _suggestion(shown: str, key: str, schema: type[Group], values: Mapping[str, Any]) -> str:
    """Return the end of a message about an unknown key, ``shown`` as ``balls[1].x``: the key probably meant."""
    inside = key.rpartition(".")[0]
    for word in _words_for(key, schema):
        return f" here; it belongs to {inside}.{word}"
    known = known_keys(schema, values)
    near = nearest(key, known)
    if near is not None:
        if near.rpartition(".")[0] == inside:
            near = shown.removesuffix(key.rpartition(".")[2]) + near.rpartition(".")[2]
        return f"; did you mean {near}?"
    siblings = [k.rpartition(".")[2] for k in known if k.rpartition(".")[0] == inside]
    return f"; {inside or 'the scene'} has {', '.join(siblings)}" if siblings else ""


def _words_for(key: str, schema: type[Group]) -> Iterator[str]:
    """The choices, such as ``model = "constant"``, with which a group would have ``key``."""
    *path, last = key.split(".")
    fields = [FieldInfo(annotation=schema)]
    for part in path:
        inner = [g for field in fields for g in groups_of(field.annotation) if part in g.model_fields]
        fields = [g.model_fields[part] for g in inner]
    for field in fields:
        tag = field.discriminator
        for g in groups_of(field.annotation):
            if isinstance(tag, str) and last in g.model_fields:
                yield f"{tag} = {short_toml(get_args(g.model_fields[tag].annotation)[0])}"


def wrong_group(error: ValidationError) -> str:
    """The problem with a group that was made in Python, in a line."""
    first, *others = error.errors(include_url=False)
    key, more = ".".join(map(str, first["loc"])), f" (and {len(others)} more)" if others else ""
    if first["type"] == "missing":
        remedy = f'give it one, or write group(..., "...") in place of {error.title}(): then the scene\'s file has it'
        return f"{error.title}: {key} has no default{more}; {remedy}"
    return f"{error.title}: {key} = {short_toml(first['input'])}: {_problem(first)}{more}"


def _problem(error: Any) -> str:
    """Return what is wrong, in words; ``error`` is one of pydantic's."""
    context = error.get("ctx", {})
    match error["type"]:
        case "value_error":
            return str(context["error"])
        case "literal_error" | "union_tag_invalid":
            expected = str(context.get("expected") or context.get("expected_tags")).replace("'", '"')
            return f"must be {' or '.join(expected.replace(' or ', ', ').rsplit(', ', 1))}"
        case "bool_type":
            return "must be true or false"
        case "string_type":
            return "must be text in quotes"
        case "list_type" | "tuple_type":
            return "must be a list"
        case "model_type" | "model_attributes_type" | "dict_type":
            return "must be a group of keys, not a single value"
        case _:
            return re.sub(r"^\w+ should", "must", error["msg"])
