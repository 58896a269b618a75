"""Targets that are true, false or a word, by one parameter: the intervals in which they are met."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import inf

import numpy as np

from sandbox.lab.aim.question import Interval, Solution
from sandbox.lab.aim.shots import Shots, dense_scan

#: Runs between the known points in the first refinement of an end, where there may be several, and in later ones.
FIRST, _LATER = 4, 3

#: The accuracy of ends, and the distance within which finer runs look for an end that they do not see within this
#: accuracy, both as fractions of the range.
_END, _NEAR = 2e-7, 1e-5

#: Two neighbouring values, and whether the target is met at the first, but not at the second, or vice versa.
_Change = tuple[float, float, bool]


def intervals(shots: Shots) -> list[Solution]:
    """The middles of all intervals in which the target is met, the widest first."""
    span, target = shots.spans[0], shots.targets[0]
    seen = [(place, result is not None and target.met(result.get(target.name))) for place, result in dense_scan(shots)]
    changes = [(low, high, met) for (low, met), (high, after) in pairwise(seen) if met != after]
    inner = _refined(shots, changes, finer=False)
    opens, stays_open = ([0.0] if met else [] for met in (seen[0][1], seen[-1][1]))  # errors of the range's own ends
    ends = [span.low] * len(opens) + inner + [span.high] * len(stays_open)
    middles = [0.5 * (low + high) for low, high in zip(ends[::2], ends[1::2], strict=True)]
    errors = [*opens, *_errors(shots, changes, inner), *stays_open]
    checked = shots.checked([(middle,) for middle in middles])
    found = []
    for place, (result, result_errors, _) in enumerate(checked):
        low, high = ends[2 * place : 2 * place + 2]
        low_error, high_error = errors[2 * place : 2 * place + 2]
        interval = Interval(low, high, low_error, high_error, low == span.low, high == span.high)
        error = None if low_error is None or high_error is None else 0.5 * (low_error + high_error)
        solution = Solution({span.key: middles[place]}, {span.key: error}, result, result_errors, interval)
        found.append((interval.width, solution))
    return [solution for _, solution in sorted(found, key=lambda each: -each[0])]


def _errors(shots: Shots, changes: Sequence[_Change], ends: Sequence[float]) -> list[float | None]:
    """By how much these ends differ from those that finer runs find; None if they find no such end, even between the
    points of the scan."""
    least, near = (share * (shots.spans[0].high - shots.spans[0].low) for share in (_END, _NEAR))
    found: list[float | None] = [None] * len(ends)
    for width in (least, near, inf):
        missing = [number for number, end in enumerate(found) if end is None]
        tight = [
            (max(low, ends[number] - width), min(high, ends[number] + width), met)
            for number, (low, high, met) in ((number, changes[number]) for number in missing)
        ]
        met = shots.meets([(place,) for low, high, _ in tight for place in (low, high)], "solve", finer=True)
        seen = [
            number
            for number, change in enumerate(tight)
            if met[2 * number : 2 * number + 2] == [change[2], not change[2]]
        ]
        for number, end in zip(seen, _refined(shots, [tight[number] for number in seen], finer=True), strict=True):
            found[missing[number]] = end
    return [None if other is None else max(abs(end - other), least) for end, other in zip(ends, found, strict=True)]


def _refined(shots: Shots, changes: Sequence[_Change], finer: bool) -> list[float]:
    """The position at which the target starts or stops being met, for each change."""
    accuracy = 2.1 * _END * (shots.spans[0].high - shots.spans[0].low)
    found = narrowed(shots, changes, lambda number, place: (place,), accuracy, finer)
    return [0.5 * (low + high) for low, high, _ in found]


def narrowed(
    shots: Shots,
    changes: Sequence[_Change],
    point: Callable[[int, float], tuple[float, ...]],
    widest: float,
    finer: bool = False,
) -> list[_Change]:
    """The same changes between nearer values, no more than ``widest`` apart, by runs at the ``point`` of a change's
    number and a value. Where there are several changes, the one next to where the target is met is kept."""
    found, between = list(changes), FIRST
    while wide := [number for number, (low, high, _) in enumerate(found) if high - low > widest]:
        places = [np.linspace(*found[number][:2], between + 2).tolist() for number in wide]
        points = [point(number, place) for number, each in zip(wide, places, strict=True) for place in each[1:-1]]
        met = np.array(shots.meets(points, "solve", finer)).reshape(-1, between)
        for number, each, inner in zip(wide, places, met.tolist(), strict=True):
            before = found[number][2]
            known = [before, *inner, not before]
            ends = [index for index in range(between + 1) if known[index] != known[index + 1]]
            end = ends[0] if before else ends[-1]
            found[number] = (each[end], each[end + 1], before)
        between = _LATER
    return found
