"""Impacts of balls on cloth: friction in three dimensions of spin, several at once, and high noses."""

from dataclasses import replace
from itertools import permutations
from math import exp, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sandbox.engine import simulate
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, Segment, Surface
from sandbox.physics.cloth import Cloth
from tests.engine.on_cloth import CLOTH, RIGID, R, ball, of, rolling


def test_a_rolling_ball_keeps_its_spin_in_a_smooth_head_on_hit():
    """e = 1, no friction: the cue ball stops, keeps its spin and follows at 2/7 v; the object ball ends at 5/7 v."""
    balls = [rolling("cue", (-0.5, 0.0), (2.0, 0.0)), ball("1", (0.0, 0.0))]
    run = simulate(Setup(balls, plane=Cloth(rolling=0.0), duration=3.0, between_balls=of(1.0, 0.0)), resolve())
    assert run.state("cue", 3.0)[2] == pytest.approx(2 / 7 * 2.0, rel=1e-9)
    assert run.state("1", 3.0)[2] == pytest.approx(5 / 7 * 2.0, rel=1e-9)


def test_friction_between_balls_acts_against_the_whole_slip():
    """A rolling ball hits head-on with slip r w: friction mu J turns the object ball backward, and the cue ball too."""
    mu, v = 0.05, 2.0
    balls = [rolling("cue", (-2 * R - 1e-9, 0.0), (v, 0.0)), ball("1", (0.0, 0.0))]
    run = simulate(Setup(balls, plane=CLOTH, duration=1e-6, between_balls=of(1.0, mu)), resolve())
    turn = 2.5 * mu * v / R  # r mu J / I with J = m v
    assert run.rolling_spin("1", 1e-7)[1] == pytest.approx(-turn, rel=1e-4)
    assert run.rolling_spin("cue", 1e-7)[1] == pytest.approx(v / R - turn, rel=1e-4)


@settings(deadline=None, max_examples=60)
@given(
    st.floats(-0.9, 0.9),
    st.floats(0.3, 9.0),
    st.floats(-100.0, 100.0),
    st.floats(-100.0, 100.0),
    st.floats(0.0, 0.3),
    st.floats(0.5, 1.0),
)
def test_an_impact_conserves_momentum_and_never_gains_energy(cut, speed, side, draw, friction, restitution):
    y = cut * 2 * R
    x = -((4 * R * R - y * y) ** 0.5) - 1e-4
    balls = [ball("cue", (x, y), (speed, 0.0), side, (0.0, draw)), ball("1", (0.0, 0.0))]
    run = simulate(Setup(balls, plane=CLOTH, duration=1e-3, between_balls=of(restitution, friction)), resolve())
    event = next(event for event in run.events if event.kind == "impact")
    before = np.array([run.before(name, event.t)[2:4] for name in ("cue", "1")])
    after = np.array([run.state(name, event.t)[2:4] for name in ("cue", "1")])
    assert after.sum(axis=0) == pytest.approx(before.sum(axis=0), abs=1e-9)
    assert sum(ledger(run).impacts.values()) <= 1e-9


@pytest.mark.parametrize("friction", [0.0, 0.05, 0.2])
@pytest.mark.parametrize("restitution", [0.95, 1.0])
def test_three_balls_at_one_instant_gain_no_energy(friction, restitution):
    """Kane's paradox: with friction and full restitution they would, by 3 %."""
    side = 3**0.5 * R
    balls = [ball("cue", (-0.2, 0.0), (7.0, 0.0)), ball("1", (side, R + 5e-6)), ball("2", (side, -R - 5e-6))]
    setup = Setup(balls, duration=0.05, between_balls=of(restitution, friction), contact=RIGID)
    run = simulate(setup, resolve())
    assert len(run.events) == 2
    assert run.events[0].t == run.events[1].t
    book = ledger(run)
    assert sum(book.impacts.values()) <= 1e-6 * book.start
    assert book.end > 0.9 * book.start


@pytest.mark.parametrize("order", list(permutations(("cue", "1", "2"))))
def test_the_order_in_which_balls_are_listed_changes_nothing(order):
    """Side spin makes the slip, and with it the friction, another at each of two balls that are struck at once."""
    balls = {
        "cue": ball("cue", (-0.2, 0.0), (3.0, 0.0), 40.0),
        "1": ball("1", (0.0, 0.03)),
        "2": ball("2", (0.0, -0.03)),
    }
    law = lambda normal, slip: Bounce(0.95, 0.01 + 0.1 * exp(-slip))  # noqa: E731
    ends = []
    for names in (order, ("cue", "1", "2")):
        run = simulate(Setup([balls[n] for n in names], plane=CLOTH, duration=0.2, between_balls=law), resolve())
        ends.append([run.state(name, 0.2) for name in balls])
    assert np.allclose(ends[0], ends[1], atol=1e-7)


@pytest.mark.parametrize("drift", [1e-12, 1e-8, 1e-4])
@pytest.mark.parametrize("order", ["ABC", "CBA"])
def test_a_faint_touch_beside_a_hard_one_is_no_spring(order, drift):
    balls = {
        "A": rolling("A", (0.0, 0.0), (drift, 0.0)),
        "B": ball("B", (2 * R, 0.0)),
        "C": rolling("C", (4 * R, 0.0), (-5.0, 0.0)),
    }
    laws = {"between_balls": of(0.95, 0.05), "contact": RIGID}
    run = simulate(Setup([balls[name] for name in order], plane=CLOTH, duration=1.0, **laws), resolve())
    assert max(abs(run.state(name, 1e-9)[2]) for name in "ABC") < 5.0
    assert run.state("C", 1e-9)[2] == pytest.approx(1.5, abs=0.01)


@pytest.mark.parametrize("mutual", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("wall", [0.8, 1.0])
def test_a_light_ball_squeezed_on_a_wall_gains_no_energy(wall, mutual):
    light, heavy = Ball("light", 0.1, R, (0.0, R), (0.0, -2.0)), Ball("heavy", 10.0, R, (0.0, 3 * R), (0.0, -1.0))
    floor = Surface("floor", Segment((-1.0, 0.0), (1.0, 0.0)), wall, 0.0)
    book = ledger(simulate(Setup([light, heavy], [floor], duration=0.01, between_balls=of(mutual, 0.0)), resolve()))
    assert 0.1 * book.start < book.end <= (1 + 1e-6) * book.start
    assert abs(book.residue) < 1e-9


def test_a_slip_too_small_to_square_is_no_trouble():
    cloth = Cloth(sliding=2.7e-275)
    balls = [ball("cue", (-0.2, 0.0), (2.0, 0.0)), ball("1", (0.0, 0.0))]
    run = simulate(Setup(balls, plane=cloth, duration=0.5, between_balls=of(0.95, 0.05)), resolve())
    assert run.events[0].partner in ("1", "cue")


def test_a_rack_with_even_gaps_breaks_in_mirror_image():
    gap, rows = 2 * R + 1e-5, (1, 2, 3)
    balls = [ball("cue", (-0.6, 0.0), (8.0, 0.0))]
    balls += [
        ball(f"{row}{k}", (row * gap * 3**0.5 / 2, (k - (many - 1) / 2) * gap))
        for row, many in enumerate(rows)
        for k in range(many)
    ]
    run = simulate(Setup(balls, plane=CLOTH, duration=20.0, between_balls=of(0.95, 0.05)), resolve())
    for row, many in enumerate(rows):
        for k in range(many):
            x, y = run.state(f"{row}{k}", 1.0)[:2]
            u, v = run.state(f"{row}{many - 1 - k}", 1.0)[:2]
            assert (x, y) == pytest.approx((u, -v), abs=1e-9)
    assert run.state("cue", 20.0)[1] == pytest.approx(0.0, abs=1e-9)
    assert run.angle("cue", 1.0) == pytest.approx(0.0, abs=2 * pi * 1e-6)


NOSED = Surface("cushion", Segment((1.0, -2.0), (1.0, 2.0)), 0.88, 0.265, nose_height=1.2 * R)


def test_a_ball_that_a_high_nose_draws_on_parts_from_it():
    """Its spin rubs it upward on the nose, 77 deg above its centre, and so inward: more than restitution takes back."""
    high = replace(NOSED, friction=0.25, nose_height=1.9773 * R)
    start = ball("cue", (1.0 - 1.001 * R, 0.0), (1.48, -3.04), 44.07, (-99.5, -167.0))
    setup = Setup([start], [high], plane=CLOTH, duration=0.2)
    run = simulate(setup, resolve())
    assert run.state("cue", 1e-3).vx < 0.0
    energies = [kinetic(start, (*run.state("cue", t), *run.rolling_spin("cue", t))) for t in (0.0, 1e-3, 0.2)]
    assert energies == sorted(energies, reverse=True)


def test_a_ball_frozen_on_a_nose_leaves_as_one_with_a_gap():
    ends = []
    for gap in (0.0, 1e-7):
        balls = [ball("cue", (1.0 - R - gap - 0.2, -0.2), (1.0, 1.0)), ball("1", (1.0 - R - gap, 0.0))]
        run = simulate(Setup(balls, [NOSED], plane=CLOTH, duration=0.3, between_balls=of(0.95, 0.05)), resolve())
        ends.append(run.state("1", 0.3)[:4])
    assert ends[0] == pytest.approx(ends[1], abs=2e-3)
    assert ends[0][2] < -0.1
