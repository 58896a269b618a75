"""Finding, loading and running scenes: those that come with the sandbox and a user's own."""

from __future__ import annotations

import math
import pickle
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sandbox
from sandbox import resources
from sandbox.cli.new import new_scene
from sandbox.errors import RequestError
from sandbox.parameters import Group, walk
from sandbox.scene import listings, reference
from sandbox.scene.discovery import folder_of, is_installed
from sandbox.scene.modules import read_again
from sandbox.toml import read_toml
from tests.own_scene import DROP, change
from tests.scenes.play import run_of

SCENES = resources.folder("scenes")
NAMES = [listing.name for listing in listings()]


def refusal(*args: Any) -> str:
    with pytest.raises(RequestError) as refused:
        sandbox.load(*args)
    return str(refused.value)


# What Python asks for ------------------------------------------------------------------------------------------------


def test_a_scene_may_be_named_wherever_one_is_asked_for():
    assert sandbox.simulate("golf/putt").result == sandbox.simulate(sandbox.load("golf/putt")).result
    assert sandbox.check(DROP).errors == sandbox.check(sandbox.load(DROP)).errors != {}


@pytest.mark.parametrize(
    ("ask", "expected"),
    [
        (lambda: sandbox.simulate("golff"), "unknown scene golff; did you mean golf?"),
        (lambda: sandbox.simulate(DROP).state("bal", 1), "there is no ball 'bal'; there are 'ball'"),
        (lambda: sandbox.simulate(DROP).trajectory("bal"), "there is no ball 'bal'"),
        (lambda: next(sandbox.simulate(DROP).crossings("bal", (0, 0), (1, 0))), "there is no ball 'bal'"),
        (lambda: sandbox.simulate(DROP).trajectory(every=0), "every = 0: must be more than 0 s"),
        (lambda: sandbox.simulate(DROP).trajectory(every=-1), "every = -1: must be more than 0 s"),
        (lambda: sandbox.simulate(DROP).trajectory(every=math.inf), "every = inf: must be more than 0 s, and finite"),
        (lambda: sandbox.load(5), "5 is not a scene: give its name as text"),
        (lambda: sandbox.load("golf", ["a"]), "overrides = ['a']: must be a dictionary"),
        (lambda: sandbox.load("golf", {5: 1}), "override 5: a key is a string, such as launch.speed"),
        (lambda: sandbox.load("golf", {"ball": {5: 1}}), "override ball: 5 in it is not a key"),
        (lambda: sandbox.load("golf", {"ball": {"drag": {None: 1}}}), "override ball.drag: None in it is not a key"),
        (lambda: sandbox.sweep("golf", {5: [1, 2]}), "over 5: a key is a string, such as launch.speed"),
        (lambda: sandbox.sweep("golf", {"launch.angle": 5}), "over launch.angle: 5 is neither a list of values nor a"),
        (lambda: sandbox.aim("golf", {"launch.angle": 5}, {"carry": 200}), "vary launch.angle: 5 is neither a list"),
        (lambda: sandbox.aim("golf", {"gravity": (1, 2, 3)}, {"carry": 200}), "vary gravity: only numbers have a ra"),
    ],
)
def test_what_python_asks_wrongly_is_said_in_a_line(ask: Any, expected: str):
    with pytest.raises(RequestError) as refused:
        ask()
    assert expected in str(refused.value)


# The scenes that come with it ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("listing", list(listings()), ids=lambda listing: listing.name)
def test_every_preset_describes_itself_ends_and_stays_finite(listing: Any):
    run = run_of(listing.name)
    scene = run.scene
    assert (scene.name, scene.preset) == (listing.name.partition("/")[0], listing.name.partition("/")[2] or None)
    assert 10 <= len(listing.about) <= 110
    assert run.ended in ("rest", "until") or hasattr(scene.parameters, "duration")  # as long as its file says
    for ball in run.setup.balls:
        assert np.isfinite(run.trajectory(ball.name)).all()
    numbers = {key: value for key, value in run.result.items() if isinstance(value, float)}
    assert all(math.isfinite(number) for number in numbers.values())
    ratios = {"smash_factor", "speed_kept", "drag_coefficient", "lift_coefficient", "pace_rating"}
    assert {key for key in numbers if not scene.units[key]} <= ratios
    assert scene.rows(run)
    assert scene.verdict(run)


def keys_in(table: dict[str, Any], prefix: str = "") -> Iterator[str]:
    """The dotted keys of nested tables."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from keys_in(value, f"{prefix}{key}.")
        else:
            yield prefix + key


def defaults_in(schema: type[Group], values: Any, prefix: str = "") -> Iterator[str]:
    """The dotted keys that have a default in the declaration itself, in the groups that ``values`` choose."""
    for key, field in schema.model_fields.items():
        value = getattr(values, key)
        if isinstance(value, Group):
            yield from defaults_in(type(value), value, f"{prefix}{key}.")
        elif not field.is_required():
            yield prefix + key


@pytest.mark.parametrize("name", [name for name in NAMES if "/" not in name])
def test_a_default_stands_in_one_place(name: str):
    """In the scene's own file or in its scene.py; a word that chooses a group is its name, and stands in both."""
    scene = sandbox.load(name)
    in_file = set(keys_in(read_toml(SCENES / name / f"{name}.toml")))
    twice = in_file & set(defaults_in(type(scene.parameters), scene.parameters))
    numbers = {key for key in twice if key.rpartition(".")[2] not in ("model", "kind", "level")}
    # of basketball: that of a sphere is the default of the model; and a launch has no spin unless a file gives it one
    assert numbers <= {"ball.drag.coefficient", "launch.spin"}


FILES = sorted(
    file for file in SCENES.rglob("*.toml") if file.parent.name == "presets" or file.stem == file.parent.name
)


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(SCENES)))
def test_a_scene_file_is_found_by_name_and_by_path(file: Path):
    by_path = sandbox.load(file)
    name = by_path.name if by_path.preset is None else f"{by_path.name}/{by_path.preset}"
    by_name = sandbox.load(name)
    assert by_path == by_name == sandbox.load(str(file))
    assert by_path.module is by_name.module


def test_overrides_stand_over_the_file():
    scene = sandbox.load(DROP, {"launch.height": "6 ft", "air": {"wind": [1, 2]}})
    assert scene.parameters.launch.height == pytest.approx(1.8288)
    assert scene.parameters.air.wind == (1.0, 2.0)
    assert "override launch.height = -1: must be from 0.1 to 100 m" in refusal(DROP, {"launch.height": -1})


def test_runs_are_repeatable():
    one, other = (sandbox.simulate(sandbox.load(DROP)) for _ in range(2))
    assert one.result == other.result
    assert one.trajectory("ball").tobytes() == other.trajectory("ball").tobytes()


# A user's own -------------------------------------------------------------------------------------------------------


def test_a_folder_is_a_scene(drop: Path):
    scene = sandbox.load(drop)
    assert (scene.name, scene.preset) == ("drop", None)
    assert scene.parameters.launch.height == 2.0
    assert scene.about.startswith("A ball dropped on the floor")


def test_a_folder_without_a_scene_file_takes_the_defaults(drop: Path):
    (drop / "drop.toml").unlink()
    assert sandbox.load(drop).parameters == sandbox.load(drop).module.Parameters()


def test_a_scene_is_checked_once_and_its_file_read_each_time(drop: Path, monkeypatch: pytest.MonkeyPatch):
    sandbox.load(drop)
    with monkeypatch.context() as patched:
        patched.setattr("inspect.signature", lambda function: pytest.fail("checked again"))
        patched.setattr("tomllib.loads", lambda text: pytest.fail("parsed again"))
        sandbox.load(drop)
    change(drop / "drop.toml", "height = 2.0", "height = 4.0")  # of the same length, at once
    assert sandbox.load(drop).parameters.launch.height == 4.0
    change(drop / "scene.py", "def build(parameters:", "def build(wrong, parameters:")
    assert sandbox.load(drop).parameters.launch.height == 4.0  # the module is as it was read
    with pytest.raises(RequestError, match="build is called as build"), read_again(drop):
        sandbox.load(drop)
    assert sandbox.load(drop).parameters.launch.height == 4.0


def test_a_preset_lies_over_the_scenes_own_file(drop: Path):
    (drop / "drop.toml").write_text('scene = "drop"\n[launch]\nheight = 3.0')
    scene = sandbox.load(drop / "moon")
    assert (scene.name, scene.preset) == ("drop", "moon")
    assert scene.parameters.gravity == 1.62
    assert scene.parameters.launch.height == 3.0
    assert scene.about == "The same drop on the moon."


@pytest.mark.parametrize("named", ["./drop", "./drop/moon", "../{}/drop", "{}/drop"])
def test_a_scene_file_may_name_a_folder_by_its_path(drop: Path, named: str):
    path = named.format(drop.parent if named.startswith("{") else drop.parent.name)
    (drop.parent / "shot.toml").write_text(f'scene = "{path}"\nlaunch.height = 3.7')
    scene = sandbox.load(drop.parent / "shot.toml")
    assert (scene.name, scene.preset, scene.folder) == ("drop", None, drop)
    assert scene.parameters.launch.height == 3.7
    assert scene.parameters.gravity == (1.62 if path.endswith("moon") else 9.81)


def test_a_scene_file_in_its_folder_may_say_so(drop: Path):
    (drop / "high.toml").write_text('scene = "."\nlaunch.height = 50')
    (drop / "presets" / "low.toml").write_text('scene = ".."\nlaunch.height = 0.5')
    assert sandbox.load(drop / "high.toml").parameters.launch.height == 50
    assert sandbox.load(drop / "presets" / "low.toml").preset == sandbox.load(drop / "low").preset == "low"


def test_a_relative_path_is_enough(drop: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(drop.parent)
    assert {sandbox.load(named).folder for named in ("./drop", Path("drop"), "./drop/scene.py")} == {drop}
    monkeypatch.chdir(drop)
    assert sandbox.load(".") == sandbox.load("../drop") == sandbox.load(drop)
    (drop / "drop.toml").write_text('scene = "."')
    assert refusal("drop.toml", {"launch.speed": -1}) == "override launch.speed = -1: must be from 0 to 340 m/s"
    (drop / "drop.toml").write_text("gravity = -1")
    assert refusal(".") == "drop.toml: gravity = -1: must be from 0 to 30 m/s^2"


# Opening data runs no code ------------------------------------------------------------------------------------------


@pytest.fixture
def trap(drop: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder full of scenes whose code must not run; they are called like one that is built in, and otherwise."""
    place = drop.parent / "downloads"
    place.mkdir()
    for name in ("golf", "drop"):
        (shutil.copytree(drop, place / name) / "scene.py").write_text("raise AssertionError('this ran')")
    for file in ("scene.py", "presets.py", "sandbox.py"):
        (place / file).write_text("raise AssertionError('this ran')")
    (place / "presets").mkdir()
    monkeypatch.chdir(place)
    return place


@pytest.mark.parametrize("where", ["shot.toml", "golf/shot.toml", "golf/presets/shot.toml", "presets/shot.toml"])
@pytest.mark.parametrize("named", ["golf", "golf/moon"])
def test_a_bare_name_means_an_installed_scene(trap: Path, where: str, named: str):
    (trap / where).write_text(f'scene = "{named}"')
    assert sandbox.load(where).folder == sandbox.load(trap / where).folder == SCENES / "golf"
    assert sandbox.load(named).folder == SCENES / "golf"


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("drop", "unknown scene drop; for the one in this folder write ./drop"),
        ("drop/moon", "unknown scene drop/moon; for the one in this folder write ./drop/moon"),
        ("drop/drop.toml", "a file alone does not run the scene.py of its folder: ask for ./drop"),
        ("drop/presets/moon.toml", "a file alone does not run the scene.py of its folder: ask for ./drop/moon"),
        ("shot.toml", 'for the folder next to this file write scene = "./drop"'),
        ("bare.toml", "needs a line that names its scene"),
    ],
)
def test_a_name_or_a_file_never_runs_code_that_was_not_asked_for(trap: Path, source: str, expected: str):
    (trap / "shot.toml").write_text('scene = "drop"')
    (trap / "bare.toml").write_text("gravity = 3")
    assert expected in refusal(source)


def test_a_path_runs_the_code_it_names(trap: Path):
    (trap / "shot.toml").write_text('scene = "./golf"')
    for source in ("./drop", "./golf", "shot.toml", trap / "golf", "."):
        with pytest.raises(AssertionError, match="this ran"):
            sandbox.load(source)


def test_a_reference_leads_back_to_its_scene(drop: Path, tmp_path: Path):
    places = [tmp_path, drop, drop / "presets", tmp_path / "a" / "b"]
    for place in places:
        place.mkdir(parents=True, exist_ok=True)
        for folder in (drop, SCENES / "golf"):
            (place / "shot.toml").write_text(f'scene = "{reference(folder, place)}"')
            assert sandbox.load(place / "shot.toml").folder == folder
    assert reference(SCENES / "golf", tmp_path) == "golf"
    assert (folder_of("golf/moon"), folder_of(str(drop)), folder_of("golff")) == (SCENES / "golf", drop, None)
    assert (is_installed(SCENES / "golf"), is_installed(drop)) == (True, False)


def test_a_scene_may_import_its_neighbours(drop: Path):
    (drop / "weights.py").write_text("GRAVITY = 1.5")
    change(drop / "scene.py", "from sandbox", "from .weights import GRAVITY\nfrom sandbox")
    assert sandbox.load(drop).module.GRAVITY == 1.5


def test_two_folders_of_one_name_do_not_mix(drop: Path, tmp_path: Path):
    other = tmp_path / "elsewhere" / "drop"
    shutil.copytree(drop, other)
    change(other / "scene.py", '9.81, "m/s^2"', '1.0, "m/s^2"')
    assert sandbox.load(drop).parameters.gravity == 9.81
    assert sandbox.load(other).parameters.gravity == 1.0
    assert sandbox.load(drop).parameters.gravity == 9.81


def test_a_folder_may_have_any_name(drop: Path):
    odd = drop.rename(drop.parent / "my drop, v1.2")
    assert sandbox.load(odd).name == "my drop, v1.2"


def test_an_installed_package_may_offer_scenes(drop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    package = tmp_path / "site"
    shutil.copytree(drop, package / "droppings" / "drop")
    (package / "droppings" / "__init__.py").touch()
    info = package / "droppings-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: droppings\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[sandbox.scenes]\ndrop = droppings.drop.scene\ngone = nowhere.scene\n")
    monkeypatch.syspath_prepend(str(package))
    assert sandbox.load("drop").folder == package / "droppings" / "drop"
    assert sandbox.load("drop/moon").parameters.gravity == 1.62
    assert {"drop", "drop/moon"} < {listing.name for listing in listings()}
    said = "scene gone: droppings offers it as nowhere.scene, but that module is not installed with it"
    assert refusal("gone") == said


def test_a_scene_installed_without_its_numbers_says_so(tmp_path: Path):
    folder = tmp_path / "site-packages" / "droppings" / "own"
    folder.parent.mkdir(parents=True)
    new_scene(tmp_path / "own")
    shutil.copytree(tmp_path / "own", folder, ignore=shutil.ignore_patterns("*.toml", "presets", "golden"))
    said = f"{folder}: it was installed without its file of numbers, own.toml: declare it as package data"
    assert refusal(folder) == said


def test_a_scene_file_may_begin_from_a_preset(tmp_path: Path):
    file = tmp_path / "shot.toml"
    file.write_text('scene = "golf/golf-game"\n[launch]\nangle = 20\n[ball.lift]\nmodel = "none"\n')
    game, own = sandbox.load("golf/golf-game"), sandbox.load(file)
    assert (own.name, own.preset) == ("golf", None)
    assert own.parameters == sandbox.load("golf/golf-game", {"launch.angle": 20, "ball.lift.model": "none"}).parameters
    assert own.parameters.ball.mass == game.parameters.ball.mass != sandbox.load("golf").parameters.ball.mass
    file.write_text('scene = "golf/golf-gane"')
    assert refusal(file) == f"{file}: golf has no preset golf-gane; did you mean golf/golf-game?"


def test_a_scene_file_may_begin_from_another(tmp_path: Path, drop: Path):
    (tmp_path / "one.toml").write_text('scene = "golf/golf-game"\n[launch]\nangle = 20\nspeed = 50\n')
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "two.toml").write_text('scene = "../one.toml"\n[launch]\nspeed = 60\n')
    two = sandbox.load(tmp_path / "more" / "two.toml")
    assert (two.name, two.preset) == ("golf", None)
    assert two.parameters == sandbox.load("golf/golf-game", {"launch.angle": 20, "launch.speed": 60}).parameters
    (tmp_path / "own.toml").write_text(f'scene = "./{drop.relative_to(tmp_path)}/moon"')
    (tmp_path / "other.toml").write_text('scene = "./own.toml"\ngravity = 3')
    assert sandbox.load(tmp_path / "other.toml").parameters == sandbox.load(drop, {"gravity": 3.0}).parameters
    for name, text, said in (
        ("silent", "gravity = 3", "silent.toml: needs a line that names its scene"),
        ("mute", 'scene = "./silent.toml"', "silent.toml: needs a line that names its scene"),
        ("loop", 'scene = "./loop.toml"', 'scene = "./loop.toml": is based on itself'),
        ("lost", 'scene = "./nowhere.toml"', 'scene = "./nowhere.toml": there is no such file'),
        ("bad", 'scene = "golf"\ngravity = -3', "bad.toml: gravity = -3: must be from"),
        ("wrong", 'scene = "./bad.toml"', "bad.toml: gravity = -3: must be from"),
    ):
        (tmp_path / f"{name}.toml").write_text(text)
        assert said in refusal(tmp_path / f"{name}.toml")


def test_a_scene_file_elsewhere_says_what_it_is(tmp_path: Path):
    file = tmp_path / "shot.toml"
    file.write_text('# A flop over the bunker.\nscene = "golf"\n')
    assert sandbox.load(file).about == "A flop over the bunker."
    file.write_text('scene = "golf"\n# gravity = 3\n')
    assert sandbox.load(file).about == sandbox.load("golf").about


def test_a_preset_may_begin_from_another_but_not_from_itself(drop: Path):
    (drop / "presets" / "high.toml").write_text('scene = "drop/moon"\nlaunch.height = 50')
    (drop.parent / "shot.toml").write_text('scene = "./drop/high"\nlaunch.speed = 1')
    own = sandbox.load(drop.parent / "shot.toml").parameters
    assert (own.gravity, own.launch.height, own.launch.speed) == (1.62, 50.0, 1.0)
    (drop / "presets" / "high.toml").write_text('scene = "drop/moon"')
    (drop / "presets" / "moon.toml").write_text('scene = "drop/high"')
    assert 'high.toml: scene = "drop/moon": is based on itself' in refusal(drop / "moon")


def test_a_scene_can_be_sent_to_another_process(drop: Path):
    scene = sandbox.load(drop / "moon", {"launch.height": 3, "ball.drag.model": "constant"})
    assert pickle.loads(pickle.dumps(scene)) == scene
    code = "import pickle, sys; print(pickle.load(sys.stdin.buffer).parameters)"
    process = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(scene), capture_output=True, check=True)
    assert process.stdout.decode().strip() == str(scene.parameters)


def test_what_python_shows_of_a_run_fits_a_line():
    run = sandbox.simulate(sandbox.load("golf/driver"))
    assert repr(run) == f"<Run of golf/driver: {run.duration:.2f} s, {len(run.events)} events, ended by rest>"
    found = sandbox.sweep("golf/driver", {"launch.angle": [10, 12]})
    assert repr(found) == "<Sweep of golf/driver: 2 points over launch.angle>"
    near = sandbox.aim("golf/driver", {"launch.speed": (60, 60.5)}, {"carry": 500})
    assert repr(near) == "<Aim of golf/driver at carry = 500.0: no solution>"


# Refusals -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("golff", "unknown scene golff; did you mean golf?"),
        ("Golf", "unknown scene Golf; did you mean golf?"),
        ("qqqqqq", "unknown scene qqqqqq; sandbox list shows them all"),
        ("", "unknown scene"),
        ("./qqqqqq", "./qqqqqq: there is no such folder or file"),
        ("golf/qqqqqq", "golf has no preset qqqqqq"),
        ("golf/../golf", "unknown scene golf/../golf"),
        ("nowhere/shot.toml", "nowhere/shot.toml: cannot be read: no such file or directory"),
        ("x" * 5000, "cannot be read: file name too long"),
        ("tests" if Path("tests").is_dir() else ".", "a folder without scene.py is not a scene"),
    ],
)
def test_what_cannot_be_found_is_refused(source: str, expected: str):
    message = refusal(source)
    assert expected in message
    assert len(message.splitlines()) == 1
    assert len(message) < 200


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("", 'needs a line that names its scene, such as scene = "golf"'),
        ("gravity = 3", 'needs a line that names its scene, such as scene = "golf"'),
        ("scene = 3", 'scene = 3: must be the name of a scene or preset, such as "golf" or "golf/moon"'),
        ('scene = ""', 'scene = "": must be the name of a scene'),
        ('scene = "../golf"', 'scene = "../golf": there is no scene.py in that folder'),
        ('scene = "a/b/c"', 'scene = "a/b/c": must be the name of a scene'),
        ('scene = "golf/"', 'scene = "golf/": must be the name of a scene'),
        ('scene = "golff"', "unknown scene golff; did you mean golf?"),
        ("scene = ", "broken TOML"),
    ],
)
def test_a_file_that_names_no_scene_is_refused(tmp_path: Path, content: str, expected: str):
    (tmp_path / "shot.toml").write_text(content)
    message = refusal(tmp_path / "shot.toml")
    assert expected in message
    assert message.startswith(str(tmp_path / "shot.toml"))


def test_a_file_for_another_scene_is_refused(drop: Path):
    (drop / "drop.toml").write_text('scene = "golf"')
    assert 'scene = "golf", but a file in this folder is for drop' in refusal(drop)
    (drop / "drop.toml").write_text('scene = "dropp"')
    assert "unknown scene dropp; sandbox list shows them all; a file in this folder is for drop" in refusal(drop)


# Checking -----------------------------------------------------------------------------------------------------------


def test_check_estimates_the_error_of_each_number():
    scene = sandbox.load("golf", {"accuracy.level": "fast"})
    run = sandbox.simulate(scene)
    check = sandbox.check(scene, run)
    precise = sandbox.simulate(sandbox.load("golf", {"accuracy.level": "precise"}))
    assert 0 < check.errors["carry"] < 1.0  # m
    assert abs(run.result["carry"] - precise.result["carry"]) < 2 * check.errors["carry"]
    assert check.changed == {}


def test_check_tells_what_hangs_on_the_accuracy(drop: Path):
    more = """
    Fact("verdict", "", "", lambda run, parameters: "in" if run.accuracy.tolerance < 5e-4 else "out"),
    Fact("nothing", "", "", lambda run, parameters: float("nan")),
"""
    change(drop / "scene.py", "FACTS = (", f"FACTS = ({more}")
    check = sandbox.check(sandbox.load(drop))
    assert check.changed == {"verdict": ("out", "in")}
    assert check.errors.keys() == {"bounces", "first_touch", "final_height"}


def test_walking_the_parameters_of_a_file_covers_it():
    """Every key in golf.toml is a parameter that sliders and sweeps can name."""
    keys = set(keys_in(read_toml(SCENES / "golf" / "golf.toml"))) - {"scene"}
    assert keys <= {parameter.key for parameter in walk(sandbox.load("golf").parameters)}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"launch.speed": 3.0, "launch.height": 1.0}, "Still moving after 1.00 s, 0.41 m from the start"),
        ({"floor.restitution": 0.0}, "At rest after 0.63 s, 1.95 m from the start"),
    ],
)
def test_a_scene_without_facts_and_verdict_has_some(drop: Path, changes: dict[str, Any], said: str):
    change(drop / "scene.py", "FACTS = (", "_FACTS = (")
    change(drop / "scene.py", "def verdict", "def _verdict")
    run = sandbox.simulate(sandbox.load(drop, changes))
    assert list(run.result) == ["distance", "duration", "ended"]
    assert run.scene.verdict(run) == said
