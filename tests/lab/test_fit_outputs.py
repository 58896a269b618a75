"""Reports and files of a fit: models, warnings, outliers, JSON, picture, page, and a scene file with its points."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest

import sandbox
from sandbox.cli.program import call
from sandbox.errors import RequestError
from sandbox.lab.fit import Fit, report
from sandbox.lab.report import as_json

TRUE = {"launch.speed": 7.1, "floor.restitution": 0.71}
RANGES = {"launch.speed": (6, 9), "floor.restitution": (0.5, 0.9)}
FREE_KICK = {"ball.drag.model": "constant", "ball.drag.coefficient": 0.2, "wall.present": False}


def track(scene: str, changes: dict[str, Any], last: float, sd: float, points: int = 40) -> dict[str, Any]:
    """Points of a run at even times up to ``last`` in s, with errors of ``sd`` in m."""
    run = sandbox.simulate(sandbox.load(scene, changes))
    t = np.linspace(0.0, last, points)
    x, y = (run.states("ball", t)[:, :2] + np.random.default_rng(4).normal(0.0, sd, (points, 2))).T
    return {"t": t, "x": x, "y": y}


def said(found: Fit) -> str:
    return " ".join(report.sentences(found))


@pytest.fixture(scope="module")
def gross() -> Fit:
    """A throw of which three points were clicked 0.5 m off."""
    points = track("basketball", TRUE, 3.4, 0.008)
    for row in (4, 16, 29):
        points["y"][row] += 0.5
    return sandbox.fit("basketball", points, RANGES, robust=True)


def test_gross_errors_are_named_and_hardly_count(gross: Fit):
    assert gross.outliers == (5, 17, 30)
    assert gross.loss in report.title(gross) == "basketball: 40 points, Tukey's biweight"
    for key, one in gross.values.items():
        assert one.low < TRUE[key] < one.high
    assert list(gross.residual_sd.values()) == pytest.approx([0.008, 0.008], rel=0.25)


def test_json_has_what_was_promised(gross: Fit):
    told = json.loads(as_json(gross.report()))
    assert told["values"]["launch.speed"].keys() >= {"value", "low", "high", "unit"}
    assert told["values"]["launch.speed"]["unit"] == "m/s"
    assert told["residual_sd"].keys() == {"x", "y"}
    assert told["outliers"] == [5, 17, 30]
    assert told["points"] == 40
    assert abs(told["correlations"]["launch.speed, floor.restitution"]) < 1.0


def test_models_are_compared_in_a_sentence():
    points = track("tennis", {}, 0.9, 0.01, 20)
    ranges, models = (
        {"launch.speed": (48, 58), "launch.angle": (-8, -2)},
        {"ball.drag.model": ["none", "cross-lindsey"]},
    )
    found = sandbox.fit("tennis", points, ranges, models=models)
    assert list(found.models) == ["cross-lindsey", "none"]
    assert found.models["none"].behind > 10.0
    assert found.scene.parameters.ball.drag.model == "cross-lindsey"
    assert "cross-lindsey fits best; none (AICc" in said(found)
    assert said(found).count("is ruled out") == 1
    with pytest.raises(RequestError, match="did you mean none"):
        sandbox.fit("tennis", points, {"launch.speed": (48, 58)}, models={"ball.drag.model": ["non", "constant"]})
    with pytest.raises(RequestError, match="alone cannot be compared"):
        sandbox.fit("tennis", points, {"launch.speed": (48, 58)}, models={"ball.drag.model": ["none"]})


def test_what_cannot_be_told_apart_is_said_with_what_would_help():
    kick = track("soccer", FREE_KICK, 0.4, 0.02, 14)
    fixed = sandbox.load("soccer", FREE_KICK)
    found = sandbox.fit(fixed, kick, {"launch.speed": (20, 35), "ball.drag.coefficient": (0, 1)})
    assert "launch.speed and ball.drag.coefficient have strongly correlated errors" in said(found)
    assert "more of the path would help, up to " in said(found)


def test_a_model_that_does_not_explain_the_track_is_warned_of():
    kick = track("soccer", {**FREE_KICK, "ball.drag.coefficient": 0.5}, 0.9, 0.01, 30)
    without = sandbox.load("soccer", {"ball.drag.model": "none", "wall.present": False})
    found = sandbox.fit(without, kick, {"launch.speed": (20, 35), "launch.angle": (10, 30)})
    assert found.pattern > 2.0
    assert "the residuals have a pattern" in said(found)
    right = sandbox.fit(
        sandbox.load("soccer", {**FREE_KICK, "ball.drag.coefficient": 0.5}), kick, {"launch.speed": (20, 35)}
    )
    assert right.pattern == 0.0


def test_ends_of_ranges_and_unknown_values_are_said():
    points = track("basketball", TRUE, 0.8, 0.008)
    found = sandbox.fit("basketball", points, {"launch.speed": (7.2, 9), "floor.restitution": (0.5, 0.9)})
    assert found.values["launch.speed"].at_bound
    assert "launch.speed stopped at the end of its range, 7.2 m/s" in said(found)
    assert found.values["floor.restitution"].unknown
    assert (found.values["floor.restitution"].low, found.values["floor.restitution"].high) == (0.5, 0.9)


def test_points_after_the_end_of_the_run_are_said():
    scene = sandbox.load("throws")
    end = sandbox.simulate(scene).duration
    points = track("throws", {}, end, 0.01, 20)
    points["t"][-1] = end + 0.1
    found = sandbox.fit(scene, points, {"launch.speed": (10, 20)}, robust=True)
    assert found.late == 1
    assert f"1 point later than {end:.3g} s, where this scene ends its runs" in said(found)


@pytest.fixture
def folder(gross: Fit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    points = gross.measured.points(gross.scene, ())
    assert points is not None
    (tmp_path / "throw.csv").write_text(points.as_csv())
    monkeypatch.chdir(tmp_path)
    return tmp_path


COMMAND = ["fit", "basketball", "throw.csv", "--vary", "launch.speed=6:9", "--vary", "floor.restitution", "--robust"]


def test_picture_page_and_scene_file_are_written(folder: Path, capsys):
    assert call([*COMMAND, "--plot", "fit.png", "--page", "fit.html", "--save", "fitted.toml"]) == 0
    written = [line.removeprefix("wrote ") for line in capsys.readouterr().out.splitlines() if "wrote" in line]
    assert written == ["fitted.toml", "fitted.csv", "fit.png", "fit.html"]
    assert (folder / "fit.png").stat().st_size > 20_000
    page = (folder / "fit.html").read_text()
    assert "<svg" in page
    assert "sandbox run basketball --set launch.speed=7.1" in page
    saved = sandbox.load(folder / "fitted.toml")
    assert saved.parameters.floor.restitution == pytest.approx(0.71, abs=0.003)
    assert saved.measured is not None
    assert len(saved.measured.t) == 40
    with_dots, without = (
        pygame.surfarray.array3d(scene.picture(sandbox.simulate(scene)).poster())
        for scene in (saved, sandbox.load("basketball", {**TRUE, "launch.speed": saved.parameters.launch.speed}))
    )
    assert (with_dots != without).any(axis=2).sum() > 40 * 9


def test_a_fit_that_fails_writes_nothing(folder: Path, capsys):
    before = sorted(folder.iterdir())
    wrong = [[*COMMAND[:1], "golf", "throw.csv", "--vary", "launch.speed=10:90", "--save", "x.toml", "--plot", "x.png"],
             [*COMMAND, "--save", "throw.toml"], [*COMMAND, "--save", "x.json"], [*COMMAND, "--plot", "x.pdf"],
             [*COMMAND, "--models", "ball.drag.modl"]]  # fmt: skip
    expected = [
        "comes near this track",
        "its points would be written over throw.csv",
        "--save x.json",
        "--plot x.pdf",
        "modl",
    ]
    for command, words in zip(wrong, expected, strict=True):
        assert call(command) == 2
        shown = capsys.readouterr()
        assert words in shown.err
        assert (shown.out, len(shown.err.splitlines()), sorted(folder.iterdir())) == ("", 1, before)


@pytest.mark.parametrize(
    ("table", "wrong"),
    [
        ('measured = "throw.csv"', r"must be \[measured\] with track"),
        ('measured = { track = "none.csv" }', "none.csv"),
        ('measured = { track = "bad.csv" }', "row 2 is not t, x, y, ball"),
        ('measured = { track = "other.csv" }', "must have rows with t, x, y, ball"),
    ],
)
def test_measured_points_that_cannot_be_read_are_one_line(table: str, wrong: str, tmp_path: Path):
    (tmp_path / "bad.csv").write_text("t,x,y,ball\n0,1,2,ball\n1,here,2,ball\n")
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    (tmp_path / "shot.toml").write_text(f'scene = "basketball"\n{table}\n')
    with pytest.raises(RequestError, match=wrong) as error:
        sandbox.load(tmp_path / "shot.toml")
    assert "\n" not in str(error.value)


def test_a_track_without_noise_shows_seven_digits():
    found = sandbox.fit("throws", track("throws", {}, 1.5, 0.0, 12), {"launch.speed": (10, 20)})
    assert report.value_rows(found) == [("launch.speed", "14.00000", "m/s", "14.00000 to 14.00000", "± 0 %")]


def test_points_of_several_balls_have_the_colours_of_their_paths():
    run = sandbox.simulate(sandbox.load("collisions"))
    t = np.linspace(0.0, 0.6, 10)
    places = np.vstack([run.states(ball, t)[:, :2] for ball in ("first", "second")])
    noise = np.random.default_rng(0).normal(0.0, 0.002, (20, 2))
    x, y = (places + noise).T
    track = {"t": np.tile(t, 2), "x": x, "y": y, "ball": ["first"] * 10 + ["second"] * 10}
    picture = np.asarray(sandbox.fit("collisions", track, {"launch.speed": (1, 3)}).plot().convert("RGB")).astype(int)
    residuals = picture[len(picture) * 2 // 3 :]  # below the paths
    for colour in ((213, 94, 0), (0, 114, 178)):  # of the first path and the second
        assert (np.abs(residuals - colour).max(axis=2) < 4).sum() > 20
