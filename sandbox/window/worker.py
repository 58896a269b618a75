"""What the window's worker process computes: scenes run there, so that drawing never waits for them."""

from __future__ import annotations

import traceback
from contextlib import suppress
from pathlib import Path
from time import perf_counter
from typing import Any

from sandbox.errors import RunError, SandboxError
from sandbox.scene import Scene, check, load, simulate
from sandbox.scene.modules import forget
from sandbox.window.replay import data_of


def warm_up(source: str) -> None:
    """Import what runs of the scene need; a scene that is invalid is reported where it is opened."""
    with suppress(Exception):
        load(source).build()


def reread(folder: Path) -> None:
    """Read the code of a scene from its files again."""
    forget(folder)


def computed(scene: Scene) -> tuple[dict[str, Any], float]:
    """The data of a scene's run, and how long it took, in s. Raises SandboxError."""
    started = perf_counter()
    try:
        run = simulate(scene)
    except SandboxError:
        raise
    except Exception as error:  # from a scene's own code, maybe of a class that the window's process cannot import
        raise RunError(described(error, scene.folder)) from None
    return data_of(run), perf_counter() - started


def described(error: Exception, folder: Path) -> str:
    """An error in a scene's own code on one line: the file and line in the scene's folder, and its message."""
    said = str(error) if isinstance(error, SandboxError) else f"{type(error).__name__}: {error}".rstrip(": ")
    if isinstance(error, SyntaxError) and error.filename:
        return f"{_short(error.filename)}, line {error.lineno}: {type(error).__name__}: {error.msg}"
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if Path(frame.filename).resolve().is_relative_to(folder.resolve())]
    return f"{_short(own[-1].filename)}, line {own[-1].lineno}: {said}" if own else said


def _short(file: str) -> str:
    """A path, relative to the current folder if it is in there."""
    path = Path(file).resolve()
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)


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
