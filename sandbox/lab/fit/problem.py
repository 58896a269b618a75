"""A fit as a problem of numbers: residuals of candidates, which are shares of the ranges of what is fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sandbox.lab.axes import Span, unit_of
from sandbox.lab.fit.measured import Measured
from sandbox.lab.runs import Progress, no_progress
from sandbox.parameters import value_at
from sandbox.scene import Scene

#: Differences of neighbouring runs: as a share of the value, but at least and at most this share of its range.
STEP, _LEAST_STEP, _MOST_STEP = 1e-5, 1e-8, 1e-5

#: A slope to one side so many times as steep as to the other is that of a cliff.
_STEEPER = 3.0

#: Declared bounds so many times as wide as the scene's own value are searched near that value only, directions all
#: round it (in deg); and what belongs to a film within this share of its range around where it most likely is.
WIDE, _ALL_ROUND, _LIKELY = 20.0, 180.0, 0.2


@dataclass(frozen=True)
class Declared(Span):
    """The declared bounds of a parameter, of which no range was given."""


class Problem:
    """Residuals of measured data as a function of shares, from 0 to 1, of the ranges of what is fitted; and how it is:
    with gross errors counted less if ``robust``, and telling ``progress`` about its starts."""

    def __init__(
        self,
        scene: Scene,
        measured: Measured,
        spans: Sequence[Span],
        robust: bool = False,
        progress: Progress = no_progress,
    ) -> None:
        self.scene, self.measured, free = scene, measured, measured.free
        self.spans, self.robust, self.progress = spans, robust, progress
        self.scene_keys = [span.key for span in spans]
        self.keys = [*self.scene_keys, *(one.key for one in free)]
        self.units = [*(unit_of(scene, key) for key in self.scene_keys), *(one.unit for one in free)]
        ranges = [(span.low, span.high) for span in spans] + [(one.low, one.high) for one in free]
        self.declared = np.array([isinstance(span, Declared) for span in spans] + [False] * len(free))
        self.low, high = np.array(ranges).T
        self.width = high - self.low
        own = [value_at(scene.parameters, key) for key in self.scene_keys]
        # a parameter that is not set, such as a density that follows from temperature and pressure, has the middle
        middles = (0.5 * (span.low + span.high) for span in spans)
        starts = [middle if value is None else float(value) for value, middle in zip(own, middles, strict=True)]
        self.own = np.clip((np.array([*starts, *(one.start for one in free)]) - self.low) / self.width, 0.0, 1.0)
        self.times = np.nan_to_num(measured.times, nan=0.0)  # without a time: in every window
        self.last = float(self.times.max())  # s

    def __len__(self) -> int:
        return len(self.keys)

    def values(self, shares: np.ndarray) -> np.ndarray:
        """Candidates in their units, of any shape (..., parameters)."""
        return np.clip(self.low + shares * self.width, self.low, self.low + self.width)

    def residuals(self, shares: np.ndarray, until: float | None = None) -> np.ndarray:
        """Residuals of candidates, shape (candidates, residuals): up to a time in s, by default all."""
        until = self.last if until is None else until
        return self.measured.residuals(self.scene, self.scene_keys, self.values(shares), until)

    def around(self, share: np.ndarray, until: float) -> tuple[np.ndarray, np.ndarray]:
        """Residuals at a candidate, and their slopes by the shares, shape (residuals, parameters), computed together.

        Slopes are from differences to one side. A run that fails gives no slope.
        """
        steps = np.clip(STEP * np.abs(self.values(share)) / self.width, _LEAST_STEP, _MOST_STEP)
        steps = np.where(share + steps > 1.0, -steps, steps)
        found = self.residuals(np.vstack([share, share + np.diag(steps)]), until)
        return found[0], np.nan_to_num((found[1:] - found[:1]) / steps[:, None]).T

    def slopes(self, share: np.ndarray, steps: np.ndarray, inverse_sd: np.ndarray) -> np.ndarray:
        """Slopes from differences to both sides, by these steps, shape (residuals, parameters).

        Where those to one side are far steeper, weighted by ``inverse_sd``, as at the edge of a miss, only the other's
        count.
        """
        moved = np.clip(np.vstack([share + np.diag(steps), share - np.diag(steps)]), 0.0, 1.0)
        found, count = self.residuals(np.vstack([share, moved])), len(share)
        apart = np.vstack([np.diag(moved[:count]) - share, np.diag(moved[count:]) - share])  # shape (2, parameters)
        with np.errstate(invalid="ignore", divide="ignore"):
            slopes = (found[1:] - found[0]).reshape(2, count, -1) / apart[:, :, None]
        effect = np.sqrt(((slopes * inverse_sd) ** 2).sum(axis=2))
        effect = np.where(np.isnan(effect), np.inf, effect)  # a run that failed, or no room before an end of the range
        keep = (effect <= _STEEPER * effect.min(axis=0)) & np.isfinite(effect)
        kept = np.where(keep[:, :, None], slopes, 0.0).sum(axis=0) / np.maximum(keep.sum(axis=0), 1)[:, None]
        return np.asarray(kept).T

    @cached_property
    def starts_within(self) -> tuple[np.ndarray, np.ndarray]:
        """The shares between which starts are searched: all of a range that was given."""
        own, turns = np.abs(self.values(self.own)), np.array([unit == "deg" for unit in self.units])
        near = self.declared & (own > 0.0) & (self.width > WIDE * own)
        reach = np.where(near, 2.0 * own / self.width, 1.0)
        reach = np.where(self.declared & turns, _ALL_ROUND / self.width, reach)
        reach[len(self.scene_keys) :] = _LIKELY
        return np.clip(self.own - reach, 0.0, 1.0), np.clip(self.own + reach, 0.0, 1.0)
