"""``sandbox new``: the scene it writes works, looks after itself, and blames the right person for mistakes in it."""

from __future__ import annotations

import json
import os
import re
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

import sandbox
from sandbox import resources
from tests.own_scene import change
from tests.picture.legible import assert_legible

NAME, ABOVE = "beachvolley", "backyard"


@pytest.fixture(autouse=True)
def in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def scene(call) -> Path:
    """The folder of a scene that was just written."""
    assert call("new", NAME).code == 0
    return Path(NAME).resolve()


@pytest.fixture
def above(call) -> Path:
    """The folder of one that is seen from above."""
    assert call("new", ABOVE, "--from-above").code == 0
    return Path(ABOVE).resolve()


def pytest_in(folder: Path, *args: str) -> subprocess.CompletedProcess[str]:
    """pytest as a user has it: the golden fixture comes with the installed sandbox."""
    environment = {key: value for key, value in os.environ.items() if key not in ("CI", "PYTEST_XDIST_WORKER")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *args]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


# What it writes -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "view", "preset"), [(NAME, [], "still"), (ABOVE, ["--from-above"], "one-board")])
def test_new_scenes_are_complete_and_short(call, name: str, view: list[str], preset: str):
    code, out, err = call("new", name, *view)
    assert (code, err) == (0, "")
    files = {str(path.relative_to(name)) for path in Path(name).rglob("*") if path.is_file()}
    named = {f"{name}.toml", f"{name}.schema.json", f"test_{name}.py"}
    golden = {f"golden/{name}.json", f"golden/{name}.png"}
    assert files == {"scene.py", "picture.py", "shots.toml", f"presets/{preset}.toml"} | named | golden
    assert {line.removeprefix(f"wrote {name}{os.sep}") for line in out.splitlines() if "wrote" in line} == files
    assert f"sandbox run ./{name}" in out
    assert f"pytest {name} --golden-update" in out
    texts = {file: Path(name, file).read_text("utf-8") for file in files - golden}
    assert not any(re.search(r"\btemplate", text) for text in texts.values())
    assert sum(len(texts[file].splitlines()) for file in ("scene.py", "picture.py")) < 130
    assert json.loads(texts[f"{name}.schema.json"]) == json.loads(call("schema", f"./{name}").out)
    assert texts[f"{name}.toml"].startswith(f"#:schema ./{name}.schema.json\n")


@pytest.mark.parametrize("name", ["Beach-volley", "x2", "my_scene", "template", "test", "a/../b"])
def test_names(call, name: str):
    Path("a").mkdir()
    assert call("new", name).code == 0
    folder = Path(name)
    code, out, err = call("run", f"./{name}", "--json")
    assert (code, err) == (0, "")
    assert json.loads(out)["scene"] == folder.name
    assert (folder / f"test_{folder.name.replace('-', '_')}.py").is_file()


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("golf", "a scene named golf already exists"),
        ("sandbox", "would import that folder in place of the sandbox"),
        ("there", "already exists"),
        ("file", "already exists"),
        ("link", "already exists"),
        ("nowhere/new", "there is no folder nowhere"),
        ("", "a scene's name has letters"),
        ("2balls", "begins with a letter"),
        ("two words", "a scene's name has letters"),
        ("über", "a scene's name has letters"),
        ("..", "a scene's name has letters"),
        ("x" * 300, "a scene's name has letters"),
    ],
)
def test_what_cannot_be_made_is_refused(call, name: str, expected: str):
    Path("there").mkdir()
    Path("file").touch()
    Path("link").symlink_to("missing")
    before = sorted(Path().iterdir())
    code, out, err = call("new", name)
    assert (code, out) == (2, "")
    assert expected in err
    assert len(err.splitlines()) == 1
    assert sorted(Path().iterdir()) == before


def test_a_full_disk_is_told_and_nothing_stays_behind(call):
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))  # no file may be longer
    try:
        code, _, err = call("new", NAME)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert (code, err) == (1, f"error: {NAME}: cannot be written: file too large\n")
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize("copied", ["golf", "pinball"])
def test_a_scene_may_be_copied_to_begin_from(call, copied: str):
    """The same numbers under another name, and a golden test that passes at once: of a chaotic run, its beginning."""
    assert call("new", "my-own", "--from", copied).code == 0
    own = {file.stem for file in Path("my-own", "presets").iterdir()}
    assert own == {file.stem for file in resources.folder("scenes").joinpath(copied, "presets").glob("*.toml")}
    assert sandbox.load("./my-own").parameters.model_dump() == sandbox.load(copied).parameters.model_dump()
    for preset in sorted(own):
        assert sandbox.load(f"./my-own/{preset}").name == "my-own"
    assert Path("my-own/my-own.toml").read_text().startswith("#:schema ./my-own.schema.json\n")
    assert ("until = " in Path("my-own/shots.toml").read_text()) == (copied == "pinball")
    done = pytest_in(Path().resolve(), "my-own")
    assert done.returncode == 0, done.stdout


def test_what_cannot_be_copied_is_refused(call):
    assert "--from golf/moon: name a scene, such as golf" in call("new", "own", "--from", "golf/moon").err
    assert "give --from-above or --from golf" in call("new", "own", "--from", "golf", "--from-above").err
    assert "did you mean golf?" in call("new", "own", "--from", "gulf").err


# It works like those that come with the sandbox -----------------------------------------------------------------------


def test_it_runs_and_draws(call, scene: Path):
    code, out, err = call("run", f"./{NAME}", "--poster", "poster.png", "--trajectory", "path.csv")
    assert (code, err) == (0, "")
    assert "Comes down" in out
    with Image.open("poster.png") as image:
        assert image.size == (1280, 720)
    assert Path("path.csv").read_text().count("\n") > 100


def test_it_is_found_in_all_ways(call, scene: Path):
    Path("shot.toml").write_text(f'scene = "./{NAME}"')
    wanted = [f"./{NAME}", scene, f"./{NAME}/", "shot.toml"]
    outcomes = [json.loads(call("run", source, "--json").out) for source in wanted]
    assert all(outcome["result"] == outcomes[0]["result"] for outcome in outcomes)
    presets = [f"./{NAME}/still", f"{scene}/still"]
    outcomes = [json.loads(call("run", source, "--json").out) for source in presets]
    assert [outcome["preset"] for outcome in outcomes] == ["still"] * 2
    assert "did you mean beachvolley/still?" in call("run", f"./{NAME}/stil").err


def test_a_folder_that_is_renamed_says_which_file_to_rename(call, scene: Path):
    scene.rename("copy")
    outcome = call("run", "./copy")
    assert outcome.code == 2
    assert outcome.err == f"error: copy: its numbers belong in copy.toml; is {NAME}.toml that file?\n"
    Path(f"copy/{NAME}.toml").unlink()
    assert call("run", "./copy").err == "error: copy: its numbers belong in copy.toml; there is none\n"


def test_it_is_listed_where_it_stands(call, scene: Path):
    lines = call("list").out.splitlines()
    assert any(re.match(rf"\./{NAME} +A ball tossed", line) for line in lines)
    assert any(re.match(rf"\./{NAME}/still +The same toss", line) for line in lines)
    assert any(line.startswith("golf ") for line in lines)


def test_settings_and_bounds(call, scene: Path):
    still = json.loads(call("run", f"./{NAME}/still", "--json").out)["result"]
    assert json.loads(call("run", f"./{NAME}", "--json", "--set", "fan.push=0").out)["result"] == still
    assert "--set fan.push = -1: must be from 0 to 100 N" in call("run", f"./{NAME}", "--set", "fan.push=-1").err
    assert "did you mean fan.push?" in call("run", f"./{NAME}", "--set", "fan.pushes=1").err


def test_its_force_takes_many_balls_at_once(scene: Path):
    import numpy as np

    loaded = sandbox.load(scene)
    fan = loaded.build().balls[0].forces[-1]
    x = np.array([0.0, 5.0, 6.0, 9.0])
    _, up = fan(0.0, (x, np.ones(4)), (np.ones(4), np.ones(4)), np.zeros(4))
    assert list(up) == [fan(0.0, (place, 1.0), (1.0, 1.0), 0.0)[1] for place in x]


def test_reading_it_needs_no_pygame(scene: Path):
    code = f"import sys, sandbox; sandbox.load({str(scene)!r}).build(); sys.exit('pygame' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_two_scenes_may_have_one_name(call, scene: Path, tmp_path: Path):
    (tmp_path / "other").mkdir()
    assert call("new", f"other/{NAME}").code == 0
    change(tmp_path / "other" / NAME / f"{NAME}.toml", "push = 4.0", "push = 0.0")
    first, second = (sandbox.simulate(sandbox.load(path)).result for path in (scene, tmp_path / "other" / NAME))
    assert first["distance"] > second["distance"] + 1


SIDE_EXTREMES = (
    {"launch.speed": 0, "launch.height": 0},
    {"gravity": 0, "fan.push": 0, "launch.speed": 0},
    {"launch.angle": 180, "launch.speed": 340, "fan.push": 100, "fan.width": 0.05},
    {"ball.radius": 0.5, "launch.height": 0, "floor.restitution": 1},
    {"air.density": 1100, "launch.speed": 340},
    {"fan.place": -100, "fan.width": 50},
)
ABOVE_EXTREMES = (
    {"launch.speed": 0},
    {"launch.speed": 20, "launch.angle": 180, "launch.roll": -1},
    {"lane.length": 50, "lane.width": 20},
    {"lane.width": 0.3, "lane.block": 0.05},
    {"lane.felt": 0.001, "launch.speed": 10},
)


def test_extremes_run_and_draw(scene: Path, above: Path):
    for folder, extremes in ((scene, SIDE_EXTREMES), (above, ABOVE_EXTREMES)):
        for settings in extremes:
            loaded = sandbox.load(folder, settings)
            run = sandbox.simulate(loaded)
            assert loaded.rows(run)
            picture = loaded.picture(run, (320, 180))
            assert picture.poster().get_size() == picture.frame(0.5 * run.duration).get_size() == (320, 180), settings


def test_one_seen_from_above_runs_and_compares(call, above: Path):
    result = json.loads(call("run", f"./{ABOVE}", "--json").out)["result"]
    assert (result["holed"], result["to_cup"], result["bounces"]) == (True, None, 2)
    command = ("run", f"./{ABOVE}", "--poster", "poster.png", "--compare", f"./{ABOVE}/one-board")
    assert call(*command, "--strip", "film.png").code == 0
    assert min(Path(file).stat().st_size for file in ("poster.png", "film.png")) > 10_000


def test_pictures_from_above_are_legible(above: Path):
    run, other = (sandbox.simulate(sandbox.load(source)) for source in (above, above / "one-board"))
    for size in ((320, 180), (640, 360), (480, 960), (1920, 1080)):
        picture = run.scene.picture(run, size, {"one board": other})
        for draw in (picture.poster, lambda picture=picture: picture.frame(0.5 * run.duration)):
            draw()
            assert_legible(picture.sheet)
        (left, top), (right, bottom) = picture.camera.pixel(-2.0, 0.7), picture.camera.pixel(2.0, -0.7)
        assert 0 < left < right < size[0]
        assert picture.sheet.top_row < top < bottom < picture.card_row


# Its golden test ------------------------------------------------------------------------------------------------------


def test_their_golden_tests(scene: Path, above: Path):
    """They pass at once, and see what has changed: the physics, or the drawing."""
    assert pytest_in(scene.parent, NAME, ABOVE).returncode == 0
    for folder in (scene, above):
        assert 3_000 < (folder / "golden" / f"{folder.name}.png").stat().st_size < 60_000
    change(scene / f"{NAME}.toml", "push = 4.0", "push = 3.9")
    # Another length, as Python takes a file of the same second and size from its cache.
    change(above / "picture.py", "(240, 176, 64)", "(64, 76, 240)")
    changed = pytest_in(scene.parent, NAME, ABOVE)
    assert changed.returncode == 1
    assert "the physics changed" in changed.stdout
    assert "other parameters: fan.push 4 -> 3.9 N" in changed.stdout
    assert "same physics" in changed.stdout
