"""A table of launches and results: each row sets some parameters, and what was measured is compared with facts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from math import isfinite

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.fit.measured import Free, Rows
from sandbox.lab.mapped import Mapped
from sandbox.lab.runs import columns_at
from sandbox.lab.selection import LeftOut, reasons
from sandbox.scene import Scene
from sandbox.scene.points import Points

#: Groups of launches that a column makes, at least, and launches in each of them on average.
_FEWEST_GROUPS, _FEWEST_IN_GROUP = 3, 3


@dataclass(frozen=True)
class Launches(Rows):
    """Launches and what was measured of each, in the units that the scene declares."""

    given: Mapping[str, np.ndarray]  # by parameter, shape (launches,)
    measured: Mapping[str, np.ndarray]  # by fact, shape (launches,)
    numbers: np.ndarray  # the row of each launch in its file, the first is 1
    units: tuple[str, ...]  # of each fact
    notes: tuple[str, ...] = ()  # on how the table was read
    where: str = "track"  # as messages begin
    left_out: tuple[LeftOut, ...] = ()
    unused: tuple[str, ...] = ()  # columns of the table
    words: Mapping[str, np.ndarray] = field(
        default_factory=dict
    )  # by column that makes groups: the word of each launch

    what = "shot"
    free: tuple[Free, ...] = ()

    @property
    def runs(self) -> int:
        """The runs of one candidate, one for each launch."""
        return self.count

    @property
    def names(self) -> tuple[str, ...]:
        """The results."""
        return tuple(self.measured)

    @property
    def alike(self) -> Mapping[str, np.ndarray]:
        """Each launch, each result, and the words of each column that makes groups."""
        count = len(self.measured)
        found = {"shot": np.repeat(np.arange(self.count), count)} if count > 1 else {}
        found |= {"result": self.groups} if count > 1 else {}
        return found | {name: np.repeat(words, count) for name, words in self.words.items()}

    def check(self, scene: Scene) -> None:
        """Raise RequestError for a launch that has no such result in the scene."""
        fault = next(iter(self._without_result(scene)), None)
        if fault is not None:
            raise RequestError(f"{self.where}: row {fault.row}, {fault.why}")

    def that_fly(self, scene: Scene) -> Launches:
        """Those launches that have all results in the scene, the others left out. Raises RequestError if none has."""
        faults = self._without_result(scene)
        kept = ~np.isin(self.numbers, [fault.row for fault in faults])
        left_out = tuple(sorted((*self.left_out, *faults), key=lambda each: each.row))
        if not kept.any():
            raise RequestError(f"{self.where}: no row can be used: {reasons(left_out)}")
        given, measured = ({key: values[kept] for key, values in some.items()} for some in (self.given, self.measured))
        words = {name: labels[kept] for name, labels in self.words.items()}
        return replace(self, given=given, measured=measured, numbers=self.numbers[kept], left_out=left_out, words=words)

    def _without_result(self, scene: Scene) -> list[LeftOut]:
        """The launches that lack one of the results, and which."""
        computed = self._computed(scene, (), np.empty((1, 0)))[0]
        lacking = [
            (row, [name for name, value in zip(self.measured, results, strict=True) if not isfinite(value)])
            for row, results in zip(self.numbers.tolist(), computed.tolist(), strict=True)
        ]
        return [LeftOut(row, f"{scene.title} has no {names[0]} for this launch") for row, names in lacking if names]

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
        found = columns_at(scene, [*keys, *self.given], points, asked=tuple(self.measured))
        results = np.array([found.facts[name] for name in self.measured], dtype=float)  # None is not a number
        return results.T.reshape(len(values), self.count, -1)

    def points(self, scene: Scene, free: Sequence[float]) -> Points | None:
        """Return None, since there are no places."""
        return None

    def remarks(self, scene: Scene, free: Sequence[float]) -> tuple[str, ...]:
        """Sentences on how the table was read, and on what is taken as exact."""
        return (*self.notes, f"the launches are taken as measured: {', '.join(self.given)}")


def launches(scene: Scene, found: Mapped, strict: bool = False) -> Launches:
    """The launches of a table, without those that have no such result in the scene. Raises RequestError; with
    ``strict`` also for a launch without one."""
    found.check_both()
    every = Launches(
        {key: one.values for key, one in found.given.items()},
        {key: one.values for key, one in found.measured.items()},
        np.array(found.rows),
        tuple(one.unit for one in found.measured.values()),
        found.notes,
        found.table.where,
        found.left_out,
        found.unused,
        _words(found),
    )
    return every if strict else every.that_fly(scene)


def _words(found: Mapped) -> dict[str, np.ndarray]:
    """The columns that make groups of launches, such as the club, the player or the day: a few words, none of them
    alone."""
    columns: dict[str, np.ndarray] = {}
    for column in found.table.columns:
        cells = np.array([column.cells[row - 1].strip() for row in found.rows])
        counts = np.unique(cells, return_counts=True)[1]
        if column.name in found.unused and _FEWEST_GROUPS <= len(counts) <= len(cells) / _FEWEST_IN_GROUP:
            columns[column.name] = cells
    return columns
