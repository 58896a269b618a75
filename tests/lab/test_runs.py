"""Many runs of a scene: built at once, and ended when the facts that are asked for are final."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sandbox
from sandbox import parameters as declared
from sandbox.engine.many.stacking import FEWEST, agree
from sandbox.engine.paths.run import Run
from sandbox.lab import runs as lab_runs
from sandbox.lab.axes import Varied
from sandbox.lab.runs import builder, built_at_once, runs
from sandbox.scene import listings, load
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.facts import Fact
from sandbox.sport.readings import apex, fact_from, first_contact_with, passing_at
from tests.own_scene import DROP, change, copy_of

SCENES = [listing.name for listing in listings() if "/" not in listing.name]


@pytest.mark.parametrize("name", SCENES)
def test_what_is_built_at_once_is_what_is_built_for_each(name: str):
    scene = load(name, {"zero.distance": 0.0} if name == "bullet" else {})  # a zero is found by runs, one for each
    build = builder(scene, ())
    at_once = set()
    for parameter in declared.walk(scene.parameters):
        if not isinstance(parameter.value, float) or parameter.low is None or parameter.high is None:
            continue
        values = np.clip(parameter.value * np.linspace(0.9, 1.15, FEWEST) + 1e-3, parameter.low, parameter.high)
        varied, points = Varied(scene, [parameter.key]), [(value,) for value in values.tolist()]
        each = [varied.parameters(point) for point in points]
        ((_, many),) = varied.together(points)
        stack = built_at_once(build, many, each)
        if stack is not None:
            at_once.add(parameter.key)
            assert all(agree(stack[place], build(each[place])) for place in range(1, FEWEST, 6)), parameter.key
    if name in ("basketball", "golf", "soccer", "volleyball"):
        assert at_once >= {"launch.speed", "launch.angle"}


def test_a_build_differing_between_compared_points_is_rejected():
    scene = load("basketball")
    points = [(angle,) for angle in np.linspace(40.0, 60.0, FEWEST).tolist()]
    varied = Varied(scene, ["launch.angle"])
    each = [varied.parameters(point) for point in points]
    ((_, many),) = varied.together(points)
    build = builder(scene, ())
    assert built_at_once(build, many, each) is not None
    assert built_at_once(build, many, each[::-1]) is None  # what is built alone differs
    only_floats = lambda given: build(given if isinstance(given.launch.angle, float) else each[0])  # noqa: E731
    assert built_at_once(only_floats, many, each) is None


def test_facts_from_arrays_are_those_of_single_runs(monkeypatch):
    """Short throws do not pass the line: what a fact does then it must do for each of these."""
    scene, line = load("throws"), passing_at(lambda it: 20.0)
    computed: dict[str, Callable[[Any, Any], Any]] = {
        "height": fact_from(line, "y"),
        "angle": fact_from(line, "descent"),
        "squared": fact_from(line, lambda ball, it: ball.speed * ball.speed / it.launch.speed),
        "passes": lambda run, it: 0.0 if line(run, it) is None else 1.0,
        "higher": lambda run, it: None if (ball := line(run, it)) is None else max(ball.y, 3.0),
        "above": lambda run, it: apex(run, it) - it.release.height,
        "landing": fact_from(first_contact_with("ground"), "speed"),
        "touched": lambda run, it: len(run.events),
        "mixed": lambda run, it: float(np.max(it.launch.speed)),
        "word": lambda run, it: "thrown",
    }
    monkeypatch.setattr(scene.module, "FACTS", tuple(Fact(key, "", "", how) for key, how in computed.items()))
    at_once: list[list[str]] = []
    found_at_once = lab_runs.facts_at_once
    noted = lambda *given: at_once.append(list(found := found_at_once(*given))) or found  # noqa: E731
    monkeypatch.setattr(lab_runs, "facts_at_once", noted)
    points = [(speed,) for speed in np.linspace(9.0, 17.0, FEWEST + 6).tolist()]
    found = list(runs(scene, ["launch.speed"], points))
    for run in found:
        assert isinstance(run, SceneRun)
        for key, value in run.scene.result(run.data).items():
            assert run.result[key] == (pytest.approx(value, rel=1e-12) if isinstance(value, float) else value), key
    assert {run.result["passes"] for run in found} == {0.0, 1.0}
    assert at_once == [["height", "angle", "squared", "passes", "above", "landing", "word"]]


def test_a_shot_that_begins_on_the_ground_has_its_launch():
    """Among others, too: a slow one stays there, and its landing is its launch."""
    speeds = np.linspace(1.0, 3.0, FEWEST).tolist()
    slow = next(runs(load("golf"), ["launch.speed"], [(speed,) for speed in speeds], asked=["landing_angle"]))
    alone = sandbox.simulate(load("golf", {"launch.speed": 1.0}))
    assert isinstance(slow, SceneRun)
    assert slow.result["landing_angle"] == alone.result["landing_angle"] == pytest.approx(-10.4)


def test_the_accuracy_may_differ_from_shot_to_shot():
    tolerances = np.geomspace(1e-6, 1e-3, FEWEST).tolist()
    found = list(runs(load("throws"), ["accuracy.tolerance"], [(each,) for each in tolerances]))
    assert [run.accuracy.tolerance for run in found] == tolerances
    alone = sandbox.simulate(load("throws", {"accuracy.tolerance": tolerances[-1]}))
    assert found[-1].result == alone.result


def test_numbers_and_words_may_be_mixed():
    keys = ["launch.speed", "ball.drag.model", "accuracy.level"]
    points = [
        (speed, drag, level)
        for speed in np.linspace(6.0, 9.0, 30).tolist()
        for drag in ("constant", "none", "unknown")
        for level in ("fast", "balanced")
    ]
    for place, (point, run) in enumerate(zip(points, runs(load("basketball"), keys, points), strict=True)):
        assert isinstance(run, sandbox.RequestError if point[1] == "unknown" else Run)
        if point[1] == "unknown" or place % 7:  # each word is among the others
            continue
        alone = sandbox.simulate(load("basketball", dict(zip(keys, point, strict=True))))
        assert run.result["verdict"] == alone.result["verdict"]
        assert run.result["apex"] == pytest.approx(alone.result["apex"], abs=1e-9)
        assert run.accuracy == alone.accuracy


def test_no_fact_is_computed_where_only_paths_are_asked_for(tmp_path: Path):
    drop = copy_of(DROP, tmp_path / "drop")
    change(drop / "scene.py", "FACTS = (", 'FACTS = (Fact("wrong", "", "", lambda run, it: 1 / 0),')
    found = list(runs(load(drop), ["launch.height"], [(1.0,), (2.0,)], until=0.5))
    assert [(run.duration, run.result) for run in found if isinstance(run, SceneRun)] == [(0.5, {})] * 2
