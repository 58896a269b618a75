"""The charts of reports: one figure, one style and one legend for all; with matplotlib (extra ``lab``)."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from sandbox import resources
from sandbox.files import atomic_write, check_file, check_installed
from sandbox.lab.report import Chart, Report

if TYPE_CHECKING:
    from PIL import Image

#: Width in inches, dots per inch, and the free edge as a share of the picture.
_WIDTH, _DOTS, _EDGE = 9.6, 130, 0.02

#: Behind a text on a drawing.
PLATE = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 1.5}


def check_chart(option: str, path: Path) -> None:
    """Raise RequestError, before any work is done, if a chart cannot be written there, or matplotlib is missing."""
    check_file(option, path, ".png")
    check_installed(option, "matplotlib")


def image(report: Report, path: Path | str | None) -> Image.Image | None:
    """The charts of a report: written to ``path``, a PNG, or handed back where there is none."""
    from PIL import Image

    from sandbox.picture.images import check_path

    if path is not None:
        check_path(path)
        check_chart("path", Path(path))
        draw(report, Path(path))
        return None
    with TemporaryDirectory() as folder:
        file = Path(folder, "chart.png")
        check_chart("plot", file)
        draw(report, file)
        return Image.open(BytesIO(file.read_bytes()))


def draw(report: Report, path: Path) -> None:
    """Write the charts of a report as one picture (PNG)."""
    charts = report.charts()
    title, about = next(((chart.title, chart.about) for chart in charts), ("", ""))
    with drawn(charts, title or report.title, about) as sheet, atomic_write(path) as out:
        sheet.savefig(out.buffer, format="png")


@contextmanager
def drawn(charts: Sequence[Chart], title: str = "", about: str = "", width: float = _WIDTH) -> Iterator[Any]:
    """A figure of charts, one below the other, with a title, ``width`` in inches; to be saved inside."""
    import matplotlib
    from matplotlib import font_manager
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    colours = tomllib.loads((resources.folder("assets") / "palette.toml").read_text("utf-8"))
    for file in sorted((resources.folder("assets") / "fonts").glob("*.ttf")):
        font_manager.fontManager.addfont(str(file))
    head = 0.55 + 0.25 * len(about.split("\n")) if title else 0.0
    heights = [chart.height * -(-len(chart.panels) // chart.across) for chart in charts]
    tall = head + sum(heights)
    frame = (_EDGE, _EDGE, 1.0 - 2.0 * _EDGE, 1.0 - head / tall - 2.0 * _EDGE)
    with matplotlib.rc_context(_style(colours)):
        layout = ConstrainedLayoutEngine(rect=frame)
        sheet = Figure(figsize=(width, tall), dpi=_DOTS, facecolor="white", layout=layout)
        sheet.text(_EDGE, 1.0 - 0.18 / tall, title, ha="left", va="top", fontsize=15, fontweight="bold")
        sheet.text(_EDGE, 1.0 - 0.5 / tall, about, ha="left", va="top", fontsize=10,
                   color=colours["card"]["ink_quiet"], linespacing=1.3)  # fmt: skip
        if charts:
            parts = sheet.subfigures(len(charts), 1, height_ratios=heights, squeeze=False).flat
            for part, chart in zip(parts, charts, strict=True):
                _fill(part, chart, colours)
        yield sheet


def _fill(part: Any, chart: Chart, colours: Mapping[str, Any]) -> None:
    """Draw the panels of a chart into a part of a figure."""
    down = -(-len(chart.panels) // chart.across)
    in_line = chart.across == 1 and not any(panel.x for panel in chart.panels[:-1])
    places = part.subplots(down, chart.across, squeeze=False, sharex=in_line).flat
    for panel, axes in zip(chart.panels, places, strict=False):
        panel.draw(axes, colours)
        axes.set_title(panel.title, loc="left", fontsize=11, fontweight="bold")
        axes.set(**{f"{side}label": text for side, text in (("x", panel.x), ("y", panel.y)) if text})
        if axes.get_legend_handles_labels()[1] and axes.get_legend() is None:
            legend(axes)
    for axes in places:  # what is left of the last row
        axes.set_axis_off()


def _style(colours: dict[str, Any]) -> Any:
    """The style of all charts, as matplotlib's parameters."""
    from cycler import cycler

    card = colours["card"]
    ticks = {"color": card["quiet"], "labelcolor": card["ink_quiet"], "labelsize": 9.5}
    return {
        "svg.hashsalt": "sandbox",
        "font.family": ["Noto Sans", "sans-serif"],
        "text.color": card["ink"],
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.edgecolor": card["quiet"],
        "axes.labelcolor": card["ink_quiet"],
        "axes.prop_cycle": cycler(color=colours["trace"]["colours"]),
        **{f"{side}tick.{name}": value for side in "xy" for name, value in ticks.items()},
        **{f"{side}tick.minor.size": 0 for side in "xy"},
        "grid.color": card["quiet"],
        "grid.linewidth": 0.5,
        "grid.alpha": 0.4,
        "legend.frameon": False,
        "legend.fontsize": 10.5,
        "legend.labelcolor": card["ink"],
        "legend.borderaxespad": 0.0,
        "lines.linewidth": 1.8,
        "scatter.edgecolors": "none",
    }


def legend(axes: Any, **options: Any) -> None:
    """A legend to the right of the axes."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), **options)


def mark(axes: Any, place: tuple[float, ...], text: str, card: dict[str, str], beside: bool = False) -> None:
    """A diamond with its name above it and within the axes, whose limits must be set; or above it to the right, where
    nothing is drawn that is better in both."""
    low, high = axes.get_xlim()
    side = (
        "left" if place[0] < low + 0.1 * (high - low) else "right" if place[0] > high - 0.1 * (high - low) else "center"
    )
    axes.plot(*place, marker="D", markersize=9, markerfacecolor=card["accent"], markeredgecolor=card["ink"], zorder=5)
    where = {"xytext": (8, 8), "va": "bottom"} if beside else {"xytext": (0, 11), "ha": side, "va": "bottom"}
    axes.annotate(text, place, textcoords="offset points", fontsize=10.5, fontweight="bold", zorder=6, bbox=PLATE,
                  **where)  # fmt: skip
