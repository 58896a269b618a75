"""Throws: the closed form of the parabola, and the angle that is best for it."""

from __future__ import annotations

import pytest

import sandbox
from tests.scenes.play import results_of

throw = results_of("throws")


@pytest.mark.parametrize("angle", [20.0, 38.0, 60.0])
def test_without_air_the_distance_is_that_of_the_parabola(angle: float):
    result = throw(air__density=0.0, launch__angle=angle)
    assert result["distance"] == pytest.approx(result["vacuum_distance"], rel=1e-9)


def test_the_best_angle_is_the_best():
    best = throw(air__density=0.0)["best_angle"]
    farthest = throw(air__density=0.0, launch__angle=best)["distance"]
    assert all(throw(air__density=0.0, launch__angle=best + off)["distance"] < farthest for off in (-0.5, 0.5))


def test_air_costs_a_shot_little():
    result = throw()
    assert 0.05 < result["vacuum_distance"] - result["distance"] < 0.3


@pytest.mark.parametrize(
    ("ahead", "said"), [(0.0, "equals the mark"), (-0.004, "equals the mark"), (0.3, ", 0.30 m short of the mark")]
)
def test_the_headline_says_the_distance_as_the_card_does_and_where_the_mark_is(ahead: float, said: str):
    run = sandbox.simulate(sandbox.load("throws", {"record": throw()["distance"] + ahead}))
    distance = dict(run.scene.rows(run))["distance"]
    assert distance == f"{run.result['distance']:.2f} m"
    assert run.scene.verdict(run) == f"{distance} {said}".replace(" ,", ",")
