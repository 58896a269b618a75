"""Runs that several tests of the engine look at."""

import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay

G = 9.81


@pytest.fixture(scope="module")
def bouncing():
    floor = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.6, 0.4, 0.05)
    inertia = 0.4 * 0.2 * 0.05**2
    forces = [Gravity(G, 0.2), Drag(0.05, 1.2, Constant(0.4)), Magnus(0.05, 1.2, Constant(0.2))]
    ball = Ball("ball", 0.2, 0.05, (0.0, 1.0), (6.0, 3.0), 20.0, forces=forces,
                torques=[SpinDecay(inertia, 0.05, 1e-3)])  # fmt: skip
    return simulate(Setup([ball], [floor], duration=30.0), resolve("precise"))
