"""Error against time: a free throw that clips the rim, and a golf flight, ours beside plain pymunk, in one process.

Run ``python benchmarks/engine.py [--json F]``. The error is that of the ball's position at the end, against "precise"
at a thousandth of its tolerance; the time is the median of repeats, taken in turn over all methods so that a slow
moment of the machine hits all.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from math import hypot
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import sandbox
from sandbox.engine import simulate
from sandbox.engine.accuracy import LEVELS, Accuracy, resolve
from sandbox.engine.setup import Setup

#: The shot of the design: off the front of the rim, then high; position 2.5 s after the release.
RIM = {
    "launch.speed": 7.3,
    "launch.angle": 52.0,
    "launch.spin": 180.0,
}
PLAIN_RATES = (60, 1_000, 4_000, 16_000, 64_000, 256_000)  # steps/s
TARGET = 0.01  # m


def rim_shot() -> Setup:
    """The basketball scene, run for 2.5 s whatever the ball does."""
    return replace(sandbox.load("basketball", RIM).build(), duration=2.5, until=None)


def golf_flight() -> Setup:
    """The default drive, to its landing."""
    return replace(sandbox.load("golf").build(), until=lambda event: True)


def methods(plain_rates: tuple[int, ...]) -> dict[str, Accuracy]:
    """What is compared, by name."""
    exact = {f"exact, {name}": accuracy for name, accuracy in LEVELS.items()}
    return exact | {f"plain, {rate:,} steps/s": resolve(method="plain", step=1 / rate) for rate in plain_rates}


def compare(setup: Setup, plain_rates: tuple[int, ...], repeats: int) -> list[dict[str, Any]]:
    """Error in m and median time in s of each method."""
    name = setup.balls[0].name
    best = resolve("precise", tolerance=1e-8)
    reference = simulate(setup, best)
    x, y = reference.state(name, reference.duration)[:2]
    chosen = methods(plain_rates)
    times: dict[str, list[float]] = {method: [] for method in chosen}
    ends: dict[str, float] = {}
    for round_number in range(repeats):
        for method, accuracy in chosen.items():
            if accuracy.method == "plain" and accuracy.step < 1e-4 and round_number > 0:
                continue  # seconds each: once is enough
            started = perf_counter()
            run = simulate(setup, accuracy)
            times[method].append(perf_counter() - started)
            u, v = run.state(name, run.duration)[:2]
            ends[method] = hypot(u - x, v - y)
    return [{"method": method, "error_m": ends[method], "time_s": median(times[method])} for method in chosen]


def ratio_at(rows: list[dict[str, Any]], target: float) -> float | None:
    """How many times longer plain pymunk takes than ours, each at its cheapest below the target error.

    Where no plain run gets there, the finest is taken: the true ratio is larger.
    """
    ours = [row["time_s"] for row in rows if row["method"].startswith("exact") and row["error_m"] < target]
    plain = [row for row in rows if row["method"].startswith("plain")]
    theirs = [row["time_s"] for row in plain if row["error_m"] < target] or [plain[-1]["time_s"]]
    return min(theirs) / min(ours) if ours else None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="write the rows here")
    parser.add_argument("--repeats", type=int, default=15)
    arguments = parser.parse_args()
    cases = {
        "rim shot, 2.5 s": compare(rim_shot(), PLAIN_RATES, arguments.repeats),
        "golf flight to landing": compare(golf_flight(), PLAIN_RATES[:5], arguments.repeats),
    }
    for case, rows in cases.items():
        sys.stdout.write(f"\n{case}\n  {'method':<26} {'error':>12} {'time':>12}\n")
        for row in rows:
            sys.stdout.write(f"  {row['method']:<26} {row['error_m']:>10.2e} m {1e3 * row['time_s']:>9.2f} ms\n")
        ratio = ratio_at(rows, TARGET)
        if ratio is not None:
            sys.stdout.write(f"  at {100 * TARGET:g} cm error: plain pymunk takes {ratio:,.0f} times as long\n")
    if arguments.json:
        arguments.json.write_text(json.dumps(cases, indent=1))


if __name__ == "__main__":
    main()
