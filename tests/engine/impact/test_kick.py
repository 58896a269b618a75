"""Surfaces that kick: the impulse they add, alone, in a corner, to bodies, in batches, and its energy."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from sandbox.engine import simulate, simulate_many
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.motion import Sliding
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import box
from sandbox.engine.model.surface import Circle, Moving, Segment, Surface
from sandbox.engine.paths.run import Run
from sandbox.physics.forces import Gravity

MASS, RADIUS, KICK = 0.08, 0.0135, 0.12
BALANCED = resolve(level="balanced")
BUMPER = Surface("bumper", Circle((0.0, 0.0), 0.03), restitution=0.6, friction=0.0, kick=KICK)


def ball_at(x: float, y: float, vx: float, vy: float) -> Ball:
    return Ball("ball", MASS, RADIUS, (x, y), (vx, vy))


def test_a_bumper_adds_its_impulse_along_the_normal():
    """v' = e v + J / m, whatever the speed; the ledger has the work J (v' - J / 2m)."""
    run = simulate(Setup([ball_at(-0.5, 0.0, 2.0, 0.0)], [BUMPER], duration=0.5), BALANCED)
    leaving = 0.6 * 2.0 + KICK / MASS
    assert run.state("ball", 0.5).vx == pytest.approx(-leaving, abs=1e-9)
    book = ledger(run)
    assert book.work["kicked by bumper"] == pytest.approx(KICK * (leaving - 0.5 * KICK / MASS), abs=1e-12)
    assert book.impacts["bumper"] == pytest.approx(-0.5 * MASS * (1.0 - 0.36) * 4.0, abs=1e-12)
    assert (book.jumped, book.residue) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_a_bumper_that_moves_is_driven_and_kicks():
    moving = Moving(BUMPER, Sliding((-1.0, 0.0)))
    run = simulate(Setup([ball_at(-0.5, 0.0, 2.0, 0.0)], [moving], duration=0.4), BALANCED)
    leaving = 0.6 * 3.0 + KICK / MASS  # as seen from it
    assert run.state("ball", 0.4).vx == pytest.approx(-1.0 - leaving, abs=1e-9)
    book = ledger(run)
    assert book.work["kicked by bumper"] == pytest.approx(KICK * (leaving - 0.5 * KICK / MASS), abs=1e-12)
    assert book.work["driven by bumper"] == pytest.approx(MASS * (3.0 + leaving), abs=1e-12)
    assert book.start + sum([*book.work.values(), *book.impacts.values()]) == pytest.approx(book.end, abs=1e-12)


def test_a_ball_that_is_kicked_into_a_wall_bounces_off_that():
    """It comes into the corner of a floor and a side of 45 degrees that kicks it down: it leaves along the floor."""
    floor = Surface("floor", Segment((-1.0, 0.0), (1.0, 0.0)), 0.5, 0.0)
    side = Surface("side", Segment((0.0, 1.0), (1.0, 0.0)), 0.5, 0.0, kick=KICK)
    run = simulate(Setup([ball_at(0.4, RADIUS, 2.0, 0.0)], [floor, side], duration=0.7), BALANCED)
    assert run.events[0].t == pytest.approx((0.6 - RADIUS * (1.0 + sqrt(2.0))) / 2.0, abs=1e-9)
    state = run.state("ball", run.events[0].t + 1e-3)
    assert state.vx < 0.0 <= state.vy
    book = ledger(run)
    assert book.work["kicked by side"] > 0.0
    assert book.jumped == pytest.approx(0.0, abs=1e-12)
    causes = [*book.work.values(), *book.impacts.values(), *book.contacts.values()]
    assert book.start + sum(causes) == pytest.approx(book.end, abs=1e-12)


def test_a_body_that_falls_on_two_points_is_kicked_once():
    """A crate that falls flat on two corners leaves with e v + J / m and without spin."""
    crate = Body("crate", position=(0.0, 0.5), velocity=(0.0, -2.0), shape=box(0.2, 0.2), mass=MASS)
    floor = Surface("floor", Segment((-1.0, 0.0), (1.0, 0.0)), 0.5, 0.0, kick=KICK)
    run = simulate(Setup([crate], [floor], duration=0.4), BALANCED)
    assert run.state("crate", 0.4)[2:5] == pytest.approx((0.0, 1.0 + KICK / MASS, 0.0), abs=1e-6)


def test_many_shots_are_kicked_as_each_alone():
    starts = [
        replace(ball_at(-0.5, aside, 2.0, 0.0), forces=[Gravity(1.0, MASS)]) for aside in np.linspace(-0.04, 0.04, 9)
    ]
    bumpers = [replace(BUMPER, kick=0.01 * place) for place in range(9)]
    setups = [Setup([start], [bumper], duration=0.5) for start, bumper in zip(starts, bumpers, strict=True)]
    together = list(simulate_many(setups, BALANCED))
    for setup, run in zip(setups, together, strict=True):
        assert isinstance(run, Run)
        alone = simulate(setup, BALANCED)
        assert run.state("ball", 0.5) == pytest.approx(alone.state("ball", 0.5), abs=1e-9)
    assert sum(event.partner == "bumper" for run in together if isinstance(run, Run) for event in run.events) >= 5


def test_the_plain_method_kicks_too():
    setup = Setup([ball_at(-0.5, 0.0, 2.0, 0.0)], [BUMPER], duration=0.5)
    ends = [simulate(setup, resolve(method=method)).state("ball", 0.5) for method in ("exact", "plain")]
    assert ends[1] == pytest.approx(ends[0], abs=1e-6)


def test_a_kick_is_not_negative():
    with pytest.raises(ValueError, match="kick = -1"):
        replace(BUMPER, kick=-1.0)
