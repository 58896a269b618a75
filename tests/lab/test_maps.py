"""Pictures of sweeps: they keep clear of the edges, and say where the scene file's own shot is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from sandbox.lab import maps
from sandbox.lab.axes import parse_axis
from sandbox.lab.plan import Plan
from sandbox.lab.sweep import sweep_to_file, workers
from sandbox.scene import load


def plan_of(source: str, *over: str) -> Plan:
    scene = load(source)
    return Plan(scene, tuple(parse_axis(scene, "--over", text) for text in over))


@pytest.mark.parametrize(
    ("over", "place"),
    [
        (("launch.angle=5:20:4", "ball.drag.model=none,tour-fit,constant"), [10.4, 1.0]),
        (("ball.drag.model=tour-fit,none",), [0.0]),
        (("launch.angle=5:20:4", "ball.drag.model=none,constant"), None),
        (("launch.angle=15:20:4",), None),
    ],
)
def test_where_the_scene_files_own_shot_is(over, place):
    assert maps._own(plan_of("golf", *over)) == place


def test_a_picture_of_one_word_keeps_clear_of_the_edges(tmp_path: Path):
    plan, rows, plot = plan_of("basketball", "launch.angle=50:55:5"), tmp_path / "x.csv", tmp_path / "x.png"
    with workers(1) as staff:
        sweep_to_file(plan, rows, staff)
    maps.draw_sweep(plan, rows, plot, "ended")
    with Image.open(plot) as picture:
        inked = np.asarray(picture.convert("RGB")).min(axis=2) < 250
    across, down = (np.flatnonzero(inked.any(axis=axis)) for axis in (0, 1))
    least = 0.015 * inked.shape[1]
    assert min(across[0], down[0], inked.shape[1] - across[-1], inked.shape[0] - down[-1]) > least
