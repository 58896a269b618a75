"""The plan of a sweep: its points, and the row of a run at each of them."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from sandbox.engine.many.batch_forces import why_alone
from sandbox.engine.many.flown import COUNTS
from sandbox.errors import RequestError
from sandbox.lab.axes import MOST_POINTS, Axis, Normal, Span, Values
from sandbox.lab.provenance import Provenance, provenance
from sandbox.lab.runs import columns_at, fly_together, runs
from sandbox.scene import Scene, errors_of
from sandbox.tracebacks import one_line_error

if TYPE_CHECKING:
    from sandbox.scene.scene_run import SceneRun

#: Columns of a run's cost in a sweep: counts only, since times differ from run to run.
FLAGS = ("impacts", "steps", "refined_steps")

#: The column of a checked sweep that lists the results that a finer run changes.
CHANGED = "depends_on_accuracy"

#: Random points are drawn in blocks of this size, each with its own seed, so that any point is available directly.
_BLOCK = 1024

#: Points computed together: more are faster, fewer give earlier results. The number must not depend on the workers, as
#: the last digits of a shot depend on how many are computed with it.
_SMALLEST_BLOCK, _LARGEST_BLOCK = 32, 2560

#: Most evaluations of the forces in a block, about a second: a sweep that is interrupted loses what is not yet a row.
_WORK = 1_200_000

#: One run as a row: swept parameters, results, flags, and ``error``, which is empty if the run was completed.
Record = dict[str, Any]


@dataclass(frozen=True)
class Plan:
    """All points of a sweep: the grid of the axes' values, last axis fastest; ``samples`` points at random; or, if the
    points are ``listed``, the first values of all axes, the second ones, and so on."""

    scene: Scene
    axes: tuple[Axis, ...]
    samples: int = 0  # 0 for points that are not drawn
    seed: int = 0
    check: bool = False  # whether each run is repeated at a finer accuracy
    listed: bool = False  # whether the axes have a value for each point, in order
    facts: tuple[str, ...] = ()  # of each row; by default all but how a run ends

    def __post_init__(self) -> None:
        if not self.axes:
            raise RequestError("nothing to sweep over: name at least one parameter")
        if self.samples < 0 or self.seed < 0:
            raise RequestError(f"samples = {self.samples}, seed = {self.seed}: must not be less than 0")
        keys = [axis.key for axis in self.axes]
        for key in keys:
            if keys.count(key) > 1:
                raise RequestError(f"{key} is swept over twice")
        for axis in self.axes:
            if isinstance(axis, Normal) and not self.samples:
                raise RequestError(f"--over {axis.key}={axis.mean:g}~{axis.sd:g}: a distribution needs --samples")
            if isinstance(axis, Span) and not self.samples:
                raise RequestError(
                    f"--over {axis.key}={axis.low:g}:{axis.high:g}: a grid needs the number of points, "
                    f"{axis.low:g}:{axis.high:g}:N; or use --samples for random points"
                )
        if self.size > MOST_POINTS:
            raise RequestError(f"{self.size:,} points are too many; the limit is {MOST_POINTS:,}")

    @property
    def keys(self) -> list[str]:
        """The swept parameters."""
        return [axis.key for axis in self.axes]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each axis; one length for points that are no grid."""
        if self.samples:
            return (self.samples,)
        lengths = tuple(len(axis.values) for axis in self.axes if isinstance(axis, Values))
        return lengths[:1] if self.listed else lengths

    @property
    def is_grid(self) -> bool:
        """True if the points are a grid."""
        return not (self.samples or self.listed)

    @property
    def size(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    @cached_property
    def facts_read(self) -> list[str]:
        """The facts of each row."""
        return list(self.facts) or self.scene.facts_except_ended

    @cached_property
    def block(self) -> int:
        """Number of points computed together: 1 if shots are computed one at a time, or the first one takes long."""
        first = next(self.points(0, 1))
        if not fly_together(self.scene, self.keys, first):
            return 1
        run = self._first_run()
        cost = 1 if isinstance(run, Exception) else run.numerics.force_evaluations
        most = min(_LARGEST_BLOCK, _WORK // max(cost, 1))
        if most < _SMALLEST_BLOCK:
            return 1
        blocks = -(-self.size // most)
        return max(_SMALLEST_BLOCK, -(-self.size // blocks))

    @cached_property
    def columns(self) -> list[str]:
        """The columns of a table of all rows. A checked sweep has an error for what is a number in its first run."""
        names = [*self.keys, *self.facts_read, "ended", *FLAGS]
        if self.check:
            run = self._first_run()
            known, (numbers, _) = (
                ({}, ({}, ())) if isinstance(run, Exception) else (run.result, errors_of(run.result, run.result))
            )
            names += [f"{key}_error" for key in self.facts_read if key in numbers or known.get(key) is None]
            names.append(CHANGED)
        return [*dict.fromkeys(names), "error"]

    def _first_run(self) -> SceneRun | Exception:  # not kept: a plan is sent to workers, and not every run can be
        return next(runs(self.scene, self.keys, list(self.points(0, 1)), asked=self.facts_read))

    def why_alone(self) -> str:
        """Return why shots that could be computed together ran one by one; "" if they need to, or did not."""
        run = self._first_run() if self.block > 1 else None
        return "" if run is None or isinstance(run, Exception) else why_alone(run.setup)

    def points(self, start: int, stop: int) -> Iterator[tuple[Any, ...]]:
        """The swept values of the points from ``start`` up to ``stop``."""
        if self.samples:
            return self._random(start, stop)
        if self.listed:
            return zip(*(axis.values[start:stop] for axis in self.axes if isinstance(axis, Values)), strict=True)
        return (tuple(self._on_grid(number)) for number in range(start, stop))

    def _on_grid(self, number: int) -> list[Any]:
        values = []
        for axis in reversed(self.axes):
            assert isinstance(axis, Values)  # a grid has no spans
            number, place = divmod(number, len(axis.values))
            values.append(axis.values[place])
        return values[::-1]

    def _random(self, start: int, stop: int) -> Iterator[tuple[Any, ...]]:
        for block in range(start // _BLOCK, -(-stop // _BLOCK)):
            shares = np.random.default_rng((self.seed, block)).random((_BLOCK, len(self.axes)))
            first = block * _BLOCK
            for row in shares[max(start - first, 0) : stop - first].tolist():
                yield tuple(_drawn(axis, share) for axis, share in zip(self.axes, row, strict=True))

    @cached_property
    def provenance(self) -> Provenance:
        """All that the rows depend on apart from this plan."""
        return provenance(self.scene)

    @cached_property
    def fingerprint(self) -> str:
        """Two sweeps with the same fingerprint have the same rows: same scene, same points, same code."""
        told = {
            "scene": self.scene.name,
            "provenance": self.provenance.parts,
            "parameters": self.scene.parameters.model_dump(),
            "axes": [asdict(axis) for axis in self.axes],
            "samples": self.samples,
            "seed": self.seed,
            "check": self.check,
            "listed": self.listed,
            "facts": self.facts,
        }
        return hashlib.sha256(json.dumps(told, sort_keys=True, default=str).encode()).hexdigest()


def _drawn(axis: Axis, share: float) -> Any:
    if isinstance(axis, Span):
        return axis.low + share * (axis.high - axis.low)
    if isinstance(axis, Normal):
        return axis.value(share)
    return axis.values[int(share * len(axis.values))]


# ---------------------------------------------------------------------------------------------------------------------
# Rows
# ---------------------------------------------------------------------------------------------------------------------


class Rows(Sequence[Record]):
    """Rows of a sweep, kept as columns: values by name, None where a row has no such value."""

    def __init__(self, columns: Mapping[str, Sequence[Any]]) -> None:
        self.columns = columns  # one is ``error``

    @classmethod
    def of(cls, rows: Sequence[Record]) -> Rows:
        """The same rows as columns."""
        names = dict.fromkeys(name for row in rows for name in row)
        return cls({name: [row.get(name) for row in rows] for name in names})

    @classmethod
    def joined(cls, parts: Sequence[Rows]) -> Rows:
        """The rows of all parts."""
        names = dict.fromkeys(name for part in parts for name in part.columns)
        return cls({name: [*chain(*(part.column(name) for part in parts))] for name in names})

    def column(self, name: str) -> Sequence[Any]:
        """The values of a column; None in each row without it."""
        return self.columns.get(name) or [None] * len(self)

    def __len__(self) -> int:
        return len(self.columns["error"])

    def __getitem__(self, place: Any) -> Any:
        """One row, in which a point that failed has only its values and the error; of a slice rows."""
        if isinstance(place, slice):
            return Rows({name: values[place] for name, values in self.columns.items()})
        row = {name: values[place] for name, values in self.columns.items()}
        return {name: value for name, value in row.items() if value is not None} if row["error"] else row


def records(plan: Plan, start: int, stop: int, alone: bool = False) -> Rows:
    """The rows of the points from ``start`` up to ``stop``. A point that fails is a row with its error.

    Points are always computed in whole blocks, so that a row has the same digits on every worker with the same kind of
    processor; ``alone`` computes only the requested points.
    """
    if alone:
        return _rows(plan, start, stop)
    parts = []
    while start < stop:
        first = start - start % plan.block
        last = min(first + plan.block, plan.size)
        part = _rows(plan, first, last)
        parts.append(part[start - first : stop - first])
        start = last
    return Rows.joined(parts)


def _rows(plan: Plan, start: int, stop: int) -> Rows:
    points = list(plan.points(start, stop))
    found = columns_at(plan.scene, plan.keys, points, asked=plan.facts_read)
    swept = dict(zip(plan.keys, zip(*points, strict=True), strict=True))
    columns: dict[str, Sequence[Any]] = {**swept, **found.facts, "ended": [ended or None for ended in found.ended]}
    for flag in FLAGS:
        counts = columns[flag] = found.counts[:, COUNTS.index(flag)].tolist()
        for place in found.errors:
            counts[place] = None
    if plan.check:
        finer = columns_at(plan.scene, plan.keys, points, finer=True, asked=plan.facts_read)
        both = enumerate(zip(found.results(), finer.results(), strict=True))
        checks = [{} if one is None else _accuracy(one, other, finer.errors.get(place)) for place, (one, other) in both]
        columns |= Rows.of(checks).columns
    failed = {place: one_line_error(error) for place, error in found.errors.items()}
    return Rows({**columns, "error": [failed.get(place, "") for place in range(len(points))]})


def _accuracy(result: Mapping[str, Any], finer: Mapping[str, Any] | None, failed: Exception | None) -> Record:
    """The estimated error of each number of a result, and which others depend on the accuracy; or why the finer run
    failed."""
    if finer is None:
        return {CHANGED: "" if failed is None else f"a finer run fails: {one_line_error(failed)}"}
    errors, changed = errors_of(result, finer)
    numbers = [name for name, value in result.items() if name in errors or value is None]
    return {f"{name}_error": errors.get(name) for name in numbers} | {CHANGED: " ".join(changed)}
