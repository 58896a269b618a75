"""Other minima of a fit: values elsewhere that explain the data as well, such as a spin that is half a turn more.

Away from the best values chi^2 rises as the slopes there say. Along a line on which it falls again, or rises by far
less or more, there may be another minimum; so it is looked for from there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sandbox.lab.fit.descent import Place, descend
from sandbox.lab.fit.intervals import Errors
from sandbox.lab.fit.loss import Loss
from sandbox.lab.fit.problem import Problem

#: Standard errors by which a value is moved along a line, but at most this share of a range.
_MOVED, WIDEST = (3.0, 6.0, 10.0, 16.0, 26.0, 45.0), 0.5

#: Most runs for all lines together, and fewest steps of a line that are worth a look: a long table of shots has none.
MOST_RUNS, _FEWEST_STEPS = 1000, 4

#: The share of chi^2 one step before, below which it falls; how many times more or less than the slopes say is odd; and
#: from how many places of both kinds another minimum is looked for.
FALLS, _ODD, _LOOKED_FALLING, _LOOKED_ODD = 0.99, 2.0, 3, 2

#: A path with so many times as much of chi^2 as residuals, 7 standard deviations off, has lost the data.
LOST = 50.0

#: Steps after which a way that leads back is given up, and all steps; and the share of the cost that one must save.
_FIRST_STEPS, STEPS, WORTH = 4, 12, 1e-3

#: A minimum whose chi^2 is so much more than that of the best explains the data no longer (as Akaike's criterion has
#: it: Burnham & Anderson 2002, section 2.6).
_NEARLY = 10.0

#: Values so many half widths of an interval away are others.
APART = 1.5


@dataclass(frozen=True)
class Weighted:
    """A problem with the scale of each residual and the loss, by which places are compared."""

    problem: Problem
    sds: np.ndarray  # shape (residuals,)
    loss: Loss

    def chi2(self, residuals: np.ndarray) -> np.ndarray:
        """Twice the cost of residuals, shape (..., residuals): chi^2 where it is the square."""
        return np.asarray(2.0 * self.loss.cost(residuals / self.sds).sum(axis=-1))

    def down(self, share: np.ndarray, steps: int) -> Place:
        """The minimum near a candidate, as far as so many steps lead."""
        return descend(self.problem, share, 1.0 / self.sds, self.loss, worth=WORTH, steps=steps)


def rivals(weighted: Weighted, best: Place, errors: Errors, known: Sequence[Place] = ()) -> list[tuple[float, Place]]:
    """Other minima with nearly the chi^2 of the best, or less, and how much more it is; the least first.

    ``known`` are places where other starts ended.
    """
    least = float(weighted.chi2(best.residuals))
    shares = [place.share for place in known if weighted.chi2(place.residuals) - least < 2.0 * _NEARLY]
    ended: list[tuple[float, Place]] = []
    for share in [*shares, *_doubtful(weighted, best, errors)]:
        place = weighted.down(share, _FIRST_STEPS)
        if np.isfinite(place.cost) and _apart(place, best, errors):
            place = weighted.down(place.share, STEPS - _FIRST_STEPS)
            ended.append((float(weighted.chi2(place.residuals)) - least, place))
    found: list[tuple[float, Place]] = []
    for more, place in sorted(ended, key=lambda pair: pair[0]):
        others = [best, *(other for _, other in found)]
        if more < _NEARLY and all(_apart(place, other, errors) for other in others):
            found.append((more, place))
    return found


def _apart(place: Place, other: Place, errors: Errors) -> bool:
    """True if a value is outside the interval of the other, where that is not all of its range."""
    half = errors.half_widths
    return bool((np.abs(place.share - other.share) > APART * half)[half < 1.0].any())


def _doubtful(weighted: Weighted, best: Place, errors: Errors) -> list[np.ndarray]:
    """Candidates where chi^2, along a line away from the best, is less again than before; and those where it is not
    what slopes say. Of both the least first, and none that has lost the data."""
    most = MOST_RUNS // (weighted.problem.measured.runs * 4 * len(best.share))  # steps of each line
    if most < _FEWEST_STEPS:
        return []
    shares = _lines(best, errors)[:, :most]
    lines, steps, count = shares.shape
    flat = shares.reshape(-1, count)
    found = weighted.chi2(weighted.problem.residuals(flat))
    expected = weighted.chi2(best.residuals + (flat - best.share) @ best.slopes.T)
    falls, along = np.zeros((lines, steps), dtype=bool), found.reshape(lines, steps)
    falls[:, 1:] = along[:, 1:] < FALLS * along[:, :-1]
    odd = (found > _ODD * expected) | (expected > _ODD * found)
    chosen: list[int] = []
    for which, most in ((falls.ravel(), _LOOKED_FALLING), (odd, _LOOKED_ODD)):
        near = which & (found < LOST * len(best.residuals))
        order = np.argsort(np.where(near, found, np.inf), kind="stable")
        chosen += [place for place in order[:most].tolist() if near[place] and place not in chosen]
    return [flat[place] for place in chosen]


def _lines(best: Place, errors: Errors) -> np.ndarray:
    """Candidates along lines, shape (lines, steps, values): each value moved to both sides, alone or with the others by
    their correlations."""
    sds = np.maximum(errors.sds, 1e-300)
    ways = np.vstack([(errors.covariance / sds).T, np.diag(errors.sds)])  # by one standard error
    moves = np.vstack([ways, -ways])[:, None] * np.array(_MOVED)[:, None]
    moves = moves * np.minimum(1.0, WIDEST / np.maximum(np.abs(moves).max(axis=2, keepdims=True), 1e-300))
    return np.asarray(np.clip(best.share + moves, 0.0, 1.0))
