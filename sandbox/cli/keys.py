"""All keys of a scene file as a table for people."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, get_origin

from pydantic_core import PydanticUndefined

from sandbox.lab.tables import table
from sandbox.parameters import Group, Quantity, groups_of, words_of
from sandbox.text import toml_text


def key_table(parameters: Group) -> list[str]:
    """Every key of a scene file with its default, unit, bounds or words, and meaning; also those of other choices."""
    rows: dict[str, list[str]] = {}
    for row in _key_rows(parameters):
        rows.setdefault(row[0], row)
    return table(("key", "default", "unit", "from, to", "what it is"), rows.values(), "lllll", indent="")


def _key_rows(group: Group | type[Group], prefix: str = "", needs: str = "") -> Iterator[list[str]]:
    """The rows of a group, or of one that is not chosen, whose keys need another word: ``model = "constant"``."""
    fields = (group if isinstance(group, type) else type(group)).model_fields
    for name, field in sorted(fields.items(), key=lambda item: item[0] == "accuracy"):
        key, about, inner = prefix + name, field.description or "", groups_of(field.annotation)
        value = getattr(group, name, None) if isinstance(group, Group) else field.get_default()
        declared, words, tag = field.json_schema_extra, words_of(field.annotation), field.discriminator
        meaning = f"{about} (with {needs})" if needs else about
        if isinstance(tag, str):
            chosen = sorted(inner, key=lambda each: not isinstance(value, each))
            words = tuple(word for each in inner for word in words_of(each.model_fields[tag].annotation))
            default = getattr(value, tag, None)
            yield [f"{key}.{tag}", _as_written(default), "", _one_of(words), about]
            for each in chosen:
                other = words_of(each.model_fields[tag].annotation)[:1]
                rest = _key_rows(
                    *((value, f"{key}.") if each is type(value) else (each, f"{key}.", f"{tag} = {_one_of(other)}"))
                )
                yield from (row for row in rest if row[0] != f"{key}.{tag}")
        elif inner and isinstance(value, Group):
            yield from _key_rows(value, f"{key}.", needs)
        elif inner and get_origin(field.annotation) is not list:
            yield from _key_rows(inner[0], f"{key}.", needs)
        else:
            bounds = f"{declared.low:.10g}, {declared.high:.10g}" if isinstance(declared, Quantity) else _one_of(words)
            unit = declared.unit if isinstance(declared, Quantity) else ""
            default = "" if inner and value else _as_written(value)
            yield [f"[[{key}]]" if inner else key, default, unit, bounds, meaning]
            if inner:
                yield from _key_rows(inner[0], f"{key}[].", needs)


def _as_written(value: Any) -> str:
    """A default as a scene file has it; "" for a key that has none."""
    return "" if value is None or value is PydanticUndefined else toml_text(value)


def _one_of(words: Sequence[Any]) -> str:
    return " | ".join(map(toml_text, words))
