"""Friction between two balls, and how they spring back along their contact."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

from sandbox.physics.hertz import PHENOLIC
from sandbox.physics.throw import friction_by_speed, spring_back


def test_friction_is_near_the_older_points():
    """Marlow's 0.11, 0.06 and 0.01 at slips of 0.07, 0.7 and 7 m/s: 0.13, 0.11 and 0.006 here."""
    found = [friction_by_speed(slip) for slip in (0.0707, 0.707, 7.07)]
    assert found == pytest.approx([0.1297, 0.1071, 0.0058], abs=5e-5)


def share_by_springs(slip: float, steps: int = 600, springs: int = 40) -> float:
    """Impulse along the contact of two elastic solid spheres over mu times that across it, by a row of equal springs
    (Maw, Barber & Fawcett 1976); ``slip`` over mu times the approach."""
    depth, approach, along, across = 0.0, 1.0, 0.0, 0.0
    h, deepest = 3.218 / 600.0 * (600.0 / steps), 1.25**0.4  # reduced mass and stiffness are 1
    places = (np.arange(springs) + 0.5) / springs
    stiff, stretch = PHENOLIC.along * 1.5 * sqrt(deepest) / springs, np.zeros(springs)
    while depth >= 0.0:
        share = np.maximum(depth - deepest * places**2, 0.0)
        push = depth**1.5
        most = push * share / max(share.sum(), 1e-30) / stiff
        stretch = np.clip(stretch + h * slip, -most, most)
        pull = stiff * stretch.sum()
        slip, approach = slip - 3.5 * h * pull, approach - h * push
        along, across, depth = along + h * pull, across + h * push, depth + h * approach
    return along / across


@pytest.mark.parametrize("share", [0.05, 0.15, 0.3, 0.45, 0.6, 0.7, 0.8, 0.9, 1.5])
def test_balls_spring_back_as_elastic_spheres_do(share: float):
    assert min(1.0, (1.0 + spring_back(share)) * share) == pytest.approx(share_by_springs(7.0 * share), abs=0.012)


def test_nothing_springs_back_by_more_than_half():
    back = spring_back(np.linspace(0.0, 3.0, 301))
    assert back.min() == 0.0
    assert back.max() == pytest.approx(0.495, abs=2e-3)
