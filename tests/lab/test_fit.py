"""Fits: a known truth is found again through bounces, and what is no track."""

from __future__ import annotations

import numpy as np
import pytest

import sandbox
from sandbox.errors import RequestError

TRUE = {"launch.speed": 7.1, "floor.restitution": 0.71}


def test_a_noisy_track_through_bounces_gives_back_the_truth():
    run = sandbox.simulate(sandbox.load("basketball", TRUE))
    t = np.linspace(0.0, run.duration, 40)
    noise = np.random.default_rng(5).normal(0.0, 0.005, (40, 2))
    x, y = (run.states("ball", t)[:, :2] + noise).T
    found = sandbox.fit(
        "basketball", {"t": t, "x": x, "y": y}, {"launch.speed": (6, 9), "floor.restitution": (0.5, 0.9)}
    )
    for key, one in found.values.items():
        half = 0.5 * (one.high - one.low)
        assert 0.0 < half < 0.05
        assert abs(one.value - TRUE[key]) < 1.5 * half
    assert found.residual_sd == pytest.approx({"x": 0.005, "y": 0.005}, rel=0.4)


def test_a_value_without_effect_does_not_end_the_search():
    """Any friction at which the ball grips gives one path, which has no slope to where it slides."""
    true = {
        "launch.speed": 50.0, "launch.angle": -6.0, "launch.spin": -1500.0, "court.restitution": 0.78,
        "court.friction": 0.5,
    }  # fmt: skip
    t = np.linspace(0.0, 1.1, 40)
    places = sandbox.simulate(sandbox.load("tennis", true)).states("ball", t)[:, :2]
    x, y = (places + np.random.default_rng(5).normal(0.0, 0.01, (40, 2))).T
    ranges = {"launch.speed": (30, 70), "launch.angle": (-10, 0), "launch.spin": (-4000, 0)}
    vary = {key: ranges.get(key) for key in true}
    found = sandbox.fit("tennis", {"t": t, "x": x, "y": y}, vary)
    assert found.residual_sd == pytest.approx({"x": 0.01, "y": 0.01}, rel=0.3)
    assert found.values["court.friction"].value == pytest.approx(0.5, abs=0.02)


def test_values_that_change_nothing_are_refused_without_warning():
    """The mark in the sector is only drawn."""
    track = {"t": np.linspace(0.0, 1.0, 9), "x": np.linspace(0.0, 90.0, 9), "y": np.linspace(2.0, 9.0, 9)}
    with pytest.raises(RequestError, match="no run of throws in these ranges comes near this track"):
        sandbox.fit("throws", track, {"record": (20, 25)})


@pytest.mark.parametrize(
    ("vary", "models", "wrong"),
    [
        ({"ball.drag.model": None}, None, "ball.drag.model: only numbers can be fitted; --models compares words"),
        ({"launch.speed": None}, "launch.speed", "launch.speed: is a number, not a choice of models; --vary fits it"),
    ],
)
def test_a_number_is_no_model_and_a_word_no_number(vary, models, wrong):
    with pytest.raises(RequestError, match=wrong):
        sandbox.fit("basketball", {"t": [0, 0.1, 0.2], "x": [0, 0.5, 1], "y": [2, 2.5, 3]}, vary, models=models)


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("t,x\n0,1\n", "column y"),
        ("t,x,y\n0,0,0\n0.2,1,1\n0.1,2,2\n", "row 3, t = 0.1 s is before 0.2 s"),
        ("t,x,y\n0,0,3 ft\n", "is not a number"),
        ("t,x,y\n0,0,0\n", "1 point for 1 parameter"),
        ("t,x,y,ball\n0,0,0,puck\n1,1,1,puck\n", "no ball 'puck'"),
    ],
)
def test_what_is_no_track_is_an_error_of_one_line(tmp_path, text, wrong):
    file = tmp_path / "track.csv"
    file.write_text(text)
    with pytest.raises(RequestError, match=wrong) as error:
        sandbox.fit("basketball", file, {"launch.speed": (6, 9)})
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("wide", [(-180.0, 180.0), None])
def test_a_direction_is_searched_all_round(wide):
    """The scene's own direction is 3.8 deg, a twentieth of its range and less."""
    alone = sandbox.load("billiards/three-rail-carom", {"balls": [{"name": "white", "x": 0.7, "y": 0.0}]})
    run = sandbox.simulate(alone.changed({"cue.speed": 4.3, "cue.angle": 161.0}))
    t = np.linspace(0.0, 1.0, 40)
    places = run.states("white", t)[:, :2] + np.random.default_rng(5).normal(0.0, 0.002, (40, 2))
    found = sandbox.fit(alone, {"t": t, "x": places[:, 0], "y": places[:, 1]}, {"cue.speed": None, "cue.angle": wide})
    assert found.values["cue.angle"].value == pytest.approx(161.0, abs=0.2)
    assert found.values["cue.speed"].value == pytest.approx(4.3, abs=0.02)
