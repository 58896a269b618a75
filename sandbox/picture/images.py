"""A run as Pillow images: its poster, frames, animation, graphs and energy, written to files or handed back."""

from __future__ import annotations

import os
import tempfile
from base64 import b64encode
from collections.abc import Callable, Mapping
from numbers import Real
from pathlib import Path
from typing import Any

from PIL import Image

from sandbox.engine.paths.run import ROUNDING_OF_TIME, Run
from sandbox.errors import RequestError
from sandbox.files import check_name, check_size
from sandbox.picture import energy_chart as energy
from sandbox.picture import frames
from sandbox.picture import graph as graphs
from sandbox.scene.setup_scene import with_scene

Size = tuple[int, int]

#: Size of posters and of what moves, in px.
POSTER, _MOVING = (960, 540), (640, 360)
#: The writers of animations, by the end of the file's name.
_WRITERS: Mapping[str, Callable[..., int]] = {".gif": frames.save_gif, ".webp": frames.save_webp}


class _Animation:
    """A run in motion: shown by a notebook, and ``data`` is an animated WebP."""

    def __init__(self, data: bytes):
        self.data = data

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        url = f"data:image/webp;base64,{b64encode(self.data).decode()}"
        return {"text/html": f'<img alt="the run in motion" src="{url}">', "text/plain": "<Animation of a run>"}


def poster(run: Run, path: Path | str | None, size: Size | None) -> Image.Image | None:
    """The whole run as one picture: written to ``path``, or handed back."""
    return _drawn_once(lambda: picture_of(run, size or POSTER).poster(), path)


def energy_chart(run: Run, path: Path | str | None, size: Size | None) -> Image.Image | None:
    """The energy by cause over time: written to ``path``, or handed back."""
    return _drawn_once(lambda: energy.energy_chart(with_scene(run), _checked(size or POSTER)), path)


def graph(run: Run, path: Path | str | None, size: Size | None) -> Image.Image | None:
    """Graphs over time: written to ``path``, or handed back."""
    return _drawn_once(lambda: graphs.graph(with_scene(run), _checked(size or POSTER)), path)


def _drawn_once(draw: Callable[[], Any], path: Path | str | None) -> Image.Image | None:
    """A picture: written to ``path``, or handed back."""
    if path is None:
        return frames.to_image(draw())
    check_path(path, ".png")
    frames.save_png(draw(), path)
    return None


def frame(run: Run, t: float, size: Size | None) -> Image.Image:
    """The run at time t in s. Raises RequestError for a time outside it."""
    if not isinstance(t, float | Real):
        raise RequestError(f"frame at t = {t!r:.60}: must be a number, in s")
    rounding = ROUNDING_OF_TIME * run.duration
    if not -rounding <= t <= run.duration + rounding:
        raise RequestError(f"frame at t = {t:.12g} s: the run is from 0 to {run.duration:.12g} s")
    return frames.to_image(picture_of(run, size or POSTER).frame(float(t)))


def save_frames(run: Run, folder: Path | str, fps: float, size: Size | None) -> int:
    """Write the frames of the run into a folder; return how many."""
    _check_rate(fps)
    check_path(folder)
    return frames.save_frames(picture_of(run, size or _MOVING), run, folder, fps)


def animate(run: Run, path: Path | str | None, size: Size | None, fps: float) -> _Animation | None:
    """The run in motion: written to ``path``, or handed back."""
    _check_rate(fps)
    drawn = picture_of(run, size or _MOVING)
    if path is not None:
        check_path(path, *_WRITERS)
        _WRITERS[Path(path).suffix.lower()](drawn, run, path, fps)
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "run.webp")
        frames.save_webp(drawn, run, file, fps)
        return _Animation(file.read_bytes())


def picture_of(run: Run, size: Size) -> Any:
    drawn = with_scene(run)
    return drawn.scene.picture(drawn, _checked(size))


def _checked(size: Size) -> Size:
    """Return the size. Raises RequestError if no picture can have it."""
    check_size(f"size = {size}", size)
    return size


def _check_rate(fps: float) -> None:
    if not isinstance(fps, float | Real) or not 1 <= fps <= 240:
        raise RequestError(f"fps = {fps!r:.60}: must be from 1 to 240")


def check_path(path: Path | str, *suffixes: str) -> None:
    """Raise RequestError for what is no name, or of no file with one of these endings, where there are any."""
    if not isinstance(path, str | os.PathLike):
        raise RequestError(f"path = {path!r:.60}: must be the name of a file or folder, as text or a Path")
    check_name("path", Path(path))
    if suffixes and Path(path).suffix.lower() not in suffixes:
        raise RequestError(f"{path}: its name must end in {' or '.join(suffixes)}")
