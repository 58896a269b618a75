"""Charts of sweeps: a map over two parameters, a curve or a strip over one."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.axes import Axis, Values, label, result_label
from sandbox.lab.chart import PLATE, legend
from sandbox.lab.plan import Plan
from sandbox.lab.report import Chart, Panel
from sandbox.lab.row_file import cell
from sandbox.parameters import value_at
from sandbox.sport.amounts import significant
from sandbox.text import no_such_result, with_noun

#: Most words in a legend; rarer ones are grouped.
_MOST_WORDS, _OTHERS = 8, "others"

#: Cells of what did not happen.
NOTHING = (None, "", "false", "[]", "{}")

#: Points that failed.
FAILED = "failed"

#: Colour map of numbers: perceptually uniform, and safe for the colour-blind.
_HEIGHTS = "viridis"

#: Fewest cells along an axis for contour lines.
_FEWEST_FOR_LINES = 8

#: Most cells with outlines, and most points of a curve marked with dots.
_MOST_OUTLINED, _MOST_DOTS = 40_000, 60

#: Most curves of a chart, and the largest range of integers with a colour each.
_MOST_CURVES, _MOST_COUNTS = 6, 12


#: The cells of a row by column, as a file has them.
Row = Mapping[str, str]


@dataclass(frozen=True)
class ChartData:
    """The columns that a chart needs: numbers, NaN where missing, or words."""

    axes: list[np.ndarray]  # position of each point along each axis; words are at 0, 1, 2...
    label: str  # of what is shown, with its unit
    numbers: np.ndarray | None
    words: list[str]  # of the same length as the axes; empty if the column shown is a number
    good: frozenset[str]  # words that stand for success

    @property
    def counts(self) -> bool:
        """True if the numbers are few integers, for which contour lines make no sense."""
        if self.numbers is None:
            return False
        known = self.numbers[np.isfinite(self.numbers)]
        return bool(known.size and (known == np.round(known)).all() and np.ptp(known) <= _MOST_COUNTS)


def check_plot(plan: Plan, of: str | None, family: str | None = None) -> None:
    """Raise RequestError, before any work is done, if the chart cannot be drawn."""
    if family is not None:
        if family not in plan.keys:
            raise RequestError(f"--family {family}: is not swept over; choose from {', '.join(plan.keys)}")
        if len(plan.axes) != 2 or not plan.is_grid:
            raise RequestError(f"--family {family}: a family of curves needs a grid over two parameters")
        curves = plan.shape[plan.keys.index(family)]
        if curves > _MOST_CURVES:
            raise RequestError(f"--family {family}: {curves} values are too many curves; the most is {_MOST_CURVES}")
    if len(plan.axes) > 2:
        raise RequestError(f"--plot shows one or two parameters, not {len(plan.axes)}: {', '.join(plan.keys)}")
    if any(len(axis.values) < 2 for axis in plan.axes if isinstance(axis, Values)):
        raise RequestError("--plot needs two values or more along each parameter")
    if of is not None and of not in plan.columns:
        raise RequestError(f"--of {of}: {no_such_result(of, plan.columns[:-1])}")


def chart_of(plan: Plan, found: ChartData, family: str | None = None) -> Chart:
    """Over two parameters a map, or for each value of ``family``, one of them, a curve with its greatest value marked.
    Raises RequestError for a family of what is not a number."""
    if family is not None and found.numbers is None:
        raise RequestError(f"--family {family}: curves need a number, and {found.label} is not one; name another --of")
    shots = f"{plan.samples:,} shots at random" if plan.samples else with_noun(plan.size, "shot")
    drawn = axes_shown(plan, found, family)
    x, y = (label(plan.scene, plan.axes[place].key) for place in (drawn[0], drawn[-1]))
    if len(drawn) == 1:
        y = found.label if found.numbers is not None else ""
    title = f"{plan.scene.title}: {found.label.partition(' (')[0]}"
    panel = Panel(partial(_draw, plan, found, drawn, family), x, y)
    return Chart([panel], title, f"{shots}; all other parameters as in the scene file")


def axes_shown(plan: Plan, found: ChartData, family: str | None = None) -> list[int]:
    """The places of the axes that the chart has: both, or the one along which curves run."""
    if len(plan.axes) == 2 and found.numbers is not None and plan.is_grid:
        several = [axis for axis in plan.axes if axis.key == family or (family is None and not has_numbers(axis))]
        if len(several) == 1 and isinstance(several[0], Values) and len(several[0].values) <= _MOST_CURVES:
            return [1 - plan.axes.index(several[0])]
    return list(range(len(plan.axes)))


def _draw(
    plan: Plan, found: ChartData, drawn: Sequence[int], family: str | None, axes: Any, colours: Mapping[str, Any]
) -> None:
    if len(drawn) == 1 and found.numbers is not None:
        _curves(axes, plan, found, drawn[0], family)
    else:
        (_map if plan.is_grid or len(drawn) != 2 else _cloud)(axes, plan, found, colours)
    for place, side in zip(drawn, ("x", "y"), strict=False):
        axis = plan.axes[place]
        if isinstance(axis, Values) and not has_numbers(axis):
            axes.set(**{f"{side}ticks": range(len(axis.distinct))})
            axes.set(**{f"{side}ticklabels": [cell(value) for value in axis.distinct]})
    own = own_place(plan)
    if own is not None:
        _mark_own(axes, [own[place] for place in drawn], found, found.axes[drawn[0]], colours["card"]["ink"])


# ---------------------------------------------------------------------------------------------------------------------
# What to show
# ---------------------------------------------------------------------------------------------------------------------


def read(plan: Plan, rows: Iterable[Row], of: str | None) -> ChartData:
    """The swept columns and the one to show. Raises RequestError if every point failed."""
    scene = plan.scene
    column = of or ("verdict" if "verdict" in plan.facts_read else next(iter(plan.facts_read), "ended"))
    places: list[list[str]] = [[] for _ in plan.keys]
    texts: list[str] = []
    won: list[bool] = []
    for row in rows:
        for place, key in zip(places, plan.keys, strict=True):
            place.append(row[key])
        texts.append(row[column] if not row["error"] else FAILED)
        won.append(row.get(scene.controls.scores) not in NOTHING)
    if all(text == FAILED for text in texts):
        raise RequestError("--plot: every point failed, there is nothing to show")
    swept = [_column(axis, place) for axis, place in zip(plan.axes, places, strict=True)]
    numbers = _numbers(["" if text == FAILED else text for text in texts])
    if numbers is not None:
        return ChartData(swept, result_label(scene, column), numbers, [], frozenset())
    in_order = column not in scene.facts or scene.facts[column].in_order
    words = [text if text == FAILED else _word(text, in_order) for text in texts]
    scored, all_of = Counter(word for word, wins in zip(words, won, strict=True) if wins), Counter(words)
    good = frozenset(word for word in all_of if 2 * scored[word] > all_of[word])
    return ChartData(swept, result_label(scene, column), None, words, good)


def _word(text: str, in_order: bool) -> str:
    """A cell as a legend has it: of a table its names, and of a list whose order is of no interest the sorted words."""
    try:
        held = json.loads(text)
    except ValueError:
        held = None
    if not isinstance(held, list | dict):  # it is a word, or a number among words
        return text or "none"
    names = [name if isinstance(name, str) else json.dumps(name) for name in held]
    if isinstance(held, dict) or not in_order:
        names.sort(key=lambda name: (len(name), name))  # 9 before 10
    return ", ".join(names) or "none"


def _column(axis: Axis, texts: Sequence[str]) -> np.ndarray:
    if has_numbers(axis):
        return np.array([float(text) for text in texts])
    assert isinstance(axis, Values)  # a span has numbers
    order = {cell(value): place for place, value in enumerate(axis.distinct)}
    return np.array([float(order[text]) for text in texts])


def has_numbers(axis: Axis) -> bool:
    return not isinstance(axis, Values) or all(isinstance(value, float) for value in axis.values)


def _numbers(texts: Sequence[str]) -> np.ndarray | None:
    """The texts as numbers, NaN for an empty one; None if one is not a number, or all are empty."""
    if not any(texts):
        return None
    try:
        return np.array([float(text) if text else np.nan for text in texts])
    except ValueError:
        return None


def own_place(plan: Plan) -> list[float] | None:
    """Positions of the scene's own values along the axes, if they lie on them."""
    own: list[float] = []
    for axis in plan.axes:
        value = value_at(plan.scene.parameters, axis.key)
        if isinstance(axis, Values) and not has_numbers(axis):
            if value not in axis.values:
                return None
            own.append(float(axis.distinct.index(value)))
            continue
        ends = axis.values if isinstance(axis, Values) else (axis.low, axis.high)
        if not isinstance(value, float) or not min(ends) <= value <= max(ends):
            return None
        own.append(value)
    return own


# ---------------------------------------------------------------------------------------------------------------------
# Drawing
# ---------------------------------------------------------------------------------------------------------------------


def _curves(axes: Any, plan: Plan, found: ChartData, along: int, family: str | None) -> None:
    """A number over one axis, with a curve for each value of the other, if there is one."""
    values, names = np.zeros(1), [""]
    if len(plan.axes) == 2:
        other = plan.axes[1 - along]
        assert isinstance(other, Values)
        values = np.unique(found.axes[1 - along])
        named = values.tolist() if has_numbers(other) else other.distinct
        names = [f"{value:g}" if isinstance(value, float) else cell(value) for value in named]
    assert found.numbers is not None
    for value, name in zip(values, names, strict=True):
        here = found.axes[1 - along] == value if len(plan.axes) == 2 else np.full(len(found.numbers), True)
        order = np.argsort(found.axes[along][here])
        style = "-" if has_numbers(plan.axes[along]) else ""
        dots = "o" if len(order) <= _MOST_DOTS and family is None else ""
        x, y = found.axes[along][here][order], found.numbers[here][order]
        (line,) = axes.plot(x, y, linestyle=style, marker=dots, markersize=3.5, label=name)
        if family is not None and np.isfinite(y).any():
            best = int(np.nanargmax(y))
            if 0 < best < len(y) - 1:
                axes.plot(x[best], y[best], "o", markersize=7, color=line.get_color())
                axes.annotate(significant(float(x[best]), 3), (x[best], y[best]), xytext=(0, 9),
                              textcoords="offset points", ha="center", fontsize=9.5, bbox=PLATE)  # fmt: skip
    axes.grid(axis="y")
    if len(plan.axes) == 2:
        legend(axes, title=label(plan.scene, plan.axes[1 - along].key), alignment="left")


def _map(axes: Any, plan: Plan, found: ChartData, colours: Mapping[str, Any]) -> None:
    """Cells over two axes, or in a strip over one, coloured by a word, or by a number with contour lines."""
    from matplotlib.colors import ListedColormap

    shape = plan.shape if len(plan.axes) == 2 else (plan.size, 1)
    places = [found.axes[0].reshape(shape)[:, 0], found.axes[-1].reshape(shape)[0] if len(plan.axes) == 2 else [0.0]]
    orders = [np.argsort(place) for place in places]
    across, up = (np.asarray(place)[order] for place, order in zip(places, orders, strict=True))
    if len(plan.axes) == 1:
        up = np.array([0.0, 1.0])
        axes.set_yticks([])

    def grid(values: np.ndarray) -> Any:
        cells = values.reshape(shape)[np.ix_(*orders)].T
        return np.repeat(cells, len(up) // len(cells), axis=0)

    if found.words:
        chosen, codes = _coded(found, colours)
        cells = grid(codes)
        colour_map = ListedColormap(list(chosen.values()))
        mesh = axes.pcolormesh(across, up, cells, shading="nearest", cmap=colour_map, vmin=-0.5,
                               vmax=len(chosen) - 0.5, rasterized=True)  # fmt: skip
        _outline(axes, mesh.get_coordinates(), cells, colours["card"]["ink"])
        _legend(axes, found, chosen, colours)
        return
    assert found.numbers is not None
    heights = np.ma.masked_invalid(grid(found.numbers))
    mesh = axes.pcolormesh(across, up, heights, shading="nearest", rasterized=True, **_colours(found, heights))
    _key(axes, mesh, found)
    if not found.counts and min(heights.shape) >= _FEWEST_FOR_LINES and heights.count() > 1:
        lines = axes.contour(across, up, heights, levels=8, colors="white", linewidths=0.7, alpha=0.8)
        axes.clabel(lines, fontsize=8.5, fmt=significant)


def _colours(found: ChartData, heights: np.ma.MaskedArray[Any, Any]) -> dict[str, Any]:
    """The colours of numbers; one for each whole number if these are few."""
    if not found.counts:
        return {"cmap": _HEIGHTS}
    import matplotlib
    from matplotlib.colors import BoundaryNorm

    low, high = int(heights.min()), int(heights.max())
    count = high - low + 1
    norm = BoundaryNorm(np.arange(low, high + 2) - 0.5, count)
    return {"cmap": matplotlib.colormaps[_HEIGHTS].resampled(count), "norm": norm}


def _outline(axes: Any, corners: np.ndarray, cells: np.ndarray, ink: str) -> None:
    """A fine dark line between areas of different words; ``corners`` has shape (rows + 1, columns + 1, 2)."""
    from matplotlib.collections import LineCollection

    beside, above = cells[:, 1:] != cells[:, :-1], cells[1:] != cells[:-1]
    upright = np.stack([corners[:-1, 1:-1], corners[1:, 1:-1]], axis=2)[beside]
    level = np.stack([corners[1:-1, :-1], corners[1:-1, 1:]], axis=2)[above]
    if cells.size <= _MOST_OUTLINED:
        axes.add_collection(LineCollection([*upright, *level], colors=ink, linewidths=0.5, alpha=0.5))


def _cloud(axes: Any, plan: Plan, found: ChartData, colours: Mapping[str, Any]) -> None:
    """A dot for each shot."""
    size = float(np.clip(20_000 / max(len(found.axes[0]), 1), 2.0, 40.0))
    if found.numbers is not None:
        _key(axes, axes.scatter(*found.axes, c=found.numbers, s=size, cmap=_HEIGHTS), found)
        return
    chosen, codes = _coded(found, colours)
    for code, colour in reversed(list(enumerate(chosen.values()))):  # success on top
        axes.scatter(*(axis[codes == code] for axis in found.axes), s=size, color=colour)
    _legend(axes, found, chosen, colours)


def _mark_own(axes: Any, own: Sequence[float], found: ChartData, places: np.ndarray, ink: str) -> None:
    """Mark the scene file's own shot with a ring or a line."""
    text: dict[str, Any] = {"textcoords": "offset points", "fontsize": 9.5, "bbox": PLATE}
    if len(own) == 1:
        several = len(axes.get_lines()) > 1
        if several:
            axes.margins(y=0.18)  # room above all curves, and the name of the highest point
        axes.axvline(own[0], color=ink, linewidth=1.0, linestyle=(0, (4, 3)))
        top = several or not _is_high(found, places, own[0])  # away from the curve
        place, offset = (own[0], float(top)), (5, -6 if top else 6)
        text |= {"xycoords": ("data", "axes fraction"), "va": "top" if top else "bottom"}
    else:
        for colour, width in (("white", 3.5), (ink, 1.6)):
            axes.plot(*own, "o", markersize=11, markerfacecolor="none", markeredgecolor=colour, markeredgewidth=width)
        place, offset = (own[0], own[1]), (10, 0)
        text |= {"va": "center"}
    axes.annotate("scene file", place, xytext=offset, **text)


def _is_high(found: ChartData, places: np.ndarray, own: float) -> bool:
    """True if the curve is in the upper half of its range at the scene file's own shot."""
    if found.numbers is None or not np.isfinite(found.numbers).any():
        return False
    height = found.numbers[np.nanargmin(np.abs(places - own))]
    return bool(height > 0.5 * (np.nanmin(found.numbers) + np.nanmax(found.numbers)))


def _coded(found: ChartData, colours: Mapping[str, Any]) -> tuple[dict[str, str], np.ndarray]:
    """A colour for each word, success vivid and the most common first, and the index of each point's colour."""
    counts = Counter(found.words)
    failures = counts.pop(FAILED, 0)
    ordered = sorted(counts, key=lambda word: (word not in found.good, -counts[word], word))
    if len(ordered) > _MOST_WORDS:
        rare = set(sorted(counts, key=lambda word: counts[word])[: len(ordered) - _MOST_WORDS + 1])
        ordered = [word for word in ordered if word not in rare]
    vivid, quiet = iter(colours["sweep"]["good"]), iter(colours["sweep"]["other"])
    chosen = {word: next(vivid) if word in found.good or not found.good else next(quiet) for word in ordered}
    if len(ordered) < len(counts):
        chosen[_OTHERS] = colours["sweep"]["rest"]
    if failures:
        chosen[FAILED] = colours["sweep"]["failed"]
    places = {word: place for place, word in enumerate(chosen)}
    return chosen, np.array([places.get(word, places.get(_OTHERS, 0)) for word in found.words])


def _legend(axes: Any, found: ChartData, chosen: Mapping[str, str], colours: Mapping[str, Any]) -> None:
    """Legend of the colours, with the share of each."""
    from matplotlib.patches import Patch

    counts = Counter(word if word in chosen else _OTHERS for word in found.words)
    edge = {"edgecolor": colours["card"]["quiet"], "linewidth": 0.5}
    shares = {word: 100.0 * counts[word] / len(found.words) for word in chosen}
    texts = {word: f"{share:.1f} %" if share >= 0.1 else f"{counts[word]}" for word, share in shares.items()}
    legend(axes, handles=[Patch(facecolor=chosen[word], label=f"{word}  {texts[word]}", **edge) for word in chosen])


def _key(axes: Any, drawn: Any, found: ChartData) -> None:
    """The colour scale."""
    bar = axes.figure.colorbar(drawn, ax=axes, aspect=30, pad=0.02, label=found.label)
    bar.outline.set_visible(False)
    if found.numbers is not None and found.counts:
        bar.set_ticks(np.arange(np.nanmin(found.numbers), np.nanmax(found.numbers) + 1))
    bar.ax.tick_params(length=0)
