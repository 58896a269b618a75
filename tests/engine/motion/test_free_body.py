"""Forces and torques on bodies that touch nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.ball import Body
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import box
from sandbox.errors import RunError
from tests.engine.bodies import run_of


def test_a_torque_may_depend_on_the_angle():
    """I w' = -k (angle): a torsion pendulum turns as A cos((k / I)^(1/2) t), between steps, too; the error follows the
    tolerance."""
    stiffness, most = 0.5, 0.8
    spring = lambda t, position, velocity, spin: -stiffness * position.angle  # noqa: E731
    crate = Body("crate", position=(0.0, 0.0), shape=box(0.4, 0.3), mass=2.0, angle=most, torques=(spring,))
    for level, aimed in (("balanced", 2e-6), ("precise", 2e-8)):
        run = simulate(Setup([crate], duration=3.0), LEVELS[level])
        for t in np.linspace(0.1, 3.0, 30):
            turned, rate = (stiffness / crate.inertia) ** 0.5 * t, (stiffness / crate.inertia) ** 0.5
            assert run.angle("crate", t) == pytest.approx(most * math.cos(turned), abs=aimed)
            assert run.state("crate", t)[4] == pytest.approx(-most * rate * math.sin(turned), abs=20.0 * aimed)


def test_a_force_on_a_body_must_be_real():
    crate = Body(
        "crate", position=(0.0, 0.0), shape=box(0.4, 0.3), mass=2.0, forces=[lambda *state: (1j * state[0], 0)]
    )
    with pytest.raises(RunError, match=r"must return \(fx, fy\) in N.*returned \(.*j, 0\)"):
        run_of([crate], 3.0)
