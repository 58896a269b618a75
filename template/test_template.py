"""Tests of the scene; its golden run is in shots.toml."""

from __future__ import annotations

from math import radians, sin
from pathlib import Path

import pytest

import sandbox

SCENE = Path(__file__).parent


def test_apex_without_air_and_fan() -> None:
    """v^2 sin^2(angle) / 2 g above the hand."""
    launch = {"launch.speed": 8.0, "launch.angle": 60.0, "launch.height": 1.5}
    run = sandbox.simulate(sandbox.load(SCENE, {"air.density": 0.0, "fan.push": 0.0, "gravity": 9.81, **launch}))
    assert run.result["apex"] == pytest.approx(1.5 + (8.0 * sin(radians(60.0))) ** 2 / (2 * 9.81), rel=1e-9)


def test_the_fan_carries_the_ball_farther() -> None:
    with_fan, without = (sandbox.simulate(sandbox.load(SCENE, {"fan.push": push})).result for push in (4.0, 0.0))
    assert with_fan["distance"] > without["distance"] + 0.5
