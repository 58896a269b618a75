"""Two number targets, by two parameters: as many solutions as several starts find."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import hypot, inf

import numpy as np

from sandbox.lab.aim.maximize import peak
from sandbox.lab.aim.question import Solution
from sandbox.lab.aim.root import SAME, STEP, is_met, solution
from sandbox.lab.aim.shots import Shots
from sandbox.lab.axes import Span

#: Points of the scan along each parameter.
_SCAN_EACH = 21

#: Starts, and the most iterations of each.
_STARTS, _ITERATIONS = 12, 60


def pairs(shots: Shots) -> list[Solution]:
    """The pairs of values, found from several starts, at which two numbers meet their targets."""
    from scipy.optimize import root

    first, second = shots.spans
    shots.planned = _SCAN_EACH**2
    places = [np.linspace(span.low, span.high, _SCAN_EACH).tolist() for span in shots.spans]
    results = shots.results([(x, y) for x in places[0] for y in places[1]])
    misses = np.array([shots.missed(result) for result in results]).reshape(_SCAN_EACH, _SCAN_EACH, 2)
    scales = np.array([shots.spread(index) for index in range(2)])

    def point_at(u: np.ndarray) -> tuple[float, float]:
        x, y = np.clip(u, 0.0, 1.0).tolist()
        return first.low + x * (first.high - first.low), second.low + y * (second.high - second.low)

    def missed(u: np.ndarray, phase: str) -> np.ndarray:
        beyond = u - np.clip(u, 0.0, 1.0)
        off = shots.numbers(point_at(u), phase) / scales
        return np.where(np.isfinite(off), off, 10.0) + 10.0 * beyond

    solutions: list[Solution] = []
    starts = _starts(misses / scales)
    for number, start in enumerate(starts):
        work = partial(missed, phase=f"solve {number + 1}")
        options = {"xtol": 1e-11, "eps": STEP**2, "maxfev": _ITERATIONS}
        found = np.clip(root(work, start, method="hybr", options=options).x, 0.0, 1.0)
        point = point_at(found)
        known = any(_distance(other, point, shots.spans) < 1e3 * SAME for other in solutions)
        if not known and np.isfinite(shots.numbers(point, "solve")).all() and is_met(shots, point):
            solutions.append(solution(shots, point))
    if not solutions and starts:
        low, high = (point_at(starts[0] + sign / _SCAN_EACH) for sign in (-1.0, 1.0))
        peak(shots, low, high, lambda result: -hypot(*shots.missed(result) / scales))
    return sorted(solutions, key=lambda found: tuple(found.values.values()))


def _starts(off: np.ndarray) -> list[np.ndarray]:
    """Starting points: cells in which both targets are crossed, then the points that miss by least around them."""
    size = np.hypot(off[..., 0], off[..., 1])
    size = np.where(np.isfinite(size), size, inf)
    n = len(size) - 1
    corners = np.stack([off[:-1, :-1], off[1:, :-1], off[:-1, 1:], off[1:, 1:]])
    crossed = ((corners.min(axis=0) <= 0.0) & (corners.max(axis=0) >= 0.0)).all(axis=-1)
    cells = sorted(np.argwhere(crossed).tolist(), key=lambda cell: size[cell[0], cell[1]])
    found = [(np.array(cell) + 0.5) / n for cell in cells]
    wide = np.pad(size, 1, constant_values=inf)
    around = np.stack([wide[1 + i : n + 2 + i, 1 + j : n + 2 + j] for i in (-1, 0, 1) for j in (-1, 0, 1)])
    lowest = np.argwhere((size <= around.min(axis=0)) & np.isfinite(size)).tolist()
    found += [np.array(place) / n for place in sorted(lowest, key=lambda place: size[place[0], place[1]])]
    return found[:_STARTS]


def _distance(found: Solution, point: tuple[float, ...], spans: Sequence[Span]) -> float:
    """Distance of two points in fractions of the ranges."""
    shares = [
        (found.values[span.key] - value) / (span.high - span.low) for span, value in zip(spans, point, strict=True)
    ]
    return hypot(*shares)
