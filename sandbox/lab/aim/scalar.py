"""A number target, by one parameter: every root in the range, and every jump over the target."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from math import copysign, inf, isfinite

import numpy as np

from sandbox.lab.aim.maximize import peak
from sandbox.lab.aim.question import Solution, Trial
from sandbox.lab.aim.root import SAME, bracketed, is_met, solution
from sandbox.lab.aim.shots import SCAN, Shots, scan

#: Roots are found to this fraction of the range.
_FINE = 1e-12

#: A bracket with gaps in the result is divided into this many parts, up to this many times.
_PARTS, _DEEPEST = 8, 3


#: Runs that a root takes, and a place where a result may barely reach the target, about: for the progress bar.
_RUNS_OF_A_ROOT, _RUNS_OF_A_TURN = 25, 150


class _Gap(Exception):
    """A missing result inside a bracket."""


def roots_of(shots: Shots) -> tuple[list[Solution], list[tuple[Trial, Trial]]]:
    """Every value in the range at which a number meets its target, and the jumps over it."""
    seen = [(place, float(shots.missed(result)[0])) for place, result in scan(shots, SCAN)]
    span = shots.spans[0]
    found = [place for place, miss in seen if miss == 0.0]
    jumps: list[float] = []
    crossed, turns = list(_brackets(seen)), list(_turns(seen))
    shots.planned = len(shots.tries) + _RUNS_OF_A_ROOT * len(crossed) + _RUNS_OF_A_TURN * len(turns)
    brackets = [*crossed, *_hidden(shots, seen, turns)]
    for number, (low, high) in enumerate(brackets):
        for root in _roots(shots, low, high, f"solve {number + 1}", depth=0):
            (found if is_met(shots, (root,)) else jumps).append(root)
    if not found:
        best = min(range(len(seen)), key=lambda index: abs(seen[index][1]) if isfinite(seen[index][1]) else inf)
        around = ([seen[max(best - 1, 0)][0]], [seen[min(best + 1, len(seen) - 1)][0]])
        peak(shots, *around, lambda result: -abs(float(shots.missed(result)[0])))
    solutions: list[Solution] = []
    for root in sorted(found):
        if not solutions or root - solutions[-1].values[span.key] > SAME * (span.high - span.low):
            solutions.append(solution(shots, (root,)))
    return solutions, [_sides(shots, jump) for jump in jumps]


def _brackets(seen: Iterable[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    for (low, below), (high, above) in pairwise(seen):
        if below * above < 0.0:
            yield low, high


def _turns(seen: Sequence[tuple[float, float]]) -> Iterator[int]:
    """The points of the scan around which a result may barely reach the target."""
    for place in range(1, len(seen) - 1):
        misses = seen[place - 1][1], seen[place][1], seen[place + 1][1]
        if all(map(isfinite, misses)) and not min(misses) <= 0.0 <= max(misses) and _is_lowest(*misses):
            yield place


def _hidden(shots: Shots, seen: Sequence[tuple[float, float]], turns: Sequence[int]) -> Iterator[tuple[float, float]]:
    """Brackets of pairs of roots with no point of the scan between them, around some of its points."""
    for place in turns:
        left, here, right = seen[place - 1 : place + 2]
        turn = _turning_point(shots, left[0], right[0], copysign(1.0, here[1]))
        if turn[1] * here[1] <= 0.0:
            yield left[0], turn[0]
            yield turn[0], right[0]


def _is_lowest(left: float, here: float, right: float) -> bool:
    """True if the middle value is closest to zero, and a parabola through all three reaches or nearly reaches zero."""
    if abs(here) > min(abs(left), abs(right)):
        return False
    bend, lean = left - 2.0 * here + right, 0.5 * (right - left)
    lowest = here - 0.5 * lean * lean / bend if bend != 0.0 else here
    return abs(lowest) < 0.5 * abs(here) or lowest * here <= 0.0


def _turning_point(shots: Shots, low: float, high: float, sign: float) -> tuple[float, float]:
    """The place where the result comes closest to the target, or exceeds it most, and its miss there."""
    (place,), height = peak(shots, [low], [high], lambda result: -sign * float(shots.missed(result)[0]))
    return place, -sign * height


def _roots(shots: Shots, low: float, high: float, phase: str, depth: int) -> Iterator[float]:
    """The root in a bracket; with gaps in the result, the roots in the brackets between them."""

    def missed(place: float) -> float:
        miss = float(shots.numbers((float(place),), phase)[0])
        if not isfinite(miss):
            raise _Gap
        return miss

    span = shots.spans[0]
    try:
        yield bracketed(missed, low, high, _FINE * (span.high - span.low))
    except _Gap:
        if depth < _DEEPEST:
            places = np.linspace(low, high, _PARTS + 1).tolist()
            results = shots.results([(place,) for place in places], phase)
            misses = [float(shots.missed(result)[0]) for result in results]
            for inner in _brackets(zip(places, misses, strict=True)):
                yield from _roots(shots, *inner, phase, depth + 1)


def _sides(shots: Shots, place: float) -> tuple[Trial, Trial]:
    """The tries on either side of a jump."""
    ordered = sorted((each for each in shots.tries if each.found[0] is not None), key=lambda each: each.values)
    wanted = shots.targets[0].value
    across = (
        (one, other) for one, other in pairwise(ordered) if (one.found[0] - wanted) * (other.found[0] - wanted) <= 0.0
    )
    return min(across, key=lambda pair: abs(pair[0].values[0] - place))
