"""Impacts of bodies: impulses at their points of contact, against closed forms."""

from __future__ import annotations

import itertools
import math
import random
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.ball import Ball, Body, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Ellipse, Polygon, box
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from tests.engine.bodies import OUTLINES, floor, run_of, thrown


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
def test_a_rod_struck_off_its_centre(restitution: float):
    """J = (1 + e) v / (1/M + 1/m + d^2/I); the rod gets J/m and J d/I, the ball loses J/M."""
    mass, rod_mass, length, d, v = 0.3, 1.2, 1.0, 0.35, 4.0
    rod = Body("rod", position=(0.0, 0.0), shape=box(0.02, length), mass=rod_mass)
    ball = Ball("ball", mass, 0.05, (-1.0, d), (v, 0.0))
    law = ConstantBounce(Bounce(restitution, 0.0))
    run = run_of([ball, rod], 0.3, between_balls=law)
    push = (1.0 + restitution) * v / (1.0 / mass + 1.0 / rod_mass + d * d / rod.inertia)
    assert run.events[0].t == pytest.approx((1.0 - 0.05 - 0.01) / v, abs=1e-10)
    state = run.state("rod", 0.3) if restitution else run.state("rod", run.events[0].t)
    assert state[2:] == pytest.approx((push / rod_mass, 0.0, -push * d / rod.inertia), abs=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.05, 5.0])
def test_a_box_on_its_corner(friction: float):
    """The impulse J = K^-1 dv at the corner, with friction up to mu times its normal part, in closed form."""
    angle, spin, vx, restitution = 0.6, 3.0, 1.5, 0.5
    body = thrown(box(0.4, 0.3), position=(0.0, 1.0), velocity=(vx, 0.0), spin=spin, angle=angle)
    run = run_of([body], 0.4, floor(restitution, friction))
    t = run.events[0].t
    x, y, ux, uy, spin = run.before("body", t)
    turned = run.angle("body", t)
    corners = [complex(*corner) * np.exp(1j * turned) for corner in box(0.4, 0.3).corners]  # type: ignore[arg-type]
    lowest = min(corners, key=lambda corner: corner.imag)
    assert y + lowest.imag == pytest.approx(0.0, abs=1e-10)
    rx, ry = lowest.real, lowest.imag
    slip, closing = ux - spin * ry, uy + spin * rx
    m, inertia = body.mass, body.inertia
    k = np.array([[1 / m + ry * ry / inertia, -rx * ry / inertia], [-rx * ry / inertia, 1 / m + rx * rx / inertia]])
    along, up = np.linalg.solve(k, (-slip, -(1.0 + restitution) * closing))
    if abs(along) > friction * up:
        way = math.copysign(friction, along)
        up = -(1.0 + restitution) * closing / (k[1, 1] + k[1, 0] * way)
        along = way * up
    after = ux + along / m, uy + up / m, spin + (rx * up - ry * along) / inertia
    assert run.state("body", t)[2:] == pytest.approx(after, abs=1e-9)


def test_frictionless_elastic_impacts_conserve_everything():
    """Momentum, angular momentum and energy to 1e-10 of what there is, through dozens of impacts."""
    rng = random.Random(4)
    bodies = [
        Body(
            str(number),
            position=(1.3 * math.cos(number), 1.3 * math.sin(number)),
            velocity=(-2.0 * math.cos(number) + rng.uniform(-0.4, 0.4), -2.0 * math.sin(number)),
            spin=rng.uniform(-9.0, 9.0),
            shape=shape,
            mass=rng.uniform(0.5, 3.0),
        )
        for number, shape in enumerate(list(OUTLINES.values())[:6])
    ]
    run = run_of(bodies, 1.5)
    assert len(run.events) >= 6

    def sums(t: float) -> list[float]:
        states = [(body, run.state(body.name, t)) for body in bodies]
        return [
            sum(kinetic(body, state) for body, state in states),
            *(sum(body.mass * state[axis] for body, state in states) for axis in (2, 3)),
            sum(b.mass * (s[0] * s[3] - s[1] * s[2]) + b.inertia * s[4] for b, s in states),
        ]

    assert sums(1.5) == pytest.approx(sums(0.0), abs=1e-10 * sums(0.0)[0])


@pytest.mark.parametrize("spin", [-25.6, 43.3, 52.8])
def test_the_last_hop_of_an_ellipse_gives_it_no_energy(spin: float):
    """The impulse that ends it acts at the point of contact, which is not below the centre."""
    body = thrown(Ellipse(0.143, 0.0865), position=(0.0, 0.3), velocity=(1.5, -1.0), spin=spin, angle=0.5)
    run = run_of([body], 2.0, floor(0.6, 0.5))
    assert any(event.kind == "contact" for event in run.events)
    for before, after in itertools.pairwise(run.arcs["body"]):
        assert kinetic(body, after.start) <= kinetic(body, before.state(before.t1)) + 1e-9


def test_a_64_gon_converges_to_its_ellipse():
    """The first bounce of polygons around the ellipse comes nearer with the square of their corners."""
    start: dict[str, Any] = {"position": (0.0, 1.0), "spin": 3.0, "angle": 0.4}
    inertia = 2.0 * (0.09 + 0.0144) / 4
    exact = run_of([thrown(Ellipse(0.3, 0.12), moment=inertia, **start)], 0.5, floor(0.6, 0.2)).events[0].t
    for count in (64, 256):
        turns = [2.0 * math.pi * k / count for k in range(count)]
        shape = Polygon([(0.3 * math.cos(turn), 0.12 * math.sin(turn)) for turn in turns])
        found = run_of([thrown(shape, moment=inertia, **start)], 0.5, floor(0.6, 0.2)).events[0].t
        assert 0.0 <= found - exact < 0.5 / count**2


@pytest.mark.parametrize("method", ["exact", "plain"])
def test_a_law_gets_approach_and_slip_speeds_on_a_slope(method: Any):
    met = list[tuple[float, float]]()

    def law(approach: float, slip: float) -> Bounce:
        met.append((approach, slip))
        return Bounce(0.5, 0.0)

    c, s, into, along = math.cos(0.4), math.sin(0.4), 3.0, 2.0
    slope = Surface("slope", Segment((-5.0 * c, -5.0 * s), (5.0 * c, 5.0 * s)), 0.5, 0.0, law=law)
    start = {"position": (-s, c), "velocity": (along * c + into * s, along * s - into * c), "angle": 0.4 + math.pi / 4}
    body = Body("body", shape=box(0.3, 0.3), mass=1.0, **start)
    simulate(Setup([body], [slope], 0.35), replace(LEVELS["balanced"], method=method))
    assert met[0] == pytest.approx((into, along))


def test_what_slides_on_a_floor_presses_on_the_wall_it_meets():
    """Free of the floor it would lift off the wall; the floor presses it on. It stalled in 13,000 impacts."""
    wall = Surface("wall", Segment((0.0, 0.0), (0.0, 9.0)), 0.0, 0.1)
    egg = thrown(Ellipse(0.55, 0.34), position=(0.6, 0.35), velocity=(-1.0, 0.0), spin=1.0)
    run = run_of([egg], 2.0, [*floor(0.0, 0.1), wall])
    assert run.numerics.impacts < 20
    assert run.state("body", run.duration)[0] > 0.34 - 1e-9
