"""What the process beside the window computes: drawing has the window's own for itself."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from sandbox.errors import RunError, SandboxError
from sandbox.lab.runs import runs
from sandbox.scene import Scene, load, simulate
from sandbox.window.recorded import plain
from sandbox.window.session import Shot


def warmed(source: str) -> None:
    """Import what runs of the scene need; a scene that will not do is told of where it is opened."""
    with suppress(Exception):
        load(source).build()


def predicted(scene: Scene) -> tuple[dict[str, Any], float]:
    """The record of a scene's run, and how long it took, in s. Raises SandboxError."""
    started = perf_counter()
    try:
        run = simulate(scene)
    except SandboxError:
        raise
    except Exception as error:  # a scene's own code, and maybe of a kind that the window's process does not know
        raise RunError(f"{type(error).__name__}: {error}") from None
    return plain(run), perf_counter() - started


class FanShot(NamedTuple):
    """What a fan shows of one of its shots."""

    points: np.ndarray  # shape (n, 3): t in s, x and y in m
    scored: bool
    value: float | None  # of what the scene tells of its shots


def varied(
    scene: Scene, keys: Sequence[str], points: Sequence[Sequence[float]], told: str | None
) -> tuple[list[FanShot | None], float]:
    """Shots with other values at the keys, None for one that fails, and how long they took, in s; ``told`` is the
    name of the result whose value is wanted."""
    started = perf_counter()
    found: list[FanShot | None] = []
    for run in runs(scene, keys, points):
        if isinstance(run, Exception):
            found.append(None)
            continue
        shot, value = Shot(scene, run), run.result.get(told) if told else None
        found.append(FanShot(shot.track(shot.ball), shot.scored, value if isinstance(value, float) else None))
    return found, perf_counter() - started
