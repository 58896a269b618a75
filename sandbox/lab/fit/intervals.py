"""The accuracy of fitted values: scatter of each group, covariance of the values, and their 95 % intervals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sandbox.lab.fit.loss import Loss
from sandbox.lab.statistics import student

#: Groups in one unit scatter alike, unless their variances differ by this many standard errors.
_DIFFERENT = 3.0

#: Groups whose errors are alike are too far apart to be so by chance, at this many standard deviations of a normal
#: distribution (one side, 5 %); an interval from them takes at least this many degrees of freedom: assumed.
_BY_CHANCE, _FEWEST_FREE = 1.645, 2.0

#: Two values whose errors are correlated more strongly than this can hardly be told apart.
HARDLY = 0.98

#: A direction of the values with less than this share of the largest effect has none: its variance is then so large
#: that the interval is the whole range.
_NO_EFFECT = 1e-9


@dataclass(frozen=True)
class Errors:
    """The errors of fitted shares: their covariance, and the degrees of freedom of each variance."""

    covariance: np.ndarray
    freedom: np.ndarray

    @property
    def sds(self) -> np.ndarray:
        """The standard error of each share."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def half_widths(self) -> np.ndarray:
        """Half of each 95 % interval."""
        return self.sds * np.array([student(each) for each in self.freedom.tolist()])


def group_sds(residuals: np.ndarray, slopes: np.ndarray, sds: np.ndarray, groups: np.ndarray) -> np.ndarray:
    """The standard deviation of each group's errors, shape (groups,), from residuals that were weighted by ``sds``.

    Each group loses as many degrees of freedom as it decides of the values: its part of the trace of the hat matrix.
    """
    unit = slopes / sds[:, None]
    leverage = np.einsum("ij,jk,ik->i", unit, inverse_of(unit)[0], unit)
    found = []
    for group in range(int(groups.max()) + 1):
        own = groups == group
        freedom = max(float(own.sum() - leverage[own].sum()), 1.0)
        found.append(float(np.sqrt((residuals[own] ** 2).sum() / freedom)))
    return np.array(found)


def pooled(sds: np.ndarray, counts: np.ndarray, units: tuple[str, ...]) -> np.ndarray:
    """The standard deviations of groups, with one for all groups in a unit that do not differ more than by chance; one
    that is met exactly, as x of a fall straight down, does."""
    found = sds.copy()
    for unit in dict.fromkeys(units):
        own = np.array([each == unit for each in units])
        if own.sum() > 1 and (sds[own] > 0.0).all():
            logs, errors = 2.0 * np.log(sds[own]), np.sqrt(2.0 / counts[own])
            if np.ptp(logs) < _DIFFERENT * float(np.hypot(*np.sort(errors)[-2:])):
                found[own] = np.sqrt((counts[own] * sds[own] ** 2).sum() / counts[own].sum())
    return found


def errors_of(residuals: np.ndarray, slopes: np.ndarray, sds: np.ndarray, groups: np.ndarray, loss: Loss) -> Errors:
    """The errors of the shares, from residuals and slopes at the best ones and the scale of each residual.

    With squares each group has the variance of its residuals. With another loss psi' it is Huber's (1981, eq. 7.6.13):
    K^2 (sum psi^2 / (n - p)) / (mean psi')^2 (X'X)^-1, with K = 1 + p / n var(psi') / (mean psi')^2.
    """
    scaled, unit = residuals / sds, slopes / sds[:, None]
    count, parameters = unit.shape
    inverse, unknown = inverse_of(unit)
    psi, bend = loss.weight(scaled) * scaled, loss.bend(scaled)
    mean = max(float(bend.mean()), 0.05)
    correction = (1.0 + parameters / count * float(bend.var()) / mean**2) / mean
    influence = inverse @ unit.T  # of each residual on each share
    parts, degrees = [], []
    for group in range(int(groups.max()) + 1):
        own = groups == group
        leverage = float(np.einsum("ij,ji->", unit[own], influence[:, own]))
        degrees.append(max(float(own.sum()) - leverage - float((loss.weight(scaled[own]) == 0.0).sum()), 1.0))
        variance = float((psi[own] ** 2).sum()) / max(float(own.sum()) - leverage, 1.0) * correction**2
        parts.append((influence[:, own] @ influence[:, own].T) * variance)
    shares = np.array([np.diag(part) for part in parts])  # of each group in each variance
    total = shares.sum(axis=0)
    weights = (shares**2 / np.array(degrees)[:, None]).sum(axis=0)  # Welch and Satterthwaite
    freedom = np.where(weights > 0.0, total**2 / np.maximum(weights, 1e-300), max(count - parameters, 1))
    return Errors(np.sum(parts, axis=0) + unknown, np.clip(freedom, 1.0, max(count - parameters, 1)))


def inverse_of(slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The inverse of slopes' slopes in directions that have an effect, and the enormous variance of those that have
    none."""
    size = np.sqrt((slopes**2).sum(axis=0))
    size = np.maximum(size, _NO_EFFECT * (float(size.max(initial=0.0)) or 1.0))
    unit = slopes / size
    values, vectors = np.linalg.eigh(unit.T @ unit)
    known, scale = values > _NO_EFFECT**2, np.outer(size, size)
    inverse = (vectors[:, known] / values[known]) @ vectors[:, known].T / scale
    return inverse, (vectors[:, ~known] / _NO_EFFECT**2) @ vectors[:, ~known].T / scale


def clustered(
    residuals: np.ndarray, slopes: np.ndarray, sds: np.ndarray, labels: np.ndarray, loss: Loss
) -> tuple[Errors, np.ndarray]:
    """The errors of the shares where those of one group are alike, as far as they may be, and independent of those of
    others: a sandwich whose middle has the sum of each group (Liang & Zeger 1986, times G / (G - 1)). And for each
    share true if groups differ by more than errors that are all independent would by chance.
    """
    scaled, unit = residuals / sds, slopes / sds[:, None]
    inverse, unknown = inverse_of(unit)
    mean = max(float(loss.bend(scaled).mean()), 0.05)
    moved = inverse @ (unit * (loss.weight(scaled) * scaled / mean)[:, None]).T  # of each residual in each share
    names, places = np.unique(labels, return_inverse=True)
    sums = np.zeros((len(slopes.T), len(names)))
    np.add.at(sums.T, places, moved.T)
    count, parameters = len(names), len(sums)
    factor = count / max(count - 1, 1)
    apart = factor * (sums**2).sum(axis=1) > _most_by_chance(count - 1) * (moved**2).sum(axis=1)
    freedom = np.full(parameters, max(float(count - parameters), _FEWEST_FREE))
    return Errors(factor * sums @ sums.T + unknown, freedom), apart


def _most_by_chance(freedom: int) -> float:
    """The 95 % quantile of chi^2 over its degrees of freedom (Wilson & Hilferty 1931)."""
    step = 2.0 / (9.0 * max(freedom, 1))
    return float((1.0 - step + _BY_CHANCE * step**0.5) ** 3)
