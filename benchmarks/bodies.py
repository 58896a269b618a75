"""Bodies that are no balls: the error at equal time of a tumbling box and of two polygons in a room, compared with
pymunk alone.

Run ``python benchmarks/bodies.py [--json F] [--repeats N] [--quick]``. The error is the farthest that any point of a
body may be off at the end, against "precise" made finer twice: its overlap at a touch is a sixteenth. Error and
processor time are medians over nine starts. Bare pymunk is a Space with its own gravity and a loop, without a callback
in Python and without recording. Its error at our time is read off between two of its rates, on a double logarithmic
scale.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from math import exp, hypot, log, remainder, tau
from statistics import median
from typing import Any

import pymunk
from by_pymunk import SLOP
from measured import command_line, keep, show, timed

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS, Accuracy
from sandbox.engine.model.ball import Body
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Polygon, box, regular
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.physics.forces import Gravity

G = 9.81  # m/s^2
#: Restitution and friction of a shape, which pymunk multiplies.
SPRINGY, ROUGH = 0.93, 0.55
RATES, QUICK_RATES = (240, 1_000, 2_000, 4_000, 8_000, 16_000, 64_000), (1_000, 2_000)  # steps/s

Place = tuple[float, float, float]  # x and y in m, angle in rad


def setup(bodies: list[Body], duration: float, corners: list[tuple[float, float]]) -> Setup:
    bounce = SPRINGY**2, ROUGH**2
    walls = [Surface(f"wall {k}", Segment(*ends), *bounce) for k, ends in enumerate(pairwise(corners))]
    return Setup(bodies, walls, duration, between_balls=ConstantBounce(Bounce(*bounce)))


def tumbling(height: float) -> Setup:
    """A box that falls on a floor from a height in m."""
    crate = Body(
        "box", mass=2.0, shape=box(0.4, 0.25), position=(0.0, height), velocity=(1.2, 0.0), spin=-5.0, angle=0.5,
        forces=(Gravity(G, 2.0),),
    )  # fmt: skip
    return setup([crate], 3.0, [(-50.0, 0.0), (50.0, 0.0)])


def meeting(spin: float) -> Setup:
    """Two polygons in a room, of which one spins, in rad/s."""
    wedge = Polygon(((0.0, 0.0), (0.5, 0.0), (0.1, 0.25)))
    bodies = [
        Body("pentagon", mass=1.0, shape=regular(5, 0.2), position=(-0.5, 0.1), velocity=(3.0, 0.7), spin=spin),
        Body("wedge", mass=0.6, shape=wedge, position=(0.5, 0.0), spin=-4.0),
    ]
    return setup(bodies, 1.5, [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)])


def cases() -> dict[str, list[Setup]]:
    """Nine starts each: how much an error grows from impact to impact is a matter of luck."""
    return {
        "a box tumbles on a floor, 3 s": [tumbling(0.65 + 0.02 * k) for k in range(9)],
        "two polygons in a room, 1.5 s": [meeting(3.0 + 0.5 * k) for k in range(9)],
    }


def by_us(of: Setup, accuracy: Accuracy) -> tuple[list[Place], int]:
    """Return the final places of the bodies, and the number of impacts."""
    run = simulate(of, accuracy)
    ends = [(*run.state(body.name, run.duration)[:2], run.angle(body.name, run.duration)) for body in of.balls]
    return ends, run.numerics.impacts


def by_pymunk(of: Setup, rate: float) -> tuple[list[Place], int]:
    """The same with pymunk alone; it does not count impacts."""
    space = pymunk.Space()
    space.collision_slop = SLOP
    space.gravity = 0.0, -G if any(body.forces for body in of.balls) else 0.0
    shapes: list[pymunk.Shape] = [pymunk.Segment(space.static_body, s.shape.a, s.shape.b, 0.0) for s in of.surfaces]
    moving = []
    for body in of.balls:
        made = pymunk.Body(body.mass, body.inertia)
        made.position, made.velocity, made.angular_velocity, made.angle = (
            body.position, body.velocity, body.spin, body.angle)  # fmt: skip
        shapes.append(pymunk.Poly(made, body.outline.corners))
        space.add(made)
        moving.append(made)
    for shape in shapes:
        shape.elasticity, shape.friction = SPRINGY, ROUGH
    space.add(*shapes)
    for _ in range(round(of.duration * rate)):
        space.step(1.0 / rate)
    return [(*made.position, made.angle) for made in moving], 0


def off(of: Setup, ends: list[Place], reference: list[Place]) -> float:
    """The farthest that a point of a body may be away from where it should be, in m."""
    return max(
        hypot(x - u, y - v) + body.radius * abs(remainder(angle - turned, tau))
        for body, (x, y, angle), (u, v, turned) in zip(of.balls, ends, reference, strict=True)
    )


def compare(starts: list[Setup], rates: tuple[int, ...], repeats: int) -> dict[str, Any]:
    """Rows of both, and how many times larger pymunk's error is at the time that each of ours takes; all medians."""
    methods: dict[str, Callable[[Setup], tuple[list[Place], int]]] = {
        **{f"exact, {name}": partial(by_us, accuracy=accuracy) for name, accuracy in LEVELS.items()},
        **{f"bare pymunk, {rate:,} steps/s": partial(by_pymunk, rate=rate) for rate in rates},
    }
    times: dict[str, list[float]] = {name: [] for name in methods}
    errors: dict[str, list[float]] = {name: [] for name in methods}
    impacts = []
    for of in starts:
        reference, count = by_us(of, LEVELS["precise"].finer().finer())
        impacts.append(count)
        for name, method in methods.items():
            for _ in range(repeats):
                spent, (ends, _) = timed(method, of)
                times[name].append(spent)
            errors[name].append(off(of, ends, reference))
    rows = [{"method": name, "error_m": median(errors[name]), "time_s": median(times[name])} for name in methods]
    theirs = [(row["time_s"], row["error_m"]) for row in rows if row["method"].startswith("bare")]
    for row in rows:
        if row["method"].startswith("exact"):
            row["pymunk_over_ours"] = at(row["time_s"], theirs) / row["error_m"]
    return {"impacts": median(impacts), "rows": rows}


def at(time: float, points: list[tuple[float, float]]) -> float:
    """The error in m at a time in s; beyond the ends that of the end."""
    for (t0, e0), (t1, e1) in pairwise(points):
        if t0 <= time <= t1:
            return exp(log(e0) + log(e1 / e0) * log(time / t0) / log(t1 / t0))
    return points[0][1] if time < points[0][0] else points[-1][1]


def report(name: str, results: dict[str, Any]) -> None:
    columns = {
        "method": "{method}",
        "error": "{error_m:.1e} m",
        "time": "{time_s:.2f ms}",
        "bare pymunk's error at the same time": "{pymunk_over_ours:,.0f} times",
    }
    show(f"{name}, {results['impacts']:g} impacts", results["rows"], columns)


def main() -> None:
    arguments = command_line(__doc__, repeats=3)
    rates, most = (QUICK_RATES, 1) if arguments.quick else (RATES, None)
    results = {name: compare(starts[:most], rates, arguments.repeats) for name, starts in cases().items()}
    for name, found in results.items():
        report(name, found)
    keep(arguments.json, results)


if __name__ == "__main__":
    main()
