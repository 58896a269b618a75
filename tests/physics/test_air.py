"""Air: viscosity and wind."""

from __future__ import annotations

from math import atan, log, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.physics.air import VISCOSITY, Gusts, LogWind, UniformWind, density_share, moist_density, viscosity


@pytest.mark.parametrize(
    ("temperature", "published"),
    [(216.65, 1.4216e-5), (288.15, 1.7894e-5)],  # U.S. Standard Atmosphere 1976, at 11 km and at sea level
)
def test_viscosity_of_the_standard_atmosphere(temperature: float, published: float):
    assert viscosity(temperature) == pytest.approx(published, rel=1e-4)


def test_viscosity_without_a_word_is_that_of_15_degrees():
    assert viscosity(288.15) == VISCOSITY


@pytest.mark.parametrize(("height", "share"), [(0.0, 1.0), (5_000.0, 0.60091), (11_000.0, 0.29707)])
def test_density_of_the_standard_atmosphere(height: float, share: float):
    assert density_share(height) == pytest.approx(share, rel=1e-4)


def test_uniform_wind_is_the_same_everywhere():
    assert UniformWind(-3.0, 1.0)(7.0, (100.0, 30.0)) == (-3.0, 1.0)


def test_log_wind_has_the_wind_given_at_its_height():
    assert LogWind((-8.0, 0.5), 10.0, 0.03)(0.0, (0.0, 10.0)) == pytest.approx((-8.0, 0.5))


def test_log_wind_by_its_formula():
    """w(y) = w_ref ln(1 + y / y0) / ln(1 + y_ref / y0)."""
    wind = LogWind((6.0, 0.0), 10.0, 0.03)
    assert wind(0.0, (0.0, 2.0))[0] == pytest.approx(6.0 * log(1.0 + 2.0 / 0.03) / log(1.0 + 10.0 / 0.03))


@given(low=st.floats(-10.0, 300.0), more=st.floats(0.0, 300.0))
def test_log_wind_never_falls_with_height(low: float, more: float):
    wind = LogWind((5.0, 0.0), 10.0, 0.03)
    assert wind(0.0, (0.0, low + more))[0] >= wind(0.0, (0.0, low))[0] >= 0.0


def test_log_wind_is_0_at_the_ground_and_even_above_its_ceiling():
    wind = LogWind((5.0, 0.0), 10.0, 0.03)
    assert wind(0.0, (0.0, 0.0)) == wind(0.0, (0.0, -3.0)) == (0.0, 0.0)
    assert wind(0.0, (0.0, 100.0)) == wind(0.0, (0.0, 5000.0))


def test_log_wind_takes_arrays():
    wind = LogWind((5.0, -1.0), 10.0, 0.03)
    heights = np.array([-1.0, 0.0, 3.0, 250.0])
    x, y = wind(0.0, (np.zeros(4), heights))
    one_by_one = [wind(0.0, (0.0, float(h))) for h in heights]
    for number, expected in enumerate(one_by_one):
        assert (x[number], y[number]) == pytest.approx(expected, rel=1e-15)


GUSTS = Gusts(UniformWind(-8.0, 0.0), sd=1.5, height=10.0, seed=3)


def test_gusts_have_the_variance_of_drydens_spectra():
    """Over a band, along: ``2 sd^2 / pi atan(L k)``; upwards: ``sd_w^2 / pi (2 atan(h k) - h k / (1 + (h k)^2))``."""
    c = 0.177 + 0.000823 * 10.0 / 0.3048
    ends = [10.0 / (10.0 / c**1.2) * end for end in (0.1, 30.0)]  # h k
    along = 1.5**2 * 2.0 / pi * (atan(30.0) - atan(0.1))
    low, high = (2.0 * atan(x) - x / (1.0 + x * x) for x in ends)
    x = np.linspace(0.0, 40_000.0, 20_001)
    u, w = GUSTS(0.0, (x, np.full_like(x, 50.0)))
    assert np.var(u) == pytest.approx(along, rel=0.03)
    assert np.var(w) == pytest.approx((1.5 * c**0.4) ** 2 / pi * (high - low), rel=0.03)
    assert np.mean(u) == pytest.approx(-8.0, abs=0.05)


def test_gusts_are_carried_along_by_the_wind():
    assert GUSTS(2.0, (30.0, 40.0)) == pytest.approx(GUSTS(0.0, (30.0 + 16.0, 40.0)), rel=1e-12)


def test_gusts_are_the_same_for_a_seed_and_none_at_the_ground():
    assert Gusts(UniformWind(-8.0, 0.0), 1.5, 10.0, 3)(1.0, (9.0, 5.0)) == GUSTS(1.0, (9.0, 5.0))
    assert Gusts(UniformWind(-8.0, 0.0), 1.5, 10.0, 4)(1.0, (9.0, 5.0)) != GUSTS(1.0, (9.0, 5.0))
    assert GUSTS(1.0, (9.0, 0.1)) == (-8.0, 0.0)


def test_moist_air_by_the_gas_law():
    """rho = (p - p_v) / (R_d T) + p_v / (R_v T); the saturated vapour of water is 3,169 Pa at 25 C (CRC Handbook)."""
    for celsius, vapour in ((25.0, 3169.0), (0.0, 611.2)):
        t = celsius + 273.15
        for humidity in (0.0, 0.5, 1.0):
            wet = humidity * vapour
            exact = (101325.0 - wet) / (287.05 * t) + wet / (461.5 * t)
            assert moist_density(t, 101325.0, humidity, 0.0) == pytest.approx(exact, rel=1e-3)
