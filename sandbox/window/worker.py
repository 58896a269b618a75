"""What the window's worker process computes: scenes are built and run there, so that drawing never waits for them."""

from __future__ import annotations

import pickle
from contextlib import suppress
from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING, Any

from sandbox.errors import RunError, SandboxError
from sandbox.scene import Scene, check, load, simulate
from sandbox.tracebacks import one_line_error
from sandbox.window.replay import data_of, run_of

if TYPE_CHECKING:
    from sandbox.engine.run import Run

#: A run on its way to the window: pickled with its setup, or without, if that has functions that cannot be pickled.
Packed = bytes | dict[str, Any]


def warm_up(source: str) -> None:
    """Import the scene; one that is invalid is reported where it is opened."""
    with suppress(Exception):
        load(source)


def computed(scene: Scene) -> tuple[Packed, float]:
    """A scene's run, and how long it took, in s. Raises SandboxError: a RequestError if the scene cannot be built."""
    started = perf_counter()
    try:
        run = simulate(scene)
    except SandboxError:
        raise
    except Exception as error:  # from a scene's own code, maybe of a class that the window's process cannot import
        raise RunError(one_line_error(error)) from None
    took = perf_counter() - started
    try:
        return pickle.dumps(replace(run, scene=None)), took
    except Exception:  # such as a force that is a lambda
        return data_of(run), took


def unpacked(scene: Scene, packed: Packed) -> Run:
    """The run of a scene, as the worker sent it."""
    run: Run = run_of(scene, packed) if isinstance(packed, dict) else pickle.loads(packed)
    run.scene = scene
    return run


def cost_and_errors(scene: Scene) -> str:
    """What a run of the scene costs, and the errors of its results, in a line."""
    run = simulate(scene)
    checked = check(scene, run)
    units = scene.units
    errors = [f"{name} ± {error:.1g} {units.get(name, '')}" for name, error in checked.errors.items() if error > 0]
    changed = [f"{name} would be {finer}" for name, (_, finer) in checked.changed.items()]
    changed += [f"{name} is chaotic" for name in (*checked.chaotic, *checked.unsettled)]
    summary = ", ".join(text.strip() for text in changed or errors[:4]) or "the same in a finer run"
    return f"{1e3 * run.numerics.wall_s:.1f} ms a run; {summary.replace('_', ' ')}"
