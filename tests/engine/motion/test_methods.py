"""An integrator is data: three that the program has never heard of run in both engines and in the lab."""

from __future__ import annotations

from dataclasses import replace
from math import cos, hypot, inf, pi, radians, sin

import numpy as np
import pytest

from sandbox.engine import simulate, simulate_many
from sandbox.engine.kernel.step_control import StepControl
from sandbox.engine.many import batch
from sandbox.engine.model.accuracy import LEVELS, Accuracy, resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import ForceRegion, Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.engine.motion.forces_on_ball import acceleration_function
from sandbox.engine.paths.run import Run
from sandbox.lab import timing
from sandbox.lab import trade as lab
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity
from sandbox.physics.integrators import INTEGRATORS
from sandbox.scene import load
from tests.physics.methods import MORE

FLOOR = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.7, 0.4)

CHOICES = {
    "bogacki-shampine": {"tolerance": 1e-4},
    "shu-osher": {"tolerance": 1e-3},
    "ralston": {"step": 1 / 300},
    "rk4": {"step": 1 / 240},
}


@pytest.fixture(autouse=True)
def more(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, integrator in MORE.items():
        monkeypatch.setitem(INTEGRATORS, name, integrator)


def chosen(name: str) -> Accuracy:
    return resolve(integrator=name, **CHOICES[name])


def tossed(number: int) -> Setup:
    angle = radians(30.0 + number)
    forces = [Gravity(9.81, 0.6), Drag(0.12, 1.2, Constant(0.5))]
    ball = Ball("ball", 0.6, 0.12, (0.0, 2.0), (8.0 * cos(angle), 8.0 * sin(angle)), -5.0, forces=forces)
    return Setup([ball], [FLOOR], duration=1.5)


@pytest.mark.parametrize("name", CHOICES)
def test_both_engines_take_it_from_the_table(name: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(batch, "FEWEST", 4)
    setups = [tossed(number) for number in range(0, 30, 4)]
    per_step = {**INTEGRATORS, **MORE}[name].evaluations
    to_the_end = 0
    for setup, together in zip(setups, simulate_many(setups, chosen(name)), strict=True):
        alone = simulate(setup, chosen(name))
        assert isinstance(together, Run), together
        assert together.state("ball", 1.5) == pytest.approx(alone.state("ball", 1.5), abs=1e-9)
        for count in ("steps", "refined_steps", "impacts"):
            assert getattr(together.numerics, count) == getattr(alone.numerics, count)
        # the last few are handed over, and evaluate less from there on
        to_the_end += together.numerics.force_evaluations == (per_step + 1) * together.numerics.steps
        starts = 1 + alone.numerics.impacts  # of the flights; at an impact it also says what presses
        assert alone.numerics.force_evaluations == per_step * alone.numerics.steps + starts
    assert to_the_end > 3


def test_the_step_follows_the_order_of_the_method():
    """A tolerance that is eight times smaller makes the steps of a third-order method half as long."""
    fall = replace(tossed(20), surfaces=[], duration=20.0)
    counts = [
        simulate(fall, resolve(integrator="bogacki-shampine", tolerance=1e-4 / 8**k)).numerics.steps for k in range(3)
    ]
    assert counts[1] / counts[0] == pytest.approx(2.0, rel=0.1)
    assert counts[2] / counts[1] == pytest.approx(2.0, rel=0.1)


def test_steps_follow_a_torque_as_they_follow_a_force():
    """alpha = A cos(w t), so spin = A / w sin(w t), without any force that would shorten the steps."""
    inertia, most, rate = 1e-3, 200.0, 40.0
    ball = Ball("ball", 0.6, 0.12, (0.0, 0.0), inertia_factor=inertia / (0.6 * 0.12**2),
                torques=[lambda t, position, velocity, spin: inertia * most * cos(rate * t)])  # fmt: skip
    run = simulate(Setup([ball], duration=2.0), resolve())
    assert run.state("ball", 2.0)[4] == pytest.approx(most / rate * sin(rate * 2.0), abs=1e-3)


@pytest.mark.parametrize("turn", [0.0, 1.0, pi / 2, 2.5, pi, -pi / 2])
def test_no_step_skips_a_patch(turn: float):
    """A force F over 2 cm brings a ball at 40 m/s, which flies 0.7 m in a step, to v^2 = v0^2 + 2 F d / m."""
    c, s, mass, push, deep = cos(turn), sin(turn), 0.5, 2e4, 0.02
    for way in (1.03, 1.31, 1.57, 1.72):

        def kick(t, position, velocity, spin, way=way):
            inside = abs(position[0] * c + position[1] * s - way) < 0.5 * deep
            return (push * c * inside, push * s * inside)

        x, y = way * c, way * s
        region = ForceRegion(x - deep, y - deep, x + deep, y + deep, 1e-5)
        ball = Ball("ball", mass, 0.1, (0.0, 0.0), (40.0 * c, 40.0 * s), forces=[kick])
        run = simulate(Setup([ball], duration=0.1, force_regions=[region]), resolve(integrator="rk4", step=1 / 60))
        faster = (40.0**2 + 2.0 * push * deep / mass) ** 0.5
        assert hypot(*run.state("ball", 0.1)[2:4]) == pytest.approx(faster, rel=1e-2)


@pytest.mark.parametrize("speed", [1.0, 20.0, 60.0])
@pytest.mark.parametrize("width", [0.0, 1e-9, 0.01, 0.03])
def test_no_step_skips_a_patch_that_is_thinner_than_its_own_step(width: float, speed: float):
    """At 60 m/s a ball is through 1 cm in a 300th of the longest step; one without a width has a border, too."""
    push = 2000.0
    kick = lambda t, position, velocity, spin: (push if 1.0 < position[0] < 1.0 + width else 0.0, 0.0)  # noqa: E731
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.0), (speed, 0.0), forces=[kick])
    region = ForceRegion(1.0, -1.0, 1.0 + width, 1.0, 0.05)
    run = simulate(Setup([ball], duration=2.0 / speed, force_regions=[region]), resolve())
    assert run.state("ball", 2.0 / speed)[2] == pytest.approx((speed * speed + 2.0 * push * width) ** 0.5, rel=1e-3)
    assert any(abs(state[0] - 1.0) < 1e-6 for _, state in run.ends("ball"))
    assert run.numerics.steps < 100


@pytest.mark.parametrize("way", [(1, 0), (-1, 0), (0, 1), (0, -1)])
def test_steps_end_at_the_borders_of_patches(way: tuple[int, int]):
    """Where a force begins, is greatest and ends, each with a kink: found by refusals, these would be 20 steps more."""
    kinks = 1.0, 1.05, 1.1

    def gone(x: float, y: float) -> float:
        return x * way[0] + y * way[1]

    def slowed(t, position, velocity, spin):
        k = -20.0 * max(0.0, 0.05 - abs(gone(*position) - 1.05))
        return k * velocity[0], k * velocity[1]

    def around(near: float, far: float) -> ForceRegion:
        (left, right), (bottom, top) = (sorted((near * part, far * part)) if part else (-1.0, 1.0) for part in way)
        return ForceRegion(left, bottom, right, top, 0.02)

    ball = Ball("ball", 0.5, 0.1, (0.0, 0.0), (8.0 * way[0], 8.0 * way[1]), forces=[slowed])
    run = simulate(Setup([ball], duration=0.5, force_regions=[around(*kinks[:2]), around(*kinks[1:])]), resolve())
    ends = [gone(*state[:2]) for _, state in run.ends("ball")]
    assert all(min(abs(end - kink) for end in ends) < 1e-3 for kink in kinks)
    assert run.numerics.refined_steps < 5


def test_a_path_may_turn_back_at_the_border_of_a_patch():
    """The step ends at its top, v / g after the start, where the speed is zero but for rounding."""
    g = 9.81
    for speed in (0.01 * k for k in range(1, 40)):
        duration = speed / g
        top = duration * (speed - 0.5 * duration * g)
        ball = Ball("ball", 1.0, 0.1, (0.0, 0.0), (0.0, speed), forces=[Gravity(g, 1.0)])
        region = ForceRegion(-1.0, top, 1.0, 1.0, 1e-3)
        run = simulate(Setup([ball], duration=duration, force_regions=[region]), resolve())
        assert run.state("ball", duration)[1:4] == pytest.approx((top, 0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize("speed", [7.285, 7.644, 6.93, 5.6])
def test_no_step_skips_a_patch_that_a_path_only_reaches_into(speed: float):
    """A ball that rises d into a force F comes back, after twice (v - u) / g + u / (g + F / m) with u^2 = 2 g d, as
    fast as it rose."""
    g, mass, push, deep = 9.81, 1.0, 45.0, 0.024
    border, there = speed * speed / (2 * g) - deep, (2 * g * deep) ** 0.5
    net = lambda t, position, velocity, spin: (0.0, -push if position[1] > border else 0.0)  # noqa: E731
    ball = Ball("ball", mass, 0.1, (0.0, 0.0), (0.0, speed), forces=[Gravity(g, mass), net])
    back = 2 * ((speed - there) / g + there / (g + push / mass))
    setup = Setup([ball], duration=back, force_regions=[ForceRegion(-1.0, border, 1.0, border + 2.0, 1 / 240)])
    assert simulate(setup, resolve()).state("ball", back)[1:4] == pytest.approx((0.0, 0.0, -speed), abs=5e-3)


def test_finer_means_half_the_step_for_each_order():
    third, fifth = chosen("bogacki-shampine").finer(), LEVELS["balanced"].finer()
    assert third.tolerance == pytest.approx(1e-4 / 8)
    assert fifth.step == 0.5 * LEVELS["balanced"].step
    assert (fifth.tolerance, fifth.settle) == pytest.approx((1e-3 / 32, 1e-8 / 1024))


def test_trade_measures_it(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(lab, "RATES", (60, 240))
    monkeypatch.setattr(lab, "TOLERANCES", (1e-1, 1e-3))
    monkeypatch.setattr(lab, "LONGEST", inf)  # on a busy machine too
    monkeypatch.setattr(timing, "REPEATS", 1)
    monkeypatch.setattr(lab, "ablation", lambda reference: [])
    monkeypatch.setattr(lab, "shot_map", lambda scene: None)
    points = lab.trade(load("basketball")).points
    for name in MORE:
        coarse, fine = [point for point in points if point.method == name]
        assert coarse.error_m is not None
        assert fine.error_m is not None
        assert fine.error_m < coarse.error_m


def test_the_step_after_an_impact_is_no_longer_than_before():
    for number in range(30):
        setup = tossed(number)
        setup = replace(setup, balls=[replace(setup.balls[0], position=(0.0, 6.0))], duration=3.0)
        bounced = simulate(setup, resolve())
        t = bounced.events[0].t
        cut = simulate(replace(setup, surfaces=[]), resolve()).arcs["ball"].at(t)
        after = bounced.arcs["ball"].at(t)
        assert after.t0 == t
        assert after.t1 - after.t0 <= (cut.t1 - cut.t0) * (1.0 + 1e-12)


def test_a_step_short_only_by_rounding_is_a_whole_step():
    """The wanted step may be the length of an arc, a difference of times: the next one does not depend on its last
    digit, in which one shot differs from the same in a batch."""
    ball, control = tossed(0).balls[0], StepControl(resolve())
    law = acceleration_function(ball)
    step = control.integrator.step_of(law)
    start = (*ball.position, *ball.velocity, ball.spin)

    def following(h: float, wanted: float) -> float | None:
        fits, following, _, _ = control.attempt(step, 0.0, start, law(0.0, start), h, wanted, ball.radius)
        return following if fits else None

    fitting = next(h for h in 0.99 ** np.arange(1000.0) if following(h, h))
    shorter = following(fitting, fitting)
    assert shorter is not None
    assert shorter < fitting
    assert following(fitting, np.nextafter(fitting, 1.0)) == shorter
    assert following(fitting, 1.1 * fitting) == 1.1 * fitting  # of which it is a part
