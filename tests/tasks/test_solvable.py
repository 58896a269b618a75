"""Every task can be solved, and none by holding the button; each sport has three, in rising order."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import pytest

from sandbox import resources
from sandbox.lab.runs import runs
from sandbox.scene.scene_run import SceneRun
from sandbox.tasks import Session, Task, load, tasks

SOLUTIONS = json.loads((Path(__file__).parent / "solutions.json").read_text("utf-8"))

of_name = cache(load)


@pytest.mark.parametrize("name", tasks())
def test_a_task_can_be_solved(name: str):
    """By the shots that docs/measure_tasks.py found for its first attempt."""
    session = Session(of_name(name), noise=False)
    for values in SOLUTIONS[name]["shots"]:
        shot = session.shoot(values)
    assert shot.made
    assert session.attempts[0].over


@pytest.mark.parametrize("name", tasks())
def test_holding_the_button_passes_no_task(name: str):
    """Neither where the controls stand at first, nor at full strength or the least."""
    task = of_name(name)
    first = task.controls[0]
    held = [{}, {first.key: first.high}, {first.key: first.low}]
    passed = _passed_at_once if task.shots == 1 else _passed_shot_by_shot
    assert [values for values in held if passed(task, values)] == []


def _passed_at_once(task: Task, values: Mapping[str, float]) -> bool:
    """True if the same shot in all attempts passes: computed as arrays, and ended when the score is final."""
    drawn = [list(task.drawn_for(0, attempt).values()) for attempt in range(1, task.attempts + 1)]
    keys = [*(start.key for start in task.start), *task.defaults]
    points = [[*start, *task.aimed(values).values()] for start in drawn]
    found = [run for run in runs(task.scene, keys, points, asked=task.facts) if isinstance(run, SceneRun)]
    assert len(found) == len(points)
    return task.passed(task.score.total([task.score.of_shot(run.result) for run in found]))


def _passed_shot_by_shot(task: Task, values: Mapping[str, float]) -> bool:
    session = Session(task, noise=False)
    while not session.over:
        session.shoot(values)
    return session.passed


#: Sports that have a task at each of the five levels.
FIVE = {
    "basketball",
    "golf",
    "soccer",
    "soccer-curl",
    "billiards",
    "baseball",
    "tennis",
    "bowling",
    "minigolf",
    "putting",
}


def test_sports_with_tasks_have_one_at_each_level_from_the_first():
    scenes = {path.parent.parent.name for path in resources.folder("scenes").glob("*/tasks/*.toml")}
    assert len(scenes) >= 19
    for scene in sorted(scenes):
        levels = [of_name(name).level for name in tasks() if of_name(name).file.parent.parent.name == scene]
        assert levels == [1, 2, 3, 4, 5] if scene in FIVE else levels == [1, 2, 3], scene
    assert all(of_name(name).file.parent.parent.name == of_name(name).scene.name for name in tasks())


def test_a_practised_player_makes_a_quarter_of_the_shots():
    """As docs/measure_tasks.py has measured it, with the noise of his aim; a random shot is seldom a success, but for
    the first task of a sport."""
    assert [name for name in tasks() if SOLUTIONS[name]["practised"] < 0.25] == []
    most = {1: 0.75}
    assert [name for name in tasks() if SOLUTIONS[name]["by_chance"] > most.get(of_name(name).level, 0.3)] == []
