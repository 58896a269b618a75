"""Squirt: the published angles, and what always holds."""

from __future__ import annotations

from math import degrees

import pytest

from sandbox.physics.cue import squirt_angle


@pytest.mark.parametrize(("offset", "ratio", "angle"), [(0.51, 20.15, 2.5), (0.51, 29.16, 1.8), (0.30, 12.01, 2.4)])
def test_squirt_is_as_published(offset: float, ratio: float, angle: float):
    """Tip offset in in, the ball's mass over the cue's end mass, and deg (Alciatore, Squirt II)."""
    assert degrees(squirt_angle(offset / 1.125, 0.0, 1.0 / ratio)) == pytest.approx(angle, abs=0.05)


def test_squirt_is_zero_without_english_and_without_an_end_mass():
    assert squirt_angle(0.0, 0.4, 0.05) == 0.0
    assert squirt_angle(0.4, 0.2, 0.0) == 0.0
    assert squirt_angle(-0.4, 0.2, 0.05) == -squirt_angle(0.4, 0.2, 0.05)


def test_a_heavy_end_sends_the_ball_as_its_surface_turns():
    """An end that cannot be pushed aside: tan a = (5/2) x c / (1 + (5/2) c^2), 20.6 deg at the edge of a miscue."""
    assert degrees(squirt_angle(0.5, 0.0, 1e9)) == pytest.approx(20.6, abs=0.1)
