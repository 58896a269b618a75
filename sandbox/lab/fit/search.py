"""The best candidate of a fit: several starts, each followed through a growing window of time.

The path before the first impacts is simple, and leads to the right impacts later; all of a long path at once has as
many minima as ways to bounce.
"""

from __future__ import annotations

import numpy as np

from sandbox.lab.fit.descent import WORTH, Place, descend
from sandbox.lab.fit.loss import HUBERS, SQUARES
from sandbox.lab.fit.problem import Problem

#: Starts that are tried for each value beyond the first, and those that are followed, at most; fewer are tried where
#: one is more than so many runs in all, as for a long table of shots.
TRIED, _FOLLOWED, MOST_RUNS = 24, 6, 1000

#: The first window, and by how much it grows at least, as shares of the points; smaller where that leads nowhere.
WINDOW, _GROWTHS = 0.25, (0.125, 0.05)

#: A window grows up to where the path is so many standard deviations from the points, which are taken to be at least
#: this share of what a start is typically off by: those of few points say little.
LOST, _LOST_SCALE = 8.0, 0.02

#: A larger window that fits so many times worse, or with one new point so many standard deviations off, has lost the
#: path. Candidates are then drawn from those that fit the smaller one, with so many times its standard errors, but at
#: most this share of a range; the best are followed. Where that did not help so many times, it is not tried any more.
_WORSE, _WORSE_ROBUST, FAR, _INFLATED, WIDEST, DRAWN, _POLISHED, _VAIN = 1.25, 1.6, 4.5, 2.0, 0.3, 32, 4, 2

#: Starts that lead to the same path in the first window, to this share of its standard deviation, and to values less
#: apart than this share of a range, are one.
SAME, APART = 0.1, 0.25

#: The accuracy of the fit to a window that is not the last, as a share of what one residual costs.
COARSE = 0.3

#: Ratio of von Neumann (1941): the mean square of differences of neighbouring residuals over the mean square of the
#: residuals. It is 2 for errors that are independent; below this the path has another shape than the track, perhaps or
#: surely.
ALIKE, _OTHER_SHAPE = 1.2, 0.4

#: A path with another shape that is so much off, as a share of what a start is typically off by, ends the search.
_FAR_OFF = 0.1

#: Residuals of a group below which their order says nothing; and how many times the median they may be.
ENOUGH, _LARGE = 8, 5.0


def search(problem: Problem) -> list[Place]:
    """The places where starts ended, the best first; none if no run could be completed. Its ``progress`` is called with
    the number of starts that were followed, and of all."""
    starts, scale = _starts(problem)
    ended: list[tuple[float, Place]] = []
    for growth in _GROWTHS:
        following = _Following(problem, scale, problem.robust, growth)
        for number, share in enumerate(starts):
            problem.progress(number, len(starts))
            found = following.from_start(share)
            ended += [(following.merit(place), place) for place in (found, following.freed(found)) if place is not None]
            ended.sort(key=lambda pair: pair[0])
            if ended and _is_good(problem, ended[0][1], following.agreed):
                return [place for _, place in ended]
        if window(problem, WINDOW) >= problem.last or following.hopeless:
            break  # there is nothing to grow, or no window would do
    return [place for _, place in ended]


def follow(problem: Problem, share: np.ndarray) -> Place | None:
    """The place to which one start leads, gross errors counted less; None if a run failed on the way."""
    first, groups = problem.times <= window(problem, WINDOW), problem.measured.groups
    scale = robust_sds(problem.residuals(share[None])[0], 0 * groups, first)
    return _Following(problem, scale, True, _GROWTHS[0]).from_start(share)


def _is_good(problem: Problem, place: Place, agreed: int) -> bool:
    """True if the residuals have no pattern; or where they are too few to have one, if two starts came to them. Not at
    the end of a range, where there may be a better minimum elsewhere."""
    ratio = neumann(problem.measured.groups, place.residuals)
    inside = bool(((place.share > 0.0) & (place.share < 1.0)).all())
    return inside and (ratio > ALIKE or (ratio == 0.0 and agreed > 0))


def neumann(groups: np.ndarray, residuals: np.ndarray) -> float:
    """The least ratio of von Neumann of all groups with enough residuals; 0 if there are none. Outliers count as large
    residuals."""
    ratios = []
    for group in np.unique(groups):
        part = residuals[groups == group]
        if len(part) >= ENOUGH and part.any():
            most = _LARGE * float(np.median(np.abs(part))) or float(np.abs(part).max())
            part = np.clip(part, -most, most)
            ratios.append(float((np.diff(part) ** 2).mean() / (part**2).mean()))
    return min(ratios, default=0.0)


def robust_sds(residuals: np.ndarray, groups: np.ndarray, inside: np.ndarray | bool = True) -> np.ndarray:
    """The standard deviation of each residual's group, by those ``inside`` (by default all), which outliers hardly
    change: 1.4826 median absolute residual. It is 1 for a group with no residuals other than 0."""
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
    tried = min(TRIED * max(len(problem) - 1, 1), max(_FOLLOWED, MOST_RUNS // problem.measured.runs))
    columns = [rng.permutation(tried) for _ in range(len(problem))]
    cube = low + (np.column_stack(columns) + rng.random((tried, len(problem)))) / tried * (high - low)
    cube[::2, len(problem.scene_keys) :] = problem.own[len(problem.scene_keys) :]  # of a film, where it most likely is
    starts = np.clip(np.vstack([problem.own, cube]), 1e-3 * high, 1.0 - 1e-3 * (1.0 - low))
    until = window(problem, WINDOW)
    found = problem.residuals(starts, until)
    done, measured = ~np.isnan(found).any(axis=1), problem.measured
    units = np.array([measured.units.index(measured.units[group]) for group in measured.groups])
    scale = np.ones(len(units))
    if done.any():
        scale = robust_sds(np.median(np.abs(found[done]), axis=0), units, problem.times <= until)
    costs = np.where(done, (np.abs(found) / scale)[:, problem.times <= until].sum(axis=1), np.inf)
    return [starts[place] for place in np.argsort(costs, kind="stable")[:_FOLLOWED] if done[place]], scale


def window(problem: Problem, share: float) -> float:
    """The time in s by which this share of the residuals were measured, but at least twice as many as parameters."""
    times = np.sort(problem.times)
    return float(times[min(max(int(share * len(times)), 2 * len(problem)), len(times)) - 1])


class _Following:
    """From starts to all points, through growing windows."""

    def __init__(self, problem: Problem, scale: np.ndarray, robust: bool, growth: float) -> None:
        self.problem, self.scale, self.robust, self.growth = problem, scale, robust, growth
        self.worse = _WORSE_ROBUST if robust else _WORSE
        self._vain = 0
        self.hopeless = False  # whether the path has another shape than the track already where it is followed
        self.agreed = 0  # starts that came to the same path as others in the first window
        self._firsts: list[tuple[np.ndarray, np.ndarray]] = []  # residuals in the first window, and shares, so far

    def from_start(self, share: np.ndarray) -> Place | None:
        """The place where the search ends; None if a run failed on the way, or another start came to the same path."""
        problem, part = self.problem, WINDOW
        until = window(problem, part)
        place = self._descend(share, until, self._least_saving(until))
        if place is None or self._is_known(place, until):
            return None
        while until < problem.last and place is not None:
            part += self.growth
            before, good = until, self._good_until(place, until)
            following = float(problem.times[problem.times > before].min())
            until = max(window(problem, part), good, following)
            place = self._grown(place, before, until)
        return place

    def freed(self, place: Place | None) -> Place | None:
        """Down again with the scene's own values for those that are at an end of their range or change nothing; None if
        there are none. Friction at which a ball grips is such a value: no slope leads back to where it slides."""
        if place is None:
            return None
        stuck = (place.share <= 0.0) | (place.share >= 1.0) | ~place.slopes.any(axis=0)
        if not stuck.any():
            return None
        return self._descend(np.where(stuck, self.problem.own, place.share), self.problem.last, WORTH)

    def _is_known(self, place: Place, until: float) -> bool:
        """True if another start came to the same path in the first window, and not by far other values."""
        first = (place.residuals / self.scale)[self.problem.times <= until]
        size = SAME * max(float(np.abs(first).mean()), 1e-12)
        matters = (place.slopes != 0.0).any(axis=0)
        known = any(
            float(np.abs(first - other).mean()) < size and (np.abs(place.share - share)[matters] < APART).all()
            for other, share in self._firsts
        )
        self._firsts.append((first, place.share))
        self.agreed += known
        return known

    def _grown(self, place: Place, before: float, until: float) -> Place | None:
        """The minimum in a larger window. Where the path does not follow the points any more, many candidates that fit
        the window ``before`` as well are tried: an impact makes large differences of small ones."""
        worth = self._least_saving(until)
        found = self._descend(place.share, until, worth)
        if found is not None and (self._vain >= _VAIN or not self._is_lost(place, before, found, until)):
            return found
        inside = self.problem.times <= before
        ratio = neumann(self.problem.measured.groups[inside], place.residuals[inside])
        if found is not None and 0.0 < ratio < _OTHER_SHAPE and self.off(place.residuals, before) > _FAR_OFF:
            self.hopeless = True
            return found
        tried = [found] if found is not None else []
        for share in self._likely(place, before, until):
            another = self._descend(share, until, worth)
            if another is not None:
                tried.append(another)
                if not self._is_lost(place, before, another, until):
                    break
        best = min(tried, key=lambda each: self.off(each.residuals, until), default=None)
        self._vain += best is found
        return best

    def _is_lost(self, place: Place, before: float, larger: Place, until: float) -> bool:
        """True if the larger window fits worse than the one before."""
        usual, times = self.off(place.residuals, before), self.problem.times
        if self.off(larger.residuals, until) > self.worse * usual:
            return True
        new = np.abs(larger.residuals / self.scale)[(times > before) & (times <= until)]
        if self.robust:  # some points may be far off
            return float(np.median(new)) > self.worse * usual
        return float(new.max()) > FAR * usual

    def _likely(self, place: Place, before: float, until: float) -> list[np.ndarray]:
        """The best for a larger window of the candidates that are as likely, by the window ``before``."""
        problem, inside = self.problem, self.problem.times <= before
        sds = robust_sds(place.residuals, problem.measured.groups, inside)
        slopes = place.slopes[inside] / sds[inside, None]
        variances, axes = np.linalg.eigh(slopes.T @ slopes)
        widths = np.minimum(_INFLATED / np.sqrt(np.maximum(variances, 1e-12)), WIDEST)
        drawn = np.random.default_rng(1).normal(size=(DRAWN, len(problem))) * widths @ axes.T
        shares = np.clip(place.share + drawn, 0.0, 1.0)
        found = np.abs(problem.residuals(shares, until) / self.scale)[:, problem.times <= until]
        costs = np.nan_to_num(found.sum(axis=1), nan=np.inf)
        return [shares[best] for best in np.argsort(costs, kind="stable")[:_POLISHED] if np.isfinite(costs[best])]

    def off(self, residuals: np.ndarray, until: float) -> float:
        """The typical distance of the path from the points of a window: the root mean square, or the median where
        outliers are expected, on the scale of all."""
        left = np.abs(residuals / self.scale)[self.problem.times <= until]
        return float(np.median(left) if self.robust else np.sqrt((left**2).mean()))

    def merit(self, place: Place) -> float:
        """The measure by which one of several candidates for all points is chosen; the lower, the better."""
        left = np.abs(place.residuals / self.scale)
        return float((np.sqrt(left) if self.robust else left**2).mean())

    def _least_saving(self, until: float) -> float:
        """The share of the cost that a step must save: in a window that is not the last, a part of what one residual
        costs, so that values of which it says little stay where they are."""
        inside = int((self.problem.times <= until).sum())
        return WORTH if until >= self.problem.last else COARSE / inside

    def _descend(self, share: np.ndarray, until: float, worth: float) -> Place | None:
        """The minimum in one window; with a robust loss in two rounds, as its scale falls with the residuals."""
        problem, place, sds = self.problem, None, self.scale
        for _ in range(2 if self.robust else 1):
            if self.robust:
                start = problem.residuals(share[None], until)[0] if place is None else place.residuals
                sds = robust_sds(start, problem.measured.groups, problem.times <= until)
            place = descend(problem, share, 1.0 / sds, HUBERS if self.robust else SQUARES, until, worth)
            if not np.isfinite(place.cost):
                return None
            share = place.share
        return place

    def _good_until(self, place: Place, until: float) -> float:
        """The time in s of the last point up to which the path stays near all."""
        problem, inside = self.problem, self.problem.times <= until
        whole = problem.residuals(place.share[None])[0]
        if np.isnan(whole).any():
            return until
        sds = robust_sds(place.residuals, problem.measured.groups, inside)
        far = np.abs(whole) > LOST * np.maximum(sds, _LOST_SCALE * self.scale)
        lost = problem.times[far & ~inside]
        return problem.last if not len(lost) else float(problem.times[problem.times < lost.min()].max(initial=until))
