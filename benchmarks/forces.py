"""The cost of a force in Python: microseconds per ball and step, for 1 to 1,000 separate balls in flight for a second.

Run ``python benchmarks/forces.py [--json F] [--repeats N] [--quick]``. Gravity and quadratic drag, at 240 steps per
second for fixed steps; the balls are far apart and touch nothing.

- bare pymunk: gravity alone, no callback. It is the limit: the cost without any force in Python.
- velocity_func: gravity and drag in a function that pymunk calls for each ball, as its users would write it.
- batch and numpy: all velocities read by ``pymunk.batch``, drag in numpy, all forces written; gravity by pymunk.
- plain: our plain method, which is velocity_func plus the recording and checks of this program.
- exact: this engine at "balanced", all balls in one setup; its steps are as long as the error allows, with six
  evaluations of the forces each.
- exact, many: the same with a setup for each ball, by ``simulate_many``, as in sweeps; with arrays if there are
  enough shots, otherwise one at a time.

Times are processor times, medians of interleaved repeats; slow methods run once. "error" is the largest position
error of any ball after the second.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from dataclasses import replace
from math import cos, hypot, radians, sin
from pathlib import Path
from statistics import median
from time import thread_time
from typing import Any, NamedTuple

import numpy as np
import pymunk
import pymunk.batch
from shots import basketball_law

from sandbox.engine import simulate, simulate_many
from sandbox.engine.accuracy import Accuracy, resolve
from sandbox.engine.run import Run
from sandbox.engine.setup import HOLLOW_SPHERE, Ball, Bounds, Force, Segment, Setup, Surface
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
    forces: list[Force] = [Gravity(MASS, GRAVITY), Drag(RADIUS, DENSITY, Constant(DRAG))]
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
            fly = prepare()
            started = thread_time()
            flown[method] = fly()
            times[method].append(thread_time() - started)
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


def show(rows: list[dict[str, Any]]) -> None:
    out = sys.stdout
    out.write(f"{'':<27}{'steps':>8}{'a ball and step':>24}{'a ball and second':>26}\n")
    out.write(
        f"{'balls':<9}{'method':<18}{'':>8}{'time':>14}{'over bare':>10}{'time':>16}{'over bare':>10}{'error':>12}\n"
    )
    for number, row in enumerate(rows):
        first = number == 0 or rows[number - 1]["balls"] != row["balls"]
        error = "" if row["error_m"] is None else f"{row['error_m']:.1e} m"
        out.write(
            f"{format(row['balls'], ',') if first else '':<9}{row['method']:<18}{row['steps']:>8.3g}"
            f"{row['us_per_step']:>11.2f} us{row['step_over_limit']:>10,.1f}"
            f"{row['us_per_second']:>13,.0f} us{row['second_over_limit']:>10,.1f}{error:>12}\n"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", type=Path, help="write the rows here")
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--quick", action="store_true", help="few balls, once, as a test")
    arguments = parser.parse_args()
    counts, repeats = ((1, 2), 1) if arguments.quick else (COUNTS, arguments.repeats)
    rows = [row for count in counts for row in compare(count, repeats)]
    show(rows)
    if arguments.json:
        arguments.json.write_text(json.dumps({"forces": rows}, indent=1))


if __name__ == "__main__":
    main()
