"""Forces: what must hold of each, whatever its coefficient."""

from __future__ import annotations

from math import hypot, pi
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import sandbox
from sandbox.engine.motion.forces_on_ball import cause
from sandbox.physics.air import LogWind, UniformWind
from sandbox.physics.coefficients import Constant, spin_ratio_lift, tour_fit_drag, tour_fit_lift
from sandbox.physics.forces import Drag, Gravity, Inside, Magnus, SpinDecay, Thinning

ROOT = Path(__file__).resolve().parents[2]
RADIUS, DENSITY = 0.021335, 1.2
DRAG = Drag(RADIUS, DENSITY, tour_fit_drag)
LIFT = Magnus(RADIUS, DENSITY, tour_fit_lift)
HERE = (3.0, 5.0)

SPEEDS = st.floats(-340.0, 340.0)
SPINS = st.floats(-2000.0, 2000.0)


def test_gravity():
    assert Gravity(9.81, 0.5)(0.0, HERE, (3.0, 4.0), 5.0) == (0.0, -0.5 * 9.81)


@pytest.mark.parametrize(("name", "said"), [("throws", "0.01 %"), ("golf", "0.1 %"), ("volleyball", "2.2 %")])
def test_the_buoyancy_left_out_is_what_the_page_says(name: str, said: str):
    """The density of the air over that of the ball."""
    parameters = sandbox.load(name).parameters
    ball = parameters.ball
    share = 100.0 * parameters.air.air.density * 4.0 / 3.0 * pi * ball.radius**3 / ball.mass
    digits = len(said.partition(".")[2].split()[0])
    assert f"{share:.{digits}f} %" == said
    assert said in (ROOT / "docs" / "physics.md").read_text("utf-8").partition("### Drag")[0]


def test_drag_by_its_formula():
    """F = -1/2 rho Cd A |u| u."""
    fx, fy = Drag(RADIUS, DENSITY, Constant(0.3))(0.0, HERE, (30.0, -40.0), 0.0)
    size = 0.5 * DENSITY * 0.3 * pi * RADIUS**2 * 50.0
    assert (fx, fy) == pytest.approx((-size * 30.0, size * 40.0))


def test_a_kind_of_constant_coefficient_of_a_scene_is_asked():
    class Ribbed(Constant):
        def __call__(self, reynolds, spin_ratio):
            return self.value * (1.0 + spin_ratio)

    at = (0.0, HERE, (50.0, 0.0), 50.0 / RADIUS)  # where the spin ratio is 1
    assert Drag(RADIUS, DENSITY, Ribbed(0.3))(*at) == pytest.approx(Drag(RADIUS, DENSITY, Constant(0.6))(*at))


def test_lift_by_its_formula():
    """F = 1/2 rho Cl A |u|^2, and here Cl = r w / |u|; backspin of a ball flying towards +x lifts."""
    fx, fy = Magnus(RADIUS, DENSITY, spin_ratio_lift)(0.0, HERE, (50.0, 0.0), 300.0)
    assert (fx, fy) == pytest.approx((0.0, 0.5 * DENSITY * RADIUS * 300.0 / 50.0 * pi * RADIUS**2 * 50.0**2))


def test_a_cross_section_of_its_own():
    usual, half = Drag(RADIUS, DENSITY, Constant(0.3)), Drag(RADIUS, DENSITY, Constant(0.3), area=0.5 * pi * RADIUS**2)
    assert half(0.0, HERE, (30.0, 0.0), 0.0)[0] == pytest.approx(0.5 * usual(0.0, HERE, (30.0, 0.0), 0.0)[0])


def test_viscosity_and_spin_reach_the_coefficient():
    seen = []

    def coefficient(reynolds, spin_ratio):
        seen.append((reynolds, spin_ratio))
        return 0.3

    Drag(RADIUS, DENSITY, coefficient, viscosity=2e-5)(0.0, HERE, (0.0, -40.0), -500.0)
    assert seen == [pytest.approx((DENSITY * 40.0 * 2 * RADIUS / 2e-5, RADIUS * 500.0 / 40.0))]


@given(vx=SPEEDS, vy=SPEEDS, spin=SPINS)
def test_in_still_air_no_force_adds_energy_and_lift_does_no_work(vx: float, vy: float, spin: float):
    fx, fy = DRAG(0.0, HERE, (vx, vy), spin)
    assert fx * vx + fy * vy <= 0.0
    fx, fy = LIFT(0.0, HERE, (vx, vy), spin)
    assert abs(fx * vx + fy * vy) <= 1e-15 * (1.0 + hypot(fx, fy) * hypot(vx, vy))
    assert SpinDecay(8e-6, RADIUS, 2e-5)(0.0, HERE, (vx, vy), spin) * spin <= 0.0


@pytest.mark.parametrize("force", [DRAG, LIFT], ids=["drag", "lift"])
@given(vx=SPEEDS, vy=SPEEDS, spin=SPINS)
def test_mirror_image_in_mirror_image_out(force, vx: float, vy: float, spin: float):
    """In a mirror the spin turns the other way."""
    fx, fy = force(0.0, HERE, (vx, vy), spin)
    assert force(0.0, HERE, (-vx, vy), -spin) == (-fx, fy)


@given(vx=SPEEDS, vy=SPEEDS, spin=SPINS, wx=st.floats(-40.0, 40.0), wy=st.floats(-40.0, 40.0))
def test_only_the_velocity_relative_to_the_air_counts(vx: float, vy: float, spin: float, wx: float, wy: float):
    wind = UniformWind(wx, wy)
    for still, windy in (
        (DRAG, Drag(RADIUS, DENSITY, tour_fit_drag, wind)),
        (LIFT, Magnus(RADIUS, DENSITY, tour_fit_lift, wind)),
    ):
        assert windy(0.0, HERE, (vx, vy), spin) == still(0.0, HERE, (vx - wx, vy - wy), spin)


def test_lift_along_the_ground_does_not_know_the_wind():
    windy = Magnus(RADIUS, DENSITY, tour_fit_lift, UniformWind(-20.0, 0.0), along_ground=True)
    assert windy(0.0, HERE, (50.0, 9.0), 300.0) == LIFT(0.0, HERE, (50.0, 9.0), 300.0)


@pytest.mark.parametrize("spin", [0.0, 400.0])
def test_no_force_at_rest_in_still_air_and_no_lift_without_spin(spin: float):
    for force in (DRAG, LIFT):
        assert force(0.0, HERE, (0.0, 0.0), spin) == pytest.approx((0.0, 0.0), abs=0.0)
    assert (LIFT(0.0, HERE, (50.0, 9.0), spin) == (0.0, 0.0)) == (spin == 0.0)


def test_spin_decay_by_its_formula():
    """dw/dt = -k |u| w / r."""
    torque = SpinDecay(8e-6, RADIUS, 2e-5, UniformWind(-10.0, 0.0))(0.0, HERE, (40.0, 0.0), 300.0)
    assert torque / 8e-6 == pytest.approx(-2e-5 * 50.0 * 300.0 / RADIUS)


@given(
    shots=st.lists(st.tuples(SPEEDS, SPEEDS, SPINS, st.floats(0.0, 120.0)), min_size=1, max_size=5),
    wx=st.floats(-40.0, 40.0),
)
def test_floats_and_arrays_agree(shots, wx: float):
    """One ball goes through Python floats, many through numpy; the same numbers come out, to the last place."""
    assume(all(spin == 0.0 or abs(spin) > 1e-250 for _, _, spin, _ in shots))
    wind = LogWind((wx, 0.0), 10.0, 0.03)
    vx, vy, spin, y = (np.array(column) for column in zip(*shots, strict=True))
    for force in (Drag(RADIUS, DENSITY, tour_fit_drag, wind), Magnus(RADIUS, DENSITY, tour_fit_lift, wind)):
        together = np.array(force(0.0, (np.zeros_like(y), y), (vx, vy), spin)).T
        one_by_one = [force(0.0, (0.0, sy), (sx, sv), sw) for sx, sv, sw, sy in shots]
        assert together == pytest.approx(np.array(one_by_one), rel=1e-13, abs=1e-13)
    decay = SpinDecay(8e-6, RADIUS, 2e-5, wind)
    together = decay(0.0, (np.zeros_like(y), y), (vx, vy), spin)
    one_by_one = [decay(0.0, (0.0, sy), (sx, sv), sw) for sx, sv, sw, sy in shots]
    assert together == pytest.approx(np.array(one_by_one), rel=1e-14)


def test_a_force_in_a_medium_grows_with_the_immersed_fraction():
    force = Inside(Gravity(10.0, 1.0), (0.0, 2.0), (0.0, 1.0), 0.25, "drag of water")
    heights = np.array([3.0, 2.25, 2.125, 2.0, 1.875, 1.75, 0.0])
    shares = [0.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.0]
    together = force(0.0, (np.zeros(7), heights), (0.0, 0.0), 0.0)[1]
    alone = [force(0.0, (0.0, y), (0.0, 0.0), 0.0)[1] for y in heights.tolist()]
    assert together == pytest.approx(np.multiply(shares, -10.0))
    assert alone == pytest.approx(together)
    assert cause(force) == "drag of water"


def test_air_thins_as_in_the_standard_atmosphere():
    """Its table has 1.2250, 1.1117, 0.7364 and 0.3639 kg/m^3 at 0, 1, 5 and 11 km."""
    heights = np.array([0.0, 1000.0, 5000.0, 11000.0])
    thinning = Thinning(Gravity(1.2250, 1.0))
    assert thinning(0.0, (0.0, heights), (0.0, 0.0), 0.0)[1] == pytest.approx(
        [-1.225, -1.1117, -0.7364, -0.3639], rel=5e-4
    )
    assert thinning(0.0, (0.0, 1000.0), (0.0, 0.0), 0.0)[1] == pytest.approx(-1.1117, rel=5e-4)
    assert cause(thinning) == "gravity"
