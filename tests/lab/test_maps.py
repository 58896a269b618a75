"""Pictures of sweeps: they keep clear of the edges, and say where the scene file's own shot is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from PIL import Image

from sandbox.lab import chart, maps, row_file
from sandbox.lab.axes import parse_axis
from sandbox.lab.plan import Plan
from sandbox.lab.report import Report
from sandbox.lab.sweep import sweep_to_file, workers
from sandbox.scene import load
from tests.own_scene import DROP


def plan_of(source: str, *over: str) -> Plan:
    scene = load(source)
    return Plan(scene, tuple(parse_axis(scene, "--over", text) for text in over))


def report_of(plan: Plan, rows: Path, of: str) -> Report:
    """The chart of the rows of a sweep."""
    return Report(dict, "", [maps.chart_of(plan, maps.read(plan, row_file.rows(rows), of))])


@pytest.mark.parametrize(
    ("over", "place"),
    [
        (("launch.angle=5:20:4", "ball.drag.model=none,monitor-fit,constant"), [10.4, 1.0]),
        (("ball.drag.model=monitor-fit,none",), [0.0]),
        (("launch.angle=5:20:4", "ball.drag.model=none,constant"), None),
        (("launch.angle=15:20:4",), None),
    ],
)
def test_where_the_scene_files_own_shot_is(over, place):
    assert maps.own_place(plan_of("golf", *over)) == place


def test_a_picture_of_one_word_keeps_clear_of_the_edges(tmp_path: Path):
    plan, rows, plot = plan_of("basketball", "launch.angle=50:55:5"), tmp_path / "x.csv", tmp_path / "x.png"
    with workers(1) as pool:
        sweep_to_file(plan, rows, pool)
    chart.draw(report_of(plan, rows, "ended"), plot)
    with Image.open(plot) as picture:
        inked = np.asarray(picture.convert("RGB")).min(axis=2) < 250
    across, down = (np.flatnonzero(inked.any(axis=axis)) for axis in (0, 1))
    least = 0.015 * inked.shape[1]
    assert min(across[0], down[0], inked.shape[1] - across[-1], inked.shape[0] - down[-1]) > least


def axes_of(tmp_path: Path, of: str, *over: str) -> Axes:
    """The axes of the chart of a sweep."""
    plan, rows, shown = plan_of(str(DROP), *over), tmp_path / "x.csv", []
    with workers(1) as pool:
        sweep_to_file(plan, rows, pool)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(Figure, "savefig", lambda figure, *args, **kwargs: shown.append(figure.axes[0]))
        chart.draw(report_of(plan, rows, of), tmp_path / "x.png")
    (axes,) = shown
    return axes


def drawn(tmp_path: Path, of: str, *over: str) -> tuple[list[str], list[str]]:
    """The kinds of what a chart shows, and the words of its legend."""
    axes = axes_of(tmp_path, of, *over)
    legend = axes.get_legend()
    kinds = [type(part).__name__ for part in (*axes.collections, *axes.lines)]
    return kinds, [] if legend is None else [text.get_text() for text in legend.get_texts()]


def test_words_over_one_number_are_a_strip_that_fills_the_chart(tmp_path: Path):
    axes = axes_of(tmp_path, "bounced", "launch.height=0.1:10:4")
    (strip,) = (part for part in axes.collections if isinstance(part, QuadMesh))
    rows = strip.get_coordinates()[:, 0, 1]
    assert axes.get_ylim() == (rows[0], rows[-1])
    assert rows[0] < rows[-1]
    assert (np.asarray(strip.get_array()) == strip.get_array()[0]).all()
    assert len(set(strip.get_array()[0])) == 2
    assert not axes.get_yticks().size
    assert all(text.get_text().endswith(" %") for text in axes.get_legend().get_texts())


def test_a_number_over_words_is_a_curve_for_each_word(tmp_path):
    kinds, words = drawn(tmp_path, "final_height", "launch.height=1:2:4", "ball.drag.model=none,constant")
    assert "QuadMesh" not in kinds
    assert words == ["none", "constant"]


def written(name: str, *cells: str) -> str:
    rows = [f'{angle},"{cell}",{cell.count("6") > 0!s},\n'.lower() for angle, cell in enumerate(cells)]
    return f"cue.angle,{name},scored,error\n" + "".join(rows)


@pytest.mark.parametrize(
    ("name", "cells", "words"),
    [
        ("potted", ('[""7"", ""6""]', '[""6"", ""7""]', '[""10"", ""9""]', "[]"), ["6, 7", "6, 7", "9, 10", "none"]),
        ("potted", ('[""6""]', '[""6""]', "[]", "[]"), ["6", "6", "none", "none"]),
        ("pockets", ('{""7"": ""a"", ""6"": ""b""}', '{""6"": ""a"", ""7"": ""c""}', "{}"), ["6, 7", "6, 7", "none"]),
        ("touches", ('[""7"", ""6""]', '[""6"", ""7""]'), ["7, 6", "6, 7"]),  # here the order says something
    ],
)
def test_sets_of_balls_are_counted_whatever_their_order(tmp_path: Path, name: str, cells: tuple[str, ...], words):
    file = tmp_path / "x.csv"
    file.write_text(written(name, *cells))
    found = maps.read(plan_of("billiards", "cue.angle=0:2:3"), row_file.rows(file), name)
    assert found.numbers is None
    assert found.words == words
    assert found.good == {word for word in words if "6" in word}


@pytest.mark.parametrize(("of", "lines"), [("bounces", False), ("final_height", True)])
def test_contour_lines_are_drawn_except_for_counts(tmp_path, of, lines):
    kinds, _ = drawn(tmp_path, of, "launch.height=1:2:9", "launch.speed=0:2:9")
    assert ("QuadContourSet" in kinds) == lines
    assert "QuadMesh" in kinds
