"""Running a scene."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from sandbox.scene.scene import Scene, as_scene

if TYPE_CHECKING:
    from sandbox.engine.accuracy import Accuracy
    from sandbox.engine.run import Run
    from sandbox.engine.setup import Setup


Progress = Callable[[float, float], None]


def simulate(scene: Scene | str | Path, progress: Progress | None = None) -> Run:
    """Run the scene to its end at the accuracy that its parameters ask for; ``run.result`` holds its numbers.

    The plain method, which may take minutes, calls ``progress`` with the time simulated and its most, in s.
    """
    from sandbox.engine.accuracy import resolve

    chosen = as_scene(scene)
    return simulate_at(chosen, resolve(**chosen.parameters.accuracy.model_dump()), progress=progress)


def simulate_at(scene: Scene, accuracy: Accuracy, setup: Setup | None = None, progress: Progress | None = None) -> Run:
    """Run the scene at an accuracy; ``setup`` is a variation of the scene's own, to run in its place."""
    from sandbox.engine import simulate as run_setup

    run = run_setup(setup or scene.build(), accuracy, progress)
    run.scene = scene
    run.result = scene.result(run)
    return run
