"""The place at which a result that is true or false is true most often: for a player who does not hit it exactly."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import product
from statistics import NormalDist

import numpy as np

from sandbox.lab.aim.question import Solution, Trial
from sandbox.lab.aim.shots import Shots
from sandbox.lab.runs import columns_at
from sandbox.lab.scatter import players_spread
from sandbox.lab.statistics import wilson

#: Points of the scan along each of one or two parameters, and of the closer look around the best of them.
_SCAN, _CLOSER = {1: 41, 2: 11}, {1: 9, 2: 5}

#: Shots around each point of the scan, and of the closer look. All points have the same deviations, so that the place
#: of the best is known better than the share there.
_SHOTS, _MORE = 128, 512


def most_often(shots: Shots, around: tuple[int, int] | None = None) -> list[Solution]:
    """The place at which most shots of a practised player have the result, with that share and half of its 95 %
    interval; [] where no shot has it. ``around`` is how many are tried around each point of the scan, and of the closer
    look."""
    scanned, tried = around or (_SHOTS, _MORE)
    spans = shots.spans
    count = len(spans)
    shots.planned = _SCAN[count] ** count + _CLOSER[count] ** count
    low, high = np.array([span.low for span in spans]), np.array([span.high for span in spans])
    step = (high - low) / (_SCAN[count] - 1)
    best, _ = _best(shots, np.linspace(low, high, _SCAN[count]).T, scanned, "scan")
    near = np.linspace(np.maximum(best - step, low), np.minimum(best + step, high), _CLOSER[count]).T
    best, share = _best(shots, near, tried, "solve")
    if share == 0.0:
        return []
    name, ends = shots.targets[0].name, wilson(share, tried)
    values = {span.key: value for span, value in zip(spans, best.tolist(), strict=True)}
    fine: dict[str, float | None] = {
        span.key: float(places[1] - places[0]) for span, places in zip(spans, near, strict=True)
    }
    return [Solution(values, fine, {name: share}, {name: 0.5 * (ends[1] - ends[0])})]


def _best(shots: Shots, axes: np.ndarray, count: int, phase: str) -> tuple[np.ndarray, float]:
    """The middle of the points of a grid with the greatest share, and that share; ``axes`` have the shape (parameters,
    points along each)."""
    points = list(product(*axes.tolist()))
    shares = np.array(_shares(shots, points, count))
    for point, share in zip(points, shares.tolist(), strict=True):
        shots.tried(Trial(point, (share,), phase))
    return np.array(points)[shares == shares.max()].mean(axis=0), float(shares.max())


def _shares(shots: Shots, points: Sequence[tuple[float, ...]], count: int) -> list[float]:
    """The share of so many shots around each point, each deviating as a practised player does."""
    keys, name = [span.key for span in shots.spans], shots.targets[0].name
    rows, order = list[tuple[float, ...]](), list(keys)
    for point in points:
        spread = players_spread(shots.scene.changed(dict(zip(keys, point, strict=True)), "vary"))
        order = [*keys, *(key for key in spread if key not in keys)]
        columns = {key: [value] * count for key, value in zip(keys, point, strict=True)}
        for (key, (known, sd)), deviates in zip(spread.items(), _deviates(len(spread), count), strict=True):
            columns[key] = [known.within(known.value + sd * z) for z in deviates.tolist()]
        rows += zip(*(columns[key] for key in order), strict=True)
    found = np.array(columns_at(shots.scene, order, rows, asked=[name]).facts[name], dtype=bool)  # None counts as no
    shares: list[float] = found.reshape(-1, count).mean(axis=1).tolist()
    return shares


@cache
def _deviates(causes: int, count: int) -> np.ndarray:
    """Standard deviations by cause and shot, evenly spread: Sobol's points, shape (causes, count)."""
    from scipy.stats import qmc

    points = qmc.Sobol(max(causes, 1), seed=0).random(count)
    return np.vectorize(NormalDist().inv_cdf)(points.T[:causes])
