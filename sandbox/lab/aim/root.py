"""What stands at a root: whether it is one, and how far the finite accuracy of the runs moves it."""

from __future__ import annotations

from math import inf, isfinite, sqrt

import numpy as np

from sandbox.lab.aim.question import Solution
from sandbox.lab.aim.shots import Shots

#: Step for slopes, and distance below which two solutions are one, as shares of the range.
STEP, SAME = 1e-5, 1e-6

#: A target is met where it is missed by less than this share of what the result varies by; or by less than its
#: numerical error, as long as that is a small share too: at a jump a finer run is off by the jump itself.
_MET, _NOISE = 1e-6, 1e-3


def is_met(shots: Shots, point: tuple[float, ...]) -> bool:
    """Whether all targets are met, within a millionth of what the results vary by, or within their numerical error."""
    misses = np.abs(shots.numbers(point, "solve"))
    spreads = np.array([shots.spread(index) for index in range(len(shots.targets))])
    if (misses <= _MET * spreads).all():
        return True
    _, _, shift = shots.checked(point)
    noise = np.minimum(3.0 * np.abs(shift), _NOISE * spreads)
    return bool((misses <= np.maximum(_MET * spreads, noise)).all())


def solution(shots: Shots, point: tuple[float, ...]) -> Solution:
    """What stands at a root, with the numerical errors: the shift of the targets over their slopes."""
    result, errors, shift = shots.checked(point)
    moved = _moved(shots, point, shift) if np.isfinite(shift).all() else [None] * len(point)
    keys = [span.key for span in shots.spans]
    return Solution(dict(zip(keys, point, strict=True)), dict(zip(keys, moved, strict=True)), result, errors)


def _moved(shots: Shots, point: tuple[float, ...], shift: np.ndarray) -> list[float | None]:
    """By how much values must move to make up for a shift of the targets."""
    here = shots.numbers(point, "solve")
    slopes = np.empty((len(here), len(point)))
    bends = np.empty((len(here), len(point)))
    for column, span in enumerate(shots.spans):
        h = STEP * (span.high - span.low)
        before, after = (
            shots.numbers(tuple(value + sign * h * (place == column) for place, value in enumerate(point)), "solve")
            for sign in (-1.0, 1.0)
        )
        slopes[:, column] = (after - before) / (2.0 * h)
        bends[:, column] = (after - 2.0 * here + before) / (h * h)
    if len(point) == 1:
        needed = [abs(shift[0] / slopes[0, 0]) if slopes[0, 0] else inf]
        if bends[0, 0]:  # near a turning point the slope says nothing
            needed.append(sqrt(2.0 * abs(shift[0] / bends[0, 0])))
        least = min(needed)
        return [float(least) if isfinite(least) else None]
    try:
        inverse = np.linalg.inv(slopes)
    except np.linalg.LinAlgError:
        return [None] * len(point)
    moved = np.abs(inverse) @ np.abs(shift)
    return [float(value) if isfinite(value) else None for value in moved]
