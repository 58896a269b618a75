"""Scores: what shots are worth, and what they add up to."""

from __future__ import annotations

from typing import Any

import pytest

from sandbox.tasks import Score, load
from sandbox.tasks.scoring import Wanted

RINGS = ((0.1, 10.0), (0.5, 5.0))


@pytest.mark.parametrize(
    ("score", "fact", "worth", "reward"),
    [
        (Score("made", ""), True, 1.0, 1.0),
        (Score("made", ""), None, 0.0, 0.0),
        (Score("potted", ""), ["1", "2"], 2.0, 2.0),
        (Score("pins", ""), 7, 7.0, 7.0),
        (Score("distance", "m", "greatest"), 21.5, 21.5, 21.5),
        (Score("distance", "m", "greatest"), None, None, 0.0),
        (Score("distance", "m", "nearest", 20.0, farthest=5.0), 18.5, 1.5, -1.5),
        (Score("distance", "m", "nearest", 20.0, farthest=5.0), 90.0, 70.0, -5.0),
        (Score("distance", "m", "nearest", 20.0, farthest=5.0), None, None, -5.0),
        (Score("height", "m", "points", 1.0, RINGS), 1.1 - 1e-9, 10.0, 10.0),
        (Score("height", "m", "points", 1.0, RINGS), 0.6, 5.0, 5.0),
        (Score("height", "m", "points", 1.0, RINGS), 1.6, 0.0, 0.0),
        (Score("holed", "", "fewest"), True, 1.0, -1.0),
        (Score("holed", "", "fewest"), False, 0.0, -1.0),
    ],
)
def test_what_a_shot_is_worth(score: Score, fact: Any, worth: float | None, reward: float):
    assert score.of_shot({score.fact: fact}) == worth
    assert score.reward(worth) == reward


@pytest.mark.parametrize(
    ("how", "worths", "attempt"),
    [
        ("sum", [1.0, 0.0, 2.0], 3.0),
        ("greatest", [None, 3.0, 5.0], 5.0),
        ("nearest", [None, 3.0, 5.0], 3.0),
        ("nearest", [None], None),
        ("fewest", [0.0, 0.0, 1.0], 3.0),
        ("fewest", [0.0, 0.0, 0.0], 4.0),
    ],
)
def test_what_an_attempt_of_three_shots_is_worth(how: str, worths: list[float | None], attempt: float | None):
    assert Score("fact", "m", how).of_attempt(worths, 3) == attempt


def test_a_smaller_score_is_better_of_nearest_and_fewest():
    for how, better, worse in (("sum", 3.0, 2.0), ("greatest", 3.0, 2.0), ("nearest", 2.0, 3.0), ("fewest", 2.0, 3.0)):
        score = Score("fact", "m", how)
        assert score.reaches(better, better)
        assert score.reaches(better, worse)
        assert not score.reaches(worse, better)
        assert not score.reaches(None, worse)


def test_a_shot_counts_only_with_the_facts_that_are_wanted():
    wanted = Wanted("verdict", "bank"), Wanted("angle", within=(40.0, 60.0)), Wanted("potted", "8")
    score = Score("made", "", wanted=wanted)
    good = {"made": True, "verdict": "bank", "angle": 40.0, "potted": ["1", "8"]}
    assert score.of_shot(good) == 1.0
    for fact, value in (("verdict", "rim"), ("angle", 39.9), ("angle", None), ("potted", ["1"])):
        assert score.of_shot({**good, fact: value}) == 0.0


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
