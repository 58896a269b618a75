"""Runs of a scene with other values, written shortly."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import sandbox
from sandbox.scene.scene_run import SceneRun


def run_of(source: str, changes: Mapping[str, Any] | None = None) -> SceneRun:
    """The run of a scene or preset: computed once in a process, for all tests that only look at it."""
    return _computed(source, json.dumps(changes))


@cache
def _computed(source: str, changes: str) -> SceneRun:
    return sandbox.simulate(sandbox.load(source, json.loads(changes)))


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
