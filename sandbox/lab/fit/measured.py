"""Measured data as a fit needs them: residuals for many candidates at once, and which of them scatter alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from sandbox.lab.selection import LeftOut
from sandbox.scene import Scene
from sandbox.scene.points import Points


@dataclass(frozen=True)
class Free:
    """A number that belongs to the measurement and not to the scene, such as the time of the launch on a film."""

    key: str  # "track.time"
    low: float
    high: float
    start: float
    unit: str


class Measured(Protocol):
    """Measured data: a track of positions, or a table of launches and results."""

    @property
    def count(self) -> int:
        """Rows of the data: points of a track, launches of a table."""

    @property
    def runs(self) -> int:
        """Runs that one candidate needs: 1 for a track, one for each launch of a table."""

    @property
    def what(self) -> str:
        """A row by name: ``"point"``, ``"launch"``."""

    @property
    def rows(self) -> np.ndarray:
        """The row of each residual, the first is 1; integers, shape (residuals,)."""

    @property
    def groups(self) -> np.ndarray:
        """The place in ``names`` of each residual: those of one group scatter alike; shape (residuals,)."""

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities that were measured, by group: ``("x", "y")``, ``("carry", "apex")``."""

    @property
    def units(self) -> tuple[str, ...]:
        """The unit of each group."""

    @property
    def alike(self) -> Mapping[str, np.ndarray]:
        """Groups of residuals whose errors may be alike, by name: a label for each residual, shape (residuals,)."""

    @property
    def times(self) -> np.ndarray:
        """The time of each residual in s since the launch, NaN if unknown; shape (residuals,)."""

    @property
    def free(self) -> tuple[Free, ...]:
        """Numbers of the measurement itself that are fitted too."""

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """The rows of the data that are not used, each with its reason."""

    @property
    def unused(self) -> tuple[str, ...]:
        """The names of columns that the fit does not use."""

    def check(self, scene: Scene) -> None:
        """Raise RequestError if this cannot be compared with runs of the scene."""

    def residuals(self, scene: Scene, keys: Sequence[str], values: np.ndarray, until: float) -> np.ndarray:
        """Measured minus computed of each candidate, shape (candidates, residuals); a row of NaN for a run that failed.

        ``values`` has the parameters ``keys`` of the scene, then ``free``, shape (candidates, keys + free), in their
        units. Residuals measured after ``until`` in s are not read, so runs may end there.
        """

    def points(self, scene: Scene, free: Sequence[float]) -> Points | None:
        """The measured places with these values of ``free``; None for what has no places."""

    def remarks(self, scene: Scene, free: Sequence[float]) -> tuple[str, ...]:
        """Sentences on the data, compared with the fitted scene; and on what was assumed in reading it."""


class Rows:
    """Data with the same quantities in each row: residuals are those of the first row, of the second, and so on."""

    numbers: np.ndarray  # the row of each in its file, the first is 1; shape (rows,)

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities."""
        raise NotImplementedError

    @property
    def count(self) -> int:
        """The rows."""
        return len(self.numbers)

    @property
    def rows(self) -> np.ndarray:
        """The row of each residual."""
        return np.repeat(self.numbers, len(self.names))

    @property
    def groups(self) -> np.ndarray:
        """The place of each residual's quantity in ``names``."""
        return np.tile(np.arange(len(self.names)), self.count)

    @property
    def alike(self) -> Mapping[str, np.ndarray]:
        """No groups are known; neighbours have a pattern."""
        return {}

    @property
    def times(self) -> np.ndarray:
        """NaN for each residual: each run is compared as a whole."""
        return np.full(self.count * len(self.names), np.nan)
