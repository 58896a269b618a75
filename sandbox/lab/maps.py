"""Charts of sweeps: a map over two parameters, a curve or a strip over one, in the frame of chart.py."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from sandbox import parameters as declared
from sandbox.errors import RequestError
from sandbox.lab.axes import Axis, Values, at, label, result_label
from sandbox.lab.chart import chart, check_installed
from sandbox.lab.plan import CHANGED, FLAGS, Plan, records
from sandbox.lab.row_file import cell, rows
from sandbox.lab.tables import significant
from sandbox.parameters import path_of

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


@dataclass(frozen=True)
class Found:
    """The columns that a chart needs: numbers, NaN where missing, or words."""

    axes: list[np.ndarray]  # position of each point along each axis; words are at 0, 1, 2...
    name: str  # of what is shown
    label: str  # the same with its unit
    numbers: np.ndarray | None
    words: list[str]  # of the same length as the axes; empty if the column shown is a number
    good: frozenset[str]  # words that stand for success


def check_plot(plan: Plan, of: str | None) -> None:
    """Raise RequestError, before any work is done, if the chart cannot be drawn."""
    check_installed("--plot")
    if len(plan.axes) > 2:
        raise RequestError(f"--plot shows one or two parameters, not {len(plan.axes)}: {', '.join(plan.keys)}")
    if any(len(axis.values) < 2 for axis in plan.axes if isinstance(axis, Values)):
        raise RequestError("--plot needs two values or more along each parameter")
    first = records(plan, 0, 1)[0]
    if of is not None and of not in first and not first["error"]:
        raise RequestError(_no_such(of, first))


def _no_such(name: str, columns: Iterable[str]) -> str:
    return f"--of {name}: {declared.no_such_result(name, [each for each in columns if each != 'error'])}"


def draw_sweep(plan: Plan, file: Path, path: Path, of: str | None = None) -> None:
    """A chart of the rows in ``file``; ``of`` names the column, by default the verdict or the first result."""
    found = read(plan, file, of)
    name = f"{plan.scene.name}/{plan.scene.preset}" if plan.scene.preset else plan.scene.name
    title = f"{name}: {found.label.partition(' (')[0]}"
    with chart(path, title, _about(plan)) as (axes, colours):
        labels = [label(plan.scene, axis.key) for axis in plan.axes]
        along = _along(plan, found)
        if along is not None:
            _curves(axes, plan, found, along, colours)
            labels = [labels[along], found.label]
        elif len(plan.axes) == 1:
            _line(axes, plan, found, colours)
            _tick_words(axes, plan)
        elif plan.samples:
            _cloud(axes, found, colours)
            _tick_words(axes, plan)
        else:
            _map(axes, plan, found, colours)
            _tick_words(axes, plan)
        _mark_own(axes, plan, found, along, colours)
        axes.set_xlabel(labels[0])
        axes.set_ylabel(labels[1] if len(labels) == 2 else found.label if not found.words else "")


# ---------------------------------------------------------------------------------------------------------------------
# What to show
# ---------------------------------------------------------------------------------------------------------------------


def read(plan: Plan, file: Path, of: str | None) -> Found:
    """The swept columns and the one to show. Raises RequestError if there is no such column."""
    table = rows(file)
    first = next(table, {})
    names = [name for name in first if name not in (*plan.keys, *FLAGS, CHANGED, "ended", "error")]
    shown = of or ("verdict" if "verdict" in names else next(iter(names), None))
    if shown is None:
        raise RequestError("--plot: every point failed, there is nothing to show")
    if shown not in first:
        raise RequestError(_no_such(shown, list(first)))
    scores = plan.scene.controls.scores
    places: list[list[str]] = [[] for _ in plan.keys]
    texts: list[str] = []
    won: list[bool] = []
    for row in _chained(first, table):
        for place, key in zip(places, plan.keys, strict=True):
            place.append(row[key])
        texts.append(row[shown] if not row["error"] else FAILED)
        won.append(row.get(scores) not in NOTHING)
    swept = [_column(axis, place) for axis, place in zip(plan.axes, places, strict=True)]
    numbers = _numbers(["" if text == FAILED else text for text in texts])
    if numbers is not None:
        return Found(swept, shown, result_label(plan.scene, shown), numbers, [], frozenset())
    in_order = shown not in plan.scene.facts or plan.scene.facts[shown].in_order
    words = [text if text == FAILED else _word(text, in_order) for text in texts]
    scored, all_of = Counter(word for word, wins in zip(words, won, strict=True) if wins), Counter(words)
    good = frozenset(word for word in all_of if 2 * scored[word] > all_of[word])
    return Found(swept, shown, result_label(plan.scene, shown), None, words, good)


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


def _chained(first: Mapping[str, str], rest: Iterable[Mapping[str, str]]) -> Iterable[Mapping[str, str]]:
    if first:
        yield first
    yield from rest


def _column(axis: Axis, texts: Sequence[str]) -> np.ndarray:
    if _has_numbers(axis):
        return np.array([float(text) for text in texts])
    assert isinstance(axis, Values)  # a span has numbers
    order = {cell(value): place for place, value in enumerate(axis.values)}
    return np.array([float(order[text]) for text in texts])


def _numbers(texts: Sequence[str]) -> np.ndarray | None:
    """The texts as numbers, NaN for an empty one; None if one is not a number, or all are empty."""
    if not any(texts):
        return None
    try:
        return np.array([float(text) if text else np.nan for text in texts])
    except ValueError:
        return None


def _about(plan: Plan) -> str:
    spread = f"{plan.samples:,} shots at random" if plan.samples else f"{plan.size:,} shots"
    return f"{spread}; all other parameters as in the scene file"


def _own(plan: Plan) -> list[float] | None:
    """Positions of the scene's own values along the axes, if they lie on them."""
    own: list[float] = []
    for axis in plan.axes:
        value = at(plan.scene.parameters, path_of("over", axis.key))
        if isinstance(axis, Values) and not _has_numbers(axis):
            if value not in axis.values:
                return None
            own.append(float(axis.values.index(value)))
            continue
        ends = axis.values if isinstance(axis, Values) else (axis.low, axis.high)
        if not isinstance(value, float) or not min(ends) <= value <= max(ends):
            return None
        own.append(value)
    return own


# ---------------------------------------------------------------------------------------------------------------------
# Drawing
# ---------------------------------------------------------------------------------------------------------------------


def _map(axes: Any, plan: Plan, found: Found, colours: Mapping[str, Any]) -> None:
    """Cells over two axes, coloured by a word, or by a number with contour lines."""
    from matplotlib.colors import ListedColormap

    places = [_positions(axis) for axis in plan.axes]
    orders = [np.argsort(place) for place in places]
    across, up = (place[order] for place, order in zip(places, orders, strict=True))
    corners = _edges(across), _edges(up)
    if found.words:
        chosen, codes = _coded(found, colours)
        cells = codes.reshape(plan.shape)[np.ix_(*orders)].T
        axes.pcolormesh(*corners, cells, cmap=ListedColormap(list(chosen.values())), vmin=-0.5, vmax=len(chosen) - 0.5)
        _outline(axes, across, up, cells, colours)
        _legend(axes, found, chosen, colours)
        return
    assert found.numbers is not None
    heights = np.ma.masked_invalid(found.numbers.reshape(plan.shape)[np.ix_(*orders)].T)
    if _are_counts(found.numbers):
        _key(axes, axes.pcolormesh(*corners, heights, **_steps(heights)), found, colours)
        return
    _key(axes, axes.pcolormesh(*corners, heights, cmap=_HEIGHTS), found, colours)
    if min(heights.shape) >= _FEWEST_FOR_LINES and heights.count() > 1:
        lines = axes.contour(across, up, heights, levels=8, colors="white", linewidths=0.7, alpha=0.8)
        axes.clabel(lines, fontsize=8.5, fmt=significant)


def _are_counts(numbers: np.ndarray) -> bool:
    """Whether they are all integers, for which contour lines make no sense."""
    known = numbers[np.isfinite(numbers)]
    return bool(known.size and (known == np.round(known)).all() and np.ptp(known) <= _MOST_COUNTS)


def _steps(heights: np.ma.MaskedArray[Any, Any]) -> dict[str, Any]:
    """One colour for each whole number."""
    import matplotlib
    from matplotlib.colors import BoundaryNorm

    low, high = int(heights.min()), int(heights.max())
    count = high - low + 1
    return {
        "cmap": matplotlib.colormaps[_HEIGHTS].resampled(count),
        "norm": BoundaryNorm(np.arange(low, high + 2) - 0.5, count),
    }


def _outline(axes: Any, across: np.ndarray, up: np.ndarray, cells: np.ndarray, colours: Mapping[str, Any]) -> None:
    """A fine dark line between areas of different words."""
    x, y = _edges(across), _edges(up)
    lines = [((x[i + 1], y[j]), (x[i + 1], y[j + 1])) for j, i in np.argwhere(cells[:, 1:] != cells[:, :-1])]
    lines += [((x[i], y[j + 1]), (x[i + 1], y[j + 1])) for j, i in np.argwhere(cells[1:] != cells[:-1])]
    if lines and cells.size <= _MOST_OUTLINED:
        from matplotlib.collections import LineCollection

        axes.add_collection(LineCollection(lines, colors=colours["card"]["ink"], linewidths=0.5, alpha=0.5))


def _cloud(axes: Any, found: Found, colours: Mapping[str, Any]) -> None:
    """A dot for each random shot."""
    size = float(np.clip(20_000 / max(len(found.axes[0]), 1), 2.0, 40.0))
    if found.numbers is not None:
        dots = axes.scatter(*found.axes, c=found.numbers, s=size, cmap=_HEIGHTS, linewidths=0)
        _key(axes, dots, found, colours)
        return
    chosen, codes = _coded(found, colours)
    for code, colour in reversed(list(enumerate(chosen.values()))):  # success on top
        here = codes == code
        axes.scatter(found.axes[0][here], found.axes[1][here], s=size, color=colour, linewidths=0)
    _legend(axes, found, chosen, colours)


def _line(axes: Any, plan: Plan, found: Found, colours: Mapping[str, Any]) -> None:
    """A curve over one axis, or a strip of colours."""
    places = found.axes[0]
    order = np.argsort(places)
    places = places[order]
    if found.numbers is not None:
        marker = "o" if len(places) <= _MOST_DOTS else ""
        trace = colours["trace"]["colours"][0]
        axes.plot(places, found.numbers[order], color=trace, linewidth=1.8, marker=marker, markersize=3.5)
        axes.grid(axis="y", color=colours["card"]["quiet"], linewidth=0.5, alpha=0.4)
        return
    chosen, codes = _coded(found, colours)
    edges = _edges(places)
    for code, left, right in zip(codes[order], edges, edges[1:], strict=False):
        axes.axvspan(left, right, color=list(chosen.values())[code], linewidth=0)
    axes.set_yticks([])
    axes.set_xlim(edges[0], edges[-1])
    _legend(axes, found, chosen, colours)


def _along(plan: Plan, found: Found) -> int | None:
    """The axis of numbers, if a number is shown over numbers and words: then there is a curve for each word."""
    numeric = [place for place, axis in enumerate(plan.axes) if _has_numbers(axis)]
    words = [axis for axis in plan.axes if isinstance(axis, Values) and not _has_numbers(axis)]
    if plan.samples or found.numbers is None or len(numeric) != 1 or len(words) != 1:
        return None
    return numeric[0] if len(words[0].values) <= _MOST_CURVES else None


def _curves(axes: Any, plan: Plan, found: Found, along: int, colours: Mapping[str, Any]) -> None:
    """A curve over the numbers of one axis for each word of the other."""
    assert found.numbers is not None
    words = plan.axes[1 - along]
    assert isinstance(words, Values)
    for place, (word, colour) in enumerate(zip(words.values, colours["trace"]["colours"], strict=False)):
        here = found.axes[1 - along] == place
        order = np.argsort(found.axes[along][here])
        x, y = found.axes[along][here][order], found.numbers[here][order]
        marker = "o" if len(x) <= _MOST_DOTS else ""
        axes.plot(x, y, color=colour, linewidth=1.8, marker=marker, markersize=3.5, label=cell(word))
    axes.grid(axis="y", color=colours["card"]["quiet"], linewidth=0.5, alpha=0.4)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0, frameon=False, fontsize=10.5,
                labelcolor=colours["card"]["ink"], title=label(plan.scene, words.key), alignment="left")  # fmt: skip


def _mark_own(axes: Any, plan: Plan, found: Found, along: int | None, colours: Mapping[str, Any]) -> None:
    """Mark the scene file's own shot with a ring or a line."""
    own = _own(plan)
    if own is None:
        return
    if along is not None:
        own = [own[along]]
        found = replace(found, axes=[found.axes[along]])
    ink = colours["card"]["ink"]
    if len(own) == 1:
        axes.axvline(own[0], color=ink, linewidth=1.0, linestyle=(0, (4, 3)))
        top = not _is_high(found, own[0])  # away from the curve
        place, offset = (own[0], float(top)), (5, -6 if top else 6)
        offset_text: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "va": "top" if top else "bottom"}
    else:
        axes.plot(*own, marker="o", markersize=11, markerfacecolor="none", markeredgecolor="white", markeredgewidth=3.5)
        axes.plot(*own, marker="o", markersize=11, markerfacecolor="none", markeredgecolor=ink, markeredgewidth=1.6)
        place, offset, offset_text = (own[0], own[1]), (10, 0), {"va": "center"}
    offset_text |= {"xytext": offset, "textcoords": "offset points", "fontsize": 9.5, "color": ink}
    text = axes.annotate("scene file", place, **offset_text)
    text.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 1.5})


def _is_high(found: Found, own: float) -> bool:
    """Whether the curve is in the upper half of its range at the scene file's own shot."""
    if found.numbers is None or not np.isfinite(found.numbers).any():
        return False
    height = found.numbers[np.nanargmin(np.abs(found.axes[0] - own))]
    return bool(height > 0.5 * (np.nanmin(found.numbers) + np.nanmax(found.numbers)))


def _coded(found: Found, colours: Mapping[str, Any]) -> tuple[dict[str, str], np.ndarray]:
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


def _legend(axes: Any, found: Found, chosen: Mapping[str, str], colours: Mapping[str, Any]) -> None:
    """Legend of the colours, with the share of each."""
    from matplotlib.patches import Patch

    counts = Counter(word if word in chosen else _OTHERS for word in found.words)
    edge = {"edgecolor": colours["card"]["quiet"], "linewidth": 0.5}
    patches = [
        Patch(facecolor=colour, label=_share(word, counts[word], found), **edge) for word, colour in chosen.items()
    ]
    axes.legend(
        handles=patches,
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        borderaxespad=0.0,
        frameon=False,
        fontsize=10.5,
        labelcolor=colours["card"]["ink"],
    )


def _share(word: str, count: int, found: Found) -> str:
    percent = 100.0 * count / len(found.words)
    return f"{word}  {percent:.1f} %" if percent >= 0.1 else f"{word}  {count}"


def _key(axes: Any, drawn: Any, found: Found, colours: Mapping[str, Any]) -> None:
    """The colour scale."""
    bar = axes.figure.colorbar(drawn, ax=axes, aspect=30, pad=0.02)
    bar.outline.set_visible(False)
    if found.numbers is not None and _are_counts(found.numbers):
        bar.set_ticks(np.arange(np.nanmin(found.numbers), np.nanmax(found.numbers) + 1))
    bar.ax.tick_params(colors=colours["card"]["ink_quiet"], labelsize=9.5, length=0)
    bar.set_label(found.label, color=colours["card"]["ink_quiet"])


def _positions(axis: Axis) -> np.ndarray:
    """Positions of an axis' values: numbers at their value, words at 0, 1, 2..."""
    assert isinstance(axis, Values)  # a grid has no spans
    return np.array(axis.values) if _has_numbers(axis) else np.arange(float(len(axis.values)))


def _has_numbers(axis: Axis) -> bool:
    return not isinstance(axis, Values) or all(isinstance(value, float) for value in axis.values)


def _tick_words(axes: Any, plan: Plan) -> None:
    for axis, ticks in zip(plan.axes, (axes.set_xticks, axes.set_yticks), strict=False):
        if isinstance(axis, Values) and not _has_numbers(axis):
            ticks(range(len(axis.values)), [cell(value) for value in axis.values])


def _edges(places: np.ndarray) -> np.ndarray:
    """The borders of cells around sorted places."""
    middles = 0.5 * (places[1:] + places[:-1])
    return np.concatenate([[1.5 * places[0] - 0.5 * places[1]], middles, [1.5 * places[-1] - 0.5 * places[-2]]])
