"""Reports as HTML: a page for any browser, and what a notebook shows."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from PIL import Image

from sandbox.lab.chart import drawn
from sandbox.lab.report import Chart, Notes, Report, Section, Table
from sandbox.page.parts import filled, html, picture


def page_of(report: Report) -> str:
    """A page with all sections of a report, one file without network."""
    footer = f"<footer><p><code>{html(report.command)}</code></p></footer>" if report.command else ""
    return filled("report.html", html(report.title), sections=_sections(report.sections, _svg), footer=footer)


def notebook_html(report: Report) -> str:
    """A report without its details, for a notebook: its charts are images, for notebooks show no SVG of others."""
    short = [section for section in report.sections if isinstance(section, Chart) or not section.detail]
    return f"<h3>{html(report.title)}</h3>\n{_sections(short, _image)}"


def _sections(sections: Iterable[Section], shown: Callable[[Chart], str]) -> str:
    """Sections as HTML; ``shown`` makes that of a chart."""
    return "\n".join(filter(None, (_section(section, shown) for section in sections)))


def _section(section: Section, shown: Callable[[Chart], str]) -> str:
    heading = f"<h2>{html(section.title)}</h2>" if section.title else ""
    if isinstance(section, Chart):
        caption = f"<figcaption>{html(section.note)}</figcaption>" if section.note else ""
        return f'<figure class="chart">{shown(section)}{caption}</figure>'
    notes = "".join(f"<p>{html(note)}</p>" for note in section.notes)
    if isinstance(section, Notes):
        return f"<section>{heading}{notes}</section>" if notes else ""
    return f"<section>{heading}{_table(section)}{notes}</section>" if section.rows else ""


def _table(section: Table) -> str:
    """A table, without columns that are empty."""
    body = section.cells
    used = [place for place, column in enumerate(section.columns) if column.heading or any(row[place] for row in body)]
    sides = ["" if section.columns[place].align == "r" else ' class="words"' for place in used]

    def row(texts: Sequence[str], kind: str) -> str:
        cells = (f"<{kind}{side}>{html(texts[place])}</{kind}>" for place, side in zip(used, sides, strict=True))
        return f"<tr>{''.join(cells)}</tr>"

    heads = [column.heading for column in section.columns]
    heading = f"<thead>{row(heads, 'th')}</thead>" if any(heads) else ""
    rows = "\n".join(row(texts, "td") for texts in body)
    return f"<table>{heading}<tbody>\n{rows}\n</tbody></table>"


def svg_of(sheet: Any, label: str) -> str:
    """A figure as SVG, which is sharp at any size, without a date: the same figure is the same text."""
    out = io.StringIO()
    sheet.savefig(out, format="svg", metadata={"Date": None})
    text = out.getvalue()
    text = re.sub(r' (width|height)="[^"]*"', "", text[text.index("<svg") :], count=2)
    return text.replace("<svg", f'<svg role="img" aria-label="{html(label)}"', 1)


def _svg(chart: Chart) -> str:
    """A chart as SVG."""
    with drawn([chart]) as sheet:
        return svg_of(sheet, chart.title or "chart")


def _image(chart: Chart) -> str:
    """A chart as an image."""
    out = io.BytesIO()
    with drawn([chart]) as sheet:
        sheet.savefig(out, format="png")
    image = Image.open(out).convert("RGB")
    return f'<img alt="{html(chart.title or "chart")}" width="{min(960, image.width)}" src="{picture(image)}">'
