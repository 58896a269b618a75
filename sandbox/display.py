"""Display of runs, scenes and results by pictures and in notebooks, which are above them and found by their entries."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar

from sandbox import entries

if TYPE_CHECKING:
    from pathlib import Path
    from typing import Protocol

    File = Path | str | None
    Size = tuple[int, int] | None

    class Pictures(Protocol):
        """The picture of a scene that has none of its own, and the class that every picture is of."""

        @property
        def Picture(self) -> type: ...  # noqa: N802

        @property
        def View(self) -> type: ...  # noqa: N802

    class Images(Protocol):
        """A run as images: sizes in px, times in s. What draws writes to ``path`` if there is one, or returns it."""

        def poster(self, run: Any, path: File, size: Size) -> Any: ...

        def frame(self, run: Any, t: float, size: Size) -> Any: ...

        def save_frames(self, run: Any, folder: Path | str, fps: float, size: Size) -> int: ...

        def animate(self, run: Any, path: File, size: Size, fps: float) -> Any: ...

        def energy_chart(self, run: Any, path: File, size: Size) -> Any: ...

        def graph(self, run: Any, path: File, size: Size) -> Any: ...

    class Notebook(Protocol):
        """Pages and HTML."""

        def page(self, run: Any, path: File) -> Any: ...

        def run_html(self, run: Any) -> str: ...

        def scene_html(self, scene: Any) -> str: ...

        def report_page(self, report: Any, path: File) -> Any: ...

        def report_html(self, report: Any) -> str: ...


def pictures() -> Pictures:
    """The default picture, and the class of all."""
    return _part("pictures")


def notebook() -> Notebook:
    """The display in notebooks. Raises RequestError where the package that has it was taken off."""
    return _part("notebooks")


def _images() -> Images:
    return _part("images")


def _part(name: str) -> Any:
    return entries.require(name, "sandbox")


class Drawable:
    """A run that can be drawn: as its scene's picture, or plainly if it has no scene."""

    def poster(self, path: File = None, size: Size = None) -> Any:
        """Draw the whole run as one picture: write it to ``path`` (a PNG), or return a Pillow image if there is none.

        ``size`` is in px, here and below.
        """
        return _images().poster(self, path, size)

    def frame(self, t: float, size: Size = None) -> Any:
        """Draw the run at time t in s, as a Pillow image."""
        return _images().frame(self, t, size)

    def frames(self, folder: Path | str, fps: float = 60.0, size: Size = None) -> int:
        """Write frame_00000.png, frame_00001.png, ... into a folder; return how many."""
        return _images().save_frames(self, folder, fps, size)

    def animate(self, path: File = None, size: Size = None, fps: float = 25.0) -> Any:
        """Draw the run in motion: write it to ``path`` (GIF or WebP), or return it for a notebook to show."""
        return _images().animate(self, path, size, fps)

    def page(self, path: File = None) -> Any:
        """Make a page for any browser that plays the run: write it to ``path``, or return its text."""
        return notebook().page(self, path)

    def energy_chart(self, path: File = None, size: Size = None) -> Any:
        """Draw the energy by cause over time: write it to ``path`` (a PNG), or return a Pillow image."""
        return _images().energy_chart(self, path, size)

    def graph(self, path: File = None, size: Size = None) -> Any:
        """Draw position, speed, spin, acceleration, forces and energy over time: a PNG, or a Pillow image."""
        return _images().graph(self, path, size)

    def _repr_html_(self) -> str:
        return notebook().run_html(self)


class Reported:
    """A result with a report, which draws and shows it: by ``report_of`` of a module above it, ``REPORTED_BY``."""

    REPORTED_BY: ClassVar[str]

    def report(self) -> Any:
        """The sections that every output is made of."""
        return import_module(self.REPORTED_BY).report_of(self)

    def plot(self, path: File = None) -> Any:
        """Draw the charts of its report: write them to ``path`` (a PNG), or return a Pillow image."""
        return _part("charts").image(self.report(), path)

    def page(self, path: File = None) -> Any:
        """Make a page for any browser with charts and tables: write it to ``path`` (HTML), or return its text."""
        return notebook().report_page(self.report(), path)

    def _repr_html_(self) -> str:
        return notebook().report_html(self.report())
