"""Runs of one scene at any points: those of arrays, computed together."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.axes import Values, points_given
from sandbox.lab.mapped import choices_of
from sandbox.lab.plan import Plan
from sandbox.lab.points import points_from
from sandbox.lab.runs import Progress, columns_at, no_progress, runs
from sandbox.lab.selection import LeftOut
from sandbox.scene import Scene, as_scene
from sandbox.scene.scene_run import SceneRun
from sandbox.text import check_mapping, no_such_result
from sandbox.tracebacks import one_line_error


@dataclass(frozen=True)
class Runs:
    """The results of ``simulate_many``, in the order of the points.

    ``found["carry"]`` is an array of that fact, in its unit. What did not happen, or could not be computed, is NaN
    among numbers, else None; ``errors`` says why by the place of the point. ``runs`` has the runs, if they were kept.

    >>> import sandbox
    >>> found = sandbox.simulate_many("golf", {"launch.speed": [60.0, 70.0]}, facts=("carry",))
    >>> found["carry"].shape, found.errors
    ((2,), {})
    """

    scene: Scene
    points: Mapping[str, np.ndarray]  # the values of each parameter, in its declared unit
    facts: Mapping[str, np.ndarray]  # each in its unit, as in ``scene.units``
    errors: Mapping[int, str]  # one line for each point that failed
    runs: Sequence[SceneRun | None]  # None for one that failed; empty if they were not kept
    rows: tuple[int, ...] = ()  # of a table of shots, the first is 1, that are the points
    left_out: tuple[LeftOut, ...] = ()  # its rows that are not used, each with its reason

    def __len__(self) -> int:
        return len(next(iter(self.points.values())))

    def __getitem__(self, fact: str) -> np.ndarray:
        """The values of a fact. Raises RequestError if it was not asked for."""
        if fact not in self.facts:
            raise RequestError(f"{fact!r}: {no_such_result(str(fact), list(self.facts))}")
        return self.facts[fact]

    def __repr__(self) -> str:
        failed = f", {len(self.errors):,} failed" if self.errors else ""
        return f"<Runs of {self.scene.title}: {len(self):,} points over {', '.join(self.points)}{failed}>"


def simulate_many(
    scene: Scene | str | Path,
    points: Mapping[str, Any] | str | Path,
    facts: Sequence[str] = (),
    *,
    columns: Mapping[str, str] | None = None,
    where: Mapping[str, str] | Sequence[str] = (),
    without: Sequence[str] = (),
    strict: bool = False,
    paths: bool = False,
    progress: Progress = no_progress,
) -> Runs:
    """Run a scene at each of many points: ``simulate_many("golf", {"launch.speed": speeds, "launch.angle": angles})``.

    ``points`` gives the values of each parameter, one per point, in its declared unit or as strings with a unit: the
    first values of all are the first point. Or it is a table, with the parameters in its first line, or with shots as
    ``fit`` reads them: ``columns``, ``where``, ``without`` and ``strict`` are as there, and ``rows`` of the result are
    those of the table that are used. Similar shots are computed together, as arrays, with the results of
    ``simulate`` to rounding; the same points give the same digits.

    Only the ``facts`` that are named are read, by default all but how a run ends, and each run ends when these are
    final. ``paths`` keeps every run, to its end and with all facts, in ``runs``. ``progress`` is called with the number
    of points that are done, and of all.

    Raises RequestError for a value that a parameter cannot have, with the place of the point. A point that fails later
    is in ``errors``, and the others are computed.

    >>> import sandbox
    >>> found = sandbox.simulate_many(
    ...     "basketball", {"launch.speed": [7.0, 7.4, 9.0], "launch.angle": [50.0, 52.0, 45.0]}, facts=("made", "apex")
    ... )
    >>> found["made"].dtype, found["apex"].shape
    (dtype('bool'), (3,))
    """
    chosen, read = as_scene(scene), None
    wanted = _facts(chosen, facts)
    if isinstance(points, str | Path):
        axes, read = points_from(chosen, "points", Path(points), choices_of(columns, where, without, strict))
    else:
        check_mapping("points", points, '{"launch.angle": [10, 20, 30]}')
        axes = points_given(chosen, points)
    plan = Plan(chosen, axes, listed=True, facts=wanted)
    rows: dict[str, list[Any]] = {key: [] for key in plan.facts_read}
    kept: list[SceneRun | None] = []
    errors: dict[int, str] = {}
    for start in range(0, plan.size, plan.block):
        progress(start, plan.size)
        some = list(plan.points(start, start + plan.block))
        if paths:
            each = list(runs(chosen, plan.keys, some))
            kept += [run if isinstance(run, SceneRun) else None for run in each]
            failed = {place: run for place, run in enumerate(each) if isinstance(run, Exception)}
            results = [{} if isinstance(run, Exception) else run.result for run in each]
            found = {key: [result.get(key) for result in results] for key in rows}
        else:
            found, failed, *_ = columns_at(chosen, plan.keys, some, asked=plan.facts_read)
        for key, values in rows.items():
            values += found[key]
        errors |= {start + place: one_line_error(error) for place, error in failed.items()}
    progress(plan.size, plan.size)
    given = {axis.key: as_array(axis.values) for axis in plan.axes if isinstance(axis, Values)}
    found_facts = {key: as_array(values) for key, values in rows.items()}
    numbers, left_out = ((), ()) if read is None else (read.rows, read.left_out)
    return Runs(chosen, given, found_facts, errors, kept, numbers, left_out)


def _facts(scene: Scene, facts: Sequence[str]) -> tuple[str, ...]:
    """The facts that are asked for. Raises RequestError if the scene does not have one."""
    if isinstance(facts, str):
        raise RequestError(f'facts = {facts!r}: must be a tuple of names; write ("{facts}",)')
    if not isinstance(facts, Collection):
        raise RequestError(f"facts = {facts!r:.60}: must be a tuple of names")
    for name in facts:
        if not isinstance(name, str) or name not in scene.facts:
            raise RequestError(f"facts, {name!r}: {no_such_result(str(name), list(scene.facts))}")
    return tuple(dict.fromkeys(facts))


def as_array(values: Sequence[Any]) -> np.ndarray:
    """Values as an array: of numbers, with NaN for None; of true and false; or of objects."""
    kinds = {*map(type, values)}  # of a million values in an instant
    if all(issubclass(kind, bool) for kind in kinds):
        return np.array(values, dtype=bool)
    numbers = kinds - {type(None)}
    if all(issubclass(kind, int | float) and not issubclass(kind, bool) for kind in numbers):
        return np.array([np.nan if value is None else value for value in values] if numbers < kinds else values, float)
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column
