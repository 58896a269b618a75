"""Search for the greatest value of a number, by one or two parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import product
from math import inf
from typing import Any

import numpy as np

from sandbox.lab.aim.question import Solution
from sandbox.lab.aim.shots import Shots

#: Points of the scan along each of one or two parameters, and of each closer look at the best of them.
_SCAN, _CLOSER = {1: 129, 2: 41}, {1: 25, 2: 9}

#: The place is found to this fraction of the range: near its greatest value a result hardly changes.
_FINE = 1e-7

#: The value that is maximized, from a run's targeted results, or None for a failed run; None or NaN if unknown.
Height = Callable[[Mapping[str, Any] | None], float | None]


def maximize(shots: Shots) -> list[Solution]:
    """The place at which the number is greatest; none if no run has it."""
    shots.planned = _SCAN[len(shots.spans)] ** len(shots.spans)
    low, high = ([getattr(span, end) for span in shots.spans] for end in ("low", "high"))
    name = shots.targets[0].name
    point, height = peak(shots, low, high, lambda result: (result or {}).get(name), scanned=True)
    if height == -inf:
        return []
    result, errors, _ = shots.checked([point])[0]
    values = {span.key: value for span, value in zip(shots.spans, point, strict=True)}
    fine: dict[str, float | None] = {span.key: _FINE * (span.high - span.low) for span in shots.spans}
    return [Solution(values, fine, result, errors)]


def peak(
    shots: Shots, low: Sequence[float], high: Sequence[float], height: Height, scanned: bool = False
) -> tuple[tuple[float, ...], float]:
    """The point between two corners at which the ``height`` of the result is greatest, and that height, -inf if it is
    nowhere known: looked for on grids, each around the best point of the one before, the first of them a scan."""
    left, right, best, most = np.array(low), np.array(high), tuple(low), -inf
    whole, parts = [span.high - span.low for span in shots.spans], (_SCAN if scanned else _CLOSER)[len(low)]
    while (right - left > np.multiply(_FINE, whole)).any():
        points = list(product(*np.linspace(left, right, parts).T.tolist()))
        results = shots.results(points, "scan" if scanned else "solve")
        heights = np.nan_to_num(np.array([height(result) for result in results], float), nan=-inf)
        best, most = points[int(heights.argmax())], float(heights.max())
        if most == -inf:
            break
        step, parts, scanned = (right - left) / (parts - 1), _CLOSER[len(low)], False
        left, right = np.maximum(best - step, low), np.minimum(best + step, high)
    return best, most
