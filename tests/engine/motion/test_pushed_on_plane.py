"""Forces on balls, discs and stones that lie on a plane seen from above."""

from math import hypot

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sandbox.engine import simulate
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import DISC, Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.physics.cloth import Cloth
from sandbox.physics.forces import Drag
from sandbox.physics.ice import CurlingIce, Glide
from sandbox.physics.plane import Strips
from sandbox.physics.slope import Slope

G, R, M = 9.81, 0.1, 2.0  # m/s^2, m, kg
CLOTH = Cloth(sliding=0.2, rolling=0.01)


def steady(fx, fy=0.0):
    return lambda t, position, velocity, spin: (fx, fy)


def rolling(velocity, *forces, **more):
    return Ball("ball", M, R, (0.0, 0.0), velocity, 0.0, (-velocity[1] / R, velocity[0] / R), forces=forces, **more)


def disc(velocity, *forces, **more):
    return Ball("ball", M, R, (0.0, 0.0), velocity, forces=forces, inertia_factor=DISC, **more)


def moved(ball, plane, duration, level="precise"):
    return simulate(Setup([ball], plane=plane, duration=duration), resolve(level))


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0])
def test_a_push_along_a_roll_is_exact(angle):
    """a = F / (m (1 + k)) - mu_r g, at any angle of the path."""
    along = np.array([np.cos(angle), np.sin(angle)])
    a = 1.4 / M / 1.4 - 0.01 * G
    run = moved(rolling(tuple(1.0 * along), steady(*(1.4 * along))), CLOTH, 2.0)
    assert run.state("ball", 2.0)[:2] == pytest.approx((2.0 + 2.0 * a) * along, abs=1e-12)
    assert run.state("ball", 2.0)[2:4] == pytest.approx((1.0 + 2.0 * a) * along, abs=1e-12)
    assert run.rolling_spin("ball", 2.0) == pytest.approx((1.0 + 2.0 * a) / R * along[[1, 0]] * (-1.0, 1.0), abs=1e-11)


def test_a_push_against_a_roll_stops_it_and_drives_it_back():
    run = moved(rolling((1.0, 0.0), steady(-1.4)), CLOTH, 4.0)
    up, back = 0.5 + 0.01 * G, 0.5 - 0.01 * G
    expected = 0.5 / up - 0.5 * back * (4.0 - 1.0 / up) ** 2
    assert run.state("ball", 4.0)[0] == pytest.approx(expected, abs=1e-9)
    assert run.state("ball", 4.0)[2] == pytest.approx(-back * (4.0 - 1.0 / up), abs=1e-9)


@pytest.mark.parametrize(("force", "a"), [(20.0, 10.0 - 0.2 * G), (10.0, 5.0 / 1.4 - 0.01 * G)])
def test_a_ball_at_rest_slides_only_under_a_strong_push(force, a):
    """Its grip ends at F = m (1 + 1/k) mu_s g, 13.7 N."""
    run = moved(rolling((0.0, 0.0), steady(force)), CLOTH, 1.0)
    assert run.state("ball", 1.0)[:4] == pytest.approx((0.5 * a, 0.0, a, 0.0), abs=1e-12)
    assert (run.rolling_spin("ball", 1.0)[1] * R == pytest.approx(a, abs=1e-12)) == (force == 10.0)


@pytest.mark.parametrize(
    ("ball", "plane", "hold"),
    [
        (rolling((0.0, 0.0)), CLOTH, 1.4 * 0.01 * G * M),
        (disc((0.0, 0.0)), Glide(0.1), 0.1 * G * M),
        (disc((0.0, 0.0)), CurlingIce(), CurlingIce().deceleration(0.0) * M),
    ],
)
def test_what_rests_stays_until_friction_no_longer_holds_it(ball, plane, hold):
    for share, rests in ((0.999, True), (1.001, False)):
        pushed = Ball(
            ball.name, M, R, (0.0, 0.0), inertia_factor=ball.inertia_factor, forces=[steady(0.0, share * hold)]
        )
        run = moved(pushed, plane, 3.0)
        assert (run.ended == "rest") == rests
        assert (run.state("ball", run.duration)[1] > 0.0) != rests


def test_a_ball_loses_its_grip_where_the_push_is_too_strong():
    """F = F0 + c t passes m (1 + 1/k) mu_s g at a known time; from then on the lowest point slips."""
    limit = 3.5 * 0.2 * G * M
    lost = (limit - 2.0) / 20.0  # s
    run = moved(rolling((1.0, 0.0), lambda t, position, velocity, spin: (2.0 + 20.0 * t, 0.0)), CLOTH, 1.0)
    slips = [run.state("ball", t)[2] - R * run.rolling_spin("ball", t)[1] for t in (lost - 1e-3, lost + 0.1)]
    assert slips[0] == pytest.approx(0.0, abs=1e-12)
    # ds/dt = c (t - lost) / m after it
    assert slips[1] == pytest.approx(0.5 * 20.0 / M * 0.1**2, rel=1e-7)
    assert min(abs(arc.t0 - lost) for arc in run.arcs["ball"]) < 1e-8


def magnet(t, position, velocity, spin):
    """Pulls to (0, 2)."""
    x, y = position[0], position[1] - 2.0
    away = (x * x + y * y + 0.09) ** 1.5
    return -3.0 * x / away, -3.0 * y / away


def test_a_puck_past_a_magnet_follows_its_equation():
    def rates(t, state):
        x, y, vx, vy = state
        fx, fy = magnet(t, (x, y), (vx, vy), 0.0)
        speed = hypot(vx, vy)
        return vx, vy, fx / M - 0.05 * G * vx / speed, fy / M - 0.05 * G * vy / speed

    known = solve_ivp(rates, (0.0, 1.5), (0.0, 0.0, 2.0, 0.5), rtol=1e-12, atol=1e-12).y[:, -1]
    for level, error in (("fast", 1e-4), ("balanced", 1e-6), ("precise", 1e-8)):
        run = moved(disc((2.0, 0.5), magnet), Glide(0.05), 1.5, level)
        assert run.state("ball", 1.5)[:4] == pytest.approx(known, abs=error), level


def test_a_ball_that_slips_past_a_magnet_follows_its_equation():
    def rates(t, state):
        x, y, vx, vy, wx, wy = state
        fx, fy = magnet(t, (x, y), (vx, vy), 0.0)
        ux, uy = vx - R * wy, vy + R * wx
        slowing = 0.2 * G / hypot(ux, uy)
        return vx, vy, fx / M - slowing * ux, fy / M - slowing * uy, -2.5 / R * slowing * uy, 2.5 / R * slowing * ux

    start = (0.0, 0.0, 2.0, 0.5, -10.0, -20.0)
    known = solve_ivp(rates, (0.0, 0.4), start, rtol=1e-12, atol=1e-12).y[:, -1]
    ball = Ball("ball", M, R, (0.0, 0.0), (2.0, 0.5), rolling_spin=(-10.0, -20.0), forces=[magnet])
    run = moved(ball, CLOTH, 0.4)
    found = (*run.state("ball", 0.4)[:4], *run.rolling_spin("ball", 0.4))
    assert found == pytest.approx(known, abs=1e-8)


def test_a_torque_spins_it_against_the_friction():
    """dw/dt = T / I - 2 mu_sp g / r, from rest; below that friction it stays."""
    friction = 2.0 * 0.1 * G / R
    inertia = 0.5 * M * R * R
    for share, rate in ((0.99, 0.0), (3.0, 2.0 * friction)):
        twist = lambda t, position, velocity, spin, torque=share * friction * inertia: torque  # noqa: E731
        run = moved(disc((0.0, 0.0), torques=[twist]), Glide(0.1, spinning=0.1), 2.0)
        assert run.state("ball", run.duration)[4] == pytest.approx(rate * run.duration, abs=1e-9)
        assert run.ended == ("duration" if rate else "rest")


def test_strips_and_slopes_take_forces_too():
    """Two halves of one cloth are that cloth; a push uphill takes as much as the slope pulls."""
    ball = rolling((1.0, 0.4), magnet)
    whole, halves = (moved(ball, plane, 1.2) for plane in (CLOTH, Strips([0.3], [CLOTH, CLOTH])))
    assert whole.state("ball", 1.2) == pytest.approx(halves.state("ball", 1.2), abs=1e-8)
    slope = Slope(sliding=0.2, rolling=0.01, pull_x=-0.7)
    held, level = moved(rolling((1.0, 0.4), steady(0.7 * M)), slope, 1.2), moved(rolling((1.0, 0.4)), CLOTH, 1.2)
    assert held.state("ball", 1.2) == pytest.approx(level.state("ball", 1.2), abs=1e-8)


@pytest.mark.parametrize("plane", [Glide(0.1), CurlingIce()])
def test_both_methods_move_it_alike(plane):
    ball = rolling((1.0, 0.4), magnet) if plane.rolls else disc((1.0, 0.4), magnet)
    exact = moved(ball, plane, 1.0)
    plain = simulate(Setup([ball], plane=plane, duration=1.0), resolve(method="plain", step=4e-4))
    assert plain.state("ball", 1.0)[:4] == pytest.approx(exact.state("ball", 1.0)[:4], abs=2e-3)


def test_what_rests_on_a_plane_feels_a_push_that_begins_later():
    """10 N from 1 s on: a = F / m - mu g of a puck; a ramp of 2 t N moves a ball where it passes m (1 + k) mu_r g."""
    late = lambda t, position, velocity, spin: (10.0 if t >= 1.0 else 0.0, 0.0)  # noqa: E731
    a = 10.0 / M - 0.1 * G
    assert moved(disc((0.0, 0.0), late), Glide(0.1), 3.0).state("ball", 3.0)[0] == pytest.approx(2.0 * a, abs=1e-9)
    ramp = lambda t, position, velocity, spin: (2.0 * t, 0.0)  # noqa: E731
    wakes = M * 1.4 * 0.01 * G / 2.0  # s
    x = 2.0 / (1.4 * M) * (3.0 - wakes) ** 3 / 6.0
    assert moved(rolling((0.0, 0.0), ramp), CLOTH, 3.0).state("ball", 3.0)[0] == pytest.approx(x, abs=1e-8)


BOARD, SOFT = (Surface("board", Segment((1.0, -9.0), (1.0, 2.0)), e, 0.0) for e in (0.6, 0.0))


def against_board(plane, *forces, surfaces=(BOARD,), duration=9.0, velocity=(0.5, 0.0)):
    ball = rolling(velocity, *forces) if plane.rolls else disc(velocity, *forces)
    return simulate(Setup([ball], surfaces, plane=plane, duration=duration), resolve("precise"))


@pytest.mark.parametrize("plane", [Glide(0.1), CLOTH, CurlingIce()])
def test_a_push_into_a_board_brings_it_to_rest_there(plane):
    run = against_board(plane, steady(5.0))
    assert run.ended == "rest"
    assert run.state("ball", run.duration)[:2] == pytest.approx((1.0 - R, 0.0), abs=1e-9)
    assert run.events[-1].partner == "board"


def test_a_push_along_a_board_slides_it_to_its_end():
    """The board holds back what pushes into it: a = F_y / m - mu g, and the centre passes the end at the known time."""
    run = against_board(Glide(0.1), steady(5.0, 3.0), surfaces=[SOFT], velocity=(0.5, 0.3))
    began = next(event.t for event in run.events if event.kind == "contact")
    left = next(event for event in run.events if event.kind == "leave")
    y, v = (run.state("ball", began)[i] for i in (1, 3))
    a = 3.0 / M - 0.1 * G
    assert left.t - began == pytest.approx((-v + (v * v + 2.0 * a * (2.0 - y)) ** 0.5) / a, abs=1e-9)
    assert run.state("ball", 0.5 * (began + left.t))[0] == pytest.approx(1.0 - R, abs=1e-9)
    assert run.state("ball", run.duration)[0] > 1.0 + R
    assert abs(ledger(run).residue) < 1e-8 * ledger(run).end


def test_it_leaves_the_board_when_the_push_turns():
    """Fx = 5 - 2 t N turns at 2.5 s, while it slides along."""
    run = against_board(
        Glide(0.05), lambda t, position, velocity, spin: (5.0 - 2.0 * t, 1.1), surfaces=[SOFT], duration=3.0
    )
    left = next(event for event in run.events if event.kind == "leave")
    assert left.t == pytest.approx(2.5, abs=1e-9)
    assert run.state("ball", 3.0)[0] < 1.0 - R - 1e-3


def test_it_rests_in_a_corner():
    floor = Surface("end", Segment((-9.0, 1.0), (9.0, 1.0)), 0.6, 0.0)
    run = against_board(Glide(0.05), steady(5.0, 4.0), surfaces=(BOARD, floor), velocity=(0.5, 0.4))
    assert run.ended == "rest"
    assert run.state("ball", run.duration)[:2] == pytest.approx((1.0 - R, 1.0 - R), abs=1e-9)


def test_the_ledger_books_the_work_of_each_force_on_a_plane():
    wind = Drag(coefficient=0.5, density=1.2, area=0.05, wind=lambda t, position: (0.0, 6.0))
    book = ledger(moved(rolling((2.0, 0.0), wind, magnet), CLOTH, 1.5))
    assert {"drag", "magnet"} <= set(book.work)
    assert book.contacts["cloth"] < 0.0
    causes = sum(book.work.values()) + sum(book.contacts.values())
    assert book.start + causes + book.residue == pytest.approx(book.end, abs=1e-12)
    assert abs(book.residue) < 1e-8 * book.start


def test_a_plane_that_knows_no_forces_is_refused_by_name():
    class Deck:
        name, rolls, in_closed_form, strongest, TERMS = "deck", False, True, 1.0, {}
        phase = Glide(0.1).phase

    Setup([disc((1.0, 0.0))], plane=Deck())
    with pytest.raises(ValueError, match=r"ball 'ball' has forces or torques, and its plane .* has no phase_under"):
        Setup([disc((1.0, 0.0), magnet)], plane=Deck())
