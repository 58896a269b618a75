"""A cushion whose nose is above the ball's centre: against the law as vectors, and against tracked rebounds."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, radians, sin

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.physics.cloth import Cloth
from sandbox.physics.plane import PlaneMode

RADIUS, NOSE, RESTITUTION, FRICTION = 0.03075, 0.037, 0.88, 0.265  # a carom table's


def rebound(motion, normal, height=NOSE, restitution=RESTITUTION, friction=FRICTION, method="exact"):
    """The motion of a ball just after it hits a nose."""
    (nx, ny), (vx, vy, wz, wx, wy) = normal, motion
    ball = Ball("ball", 0.2, RADIUS, (1.001 * RADIUS * nx, 1.001 * RADIUS * ny), (vx, vy), wz, (wx, wy))
    rail = Surface(
        "rail", Segment((-9.0 * ny, 9.0 * nx), (9.0 * ny, -9.0 * nx)), restitution, friction, nose_height=height
    )
    run = simulate(
        Setup([ball], [rail], plane=Cloth(0.0, 0.0, 0.0), duration=2e-3),
        resolve(method=method, step=1e-4, integrator="heun"),
    )
    return (*run.state("ball", run.duration)[2:], *run.rolling_spin("ball", run.duration))


def by_vectors(motion, normal, height=NOSE, restitution=RESTITUTION, friction=FRICTION):
    """Han's law as it is written, with cross products."""
    vx, vy, wz, wx, wy = motion
    n, v, w = np.array([*normal, 0.0]), np.array([vx, vy, 0.0]), np.array([wx, wy, wz])
    theta = np.arcsin((height - RADIUS) / RADIUS)
    d = -n * np.cos(theta) + np.array([0.0, 0.0, np.sin(theta)])
    slip = v + np.cross(w, RADIUS * d)
    slip -= d * (slip @ d)
    pressed = -(1.0 + restitution) * (v @ n) * np.cos(theta)
    size = np.linalg.norm(slip)
    impulse = -pressed * d - min(friction * pressed, 2 / 7 * size) * slip / size
    v, w = v + impulse, w + 2.5 * np.cross(d, impulse) / RADIUS
    return v[0], v[1], w[2], w[0], w[1]


def some_motions(count):
    random = np.random.default_rng(0)
    for _ in range(count):
        turn, along, into = random.uniform(0.0, 2 * np.pi), random.normal(), random.uniform(0.1, 5.0)
        n = (cos(turn), sin(turn))
        spins = random.normal(size=3) * 40.0
        yield (-into * n[0] + along * n[1], -into * n[1] - along * n[0], *spins.tolist()), n


@pytest.mark.parametrize("method", ["exact", "plain"])
def test_is_the_law_as_it_is_written(method):
    for motion, normal in some_motions(100):
        assert rebound(motion, normal, method=method) == pytest.approx(by_vectors(motion, normal), abs=1e-11)


def test_the_ball_goes_away_and_gains_nothing():
    for motion, normal in some_motions(200):
        after = rebound(motion, normal)
        assert after[0] * normal[0] + after[1] * normal[1] > 0.0
        energies = [
            m[0] ** 2 + m[1] ** 2 + 0.4 * RADIUS**2 * (m[2] ** 2 + m[3] ** 2 + m[4] ** 2) for m in (motion, after)
        ]
        assert energies[1] <= energies[0]


@pytest.mark.parametrize(
    ("angle", "after", "rolling", "speed"), [(20, 15.3, 23.8, 0.598), (45, 37.0, 50.4, 0.646), (60, 57.0, 70.1, 0.728)]
)
def test_a_rolling_ball_leaves_as_tracked_ones_do(angle, after, rolling, speed):
    """Angles from the normal just after the cushion and once the ball rolls again, and the speed over that before."""
    vx, vy = cos(radians(angle)), sin(radians(angle))
    motion = rebound((vx, vy, 0.0, -vy / RADIUS, vx / RADIUS), (-1.0, 0.0))
    assert degrees(atan2(motion[1], -motion[0])) == pytest.approx(after, abs=0.1)
    cloth, state = Cloth(sliding=0.202, rolling=0.0045), (0.0, 0.0, *motion)
    while (phase := cloth.phase(state, RADIUS)).mode is PlaneMode.SLIDING:
        state = phase.after(phase.duration)
    assert degrees(atan2(state[3], -state[2])) == pytest.approx(rolling, abs=0.1)
    assert hypot(state[2], state[3]) == pytest.approx(speed, abs=2e-3)


def test_mirrored_it_is_the_mirror_image():
    for (vx, vy, wz, wx, wy), (nx, ny) in some_motions(50):
        one = rebound((vx, vy, wz, wx, wy), (nx, ny))
        other = rebound((vx, -vy, -wz, -wx, wy), (nx, -ny))
        assert other == pytest.approx((one[0], -one[1], -one[2], -one[3], one[4]), abs=1e-12)


def test_a_nose_at_the_centre_is_a_wall():
    """Without friction, e of the normal speed, and nothing else changes."""
    after = rebound((1.0, 0.5, 3.0, 2.0, 1.0), (-1.0, 0.0), RADIUS, 0.9, 0.0)
    assert after == pytest.approx((-0.9, 0.5, 3.0, 2.0, 1.0))
