"""The energy ledger: it closes, names every cause, and warns of what came from nowhere."""

import re

import pytest

import sandbox
from sandbox.engine import ledger as ledgers
from sandbox.engine import simulate
from sandbox.engine.ledger import ledger, warnings
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.physics.cloth import Cloth
from sandbox.physics.forces import Gravity
from sandbox.physics.ice import CurlingIce, Glide
from sandbox.physics.slope import Slope
from tests.engine import shots

G = 9.81


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


@pytest.mark.parametrize("plane", [Cloth(), Glide(0.1, drag=0.05), CurlingIce(), Slope(rolling=0.02, pull_y=-0.4)])
def test_the_residue_on_a_plane_is_the_error_of_the_path(plane):
    """Friction is booked by its own work, so a path that is not the law's leaves a residue."""
    spins = (0.0, 30.0) if plane.rolls else (0.0, 0.0)
    run = simulate(Setup([Ball("ball", 2.0, 0.05, (0.0, 0.0), (2.0, 0.3), 3.0, spins)], plane=plane), resolve())
    assert abs(ledger(run).residue) < 1e-4 * ledger(run).start
    for arc in run.arcs["ball"]:
        arc.curves = (*arc.curves[:2], *(tuple(1.01 * v for v in curve) for curve in arc.curves[2:4]), *arc.curves[4:])
        arc.end = None
    assert abs(ledger(run).residue) > 1e-3 * ledger(run).start


def test_the_ledger_books_what_sliding_takes_until_a_ball_rolls():
    """Sliding takes m u^2 / 7 from a solid sphere whose lowest point slips by u; rolling m mu_r g along its path."""
    ball = Ball("ball", 0.2, 0.03, (0.0, 0.0), (2.0, 0.0))
    rolls_at = 2.0 * 2.0 / (7.0 * 0.2 * G)
    run = simulate(Setup([ball], plane=Cloth(sliding=0.2, rolling=0.01, gravity=G), duration=rolls_at), resolve())
    assert ledger(run).contacts["cloth"] == pytest.approx(-0.2 * 2.0**2 / 7.0, rel=1e-12)
    longer = simulate(
        Setup([ball], plane=Cloth(sliding=0.2, rolling=0.01, gravity=G), duration=rolls_at + 1.0), resolve()
    )
    path = longer.state("ball", rolls_at + 1.0)[0] - longer.state("ball", rolls_at)[0]
    rolled = ledger(longer).contacts["cloth"] - ledger(run).contacts["cloth"]
    assert rolled == pytest.approx(-1.4 * 0.2 * 0.01 * G * path, rel=1e-12)


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


def test_the_ledgers_quadrature_is_exact_up_to_degree_nine():
    """Its weights are those of Gauss and Legendre on [0, 1]: the integral of x^n is 1 / (n + 1)."""
    for degree in range(10):
        total = sum(weight * node**degree for node, weight in zip(ledgers._NODES, ledgers._WEIGHTS, strict=True))
        assert total == pytest.approx(1.0 / (degree + 1), rel=1e-13)
