"""How far a result is to be trusted: a second run, finer, and where the two differ."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox.scene.finding import as_scene
from sandbox.scene.running import simulate, simulate_at
from sandbox.scene.scene import Scene

if TYPE_CHECKING:
    from sandbox.engine.run import Run


@dataclass(frozen=True)
class Check:
    """How far a result is to be trusted, by a second run at a finer accuracy."""

    finer: Run
    errors: dict[str, float] = field(default_factory=dict)  # estimated, for each number of the result, in its unit
    changed: dict[str, tuple[Any, Any]] = field(default_factory=dict)  # what else differs: in the run, in the finer one


def check(scene: Scene | str | Path, run: Run | None = None) -> Check:
    """Estimate the errors of the scene's result: run it again, finer, and compare."""
    chosen = as_scene(scene)
    run = run or simulate(chosen)
    return compare(run, simulate_at(chosen, run.accuracy.finer()))


def compare(run: Run, finer: Run) -> Check:
    """The estimated errors of a run's result, by those of a finer run of the same scene."""
    outcome = Check(finer)
    for name, value in run.result.items():
        other = outcome.finer.result.get(name)
        form, numbers = _taken_apart(value)
        other_form, other_numbers = _taken_apart(other)
        if form != other_form:
            outcome.changed[name] = (value, other)
        elif numbers:
            outcome.errors[name] = max(abs(a - b) for a, b in zip(numbers, other_numbers, strict=True))
    return outcome


def _taken_apart(value: Any) -> tuple[Any, list[float]]:
    """The form of a value with its numbers left out, and those numbers in order."""
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float, [float(value)]
    if isinstance(value, Mapping):
        items, forms = list(value.values()), list(value)
    elif isinstance(value, list | tuple):
        items, forms = list(value), []
    else:
        return value if value == value else None, []  # NaN is a result that is not there
    parts = [_taken_apart(item) for item in items]
    return [*forms, *(form for form, _ in parts)], [number for _, numbers in parts for number in numbers]
