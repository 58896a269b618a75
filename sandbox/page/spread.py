"""A spread as a page: its picture, and its numbers as tables."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Sequence
from pathlib import Path

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
from sandbox.page.parts import filled, html
from sandbox.page.replay import command
from sandbox.text import argument


def page_of(spread: Spread) -> str:
    """The page of a spread."""
    keys = [each.key for each in spread.by]
    tables = [
        _table("Shares", ("", "share", "95 % interval"), share_rows(spread)),
        _table("Numbers", NUMBERS, number_rows(spread)),
        _table("Where balls come to lie", ELLIPSES, ellipse_rows(spread)),
        _table(f"Causes: {CAUSES}", ("", *keys), cause_rows(spread)),
        _table(
            "Shots that a real test needs, to be 95 % certain of the mean or the share", ("", ""), need_rows(spread)
        ),
    ]
    return filled(
        "spread.html",
        title=html(title(spread)),
        about=html(about(spread)),
        chart=_chart(spread),
        tables="\n".join(filter(None, tables)),
        command=html(command(spread.scene, "spread", *_options(spread))),
    )


def _table(caption: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table with its heading; "" without rows, and without columns that are empty."""
    if not rows:
        return ""
    used = [place for place in range(len(heads)) if any(row[place] for row in rows)]  # an empty column is left out
    head = "".join(f'<th scope="col">{html(heads[place])}</th>' for place in used)
    body = "\n".join(
        "<tr>" + "".join(f"<{'td' if place else 'th'}>{html(row[place])}</{'td' if place else 'th'}>" for place in used)
        + "</tr>"
        for row in rows
    )  # fmt: skip
    heading = f"<thead><tr>{head}</tr></thead>" if any(heads) else ""
    return f"<section><h2>{html(caption)}</h2><table>{heading}<tbody>\n{body}\n</tbody></table></section>"


def _chart(spread: Spread) -> str:
    """The picture as SVG: sharp at any size."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "spread.svg"
        draw(spread, path)
        text = path.read_text("utf-8")
    image = text[text.index("<svg") :]
    return re.sub(r'^<svg ([^>]*?)width="[^"]*" height="[^"]*"|^<svg ([^>]*?)height="[^"]*" width="[^"]*"',
                  r'<svg \1\2role="img" aria-label="histograms and causes"', image, count=1)  # fmt: skip


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
