"""Drag and lift coefficients: those of every ball, those of a golf ball, and the simple ones."""

from __future__ import annotations

from math import exp, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.physics import coefficients as law
from sandbox.physics.coefficients import GOLF_DRAG, GOLF_LIFT, Constant, Laws

#: From a ball at rest to ten times the speed of sound in water; from no spin to a ball that spins on the spot.
REYNOLDS = st.floats(0.0, 1e10)
SPIN_RATIOS = st.floats(0.0, 1e33)

#: Every coefficient that is registered.
REGISTERED = [
    pytest.param(laws, name, id=f"{laws.ball} {laws.kind} {name}")
    for laws in vars(law).values()
    if isinstance(laws, Laws)
    for name in laws
]

# Any model, anywhere --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("laws", "name"), REGISTERED)
def test_a_coefficient_goes_through_its_points(laws: Laws, name: str):
    origin = laws.origins[name]
    for (reynolds, spin_ratio), value in origin.points.items():
        assert laws[name](reynolds, spin_ratio) == pytest.approx(value, abs=origin.within)


@pytest.mark.parametrize(("laws", "name"), REGISTERED)
def test_floats_and_arrays_agree(laws: Laws, name: str):
    reynolds, spin_ratio = (grid.ravel() for grid in np.meshgrid(np.linspace(0.0, 4e5, 41), np.linspace(0.0, 2.0, 41)))
    together = np.broadcast_to(laws[name](reynolds, spin_ratio), reynolds.shape)
    one_by_one = [laws[name](float(re), float(s)) for re, s in zip(reynolds, spin_ratio, strict=True)]
    assert together == pytest.approx(one_by_one, rel=1e-14, abs=1e-16)


@pytest.mark.parametrize(("laws", "name"), REGISTERED)
def test_coefficients_have_no_jumps(laws: Laws, name: str):
    """A jump would defeat the integrator's error control."""
    spins, speeds = np.linspace(0.0, 1.2, 4801), np.linspace(0.0, 4e5, 4001)
    for reynolds in (2e4, 6.8e4, 1.5e5):
        values = np.broadcast_to(laws[name](np.full_like(spins, reynolds), spins), spins.shape)
        assert np.abs(np.diff(values))[spins[1:] > 0.02].max() < 1.2e-3
    values = np.broadcast_to(laws[name](speeds, np.full_like(speeds, 0.1)), speeds.shape)
    assert np.abs(np.diff(values)).max() < 2e-3


def test_a_coefficient_is_registered_once_with_source_and_points():
    mine = Laws("a feather", "drag")
    assert mine.law("mine", "me", {(1e5, 0.0): 0.3, (2e5, 0.0): 0.3})(Constant(0.3)) == Constant(0.3) == mine["mine"]
    for name, source, points in (("mine", "me", 2), ("other", "", 2), ("other", "me", 1)):
        with pytest.raises(ValueError, match="of a feather: needs a new name, a source, and two points or more"):
            mine.law(name, source, dict.fromkeys(((float(re), 0.0) for re in range(points)), 0.3))


@pytest.mark.parametrize("name", GOLF_DRAG)
@given(reynolds=REYNOLDS, spin_ratio=SPIN_RATIOS)
def test_drag_is_positive_and_no_more_than_a_rough_sphere_has(name: str, reynolds: float, spin_ratio: float):
    assert 0.05 < GOLF_DRAG[name](reynolds, spin_ratio) < 0.7


@pytest.mark.parametrize("name", GOLF_LIFT)
@given(reynolds=REYNOLDS, spin_ratio=SPIN_RATIOS)
def test_lift_is_bounded_and_lifts_by_spin_alone(name: str, reynolds: float, spin_ratio: float):
    assert 0.0 <= GOLF_LIFT[name](reynolds, spin_ratio) < 0.6
    assert GOLF_LIFT[name](reynolds, 0.0) == 0.0


@pytest.mark.parametrize(("model", "edge"), [(law.quadratic_lift, 0.06628), (law.usga_lift, 0.0860 - 0.0122)])
def test_lift_rises_from_0_over_the_first_spin(model, edge: float):
    """Both formulas have lift without spin; it is spread evenly over S = 0 to 0.02."""
    for s in (0.004, 0.01, 0.016):
        assert model(1e5, s) == pytest.approx(50.0 * s * edge, rel=0.5)
    assert model(1e5, 0.02) == pytest.approx(edge, rel=0.5)


@pytest.mark.parametrize(
    ("model", "values"),
    [
        (law.stepanek_drag, {0.0: 0.508, 0.3: 0.6621, 1e6: 0.7981}),
        (law.stepanek_lift, {0.0: 0.0, 0.3: 0.1890, 1e6: 0.4946}),
        (law.nathan_lift, {0.0: 0.0, 0.3: 0.2619, 1e6: 0.4801}),
        (law.pitch_fit_drag, {0.0: 0.299, 0.2: 0.3336}),
        (law.sawicki_lift, {0.05: 0.075, 0.3: 0.27, 2.0: 0.69}),
    ],
)
def test_what_depends_on_the_spin_alone_has_its_values(model, values: dict[float, float]):
    for spin_ratio, value in values.items():
        assert model(1e5, spin_ratio) == pytest.approx(value, abs=1e-4)


def test_a_table_tennis_ball_loses_its_lift_at_one_spin():
    """Miyazaki 2017: almost none at Re = 9e4 and S = 0.48 to 0.50; the valley is shallower for slow balls."""
    assert max(law.lift_crisis(9e4, s) for s in (0.48, 0.49, 0.50)) < 0.01
    assert law.lift_crisis(9e4, 0.5) < law.lift_crisis(6e4, 0.5) < law.lift_crisis(3e4, 0.5)
    assert min(law.lift_crisis(9e4, s) for s in (0.2, 1.0)) > 0.13


def test_simple_models():
    assert Constant(0.25)(1e5, 0.3) == 0.25
    assert law.spin_ratio_lift(1e5, 0.3) == 0.3


# The fit to tour averages ---------------------------------------------------------------------------------------------


@given(spin_ratio=st.floats(0.0, 3.0), more=st.floats(0.0, 3.0), reynolds=st.floats(0.0, 5e5))
def test_tour_fit_more_spin_means_more_lift_and_more_drag(spin_ratio: float, more: float, reynolds: float):
    assert law.tour_fit_lift(reynolds, spin_ratio + more) >= law.tour_fit_lift(reynolds, spin_ratio)
    assert law.tour_fit_drag(reynolds, spin_ratio + more) >= law.tour_fit_drag(reynolds, spin_ratio)


@given(reynolds=st.floats(0.0, 5e5), more=st.floats(0.0, 5e5), spin_ratio=st.floats(0.0, 3.0))
def test_tour_fit_drag_falls_through_the_crisis_and_stays_there(reynolds: float, more: float, spin_ratio: float):
    assert law.tour_fit_drag(reynolds + more, spin_ratio) <= law.tour_fit_drag(reynolds, spin_ratio)


def test_tour_fit_at_its_limits():
    assert law.tour_fit_drag(0.0, 0.0) == 0.5  # a sphere before the crisis
    assert law.tour_fit_drag(5e5, 0.0) == pytest.approx(0.20, abs=1e-6)  # a dimpled ball beyond it
    assert law.tour_fit_drag(0.68e5, 0.0) == pytest.approx(0.35)  # half way
    assert law.tour_fit_lift(1e5, 1e9) == 0.324
    assert law.tour_fit_drag(1e5, 1e9) - law.tour_fit_drag(1e5, 0.0) == pytest.approx(1.10 * 0.324**2)
    assert law.tour_fit_lift(1e5, 0.126) == pytest.approx(0.324 * (1.0 - exp(-1.0)))


@pytest.mark.parametrize(
    ("reynolds", "spin_ratio", "drag", "lift"),
    [(1.1e5, 0.1, 0.240, 0.135), (1.5e5, 0.15, 0.256, 0.164)],  # Li et al. 2017; Crabill 2019; both second-hand
)
def test_tour_fit_is_near_what_flow_simulations_find(reynolds: float, spin_ratio: float, drag: float, lift: float):
    """Real balls lift more than simulated ones; the drag agrees."""
    assert law.tour_fit_drag(reynolds, spin_ratio) == pytest.approx(drag, abs=0.005)
    assert law.tour_fit_lift(reynolds, spin_ratio) == pytest.approx(lift, abs=0.07)


@given(spin_ratio=st.floats(0.0, 3.0), more=st.floats(0.0, 3.0), reynolds=st.floats(0.0, 5e5))
def test_monitor_fit_rises_with_the_spin_within_bounds(spin_ratio: float, more: float, reynolds: float):
    for model in (law.monitor_fit_lift, law.monitor_fit_drag):
        assert model(reynolds, spin_ratio + more) >= model(reynolds, spin_ratio)
    assert law.monitor_fit_drag(2.0 * reynolds, 0.0) <= law.monitor_fit_drag(reynolds, 0.0)
    assert 0.183 <= law.monitor_fit_drag(reynolds, spin_ratio) < 0.62


# The formulas of the papers -------------------------------------------------------------------------------------------


@given(reynolds=st.floats(0.7e5, 2.1e5), spin_ratio=st.floats(0.02, 0.3))
def test_models_are_their_formulas_inside_their_range(reynolds: float, spin_ratio: float):
    re, s = reynolds / 1e5, spin_ratio
    formulas = {
        law.smits_smith_drag: 0.24 + 0.18 * s + 0.06 * sin(pi * (reynolds - 9e4) / 2e5),
        law.smits_smith_lift: 0.54 * s**0.4,
        law.lyu_drag: 1.91e-11 * reynolds**2 - 5.40e-6 * reynolds + 0.56,
        law.lyu_lift: -3.25 * s**2 + 1.99 * s,
        law.usga_drag: 0.2028 + 2.8466 * s**2 + 0.0165 * re - 0.2159 * s,
        law.usga_lift: 0.0860 + 0.6463 * s - 0.0122 / re**2 + 1.4789 * s**2,
        law.quadratic_drag: 0.19710 + 0.54852 * s - 0.52694 * s**2 - 0.09160 * (re - 1.5),
        law.quadratic_lift: 0.06628 + 1.37548 * s - 1.41620 * s**2,
        law.power_law_golf_drag: 0.2333 + 0.3260 * s,
        law.power_law_golf_lift: 0.5277 * s**0.4124,
    }
    for model, expected in formulas.items():
        assert model(reynolds, spin_ratio) == pytest.approx(expected, rel=1e-12), model.__name__


@pytest.mark.parametrize(
    ("model", "far", "edge"),
    [
        (law.smits_smith_drag, (9e5, 5.0), (2.9e5, 1.0)),
        (law.smits_smith_lift, (1e5, 5.0), (1e5, 1.0)),
        (law.lyu_drag, (9e5, 0.1), (2.1e5, 0.1)),
        (law.lyu_lift, (1e5, 5.0), (1e5, 0.306)),
        (law.quadratic_drag, (9e5, 5.0), (2.2e5, 0.52)),
        (law.quadratic_drag, (0.0, 0.1), (0.3e5, 0.1)),
        (law.quadratic_lift, (1e5, 5.0), (1e5, 0.4856)),
        (law.power_law_golf_drag, (1e5, 5.0), (1e5, 1.0)),
        (law.power_law_golf_lift, (1e5, 5.0), (1e5, 1.0)),
        (law.usga_drag, (9e5, 5.0), (2.5e5, 0.35)),
        (law.usga_lift, (0.0, 5.0), (0.5e5, 0.35)),
    ],
)
def test_models_are_held_outside_their_range(model, far: tuple[float, float], edge: tuple[float, float]):
    assert model(*far) == model(*edge)
