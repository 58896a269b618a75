"""The flight of a single ball: the short way through the kernel, and the way through the queue of events."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from sandbox.engine.impact.impulses import DiscOnGround
from sandbox.engine.live import LiveSimulation
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Trap
from sandbox.engine.paths.run import Run
from sandbox.engine.simulation import Simulation
from sandbox.physics.coefficients import GOLF_DRAG, GOLF_LIFT, SOCCER_DRAG, TENNIS_LIFT, Constant, tour_fit_drag
from sandbox.physics.elementwise import of_floats
from sandbox.physics.forces import Drag, Gravity
from sandbox.physics.impulse import exchange
from sandbox.scene import load
from tests.reference.grazing import cases, mistake


def exactly(run: Run) -> list[object]:
    """All that was computed, but the time that it took."""
    arcs = [(arc.t0, arc.t1, arc.start, tuple(map(tuple, arc.curves)), arc.phase) for arc in run.arcs["ball"]]
    return [run.ended, run.duration, run.events, replace(run.numerics, wall_s=0.0), arcs]


@pytest.mark.parametrize(
    "scene", ["golf", "golf/headwind", "basketball/rattle", "tennis", "soccer/goal-kick-in-a-gale", "golf/putt"]
)
def test_a_flight_is_the_same_with_and_without_the_queue(scene: str):
    setup = load(scene).build()
    alone, queued = LiveSimulation(setup, resolve()), Simulation(setup, resolve())
    assert exactly(alone.run()) == exactly(queued.run())


def test_a_trap_in_the_air_catches_a_ball():
    """On its way down through (1, 1): as through the queue."""
    ball = Ball("ball", 1.0, 0.1, (0.0, 1.0), (4.0, 1.22625), forces=[Gravity(9.81), Drag(coefficient=0.01)])
    setup = Setup([ball], traps=[Trap("bag", (1.0, 1.0), 0.2), Trap("far", (9.0, 9.0), 0.1)], duration=5.0)
    run = LiveSimulation(setup, resolve()).run()
    assert [event.kind for event in run.events] == ["caught"]
    assert exactly(run) == exactly(Simulation(setup, resolve()).run())


def test_the_closed_form_of_an_impact_is_that_of_pymunk():
    """Grazing and head on, sticking and sliding, without restitution and without friction."""
    rng, disc = np.random.default_rng(5), DiscOnGround()
    approach, slip = 10.0 ** rng.uniform(-6.0, 2.0, 10_000), rng.normal(0.0, 1.0, 10_000)
    slip *= 10.0 ** rng.uniform(-6.0, 2.0, 10_000)
    factor, restitution, friction = rng.uniform((0.2, 0.0, 0.0), (1.0, 1.0, 2.0), (10_000, 3)).T
    restitution[::7], friction[::11], slip[::13] = 0.0, 0.0, 0.0
    push, rub = exchange(approach, slip, factor, restitution, friction)
    numbers = zip(
        approach.tolist(), slip.tolist(), factor.tolist(), restitution.tolist(), friction.tolist(), strict=True
    )
    found = np.array([disc.exchange(*each) for each in numbers])
    off = abs(found - np.column_stack((push, rub))) / (approach + abs(slip))[:, None]
    assert off.max() < 1e-14
    sticks = abs(rub) < friction * push
    assert 0.1 < sticks.mean() < 0.9
    first = [float(each[0]) for each in (approach, slip, factor, restitution, friction)]
    assert exchange(*first) == (push[0], rub[0])


def test_no_grazing_touch_is_missed():
    """A small part of what tests/reference/grazing.py does."""
    found = [mistake(case) for case in cases(150)]
    assert set(found) == {""}


def test_laws_of_floats_are_the_same_laws():
    for law in (law for laws in (GOLF_DRAG, GOLF_LIFT, SOCCER_DRAG, TENNIS_LIFT) for law in laws.values()):
        for reynolds, spin_ratio in np.random.default_rng(3).uniform((1e4, 0.0), (5e5, 1.5), (20, 2)).tolist():
            assert of_floats(law)(reynolds, spin_ratio) == law(reynolds, spin_ratio)


def test_laws_of_floats_look_at_no_kinds():
    """Of sandbox.physics: the functions of a scene, which may change, are left alone."""
    bound = of_floats(tour_fit_drag).__globals__["tour_fit_lift"].__globals__
    assert bound["exp"] is math.exp
    assert of_floats(exactly) is exactly
    assert of_floats(Constant(0.5)) == Constant(0.5)
