"""Pitches: strike or ball, and what spin makes of them."""

from __future__ import annotations

from typing import Any

import pytest

import sandbox


def pitch(preset: str = "baseball-pitch", **changes: Any) -> dict[str, Any]:
    scene = sandbox.load(preset, {key.replace("__", "."): value for key, value in changes.items()})
    return sandbox.simulate(scene).result


@pytest.mark.parametrize(
    ("angle", "strike", "words"),
    [(-2.0, True, "Strike"), (1.0, False, "too high"), (-4.5, False, "too low"), (-30.0, False, "in the dirt")],
)
def test_a_strike_passes_through_the_zone(angle: float, strike: bool, words: str):
    run = sandbox.simulate(sandbox.load("baseball-pitch", {"launch.angle": angle}))
    assert run.result["strike"] is strike
    assert words in run.scene.verdict(run)


def test_backspin_rises_and_topspin_falls():
    assert pitch()["break"] > 0.3
    assert pitch("baseball-pitch/curve")["break"] < -0.3
    assert pitch(launch__spin=0.0)["break"] == pytest.approx(0.0, abs=0.05)


def test_a_ball_that_clips_the_zone_is_a_strike():
    height = pitch()["plate_height"]
    assert pitch(plate__top=height - 0.03)["strike"]
    assert not pitch(plate__top=height - 0.04)["strike"]


@pytest.mark.parametrize("preset", ["curve", "changeup"])
def test_presets_are_strikes(preset: str):
    assert pitch(f"baseball-pitch/{preset}")["strike"]
