"""The gain of Sobol points over random ones in ``sandbox spread``: how many random shots give the same error.

For each number of shots the root mean square error of mean, standard deviation and share over many seeds, compared with
many more shots: ``python benchmarks/spread.py``, about two minutes.
"""

from __future__ import annotations

import click
import numpy as np

import sandbox
from sandbox.lab.spread.causes import causes_of, shares_of

#: The scene, and the fact whose mean, standard deviation or share is measured.
CASES = (("golf", "carry"), ("basketball", "entry_angle"), ("basketball", "made"))
SHOTS, SEEDS, TRUTH = (128, 1024), 24, 1 << 16


def errors(scene: sandbox.Scene, fact: str, sampling: str, shots: int, truth: np.ndarray) -> np.ndarray:
    """Root mean square errors of mean and standard deviation, from many seeds."""
    return np.sqrt(
        np.mean([(estimates(scene, fact, sampling, shots, seed) - truth) ** 2 for seed in range(SEEDS)], axis=0)
    )


def estimates(scene: sandbox.Scene, fact: str, sampling: str, shots: int, seed: int) -> np.ndarray:
    """Mean and standard deviation of a fact, from one set of points."""
    causes = causes_of(scene, [], "by")
    shares = shares_of(shots, len(causes), seed, sampling)
    points = {each.key: each.values(column) for each, column in zip(causes, shares.T, strict=True)}
    values = sandbox.simulate_many(scene, points, facts=(fact,))[fact].astype(float)
    return np.array([values.mean(), values.std(ddof=1)])


def main() -> None:
    click.echo(
        "scene, fact                shots    error of the mean: random, Sobol, gain    of the sd: random, Sobol, gain"
    )
    for name, fact in CASES:
        scene = sandbox.load(name)
        truth = estimates(scene, fact, "sobol", TRUTH, 12345)
        for shots in SHOTS:
            random, even = (errors(scene, fact, sampling, shots, truth) for sampling in ("random", "sobol"))
            parts = [f"{r:10.2g} {e:10.2g} {(r / e) ** 2:8.0f}x" for r, e in zip(random, even, strict=True)]
            click.echo(f"{name + ', ' + fact:26s} {shots:5d}    {'    '.join(parts)}")


if __name__ == "__main__":
    main()
