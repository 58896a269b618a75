"""What people read, kept as text: cards, and the tables and charts of the lab."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from sandbox.engine.model.accuracy import LEVELS
from sandbox.lab import ablation, chart, maps, row_file, stress, trade, validate
from sandbox.lab.aim import Aim, aim
from sandbox.lab.axes import parse_axis
from sandbox.lab.plan import Plan
from sandbox.lab.report import Report, as_text
from sandbox.lab.stress import FAILED, HELD, REFUSED, SENSELESS, Outcome
from sandbox.lab.sweep import sweep_to_file, workers
from sandbox.lab.verdicts import VerdictChanges, Verdicts
from sandbox.scene import load
from tests.own_scene import DROP

# Scenes ---------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["golf", "billiards/bank"])
def test_a_card(name: str, call, printed):
    """Of one ball and of several, as metric and US numbers, without what it cost to compute. The numbers of all scenes
    are read back in ``tests/scenes/test_every_scene.py``."""
    told = "".join(call("run", name, "--units", units).out for units in ("si", "us"))
    printed(f"card-{name.replace('/', '-')}", re.sub(r": \d+ steps.*", "", told))


# Tables ---------------------------------------------------------------------------------------------------------------


def compared(value: str, computed: Any, tolerance: float | None, unit: str = "m", reason: str = "") -> Any:
    difference = None if tolerance is None or computed is None else computed - float(value)
    holds = computed == value if difference is None else abs(difference) <= (tolerance or 0.0)
    case = "golf/driver", "", "long drive", "landing_speed", value, tolerance, unit, "a table of 2012", reason
    case = *case, "measured", "drag", "the last digit"
    return validate.Compared(*case, computed=computed, difference=difference, holds=holds, preset="driver")


def test_the_table_of_validate(printed):
    """Digits: one more than published, as far as the tolerance has them; words, and what did not happen."""
    rows = [
        compared("200", 200.4321, 1.0),
        compared("200", 198.0, 1.0, reason="another ball"),
        compared("31.25", 31.2512, 0.01),
        compared("31.25127", 31.2, 0.1),
        compared("1.5e-3", 0.00151, 1e-4),
        compared("0.123456789012", 0.123456789, 1e-12),
        compared("12", 12.0, 250.0, ""),
        compared("in", "in", None, ""),
        compared("in", None, None, ""),
        replace(compared("5", 5.0, 1.0), scene="throws", preset="", source="another", kind="exact"),
    ]
    printed("validate", "\n".join(as_text(validate.report_of(rows))))


def test_the_tables_of_stress(printed):
    numbers: list[tuple[str, float | None, float | None]] = [
        (HELD, 1e-9, 2e-6), (HELD, 0.0, 0.0), (REFUSED, None, None), (FAILED, 0.25, 0.0123),
    ]  # fmt: skip
    outcomes = [
        Outcome(scene, extreme, method, word, "" if word == HELD else "too fast", 1.0, energy, overlap)
        for scene in ("golf", "")
        for extreme, shift in (("step 0.5 s", 0), ("step 0.1 s", 1), ("all highest", 2))
        for place, method in enumerate(("dormand-prince", "heun", "plain"))
        for word, energy, overlap in [numbers[(place + shift) % 4]]
    ]
    outcomes.append(Outcome("golf", "board upside down", "heun", SENSELESS, "board.top is below board.bottom"))
    printed("stress", "\n".join(as_text(stress.report_of(outcomes))))
    printed("stress-all", "\n".join(as_text(stress.report_of(outcomes), everything=True)))


def test_the_tables_of_what_parts_of_a_model_do(printed):
    part = ablation.Ablated("drag", "left out", ("in", "in"), 1.234, 0.5678, {"carry": (200.04, 260.1)}, 0.25, 0.01)
    rows = [
        part,
        replace(part, verdict=("hit, off the post, out", "hit, in"), saves=0.02, saves_noise=0.011),
        replace(part, shift_m=5e-5, flight_m=0.0, saves=-0.3),
        replace(part, shift_m=1e-9, flight_m=1e-9, idle=True, saves=0.009, saves_noise=0.0, resolution_m=1e-6),
        replace(part, results={"a": (1.0, 2.0), "b": (3.0, 4.0), "c": (5.0, 6.0)}, saves=None),
        replace(part, shift_m=None, problem="diverged"),
    ]
    printed("ablation", "\n".join(as_text(Report(dict, "parts", ablation.tables(rows, 1.23456)), everything=True)))


def measured() -> trade.Trade:
    """A trade with settings of known errors and times."""

    def point(
        method: str, setting: str, error: float | None, wall: float, stable: bool = True, said: str = ""
    ) -> trade.Point:
        return trade.Point(method, setting, LEVELS["fast"], error, wall, 3, int(1e5 * wall), 2.0 / wall, stable, said)

    points = [
        point("plain", "1/2 s", 3.21, 1e-4, stable=False),
        point("plain", "1/20 s", None, 1e-3, False, "tunnelled: t = 1 s, ball 'ball': went through 'fairway'"),
        point("plain", "1/60 s", 0.12, 2e-3),
        point("plain", "1/1000 s", 9e-3, 0.03),
        point("heun", "1/10 s", 0.04, 6e-4),
        point("heun", "1/240 s", 3e-5, 5e-3),
        point("heun", "1/4000 s", None, 0.1, said="t = 1 s, ball 'ball': diverged"),
        point("dormand-prince", "1e-06 m", 2e-10, 9e-4),
    ]
    errors = (1e-4, 2e-3), (5e-7, 7e-4), (1e-10, 1.2e-3)
    levels = {name: point("level", name, *each) for name, each in zip(LEVELS, errors, strict=True)}
    reference: Any = SimpleNamespace(scene=load("golf"), time=2.0, error=1e-11, points={"ball": (1.0, 2.0)})
    reference.closed_form, reference.growth, reference.diverges_at = False, 34.5, None
    methods = {"fast": Verdicts(224, 1, 0), "precise": Verdicts(225, 0, 0), "plain 1/60 s": Verdicts(219, 2, 4)}
    failures = {"plain 1/60 s": {"tunnelled": 3, "RunError": 1}}
    verdicts = VerdictChanges(("launch.speed", "launch.angle"), 225, methods, failures)
    return trade.Trade(reference, points, levels, [], verdicts)


def test_the_tables_of_trade(printed):
    printed("trade", "\n".join(as_text(trade.report_of(measured()))))
    printed("trade-all", "\n".join(as_text(trade.report_of(measured()), everything=True)))


#: Searches of a falling ball, by their names.
SEARCHES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "number": ({"launch.height": (0.5, 9)}, {"target": {"first_touch": 0.9}}),
    "jump": ({"launch.height": (0.5, 9)}, {"target": {"bounces": 1.5}}),
    "none": ({"launch.height": (0.5, 9)}, {"target": {"first_touch": 5.0}}),
    "interval": ({"launch.height": (0.5, 9)}, {"target": {"bounced": True}}),
    "intervals": ({"launch.height": (0.5, 9)}, {"target": {"bounced": False}}),
    "greatest": ({"launch.height": (0.5, 2)}, {"maximize": "final_height"}),
    "greatest of two": ({"launch.height": (0.5, 2), "launch.speed": (0, 3)}, {"maximize": "final_height"}),
    "region": ({"launch.height": (1, 9), "launch.speed": (0, 3)}, {"target": {"bounced": False}}),
    "pair": ({"launch.height": (1, 2), "launch.speed": (0, 3)}, {"target": {"first_touch": 0.7, "final_height": 1}}),
}


def searched(name: str) -> Aim:
    spans, wanted = SEARCHES[name]
    return aim(str(DROP), spans, **wanted)


@pytest.mark.parametrize("name", SEARCHES)
def test_a_search_and_its_chart(name: str, printed, tmp_path: Path):
    found = searched(name).report()
    printed(f"aim-{name.replace(' ', '-')}", "\n".join([*as_text(found), "", *described(found, tmp_path)]))


# Charts ---------------------------------------------------------------------------------------------------------------


def described(report: Report, folder: Path) -> list[str]:
    """All that its charts show, as lines: texts, ticks, curves, areas, with colours and sizes; without drawing it."""
    figures: list[Figure] = []
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(Figure, "savefig", lambda figure, *args, **kwargs: figures.append(figure))
        chart.draw(report, folder / "chart.png")
    (figure,) = figures
    heading = [f"heading {text.get_text()}" for text in figure.texts]
    return [*heading, *(line for axes in figure.axes for line in _axes_lines(axes))]


def _axes_lines(axes: Any) -> Iterator[str]:
    yield f"axes {axes.get_xlabel()} | {axes.get_ylabel()} | {_short([*axes.get_xlim(), *axes.get_ylim()])}"
    grid = [line.get_visible() for line in axes.yaxis.get_gridlines()[:1]]
    yield f"scales {axes.get_xscale()} {axes.get_yscale()}, grid {grid}"
    yield f"title {axes.get_title('left').strip()}"
    for text in axes.texts:
        place = [*getattr(text, "xyann", ()), text.get_fontsize(), text.get_zorder()]
        colour = to_hex(text.get_color(), keep_alpha=True)
        yield f"text {text.get_text()} | {_short(place)} {colour} {text.get_ha()} {text.get_va()}"
    for line in axes.lines:
        look = [line.get_linewidth(), line.get_markersize(), line.get_zorder()]
        style = f"{line.get_color()} {line.get_linestyle()} {line.get_marker()} {line.get_label()}"
        yield f"line {len(line.get_xdata())} {style} {_short(look)} | {_short(_ends(line.get_xydata()))}"
    for part in axes.collections:
        values = np.ma.compressed(np.ma.masked_invalid(part.get_array())) if part.get_array() is not None else []
        numbers = [
            *np.ma.filled(np.ravel(part.get_offsets()), -1.0)[:2],
            *np.ravel(part.get_linewidths())[:1],
            part.get_zorder(),
        ]
        colours = np.round(part.get_facecolor(), 3).tolist()[:2]
        spread = [len(values), *(f(values) for f in (np.min, np.max, np.mean) if len(values))]
        yield f"{type(part).__name__} {_short(numbers)} {colours} {part.get_label()} | {_short(spread)}"
        if hasattr(part, "get_sizes"):
            yield f"  {len(part.get_offsets())} of size {_short(part.get_sizes()[:1])}"
        if hasattr(part, "get_segments"):
            yield f"  {len(part.get_segments())} lines"
        if hasattr(part, "get_coordinates"):
            yield f"  corners {_short(_ends(part.get_coordinates().reshape(-1, 2)))}"
    if axes.get_legend() is not None:
        yield f"legend {[text.get_text() for text in axes.get_legend().get_texts()]}"


def _ends(points: Any) -> list[float]:
    """The first and the last of some points."""
    array = np.asarray(points, float)
    return [*array[0].tolist(), *array[-1].tolist()] if len(array) else []


def _short(numbers: Sequence[Any]) -> str:
    return " ".join(f"{float(number) + 0.0:.4g}" for number in numbers)


#: Sweeps of a falling ball: what they show, and their axes.
SWEEPS = {
    "curve": ("final_height", ["launch.height=1:2:5"]),
    "curves": ("final_height", ["launch.height=1:2:5", "ball.drag.model=none,constant"]),
    "words": ("bounced", ["launch.height=3:7:9", "launch.speed=0:2:4"]),
    "counts": ("bounces", ["launch.height=1:7:9", "launch.speed=0:2:5"]),
    "heights": ("final_height", ["launch.height=1:2:9", "launch.speed=0:2:9"]),
    "strip": ("bounced", ["launch.height=0.1:10:12"]),
    "missing": ("first_touch", ["launch.height=3:7:9", "launch.speed=0:2:4"]),
}


@pytest.mark.parametrize("name", SWEEPS)
@pytest.mark.parametrize("samples", [0, 20])
def test_the_chart_of_a_sweep(name: str, samples: int, printed, tmp_path: Path):
    of, over = SWEEPS[name]
    if samples and len(over) == 1:
        pytest.skip("a sample over one parameter is a curve")
    scene, rows = load(str(DROP)), tmp_path / "rows.csv"
    plan = Plan(scene, tuple(parse_axis(scene, "--over", text) for text in over), samples=samples)
    with workers(1) as pool:
        sweep_to_file(plan, rows, pool)
    shown = maps.chart_of(plan, maps.read(plan, row_file.rows(rows), of))
    lines = described(Report(dict, "", [shown]), tmp_path)
    printed(f"sweep-{name}{'-samples' * bool(samples)}", "\n".join(lines))


def test_the_chart_of_trade(printed, tmp_path: Path):
    printed("trade-chart", "\n".join(described(trade.report_of(measured()), tmp_path)))
