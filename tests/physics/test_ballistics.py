"""The curve through a drag table: through its points, smooth, and never beyond its neighbours."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from sandbox.physics.ballistics import BulletDrag, drag_by_mach, drag_table


@pytest.mark.parametrize("shape", ["G1", "G7", "GS"])
def test_the_curve_stays_between_the_points_of_its_table(shape: str):
    machs, cubics = drag_table(shape)
    points = [drag_by_mach(shape, mach) for mach in machs]
    assert points[:-1] == pytest.approx([cubic[0] for cubic in cubics], abs=1e-15)
    for k in range(len(machs) - 1):
        between = drag_by_mach(shape, np.linspace(machs[k], machs[k + 1], 9))
        low, high = sorted(points[k : k + 2])
        assert between.min() >= low - 1e-12
        assert between.max() <= high + 1e-12
    many = np.linspace(0.0, 6.0, 301)
    assert drag_by_mach(shape, many) == pytest.approx([drag_by_mach(shape, float(mach)) for mach in many], rel=1e-12)


@pytest.mark.parametrize("shape", ["G1", "G7", "GS"])
def test_its_slope_is_the_weighted_harmonic_mean(shape: str):
    """(w1 + w2) / d = w1 / s1 + w2 / s2 with the weights w1 = 2 h2 + h1 and w2 = h2 + 2 h1; no slope at a peak."""
    machs, _ = drag_table(shape)
    points = [drag_by_mach(shape, mach) for mach in machs]
    for k in range(1, len(machs) - 1):
        before, after = machs[k] - machs[k - 1], machs[k + 1] - machs[k]
        rise, fall = (points[k] - points[k - 1]) / before, (points[k + 1] - points[k]) / after
        near, far = 2.0 * after + before, after + 2.0 * before
        mean = (near + far) / (near / rise + far / fall) if rise * fall > 0.0 else 0.0
        for side in (-1e-7, 1e-7):
            slope = (drag_by_mach(shape, machs[k] + side) - points[k]) / side
            assert slope == pytest.approx(mean, abs=1e-4)


def test_a_bullet_in_wind_is_one_that_flies_that_much_slower():
    still = BulletDrag(0.01, "G7", 0.3, 1.2, 340.0)
    blown = BulletDrag(0.01, "G7", 0.3, 1.2, 340.0, lambda t, position: (-5.0, 2.0))
    assert blown(0.0, (0.0, 0.0), (800.0, 3.0), 0.0) == still(0.0, (0.0, 0.0), (805.0, 1.0), 0.0)


@pytest.mark.parametrize("mass", [0.01, 0.045])
def test_the_drag_of_a_bullet_is_that_of_its_coefficient(mass: float):
    """F = m (pi / 8) rho Cd v^2 / BC, with BC in lb/in^2 of 0.45359237 kg over (0.0254 m)^2."""
    speed, sound, density, coefficient = 680.0, 340.0, 1.2, 0.3
    force = BulletDrag(mass, "G7", coefficient, density, sound)(0.0, (0.0, 0.0), (speed, 0.0), 0.0)
    expected = mass * pi / 8.0 * density * drag_by_mach("G7", 2.0) * speed**2 / (coefficient * 0.45359237 / 0.0254**2)
    assert force == (pytest.approx(-expected, rel=1e-6), 0.0)
