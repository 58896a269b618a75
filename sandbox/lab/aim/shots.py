"""Runs of a search, kept so that none is done twice, and a first look over the range."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np

from sandbox import parameters as declared
from sandbox.errors import RequestError, RunError
from sandbox.lab.aim.question import Target, Try
from sandbox.lab.axes import Span
from sandbox.lab.runs import runs
from sandbox.scene import Scene, compare

#: Points of the first look at the range of one number.
_LOOK = 129

#: Times that a stretch with a jump in it is looked at more closely, into how many parts, and the most runs for it all.
_CLOSER, _PARTS, _MOST_RUNS = 3, 4, 2000

#: A run whose result is off the line between its neighbours by more than this share of their spread: not smooth.
_BEND = 0.25

Progress = Callable[[int, int], None]


def silent(done: int, total: int) -> None:
    pass


class Shots:
    """Runs the scene at given values, and keeps what came out."""

    def __init__(self, scene: Scene, spans: Sequence[Span], targets: Sequence[Target], progress: Progress) -> None:
        self.scene = scene
        self.spans = spans
        self.targets = targets
        self.tries: list[Try] = []
        self.failures = 0
        self._asked = _asked(scene, [target.name for target in targets])
        self._progress = progress
        self._first_error: Exception | None = None
        self._known: dict[tuple[float, ...], dict[str, Any] | None] = {}

    def results(
        self, points: Sequence[tuple[float, ...]], phase: str = "scan", finer: bool = False
    ) -> list[dict[str, Any] | None]:
        """The results at some points; None where the run failed."""
        if finer:
            return [self._result(run) for run in runs(self.scene, self._keys, points, True, self._asked)]
        new = [point for point in dict.fromkeys(points) if point not in self._known]
        for point, run in zip(new, runs(self.scene, self._keys, new, False, self._asked), strict=True):
            result = self._known[point] = self._result(run)
            self._check_names(result)
            found = tuple(None if result is None else result.get(target.name) for target in self.targets)
            self.tries.append(Try(point, found, phase))
            self._progress(len(self.tries), max(self.planned, len(self.tries)))
        return [self._known[point] for point in points]

    #: Runs that are foreseen, for the progress bar.
    planned = _LOOK

    def numbers(self, point: tuple[float, ...], phase: str, finer: bool = False) -> np.ndarray:
        """How far the targets are missed at one point; NaN where there is no such result."""
        return self.missed(self.results([point], phase, finer)[0])

    def missed(self, result: Mapping[str, Any] | None) -> np.ndarray:
        values = [None if result is None else result.get(target.name) for target in self.targets]
        return np.array(
            [
                np.nan if value is None else value - target.value
                for target, value in zip(self.targets, values, strict=True)
            ]
        )

    def checked(self, point: tuple[float, ...]) -> tuple[dict[str, Any], dict[str, float], np.ndarray]:
        """Result at a point, its estimated errors, and the shift of the aimed-at results in a finer run."""
        run = next(runs(self.scene, self._keys, [point]))
        finer = next(runs(self.scene, self._keys, [point], finer=True))
        if isinstance(run, Exception) or isinstance(finer, Exception):
            return dict(self._known.get(point) or {}), {}, np.full(len(self.targets), np.nan)
        shift = self.missed(finer.result) - self.missed(run.result) if all(t.is_number for t in self.targets) else None
        return run.result, compare(run, finer).errors, np.zeros(0) if shift is None else shift

    def nearest(self) -> Try | None:
        """The try that misses least. Raises RunError where none came to its end."""
        if self._first_error is not None and self.failures == len(self.tries):
            raise RunError(f"not one run in the range came to its end, first: {self._first_error}")
        if not all(target.is_number for target in self.targets):
            return None
        complete = [each for each in self.tries if all(value is not None for value in each.found)]
        scales = [self.spread(index) for index in range(len(self.targets))]

        def miss(each: Try) -> float:
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

    def _result(self, run: Any) -> dict[str, Any] | None:
        if isinstance(run, Exception):
            self.failures += 1
            self._first_error = self._first_error or run
            return None
        return dict(run.result)

    def _check_names(self, result: Mapping[str, Any] | None) -> None:
        """Raise RequestError for a target that the scene does not have, or that is of another kind."""
        if result is None:
            return
        for target in self.targets:
            if target.name not in result:
                raise RequestError(f"--target {target.name}: {declared.no_such_result(target.name, tuple(result))}")
            value = result[target.name]
            if isinstance(value, bool) and not isinstance(target.value, bool):
                raise RequestError(f"--target {target.name}: is true or false; write {target.name}=true")
            if isinstance(value, str) and not isinstance(target.value, str):
                raise RequestError(f"--target {target.name}: is a word, such as {target.name}={value}")
            if isinstance(value, int | float) and not isinstance(value, bool) and not target.is_number:
                raise RequestError(f"--target {target.name}: is a number, such as {target.name}={value:.4g}")
            if isinstance(value, list | tuple | dict):
                raise RequestError(f"--target {target.name}: is a list and cannot be aimed at")


def _asked(scene: Scene, names: Sequence[str]) -> list[str]:
    """What runs are asked for, which end as soon as it is settled: the targets, and what is settled with them, as where
    that changes a target may jump. All, by an empty list, where a target may change until the end."""
    if scene.settles(names) is None:
        return []
    by = [scene.facts[name].settled for name in names]
    return [key for key, fact in scene.facts.items() if fact.settled in by]


def _signature(result: Mapping[str, Any] | None) -> Any:
    """What of a result is no number: it changes where the result jumps."""
    if result is None:
        return None
    return [
        (name, "number" if isinstance(value, int | float) and not isinstance(value, bool) else repr(value))
        for name, value in result.items()
        if not isinstance(value, dict)
    ]


def scan(shots: Shots) -> list[tuple[float, dict[str, Any] | None]]:
    """Results over the range, at points that lie closer where something changes abruptly."""
    span, target = shots.spans[0], shots.targets[0]
    places = np.linspace(span.low, span.high, _LOOK).tolist()
    for _ in range(_CLOSER + 1):
        results = shots.results([(place,) for place in places])
        seen = list(zip(places, results, strict=True))
        rough = {index for index, (one, other) in enumerate(pairwise(results)) if _signature(one) != _signature(other)}
        if target.is_number:
            rough |= _bends([shots.missed(result)[0] for result in results])
        if not rough or len(shots.tries) + (_PARTS - 1) * len(rough) > _MOST_RUNS:
            break
        finer: list[float] = []
        for index, (low, high) in enumerate(pairwise(places)):
            finer += np.linspace(low, high, _PARTS + 1).tolist()[:-1] if index in rough else [low]
        places = [*finer, places[-1]]
    return seen


def _bends(values: Sequence[float]) -> set[int]:
    """Stretches beside a value that does not lie between its neighbours smoothly."""
    found: set[int] = set()
    y = np.array(values)
    middle = 0.5 * (y[:-2] + y[2:])
    spread = np.abs(y[2:] - y[:-2]) + 1e-9 * (np.nanmax(np.abs(y)) if np.isfinite(y).any() else 1.0)
    with np.errstate(invalid="ignore"):
        for index in np.flatnonzero(np.abs(y[1:-1] - middle) > _BEND * spread):
            found |= {int(index), int(index) + 1}
    return found
