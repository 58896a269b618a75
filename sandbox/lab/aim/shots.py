"""Runs of a search, cached so that none is repeated, and the scan of the range."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np

from sandbox.errors import RequestError, RunError
from sandbox.lab.aim.question import Target, Trial
from sandbox.lab.axes import Span
from sandbox.lab.runs import Progress, columns_at, fly_together
from sandbox.scene import Scene, errors_of
from sandbox.text import no_such_result
from sandbox.tracebacks import one_line_error

#: Points of the scan of one parameter for a target that is a number.
SCAN = 129

#: Points of the scan for a target that is not a number, where runs are computed together, and where one by one. The
#: result may change between any two points without a sign of it, so their spacing is the width that is guaranteed.
_DENSE, DENSE_ALONE = 2049, 513

#: Refinements of an interval with a jump, the parts of each, and the most runs that these may add: for a number; and
#: for a target that is none, where runs are computed together and where one by one. Baskets off the rim alternate with
#: misses in bands down to a ten-thousandth of a degree: with ten halvings 0 of 55,616 random shots in intervals missed.
_REFINEMENTS, _PARTS, _MOST_RUNS = 3, 4, 2000
_HALVINGS, _MOST_TOGETHER, _MOST_ALONE = 9, 12000, 2000

#: A result is not smooth if it differs from the cubic through its four neighbours by more than this fraction of their
#: spread.
_BEND = 0.2


class Shots:
    """Runs the scene at given values, and caches the results."""

    def __init__(self, scene: Scene, spans: Sequence[Span], targets: Sequence[Target], progress: Progress) -> None:
        self.scene = scene
        self.spans = spans
        self.targets = targets
        self.tries: list[Trial] = []
        self.failures = 0
        self.resolution: dict[str, float] = {}
        self._names = [target.name for target in targets]
        for target in targets:
            if target.name not in scene.facts:
                why = no_such_result(target.name, tuple(scene.facts))
                raise RequestError(f"{_option(target)} {target.name}: {why}")
            names = scene.build().names if scene.facts[target.name].names else [target.value]
            if isinstance(target.value, str) and target.value not in names:
                raise RequestError(f"--target {target}: there is no such name; there are {', '.join(names)}")
        self._progress = progress
        self._first_error: Exception | None = None
        self._known: dict[tuple[float, ...], dict[str, Any] | None] = {}
        self._finer: dict[tuple[float, ...], dict[str, Any] | None] = {}

    def results(
        self, points: Sequence[tuple[float, ...]], phase: str = "scan", others: bool = False
    ) -> list[dict[str, Any] | None]:
        """The targeted results at some points, and ``others`` that become final with them; None if the run failed."""
        asked = _final_with(self.scene, self._names) if others else self._names
        new = [point for point in dict.fromkeys(points) if point not in self._known]
        tried = len(self.tries)
        computed = columns_at(
            self.scene, self._keys, new, asked=asked, progress=lambda done, _: self._show_progress(tried + done)
        )
        self.failures += len(computed.errors)
        self._first_error = self._first_error or next(iter(computed.errors.values()), None)
        for point, result in zip(new, computed.results(), strict=True):
            self._known[point] = result
            self._check_kinds(result)
            found = tuple(None if result is None else result.get(name) for name in self._names)
            self.tries.append(Trial(point, found, phase))
        self._show_progress(len(self.tries))
        return [self._known[point] for point in points]

    def tried(self, one: Trial) -> None:
        """Count a try that was computed elsewhere."""
        self.tries.append(one)
        self._show_progress(len(self.tries))

    def _show_progress(self, done: int) -> None:
        self._progress(done, max(self.planned, done))

    #: Expected number of runs, for the progress bar.
    planned = SCAN

    def resolved(self, share: float) -> None:
        """Keep the widths, as a share of each range, below which an interval or region, or a gap, may be missed."""
        self.resolution = {span.key: share * (span.high - span.low) for span in self.spans}

    def _finer_results(self, points: Sequence[tuple[float, ...]]) -> list[dict[str, Any] | None]:
        """The targeted results of finer runs at some points."""
        new = [point for point in dict.fromkeys(points) if point not in self._finer]
        found = columns_at(self.scene, self._keys, new, finer=True, asked=self._names)
        self._finer |= zip(new, found.results(), strict=True)
        return [self._finer[point] for point in points]

    def numbers(self, point: tuple[float, ...], phase: str) -> np.ndarray:
        """The miss of each target at one point; NaN if there is no such result."""
        return self.missed(self.results([point], phase)[0])

    def meets(self, points: Sequence[tuple[float, ...]], phase: str, finer: bool = False) -> list[bool]:
        """True if the target, which is not a number, is met at each of these points."""
        target = self.targets[0]
        found = self._finer_results(points) if finer else self.results(points, phase)
        return [result is not None and target.met(result.get(target.name)) for result in found]

    def missed(self, result: Mapping[str, Any] | None) -> np.ndarray:
        values = [None if result is None else result.get(target.name) for target in self.targets]
        return np.array(
            [
                np.nan if value is None else value - target.value
                for target, value in zip(self.targets, values, strict=True)
            ]
        )

    def checked(self, points: Sequence[tuple[float, ...]]) -> list[tuple[dict[str, Any], dict[str, float], np.ndarray]]:
        """The whole result at each of some points, its estimated errors, and the shift of the aimed-at results in a
        finer run."""
        coarser, finer = (
            columns_at(self.scene, self._keys, points, how, self.scene.facts_except_ended).results()
            for how in (False, True)
        )
        return [self._compared(*each) for each in zip(points, coarser, finer, strict=True)]

    def _compared(
        self, point: tuple[float, ...], result: dict[str, Any] | None, finer: dict[str, Any] | None
    ) -> tuple[dict[str, Any], dict[str, float], np.ndarray]:
        if result is None or finer is None:
            return dict(self._known.get(point) or {}), {}, np.full(len(self.targets), np.nan)
        numbers = all(target.is_number for target in self.targets)
        shift = self.missed(finer) - self.missed(result) if numbers else np.zeros(0)
        return result, errors_of(result, finer)[0], shift

    def nearest(self) -> Trial | None:
        """The try with the smallest miss. Raises RunError if none was completed."""
        if self._first_error is not None and self.failures == len(self.tries):
            first = one_line_error(self._first_error)
            raise RunError(f"no run in the range could be completed; the first error: {first}")
        if not all(target.is_ordered for target in self.targets):
            return None
        complete = [each for each in self.tries if all(value is not None for value in each.found)]
        scales = [self.spread(index) for index in range(len(self.targets))]

        def miss(each: Trial) -> float:
            offs = zip(each.found, self.targets, scales, strict=True)
            return hypot(*((value - target.value) / scale for value, target, scale in offs))

        return min(complete, key=miss, default=None)

    def spread(self, index: int) -> float:
        """Size of a result's changes over the range."""
        values = [each.found[index] for each in self.tries if each.found[index] is not None]
        return float(np.ptp(values)) or 1.0 if values else 1.0

    @property
    def _keys(self) -> list[str]:
        return [span.key for span in self.spans]

    def _check_kinds(self, result: Mapping[str, Any] | None) -> None:
        """Raise RequestError for a target that is of another kind than the result."""
        if result is None:
            return
        for target in self.targets:
            option, wanted = _option(target), 0.0 if target.is_maximum else target.value
            value = result[target.name]
            held = isinstance(value, list | dict) and isinstance(wanted, str)  # a word that a list may hold
            if value is not None and _kind(value) != _kind(wanted) and not held:
                hint = f", such as {_example(target, value)}" if option == "--target" else ""
                raise RequestError(f"{option} {target.name}: is {_kind(value)}{hint}, not {_kind(wanted)}")


def _example(target: Target, value: Any) -> str:
    """A target for a result like this value: a word that may look like a number is in quotes, also for the shell."""
    if isinstance(value, list | dict):
        value = next(iter(value), "1")
    text = f"{value:.4g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)
    return f"{target.name}={text}" if not isinstance(value, str) or text.isalpha() else f"""'{target.name}="{text}"'"""


def _kind(value: Any) -> str:
    """The kind of a result, in words."""
    if isinstance(value, bool | np.bool_):
        return "true or false"
    return (
        "a number" if isinstance(value, int | float | np.number) else "a word" if isinstance(value, str) else "a list"
    )


def _option(target: Target) -> str:
    return "--maximize" if target.is_maximum else "--target"


def _final_with(scene: Scene, names: Sequence[str]) -> list[str]:
    """These facts, and those that become final with them, since a target may jump where these change. An empty list
    means all facts, if a target may change until the end."""
    if scene.final_when(names) is None:
        return []
    by = [scene.facts[name].final_when for name in names]
    return [key for key, fact in scene.facts.items() if fact.final_when in by]


def _signature(result: Mapping[str, Any] | None) -> Any:
    """The values of a result that are not numbers: they change where the result jumps."""
    if result is None:
        return None
    return [
        (name, "number" if isinstance(value, int | float) and not isinstance(value, bool) else repr(value))
        for name, value in result.items()
        if not isinstance(value, dict)
    ]


def scan(shots: Shots, points: int) -> list[tuple[float, dict[str, Any] | None]]:
    """Results, of a number, at this many points of the range, with more points where something changes abruptly."""
    span = shots.spans[0]
    shots.planned = points
    places = np.linspace(span.low, span.high, points).tolist()
    for _ in range(_REFINEMENTS + 1):
        results = shots.results([(place,) for place in places], others=True)
        seen = list(zip(places, results, strict=True))
        rough = {index for index, (one, other) in enumerate(pairwise(results)) if _signature(one) != _signature(other)}
        rough |= _bends(np.array(places), np.array([shots.missed(result)[0] for result in results]))
        if not rough or len(places) + (_PARTS - 1) * len(rough) > points + _MOST_RUNS:
            break
        finer: list[float] = []
        for index, (low, high) in enumerate(pairwise(places)):
            finer += np.linspace(low, high, _PARTS + 1).tolist()[:-1] if index in rough else [low]
        places = [*finer, places[-1]]
    return seen


def dense_scan(shots: Shots) -> list[tuple[float, dict[str, Any] | None]]:
    """Results at evenly spaced points, which miss nothing wider than their spacing, and at many more where anything in
    the result changes: gaps between neighbours with different results are halved again and again, and those next to
    them are at most twice as wide."""
    span = shots.spans[0]
    middle = 0.5 * (span.low + span.high)
    together = fly_together(shots.scene, [span.key], [middle])
    points, most = (_DENSE, _MOST_TOGETHER) if together else (DENSE_ALONE, _MOST_ALONE)
    shots.planned = points
    shots.resolved(1.0 / (points - 1))
    places = np.linspace(span.low, span.high, points).tolist()
    spacing = (span.high - span.low) / (points - 1)
    kinds: dict[str, int] = {}
    kind_at: dict[float, int] = {}  # of the result at each place
    for halvings in range(_HALVINGS + 1):
        results = shots.results([(place,) for place in places], others=True)
        for place, result in zip(places, results, strict=True):
            if place not in kind_at:
                kind_at[place] = kinds.setdefault(str(_signature(result)), len(kinds))
        differ, widths = np.diff([kind_at[place] for place in places]) != 0, np.diff(places)
        narrow = np.where(differ, widths, np.inf)
        beside = np.minimum(np.append(narrow[1:], np.inf), np.append(np.inf, narrow[:-1]))
        split = (differ & (widths > 0.75 * spacing / 2**halvings)) | (widths > 2.5 * beside)
        if halvings == _HALVINGS or not split.any() or len(places) + split.sum() > points + most:
            break
        halves = [0.5 * (places[index] + places[index + 1]) for index in np.flatnonzero(split)]
        places = sorted([*places, *halves])
    return list(zip(places, results, strict=True))


def _bends(x: np.ndarray, y: np.ndarray) -> set[int]:
    """Intervals next to a value that is not smooth among its neighbours, or has none on one side."""
    here = np.arange(len(x))
    window = np.clip(here - 2, 0, len(x) - 5)[:, None] + np.arange(5)
    others = window[window != here[:, None]].reshape(-1, 4)
    u, v = x[others] - x[:, None], y[others]
    apart = u[:, None, :] - u[:, :, None]
    weights = np.where(apart == 0.0, 1.0, u[:, None, :] / np.where(apart == 0.0, 1.0, apart)).prod(axis=2)  # Lagrange's
    known = np.isfinite(y)
    rounding = 1e-9 * np.ptp(y[known]) if known.any() else 0.0
    smooth = np.abs((weights * v).sum(axis=1) - y) <= _BEND * np.ptp(v, axis=1) + rounding
    rough = np.flatnonzero(known & ~smooth)
    return {*rough.tolist(), *(rough - 1).tolist()} & set(range(len(x) - 1))
