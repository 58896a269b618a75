"""A fit: the best values, how well they are known, and what is odd about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from math import ceil, inf
from typing import Any, ClassVar

import numpy as np

from sandbox import display
from sandbox.errors import RequestError, RunError
from sandbox.lab.fit.descent import Place, descend
from sandbox.lab.fit.intervals import HARDLY, Errors, clustered, errors_of, group_sds, pooled
from sandbox.lab.fit.loss import HUBERS, OUTLIER, SQUARES, TUKEYS, Loss
from sandbox.lab.fit.measured import Measured
from sandbox.lab.fit.problem import Problem
from sandbox.lab.fit.rivals import Weighted, rivals
from sandbox.lab.fit.search import ALIKE, ENOUGH, neumann, robust_sds, search
from sandbox.lab.runs import runs
from sandbox.scene import Scene
from sandbox.text import with_noun

#: Rounds in which values and standard deviations of the groups are found one from the other; and in which a minimum is
#: looked for whose chi^2 is at least so much less.
ROUNDS, _ROUNDS_OF_RIVALS, BETTER = 3, 6, 0.2

#: Steps for the last slopes, in standard errors of the values as they seem before: the first, which at most may be this
#: share of a range; and how often they are made smaller.
FIRST_STEP, _WIDEST_STEP, _SHRINKING = 300.0, 0.02, 6

#: A standard deviation that is smaller than this, in its unit, is rounding; and so are residuals that are a smaller
#: share than this of what the ranges change.
ROUNDING, _ROUNDING_SHARE = 1e-12, 1e-8

#: A share of its range within which a value is at its end.
_AT_END = 1e-6

#: A block of neighbours is so many times as long as their errors are alike, and there are at least so many: assumed.
_BLOCK, _FEWEST_BLOCKS = 3.0, 6

#: A fit whose residuals have a pattern, and on average this share of the extent of the data, explains nothing.
NOTHING = 0.15


class FarOff(RequestError):
    """No run comes near the data."""


@dataclass(frozen=True)
class Value:
    """A fitted value with its 95 % interval, in its unit. One that stopped at an end of its range is no result, and has
    no interval; nor has one that can hardly be told apart from another."""

    value: float
    low: float | None
    high: float | None
    unit: str
    at_bound: bool = False  # the fit stopped at an end of the range
    unknown: bool = False  # the data do not say: the interval is the whole range
    interval_kind: str | None = None  # "normal"; "robust", where errors are alike in groups; None without an interval

    @property
    def half(self) -> float | None:
        """Half of the interval; None without one."""
        return None if self.low is None or self.high is None else 0.5 * (self.high - self.low)

    def holds(self, value: float) -> bool:
        """True for a value in the interval, or for the same where there is none."""
        return value == self.value if self.low is None or self.high is None else self.low <= value <= self.high


@dataclass(frozen=True)
class Other:
    """Other values that explain the data nearly as well."""

    values: dict[str, float]  # by key, in its unit
    more: float  # of chi^2, compared with the best


@dataclass(frozen=True)
class Model:
    """One of several models that were compared: how far it is behind the best, and its fit, or why there is none."""

    behind: float  # difference of AICc to the best; inf for a model that could not be fitted
    fit: Fit | None
    failure: str = ""


@dataclass(frozen=True, repr=False)
class Fit(display.Reported):
    """The result of a fit: ``values`` with 95 % intervals, ``correlations``, ``residuals``, ``outliers``.

    >>> import sandbox
    >>> track = {"t": [0.0, 0.2, 0.4], "x": [0.0, 1.0, 2.0], "y": [2.1, 2.9, 3.3]}
    >>> isinstance(sandbox.fit("basketball", track, {"launch.speed": (6, 9)}), sandbox.Fit)
    True
    """

    REPORTED_BY: ClassVar = "sandbox.lab.fit.report"

    scene: Scene  # with the fitted values
    measured: Measured
    values: dict[str, Value]
    correlations: dict[tuple[str, str], float]  # of the errors of two values, -1 to 1
    residuals: np.ndarray  # measured minus computed, shape (residuals,); units as in ``measured``
    residual_sd: dict[str, float]  # of the errors of each group, such as x and y, in its unit
    pooled: bool  # whether groups in one unit were weighted alike
    loss: str  # "least squares", "Tukey's biweight"
    outliers: tuple[int, ...]  # rows of the data, the first is 1
    pattern: float  # how much larger residuals are than the differences of neighbours say; 0.0 if they are as large
    remarks: tuple[str, ...]
    slopes: np.ndarray  # of the computed by the values in their units, (residuals, values)
    half_widths: dict[str, float]  # of the interval of each value, if it has one or not
    normal_half_widths: dict[str, float]  # the same, if all errors were independent
    robust_by: tuple[str, ...] = ()  # the groups whose errors are alike, from which intervals are robust
    late: int = 0  # points after the end of the scene's own run
    end: float = inf  # s, that end
    others: tuple[Other, ...] = ()  # values of other minima, the best first
    models: Mapping[str, Model] = field(default_factory=dict)  # that were compared, by name
    models_of: str = ""  # the parameter that chooses the model

    @property
    def free(self) -> list[float]:
        """The values of what belongs to the measurement itself."""
        return [self.values[one.key].value for one in self.measured.free]

    def __repr__(self) -> str:
        values = ", ".join(f"{key} = {one.value:.6g} {one.unit}".rstrip() for key, one in self.values.items())
        return f"<Fit of {self.scene.title}: {values}>"

    @property
    def aicc(self) -> float:
        """Akaike's information criterion, corrected for few residuals (Hurvich & Tsai 1989): the lower, the better.
        Each group has its own standard deviation."""
        groups, count = self.measured.groups, len(self.residuals)
        likelihood, free = 0.0, len(self.values)
        for group in np.unique(groups).tolist():
            own = self.residuals[groups == group]
            squares = own**2
            if self.loss != SQUARES.name:  # Ronchetti (1985): what outliers cost is bounded
                sd = self.residual_sd[self.measured.names[group]]
                squares = 2.0 * sd**2 * TUKEYS.cost(own / sd)
            likelihood += len(own) * float(np.log(max(float(squares.mean()), 1e-300)))
            free += 1
        return likelihood + 2.0 * free * count / max(count - free - 1, 1)


def solve(problem: Problem, near: bool = True) -> Fit:
    """The best fit. Raises RequestError for too few rows; FarOff, if it must be ``near``, for data that no run comes
    near; RunError if no run could be completed."""
    scene, measured = problem.scene, problem.measured
    measured.check(scene)
    if measured.count <= len(problem):
        rows, values = with_noun(measured.count, measured.what), with_noun(len(problem), "parameter")
        raise RequestError(f"{rows} for {values}: a fit needs more {measured.what}s than parameters")
    ended = search(problem)
    if not ended:
        raise RunError(f"no run of {scene.title} in these ranges could be completed")
    place, known = ended[0], ended[1:]
    for left in reversed(range(_ROUNDS_OF_RIVALS)):
        place, sds, loss = _refined(problem, place)
        place = Place(place.share, place.residuals, _slopes(problem, place, sds), place.cost)
        if near:
            check_near(scene, measured, place.residuals, problem.robust)
        errors = errors_of(place.residuals, place.slopes, sds, measured.groups, loss)
        found = rivals(Weighted(problem, sds, loss), place, errors, known)
        if not left or not found or found[0][0] > -BETTER:
            break
        place, known = found[0][1], []
    return _finished(problem, place, sds, loss, errors, found)


def _slopes(problem: Problem, place: Place, sds: np.ndarray) -> np.ndarray:
    """Slopes by differences that change the residuals as much as errors do: within these a path may bend, as where it
    grazes the rim, and a slope at one place says too little. From larger ones down to those that are as large."""
    effect = np.sqrt(((place.slopes / sds[:, None]) ** 2).sum(axis=0))
    steps = np.clip(FIRST_STEP / np.maximum(effect, 1e-300), 1e-8, _WIDEST_STEP)
    for _ in range(_SHRINKING):
        slopes = problem.slopes(place.share, steps, 1.0 / sds)
        wanted = 1.0 / np.maximum(np.sqrt(((slopes / sds[:, None]) ** 2).sum(axis=0)), 1e-300)
        if (steps <= 3.0 * wanted).all():
            break
        steps = np.clip(np.minimum(steps, np.maximum(wanted, 0.1 * steps)), 1e-8, _WIDEST_STEP)
    return slopes


def _refined(problem: Problem, place: Place) -> tuple[Place, np.ndarray, Loss]:
    """The place with each group weighted by its own scatter, the scale of each residual, and the loss."""
    groups = problem.measured.groups
    counts, units, used = np.bincount(groups), problem.measured.units, np.ones(len(groups))
    first = np.unique(groups, return_index=True)[1]
    if problem.robust:
        sds = robust_sds(place.residuals, groups)
        for loss in (HUBERS, HUBERS, TUKEYS, TUKEYS):
            place = descend(problem, place.share, 1.0 / sds, loss)
            sds = pooled(robust_sds(place.residuals, groups)[first], counts, units)[groups]
        return place, sds, TUKEYS
    for _ in range(ROUNDS):
        by_group = pooled(group_sds(place.residuals, place.slopes, used, groups), counts, units)
        by_group = np.maximum(by_group, max(1e-9 * float(by_group.max()), ROUNDING))
        sds = by_group[groups]
        if np.ptp(sds / used) <= 0.02 * float((sds / used).min()):
            break
        used = sds
        place = descend(problem, place.share, 1.0 / used, SQUARES)
    return place, sds, SQUARES


def _finished(
    problem: Problem,
    place: Place,
    sds: np.ndarray,
    loss: Loss,
    errors: Errors,
    others: Sequence[tuple[float, Place]],
) -> Fit:
    """The fit with intervals and warnings."""
    measured, count = problem.measured, len(problem)
    scatter = group_sds(place.residuals, place.slopes, sds, measured.groups)
    if loss is not SQUARES:
        scatter = np.array([sds[measured.groups == group][0] for group in range(len(measured.names))])
    kept = np.abs(place.residuals) <= OUTLIER * np.maximum(robust_sds(place.residuals, measured.groups), 1e-12)
    keys, values = problem.keys, problem.values(place.share).tolist()
    pattern = _pattern(problem, np.where(kept, place.residuals, 0.0), place.slopes)
    half, robust_by = _half_widths(measured, place, sds, loss, errors, pattern)
    best = problem.scene.changed(dict(zip(problem.scene_keys, values, strict=False)))
    correlated = errors.covariance / np.maximum(np.outer(errors.sds, errors.sds), 1e-300)
    return Fit(
        best,
        measured,
        _values(problem, place.share, half, correlated, [bool(some) for some in robust_by]),
        {(keys[i], keys[j]): float(correlated[i, j]) for i, j in combinations(range(count), 2)},
        place.residuals,
        dict(zip(measured.names, scatter.tolist(), strict=True)),
        bool(np.ptp(sds) == 0.0),
        loss.name,
        tuple(np.unique(measured.rows[~kept]).tolist()),
        pattern,
        measured.remarks(best, values[len(problem.scene_keys) :]),
        -place.slopes / problem.width,
        dict(zip(keys, (half * problem.width).tolist(), strict=True)),
        dict(zip(keys, (errors.half_widths * problem.width).tolist(), strict=True)),
        tuple(dict.fromkeys(name for some in robust_by for name in some)),
        *_late(problem, best, values[len(problem.scene_keys) :]),
        tuple(
            Other(dict(zip(keys, problem.values(other.share).tolist(), strict=True)), more) for more, other in others
        ),
    )


def _pattern(problem: Problem, residuals: np.ndarray, slopes: np.ndarray) -> float:
    """The factor by which residuals are larger than those of neighbours differ; 0.0 if they are not, are too few, or
    are rounding."""
    if np.sqrt((residuals**2).mean()) < _ROUNDING_SHARE * np.abs(slopes).max():
        return 0.0
    ratio = neumann(problem.measured.groups, residuals)
    return 0.0 if ratio == 0.0 or ratio >= ALIKE else float(np.sqrt(2.0 / ratio))


def _late(problem: Problem, best: Scene, free: Sequence[float]) -> tuple[int, float]:
    """The points after the end of the scene's own run, where balls still move; and that end in s, for places without
    times too."""
    points = problem.measured.points(best, free)
    if points is None:
        return 0, inf
    run = next(runs(best, (), [()], asked=()))
    if isinstance(run, Exception) or (run.ended == "rest" and not np.isnan(points.t).all()):
        return 0, inf
    return int((points.t > run.duration * (1.0 + 1e-9)).sum()), run.duration


def _half_widths(
    measured: Measured, place: Place, sds: np.ndarray, loss: Loss, errors: Errors, pattern: float
) -> tuple[np.ndarray, list[list[str]]]:
    """Half of the interval of each share: the widest of that of independent errors and those of groups that differ by
    more than chance; and the names of these groups for each share. Where residuals have a pattern, blocks of neighbours
    are groups, too."""
    alike = dict(measured.alike)
    if pattern:
        rows = np.unique(measured.rows)
        length = max(2, min(ceil(_BLOCK * pattern**2), len(rows) // _FEWEST_BLOCKS))
        alike[f"blocks of {length} {measured.what}s"] = np.searchsorted(rows, measured.rows) // length
    half, names = errors.half_widths, [list[str]() for _ in errors.sds]
    for name, labels in alike.items():
        found, apart = clustered(place.residuals, place.slopes, sds, labels, loss)
        for place_of in np.flatnonzero(apart & (found.half_widths > errors.half_widths)):
            names[place_of].append(name)
            half = np.where(np.arange(len(half)) == place_of, np.maximum(half, found.half_widths), half)
    return half, names


def _values(
    problem: Problem, share: np.ndarray, halves: np.ndarray, correlated: np.ndarray, robust: Sequence[bool]
) -> dict[str, Value]:
    found: dict[str, Value] = {}
    hardly = (np.abs(np.triu(correlated, 1) + np.tril(correlated, -1)) > HARDLY).any(axis=0)
    columns: Any = zip(
        problem.keys, problem.units, share, halves, problem.low, problem.width, hardly, robust, strict=True
    )
    for key, unit, at, half, low, width, is_hardly, is_robust in columns:
        value, error, unknown = float(low + at * width), float(half * width), bool(half >= 1.0)
        at_bound = not _AT_END < at < 1.0 - _AT_END
        if at_bound or (is_hardly and not unknown):
            found[key] = Value(value, None, None, unit, at_bound, unknown)
        else:
            ends = max(float(low), value - error), min(float(low + width), value + error)
            found[key] = Value(value, *ends, unit, False, unknown, "robust" if is_robust else "normal")
    return found


def check_near(scene: Scene, measured: Measured, residuals: np.ndarray, robust: bool = False) -> None:
    """Raise FarOff if no run comes near the data; with ``robust``, near most of them."""
    points = measured.points(scene, [one.start for one in measured.free])
    if points is None or len(points.positions) < ENOUGH:
        return
    off = float(robust_sds(residuals, 0 * measured.groups)[0] if robust else np.sqrt((residuals**2).mean()))
    extent = float(np.sqrt(((points.positions - points.positions.mean(axis=0)) ** 2).mean()))
    if off > NOTHING * extent and neumann(measured.groups, residuals) < ALIKE:
        best = f"comes near this track, the best is off by {off:.3g} m on average"
        raise FarOff(f"no run of {scene.title} in these ranges {best}")
