"""A table of launches and results: each row sets some parameters, and what was measured is compared with facts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import isfinite

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.axes import checked
from sandbox.lab.fit.formats import Form
from sandbox.lab.fit.mapped import mapped
from sandbox.lab.fit.measured import Free
from sandbox.lab.runs import runs
from sandbox.lab.table_file import Table
from sandbox.scene import Scene
from sandbox.scene.points import Points


@dataclass(frozen=True)
class Launches:
    """Launches and what was measured of each, in the units that the scene declares."""

    given: Mapping[str, np.ndarray]  # by parameter, shape (launches,)
    measured: Mapping[str, np.ndarray]  # by fact, shape (launches,)
    numbers: np.ndarray  # the row of each launch in its file, the first is 1
    units: tuple[str, ...]  # of each fact
    notes: tuple[str, ...] = ()  # on how the table was read
    where: str = "track"  # as messages begin

    what = "shot"
    free: tuple[Free, ...] = ()

    @property
    def count(self) -> int:
        """The launches."""
        return len(self.numbers)

    @property
    def runs(self) -> int:
        """The runs of one candidate, one for each launch."""
        return self.count

    @property
    def rows(self) -> np.ndarray:
        """The row of each residual: all results of the first launch, of the second, and so on."""
        return np.repeat(self.numbers, len(self.measured))

    @property
    def groups(self) -> np.ndarray:
        """The place of each residual's result in ``names``."""
        return np.tile(np.arange(len(self.measured)), self.count)

    @property
    def names(self) -> tuple[str, ...]:
        """The results."""
        return tuple(self.measured)

    @property
    def times(self) -> np.ndarray:
        """NaN for each residual, since results have no times."""
        return np.full(self.count * len(self.measured), np.nan)

    def check(self, scene: Scene) -> None:
        """Raise RequestError for a launch that the scene cannot make, or that has no such result."""
        for key, values in self.given.items():
            for row, value in zip(self.numbers.tolist(), values.tolist(), strict=True):
                checked(scene, f"{self.where}: row {row},", key, value)
        computed = self._computed(scene, (), np.empty((1, 0)))[0]
        for place, row in enumerate(self.numbers.tolist()):
            for name, value in zip(self.measured, computed[place].tolist(), strict=True):
                if not isfinite(value):
                    raise RequestError(f"{self.where}: row {row}, {scene.title} has no {name} for this launch")

    def residuals(self, scene: Scene, keys: Sequence[str], values: np.ndarray, until: float) -> np.ndarray:
        """Measured minus computed results in their units, shape (candidates, launches times results)."""
        found = np.column_stack(list(self.measured.values())) - self._computed(scene, keys, values)
        left = found.reshape(len(values), -1)
        left[~np.isfinite(left).all(axis=1)] = np.nan
        return left

    def _computed(self, scene: Scene, keys: Sequence[str], values: np.ndarray) -> np.ndarray:
        """The results, shape (candidates, launches, results); NaN for one that a run does not have."""
        launches = list(zip(*(column.tolist() for column in self.given.values()), strict=True))
        points = [(*candidate, *launch) for candidate, launch in product(values[:, : len(keys)].tolist(), launches)]
        found = np.full((len(points), len(self.measured)), np.nan)
        for place, run in enumerate(runs(scene, [*keys, *self.given], points, asked=tuple(self.measured))):
            if not isinstance(run, Exception):
                found[place] = [np.nan if run.result[name] is None else run.result[name] for name in self.measured]
        return found.reshape(len(values), self.count, -1)

    def points(self, scene: Scene, free: Sequence[float]) -> Points | None:
        """Return None, since there are no places."""
        return None

    def remarks(self, scene: Scene, free: Sequence[float]) -> tuple[str, ...]:
        """Sentences on how the table was read, and on what is taken as exact."""
        return (*self.notes, f"the launches are taken as measured: {', '.join(self.given)}")


def launches(scene: Scene, table: Table, form: Form, where: Mapping[str, str]) -> Launches:
    """The launches of a table. Raises RequestError."""
    found = mapped(scene, table, form, where)
    return Launches(
        {key: one.values for key, one in found.given.items()},
        {key: one.values for key, one in found.measured.items()},
        np.array(found.rows),
        tuple(one.unit for one in found.measured.values()),
        found.notes,
        table.where,
    )
