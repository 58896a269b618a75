"""Whole runs with impacts converge: exact ones at the order of their integrator, plain ones to exact ones."""

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, Segment, Surface
from sandbox.physics.forces import Gravity
from tests.engine import shots

G = 9.81


@pytest.mark.parametrize(
    ("integrator", "order", "steps"),
    [
        ("explicit-euler", 1, (400, 3200)),
        ("heun", 2, (100, 800)),
        ("velocity-verlet", 2, (100, 800)),
        ("rk4", 4, (30, 120)),
    ],
)
def test_runs_with_impacts_converge_at_the_integrators_order(integrator, order, steps):
    """Rim, board and floor included: the end after 2.5 s, against precise at a hundredth of its tolerance."""
    shot = next(s for s in shots.seeded(50) if len(simulate(shots.setup(*s, 2.5), resolve()).events) == 3)
    exact = simulate(shots.setup(*shot, 2.5), resolve("precise", tolerance=1e-8)).state("ball", 2.5)
    errors = []
    for count in steps:
        end = simulate(shots.setup(*shot, 2.5), resolve(integrator=integrator, step=1 / count)).state("ball", 2.5)
        errors.append(np.hypot(end[0] - exact[0], end[1] - exact[1]))
    slope = np.log(errors[0] / errors[1]) / np.log(steps[1] / steps[0])
    assert slope == pytest.approx(order, abs=0.45)


def test_plain_converges_to_the_same_end_at_first_order():
    shot = next(s for s in shots.seeded(50) if len(simulate(shots.setup(*s, 1.2), resolve()).events) == 1)
    exact = simulate(shots.setup(*shot, 1.2), resolve("precise")).state("ball", 1.2)
    errors = []
    for count in (500, 8000):
        end = simulate(shots.setup(*shot, 1.2), resolve(method="plain", step=1 / count)).state("ball", 1.2)
        errors.append(np.hypot(end[0] - exact[0], end[1] - exact[1]))
    assert errors[1] < 0.02
    assert errors[1] < 0.3 * errors[0]


def test_plain_converges_to_exact_on_soft_turf():
    """A tilted bounce turns forward speed upward; what counts as too low is the rebound, in both methods."""

    def law(normal, tangential):
        return Bounce(0.4, 0.4, 0.05 * tangential / (1.0 + tangential))

    turf = Surface("turf", Segment((-9.0, 0.0), (99.0, 0.0)), 0.4, 0.4, 0.1, 0.005, law)
    ball = Ball("ball", 0.05, 0.02, (0.0, 0.5), (6.0, 0.0), forces=[Gravity(G, 0.05)])
    setup = Setup([ball], [turf], duration=2.5)
    exact = simulate(setup, resolve("precise"))
    errors = [
        abs(simulate(setup, resolve(method="plain", step=step)).state("ball", 2.5)[0] - exact.state("ball", 2.5)[0])
        for step in (1 / 1000, 1 / 8000)
    ]
    assert errors[1] < 2e-3
    assert errors[1] < 0.2 * errors[0]
