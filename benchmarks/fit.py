"""Measure how honest the intervals of ``sandbox fit`` are: how often they hold the truth, of synthetic tracks.

In eight scenes, with flight, bounces, sliding and cushions, values are drawn, a run is measured with normally
distributed errors, and fitted. ``python benchmarks/fit.py``: how many of the 95 % intervals hold the true value, and
the processor time of a fit; without and with three gross errors in each track and a robust loss. Three minutes of
processor time; ``--tracks N`` of each scene, ``--seed S``, ``--only SCENE``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from time import process_time
from typing import Any

import click
import numpy as np

import sandbox

#: Gross errors of a track, and by how many standard deviations a coordinate is off.
OUTLIERS, GROSS = 3, (8.0, 40.0)


@dataclass(frozen=True)
class Case:
    """Tracks of one scene: what varies, within which range the truth is drawn, and how it is measured."""

    scene: str
    about: str
    ranges: Mapping[str, tuple[float, float]]  # of the search; the truth is drawn from its middle three fifths
    times: tuple[float, float]  # s, of the last point
    noise: tuple[float, float]  # m, standard deviations of x and y
    points: int = 40
    fixed: Mapping[str, Any] = field(default_factory=dict)


CASES = (
    Case(
        "basketball",
        "rim, board and floor",
        {"launch.speed": (6.5, 8.5), "launch.angle": (45, 60), "floor.restitution": (0.6, 0.9)},
        (2.0, 3.5),
        (0.01, 0.01),
    ),
    Case(
        "golf",
        "flight, bounces, roll",
        {"launch.speed": (55, 75), "launch.angle": (8, 18), "launch.spin": (1500, 4500)},
        (6.0, 12.0),
        (0.3, 0.15),
    ),
    Case(
        "billiards",
        "sliding, rolling, cushions",
        {"cue.speed": (2, 6), "cue.angle": (20, 60), "cushion.restitution": (0.75, 0.95)},
        (2.0, 5.0),
        (0.004, 0.004),
        fixed={"balls": [{"name": "cue", "x": -0.6, "y": 0.1}], "table.pockets": False},
    ),
    Case(
        "tennis",
        "flight with spin, bounces",
        {"launch.speed": (40, 56), "launch.angle": (-8, -3), "launch.spin": (-2500, 0)},
        (0.6, 1.2),
        (0.02, 0.01),
    ),
    Case(
        "soccer",
        "drag in flight",
        {"launch.speed": (22, 32), "launch.angle": (14, 26), "ball.drag.coefficient": (0.05, 0.45)},
        (0.8, 1.6),
        (0.05, 0.05),
        fixed={"ball.drag.model": "constant", "wall.present": False},
    ),
    Case(
        "minigolf/bank-shot",
        "boards",
        {"launch.speed": (2.0, 3.6), "launch.angle": (15, 50), "lane.restitution": (0.6, 0.9)},
        (1.5, 3.0),
        (0.005, 0.005),
        fixed={"hole.x": 3.0, "hole.y": -0.35},
    ),
    Case(
        "collisions/bouncing-ball",
        "bounces",
        {"gravity": (8.5, 11.0), "floor.restitution": (0.6, 0.9)},
        (1.5, 3.0),
        (0.003, 0.003),
        points=30,
    ),
    Case(
        "bowling",
        "oil, sliding, rolling",
        {"launch.speed": (7.0, 9.5), "launch.spin": (250, 500), "dry": (0.1, 0.3)},
        (1.7, 2.0),
        (0.02, 0.01),
    ),
)


@dataclass
class Tally:
    """Counts of one scene's tracks: intervals that hold, values, fits that failed; and processor times in s."""

    held: int = 0
    values: int = 0
    failed: int = 0
    seconds: list[float] = field(default_factory=list)

    def __add__(self, other: Tally) -> Tally:
        seconds = self.seconds + other.seconds
        return Tally(self.held + other.held, self.values + other.values, self.failed + other.failed, seconds)


def track(case: Case, rng: np.random.Generator, outliers: int) -> tuple[dict[str, float], dict[str, Any]]:
    """True values, and a track measured with errors."""
    while True:
        truth = {}
        for key, (low, high) in case.ranges.items():
            truth[key] = float(low + rng.uniform(0.2, 0.8) * (high - low))
        run = sandbox.simulate(sandbox.load(case.scene, {**case.fixed, **truth}))
        last = rng.uniform(*case.times)
        if run.duration > last:
            break
    t = np.linspace(0.0, last, case.points)
    ball = run.setup.balls[0].name
    places = run.states(ball, t)[:, :2] + rng.normal(0.0, 1.0, (case.points, 2)) * case.noise
    for row in rng.choice(case.points, outliers, replace=False):
        axis = int(rng.integers(2))
        places[row, axis] += rng.choice([-1.0, 1.0]) * rng.uniform(*GROSS) * case.noise[axis]
    return truth, {"t": t, "x": places[:, 0], "y": places[:, 1], "ball": [ball] * case.points}


def measure(case: Case, tracks: int, seed: int, outliers: int, robust: bool) -> Tally:
    """Fit some tracks, and count the intervals that hold the truth."""
    tally, scene = Tally(), sandbox.load(case.scene, case.fixed)
    for number in range(tracks):
        rng = np.random.default_rng([seed, number])
        truth, data = track(case, rng, outliers)
        began = process_time()
        try:
            found = sandbox.fit(scene, data, case.ranges, robust=robust)
        except sandbox.errors.RequestError as error:
            click.echo(f"{case.scene}, track {number}, {truth}: {error}", err=True)
            tally.failed += 1
            tally.values += len(truth)
            continue
        tally.seconds.append(process_time() - began)
        tally.values += len(truth)
        tally.held += sum(found.values[key].low <= value <= found.values[key].high for key, value in truth.items())
    return tally


def row(name: str, tallies: list[Tally]) -> str:
    """One line of the table."""
    parts = [
        f"{each.held:5d} of {each.values:4d} {100.0 * each.held / each.values:5.1f} % {np.median(each.seconds):6.2f} s"
        for each in tallies
    ]
    return f"{name:24s} {'   '.join(parts)}"


@click.command()
@click.option("--tracks", default=25, show_default=True, help="Tracks of each scene.")
@click.option("--seed", default=0, show_default=True)
@click.option("--only", default="", help="One scene.")
def main(tracks: int, seed: int, only: str) -> None:
    click.echo(f"{'':24s} {'95 % intervals that hold':33s} with {OUTLIERS} gross errors, robust")
    totals = [Tally(), Tally()]
    for case in CASES:
        if only in case.scene:
            found = [measure(case, tracks, seed, *how) for how in ((0, False), (OUTLIERS, True))]
            totals = [total + each for total, each in zip(totals, found, strict=True)]
            click.echo(row(case.scene, found))
    click.echo(row("all", totals))


if __name__ == "__main__":
    main()
