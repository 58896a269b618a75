"""Bodies that roll, rock, slide and tip on surfaces, against closed forms."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from sandbox.engine.ledger import ledger
from sandbox.engine.model.ball import Body, kinetic
from sandbox.engine.model.shapes import Ellipse, Polygon, Shape, box
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Run
from sandbox.physics.forces import Gravity
from tests.engine.bodies import LEVEL, OUTLINES, G, floor, run_of, thrown


def test_an_ellipse_rocks_to_rest_where_rolling_is_resisted():
    """It stops where the lever of its own weight is less than that of the resistance."""
    start: dict[str, Any] = {"position": (0.0, 0.2), "velocity": (-0.8, 0.0), "spin": 4.0}
    surface = Surface("floor", LEVEL, 0.0, 2.0, rolling_resistance=0.05)
    run = run_of([thrown(Ellipse(0.3, 0.2), **start)], 20.0, [surface])
    turn = run.angle("body", run.duration)
    h = math.sqrt((0.3 * math.sin(turn)) ** 2 + (0.2 * math.cos(turn)) ** 2)
    lever = abs(0.05 * math.sin(turn) * math.cos(turn)) / h
    assert run.ended == "rest"
    assert run.duration > 1.0
    assert lever <= 0.05 * (h + 0.25 * (0.09 + 0.04) / h)


@pytest.mark.parametrize("spin", [-10.0, 2.0, 12.0])
def test_friction_limits_rolling_resistance_of_an_ellipse(spin: float):
    """Where it would slip by resistance alone it rolls on, resisted less."""
    surface = Surface("floor", LEVEL, 0.3, 0.3, rolling_resistance=0.05)
    run = run_of([thrown(Ellipse(0.2, 0.12), position=(0.0, 0.3), velocity=(1.0, 0.0), spin=spin)], 20.0, [surface])
    book = ledger(run)
    assert run.ended == "rest"
    assert abs(book.residue) < 1e-4 * book.start


def test_a_capsule_turning_faster_than_friction_holds_slips():
    """Its end, at l = -0.1 m, is drawn towards the centre by w^2 l: more than the friction of its weight."""
    way, radius, spin = 0.1, 0.2, 20.0
    start = {"position": (0.0, radius), "velocity": (-spin * radius, spin * way), "spin": spin}
    surface = Surface("floor", LEVEL, 0.0, 0.6, rolling_resistance=0.02)
    run = run_of([thrown(Polygon([(-way, 0.0), (way, 0.0)], radius), **start)], 0.005, [surface])
    x, _, vx, _, spin, angle = run.arcs["body"][-1].end
    assert vx + spin * (radius + way * math.sin(angle)) > 0.1  # m/s


def test_a_box_falling_on_its_corner_tumbles_to_rest():
    run = run_of([thrown(box(0.4, 0.3), position=(0.0, 1.0), spin=4.0, angle=0.5)], 4.0, floor(0.5, 0.3))
    assert run.ended == "rest"
    assert run.events[-1].kind == "rest"
    _, y, *motion = run.state("body", run.duration)
    assert motion == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert min(abs(y - 0.15), abs(y - 0.2)) < 5e-4
    assert math.remainder(run.angle("body", run.duration), math.pi / 2) == pytest.approx(0.0, abs=2e-3)


def test_a_box_slides_down_a_slope_as_the_textbook_says():
    """a = g (sin - mu cos)."""
    slope, friction = 0.5, 0.2
    c, s = math.cos(slope), math.sin(slope)
    surface = Surface("slope", Segment((-20.0 * c, 20.0 * s), (20.0 * c, -20.0 * s)), 0.3, friction)
    start = 0.151 * s, 0.151 * c
    run = run_of([thrown(box(0.4, 0.3), position=start, angle=-slope)], 2.0, [surface])
    assert math.hypot(*run.state("body", 2.0)[2:4]) == pytest.approx(G * (s - friction * c) * 2.0, rel=5e-3)


def off_the_end(shape: Shape, angle: float, friction: float, radius: float = 0.0) -> Run:
    """A body that starts on a ledge with 2 m/s, 30 cm before its end."""
    drop = min(math.sin(angle) * x + math.cos(angle) * y for x, y in shape.rim(1e-6))
    ledge = Surface("ledge", Segment((-5.0, -radius), (0.3, -radius), radius), restitution=0.0, friction=friction)
    start = thrown(shape, position=(0.0, 1e-5 - drop), angle=angle, velocity=(2.0, 0.0))
    return run_of([start], 0.6, [ledge])


def test_a_box_sliding_on_its_corner_leaves_at_the_ledge_end():
    """Without friction it keeps its speed along the ledge until its front lower corner is at the end."""
    run = off_the_end(OUTLINES["box"], -0.7, 0.0)
    (leaves,) = (event for event in run.events if event.kind == "leave")
    angle = run.angle("body", leaves.t)
    assert leaves.x == pytest.approx(2.0 * leaves.t, rel=1e-9)
    assert leaves.x + 0.2 * math.cos(angle) + 0.15 * math.sin(angle) == pytest.approx(0.3, abs=1e-9)


@pytest.mark.parametrize("shape", ["box", "rounded box", "ellipse"])
@pytest.mark.parametrize("radius", [0.0, 0.02])
def test_bodies_go_over_the_end_of_a_ledge(shape: str, radius: float):
    for angle, friction in itertools.product((-0.7, -0.3, 0.7), (0.0, 0.3)):
        run = off_the_end(OUTLINES[shape], angle, friction, radius)
        assert run.numerics.steps < 200
        assert run.state("body", 0.6).y < 0.0


def test_an_ellipse_rocks_with_the_period_of_its_energy():
    """(I + m (h^2 + h'^2)) w^2 / 2 + m g h = const with h^2 = a^2 sin^2 + b^2 cos^2; the period is a quadrature."""
    a, b, mass, widest = 0.3, 0.2, 2.0, 0.4
    inertia = mass * (a * a + b * b) / 4

    def height(turn: Any) -> Any:
        return np.sqrt((a * np.sin(turn)) ** 2 + (b * np.cos(turn)) ** 2)

    share = (np.arange(2000) + 0.5) / 2000 * np.pi / 2
    turn = widest * np.sin(share)
    h, slope = height(turn), (a * a - b * b) * np.sin(turn) * np.cos(turn) / height(turn)
    pace = np.sqrt((inertia / mass + h * h + slope * slope) / (2.0 * G * (height(widest) - h)))
    period = 4.0 * float(np.mean(pace * widest * np.cos(share)) * np.pi / 2)
    body = thrown(Ellipse(a, b), position=(0.0, float(height(widest))), angle=widest)
    run = run_of([body], 3.2 * period, floor(0.0, 2.0))
    for count in (1, 2, 3):
        assert run.angle("body", count * period) == pytest.approx(widest, abs=2e-4)
        assert run.angle("body", (count - 0.5) * period) == pytest.approx(-widest, abs=2e-4)
    lost = kinetic(body, run.state("body", 2.25 * period)) - mass * G * float(height(widest) - height(0.0))
    assert lost == pytest.approx(0.0, abs=1e-3 * mass * G * float(height(widest) - height(0.0)))


def test_an_ellipse_slips_and_leaves_where_its_energy_says():
    """Down a slope from rest, rolling with h(a) and l = -h': w^2 from the energy, the forces N and F from w and its
    rate. It slips where |F| = mu N, long before N = 0 with some friction, and just before it with very much."""
    a, b, slope, start, mass = 0.143, 0.12, 0.3, 0.1, 2.0
    turn = start - np.linspace(0.0, 12.0, 400_001)
    c, s = np.cos(turn), np.sin(turn)
    h = np.sqrt((a * s) ** 2 + (b * c) ** 2)
    h1 = (a * a - b * b) * s * c / h
    h2 = (a * a - b * b) * (c * c - s * s) / h - h1 * h1 / h
    inertia = (a * a + b * b) / 4 + h * h + h1 * h1  # over the mass, about the point of contact
    way = np.concatenate(((0.0,), np.cumsum(0.5 * (h[1:] + h[:-1]) * -np.diff(turn))))
    spin2 = 2.0 * G * (way * math.sin(slope) - (h - h[0]) * math.cos(slope)) / inertia
    rate = 0.5 * np.gradient(spin2, turn)
    push, along = G * math.cos(slope) + h2 * spin2 + h1 * rate, -rate * h - spin2 * h1 - G * math.sin(slope)
    surface = [(100.0 * way * math.cos(slope), -100.0 * way * math.sin(slope)) for way in (-1, 1)]
    x, y = h[0] * math.sin(slope), h[0] * math.cos(slope)
    for friction in (0.4, 3.0):
        floor = [Surface("slope", Segment(*surface), 0.0, friction)]
        run = run_of([thrown(Ellipse(a, b), position=(x, y), angle=start - slope, mass=mass)], 1.5, floor)
        slips = next(arc.t0 for arc in run.arcs["body"] if arc.phase is Phase.SLIDING)
        expected = turn[np.argmax(np.abs(along) > friction * push)]
        assert run.angle("body", slips) + slope == pytest.approx(expected, abs=1e-4)
        assert run.state("body", slips)[4] ** 2 == pytest.approx(spin2[np.argmax(turn <= expected)], rel=1e-4)
    assert next(event.t for event in run.events if event.kind == "leave") == pytest.approx(slips, abs=1e-3)


def test_a_torque_works_on_what_rolls():
    """Kinetic energy, m g y and -T (angle) are one sum, to and fro about where they balance."""
    body = thrown(Ellipse(0.3, 0.2), position=(0.0, 0.2), torques=[lambda *state: 0.4])
    run = run_of([body], 2.0, floor(0.0, 2.0))
    assert max(run.angle("body", t) for t in np.linspace(0.0, 2.0, 50)) > 0.1
    for t in np.linspace(0.0, 2.0, 9):
        state = run.state("body", t)
        gone = kinetic(body, state) + body.mass * G * (state[1] - 0.2)
        assert gone == pytest.approx(0.4 * run.angle("body", t), abs=1e-4)


def test_a_domino_tips_and_strikes_its_neighbour():
    """About its edge, w^2 = w0^2 + 2 m g (h0 - h) / I; then the corner meets the face of the next."""
    width, tall, gap, mass, spin = 0.008, 0.045, 0.02, 0.01, -4.0
    rocking = mass * (width**2 + tall**2) / 3.0  # about the edge
    first, second = (
        Body(
            name,
            position=(x + width / 2, tall / 2),
            shape=box(width, tall),
            mass=mass,
            forces=(Gravity(G, mass),),
            **({"velocity": (-spin * tall / 2, -spin * width / 2), "spin": spin} if name == "first" else {}),
        )
        for name, x in (("first", 0.0), ("second", width + gap))
    )
    run = run_of([first, second], 0.2, floor(0.0, 1.0), between_balls=ConstantBounce(Bounce(0.3, 0.0)))
    hit = next(event for event in run.events if {event.ball, event.partner} == {"first", "second"})
    tilt = math.asin(gap / tall)
    drop = tall / 2 - (math.hypot(width, tall) / 2) * math.cos(tilt + math.atan2(-width, tall))
    expected = math.sqrt(spin**2 + 2.0 * mass * G * drop / rocking)
    assert run.angle("first", hit.t) == pytest.approx(-tilt, abs=2e-4)
    assert -run.before("first", hit.t)[4] == pytest.approx(expected, rel=1e-3)
    assert hit.speed == pytest.approx(expected * tall * math.cos(tilt), rel=1e-3)


def test_a_rod_tips_over_its_end_as_the_pendulum_says():
    """From 1.2 rad off the vertical, on a floor that holds: the time to fall is an integral."""
    length, start, mass = 1.0, 1.2, 1.0
    body = thrown(box(1e-3, length), position=(0.0, length / 2 * math.cos(start)), angle=start, mass=mass)
    low = 5e-4 * math.sin(start)
    body = replace(body, position=(0.0, length / 2 * math.cos(start) + low))
    rocking = body.inertia + mass * (length**2 + 1e-6) / 4
    run = run_of([body], 3.0, floor(0.0, 5.0))
    lands = next(event.t for event in run.events if event.kind == "impact")
    share = (np.arange(4000) + 0.5) / 4000
    turn = start + (np.pi / 2 - start) * share**2
    away = math.hypot(length, 1e-3) / 2
    off = math.atan2(1e-3, length)
    fell = away * (np.cos(start - off) - np.cos(turn - off))
    pace = 1.0 / np.sqrt(2.0 * mass * G * fell / rocking)
    assert lands == pytest.approx(float(np.mean(pace * 2.0 * share * (np.pi / 2 - start))), rel=2e-4)
