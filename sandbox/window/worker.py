"""Work for the window's worker process: scenes are built and run there, so that drawing never waits for them."""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from contextlib import nullcontext, suppress
from pathlib import Path
from time import perf_counter
from typing import Any

from sandbox.errors import RunError, SandboxError
from sandbox.scene import Scene, check, load, simulate
from sandbox.scene.discovery import folder_of
from sandbox.scene.modules import read_again
from sandbox.scene.scene_run import SceneRun
from sandbox.tracebacks import one_line_error
from sandbox.window.replay import data_of, read, run_of

#: A run on its way to the window: pickled with its setup, or without, if that has functions that cannot be pickled.
Packed = bytes | dict[str, Any]


def started() -> None:
    """Do nothing: it is done once the process has begun to work."""


def warm_up(source: str) -> None:
    """Import the scene; one that is invalid is reported where it is opened."""
    with suppress(Exception):
        load(source)


def checked(source: str, changes: Mapping[str, Any], of: Path | None = None, code: bool = False) -> None:
    """Load a scene with its picture and build it, with the changes if they are ``of`` its folder; with ``code`` from
    its files as they are now. What never ends, does not end here. Raises SandboxError."""
    folder = folder_of(source)
    try:
        with read_again(folder) if code and folder is not None else nullcontext():
            scene = load(source)
            scene = scene.changed(changes, "the window's") if scene.folder == of else scene
            scene.picture_module()
            scene.build()
    except SandboxError:
        raise
    except Exception as error:
        raise RunError(one_line_error(error)) from None


def checked_replay(path: Path, scene: str | None, running: Path) -> None:
    """Read a replay as the window will. Raises SandboxError."""
    read(path, scene, running)


def computed(scene: Scene) -> tuple[Packed, float]:
    """A scene's run, and how long it took, in s. Raises SandboxError: a RequestError if the scene cannot be built."""
    started = perf_counter()
    try:
        run = simulate(scene)
        took = perf_counter() - started
        scene.verdict(run)  # its code runs here before it does in the window
    except SandboxError:
        raise
    except Exception as error:  # from a scene's own code, maybe of a class that the window's process cannot import
        raise RunError(one_line_error(error)) from None
    try:
        return pickle.dumps((run.data, run.result)), took
    except Exception:  # such as a force that is a lambda
        return data_of(run), took


def unpacked(scene: Scene, packed: Packed) -> SceneRun:
    """The run of a scene, as the worker sent it."""
    if isinstance(packed, dict):
        return run_of(scene, packed)
    run, result = pickle.loads(packed)
    return SceneRun.of(run, scene, result)


def cost_and_errors(scene: Scene) -> str:
    """The cost of a run of the scene and the errors of its results, in a line."""
    run = simulate(scene)
    checked = check(scene, run)
    units = scene.units
    errors = [f"{name} ± {error:.1g} {units.get(name, '')}" for name, error in checked.errors.items() if error > 0]
    changed = [f"{name} would be {finer}" for name, (_, finer) in checked.changed.items()]
    changed += [f"{name} is chaotic" for name in (*checked.chaotic, *checked.changed_by_nudge)]
    summary = ", ".join(text.strip() for text in changed or errors[:4]) or "the same in a finer run"
    return f"{1e3 * run.numerics.wall_s:.1f} ms a run; {summary.replace('_', ' ')}"
