"""What editors complete and check scene files by: every shipped file points at its schema, which is in step."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator

from sandbox import resources
from sandbox.scene import parameters_of
from sandbox.schema import json_schema

SCENES = sorted(path.parent for path in resources.folder("scenes").glob("*/scene.py"))
FILES = sorted(
    file
    for name in ("scenes", "template", "template_above")
    for file in resources.folder(name).rglob("*.toml")
    if file.name not in ("colours.toml", "tables.toml")  # of a picture; of billiards
    and file.parent.name != "tasks"
)


def read(folder: Path) -> Any:
    return json.loads((folder / f"{folder.name}.schema.json").read_text("utf-8"))


@pytest.mark.parametrize("folder", SCENES, ids=lambda folder: folder.name)
def test_a_schema_is_in_step_with_its_scene(folder: Path):
    name, parameters = parameters_of(folder)
    assert read(folder) == json.loads(json.dumps(json_schema(parameters, name))), "make schemas"


@pytest.mark.parametrize("folder", SCENES, ids=lambda folder: folder.name)
def test_a_schema_is_one(folder: Path):
    Draft7Validator.check_schema(read(folder))


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}/{file.name}")
def test_a_scene_file_points_at_its_schema(file: Path):
    """The first line, as TOML extensions of editors read it."""
    folder = file.parent.parent if file.parent.name == "presets" else file.parent
    expected = folder / f"{folder.name}.schema.json"
    directive, _, path = file.read_text("utf-8").partition("\n")[0].partition(" ")
    assert (directive, (file.parent / path).resolve()) == ("#:schema", expected.resolve())


@pytest.mark.parametrize("folder", SCENES, ids=lambda folder: folder.name)
def test_the_shipped_files_are_in_order(folder: Path):
    checker = Draft7Validator(read(folder))
    for file in (file for file in FILES if folder in file.parents):
        assert [error.message for error in checker.iter_errors(tomllib.loads(file.read_text("utf-8")))] == []


@pytest.mark.parametrize(
    "text",
    [
        "[launch]\nspede = 70.0",
        "[launch]\nspeed = -1.0",
        '[launch]\nspeed = "70 kg"',
        '[launch]\nspeed = "7.0.1 m/s"',
        "[launch]\nspeed = true",
        '[accuracy]\nlevel = "best"',
        "[air]\nwind = [1.0]",
        '[ball.drag]\nmodel = "feather"',
        'scene = "chess"',
        'scene = "golf/"',
        "launches = 1",
    ],
)
def test_a_mistake_is_seen(text: str):
    folder = next(folder for folder in SCENES if folder.name == "golf")
    assert not Draft7Validator(read(folder)).is_valid(tomllib.loads(text))


@pytest.mark.parametrize(
    "text",
    [
        '[launch]\nspeed = "171 mph"',
        '[launch]\nspeed = 70\nangle = "12 deg"',
        '[air]\nwind = ["-10 mph", 0]',
        '[ball.drag]\nmodel = "constant"\ncoefficient = 0.3',
        'scene = "golf/7-iron"',
        "",
    ],
)
def test_what_is_right_is_let_pass(text: str):
    folder = next(folder for folder in SCENES if folder.name == "golf")
    assert [error.message for error in Draft7Validator(read(folder)).iter_errors(tomllib.loads(text))] == []
