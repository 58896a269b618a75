"""Tasks: starts are drawn by seed, controls aimed with noise, attempts scored."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from sandbox.errors import RequestError
from sandbox.tasks import Session, Task, is_task, load, tasks


def test_a_seed_gives_the_same_starts_to_every_player():
    task = load("free-throw")
    drawn = [task.drawn_for(4, attempt)["release.height"] for attempt in range(1, 30)]
    assert drawn == [task.drawn_for(4, attempt)["release.height"] for attempt in range(1, 30)]
    assert len(set(drawn)) == 29
    assert 1.95 <= min(drawn) < 2.05 < 2.2 < max(drawn) <= 2.3
    assert drawn != [task.drawn_for(5, attempt)["release.height"] for attempt in range(1, 30)]


def test_the_aim_is_as_exact_as_the_task_says():
    speed = load("free-throw").controls[0]
    shots = [speed.aimed(7.0, np.random.default_rng(n)) for n in range(2_000)]
    assert np.mean(shots) == pytest.approx(7.0, abs=0.006)
    assert np.std(shots) == pytest.approx(0.07, rel=0.06)
    assert speed.aimed(7.0, None) == 7.0
    assert speed.aimed(99.0, None) == speed.high


def test_players_with_one_seed_differ_in_their_aim_only():
    values = {"launch.speed": 7.4}
    first, second = (Session(load("free-throw"), seed=3, player=player) for player in (0, 1))
    assert first.scene == second.scene
    assert first.aimed(values) == first.aimed(values)
    assert first.aimed(values) != second.aimed(values)


def test_a_session_counts_attempts_streak_and_stars():
    session = Session(load("free-throw"), noise=False)
    made = [session.shoot(_in(session) if right else {}).made for right in (True, False, True, True)]
    assert made == [True, False, True, True]
    assert (session.total, session.left, session.streak, session.stars, session.passed) == (3.0, 1, 2, 0, False)
    assert session.result == "3 of 4 made so far"
    session.shoot({})
    assert session.result == "3 of 5 made: passed"
    assert (session.total, session.left, session.streak, session.stars, session.passed) == (3.0, 0, 0, 1, True)
    with pytest.raises(RequestError, match="all 5 attempts are played"):
        session.shoot({})


def _in(session: Session) -> dict[str, float]:
    """A free throw that goes in from any height of release in the task."""
    height = session.scene.parameters.release.height
    return {"launch.speed": 7.45 - 0.83 * (height - 2.1336), "launch.angle": 52.0}


#: The 1 lies in front of one corner, the 8 in front of the opposite one, and the cue ball between them.
DIAGONAL = """
goal = "Pot the 1, then the 8"
scene = "billiards"
attempts = 2
shots = 3
pass = 2
stars = [2, 3, 4]
score = "potted"
goes_on = { scored = true }
ends = { potted = "8" }

[set]
rack = "none"
balls = [
    { name = "cue", x = 0.7, y = 0.35 },
    { name = "1", x = 1.1, y = 0.55 },
    { name = "8", x = -1.1, y = -0.55 },
]

[[controls]]
key = "cue.angle"
low = -180
high = 180
default = 90

[[controls]]
key = "cue.speed"
low = 1.0
high = "3 m/s"

[[controls]]
key = "cue.follow"
low = -0.5
high = 0.1
"""


@pytest.fixture
def diagonal(tmp_path: Path) -> Task:
    file = tmp_path / "diagonal.toml"
    file.write_text(DIAGONAL)
    return load(file)


def test_an_attempt_of_several_shots_goes_on_where_balls_lie(diagonal: Task):
    session = Session(diagonal)
    assert session.shoot({"cue.angle": _to(session, "1")}).run.result["potted"] == ["1"]
    assert (session.attempt.number, len(session.attempt.shots), session.total) == (1, 1, 0.0)
    assert [ball.name for ball in session.scene.parameters.balls] == ["cue", "8"]
    assert session.shoot({"cue.angle": _to(session, "8"), "cue.speed": 1.2, "cue.follow": -0.1}).run.result[
        "potted"
    ] == ["8"]
    assert (session.attempt.number, session.total) == (2, 2.0)
    session.shoot({})
    assert (session.over, session.total, session.stars, session.streak) == (True, 2.0, 1, 0)


def test_an_attempt_ends_with_the_eight_or_a_miss(diagonal: Task):
    session = Session(diagonal)
    session.shoot({"cue.angle": _to(session, "8"), "cue.speed": 1.2, "cue.follow": -0.1})
    assert (session.attempts[0].worth, session.attempt.number) == (1.0, 2)
    session.shoot({})
    assert (session.attempt.worth, session.over) == (0.0, True)


def _to(session: Session, name: str) -> float:
    """The direction of a ball from the cue ball, in deg."""
    lies = {ball.name: (ball.x, ball.y) for ball in session.scene.parameters.balls}
    return direction(lies["cue"], lies[name])


def direction(start: Sequence[float], end: Sequence[float]) -> float:
    """The direction from one place to another, in deg."""
    return float(np.degrees(np.arctan2(end[1] - start[1], end[0] - start[0])))


def test_names_of_tasks_are_no_names_of_scenes(tmp_path: Path):
    assert not is_task("golf")
    assert not is_task("golf/driver")
    assert is_task("free-throw")
    scene = tmp_path / "shot.toml"
    scene.write_text('scene = "soccer"\n[goal]\ndistance = 20\n')
    assert not is_task(scene)
    assert "free-throw" in tasks()


def test_points_of_a_decathlon_follow_the_stars():
    made, near = load("free-throw"), load("closest-to-the-pin")
    assert made.stars == (3.0, 4.0, 5.0)
    assert [made.points(score) for score in (0.0, 1.5, 3.0, 4.0, 5.0)] == [0, 200, 400, 700, 1000]
    assert near.stars == (5.0, 3.0, 1.5)  # m
    assert [near.points(score) for score in (None, 10.0, 5.0, 4.0, 3.0, 0.0)] == [0, 200, 400, 550, 700, 1000]
