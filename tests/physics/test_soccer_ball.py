"""Drag and lift coefficients of a soccer ball."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest

from sandbox.physics.coefficients import (
    SOCCER_DRAG,
    SOCCER_LIFT,
    asai_lift,
    goff_carre_drag,
    mencke_lift,
    pooled_lift,
    power_law_soccer_lift,
    textbook_soccer_drag,
)
from tests.reference.fit_soccer_lift import LAUNCH, SOURCES, aside, fit, law

#: Reynolds number per m/s of the ball and air of Goff and Carre.
PER_SPEED = 1.457e4
#: The textbook's drag, by Reynolds number.
TEXTBOOK = {5e4: 0.47, 1e5: 0.47, 1.175e5: 0.345, 1.35e5: 0.22, 4e5: 0.22}


@pytest.mark.parametrize(
    ("model", "reynolds", "spin_ratio", "published", "off"),
    [
        *(
            (goff_carre_drag, PER_SPEED * v, 0.0, 0.155 + 0.346 / (1.0 + exp((v - 12.19) / 1.309)), 2e-4)
            for v in (5.0, 8.0, 11.0, 12.19, 14.0, 20.0, 35.0)
        ),
        *((goff_carre_drag, PER_SPEED * 25.0, s, 0.4127 * s**0.3056, 2e-4) for s in (0.05, 0.1, 0.2, 0.3)),
        *((textbook_soccer_drag, re, 0.0, drag, 1e-7) for re, drag in TEXTBOOK.items()),
        *((asai_lift, 4e5, s, lift, 0.0031) for s, lift in ((0.18, 0.21), (0.22, 0.24), (0.34, 0.29))),
        *((pooled_lift, 4e5, s, lift, 0.02) for s, lift in ((0.10, 0.185), (0.20, 0.27), (0.24, 0.26), (0.71, 0.31))),
        (mencke_lift, 2.7e5, 0.28, 0.5, 0.01),
        *((power_law_soccer_lift, 4e5, s, 0.385 * min(s, 1.0) ** 0.25, 1e-7) for s in (0.2, 3.0)),
    ],
)
def test_published_values(model, reynolds: float, spin_ratio: float, published: float, off: float):
    assert model(reynolds, spin_ratio) == pytest.approx(published, abs=off)


def test_drag_has_no_jumps():
    """The source jumps at v = 12.19 m/s and at S = 0.05; a jump would defeat the integrator's error control."""
    speeds = np.linspace(1.0, 40.0, 4001)
    spins = np.linspace(0.0, 0.6, 601)
    over_speed = np.array(
        [goff_carre_drag(PER_SPEED * speeds, np.full_like(speeds, s)) for s in (0.0, 0.049, 0.051, 0.3)]
    )
    over_spin = np.array([goff_carre_drag(np.full_like(spins, PER_SPEED * v), spins) for v in (8.0, 12.1, 12.3, 30.0)])
    assert np.abs(np.diff(over_speed, axis=1)).max() < 1e-3
    assert np.abs(np.diff(over_spin, axis=1)).max() < 2e-3


@pytest.mark.parametrize(("law", "most"), [(pooled_lift, 0.301), (mencke_lift, 0.54), (asai_lift, 0.498)])
def test_lift_grows_evenly_from_nothing_and_stays_bounded(law, most: float):
    spins = np.linspace(0.0, 2.0, 201)
    lift = law(np.full_like(spins, 4e5), spins)
    assert lift[0] == 0.0
    assert (np.diff(lift) > 0.0).all()
    assert (np.diff(lift, 2) < 0.0).all()
    assert lift[-1] < most


def test_the_fit_of_lift_gives_the_numbers_of_the_laws():
    greatest, scale = fit()
    assert (greatest, scale) == pytest.approx((0.301, 0.108), abs=6e-4)
    for name in SOURCES:
        assert law(fit(name), 0.2) == pytest.approx(pooled_lift(4e5, 0.2), abs=0.009)
    assert np.abs(aside(LAUNCH, np.array([0.54, 0.108]))).max() < 0.085  # m, from Mencke's track


@pytest.mark.parametrize("name", [*SOCCER_DRAG, *SOCCER_LIFT])
def test_arrays_give_what_floats_give(name: str):
    model = (SOCCER_DRAG | SOCCER_LIFT)[name]
    reynolds = [0.0, 3e4, 1.2e5, 1.8e5, 6e5, 5e7]
    spins = [0.0, 0.02, 0.06, 0.3, 1.0, 1e4]
    one_by_one = [float(model(re, s)) for re, s in zip(reynolds, spins, strict=True)]
    assert model(np.array(reynolds), np.array(spins)) == pytest.approx(one_by_one, rel=1e-14)
    assert all(0.0 <= value < 1.0 for value in one_by_one)
