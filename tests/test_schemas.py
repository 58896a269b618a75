"""What editors complete and check scene files by: every shipped file points at its schema, which is in step."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator

from sandbox import resources
from sandbox.scene import load, parameters_of
from sandbox.schema import json_schema
from sandbox.tasks.schema import task_schema

SCENES = sorted(path.parent for path in resources.folder("scenes").glob("*/scene.py"))
FILES = sorted(
    file
    for name in ("scenes", "template", "template_above")
    for file in resources.folder(name).rglob("*.toml")
    if file.parent.name == "presets" or file.stem == file.parent.name
)


def read(folder: Path) -> Any:
    return json.loads((folder / f"{folder.name}.schema.json").read_text("utf-8"))


@pytest.mark.parametrize("folder", SCENES, ids=lambda folder: folder.name)
def test_a_schema_is_in_step_with_its_scene(folder: Path):
    name, parameters = parameters_of(folder)
    assert read(folder) == json.loads(json.dumps(json_schema(parameters, name))), "make lists"


@pytest.mark.parametrize("folder", SCENES, ids=lambda folder: folder.name)
def test_a_schema_is_one(folder: Path):
    Draft7Validator.check_schema(read(folder))


def descriptions(schema: Any) -> Iterator[str]:
    """All texts of a schema that an editor shows."""
    for key, value in schema.items() if isinstance(schema, dict) else enumerate(schema):
        if key == "description" and isinstance(value, str):
            yield value
        elif isinstance(value, dict | list):
            yield from descriptions(value)


#: Markup, calls, keyword arguments, Python's constants, and lines.
CODE = re.compile(r"`|\n|::|->|__|\bNone\b|\bTrue\b|\bFalse\b|\bself[.,)]|\bclass [A-Z]|\w\(\w|\w=\w")


@pytest.mark.parametrize("folder", SCENES, ids=lambda folder: folder.name)
def test_descriptions_are_for_who_edits_a_file(folder: Path):
    """They are sentences, without code; those of tasks too."""
    texts = [*descriptions(json_schema(*parameters_of(folder)[::-1])), *descriptions(task_schema(load(folder)))]
    assert [text for text in texts if CODE.search(text)] == []
    assert len(texts) > 40
    assert CODE.search("A ball. ``class GolfBall(Sphere, drag=GOLF_DRAG)`` may have")


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
        '[launch]\nspeed = "-5 mph"',
        "[ball.drag]\ncoefficient = 0.3",  # of another model than the scene's own
        'scene = "golf"\n[ball.drag]\ncoefficient = 0.3',
        '[ball.drag]\nmodel = "none"\ncoefficient = 0.3',
        '[accuracy]\nmethod = "pymunk"',
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
        'scene = "./my-shot.toml"',
        'scene = "golf/golf-game"\n[ball.drag]\ncoefficient = 0.3',  # whose drag has one
        '[launch]\nangle = "-2 deg"',
        "",
    ],
)
def test_what_is_right_is_let_pass(text: str):
    folder = next(folder for folder in SCENES if folder.name == "golf")
    assert [error.message for error in Draft7Validator(read(folder)).iter_errors(tomllib.loads(text))] == []


def test_editors_see_the_words_allowed():
    golf = read(next(folder for folder in SCENES if folder.name == "golf"))
    drag = golf["$defs"]["GolfBall"]["properties"]["drag"]
    assert drag["properties"]["model"]["enum"][-2:] == ["constant", "none"]
    assert golf["$defs"]["Accuracy"]["properties"]["method"]["enum"] == ["exact", "plain"]


TASKS = sorted(resources.folder("scenes").glob("*/tasks/*.toml"))


@pytest.mark.parametrize("scene", sorted({file.parent.parent.name for file in TASKS}))
def test_shipped_tasks_match_their_schema(scene: str):
    schema = task_schema(load(scene))
    Draft7Validator.check_schema(schema)
    checker = Draft7Validator(schema)
    for file in (file for file in TASKS if file.parent.parent.name == scene):
        assert [error.message for error in checker.iter_errors(tomllib.loads(file.read_text("utf-8")))] == [], file


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("attempts = 5", "attempts = 0"),
        ("attempts = 5", 'attempts = "5"'),
        ("attempts = 5", "attempt = 5"),
        ("pass = 3", "passing = 3"),
        ("stars = [3, 4, 5]", "stars = [3, 4]"),
        ('score = "made"', 'score = "mad"'),
        ('score = "made"', 'score = { fact = "made", how = "least" }'),
        ('score = "made"', "score = { fact = 'made', wanted = { verdikt = 'bank' } }"),
        ('key = "launch.speed"', 'key = "launch.spede"'),
        ('scene = "basketball/free-throw"', 'scene = "golf"'),
        ("pass = 3", "pass = 3\nset = { gravity = -1 }"),
    ],
)
def test_a_mistake_in_a_task_is_seen(old: str, new: str):
    text = next(file for file in TASKS if file.stem == "free-throw").read_text("utf-8")
    assert old in text
    assert not Draft7Validator(task_schema(load("basketball"))).is_valid(tomllib.loads(text.replace(old, new)))
