"""Tests of the scene; ``pytest --golden-update`` makes the golden files, or makes them anew."""

from __future__ import annotations

from math import radians, sin
from pathlib import Path

import pytest

import sandbox

SCENE = Path(__file__).parent


def test_toss(golden):
    golden.check("template", sandbox.simulate(sandbox.load(SCENE)))


def test_apex_without_air_and_fan():
    """v^2 sin^2(angle) / 2 g above the hand."""
    scene = sandbox.load(SCENE, {"air.density": 0.0, "fan.push": 0.0})
    launch = scene.parameters.launch
    rise = (launch.speed * sin(radians(launch.angle))) ** 2 / (2 * scene.parameters.gravity)
    assert sandbox.simulate(scene).result["apex"] == pytest.approx(launch.height + rise, rel=1e-9)


def test_the_fan_carries_the_ball_farther():
    with_fan, without = (sandbox.simulate(sandbox.load(SCENE, {"fan.push": push})).result for push in (4.0, 0.0))
    assert with_fan["distance"] > without["distance"] + 0.5
