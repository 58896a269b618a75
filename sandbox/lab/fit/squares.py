"""The least squares of a fit: residuals over many runs, several starts, and intervals of the values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from sandbox.errors import RequestError, RunError
from sandbox.lab.axes import Span
from sandbox.lab.fit.track import Track
from sandbox.lab.many import simulate_many
from sandbox.parameters import value_at
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun

#: Difference of neighbouring runs, as a share of the range; starts that are tried, and of these, solved from.
STEP, TRIED, SOLVED = 1e-6, 32, 3

#: Shares of the points, from the first, that are fitted one after another from each start: the path before the first
#: bounces leads to the right number of bounces later.
WINDOWS = (0.25, 0.5, 1.0)

#: A residual beyond so many robust standard deviations is an outlier.
OUTLIER = 4.0

#: The residual in m of a point whose run failed: worse than any track.
FAILED = 1e4


@dataclass(frozen=True)
class Value:
    """A fitted value with its 95 % interval, in the parameter's unit."""

    value: float
    low: float
    high: float
    at_bound: bool  # the fit stopped at an end of the range, so the interval does not hold


@dataclass(frozen=True)
class Fit:
    """The result of a fit: ``values`` with 95 % intervals, ``correlations``, ``residuals``, ``outliers``.

    >>> import sandbox
    >>> track = {"t": [0.0, 0.2, 0.4], "x": [0.0, 1.0, 2.0], "y": [2.1, 2.9, 3.3]}
    >>> isinstance(sandbox.fit("basketball", track, {"launch.speed": (6, 9)}), sandbox.Fit)
    True
    """

    scene: Scene  # with the fitted values
    track: Track
    values: dict[str, Value]
    correlations: dict[tuple[str, str], float]  # of the errors of two values, -1 to 1
    residuals: np.ndarray = field(repr=False)  # m, shape (points, 2): measured minus computed
    outliers: tuple[int, ...] = ()  # rows of the track, the first is 1
    late: int = 0  # points after the end of the fitted run, compared with where the ball was then

    @property
    def residual_sd(self) -> tuple[float, float]:
        """The standard deviation of the residuals in x and y, in m."""
        freedom = max(len(self.track) - 0.5 * len(self.values), 1.0)
        x, y = np.sqrt((self.residuals**2).sum(axis=0) / freedom).tolist()
        return x, y


class Residuals:
    """Measured minus computed positions, for many candidates at once."""

    def __init__(self, scene: Scene, track: Track, spans: Sequence[Span]) -> None:
        self.scene, self.track, self.spans = scene, track, spans
        self.low = np.array([span.low for span in spans])
        self.width = np.array([span.high - span.low for span in spans])
        names = [ball.name for ball in scene.build().balls]
        self.balls = tuple(ball or names[0] for ball in track.balls)
        unknown = next((ball for ball in self.balls if ball not in names), None)
        if unknown is not None:
            raise RequestError(f"track: no ball {unknown!r} in {scene.title}; it has {', '.join(names)}")

    def many(self, shares: np.ndarray) -> np.ndarray:
        """Residuals in m, shape (candidates, 2 points), of candidates as shares of the ranges."""
        values = self.low + np.clip(shares, 0.0, 1.0) * self.width
        found = simulate_many(self.scene, {s.key: values[:, n] for n, s in enumerate(self.spans)}, paths=True)
        return np.array([self.of(run) for run in found.runs])

    def of(self, run: SceneRun | None) -> np.ndarray:
        if run is None:
            return np.full(2 * len(self.track), FAILED)
        places = np.empty((len(self.track), 2))
        for ball in set(self.balls):
            rows = [row for row, name in enumerate(self.balls) if name == ball]
            places[rows] = run.states(ball, np.minimum(self.track.t[rows], run.duration))[:, :2]
        return np.asarray(self.track.positions - places).ravel()

    def one(self, share: np.ndarray) -> np.ndarray:
        return self.many(share[None])[0]

    def slopes(self, share: np.ndarray) -> np.ndarray:
        """Derivatives of the residuals by the shares, by central differences, shape (2 points, parameters)."""
        count = len(share)
        up, down = (np.clip(share + sign * STEP * np.eye(count), 0.0, 1.0) for sign in (1.0, -1.0))
        found = self.many(np.vstack([up, down]))
        return ((found[:count] - found[count:]) / np.diag(up - down)[:, None]).T


def solve(scene: Scene, track: Track, spans: Sequence[Span]) -> Fit:
    """The best fit from several starts: the scene's own values, and the best of evenly spread points."""
    from scipy.optimize import least_squares
    from scipy.stats import qmc

    residuals = Residuals(scene, track, spans)
    own = np.array([float(value_at(scene.parameters, span.key)) for span in spans])
    spread = qmc.Sobol(len(spans), seed=0).random(TRIED)
    starts = np.clip(np.vstack([(own - residuals.low) / residuals.width, spread]), 1e-3, 1.0 - 1e-3)
    costs = (residuals.many(starts) ** 2).sum(axis=1)
    chosen = [0, *(place for place in np.argsort(costs).tolist() if place)][:SOLVED]
    best = None
    for place in chosen:
        share = starts[place]
        for window in WINDOWS:
            part = Residuals(scene, track.first(max(round(window * len(track)), len(spans) + 1)), spans)
            tried = least_squares(part.one, share, part.slopes, bounds=(0.0, 1.0), x_scale="jac")
            share = np.clip(tried.x, 1e-9, 1.0 - 1e-9)
        if best is None or tried.cost < best.cost:
            best = tried
    assert best is not None
    if best.fun.max() >= FAILED:
        raise RunError(f"no run of {scene.title} in these ranges could be completed")
    return _finished(residuals, best.x, best.fun)


def _finished(residuals: Residuals, share: np.ndarray, left: np.ndarray) -> Fit:
    """The fit with intervals, from the slopes at the best values."""
    from scipy.stats import t as student

    slopes, count = residuals.slopes(share), len(share)
    freedom = len(left) - count
    # x and y of a track may be measured unequally well, but are weighted alike
    covariance = np.linalg.pinv(slopes.T @ slopes) * (left @ left) / freedom
    half = student.ppf(0.975, freedom) * np.sqrt(np.diag(covariance)) * residuals.width
    values = residuals.low + share * residuals.width
    keys = [span.key for span in residuals.spans]
    ends = (share < 1e-6) | (share > 1.0 - 1e-6)
    sds = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    off = left.reshape(-1, 2)
    middle = 1.4826 * np.median(np.abs(off), axis=0)
    outliers = np.flatnonzero((np.abs(off) > OUTLIER * np.maximum(middle, 1e-12)).any(axis=1)) + 1
    best = residuals.scene.changed({key: float(v) for key, v in zip(keys, values, strict=True)})
    duration = simulate_many(best, {keys[0]: values[:1]}, paths=True).runs[0]
    late = 0 if duration is None else int((residuals.track.t > duration.duration).sum())
    return Fit(
        best,
        residuals.track,
        {
            k: Value(float(v), float(v - h), float(v + h), bool(e))
            for k, v, h, e in zip(keys, values, half, ends, strict=True)
        },
        {(keys[i], keys[j]): float(covariance[i, j] / (sds[i] * sds[j])) for i, j in combinations(range(count), 2)},
        off,
        tuple(outliers.tolist()),
        late,
    )
