"""The plain method: it converges where it can, and what it cannot do is an error and not a number."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import dist, hypot

import pymunk
import pytest

import sandbox
from sandbox.engine import plain, simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.motion import Turning
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import MethodFailed
from sandbox.engine.model.shapes import box
from sandbox.engine.model.surface import Bounce, Circle, Moving, Segment, Surface
from sandbox.engine.paths.run import Run
from sandbox.errors import RunError
from sandbox.physics.cloth import Cloth
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity
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


@pytest.mark.parametrize(("english", "follow"), [(0.0, 1.0), (-1.5, -0.5)])
def test_it_converges_to_exact_on_cloth(english: float, follow: float):
    setup = struck(english, follow)
    exact = simulate(setup, resolve("precise"))

    def off(run: Run) -> float:
        return max(
            dist(run.state(ball, run.duration)[:2], exact.state(ball, exact.duration)[:2]) for ball in ("cue", "1")
        )

    coarse, fine = (off(simulate(setup, resolve(**by_steps_of(step)))) for step in (1e-2, 1.2e-3))
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


@pytest.mark.parametrize("scene", ["golf/7-iron", "basketball", "soccer", "minigolf", "pinball/no-hands", "billiards"])
def test_steps_of_a_sixtieth_run_every_sport(scene: str):
    """None falls through turf, net or flipper, and none has its motion reversed by a net."""
    setup = replace(load(scene).build(), duration=9.0)
    met = [
        {event.partner for event in simulate(setup, how).events[:2]}
        for how in (resolve(), resolve(**by_steps_of(1 / 60)))
    ]
    assert met[0] == met[1] != set()


@pytest.mark.parametrize(("scene", "step", "off"), [("golf", 1 / 60, 0.2), ("basketball", 1 / 240, 0.01)])
def test_a_sport_comes_out_as_by_the_exact_method(scene: str, step: float, off: float):
    """Flights to second order, contacts where they are: 9 cm after 16 s and 4 mm after 4 s."""
    setup = replace(load(scene).build(), until=None, duration=4.0 if scene == "basketball" else 16.0)
    ends = [simulate(setup, how) for how in (resolve("precise"), resolve(method="plain", step=step))]
    at = min(run.duration for run in ends)
    assert dist(*(run.state("ball", at)[:2] for run in ends)) < off


@pytest.mark.parametrize("shape", [Segment((2.0, -1.0), (2.0, 1.0)), Circle((2.0, 0.0), 0.01)])
def test_a_bullet_bounces_off_what_is_thin(shape: Segment | Circle):
    bullet = Ball("bullet", 0.01, 0.005, (0.0, 0.0), (300.0, 0.0))
    setup = Setup([bullet], [Surface("wall", shape, 0.5, 0.0)], duration=0.01)
    for step in (1e-2, 1e-3, 1e-5):
        assert simulate(setup, resolve(**by_steps_of(step))).state("bullet", 0.01)[2] == pytest.approx(-150.0)


def test_a_box_that_is_too_fast_has_tunnelled():
    """It is not followed as a ball is: it takes shorter steps, as many as there may be."""
    crate = Body("crate", mass=1.0, shape=box(0.02, 0.02), position=(0.0, 0.0), velocity=(900.0, 0.0))
    setup = Setup([crate], [Surface("wall", Segment((2.0, -9.0), (2.0, 1.0)), 0.5, 0.0)], duration=0.01)
    with pytest.raises(MethodFailed, match=r"tunnelled: t = .*'crate': went through 'wall' within a step of 0.01 s"):
        simulate(setup, resolve(**by_steps_of(1e-2)))
    assert simulate(setup, resolve(**by_steps_of(1e-5))).state("crate", 0.01)[2] == pytest.approx(-450.0)


def test_a_spring_too_stiff_for_its_step_has_exploded():
    """Steps h are stable below 2 / w; a failure keeps its name between processes."""

    def spring(t: float, position: tuple[float, float], velocity: object, spin: float) -> tuple[float, float]:
        return -1e4 * position[0], 0.0

    setup = Setup([Ball("ball", 1.0, 0.1, (1.0, 0.0), forces=[spring])], duration=5.0)
    assert abs(simulate(setup, resolve(**by_steps_of(0.019))).state("ball", 5.0)[0]) < 20.0
    with pytest.raises(MethodFailed, match="exploded: ") as failure:
        simulate(setup, resolve(**by_steps_of(0.03)))
    assert pickle.loads(pickle.dumps(failure.value)).name == "exploded"


def test_balls_that_touch_gain_no_energy():
    """Chipmunk begins a step with the impulses of the one before, scaled: after a short part of a step, too much."""
    run = simulate(load("billiards/newtons-cradle").build(), resolve(**by_steps_of(1 / 60)))
    assert max(hypot(*arc.end[2:4]) for path in run.arcs.values() for arc in path) <= 3.0


def thicknesses(scene: str, level: bool) -> list[float]:
    """Of the level surfaces of a scene, or the upright ones, in m."""
    boxes = [shape.bb for shape in sandbox.pymunk_space(load(scene).build()).static_body.shapes]
    sizes = [(box.right - box.left, box.top - box.bottom) for box in boxes]
    return [min(size) for size in sizes if (size[0] > size[1]) is level]


def test_the_ground_is_thick_and_a_net_is_not():
    """Turf beside the cup too; a board all around a table, but not the roof of a goal, over which balls fly."""
    soccer, golf = thicknesses("soccer", True), thicknesses("golf", True)
    assert (max(soccer), min(soccer)) == (pytest.approx(1.0), pytest.approx(0.0))
    assert sorted(golf)[-4:] == pytest.approx([1.0] * 4)
    assert thicknesses("billiards/three-rail-carom", False) == pytest.approx([1.0, 1.0])


def test_a_surface_that_moves_is_met_as_by_the_exact_method():
    """A bat that turns and kicks."""
    bat = Surface("bat", Segment((0.0, 1.0), (0.0, 0.0), 0.02), 0.6, 0.3, kick=0.1)
    ball = Ball("ball", 0.1, 0.05, (0.8, 0.4), (-3.0, 0.0), forces=[Gravity(9.81, 0.1)])
    setup = Setup([ball], [Moving(bat, Turning((0.0, 1.0), 5.0))], duration=0.5)
    ends = [simulate(setup, resolve(**how)).state("ball", 0.5) for how in ({}, by_steps_of(1e-3))]
    assert ends[0][2] > 1.0
    assert ends[1] == pytest.approx(ends[0], rel=1e-3, abs=2e-3)


def test_a_space_goes_on_with_what_is_added_to_it():
    """A ball on a joint of pymunk's falls as a pendulum, slowed by the air of its setup, onto a block."""
    bob = Ball("bob", 0.6, 0.12, (1.0, 0.0), forces=[Gravity(9.81, 0.6), Drag(0.12, 1.2, Constant(0.5))])
    space = sandbox.pymunk_space(Setup([bob]))
    body = space.named["bob"]
    space.add(pymunk.PinJoint(body, space.static_body))
    for _ in range(100):
        space.step(1 / 240)
    assert space.time == pytest.approx(100 / 240)
    assert body.position.length == pytest.approx(1.0, abs=5e-3)
    lost = 0.6 * 9.81 * -body.position.y - 0.3 * body.velocity.length**2  # J, to the air
    assert 0.0 < lost < 0.3
    block = pymunk.Circle(space.static_body, 0.1, (-0.6, -0.8))
    block.elasticity = 1.0
    space.add(block)
    for _ in range(240):
        space.step(1 / 240)
        assert (body.position - block.offset).length > 0.2195


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
