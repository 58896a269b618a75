"""The best candidate of a fit: several starts, each followed through a growing window of time.

The path before the first impacts is simple, and leads to the right impacts later; all of a long path at once has as
many minima as ways to bounce.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sandbox.lab.fit.descent import WORTH, Place, descend
from sandbox.lab.fit.loss import HUBERS, SQUARES
from sandbox.lab.fit.problem import Problem

#: Starts that are tried, and those that are followed, at most.
TRIED, FOLLOWED = 24, 6

#: The first window, and by how much it grows at least, as shares of the points.
WINDOW, GROWTH = 0.25, 0.125

#: A window grows up to where the path is so many standard deviations from the points, which are taken to be at least
#: this share of what a start is typically off by: those of few points say little.
LOST, LOST_SCALE = 8.0, 0.02

#: The accuracy of the fit to a window that is not the last, as a share of the cost.
COARSE = 1e-3

#: Ratio of von Neumann (1941): the mean square of differences of neighbouring residuals over the mean square of the
#: residuals. It is 2 for errors that are independent; below this the path has another shape than the track.
ALIKE = 1.2

#: Residuals of a group below which their order says nothing.
ENOUGH = 8


def search(problem: Problem, robust: bool) -> Place | None:
    """The best candidate; None if no run could be completed."""
    starts, scale = _starts(problem)
    best, least = None, np.inf
    for share in starts:
        found = _Following(problem, scale, robust).from_start(share)
        if found is None:
            continue
        left = np.abs(found.residuals / scale)
        merit = float((left if robust else left**2).sum())
        if merit < least:
            best, least = found, merit
        if best is not None and neumann(problem, best.residuals) > ALIKE:
            break
    return best


def neumann(problem: Problem, residuals: np.ndarray) -> float:
    """The least ratio of von Neumann of all groups with enough residuals; 0 if there are none."""
    groups = problem.measured.groups
    parts = [residuals[groups == group] for group in np.unique(groups)]
    enough = [part for part in parts if len(part) >= ENOUGH and part.any()]
    return min((float((np.diff(part) ** 2).mean() / (part**2).mean()) for part in enough), default=0.0)


def robust_sds(residuals: np.ndarray, groups: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """The standard deviation of each residual's group, by those ``inside``, which outliers hardly change: 1.4826 median
    absolute residual. It is 1 for a group with no residuals other than 0."""
    sds = np.ones(len(residuals))
    for group in np.unique(groups):
        size = np.abs(residuals[(groups == group) & inside])
        if len(size):
            sds[groups == group] = 1.4826 * np.median(size) or size.max() or 1.0
    return sds


def _starts(problem: Problem) -> tuple[list[np.ndarray], np.ndarray]:
    """The scene's own values and a Latin hypercube, the best by the first window first; and a scale for each residual,
    the same for those in one unit, so that others can be compared."""
    rng, (low, high) = np.random.default_rng(0), problem.starts_within
    columns = [rng.permutation(TRIED) for _ in range(len(problem))]
    cube = low + (np.column_stack(columns) + rng.random((TRIED, len(problem)))) / TRIED * (high - low)
    starts = np.clip(np.vstack([problem.own, cube]), 1e-3 * high, 1.0 - 1e-3 * (1.0 - low))
    until = window(problem, WINDOW)
    found = problem.residuals(starts, until)
    done, measured = ~np.isnan(found).any(axis=1), problem.measured
    units = np.array([measured.units.index(measured.units[group]) for group in measured.groups])
    scale = np.ones(len(units))
    if done.any():
        scale = robust_sds(np.median(np.abs(found[done]), axis=0), units, problem.times <= until)
    costs = np.where(done, (np.abs(found) / scale)[:, problem.times <= until].sum(axis=1), np.inf)
    return [starts[place] for place in np.argsort(costs, kind="stable")[:FOLLOWED] if done[place]], scale


def window(problem: Problem, share: float) -> float:
    """The time in s by which this share of the residuals were measured, but at least twice as many as parameters."""
    times = np.sort(problem.times)
    return float(times[min(max(int(share * len(times)), 2 * len(problem)), len(times)) - 1])


@dataclass
class _Following:
    """From one start to all points, through growing windows."""

    problem: Problem
    scale: np.ndarray
    robust: bool

    def from_start(self, share: np.ndarray) -> Place | None:
        """The place where the search ends; None if a run failed on the way."""
        problem, part = self.problem, WINDOW
        until = window(problem, part)
        while until < problem.last:
            place = self._descend(share, until, COARSE)
            if place is None:
                return None
            share, part = place.share, part + GROWTH
            until = max(window(problem, part), self._good_until(share, place.residuals, until))
        return self._descend(share, until, WORTH)

    def _descend(self, share: np.ndarray, until: float, worth: float) -> Place | None:
        """The minimum in one window; with a robust loss in two rounds, as its scale falls with the residuals."""
        inside, place = self.problem.times <= until, None
        for _ in range(2 if self.robust else 1):
            sds = self.scale
            if self.robust:
                start = self.problem.residuals(share[None], until)[0] if place is None else place.residuals
                sds = robust_sds(start, self.problem.measured.groups, inside)
            place = descend(self.problem, share, 1.0 / sds, HUBERS if self.robust else SQUARES, until, worth)
            if not np.isfinite(place.cost):
                return None
            share = place.share
        return place

    def _good_until(self, share: np.ndarray, residuals: np.ndarray, until: float) -> float:
        """The time in s up to which the path stays near the points."""
        problem, inside = self.problem, self.problem.times <= until
        whole = problem.residuals(share[None])[0]
        if np.isnan(whole).any():
            return until
        sds = robust_sds(residuals, problem.measured.groups, inside)
        far = np.abs(whole) > LOST * max(sds.max(), LOST_SCALE * self.scale.max())
        lost = problem.times[far & ~inside]
        return problem.last if not len(lost) else float(lost.min())
