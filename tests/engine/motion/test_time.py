"""Forces that depend on time: what lies still feels them, and steps see them."""

from __future__ import annotations

from math import log

import pytest

import sandbox
from sandbox import (
    Ball,
    Body,
    Cloth,
    Drag,
    Glide,
    Gravity,
    Moving,
    RunError,
    Segment,
    Setup,
    Sliding,
    Surface,
    World,
    box,
)
from sandbox.engine import simulate_many
from sandbox.engine.model.accuracy import LEVELS

G = Gravity(9.81)
SMOOTH = Surface("floor", Segment((-99.0, 0.0), (99.0, 0.0)), 0.5, 0.0)
ROUGH = Surface("floor", Segment((-99.0, 0.0), (99.0, 0.0)), 0.5, 0.5)


def push(t, position, velocity, spin):
    """10 N from 1 s on."""
    return 10.0 * (t >= 1.0), 0.0


def push_after(t, position, velocity, spin):
    return 10.0 * (t > 1.0), 0.0


def ramp(t, position, velocity, spin):
    return 2.0 * t, 0.0


def lying(*forces, **more):
    return Ball("ball", 1.0, 0.1, (0.0, 0.1), forces=[G, *forces], **more)


@pytest.mark.parametrize("force", [push, push_after])
@pytest.mark.parametrize("discontinuities", [(), (1.0,)])
def test_what_lies_feels_a_push_that_comes_later(force, discontinuities):
    """x = 10/2 (t - 1)^2 without friction."""
    run = sandbox.simulate(Setup([lying(force)], [SMOOTH], duration=3.0, discontinuities=discontinuities))
    assert (run.ended, run.state("ball", 1.0).vx) == ("duration", 0.0)
    assert run.state("ball", 3.0).x == pytest.approx(20.0, abs=1e-9)


def test_a_growing_push_rolls_a_ball_from_the_start():
    """a = (5/7) 2 t, so x = (5/7) t^3 / 3."""
    run = sandbox.simulate(Setup([lying(ramp)], [ROUGH], duration=2.0))
    assert run.state("ball", 2.0).x == pytest.approx(5.0 / 7.0 * 8.0 / 3.0, abs=1e-9)


def test_a_box_slides_once_the_push_exceeds_its_friction():
    """mu m g = 2 t at t = 2.4525 s, then x = (t - 2.4525)^3 / 3."""
    crate = Body("crate", mass=1.0, shape=box(0.4, 0.2), position=(0.0, 0.1), forces=[G, ramp])
    run = sandbox.simulate(Setup([crate], [ROUGH], duration=3.5))
    assert run.state("crate", 2.4).x == pytest.approx(0.0, abs=1e-9)
    assert run.state("crate", 3.5).x == pytest.approx(1.0475**3 / 3.0, abs=1e-4)


def test_a_gust_takes_what_lies_along():
    """With u = 20 - v: u' = -(k/m) u^2, so x = 20 s - (m/k) ln(1 + 20 k s / m) after s seconds."""
    drag = Drag(coefficient=0.5, wind=lambda t, position: (20.0 * (t > 1.0), 0.0))
    ball = Ball("ball", 0.02, 0.1, (0.0, 0.1), forces=[G, drag])
    by_mass = ball.forces[1].row.half_density_area * 0.5 / 0.02
    run = sandbox.simulate(Setup([ball], [SMOOTH], duration=3.0))
    assert run.state("ball", 3.0).x == pytest.approx(40.0 - log(1.0 + 40.0 * by_mass) / by_mass, abs=1e-3)


def test_a_world_feels_it_too():
    world = World(Setup([lying(push)], [SMOOTH], duration=600.0))
    while world.t < 2.9 - 1e-9:
        world.step(1 / 60)
    assert world.state["ball"].x == pytest.approx(5.0 * (world.t - 1.0) ** 2, abs=1e-9)


@pytest.mark.parametrize("start", [0.0, 0.4, 1.234])
def test_in_space_a_push_moves_a_ball_at_rest(start):
    """1 N for 0.2 s on 1 kg."""
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.0), forces=[lambda t, *_: (1.0 * (start < t < start + 0.2), 0.0)])
    run = sandbox.simulate(Setup([ball], duration=3.0))
    assert run.state("ball", 3.0).x == pytest.approx(0.02 + 0.2 * (2.8 - start), abs=1e-4)


def test_a_run_in_which_nothing_wakes_ends_at_rest():
    """Where it came to rest, though it was asked up to the end."""
    weak = lying(lambda t, *_: (0.4 * (t > 2.0), 0.0), velocity=(1.0, 0.0))
    grass = Surface("grass", Segment((-99.0, 0.0), (99.0, 0.0)), 0.0, 0.5, rolling_resistance=0.1)
    run = sandbox.simulate(Setup([weak], [grass], duration=20.0))
    rest = next(event.t for event in run.events if event.kind == "rest")
    assert (run.ended, run.duration) == ("rest", rest)
    assert rest < 2.0


def test_what_moved_rests_again_and_wakes_again():
    """Two pushes of 1 s; each leaves 1 m/s, which rolling resistance takes in 1/0.981 s."""
    grass = Surface("grass", Segment((-99.0, 0.0), (99.0, 0.0)), 0.0, 0.5, rolling_resistance=0.1)
    pushes = lying(lambda t, *_: (5.0 * (t % 4.0 < 0.5), 0.0))
    run = sandbox.simulate(Setup([pushes], [grass], duration=8.0))
    assert [event.kind for event in run.events] == ["contact", "rest", "rest"]
    x, back = run.state("ball", 3.9).x, run.state("ball", 7.9).x
    assert back == pytest.approx(2.0 * x, rel=1e-6)


def test_a_heap_wakes_when_a_force_on_it_changes():
    """10 N on 2 kg with 0.5 * 2 g of friction below: a = 0.19 m/s^2 of the lower box, on which the other slides."""
    lower, upper = (
        Body(name, mass=1.0, shape=box(0.4, 0.2), position=(0.0, y), forces=[G, *forces])
        for name, y, forces in (("lower", 0.1, [push]), ("upper", 0.3, []))
    )
    run = sandbox.simulate(Setup([lower, upper], [ROUGH], duration=2.0))
    assert [event.kind for event in run.events[:2]] == ["rest", "rest"]
    assert run.state("lower", 1.0).x == pytest.approx(0.0, abs=1e-9)
    assert run.state("lower", 2.0).x == pytest.approx(0.5 * (10.0 - 9.81), abs=1e-6)


def test_a_ball_in_a_corner_leaves_it_when_it_is_pulled_out():
    wall = Surface("wall", Segment((-0.1, 0.0), (-0.1, 1.0)), 0.5, 0.5)
    run = sandbox.simulate(Setup([lying(lambda t, *_: (-1.0 + t, 0.0))], [ROUGH, wall], duration=3.0))
    assert run.state("ball", 1.0).x == pytest.approx(0.0, abs=1e-9)
    assert run.state("ball", 3.0).x == pytest.approx(5.0 / 7.0 * 8.0 / 6.0, abs=1e-6)


@pytest.mark.parametrize(
    ("plane", "acceleration"),
    [(Glide(0.1), 10.0 - 0.981), (Cloth(sliding=0.5, rolling=0.01, spinning=0.01), 50.0 / 7.0 - 0.0981)],
)
def test_what_lies_on_a_plane_feels_it(plane, acceleration):
    """A disc slides; a ball rolls, with 5/7 of the push."""
    ball = Ball("ball", 1.0, 0.05, (0.0, 0.0), forces=[push])
    run = sandbox.simulate(Setup([ball], plane=plane, duration=2.0))
    assert run.state("ball", 1.0).x == 0.0
    assert run.state("ball", 2.0).x == pytest.approx(0.5 * acceleration, abs=1e-6)


def test_a_ball_carried_by_a_belt_feels_it():
    """The belt moves with 1 m/s; from 1 s on the push adds 5/7 of 10 m/s^2."""
    belt = Moving(ROUGH, Sliding((1.0, 0.0)))
    run = sandbox.simulate(Setup([lying(push, velocity=(1.0, 0.0))], [belt], duration=1.5))
    assert run.state("ball", 1.5).x == pytest.approx(1.5 + 0.5 * 50.0 / 7.0 * 0.25, abs=1e-6)


@pytest.mark.parametrize("level", ["fast", "balanced", "precise"])
@pytest.mark.parametrize("length", [0.1, 0.05, 0.02])
def test_no_step_misses_a_short_gust(level, length):
    """5 N on 1 kg from t0 on: x = 5 + 5 length (1 - t0 - length / 2)."""
    for i in range(11):
        start = 0.05 + 0.083 * i
        gust = Ball(
            "ball",
            1.0,
            0.1,
            (0.0, 2.0),
            (5.0, 5.0),
            forces=[G, lambda t, *_, a=start: (5.0 * (a <= t < a + length), 0.0)],
        )
        x = sandbox.simulate(Setup([gust], duration=1.0), level).state("ball", 1.0).x
        assert x == pytest.approx(
            5.0 + 5.0 * length * (max(0.0, 1.0 - start - 0.5 * length)), abs=LEVELS[level].tolerance
        )


def test_declared_jumps_are_hit_exactly():
    """With a scale that is too coarse to see the gust."""

    def gust(t, position, velocity, spin):
        return 5.0 * (0.4 <= t < 0.405), 0.0

    gust.discontinuities, gust.time_scale = (0.4, 0.405), 1.0
    flying, rests = Ball("ball", 1.0, 0.1, (0.0, 2.0), (5.0, 5.0), forces=[G, gust]), lying(gust)
    flown = sandbox.simulate(Setup([flying], duration=1.0))
    assert flown.state("ball", 1.0).x == pytest.approx(5.0 + 0.025 * 0.5975, abs=1e-6)
    slid = sandbox.simulate(Setup([rests], [SMOOTH], duration=1.0))
    assert slid.state("ball", 1.0).x == pytest.approx(0.025 * 0.5975, abs=1e-6)


def test_shots_computed_together_feel_it_too():
    setups = [
        Setup(
            [Ball("ball", 1.0, 0.1, (0.0, 0.5), (0.1 * i, 0.0), forces=[G, late])],
            [Surface("floor", Segment((-99.0, 0.0), (99.0, 0.0)), 0.0, 0.5, rolling_resistance=0.2)],
            duration=4.0,
        )
        for i in range(30)
    ]
    together = list(simulate_many(setups, LEVELS["balanced"]))
    for setup, run in zip(setups, together, strict=True):
        assert not isinstance(run, Exception)
        alone = sandbox.simulate(setup)
        assert (run.ended, run.duration) == (alone.ended, 4.0)
        assert run.state("ball", 4.0) == pytest.approx(alone.state("ball", 4.0), abs=1e-9)
        assert run.state("ball", 4.0).x > run.state("ball", 3.0).x + 1.0


def late(t, position, velocity, spin):
    return 10.0 * (t >= 3.0), 0.0 * t


def test_a_calm_ball_takes_few_steps():
    calm = Ball("ball", 1.0, 0.1, (0.0, 0.0), (1e-3, 0.0))
    run = sandbox.simulate(Setup([calm], duration=60_000.0))
    assert run.state("ball", 60_000.0).x == pytest.approx(60.0, abs=1e-9)
    assert run.numerics.steps < 200
    slowed = Ball("ball", 1.0, 0.1, (0.0, 0.0), (1e-3, 0.0), forces=[Drag()])
    assert sandbox.simulate(Setup([slowed], duration=60_000.0)).numerics.steps < 15_000


def test_a_force_that_changes_when_called_again_is_named():
    calls = []

    def flicker(t, position, velocity, spin):
        calls.append(t)
        return float(len(calls)), 0.0

    setup = Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0), forces=[flicker])], duration=1.0)
    with pytest.raises(RunError, match=r"'ball': flicker, called twice .* returned \(1\.0, 0\.0\) and \(2\.0, 0\.0\)"):
        sandbox.simulate(setup)
    calm = sandbox.simulate(Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0))], duration=1.0))
    with pytest.raises(RunError, match=r"t = 0\.5 s, ball 'ball': flicker, called twice"):
        calm.fork(0.5, forces=[flicker])


def test_many_short_steps_are_explained(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sandbox.engine.guard.MOST_STEPS", 5_000)
    windy = Ball("ball", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0), forces=[lambda t, *_: (1e-9 * t, 0.0)])
    with pytest.raises(RunError, match=r"depend on time and so take steps of 0\.01 s: give them a time_scale"):
        sandbox.simulate(Setup([windy], duration=100.0))
