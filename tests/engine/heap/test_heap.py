"""Balls that press on one another: they come to rest without overlap, roll together as their forces say, and part."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, pairwise
from math import cos, hypot, pi, sin, sqrt
from random import Random

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.contact.touch import Outline
from sandbox.engine.heap.stepping import Stepper
from sandbox.engine.impact.cluster_parts import ClusterBall
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.ball import Body as Outlined
from sandbox.engine.model.setup import ContactModel, Setup
from sandbox.engine.model.shapes import Ellipse, box
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.engine.paths.phase import InCluster, InHeap
from sandbox.errors import RunError
from sandbox.physics.forces import Gravity
from tests.engine.contact_law import by_contact_law

R, M, G = 0.03, 0.1, 9.81  # m, kg, m/s^2


class Push:
    """A constant force to the right, in N."""

    def __init__(self, force):
        self.force = force

    def __call__(self, t, position, velocity, spin):
        return self.force, 0.0


def ball(name, x, y, vx=0.0, vy=0.0, push=0.0):
    return Ball(str(name), M, R, (x, y), (vx, vy), forces=[Gravity(G, M), *([Push(push)] if push else [])])


def surface(name, a, b, restitution=0.5, friction=0.5, resistance=0.02):
    return Surface(name, Segment(a, b), restitution, friction, resistance)


FLOOR = [surface("floor", (-5.0, 0.0), (5.0, 0.0))]
TURNS = [pi + pi * part / 24 for part in range(25)]
RIM = [(0.5 * cos(turn), 0.5 + 0.5 * sin(turn)) for turn in TURNS]
BOWL = [surface(f"bowl {place}", *ends) for place, ends in enumerate(pairwise(RIM))]
BOX = [*FLOOR, surface("left", (-0.25, 0.0), (-0.25, 9.0)), surface("right", (0.25, 0.0), (0.25, 9.0))]
SLOPE = [surface("slope", (-4.0, 1.46), (0.0, 0.0)), surface("wall", (0.0, -0.5), (0.0, 3.0))]


def poured(count, across, x=0.0, y=0.6):
    random = Random(count)
    columns = int(across / (2.4 * R))
    return [
        ball(
            place,
            x + (place % columns - 0.5 * columns + 0.5) * 2.4 * R + 0.1 * R * random.uniform(-1, 1),
            y + place // columns * 2.4 * R + 0.1 * R * random.uniform(-1, 1),
        )
        for place in range(count)
    ]


def pyramid(rows):
    places = [(row, place) for row in range(rows) for place in range(rows - row)]
    return [ball(f"{row} {place}", (2 * place - rows + row + 1) * R, R + row * sqrt(3) * R) for row, place in places]


def run_of(balls, surfaces, friction=0.3, restitution=0.5, duration=30.0, level="balanced"):
    setup = Setup(balls, surfaces, duration, between_balls=ConstantBounce(Bounce(restitution, friction)))
    return simulate(setup, resolve(level))


def overlap(run, t):
    """The deepest overlap at t, as a fraction of the radius."""
    places = {each.name: run.state(each.name, t)[:2] for each in run.setup.balls}
    between = [2 * R - hypot(a[0] - b[0], a[1] - b[1]) for a, b in combinations(places.values(), 2)]
    within = [-Outline.of(each.shape, R).near(x, y).gap for each in run.setup.surfaces for x, y in places.values()]
    return max(*between, *within) / R


def heaped(run):
    return [arc for path in run.arcs.values() for arc in path if isinstance(arc.contact, InHeap)]


HEAPS = {
    "one on one": ([ball(0, 0.0, R), ball(1, 0.005, 0.3)], FLOOR),
    "one on two": ([ball(0, -R, R), ball(1, R, R), ball(2, 0.0, 0.2)], FLOOR),
    "a column": ([ball(place, 0.0, R + 2.5 * R * place) for place in range(3)], BOX),
    "a pyramid": (pyramid(4), FLOOR),
    "3 into a bowl": (poured(3, 0.3), BOWL),
    "8 into a bowl": (poured(8, 0.3), BOWL),
    "12 into a box": (poured(12, 0.4), BOX),
    "8 down a slope": (poured(8, 0.4, -0.5), SLOPE),
}


@pytest.mark.parametrize("heap", HEAPS)
def test_a_heap_rests_without_overlap_and_its_ledger_closes(heap):
    run = run_of(*HEAPS[heap])
    assert run.ended == "rest"
    assert overlap(run, run.duration) < 1e-4
    book = ledger(run)
    booked = sum(book.work.values()) + sum(book.impacts.values()) + sum(book.contacts.values())
    assert book.start + booked == pytest.approx(book.end, abs=1e-9)
    assert abs(book.residue) < 1e-9
    fallen = sum(run.state(ball.name, 0.0)[1] - run.state(ball.name, run.duration)[1] for ball in run.setup.balls)
    assert book.work["gravity"] == pytest.approx(M * G * fallen, rel=0.02)  # but for what it does during impacts
    assert book.contacts.get("heap", 0.0) < 1e-3 * sum(book.work.values())  # a few steps may err by that
    assert -1e-12 <= book.contacts["position correction"] < 0.01 * sum(book.work.values())
    assert any(abs(arc.contact.vy) > 1e-5 for arc in heaped(run))
    for arc in heaped(run):  # what position correction moves is no speed, wherever a step is cut
        start, middle, end = (np.array(arc.state(t)[2:4]) for t in (arc.t0, 0.5 * (arc.t0 + arc.t1), arc.t1))
        assert middle == pytest.approx(0.5 * (start + end), abs=1e-9)


def scaled(scale, bodies, proportional=True):
    """Three that fall into a box, with all lengths and accelerations scaled in proportion, and times by the root."""
    root, outlines = sqrt(scale), [box(0.05 * scale, 0.03 * scale), Ellipse(0.03 * scale, 0.02 * scale), None]
    balls = []
    for place, outline in enumerate(outlines):
        common = {"position": (0.01 * place * scale, (0.04 + 0.07 * place) * scale), "velocity": (0.3 * root, 0.0)}
        mass = M * scale**3
        common |= {"mass": mass, "forces": [Gravity(G, mass)]}
        disc = Ball(str(place), radius=0.03 * scale, **common)
        balls.append(Outlined(str(place), shape=outline, angle=0.3, **common) if bodies and outline else disc)
    walls = [(-9.0, 0.0, 9.0, 0.0), (-0.06, 0.0, -0.06, 9.0), (0.06, 0.0, 0.06, 9.0)]
    walls = [[scale * length for length in wall] for wall in walls]
    surfaces = [surface(f"wall {place}", wall[:2], wall[2:]) for place, wall in enumerate(walls)]
    laws = {"between_balls": ConstantBounce(Bounce(0.4, 0.4)), "contact": ContactModel("rigid")}
    accuracy = resolve("balanced")
    if proportional:
        lengths = {"settle": scale * accuracy.settle, "skin": scale * accuracy.skin}
        accuracy = replace(accuracy, step=root * accuracy.step, **lengths)
    return simulate(Setup(balls, surfaces, 30.0 * root, **laws), accuracy)


def test_balls_that_are_poured_into_a_bowl_do_not_sink_into_it():
    """While those above press on them, those below are struck against it again and again."""
    run = run_of(poured(24, 0.5), BOWL, duration=0.4)
    assert max(overlap(run, t) for t in np.linspace(0.34, 0.4, 16)) < 0.05


@pytest.mark.parametrize("bodies", [False, True])
def test_heaps_of_any_size_come_to_rest_alike(bodies):
    """From 1/100 to 100 times as large: exactly so at an accuracy in proportion, and at rest at the usual one."""
    whole = scaled(1.0, bodies)
    assert whole.ended == scaled(0.01, bodies, proportional=False).ended == "rest"
    for scale in (0.01, 100.0):
        run = scaled(scale, bodies)
        assert run.duration == pytest.approx(sqrt(scale) * whole.duration, rel=0.05)  # when is noticed after a step
        for each in run.setup.balls:
            place = np.array(run.state(each.name, run.duration)[:2]) / scale
            assert place == pytest.approx(whole.state(each.name, whole.duration)[:2], abs=3e-3 * R)


@pytest.mark.parametrize("restitution", [0.0, 0.95, 1.0])
def test_a_heap_of_any_restitution_is_no_error(restitution):
    """With no loss between balls only the floor takes energy."""
    run = run_of([ball(place, 0.001 * place, R + 3 * R * place) for place in range(4)], BOX, 0.2, restitution)
    assert run.ended == "rest"
    assert overlap(run, run.duration) < 1e-4


def test_heavy_balls_that_wedge_light_ones_come_to_rest():
    """On a slope without friction, against a wall: the heaviest is a hundred times as heavy as the lightest."""
    places = [(-73.71, 87.51), (-73.78, 94.44), (-85.57, 98.77), (-73.93, 101.74), (-59.44, 105.01)]  # mm
    balls = []
    for number, ((x, y), r) in enumerate(zip(places, (3.219, 3.386, 0.73, 2.104, 1.006), strict=True)):
        mass = 1e-6 * r**3
        balls.append(Ball(str(number), mass, 1e-3 * r, (1e-3 * x, 1e-3 * y), forces=[Gravity(G, mass)]))
    surfaces = [replace(each, restitution=0.8, friction=0.0) for each in SLOPE]
    run = run_of(balls, surfaces, 0.2, 0.0, duration=2.0)
    for each in balls:  # one that lies alone may spin on: nothing rubs on it
        assert run.state(each.name, run.duration)[2:4] == (0.0, 0.0)


@pytest.mark.parametrize("stiffness", [1e4, 1e6])
def test_soft_balls_stay_in_their_bowl(stiffness):
    """They are not pressed through it while they press on one another, for milliseconds and centimetres."""
    laws = {"between_balls": ConstantBounce(Bounce(0.6, 0.2)), "contact": ContactModel("auto", stiffness)}
    run = simulate(Setup(poured(8, 0.3), BOWL, 30.0, **laws), resolve("balanced"))
    assert run.ended == "rest"
    assert overlap(run, run.duration) < 1e-4
    assert all(run.state(ball.name, run.duration)[1] > 0.0 for ball in run.setup.balls)


def test_a_pyramid_at_rest_stays_at_rest():
    run = run_of(pyramid(4), FLOOR, friction=1.0)
    assert run.ended == "rest"
    for each in run.setup.balls:
        assert run.state(each.name, run.duration)[:2] == pytest.approx(each.position, abs=2e-3 * R)


def test_without_friction_a_pyramid_slides_apart():
    run = run_of(pyramid(2), [surface("floor", (-5.0, 0.0), (5.0, 0.0), 0.5, 0.0, 0.0)], friction=0.0, duration=0.6)
    x, y, vx, *_ = run.state("0 1", 0.6)
    assert x > 3 * R
    assert vx > 0.1
    assert run.state("1 0", 0.6)[1] == pytest.approx(R, abs=1e-3)


def test_a_ball_that_pushes_another_rolls_as_its_force_says():
    """Two roll as one: a = F / (2 m (1 + k)) - c g, without friction between them."""
    force, resistance = 0.2, 0.02
    floor = [surface("floor", (-5.0, 0.0), (50.0, 0.0), 0.5, 0.8, resistance)]
    run = run_of([ball("rear", 0.0, R, push=force), ball("front", 2 * R, R)], floor, friction=0.0, duration=2.0)
    expected = 0.5 * (force / (2 * M * 1.4) - resistance * G) * 2.0**2
    assert run.state("front", 2.0)[0] - 2 * R == pytest.approx(expected, rel=2e-3)
    assert run.state("rear", 2.0)[0] == pytest.approx(expected, rel=2e-3)
    contact = run.state("front", 2.0)[2]
    assert run.state("front", 2.0)[4] == pytest.approx(-contact / R, rel=1e-3)


def test_what_flies_while_a_heap_comes_to_rest_meets_it():
    """At 0.28 s, on an arc that began before the heap was at rest, at 0.24 s."""
    run = run_of([*pyramid(2), ball("late", 0.0, 0.53)], FLOOR, friction=1.0, duration=0.4)
    first = next(event for event in run.events if event.kind == "impact")
    assert first.t == pytest.approx(sqrt(2.0 * (0.53 - 3.0 * R - sqrt(3) * R) / G), rel=1e-3)


def test_a_heap_at_rest_that_is_struck_moves_and_rests_again():
    struck = [*pyramid(2), ball("late", -3.0, R, vx=2.5)]
    run = run_of(struck, FLOOR, friction=1.0)
    assert run.state("1 0", 0.9)[:2] == pytest.approx((0.0, R + sqrt(3) * R), abs=1e-4)
    assert hypot(run.state("1 0", run.duration)[0], run.state("1 0", run.duration)[1] - R - sqrt(3) * R) > R
    assert run.ended == "rest"
    assert overlap(run, run.duration) < 1e-4


TUB = [*FLOOR, surface("left", (-4 * R, 0.0), (-4 * R, 9.0), 0.5, 0.0), surface("right", (4 * R, 0.0), (4 * R, 9.0))]


@pytest.mark.parametrize(("aside", "restitution"), [(0.0, 0.9), (0.3 * R, 0.5)])
def test_a_blow_goes_through_a_heap_by_contact_mechanics(aside, restitution):
    """A ball dropped on a pyramid of ten: to 0.1 % of its speed as by an integration of the same law."""
    balls = [*pyramid(4), ball("late", aside, R + 3 * sqrt(3) * R + 2.2 * R + 0.1)]
    run = run_of(balls, TUB, 0.0, restitution, 0.2)
    blow = next(event for event in run.events if "late" in (event.ball, event.partner))
    pressed = {each.name: arc for each in balls for arc in run.arcs[each.name] if isinstance(arc.contact, InCluster)}
    assert {arc.contact.start for arc in pressed.values()} == {blow.t}
    assert len(pressed) == 11
    states = [run.before(each.name, blow.t) for each in balls]
    bodies = [
        ClusterBall(
            M, R, 0.4 * M * R * R, state[:2], state[2:4], (0.0, 0.0, 0.0), (0.0, -G if each is balls[-1] else 0.0)
        )
        for each, state in zip(balls, states, strict=True)
    ]
    lasts = pressed["late"].t1 - blow.t
    expected = by_contact_law(bodies, [lasts], run.setup.contact.between(R, R), restitution, accuracy=1e-6)[-1]
    found = [pressed[each.name].end[2:4] for each in balls]
    assert np.abs(found - expected[:, 2:4]).max() < 1e-3 * blow.speed


def test_a_pair_far_from_a_heap_meets_as_if_there_were_none():
    """Heads a three-ball chain, touching, in the air above a heap on the floor."""
    chain = [ball(place, 1.0 + 2 * R * place, 2.0, vx=0.0 if place else 1.0) for place in range(3)]
    alone, beside = (run_of(balls, FLOOR, 0.0, 1.0, 0.1) for balls in (chain, [*chain, *pyramid(2)]))
    for each in chain:
        assert beside.state(each.name, 0.1) == pytest.approx(alone.state(each.name, 0.1), abs=1e-9)
    assert alone.numerics.clusters == beside.numerics.clusters == 1


def test_what_rests_far_from_a_heap_that_settles_rests_once():
    far = Outlined("far", shape=box(0.1, 0.05), mass=M, position=(2.0, 0.03), forces=[Gravity(G, M)])
    run = run_of([far, *poured(8, 0.4)], BOX)
    rests = [event.t for event in run.events if event.kind == "rest" and event.ball == "far"]
    assert len(rests) == 1
    assert rests[0] < 0.5 < run.duration


def test_balls_that_part_fly_on_exactly():
    """Thrown up together in touch, they press on nothing: two parabolas, and soon no heap."""
    run = run_of([ball("a", 0.0, 1.0, vy=2.0), ball("b", 2 * R, 1.0, vy=2.0)], FLOOR, duration=0.3)
    for name in "ab":
        assert run.state(name, 0.3)[1] == pytest.approx(1.0 + 2.0 * 0.3 - 0.5 * G * 0.3**2, abs=1e-9)
    assert run.numerics.pymunk_steps < 12


def test_a_heap_creating_energy_is_an_error_naming_its_bodies(monkeypatch):
    """Here each step lifts two that rest on each other by 1 mm."""
    solve = Stepper._solve

    def lifting(self, members, touches, share):
        solve(self, members, touches, share)
        for member in members:
            member.y += 1e-3

    monkeypatch.setattr(Stepper, "_solve", lifting)
    below = Outlined("below", shape=box(0.2, 0.1), mass=M, position=(0.0, 0.05), forces=[Gravity(G, M)])
    above = Outlined("above", shape=box(0.2, 0.1), mass=M, position=(0.02, 0.15), forces=[Gravity(G, M)])
    with pytest.raises(
        RunError, match=r"^t = .* s: .* J appeared from nothing in the heap of 'above', 'below'"
    ) as said:
        run_of([below, above], FLOOR)
    assert "\n" not in str(said.value)


def test_a_heavy_ball_on_a_light_one_is_carried_by_it():
    """A thousand times as heavy: iterations that begin anew with each step let it sink."""
    light = Ball("light", 0.01, R, (0.0, R), forces=[Gravity(G, 0.01)])
    heavy = Ball("heavy", 10.0, R, (0.0, 3 * R + 1e-4), forces=[Gravity(G, 10.0)])
    walls = [surface(name, (x, 0.0), (x, 9.0), friction=0.0) for name, x in (("left", -R), ("right", R))]
    run = run_of([light, heavy], [*FLOOR, *walls], restitution=0.0, duration=1.0)
    assert run.state("heavy", run.duration)[1] == pytest.approx(3 * R, abs=1e-3 * R)
    assert max(overlap(run, t) for t in np.linspace(0.0, run.duration, 60)) < 0.02


def test_boxes_that_fall_together_on_the_next_corner_go_on():
    """The heavy one stands on a corner, and the next is too fast for a step: they would meet at the first for ever."""
    light = Outlined("light", shape=box(0.12046802348009102, 0.08343080498424456), mass=0.0793, forces=[Gravity(G)],
                     angle=3.0937468359950904, position=(-0.05684286983151058, 0.04467280985305697))  # fmt: skip
    heavy = Outlined("heavy", shape=box(0.07092984450777058, 0.1886014506849759), mass=22.65, forces=[Gravity(G)],
                     angle=-0.033474838010031364, position=(-0.0429041753576802, 0.1814089808534181),
                     velocity=(0.09779858663345493, -0.23078153896644318), spin=-2.324644841737424)  # fmt: skip
    turns = [pi * part / 40 for part in range(18, 23)]
    rim = [(-1.3242553226347955 * cos(turn), 1.3242553226347955 * (1.0 - sin(turn))) for turn in turns]
    bowl = [surface(f"bowl {place}", *ends, 0.0764, 0.8066, 0.0) for place, ends in enumerate(pairwise(rim))]
    numerics = run_of([light, heavy], bowl, 0.4776, 0.7668, duration=0.006).numerics
    assert numerics.impacts < 40


def test_an_ellipse_slides_for_a_moment_and_rolls_on():
    """Its slide begins with a slip of 6e-17 m/s, by rounding, which is not its end."""
    sizes = (0.09189541639610163, 0.03786986286671355), (0.09258495762422515, 0.052231609147767484)
    masses, angles = (3.861335265054276, 0.14619016794422457), (-0.8595695687670024, -1.0017605877861686)
    places = (0.13385698964870327, 0.24), (0.005662145564124633, 0.56)
    velocities = (-0.46095933497303543, 0.07344789118421646), (-0.9207608536679717, 0.39190176583978986)
    bodies = []
    for number, spin in enumerate((3.655889253358799, 1.4770402538350336)):
        motion = {"position": places[number], "velocity": velocities[number], "spin": spin, "angle": angles[number]}
        mass, shape = masses[number], Ellipse(*sizes[number])
        bodies.append(Outlined(str(number), shape=shape, mass=mass, forces=[Gravity(G, mass)], **motion))
    sides = [((-20.0, 6.0), (0.4, -0.12)), ((0.4, -0.12), (0.4, 4.0))]
    surfaces = [surface(str(number), *ends, 0.6, 0.2, 0.0) for number, ends in enumerate(sides)]
    run = run_of(bodies, surfaces, 0.6, 0.0, duration=1.5)
    assert run.duration == 1.5


def boxes(rows, speed=0.0):
    """A pyramid of boxes that slides at this speed in m/s."""
    places = [(0.21 * k + 0.105 * row, 0.05 + 0.1 * row) for row in range(rows) for k in range(rows - row)]
    common = {"shape": box(0.2, 0.1), "mass": 0.5, "velocity": (speed, 0.0), "forces": [Gravity(G, 0.5)]}
    return [Outlined(str(number), position=place, **common) for number, place in enumerate(places)]


def test_a_blow_on_many_boxes_takes_few_linear_systems(monkeypatch):
    """Choosing which contacts hold took more than 5,000 of them: it went round in circles."""
    systems, solve = [], np.linalg.solve
    monkeypatch.setattr(np.linalg, "solve", lambda *given: systems.append(given) or solve(*given))
    late = Ball("ball", 1.0, 0.06, (-0.35, 0.2), (5.0, 0.5), forces=[Gravity(G)])
    run = run_of([*boxes(5), late], FLOOR, 0.5, 0.2, duration=0.15)
    assert any({event.ball, event.partner} & {"ball"} for event in run.events)
    assert len(systems) < 1_000


def test_bodies_in_a_heap_take_steps_that_suit_the_accuracy():
    """Those of "fast" are three times as long as those of "balanced"."""
    taken = {
        level: run_of(boxes(2, 1.0), FLOOR, 0.5, 0.2, duration=0.1, level=level).numerics.pymunk_steps
        for level in ("fast", "balanced", "precise")
    }
    assert 2.0 < taken["balanced"] / taken["fast"] < 5.0
    assert 2.0 < taken["precise"] / taken["balanced"] < 5.0
