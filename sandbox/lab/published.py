"""Published numbers: the tables in the folders ``published`` of the scenes, each row with its source.

A table is ``published/NAME.csv`` in the folder of its scene, with the columns preset, case, set, result, value,
tolerance, unit, source, reason, kind, tests, tolerance_from: ``preset`` is empty for the scene itself, ``set`` holds
``key=value`` separated by ``;``, ``result`` is a key of the scene's result, with dots into lists and tables, ``kind``
is one of KINDS, ``tests`` names the effects that the number is to show (see teeth.py), and ``tolerance_from`` says what
the tolerance is: the uncertainty of the measurement, or why it is not. With a column ``vary``, ranges of one or two
parameters (``launch.angle=46:60``), a row is of the launch among these of which a practised player scores most often:
its result is one of the parameters, or the share. A table in another format has a ``NAME.toml`` next to it that maps
its columns to such rows.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sandbox.errors import RequestError
from sandbox.parameters import parse_assignment
from sandbox.scene.discovery import installed_folders
from sandbox.toml import read_toml

#: What a published number is. Only those of COUNTED say how true a model is.
KINDS = {
    "exact": "a closed form, or a solution to many digits",
    "fitted": "a constant of the model, or of the scene, was chosen to meet it",
    "program": "computed by another program",
    "model": "computed by another model, or a rule of thumb",
    "measured": "measured, and used for no constant",
    "held-out": "measured; others of the same set were fitted, this one was not",
}
COUNTED = ("measured", "held-out")


@dataclass(frozen=True)
class Case:
    """One published number, or one published word."""

    scene: str  # with its preset
    set: str  # changed parameters, as written in the table
    name: str  # as shown
    result: str
    value: str
    tolerance: float | None  # in ``unit``; None for words
    unit: str
    source: str
    reason: str  # why it does not match, if known
    kind: str  # of KINDS
    tests: str  # effects that it is to show: causes of forces, keys of parameters, or key=value; separated by ``;``
    tolerance_from: str  # what the tolerance is
    preset: str = field(default="", kw_only=True)
    vary: str = field(default="", kw_only=True)  # ranges, ``key=low:high``, separated by ``;``

    @property
    def sport(self) -> str:
        """The scene without its preset."""
        return self.scene.removesuffix(f"/{self.preset}") if self.preset else self.scene


def tables_of(folder: Path) -> list[Path]:
    """The published tables in the folder of a scene."""
    return sorted((folder / "published").glob("*.csv"))


def form_of(table: Path) -> Path | None:
    """The file that says how the rows of a table in another format are read; None for a table in the usual one."""
    form = table.with_suffix(".toml")
    return form if form.is_file() else None


def cases() -> Iterator[Case]:
    """Every published number of the installed scenes."""
    for scene, folder in sorted(installed_folders().items()):
        yield from cases_of(scene, folder)


def cases_of(scene: str, folder: Path) -> Iterator[Case]:
    """The published numbers of a scene that came with the sandbox, or with an installed package."""
    for path in tables_of(folder):
        form = form_of(path)
        if form is not None:
            yield from cases_by_form(scene, path, form)
        else:
            yield from (_case(scene, row) for row in _rows(path))


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def _case(scene: str, row: Mapping[str, str]) -> Case:
    given = dict(row)
    name, tolerance, preset = (given.pop(column) for column in ("case", "tolerance", "preset"))
    return Case(
        scene=with_preset(scene, preset),
        name=name,
        tolerance=float(tolerance) if tolerance else None,
        preset=preset,
        **given,
    )


def with_preset(scene: str, preset: str) -> str:
    """The preset of a scene as it is loaded."""
    return f"{scene}/{preset}" if preset else scene


def cases_by_form(scene: str, path: Path, file: Path) -> Iterator[Case]:
    """The cases of a table in another format. In its form, ``{column}`` stands for the row's value in that column.

    It has ``name``, ``source``, ``kind``, ``set``; ``value``, ``unit``, ``tolerance``, ``tests`` and ``tolerance_from``
    of each of ``results``, with the rows that it does not have as ``unless``, words by column; and ``reasons`` by name
    and result. Raises RequestError where a key or a column is missing.
    """
    form = read_toml(file)
    try:
        for row in _rows(path):
            name = form["name"].format(**row)
            settings = "; ".join(f"{key}={value.format(**row)}" for key, value in form["set"].items())
            for result, how in form["results"].items():
                if any(row[column] in words for column, words in how.get("unless", {}).items()):
                    continue
                reason = form.get("reasons", {}).get(f"{name} {result}", "")
                value, source, kind = (text.format(**row) for text in (how["value"], form["source"], form["kind"]))
                allowed = float(str(how["tolerance"]).format(**row)), how["unit"]
                last = kind, how["tests"].format(**row), how["tolerance_from"]
                yield Case(scene, settings, name, result, value, *allowed, source, reason, *last)
    except KeyError as error:
        raise RequestError(f"{file}: needs {error}, as a key, or as a column of {path.name}") from None


def assignments(text: str) -> dict[str, Any]:
    """``key=value; key=value`` as a dictionary."""
    return dict(parse_assignment(part) for part in text.split(";") if part.strip())
