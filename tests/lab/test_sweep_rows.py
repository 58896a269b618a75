"""Rows of a sweep: those of single runs, with their errors."""

from __future__ import annotations

import re

import numpy as np
import pytest

import sandbox
from sandbox.lab.plan import CHANGED, records
from sandbox.lab.row_file import cell
from sandbox.scene import compare, load, simulate
from sandbox.scene.running import simulate_at
from tests.lab.sweeping import grid, own_scene
from tests.own_scene import DROP


def test_rows_are_those_of_single_runs(falling):
    plan = grid(falling, "launch.height=0.5:2:4", "floor.restitution=0.5,0.9", "ball.drag.model=none,constant")
    for row in records(plan, 0, plan.size):
        overrides = {key: row[key] for key in plan.keys}
        run = simulate(load(DROP, overrides))
        assert row == {
            **overrides,
            **run.result,
            "ended": run.ended,
            "impacts": run.numerics.impacts,
            "steps": run.numerics.steps,
            "refined_steps": run.numerics.refined_steps,
            "error": "",
        }


def test_a_point_that_fails_is_a_row_with_its_error(tmp_path):
    failing = "    if parameters.launch.height == 1.0:\n        raise ZeroDivisionError('no\\nway')\n"
    plan = grid(load(own_scene(tmp_path, failing)), "launch.height=0.5,1,1.5")
    rows = records(plan, 0, 3)
    errors = [re.sub(r"\d+\)$", "N)", row["error"]) for row in rows]
    assert errors == ["", "ZeroDivisionError: no way (drop/scene.py, line N)", ""]
    assert "final_height" not in rows[1]


def test_python_gets_arrays_and_records():
    found = sandbox.sweep(DROP, {"launch.height": [0.5, 1.0, 50.0], "launch.speed": np.linspace(0.0, 2.0, 4)})
    assert found["final_height"].shape == (3, 4)
    assert found["bounced"].dtype == bool
    assert np.isnan(found["first_touch"][2]).all()  # it never came down
    assert found["first_touch"][1, 0] == pytest.approx((2 * (1.0 - 0.05) / 9.81) ** 0.5, abs=1e-9)
    assert found.records[4]["launch.height"] == 1.0
    assert set(found.columns) == set(found.records[0])
    assert {len(column) for column in found.columns.values()} == {12}
    assert found.axes["launch.speed"] == pytest.approx([0.0, 2 / 3, 4 / 3, 2.0])
    with pytest.raises(KeyError):
        found["carry"]


def test_each_row_has_the_accuracy_that_it_asks_for():
    swept = sandbox.sweep(
        "basketball", {"accuracy.level": ["fast", "precise"], "launch.angle": np.linspace(45, 60, 30)}
    )
    fast, precise = swept["steps"]
    assert np.all(1.2 * fast < precise)


def test_a_checked_sweep_reports_errors_and_changed_facts():
    # at the edge of the ring: in or out is decided by less than the error
    found = sandbox.sweep("basketball", {"launch.speed": [7.0, 7.391]}, check=True)
    for row in found.records:
        run = simulate(load("basketball", {"launch.speed": row["launch.speed"]}))
        check = compare(run, simulate_at(run.scene, run.accuracy.finer()))
        assert row["apex_error"] == pytest.approx(check.errors["apex"], rel=1e-3, abs=1e-12)
        assert row[CHANGED] == " ".join(check.changed)


def test_cells():
    values = [None, float("nan"), True, 1.0, 0.1 + 0.2, 3, "a\nb", np.float64(2.5), np.bool_(False)]
    texts = ["", "", "true", "1.0", "0.30000000000000004", "3", "a b", "2.5", "false"]
    assert [cell(value) for value in values] == texts
    values = [["x", 1.5], {"a": [1]}, [float("nan"), "\x9b"]]
    assert [cell(value) for value in values] == ['["x", 1.5]', '{"a": [1]}', '[null, "\\u009b"]']
