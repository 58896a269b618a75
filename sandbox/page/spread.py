"""A spread as a page: its picture, and its numbers as tables."""

from __future__ import annotations

from sandbox.lab.axes import Span
from sandbox.lab.spread import Spread
from sandbox.lab.spread.chart import draw
from sandbox.lab.spread.report import (
    CAUSES,
    ELLIPSES,
    NUMBERS,
    about,
    cause_rows,
    ellipse_rows,
    need_rows,
    number_rows,
    share_rows,
    title,
)
from sandbox.page.parts import captioned, filled, html, svg
from sandbox.page.replay import command
from sandbox.text import argument


def page_of(spread: Spread) -> str:
    """The page of a spread."""
    keys = [each.key for each in spread.by]
    tables = [
        captioned("Shares", ("", "share", "95 % interval"), share_rows(spread)),
        captioned("Numbers", NUMBERS, number_rows(spread)),
        captioned("Where balls come to lie", ELLIPSES, ellipse_rows(spread)),
        captioned(f"Causes: {CAUSES}", ("", *keys), cause_rows(spread)),
        captioned(
            "Shots that a real test needs, to be 95 % certain of the mean or the share", ("", ""), need_rows(spread)
        ),
    ]
    return filled(
        "spread.html",
        title=html(title(spread)),
        about=html(about(spread)),
        chart=svg(lambda path: draw(spread, path), "histograms and causes"),
        tables="\n".join(filter(None, tables)),
        command=html(command(spread.scene, "spread", *_options(spread))),
    )


def _options(spread: Spread) -> list[str]:
    options = []
    for each in spread.by:
        axis = each.axis
        text = (
            f"{argument(axis.low)}:{argument(axis.high)}" if isinstance(axis, Span) else each.given or argument(axis.sd)
        )
        options += ["--by", f"{each.key}={text}"]
    if spread.only:
        options += [word for name in spread.runs.facts for word in ("--of", name)]
    options += ["--samples", str(spread.samples), "--seed", str(spread.seed)]
    options += ["--sampling", "random"] if spread.sampling == "random" else []
    options += [word for name, width in spread.within.items() for word in ("--within", f"{name}={width:g}")]
    return [*options, *([] if spread.points.pairs or len(spread.by) == 1 else ["--no-causes"]), "--page", "spread.html"]
