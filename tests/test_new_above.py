"""``sandbox new NAME --from-above``: a scene seen from above, as complete as one seen from the side, and as short."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import sandbox
from sandbox.cli import main
from tests.picture.legible import assert_legible
from tests.test_new import pytest_in

NAME = "minigolf"


@pytest.fixture
def scene(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a scene that was just written."""
    monkeypatch.chdir(tmp_path)
    assert main(["new", NAME, "--from-above"]) == 0
    assert f"wrote {Path(NAME) / 'picture.py'}" in capsys.readouterr().out
    return tmp_path / NAME


def test_it_is_whole_and_short(scene: Path):
    files = {str(path.relative_to(scene)) for path in scene.rglob("*") if path.is_file()}
    own = {f"{NAME}.toml", f"{NAME}.schema.json", f"test_{NAME}.py"}
    assert files == {"scene.py", "picture.py", "presets/one-board.toml"} | own
    assert all(not re.search("template", (scene / file).read_text("utf-8")) for file in files)
    lines = [len((scene / file).read_text("utf-8").splitlines()) for file in ("scene.py", "picture.py")]
    assert sum(lines) < 120


def test_it_runs_draws_and_compares(scene: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["run", f"./{NAME}", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)["result"]
    assert (result["holed"], result["to_cup"], result["bounces"]) == (True, None, 2)
    command = ["run", f"./{NAME}", "--poster", "poster.png", "--compare", f"./{NAME}/one-board", "--strip", "film.png"]
    assert main(command) == 0
    assert Path("poster.png").stat().st_size > 10_000
    assert Path("film.png").stat().st_size > 10_000


@pytest.mark.parametrize("size", [(320, 180), (640, 360), (480, 960), (1920, 1080)], ids=str)
def test_its_pictures_are_legible(scene: Path, size: tuple[int, int]):
    run, other = (sandbox.simulate(sandbox.load(source)) for source in (scene, scene / "one-board"))
    picture = run.scene.picture(run, size, {"one board": other})
    for t in (None, 0.5 * run.duration):
        picture.poster() if t is None else picture.frame(t)
        assert_legible(picture.sheet)
    (left, top), (right, bottom) = picture.camera.pixel(-2.0, 0.7), picture.camera.pixel(2.0, -0.7)
    assert 0 < left < right < size[0]
    assert picture.sheet.top_row < top < bottom < picture.card_row


@pytest.mark.parametrize(
    "settings",
    [
        {"launch.speed": 0},
        {"launch.speed": 20, "launch.angle": 180, "launch.roll": -1},
        {"lane.length": 50, "lane.width": 20},
        {"lane.width": 0.3, "lane.block": 0.05},
        {"lane.felt": 0.001, "launch.speed": 10},
    ],
)
def test_extremes_run_and_draw(scene: Path, settings: dict[str, float]):
    loaded = sandbox.load(scene, settings)
    run = sandbox.simulate(loaded)
    assert loaded.rows(run)
    picture = loaded.picture(run, (320, 180))
    assert picture.poster().get_size() == picture.frame(0.5 * run.duration).get_size() == (320, 180)


def test_its_golden_test(scene: Path):
    assert pytest_in(scene.parent, NAME, "--golden-update").returncode == 0
    again = pytest_in(scene.parent, NAME)
    assert (again.returncode, "3 passed" in again.stdout) == (0, True)
