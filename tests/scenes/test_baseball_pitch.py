"""Pitches: strike or ball, and what spin makes of them."""

from __future__ import annotations

import pytest

from tests.scenes.play import results_of

pitch = results_of("baseball-pitch")


def test_backspin_rises_and_topspin_falls():
    assert pitch()["break"] > 0.3
    assert pitch("baseball-pitch/curve")["break"] < -0.3
    assert pitch(launch__spin=0.0)["break"] == pytest.approx(0.0, abs=0.05)


def test_a_ball_that_clips_the_zone_is_a_strike():
    height = pitch()["plate_height"]
    assert pitch(plate__top=height - 0.03)["strike"]
    assert not pitch(plate__top=height - 0.04)["strike"]


def test_a_ball_that_clips_the_lower_edge_is_a_strike_too():
    """Its radius is 3.7 cm."""
    height = pitch("baseball-pitch/curve")["plate_height"]
    assert pitch("baseball-pitch/curve", plate__bottom=height + 0.03)["strike"]
    assert not pitch("baseball-pitch/curve", plate__bottom=height + 0.04)["strike"]
