"""The run record: samples, crossings, angles, events, and the energy ledger."""

import re
import sys
from dataclasses import asdict, replace
from math import cos, pi, sin, sqrt

import numpy as np
import pytest

import sandbox
from sandbox.engine import ledger as ledgers
from sandbox.engine import simulate, simulation
from sandbox.engine.ledger import ledger, warnings
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, Segment, Surface
from sandbox.engine.motion.forces_on_ball import acceleration_function
from sandbox.engine.paths.arc import hermite_arc
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Numerics
from sandbox.physics.cloth import Cloth
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
from tests.engine import shots

G = 9.81


@pytest.fixture(scope="module")
def bouncing():
    floor = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.6, 0.4, 0.05)
    inertia = 0.4 * 0.2 * 0.05**2
    forces = [Gravity(G, 0.2), Drag(0.05, 1.2, Constant(0.4)), Magnus(0.05, 1.2, Constant(0.2))]
    ball = Ball("ball", 0.2, 0.05, (0.0, 1.0), (6.0, 3.0), 20.0, forces=forces,
                torques=[SpinDecay(inertia, 0.05, 1e-3)])  # fmt: skip
    return simulate(Setup([ball], [floor], duration=30.0), resolve("precise"))


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


def test_ledger_closes_and_names_every_cause(bouncing):
    book = ledger(bouncing)
    assert set(book.work) == {"gravity", "drag", "lift", "spin decay"}
    assert set(book.impacts) == {"floor"}
    assert set(book.contacts) == {"floor"}
    causes = sum(book.work.values()) + sum(book.impacts.values()) + sum(book.contacts.values())
    assert book.start + causes + book.residue == pytest.approx(book.end, abs=1e-12)
    assert book.start == pytest.approx(0.5 * 0.2 * 45.0 + 0.5 * 0.4 * 0.2 * 0.05**2 * 400.0)
    assert book.work["gravity"] == pytest.approx(0.2 * G * 0.95, abs=1e-6)
    assert book.work["lift"] == pytest.approx(0.0, abs=1e-12)
    assert max(book.work["drag"], book.impacts["floor"], book.contacts["floor"]) < 0
    assert abs(book.residue) < 1e-6


def test_residue_of_the_ledger_shrinks_with_the_tolerance():
    shot = shots.seeded(3)[2]
    residues = [abs(ledger(simulate(shots.setup(*shot, 2.5), resolve(level))).residue) for level in ("fast", "precise")]
    assert residues[1] < 0.05 * residues[0]


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


def test_a_turn_is_two_pi():
    ball = Ball("ball", 0.2, 0.05, (0.0, 0.0), spin=2 * pi)
    run = simulate(Setup([ball], duration=3.0), resolve())
    assert run.angle("ball", 1.5) == pytest.approx(3 * pi, abs=1e-12)


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
        for step in (1 / 1000, 1 / 16000)
    ]
    assert errors[1] < 2e-3
    assert errors[1] < 0.2 * errors[0]


def test_the_ledger_books_touching_balls_under_one_impact():
    """Of three balls in touch only the first has an approach of its own; the energy of the others is no residue."""
    balls = [Ball(f"{k}", 0.2, 0.05, (0.1 * k, 0.0)) for k in range(3)]
    balls.append(Ball("cue", 0.2, 0.05, (-1.0, 0.0), (2.0, 0.0)))
    book = ledger(simulate(Setup(balls, duration=1.0), resolve()))
    assert abs(book.residue) < 1e-9
    assert sum(book.impacts.values()) <= 1e-12


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_what_the_last_impact_did_is_in_the_path(restitution):
    """A ball that falls on soft ground rests there, and one that is stopped at its landing has bounced."""
    floor = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), restitution, 0.4)
    ball = Ball("ball", 0.2, 0.05, (0.0, 1.05), forces=[Gravity(G, 0.2)])
    landed = lambda event: event.kind == "impact"  # noqa: E731
    run = simulate(Setup([ball], [floor], duration=5.0, until=landed), resolve())
    speed = (2 * G) ** 0.5
    assert run.before("ball", run.duration)[3] == pytest.approx(-speed, rel=1e-6)
    assert run.state("ball", run.duration)[3] == pytest.approx(restitution * speed, abs=1e-6)
    book = ledger(run)
    assert book.end == pytest.approx(0.5 * 0.2 * (restitution * speed) ** 2, abs=1e-6)
    assert abs(book.residue) < 1e-6


def test_energy_from_nowhere_is_said():
    """Euler's steps carry a light ball, whose drag is strong, further than the drag allows."""
    light = {"ball.mass": 1e-4, "accuracy.integrator": "explicit-euler"}
    (warning,) = warnings(sandbox.simulate(sandbox.load("golf", light)))
    assert re.match(r"0\.08\d+ J appeared by the error of explicit-euler with steps of 0.00417 s", warning)
    assert warnings(sandbox.simulate(sandbox.load("golf", {"accuracy.integrator": "rk4"}))) == []


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


def test_the_ledgers_quadrature_is_exact_up_to_degree_nine():
    """Its weights are those of Gauss and Legendre on [0, 1]: the integral of x^n is 1 / (n + 1)."""
    for degree in range(10):
        total = sum(weight * node**degree for node, weight in zip(ledgers._NODES, ledgers._WEIGHTS, strict=True))
        assert total == pytest.approx(1.0 / (degree + 1), rel=1e-13)
