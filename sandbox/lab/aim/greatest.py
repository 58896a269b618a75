"""The greatest value of a number, by one or two parameters."""

from __future__ import annotations

from itertools import product
from math import inf

import numpy as np

from sandbox.lab.aim.question import Solution
from sandbox.lab.aim.shots import Shots

#: Points of the scan along each of one or two parameters, and of each closer look at the best of them.
_SCAN, _CLOSER = {1: 129, 2: 41}, {1: 25, 2: 9}

#: The place is found to this fraction of the range: near its greatest value a result hardly changes.
_FINE = 1e-7


def greatest(shots: Shots) -> list[Solution]:
    """The place at which the number is greatest; none if no run has it."""
    shots.planned = _SCAN[len(shots.spans)] ** len(shots.spans)
    low, high = (np.array([getattr(span, end) for span in shots.spans]) for end in ("low", "high"))
    whole, parts, best = high - low, _SCAN[len(shots.spans)], low
    left, right = low, high
    while (right - left > _FINE * whole).any():
        axes = [np.linspace(a, b, parts).tolist() for a, b in zip(left, right, strict=True)]
        points = list(product(*axes))
        heights = [_height(shots, result) for result in shots.results(points, "scan" if best is low else "solve")]
        if max(heights) == -inf:
            return []
        best = np.array(points[int(np.argmax(heights))])
        step, parts = (right - left) / (parts - 1), _CLOSER[len(shots.spans)]
        left, right = np.maximum(best - step, low), np.minimum(best + step, high)
    point = tuple(best.tolist())
    result, errors, _ = shots.checked([point])[0]
    values = {span.key: value for span, value in zip(shots.spans, point, strict=True)}
    return [Solution(values, dict(zip(values, (_FINE * whole).tolist(), strict=True)), result, errors)]


def _height(shots: Shots, result: dict[str, object] | None) -> float:
    value = None if result is None else result.get(shots.targets[0].name)
    return value if isinstance(value, int | float) else -inf
