"""The inverse problem: which launch, or any other number of a scene, gives the result that is wanted.

The range is scanned finely enough to see every branch, more finely where results jump; then scipy's solvers take
over: ``brentq`` in each bracket for one number, ``root`` (Powell's hybrid method) from several starts for two. What
only holds or does not (``made = true``) has intervals, whose ends are closed in on. How far the finite accuracy of the
runs moves a solution is told by finer runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from math import hypot, inf, isfinite, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from sandbox import parameters as declared
from sandbox import units
from sandbox.errors import RequestError, RunError
from sandbox.lab.axes import Span, as_axis
from sandbox.lab.runs import runs
from sandbox.scene import Scene, as_scene, compare

#: Points of the first look at a range, at one number, and along each of two.
_LOOK, _LOOK_EACH = 129, 21

#: Times that a stretch with a jump in it is looked at more closely, into how many parts, and the most runs for it all.
_CLOSER, _PARTS, _MOST_RUNS = 3, 4, 2000

#: A run whose result is off the line between its neighbours by more than this share of their spread: not smooth.
_BEND = 0.25

#: Roots are found to this share of the range; a result jumps if it is then still off by this share of its own range.
_FINE, _JUMP = 1e-12, 1e-6

#: Step for slopes, and distance below which two solutions are one, as shares of the range.
_STEP, _SAME = 1e-5, 1e-6

#: Ends of intervals are closed in on in rounds, in each by so many runs between what is known. The finer runs look
#: for the same end only so near to it, as a share of the range, if they can; ends are found to the last of these.
_BETWEEN, _ROUNDS, _NEAR, _END = 9, 6, 1e-5, 1e-8

#: Starts for two numbers, and the most iterations of each.
_STARTS, _ITERATIONS = 12, 60

Progress = Callable[[int, int], None]


def _silent(done: int, total: int) -> None:
    pass


# ---------------------------------------------------------------------------------------------------------------------
# What is asked, and what comes out
# ---------------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Target:
    """A result and the value that it shall have: a number in the result's own unit, or true, false or a word."""

    name: str
    value: Any

    @property
    def is_number(self) -> bool:
        return isinstance(self.value, float)

    def met(self, value: Any) -> bool:
        """Whether a run's value is the one that is wanted; for what is no number."""
        return bool(value == self.value and isinstance(value, bool) == isinstance(self.value, bool))


@dataclass(frozen=True)
class Try:
    """One run on the way: where, and the results that were aimed at; None where there was none."""

    values: tuple[float, ...]
    found: tuple[Any, ...]
    phase: str  # "scan", or "solve" with the number of the start or bracket


@dataclass(frozen=True)
class Interval:
    """Where the target is met, all the way between two ends; at an end of the range it may go on beyond."""

    low: float
    high: float
    low_error: float | None  # None where the finer runs see no such end, or the interval ends with the range
    high_error: float | None
    open_low: bool  # cut off by the range
    open_high: bool

    @property
    def width(self) -> float:
        return self.high - self.low


@dataclass(frozen=True)
class Solution:
    """Values that meet the targets, their numerical errors (None: unknown), and the run's result with its own."""

    values: dict[str, float]
    errors: dict[str, float | None]
    result: dict[str, Any]
    result_errors: dict[str, float]
    interval: Interval | None = None  # for a target that is no number; the value is its middle


@dataclass(frozen=True)
class Aim:
    """What a search came to. ``solutions`` come in order of the value, or the widest interval first."""

    scene: Scene
    spans: tuple[Span, ...]
    targets: tuple[Target, ...]
    solutions: list[Solution]
    nearest: Try | None  # the best of all tries, where there is no solution
    jumps: list[tuple[Try, Try]]  # where the result leaps over the target between two all but equal values
    tries: list[Try] = field(repr=False)
    failures: int = 0  # tries that could not be run

    def __repr__(self) -> str:
        wanted = ", ".join(f"{target.name} = {target.value}" for target in self.targets)
        found = "; ".join(", ".join(f"{k} = {v:.6g}" for k, v in one.values.items()) for one in self.solutions)
        return f"<Aim of {self.scene.title} at {wanted}: {found or 'no solution'}>"

    @property
    def misses(self) -> dict[str, float]:
        """By how much the nearest try misses each target; empty where there is a solution, or no nearest."""
        if self.nearest is None:
            return {}
        return {
            target.name: value - target.value
            for target, value in zip(self.targets, self.nearest.found, strict=True)
            if target.is_number and value is not None
        }


def parse_target(text: str, scene: Scene | None = None) -> Target:
    """``carry=200``, ``carry="219 yd"``, ``made=true`` or ``verdict=swish``. Raises RequestError."""
    name, equals, value = (part.strip() for part in text.partition("="))
    if not name or not equals or not value:
        raise RequestError(f"--target {text}: write it as NAME=VALUE, for example --target carry=200")
    return as_target(name, value, "--target", scene)


def as_target(name: str, value: Any, option: str = "target", scene: Scene | None = None) -> Target:
    """A target from Python. A number may have a unit: that of the scene's result, or of its kind; where the scene does
    not say, results are in SI, but angles in deg and spins in rpm."""
    if isinstance(value, bool | np.bool_):
        return Target(name, bool(value))
    if isinstance(value, int | float | np.number):
        if not isfinite(value):
            raise RequestError(f"{option} {name}: {value} cannot be aimed at")
        return Target(name, float(value))
    if not isinstance(value, str):
        raise RequestError(f"{option} {name}: {value!r} is not a number, true, false or a word")
    text = value.strip().strip("\"'")
    if text in ("true", "false"):
        return Target(name, text == "true")
    try:
        return as_target(name, float(text), option)
    except ValueError:
        pass
    declared = "" if scene is None else scene.units.get(name, "")
    for unit in _RESULT_UNITS:
        try:
            number = units.parse(text, unit)
        except ValueError:
            continue
        if declared in units.KIND_OF and declared:
            try:
                number = units.parse(text, declared)
            except ValueError as error:
                raise RequestError(f"{option} {name}={text}: {error}") from None
        return as_target(name, number, option)
    return Target(name, text)


#: Units of results: SI, but angles in deg and spins in rpm.
_RESULT_UNITS = [
    {"rad": "deg", "rad/s": "rpm"}.get(unit, unit) for unit in (next(iter(kind)) for kind in units.KINDS.values())
]


def aim(
    scene: Scene | str | Path,
    vary: Mapping[str, tuple[Any, Any]],
    target: Mapping[str, Any],
    *,
    progress: Progress = _silent,
) -> Aim:
    """All values within a range that meet a target: ``aim("golf", {"launch.angle": (5, 75)}, {"carry": 200.0})``.

    Two parameters with two targets likewise. A target that is true, false or a word gives the intervals in which it is
    met, the widest first, each with its middle, which forgives most. Raises RequestError for a request that makes no
    sense, and RunError where not one run in the range came to its end.
    """
    chosen = as_scene(scene)
    spans = []
    for key, given in vary.items():
        axis = as_axis(chosen, key, tuple(given) if isinstance(given, list) else given, "vary")
        if not isinstance(axis, Span):
            raise RequestError(f"vary {key}: only numbers have a range, (low, high), and this is {given!r}")
        spans.append(axis)
    return search(chosen, spans, [as_target(name, value, scene=chosen) for name, value in target.items()], progress)


def search(scene: Scene, spans: Sequence[Span], targets: Sequence[Target], progress: Progress = _silent) -> Aim:
    """As aim, for what was read already."""
    try:
        import scipy  # noqa: F401
    except ImportError:
        raise RequestError("sandbox aim needs scipy, which is not installed: pip install scipy") from None
    for option, names in (("--vary", [span.key for span in spans]), ("--target", [each.name for each in targets])):
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise RequestError(f"{option} {twice}: is named twice")
    numbers = [target.is_number for target in targets]
    if not (len(spans) == len(targets) == 1 or (len(spans) == len(targets) == 2 and all(numbers))):
        raise RequestError(
            f"{_count(spans, 'parameter')} and {_count(targets, 'target')}: one goes with one, or two with two "
            "that are numbers; sandbox sweep shows what others do"
        )
    shots = _Shots(scene, spans, targets, progress)
    jumps: list[tuple[Try, Try]] = []
    if len(spans) == 2:
        solutions = _two(shots)
    elif numbers[0]:
        solutions, jumps = _one(shots)
    else:
        solutions = _intervals(shots)
    nearest = None if solutions else shots.nearest()
    tries = shots.tries
    return Aim(scene, tuple(spans), tuple(targets), solutions, nearest, jumps, tries, shots.failures)


def _count(things: Sequence[Any], name: str) -> str:
    return f"{len(things)} {name}" + ("" if len(things) == 1 else "s")


# ---------------------------------------------------------------------------------------------------------------------
# Runs
# ---------------------------------------------------------------------------------------------------------------------


class _Shots:
    """Runs the scene at given values, and keeps what came out."""

    def __init__(self, scene: Scene, spans: Sequence[Span], targets: Sequence[Target], progress: Progress) -> None:
        self.scene = scene
        self.spans = spans
        self.targets = targets
        self.tries: list[Try] = []
        self.failures = 0
        self._progress = progress
        self._first_error: Exception | None = None
        self._known: dict[tuple[float, ...], dict[str, Any] | None] = {}

    def results(
        self, points: Sequence[tuple[float, ...]], phase: str = "scan", finer: bool = False
    ) -> list[dict[str, Any] | None]:
        """The results at some points; None where the run failed."""
        if finer:
            return [self._result(run) for run in runs(self.scene, self._keys, points, finer=True)]
        new = [point for point in dict.fromkeys(points) if point not in self._known]
        for point, run in zip(new, runs(self.scene, self._keys, new), strict=True):
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


def _signature(result: Mapping[str, Any] | None) -> Any:
    """What of a result is no number: it changes where the result jumps."""
    if result is None:
        return None
    return [
        (name, "number" if isinstance(value, int | float) and not isinstance(value, bool) else repr(value))
        for name, value in result.items()
        if not isinstance(value, dict)
    ]


def _scan(shots: _Shots) -> list[tuple[float, dict[str, Any] | None]]:
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


# ---------------------------------------------------------------------------------------------------------------------
# One number
# ---------------------------------------------------------------------------------------------------------------------


class _Gap(Exception):
    """A result that is not there, inside a bracket."""


def _one(shots: _Shots) -> tuple[list[Solution], list[tuple[Try, Try]]]:
    """Every value in the range at which a number meets its target, and where it jumps over it."""
    seen = [(place, float(shots.missed(result)[0])) for place, result in _scan(shots)]
    span = shots.spans[0]
    roots = [place for place, miss in seen if miss == 0.0]
    jumps: list[float] = []
    brackets = [*_brackets(seen), *_hidden(shots, seen)]
    for number, (low, high) in enumerate(brackets):
        for root in _roots(shots, low, high, f"solve {number + 1}", depth=0):
            (roots if _is_met(shots, (root,)) else jumps).append(root)
    if not roots:
        _come_nearer(shots, seen)
    solutions: list[Solution] = []
    for root in sorted(roots):
        if not solutions or root - solutions[-1].values[span.key] > _SAME * (span.high - span.low):
            solutions.append(_solution(shots, (root,)))
    return solutions, [_sides(shots, jump) for jump in jumps]


def _brackets(seen: Iterable[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    for (low, below), (high, above) in pairwise(seen):
        if below * above < 0.0:
            yield low, high


def _hidden(shots: _Shots, seen: Sequence[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    """Brackets of pairs of roots with no point of the scan between them: a result that only just gets to the target."""
    for left, here, right in zip(seen, seen[1:], seen[2:], strict=False):
        misses = left[1], here[1], right[1]
        if not all(map(isfinite, misses)) or min(misses) <= 0.0 <= max(misses) or not _is_lowest(*misses):
            continue
        turn = _turning_point(shots, left[0], right[0], here[1])
        if turn[1] * here[1] <= 0.0:
            yield left[0], turn[0]
            yield turn[0], right[0]


def _is_lowest(left: float, here: float, right: float) -> bool:
    """Whether the middle one is nearest to zero, and a parabola through all three comes near to zero or beyond."""
    if abs(here) > min(abs(left), abs(right)):
        return False
    bend, lean = left - 2.0 * here + right, 0.5 * (right - left)
    lowest = here - 0.5 * lean * lean / bend if bend != 0.0 else here
    return abs(lowest) < 0.5 * abs(here) or lowest * here <= 0.0


def _turning_point(shots: _Shots, low: float, high: float, sign: float) -> tuple[float, float]:
    """Where the result comes nearest to the target, or goes furthest beyond it, and by how much it misses it there."""
    from scipy.optimize import minimize_scalar

    def height(place: float) -> float:
        miss = float(shots.numbers((float(place),), "solve")[0])
        return miss if sign > 0.0 else -miss if isfinite(miss) else inf

    found = minimize_scalar(height, bounds=(low, high), method="bounded", options={"xatol": _SAME * (high - low)})
    return float(found.x), float(found.fun) if sign > 0.0 else -float(found.fun)


def _come_nearer(shots: _Shots, seen: Sequence[tuple[float, float]]) -> None:
    """Try what lies around the best of the scan."""
    finite = [index for index, (_, miss) in enumerate(seen) if isfinite(miss)]
    if finite:
        best = min(finite, key=lambda index: abs(seen[index][1]))
        low, high = seen[max(best - 1, 0)][0], seen[min(best + 1, len(seen) - 1)][0]
        _turning_point(shots, low, high, seen[best][1])


def _roots(shots: _Shots, low: float, high: float, phase: str, depth: int) -> Iterator[float]:
    """The root in a bracket; where there are stretches without a result, those in the brackets between them."""
    from scipy.optimize import brentq

    def missed(place: float) -> float:
        miss = float(shots.numbers((float(place),), phase)[0])
        if not isfinite(miss):
            raise _Gap
        return miss

    span = shots.spans[0]
    try:
        yield float(brentq(missed, low, high, xtol=_FINE * (span.high - span.low), rtol=4 * np.finfo(float).eps))
    except _Gap:
        if depth < _CLOSER:
            places = np.linspace(low, high, _BETWEEN).tolist()
            results = shots.results([(place,) for place in places], phase)
            misses = [float(shots.missed(result)[0]) for result in results]
            for inner in _brackets(zip(places, misses, strict=True)):
                yield from _roots(shots, *inner, phase, depth + 1)


def _is_met(shots: _Shots, point: tuple[float, ...]) -> bool:
    """Whether all targets are met, within a millionth of what the results vary by, or within their numerical error."""
    misses = np.abs(shots.numbers(point, "solve"))
    allowed = np.array([_JUMP * shots.spread(index) for index in range(len(shots.targets))])
    if (misses <= allowed).all():
        return True
    _, _, shift = shots.checked(point)
    return bool((misses <= np.maximum(allowed, 3.0 * np.abs(shift))).all())


def _sides(shots: _Shots, place: float) -> tuple[Try, Try]:
    """The tries on either side of a jump."""
    ordered = sorted((each for each in shots.tries if each.found[0] is not None), key=lambda each: each.values)
    wanted = shots.targets[0].value
    across = (
        (one, other) for one, other in pairwise(ordered) if (one.found[0] - wanted) * (other.found[0] - wanted) <= 0.0
    )
    return min(across, key=lambda pair: abs(pair[0].values[0] - place))


def _solution(shots: _Shots, point: tuple[float, ...]) -> Solution:
    """What stands at a root, with the numerical errors: the shift of the targets over their slopes."""
    result, errors, shift = shots.checked(point)
    moved = _moved(shots, point, shift) if np.isfinite(shift).all() else [None] * len(point)
    keys = [span.key for span in shots.spans]
    return Solution(dict(zip(keys, point, strict=True)), dict(zip(keys, moved, strict=True)), result, errors)


def _moved(shots: _Shots, point: tuple[float, ...], shift: np.ndarray) -> list[float | None]:
    """By how much values must move to make up for a shift of the targets."""
    here = shots.numbers(point, "solve")
    slopes = np.empty((len(here), len(point)))
    bends = np.empty((len(here), len(point)))
    for column, span in enumerate(shots.spans):
        h = _STEP * (span.high - span.low)
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


# ---------------------------------------------------------------------------------------------------------------------
# Two numbers
# ---------------------------------------------------------------------------------------------------------------------


def _two(shots: _Shots) -> list[Solution]:
    """Every pair of values, as far as several starts find them, at which two numbers meet their targets."""
    from scipy.optimize import minimize, root

    first, second = shots.spans
    shots.planned = _LOOK_EACH**2
    places = [np.linspace(span.low, span.high, _LOOK_EACH).tolist() for span in shots.spans]
    results = shots.results([(x, y) for x in places[0] for y in places[1]])
    misses = np.array([shots.missed(result) for result in results]).reshape(_LOOK_EACH, _LOOK_EACH, 2)
    scales = np.array([shots.spread(index) for index in range(2)])

    def placed(u: np.ndarray) -> tuple[float, float]:
        x, y = np.clip(u, 0.0, 1.0).tolist()
        return first.low + x * (first.high - first.low), second.low + y * (second.high - second.low)

    def missed(u: np.ndarray, phase: str) -> np.ndarray:
        beyond = u - np.clip(u, 0.0, 1.0)
        off = shots.numbers(placed(u), phase) / scales
        return np.where(np.isfinite(off), off, 10.0) + 10.0 * beyond

    solutions: list[Solution] = []
    starts = _starts(misses / scales)
    for number, start in enumerate(starts):
        work = partial(missed, phase=f"solve {number + 1}")
        options = {"xtol": 1e-11, "eps": _STEP**2, "maxfev": _ITERATIONS}
        found = np.clip(root(work, start, method="hybr", options=options).x, 0.0, 1.0)
        point = placed(found)
        known = any(_distance(solution, point, shots.spans) < 1e3 * _SAME for solution in solutions)
        if not known and np.isfinite(shots.numbers(point, "solve")).all() and _is_met(shots, point):
            solutions.append(_solution(shots, point))
    if not solutions and starts:
        limits = [(0.0, 1.0)] * 2
        options = {"maxfev": 4 * _ITERATIONS, "xatol": _SAME, "fatol": _SAME}
        minimize(lambda u: hypot(*missed(u, "solve")), starts[0], method="Nelder-Mead", bounds=limits, options=options)
    return sorted(solutions, key=lambda solution: tuple(solution.values.values()))


def _starts(off: np.ndarray) -> list[np.ndarray]:
    """Where to begin: cells in which both targets are passed, then the places that miss least around them."""
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


def _distance(solution: Solution, point: tuple[float, ...], spans: Sequence[Span]) -> float:
    """Distance of two places in shares of the ranges."""
    shares = [
        (solution.values[span.key] - value) / (span.high - span.low) for span, value in zip(spans, point, strict=True)
    ]
    return hypot(*shares)


# ---------------------------------------------------------------------------------------------------------------------
# True, false, or a word
# ---------------------------------------------------------------------------------------------------------------------


#: Two neighbouring values, and whether the target is met at the first, but not at the second, or the other way round.
_Change = tuple[float, float, bool]


def _intervals(shots: _Shots) -> list[Solution]:
    """The middles of all stretches in which the target is met, the widest first."""
    span, target = shots.spans[0], shots.targets[0]
    seen = [(place, _meets(result, target)) for place, result in _scan(shots)]
    changes = [(low, high, met) for (low, met), (high, after) in pairwise(seen) if met != after]
    ends = _closed_in(shots, changes, finer=False)
    finer = _seen_finer(shots, changes, ends)
    borders: list[tuple[float, float | None, bool]] = [
        (end, None if other is None else abs(end - other), False) for end, other in zip(ends, finer, strict=True)
    ]
    if seen[0][1]:
        borders.insert(0, (span.low, 0.0, True))
    if seen[-1][1]:
        borders.append((span.high, 0.0, True))
    found = [
        Interval(low, high, low_error, high_error, open_low, open_high)
        for (low, low_error, open_low), (high, high_error, open_high) in zip(borders[::2], borders[1::2], strict=True)
    ]
    return [_middle(shots, interval) for interval in sorted(found, key=lambda interval: -interval.width)]


def _meets(result: Mapping[str, Any] | None, target: Target) -> bool:
    return result is not None and target.met(result.get(target.name))


def _seen_finer(shots: _Shots, changes: Sequence[_Change], ends: Sequence[float]) -> list[float | None]:
    """The same ends by finer runs; None for one that they do not see, not even between the points of the scan."""
    near = _NEAR * (shots.spans[0].high - shots.spans[0].low)
    found: list[float | None] = [None] * len(ends)
    for width in (near, inf):
        missing = [number for number, end in enumerate(found) if end is None]
        tight = [
            (max(low, ends[number] - width), min(high, ends[number] + width), met)
            for number, (low, high, met) in ((number, changes[number]) for number in missing)
        ]
        results = shots.results([(place,) for low, high, _ in tight for place in (low, high)], "solve", finer=True)
        met = [_meets(result, shots.targets[0]) for result in results]
        seen = [
            number
            for number, change in enumerate(tight)
            if met[2 * number : 2 * number + 2] == [change[2], not change[2]]
        ]
        for number, end in zip(seen, _closed_in(shots, [tight[number] for number in seen], finer=True), strict=True):
            found[missing[number]] = end
    return found


def _closed_in(shots: _Shots, changes: Sequence[_Change], finer: bool) -> list[float]:
    """Where the target begins or ceases to be met, for each change."""
    brackets = list(changes)
    least = _END * (shots.spans[0].high - shots.spans[0].low)
    for _ in range(_ROUNDS):
        if all(high - low <= least for low, high, _ in brackets):
            break
        inner = [np.linspace(low, high, _BETWEEN + 2).tolist()[1:-1] for low, high, _ in brackets]
        results = iter(shots.results([(place,) for places in inner for place in places], "solve", finer))
        for number, ((low, high, before), places) in enumerate(zip(brackets, inner, strict=True)):
            known = [low, *places, high]
            met = [before, *(_meets(next(results), shots.targets[0]) for _ in places), not before]
            ends_here = [index for index in range(len(places) + 1) if met[index] != met[index + 1]]
            # of several ends the one beside the stretch in which the target is met
            change = ends_here[0] if before else ends_here[-1]
            brackets[number] = (known[change], known[change + 1], before)
    return [0.5 * (low + high) for low, high, _ in brackets]


def _middle(shots: _Shots, interval: Interval) -> Solution:
    key, middle = shots.spans[0].key, 0.5 * (interval.low + interval.high)
    result, errors, _ = shots.checked((middle,))
    ends = interval.low_error, interval.high_error
    error = None if None in ends else 0.5 * sum(end for end in ends if end is not None)
    return Solution({key: middle}, {key: error}, result, errors, interval)
