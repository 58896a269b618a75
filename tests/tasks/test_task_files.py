"""Tasks from the command line, and what is wrong with a task file in one line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sandbox.tasks import load
from tests.own_scene import assert_refused, change

TASK = """
goal = "Throw it in"
scene = "basketball"
attempts = 3
shown = "one metre"
pass = 2
stars = [1, 2, 3]
score = "made"

[[start]]
key = "hoop.distance"
low = 4
high = "5 m"

[[controls]]
key = "launch.speed"
low = 5
high = 10
"""


#: The lines of it that say what counts.
COUNTED = 'pass = 2\nstars = [1, 2, 3]\nscore = "made"'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(TASK)
    return path


def test_the_list_says_what_a_task_is(call):
    code, out, _ = call("tasks")
    assert code == 0
    assert "Make three of five free throws" in out
    listed = {task["name"]: task for task in json.loads(call("tasks", "--json")[1])}
    assert listed["free-throw"] == {
        "name": "free-throw",
        "scene": "basketball/free-throw",
        "level": 2,
        "goal": "Make three of five free throws",
        "attempts": 5,
        "score": "made",
    }
    assert listed["closest-to-the-pin"]["score"] == "nearest: distance_to_pin"


def test_an_attempt_is_run_from_what_is_drawn_for_it(call, file: Path):
    first, third, again = (json.loads(call("run", file, "--json", "--attempt", n)[1]) for n in (1, 3, 3))
    for part in ("parameters", "result", "attempt"):
        assert third[part] == again[part]
    distances = [run["parameters"]["hoop"]["distance"] for run in (first, third)]
    assert 4.0 <= min(distances) < max(distances) <= 5.0
    assert third["attempt"]["start"] == {"hoop.distance": distances[1]}
    assert first["attempt"]["start"] != json.loads(call("run", file, "--json", "--seed", 1)[1])["attempt"]["start"]
    code, out, _ = call("run", "free-throw", "--set", "launch.speed=7.391", "--set", "launch.angle=52")
    assert code == 0
    assert "counts 1 (made)" in " ".join(out.split())
    assert "launch.speed = 7.391 m/s" in out


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ('"made"', '"maed"', 'score.fact = "maed": no such result; did you mean made?'),
        ("low = 5", "low = -1", "controls[0].low = -1: launch.speed must be from 0 to 340 m/s"),
        ("low = 5", "low = 12", "controls[0], launch.speed: low = 12 must be below high = 10"),
        ("low = 5", 'low = "5 kg"', 'controls[0].low = "5 kg": '),
        ("low = 5\n", "", "controls[0].low: missing"),
        (
            '"launch.speed"',
            '"launch.sped"',
            'controls[0].key = "launch.sped": basketball has no such parameter; did you',
        ),
        ('"launch.speed"', '"hoop.distance"', "hoop.distance: is given twice in start and controls"),
        ('"launch.speed"', '"net.slows"', "controls[0], net.slows: is not a number, and has no range; give values"),
        ("high = 10", "high = 10\ndefault = 11", "controls[0].default = 11: must be from 5 to 10 m/s"),
        ("high = 10", 'high = 10\nnoise = "-1 %"', 'controls[0].noise = "-1 %": a standard deviation is 0 or more'),
        ('high = "5 m"', "high = 600", "start[0].high = 600: hoop.distance must be from 0 to 500 m"),
        ("attempts = 3", "attempts = 0", "attempts = 0: must"),
        (
            "attempts = 3",
            "attempts = 3\nshots = 2",
            "shots = 2: a shot of basketball does not go on from the one before",
        ),
        ("pass = 2\n", "", "pass: missing"),
        ("pass = 2", "pas = 2", "pas: unknown key; did you mean pass?"),
        ("pass = 2", 'pass = "two"', 'pass = "two": '),
        ("stars = [1, 2, 3]", "stars = [3, 2, 1]", "stars = [3, 2, 1]: must be rising"),
        ("pass = 2", "pass = 20", "pass = 20: 3 attempts can reach 3 at most"),
        ("stars = [1, 2, 3]", "stars = [1, 2, 4]", "stars[2] = 4: 3 attempts can reach 3 at most"),
        (
            COUNTED,
            'pass = 9\nstars = [1, 2, 3]\nscore = { fact = "made", how = "streak" }',
            "pass = 9: 3 attempts can reach 3 at most",
        ),
        (
            COUNTED,
            'pass = 2\nstars = [5, 4, 3]\nscore = { fact = "made", how = "fewest" }',
            "pass = 2: 3 attempts can reach 3 at least",
        ),
        (
            COUNTED,
            'pass = -1\nstars = [5, 3, 1]\nscore = { fact = "entry_angle", how = "nearest", target = 45 }',
            "pass = -1 deg: 3 attempts can reach 0 deg at least",
        ),
        (
            'score = "made"',
            'score = { fact = "made", how = "best" }',
            'score.how = "best": must be "sum", "greatest", "nearest", "points", "fewest" or "streak"',
        ),
        ('score = "made"', 'score = { fact = "made", target = 3 }', 'score.how = "sum": has no target'),
        ("attempts = 3", "colour = 1\nattempts = 3", "stars, pass, goes_on"),
        ('"Throw it in"', '"Throw\\nit in"', "must be one line of printable characters"),
        (
            'score = "made"',
            'score = { fact = "made", wanted = { entry_angle = [60, 40] } }',
            "score.wanted.entry_angle = [60, 40]: write the lower end first",
        ),
        ('"one metre"', '"some"', 'shown = "some": must be "all", "first contact", "one metre" or "nothing"'),
        ('"basketball"', '"basketbal"', 'scene = "basketbal": unknown scene basketbal; did you mean basketball?'),
        ("attempts = 3", "atempts = 3", "atempts: unknown key; did you mean attempts?"),
        ('score = "made"', 'score = { fact = "made", how = "points" }', 'score.how = "points": needs rings'),
        (
            'score = "made"',
            'score = "made"\nends = { apexx = 3 }',
            'ends = "apexx": no such result; did you mean apex?',
        ),
        ("[[start]]", "[set]\nhoop.hight = 3\n\n[[start]]", "set hoop.hight: unknown key; did you mean hoop.height?"),
    ],
)
def test_what_is_wrong_with_a_task_is_a_line(call, file: Path, before: str, after: str, said: str):
    change(file, before, after)
    outcome = call("run", file)
    assert_refused(outcome, said)
    assert "mine.toml: " in outcome[2]


def test_other_requests_that_are_refused(call, file: Path):
    assert_refused(call("run", file, "--attempt", 4), "--attempt 4: mine has 3 attempts")
    assert_refused(call("run", "golf", "--attempt", 2), "--attempt: only a task has attempts, and golf is a scene")
    assert_refused(call("run", "nowhere.toml", "--attempt", 2), "nowhere.toml: cannot be read: no such file")
    change(file, '"made"', '"verdict"')
    assert_refused(call("run", file), 'score.fact = "verdict": is "')
    assert_refused(call("aim", file, "--vary", "launch.angle=3:4", "--target", "made=true"), "is a task, not a scene")
    assert_refused(call("validate", "free-throw"), "free-throw: is a task, not a scene")


def test_units_and_defaults_of_a_task_file(file: Path):
    task = load(file)
    assert (task.start[0].low, task.start[0].high, task.controls[0].default, task.name) == (4.0, 5.0, 7.5, "mine")
