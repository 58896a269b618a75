"""Surfaces that move: times of impact and impulses against closed forms and an independent solver; what carries a ball;
the work that they do; and what is refused."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import asin, cos, inf, nan, pi, sin, sqrt
from random import Random
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from sandbox.engine import simulate
from sandbox.engine.contact import driven
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.motion import Given, InTurn, Motion, Placing, Sliding, Swinging, Turning, moved, stays_within
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import box
from sandbox.engine.model.surface import Circle, Moving, Segment, Surface
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Run
from sandbox.errors import RunError
from sandbox.physics.cloth import Cloth
from sandbox.physics.forces import Gravity

G, MASS, RADIUS = 9.81, 0.6, 0.1
PLATE = Segment((-5.0, 0.0), (5.0, 0.0))


def to_and_fro(period: float, shift: tuple[float, float]) -> Swinging:
    """A motion without turning, about where it is drawn."""
    return Swinging((0.0, 0.0), 0.0, period, shift=shift)


def run_with(
    motion: Motion,
    shape: Segment | Circle = PLATE,
    *,
    position: tuple[float, float] = (0.0, 1.0),
    velocity: tuple[float, float] = (0.0, 0.0),
    spin: float = 0.0,
    restitution: float = 0.8,
    friction: float = 0.5,
    resistance: float = 0.0,
    gravity: float = G,
    duration: float = 3.0,
    others: Sequence[Surface] = (),
) -> Run:
    """A ball that falls on a surface that moves."""
    ball = Ball("ball", MASS, RADIUS, position, velocity, spin, forces=[Gravity(MASS, gravity)])
    surface = Surface("lift", shape, restitution, friction, resistance)
    return simulate(Setup([ball], [Moving(surface, motion), *others], duration), resolve(level="balanced"))


# When and how hard ----------------------------------------------------------------------------------------------------


def test_a_rising_plate_is_met_where_two_parabolas_meet():
    run = run_with(Sliding((0.0, (0.5, 2.0))))
    first = run.events[0]
    a, b, c = 0.5 * G + 1.0, 0.5, RADIUS - 1.0
    t = (-b + sqrt(b * b - 4.0 * a * c)) / (2.0 * a)
    assert first.t == pytest.approx(t, abs=1e-10)
    plate = 0.5 + 2.0 * t
    assert first.speed == pytest.approx(G * t + plate, abs=1e-9)
    assert run.state("ball", first.t).vy == pytest.approx(plate + 0.8 * first.speed, abs=1e-9)


def test_a_bat_of_infinite_mass_drives_a_ball():
    """At twice its speed if elastic; along it as far as friction grips: 2/7 of the speed of a bat."""
    bat = Segment((-1.0, -1.0), (-1.0, 1.0))
    run = run_with(Sliding((20.0, 0.0)), bat, position=(0.0, 0.0), restitution=1.0, gravity=0.0, duration=0.2)
    assert run.events[0].t == pytest.approx(0.9 / 20.0, abs=1e-11)
    assert run.state("ball", 0.1)[2:] == pytest.approx((40.0, 0.0, 0.0), abs=1e-9)
    run = run_with(Sliding((20.0, 7.0)), bat, position=(0.0, 0.0), gravity=0.0, duration=0.2)
    _, _, vx, vy, spin = run.state("ball", 0.1)
    assert vx == pytest.approx(1.8 * 20.0)
    assert vy == pytest.approx(2.0)
    assert vy - RADIUS * spin == pytest.approx(7.0)  # of the point that touched


def test_a_blade_strikes_with_the_speed_of_its_point():
    blade = Segment((0.0, 0.0), (2.0, 0.0))
    run = run_with(
        Turning((0.0, 0.0), 3.0), blade, position=(1.2, 0.4), restitution=0.5, friction=0.0, gravity=0.0, duration=1.0
    )
    hit = run.events[0]
    angle = 3.0 * hit.t
    assert 0.4 * cos(angle) - 1.2 * sin(angle) == pytest.approx(RADIUS, abs=1e-10)
    along = 1.2 * cos(angle) + 0.4 * sin(angle)
    assert hit.speed == pytest.approx(3.0 * along, abs=1e-9)
    _, _, vx, vy, _ = run.state("ball", hit.t)
    assert cos(angle) * vy - sin(angle) * vx == pytest.approx(1.5 * 3.0 * along, abs=1e-9)
    assert cos(angle) * vx + sin(angle) * vy == pytest.approx(0.0, abs=1e-9)


@dataclass(frozen=True)
class Wobble:
    """Two harmonics and a turn that is one, in numpy."""

    rate: float  # rad/s

    def __call__(self, t: float) -> Placing:
        return Placing(0.3 * sin(self.rate * t), 0.2 * sin(1.7 * self.rate * t), 0.5 * sin(0.6 * self.rate * t))


@dataclass(frozen=True)
class WobbleRates:
    """The derivative of ``Wobble``."""

    rate: float  # rad/s

    def __call__(self, t: float) -> Placing:
        w = self.rate
        return Placing(0.3 * w * cos(w * t), 0.34 * w * cos(1.7 * w * t), 0.3 * w * cos(0.6 * w * t))


def random_case(seed: int) -> tuple[Motion, Segment | Circle]:
    """A motion of each kind in turn, with a random shape."""
    draw = Random(seed).uniform
    about = (draw(-0.5, 0.5), draw(-0.5, 0.5))
    kinds = (
        lambda: Sliding((draw(-3.0, 3.0), (draw(-2.0, 4.0), 2.0 * draw(-1.0, 1.0)))),
        lambda: Swinging(
            about, draw(-1.0, 1.0), draw(0.2, 2.0), draw(0.0, 6.0), shift=(draw(-0.5, 0.5), draw(-0.5, 0.5))
        ),
        lambda: Turning(about, draw(-30.0, 30.0), draw(0.0, 6.0)),
        lambda: Given(Wobble(2.0 + abs(about[0])), WobbleRates(2.0 + abs(about[0]))),
    )
    a = (draw(-1.5, 1.5), draw(-1.2, 0.2))
    b = (a[0] + draw(1.0, 3.0), a[1] + draw(-1.0, 1.0))
    return kinds[seed % 4](), Circle(a, draw(0.05, 0.4)) if seed % 3 == 0 else Segment(a, b, draw(0.0, 0.1))


class Independent:
    """A ball that falls from rest at (0, 2) or flies as given, and its distance to a shape that moves: by formulas of
    its own."""

    def __init__(self, motion: Motion, shape: Segment | Circle, velocity: tuple[float, float]) -> None:
        self.motion, self.shape, self.velocity = motion, shape, velocity
        ends = (shape.center, shape.center) if isinstance(shape, Circle) else (shape.a, shape.b)
        self.a, self.b = (complex(*end) - complex(*motion.about) for end in ends)

    def ball(self, t: float) -> complex:
        return complex(self.velocity[0] * t, 2.0 + self.velocity[1] * t - 0.5 * G * t * t)

    def nearest(self, t: float) -> complex:
        """The point of the shape's line that is nearest to the ball."""
        x, y, angle = self.motion.place(t)
        turn = complex(cos(angle), sin(angle))
        a, b = complex(x, y) + turn * self.a, complex(x, y) + turn * self.b
        along = (self.ball(t) - a) * (b - a).conjugate()
        share = along.real / abs(b - a) ** 2 if b != a else 0.0
        return a + min(1.0, max(0.0, share)) * (b - a)

    def gap(self, t: float) -> float:
        return abs(self.ball(t) - self.nearest(t)) - self.shape.radius - RADIUS

    def first_touch(self, until: float, step: float) -> float | None:
        times = np.arange(0.0, until, step)
        gaps = [self.gap(t) for t in times]
        for t, before, after in zip(times, gaps[:-1], gaps[1:], strict=False):
            if before > 0.0 >= after:
                return float(brentq(self.gap, t, t + step, xtol=1e-14))
        return None

    def velocity_after(self, t: float, restitution: float, friction: float) -> tuple[complex, float]:
        """Velocity and spin after an impact at t of a solid sphere without spin."""
        point = self.nearest(t)
        n = (self.ball(t) - point) / abs(self.ball(t) - point)
        point = self.ball(t) - RADIUS * n
        x, y, _ = self.motion.place(t)
        vx, vy, spin = self.motion.rates(t)
        surface = complex(vx, vy) + spin * 1j * (point - complex(x, y))
        velocity = complex(self.velocity[0], self.velocity[1] - G * t)
        seen = (velocity - surface) * n.conjugate()  # real: away from the surface; imaginary: along it
        push, slip = -(1.0 + restitution) * seen.real, seen.imag
        rub = min(friction * push, abs(slip) * 2.0 / 7.0) * (1.0 if slip < 0.0 else -1.0)
        return velocity + (push + 1j * rub) * n, -rub / (0.4 * RADIUS)


@pytest.mark.parametrize("block", range(4))
def test_random_motions_agree_with_an_independent_solver(block: int):
    met = 0
    for seed in range(40 * block, 40 * (block + 1)):
        motion, shape = random_case(seed)
        draw = Random(seed).uniform
        case = Independent(motion, shape, (draw(-1.0, 1.0), draw(-3.0, 1.0)))
        if case.gap(0.0) < 0.01:
            continue
        run = run_with(motion, shape, position=(0.0, 2.0), velocity=case.velocity, duration=1.2, friction=0.3)
        hit = next((event for event in run.events if event.kind == "impact"), None)
        step = 2e-3 if hit is None else min(2e-3, 0.05 * max(hit.t, 1e-3))
        t = case.first_touch(1.2 if hit is None else hit.t + 2.0 * step, step)
        if hit is None:
            assert t is None, seed
            continue
        met += 1
        if hit.speed < 0.05:
            assert abs(case.gap(hit.t)) < 1e-9, seed  # it grazes: sampling may not see it
            continue
        assert t == pytest.approx(hit.t, abs=1e-9), seed
        velocity, spin = case.velocity_after(t, 0.8, 0.3)
        state = run.state("ball", hit.t)
        assert complex(state.vx, state.vy) == pytest.approx(velocity, abs=1e-6), seed
        assert state.spin == pytest.approx(spin, abs=1e-5), seed
    assert met > 10


def test_nothing_tunnels_through_a_blade_at_any_speed():
    """A ball that stands where a thin blade passes is hit, whatever their speeds."""
    blade = Segment((0.0, 0.0), (2.0, 0.0))
    for seed in range(60):
        draw = Random(seed).uniform
        rate, speed, x = 10.0 ** draw(0.0, 3.0), 10.0 ** draw(0.0, 3.0), draw(3.3, 4.9)
        arrives = (x - 2.0 - RADIUS) / speed
        latest = arrives + min(2.0 * pi / rate, 2.0 / speed)
        run = run_with(
            Turning((0.0, 0.0), rate, draw(0.0, 6.0)),
            blade,
            position=(x, 0.0),
            velocity=(-speed, 0.0),
            gravity=0.0,
            duration=latest + 1e-6,
            restitution=1.0,
        )
        assert run.events, seed
        assert run.events[0].t >= arrives - 1e-9, seed


# What carries a ball --------------------------------------------------------------------------------------------------


def test_a_lift_carries_a_ball_that_rests_on_it():
    run = run_with(to_and_fro(1.0, (0.0, 0.05)), restitution=0.0)
    for t in (1.0, 1.7, 2.9):
        lift = 0.05 * sin(2.0 * pi * t)
        assert run.state("ball", t)[1:4] == pytest.approx((RADIUS + lift, 0.0, 0.1 * pi * cos(2.0 * pi * t)), abs=1e-9)
    assert run.arcs["ball"].at(2.0).phase is Phase.RESTING


def test_a_ball_leaves_a_lift_that_falls_faster_than_it():
    run = run_with(to_and_fro(0.3, (0.0, 0.05)), restitution=0.0, duration=0.8)
    leaves = next(event.t for event in run.events if event.kind == "leave")
    rate = 2.0 * pi / 0.3
    assert 0.05 * rate**2 * sin(rate * leaves) == pytest.approx(G, abs=1e-6)


def test_a_ball_rolls_on_what_moves_along_with_2_7_of_its_speed():
    run = run_with(to_and_fro(1.0, (0.1, 0.0)), position=(0.0, RADIUS), restitution=0.0)
    for t in (1.3, 2.9):  # by its angular momentum about the point of contact, also while it slid at first
        assert run.state("ball", t).vx == pytest.approx(2.0 / 7.0 * 0.2 * pi * cos(2.0 * pi * t), abs=1e-6)


def test_rolling_resistance_holds_a_ball_until_it_is_overcome():
    run = run_with(to_and_fro(1.0, (0.1, 0.0)), restitution=0.0, resistance=0.5)
    assert run.state("ball", 2.9).vx == pytest.approx(0.2 * pi * cos(5.8 * pi), abs=1e-9)
    run = run_with(to_and_fro(1.0, (0.1, 0.0)), restitution=0.0, resistance=0.02)
    assert abs(run.state("ball", 2.9).vx) < 0.5 * 0.2 * pi


def test_a_ball_flies_on_where_what_carries_it_stops():
    up = Sliding([(0.0, (0.0, 2.0)), (0.5, (0.0, 0.0))])
    run = run_with(up, position=(0.0, RADIUS), restitution=0.0, duration=1.0)
    assert run.state("ball", 0.4).y == pytest.approx(RADIUS + 0.8, abs=1e-9)
    assert [event.kind for event in run.events][-2:] == ["impact", "rest"]
    assert run.state("ball", 0.6).y == pytest.approx(RADIUS + 1.0 + 0.2 - 0.5 * G * 0.01, abs=1e-9)


def test_a_plate_that_starts_strikes_the_ball_that_lies_on_it():
    wait = InTurn([(0.0, Sliding()), (0.5, Sliding((0.0, 3.0), start=0.5))])
    run = run_with(wait, position=(0.0, RADIUS), restitution=0.5, duration=0.7)
    assert run.state("ball", 0.4)[:4] == pytest.approx((0.0, RADIUS, 0.0, 0.0), abs=1e-12)
    assert run.state("ball", 0.5).vy == pytest.approx(4.5, abs=1e-9)


# Work, and what is refused --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("motion", "restitution"),
    [
        (Sliding((0.0, 0.5)), 0.8),
        (to_and_fro(1.0, (0.0, 0.05)), 0.0),
        (to_and_fro(0.5, (0.1, 0.05)), 0.5),
        (Turning((-1.0, 0.0), 0.5), 0.9),
    ],
)
def test_the_ledger_has_the_work_of_what_moves(motion: Motion, restitution: float):
    run = run_with(motion, restitution=restitution, friction=0.1, duration=1.5)
    found = ledger(run)
    assert abs(found.work["driven by lift"]) > 0.01
    assert found.impacts["lift"] < 0.0
    assert abs(found.residue) < 1e-6
    sums = sum(found.work.values()) + sum(found.impacts.values()) + sum(found.contacts.values()) + found.residue
    assert found.start + sums == pytest.approx(found.end)


def test_what_jumps_is_refused_with_its_time():
    with pytest.raises(ValueError, match=r"at 0\.5 s the place jumps from \(0, 0\) m, 0 rad to \(1, 0\) m, 0 rad"):
        InTurn([(0.0, Sliding()), (0.5, Sliding(shift=(1.0, 0.0)))])
    step = Given(lambda t: Placing(0.0, float(t > 0.2), 0.0), lambda t: Placing(0.0, 0.0, 0.0))
    with pytest.raises(RunError, match=r"t = 0\.2 s: the motion of 'lift' is not smooth"):
        run_with(step)


def test_a_velocity_that_is_not_the_derivative_is_refused():
    wrong = Given(lambda t: Placing(0.0, t), lambda t: Placing(0.0, 2.0))
    with pytest.raises(RunError, match="'lift' is not smooth, or its velocity is not the derivative of its place"):
        run_with(wrong)


@pytest.mark.parametrize("wrong", [None, 0.0, "ab", (0.0, 0.0, 0.0, 0.0), (0j, 0.0)])
def test_a_place_that_is_none_is_refused_with_its_time(wrong: Any):
    with pytest.raises(RunError, match="t = 0 s: the place of 'lift' must be a Placing of finite numbers"):
        run_with(Given(lambda t: wrong, lambda t: (0.0, 0.0)))


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Given(3, 4), "given motion: position = 3 must be a function of time"),
        (lambda: InTurn([(0.0, 3)]), r"motions in turn: \(0.0, 3\) must be a finite time in s and a motion"),
        (lambda: InTurn([(nan, Sliding())]), r"motions in turn: \(nan, .*\) must be a finite time in s and a motion"),
        (lambda: Moving(PLATE, Sliding()), r"Moving\(Segment.*\): must be a Surface and a motion"),
        (lambda: Moving(Surface("lift", PLATE, 0.5, 0.5), None), r"Moving\(.*, None\): must be a Surface and a motion"),
        (lambda: Moving(Surface("lift", PLATE, 0.5, 0.5), Turning), "motion = .* must have about, place and rates"),
    ],
)
def test_what_is_no_motion_is_refused_where_it_is_given(make: Callable[[], object], said: str):
    with pytest.raises(ValueError, match=said):
        make()


def test_a_motion_must_have_what_motions_have():
    with pytest.raises(ValueError, match=r"surface 'lift': motion = 3\.0 must have about, place and rates"):
        run_with(3.0)  # type: ignore[arg-type]


def test_a_ball_goes_along_with_what_turns_in_low_hops():
    """A plate that turns up under a ball without friction or bounce keeps touching it; no energy is from nowhere."""
    start = {"position": (0.5, RADIUS), "velocity": (0.0, 0.1), "restitution": 0.0, "friction": 0.0}
    run = run_with(Turning((0.0, 0.0), 0.2), duration=0.5, **start)  # type: ignore[arg-type]
    times = np.linspace(0.0, 0.5, 101)
    x, y, *_ = run.states("ball", times).T
    above = y * np.cos(0.2 * times) - x * np.sin(0.2 * times) - RADIUS
    assert above.min() > -1e-9
    assert above.max() < 3e-6
    book = ledger(run)
    assert sum(book.impacts.values()) + book.residue == pytest.approx(0.0, abs=1e-6)
    assert book.start + sum(book.work.values()) == pytest.approx(book.end, abs=1e-5)  # a hop more


def flipper(*motions: tuple[float, Motion]) -> Surface:
    """A bar of 1 m about the origin."""
    return Moving(Surface("flipper", Segment((0.0, 0.0), (1.0, 0.0), 0.05), 0.5, 0.3), InTurn(motions))


def simulated_with(surface: Surface, position: tuple[float, float], others: Sequence[Surface], last: float) -> Run:
    ball = Ball("ball", MASS, RADIUS, position, forces=[Gravity(MASS, G)])
    return simulate(Setup([ball], [surface, *others], duration=last), resolve(level="balanced"))


def test_a_ball_is_cradled_until_what_has_turned_turns_again():
    """It rests between a wall and a bar that was raised, is not done with that, and flies when the bar goes on."""
    turns = (0.0, 0.0, 0.0), (2.0, 0.0, 0.1), (0.0, 0.6, 0.4), (4.0, 0.6, 3.0), (0.0, 0.8, 3.05)  # rate, from, when
    bar = flipper(*((start, Turning((0.0, 0.0), rate, angle, start)) for rate, angle, start in turns))
    wall = Surface("wall", Segment((-0.15, -1.0), (-0.15, 2.0)), 0.3, 0.3)
    run = simulated_with(bar, (0.3, 0.3), [wall], 3.2)
    assert next(event.t < 3.0 for event in run.events if event.kind == "rest")
    assert run.arcs["ball"].at(2.9).phase is Phase.RESTING
    assert next(event.t for event in run.events if event.t > 2.9) == pytest.approx(3.0, abs=1e-9)
    assert run.state("ball", 3.05).y > run.state("ball", 2.9).y + 0.01


def test_what_stands_between_two_turns_is_as_any_that_stands():
    bar = flipper((0.0, Turning((0.0, 0.0), 0.0, -0.3)), (2.0, Turning((0.0, 0.0), 1.0, -0.3, 2.0)))
    fixed = Surface("flipper", Segment((0.0, 0.0), (cos(-0.3), sin(-0.3)), 0.05), 0.5, 0.3)
    one, other = (simulated_with(each, (0.3, 0.4), [], 1.0) for each in (bar, fixed))
    assert [event.kind for event in one.events] == [event.kind for event in other.events]
    assert one.state("ball", 1.0) == pytest.approx(other.state("ball", 1.0), abs=1e-9)


def test_a_ball_that_is_pressed_on_something_is_refused_by_name():
    wall = Surface("wall", Segment((1.0, -5.0), (1.0, 5.0)), 0.0, 0.3)
    slope = Segment((-5.0, 3.0), (5.0, -3.0))
    with pytest.raises(RunError, match="'lift', which moves, presses it on 'wall'"):
        run_with(Sliding((0.0, 0.1)), slope, position=(0.0, 0.5), restitution=0.0, friction=0.0, others=[wall])


@pytest.mark.parametrize("velocity", [(0.0, 0.0), (0.3, 0.0), (0.0, 0.5)])
def test_balls_that_press_on_one_another_are_not_carried(velocity: tuple[float, float]):
    balls = [
        Ball(name, MASS, RADIUS, (0.0, y * RADIUS), forces=[Gravity(MASS, G)]) for name, y in (("low", 1), ("high", 3))
    ]
    lift = Moving(Surface("lift", PLATE, 0.8, 0.4), Sliding(velocity))
    with pytest.raises(RunError, match="ball 'low': 'high' presses on it, and it is on 'lift', which moves: "):
        simulate(Setup(balls, [lift], duration=1.0), resolve(level="balanced"))


def test_a_body_bounces_off_what_moves_and_is_not_carried():
    crate = Body("crate", position=(0.0, 1.0), shape=box(0.2, 0.2), mass=1.0, forces=[Gravity(1.0, G)])
    plate = Moving(Surface("lift", PLATE, 0.5, 0.3), Sliding((0.0, 1.0)))
    run = simulate(Setup([crate], [plate], duration=0.5), resolve(level="balanced"))
    first = run.events[0]
    assert first.t == pytest.approx((-1.0 + sqrt(1.0 + 2.0 * G * 0.9)) / G, abs=1e-9)
    assert run.state("crate", first.t).vy == pytest.approx(1.0 + 0.5 * first.speed, abs=1e-6)
    with pytest.raises(RunError, match="'crate': it stays on 'lift', which moves"):
        simulate(Setup([crate], [plate], duration=5.0), resolve(level="balanced"))


def test_a_crate_that_slides_onto_a_belt_is_refused_at_the_seam():
    floor = Surface("floor", Segment((-5.0, 0.0), (0.0, 0.0)), 0.2, 0.3)
    belt = Moving(Surface("belt", Segment((0.0, 0.0), (9.0, 0.0)), 0.2, 0.5), Sliding((-1.0, 0.0)))
    crate = Body("crate", (-1.0, 0.15), (3.0, 0.0), shape=box(0.4, 0.3), mass=2.0, forces=[Gravity(2.0, G)])
    with pytest.raises(RunError, match=r"t = 0.22\d*.*it stays on 'belt'"):  # when its front is over it
        simulate(Setup([crate], [floor, belt], duration=1.5), resolve())


def test_a_setup_with_motions_is_data():
    surface = Moving(
        Surface("gate", PLATE, 0.5, 0.3), InTurn([(0.0, Sliding()), (1.0, Swinging((0.0, 0.0), 0.0, 2.0, -pi))])
    )
    assert pickle.loads(pickle.dumps(surface)) == surface
    assert surface.at(0.5).shape == PLATE
    assert Moving(Surface("gate", PLATE, 0.5, 0.3), Turning((0.0, 0.0), pi)).at(0.5).shape.b == pytest.approx(
        (0.0, 5.0)
    )


def test_pieces_of_a_velocity_follow_each_other_without_a_jump():
    """x = 1 + t^2 until 1.5 s, counted from 0.5 s; then back at 1 m/s."""
    pieces = Sliding([(0.0, ((0.0, 2.0), 0.0)), (1.0, (-1.0, 0.0))], start=0.5, shift=(1.0, 0.0))
    assert [pieces.place(t).x for t in (0.0, 0.5, 1.0, 1.5, 2.5)] == pytest.approx([1.0, 1.0, 1.25, 2.0, 1.0])
    assert [pieces.rates(t).x for t in (0.0, 1.0, 2.0)] == pytest.approx([0.0, 1.0, -1.0])
    assert InTurn([(0.0, pieces), (9.0, Sliding(shift=(-5.5, 0.0)))]).rates(1.0).x == pytest.approx(1.0)


@pytest.mark.parametrize("velocity", [3.0, (1.0,), (1.0, float("nan")), ("a", 0.0), [(0.0, (1.0, 2.0, 3.0))]])
def test_a_velocity_that_is_none_is_refused(velocity):
    with pytest.raises(ValueError, match=r"sliding: velocity = .* must be two finite numbers, \(vx, vy\) in m/s, or"):
        Sliding(velocity)


def test_pieces_must_be_in_order():
    with pytest.raises(ValueError, match="each must begin after the one before"):
        Sliding([(1.0, (1.0, 0.0)), (0.5, (0.0, 0.0))])


def test_a_ball_at_rest_is_struck_by_what_comes_to_it():
    """A blade that turns at 1 rad/s reaches a ball that waits at 90 degrees, less the angle that both cover."""
    blade = Moving(Surface("blade", Segment((0.0, 0.0), (1.0, 0.0)), 0.5, 0.0), Turning((0.0, 0.0), 1.0))
    ball = Ball("ball", MASS, RADIUS, (0.0, 0.5))
    run = simulate(Setup([ball], [blade], duration=2.0, plane=Cloth()), resolve(level="balanced"))
    assert run.events[0].t == pytest.approx(0.5 * pi - asin(RADIUS / 0.5), abs=1e-9)
    assert run.state("ball", 1.5).x < -0.02


def test_balls_that_nothing_reaches_end_the_run():
    blade = Moving(Surface("blade", Segment((0.0, 0.0), (1.0, 0.0)), 0.5, 0.0), Turning((0.0, 0.0), 1.0))
    ball = Ball("ball", MASS, RADIUS, (0.0, 1.5), (1.0, 0.0))
    run = simulate(Setup([ball], [blade], duration=99.0, plane=Cloth()), resolve(level="balanced"))
    assert run.ended == "rest"
    assert run.duration < 99.0


def bounded_motion(kind: int, draw: Callable[[float, float], float]) -> Motion:
    """A random motion of each kind that stays near by."""
    about, rate, last = (draw(-1.0, 1.0), draw(-1.0, 1.0)), draw(-9.0, 9.0), draw(0.1, 1.0)
    if kind == 0:
        return Turning(about, rate, draw(0.0, 6.0))
    if kind == 1:
        return Swinging(about, draw(-2.0, 2.0), draw(0.1, 3.0), shift=(draw(-1.0, 1.0), draw(-1.0, 1.0)))
    if kind == 2:
        times = sorted(draw(-1.0, 3.0) for _ in range(3))
        ways = [(draw(-2.0, 2.0), draw(-2.0, 2.0)), (draw(-2.0, 2.0), draw(-2.0, 2.0)), (0.0, 0.0)]
        return Sliding(list(zip(times, ways, strict=True)), draw(-1.0, 1.0), (0.3, -0.4), about, draw(0.0, 6.0))
    return InTurn([(0.0, Turning(about, rate)), (last, Sliding(about=about, angle=rate * last))])


def test_a_motion_stays_within_its_box():
    for seed in range(120):
        draw = Random(seed).uniform
        motion, points = bounded_motion(seed % 4, draw), [(draw(-2.0, 2.0), draw(-2.0, 2.0)) for _ in range(2)]
        left, bottom, right, top = stays_within(motion, points)
        assert right - left < 50.0
        for t in np.linspace(0.0, 5.0, 40):
            for x, y in (moved(point, motion, t) for point in points):
                assert left - 1e-9 <= x <= right + 1e-9
                assert bottom - 1e-9 <= y <= top + 1e-9
    assert stays_within(Sliding((1.0, 0.0)), [(0.0, 0.0)])[2] == inf


def test_what_moves_too_fast_is_refused_only_where_it_is_met(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(driven, "_MOST_ARCS", 50)
    gate = Segment((-0.5, 0.0), (0.5, 0.0))
    said = "t = .* s: the motion of 'lift' has taken 50 pieces of path, the last .* s long; shorten the duration"
    with pytest.raises(RunError, match=said):
        run_with(to_and_fro(1e-3, (0.0, 0.1)), gate)
    assert run_with(to_and_fro(1e-3, (0.0, 0.1)), gate, position=(2.0, 1.0)).ended == "duration"


def test_a_ball_that_spins_in_its_path_meets_what_moves():
    """Its spin about the vertical ends before it stops: the path beyond that is predicted at once."""
    gate = Moving(Surface("gate", Segment((1.0, -0.2), (1.0, 0.2)), 0.5, 0.2), to_and_fro(2.0, (0.0, 0.1)))
    ball = Ball("ball", MASS, RADIUS, (0.0, 0.0), (2.0, 0.0), spin=1.0, rolling_spin=(0.0, 2.0 / RADIUS))
    run = simulate(Setup([ball], [gate], duration=9.0, plane=Cloth()), resolve(level="balanced"))
    assert run.events[0].partner == "gate"
    assert run.state("ball", run.events[0].t).x == pytest.approx(1.0 - RADIUS, abs=1e-9)
