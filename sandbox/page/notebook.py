"""Display of runs, scenes and reports in notebooks; and their pages and charts."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from sandbox.page import report as reports
from sandbox.page.parts import html, picture, save, table
from sandbox.page.replay import page_of, text_of
from sandbox.parameters import walk
from sandbox.picture import frames
from sandbox.picture.images import POSTER, check_path, picture_of
from sandbox.scene.setup_scene import with_scene

if TYPE_CHECKING:
    from sandbox.engine.paths.run import Run
    from sandbox.lab.report import Report
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


def report_html(report: Report) -> str:
    """Its tables and sentences, and its charts as images."""
    return reports.notebook_html(report)


def report_page(report: Report, path: Path | str | None) -> str | None:
    """Its page: written to ``path``, or its text."""
    return _paged(lambda: reports.page_of(report), path)
