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
