"""How fast courts play: the ITF's pace rating."""

from __future__ import annotations

from math import cos, radians, sin

import pytest

from sandbox.physics.court import court_pace, is_pace_test, pace_category


@pytest.mark.parametrize(("friction", "restitution"), [(0.5, 0.81), (0.7, 0.85), (0.6, 0.75)])
@pytest.mark.parametrize("temperature", [23.0, 33.0])
def test_a_sliding_ball_tells_friction_and_restitution(friction, restitution, temperature):
    """v_x' = v_x - mu (1 + e) v_y and v_y' = e v_y; a ball of 33 C is rated as if it had 0.03 less."""
    vx, vy = 30.0 * cos(radians(16.0)), -30.0 * sin(radians(16.0))
    after = vx + friction * (1.0 + restitution) * vy, -restitution * vy
    corrected = restitution + 0.003 * (23.0 - temperature)
    wanted = 100.0 * (1.0 - friction) + 150.0 * (0.81 - corrected)
    assert court_pace((vx, vy), after, temperature) == pytest.approx(wanted, abs=1e-9)


def test_the_categories_of_the_itf():
    slower = {10: "slow", 29.4: "slow", 30: "medium-slow", 34: "medium-slow"}
    ratings = slower | {35: "medium", 40: "medium-fast", 45: "fast"}
    assert {rating: pace_category(rating) for rating in ratings} == ratings


def test_what_counts_as_the_test():
    assert is_pace_test(28.0, 18.0, -3.0)
    assert not any(is_pace_test(*ball) for ball in ((27.9, 16.0, 0.0), (30.0, 18.1, 0.0), (30.0, 16.0, 3.1)))
