"""Balls that give way along their contacts, against another integrator, the closed form, and what always holds."""

from __future__ import annotations

from dataclasses import replace
from math import cos, hypot, radians, sin, tan

import numpy as np
import pytest

from sandbox.engine.impact.cluster_parts import ClusterBall
from sandbox.engine.impact.clusters import ClusterOutcome
from sandbox.physics.hertz import PHENOLIC, largest_overlap
from sandbox.physics.throw import friction_by_speed, spring_back
from tests.engine.contact_law import by_springs
from tests.engine.impact.test_clusters import APART, MASS, STIFFNESS, TRIANGLE, ball, cluster, energy, rack

ALONG = PHENOLIC.along


def passage(
    bodies: list[ClusterBall],
    restitution: float = 0.95,
    friction: float = 0.1,
    step: float = 0.07,
    along: float = ALONG,
) -> ClusterOutcome:
    return replace(cluster(bodies, restitution, friction), along=along).pass_through(step)


def struck(speed: float, angle: float, others: list[ClusterBall], spin: tuple[float, float, float] = (0.0, 0.0, 0.0)):
    """A ball that touches the first of the others, and comes at ``angle`` (deg) to the line of x."""
    way = radians(angle)
    return [ball(-APART * cos(way), -APART * sin(way), speed, spin=spin), *others]


@pytest.mark.parametrize("cut", [5.0, 12.0, 20.0, 26.0, 31.0, 35.0])
def test_a_slow_pair_has_the_throw_of_the_closed_form(cut: float):
    """Slow, so that the line of centres hardly turns; of mu P."""
    way, mu, e = radians(cut), 0.13, 0.95
    outcome = passage([ball(0.0, 0.0, 0.02), ball(APART * cos(way), APART * sin(way))], e, mu)
    along, across = outcome.velocity[1] @ np.array([[cos(way), -sin(way)], [sin(way), cos(way)]])
    share = 2.0 / 7.0 * tan(way) / (mu * (1.0 + e))
    assert -across / along / mu == pytest.approx(min(1.0, (1.0 + spring_back(share)) * share), abs=0.015)


@pytest.mark.parametrize("others", [[ball(0.0, 0.0), ball(APART, 0.0)], TRIANGLE[:3]])
def test_springs_leave_as_another_integrator_says(others):
    """A frozen combination and a triangle, struck obliquely: to 0.1 % of the blow at ``balanced``."""
    bodies, speed, friction = struck(8.0, 28.0, others), 8.0, 0.13
    outcome = passage(bodies, 0.95, friction)
    deepest = float(largest_overlap(0.5 * MASS, STIFFNESS, 2.0 * speed))
    expected = by_springs(bodies, float(outcome.times[-1]), STIFFNESS, 0.95, friction, ALONG, deepest)
    assert np.abs(outcome.velocity - expected[:, 2:4]).max() < 1e-3 * speed


def test_springs_converge():
    """With four times the friction of clean balls it is rougher: 0.4 % of the blow at ``balanced``."""
    bodies = struck(8.0, 28.0, [ball(0.0, 0.0), ball(APART, 0.0)])
    for friction, error in ((0.13, 5e-4), (0.5, 5e-3)):
        rough, fine, finest = (passage(bodies, friction=friction, step=step).velocity for step in (0.07, 0.0175, 0.006))
        assert np.abs(rough - finest).max() < error * 8.0
        assert np.abs(fine - finest).max() < 0.2 * error * 8.0


def test_springs_create_no_energy():
    """Random impacts of a rack's corner: any friction, restitution, spin, step, and stiffness along."""
    random = np.random.default_rng(5)
    for _ in range(15):
        spin = tuple(random.normal(0.0, 150.0, 3).tolist())
        bodies = struck(float(10 ** random.uniform(-2, 1.3)), float(random.uniform(-70.0, 70.0)), TRIANGLE[:3], spin)
        e, mu, along = random.uniform(0.05, 1.0), 10 ** random.uniform(-2, 1), 10 ** random.uniform(-1, 0.3)
        outcome = passage(bodies, e, mu, float(random.choice([0.035, 0.07, 0.14])), along)
        assert np.isfinite(outcome.motion).all()
        assert outcome.gained <= 2e-3 * outcome.energy
        had = energy(np.array([body.velocity for body in bodies]), np.array([body.spin for body in bodies]), bodies)
        assert energy(outcome.velocity, outcome.spin[:, [1, 2, 0]], bodies) <= had * (1.0 + 1e-12)


def test_a_rack_with_springs_keeps_momentum_and_mirrors():
    bodies = rack(8.0, 1e-5)
    outcome = passage(bodies, friction=friction_by_speed)
    assert outcome.velocity.sum(axis=0) == pytest.approx([8.0, 0.0], abs=1e-9)
    mirrored = outcome.velocity[[0, 1, 3, 2, 6, 5, 4, 8, 7, 9]] * [1, -1]
    assert mirrored == pytest.approx(outcome.velocity, abs=8e-9)


def test_friction_goes_by_the_slip_with_which_balls_meet():
    """As the closed form of a pair takes it, though the slip ends meanwhile."""
    way = radians(45.0)
    pair = [ball(0.0, 0.0, 0.02), ball(APART * cos(way), APART * sin(way))]
    falling = passage(pair, friction=lambda slip: 0.1 - 3.0 * slip)
    fixed = passage(pair, friction=0.1 - 0.06 * sin(way))
    assert falling.velocity == pytest.approx(fixed.velocity, abs=2e-5 * 0.02)
    assert hypot(*falling.velocity[1]) > 0.0
