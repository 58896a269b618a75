"""Measure how honest the intervals of ``sandbox fit`` are where a film's clock and axes are not known, for places
without times, and for tables of shots.

Each case draws values, measures a run with normally distributed errors, and fits. ``python benchmarks/fit_films.py``:
how many of the 95 % intervals hold the true value, and the median processor time of a fit. Five minutes of processor
time; ``--fits N`` of each, ``--seed S``. Tracks with times are in ``benchmarks/fit.py``.
"""

from __future__ import annotations

from collections.abc import Callable
from time import process_time

import click
import numpy as np

import sandbox

Found = tuple[dict[str, float], sandbox.Fit]  # the truth, and what was fitted
BOUNCING = "collisions/bouncing-ball"


def drawn(rng: np.random.Generator, **ranges: tuple[float, float]) -> dict[str, float]:
    """True values, evenly drawn; "__" stands for a dot."""
    return {key.replace("__", "."): float(rng.uniform(*span)) for key, span in ranges.items()}


def film(rng: np.random.Generator) -> Found:
    """A ball that bounces, filmed at 30 frames a second by a tilted camera with a clock and axes of its own; 4 mm."""
    truth = drawn(rng, floor__restitution=(0.6, 0.9), launch__speed=(1.0, 2.5))
    run, t = sandbox.simulate(sandbox.load(BOUNCING, truth)), np.arange(0.0, 1.9, 1.0 / 30.0)
    places = run.states("first", t)[:, :2] + rng.normal(0.0, 0.004, (len(t), 2))
    camera = drawn(
        rng, track__time=(0, 3), track__origin__x=(-0.3, 0.3), track__origin__y=(-0.3, 0.3), track__tilt=(-4, 4)
    )
    time, *origin, tilt = camera.values()
    cos, sin = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    x, y = ((places - origin) @ np.array([[cos, -sin], [sin, cos]])).T
    vary = {"floor.restitution": (0.4, 1.0), "launch.speed": (0.3, 4.0)}
    found = sandbox.fit(BOUNCING, {"t": t + time, "x": x, "y": y}, vary, free=["origin", "time", "tilt"])
    return truth | camera, found


def throw(rng: np.random.Generator) -> Found:
    """A throw, 30 places on a photograph; 2 cm."""
    truth = drawn(rng, launch__speed=(10, 14), launch__angle=(30, 50))
    run = sandbox.simulate(sandbox.load("throws", truth))
    places = run.states("ball", np.linspace(0.05, run.duration - 0.05, 30))[:, :2] + rng.normal(0.0, 0.02, (30, 2))
    vary = {"launch.speed": (8, 20), "launch.angle": (20, 60)}
    return truth, sandbox.fit("throws", {"x": places[:, 0], "y": places[:, 1]}, vary)


def bounces(rng: np.random.Generator) -> Found:
    """A ball that bounces, 50 places on a photograph with the shutter open; 4 mm."""
    truth = drawn(rng, floor__restitution=(0.6, 0.9), launch__speed=(1.0, 2.5))
    run = sandbox.simulate(sandbox.load(BOUNCING, truth))
    places = run.states("first", np.sort(rng.uniform(0.0, 2.0, 50)))[:, :2] + rng.normal(0.0, 0.004, (50, 2))
    vary = {"floor.restitution": (0.4, 1.0), "launch.speed": (0.3, 4.0)}
    return truth, sandbox.fit(BOUNCING, {"x": places[:, 0], "y": places[:, 1]}, vary)


def shots(rng: np.random.Generator) -> Found:
    """A table of 100 drives, their carry off by 2 m and their height by 0.5 m: the density of the air."""
    truth = drawn(rng, air__density=(1.0, 1.3))
    launch = {"launch.speed": rng.normal(66, 3, 100), "launch.angle": rng.normal(13, 2, 100),
              "launch.spin": rng.normal(2700, 300, 100)}  # fmt: skip
    flown = sandbox.simulate_many(sandbox.load("golf", truth), launch, facts=("carry", "apex"))
    off = {"carry": flown["carry"] + rng.normal(0.0, 2.0, 100), "apex": flown["apex"] + rng.normal(0.0, 0.5, 100)}
    table = {**launch, **off}
    return truth, sandbox.fit("golf", table, {"air.density": (0.9, 1.5)}, columns={key: key for key in table})


CASES: tuple[Callable[[np.random.Generator], Found], ...] = (film, throw, bounces, shots)


@click.command()
@click.option("--fits", default=100, show_default=True, help="Fits of each case.")
@click.option("--seed", default=0, show_default=True)
def main(fits: int, seed: int) -> None:
    for case in CASES:
        held, seconds = [], []
        for number in range(fits):
            began = process_time()
            truth, found = case(np.random.default_rng([seed, number]))
            seconds.append(process_time() - began)
            held += [found.values[key].low <= value <= found.values[key].high for key, value in truth.items()]
        click.echo(f"{case.__name__:8s} {sum(held):4d} of {len(held):4d} {100.0 * np.mean(held):5.1f} %   "
                   f"{np.median(seconds):5.2f} s   {case.__doc__}")  # fmt: skip


if __name__ == "__main__":
    main()
