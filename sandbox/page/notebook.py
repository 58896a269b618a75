"""Display of a run, a scene, a sweep and a search in notebooks; and their pages and charts."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Callable, Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image

from sandbox.errors import RequestError
from sandbox.page.parts import html, picture, save, table
from sandbox.page.replay import page_of, text_of
from sandbox.parameters import walk
from sandbox.picture import frames
from sandbox.picture.images import POSTER, check_path, picture_of
from sandbox.scene.setup_scene import with_scene

if TYPE_CHECKING:
    from sandbox.engine.paths.run import Run
    from sandbox.lab.aim import Aim
    from sandbox.lab.fit import Fit
    from sandbox.lab.spread import Spread
    from sandbox.lab.sweep import Sweep
    from sandbox.scene import Scene

#: Height of the page of a run in a notebook, in px.
PLAYER = 760


def page(run: Run, path: Path | str | None) -> str | None:
    """The page that plays the run: written to ``path``, or its text."""
    return _paged(lambda: page_of(with_scene(run)), path)


def _paged(make: Callable[[], str], path: Path | str | None) -> str | None:
    """A page: written to ``path``, or its text."""
    if path is None:
        return make()
    check_path(path, ".html", ".htm")
    save(make(), Path(path))
    return None


# ------------------------------------------------------------------------------------------------------------ as HTML


def run_html(done: Run) -> str:
    """Card and poster, and the page that plays it where the notebook is trusted."""
    run = with_scene(done)
    page = escape(page_of(run))
    shown = picture(frames.to_image(picture_of(run, POSTER).poster()))
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
    check_path(path)
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
