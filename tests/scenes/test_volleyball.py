"""Volleyball: in, long, net and short, and how the ball gets there."""

from __future__ import annotations

import pytest

from tests.scenes.play import results_of

hit = results_of("volleyball")


def test_without_air_it_falls_as_a_stone():
    """h = g t^2 / 2 from a level hit, and x = v t."""
    result = hit(air__density=0.0, launch__angle=0.0, launch__speed=20.0, net__height=1.2)
    fall = (2.0 * (3.1 - 0.105) / 9.81) ** 0.5
    assert result["flight_time"] == pytest.approx(fall, rel=1e-9)
    assert result["landing"] == pytest.approx(20.0 * fall, rel=1e-9)
    assert result["net_clearance"] == pytest.approx(3.1 - 0.5 * 9.81 * (9.0 / 20.0) ** 2 - 0.105 - 1.2, rel=1e-9)


def test_past_the_drag_crisis_a_faster_ball_has_less_drag():
    """Past the drag crisis the force falls though the speed grows."""
    from sandbox.scene import load

    drag = load("volleyball").build().balls[0].forces[1]
    slow, fast = (-drag(0.0, (0.0, 3.0), (speed, 0.0), 0.0)[0] for speed in (13.0, 19.0))
    assert fast < slow
