"""A setup by itself as a scene: with no parameters but its accuracy, the facts of any run, and the plain picture."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from sandbox import display
from sandbox.parameters import Accuracy, SceneParameters
from sandbox.scene.scene import Scene
from sandbox.scene.scene_run import SceneRun

if TYPE_CHECKING:
    from sandbox.engine.model.setup import Setup
    from sandbox.engine.paths.run import Run


@dataclass(frozen=True)
class SetupScene(Scene):
    """The scene of one setup, in no folder."""

    setup: Setup = field(kw_only=True)

    @property
    def module(self) -> ModuleType:
        """A module that defines nothing."""
        return ModuleType("setup")

    @property
    def about(self) -> str:
        return ""

    def picture_module(self) -> Any:
        """The module of the plain picture."""
        return display.pictures()

    def build(self) -> Setup:
        return self.setup

    def __reduce__(self) -> tuple[Any, ...]:
        return scene_of, (self.setup, self.parameters)


def scene_of(setup: Setup, parameters: SceneParameters | None = None) -> SetupScene:
    """The scene of a setup."""
    return SetupScene("setup", None, parameters or SceneParameters(), Path(), setup=setup)


def with_scene(run: Run) -> SceneRun:
    """A run of a setup as a run of its scene, for what shows runs; that of a scene as it is."""
    if isinstance(run, SceneRun):
        return run
    accuracy = run.accuracy
    known = {name: getattr(accuracy, name) for name in ("level", "tolerance", "method", "integrator", "step")}
    scene = scene_of(run.setup, SceneParameters(accuracy=Accuracy.model_validate(known)))
    return SceneRun.of(run, scene, scene.result(run))
