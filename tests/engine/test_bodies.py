"""Bodies of any convex outline: their mass, distances, times of impact and impacts, against closed forms."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.contact import turning_touch
from sandbox.engine.contact.manifold import meeting
from sandbox.engine.contact.turning_touch import OutlineOnArc, first_touch, pose_of
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.ball import Ball, Body, kinetic
from sandbox.engine.model.nearest import Pose, nearest
from sandbox.engine.model.setup import ContactModel, Setup
from sandbox.engine.model.shapes import Ellipse, Polygon, Shape, box, capsule, disc, regular
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.engine.paths.arc import Arc, hermite_arc
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError, RunError
from sandbox.physics.forces import Gravity
from sandbox.physics.ice import Glide

G = 9.81  # m/s^2
OUTLINES = {
    "box": box(0.4, 0.3),
    "rounded box": box(0.4, 0.3, 0.05),
    "triangle": Polygon(((0.1, 0.25), (0.3, 0.0), (0.0, 0.0))),
    "rounded triangle": Polygon(((0.0, 0.0), (0.3, 0.0), (0.1, 0.25)), 0.06),
    "capsule": capsule(0.5, 0.08),
    "disc": disc(0.2),
    "ellipse": Ellipse(0.3, 0.12),
    "heptagon": regular(7, 0.25, 0.02),
}


def random_outline(rng: random.Random) -> Shape:
    size = rng.uniform(0.2, 1.0)
    kind = rng.randrange(4)
    if kind == 0:
        return Ellipse(size, rng.uniform(0.1, 1.0) * size)
    if kind == 1:
        return box(2.0 * size, rng.uniform(0.2, 2.0) * size, rng.choice((0.0, 0.05 * size)))
    if kind == 2:
        return capsule(2.0 * size, rng.uniform(0.1, 0.9) * size)
    turns = [2.0 * math.pi * (k + rng.uniform(0.0, 0.8)) / 6 for k in range(6)]
    return Polygon([(size * math.cos(turn), size * math.sin(turn)) for turn in turns], rng.choice((0.0, 0.1)))


class Push(NamedTuple):
    """A constant force in N."""

    force: tuple[float, float]

    def __call__(self, *state: Any) -> tuple[float, float]:
        return self.force


def floor(restitution: float, friction: float) -> list[Surface]:
    return [Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), restitution, friction)]


def thrown(shape: Shape, *, mass: float = 2.0, **start: Any) -> Body:
    return Body("body", shape=shape, mass=mass, forces=(Gravity(mass, G),), **start)


def run_of(balls: Sequence[Ball], duration: float, surfaces: Sequence[Surface] = (), **more: Any) -> Run:
    return simulate(Setup(balls, surfaces, duration, **more), LEVELS["balanced"])


# ------------------------------------------------------------------------------------------------ outlines


@pytest.mark.parametrize("name", OUTLINES)
def test_mass_properties_are_those_of_a_fine_polygon(name: str):
    area, center, moment = OUTLINES[name].mass_properties()
    fine = Polygon(OUTLINES[name].rim(1e-6)).mass_properties()
    assert (area, *center, moment) == pytest.approx((fine.area, *fine.center, fine.moment), rel=3e-5, abs=1e-6)


@pytest.mark.parametrize(
    ("shape", "factor"),
    [
        (box(0.4, 0.3), (0.16 + 0.09) / 12),
        (disc(0.2), 0.04 / 2),
        (Ellipse(0.3, 0.12), (0.09 + 0.0144) / 4),
        (regular(3, 0.3), 0.09 / 4),
    ],
)
def test_moments_of_inertia_are_those_of_the_textbook(shape: Shape, factor: float):
    assert Body("body", position=(0.0, 0.0), shape=shape, mass=3.0).inertia == pytest.approx(3.0 * factor, rel=1e-14)


def test_mass_from_density_with_given_center_and_moment():
    given = Body("body", position=(0.0, 0.0), shape=box(0.4, 0.3), density=5.0, center=(0.1, 0.0))
    assert given.mass == pytest.approx(0.6)
    assert given.inertia == pytest.approx(0.6 * (0.25 / 12 + 0.01))
    assert replace(given, angle=1.0).outline == given.outline
    elsewhere = Body("body", position=(0.0, 0.0), shape=Ellipse(0.4, 0.3, (0.5, 0.2)), mass=1.0)
    assert elsewhere.outline == Ellipse(0.4, 0.3)
    assert Body("body", position=(0.0, 0.0), shape=box(0.4, 0.3), mass=1.0, moment=0.7).inertia == pytest.approx(0.7)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"shape": box(1.0, 1.0)}, "either mass or density"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "density": 1.0}, "either mass or density"),
        ({"shape": Polygon(((0.0, 0.0), (1.0, 0.0))), "mass": 1.0}, "no area"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "center": (0.6, 0.0)}, "inside"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "angle": math.nan}, "finite"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "moment": -1.0}, "positive"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "rolling_spin": (1.0, 0.0)}, "rolling_spin"),
    ],
)
def test_a_wrong_body_is_refused_with_its_reason(wrong: dict[str, Any], said: str):
    with pytest.raises(ValueError, match=said):
        Body("body", position=(0.0, 0.0), **wrong)


@pytest.mark.parametrize(
    "corners",
    [(), ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), ((0, 0), (2, 0), (1, 0.1), (0, 2)), ((0, 0), (1, 1), (1, 0), (0, 1))],
)
def test_what_is_not_convex_is_refused(corners: tuple[tuple[float, float], ...]):
    with pytest.raises(ValueError, match=r"convex|corners"):
        Polygon(corners)


# ------------------------------------------------------------------------------------------------ distances


def widest(points: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """How far points reach in each direction."""
    reach: np.ndarray = np.max(np.outer(np.cos(turns), points[:, 0]) + np.outer(np.sin(turns), points[:, 1]), axis=1)
    return reach


def height(shape: Shape, at: Pose, turns: np.ndarray) -> np.ndarray:
    """How far an outline reaches in each direction."""
    there = at.x * np.cos(turns) + at.y * np.sin(turns)
    if isinstance(shape, Ellipse):
        return there + np.hypot(shape.a * np.cos(turns - at.angle), shape.b * np.sin(turns - at.angle))
    return there + widest(np.array(shape.corners), turns - at.angle) + shape.radius


@pytest.mark.parametrize("name", OUTLINES)
def test_a_rim_is_within_its_tolerance_without_double_points(name: str):
    shape, turns = OUTLINES[name], np.linspace(-np.pi, np.pi, 361)
    for within in (1e-2, 1e-4):
        rim = shape.rim(within)
        left_out = height(shape, Pose(0.0, 0.0, 0.0), turns) - widest(np.array(rim), turns)
        assert -1e-12 < left_out.min() <= left_out.max() < within
        assert min(map(math.dist, rim, [*rim[1:], rim[0]])) > 1e-6


@pytest.mark.parametrize("name", ["box", "triangle", "rounded triangle", "heptagon"])
def test_rounding_keeps_the_sides_and_cuts_the_corners(name: str):
    x, y = OUTLINES[name].mass_properties().center
    shape, here = OUTLINES[name].moved(-x, -y), Pose(0.0, 0.0, 0.0)
    assert isinstance(shape, Polygon)
    rounder, normals, turns = shape.rounded(0.02), np.array(shape.normals), np.linspace(-np.pi, np.pi, 97)
    assert shape.radius < rounder.radius <= shape.radius + 0.02
    assert height(rounder, here, normals) == pytest.approx(height(shape, here, normals))
    cut = height(shape, here, turns) - height(rounder, here, turns)
    assert -1e-12 < cut.min() < 1e-6 < cut.max() < 0.02


def test_distances_are_the_widest_strip_between():
    rng = random.Random(3)
    for _ in range(40):
        one, other = random_outline(rng), random_outline(rng)
        here, there = (Pose(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-7, 7)) for _ in range(2))
        found = nearest(one, here, other, there)
        coarse = np.linspace(0.0, 2.0 * np.pi, 720)
        at = coarse[np.argmax(-height(one, here, coarse + np.pi) - height(other, there, coarse))]
        for width in (1e-2, 1e-4, 1e-6):
            turns = np.linspace(at - width, at + width, 201)
            strips = -height(one, here, turns + np.pi) - height(other, there, turns)
            at = turns[np.argmax(strips)]
        assert found.gap == pytest.approx(strips.max(), abs=3e-7)
        if strips.max() > 0.0:
            assert math.remainder(found.direction - at, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-3)


def swinging(rng: random.Random, way: float, h: float) -> Arc:
    """A fast path towards the other that starts ``way`` of the middle."""
    x, y, angle = way * rng.uniform(2.0, 3.0), rng.uniform(-1.0, 1.0), rng.uniform(-3.0, 3.0)
    vx, vy, spin = -way * rng.uniform(0.0, 12.0), rng.uniform(-2.0, 2.0), rng.uniform(-40.0, 40.0)
    ax, ay, turning = rng.uniform(-5.0, 5.0), rng.uniform(-10.0, 10.0), rng.uniform(-30.0, 30.0)
    end = (x + h * vx + h * h * ax / 2, y + h * vy + h * h * ay / 2, vx + h * ax, vy + h * ay, spin + h * turning)
    start, end = (x, y, vx, vy, spin, angle), (*end, angle + h * spin + h * h * turning / 2)
    return hermite_arc(0.0, h, start, (ax, ay, turning), end, (ax, ay, turning))


def test_no_touch_of_spinning_outlines_is_missed():
    """Between the start and the time found, sampled finely, they are apart; then they overlap by the skin."""
    rng, hits = random.Random(8), 0
    for _ in range(60):
        one, other = (OutlineOnArc(random_outline(rng), swinging(rng, way, 0.6)) for way in (-1.0, 1.0))
        t = first_touch(one, other, 0.0, 0.6)
        gaps = [
            nearest(one.shape, pose_of(one.arc.state(at)), other.shape, pose_of(other.arc.state(at))).gap
            for at in np.linspace(0.0, 0.6 if t is None else t, 60, endpoint=t is not None)
        ]
        assert min(gaps) > -2.1e-11
        if t is not None:
            hits += 1
            assert gaps[-1] == pytest.approx(-2e-11, abs=1e-12)
    assert hits > 15


def test_the_spin_of_a_disc_costs_no_distance_queries(monkeypatch):
    """It turns no point of its outline's core."""
    asked = []
    monkeypatch.setattr(turning_touch, "nearest", lambda *where: asked.append(where) or nearest(*where))
    start = [(-0.2, 0.1, 1.5, 0.0, 0.0, 0.0), (-1e-7, 0.1, 1.5, 0.0, -20.0)]
    ends = [(state[0] + 1.5 * 0.1, *state[1:]) for state in start]
    arcs = [hermite_arc(0.0, 0.1, *pair, (0.0,) * 3) for pair in zip(start, [(0.0,) * 3] * 2, ends, strict=True)]
    assert first_touch(OutlineOnArc(box(0.2, 0.2), arcs[0]), OutlineOnArc(disc(0.1), arcs[1]), 0.0, 0.1) is None
    assert len(asked) < 10


# ------------------------------------------------------------------------------------------------ impacts


@pytest.mark.parametrize("turn", [0.0, 0.9, -2.0])
def test_stacked_boxes_touch_at_the_ends_of_the_shared_side(turn: float):
    way, up = np.exp(1j * turn), 1j * np.exp(1j * turn)
    large, small = (Body("box", position=(0.0, 0.0), shape=box(width, 0.2), mass=1.0) for width in (2.0, 0.4))
    for along, ends in ((0.3, (0.1, 0.5)), (-0.9, (-1.0, -0.7))):
        place = along * way + 0.2 * up
        met = meeting(small, (place.real, place.imag, 0.0, 0.0, 0.0, turn), large, (0.0, 0.0, 0.0, 0.0, 0.0, turn))
        found = sorted((complex(*point) / way for point in met.points), key=lambda point: point.real)
        assert found == pytest.approx([complex(end, 0.1) for end in ends])
        assert (met.gap, *met.normal) == pytest.approx((0.0, up.real, up.imag), abs=1e-12)


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


@pytest.mark.parametrize("friction", [0.0, 0.15, 0.9])
def test_a_disc_as_body_is_a_ball(friction: float):
    start: dict[str, Any] = {"position": (0.0, 1.2), "velocity": (1.0, 0.5), "spin": -7.0}
    ball = Ball("body", 2.0, 0.2, inertia_factor=0.5, forces=(Gravity(2.0, G),), **start)
    runs = [run_of([one], 1.6, floor(0.8, friction)) for one in (ball, thrown(disc(0.2), **start))]
    assert len(runs[0].events) == len(runs[1].events) >= 2
    assert runs[1].state("body", 1.6) == pytest.approx(runs[0].state("body", 1.6), abs=1e-9)


def grass(normal_speed: float, slip_speed: float) -> Bounce:
    """A law of both speeds, whose surface tilts and gives back some of the slip."""
    return Bounce(0.7 - 0.01 * normal_speed, 0.3 + 0.02 * slip_speed, 0.05, 0.2)


LEVEL, STEEP, SLIGHT = (Segment((-50.0, rise), (50.0, -rise)) for rise in (0.0, 20.0, 2.0))


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
    ball = Ball("body", 2.0, 0.2, inertia_factor=0.5, forces=(Gravity(2.0, G),), **start)
    runs = [run_of([body], 4.0, [surface]) for body in (ball, thrown(disc(0.2), **start))]
    without = run_of([ball], 4.0, [Surface("floor", surface.shape, surface.restitution, surface.friction)])
    assert (len(runs[0].events), *runs[0].state("body", 4.0)) != pytest.approx(
        (len(without.events), *without.state("body", 4.0)), abs=0.05
    )
    assert runs[1].state("body", 4.0) == pytest.approx(runs[0].state("body", 4.0), abs=2e-8)
    assert [event.kind for event in runs[1].events] == [event.kind for event in runs[0].events]
    assert runs[1].ended == runs[0].ended
    plain = replace(LEVELS["balanced"], method="plain", step=5e-4)
    stepped = [simulate(Setup([body], [surface], 1.5), plain) for body in (ball, thrown(disc(0.2), **start))]
    assert stepped[1].state("body", 1.5) == pytest.approx(stepped[0].state("body", 1.5), abs=1e-6)
    assert stepped[1].state("body", 1.5) == pytest.approx(runs[1].state("body", 1.5), abs=0.3)


def test_an_ellipse_rocks_to_rest_where_rolling_is_resisted():
    """It stops where the lever of its own weight is less than that of the resistance."""
    start: dict[str, Any] = {"position": (0.0, 0.2), "velocity": (-0.8, 0.0), "spin": 4.0}
    surface = Surface("floor", LEVEL, 0.0, 2.0, rolling_resistance=0.05)
    run = run_of([thrown(Ellipse(0.3, 0.2), **start)], 20.0, [surface])
    turn = run.angle("body", 20.0)
    h = math.sqrt((0.3 * math.sin(turn)) ** 2 + (0.2 * math.cos(turn)) ** 2)
    lever = abs(0.05 * math.sin(turn) * math.cos(turn)) / h
    assert run.ended == "rest"
    assert run.duration > 1.0
    assert lever <= 0.05 * (h + 0.25 * (0.09 + 0.04) / h)


@pytest.mark.parametrize("spin", [-25.6, 43.3, 52.8])
def test_the_last_hop_of_an_ellipse_gives_it_no_energy(spin: float):
    """The impulse that ends it acts at the point of contact, which is not below the centre."""
    body = thrown(Ellipse(0.143, 0.0865), position=(0.0, 0.3), velocity=(1.5, -1.0), spin=spin, angle=0.5)
    run = run_of([body], 2.0, floor(0.6, 0.5))
    assert any(event.kind == "contact" for event in run.events)
    for before, after in itertools.pairwise(run.arcs["body"]):
        assert kinetic(body, after.start) <= kinetic(body, before.state(before.t1)) + 1e-9


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


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"contact": ContactModel("hertz")}, "hertz.*bodies"),
        ({"surfaces": [Surface("cushion", LEVEL, 0.5, 0.1, nose_height=0.1)]}, "'cushion'.*bodies"),
        ({"plane": Glide(0.1)}, "bodies cannot move on a plane"),
    ],
)
def test_what_bodies_do_not_know_is_refused(more: dict[str, Any], said: str):
    with pytest.raises(ValueError, match=said):
        Setup([Body("body", position=(0.0, 0.0), shape=box(1.0, 1.0), mass=1.0)], **more)


def test_the_plain_method_refuses_what_it_cannot_do():
    setup = Setup([thrown(Ellipse(0.3, 0.2), position=(0.0, 1.0))], [Surface("grass", LEVEL, 0.5, 0.5, 0.1)])
    with pytest.raises(RequestError, match="rolling_resistance of 'grass'"):
        simulate(setup, replace(LEVELS["balanced"], method="plain"))


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


def test_a_box_falling_on_its_corner_tumbles_to_rest():
    run = run_of([thrown(box(0.4, 0.3), position=(0.0, 1.0), spin=4.0, angle=0.5)], 4.0, floor(0.5, 0.3))
    assert run.ended == "rest"
    assert run.events[-1].kind == "rest"
    _, y, *motion = run.state("body", run.duration)
    assert motion == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert min(abs(y - 0.15), abs(y - 0.2)) < 5e-4
    assert math.remainder(run.angle("body", run.duration), math.pi / 2) == pytest.approx(0.0, abs=2e-3)


def test_what_slides_on_a_floor_presses_on_the_wall_it_meets():
    """Free of the floor it would lift off the wall; the floor presses it on. It stalled in 13,000 impacts."""
    wall = Surface("wall", Segment((0.0, 0.0), (0.0, 9.0)), 0.0, 0.1)
    egg = thrown(Ellipse(0.55, 0.34), position=(0.6, 0.35), velocity=(-1.0, 0.0), spin=1.0)
    run = run_of([egg], 2.0, [*floor(0.0, 0.1), wall])
    assert run.numerics.impacts < 20
    assert run.state("body", run.duration)[0] > 0.34 - 1e-9


def test_a_box_slides_down_a_slope_as_the_textbook_says():
    """a = g (sin - mu cos)."""
    slope, friction = 0.5, 0.2
    c, s = math.cos(slope), math.sin(slope)
    surface = Surface("slope", Segment((-20.0 * c, 20.0 * s), (20.0 * c, -20.0 * s)), 0.3, friction)
    start = 0.151 * s, 0.151 * c
    run = run_of([thrown(box(0.4, 0.3), position=start, angle=-slope)], 2.0, [surface])
    assert math.hypot(*run.state("body", 2.0)[2:4]) == pytest.approx(G * (s - friction * c) * 2.0, rel=5e-3)


# ------------------------------------------------------------------------------------------------ lasting contact


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
            forces=(Gravity(mass, G),),
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
            x, y, vx, vy, spin = level.state(ball.name, t)[:5]
            assert tilted.state(ball.name, t)[:5] == pytest.approx((*turned(x, y), *turned(vx, vy), spin), abs=off)


def test_a_torque_may_depend_on_the_angle():
    """I w' = -k (angle): a torsion pendulum turns as A cos((k / I)^(1/2) t), between steps, too; the error follows the
    tolerance."""
    stiffness, most = 0.5, 0.8
    spring = lambda t, position, velocity, spin: -stiffness * position.angle  # noqa: E731
    crate = Body("crate", position=(0.0, 0.0), shape=box(0.4, 0.3), mass=2.0, angle=most, torques=(spring,))
    for level, aimed in (("balanced", 2e-6), ("precise", 2e-8)):
        run = simulate(Setup([crate], duration=3.0), LEVELS[level])
        for t in np.linspace(0.1, 3.0, 30):
            turned, rate = (stiffness / crate.inertia) ** 0.5 * t, (stiffness / crate.inertia) ** 0.5
            assert run.angle("crate", t) == pytest.approx(most * math.cos(turned), abs=aimed)
            assert run.state("crate", t)[4] == pytest.approx(-most * rate * math.sin(turned), abs=20.0 * aimed)


def test_a_force_on_a_body_must_be_real():
    crate = Body(
        "crate", position=(0.0, 0.0), shape=box(0.4, 0.3), mass=2.0, forces=[lambda *state: (1j * state[0], 0)]
    )
    with pytest.raises(RunError, match=r"must return \(fx, fy\) in N.*returned \(.*j, 0\)"):
        run_of([crate], 3.0)


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
        forces = [Gravity(mass, gravity)] if gravity else []
        bodies.append(Body(name, *(place, *start), angle=turned, shape=shape, mass=mass, forces=forces))
    restitution, friction = rng.choice((0.0, 0.3, 0.7, 1.0)), rng.choice((0.0, 0.1, 0.5, 1.5))
    wall = Surface("wall", Segment((-4.0, 0.0), (-4.0, 50.0)), restitution, friction)
    law = ConstantBounce(Bounce(restitution, friction))
    run = run_of(bodies, 2.5, [*floor(restitution, friction), wall], between_balls=law)

    assert run.numerics.impacts < 100

    def energy(t: float) -> float:
        states = [(body, run.state(body.name, t)) for body in bodies]
        return sum(kinetic(body, state) + body.mass * gravity * state[1] for body, state in states)

    for t in np.linspace(0.0, 2.5, 31):
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
