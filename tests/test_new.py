"""``sandbox new``: the scene it writes works, looks after itself, and blames the right person for mistakes in it."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from PIL import Image

import sandbox
from sandbox.cli import main

COMMAND = [sys.executable, "-c", "import sys; from sandbox.cli import main; sys.exit(main())"]
NAME = "beachvolley"


class Outcome(NamedTuple):
    code: int
    out: str
    err: str


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Call the program in this process, in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def called(*args: object) -> Outcome:
        code = main([str(arg) for arg in args])
        return Outcome(code, *capsys.readouterr())

    return called


@pytest.fixture
def scene(call) -> Path:
    """The folder of a scene that was just written."""
    assert call("new", NAME).code == 0
    return Path(NAME).resolve()


def change(file: Path, old: str, new: str) -> None:
    source = file.read_text("utf-8")
    assert old in source
    file.write_bytes(source.replace(old, new, 1).encode("utf-8", "surrogateescape"))


def pytest_in(folder: Path, *args: str) -> subprocess.CompletedProcess[str]:
    """pytest as a user has it: the golden fixture comes with the installed sandbox."""
    environment = {key: value for key, value in os.environ.items() if key not in ("CI", "PYTEST_XDIST_WORKER")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *args]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


# What it writes -----------------------------------------------------------------------------------------------------


def test_the_files_and_what_to_do_next(call):
    code, out, err = call("new", NAME)
    assert (code, err) == (0, "")
    files = {str(path.relative_to(NAME)) for path in Path(NAME).rglob("*") if path.is_file()}
    assert files == {
        "scene.py",
        "picture.py",
        f"{NAME}.toml",
        f"{NAME}.schema.json",
        f"test_{NAME}.py",
        "presets/still.toml",
    }
    assert {line.removeprefix(f"wrote {NAME}{os.sep}") for line in out.splitlines() if "wrote" in line} == files
    assert f"sandbox run ./{NAME}" in out
    assert f"pytest {NAME} --golden-update" in out


def test_nothing_is_called_template_any_more(scene: Path):
    for file in scene.rglob("*"):
        assert "template" not in file.name
        if file.is_file():
            assert not re.search(r"\btemplate\b", file.read_text("utf-8"))


def test_the_scene_is_small(scene: Path):
    """Little enough to read before lunch, and so is one seen from above."""
    other = scene.parent / "above"
    assert main(["new", str(other), "--from-above"]) == 0
    for folder in (scene, other):
        lines = sum(len((folder / name).read_text("utf-8").splitlines()) for name in ("scene.py", "picture.py"))
        assert lines < 120


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


def test_a_full_or_closed_folder_is_told_and_nothing_stays_behind(call, monkeypatch):
    def full(*args: object, **kwargs: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("shutil.copytree", full)
    code, _, err = call("new", NAME)
    assert (code, err) == (1, f"error: {NAME}: cannot be written: no space left on device\n")
    assert list(Path().iterdir()) == []


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


def test_it_is_listed_where_it_stands(call, scene: Path):
    lines = call("list").out.splitlines()
    assert any(re.match(rf"\./{NAME} +A ball tossed", line) for line in lines)
    assert any(re.match(rf"\./{NAME}/still +The same toss", line) for line in lines)
    assert any(line.startswith("golf ") for line in lines)


def test_its_schema_is_in_step(call, scene: Path):
    written = json.loads((scene / f"{NAME}.schema.json").read_text("utf-8"))
    assert written == json.loads(call("schema", f"./{NAME}").out)
    assert "push" in json.dumps(written)
    assert (scene / f"{NAME}.toml").read_text("utf-8").startswith(f"#:schema ./{NAME}.schema.json\n")


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


@pytest.mark.parametrize(
    "settings",
    [
        {"launch.speed": 0, "launch.height": 0},
        {"gravity": 0, "fan.push": 0, "launch.speed": 0},
        {"launch.angle": 180, "launch.speed": 340, "fan.push": 100, "fan.width": 0.05},
        {"ball.radius": 0.5, "launch.height": 0, "floor.restitution": 1},
        {"air.density": 1100, "launch.speed": 340},
        {"fan.place": -100, "fan.width": 50},
    ],
)
def test_extremes_run_and_draw(scene: Path, settings: dict[str, float]):
    loaded = sandbox.load(scene, settings)
    run = sandbox.simulate(loaded)
    assert loaded.rows(run)
    picture = loaded.picture(run, (320, 180))
    assert picture.poster().get_size() == picture.frame(0.5 * run.duration).get_size() == (320, 180)


def test_a_result_that_json_does_not_know(call, scene: Path):
    change(scene / "scene.py", "    ENDED,", '    Fact("run", "", "", lambda run, parameters: run),')
    outcome = call("run", f"./{NAME}", "--json")
    assert outcome[:2] == (1, "")
    expected = "the fact run must return a number, a text, true or false, or a list of those, but returned <Run of"
    assert f"error: {NAME}/scene.py: {expected}" in outcome.err


# Its golden test ------------------------------------------------------------------------------------------------------


def test_its_golden_test(scene: Path):
    """Passes once the files are made, then sees what has changed: the physics, or the drawing."""
    made = pytest_in(scene.parent, NAME, "--golden-update")
    assert made.returncode == 0
    golden = scene / "golden" / f"{NAME}.png"
    assert f"{golden}: new" in made.stdout
    assert 3_000 < golden.stat().st_size < 60_000
    again = pytest_in(scene.parent, NAME)
    assert (again.returncode, "3 passed" in again.stdout) == (0, True)
    change(scene / f"{NAME}.toml", "push = 4.0", "push = 3.9")
    assert "the physics changed" in pytest_in(scene.parent, NAME, "-k", "toss").stdout
    change(scene / f"{NAME}.toml", "push = 3.9", "push = 4.0")
    change(scene / "picture.py", "(40, 52, 60)", "(140, 52, 60)")
    changed = pytest_in(scene.parent, NAME, "-k", "toss")
    assert changed.returncode == 1
    assert "same physics" in changed.stdout


# Mistakes in it -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (
            "scene.py",
            "launch.height, parameters",
            "launch.hight, parameters",
            "AttributeError: 'Toss' object has no",
        ),
        ("scene.py", "def build(", "def build((", "SyntaxError: "),
        ("scene.py", "def build(", "\udcff\ndef build(", "SyntaxError: "),
        ("scene.py", "(position[0]", "(position[2]", "IndexError: tuple index out of range"),
        (
            "scene.py",
            'at(landing, "x")',
            'at(landing, "ex")',
            'ValueError: at(..., "ex"): a Moment has t',
        ),
        ("scene.py", 'run.result["distance"]', 'run.result["distanse"]', "KeyError: 'distanse'"),
        ("scene.py", 'until=Touches("floor", 4)', "until=lambda event: event.foo", "AttributeError: 'Event'"),
        (
            "scene.py",
            "Fan(fan.place, fan.width, fan.push))",
            "Fan)",
            "ValueError: ball 'ball': 'Fan' is not a force",
        ),
        (
            "scene.py",
            "duration=20.0",
            "duration=-20.0",
            "duration = -20.0 s must be positive",
        ),
        ("picture.py", "Place(Hall", "Place(Hole", "NameError: name 'Hole' is not defined"),
        ("picture.py", "launch.height)", "launch.hight)", "AttributeError: 'Toss' object has no"),
        (
            "picture.py",
            "picture.places",
            "picture.plaices",
            "ModuleNotFoundError: No module named 'sandbox.picture.plai",
        ),
    ],
)
def test_a_failure_shows_the_users_lines_and_nothing_of_ours(
    call, scene: Path, file: str, old: str, new: str, expected: str
):
    change(scene / file, old, new)
    code, out, err = call("run", f"./{NAME}", "--poster", "poster.png")
    assert (code, out) == (1, "")
    assert err.startswith("error: your scene failed\n")
    assert expected in err.splitlines()[-1]
    files = [line.split('"')[1] for line in err.splitlines() if line.startswith("  File ")]
    assert set(files) == {str(scene / file)}
    assert not Path("poster.png").exists()


#: Before this method of the picture others are put in.
PLACE = "    @cached_property"


@pytest.mark.parametrize("file", ["scene.py", "picture.py"])
def test_a_file_with_nul_bytes_is_named(call, scene: Path, file: str):
    (scene / file).write_bytes((scene / file).read_bytes() + b"\0")
    expected = f"error: {scene / file}: not a text file, it holds NUL bytes\n"
    assert call("run", f"./{NAME}", "--poster", "poster.png") == (2, "", expected)


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        ("scene.py", "return Setup([", "Setup([", "scene.py: build must return a Setup, but returned None"),
        ("scene.py", 'return "Never', '"Never', "verdict must return text, but returned None"),
        ("scene.py", "FACTS = (", "FACTS = (3,", "FACTS must be a tuple of facts, but 3 is not one"),
        ("scene.py", '"apex", "m"', '"apex", "metres"', 'FACTS: apex has the unit "metres", which is not known'),
        ("scene.py", '"apex", "apex"', '"distance", "apex"', "FACTS: two are called distance"),
        ("scene.py", "def build(parameters: Parameters)", "def build()", "build is called as build(parameters)"),
        ("scene.py", "def verdict(run: Run, ", "def verdict(", "verdict is called as verdict(run, parameters)"),
        ("scene.py", "def build(", "def built(", "a scene needs Parameters, build; build is missing"),
        ("picture.py", "class Picture", "class Pictures", "Picture(run, parameters, size) is missing"),
        ("picture.py", PLACE, f"    poster = None\n\n{PLACE}", "picture.py: Picture.poster(self) is missing"),
        (
            "picture.py",
            PLACE,
            f"    def __init__(self, run): ...\n{PLACE}",
            "called as Picture(run, parameters, size)",
        ),
        ("picture.py", PLACE, f"    def frame(self, x, t): ...\n{PLACE}", "called as Picture.frame(self, t)"),
        (
            "picture.py",
            PLACE,
            f"    def poster(self): ...\n{PLACE}",
            "must return a pygame.Surface, and returned None",
        ),
        ("scene.py", "return 0.0, self.push", "0.0, self.push", "must return"),
        ("scene.py", "return 0.0, self.push", "return self.push", "must return"),
        ("scene.py", "velocity: Any, spin: Any)", "velocity: Any)", "is called with"),
        ("scene.py", "CONTROLS = Controls(", "CONTROLS = dict(", "CONTROLS must be a sandbox.sport.controls.Controls"),
        (
            "scene.py",
            'Handle("fan.place"',
            'Handle("fan.plaice"',
            f'{NAME}/scene.py: CONTROLS handles "fan.plaice": unknown key; did you mean fan.place?',
        ),
        ("scene.py", "strongest=20.0", 'speed="launch.sped"', 'CONTROLS speed "launch.sped": unknown key; did'),
        ("scene.py", '(Spin("launch.spin", 20.0),)', '(Spin("launch.spin", 20.0))', "CONTROLS spins = Spin("),
        (
            "scene.py",
            "strongest=20.0",
            'scores="enbed"',
            'CONTROLS scores "enbed": no such result; did you mean ended?',
        ),
        ("scene.py", "strongest=20.0", 'fan_fact="apx"', 'CONTROLS fan_fact "apx": no such result; did you mean apex?'),
    ],
)
def test_what_is_handed_back_wrongly_is_said_in_a_line(call, scene: Path, file: str, old: str, new: str, expected: str):
    change(scene / file, old, new)
    code, out, err = call("run", f"./{NAME}", "--poster", "poster.png")
    assert code in (1, 2)
    assert out == ""
    assert expected in err
    assert 1 <= len(err.strip().splitlines()) <= 2
