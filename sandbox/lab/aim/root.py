"""Roots: how one is found, whether it is one, and its numerical error."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, isfinite, sqrt
from sys import float_info

import numpy as np

from sandbox.lab.aim.question import Solution
from sandbox.lab.aim.shots import Shots

#: Step for slopes, and distance below which two solutions are the same, as fractions of the range.
STEP, SAME = 1e-5, 1e-6

#: A target is met if the miss is below this fraction of the result's variation, or below its numerical error if that
#: is below the second fraction.
_MET, _NOISE = 1e-6, 1e-3


def bracketed(miss: Callable[[float], float], a: float, b: float, fine: float) -> float:
    """The place between a and b at which ``miss`` changes sign, within ``fine``.

    Inverse quadratic interpolation where that is safe, else bisection (Chandrupatla 1997). scipy's brentq would do as
    well, but takes longer to import than the whole search.
    """
    at_a, at_b = miss(a), miss(b)
    share = at_a / (at_a - at_b)
    while True:
        x = a + share * (b - a)
        at_x = miss(x)
        if (at_x > 0.0) == (at_a > 0.0):
            c, at_c = a, at_a
        else:
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = x, at_x
        least = (0.5 * fine + 2.0 * float_info.epsilon * abs(a)) / abs(b - c)
        if at_a == 0.0 or least > 0.5:
            return a if abs(at_a) < abs(at_b) else b
        xi, phi = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        share = 0.5
        if phi * phi < xi and (1.0 - phi) ** 2 < 1.0 - xi:
            share = at_a / (at_b - at_a) * at_c / (at_b - at_c)
            share += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        share = min(max(share, least), 1.0 - least)


def is_met(shots: Shots, point: tuple[float, ...]) -> bool:
    """True if all targets are met, within a millionth of the results' variation, or within their numerical error."""
    misses = np.abs(shots.numbers(point, "solve"))
    spreads = np.array([shots.spread(index) for index in range(len(shots.targets))])
    if (misses <= _MET * spreads).all():
        return True
    noise = np.minimum(3.0 * _error_beside(shots, point), _NOISE * spreads)
    return bool((misses <= np.maximum(_MET * spreads, noise)).all())


def _error_beside(shots: Shots, point: tuple[float, ...]) -> np.ndarray:
    """The numerical errors of the targets a step to either side of a point, whichever are smaller; NaN if both runs
    failed. At a jump itself a finer run differs by the jump, however small that is."""
    sides = [
        tuple(
            float(np.clip(x + way * STEP * (on.high - on.low), on.low, on.high))
            for x, on in zip(point, shots.spans, strict=True)
        )
        for way in (-1.0, 1.0)
    ]
    return np.fmin(*(np.abs(shift) for _, _, shift in shots.checked(sides)))


def solution(shots: Shots, point: tuple[float, ...]) -> Solution:
    """The solution at a root, with its numerical errors: the shift of the targets divided by their slopes."""
    result, errors, shift = shots.checked([point])[0]
    moved = _moved(shots, point, shift) if np.isfinite(shift).all() else [None] * len(point)
    keys = [span.key for span in shots.spans]
    return Solution(dict(zip(keys, point, strict=True)), dict(zip(keys, moved, strict=True)), result, errors)


def _moved(shots: Shots, point: tuple[float, ...], shift: np.ndarray) -> list[float | None]:
    """By how much the values must change to compensate a shift of the targets."""
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
        if bends[0, 0]:  # near a turning point the slope is meaningless
            needed.append(sqrt(2.0 * abs(shift[0] / bends[0, 0])))
        least = min(needed)
        return [float(least) if isfinite(least) else None]
    try:
        inverse = np.linalg.inv(slopes)
    except np.linalg.LinAlgError:
        return [None] * len(point)
    moved = np.abs(inverse) @ np.abs(shift)
    return [float(value) if isfinite(value) else None for value in moved]
