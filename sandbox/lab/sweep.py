"""Sweeps: one run for each point of a grid, or of a random sample, on all cores or on a cluster."""

from __future__ import annotations

import pickle
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from sandbox.errors import RequestError, Stopped
from sandbox.lab.axes import Values, as_axis
from sandbox.lab.plan import Plan, Record, failed, records
from sandbox.lab.row_file import RowFile
from sandbox.scene import Scene, as_scene
from sandbox.workers import Call, Cluster, InTurn, Processes, Workers, cores

#: Time in s that one call to a worker should take: progress is seen, and Ctrl-C obeyed, a few times a second.
_CALL = 0.3

#: Most points in one call.
_MOST = 1_000

#: Calls that wait for each one that is computed, so that no worker idles; more would only cost memory.
_AHEAD = 3

#: Times that points are given to another worker when theirs goes away, before they are taken to be the reason.
_TRIES = 3

#: Shots that fly together and are no more than this are done before another process has started.
_FEW = 200

Progress = Callable[[int, int], None]


def _silent(done: int, total: int) -> None:
    pass


# ---------------------------------------------------------------------------------------------------------------------
# From Python
# ---------------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Sweep:
    """What a sweep found.

    ``sweep["carry"]`` is an array in the shape of the grid, ``sweep.columns`` a dictionary of flat arrays (for
    ``pandas.DataFrame``), ``sweep.records`` a list of dictionaries. Missing numbers are NaN in arrays.
    """

    plan: Plan
    records: list[Record]

    def __repr__(self) -> str:
        return f"<Sweep of {self.plan.scene.title}: {len(self.records):,} points over {', '.join(self.plan.keys)}>"

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
        values = [record.get(name) for record in self.records]
        if all(isinstance(value, bool) for value in values):
            return np.array(values)
        if all(value is None or (isinstance(value, int | float) and not isinstance(value, bool)) for value in values):
            return np.array([np.nan if value is None else float(value) for value in values])
        column = np.empty(len(values), dtype=object)
        column[:] = values
        return column


def sweep(
    scene: Scene | str | Path,
    over: Mapping[str, Any],
    *,
    samples: int = 0,
    seed: int = 0,
    check: bool = False,
    jobs: int = 1,
    scheduler: str | None = None,
    progress: Progress = _silent,
) -> Sweep:
    """One run for each point: ``sweep("golf", {"launch.angle": np.linspace(5, 60, 56), "launch.spin": [0, 3000]})``.

    ``over`` has the values of each parameter, in its declared unit or as strings with one; a pair such as
    ``(60.0, 80.0)`` is a range from which ``samples`` random points are drawn, all the same for the same ``seed``.
    ``check`` repeats each run finer and adds estimated errors. ``jobs`` above 1 uses so many processes (the calling
    script then needs ``if __name__ == "__main__":``), ``scheduler`` the workers of a Dask scheduler.
    """
    chosen = as_scene(scene)
    axes = tuple(as_axis(chosen, key, given) for key, given in over.items())
    plan = Plan(chosen, axes, samples, seed, check)
    found: list[Record] = []
    with workers(jobs, scheduler) as staff:
        for rows in swept(plan, staff, progress=progress):
            found += rows
    return Sweep(plan, found)


# ---------------------------------------------------------------------------------------------------------------------
# Into a file
# ---------------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Written:
    """What a sweep into a file came to."""

    points: int
    resumed: int  # points that were there already
    failures: int  # among the new points
    first_error: str
    seconds: float  # for the new points
    before: Path | None = None  # where the rows are that were in the file, of another sweep

    def as_text(self) -> str:
        """How many points, how fast, what went wrong, and what was there before."""
        new = self.points - self.resumed
        before = f", {self.resumed:,} of them before" if self.resumed else ""
        points = "1 point" if self.points == 1 else f"{self.points:,} points"
        lines = [f"{points}{before}; {new:,} in {self.seconds:.1f} s, {new / self.seconds:,.0f}/s"]
        if self.failures:
            lines.append(f"{self.failures:,} failed, first with: {self.first_error}")
        if self.before is not None:
            lines.append(f"the rows that were there before are in {self.before}")
        return "\n".join(lines)


def sweep_to_file(plan: Plan, path: Path, staff: Workers, progress: Progress = _silent) -> Written:
    """All rows of the plan as CSV, from where an interrupted sweep into the same file stopped.

    Raises Stopped on Ctrl-C, and RunError where the file cannot be written to its end; both keep what is done.
    """
    failures, first_error, began = 0, "", perf_counter()
    with RowFile(path, plan.fingerprint) as file:
        resumed = file.done
        try:
            for rows in swept(plan, staff, resumed, progress):
                file.append(rows)
                errors = [row["error"] for row in rows if row["error"]]
                failures += len(errors)
                first_error = first_error or "".join(errors[:1])
        except KeyboardInterrupt:
            kept = f"{file.done:,} of {plan.size:,} points are kept in {path}"
            raise Stopped(f"stopped: {kept}; the same command goes on from there") from None
        file.finish()
    before = file.before if file.before.is_file() else None
    return Written(plan.size, resumed, failures, first_error, perf_counter() - began, before)


# ---------------------------------------------------------------------------------------------------------------------
# Handing out the work
# ---------------------------------------------------------------------------------------------------------------------


def jobs_that_pay(plan: Plan) -> int:
    """One process for each core; but one alone where shots fly together and are done before another has started."""
    return 1 if plan.block > 1 and plan.size <= _FEW else min(cores(), plan.size)


@contextmanager
def workers(jobs: int, scheduler: str | None = None) -> Iterator[Workers]:
    """Whoever is asked for; dismissed at the end, in the middle of their work if need be."""
    if jobs < 1:
        raise RequestError(f"--jobs {jobs}: at least one is needed")
    staff: Workers = Cluster(scheduler) if scheduler is not None else InTurn() if jobs == 1 else Processes(jobs)
    try:
        yield staff
    except BaseException:
        staff.close(abandon=True)
        raise
    staff.close(abandon=False)


def swept(plan: Plan, staff: Workers, first: int = 0, progress: Progress = _silent) -> Iterator[list[Record]]:
    """The rows of all points from ``first`` on, in order, a few at a time."""
    payload = pickle.dumps(plan)
    pace = _Pace(plan, staff.width)
    waiting: deque[tuple[int, int, Call]] = deque()
    following = first
    progress(first, plan.size)
    while following < plan.size or waiting:
        while following < plan.size and len(waiting) < _AHEAD * staff.width:
            stop = min(plan.size, following - following % plan.block + pace.points)
            waiting.append((following, stop, staff.submit(_computed, payload, following, stop)))
            following = stop
        start, stop, call = waiting.popleft()
        rows, seconds = _result(plan, payload, staff, start, stop, call)
        pace.note(stop - start, seconds)
        yield rows
        progress(stop, plan.size)


def _result(plan: Plan, payload: bytes, staff: Workers, start: int, stop: int, call: Call, alone: bool = False) -> Any:
    """What a call gives. One whose worker went away is repeated; in the end point by point, each alone, so that none
    suffers for others."""
    for _ in range(_TRIES):
        try:
            return call.result()
        except Exception as error:
            if not staff.lost(error):
                raise
        call = staff.submit(_computed, payload, start, stop, alone)
    if stop - start == 1:
        return failed(plan, start, stop, f"the process that ran it was killed {_TRIES} times: out of memory?"), 0.0
    found: list[Record] = []
    for number in range(start, stop):
        one = staff.submit(_computed, payload, number, number + 1, True)
        found += _result(plan, payload, staff, number, number + 1, one, alone=True)[0]
    return found, 0.0


class _Pace:
    """How many points to hand out at once: whole blocks, in calls that take about ``_CALL`` s."""

    def __init__(self, plan: Plan, width: int) -> None:
        self._block = plan.block
        self._most = max(self._block, min(_MOST, -(-plan.size // (_AHEAD * width))))
        self.points = self._block

    def note(self, points: int, seconds: float) -> None:
        """A call that computed so many points took so long."""
        fitting = int(min(points * _CALL / max(seconds, 1e-6), 4 * self.points, self._most))
        self.points = max(self._block, fitting - fitting % self._block)


def _computed(payload: bytes, start: int, stop: int, alone: bool = False) -> tuple[list[Record], float]:
    """The rows of some points, and how long they took in s; in whatever process this is."""
    began = perf_counter()
    rows = records(_plan(payload), start, stop, alone)
    return rows, perf_counter() - began


@lru_cache(maxsize=2)
def _plan(payload: bytes) -> Plan:
    plan = pickle.loads(payload)
    assert isinstance(plan, Plan)
    return plan
