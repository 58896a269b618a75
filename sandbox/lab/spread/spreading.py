"""Scatter in the parameters and what becomes of it in the results: the same shot many times, as a player would hit it.

Each cause, a parameter with its standard deviation, is drawn independently of the others, at points of Sobol's
sequence, which cover the distribution evenly. Sobol's indices (2001, Math. Comput. Simul. 55:271) say how much of
the variance each cause accounts for: the first-order index is its share alone, the total one includes what it does
together with others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from sandbox import display
from sandbox.errors import RequestError, RunError
from sandbox.lab.many import Runs, simulate_many
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.spread.causes import SAMPLINGS, Cause, Points, cause, causes_of, points_of
from sandbox.lab.spread.needs import Need, width_of
from sandbox.lab.statistics import (
    Ellipse,
    Numbers,
    Share,
    round_number,
    shots_for_mean,
    shots_for_share,
)
from sandbox.scene import Scene, as_scene
from sandbox.text import check_mapping, one_line

#: Shots, unless others are asked for, and the fewest and most.
SAMPLES, FEWEST, MOST = 1024, 16, 1_000_000

#: The certainties that are asked for unless others are: of shares, and of means in standard deviations.
_OF_SHARES, _OF_MEANS = (0.05, 0.01), 0.1

#: Directions, or coordinates of a place.
_TWO = 2


@dataclass(frozen=True)
class Indices:
    """Sobol's indices of one cause: the share of the variance that it makes alone (first order), and with all that it
    does together with others (total); and the standard errors of both estimates, by bootstrap."""

    first: float
    total: float
    first_error: float = 0.0
    total_error: float = 0.0


@dataclass(frozen=True)
class Spread(display.Reported):
    """The outcome of ``spread``.

    ``numbers`` has the distribution of each number, ``shares`` those of what is true or false, ``words`` those of each
    word, ``ellipses`` where balls come to lie; ``causes`` says which cause makes which share of a variance.

    >>> import sandbox
    >>> found = sandbox.spread("golf", {"launch.speed": "1%", "launch.angle": "1 deg"}, facts=("carry",), samples=64)
    >>> found.numbers["carry"].sd > 1.0, sorted(found.causes["carry"])
    (True, ['launch.angle', 'launch.speed'])
    """

    REPORTED_BY: ClassVar = "sandbox.lab.spread.report"

    scene: Scene
    by: tuple[Cause, ...]
    points: Points
    runs: Runs
    seed: int
    sampling: str
    within: Mapping[str, float]
    only: bool = False  # whether some facts were asked for, not all

    def __repr__(self) -> str:
        return f"<Spread of {self.scene.title}: {self.samples:,} shots by {', '.join(each.key for each in self.by)}>"

    @property
    def samples(self) -> int:
        """The shots that scatter; more are computed to tell causes apart."""
        return self.points.samples

    @property
    def failures(self) -> int:
        """The number of them that could not be computed."""
        return sum(place < self.samples for place in self.runs.errors)

    def values(self, fact: str) -> np.ndarray:
        """The values of a fact in all shots that scatter, shape (samples,)."""
        return self.runs[fact][: self.samples]

    @cached_property
    def numbers(self) -> dict[str, Numbers]:
        """The distribution of each fact that is a number."""
        columns = {name: self.values(name) for name in self.runs.facts}
        known = {name: values[np.isfinite(values)] for name, values in columns.items() if values.dtype == float}
        return {name: Numbers(values) for name, values in known.items() if len(values)}

    @cached_property
    def shares(self) -> dict[str, Share]:
        """The share of shots for which each fact that is true or false is true; and of those that score."""
        found = {}
        for name in self.runs.facts:
            hits = self.hits(name)
            if hits is not None:
                known = hits[: self.samples][~np.isnan(hits[: self.samples])]
                if len(known):
                    found[name] = Share(int(known.sum()), len(known))
        return found

    @cached_property
    def words(self) -> dict[str, dict[str, Share]]:
        """The share of shots with each word, the most common first."""
        found = {}
        for name in self.runs.facts:
            said = [value for value in self.values(name).tolist() if isinstance(value, str)]
            if said and name not in self.shares:
                counts = sorted({word: said.count(word) for word in set(said)}.items(), key=lambda it: (-it[1], it[0]))
                found[name] = {word: Share(count, len(said)) for word, count in counts}
        return found

    @cached_property
    def ellipses(self) -> dict[str, Ellipse]:
        """The ellipse in which each ball comes to lie, by name, of those that move in two directions."""
        found = {}
        for name, values in self.runs.facts.items():
            if self.scene.units[name] != "m":  # a velocity is no place
                continue
            rows = [row for row in values[: self.samples].tolist() if isinstance(row, Mapping)]
            for ball in dict.fromkeys(ball for row in rows for ball in row):
                places = [row[ball] for row in rows if _is_place(row.get(ball))]
                if len(places) > _TWO:
                    ellipse = Ellipse(np.array(places, float))
                    if ellipse.axes[1] > 1e-6:
                        found[ball if name == "positions" else f"{name} {ball}"] = ellipse
        landing = self.scene.controls.landing
        if landing and all(name in self.numbers for name in landing):
            both = np.column_stack([self.values(name) for name in landing])
            both = both[np.isfinite(both).all(axis=1)]
            if len(both) > _TWO and Ellipse(both).axes[1] > 1e-6:
                found["landing"] = Ellipse(both)
        return found

    @cached_property
    def causes(self) -> dict[str, dict[str, Indices]]:
        """The indices of each cause, by fact: of numbers, and of what is true or false, as 1 and 0. A fact that some
        shots lack has none, and one that does not vary."""
        found = {}
        for name in (*self.numbers, *self.shares):
            whole = self.hits(name) if name in self.shares else self.runs[name]
            if whole is None or not np.isfinite(whole).all() or np.ptp(whole[: self.samples]) == 0.0:
                continue
            if name in self.numbers and not self.numbers[name].varies:
                continue
            if len(self.by) == 1:
                found[name] = {self.by[0].key: Indices(1.0, 1.0)}
            elif self.points.pairs:
                found[name] = self._indices(whole)
        return found

    def _indices(self, values: np.ndarray) -> dict[str, Indices]:
        """Sobol's indices of one fact, by the estimators of Saltelli (2010)."""
        from scipy.stats import sobol_indices

        points, keys = self.points, [each.key for each in self.by]
        a, b = values[: points.pairs], values[points.rows(0)]
        mixed = np.array([values[points.rows(1 + place)] for place in range(len(keys))])
        known = sobol_indices(func={"f_A": a[None], "f_B": b[None], "f_AB": mixed[:, None]}, n=points.pairs)
        first_errors, total_errors = _bootstrap(a, b, mixed)
        rows = zip(known.first_order.tolist(), known.total_order.tolist(), first_errors, total_errors, strict=True)
        return {key: Indices(*row) for key, row in zip(keys, rows, strict=True)}

    @cached_property
    def needs(self) -> list[Need]:
        """The random shots that each certainty needs: what was asked for, or 5 % and 1 % of the share that scores, and
        a tenth of the standard deviation of the most important number."""
        asked = [*self.within.items()]
        if not asked:
            scores = self.scene.controls.scores
            asked += [(name, within) for name in self.shares if name == scores for within in _OF_SHARES]
            main = next((name for name in self.displayed if name in self.numbers), None)
            if main is not None:
                asked.append((main, round_number(_OF_MEANS * self.numbers[main].sd)))
        found = []
        for name, within in asked:
            if name in self.shares:
                found.append(Need(name, within, shots_for_share(self.shares[name].value, within)))
            elif name in self.numbers:
                found.append(Need(name, within, shots_for_mean(self.numbers[name].sd, within)))
        return found

    @cached_property
    def displayed(self) -> list[str]:
        """The facts that people are shown: those that vary, but not what a shot starts with."""
        facts = self.scene.facts
        numbers = [name for name, found in self.numbers.items() if found.varies and facts[name].final_when != "start"]
        return [name for name in self.runs.facts if name in numbers or name in self.shares or name in self.words]

    def hits(self, name: str) -> np.ndarray | None:
        """1.0 and 0.0 for what is true or false in all shots, NaN for those that failed; None for other facts."""
        values = self.runs[name]
        scores = name == self.scene.controls.scores
        if values.dtype == bool:
            return values.astype(float)
        if values.dtype == float and not scores:
            return None
        listed = values.tolist()
        if not scores and any(not isinstance(value, bool) and value is not None for value in listed):
            return None
        if not scores and all(value is None for value in listed):
            return None
        failed = np.isin(np.arange(len(listed)), list(self.runs.errors))
        return np.where(failed, np.nan, [float(bool(value) and value == value) for value in listed])


def _is_place(value: Any) -> bool:
    return isinstance(value, Sequence) and len(value) == _TWO and all(isinstance(number, float) for number in value)


def _bootstrap(a: np.ndarray, b: np.ndarray, mixed: np.ndarray, times: int = 100) -> tuple[list[float], list[float]]:
    """Standard errors of both indices of each cause, by drawing the shots again, the same for the same shots."""
    middle = 0.5 * (a.mean() + b.mean())
    a, b, mixed = a - middle, b - middle, mixed - middle
    together, alone = b * (mixed - a), 0.5 * (a - mixed) ** 2  # shape (causes, shots)
    weights = np.random.default_rng(0).multinomial(len(a), np.full(len(a), 1.0 / len(a)), times) / len(a)
    means = weights @ a, weights @ b
    variance = 0.5 * (weights @ (a * a) + weights @ (b * b)) - (0.5 * (means[0] + means[1])) ** 2
    variance = np.where(variance > 0.0, variance, np.inf)
    errors = ((weights @ each.T / variance[:, None]).std(axis=0, ddof=1).tolist() for each in (together, alone))
    first, total = errors
    return first, total


def spread(
    scene: Scene | str | Path,
    by: Mapping[str, Any] | None = None,
    *,
    facts: Sequence[str] = (),
    samples: int = SAMPLES,
    seed: int = 0,
    sampling: str = "sobol",
    causes: bool = True,
    within: Mapping[str, Any] | None = None,
    progress: Progress = no_progress,
) -> Spread:
    """Compute how scatter in the parameters becomes scatter in the results.

    ``spread("golf", {"launch.speed": "1%", "launch.angle": 1.0})``.

    ``by`` gives the standard deviation of each parameter, in its declared unit, with a unit (``"0.5 mph"``), or as a
    share of its value (``"1%"``); the values are normally distributed around the scene's own, within their bounds.
    ``"-3:3"`` is an even distribution. By default the scene's own scatter of a practised player is used.

    Of ``samples`` shots come mean, standard deviation, quantiles and shares, in ``numbers``, ``shares`` and ``words``.
    With ``causes`` as many again, and as many for each parameter, say how much of the variance each accounts for.
    ``facts`` names those to read, by default all. ``within={"carry": 1.0}`` asks how many random shots tell the mean of
    carry to within 1 m in 95 of 100 cases; of a share it is a number below 1. ``sampling`` is ``"sobol"`` or
    ``"random"``. The same ``seed`` gives the same shots. Needs scipy.

    Raises RequestError for an invalid request, and RunError if no shot could be computed.

    >>> import sandbox
    >>> found = sandbox.spread("basketball", samples=64, causes=False)
    >>> 0.0 < found.shares["made"].value < 1.0
    True
    """
    chosen = as_scene(scene)
    check_mapping("by", by or {}, '{"launch.speed": "1%"}')
    given = [cause(chosen, "by", key, sd) for key, sd in (by or {}).items()]
    return spread_of(chosen, causes_of(chosen, given, "by"), facts, samples, seed, sampling, causes, within, progress)


def check_scipy() -> None:
    """Import what points and indices are made by, which takes a while. Raises RequestError where it is missing."""
    try:
        import scipy.stats  # noqa: F401
    except ImportError:
        raise RequestError("sandbox spread needs scipy, which is not installed: pip install scipy") from None


def spread_of(
    scene: Scene,
    by: Sequence[Cause],
    facts: Sequence[str] = (),
    samples: int = SAMPLES,
    seed: int = 0,
    sampling: str = "sobol",
    causes: bool = True,
    within: Mapping[str, Any] | None = None,
    progress: Progress = no_progress,
) -> Spread:
    """Like ``spread``, for causes already parsed."""
    check_scipy()
    if not isinstance(samples, int) or not FEWEST <= samples <= MOST:
        raise RequestError(f"samples = {samples}: must be from {FEWEST} to {MOST:,}")
    if not isinstance(seed, int) or seed < 0:
        raise RequestError(f"seed = {seed}: must be a whole number, not less than 0")
    if sampling not in SAMPLINGS:
        raise RequestError(f'sampling = "{sampling}": must be {" or ".join(SAMPLINGS)}')
    wanted = {name: width_of(scene, "within", name, width) for name, width in (within or {}).items()}
    asked = tuple(dict.fromkeys([*facts, *wanted])) if facts else ()
    points = points_of(by, samples, seed, sampling, causes)
    runs = simulate_many(scene, points.values, asked, progress=progress)
    found = Spread(scene, tuple(by), points, runs, seed, sampling, wanted, bool(facts))
    if found.failures == samples:
        raise RunError(f"no shot could be computed; the first error: {one_line(runs.errors[0])}")
    for name, width in wanted.items():
        if name not in found.numbers and name not in found.shares:
            raise RequestError(f"within, {name}: is neither a number nor true or false in these shots")
        if name in found.shares and width >= 1.0:
            raise RequestError(f"within, {name} = {width:g}: of a share it must be below 1, such as 0.05")
    return found
