"""Turf: Penner's bounce, and the stimpmeter."""

from __future__ import annotations

from math import atan2, cos, degrees, radians, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.physics.turf import penner_bounce, penner_restitution, penner_tilt, stimp_resistance

SPEEDS = st.floats(0.0, 120.0)


@pytest.mark.parametrize(
    ("speed", "restitution"),
    [(0.0, 0.510), (10.0, 0.510 - 0.375 + 0.0903), (20.0, 0.1212), (20.1, 0.120), (60.0, 0.120)],
)
def test_restitution(speed: float, restitution: float):
    assert penner_restitution(speed) == pytest.approx(restitution)


def test_tilt_at_the_measurement_that_it_is_drawn_through():
    """Haake: 18.6 m/s at 44.4 deg from the vertical gives 15.4 deg."""
    angle = radians(44.4)
    assert degrees(penner_tilt(18.6 * cos(angle), 18.6 * sin(angle))) == pytest.approx(15.4)


def test_a_vertical_drop_and_firm_turf_do_not_tilt():
    assert penner_tilt(15.0, 0.0) == 0.0
    assert penner_bounce(15.0, 0.0) == (penner_restitution(15.0), 0.0)
    assert penner_bounce(12.0, 20.0, give=0.0) == (penner_restitution(12.0), 0.0)
    assert penner_bounce(12.0, 9.0) == penner_bounce(12.0, 9.0, give=1.0) != penner_bounce(12.0, 9.0, give=2.0)


@given(normal=SPEEDS, along=SPEEDS, give=st.floats(0.0, 2.0))
def test_turf_hardly_tilts_under_a_ball_that_skims_it(normal: float, along: float, give: float):
    tilt, descent = degrees(penner_tilt(normal, along, give)), 90.0 - degrees(atan2(along, normal))
    assert 0.0 <= tilt <= 45.0
    assert tilt <= descent / 1.5 + 1e-9


def test_soft_turf_tilts_by_no_more_than_45_deg():
    """At 60 m/s, 20 deg from the vertical, the line would give 67 deg; two thirds of the descent are 46.7 deg."""
    angle = radians(20.0)
    assert degrees(penner_tilt(60.0 * cos(angle), 60.0 * sin(angle), give=3.0)) == pytest.approx(45.0)


@given(normal=st.floats(0.1, 60.0), along=st.floats(0.0, 60.0))
def test_restitution_depends_on_speed_normal_to_the_tilted_turf(normal: float, along: float):
    restitution, tilt = penner_bounce(normal, along)
    assert restitution == penner_restitution(normal * cos(tilt) + along * sin(tilt))


@pytest.mark.parametrize("feet", [7.0, 10.0, 13.0])
def test_stimpmeter(feet: float):
    """0.56 over the reading in feet; a ball let go at 1.83 m/s stops after v^2 / (2 c g), which is the reading."""
    resistance = stimp_resistance(0.3048 * feet)
    assert resistance == pytest.approx(0.56 / feet, rel=1e-3)
    assert 1.83**2 / (2.0 * resistance * 9.81) == pytest.approx(0.3048 * feet)
