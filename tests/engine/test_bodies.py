"""Whole runs of bodies: compared with balls, by both methods, turned, and with random outlines."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.ball import Ball, Body, kinetic
from sandbox.engine.model.nearest import Pose, nearest
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Ellipse, box, disc
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.engine.paths.run import Run, State
from sandbox.errors import RequestError
from sandbox.physics.forces import Gravity
from tests.engine.bodies import LEVEL, OUTLINES, G, floor, random_outline, run_of, thrown


class Push(NamedTuple):
    """A constant force in N."""

    force: tuple[float, float]

    def __call__(self, *state: Any) -> tuple[float, float]:
        return self.force


def state_at(run: Run, t: float, body: str = "body") -> State:
    """The state of a body at t s, or where it came to rest before."""
    return run.state(body, min(t, run.duration))


@pytest.mark.parametrize("friction", [0.0, 0.15, 0.9])
def test_a_disc_as_body_is_a_ball(friction: float):
    start: dict[str, Any] = {"position": (0.0, 1.2), "velocity": (1.0, 0.5), "spin": -7.0}
    ball = Ball("body", 2.0, 0.2, inertia_factor=0.5, forces=(Gravity(G, 2.0),), **start)
    runs = [run_of([one], 1.6, floor(0.8, friction)) for one in (ball, thrown(disc(0.2), **start))]
    assert len(runs[0].events) == len(runs[1].events) >= 2
    assert runs[1].state("body", 1.6) == pytest.approx(runs[0].state("body", 1.6), abs=1e-9)


def grass(normal_speed: float, slip_speed: float) -> Bounce:
    """A law of both speeds, whose surface tilts and gives back some of the slip."""
    return Bounce(0.7 - 0.01 * normal_speed, 0.3 + 0.02 * slip_speed, 0.05, 0.2)


STEEP, SLIGHT = (Segment((-50.0, rise), (50.0, -rise)) for rise in (20.0, 2.0))


@pytest.mark.parametrize(
    "surface",
    [
        Surface("floor", LEVEL, 0.7, 0.4, law=grass),
        Surface("floor", LEVEL, 0.7, 0.4, lowest_bounce=0.2),
        Surface("floor", LEVEL, 0.0, 0.8, rolling_resistance=0.1),
        Surface("floor", STEEP, 0.0, 0.8, rolling_resistance=0.1),
        Surface("floor", SLIGHT, 0.0, 0.8, rolling_resistance=0.1),
    ],
)
def test_what_a_surface_does_to_a_ball_it_does_to_a_disc(surface: Surface):
    start: dict[str, Any] = {"position": (0.0, 0.9), "velocity": (2.0, 0.5), "spin": -7.0}
    ball = Ball("body", 2.0, 0.2, inertia_factor=0.5, forces=(Gravity(G, 2.0),), **start)
    runs = [run_of([body], 4.0, [surface]) for body in (ball, thrown(disc(0.2), **start))]
    without = run_of([ball], 4.0, [Surface("floor", surface.shape, surface.restitution, surface.friction)])
    assert (len(runs[0].events), *state_at(runs[0], 4.0)) != pytest.approx(
        (len(without.events), *state_at(without, 4.0)), abs=0.05
    )
    assert state_at(runs[1], 4.0) == pytest.approx(state_at(runs[0], 4.0), abs=2e-8)
    assert [event.kind for event in runs[1].events] == [event.kind for event in runs[0].events]
    assert runs[1].ended == runs[0].ended
    plain = replace(LEVELS["balanced"], method="plain", step=1e-3)
    stepped = [simulate(Setup([body], [surface], 1.5), plain) for body in (ball, thrown(disc(0.2), **start))]
    assert state_at(stepped[1], 1.5) == pytest.approx(state_at(stepped[0], 1.5), abs=1e-6)
    assert state_at(stepped[1], 1.5) == pytest.approx(state_at(runs[1], 1.5), abs=0.3)


def test_the_plain_method_refuses_what_it_cannot_do():
    setup = Setup([thrown(Ellipse(0.3, 0.2), position=(0.0, 1.0))], [Surface("grass", LEVEL, 0.5, 0.5, 0.1)])
    with pytest.raises(RequestError, match="rolling_resistance of 'grass'"):
        simulate(setup, replace(LEVELS["balanced"], method="plain"))


@pytest.mark.parametrize("shape", ["box", "rounded triangle", "capsule"])
def test_pymunks_own_stepping_converges_to_the_exact_run(shape: str):
    body = thrown(OUTLINES[shape], position=(0.0, 0.7), velocity=(1.0, 0.0), spin=5.0, angle=0.3)
    setup = Setup([body], floor(0.6, 0.3), 0.6)
    exact = simulate(setup, LEVELS["balanced"])
    assert len(exact.events) >= 1
    plain = [simulate(setup, replace(LEVELS["balanced"], method="plain", step=step)) for step in (2e-3, 1e-4)]
    off = [np.abs(np.subtract(run.state("body", 0.6), exact.state("body", 0.6))).max() for run in plain]
    assert off[1] < 0.02
    assert off[1] < 0.3 * off[0]


#: What touches the ground, above it: balls and bodies at the start, friction and restitution.
GROUNDED: dict[str, tuple[list[Ball], float, float]] = {
    "an ellipse rocks": ([thrown(Ellipse(0.3, 0.2), position=(0.0, 0.25), angle=0.4)], 2.0, 0.0),
    "a box slides": ([thrown(box(0.4, 0.3), position=(0.0, 0.15), velocity=(2.0, 0.0))], 0.2, 0.3),
    "a box tumbles": ([thrown(box(0.4, 0.3), position=(0.0, 0.5), velocity=(2.0, 0.0), spin=4.0)], 0.5, 0.5),
    "a ball rolls off": ([Ball("body", 2.0, 0.2, (4.2, 0.3), (3.0, 0.0), 5.0)], 0.5, 0.3),
    "a triangle on a box": (
        [
            thrown(box(0.4, 0.3), position=(0.0, 0.15)),
            replace(thrown(OUTLINES["triangle"], position=(0.1, 0.6), spin=2.0), name="on it"),
        ],
        0.4,
        0.2,
    ),
}


@pytest.mark.parametrize(
    ("turn", "method", "off"), [(math.pi / 2, "exact", 1e-5), (-2.4, "exact", 1e-5), (-2.4, "plain", 1e-3)]
)
@pytest.mark.parametrize("name", GROUNDED)
def test_it_makes_no_difference_which_way_is_down(name: str, turn: float, method: Any, off: float):
    """The whole world turned: the same run, turned."""
    c, s = math.cos(turn), math.sin(turn)

    def turned(x: float, y: float) -> tuple[float, float]:
        return c * x - s * y, s * x + c * y

    def run_in(way: Callable[[float, float], tuple[float, float]], by: float) -> Run:
        balls = []
        for ball in GROUNDED[name][0]:
            angle = {"angle": ball.angle + by} if isinstance(ball, Body) else {}
            forces = [Push(way(0.0, -G * ball.mass))]
            start = {"position": way(*ball.position), "velocity": way(*ball.velocity), **angle}
            balls.append(replace(ball, forces=forces, **start))
        ground = Surface("ground", Segment(way(-5.0, 0.0), way(5.0, 0.0)), restitution, friction)
        law = ConstantBounce(Bounce(restitution, friction))
        return simulate(Setup(balls, [ground], 1.5, between_balls=law), replace(LEVELS["balanced"], method=method))

    balls, friction, restitution = GROUNDED[name]
    level, tilted = run_in(lambda x, y: (x, y), 0.0), run_in(turned, turn)
    for ball in balls:
        for t in (0.2, 0.7, 1.5):
            x, y, vx, vy, spin = state_at(level, t, ball.name)[:5]
            assert state_at(tilted, t, ball.name)[:5] == pytest.approx((*turned(x, y), *turned(vx, vy), spin), abs=off)


@pytest.mark.parametrize("seed", [5, 20, 21, *range(100, 107), 1020, 1258, 2211])
def test_random_pairs_neither_tunnel_nor_gain_energy_nor_stall(seed: int):
    """Two random outlines and a floor and wall, with and without gravity, any restitution and friction."""
    rng = random.Random(seed)
    gravity, bodies = rng.choice((0.0, G, G)), []
    for name, side in (("0", -1.5), ("1", 1.5)):
        mass = rng.uniform(0.2, 5.0)
        place = rng.uniform(-0.3, 0.3) + side, rng.uniform(1.2, 2.5)
        start = (-math.copysign(rng.uniform(0.0, 8.0), side), rng.uniform(-3.0, 3.0)), rng.uniform(-25.0, 25.0)
        turned, shape = rng.uniform(-3.0, 3.0), random_outline(rng)
        forces = [Gravity(gravity, mass)] if gravity else []
        bodies.append(Body(name, *(place, *start), angle=turned, shape=shape, mass=mass, forces=forces))
    restitution, friction = rng.choice((0.0, 0.3, 0.7, 1.0)), rng.choice((0.0, 0.1, 0.5, 1.5))
    wall = Surface("wall", Segment((-4.0, 0.0), (-4.0, 50.0)), restitution, friction)
    law = ConstantBounce(Bounce(restitution, friction))
    run = run_of(bodies, 2.5, [*floor(restitution, friction), wall], between_balls=law)

    assert run.numerics.impacts < 100

    def energy(t: float) -> float:
        states = [(body, run.state(body.name, t)) for body in bodies]
        return sum(kinetic(body, state) + body.mass * gravity * state[1] for body, state in states)

    for t in np.linspace(0.0, run.duration, 31):
        assert energy(t) <= energy(0.0) * (1.0 + 1e-5)
        poses = [Pose(*run.state(body.name, t)[:2], run.angle(body.name, t)) for body in bodies]
        gap = nearest(bodies[0].outline, poses[0], bodies[1].outline, poses[1]).gap
        assert gap > -4e-3 * min(body.radius for body in bodies)  # what a heap leaves
        assert all(pose.y > 0.0 and pose.x > -4.0 for pose in poses)


@pytest.mark.parametrize(("thickness", "heavier"), [(2e-5, 10.0), (4e-5, 50.0)])
def test_a_sheet_under_a_crate_does_not_fall_through_the_floor(thickness: float, heavier: float):
    """In steps of 1.4 ms, which are short for what is larger, both did."""
    sheet = thrown(box(2e-3, thickness), mass=1e-3, position=(0.0, 1.4e-3), angle=0.9, spin=1.0)
    crate = thrown(box(2e-3, 2e-3), mass=1e-3 * heavier, position=(6e-4, 4.4e-3), angle=0.3)
    bodies = [replace(sheet, name="sheet"), replace(crate, name="crate")]
    run = run_of(bodies, 0.15, floor(0.5, 0.5))
    assert min(run.state(name, run.duration)[1] for name in run.arcs) > 0.4 * thickness
