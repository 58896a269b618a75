"""Targets that are true, false or a word, by one parameter: the intervals in which they are met."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import inf

import numpy as np

from sandbox.lab.aim.question import Interval, Solution
from sandbox.lab.aim.shots import Shots, scan

#: Runs between the known points in the first refinement of an end, where there may be several, and in later ones.
_FIRST, _LATER = 5, 3

#: The accuracy of ends, and the distance within which finer runs look for an end that they do not see within this
#: accuracy, both as fractions of the range.
_END, _NEAR = 2e-7, 1e-5

#: Two neighbouring values, and whether the target is met at the first, but not at the second, or vice versa.
_Change = tuple[float, float, bool]


def intervals(shots: Shots) -> list[Solution]:
    """The middles of all intervals in which the target is met, the widest first."""
    span, target = shots.spans[0], shots.targets[0]
    seen = [(place, result is not None and target.met(result.get(target.name))) for place, result in scan(shots)]
    changes = [(low, high, met) for (low, met), (high, after) in pairwise(seen) if met != after]
    inner = _refined(shots, changes, finer=False)
    opens, stays_open = ([0.0] if met else [] for met in (seen[0][1], seen[-1][1]))  # errors of the range's own ends
    ends = [span.low] * len(opens) + inner + [span.high] * len(stays_open)
    middles = [0.5 * (low + high) for low, high in zip(ends[::2], ends[1::2], strict=True)]
    errors = [*opens, *_errors(shots, changes, inner, middles), *stays_open]
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


def _errors(
    shots: Shots, changes: Sequence[_Change], ends: Sequence[float], middles: Sequence[float]
) -> list[float | None]:
    """By how much these ends differ from those that finer runs find; None if they find no such end, even between the
    points of the scan. The ``middles``, which are needed next, are run together with the first of them."""
    least, near = (share * (shots.spans[0].high - shots.spans[0].low) for share in (_END, _NEAR))
    found: list[float | None] = [None] * len(ends)
    for width in (least, near, inf):
        missing = [number for number, end in enumerate(found) if end is None]
        tight = [
            (max(low, ends[number] - width), min(high, ends[number] + width), met)
            for number, (low, high, met) in ((number, changes[number]) for number in missing)
        ]
        points = [(place,) for low, high, _ in tight for place in (low, high)]
        shots.finer([*points, *((middle,) for middle in middles)])
        met = shots.meets(points, "solve", finer=True)
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
    brackets = list(changes)
    widest = 2.1 * _END * (shots.spans[0].high - shots.spans[0].low)
    between = _FIRST
    while wide := [number for number, (low, high, _) in enumerate(brackets) if high - low > widest]:
        inner = [np.linspace(*brackets[number][:2], between + 2).tolist()[1:-1] for number in wide]
        found = iter(shots.meets([(place,) for places in inner for place in places], "solve", finer))
        for number, places in zip(wide, inner, strict=True):
            low, high, before = brackets[number]
            known = [low, *places, high]
            met = [before, *(next(found) for _ in places), not before]
            ends_here = [index for index in range(len(places) + 1) if met[index] != met[index + 1]]
            # of several ends, the one next to the interval in which the target is met
            change = ends_here[0] if before else ends_here[-1]
            brackets[number] = (known[change], known[change + 1], before)
        between = _LATER
    return [0.5 * (low + high) for low, high, _ in brackets]
