"""Random heaps of bodies and balls: how much energy appears from nothing, how deep they overlap, and what fails.

Run ``python benchmarks/heaps.py``, with ``--count N``, ``--seed N``, ``--level L``, ``--quick`` or ``--json F``. Two to
six boxes, capsules, ellipses, polygons and balls, with masses up to 1,000 times as large as one another, fall on a flat
floor, into a bowl, down a slope against a wall, or into a box. The gain is the largest rise of mechanical energy during
the run, as a share of its largest kinetic energy; the overlap that of the deepest two, as a share of half the least
thickness.
"""

from __future__ import annotations

import random
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise
from math import cos, hypot, pi, radians, sin
from statistics import median
from typing import Any, NamedTuple

from measured import command_line, keep, say, show, timed

from sandbox.engine import simulate
from sandbox.engine.contact.manifold import meeting, surface_met
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.model.accuracy import LEVELS, resolve
from sandbox.engine.model.ball import Ball, Body, kinetic, outline_of
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Ellipse, Shape, box, capsule, regular
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.engine.paths.phase import InCluster, InHeap
from sandbox.engine.paths.run import Run
from sandbox.errors import RunError
from sandbox.physics.forces import Gravity
from sandbox.physics.integrators import State

G = 9.81  # m/s^2
#: Shares that are counted, and how many of the worst are shown.
LIMITS = (1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.02, 0.05)
_SHOWN = 5
#: Every how many steps of a heap overlaps are measured.
_EVERY = 4


def heap(seed: int) -> Setup:
    """The random heap of this number."""
    rng = random.Random(seed)
    restitution, friction = rng.choice((0.0, 0.3, 0.6, rng.random())), rng.choice((0.0, 0.2, 0.6, 1.2 * rng.random()))
    ground = rng.choice((0.0, 0.3, 0.6, rng.random())), rng.choice((0.0, 0.2, 0.6, 1.2 * rng.random()))
    floor = rng.choice(("flat", "bowl", "slope", "box"))
    size = rng.choice((0.05, 0.1, 0.2))  # m
    bodies: list[Ball] = []
    height = 1.2 * size
    for number in range(rng.randint(2, 6)):
        place = rng.uniform(-0.7, 0.7) * size, height
        mass = 10.0 ** rng.uniform(-1.5, 1.5)
        motion = {"velocity": (rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 0.5)), "spin": rng.uniform(-5.0, 5.0)}
        common: dict[str, Any] = {**motion, "position": place, "mass": mass, "forces": [Gravity(G, mass)]}
        if rng.random() < 0.2:
            bodies.append(Ball(f"ball {number}", radius=rng.uniform(0.2, 0.5) * size, **common))
        else:
            kind, shape = outline(rng, size)
            bodies.append(Body(f"{kind} {number}", shape=shape, angle=rng.uniform(-pi, pi), **common))
        height += 1.6 * size
    return Setup(
        bodies,
        [
            Surface(f"{floor} side {k}", Segment(*ends), *ground)
            for k, ends in enumerate(pairwise(corners(floor, size)))
        ],
        1.5,
        between_balls=ConstantBounce(Bounce(restitution, friction)),
    )


def outline(rng: random.Random, size: float) -> tuple[str, Shape]:
    """A random outline, no longer than 1.5 ``size`` (m), and its kind."""
    kind = rng.choice(("box", "capsule", "ellipse", "polygon"))
    length = rng.uniform(0.6, 1.2) * size
    width = rng.uniform(0.3, 1.0) * length
    shapes: dict[str, Shape] = {
        "box": box(length, width),
        "capsule": capsule(length, 0.5 * width),
        "ellipse": Ellipse(0.5 * length, 0.5 * width),
        "polygon": regular(rng.randint(3, 7), 0.5 * length),
    }
    return kind, shapes[kind]


def corners(floor: str, size: float) -> list[tuple[float, float]]:
    """The corners of a floor for bodies of this size (m)."""
    deep = 2.5 * size
    if floor == "bowl":
        turns = [radians(180 * part / 40) for part in range(41)]
        return [(-deep * cos(turn), deep * (1.0 - sin(turn))) for turn in turns]
    if floor == "slope":
        return [(-100.0 * size, 30.0 * size), (2.0 * size, -0.6 * size), (2.0 * size, 20.0 * size)]
    wall = 1.5 * size
    return {
        "flat": [(-100.0, 0.0), (100.0, 0.0)],
        "box": [(-wall, 20.0 * size), (-wall, 0.0), (wall, 0.0), (wall, 20.0 * size)],
    }[floor]


class Measured(NamedTuple):
    """What a run of a heap has done."""

    seed: int
    error: str = ""
    ended: str = ""
    gain: float = 0.0  # as a share of its largest kinetic energy
    gain_at: float = 0.0  # s
    overlap: float = 0.0  # as a share of half the least thickness
    overlap_at: float = 0.0  # s
    steps: int = 0  # of the heap
    time_s: float = 0.0


def measure(setup: Setup, seed: int, level: str = "balanced") -> Measured:
    """Run a heap, of this number, and measure it."""
    try:
        spent, run = timed(simulate, setup, resolve(level))
    except RunError as error:
        return Measured(seed, str(error))
    return Measured(seed, "", run.ended, *gained(run), *overlapped(run), run.numerics.pymunk_steps, spent)


def gained(run: Run) -> tuple[float, float]:
    """The largest rise of mechanical energy as a share of the largest kinetic energy, and when in s it was reached."""
    lowest, rise, at, fastest = float("inf"), 0.0, 0.0, 0.0
    for t in ends(run):
        states = [(ball, run.state(ball.name, t)) for ball in run.setup.balls]
        moving = sum(kinetic(ball, state) for ball, state in states)
        energy = moving + sum(ball.mass * G * state[1] for ball, state in states)
        lowest, fastest = min(lowest, energy), max(fastest, moving)
        if energy - lowest > rise:
            rise, at = energy - lowest, t
    return rise / fastest, at


def ends(run: Run) -> list[float]:
    """The times in s at which arcs end, but for those within a step of a heap, in which velocities change evenly from
    before its impulses to after them, or within a contact of balls that press on one another, and store energy."""
    arcs = [arc for path in run.arcs.values() for arc in path]
    spans = {(arc.contact.start, arc.contact.end) for arc in arcs if isinstance(arc.contact, InCluster)}
    spans |= {(arc.t0, arc.t1) for arc in arcs if isinstance(arc.contact, InHeap) and not arc.rests}
    starts, stops = sorted(start for start, _ in spans), sorted(stop for _, stop in spans)
    times = sorted({0.0, *(arc.t1 for arc in arcs)})
    return [t for t in times if bisect_left(starts, t) <= bisect_right(stops, t)]


def overlapped(run: Run) -> tuple[float, float]:
    """The deepest overlap as a share of half the least thickness, and when in s."""
    balls = run.setup.balls
    thin = min(outline_of(ball).mass_properties().area / (4.0 * ball.radius) for ball in balls)
    times = sorted({arc.t1 for path in run.arcs.values() for arc in path if isinstance(arc.contact, InHeap)})[::_EVERY]
    deepest = max(((-gap, t) for t in times for gap in gaps(run, t)), default=(0.0, 0.0))
    return deepest[0] / thin, deepest[1]


def gaps(run: Run, t: float) -> Iterator[float]:
    """The gaps at t in m between what is near each other."""
    states = [(ball, state_and_angle(run, ball, t)) for ball in run.setup.balls]
    for (one, here), (other, there) in combinations(states, 2):
        if hypot(here[0] - there[0], here[1] - there[1]) < one.radius + other.radius:
            yield meeting(one, here, other, there).gap
    for ball, state in states:
        for surface in run.setup.surfaces:
            obstacle = Obstacle(surface, ball.radius, 0.0)
            near = obstacle.near(*state[:2])
            if near.gap < 0.0:
                yield surface_met(ball, state, (obstacle, near)).gap


def state_and_angle(run: Run, ball: Ball, t: float) -> State:
    """The state of a ball at t, and the angle of a body."""
    return (*run.state(ball.name, t), *([run.angle(ball.name, t)] if ball.rotates else []))


def report(found: Sequence[Measured]) -> None:
    """Print how many heaps gain or overlap by more than some limits, the worst of them, and the errors."""
    whole = [each for each in found if not each.error]
    say(f"{len(found)} heaps, {len(found) - len(whole)} of them end with an error")
    for each in found:
        if each.error:
            say(f"  {each.seed}: {each.error}")
    for what in ("gain", "overlap"):
        worst = sorted(whole, key=lambda each: -getattr(each, what))[:_SHOWN]
        form = {"heap": "{seed}", what: f"{{{what}:.1e}}", "at": f"{{{what}_at:.3f}} s", "ends by": "{ended}"}
        above = (f"{sum(getattr(each, what) > limit for each in whole)} above {limit:g}" for limit in LIMITS)
        show(f"{what}: {', '.join(above)}", [each._asdict() for each in worst], form)
    times = [each.time_s for each in whole]
    say("", f"{sum(times):.0f} s of processor time, median {1e3 * median(times):.0f} ms, longest {max(times):.1f} s")


def main() -> None:
    options: dict[str, dict[str, Any]] = {
        "--count": {"type": int, "default": 1000},
        "--seed": {"type": int, "default": 0, "help": "number of the first heap"},
        "--level": {"default": "balanced", "choices": LEVELS},
    }
    arguments = command_line(__doc__, options=options)
    count = 3 if arguments.quick else arguments.count
    found = [measure(heap(seed), seed, arguments.level) for seed in range(arguments.seed, arguments.seed + count)]
    report(found)
    keep(arguments.json, [each._asdict() for each in found])


if __name__ == "__main__":
    main()
