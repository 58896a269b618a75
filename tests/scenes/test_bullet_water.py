"""A bullet in water: the closed form of quadratic drag, and what happens if it does not get there."""

from __future__ import annotations

from math import exp, hypot, log, pi
from pathlib import Path

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


DART, DEPTHS = "bullet-water/underwater-dart", [-2.0, -5.0, -20.0]


def cavitation(speed: float, depth: float) -> float:
    """By hand: the pressure there less that of the vapour, over the dynamic pressure."""
    return (101325.0 - 2339.0 + 998.0 * 9.80665 * depth) / (0.5 * 998.0 * speed**2)


@pytest.mark.parametrize("height", DEPTHS)
def test_in_its_cavity_only_the_nose_slows_a_dart(height: float):
    """At first ``v = v0 exp(-k s)``; with Cd = 0.82 (1 + sigma) the square of the speed falls faster by a constant,
    v^2 = (v0^2 + b) exp(-2 k s) - b, with b = 2 p / rho."""
    run = sandbox.simulate(sandbox.load(DART, {"launch.height": height}))
    k = 998.0 * 0.82 * pi * 0.001**2 / (2.0 * 0.02)
    b = 240.0**2 * cavitation(240.0, -height)
    for t in (0.002, 0.01, 0.02):
        state = run.state("ball", t)
        by_nose = (240.0**2 + b) * exp(-2.0 * k * state.x) - b
        assert hypot(state.vx, state.vy) == pytest.approx(by_nose**0.5, rel=1e-5)
    state = run.state("ball", 0.002)
    assert state.vx == pytest.approx(240.0 * exp(-k * state.x), rel=0.01)  # while sigma << 1
    assert run.result["halving"] == pytest.approx(log(2.0) / k)


@pytest.mark.parametrize("height", DEPTHS)
def test_the_cavity_closes_when_it_is_as_short_as_the_dart(height: float):
    run = sandbox.simulate(sandbox.load(DART, {"launch.height": height}))
    state = run.state("ball", run.result["cavity_time"])
    sigma = cavitation(run.result["cavity_speed"], -state.y)
    drag = 0.82 * (1.0 + sigma)
    assert 0.002 * (drag * log(1.0 / sigma)) ** 0.5 / sigma == pytest.approx(0.12, rel=1e-6)
    assert 0.002 * (drag / sigma) ** 0.5 > 0.00566


def test_the_cavity_of_a_short_bullet_closes_when_it_is_as_thin():
    """Cd / sigma = (calibre / cavitator)^2 at sigma = 0.82 / ((calibre / cavitator)^2 - 0.82)."""
    result = fire(DART, water__drag__length=0.02, gravity=0.0, harmless=5.0, duration=3.0)
    sigma = 0.82 / (2.83**2 - 0.82)
    assert cavitation(result["cavity_speed"], 0.0) == pytest.approx(sigma, rel=1e-6)


def test_after_its_cavity_a_dart_is_wet_all_round():
    result = fire(DART, gravity=0.0)
    k = 998.0 * 1.0 * pi * 0.00283**2 / (2.0 * 0.02)
    wet = log(result["cavity_speed"] / 58.0) / k
    assert result["penetration"] - result["cavity_way"] == pytest.approx(wet, rel=0.2)  # it gets wet by and by
    assert result["penetration"] - result["cavity_way"] > wet


def test_a_bullet_too_slow_for_a_cavity_is_as_wet_as_any():
    slow = {"launch__speed": 90.0, "launch__height": -5.0, "launch__angle": -90.0, "duration": 0.1}
    wetted = fire(**slow)
    nosed = fire(**slow, water__drag={"model": "cavity", "cavitator": 0.001, "length": 0.03})
    assert nosed["cavity_speed"] is None
    assert nosed["penetration"] == pytest.approx(wetted["penetration"], rel=1e-9)


def test_a_shot_from_under_water_begins_there_and_may_leave_it():
    assert fire(DART)["entry_speed"] == 240.0
    up = sandbox.simulate(sandbox.load(DART, {"launch.angle": 80.0, "launch.height": -2.0}))
    assert up.result["penetration"] is None
    assert up.scene.verdict(up) == "Still fast at the end"
    assert up.state("ball", up.duration).y > 5.0


def test_the_page_says_how_far_the_dart_goes():
    page = " ".join((Path(__file__).parents[2] / "docs" / "physics.md").read_text("utf-8").split())
    at_5, at_20 = fire(DART)["penetration"], fire(DART, launch__height=-20.0)["penetration"]
    narrow = fire(DART, water__drag__cavitator=0.0014, duration=0.5)["penetration"]
    assert f"harmless after {at_5:.1f} m at 5 m, {at_20:.1f} m at 20 m," in page
    assert f"in place of 2 mm after {narrow:.1f} m at 5 m" in page
    assert f"The ratio of the two depths, {at_20 / at_5:.2f}," in page
