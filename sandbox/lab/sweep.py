"""Sweeps: one run for each point of a grid, or of a random sample, on all cores or on a cluster."""

from __future__ import annotations

import pickle
import platform
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from time import perf_counter
from typing import Any
from uuid import uuid4

import numpy as np

from sandbox import display
from sandbox.errors import RequestError, RunError, Stopped
from sandbox.lab.axes import Values, as_axis
from sandbox.lab.chart import image
from sandbox.lab.many import as_array
from sandbox.lab.maps import chart_of, check_plot, read
from sandbox.lab.plan import Plan, Record, Rows, records
from sandbox.lab.report import Chart, Notes, Report
from sandbox.lab.row_file import RowFile, cell
from sandbox.lab.runs import Progress, no_progress
from sandbox.scene import Scene, as_scene
from sandbox.text import check_mapping, with_noun
from sandbox.workers import Call, Cluster, InTurn, Processes, WorkerLost, Workers, cores

#: Target time in s of one call to a worker, so that progress is shown and Ctrl-C handled a few times a second.
CALL = 0.3

#: Most points in one call.
_MOST = 1_000

#: Calls queued for each one being computed, so that no worker is idle; more would only cost memory.
_QUEUED = 3

#: Times that points are retried when their worker dies, before the points are taken to be the cause.
_TRIES = 3

#: Up to this many shots, or a single block of shots, finish about when another process would have started.
_ONE_PROCESS = 200

#: Most processes.
_MOST_JOBS = 1000

#: Identifies this process.
_HERE = uuid4().hex

# ---------------------------------------------------------------------------------------------------------------------
# From Python
# ---------------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Sweep(display.Reported):
    """The rows of a sweep.

    ``sweep["carry"]`` is an array in the shape of the grid, ``sweep.columns`` a dictionary of flat arrays (for
    ``pandas.DataFrame``), ``sweep.records`` a list of dictionaries. Missing numbers are NaN in arrays.

    >>> import sandbox
    >>> found = sandbox.sweep("golf", {"launch.angle": [8, 10, 12]})
    >>> found["carry"].shape, len(found.records)
    ((3,), 3)
    """

    plan: Plan
    records: list[Record]

    def __repr__(self) -> str:
        return f"<Sweep of {self.plan.scene.title}: {len(self.records):,} points over {', '.join(self.plan.keys)}>"

    def report(self, of: str | None = None) -> Report:
        """The map or the curves of one result (``of``, by default the verdict or the first)."""
        check_plot(self.plan, of)
        rows = [{name: cell(record.get(name)) for name in self.plan.columns} for record in self.records]
        return Report(lambda: self.records, repr(self), [chart_of(self.plan, read(self.plan, rows, of))])

    def plot(self, path: Path | str | None = None, of: str | None = None) -> Any:
        """The map or the curves of one result (``of``, by default the verdict or the first): written to ``path`` (a
        PNG), or without one handed back as a Pillow image."""
        return image(self.report(of), path)

    def _repr_html_(self) -> str:
        try:
            report = self.report()
        except RequestError as error:  # it cannot be drawn
            report = Report(lambda: self.records, repr(self), [Notes([str(error)])])
        return display.notebook().report_html(report)

    @property
    def axes(self) -> dict[str, np.ndarray]:
        """The values along each axis of a grid."""
        return {axis.key: np.array(axis.values) for axis in self.plan.axes if isinstance(axis, Values)}

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """All columns, flat: swept parameters, results, flags and errors."""
        names = dict.fromkeys(name for record in self.records for name in record)
        return {name: self._column(name) for name in names}

    def __getitem__(self, name: str) -> np.ndarray:
        """One column in the shape of the grid."""
        if not any(name in record for record in self.records):
            raise KeyError(name)
        return self._column(name).reshape(self.plan.shape)

    def _column(self, name: str) -> np.ndarray:
        return as_array([record.get(name) for record in self.records])


def sweep(
    scene: Scene | str | Path,
    over: Mapping[str, Any],
    *,
    samples: int = 0,
    seed: int = 0,
    check: bool = False,
    jobs: int = 1,
    scheduler: str | None = None,
    progress: Progress = no_progress,
) -> Sweep:
    """One run for each point: ``sweep("golf", {"launch.angle": np.linspace(5, 60, 56), "launch.spin": [0, 3000]})``.

    ``over`` gives the values of each parameter, in its declared unit or as strings with a unit; a pair such as
    ``(60.0, 80.0)`` is a range from which ``samples`` random points are drawn, the same for the same ``seed``;
    ``"70~1.5"`` is a normal distribution, with its mean and standard deviation. Points that are no grid, and not drawn
    at random, are for ``sandbox.simulate_many``.
    ``check`` repeats each run at finer accuracy and adds estimated errors. ``jobs`` above 1 uses that many processes
    (the calling script then needs ``if __name__ == "__main__":``), ``scheduler`` the workers of a Dask scheduler.

    >>> import sandbox
    >>> sandbox.sweep("golf", {"launch.angle": [8, 10], "launch.spin": [2000, 2500, 3000]})["carry"].shape
    (2, 3)
    """
    chosen = as_scene(scene)
    check_mapping("over", over, '{"launch.angle": [10, 20, 30]}')
    axes = tuple(as_axis(chosen, key, given) for key, given in over.items())
    plan = Plan(chosen, axes, samples, seed, check)
    found: list[Record] = []
    with workers(jobs, scheduler) as pool:
        for rows in RowsInOrder(plan, pool, progress=progress):
            found += rows
    return Sweep(plan, found)


# ---------------------------------------------------------------------------------------------------------------------
# Into a file
# ---------------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SweepSummary:
    """The outcome of a sweep written to a file."""

    points: int
    resumed: int  # points already in the file
    failures: int  # among the new points
    first_error: str
    seconds: float  # for the new points
    damaged: int | None = None  # the first damaged row, from which rows were computed again
    before: Path | None = None  # backup of the file's previous content, if from another sweep
    alone: str = ""  # why its shots ran one by one, if they need not

    def report(self, charts: Sequence[Chart] = (), said: Sequence[str] = ()) -> Report:
        """Number of points, speed, failures, the file's previous content, and what is said of the points."""
        new = self.points - self.resumed
        before = f", {self.resumed:,} already in the file" if self.resumed else ""
        title = (
            f"{with_noun(self.points, 'point')}{before}; {new:,} in {self.seconds:.1f} s, {new / self.seconds:,.0f}/s"
        )
        if not new:
            title = f"{with_noun(self.points, 'point')}, all already in the file: the sweep is complete"
        notes = [self.alone] if self.alone else []
        if self.failures:
            notes.append(f"{self.failures:,} failed, first with: {self.first_error}")
        if self.damaged is not None:
            notes.append(f"row {self.damaged:,} was damaged: computed again, with all rows after it")
        if self.before is not None:
            notes.append(f"the previous rows are in {self.before}")
        document = {**vars(self), "before": None if self.before is None else str(self.before)}
        return Report(lambda: document, title, [Notes([*(notes if new else []), *said]), *charts])


def sweep_to_file(plan: Plan, path: Path, pool: Workers, progress: Progress = no_progress) -> SweepSummary:
    """Write all rows of the plan as CSV, resuming an interrupted sweep in the same file.

    Raises Stopped on Ctrl-C, and RunError if the file cannot be written completely; both keep the rows done so far.
    """
    failures, first_error, began = 0, "", perf_counter()
    with RowFile(path, plan) as file:
        resumed = file.done
        handout = RowsInOrder(plan, pool, resumed, progress)
        try:
            for rows in handout:
                file.append(rows)
                errors = [*filter(None, rows.columns["error"])]
                failures += len(errors)
                first_error = first_error or "".join(errors[:1])
        except KeyboardInterrupt:
            with suppress(KeyboardInterrupt):  # a second one: what is written is kept, and said
                for rows in handout.finished(file.done):
                    file.append(rows)
            kept = f"{file.done:,} of {plan.size:,} points are kept in {path}"
            raise Stopped(f"stopped: {kept}; run the same command to resume") from None
        file.finish()
    before = file.before if file.before.is_file() else None
    seconds = perf_counter() - began
    return SweepSummary(plan.size, resumed, failures, first_error, seconds, file.damaged, before, plan.why_alone())


# ---------------------------------------------------------------------------------------------------------------------
# Distributing the work
# ---------------------------------------------------------------------------------------------------------------------


def worthwhile_jobs(plan: Plan) -> int:
    """One process per core, or a single one if shots computed together finish before another has started."""
    return 1 if plan.block > 1 and plan.size <= max(_ONE_PROCESS, plan.block) else min(cores(), plan.size)


@contextmanager
def workers(jobs: int, scheduler: str | None = None) -> Iterator[Workers]:
    """The requested workers; closed at the end, even in the middle of a call."""
    if not 1 <= jobs <= _MOST_JOBS:
        raise RequestError(f"--jobs {jobs}: must be from 1 to {_MOST_JOBS}")
    pool: Workers = Cluster(scheduler) if scheduler is not None else InTurn() if jobs == 1 else Processes(jobs)
    try:
        yield pool
    except BaseException:
        pool.close(abandon=True)
        raise
    pool.close(abandon=False)


class RowsInOrder:
    """Iterator over the rows of all points from ``first``, in order, a few at a time.

    A call returns the points it computed in a short time; the rest is queued again.
    """

    def __init__(self, plan: Plan, pool: Workers, first: int = 0, progress: Progress = no_progress) -> None:
        self._plan = plan
        self._pool = pool
        self._progress = progress
        self._payload = pickle.dumps((_HERE, plan.provenance, pickle.dumps(plan)))
        self._points = plan.block  # in a call: whole blocks that take about CALL s
        self._most = max(plan.block, min(_MOST, -(-plan.size // (_QUEUED * pool.width))))
        self._waiting: deque[tuple[int, int, Call]] = deque()
        self._following = first
        self._reached = first
        progress(first, plan.size)

    def __iter__(self) -> Iterator[Rows]:
        while self._reached < self._plan.size:
            self._queue_calls()
            yield self._next()

    def finished(self, first: int) -> Iterator[Rows]:
        """The rows already computed, in order from ``first``, without waiting."""
        while self._waiting and self._waiting[0][0] == first and self._waiting[0][2].done():
            start, _, call = self._waiting.popleft()
            rows, _ = call.result()
            first = start + len(rows)
            yield rows

    def _queue_calls(self) -> None:
        plan = self._plan
        while self._following < plan.size and len(self._waiting) < _QUEUED * self._pool.width:
            start = self._following
            stop = min(plan.size, start - start % plan.block + self._points)
            self._waiting.append((start, stop, self._submit(start, stop)))
            self._following = stop

    def _next(self) -> Rows:
        start, stop, call = self._waiting[0]
        rows, seconds = self._result(start, stop, call)
        self._waiting.popleft()
        self._reached = start + len(rows)
        if self._reached < stop:
            self._waiting.appendleft((self._reached, stop, self._submit(self._reached, stop)))
        fitting = int(min(len(rows) * CALL / max(seconds, 1e-6), 4 * self._points, self._most))
        self._points = max(self._plan.block, fitting - fitting % self._plan.block)
        self._progress(self._reached, self._plan.size)
        return rows

    def _submit(self, start: int, stop: int, alone: bool = False) -> Call:
        return self._pool.submit(_computed, self._payload, start, stop, alone)

    def _result(self, start: int, stop: int, call: Call, alone: bool = False) -> tuple[Rows, float]:
        """The result of a call. If its worker dies it is repeated, at last point by point, so that one point cannot
        spoil others."""
        for _ in range(_TRIES):
            try:
                found: tuple[Rows, float] = call.result()
                return found
            except WorkerLost:
                call = self._submit(start, stop, alone)
        if stop - start == 1:
            why = f"the process that ran it was killed {_TRIES} times: out of memory?"
            (values,) = self._plan.points(start, stop)
            return Rows.of([dict(zip(self._plan.keys, values, strict=True)) | {"error": why}]), 0.0
        rows: list[Record] = []
        for number in range(start, stop):
            one = self._submit(number, number + 1, alone=True)
            rows += self._result(number, number + 1, one, alone=True)[0]
        return Rows.of(rows), 0.0


def _computed(payload: bytes, start: int, stop: int, alone: bool = False) -> tuple[Rows, float]:
    """The rows of the points from ``start`` that fit in a call's time, at least one block, and their time in s; runs in
    the worker."""
    began = perf_counter()
    plan = _plan(payload)
    if alone:
        return records(plan, start, stop, alone), perf_counter() - began
    parts: list[Rows] = []
    while start < stop and (not parts or perf_counter() - began < CALL):
        parts.append(records(plan, start, min(stop, start - start % plan.block + plan.block)))
        start += len(parts[-1])
    return Rows.joined(parts), perf_counter() - began


@lru_cache(maxsize=2)
def _plan(payload: bytes) -> Plan:
    """The plan from its pickle. Raises RunError if code, scene or versions differ from those of the sender."""
    process, origin, plan = pickle.loads(payload)
    differences = origin.differences() if process != _HERE else []
    if differences:
        raise RunError(
            f"the worker on {platform.node() or 'another machine'} would compute different numbers; it differs in: "
            f"{', '.join(differences)}; restart it if that was changed since it started"
        )
    found = pickle.loads(plan)
    assert isinstance(found, Plan)
    return found
