"""A bullet in water: the closed form of quadratic drag, and what happens if it does not get there."""

from __future__ import annotations

from math import log

import pytest

import sandbox
from tests.scenes.play import results_of

fire = results_of("bullet-water")


@pytest.mark.parametrize("preset", ["bullet-water", "bullet-water/pistol"])
def test_it_goes_as_far_as_its_speed_halves(preset: str):
    """s = ln(v0 / v) / k, with k = ln 2 / halving."""
    result = fire(preset, gravity=0.0)
    halvings = log(result["entry_speed"] / 58.0) / log(2.0)
    assert result["penetration"] == pytest.approx(halvings * result["halving"], rel=0.01)  # it enters by and by


def test_twice_the_speed_is_one_halving_deeper():
    slow, fast = (
        fire(launch__speed=400.0, duration=0.1, gravity=0.0),
        fire(launch__speed=800.0, duration=0.1, gravity=0.0),
    )
    assert fast["penetration"] - slow["penetration"] == pytest.approx(slow["halving"], rel=0.01)


def test_a_slow_bullet_is_harmless_and_a_weightless_one_may_stop():
    assert fire(launch__speed=5.0, duration=1.0)["penetration"] == 0.0
    stuck = {"launch.speed": 1.0, "launch.angle": -1.0, "launch.height": 10.0, "gravity": 0.0, "air.density": 1000.0}
    run = sandbox.simulate(sandbox.load("bullet-water", stuck))
    assert run.result["penetration"] is None
    assert run.scene.verdict(run) == "Does not get into the water"
