"""How runs, scenes and results are shown: by pictures and notebooks, which are above them and register here."""

from __future__ import annotations

TYPE_CHECKING = False  # not from typing, which is slow to import: ``sandbox`` registers here as it is imported
if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from typing import Any, Protocol

    from sandbox.scene.scene import Scene
    from sandbox.scene.scene_run import SceneRun

    class Pictures(Protocol):
        """The picture of a scene that has none of its own, and the class that every picture is of."""

        @property
        def Picture(self) -> type: ...  # noqa: N802

        @property
        def View(self) -> type: ...  # noqa: N802

    class Notebook(Protocol):
        """Images and HTML: sizes in px, times in s. What draws writes to ``path`` if there is one, or returns it."""

        def poster(self, run: SceneRun, path: Path | str | None, size: tuple[int, int] | None) -> Any: ...

        def frame(self, run: SceneRun, t: float, size: tuple[int, int] | None) -> Any: ...

        def animate(self, run: SceneRun, path: Path | str | None, size: tuple[int, int] | None, fps: float) -> Any: ...

        def sweep_plot(self, sweep: Any, path: Path | str | None, of: str | None) -> Any: ...

        def run_html(self, run: SceneRun) -> str: ...

        def scene_html(self, scene: Scene) -> str: ...

        def sweep_html(self, sweep: Any) -> str: ...

        def aim_html(self, aim: Any) -> str: ...


_loaders: dict[str, Callable[[], Any]] = {}


def show_with(pictures: Callable[[], Pictures], notebook: Callable[[], Notebook]) -> None:
    """Register what pictures and notebooks are made by. Each function imports it, and is called on first use."""
    _loaders.update(pictures=pictures, notebook=notebook)


def pictures() -> Pictures:
    """The registered pictures."""
    found: Pictures = _loaders["pictures"]()
    return found


def notebook() -> Notebook:
    """The registered display of notebooks."""
    found: Notebook = _loaders["notebook"]()
    return found
