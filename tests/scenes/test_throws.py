"""Throws: the closed form of the parabola, and the angle that is best for it."""

from __future__ import annotations

from math import pi, sin
from typing import Any

import pytest

import sandbox
from tests.scenes.play import results_of

throw = results_of("throws")


@pytest.mark.parametrize("angle", [20.0, 38.0, 60.0])
def test_without_air_the_distance_is_that_of_the_parabola(angle: float):
    result = throw(air__density=0.0, launch__angle=angle)
    assert result["distance"] == pytest.approx(result["vacuum_distance"], rel=1e-9)


def test_a_throw_from_the_ground_has_the_range_of_the_parabola():
    """R = v^2 sin(2 angle) / g."""
    result = throw(air__density=0.0, release__height=0.0, release__place=0.0, launch__speed=20.0, launch__angle=30.0)
    gravity = sandbox.load("throws").parameters.gravity
    assert result["distance"] == pytest.approx(20.0**2 * sin(pi / 3.0) / gravity, rel=1e-9)
    assert result["best_angle"] == pytest.approx(45.0)


@pytest.mark.parametrize(
    "how",
    [
        {"air__density": 0.0},
        {},
        {"ball__mass": 0.02},
        {"ball__mass": 0.02, "launch__speed": 40.0},  # flat: 26 deg, where the parabola has 45
        {"ball__mass": 0.02, "air__wind": [20.0, 0.0]},  # steep, into the tailwind
        {"launch__speed": 0.5},  # nearly level, from above the ground
    ],
    ids=str,
)
def test_the_best_angle_is_the_best(how: dict[str, Any]):
    best = throw(**how)["best_angle"]
    farthest = throw(**how, launch__angle=best)["distance"]
    assert all(throw(**how, launch__angle=best + off)["distance"] < farthest for off in (-0.5, 0.5))


def test_without_gravity_no_angle_is_best():
    assert throw(gravity=0.0)["best_angle"] is None


def test_air_costs_a_shot_little():
    result = throw()
    assert 0.05 < result["vacuum_distance"] - result["distance"] < 0.3


@pytest.mark.parametrize(
    ("ahead", "said"), [(0.0, "equals the mark"), (-0.004, "equals the mark"), (0.3, ", 0.30 m short of the mark")]
)
def test_headline_card_and_mark_agree_on_the_distance(ahead: float, said: str):
    run = sandbox.simulate(sandbox.load("throws", {"record": throw()["distance"] + ahead}))
    distance = dict(run.scene.rows(run))["distance"]
    assert distance == f"{run.result['distance']:.2f} m"
    assert run.scene.verdict(run) == f"{distance} {said}".replace(" ,", ",")


def test_a_throw_that_equals_the_mark_does_not_beat_it():
    distance = throw()["distance"]
    assert not throw(record=distance)["record_beaten"]
    assert throw(record=distance - 1e-6)["record_beaten"]


@pytest.mark.parametrize("lift", [{"model": "constant", "coefficient": 0.1}, {"model": "spin-ratio"}])
def test_backspin_carries_a_throw_farther_where_lift_is_chosen(lift: dict[str, Any]):
    spins = [throw(ball__lift=lift, launch__spin=spin)["distance"] for spin in (-200.0, 0.0, 200.0)]
    assert spins == sorted(set(spins))
    assert spins[1] == pytest.approx(throw()["distance"])
