"""The run record: samples, crossings, angles, phases and events."""

import sys
from dataclasses import asdict, replace
from math import cos, pi, sin, sqrt

import numpy as np
import pytest

from sandbox.engine import simulate, simulation
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.engine.motion.forces_on_ball import acceleration_function
from sandbox.engine.paths.arc import hermite_arc
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Numerics
from sandbox.physics.cloth import Cloth
from sandbox.physics.forces import Gravity

G = 9.81


@pytest.mark.parametrize("every", [1 / 50, 1 / 120, 0.07])
def test_rows_of_a_trajectory_are_even(bouncing, every):
    path = bouncing.trajectory("ball", every=every)
    assert np.diff(path[:, 0]) == pytest.approx(every, rel=1e-9)
    assert path[0, 0] == 0.0
    assert bouncing.duration - every < path[-1, 0] <= bouncing.duration
    assert path[7, 1:].tolist() == list(bouncing.state("ball", 7 * every))


def test_trajectory_meets_every_impact_where_that_is_asked(bouncing):
    path = bouncing.trajectory("ball", every=1 / 50, ends=True)
    assert path.shape[1] == 6
    assert path[0] == pytest.approx([0.0, 0.0, 1.0, 6.0, 3.0, 20.0])
    assert (np.diff(path[:, 0]) > 0).all()
    assert path[-1, 0] == bouncing.duration
    assert np.diff(path[:, 0]).max() <= 1 / 50 + 1e-12
    impacts = [event.t for event in bouncing.events if event.kind == "impact"]
    assert set(impacts) <= set(path[:, 0])


def test_a_run_that_ends_with_an_impact_ends_with_its_outcome():
    floor = Surface("floor", Segment((-1.0, 0.0), (1.0, 0.0)), 0.6, 0.0)
    ball = Ball("ball", 0.2, 0.05, (0.0, 0.55), forces=[Gravity(G, 0.2)])
    run = simulate(Setup([ball], [floor], until=lambda event: event.kind == "impact"), resolve())
    assert run.state("ball", run.duration)[3] == pytest.approx(0.6 * sqrt(2 * G * 0.5), abs=1e-6)


def test_state_is_after_an_impact_and_before_is_before_it(bouncing):
    event = next(event for event in bouncing.events if event.kind == "impact")
    before, after = bouncing.before("ball", event.t), bouncing.state("ball", event.t)
    assert -before[3] == pytest.approx(event.speed, abs=1e-12)
    assert after[3] == pytest.approx(0.6 * event.speed, abs=1e-9)
    assert before[:2] == pytest.approx(after[:2], abs=1e-9)
    assert (event.x, event.y) == pytest.approx(after[:2], abs=1e-9)


def test_states_before_and_after_agree_for_a_rolling_ball():
    rolling = Ball("ball", 0.17, 0.028, (0.0, 0.0), (1.0, 0.0), 2.0, (0.0, 1.0 / 0.028))
    run = simulate(Setup([rolling], duration=1.0, plane=Cloth()), resolve())
    assert run.before("ball", 0.5) == run.state("ball", 0.5)


def test_velocity_is_the_slope_of_the_position(bouncing):
    for t in (0.1, 0.33, 0.71, 1.5):
        early, late = bouncing.state("ball", t - 1e-6), bouncing.state("ball", t + 1e-6)
        assert (late[0] - early[0]) / 2e-6 == pytest.approx(bouncing.state("ball", t)[2], abs=1e-6)
        assert (late[1] - early[1]) / 2e-6 == pytest.approx(bouncing.state("ball", t)[3], abs=1e-6)


def test_acceleration_along_an_arc_is_that_by_the_forces(bouncing):
    (ball,), arcs = bouncing.setup.balls, bouncing.arcs["ball"]
    for t in (0.1, 0.33, 0.71, 1.5):
        ax, ay, _ = acceleration_function(ball)(t, bouncing.state("ball", t))
        assert arcs.at(t).acceleration(t) == pytest.approx((ax, ay), abs=1e-5)


def test_angle_is_the_integral_of_the_spin(bouncing):
    t = np.linspace(0.0, 2.0, 20001)
    spins = np.array([bouncing.state("ball", x)[4] for x in t])
    assert bouncing.angle("ball", 2.0) == pytest.approx(np.trapezoid(spins, t), abs=1e-2)


def test_crossings_are_exact_and_one_sided():
    """A parabola meets the height h on its way down at v/g + sqrt((v/g)^2 - 2h/g)."""
    ball = Ball("ball", 0.2, 0.05, (0.0, 0.0), (1.0, 8.0), forces=[Gravity(G, 0.2)])
    run = simulate(Setup([ball], duration=3.0), resolve())
    ((down, _),) = run.crossings("ball", (0.0, 2.0), (0.0, 1.0))
    ((up, _),) = run.crossings("ball", (0.0, 2.0), (0.0, -1.0))
    assert down == pytest.approx(8 / G + sqrt((8 / G) ** 2 - 4 / G), abs=1e-9)
    assert up == pytest.approx(8 / G - sqrt((8 / G) ** 2 - 4 / G), abs=1e-9)
    assert run.highest("ball")[1][1] == pytest.approx(64 / (2 * G), abs=1e-9)


def test_an_arc_tells_its_phase_and_its_surface(bouncing):
    phases = [arc.phase for arc in bouncing.arcs["ball"]]
    assert [*dict.fromkeys(phases)] == [Phase.FREE, Phase.ROLLING]
    assert all((arc.surface is not None) == (arc.phase is not Phase.FREE) for arc in bouncing.arcs["ball"])
    assert {arc.surface.name for arc in bouncing.arcs["ball"] if arc.surface} == {"floor"}


def test_arcs_in_a_cluster_tell_when_the_contact_begins_and_ends():
    balls = [Ball("cue", 0.17, 0.03, (-0.06, 0.0), (1.0, 0.0)), Ball("1", 0.17, 0.03, (0.0, 0.0)),
             Ball("2", 0.17, 0.03, (0.06, 0.0))]  # fmt: skip
    run = simulate(Setup(balls, duration=0.1), resolve())
    pressed = [arc for path in run.arcs.values() for arc in path if arc.phase is Phase.CLUSTER]
    assert len({arc.contact_span for arc in pressed}) == 1
    start, end = pressed[0].contact_span
    assert start == run.events[0].t < end < start + 1e-3
    assert all(arc.drift == (0.0, 0.0) and arc.surface is None for arc in pressed)


def test_a_turn_is_two_pi():
    ball = Ball("ball", 0.2, 0.05, (0.0, 0.0), spin=2 * pi)
    run = simulate(Setup([ball], duration=3.0), resolve())
    assert run.angle("ball", 1.5) == pytest.approx(3 * pi, abs=1e-12)


def test_a_ball_that_still_rises_is_highest_at_the_end():
    rising = Ball("ball", 0.2, 0.05, (0.0, 1.0), (0.0, 10.0), forces=[Gravity(G, 0.2)])
    run = simulate(Setup([rising], duration=0.5), resolve())
    t, state = run.highest("ball")
    assert (t, state) == (0.5, run.state("ball", 0.5))
    assert state[1] == pytest.approx(1.0 + 5.0 - 0.5 * G * 0.25)


@pytest.mark.parametrize("h", [1e-12, 1e-9, 1e-6])
def test_the_velocity_within_a_very_short_arc_is_not_rounding(h: float):
    """Far from the origin (x1 - x0) / h has no digits left."""
    start, end = (1000.0, 0.0, 3.0, 4.0, 0.0), (1000.0 + 3.0 * h, 4.0 * h, 3.0, 4.0, 0.0)
    arc = hermite_arc(5.0, h, start, (0.0, 0.0, 0.0), end, (0.0, 0.0, 0.0))
    assert arc.state(5.0 + 0.5 * (arc.t1 - 5.0))[2:4] == pytest.approx((3.0, 4.0), abs=1e-9)


def test_spin_is_followed_where_nothing_else_changes():
    """A torque that swings, alpha = 600 sin(60 t), turns the ball by w = 10 (1 - cos 60 t)."""
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.0))
    swinging = replace(ball, torques=[lambda t, position, velocity, spin: 600.0 * ball.inertia * sin(60.0 * t)])
    run = simulate(Setup([swinging], duration=1.0), resolve())
    for t in (0.25, 0.7, 1.0):
        assert run.state("ball", t)[4] == pytest.approx(10.0 * (1.0 - cos(60.0 * t)), abs=0.02)


def test_a_ball_that_nothing_moves_costs_one_step_and_no_more():
    run = simulate(Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0))], duration=0.01), resolve())
    assert replace(run.numerics, wall_s=0.0) == Numerics(force_evaluations=7, steps=1)
    assert set(asdict(Numerics()).values()) == {0}


def test_imports_are_no_part_of_a_runs_computing_time(monkeypatch: pytest.MonkeyPatch):
    """Modules that only some runs need are imported on the way, by the first of them."""
    clock = [0.0]

    class Slow:
        def find_spec(self, *args: object) -> None:
            clock[0] += 100.0

    monkeypatch.setattr(simulation, "perf_counter", lambda: clock[0])
    monkeypatch.delitem(sys.modules, "sandbox.engine.impact.cluster_search", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Slow(), *sys.meta_path])
    balls = [Ball(name, 1.0, 0.1, (x, 0.0), (v, 0.0)) for name, x, v in (("a", 0.0, 1.0), ("b", 1.0, 0.0))]
    assert simulate(Setup(balls, duration=2.0), resolve()).numerics.wall_s == 0.0
    assert clock[0] >= 100.0


def test_the_place_on_an_arc_is_that_of_its_state():
    arc = hermite_arc(1.0, 0.5, (0.0, 2.0, 3.0, 4.0, 5.0), (0.0, -G, 0.0), (1.5, 3.0, 3.0, -1.0, 5.0), (0.0, -G, 0.0))
    for t in (1.0, 1.1, 1.37, 1.5):
        assert arc.position(t) == pytest.approx(arc.state(t)[:2])
    assert (arc.position(0.0), arc.position(9.0)) == (arc.state(1.0)[:2], arc.state(1.5)[:2])


def test_closing_speed_is_that_of_the_two_in_any_direction():
    """It slides at 3 m/s and falls at 4 m/s onto a floor; it meets another ball that comes at 2 m/s."""
    floor = Surface("floor", Segment((-100.0, 0.0), (100.0, 0.0)), restitution=0.8, friction=0.0)
    ball = Ball("ball", 1.0, 0.1, (0.0, 4.1), (3.0, -4.0))
    run = simulate(Setup([ball], [floor], duration=1.5), resolve())
    assert run.closing_speed(run.events[0]) == pytest.approx(5.0)
    assert run.events[0].speed == pytest.approx(4.0)
    coming = Ball("other", 1.0, 0.1, (5.0, 0.0), (-2.0, 0.0))
    run = simulate(Setup([replace(ball, position=(0.0, 0.0), velocity=(3.0, 0.0)), coming]), resolve())
    assert run.closing_speed(run.events[0]) == pytest.approx(5.0)
