"""Scores: what shots are worth, and what they add up to."""

from __future__ import annotations

from math import inf
from pathlib import Path
from typing import Any

import pytest

from sandbox.tasks import Score, load
from sandbox.tasks.scoring import KINDS, Condition, Fewest, Greatest, Nearest, Points, Streak, Sum

RINGS = ((0.1, 10.0), (0.5, 5.0))


@pytest.mark.parametrize(
    ("score", "fact", "worth", "reward"),
    [
        (Sum("made"), True, 1.0, 1.0),
        (Sum("made"), None, 0.0, 0.0),
        (Sum("potted"), ["1", "2"], 2.0, 2.0),
        (Sum("pins"), 7, 7.0, 7.0),
        (Greatest("distance", "m"), 21.5, 21.5, 21.5),
        (Greatest("distance", "m"), None, None, 0.0),
        (Nearest("distance", "m", target=20.0), 18.5, 1.5, -1.5),
        (Nearest("distance", "m", target=20.0), 90.0, 70.0, -5.0),
        (Nearest("distance", "m", target=20.0), None, None, -5.0),
        (Points("height", "m", target=1.0, rings=RINGS), 1.1 - 1e-9, 10.0, 10.0),
        (Points("height", "m", target=1.0, rings=RINGS), 0.6, 5.0, 5.0),
        (Points("height", "m", target=1.0, rings=RINGS), 1.6, 0.0, 0.0),
        (Points("height", "m", rings=RINGS), 0.05, 10.0, 10.0),
        (Fewest("holed"), True, 1.0, -1.0),
        (Fewest("holed"), False, 0.0, -1.0),
        (Streak("made"), True, 1.0, 1.0),
        (Streak("potted"), ["1", "2"], 1.0, 1.0),
        (Streak("potted"), [], 0.0, 0.0),
    ],
)
def test_what_a_shot_is_worth(score: Score, fact: Any, worth: float | None, reward: float):
    assert score.of_shot({score.fact: fact}) == worth
    assert score.reward(worth, passing=0.5) == reward
    assert score.reward(worth, passing=0.5, missed=True) == reward - (score.how == "fewest")


@pytest.mark.parametrize(
    ("how", "worths", "attempt"),
    [
        ("sum", [1.0, 0.0, 2.0], 3.0),
        ("greatest", [None, 3.0, 5.0], 5.0),
        ("nearest", [None, 3.0, 5.0], 3.0),
        ("nearest", [None], None),
        ("fewest", [0.0, 0.0, 1.0], 3.0),
        ("fewest", [0.0, 0.0, 0.0], 4.0),
        ("streak", [0.0, 1.0, 1.0], 1.0),
        ("streak", [0.0], 0.0),
    ],
)
def test_what_an_attempt_of_three_shots_is_worth(how: str, worths: list[float | None], attempt: float | None):
    assert KINDS[how]("fact", "m").of_attempt(worths, 3) == attempt


def test_a_streak_is_the_longest_of_a_session():
    worths = [1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0]
    assert [Streak("made").total(worths[:played]) for played in range(8)] == [0.0, 1.0, 2.0, 2.0, 2.0, 2.0, 3.0, 3.0]
    assert Streak("made").text(3.0) == "3 in a row"


@pytest.mark.parametrize(("how", "best"), [("sum", [3, 1]), ("greatest", [3, 1, 4, 0]), ("nearest", [0, 4, 1, 3])])
def test_best_shots_come_first(how: str, best: list[int]):
    assert KINDS[how]("fact", "m").best_shots([0.0, 2.0, None, 3.0, 0.5 * (how != "sum")]) == best


def test_a_smaller_score_is_better_of_nearest_and_fewest():
    for how, better, worse in (("sum", 3.0, 2.0), ("greatest", 3.0, 2.0), ("nearest", 2.0, 3.0), ("fewest", 2.0, 3.0)):
        score = KINDS[how]("fact", "m")
        assert score.reaches(better, better)
        assert score.reaches(better, worse)
        assert not score.reaches(worse, better)
        assert not score.reaches(None, worse)


def test_a_shot_counts_only_with_the_facts_that_are_wanted():
    wanted = Condition("verdict", "bank"), Condition("angle", within=(40.0, 60.0)), Condition("potted", "8")
    score = Sum("made", wanted=wanted)
    good = {"made": True, "verdict": "bank", "angle": 40.0, "potted": ["1", "8"]}
    assert score.of_shot(good) == 1.0
    for fact, value in (("verdict", "rim"), ("angle", 39.9), ("angle", None), ("potted", ["1"])):
        assert score.of_shot({**good, fact: value}) == 0.0


@pytest.mark.parametrize(
    ("score", "best"),
    [
        (Sum("made", most=1.0), 15.0),
        (Sum("pins", most=10.0), 150.0),
        (Sum("carry", "m"), inf),
        (Greatest("carry", "m"), inf),
        (Greatest("pins", most=10.0), 10.0),
        (Nearest("carry", "m", target=20.0), 0.0),
        (Points("height", "m", rings=RINGS), 150.0),
        (Points("height", "m", rings=((0.1, -3.0),)), 0.0),
        (Fewest("holed"), 5.0),
        (Streak("made"), 5.0),
    ],
)
def test_the_best_score_of_five_attempts_of_three_shots(score: Score, best: float):
    assert score.best_total(attempts=5, shots=3) == best


def test_each_kind_has_its_row_in_the_docs():
    page = (Path(__file__).parents[2] / "docs" / "tasks.md").read_text("utf-8")
    assert [how for how in KINDS if f'| `"{how}"`' not in page] == []


@pytest.mark.parametrize(
    ("name", "score", "text"),
    [
        ("free-throw", 4.0, "4 made"),
        ("eight-ball", 3.0, "3 made"),
        ("strikes", 26.0, "26 pins"),
        ("strikes", 1.0, "1 pin"),
        ("hold-over", 20.0, "20 points"),
        ("par-two", 7.0, "7 shots"),
        ("draw-to-the-button", 0.8, "0.80 m"),
        ("draw-to-the-button", None, "no score"),
    ],
)
def test_a_score_in_words(name: str, score: float | None, text: str):
    assert load(name).score.text(score) == text
