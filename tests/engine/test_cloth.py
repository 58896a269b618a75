"""Balls on cloth in the engine: impacts in three dimensions of spin, pockets, pushes, and both methods."""

from dataclasses import replace
from itertools import pairwise, permutations
from math import exp, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sandbox.engine import simulate
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import LEVELS, resolve
from sandbox.engine.model.ball import Ball, kinetic
from sandbox.engine.model.setup import ContactModel, Setup
from sandbox.engine.model.surface import Bounce, Segment, Surface, Trap
from sandbox.engine.motion.on_plane import slowest_hop
from sandbox.physics.cloth import Cloth

R, M = 0.028575, 0.170097
CLOTH = Cloth()
RIGID = ContactModel("rigid")


def ball(name, position, velocity=(0.0, 0.0), spin=0.0, rolling_spin=(0.0, 0.0)):
    return Ball(name, M, R, position, velocity, spin, rolling_spin)


def rolling(name, position, velocity):
    return ball(name, position, velocity, 0.0, (-velocity[1] / R, velocity[0] / R))


def of(restitution, friction):
    return lambda normal, slip: Bounce(restitution, friction)


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


def test_a_steady_push_is_a_run_of_even_hops_and_ends():
    """Topspin drives a ball into another that leans on a cushion: it slides until the spin is used up."""
    wall = Surface("cushion", Segment((R, -1.0), (R, 1.0)), 0.85, 0.2)
    balls = [ball("a", (-2 * R - 1e-6, 0.0), (0.0, 0.0), 0.0, (0.0, 5.0)), ball("b", (-1e-6, 0.0))]
    for level in LEVELS:
        setup = Setup(balls, [wall], plane=CLOTH, duration=30.0, between_balls=of(0.95, 0.05))
        run = simulate(setup, resolve(level))
        assert run.ended == "rest"
        times = np.linspace(0.0, run.duration, 1_000)
        a, b = (np.array([run.state(name, t)[0] for t in times]) for name in ("a", "b"))
        assert b.max() <= 1e-9
        assert (b - a).min() >= 2 * R - 1e-9
        hop = 0.5 * 0.5 * M * slowest_hop(setup, resolve(level).hop) ** 2
        assert sum(ledger(run).impacts.values()) <= 10 * hop


def test_balls_that_touch_and_barely_close_roll_on():
    """All that a hop adds is taken back from both, and no more."""
    balls = [rolling("rear", (-2 * R, 0.0), (1.000001, 0.0)), rolling("front", (0.0, 0.0), (1.0, 0.0))]
    alone = simulate(Setup([balls[1]], plane=CLOTH, duration=0.5), resolve()).state("front", 0.5)[2]
    run = simulate(Setup(balls, plane=CLOTH, duration=0.5, between_balls=of(0.95, 0.0)), resolve())
    assert [run.state(name, 0.5)[2] for name in ("rear", "front")] == pytest.approx([alone, alone], abs=2e-3)
    assert sum(ledger(run).impacts.values()) == pytest.approx(0.0, abs=1e-9)


def test_two_touching_balls_that_barely_close_do_not_stall():
    two = ball("2", (0.6893302035592077, 0.07289367542804442), (-0.0009600413070669939, 0.024262999307600855), 0.0,
               (-0.8490988384112285, -0.03359724609158334))  # fmt: skip
    ten = ball("10", (0.7464355178687772, 0.07515322744563493))
    run = simulate(Setup([two, ten], plane=CLOTH, between_balls=of(0.95, 0.05)), resolve())
    assert run.ended == "rest"


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


def test_the_end_of_side_spin_changes_no_path():
    """Into a ball that rolls, too, one at rest, a cushion and a pocket; with smooth ones spin changes nothing else."""
    places = {"cue": (0.0, 0.0), "1": (0.6, 0.03), "2": (0.9, 0.01)}
    speeds = {"cue": (1.0, 0.0), "1": (0.3, 0.0), "2": (0.0, 0.0)}
    wall = Surface("cushion", Segment((1.2, -1.0), (1.2, 1.0)), 0.8, 0.0)
    runs = []
    for spin in (0.0, 4.0):  # rad/s, which ends after 0.4 s
        balls = [replace(rolling(name, places[name], speeds[name]), spin=spin) for name in places]
        traps = [Trap("pocket", (0.5, 0.35), 0.06)]
        setup = Setup(balls, [wall], plane=CLOTH, traps=traps, between_balls=of(0.95, 0.0))
        runs.append(simulate(setup, resolve()))
    plain, spun = ([(e.kind, e.ball, e.partner) for e in run.events] for run in runs)
    assert [e for e in spun if e[0] != "rest"] == [e for e in plain if e[0] != "rest"]
    assert {"impact", "rest"} <= {kind for kind, *_ in plain}
    for name in places:
        assert runs[1].state(name, runs[1].duration) == pytest.approx(runs[0].state(name, runs[1].duration), abs=1e-9)
        assert [arc.start[4] for arc in runs[1].arcs[name]].count(0.0) > 0
        assert all(one.t1 == other.t0 for one, other in pairwise(runs[1].arcs[name]))
    assert runs[1].duration == pytest.approx(runs[0].duration, abs=1e-9)


def test_a_pocket_catches_a_ball_and_the_run_ends_at_rest():
    setup = Setup([rolling("cue", (0.0, 0.0), (1.0, 0.0))], plane=CLOTH, traps=[Trap("pocket", (0.5, 0.0), 0.06)])
    run = simulate(setup, resolve())
    (event,) = [event for event in run.events if event.kind == "caught"]
    assert (event.partner, event.x) == ("pocket", pytest.approx(0.44, abs=1e-9))
    assert run.caught_at("cue") == event.t == run.duration
    assert run.ended == "rest"


def test_plain_slides_rolls_and_catches_too():
    """First order: the same within a millimetre at 10,000 steps a second."""
    balls = [ball("cue", (0.0, 0.0), (2.0, 0.0)), ball("1", (0.4, 0.01))]
    setup = Setup(balls, plane=CLOTH, traps=[Trap("pocket", (0.9, 0.09), 0.06)], between_balls=of(0.95, 0.0))
    exact = simulate(setup, resolve())
    plain = simulate(setup, resolve(method="plain", step=1e-4))
    assert [event.ball for event in plain.events if event.kind == "caught"] == ["1"]
    assert exact.caught_at("1") == pytest.approx(plain.caught_at("1"), abs=0.01)
    assert plain.ended == "rest"
    assert plain.state("cue", 99.0)[:2] == pytest.approx(exact.state("cue", 99.0)[:2], abs=5e-3)
    assert len(plain.rolling_spin("cue", 0.1)) == 2


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


@pytest.mark.parametrize("gravity", [9.81, 30.0])
@pytest.mark.parametrize("level", ["fast", "balanced"])
@pytest.mark.parametrize("speed", [1e-4, 1e-3, 0.01])
def test_a_ball_that_creeps_to_a_cushion_gains_no_energy(speed: float, level: str, gravity: float):
    """Slower than the slowest hop, rolling and sliding: pressed or not, there is never more energy than before."""
    wall = Surface("wall", Segment((0.0, -1.0), (0.0, 1.0)), 0.85, 0.2)
    for wy in (speed / R, 0.0, 20.0):  # rolls, slides, spins into the cushion
        start = Ball("ball", M, R, (-R - 1e-9, 0.0), (speed, 0.1 * speed), 0.0, (0.0, wy))
        run = simulate(Setup([start], [wall], duration=5.0, plane=Cloth(gravity=gravity)), resolve(level))
        energies = [kinetic(start, run.arcs["ball"][0].start)]
        for arc in run.arcs["ball"]:
            energies += [kinetic(start, arc.start), kinetic(start, arc.state(arc.t1))]
        assert any(event.kind == "impact" for event in run.events)
        assert all(after <= before * (1.0 + 1e-9) for before, after in pairwise(energies))


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
