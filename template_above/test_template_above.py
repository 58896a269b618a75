"""Tests of the scene; its golden run is in shots.toml."""

from __future__ import annotations

from pathlib import Path

import pytest

import sandbox

SCENE = Path(__file__).parent


def test_a_rolling_ball_stops_after_the_time_that_friction_gives() -> None:
    """v / (c g), for the deceleration c g of a rolling ball."""
    rolling = {"launch.roll": 1.0, "launch.angle": 90.0, "launch.speed": 0.7, "lane.felt": 0.07}
    run = sandbox.simulate(sandbox.load(SCENE, rolling))
    assert run.result["time"] == pytest.approx(0.7 / (0.07 * 9.81), rel=1e-9)


def test_both_ways_lead_into_the_cup() -> None:
    presets = (SCENE, SCENE / "one-board")
    results = [sandbox.simulate(sandbox.load(preset)).result for preset in presets]
    assert [(result["holed"], result["bounces"]) for result in results] == [(True, 2), (True, 1)]
