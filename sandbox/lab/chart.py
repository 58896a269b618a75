"""The frame of all charts of the lab, and the chart of ``sandbox trade``; with matplotlib (extra ``lab``)."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox import resources
from sandbox.files import atomic_write, check_file, check_installed
from sandbox.lab.tables import length
from sandbox.sport.amounts import significant

if TYPE_CHECKING:
    from sandbox.lab.trade import Point, Trade

#: Size in inches, dots per inch, and the drawing area: left, bottom, width and height as fractions.
_SIZE, _DOTS, _FRAME = (9.6, 6.0), 130, (0.02, 0.02, 0.96, 0.96)

#: Errors in m that are marked.
_TARGETS = (0.1, 0.01, 0.001, 0.0001)

#: Smaller errors, in m, are drawn at this value: they do not matter.
_LEAST = 1e-9

#: What is not written into a file, so that the same chart is the same file.
_UNDATED: dict[str, dict[str, Any]] = {"svg": {"Date": None}}

#: Behind a text on a drawing.
PLATE = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 1.5}


def check_chart(option: str, path: Path) -> None:
    """Raise RequestError, before any work is done, if a chart cannot be written there, or matplotlib is missing."""
    check_file(option, path, ".png")
    check_installed(option, "matplotlib")


@contextmanager
def chart(path: Path, title: str, about: str) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Axes to draw into, and the palette; the file is written at the end."""
    with _sheet(path, _SIZE) as (sheet, colours):
        axes = sheet.subplots()
        axes.set_title(f"{about}\n", loc="left", fontsize=10, color=colours["card"]["ink_quiet"])
        axes.annotate(title, (0, 1), xytext=(0, 36), xycoords="axes fraction", textcoords="offset points",
                      fontsize=15, fontweight="bold")  # fmt: skip
        yield axes, colours


@contextmanager
def figure(path: Path, title: str, about: str, size: tuple[float, float]) -> Iterator[tuple[Any, dict[str, Any]]]:
    """A figure for several axes, ``size`` in inches, and the palette; the file is written at the end."""
    with _sheet(path, size) as (sheet, colours):
        inches = 0.55 + 0.25 * len(about.split("\n"))
        sheet.get_layout_engine().set(rect=(0.02, 0.02, 0.96, 1.0 - inches / size[1] - 0.02))
        sheet.text(0.02, 1.0 - 0.18 / size[1], title, ha="left", va="top", fontsize=15, fontweight="bold")
        sheet.text(0.02, 1.0 - 0.5 / size[1], about, ha="left", va="top", fontsize=10,
                   color=colours["card"]["ink_quiet"], linespacing=1.3)  # fmt: skip
        yield sheet, colours


@contextmanager
def _sheet(path: Path, size: tuple[float, float]) -> Iterator[tuple[Any, dict[str, Any]]]:
    """An empty figure in the style of all charts, and the palette; written at the end."""
    import matplotlib
    from matplotlib import font_manager
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    colours = tomllib.loads((resources.folder("assets") / "palette.toml").read_text("utf-8"))
    for file in sorted((resources.folder("assets") / "fonts").glob("*.ttf")):
        font_manager.fontManager.addfont(str(file))
    with matplotlib.rc_context(_style(colours)):
        sheet = Figure(figsize=size, dpi=_DOTS, facecolor="white", layout=ConstrainedLayoutEngine(rect=_FRAME))
        yield sheet, colours
        with atomic_write(path) as out:
            kind = path.suffix[1:].lower()
            sheet.savefig(out.buffer, format=kind, metadata=_UNDATED.get(kind))


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


# ---------------------------------------------------------------------------------------------------------------- trade


def draw_trade(found: Trade, path: Path) -> None:
    """Error against speed: one curve per method, best at the top right, levels marked."""
    floor = max(_LEAST, found.reference.error)

    def places(*points: Point) -> tuple[list[float], list[float]]:
        return [point.times_real_time for point in points], [max(point.error_m or 0.0, floor) for point in points]

    with chart(path, f"{found.reference.scene.title}: error against speed", _measure(found)) as (axes, colours):
        card, methods = colours["card"], list(dict.fromkeys(point.method for point in found.points))
        traces = iter(colours["trace"]["colours"])  # the levels' method, which is the last, has the first
        own = {method: card["quiet"] if method == "plain" else next(traces) for method in reversed(methods)}
        for method in methods:
            finest_first = reversed([point for point in found.points if point.method == method])
            points = list(takewhile(lambda point: point.stable, finest_first))
            if points:
                axes.plot(*places(*points), color=own[method], marker="o", markersize=4.5, label=method, zorder=3)
        for level, point in found.levels.items():
            if point.error_m is not None:
                mark(axes, tuple(value for (value,) in places(point)), level, card, beside=True)
        for target in _TARGETS:
            axes.axhline(target, color=card["quiet"], linewidth=0.8, linestyle=(0, (1, 3)), zorder=1)
            axes.annotate(length(target), (1.008, target), xycoords=("axes fraction", "data"), va="center",
                          fontsize=9, color=card["ink_quiet"])  # fmt: skip
        axes.set(xscale="log", yscale="log", xlabel="speed, times real time", ylabel="error, smaller upwards")
        slowest, fastest = axes.get_xlim()
        axes.set_xlim(slowest, fastest * (fastest / slowest) ** 0.1)  # room for the levels' names
        axes.invert_yaxis()
        axes.xaxis.set_major_formatter(lambda value, position: significant(value))
        axes.tick_params(axis="x", which="minor", pad=7)  # aligned with the other labels, which have ticks
        axes.xaxis.set_minor_formatter(lambda value, position: significant(value) if f"{value:e}"[0] in "25" else "")
        axes.yaxis.set_major_formatter(lambda value, position: length(value))
        axes.get_figure().legend(
            loc="outside lower center", ncols=len(methods), fontsize=9.5, handlelength=1.4, columnspacing=1.4
        )


def _measure(found: Trade) -> str:
    reference = found.reference
    what = "the worst ball" if len(reference.points) > 1 else "the ball"
    text = f"position error of {what} after {reference.time:.3g} s, on this machine"
    return text if reference.diverges_at is None else f"{text}; chaotic from {reference.diverges_at:.3g} s on"
