"""Rockets: the motor's curve, and what the engine makes of a mass that falls."""

from __future__ import annotations

from dataclasses import replace
from math import cosh, log, sqrt, tanh

import numpy as np
import pytest

from sandbox.engine import simulate, simulate_many
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity
from sandbox.physics.rocket import Motor, Thrust

G = 9.81
EVEN = Motor((0.2, 1.2), (10.0, 10.0), 0.5)  # 10 N for a second: 10 N s, what leaves it has 20 m/s
CURVE = Motor((0.0, 0.1, 0.5, 1.0), (0.0, 30.0, 5.0, 0.0), 0.02)


def rocket(motor: Motor, *forces, mass: float = 1.0, loses: bool = True) -> Setup:
    thrust = Thrust(motor, (0.0, 0.0), (0.0, 1.0), 1e9)
    ball = Ball("rocket", mass, 0.02, (0.0, 0.0), forces=[thrust, *forces], loss=motor if loses else None)
    return Setup([ball], duration=2.0, discontinuities=motor.times)


@pytest.mark.parametrize("motor", [EVEN, CURVE], ids=["even", "curve"])
def test_impulse_and_mass_are_the_integrals_of_thrust_and_rate(motor: Motor):
    t = np.linspace(0.0, 1.5, 1501)
    middles = 0.5 * (t[1:] + t[:-1])
    for total, rate in ((motor.impulse, motor.thrust), (motor.propellant, motor.rate)):
        assert np.sum(rate(middles)) * 1e-3 == pytest.approx(total, rel=1e-6)
    assert motor.lost(0.0) == 0.0
    assert motor.lost(1.5) == motor.propellant
    assert motor.lost(t) == pytest.approx([motor.lost(float(at)) for at in t])


def test_without_other_forces_it_gains_what_tsiolkovsky_says():
    """v = c ln(m0 / m1)."""
    for name, level in LEVELS.items():
        run = simulate(rocket(EVEN), level)
        assert run.state("rocket", 2.0)[3] == pytest.approx(20.0 * log(2.0), abs=level.tolerance), name


def test_gravity_pulls_at_what_is_left():
    """v = c ln(m0 / m1) - g t: weight falls with mass."""
    run = simulate(rocket(EVEN, Gravity(G, 1.0, loss=EVEN)), LEVELS["balanced"])
    assert run.state("rocket", 2.0)[3] == pytest.approx(20.0 * log(2.0) - 2.0 * G, rel=1e-6)


def test_against_drag_it_gains_what_fehskens_and_malewicki_say():
    """A mass that stays: v = q tanh(k q t / m), y = (m / k) ln cosh(k q t / m), q^2 = (F - m g) / k."""
    motor, drag = Motor((0.0, 1.0), (30.0, 30.0), 0.5), Drag(0.02, 1.2, Constant(0.6))
    k = -drag(0.0, (0.0, 0.0), (0.0, 1.0), 0.0)[1]
    q = sqrt((30.0 - G) / k)
    run = simulate(rocket(motor, drag, Gravity(G, 1.0), loses=False), LEVELS["precise"])
    _, y, _, speed, _ = run.before("rocket", 1.0)
    assert speed == pytest.approx(q * tanh(k * q), rel=1e-9)
    assert y == pytest.approx(log(cosh(k * q)) / k, rel=1e-9)


def test_the_ledger_knows_what_the_lost_mass_takes_away():
    found = ledger(simulate(rocket(CURVE, Gravity(G, 1.0, loss=CURVE)), LEVELS["precise"]))
    assert found.work["lost mass"] < 0.0
    assert abs(found.residue) < 1e-6 * found.work["thrust"]


def test_many_rockets_fly_as_one():
    setups = [rocket(replace(CURVE, propellant=0.001 * (1 + i)), Gravity(G, 1.0)) for i in range(40)]
    for setup, run in zip(setups, simulate_many(setups, LEVELS["balanced"]), strict=True):
        assert run.state("rocket", 2.0) == pytest.approx(simulate(setup, LEVELS["balanced"]).state("rocket", 2.0))


def test_no_step_goes_across_a_break():
    arcs = simulate(rocket(EVEN), LEVELS["fast"]).arcs["rocket"]
    assert {0.2, 1.2} <= {round(arc.t1, 12) for arc in arcs}


def test_a_ball_that_loses_mass_is_alone():
    other = Ball("other", 1.0, 0.1, (5.0, 0.0))
    with pytest.raises(ValueError, match="'rocket' loses mass"):
        replace(rocket(EVEN), balls=[*rocket(EVEN).balls, other])
