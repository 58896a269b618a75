"""The files that ``sandbox fit`` writes."""

from __future__ import annotations

from pathlib import Path

from sandbox.files import check_distinct, check_file, check_installed, writing
from sandbox.lab.fit import Fit


def check_outputs(plot: Path | None, page: Path | None, save: Path | None, has_points: bool) -> None:
    """Raise RequestError, before any work is done, if one of the files cannot be written; a fit that ``has_points``
    saves them, too."""
    if plot is not None:
        from sandbox.lab.chart import check_chart

        check_chart("--plot", plot)
    if page is not None:
        check_file("--page", page, ".html")
        check_installed("--page", "matplotlib")
    if save is not None:
        from sandbox.lab.fit.saving import check_points

        check_file("--save", save, ".toml")
        check_installed("--save", "tomlkit")
        if has_points:
            check_points("--save", save)
    check_distinct({"--plot": plot, "--page": page, "--save": save})


def write_outputs(found: Fit, plot: Path | None, page: Path | None, save: Path | None) -> list[str]:
    """Write the files, and return a line for each."""
    written: list[Path] = []
    if plot is not None:
        from sandbox.lab.fit.chart import draw

        with writing("--plot", plot):
            draw(found, plot)
        written.append(plot)
    if page is not None:
        from sandbox.page.fit import page_of
        from sandbox.page.parts import save as save_page

        with writing("--page", page):
            save_page(page_of(found), page)
        written.append(page)
    if save is not None:
        from sandbox.lab.fit.saving import save as save_scene

        with writing("--save", save):
            written += save_scene(found, save)
    return [f"wrote {path}" for path in written]
