"""Charts of the lab's measurements, with matplotlib (extra ``lab``)."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox import resources
from sandbox.errors import RequestError
from sandbox.files import written_whole
from sandbox.lab.tables import length, significant

if TYPE_CHECKING:
    from sandbox.lab.trade import Point, Trade

#: Size in inches, dots per inch, and the drawing area: left, bottom, width and height as fractions.
_SIZE, _DOTS, _FRAME = (9.6, 6.0), 130, (0.02, 0.02, 0.96, 0.96)

#: Errors in m that are marked.
_TARGETS = (0.1, 0.01, 0.001, 0.0001)

#: Smaller errors, in m, are drawn at this value: they do not matter.
_LEAST = 1e-9


def check_installed(option: str) -> None:
    """Raise RequestError with installation instructions if matplotlib is missing."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise RequestError(f"{option} needs matplotlib, which is not installed: pip install matplotlib") from None


def draw_trade(found: Trade, path: Path) -> None:
    """Error against speed: one curve per method, best at the top right, levels marked."""
    reference = found.reference
    name = f"{reference.scene.name}/{reference.scene.preset}" if reference.scene.preset else reference.scene.name
    with chart(path, f"{name}: error against speed", _measure(found)) as (axes, colours):
        floor = max(_LEAST, reference.error)
        methods = list(dict.fromkeys(point.method for point in found.points))
        for method, colour in zip(methods, _colours(methods, colours), strict=True):
            points = _stable_end([point for point in found.points if point.method == method])
            _curve(axes, points, floor, colour, method)
        for level, point in found.levels.items():
            if point.error_m is not None:
                _level(axes, level, point, floor, colours)
        _targets(axes, colours)
        axes.set_xscale("log")
        axes.set_yscale("log")
        slowest, fastest = axes.get_xlim()
        axes.set_xlim(slowest, fastest * (fastest / slowest) ** 0.1)  # room for the levels' names
        axes.invert_yaxis()
        axes.set_xlabel("speed, times real time")
        axes.set_ylabel("error, smaller upwards")
        axes.xaxis.set_major_formatter(lambda value, position: significant(value))
        axes.tick_params(axis="x", which="minor", pad=7)  # aligned with the other labels, which have ticks
        axes.xaxis.set_minor_formatter(lambda value, position: significant(value) if f"{value:e}"[0] in "25" else "")
        axes.yaxis.set_major_formatter(lambda value, position: length(value))
        ink = colours["card"]["ink"]
        figure = axes.get_figure()
        figure.legend(
            loc="outside lower center", ncols=len(methods), frameon=False, fontsize=9.5, labelcolor=ink,
            handlelength=1.4, columnspacing=1.4,
        )  # fmt: skip


def _colours(methods: Sequence[str], colours: dict[str, Any]) -> Iterator[str]:
    """The last method, which the levels use, has the first colour; the plain one is grey."""
    traces = iter(colours["trace"]["colours"])
    own = {method: next(traces) for method in reversed(methods) if method != "plain"}
    return (own.get(method, colours["card"]["quiet"]) for method in methods)


def _stable_end(points: Sequence[Point]) -> list[Point]:
    """The settings from the finest to the last stable one."""
    return list(takewhile(lambda point: point.stable, reversed(points)))


def _measure(found: Trade) -> str:
    reference = found.reference
    what = "the worst ball" if len(reference.points) > 1 else "the ball"
    text = f"position error of {what} after {reference.time:.3g} s, on this machine"
    if reference.diverges_at is not None:
        text += f"; chaotic from {reference.diverges_at:.3g} s on"
    return text


def _curve(axes: Any, points: Sequence[Point], floor: float, colour: str, label: str) -> None:
    if not points:
        return
    x = [point.times_real_time for point in points]
    y = [max(point.error_m or 0.0, floor) for point in points]
    axes.plot(x, y, color=colour, linewidth=1.8, marker="o", markersize=4.5, markeredgewidth=0, label=label, zorder=3)


def _targets(axes: Any, colours: dict[str, Any]) -> None:
    ink, quiet = colours["card"]["ink_quiet"], colours["card"]["quiet"]
    for target in _TARGETS:
        axes.axhline(target, color=quiet, linewidth=0.8, linestyle=(0, (1, 3)), zorder=1)
        place = {"xycoords": ("axes fraction", "data"), "va": "center"}
        axes.annotate(length(target), (1.008, target), fontsize=9, color=ink, **place)


def _level(axes: Any, name: str, point: Point, floor: float, colours: dict[str, Any]) -> None:
    from matplotlib.patheffects import withStroke

    place = point.times_real_time, max(point.error_m or 0.0, floor)
    card = colours["card"]
    axes.plot(*place, marker="D", markersize=9, markerfacecolor=card["accent"], markeredgecolor=card["ink"], zorder=5)
    axes.annotate(name, place, xytext=(11, 0), textcoords="offset points", va="center", fontsize=10.5,
                  fontweight="bold", color=card["ink"], zorder=6,
                  path_effects=[withStroke(linewidth=3.5, foreground="white")])  # fmt: skip


# ---------------------------------------------------------------------------------------------------------------- frame


@contextmanager
def chart(path: Path, title: str, about: str) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Axes to draw into, and the palette; the file is written at the end."""
    import matplotlib
    from matplotlib import font_manager
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    colours = tomllib.loads((resources.folder("assets") / "palette.toml").read_text("utf-8"))
    for file in sorted((resources.folder("assets") / "fonts").glob("*.ttf")):
        font_manager.fontManager.addfont(str(file))
    ink, quiet_ink, quiet = (colours["card"][name] for name in ("ink", "ink_quiet", "quiet"))
    with matplotlib.rc_context({"font.family": ["Noto Sans", "sans-serif"]}):
        figure = Figure(figsize=_SIZE, dpi=_DOTS, facecolor="white", layout=ConstrainedLayoutEngine(rect=_FRAME))
        axes = figure.subplots()
        axes.set_title(f"{about}\n", loc="left", fontsize=10, color=quiet_ink)
        axes.annotate(title, (0, 1), xytext=(0, 36), xycoords="axes fraction", textcoords="offset points",
                      fontsize=15, fontweight="bold", color=ink)  # fmt: skip
        for side, colour in (("top", "none"), ("right", "none"), ("left", quiet), ("bottom", quiet)):
            axes.spines[side].set_color(colour)
        axes.tick_params(colors=quiet_ink, which="both", labelsize=9.5)
        axes.tick_params(which="minor", length=0)
        axes.xaxis.label.set_color(quiet_ink)
        axes.yaxis.label.set_color(quiet_ink)
        yield axes, colours
        with written_whole(path) as out:
            figure.savefig(out.buffer, format="png")
