"""A run of a scene: with its result, its verdict and its pictures."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox.engine.paths.run import Run
from sandbox.scene import display

if TYPE_CHECKING:
    from sandbox.scene.scene import Scene


@dataclass(repr=False)
class SceneRun(Run):
    """What ``sandbox.simulate`` returns: the run of a scene's setup, and what the scene says of it."""

    scene: Scene = field(compare=False)
    result: dict[str, Any]  # the facts, in their units

    @classmethod
    def of(cls, run: Run, scene: Scene, result: dict[str, Any]) -> SceneRun:
        """The run of a scene's setup with what its facts say of it."""
        return cls(run.setup, run.accuracy, run.arcs, run.events, run.numerics, run.duration, run.ended, scene, result)

    @property
    def data(self) -> Run:
        """The run without its scene."""
        return Run(self.setup, self.accuracy, self.arcs, self.events, self.numerics, self.duration, self.ended)

    def __repr__(self) -> str:
        what = f"{self.duration:.2f} s, {len(self.events)} events, ended by {self.ended}"
        return f"<Run of {self.scene.title}: {what}>"

    def poster(self, path: str | Path | None = None, size: tuple[int, int] | None = None) -> Any:
        """The whole run as one picture: written to ``path`` (a PNG), or without one handed back as a Pillow image."""
        return display.notebook().poster(self, path, size)

    def frame(self, t: float, size: tuple[int, int] | None = None) -> Any:
        """The run at time t in s, as a Pillow image."""
        return display.notebook().frame(self, t, size)

    def animate(self, path: str | Path | None = None, size: tuple[int, int] | None = None, fps: float = 25.0) -> Any:
        """The run in motion: written to ``path`` (GIF or WebP), or without one handed back for a notebook to show."""
        return display.notebook().animate(self, path, size, fps)

    def _repr_html_(self) -> str:
        return display.notebook().run_html(self)
