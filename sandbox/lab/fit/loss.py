"""The cost of a residual: its square, or less where it is an outlier.

Maronna, Martin, Yohai: Robust Statistics (2006), sections 2.2 and 4.4. Residuals are in standard deviations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Loss:
    """A loss, with the residuals weighted as in least squares."""

    name: str  # for reports
    cost: Callable[[np.ndarray], np.ndarray]
    weight: Callable[[np.ndarray], np.ndarray]  # slope of the cost over the residual
    bend: Callable[[np.ndarray], np.ndarray]  # second derivative of the cost


#: A residual beyond so many robust standard deviations is an outlier.
OUTLIER = 4.0

#: From here on, in standard deviations, outliers count less (Huber) or not at all (Tukey); both lose 5 % of accuracy
#: where errors are normally distributed.
_HUBER, TUKEY = 1.345, 4.685


def _huber_weight(u: np.ndarray) -> np.ndarray:
    return _HUBER / np.maximum(np.abs(u), _HUBER)


def _huber_cost(u: np.ndarray) -> np.ndarray:
    size = np.abs(u)
    return np.where(size < _HUBER, 0.5 * u * u, _HUBER * (size - 0.5 * _HUBER))


def _inside(u: np.ndarray) -> np.ndarray:
    return np.maximum(1.0 - (u / TUKEY) ** 2, 0.0)


SQUARES = Loss("least squares", lambda u: 0.5 * u * u, np.ones_like, np.ones_like)
HUBERS = Loss("Huber's loss", _huber_cost, _huber_weight, lambda u: (np.abs(u) < _HUBER).astype(float))
TUKEYS = Loss(
    "Tukey's biweight",
    lambda u: TUKEY**2 / 6.0 * (1.0 - _inside(u) ** 3),
    lambda u: _inside(u) ** 2,
    lambda u: _inside(u) * (1.0 - 5.0 * (u / TUKEY) ** 2) * (np.abs(u) < TUKEY),
)
