"""What is read from a run."""

from __future__ import annotations

from math import asinh, hypot

import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.physics.forces import Gravity
from sandbox.sport.readings import travelled, words_of


def test_the_length_of_a_path_is_that_of_its_parabola():
    """The integral of sqrt(u^2 + v^2) dv / g is (v sqrt(u^2 + v^2) + u^2 asinh(v / u)) / 2 g."""
    g, across, up, duration = 9.81, 6.0, 4.0, 1.2

    def integral(v: float) -> float:
        return 0.5 * (v * hypot(across, v) + across**2 * asinh(v / across)) / g

    ball = Ball("ball", 0.1, 0.03, (0.0, 0.0), (across, up), forces=(Gravity(g, 0.1),))
    run = simulate(Setup((ball,), duration=duration), resolve(level="precise"))
    assert travelled(run, "ball") == pytest.approx(integral(up) - integral(up - g * duration), rel=2e-4)


def test_two_that_meet_aslant_have_both_speeds():
    """At 2 m/s with the line of centres 30 deg aside: 2 cos 30 = 1.7 m/s along the normal."""
    hit = Ball("hit", 1.0, 0.1, (1.0, 0.1))  # 2 r sin 30 aside
    run = simulate(Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0), (2.0, 0.0)), hit]), resolve())
    assert words_of(run, run.events[0])[-1] == "at 2.0 m/s, normal 1.7 m/s"
    straight = Ball("hit", 1.0, 0.1, (1.0, 0.0))
    run = simulate(Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0), (2.0, 0.0)), straight]), resolve())
    assert words_of(run, run.events[0])[-1] == "at 2.0 m/s"
