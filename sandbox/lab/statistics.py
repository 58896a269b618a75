"""Statistics of many shots: means, quantiles, shares with their intervals, ellipses, and how many shots are needed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, ceil, degrees, floor, log, sqrt
from statistics import NormalDist

import numpy as np

#: Standard deviations to either side that hold 95 % of a normal distribution.
_Z95 = NormalDist().inv_cdf(0.975)

#: The shares of the shots whose quantiles are given.
QUANTILES = (0.025, 0.05, 0.25, 0.5, 0.75, 0.95, 0.975)

#: Bars of a histogram, at least and at most.
_FEWEST_BARS, _MOST_BARS = 8, 40


@dataclass(frozen=True)
class Numbers:
    """The distribution of a number, in its unit."""

    values: np.ndarray  # shape (shots that have it,)

    @property
    def count(self) -> int:
        """The number of shots that have it: it may not happen in all."""
        return len(self.values)

    @property
    def mean(self) -> float:
        return float(self.values.mean())

    @property
    def sd(self) -> float:
        """Standard deviation, from n - 1."""
        return float(self.values.std(ddof=1)) if self.count > 1 else 0.0

    @property
    def interval(self) -> tuple[float, float] | None:
        """The 95 % interval of the mean (Student), of shots that are independent; None for fewer than two."""
        if self.count < 2:
            return None
        half = student(self.count - 1.0) * self.sd / sqrt(self.count)
        return self.mean - half, self.mean + half

    @property
    def rms(self) -> float:
        """The root of the mean square."""
        return sqrt(float((self.values**2).mean()))

    @property
    def varies(self) -> bool:
        """True if it differs by more than rounding."""
        return self.sd > 1e-9 * float(np.abs(self.values).max())

    def quantiles(self, shares: Sequence[float] = QUANTILES) -> dict[float, float]:
        """The value below which each of these shares of the shots is."""
        return dict(zip(shares, np.quantile(self.values, shares).tolist(), strict=True))

    def histogram(self, bars: int | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Counts, and the edges of the bars: by the rule of Freedman and Diaconis, or so many ``bars``; those of whole
        numbers are one wide, and there is one of what does not vary."""
        low, high = float(self.values.min()), float(self.values.max())
        if high - low < _MOST_BARS and bool((self.values == np.round(self.values)).all()):
            return np.histogram(self.values, np.arange(low - 0.5, high + 1.0))
        if not self.varies:
            return np.histogram(self.values, 1, (low - 0.5, high + 0.5))
        if bars is None:
            quarter, rest = np.quantile(self.values, (0.25, 0.75))
            wide = 2.0 * (rest - quarter) / self.count ** (1 / 3)
            bars = int(min(max(ceil((high - low) / wide) if wide > 0.0 else 0, _FEWEST_BARS), _MOST_BARS))
        return np.histogram(self.values, bars)


@dataclass(frozen=True)
class Share:
    """The share of shots for which something is true, with its 95 % interval."""

    hits: int
    shots: int

    @property
    def value(self) -> float:
        return self.hits / self.shots

    @property
    def interval(self) -> tuple[float, float]:
        """The interval of Wilson (1927, J. Am. Stat. Assoc. 22:209): it holds the true share of random shots in 95 of
        100 samples, also where no shot or each one hits. Of Sobol points it is too wide."""
        return wilson(self.value, self.shots)


@dataclass(frozen=True)
class Ellipse:
    """The ellipse that holds a ``share`` of a normal distribution with the covariance of these points."""

    points: np.ndarray  # m, shape (points, 2)
    share: float = 0.95

    @property
    def _size(self) -> float:
        """Squared size in standard deviations, in two directions: ``-2 ln(1 - share)``."""
        return -2.0 * log(1.0 - self.share)

    @property
    def center(self) -> tuple[float, float]:
        """In m."""
        x, y = self.points.mean(axis=0).tolist()
        return x, y

    @property
    def axes(self) -> tuple[float, float]:
        """Half the length of the long and of the short axis, in m."""
        (short, long), _ = self._principal
        return sqrt(self._size * max(long, 0.0)), sqrt(self._size * max(short, 0.0))

    @property
    def angle(self) -> float:
        """Direction of the long axis in deg, from -90 to 90, counter-clockwise from +x."""
        x, y = self._principal[1][:, 1].tolist()
        return degrees(atan2(y, x) if x >= 0.0 else atan2(-y, -x))

    @property
    def inside(self) -> float:
        """The share of the points that are in it: ``share`` if they are normally distributed."""
        (short, long), axes = self._principal
        away = (self.points - self.points.mean(axis=0)) @ axes
        return float(((away**2 / np.maximum([short, long], 1e-300)).sum(axis=1) <= self._size).mean())

    def outline(self, points: int = 121) -> np.ndarray:
        """Points on it in m, shape (points, 2)."""
        turn = np.linspace(0.0, 2.0 * np.pi, points)
        (short, long), axes = self._principal
        sizes = np.sqrt(self._size * np.maximum([short, long], 0.0))
        return np.asarray(self.center + (np.column_stack([np.cos(turn), np.sin(turn)]) * sizes) @ axes.T)

    @property
    def _principal(self) -> tuple[list[float], np.ndarray]:
        """Variances along the short and the long axis in m^2, and the directions as columns."""
        variances, directions = np.linalg.eigh(np.cov(self.points.T))
        return variances.tolist(), directions


def student(freedom: float) -> float:
    """The 97.5 % quantile of Student's t with so many degrees of freedom, at least 1.

    Abramowitz and Stegun 26.7.5; exact for 1 and 2, within 0.4 % for more. Between 1 and 3 it is interpolated.
    """
    if freedom < 3.0:
        exact = (12.7062047, 4.3026527, 3.1824463)
        return float(np.exp(np.interp(freedom, (1.0, 2.0, 3.0), np.log(exact))))
    z = _Z95
    terms = (
        (z**3 + z) / 4.0,
        (5.0 * z**5 + 16.0 * z**3 + 3.0 * z) / 96.0,
        (3.0 * z**7 + 19.0 * z**5 + 17.0 * z**3 - 15.0 * z) / 384.0,
        (79.0 * z**9 + 776.0 * z**7 + 1482.0 * z**5 - 1920.0 * z**3 - 945.0 * z) / 92160.0,
    )
    return z + sum(term / freedom**power for power, term in enumerate(terms, 1))


def wilson(share: float, shots: int) -> tuple[float, float]:
    """The 95 % interval of a share that was seen in so many shots (Wilson 1927)."""
    z = _Z95 * _Z95 / shots
    middle, half = (share + 0.5 * z) / (1.0 + z), _half_width(share, shots)
    return max(0.0, middle - half), min(1.0, middle + half)


def _half_width(share: float, shots: int) -> float:
    z = _Z95 * _Z95 / shots
    return sqrt(z * share * (1.0 - share) + 0.25 * z * z) / (1.0 + z)


def shots_for_share(share: float, within: float) -> int:
    """Return the random shots that tell a share to within +-``within`` in 95 of 100 cases, by Wilson's interval."""
    low, high = 0, 1
    while _half_width(share, high) > within:
        low, high = high, 2 * high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if _half_width(share, middle) <= within else (middle, high)
    return high


def shots_for_mean(sd: float, within: float) -> int:
    """Return the random shots that tell a mean to within +-``within`` in 95 of 100 cases: ``(1.96 sd / within)^2``, and
    at least 2."""
    return max(2, ceil((_Z95 * sd / within) ** 2 * (1.0 - 1e-12)))


def round_number(value: float) -> float:
    """The largest of 1, 2 and 5 times powers of ten that is not above this."""
    power = 10.0 ** floor(np.log10(value))
    return next(factor * power for factor in (5.0, 2.0, 1.0) if factor * power <= value * (1.0 + 1e-9))
