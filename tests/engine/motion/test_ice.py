"""Bodies that slide on a plane with friction by speed and by place: against integrals, closed forms and the plain
method."""

import random
from dataclasses import replace
from itertools import pairwise
from math import atan, cos, hypot, log, log1p, pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import quad

from sandbox.engine import simulate
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import LEVELS, resolve
from sandbox.engine.model.ball import DISC, Ball, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, Segment, Surface, Trap
from sandbox.physics.cloth import Cloth
from sandbox.physics.ice import CurlingIce, Glide
from sandbox.physics.plane import Strips

ICE, PUCK = CurlingIce(), Glide(0.1, 0.05)
M, R = 19.96, 0.145


def stone(velocity, spin=1.5, position=(0.0, 0.0), name="stone"):
    return Ball(name, M, R, position, velocity, spin, inertia_factor=DISC)


def end_of(run, name="stone"):
    """The state at the end of a run."""
    return run.state(name, run.duration)


def slid(ball, plane, level="balanced", **more):
    return simulate(Setup([ball], plane=plane, duration=200.0, **more), resolve(level))


def expected(speed, law=ICE):
    """Time, way ahead and way aside of a stone that turns to the left until it rests, by quadrature over v = w^5."""

    def over_speeds(what):
        return quad(lambda w: 5.0 * w**4 / law.deceleration(w**5) * what(w), 0.0, speed**0.2, epsabs=1e-13)[0]

    def turned(w):
        return quad(lambda u: 5.0 * law.curl * law.k / law.deceleration(u**5), w, speed**0.2, epsabs=1e-13)[0]

    ahead, aside = (over_speeds(lambda w, way=way: w**5 * way(turned(w))) for way in (cos, sin))
    return over_speeds(lambda w: 1.0), ahead, aside


@pytest.mark.parametrize(("level", "error"), [("fast", 1e-4), ("balanced", 1e-6)])
def test_a_puck_with_drag_stops_where_the_closed_form_says(level, error):
    """s = ln(1 + k v^2 / mu g) / 2 k, t = atan(v (k / mu g)^(1/2)) / (k mu g)^(1/2); its spin slows by itself."""
    k, slowing, v = 0.003, 0.981, 45.0
    run = slid(
        Ball("puck", 0.16, 0.038, (0.0, 0.0), (v, 0.0), 50.0, inertia_factor=DISC), Glide(0.1, 0.05, drag=k), level
    )
    time = atan(v * sqrt(k / slowing)) / sqrt(k * slowing)
    assert end_of(run, "puck").x == pytest.approx(log1p(k * v * v / slowing) / (2.0 * k), abs=error)
    assert run.duration == pytest.approx(time, abs=error)
    assert run.state("puck", 1.0).spin == pytest.approx(50.0 - 2.0 * 0.05 * 9.81 / 0.038)


@pytest.mark.parametrize(("level", "error"), [("fast", 1e-6), ("balanced", 3e-9), ("precise", 3e-10)])
@pytest.mark.parametrize("speed", [0.3, 1.0, 2.2, 3.5])
def test_a_curling_stone_follows_the_law_to_its_rest(level, error, speed):
    """The spin outlasts the motion, so that the stone turns to the end."""
    time, ahead, aside = expected(speed)
    run = slid(stone((speed, 0.0), spin=50.0), ICE, level)
    assert run.state("stone", time)[:2] == pytest.approx((ahead, aside), abs=error)
    assert run.state("stone", time + 0.01)[2:4] == (0.0, 0.0)
    assert run.ended == "rest"


def test_a_stone_whose_spin_ends_goes_straight_from_then_on():
    """w = w0 - (s / g) (p ln v + q ln(A + c v)), between the speeds; the law's spin in closed form."""
    big = ICE.a + ICE.b * ICE.c
    p = ICE.b / big
    q = 1.0 / ICE.c - p

    def spun(v):
        return ICE.s / ICE.gravity * (p * log(v) + q * log(big + ICE.c * v))

    run = slid(stone((2.0, 0.0), spin=0.3), ICE)
    ends = next(arc.t0 for arc in run.arcs["stone"] if arc.start[4] == 0.0)
    speed = hypot(*run.state("stone", ends)[2:4])
    assert spun(2.0) - spun(speed) == pytest.approx(0.3, rel=1e-7)
    way = [np.array(run.state("stone", t)[2:4]) for t in (ends, 0.5 * (ends + run.duration), run.duration - 0.1)]
    for velocity in way[1:]:
        assert abs(way[0][0] * velocity[1] - way[0][1] * velocity[0]) < 1e-9


def test_no_spin_goes_straight_and_mirrored_spin_mirrors():
    assert abs(end_of(slid(stone((2.0, 0.0), spin=0.0), ICE))[1]) == 0.0
    left, right = (end_of(slid(stone((1.5, side * 0.3), spin=side), ICE)) for side in (1.0, -1.0))
    assert left[:2] == pytest.approx((right[0], -right[1]), abs=1e-12)


@pytest.mark.parametrize("angle", [1.0, 2.5, 4.0])
def test_no_direction_on_the_ice_is_special(angle):
    straight = end_of(slid(stone((2.0, 0.0)), ICE))
    turned = end_of(slid(stone((2.0 * cos(angle), 2.0 * sin(angle))), ICE))
    x, y = straight[:2]
    assert turned[:2] == pytest.approx((x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)), abs=1e-8)


def test_a_swept_stretch_slows_less_and_the_rest_as_before():
    """A stone without spin: the speeds squared at the edges by the way between them, as integrals of v dv / a(v)."""
    edges, swept = (8.0, 15.0), replace(ICE, friction=0.7, curl=0.5)
    run = slid(stone((2.2, 0.0), spin=0.0), Strips(edges, (ICE, swept, ICE)))
    speeds = [2.2, *(next(iter(run.crossings("stone", (x, 0.0), (-1.0, 0.0))))[1][2] for x in edges), 0.0]
    end = run.state("stone", run.duration)[0]
    for law, fast, slow, way in zip((ICE, swept, ICE), speeds, speeds[1:], (8.0, 7.0, end - 15.0), strict=False):
        assert quad(lambda v, law=law: v / law.deceleration(v), slow, fast)[0] == pytest.approx(way, abs=1e-7)
    assert end > 1.05 * end_of(slid(stone((2.2, 0.0), spin=0.0), ICE))[0]


def test_a_puck_slides_evenly_and_its_spin_decays_apart():
    run = slid(stone((3.0, 4.0), spin=20.0), PUCK)
    a, alpha = 0.1 * 9.81, 2 * 0.05 * 9.81 / R
    way = 5.0**2 / (2 * a)
    assert run.state("stone", 5.0 / a)[:4] == pytest.approx((0.6 * way, 0.8 * way, 0.0, 0.0), abs=1e-12)
    assert run.state("stone", 1.0)[4] == pytest.approx(20.0 - alpha)
    assert run.duration == pytest.approx(max(5.0 / a, 20.0 / alpha))


def test_strips_are_crossed_where_they_end_in_either_direction():
    """Three strips in closed form: v^2 falls by 2 a per m of each."""
    strips = Strips((1.0, 2.0), (Glide(0.1), Glide(0.2), Glide(0.05)))
    for place, velocity in ((0.0, 3.0), (3.0, -3.0)):
        run = slid(stone((velocity, 0.0), 0.0, (place, 0.0)), strips)
        square = 9.0 - 2 * 9.81 * (0.1 + 0.2 if velocity > 0 else 0.05 + 0.2)
        last = square / (2 * 9.81 * (0.05 if velocity > 0 else 0.1))
        end = 2.0 + last if velocity > 0 else 1.0 - last
        assert run.state("stone", run.duration)[0] == pytest.approx(end, abs=1e-12)
        assert len([arc for arc in run.arcs["stone"] if arc.t1 > arc.t0]) == 3


def test_a_ball_hooks_where_the_oil_ends():
    """It slides by mu g until the edge, then bends to its side spin; v = 5/7 v0 + 2/7 r w in the end."""
    lane = Strips((12.0,), (Cloth(0.04, 0.0, 0.0, name="lane"), Cloth(0.2, 0.0, 0.0, name="lane")))
    v, wx, wy = 8.0, -20.0, 20.0
    ball = Ball("ball", 6.8, 0.108, (0.0, 0.0), (v, 0.0), rolling_spin=(wx, wy))
    run = simulate(Setup([ball], plane=lane, duration=4.0), resolve())
    vx, vy = run.state("ball", 4.0)[2:4]
    assert (vx, vy) == pytest.approx((5 / 7 * v + 2 / 7 * 0.108 * wy, -2 / 7 * 0.108 * wx), rel=1e-9)
    t, state = next(iter(run.crossings("ball", (12.0, 0.0), (-1.0, 0.0))))
    ux, uy = v - 0.108 * wy, 0.108 * wx
    assert state[3] == pytest.approx(-0.04 * 9.81 * uy / hypot(ux, uy) * t, rel=1e-9)


def test_stones_share_momentum_and_energy_is_accounted_for():
    stones = [stone((2.0, 0.1)), stone((0.0, 0.0), 0.0, (4.0, 0.2), "other")]
    setup = Setup(stones, plane=ICE, duration=100.0, between_balls=lambda normal, slip: Bounce(0.9, 0.2))
    run = simulate(setup, resolve())
    hit = next(event for event in run.events if event.kind == "impact")
    before, after = (
        np.sum([M * np.array(how(name, hit.t)[2:4]) for name in ("stone", "other")], axis=0)
        for how in (run.before, run.state)
    )
    assert before == pytest.approx(after, rel=1e-9)
    book = ledger(run)
    causes = sum(book.impacts.values()) + sum(book.contacts.values())
    assert book.start + causes + book.residue == pytest.approx(book.end, abs=1e-9)
    assert abs(book.residue) < 2e-5 * book.start  # the spin of a stone that stops, s / v
    assert set(book.contacts) == {"ice"}
    assert book.end == 0.0


def test_discs_and_rolling_balls_share_a_plane():
    """A ball on a lane meets a pin, which slides as a disc; the two keep their momentum, and the pin has no roll."""
    ball = Ball("ball", 6.8, 0.108, (0.0, 0.0), (8.0, 0.0), rolling_spin=(0.0, 8.0 / 0.108))
    pin = Ball("pin", 1.5, 0.06, (2.0, 0.05), inertia_factor=DISC)
    setup = Setup([ball, pin], plane=Cloth(0.1, name="lane"), planes=[("pin", Glide(0.4, name="deck"))], duration=5.0)
    run = simulate(setup, resolve())
    hit = run.events[0]
    assert {hit.ball, hit.partner} == {"ball", "pin"}
    after = 6.8 * np.array(run.state("ball", hit.t)[2:4]) + 1.5 * np.array(run.state("pin", hit.t)[2:4])
    assert after == pytest.approx(6.8 * np.array(run.before("ball", hit.t)[2:4]), rel=1e-9)
    assert run.rolling_spin("pin", 3.0) == (0.0, 0.0)
    assert set(ledger(run).contacts) == {"lane", "deck"}
    with pytest.raises(ValueError, match="needs a plane for all others"):
        Setup([ball], planes=[("ball", PUCK)])


@pytest.mark.parametrize("method", ["exact", "plain"])
def test_a_gutter_takes_what_it_is_for(method):
    gutter = Trap("gutter", (-1.0, 1.0), 0.1, (9.0, 1.0), only=["ball"])
    balls = [stone((3.0, 3.0), 0.0, (0.0, 0.0), "ball"), stone((0.0, 3.0), 0.0, (-0.5, 0.0), "pin")]
    run = simulate(Setup(balls, plane=PUCK, traps=[gutter], duration=1.0), resolve(method=method))
    (caught,) = (event for event in run.events if event.kind == "caught")
    assert (caught.ball, caught.partner) == ("ball", "gutter")
    assert caught.y == pytest.approx(0.9, abs=1e-9 if method == "exact" else 0.03)


@pytest.mark.parametrize("plane", [ICE, PUCK, Strips((3.0,), (ICE, replace(ICE, friction=0.5)))])
def test_the_plain_method_converges_to_exact(plane):
    wall = Surface("wall", Segment((6.0, -5.0), (6.0, 5.0)), 1.0, 0.0)
    setup = Setup([stone((1.0, 0.4), 1.0)], [wall], plane=plane, duration=8.0)
    exact = end_of(simulate(setup, resolve()))[:2]
    off = [
        hypot(*np.subtract(end_of(simulate(setup, resolve(method="plain", step=step)))[:2], exact))
        for step in (4e-3, 1e-3)
    ]
    assert off[1] < 0.4 * off[0] < 0.02


def test_levels_agree_and_two_runs_are_the_same():
    stones = [stone((2.2, 0.05)), *(stone((0.0, 0.0), 0.0, (20.0 + 0.5 * i, 0.1 * i), str(i)) for i in range(4))]
    setup = Setup(stones, plane=ICE, duration=100.0, between_balls=lambda normal, slip: Bounce(0.9, 0.2))
    ends = {level: end_of(simulate(setup, LEVELS[level])) for level in LEVELS}
    assert ends["fast"] == pytest.approx(ends["precise"], abs=1e-4)
    assert end_of(simulate(setup, resolve())) == ends["balanced"]


def test_energy_never_grows_on_ice():
    run = slid(stone((1.0, 2.0), 3.0), Strips((0.5, 4.0), (ICE, PUCK, ICE)))
    times = np.linspace(0.0, run.duration, 300)
    energies = [kinetic(run.setup.balls[0], run.state("stone", t)) for t in times]
    assert max(np.diff(energies)) < 1e-9


@pytest.mark.parametrize("law", [Glide, CurlingIce])
@pytest.mark.parametrize("value", [-0.1, float("nan"), float("inf")])
def test_ice_does_not_push(law, value):
    with pytest.raises(ValueError, match=r"ice: gravity = .* must not be negative"):
        law(**({"sliding": 0.1} if law is Glide else {}), gravity=value)


def test_strips_need_a_law_each_and_edges_in_order():
    for edges, laws in (((1.0,), [ICE]), ((2.0, 1.0), [ICE] * 3), ((1.0, 1.0), [ICE] * 3), ((1.0,), [PUCK, Cloth()])):
        with pytest.raises(ValueError, match="strips"):
            Strips(edges, laws)


def test_a_stone_that_spins_in_place_stops_turning():
    run = slid(stone((0.0, 0.0), spin=pi), ICE)
    assert run.ended == "rest"
    assert run.state("stone", run.duration) == (0.0, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("law", [PUCK, ICE, Cloth(0.2, 0.02, 0.01), Glide(0.0)])
@pytest.mark.parametrize("seed", range(6))
def test_strips_of_one_law_are_that_law(law, seed):
    """Also for bodies that start on an edge, along one, or at rest, and through impacts; energy is accounted for."""
    chance = random.Random(seed)
    edges = sorted(chance.sample([0.0, 1.0, *(chance.uniform(-3.0, 3.0) for _ in range(3))], 3))
    corners = [(-4.0, -3.0), (4.0, -3.0), (4.0, 4.0), (-4.0, 4.0), (-4.0, -3.0)]
    walls = [Surface("wall", Segment(a, b), 0.7, 0.2) for a, b in pairwise(corners)]
    balls = [
        Ball(
            name,
            chance.uniform(0.2, 20.0),
            R,
            (chance.choice([0.0, 1.0, chance.uniform(-2.0, 2.0)]), 0.4 * place),
            (chance.choice([0.0, chance.uniform(-3.0, 3.0)]), chance.uniform(-2.0, 2.0)),
            chance.uniform(-3.0, 3.0),
            (chance.uniform(-9.0, 9.0), chance.uniform(-9.0, 9.0)),
        )
        for place, name in enumerate("abc")
    ]
    one, other = (
        simulate(Setup(balls, walls, 3.0, plane=plane, between_balls=lambda normal, slip: Bounce(0.8, 0.1)), resolve())
        for plane in (law, Strips(edges, [law] * 4))
    )
    for name in "abc":
        assert end_of(one, name)[:2] == pytest.approx(end_of(other, name)[:2], abs=1e-6)
    book = ledger(other)
    changes = sum(book.impacts.values()) + sum(book.contacts.values()) + book.residue
    assert book.start + changes == pytest.approx(book.end, abs=1e-9)
