"""Runs of a scene with other values, written shortly."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import sandbox
from sandbox.scene.scene_run import SceneRun
from sandbox.shots import run_of

__all__ = ["playing", "results_of", "run_of"]


def dotted(changes: Mapping[str, Any]) -> dict[str, Any]:
    """``launch__speed`` stands for launch.speed."""
    return {key.replace("__", "."): value for key, value in changes.items()}


def playing(name: str, **usual: Any) -> Callable[..., SceneRun]:
    """``kick = playing("soccer")``: ``kick(launch__speed=20)`` is a run with that launch.speed, and
    ``kick("soccer/dipping-free-kick")`` one of a preset."""
    return lambda source=name, **changes: sandbox.simulate(sandbox.load(source, dotted(usual | changes)))


def results_of(name: str) -> Callable[..., dict[str, Any]]:
    """The same with the result of the run alone."""
    play = playing(name)
    return lambda *source, **changes: play(*source, **changes).result
