"""How the cost grows: with balls, surfaces, bodies in a pile, rows of a sweep, jobs, and Dask workers.

Run ``python benchmarks/scaling.py [--json F] [--repeats N] [--only rows,jobs] [--rows 1e6] [--quick]``. Three
minutes on an idle machine; ``--rows`` is the longest sweep. Dask workers need ``distributed``.

The exponent is the slope of log time over log size, by least squares over the larger half of the sizes: 1 where the
cost of one more is always the same. Times are processor times, except for the jobs, where they are by the clock.

- Balls: a gas seen from above, in a box whose area grows with them, so that each meets as many others: elastic, without
  forces, for a second.
- Surfaces: a ball that bounces over a floor in so many pieces, for five seconds.
- Pile: boxes that are let go one above the other, two seconds.
- Rows: free throws over speed and angle with all facts, written to a file by one process; and the most memory that this
  process has used by then, in all, which rows must not add to.
- Jobs: the same with several processes; the exponent is that of the throughput, 1 where each adds as much.
- Dask: the same with the workers of a Dask cluster on this machine, which are processes of one thread each.
"""

from __future__ import annotations

import gc
import resource
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from math import cos, log, pi, sin
from pathlib import Path
from random import Random
from time import perf_counter, thread_time
from typing import Any

import numpy as np
from measured import command_line, keep, say, show, timed

import sandbox
from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import box
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.lab.axes import Values
from sandbox.lab.plan import Plan
from sandbox.lab.sweep import sweep_to_file, workers
from sandbox.physics.forces import Gravity

BALLS = (2, 5, 10, 20, 50, 100, 200, 500)
SURFACES = (2, 5, 10, 20, 50, 100, 200, 500)
PILE = (2, 3, 4, 6, 8, 12)
ROWS = (100, 1_000, 10_000, 100_000)
JOBS, ROWS_OF_JOBS = (1, 2, 4), 10_000

R, SPEED = 0.05, 1.0  # m, m/s
#: Side of the square that each ball of the gas has, in radii.
ROOM = 8.0
G = 9.81  # m/s^2


def gas(count: int) -> Setup:
    """So many balls on a square lattice, in random directions, within four walls."""
    rng, side = Random(1), int(np.ceil(count**0.5))
    room, edge = ROOM * R, ROOM * R * side
    balls = []
    for number in range(count):
        way = rng.uniform(0.0, 2.0 * pi)
        place = ((number % side + 0.5) * room, (number // side + 0.5) * room)
        velocity = (SPEED * cos(way), SPEED * sin(way))
        balls.append(Ball(f"ball {number}", mass=1.0, radius=R, position=place, velocity=velocity))
    corners = [(0.0, 0.0), (edge, 0.0), (edge, edge), (0.0, edge)]
    walls = [
        Surface(f"wall {number}", Segment(corners[number - 1], corner), restitution=1.0, friction=0.0)
        for number, corner in enumerate(corners)
    ]
    return Setup(balls, walls, duration=1.0, between_balls=ConstantBounce(Bounce(1.0, 0.0)))


def floor_of(pieces: int) -> Setup:
    """A ball that bounces over a floor of 100 m in so many pieces."""
    ends = np.linspace(-10.0, 90.0, pieces + 1).tolist()
    floor = [
        Surface(f"floor {number}", Segment((left, 0.0), (right, 0.0)), restitution=0.9, friction=0.1)
        for number, (left, right) in enumerate(pairwise(ends))
    ]
    start = {"position": (0.0, 1.0), "velocity": (10.0, 2.0)}
    return Setup([Ball("ball", mass=0.6, radius=0.12, forces=[Gravity(G, 0.6)], **start)], floor, duration=5.0)


def pile(count: int) -> Setup:
    """So many boxes, a little apart, one above the other."""
    bodies = [
        Body(
            f"box {n}",
            mass=1.0,
            shape=box(0.2, 0.1),
            position=(0.01 * (n % 2), 0.06 + 0.11 * n),
            forces=[Gravity(G, 1.0)],
        )
        for n in range(count)
    ]
    floor = Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), restitution=0.1, friction=0.6)
    return Setup(bodies, [floor], duration=2.0, between_balls=ConstantBounce(Bounce(0.1, 0.6)))


def simulated(setup: Setup, repeats: int) -> dict[str, Any]:
    """The least time in s of a run, and its events."""
    times, runs = zip(*(timed(simulate, setup, resolve()) for _ in range(repeats)), strict=True)
    return {"time_s": min(times), "events": len(runs[0].events)}


def swept(rows: int, jobs: int = 1, clock: Callable[[], float] = thread_time, scheduler: str | None = None) -> float:
    """Time in s of a whole sweep into a file."""
    side = round(rows**0.5)
    spans = ("launch.speed", 6.8, 8.6, side), ("launch.angle", 40.0, 70.0, rows // side)
    axes = tuple(Values(key, tuple(np.linspace(low, high, count).tolist())) for key, low, high, count in spans)
    plan = Plan(sandbox.load("basketball"), axes)
    with tempfile.TemporaryDirectory() as folder, workers(jobs, scheduler) as pool:
        return timed(sweep_to_file, plan, Path(folder) / "rows.csv", pool, clock=clock)[0]


def of_rows(rows: int) -> dict[str, Any]:
    """The time in s of a sweep with so many rows, and the most memory so far in MB."""
    spent = swept(rows)
    return {"time_s": spent, "memory_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}


def exponent(sizes: Sequence[float], times: Sequence[float]) -> float:
    """The slope of log time over log size, over the larger half of the sizes."""
    some = slice((len(sizes) - 1) // 2, None)
    return float(np.polyfit([log(size) for size in sizes[some]], [log(time) for time in times[some]], 1)[0])


def grown(name: str, sizes: Sequence[int], measure: Callable[[int], dict[str, Any]]) -> dict[str, Any]:
    """The rows of one table, and its exponent."""
    rows = [{name: size, **measure(size)} for size in sizes]
    for row in rows:
        row["each_s"] = row["time_s"] / row[name]
    return {"rows": rows, "exponent": exponent(sizes, [row["time_s"] for row in rows])}


def of_jobs(name: str, rows: int, jobs: Sequence[int], sweep: Callable[[int, int], float]) -> dict[str, Any]:
    """The rows of a second by the clock, by so many processes."""
    table = [{name: count, "time_s": sweep(rows, count)} for count in jobs]
    for row in table:
        row["rows_per_s"] = rows / row["time_s"]
    return {"rows": table, "exponent": exponent(jobs, [row["rows_per_s"] for row in table])}


def by_dask(rows: int, jobs: int) -> float:
    """Time in s by the clock of a sweep by so many workers of a Dask cluster, which has been started."""
    import distributed

    quiet = {"host": "127.0.0.1", "dashboard_address": None, "silence_logs": 50}
    with distributed.LocalCluster(n_workers=jobs, threads_per_worker=1, **quiet) as cluster:
        return swept(rows, clock=perf_counter, scheduler=cluster.scheduler_address)


COLUMNS = {"time": "{time_s:.1f ms}", "each": "{each_s:.3f ms}"}
TITLES: dict[str, tuple[str, dict[str, str]]] = {
    "balls": ("balls of a gas", {"events": "{events:,}"}),
    "surfaces": ("pieces of a floor", {"events": "{events:,}"}),
    "pile": ("boxes in a pile", {"events": "{events:,}"}),
    "rows": ("rows of a sweep", {"memory": "{memory_mb:.0f} MB"}),
    "jobs": ("jobs of a sweep, by the clock", {"rows a second": "{rows_per_s:,.0f}"}),
    "dask": ("Dask workers of a sweep, by the clock", {"rows a second": "{rows_per_s:,.0f}"}),
}


def main() -> None:
    options = {"--only": {"default": ",".join(TITLES)}, "--rows": {"type": float, "default": ROWS[-1]}}
    arguments = command_line(__doc__, repeats=3, options=options)
    quick, repeats, chosen = arguments.quick, arguments.repeats, arguments.only.split(",")
    gc.set_threshold(100_000)  # as in the program itself
    some, rows_of_jobs = (2, 20) if quick else (None, ROWS_OF_JOBS)
    sizes = [rows for rows in ROWS if rows < arguments.rows] + [int(arguments.rows)]
    measured: dict[str, Callable[[], dict[str, Any]]] = {
        "balls": partial(grown, "balls", BALLS[:some], lambda n: simulated(gas(n), repeats)),
        "surfaces": partial(grown, "surfaces", SURFACES[:some], lambda n: simulated(floor_of(n), repeats)),
        "pile": partial(grown, "pile", PILE[:some], lambda n: simulated(pile(n), repeats)),
        "rows": partial(grown, "rows", (10, 20) if quick else sizes, of_rows),
        "jobs": partial(of_jobs, "jobs", rows_of_jobs, JOBS[:some], lambda n, jobs: swept(n, jobs, perf_counter)),
        "dask": partial(of_jobs, "dask", rows_of_jobs, JOBS[:some], by_dask),
    }
    results = {name: measure() for name, measure in measured.items() if name in chosen}
    for name, found in results.items():
        title, more = TITLES[name]
        columns = {name: f"{{{name}:,}}", **({} if name in ("jobs", "dask") else COLUMNS), **more}
        show(f"{title}: exponent {found['exponent']:.2f}", found["rows"], columns)
    say("")
    keep(arguments.json, results)


if __name__ == "__main__":
    main()
