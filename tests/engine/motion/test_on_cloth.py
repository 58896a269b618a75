"""Balls that slide, roll and spin on cloth, push on one another, and drop into pockets; by both methods."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import LEVELS, resolve
from sandbox.engine.model.ball import Ball, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface, Trap
from sandbox.engine.motion.on_plane import slowest_hop
from sandbox.physics.cloth import Cloth
from tests.engine.on_cloth import CLOTH, M, R, ball, of, rolling


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
    """First order: the same within 5 mm at 2,500 steps a second."""
    balls = [ball("cue", (0.0, 0.0), (2.0, 0.0)), ball("1", (0.4, 0.01))]
    setup = Setup(balls, plane=CLOTH, traps=[Trap("pocket", (0.9, 0.09), 0.06)], between_balls=of(0.95, 0.0))
    exact = simulate(setup, resolve())
    plain = simulate(setup, resolve(method="plain", step=4e-4))
    assert [event.ball for event in plain.events if event.kind == "caught"] == ["1"]
    assert exact.caught_at("1") == pytest.approx(plain.caught_at("1"), abs=0.01)
    assert plain.ended == "rest"
    assert plain.state("cue", plain.duration)[:2] == pytest.approx(exact.state("cue", exact.duration)[:2], abs=5e-3)
    assert len(plain.rolling_spin("cue", 0.1)) == 2


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
