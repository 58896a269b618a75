"""Outputs of commands that report: their options, and writing them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox import entries
from sandbox.cli.arguments import Command, json_option, say
from sandbox.files import atomic_write, check_distinct, check_file, check_installed, writing

if TYPE_CHECKING:
    from sandbox.lab.report import Report

#: The part of an extension that makes pages of reports.
PAGES = "pages of reports"


@dataclass(frozen=True)
class Outputs:
    """The outputs that a command is to write."""

    as_json: bool
    plot: Path | None
    page: Path | None

    def check(self, others: Mapping[str, Path | None] = {}) -> None:
        """Raise RequestError, before any work is done, if picture or page cannot be written, or is the same file as
        another, or as one of the ``others`` by option."""
        if self.plot is not None:
            from sandbox.lab.chart import check_chart

            check_chart("--plot", self.plot)
        if self.page is not None:
            entries.require(PAGES, "--html")
            check_file("--html", self.page, ".html")
            check_installed("--html", "matplotlib")
        check_distinct({"--plot": self.plot, "--html": self.page, **others})

    def write(
        self,
        report: Report,
        everything: bool = False,
        others: Sequence[Path] = (),
        page_of: Callable[[], str] | None = None,
        quiet: bool = False,
    ) -> None:
        """Write picture and page, which ``page_of`` makes where it is not the usual one; unless ``quiet``, print the
        report as JSON, or as text with the names of all files, ``others`` among them."""
        from sandbox.lab.report import as_json, as_text

        if self.plot is not None:
            from sandbox.lab.chart import draw

            with writing("--plot", self.plot):
                draw(report, self.plot)
        if self.page is not None:
            text = page_of() if page_of is not None else entries.require(PAGES, "--html").page_of(report)
            with writing("--html", self.page), atomic_write(self.page) as file:
                file.write(text)
        files = [path for path in (*others, self.plot, self.page) if path is not None]
        if not quiet:
            lines = [*as_text(report, everything), *(f"wrote {path}" for path in files)]
            say(as_json(report) if self.as_json else "\n".join(lines))


def report_options(command: Command) -> Command:
    """``--json``, ``--plot`` and ``--html``, given to the command as ``outputs``, whose files are checked before."""

    @json_option
    @click.option(
        "--plot",
        metavar="[F.png]",
        type=Path,
        is_flag=False,
        flag_value=Path("-"),
        help="Draw the charts of the report.  [default: SCENE-COMMAND.png]",
    )
    @click.option("--html", "--page", "page", metavar="F.html", type=Path, help="Write it as a page for any browser.")
    @wraps(command)
    def reports(*, as_json: bool, plot: Path | None, page: Path | None, **arguments: Any) -> None:
        if plot == Path("-"):
            scene = Path(arguments.get("scene") or "all").stem
            plot = Path(f"{scene}-{click.get_current_context().info_name}.png")
        outputs = Outputs(as_json, plot, page)
        outputs.check()
        command(outputs=outputs, **arguments)

    return reports
