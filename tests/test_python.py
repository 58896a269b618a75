"""The package as a library: its names, their examples, its types, its errors, and docs/python.md."""

from __future__ import annotations

import doctest
import inspect
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sandbox
from sandbox import Ball, Body, Drag, Gravity, RequestError, Segment, Setup, Surface, box
from sandbox.scene.setup_scene import with_scene

ROOT = Path(__file__).resolve().parent.parent
PAGE = (ROOT / "docs" / "python.md").read_text("utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
DOCTEST = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL
#: Of the names, those that are numbers.
NUMBERS = [name for name in sandbox.__all__ if isinstance(getattr(sandbox, name), float)]


def ball(**changes: Any) -> Ball:
    given = {"mass": 0.62, "radius": 0.12, "position": (0, 2), "velocity": (5, 6), "forces": [Gravity(9.81)]}
    return Ball("ball", **{**given, **changes})


def setup(*more: Ball, duration: float = 3.0) -> Setup:
    floor = Surface("floor", Segment((-10, 0), (30, 0)), restitution=0.8, friction=0.4)
    return Setup([ball(), *more], [floor], duration=duration)


@pytest.fixture(scope="module")
def run() -> sandbox.Run:
    return sandbox.simulate(setup())


# Names and pages ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name in sandbox.__all__ if name not in NUMBERS])
def test_the_example_of_each_name_runs(name: str):
    thing = getattr(sandbox, name)
    examples = doctest.DocTestParser().get_examples(inspect.cleandoc(thing.__doc__))
    assert examples, f"{name} has no example"
    test = doctest.DocTest(examples, {}, name, None, None, None)
    said: list[str] = []
    failed = doctest.DocTestRunner(optionflags=DOCTEST).run(test, out=said.append)
    assert failed.failed == 0, "".join(said)


def test_every_name_is_on_the_page():
    assert [name for name in sandbox.__all__ if f"`{name}`" not in PAGE] == []
    methods = [name for name in dir(sandbox.Run) if not name.startswith("_") and callable(getattr(sandbox.Run, name))]
    assert [name for name in methods if f"`run.{name}(" not in PAGE] == []


def test_the_code_of_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """All of it in one go, as somebody would who reads it from the top."""
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for block in BLOCKS:
        exec(block, names)
    assert len(BLOCKS) > 5
    assert {"shot.png", "shot.html", "shot.gif", "energy.png"} <= {path.name for path in tmp_path.iterdir()}


def test_help_leads_to_the_run():
    said = sandbox.simulate.__doc__ or ""
    assert "sandbox.Run" in said
    assert "poster" in dir(sandbox.Run)


# A setup directly ---------------------------------------------------------------------------------------------------


def test_a_setup_gives_a_run_and_a_scene_a_run_of_a_scene(run: sandbox.Run):
    """The first touch is where 2 + 6 t - 9.81 t^2 / 2 = 0.12."""
    assert type(run) is sandbox.Run
    assert type(sandbox.simulate("golf")) is sandbox.SceneRun
    assert run.events[0].t == pytest.approx((6 + (36 + 2 * 9.81 * 1.88) ** 0.5) / 9.81, abs=1e-9)


def test_accuracy_is_a_level_or_the_scenes_own():
    assert sandbox.simulate(setup()).accuracy.level == "balanced"
    precise = sandbox.simulate(setup(), accuracy="precise").accuracy
    assert (precise.level, sandbox.simulate(setup(), precise).accuracy) == ("precise", precise)
    own = sandbox.load("golf", {"accuracy.level": "fast"})
    assert [sandbox.simulate(own, level).accuracy.level for level in (None, "precise")] == ["fast", "precise"]
    assert sandbox.simulate(own, precise).accuracy == precise


def test_forces_take_mass_and_radius_from_their_ball():
    heavy = Ball("ball", mass=3.0, radius=0.2, position=(0, 0), forces=[Gravity(9.81), Drag(coefficient=0.5)])
    given = [Gravity(9.81, 3.0), Drag(0.2, 1.225, lambda reynolds, spin_ratio: 0.5)]
    now = 0.0, (0.0, 0.0), (3.0, 4.0), 0.0
    assert [force(*now) for force in heavy.forces] == [force(*now) for force in given]
    with pytest.raises(ValueError, match="in no ball's list of forces"):
        Drag()(*now)


# Times and states ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("t", [-1e-6, 3.000001, float("nan"), float("inf")])
def test_a_time_outside_the_run_is_an_error_or_nan(run: sandbox.Run, t: float):
    for asked in (lambda: run.state("ball", t), lambda: run.states("ball", [1.0, t]), lambda: run.angle("ball", t)):
        with pytest.raises(RequestError, match=r"the run is from 0 to 3 s"):
            asked()
    assert np.isnan(run.state("ball", t, outside="nan")).all()
    assert np.isnan(run.states("ball", [1.0, t], outside="nan")).all(axis=1).tolist() == [False, True]


def test_a_time_that_rounding_moved_out_is_the_end(run: sandbox.Run):
    assert run.state("ball", 3.0 * (1 + 1e-15)) == run.state("ball", run.duration)


def test_states_have_a_row_for_each_time(run: sandbox.Run):
    times = [2.0, 0.5, 3.0]
    assert run.states("ball", times).tolist() == [list(run.state("ball", t)) for t in times]
    assert run.states("ball", []).shape == (0, 5)
    crate = Body("crate", position=(6, 3), shape=box(0.4, 0.3), mass=2.0, angle=0.3, spin=1.0)
    both = sandbox.simulate(setup(crate, duration=0.5))
    assert both.states("crate", [0.0, 0.5])[:, 5].tolist() == pytest.approx([0.3, 0.8])
    assert both.states("ball", np.array([0.0, 0.5])).shape == (2, 5)


# Pictures -----------------------------------------------------------------------------------------------------------


def test_a_bare_run_has_all_pictures(run: sandbox.Run, tmp_path: Path):
    size = (320, 180)
    assert run.poster(size=size).size == run.frame(1.0, size).size == run.energy_chart(size=size).size == size
    assert run.frames(tmp_path / "frames", fps=2, size=size) == len(list((tmp_path / "frames").iterdir())) == 7
    run.animate(tmp_path / "run.webp", size, fps=2)
    run.graph(tmp_path / "graph.png")
    run.page(tmp_path / "run.html")
    assert all((tmp_path / name).stat().st_size > 1000 for name in ("run.webp", "graph.png", "run.html"))
    assert "<code>" not in run.page()  # a setup has no command


def test_the_picture_of_a_setup_names_its_surfaces(run: sandbox.Run):
    shown = with_scene(run)
    view = shown.scene.picture(shown, (640, 360))
    view.poster()
    assert "floor" in dict(view.sheet.written)


# Errors -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: ball(forces=Gravity(9.81)), r"ball 'ball': forces = Gravity\(.*\) must be a list: write it in \[ \]"),
        (lambda: ball(mass="0.62"), r"ball 'ball': mass = '0.62' must be positive"),
        (lambda: ball(position=2.0), r"ball 'ball': position = 2.0 must be two finite numbers, \(x, y\)"),
        (lambda: Setup(ball()), r"setup: balls = Ball\(.*\.\.\. must be a list: write it in \[ \]"),
        (lambda: Setup([Segment((0, 0), (1, 0))]), r"balls: Segment\(.*\) is no Ball or Body"),
        (lambda: Setup([ball()], [Segment((0, 0), (1, 0))]), r"surfaces: Segment\(.*\) is a shape: write Surface\("),
        (lambda: sandbox.simulate(ball()), r"Ball\(.*: must be a setup, a scene, its name, or the path of its file"),
        (lambda: sandbox.simulate(setup(), "exact"), "accuracy.level: 'exact' is not one of fast, balanced, precise"),
        (lambda: sandbox.simulate(setup(), 3), "accuracy = 3: must be the name of a level, or an Accuracy"),
        (lambda: sandbox.load("golf", ["launch.speed"]), "must be a dictionary such as"),
        (lambda: sandbox.sweep("golf", ["launch.speed"]), "over = .*: must be a dictionary such as"),
        (lambda: sandbox.aim("golf", ["launch.speed"]), "vary = .*: must be a dictionary such as"),
        (lambda: sandbox.simulate(setup()).state("bal", 0.0), "there is no ball 'bal'; there are 'ball'"),
        (lambda: ball(forces=[Drag(0.47)]), r"Drag: radius = 0.47 m is not that of ball 'ball', .*\(coefficient="),
        (lambda: sandbox.simulate(setup()).state("ball", "now"), "t = 'now': must be a number, in s"),
        (lambda: sandbox.simulate(setup()).states("ball", ["now"]), r"times = \['now'\]: must be numbers, in s"),
        (lambda: sandbox.simulate(setup()).fork(0.1, remove=[{}]), "remove: there is no ball {}"),
        (lambda: sandbox.simulate(setup()).poster(size=300), "must be two whole numbers, between .* px"),
        (lambda: sandbox.simulate_many("golf", {"launch.speed": [60]}, facts=None), "facts = None: must be a tuple"),
        (lambda: sandbox.World("golf").apply(3.0), "parameters = 3.0: must be a dictionary such as"),
        (lambda: sandbox.simulate(setup()).state("ball", 4.0, "last"), 'outside = \'last\': must be "error" or "nan"'),
    ],
)
def test_a_mistake_is_one_line_that_says_what_was_meant(wrong: Any, said: str):
    with pytest.raises((RequestError, ValueError), match=said) as error:
        wrong()
    assert len(str(error.value).splitlines()) == 1


def test_an_unknown_result_names_the_one_that_was_meant():
    result = sandbox.simulate("golf").result
    with pytest.raises(KeyError) as error:
        result["cary"]
    assert str(error.value) == "'cary': no such result; did you mean carry?"
    assert result.get("cary") is None
