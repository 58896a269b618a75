"""A ball on a slope seen from above, against its equations of motion, integrated."""

from __future__ import annotations

from math import hypot, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import sandbox
from sandbox import Ball, Segment, Setup, Surface
from sandbox.engine.ledger import ledger
from sandbox.physics.plane import Strips, without
from sandbox.physics.slope import Slope

MASS, RADIUS, G, INERTIA = 0.046, 0.0213, 9.81, 0.4


def run_on(slope, velocity, roll=1.0, duration=2.0):
    vx, vy = velocity
    rolling_spin = -roll * vy / RADIUS, roll * vx / RADIUS
    ball = Ball("ball", MASS, RADIUS, (0.0, 0.0), velocity, rolling_spin=rolling_spin)
    return sandbox.simulate(Setup([ball], plane=slope, duration=duration))


def test_straight_up_and_down_is_exact():
    """Up at c g + p / (1 + k), down at p / (1 + k) - c g."""
    run = run_on(Slope(rolling=0.02, pull_x=-1.4), (1.5, 0.0), duration=6.0)
    up, down = 0.02 * G + 1.0, 1.0 - 0.02 * G
    turns = 1.5 / up
    assert run.state("ball", turns).x == pytest.approx(0.5 * 1.5**2 / up, abs=1e-12)
    assert run.state("ball", 4.0).x == pytest.approx(0.5 * 1.5 * turns - 0.5 * down * (4.0 - turns) ** 2, abs=1e-9)


def test_a_ball_stays_where_friction_holds_it():
    held = run_on(Slope(rolling=0.08, pull_x=-1.0), (0.5, 0.0))
    assert held.ended == "rest"
    assert held.duration == pytest.approx(0.5 / (0.08 * G + 1.0 / 1.4), abs=1e-12)
    assert run_on(Slope(rolling=0.07, pull_x=-1.0), (0.5, 0.0)).ended == "duration"


@pytest.mark.parametrize("roll", [1.0, 0.0, -1.0])
@pytest.mark.parametrize("velocity", [(1.5, 0.4), (0.3, -1.2), (-0.8, 0.01)])
def test_across_the_slope_it_follows_its_equations(velocity: tuple[float, float], roll: float):
    slope = Slope(sliding=0.3, rolling=0.03, pull_x=-0.9, pull_y=0.2)
    pull = np.array([-0.9, 0.2])

    def slides(t, y):
        slip = y[2:4] - y[4:6]
        friction = -0.3 * G * slip / np.hypot(*slip)
        return [*y[2:4], *(pull + friction), *(-friction / INERTIA)]

    def rolls(t, y):
        return [*y[2:4], *(pull / 1.4 - 0.03 * G * y[2:4] / np.hypot(*y[2:4]))]

    def slipped(t, y):
        return hypot(*(y[2:4] - y[4:6])) - 1e-7

    slipped.terminal = True
    t, state = 0.0, np.array([0.0, 0.0, *velocity])
    if roll < 1.0:
        start = np.array([*state, roll * velocity[0], roll * velocity[1]])
        found = solve_ivp(slides, (0.0, 2.0), start, events=slipped, rtol=1e-11, atol=1e-12)
        t, state = found.t[-1], found.y[:4, -1]
    expected = solve_ivp(rolls, (t, 2.0), state, rtol=1e-11, atol=1e-12).y[:, -1]
    assert run_on(slope, velocity, roll).state("ball", 2.0)[:4] == pytest.approx(expected.tolist(), abs=2e-4)


def test_the_ledger_has_the_height():
    """Up a rise of 10 cm: m g h is gone, and friction takes m (1 + k) c g s."""
    ramp = Strips((1.0, 2.0), [Slope(rolling=0.01), Slope(rolling=0.01, pull_x=-0.1 * G), Slope(rolling=0.01)])
    run = run_on(ramp, (2.0, 0.0), duration=30.0)
    book, far = ledger(run), run.state("ball", run.duration).x
    assert far > 2.0
    assert book.work["slope"] == pytest.approx(-MASS * G * 0.1, rel=1e-9)
    assert book.contacts["cloth"] == pytest.approx(-MASS * 1.4 * 0.01 * G * far, rel=1e-9)
    assert book.start + sum(book.work.values()) + sum(book.contacts.values()) == pytest.approx(book.end, abs=1e-12)
    slower = sqrt(4.0 - 2.0 * (0.01 * G * 2.0 + 0.1 * G / 1.4))
    assert hypot(*next(run.crossings("ball", (2.0, 0.0), (-1.0, 0.0)))[1][2:4]) == pytest.approx(slower, abs=1e-9)


def test_a_ball_at_the_lower_board_rolls_along_it_or_rests():
    """Pressed on a board it goes on as straight down the slope along it, and the energy is all accounted for."""
    board = Surface("board", Segment((-9.0, -0.2), (9.0, -0.2)), 0.5, 0.0)
    for along, ended in ((-0.6, "duration"), (-0.1, "rest")):
        slope = Slope(rolling=0.03, pull_x=along, pull_y=-0.8)
        ball = Ball("ball", MASS, RADIUS, (0.0, 0.0), (0.0, 0.0))
        run = sandbox.simulate(Setup([ball], [board], plane=slope, duration=5.0))
        assert run.ended == ended
        assert run.state("ball", run.duration).y == pytest.approx(RADIUS - 0.2, abs=1e-9)
        assert abs(ledger(run).residue) < 1e-6
        if ended == "duration":
            speeds = -run.states("ball", [4.0, 5.0])[:, 2]
            assert speeds[1] - speeds[0] == pytest.approx(0.6 / 1.4 - 0.03 * G, abs=1e-9)


def test_too_steep_to_roll_is_refused():
    with pytest.raises(ValueError, match=r"cloth: a slope that pulls by 7 m/s\^2 must pull by less than 6\.87 m/s\^2"):
        Slope(sliding=0.2, pull_x=-7.0)


def test_without_friction_a_ball_slides_as_it_falls():
    """As ``sandbox trade`` leaves it out: p in place of p / (1 + k)."""
    run = run_on(without(Slope(sliding=0.2, rolling=0.0, pull_x=-0.5), "sliding"), (1.0, 0.0))
    assert run.state("ball", 2.0).x == pytest.approx(2.0 - 0.5 * 0.5 * 4.0, abs=1e-9)


def test_a_putt_across_an_even_slope_is_exact():
    """With u = tan(psi / 2), psi its angle from straight downhill, and n = a / s > 1 (friction over the pull on a ball
    that rolls), v = K u^n (1 + u^2) / 2 u: it stops straight downhill, where u = 0."""
    pull, friction, speed, psi = 0.28, 0.03 * G, 2.0, 1.9  # m/s^2, m/s, rad from downhill
    s = pull / 1.4
    n, u = friction / s, np.tan(psi / 2.0)
    k = 2.0 * speed * u ** (1.0 - n) / (1.0 + u * u)
    time = k / (2.0 * s) * (u ** (n - 1.0) / (n - 1.0) + u ** (n + 1.0) / (n + 1.0))
    down = k * k / (4.0 * s) * (u ** (2.0 * n - 2.0) / (2.0 * n - 2.0) - u ** (2.0 * n + 2.0) / (2.0 * n + 2.0))
    across = k * k / (2.0 * s) * (u ** (2.0 * n - 1.0) / (2.0 * n - 1.0) + u ** (2.0 * n + 1.0) / (2.0 * n + 1.0))
    run = run_on(Slope(rolling=0.03, pull_y=-pull), (speed * np.sin(psi), -speed * np.cos(psi)), duration=60.0)
    assert (run.ended, run.duration) == ("rest", pytest.approx(time, abs=1e-5))
    assert run.state("ball", run.duration)[:2] == pytest.approx((across, -down), abs=1e-5)


def test_a_twisted_slope_bends_both_ways_and_has_a_height():
    """z = -(p_x x + p_y y + q x y) / g: the cross slope turns over half-way, and m g z is all that the slope does."""
    slope = Slope(rolling=0.03, pull_x=-0.2, pull_y=-0.35, twist=0.25)

    def rolls(t, y):
        pull = np.array([-0.2 + 0.25 * y[1], -0.35 + 0.25 * y[0]])
        return [*y[2:4], *(pull / 1.4 - 0.03 * G * y[2:4] / np.hypot(*y[2:4]))]

    run = run_on(slope, (2.0, 0.1), duration=2.0)
    expected = solve_ivp(rolls, (0.0, 2.0), [0.0, 0.0, 2.0, 0.1], rtol=1e-11, atol=1e-12).y[:, -1]
    assert run.state("ball", 2.0)[:4] == pytest.approx(expected.tolist(), abs=2e-6)
    assert np.ptp(np.sign(np.gradient(run.states("ball", np.linspace(0.2, 2.0, 50))[:, 3]))) == 2.0
    x, y = run.state("ball", 2.0)[:2]
    assert ledger(run).work["slope"] == pytest.approx(MASS * (-0.2 * x - 0.35 * y + 0.25 * x * y), rel=1e-6)
