"""Curling: draws, guards, take-outs, who scores, and what is taken off the sheet."""

from __future__ import annotations

from math import hypot
from typing import Any

import pytest

import sandbox
from tests.scenes.play import playing

ALONE: dict[str, Any] = {"stones": []}

throw = playing("curling")


def test_the_stone_curls_to_the_side_of_its_spin():
    left, right, none = (throw(**ALONE, launch__angle=0, launch__spin=spin).result["curl"] for spin in (12, -12, 0))
    assert left == pytest.approx(-right, abs=1e-9)
    assert left > 1.0
    assert none == 0.0


def test_a_guard_in_the_way_stops_what_would_have_been_a_draw():
    assert throw(launch__angle=-2.1).result["to_tee"] > 3.0


def test_sweeping_lengthens_and_straightens():
    swept, unswept = (throw("curling/swept-draw", sweep__end=end) for end in (-1.5, -28.0))
    assert swept.result["distance"] > unswept.result["distance"] + 2.5
    assert swept.result["curl"] < unswept.result["curl"] + 0.1
    assert unswept.result["to_tee"] > 3.0


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"launch.speed": 1.2}, "Stops short of the hog line; nobody lies in the house"),
        ({"launch.speed": 3.0}, "Goes over the back line; nobody lies in the house"),
        ({"launch.angle": 9.0, "launch.speed": 2.4}, "Goes over the side line; nobody lies in the house"),
    ],
)
def test_what_leaves_the_sheet_is_taken_off(changes, said):
    run = throw(**{**ALONE, **changes})
    assert run.scene.verdict(run) == said
    assert run.result["removed"] == ["stone"]
    assert run.result["positions"] == {}
    assert run.result["to_tee"] is None


def test_a_stone_touching_the_house_counts_before_farther_ones():
    """11 cm into the rings from outside, and one that is not."""
    edge = 1.8288 + 0.145
    spots = [("red", 0.0, edge - 0.01), ("yellow", 0.0, -edge - 0.01)]
    stones = [{"team": team, "x": x, "y": y} for team, x, y in spots]
    run = throw(stones=stones, launch__speed=1.0)
    assert (run.result["scores"], run.result["points"]) == ("red", 1)
    four = [{"team": "yellow", "x": 0.1 + 0.4 * i, "y": 0.0} for i in range(3)]
    run = throw(stones=[*four, {"team": "red", "x": 0.0, "y": 0.7}], launch__speed=1.0)
    assert (run.result["scores"], run.result["points"]) == ("yellow", 2)


def test_a_hogged_stone_that_has_met_another_stays():
    guard = [{"team": "yellow", "x": -7.0, "y": 0.3}]
    run = throw(stones=guard, launch__speed=1.86, launch__angle=-2.0)
    assert run.events[0].kind == "impact"
    assert run.state("stone", run.duration)[0] < -6.4
    assert "stone" in run.result["positions"]


def test_the_next_throw_finds_the_stones_where_they_lie():
    scene = sandbox.load("curling/double")
    run = sandbox.simulate(scene)
    following = scene.controls.next_start(run, scene.parameters)
    assert following["team"] == "yellow"
    assert [(stone["team"], hypot(stone["x"], stone["y"]) < 2.0) for stone in following["stones"]] == [
        ("red", True)
    ] * 2
    assert throw(**following).setup.balls[1].position == pytest.approx(run.result["positions"]["stone"])
