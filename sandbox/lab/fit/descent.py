"""Levenberg and Marquardt's method within bounds.

Marquardt (1963), J. SIAM 11:431. A trial and the runs that its slopes need are computed together, a run that fails is a
step too far, and a loss other than the square is a weight of each residual. scipy has no such method; and importing its
``least_squares`` takes longer than most fits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sandbox.lab.fit.loss import Loss
from sandbox.lab.fit.problem import Problem

#: Steps that are tried, at most; dampings at which a step is given up; and the share of the cost that is not worth one.
MOST_STEPS, _FIRST_DAMPING, _MOST_DAMPING = 60, 1e-3, 1e8
WORTH = 1e-7

#: The longest step, as a share of the range in which starts are searched: slopes say little of what is farther.
LONGEST = 0.5


@dataclass(frozen=True)
class Place:
    """A candidate, with its residuals in their units and their slopes by the shares."""

    share: np.ndarray
    residuals: np.ndarray  # shape (residuals,)
    slopes: np.ndarray  # shape (residuals, parameters)
    cost: float


def descend(
    problem: Problem,
    share: np.ndarray,
    inverse_sd: np.ndarray,
    loss: Loss,
    until: float | None = None,
    worth: float = WORTH,
    steps: int = MOST_STEPS,
) -> Place:
    """Go down from a candidate to where the loss of the residuals measured ``until`` a time in s is least.

    ``inverse_sd`` is one over the standard deviation of each residual. It ends where a step is expected to save less
    than the share ``worth`` of the cost, or after so many ``steps``.
    """
    until = problem.last if until is None else until
    inverse = np.where(problem.times <= until, inverse_sd, 0.0)
    here, damping = _place(problem, share, inverse, loss, until), _FIRST_DAMPING
    if not np.isfinite(here.cost):
        return here
    low, high = problem.starts_within
    longest = LONGEST * (high - low)
    for _ in range(steps):
        step, saved = _step(here, inverse, loss, damping, longest)
        if abs(saved) <= worth * here.cost or damping > _MOST_DAMPING:
            break
        if saved < 0.0:  # what was cut at a bound spoils the rest of the step
            damping *= 10.0
            continue
        trial = _place(problem, np.clip(here.share + step, 0.0, 1.0), inverse, loss, until)
        if trial.cost < here.cost:
            here, damping = trial, 0.1 * damping
        else:
            damping *= 10.0 if damping > _FIRST_DAMPING else 100.0
    return here


def _place(problem: Problem, share: np.ndarray, inverse: np.ndarray, loss: Loss, until: float) -> Place:
    residuals, slopes = problem.around(share, until)
    if np.isnan(residuals).any():
        return Place(share, residuals, slopes, np.inf)
    return Place(share, residuals, slopes, float(loss.cost(residuals * inverse).sum()))


def _step(
    here: Place, inverse: np.ndarray, loss: Loss, damping: float, longest: np.ndarray
) -> tuple[np.ndarray, float]:
    """The damped step in shares, in no direction longer than ``longest``, and what it is expected to save; none in a
    direction that leads out of the range."""
    scaled = here.residuals * inverse
    root = np.sqrt(loss.weight(scaled)) * inverse
    slopes, left = here.slopes * root[:, None], here.residuals * root
    downhill = -(slopes.T @ left)
    size = np.sqrt((slopes**2).sum(axis=0))
    stuck = (here.share <= 0.0) & (downhill < 0.0) | (here.share >= 1.0) & (downhill > 0.0) | (size == 0.0)
    step, free = np.zeros(len(size)), np.flatnonzero(~stuck)
    if not len(free):
        return step, 0.0
    unit = slopes[:, free] / size[free]
    matrix = unit.T @ unit + damping * np.eye(len(free))
    step[free] = np.linalg.solve(matrix, downhill[free] / size[free]) / size[free]
    step = step / max(1.0, float((np.abs(step) / longest).max()))
    step = np.clip(here.share + step, 0.0, 1.0) - here.share
    after = left + slopes @ step
    return step, 0.5 * float(left @ left - after @ after)
