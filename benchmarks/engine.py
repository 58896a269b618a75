"""Error against time: a free throw that clips the rim, and a golf flight; this engine, pymunk alone and scipy, in one
process.

Run ``python benchmarks/engine.py [--json F] [--repeats N] [--quick]``. The error is that of the ball's position at the
end, against "precise" at a thousandth of its tolerance. The time is processor time, the median of repeats interleaved
over all methods; slow methods run once.

- exact: this engine, at each level.
- scipy: ``solve_ivp`` with a terminal event for each surface (by_scipy.py), at a tolerance and a longest step.
- bare pymunk: a Space, drag in ``velocity_func`` and a loop (by_pymunk.py), without recording the path.
- plain: the best of pymunk alone, as a method of this program (pymunk_space.py), with recording, checks and reports.

The limit is a lower bound for any method: the fewest evaluations with which scipy reaches the same error when given the
time and state of every impact, by RK45 or DOP853 at any tolerance, times the cost of one evaluation in Python.
"evaluations" and "time" are relative to that limit, at the error of their row.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import hypot, inf
from statistics import median
from time import thread_time
from timeit import timeit
from typing import Any, NamedTuple

import by_pymunk
import by_scipy
from measured import command_line, keep, say, show, timed
from shots import Shot, golf_flight, rim_shot

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS, Accuracy, resolve
from sandbox.engine.paths.run import Run

TARGET = 0.01  # m
#: A method whose runs take longer than the first time, in s, runs once; the others repeat for the second in each turn.
LONG, TURN = 0.2, 0.02
#: Tolerances of the flights for the limit: three per power of ten.
LADDER = [10.0 ** (-k / 3) for k in range(37)]

#: Method, tolerance, longest step in s.
SCIPY_ON_THE_RIM = (
    ("RK45", 1e-3, inf),
    ("RK45", 1e-3, 0.05),
    ("RK45", 1e-6, 0.01),
    ("DOP853", 1e-3, inf),
    ("DOP853", 1e-6, 0.05),
    ("DOP853", 1e-9, 0.01),
)
SCIPY_IN_FLIGHT = tuple((method, tolerance, inf) for method in ("RK45", "DOP853") for tolerance in (1e-3, 1e-6, 1e-9))
#: Steps per second.
PLAIN_ON_THE_RIM, PLAIN_IN_FLIGHT = (60, 120, 240, 480, 1_000, 4_000), (20, 60, 240, 1_000)


class End(NamedTuple):
    """The end of a shot in m, and the number of evaluations of its forces."""

    x: float
    y: float
    evaluations: int


class Case(NamedTuple):
    """A shot and the methods compared with ours: steps per second, and scipy's settings."""

    name: str
    shot: Shot
    bare_rates: tuple[int, ...]
    plain_rates: tuple[int, ...]
    scipy: tuple[tuple[str, float, float], ...]


def cases(quick: bool) -> list[Case]:
    rim, golf = ("rim shot, 2.5 s", rim_shot()), ("golf flight to landing", golf_flight())
    if quick:
        return [
            Case(*rim, (60, 1_000), (60,), SCIPY_ON_THE_RIM[1:2]),
            Case(*golf, (1_000,), (1_000,), SCIPY_IN_FLIGHT[:1]),
        ]
    fine = (60, 1_000, 4_000, 16_000, 32_000)
    return [
        Case(*rim, (*fine, 64_000, 256_000), PLAIN_ON_THE_RIM, SCIPY_ON_THE_RIM),
        Case(*golf, (60, 1_000, 2_000, 4_000, 16_000), PLAIN_IN_FLIGHT, SCIPY_IN_FLIGHT),
    ]


def ours(shot: Shot, accuracy: Accuracy) -> End:
    run = simulate(shot.setup, accuracy)
    x, y = run.state(shot.setup.balls[0].name, run.duration)[:2]
    return End(x, y, run.numerics.force_evaluations)


def methods(case: Case) -> dict[str, Callable[[], tuple[float, float, int]]]:
    """Return the methods to compare, by name."""
    shot = case.shot
    chosen: dict[str, Callable[[], tuple[float, float, int]]] = {}
    for name, accuracy in LEVELS.items():
        chosen[f"exact, {name}"] = partial(ours, shot, accuracy)
    for method, tolerance, longest in case.scipy:
        name = f"scipy {method}, {tolerance:.0e}" + ("" if longest == inf else f", steps <= {longest:g} s")
        chosen[name] = partial(by_scipy.shoot, shot, method, tolerance, longest)
    for rate in case.bare_rates:
        chosen[f"bare pymunk, {rate:,} steps/s"] = partial(by_pymunk.shoot, shot, rate)
    for rate in case.plain_rates:
        chosen[f"plain, {rate:,} steps/s"] = partial(ours, shot, resolve(method="plain", step=1 / rate))
    return chosen


def limits(shot: Shot, reference: Run) -> list[tuple[float, int]]:
    """Error in m and evaluations of the flights alone."""
    return [
        by_scipy.flight_alone(shot, reference, method, tolerance)
        for method in ("RK45", "DOP853")
        for tolerance in LADDER
    ]


def seconds_per_evaluation(shot: Shot) -> float:
    ball = shot.setup.balls[0]
    state = (*ball.velocity, ball.spin)
    return min(timeit(lambda: shot.law(*state), number=20_000, timer=thread_time) / 20_000 for _ in range(5))


def compare(case: Case, repeats: int) -> list[dict[str, Any]]:
    """A row for each method."""
    shot = case.shot
    reference = simulate(shot.setup, resolve("precise", tolerance=1e-8))
    x, y = reference.state(shot.setup.balls[0].name, reference.duration)[:2]
    alone, cost = limits(shot, reference), seconds_per_evaluation(shot)
    chosen = methods(case)
    ends: dict[str, tuple[float, float, int]] = {}
    first: dict[str, float] = {}
    for method, fly in chosen.items():
        first[method], ends[method] = timed(fly)
    turns: dict[str, list[float]] = {method: [] for method in chosen if first[method] <= LONG}
    for _ in range(repeats):
        for method, times in turns.items():
            times += [timed(chosen[method])[0] for _ in range(max(1, round(TURN / first[method])))]
    rows = []
    for method, (u, v, evaluations) in ends.items():
        error, spent = hypot(u - x, v - y), median(turns.get(method, [first[method]]))
        fewest = min(count for reached, count in alone if reached <= max(error, alone[-1][0]))
        rows.append(
            {
                "method": method,
                "error_m": error,
                "time_s": spent,
                "evaluations": evaluations,
                "limit_evaluations": fewest,
                "limit_s": fewest * cost,
                "evaluations_over_limit": evaluations / fewest,
                "time_over_limit": spent / (fewest * cost),
            }
        )
    return rows


def ratios_at(rows: list[dict[str, Any]], target: float) -> dict[str, float]:
    """Times of the other methods relative to ours, each at its fastest below the target error in m."""
    cheapest: dict[str, float] = {}
    for row in rows:
        kind = row["method"].partition(",")[0].partition(" ")[0]
        if row["error_m"] < target:
            cheapest[kind] = min(row["time_s"], cheapest.get(kind, inf))
    return {kind: spent / cheapest["exact"] for kind, spent in cheapest.items() if kind != "exact"}


def report(name: str, rows: list[dict[str, Any]]) -> None:
    columns = {
        "method": "{method}",
        "error": "{error_m:.1e} m",
        "time": "{time_s:.2f ms}",
        "evaluations": "{evaluations:,}",
        "evaluations over the limit": "{evaluations_over_limit:short}",
        "time over the limit": "{time_over_limit:short}",
    }
    show(name, rows, columns)
    words = {"scipy": "scipy", "bare": "bare pymunk", "plain": "plain"}
    ratios = [f"{words[kind]} {ratio:,.1f} times" for kind, ratio in ratios_at(rows, TARGET).items()]
    say(f"  at an error of {100 * TARGET:g} cm, relative to our fastest: {', '.join(ratios) or 'no other reaches it'}")


def main() -> None:
    arguments = command_line(__doc__, repeats=15)
    results = {case.name: compare(case, arguments.repeats) for case in cases(arguments.quick)}
    for name, rows in results.items():
        report(name, rows)
    keep(arguments.json, results)


if __name__ == "__main__":
    main()
