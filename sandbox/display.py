"""Display of runs, scenes and results by pictures and notebooks, which are above them and register here."""

from __future__ import annotations

TYPE_CHECKING = False  # not from typing, which is slow to import: ``sandbox`` registers here as it is imported
if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from typing import Any, Protocol

    File = Path | str | None
    Size = tuple[int, int] | None

    class Pictures(Protocol):
        """The picture of a scene that has none of its own, and the class that every picture is of."""

        @property
        def Picture(self) -> type: ...  # noqa: N802

        @property
        def View(self) -> type: ...  # noqa: N802

    class Notebook(Protocol):
        """Images and HTML: sizes in px, times in s. What draws writes to ``path`` if there is one, or returns it."""

        def poster(self, run: Any, path: File, size: Size) -> Any: ...

        def frame(self, run: Any, t: float, size: Size) -> Any: ...

        def save_frames(self, run: Any, folder: Path | str, fps: float, size: Size) -> int: ...

        def animate(self, run: Any, path: File, size: Size, fps: float) -> Any: ...

        def page(self, run: Any, path: File) -> Any: ...

        def energy_chart(self, run: Any, path: File, size: Size) -> Any: ...

        def graph(self, run: Any, path: File, size: Size) -> Any: ...

        def sweep_plot(self, sweep: Any, path: File, of: str | None) -> Any: ...

        def spread_plot(self, spread: Any, path: File) -> Any: ...

        def spread_page(self, spread: Any, path: File) -> Any: ...

        def spread_html(self, spread: Any) -> str: ...

        def fit_plot(self, fit: Any, path: File) -> Any: ...

        def fit_page(self, fit: Any, path: File) -> Any: ...

        def fit_html(self, fit: Any) -> str: ...

        def run_html(self, run: Any) -> str: ...

        def scene_html(self, scene: Any) -> str: ...

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


class Drawable:
    """A run that can be drawn: as its scene's picture, or plainly if it has no scene."""

    def poster(self, path: File = None, size: Size = None) -> Any:
        """Draw the whole run as one picture: write it to ``path`` (a PNG), or return a Pillow image if there is none.

        ``size`` is in px, here and below.
        """
        return notebook().poster(self, path, size)

    def frame(self, t: float, size: Size = None) -> Any:
        """Draw the run at time t in s, as a Pillow image."""
        return notebook().frame(self, t, size)

    def frames(self, folder: Path | str, fps: float = 60.0, size: Size = None) -> int:
        """Write frame_00000.png, frame_00001.png, ... into a folder; return how many."""
        return notebook().save_frames(self, folder, fps, size)

    def animate(self, path: File = None, size: Size = None, fps: float = 25.0) -> Any:
        """Draw the run in motion: write it to ``path`` (GIF or WebP), or return it for a notebook to show."""
        return notebook().animate(self, path, size, fps)

    def page(self, path: File = None) -> Any:
        """Make a page for any browser that plays the run: write it to ``path``, or return its text."""
        return notebook().page(self, path)

    def energy_chart(self, path: File = None, size: Size = None) -> Any:
        """Draw the energy by cause over time: write it to ``path`` (a PNG), or return a Pillow image."""
        return notebook().energy_chart(self, path, size)

    def graph(self, path: File = None, size: Size = None) -> Any:
        """Draw position, speed, spin, acceleration, forces and energy over time: a PNG, or a Pillow image."""
        return notebook().graph(self, path, size)

    def _repr_html_(self) -> str:
        return notebook().run_html(self)
