"""Pitches: strike or ball, and what spin makes of them."""

from __future__ import annotations

import pytest

from tests.scenes.play import results_of

pitch = results_of("baseball-pitch")


def test_backspin_rises_and_topspin_falls():
    assert pitch()["break"] > 0.3
    assert pitch("baseball-pitch/curve")["break"] < -0.2
    assert pitch(launch__spin=0.0)["break"] == pytest.approx(0.0, abs=0.05)


def test_only_active_spin_about_a_level_axis_lifts():
    """Half of it active is half the spin; a bullet's spin, or one about the upright, leaves the ball to gravity."""
    half = pitch(launch__active=0.5, launch__tilt=0.0, launch__spin=2000.0)
    assert half["plate_height"] == pitch(launch__active=1.0, launch__tilt=0.0, launch__spin=1000.0)["plate_height"]
    assert half["launch_spin"] == 2000.0
    unspun = pitch(launch__spin=0.0)
    assert pitch(launch__active=0.0)["plate_height"] == pytest.approx(unspun["plate_height"], abs=1e-9)
    aside = pitch(launch__active=1.0, launch__tilt=90.0)
    assert aside["plate_height"] == pytest.approx(unspun["plate_height"], abs=0.02)  # its drag is larger
    assert aside["plate_speed"] < unspun["plate_speed"] - 0.3
    full, tilted = (pitch(launch__tilt=tilt)["break"] - unspun["break"] for tilt in (0.0, 60.0))
    assert tilted == pytest.approx(0.5 * full, rel=0.02)


def test_a_ball_that_clips_the_zone_is_a_strike():
    height = pitch()["plate_height"]
    assert pitch(plate__top=height - 0.03)["strike"]
    assert not pitch(plate__top=height - 0.04)["strike"]


def test_a_ball_that_clips_the_lower_edge_is_a_strike_too():
    """Its radius is 3.7 cm."""
    height = pitch("baseball-pitch/curve")["plate_height"]
    assert pitch("baseball-pitch/curve", plate__bottom=height + 0.03)["strike"]
    assert not pitch("baseball-pitch/curve", plate__bottom=height + 0.04)["strike"]
