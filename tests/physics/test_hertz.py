"""Hertz's contact: stiffness, its time, and the damping that gives the restitution."""

from __future__ import annotations

import pytest

from sandbox.physics.hertz import PHENOLIC, contact_time, damping


def test_stiffness_of_two_pool_balls():
    """k = 4/3 E* sqrt(R*) of phenolic resin, 5.84 GPa and 0.34, for two balls of 28.575 mm."""
    assert PHENOLIC.between(0.028575, 0.028575) == pytest.approx(5.26e8, rel=1e-3)
    assert PHENOLIC.between(0.028575) == pytest.approx(5.26e8 * 2**0.5, rel=1e-3)


@pytest.mark.parametrize(("speed", "microseconds"), [(1.0, 390.0), (5.0, 283.0), (10.0, 246.0)])
def test_contact_time(speed, microseconds):
    """t ~ v^-0.2, from 390 us at 1 m/s with that material."""
    assert contact_time(0.170097 / 2, 5.262e8, speed) == pytest.approx(microseconds * 1e-6, rel=3e-3)


def test_no_damping_without_loss():
    assert damping(1.0) == 0.0
    assert damping(0.5) > damping(0.9) > 0.0
    assert damping(0.0) == damping(1e-3)
