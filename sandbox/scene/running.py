"""Running a scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from sandbox.scene.finding import as_scene
from sandbox.scene.scene import Scene

if TYPE_CHECKING:
    from sandbox.engine.accuracy import Accuracy
    from sandbox.engine.run import Run
    from sandbox.engine.setup import Setup


def simulate(scene: Scene | str | Path) -> Run:
    """Run the scene to its end at the accuracy that its parameters ask for; ``run.result`` holds its numbers."""
    from sandbox.engine.accuracy import resolve

    chosen = as_scene(scene)
    return simulate_at(chosen, resolve(**chosen.parameters.accuracy.model_dump()))


def simulate_at(scene: Scene, accuracy: Accuracy, setup: Setup | None = None) -> Run:
    """Run the scene at an accuracy; ``setup`` is a variation of the scene's own, to run in its place."""
    from sandbox.engine import simulate as run_setup

    run = run_setup(setup or scene.build(), accuracy)
    run.scene = scene
    run.result = scene.result(run)
    return run
