"""Display of a run, a scene, a sweep and a search in notebooks, and pictures of a run as Pillow images."""

from __future__ import annotations

import io
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from html import escape
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image

from sandbox.engine.paths.run import ROUNDING_OF_TIME
from sandbox.errors import RequestError
from sandbox.files import check_name, check_size
from sandbox.page.parts import html, picture, save, table
from sandbox.page.replay import page_of, text_of
from sandbox.parameters import walk
from sandbox.picture import frames
from sandbox.scene.setup_scene import with_scene

if TYPE_CHECKING:
    from sandbox.engine.paths.run import Run
    from sandbox.lab.aim import Aim
    from sandbox.lab.fit import Fit
    from sandbox.lab.spread import Spread
    from sandbox.lab.sweep import Sweep
    from sandbox.scene import Scene

Size = tuple[int, int]

#: Size of pictures in a notebook, in px, and frames per second of animations.
POSTER, MOVING, FPS = (960, 540), (640, 360), 25
#: Height of the page of a run in a notebook, in px.
PLAYER = 760
#: The writers of animations, by the end of the file's name.
WRITERS: Mapping[str, Callable[..., int]] = {".gif": frames.save_gif, ".webp": frames.save_webp}


class Animation:
    """A run in motion: shown by a notebook, and ``data`` is an animated WebP."""

    def __init__(self, data: bytes):
        self.data = data

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        import base64

        url = f"data:image/webp;base64,{base64.b64encode(self.data).decode()}"
        return {"text/html": f'<img alt="the run in motion" src="{url}">', "text/plain": "<Animation of a run>"}


def poster(run: Run, path: Path | str | None, size: Size | None) -> Image.Image | None:
    """The whole run as one picture: written to ``path``, or handed back."""
    return _drawn_once(lambda: _picture(run, size or POSTER).poster(), path)


def energy_chart(run: Run, path: Path | str | None, size: Size | None) -> Image.Image | None:
    """The energy by cause over time: written to ``path``, or handed back."""
    from sandbox.picture.energy_chart import energy_chart

    return _drawn_once(lambda: energy_chart(with_scene(run), _checked(size or POSTER)), path)


def graph(run: Run, path: Path | str | None, size: Size | None) -> Image.Image | None:
    """Graphs over time: written to ``path``, or handed back."""
    from sandbox.picture.graph import graph

    return _drawn_once(lambda: graph(with_scene(run), _checked(size or POSTER)), path)


def _drawn_once(draw: Callable[[], Any], path: Path | str | None) -> Image.Image | None:
    """A picture: written to ``path``, or handed back."""
    if path is None:
        return frames.to_image(draw())
    _check(path, ".png")
    frames.save_png(draw(), path)
    return None


def page(run: Run, path: Path | str | None) -> str | None:
    """The page that plays the run: written to ``path``, or its text."""
    return _paged(lambda: page_of(with_scene(run)), path)


def _paged(make: Callable[[], str], path: Path | str | None) -> str | None:
    """A page: written to ``path``, or its text."""
    if path is None:
        return make()
    _check(path, ".html", ".htm")
    save(make(), Path(path))
    return None


def frame(run: Run, t: float, size: Size | None) -> Image.Image:
    """The run at time t in s. Raises RequestError for a time outside it."""
    if not isinstance(t, float | Real):
        raise RequestError(f"frame at t = {t!r:.60}: must be a number, in s")
    rounding = ROUNDING_OF_TIME * run.duration
    if not -rounding <= t <= run.duration + rounding:
        raise RequestError(f"frame at t = {t:.12g} s: the run is from 0 to {run.duration:.12g} s")
    return frames.to_image(_picture(run, size or POSTER).frame(float(t)))


def save_frames(run: Run, folder: Path | str, fps: float, size: Size | None) -> int:
    """Write the frames of the run into a folder; return how many."""
    _check_rate(fps)
    _check(folder)
    return frames.save_frames(_picture(run, size or MOVING), run, folder, fps)


def animate(run: Run, path: Path | str | None, size: Size | None, fps: float) -> Animation | None:
    """The run in motion: written to ``path``, or handed back."""
    _check_rate(fps)
    drawn = _picture(run, size or MOVING)
    if path is not None:
        _check(path, *WRITERS)
        WRITERS[Path(path).suffix.lower()](drawn, run, path, fps)
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "run.webp")
        frames.save_webp(drawn, run, file, fps)
        return Animation(file.read_bytes())


def _picture(run: Run, size: Size) -> Any:
    drawn = with_scene(run)
    return drawn.scene.picture(drawn, _checked(size))


def _checked(size: Size) -> Size:
    """Return the size. Raises RequestError if no picture can have it."""
    check_size(f"size = {size}", size)
    return size


def _check_rate(fps: float) -> None:
    if not isinstance(fps, float | Real) or not 1 <= fps <= 240:
        raise RequestError(f"fps = {fps!r:.60}: must be from 1 to 240")


def _check(path: Path | str, *suffixes: str) -> None:
    """Raise RequestError for what is no name, or of no file with one of these endings, where there are any."""
    if not isinstance(path, str | os.PathLike):
        raise RequestError(f"path = {path!r:.60}: must be the name of a file or folder, as text or a Path")
    check_name("path", Path(path))
    if suffixes and Path(path).suffix.lower() not in suffixes:
        raise RequestError(f"{path}: its name must end in {' or '.join(suffixes)}")


# ------------------------------------------------------------------------------------------------------------ as HTML


def run_html(done: Run) -> str:
    """Card and poster, and the page that plays it where the notebook is trusted."""
    run = with_scene(done)
    page = escape(page_of(run))
    shown = picture(frames.to_image(_picture(run, POSTER).poster()))
    return (
        f'<h3>{html(run.scene.verdict(run))}</h3><img alt="poster" width="{POSTER[0]}" src="{shown}">'
        f"{table(run.scene.rows(run), run.scene.title, 'card')}"
        f'<details><summary>play</summary><iframe title="{html(run.scene.title)}" srcdoc="{page}" loading="lazy" '
        f'style="width: 100%; height: {PLAYER}px; border: 0"></iframe></details>'
    )


def scene_html(scene: Scene) -> str:
    """Its parameters as a table: key, value with unit, and meaning."""
    cells = [
        (each.key, "not set" if each.value is None else text_of(each.value, each.unit), each.meaning)
        for each in walk(scene.parameters)
    ]
    return f"<h3>{html(scene.title)}</h3><p>{html(scene.about)}</p>{table(cells, scene.title, 'parameters')}"


def sweep_html(sweep: Sweep) -> str:
    """Its map or curves; its size alone where it cannot be drawn."""
    try:
        return f"<p>{html(repr(sweep))}</p>{_image(sweep.plot())}"
    except RequestError as error:
        return f"<p>{html(repr(sweep))}: {html(str(error))}</p>"


def aim_html(aim: Aim) -> str:
    """Return the solutions as a table, and all trials as a chart."""
    from sandbox.lab.aim import report

    return _reported(report.as_text(aim), _drawn(lambda path: report.draw(aim, path)))


def _reported(lines: Iterable[str], chart: Image.Image | None) -> str:
    """A report as text, and its chart."""
    text = escape("\n".join(lines))
    return f'<pre style="font-family: monospace; white-space: pre">{text}</pre>{_image(chart)}'


def sweep_plot(sweep: Sweep, path: Path | str | None, of: str | None) -> Image.Image | None:
    """The chart of a sweep: written to ``path``, or handed back; ``of`` names the result."""
    from sandbox.lab.maps import check_plot, draw_sweep
    from sandbox.lab.row_file import cell

    check_plot(sweep.plan, of)
    rows = [{name: cell(record.get(name)) for name in sweep.plan.columns} for record in sweep.records]

    return _plotted(lambda file: draw_sweep(sweep.plan, rows, file, of), path, "--plot")


def _plotted(draw: Callable[[Path], None], path: Path | str | None, option: str = "plot") -> Image.Image | None:
    """A chart: written to ``path``, which ``option`` names in errors, or handed back."""
    from sandbox.lab.chart import check_chart

    def checked(file: Path) -> None:
        check_chart(option, file)
        draw(file)

    if path is None:
        return _drawn(checked)
    _check(path)
    checked(Path(path))
    return None


def _drawn(draw: Callable[[Path], None]) -> Image.Image:
    """The image that a function writes to a file."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "chart.png")
        draw(file)
        return Image.open(io.BytesIO(file.read_bytes()))


def _image(image: Image.Image | None) -> str:
    assert image is not None
    return f'<img alt="chart" width="{min(960, image.width)}" src="{picture(image.convert("RGB"))}">'


def spread_plot(spread: Spread, path: Path | str | None) -> Image.Image | None:
    """Its histograms and causes: written to ``path``, or handed back."""
    from sandbox.lab.spread.chart import draw

    return _plotted(lambda file: draw(spread, file), path)


def spread_page(spread: Spread, path: Path | str | None) -> str | None:
    """Its page: written to ``path``, or its text."""
    from sandbox.page.spread import page_of

    return _paged(lambda: page_of(spread), path)


def fit_plot(fit: Fit, path: Path | str | None) -> Image.Image | None:
    """Its points, path and residuals: written to ``path``, or handed back."""
    from sandbox.lab.fit.chart import draw

    return _plotted(lambda file: draw(fit, file), path)


def fit_page(fit: Fit, path: Path | str | None) -> str | None:
    """Its page: written to ``path``, or its text."""
    from sandbox.page.fit import page_of

    return _paged(lambda: page_of(fit), path)


def fit_html(fit: Fit) -> str:
    """Its report as text, and its picture."""
    from sandbox.lab.fit.report import as_text

    return _reported(as_text(fit), fit.plot())


def spread_html(spread: Spread) -> str:
    """Its numbers as text, and its picture."""
    from sandbox.lab.spread.report import as_text

    return _reported(as_text(spread), spread.plot())
