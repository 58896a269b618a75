"""Runs in which balls are struck that others touch: who takes part, what comes out, and that walls wait their turn."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, degrees, radians, sin, sqrt
from traceback import extract_stack

import numpy as np
import pytest

from sandbox.engine import simulate, simulate_many
from sandbox.engine.impact.cluster_forces import ClusterForces
from sandbox.engine.impact.cluster_parts import ClusterBall
from sandbox.engine.impact.cluster_search import ClusterSearch
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import ContactModel, Setup
from sandbox.engine.model.surface import Bounce, Circle, ConstantBounce, Segment, Surface, Trap
from sandbox.engine.paths.run import Run
from sandbox.errors import RunError
from tests.engine.contact_law import by_contact_law

R, M = 0.028575, 0.170097  # of pool balls: m, kg


def ball(name, x, y=0.0, vx=0.0, vy=0.0):
    return Ball(name, M, R, (x, y), (vx, vy))


def struck(balls, surfaces=(), model="auto", restitution=1.0, friction=0.0, duration=1.0):
    between = ConstantBounce(Bounce(restitution, friction))
    setup = Setup(balls, surfaces, duration=duration, between_balls=between, contact=ContactModel(model))
    return simulate(setup, resolve())


@pytest.mark.parametrize(
    ("model", "expected"),
    [("auto", (-0.071, 0.0764, 0.9945)), ("hertz", (-0.071, 0.0764, 0.9945)), ("rigid", (-1 / 3, 2 / 3, 2 / 3))],
)
def test_two_balls_that_touch_share_the_blow(model, expected):
    """By Hertz's law, or as one lump."""
    run = struck([ball("cue", -0.5, vx=2.0), ball("1", 0.0), ball("2", 2 * R)], model=model)
    assert [run.state(name, 1.0)[2] / 2.0 for name in ("cue", "1", "2")] == pytest.approx(expected, abs=1e-4)
    assert (run.numerics.clusters == 0) == (model == "rigid")
    assert abs(ledger(run).residue) < 1e-9


def test_energy_from_nothing_in_a_cluster_ends_the_run(monkeypatch: pytest.MonkeyPatch):
    """As if balls pushed one another twice as hard while they separate."""
    evaluate = ClusterForces.evaluate

    def livelier(forces: ClusterForces, state: np.ndarray, rates: np.ndarray) -> np.ndarray:
        elastic = evaluate(forces, state, rates)
        rates[1] *= 2.0 if forces.closing.sum() < 0.0 else 1.0
        return elastic

    monkeypatch.setattr(ClusterForces, "evaluate", livelier)
    with pytest.raises(RunError, match=r"^t = 0\.\d+ s: \S+ J appeared from nothing in the contact of '1', '2', 'cue'"):
        struck([ball("cue", -0.5, vx=2.0), ball("1", 0.0), ball("2", 2 * R)])


@pytest.mark.parametrize("ends", [SystemExit(0), GeneratorExit(), ZeroDivisionError("of the scene"), StopIteration()])
def test_what_a_law_raises_in_a_cluster_fails_its_run(ends: BaseException):
    """And ends neither the program nor the other runs."""
    setup = racked(raising_in_a_cluster(ends))
    failed, other, _ = simulate_many([setup, racked(ConstantBounce(Bounce(0.95, 0.05))), setup], resolve())
    assert isinstance(failed, Exception)
    assert type(ends).__name__ in repr(failed)
    assert isinstance(other, Run)


def racked(law):
    return Setup([ball("cue", -0.5, vx=2.0), ball("1", 0.0), ball("2", 2 * R)], duration=1.0, between_balls=law)


def raising_in_a_cluster(ends):
    def law(normal_speed, slip_speed):
        if any(call.name == "pass_through" for call in extract_stack()):
            raise ends
        return Bounce(0.95, 0.05)

    return law


@pytest.mark.parametrize(("pocket", "duration"), [(0.02, 1.0), (0.02, 0.07), (0.3, 1.0)])
def test_a_pocket_takes_a_ball_while_others_press_on_it(pocket, duration):
    """Soft balls touch for 76 ms, in which the one struck moves by 3.8 cm: in a pocket it is gone before they part."""
    balls, traps = [ball("cue", -2 * R, vx=1.0), ball("1", 0.0)], [Trap("pocket", (pocket, 0.0), 0.001)]
    run = simulate(Setup(balls, traps=traps, duration=duration, contact=ContactModel("hertz", 1000.0)), resolve())
    t = run.caught_at("1")
    (caught,) = [event for event in run.events if event.kind == "caught"]
    assert caught.x == run.state("1", duration)[0] == pytest.approx(pocket - 0.001, abs=1e-9)
    assert run.arcs["1"][-1].t1 == t < duration
    assert run.state("cue", duration)[0] > run.state("cue", 0.5 * t)[0]


def test_a_lone_pair_takes_no_contact_mechanics():
    run = struck([ball("cue", -0.5, vx=2.0), ball("1", 0.0), ball("far", 1.0, 0.5)])
    assert run.numerics.clusters == 0
    assert run.state("1", 1.0)[2] == pytest.approx(2.0)


def test_two_that_part_before_they_reach_a_wall_meet_by_impulse(monkeypatch: pytest.MonkeyPatch):
    """A light ball between a wall and one 1e4 times as heavy, Galperin's 314 impacts: none takes contact mechanics."""
    monkeypatch.setattr(ClusterSearch, "_simulate", None)
    balls = [Ball("light", 1.0, 0.1, (1.0, 0.0)), Ball("heavy", 1e4, 0.1, (2.0, 0.0), (-1.0, 0.0))]
    run = simulate(Setup(balls, [Surface("wall", Segment((0.0, -5.0), (0.0, 5.0)), 1.0, 0.0)], 100.0), resolve())
    assert run.numerics.impacts == 314


@pytest.mark.parametrize(("gap", "through"), [(0.18e-3, True), (0.21e-3, False)])
def test_a_third_ball_counts_if_it_is_reached_during_the_contact(gap, through):
    """Pool balls at 1 m/s touch for 390 us, in which the one struck moves by 0.195 mm."""
    run = struck([ball("cue", -0.5, vx=1.0), ball("1", 0.0), ball("2", 2 * R + gap)])
    assert bool(run.numerics.clusters) is through
    first, second = run.events[:2]
    assert ({first.ball, first.partner}, {second.ball, second.partner}) == ({"cue", "1"}, {"1", "2"})
    assert 0.0 < second.t - first.t < 3.0 * gap


def test_a_ball_that_grazes_one_of_two_leaves_them_less_and_less():
    """It has passed by before they are pressed together; they then part slowly."""
    left = []
    for sine in (0.02, 0.01, 0.005, 0.002):
        cue = ball("cue", -0.1, 2 * R * sqrt(1 - sine**2), vx=7.7)
        left.append(struck([cue, ball("1", 0.0), ball("2", 0.0, -2 * R)], restitution=0.95).state("2", 0.1)[3] / sine)
    assert left == sorted(left)
    assert abs(left[-1]) < 0.01 * abs(left[0])


def test_a_gap_that_a_contact_does_not_notice_changes_nothing():
    """A frozen combination, struck at 30 deg to the line of the two: alike with no gap, and with one of 0.1 um."""
    turn = radians(30.0)
    ways = []
    for gap in (0.0, 1e-7):
        cue = ball("cue", -0.3 * cos(turn), -0.3 * sin(turn), 2 * cos(turn), 2 * sin(turn))
        ways.append(struck([cue, ball("1", 0.0), ball("2", 2 * R + gap)], duration=0.5).state("1", 0.5)[2:4])
    assert degrees(atan2(*ways[0][::-1])) == pytest.approx(degrees(atan2(*ways[1][::-1])), abs=0.1)


def test_the_path_within_a_contact_is_that_of_the_bodies():
    """Soft balls of odd masses, pressed together for 0.2 s, without loss: energy and places at every time."""
    masses, stiffness = (0.163, 7.5157, 0.12835, 0.34324), 53173.7
    places = (-5.01, 0.0, 2.000000000002, 4.000000000004)
    balls = [
        Ball(str(i), mass, 1.0, (x, 0.0), (0.0 if i else 3.0, 0.0))
        for i, (mass, x) in enumerate(zip(masses, places, strict=True))
    ]
    setup = Setup(
        balls, duration=2.0, between_balls=ConstantBounce(Bounce(1.0, 1.0)), contact=ContactModel("auto", stiffness)
    )
    run = simulate(setup, resolve())
    start = next(arc.contact.start for arc in run.arcs["1"] if arc.contact)
    times = np.linspace(0.0, 1.5 - start, 300)
    bodies = [
        ClusterBall(each.mass, 1.0, 1.0, run.before(each.name, start)[:2], each.velocity, (0.0,) * 3) for each in balls
    ]
    expected = by_contact_law(bodies, times, stiffness, accuracy=1e-12)
    found = np.array([run.states(each.name, start + times) for each in balls]).swapaxes(0, 1)
    had, depth = 0.5 * masses[0] * 3.0**2, 0.05
    moving = 0.5 * (masses * found[:, :, 2] ** 2).sum(axis=1)
    pressed = 0.4 * stiffness * (np.maximum(2.0 - np.diff(found[:, :, 0]), 0.0) ** 2.5).sum(axis=1)
    assert moving.max() <= had * (1 + 1e-4)
    assert moving[1:-1].min() < 0.9 * had
    assert moving + pressed == pytest.approx(had, rel=1e-3)
    assert np.abs(found[:, :, 0] - expected[:, :, 0]).max() < 1e-3 * depth


def test_what_else_acts_during_a_contact_is_not_forgotten():
    """a = k t upward, so v = k t^2 / 2, while two of three go through a contact of 0.9 ms half way through a step."""
    k, t = 1e3, 0.4  # m/s^3, s
    lifted = [
        replace(each, forces=[lambda t, position, velocity, spin: (0.0, M * k * t)])
        for each in (ball("cue", -0.5, vx=2.0), ball("1", 0.0), ball("2", 2 * R))
    ]
    setup = Setup(lifted, duration=t, contact=ContactModel("hertz", 1e8))
    run = simulate(setup, resolve())
    assert run.numerics.clusters == 1
    for name in ("cue", "1", "2"):
        assert run.state(name, t)[3] == pytest.approx(0.5 * k * t**2, abs=2e-3)


def test_a_wall_in_a_cluster_is_met_at_its_own_speed():
    """A cue ball that strikes another and a slanting wall at once, at 2 m/s into it and 1 m/s along it."""
    met = []
    nx, ny = 0.6, 0.8

    def law(approach, along):
        met.append((approach, along))
        return Bounce(0.9, 0.0)

    wall = Surface("wall", Circle((-5 * nx, -5 * ny), 5.0), 0.9, 0.0, law=law)
    vx, vy = -2.0 * nx + ny, -2.0 * ny - nx
    here = (R * nx - 0.1 * vx, R * ny - 0.1 * vy)
    there = (R * nx + 2 * R * ny, R * ny - 2 * R * nx)
    setup = Setup([ball("cue", *here, vx, vy), ball("1", *there)], [wall], duration=0.2,
                  contact=ContactModel("hertz", wall_stiffness=1e9))  # fmt: skip
    run = simulate(setup, resolve())
    assert run.numerics.clusters == 1
    assert met
    assert {round(approach, 6) for approach, _ in met} <= {2.0, 0.0}
    assert {round(along, 6) for _, along in met} <= {1.0, 0.0}


def test_soft_balls_do_not_pass_through_a_light_one_between_them():
    """Between 100 and 1.42 kg at 50 m/s one of 24 g would be pressed in by its radius, however fast it is struck."""
    sizes, masses, places = (0.9161, 0.3847, 0.0692), (100.0, 0.024, 1.42), (0.0, 1.8008, 2.2553)
    rows = zip("abc", masses, sizes, places, strict=True)
    balls = [Ball(name, mass, size, (x, 0.0), (50.0 * (name == "a"), 0.0)) for name, mass, size, x in rows]
    setup = Setup(
        balls, duration=0.5, between_balls=ConstantBounce(Bounce(0.9, 1.0)), contact=ContactModel("hertz", 1.08e4)
    )
    run = simulate(setup, resolve())
    times = np.linspace(0.0, 0.5, 500)
    gaps = np.diff([run.states(name, times)[:, 0] for name in "abc"], axis=0)
    assert (gaps > [[sizes[0]], [sizes[1]]]).all()
    assert ledger(run).end < ledger(run).start


@pytest.mark.parametrize(("gap", "friction"), [(0.0, 0.0), (1e-10, 0.0), (0.0, 0.1), (0.0, 0.3)])
def test_a_ball_frozen_on_a_rail_bounces_off_it(gap, friction):
    """Cut at 45 deg into a rail with e = 0.85: it leaves at atan(0.85) = 40.4 deg, as the rail waits for the balls.

    With friction it has 1 - mu (1 + e) of its speed along the rail, or 5/7 where it grips: it comes back on the other.
    """
    rail = Surface("rail", Segment((-5.0, R + gap), (5.0, R + gap)), 0.85, friction)
    turn = radians(45.0)
    cue = ball("cue", -0.3 * cos(turn), -0.3 * sin(turn), 2 * cos(turn), 2 * sin(turn))
    run = struck([cue, ball("1", 0.0)], [rail], duration=0.4)
    vx, vy = run.state("1", 0.4)[2:4]
    along = max(1.0 - 1.85 * friction, 5 / 7)
    met = [("cue", 2.0), ("rail", sqrt(2.0)), *([("cue", 0.85 - along)] if friction else [])]
    assert [event.partner for event in run.events] == [name for name, _ in met]
    assert [event.speed for event in run.events] == pytest.approx([speed for _, speed in met], rel=1e-6)
    assert degrees(atan2(vy, vx)) == pytest.approx(-45.0 if friction else -40.4, abs=0.1)


def test_three_on_a_rail_wait_for_the_balls_to_part():
    """A rail behind a chain: the balls share the blow first, the rail pushes back afterwards; no energy comes in."""
    rail = Surface("rail", Segment((5 * R, -1.0), (5 * R, 1.0)), 0.9, 0.0)
    balls = [ball("cue", -0.4, vx=2.0), ball("1", 0.0), ball("2", 2 * R), ball("3", 4 * R)]
    run = struck(balls, [rail], restitution=0.95, duration=0.6)
    assert max(run.state("3", 0.6)[0] + R - 5 * R, 0.0) < 1e-6
    book = ledger(run)
    assert book.end < book.start
    assert abs(book.residue) < 1e-9


def test_a_ball_arriving_during_a_cluster_joins_it():
    """Two touch for 30 ms; a third arrives after 15: the three part as the one law says, not as two pairs."""
    late = ball("late", 2 * R + 0.035, vx=-1.0)
    model = ContactModel("auto", 1e4)
    setup = Setup([ball("cue", -2 * R, vx=1.0), ball("1", 0.0), late], duration=0.3, contact=model)
    run = simulate(setup, resolve())
    assert run.numerics.clusters == 1
    speeds = [run.state(name, 0.3)[2] for name in ("cue", "1", "late")]
    assert sum(speeds) == pytest.approx(0.0, abs=1e-9)
    assert sum(speed**2 for speed in speeds) == pytest.approx(2.0, abs=1e-3)
    assert speeds[0] < -0.9 < -0.1 < speeds[1] < 0.1
    assert [event.t for event in run.events][1] - run.events[0].t == pytest.approx(0.0175, abs=0.01)


def test_a_wall_reached_during_a_cluster_joins_it():
    """Pressed for 80 ms they would be far behind it."""
    wall = Surface("wall", Segment((R + 1e-3, -1.0), (R + 1e-3, 1.0)), 1.0, 0.0)
    setup = Setup([ball("cue", -0.2, vx=0.5), ball("1", 0.0)], [wall], 0.5, contact=ContactModel("auto", 1e3))
    run = simulate(setup, resolve())
    assert run.numerics.clusters >= 1
    assert [event.partner for event in run.events if event.ball == "1"][-1] == "wall"
    assert max(run.state("1", 0.01 * step)[0] for step in range(50)) < 0.5 * R
    assert ledger(run).end == pytest.approx(ledger(run).start, rel=1e-4)


def test_a_ball_that_a_wall_sends_back_on_a_row_goes_through_it():
    """It leaves the row, meets the wall in touch at that instant and strikes the row again: alike at all levels."""
    ways = []
    for level in ("balanced", "precise"):
        row = [ball(str(place), place * (2 * R + 1e-9)) for place in range(6)]
        wall = Surface("wall", Segment((11 * R + 5e-9, -1.0), (11 * R + 5e-9, 1.0)), 0.85, 0.2)
        balls = [ball("cue", -0.26, -0.0066, vx=0.48), *row]
        laws = {"between_balls": ConstantBounce(Bounce(1.0, 0.05)), "contact": ContactModel("auto")}
        run = simulate(Setup(balls, [wall], 0.9, **laws), resolve(level))
        ways.append([run.state(each.name, 0.9)[2] for each in balls])
    assert ways[0] == pytest.approx(ways[1], abs=5e-4)


@pytest.mark.parametrize("duration", [0.1, 0.1002])
def test_a_run_may_end_within_a_contact(duration):
    balls = [ball("cue", -0.2 - 2 * R, vx=2.0), ball("1", 0.0), ball("2", 2 * R)]
    run = struck(balls, duration=duration)
    assert run.duration == duration
    assert run.trajectory("2", ends=True)[-1, 0] == duration


@pytest.mark.parametrize("model", ["auto", "hertz"])
def test_a_graze_of_a_rack_may_be_shorter_than_a_step(model: str):
    rack = [ball(f"{row}{k}", (2 * k - row) * R, -(3**0.5) * row * R) for row in range(3) for k in range(row + 1)]
    for approach in (1.5e-3, 2e-3):  # m/s, of 7.68
        above = 2 * R * (1.0 - (approach / 7.68) ** 2) ** 0.5
        run = struck([ball("cue", -2e-3, above, vx=7.68), *rack], model=model, duration=0.01)
        assert -2.0 * approach < sum(run.state(each.name, 0.01)[3] for each in rack) <= 1e-9


def test_no_soft_ball_of_a_cluster_leaves_through_a_wall():
    row = [ball("cue", -2 * R - 0.01, vx=10.5), *(ball(f"{place}", 2 * R * place) for place in range(12))]
    place = 23 * R + 0.1  # m
    wall = Surface("wall", Segment((place, -1.0), (place, 1.0)), 0.9, 0.1)
    law, soft = ConstantBounce(Bounce(0.95, 0.05)), ContactModel("auto", 1e5)
    run = simulate(Setup(row, [wall], 0.1, between_balls=law, contact=soft), resolve())
    assert max(run.states(each.name, [0.02, 0.05, 0.1])[:, 0].max() for each in row) < place
