"""A fit as a page: its picture, its values, and what is to be said of them."""

from __future__ import annotations

from sandbox.lab.fit.chart import draw
from sandbox.lab.fit.report import HARDLY, VALUES, sentences, title, value_rows
from sandbox.lab.fit.squares import Fit
from sandbox.page.parts import captioned, filled, html, svg
from sandbox.page.replay import command


def page_of(found: Fit) -> str:
    """The page of a fit."""
    first, *others = sentences(found)
    pairs = [
        (f"{one} and {other}", f"{value:.3f}", "hardly told apart" if abs(value) > HARDLY else "")
        for (one, other), value in found.correlations.items()
    ]
    models = [(name, f"{each.behind:.1f}" if each.fit is not None else each.failure)
              for name, each in found.models.items()]  # fmt: skip
    tables = [
        captioned("Values", VALUES, value_rows(found)),
        captioned("Correlations of the errors", ("", "correlation", ""), pairs),
        captioned(f"Models: {found.models_of}", ("", "AICc above the best"), models),
    ]
    return filled(
        "fit.html",
        title=html(title(found)),
        about=html(first),
        chart=svg(lambda path: draw(found, path), "points, path and residuals"),
        said="\n".join(f"<li>{html(sentence)}</li>" for sentence in others),
        tables="\n".join(filter(None, tables)),
        command=html(command(found.scene)),
    )
