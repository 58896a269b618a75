"""The plain method: it converges where it can, and what it cannot do is an error and not a number."""

from __future__ import annotations

from math import dist

import pytest

from sandbox.engine import plain, simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, Circle, Segment, Surface
from sandbox.engine.paths.run import Run
from sandbox.errors import RunError
from sandbox.physics.cloth import Cloth
from sandbox.physics.forces import Gravity
from sandbox.scene import load

R, M = 0.028575, 0.170097


def by_steps_of(step: float) -> dict[str, object]:
    return {"method": "plain", "step": step}


def struck(english: float, follow: float) -> Setup:
    """A cut with spin, off a cushion: friction acts in and out of the plane, between balls and on the rail."""
    speed = 1.5
    cue = Ball("cue", M, R, (0.0, 0.0), (speed, 0.0), english * speed / R, (0.0, follow * speed / R))
    rail = Surface("rail", Segment((0.9, -2.0), (0.9, 2.0)), 0.8, 0.2)
    return Setup(
        [cue, Ball("1", M, R, (0.5, 0.6 * R))],
        [rail],
        plane=Cloth(),
        between_balls=lambda normal, slip: Bounce(0.95, 0.06),
    )


def test_an_impact_of_two_balls_divides_the_paths_of_both():
    """So that between samples a path never cuts the corner at an impact."""
    cue, other = Ball("cue", M, R, (0.0, 0.0), (1.0, 0.0)), Ball("1", M, R, (0.5001, 0.0))
    run = simulate(Setup([cue, other], duration=1.0, between_balls=elastic), resolve(**by_steps_of(1e-3)))
    (impact,) = run.events
    for name, before in (("cue", 1.0), ("1", 0.0)):
        assert run.before(name, impact.t)[2] == pytest.approx(before)
        assert run.state(name, impact.t)[2] == pytest.approx(1.0 - before)


def elastic(normal_speed: float, slip_speed: float) -> Bounce:
    return Bounce(1.0, 0.0)


@pytest.mark.parametrize(("english", "follow"), [(0.0, 1.0), (0.0, -1.0), (1.5, 0.5), (-1.5, -0.5)])
def test_it_converges_to_exact_on_cloth(english: float, follow: float):
    setup = struck(english, follow)
    exact = simulate(setup, resolve("precise"))

    def off(run: Run) -> float:
        return max(
            dist(run.state(ball, run.duration)[:2], exact.state(ball, exact.duration)[:2]) for ball in ("cue", "1")
        )

    coarse, fine = (off(simulate(setup, resolve(**by_steps_of(step)))) for step in (1e-2, 6e-4))
    assert fine < 0.02
    assert fine < 0.5 * coarse


@pytest.mark.parametrize("resistance", [0.05, 0.2])
def test_rolling_resistance_stops_a_ball(resistance: float):
    """A rolling ball is slowed by c g: it stops after v^2 / (2 c g)."""
    floor = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.5, 0.5, resistance)
    ball = Ball("ball", 0.2, 0.05, (0.0, 0.05), (2.0, 0.0), -2.0 / 0.05, forces=[Gravity(9.81, 0.2)])
    run = simulate(Setup([ball], [floor], duration=10.0), resolve(**by_steps_of(1e-3)))
    assert run.ended == "rest"
    assert run.state("ball", run.duration)[0] == pytest.approx(2.0**2 / (2.0 * resistance * 9.81), rel=0.02)


def test_a_ball_stepped_through_the_ground_is_reported_lost():
    with pytest.raises(RunError, match=r"ball 'ball': went through '\w+' within a step of 0.00417 s; lower"):
        simulate(load("golf/7-iron").build(), resolve(method="plain"))


@pytest.mark.parametrize("shape", [Segment((2.0, -1.0), (2.0, 1.0)), Circle((2.0, 0.0), 0.01)])
def test_a_bullet_does_not_pass_unseen(shape: Segment | Circle):
    bullet = Ball("bullet", 0.01, 0.005, (0.0, 0.0), (300.0, 0.0))
    setup = Setup([bullet], [Surface("wall", shape, 0.5, 0.0)], duration=0.01)
    with pytest.raises(RunError, match="went through 'wall'"):
        simulate(setup, resolve(**by_steps_of(1e-3)))
    assert simulate(setup, resolve(**by_steps_of(1e-6))).state("bullet", 0.01)[2] == pytest.approx(-150.0, rel=1e-3)


def test_a_run_of_too_many_steps_is_given_up_with_a_hint(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(plain, "MOST_STEPS", 1000)
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0))
    with pytest.raises(RunError, match=r"t = 0.001 s of 60 s: 1,000 steps of 1e-06 s; lengthen accuracy.step"):
        simulate(Setup([ball]), resolve(**by_steps_of(1e-6)))


def test_how_far_it_is_can_be_followed(monkeypatch: pytest.MonkeyPatch):
    told: list[tuple[float, float]] = []
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0))
    simulate(Setup([ball], duration=0.5), resolve(**by_steps_of(1e-3)), lambda t, most: told.append((t, most)))
    assert len(told) > 50
    assert told == sorted(told)
    assert {most for _, most in told} == {0.5}
    monkeypatch.setattr(plain, "MOST_STEPS", 1000)
    with pytest.raises(RunError):
        simulate(Setup([ball]), resolve(**by_steps_of(1e-3)), lambda t, most: told.append((t, most)))
    assert told[-1] == (pytest.approx(1.0, abs=0.01), 1.0)


@pytest.mark.parametrize(("level", "rate"), [("fast", 60), ("balanced", 240), ("precise", 960)])
def test_each_level_has_its_steps_a_second(level: str, rate: int):
    thrown = Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0))], duration=0.5)
    assert simulate(thrown, resolve(level, method="plain")).numerics.pymunk_steps == rate / 2


def test_a_run_says_how_it_was_stepped():
    assert resolve(method="plain").steps == "steps of 4.17 ms"
    assert resolve(integrator="heun", step=0.01).steps == "heun, steps of 10 ms"
    assert resolve().steps == "dormand-prince"


def test_a_bounce_below_the_lowest_is_lost_in_the_surface():
    """Dropped from 4 mm, it would rise 1 mm: 10 mm of grass swallow that, and nothing of a bounce of 16 mm."""
    grass = Surface("grass", Segment((-9.0, 0.0), (9.0, 0.0)), 0.5, 0.5, lowest_bounce=0.01)
    for drop, rises in ((0.004, 0.0), (0.064, 0.016)):
        ball = Ball("ball", 0.05, 0.02, (0.0, 0.02 + drop), forces=[Gravity(9.81, 0.05)])
        run = simulate(Setup([ball], [grass], duration=1.0), resolve(**by_steps_of(2e-4)))
        landed = next(event.t for event in run.events if event.kind == "impact")
        highest = max(run.state("ball", min(landed + 0.01 * k, run.duration))[1] for k in range(1, 30)) - 0.02
        assert highest == pytest.approx(rises, abs=6e-4)


def test_what_lies_feels_a_push_that_comes_later():
    """x = 10/2 (t - 1)^2."""
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.1), forces=[Gravity(9.81), lambda t, *_: (10.0 * (t >= 1.0), 0.0)])
    floor = Surface("floor", Segment((-99.0, 0.0), (99.0, 0.0)), 0.0, 0.0)
    run = simulate(Setup([ball], [floor], duration=2.0), resolve(method="plain"))
    assert (run.ended, run.duration) == ("duration", 2.0)
    assert run.state("ball", 2.0).x == pytest.approx(5.0, abs=0.05)
