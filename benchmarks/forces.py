"""The cost of a force in Python: microseconds per ball and step, for 1 to 1,000 separate balls in flight for a second.

Run ``python benchmarks/forces.py [--json F] [--repeats N] [--quick]``. Gravity and quadratic drag, at 240 steps per
second for fixed steps; the balls are far apart and touch nothing.

- bare pymunk: gravity alone, no callback. It is the limit: the cost without any force in Python.
- velocity_func: gravity and drag in a function that pymunk calls for each ball, as its users would write it.
- batch and numpy: all velocities read by ``pymunk.batch``, drag in numpy, all forces written; gravity by pymunk.
- plain: our plain method, pymunk at its best: of second order, with a look for contacts, recording and checks.
- exact: this engine at "balanced", all balls in one setup; its steps are as long as the error allows, with six
  evaluations of the forces each.
- exact, many: the same with a setup for each ball, by ``simulate_many``, as in sweeps; with arrays if there are
  enough shots, otherwise one at a time.

Times are processor times, medians of interleaved repeats; slow methods run once. "error" is the largest position
error of any ball after the second.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import cos, hypot, radians, sin
from statistics import median
from typing import Any, NamedTuple

import numpy as np
import pymunk
import pymunk.batch
from measured import command_line, keep, show, timed
from shots import basketball_law

from sandbox.engine import simulate, simulate_many
from sandbox.engine.model.accuracy import Accuracy, resolve
from sandbox.engine.model.ball import HOLLOW_SPHERE, Ball, Force
from sandbox.engine.model.setup import Bounds, Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.engine.paths.run import Run
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity

COUNTS = (1, 16, 100, 1_000)
RATE, DURATION = 240, 1.0  # steps/s, s
MASS, RADIUS, GRAVITY, DENSITY, DRAG = 0.624, 0.1194, 9.81, 1.204, 0.5  # those of the basketball
APART = 50.0  # m
#: A method whose flights take longer than this, in s, runs once.
LONG = 0.2
#: Balls in one setup beyond which the exact engine is left out: it predicts contacts for every pair.
MOST_TOGETHER = 100

Ends = list[tuple[float, float]]


class Flown(NamedTuple):
    """Final positions of the balls in m, and the steps of each."""

    ends: Ends
    steps: float


def balls(count: int) -> list[Ball]:
    """Balls in a row, each thrown upwards at a slightly different angle."""
    forces: list[Force] = [Gravity(GRAVITY, MASS), Drag(RADIUS, DENSITY, Constant(DRAG))]
    angles = (radians(50.0 + 30.0 * i / count) for i in range(count))
    return [
        Ball(
            f"ball {i}", MASS, RADIUS, (APART * i, 2.0), (12.0 * cos(angle), 12.0 * sin(angle)),
            inertia_factor=HOLLOW_SPHERE, forces=forces,
        )
        for i, angle in enumerate(angles)
    ]  # fmt: skip


def together(count: int) -> Setup:
    """All in one setup over one floor, wide enough for the row."""
    wide = APART * count + 1e3
    floor = Surface("floor", Segment((-wide, 0.0), (wide, 0.0)), 0.8, 0.5)
    return Setup(balls(count), [floor], duration=DURATION, bounds=Bounds(-wide, -wide, wide, wide))


def alone(count: int) -> list[Setup]:
    """Each in a setup of its own."""
    setup = together(count)
    return [replace(setup, balls=[replace(ball, name="ball")]) for ball in setup.balls]


def space_of(setup: Setup) -> pymunk.Space:
    space = pymunk.Space()
    for ball in setup.balls:
        body = pymunk.Body(ball.mass, ball.inertia)
        body.position, body.velocity = ball.position, ball.velocity
        space.add(body, pymunk.Circle(body, ball.radius))
    for surface in setup.surfaces:
        floor = surface.shape
        assert isinstance(floor, Segment)
        space.add(pymunk.Segment(space.static_body, floor.a, floor.b, floor.radius))
    return space


def bare(setup: Setup) -> Callable[[], Flown]:
    space = space_of(setup)
    space.gravity = 0.0, -GRAVITY
    return lambda: _stepped(space)


def by_velocity_func(setup: Setup) -> Callable[[], Flown]:
    space = space_of(setup)

    def update(body: pymunk.Body, gravity: Any, damping: float, dt: float) -> None:
        vx, vy = body.velocity
        ax, ay, _ = basketball_law(vx, vy, 0.0)
        body.velocity = vx + dt * ax, vy + dt * ay

    for body in space.bodies:
        body.velocity_func = update
    return lambda: _stepped(space)


def by_batch(setup: Setup) -> Callable[[], Flown]:
    space = space_of(setup)
    space.gravity = 0.0, -GRAVITY
    out, back, k = pymunk.batch.Buffer(), pymunk.batch.Buffer(), -0.5 * DENSITY * DRAG * np.pi * RADIUS**2
    velocity, force = pymunk.batch.BodyFields.VELOCITY, pymunk.batch.BodyFields.FORCE

    def push() -> None:
        out.clear()
        pymunk.batch.get_space_bodies(space, velocity, out)
        v = np.frombuffer(out.float_buf()).reshape(-1, 2)
        back.set_float_buf(k * np.sqrt((v * v).sum(axis=1, keepdims=True)) * v)
        pymunk.batch.set_space_bodies(space, force, back)

    return lambda: _stepped(space, push)


def _stepped(space: pymunk.Space, push: Callable[[], None] = lambda: None) -> Flown:
    steps = round(DURATION * RATE)
    for _ in range(steps):
        push()
        space.step(1 / RATE)
    return Flown([(body.position.x, body.position.y) for body in space.bodies], steps)


def by_engine(setup: Setup, accuracy: Accuracy) -> Callable[[], Flown]:
    return lambda: _ended([simulate(setup, accuracy)], len(setup.balls), accuracy)


def by_many(setups: list[Setup], accuracy: Accuracy) -> Callable[[], Flown]:
    def fly() -> Flown:
        runs = []
        for run in simulate_many(setups, accuracy):
            assert isinstance(run, Run), run
            runs.append(run)
        return _ended(runs, len(runs), accuracy)

    return fly


def _ended(runs: list[Run], count: int, accuracy: Accuracy) -> Flown:
    ends = [run.state(ball.name, DURATION)[:2] for run in runs for ball in run.setup.balls]
    steps = sum(run.numerics.steps for run in runs)
    return Flown(ends, steps if accuracy.method == "plain" else steps / count)


def compare(count: int, repeats: int) -> list[dict[str, Any]]:
    """A row for each method."""
    setup, setups = together(count), alone(count)
    balanced, plain = resolve(), resolve(method="plain", step=1 / RATE)
    # a Space can be used for one flight only, so each is prepared again, outside the measured time
    ready: dict[str, Callable[[], Callable[[], Flown]]] = {
        "bare pymunk": lambda: bare(setup),
        "velocity_func": lambda: by_velocity_func(setup),
        "batch and numpy": lambda: by_batch(setup),
        "plain": lambda: by_engine(setup, plain),
        "exact": lambda: by_engine(setup, balanced),
        "exact, many": lambda: by_many(setups, balanced),
    }
    if count > MOST_TOGETHER:
        del ready["exact"]
    times: dict[str, list[float]] = {method: [] for method in ready}
    flown: dict[str, Flown] = {}
    for _ in range(repeats):
        for method, prepare in ready.items():
            if times[method] and times[method][0] > LONG:
                continue
            spent, flown[method] = timed(prepare())
            times[method].append(spent)
    truth = _ended(_finest(setups), count, resolve("precise")).ends
    rows: list[dict[str, Any]] = []
    for method, (ends, steps) in flown.items():
        spent = 1e6 * median(times[method]) / count
        error = max(hypot(x - u, y - v) for (x, y), (u, v) in zip(ends, truth, strict=True))
        rows.append(
            {
                "method": method,
                "balls": count,
                "steps": steps,
                "us_per_step": spent / steps,
                "us_per_second": spent / DURATION,
                "error_m": None if method == "bare pymunk" else error,
            }
        )
    for row in rows:
        row["step_over_limit"] = row["us_per_step"] / rows[0]["us_per_step"]
        row["second_over_limit"] = row["us_per_second"] / rows[0]["us_per_second"]
    return rows


def _finest(setups: list[Setup]) -> list[Run]:
    return [simulate(setup, resolve("precise", tolerance=1e-9)) for setup in setups]


def report(rows: list[dict[str, Any]]) -> None:
    columns = {
        "balls": "{balls:,}",
        "method": "{method}",
        "steps": "{steps:.3g}",
        "a ball and step": "{us_per_step:.2f} us",
        "over bare": "{step_over_limit:,.1f}",
        "a ball and second": "{us_per_second:,.0f} us",
        "over bare ": "{second_over_limit:,.1f}",
        "error": "{error_m:.1e} m",
    }
    show("balls in flight", rows, columns)


def main() -> None:
    arguments = command_line(__doc__, repeats=7)
    counts = (1, 2) if arguments.quick else COUNTS
    rows = [row for count in counts for row in compare(count, arguments.repeats)]
    report(rows)
    keep(arguments.json, {"forces": rows})


if __name__ == "__main__":
    main()
