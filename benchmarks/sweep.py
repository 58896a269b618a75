"""Shots per second: the map of free throws, 61 speeds by 41 angles, computed in several ways; and how the time grows.

Run ``python benchmarks/sweep.py [--json F] [--repeats N] [--quick]``.

- sandbox sweep: the whole command, from start to the written file, with one process and with two; wall time, since that
  is what processes save.
- simulate_many: the engine alone, all shots together in arrays, as in the sweep.
- simulate: the engine alone, one shot at a time.
- bare pymunk (by_pymunk.py): a few random shots of the map, each to the same time, at the lowest of the step rates that
give an error below 1 cm. A shot for which none is enough counts with the highest: the true time is longer. The map is
extrapolated from these shots.

The limit is the forces alone: numpy evaluates gravity and drag for all shots at once, as often as the flights need at
"balanced", and nothing else; with two processes half of that. "over limit" is the time of a shot relative to it.

Commands: whole commands that a player waits for, in processor time (user and system) including the start; of a search
the time that it takes in Python, without the start. "floor" is the time that numpy takes for the forces of all these
shots, as often as they need them, and "target" what the project aims at: the same multiple of the floor for golf and
soccer as for basketball.

In the window: what it computes while a player aims, in processor time, by one process; a fan is a picture of a shot
with the usual errors, and grows where its shots are computed one by one. Such a fan is computed by two processes while
the aim rests: "clock" is the time in which they complete it; the target is for either.

Where it goes: the processor time of a shot of the map in each step of a sweep; the floor of each is the forces alone.

Growth: with the number of shots, from Python (``sandbox.lab.sweep``: build, simulate, evaluate), and with the number of
balls that fly in one setup without touching, by ``simulate``. Except for the command, times are processor times.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from math import cos, hypot, inf, radians, sin
from pathlib import Path
from random import Random
from statistics import mean, median
from time import perf_counter, sleep
from timeit import timeit
from typing import Any
from unittest.mock import patch

import by_pymunk
import numpy as np
from forces import together
from measured import Done, command_line, keep, say, show, timed
from shots import SHORT, basketball_law
from shots import Shot as Launched

import sandbox
from sandbox.engine import simulate, simulate_many
from sandbox.engine.many.batch import Batch
from sandbox.engine.many.batch_record import BatchRecord
from sandbox.engine.many.outlines import BatchSurfaces
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.setup import Setup
from sandbox.engine.motion.forces_on_ball import acceleration_function
from sandbox.engine.paths.run import Run
from sandbox.lab import runs as lab_runs
from sandbox.lab.axes import Values, Varied
from sandbox.lab.plan import Plan, records
from sandbox.lab.row_file import RowFile, cell
from sandbox.lab.runs import runs
from sandbox.lab.sweep import sweep
from sandbox.lab.tables import paragraph
from sandbox.picture.camera import Camera
from sandbox.scene import Scene
from sandbox.window import fan
from sandbox.window.score_map import score_map
from sandbox.window.shots import Shot
from sandbox.workers import Processes

SPEEDS, ANGLES = (6.0, 9.0), (35.0, 75.0)  # m/s, deg
MAP = (61, 41)
TARGET = 0.01  # m
RATES = (1_000, 4_000, 16_000, 64_000)  # steps/s
#: Random shots of the map for bare pymunk, the same each time.
DRAWN = 6
#: Numbers of shots of the grids, and of balls of the setups.
GRIDS = ((10, 10), (25, 20), MAP, (100, 100))
BALLS = (1, 4, 16, 64)

#: Whole sweeps, and the target of their processor time in s; None is the same share of their floor as the first's.
SWEEPS: dict[str, tuple[tuple[float, float], tuple[float, float], tuple[int, int], float | None]] = {
    "basketball, 61 x 41": (SPEEDS, ANGLES, MAP, 0.8),
    "basketball, 201 x 201": (SPEEDS, ANGLES, (201, 201), 201 * 201 / 5_000),
    "golf, 61 x 41": ((50.0, 80.0), (5.0, 45.0), MAP, None),
    "soccer, 61 x 41": ((15.0, 35.0), (5.0, 45.0), MAP, None),
}
#: Searches: scene, ranges and what is searched for, and the target of their processor time in s.
AIMS: tuple[tuple[str, dict[str, tuple[float, float]], dict[str, Any], float], ...] = (
    ("golf", {"launch.angle": (5.0, 75.0)}, {"carry": "250 yd"}, 0.15),
    ("basketball", {"launch.speed": (6.0, 9.0)}, {"made": True}, 1.0),
)
#: Fans in the window: shots, whether of an aim that changes, and the target of their processor time in s.
FANS = {
    "basketball": (100, True, 0.1),
    "soccer": (100, True, 0.1),
    "golf": (100, True, 0.1),
    "billiards/cut": (200, False, 1.0),
    "billiards/nine-ball-break": (200, False, 1.0),
}
#: Between two frames, in s, in which the window asks its processes.
FRAME = 1 / 60
#: Maps in the window, and the target of their processor time in s.
MAPS = {"basketball": 1.0, "soccer": 1.0, "golf": 1.0}


def grid(shape: tuple[int, int]) -> dict[str, Any]:
    return {"launch.speed": np.linspace(*SPEEDS, shape[0]), "launch.angle": np.linspace(*ANGLES, shape[1])}


def setups(shape: tuple[int, int]) -> list[Setup]:
    """The setup of each shot of the map."""
    setup = sandbox.load("basketball", SHORT).build()
    speeds, angles = grid(shape).values()
    directions = [(cos(radians(angle)), sin(radians(angle))) for angle in angles]
    return [
        replace(setup, balls=[replace(setup.balls[0], velocity=(float(speed) * x, float(speed) * y))])
        for speed in speeds
        for x, y in directions
    ]


def usual(work: Callable[[], Done], repeats: int) -> tuple[float, Done]:
    """Median of the processor time in s, and the result."""
    spent, done = zip(*(timed(work) for _ in range(repeats)), strict=True)
    return median(spent), done[-1]


# -------------------------------------------------------------------------------------------------------------- the map


PROGRAM = "from sandbox.cli import main; main()"


def of_children() -> float:
    """Processor time of all processes started so far and ended, user and system, in s."""
    spent = os.times()
    return spent.children_user + spent.children_system


def process(code: str, words: Sequence[str] = (), clock: Callable[[], float] = of_children) -> float:
    """Time of a program in s."""
    command = [sys.executable, "-c", code, *words]
    return timed(partial(subprocess.run, command, check=True, capture_output=True), clock=clock)[0]


def swept(
    scene: str,
    speeds: tuple[float, float],
    angles: tuple[float, float],
    shape: tuple[int, int],
    *more: str,
    clock: Callable[[], float] = of_children,
) -> float:
    """Time in s of a whole sweep."""
    axes = (("launch.speed", speeds, shape[0]), ("launch.angle", angles, shape[1]))
    over = [word for key, (low, high), n in axes for word in ("--over", f"{key}={low:g}:{high:g}:{n}")]
    with tempfile.TemporaryDirectory() as folder:
        return process(PROGRAM, ["sweep", scene, *over, "--out", str(Path(folder) / "map.csv"), *more], clock)


def floor_of(name: str, speeds: tuple[float, float], angles: tuple[float, float], shape: tuple[int, int]) -> float:
    """Seconds that numpy takes for the forces of these shots, as often as a few of them need them."""
    scene = sandbox.load(name)
    some = [(speed, angle) for speed in np.linspace(*speeds, 5) for angle in np.linspace(*angles, 5)]
    found = runs(scene, ["launch.speed", "launch.angle"], some, asked=scene.facts_except_ended)
    evaluations = mean(run.numerics.force_evaluations for run in found if isinstance(run, Run))
    ball, shots = scene.build().balls[0], shape[0] * shape[1]
    state = (*np.zeros((2, shots)), *np.full((2, shots), 5.0), np.full(shots, ball.spin))
    once = min(
        timeit(lambda: acceleration_function(ball, floats=False)(np.zeros(shots), state), number=9) / 9
        for _ in range(5)
    )
    return evaluations * once


def commands(repeats: int, quick: bool) -> list[dict[str, Any]]:
    """A row for each command, or for one of each kind."""
    rows, share = [], inf
    for name, (speeds, angles, shape, target) in list(SWEEPS.items())[: 1 if quick else None]:
        how = (name.partition(",")[0], speeds, angles, (6, 5) if quick else shape)
        floor = floor_of(*how)
        share = min(share, target / floor) if target is not None else share
        spent = min(swept(*how) for _ in range(repeats))
        rows.append(
            {
                "command": f"sweep {name}",
                "processor_s": spent,
                "floor_s": floor,
                "target_s": share * floor if target is None else target,
            }
        )
    for scene, vary, goal, target in AIMS[: 1 if quick else None]:
        spent = min(timed(sandbox.aim, scene, vary, goal)[0] for _ in range(repeats))
        goals = "".join(f"{name}={cell(value)}" for name, value in goal.items())
        rows.append({"command": f"aim {scene} {goals}, in Python", "processor_s": spent, "target_s": target})
    return rows


def in_the_window(repeats: int, quick: bool) -> list[dict[str, Any]]:
    """A row for each fan and map."""
    rows = []
    for name, (shots, quickly, target) in list(FANS.items())[: 1 if quick else None]:
        scene = sandbox.load(name)
        shot = Shot(scene, sandbox.simulate(scene))
        camera = Camera((0.0, 0.0), (640.0, 360.0), 60.0)
        how = (1.0, camera, quickly, shot.early, (1280, 720), ((0, 255, 0), (255, 255, 255)))
        times = []
        for _ in range(repeats):
            with patch.object(fan, "SHOTS", shots), patch.object(fan, "_begun", {}):
                parts, left = [], True
                while left:
                    spent, cloud = timed(fan.cloud, scene, *how)
                    parts, left = [*parts, spent], cloud.left > 0 and not quickly
            times.append((sum(parts), parts[0]))
        whole, first = min(times)
        clock = None if quickly else min(by_two(scene, shots, how) for _ in range(repeats))
        row = {"processor_s": whole, "first_s": first, "clock_s": clock, "target_s": target}
        rows.append({"what": f"fan of {shots}, {name}", **row})
    for name, target in list(MAPS.items())[: 1 if quick else None]:
        whole = min(timed(score_map, sandbox.load(name))[0] for _ in range(repeats))
        rows.append({"what": f"map, {name}", "processor_s": whole, "first_s": whole, "target_s": target})
    return rows


def by_two(scene: Scene, shots: int, how: Sequence[Any]) -> float:
    """Time by the clock in s in which two processes compute a whole fan, asked as often as the window asks them."""
    one, other = processes = Processes(1), Processes(1)
    try:
        for each in processes:
            each.submit(elsewhere, scene, 0, 0).result()  # it starts
        started, left, known = perf_counter(), shots, list[Any]()
        drawn, asked = one.submit(seen, scene, shots, how, known), other.submit(elsewhere, scene, shots, left)
        while left:
            sleep(FRAME)
            if asked.done():
                known = asked.result()
                asked = other.submit(elsewhere, scene, shots, left)
            if drawn.done():
                left = drawn.result().left
                drawn = one.submit(seen, scene, shots, how, known)
        return perf_counter() - started
    finally:
        for each in processes:
            each.close(abandon=True)


def seen(scene: Scene, shots: int, how: Sequence[Any], known: Sequence[Any]) -> fan.Cloud:
    """A fan as far as one process has computed it, with what is known from another."""
    with patch.object(fan, "SHOTS", shots):
        return fan.cloud(scene, *how, known)


def elsewhere(scene: Scene, shots: int, left: int) -> list[Any]:
    """Return the part of a fan that another process has computed."""
    with patch.object(fan, "SHOTS", shots):
        return fan.shots_from_end(scene, 1.0, left) if shots else []


def steps(shape: tuple[int, int]) -> dict[str, float]:
    """Seconds of processor time of a shot in each step of a sweep, and of its forces alone."""
    scene = sandbox.load("basketball")
    plan = Plan(scene, tuple(Values(key, tuple(values.tolist())) for key, values in grid(shape).items()))
    spent = dict.fromkeys(("parameters", "build and stack", "flight", "touches", "objects", "facts"), 0.0)

    def clocked(step: str, work: Callable[..., Any]) -> Callable[..., Any]:
        def wrapped(*arguments: Any) -> Any:
            seconds, done = timed(work, *arguments)
            spent[step] += seconds
            return done

        return wrapped

    reader = Scene.reader
    with ExitStack() as patched:
        for step, owner, name in (
            ("parameters", Varied, "parameters"),
            ("build and stack", lab_runs, "built_at_once"),
            ("flight", Batch, "fly"),
            ("touches", BatchSurfaces, "first_touch"),
            ("objects", BatchRecord, "flown"),
            ("facts", lab_runs, "facts_at_once"),
        ):
            patched.enter_context(patch.object(owner, name, clocked(step, getattr(owner, name))))
        patched.enter_context(patch.object(Scene, "reader", lambda *given: clocked("facts", reader(*given))))
        rows = records(plan, 0, plan.size)
    spent["flight"] -= spent["touches"]
    with tempfile.TemporaryDirectory() as folder, RowFile(Path(folder) / "map.csv", plan) as file:
        spent["rows as CSV"], _ = timed(file.append, rows)
    spent["floor"] = floor_of("basketball", SPEEDS, ANGLES, shape)
    return {step: seconds / plan.size for step, seconds in spent.items()}


def by_bare_pymunk(setup: Setup, run: Run) -> tuple[float, float, int]:
    """Seconds, error in m, and steps per second, at the lowest rate that reaches the target."""
    shot = Launched(replace(setup, duration=run.duration, until=None), basketball_law)
    x, y = run.before("ball", run.duration)[:2]
    for rate in RATES:
        spent, end = timed(by_pymunk.shoot, shot, rate)
        error = hypot(end.x - x, end.y - y)
        if error <= TARGET:
            break
    return spent, error, rate


def forces_alone(shots: int, evaluations: int) -> float:
    """Seconds that numpy takes to evaluate the forces of this many shots this many times."""
    vx, vy = np.full(shots, 4.0), np.linspace(-6.0, 6.0, shots)
    once = min(timeit(lambda: basketball_law(vx, vy, 0.0), number=50) / 50 for _ in range(5))  # type: ignore[arg-type]
    return evaluations * once


def the_map(shape: tuple[int, int], drawn: int, repeats: int) -> dict[str, Any]:
    """A row for each way of computing it."""
    flown, balanced = setups(shape), resolve()
    shots = len(flown)
    together_s, runs = usual(lambda: list(simulate_many(flown, balanced)), repeats)
    one_by_one_s, _ = timed(lambda: [simulate(setup, balanced) for setup in flown])
    evaluations = mean(run.numerics.force_evaluations for run in runs)
    limit = forces_alone(shots, round(evaluations)) / shots
    whole = "basketball", SPEEDS, ANGLES, shape, "--jobs"
    commands = [[swept(*whole, jobs, clock=perf_counter) for jobs in ("1", "2")] for _ in range(repeats)]
    finest = resolve("precise", tolerance=1e-9)
    some = Random(1).sample(flown, drawn)
    bare = [by_bare_pymunk(setup, simulate(setup, finest)) for setup in some]
    found = {
        "sandbox sweep, 1 process": (median(one for one, _ in commands) / shots, limit),
        "sandbox sweep, 2 processes": (median(two for _, two in commands) / shots, limit / 2),
        "simulate_many, engine alone": (together_s / shots, limit),
        "simulate, engine alone": (one_by_one_s / shots, limit),
        "bare pymunk, extrapolated": (mean(spent for spent, _, _ in bare), limit),
    }
    rows = [
        {"way": way, "s_per_shot": spent, "shots_per_s": 1 / spent, "map_s": spent * shots, "over_limit": spent / least}
        for way, (spent, least) in found.items()
    ]
    return {
        "shots": shots,
        "cores": os.cpu_count(),
        "evaluations_per_shot": evaluations,
        "limit_s_per_shot": limit,
        "bare_pymunk": [{"time_s": spent, "error_m": error, "steps_per_s": rate} for spent, error, rate in bare],
        "rows": rows,
    }


# --------------------------------------------------------------------------------------------------------------- growth


def by_shots(shape: tuple[int, int]) -> dict[str, float]:
    shots = shape[0] * shape[1]
    spent, _ = usual(lambda: sweep("basketball", grid(shape)), 3 if shots < 1_000 else 1)
    return {"shots": shots, "time_s": spent, "ms_per_shot": 1e3 * spent / shots}


def by_balls(balls: int, repeats: int) -> dict[str, float]:
    setup, balanced = together(balls), resolve()
    spent, _ = usual(lambda: simulate(setup, balanced), repeats)
    return {"balls": balls, "time_s": spent, "ms_per_ball": 1e3 * spent / balls}


# --------------------------------------------------------------------------------------------------------------- report


def report(results: dict[str, Any]) -> None:
    found, drawn = results["map"], results["map"]["bare_pymunk"]
    ways = {
        "": "{way}",
        "shots/s": "{shots_per_s:,.1f}",
        "the map": "{map_s:,.1f} s",
        "over limit": "{over_limit:,.0f}",
    }
    show(f"{found['shots']:,} free throws, {found['cores']} cores", found["rows"], ways)
    reached = sum(one["error_m"] <= TARGET for one in drawn)
    rates = ", ".join(f"{one['steps_per_s']:,}" for one in drawn)
    parts = ", ".join(f"{step} {1e6 * spent:.0f} us" for step, spent in results["steps"].items())
    limit = f"{found['evaluations_per_shot']:.0f} evaluations of the forces a shot in numpy"
    say(
        *paragraph(f"limit: {limit}, {1e6 * found['limit_s_per_shot']:.1f} us"),
        *paragraph(f"bare pymunk: {len(drawn)} drawn, {reached} within {100 * TARGET:g} cm, at {rates} steps/s"),
        *paragraph(f"a shot of a sweep: {parts}"),
    )
    shots = {"shots": "{shots:,}", "time": "{time_s:.2f} s", "a shot": "{ms_per_shot:.2f} ms"}
    show("growth with the shots", results["shots"], shots)
    spent = {"processor": "{processor_s:.2f} s", "floor": "{floor_s:.3f} s", "target": "{target_s:.2f} s"}
    show("whole commands", results["commands"], {"": "{command}", **spent})
    spent = {"processor": "{processor_s:.2f} s", "first": "{first_s:.2f} s"}
    spent |= {"clock": "{clock_s:.2f} s", "target": "{target_s:.2f} s"}
    show("in the window", results["window"], {"": "{what}", **spent})
    balls = {"balls": "{balls:,}", "time": "{time_s:.2f ms}", "a ball": "{ms_per_ball:.2f} ms"}
    show("growth with the balls", results["balls"], balls)


def main() -> None:
    arguments = command_line(__doc__, repeats=3)
    quick, repeats = arguments.quick, arguments.repeats
    gc.set_threshold(100_000)  # as in the program itself
    results = {
        "map": the_map((6, 5) if quick else MAP, 1 if quick else DRAWN, repeats),
        "steps": steps((6, 6) if quick else MAP),
        "shots": [by_shots(shape) for shape in (((3, 2),) if quick else GRIDS)],
        "commands": commands(repeats, quick),
        "window": in_the_window(repeats, quick),
        "balls": [by_balls(balls, 3 * repeats) for balls in (BALLS[:2] if quick else BALLS)],
    }
    report(results)
    keep(arguments.json, results)


if __name__ == "__main__":
    main()
