"""Sweeps: every point once, in order, whatever happens to the process, the disk or a worker on the way."""

from __future__ import annotations

import csv
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image

import sandbox
from sandbox import resources
from sandbox.cli import main
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError, RunError
from sandbox.lab import provenance as provenances
from sandbox.lab.axes import Span, Values, as_axis, parse_axis
from sandbox.lab.plan import CHANGED, Plan, records
from sandbox.lab.provenance import provenance
from sandbox.lab.row_file import RowFile, cell
from sandbox.lab.runs import runs
from sandbox.lab.sweep import RowsInOrder, SweepSummary, sweep_to_file, workers, worthwhile_jobs
from sandbox.scene import Scene, compare, load, simulate
from sandbox.scene.modules import read_again
from sandbox.scene.running import simulate_at
from sandbox.workers import Processes
from sandbox.workers import cluster as cluster_of
from tests.own_scene import BUILD, COMMAND, DROP, change, copy_of


@pytest.fixture
def drop() -> Scene:
    return load(DROP)


def own_scene(folder: Path, in_build: str) -> Path:
    """A copy of drop that does something more in ``build``."""
    scene = copy_of(DROP, folder / "drop")
    change(scene / "scene.py", BUILD, BUILD + in_build)
    return scene


def grid(scene: Scene, *texts: str, **more: Any) -> Plan:
    return Plan(scene, tuple(parse_axis(scene, "--over", text) for text in texts), **more)


def table(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


# What is swept over --------------------------------------------------------------------------------------------------


def test_axes_are_read(drop):
    assert parse_axis(drop, "--over", "launch.height=1:2:3") == Values("launch.height", (1.0, 1.5, 2.0))
    assert parse_axis(drop, "--over", "launch.height = 10 cm:2 ft:2") == Values("launch.height", (0.1, 0.6096))
    assert parse_axis(drop, "--over", "launch.height=1:2") == Span("launch.height", 1.0, 2.0)
    assert parse_axis(drop, "--over", "launch.height=3,1,2 m") == Values("launch.height", (3.0, 1.0, 2.0))
    assert parse_axis(drop, "--over", "floor.present=true,false") == Values("floor.present", (True, False))
    assert parse_axis(drop, "--over", "ball.drag.model=none,constant") == Values(
        "ball.drag.model", ("none", "constant")
    )
    assert parse_axis(drop, "--over", "air.wind[0]=-1:1:2") == Values("air.wind[0]", (-1.0, 1.0))
    assert parse_axis(drop, "--over", "air.wind=[1,2],[3,4]") == Values("air.wind", ((1.0, 2.0), (3.0, 4.0)))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("launch.height", "write it as KEY=LO:HI:N"),
        ("launch.hight=1:2:3", "did you mean launch.height?"),
        ("launch.height=1:200:3", "must be from"),
        ("launch.height=1 kg:2:3", "kg is a unit of mass"),
        ("launch.height=2:1:3:4", "a range has two or three"),
        ("launch.height=1:2:none", "not a number of points"),
        ("launch.height=1:2:0", "not a number of points"),
        ("launch.height=2:1", "write the lower end first"),
        ("floor.present=false:true:2", "only numbers can have a range"),
        ("launch=1:2:3", "group of keys"),
        ("air.wind[7]=1:2:3", "there is no [7]; the list has 2"),
        ("launch.height[0]=1:2:3", "is not a list"),
        ("air..wind=1:2:3", "a key is written like"),
    ],
)
def test_what_cannot_be_swept_over_is_told(drop, text, told):
    with pytest.raises(RequestError) as refused:
        parse_axis(drop, "--over", text)
    assert told in str(refused.value)
    assert str(refused.value).startswith("--over ")


def test_axes_from_python(drop):
    assert as_axis(drop, "launch.height", np.array([1.0, 2.0, 3.0])) == Values("launch.height", (1.0, 2.0, 3.0))
    assert as_axis(drop, "launch.height", (1.0, "2 m")) == Span("launch.height", 1.0, 2.0)
    assert as_axis(drop, "floor.present", (True, False)) == Values("floor.present", (True, False))
    with pytest.raises(RequestError, match="must be from"):
        as_axis(drop, "launch.height", [1.0, 2.0, -3.0])


def test_a_grid_runs_through_its_last_axis_first(drop):
    plan = grid(drop, "launch.height=1:2:2", "launch.speed=3,4,5")
    assert list(plan.points(0, 6)) == [(1.0, 3.0), (1.0, 4.0), (1.0, 5.0), (2.0, 3.0), (2.0, 4.0), (2.0, 5.0)]
    assert list(plan.points(2, 4)) == [(1.0, 5.0), (2.0, 3.0)]


def test_random_points_are_the_same_however_they_are_taken(drop):
    axes = (Span("launch.height", 1.0, 2.0), Values("floor.present", (True, False)))
    plan = Plan(drop, axes, samples=3000, seed=7)
    points = list(plan.points(0, 3000))
    assert [*plan.points(0, 1000), *plan.points(1000, 1025), *plan.points(1025, 3000)] == points
    assert list(Plan(drop, axes, samples=3000, seed=8).points(0, 9)) != points[:9]
    heights = np.array([height for height, _ in points])
    assert heights.min() >= 1.0
    assert heights.max() <= 2.0
    assert np.histogram(heights, 4, (1.0, 2.0))[0] == pytest.approx(750, abs=100)
    assert sum(present for _, present in points) == pytest.approx(1500, abs=150)


@pytest.mark.parametrize(
    ("texts", "more", "told"),
    [
        ((), {}, "nothing to sweep over"),
        (("launch.height=1:2",), {}, "--over launch.height=1:2: a grid needs the number of points, 1:2:N"),
        (("launch.height=1:2:2", "launch.height=3,4"), {}, "swept over twice"),
        (("launch.height=1:2",), {"samples": -1}, "samples = -1, seed = 0: must not be less than 0"),
        (("launch.height=1:2",), {"samples": 3, "seed": -1}, "samples = 3, seed = -1: must not be less than 0"),
        (("launch.height=1:2:1000000", "launch.speed=1:2:1000000"), {}, "too many"),
    ],
)
def test_plans_that_make_no_sense_are_told(drop, texts, more, told):
    with pytest.raises(RequestError) as refused:
        grid(drop, *texts, **more)
    assert told in str(refused.value)


# Rows ----------------------------------------------------------------------------------------------------------------


def test_rows_are_those_of_single_runs(drop):
    plan = grid(drop, "launch.height=0.5:2:4", "floor.restitution=0.5,0.9", "ball.drag.model=none,constant")
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


def test_elements_of_lists_can_be_swept_over():
    scene = load(DROP, {"marks": [{"x": 1.0}, {"x": 2.0}]})
    plan = grid(scene, "marks[1].x=3,4", "air.wind[1]=5,6")
    from sandbox.lab.axes import Varied

    parameters = Varied(scene, plan.keys).parameters((4.0, 6.0))
    assert [mark.x for mark in parameters.marks] == [1.0, 4.0]
    assert parameters.air.wind == (0.0, 6.0)


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


# The file ------------------------------------------------------------------------------------------------------------


def swept(plan: Plan, path: Path) -> SweepSummary:
    with workers(1) as pool:
        return sweep_to_file(plan, path, pool)


def whole(plan: Plan, path: Path) -> bytes:
    swept(plan, path)
    assert not path.with_name(path.name + ".resume").exists()
    return path.read_bytes()


def test_two_processes_write_the_same_file_as_one(drop, tmp_path):
    plan = grid(drop, "launch.height=0.5:2:31", "launch.speed=0:2:7")
    expected = whole(plan, tmp_path / "one.csv")
    with workers(2) as pool:
        done = sweep_to_file(plan, tmp_path / "two.csv", pool)
    assert (tmp_path / "two.csv").read_bytes() == expected
    assert len(table(tmp_path / "two.csv")) == done.points == plan.size


def resumed(plan: Plan, path: Path, left: bytes) -> SweepSummary:
    """A sweep into a file in which an interrupted one left this."""
    path.write_bytes(left)
    path.with_name(f"{path.name}.resume").write_text(plan.fingerprint + "\n")
    return swept(plan, path)


@pytest.mark.parametrize("kept", [0.05, 0.3, 0.61, 0.98])
def test_a_file_cut_off_anywhere_is_gone_on_with(drop, tmp_path, kept):
    plan, path = grid(drop, "launch.height=0.5:2:40"), tmp_path / "rows.csv"
    expected = whole(plan, path)
    left = expected[: int(kept * len(expected))]
    assert resumed(plan, path, left).resumed == max(0, left.count(b"\n") - 1)
    assert path.read_bytes() == expected


#: What may have become of a row in the middle of the file.
DAMAGE = {
    "missing": lambda row: b"",
    "NULs": lambda row: b"\0" * len(row),
    "a stray quote": lambda row: b'"' + row,
    "CRLF": lambda row: row.replace(b"\n", b"\r\n"),
    "no UTF-8": lambda row: b"\xff" + row,
    "another point": lambda row: b"9" + row,
    "twice": lambda row: row + row,
    "a cell too many": lambda row: row.replace(b"\n", b",\n"),
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damaged_rows_are_computed_again(drop, tmp_path, kind):
    plan, path = grid(drop, "launch.height=0.5:2:40"), tmp_path / "rows.csv"
    expected = whole(plan, path)
    lines = expected[: len(expected) * 4 // 5].splitlines(keepends=True)
    lines[len(lines) // 2] = DAMAGE[kind](lines[len(lines) // 2])
    done = resumed(plan, path, b"".join(lines))
    assert path.read_bytes() == expected
    assert (tmp_path / "rows.csv~").read_bytes() == b"".join(lines)
    assert done.damaged == done.resumed + 1
    assert f"row {done.damaged} was damaged: computed again" in done.as_text()


def test_what_is_before_or_after_the_rows_is_mended(drop, tmp_path):
    """A first line without rows is written again, rows beyond the last point are dropped, another header is refused."""
    plan, path = grid(drop, "launch.height=0.5:2:5"), tmp_path / "rows.csv"
    expected, header = whole(plan, path), ",".join(plan.columns).encode()
    for left in (header + b"\n", header[:20], header + b"\n1.0,", expected + expected.splitlines(keepends=True)[-1]):
        resumed(plan, path, left)
        assert path.read_bytes() == expected
        before = path.with_name("rows.csv~")
        assert before.exists() is left.startswith(expected)
        before.unlink(missing_ok=True)
    for wrong in (b"\xff", b"speed,", b"error,", b'"'):
        with pytest.raises(RequestError, match="its first line is not what this sweep wrote"):
            resumed(plan, path, wrong + expected)
        assert path.read_bytes() == wrong + expected


def test_one_sweep_at_a_time_writes_a_file(drop, tmp_path, capsys):
    path, link = tmp_path / "rows.csv", tmp_path / "link.csv"
    link.symlink_to(path)
    command = ["sweep", str(DROP), "--over", "launch.height=0.5:2:3", "--jobs", "1", "--out"]
    with RowFile(path, grid(drop, "launch.height=0.5:2:3")):
        for name in (path, link):
            assert main([*command, str(name)]) == 2
            told = f"error: --out {name}: another sweep is writing to this file; choose another name\n"
            assert capsys.readouterr().err == told
    assert main([*command, str(link)]) == 0
    assert {file.name for file in tmp_path.iterdir()} == {"rows.csv", "link.csv", ".rows.csv.complete"}


def test_files_of_the_users_are_kept(drop, tmp_path):
    plan = grid(drop, "launch.height=0.5:2:3")
    path, mark, before = (tmp_path / f"rows.csv{end}" for end in ("", ".resume", "~"))
    mark.write_text("my notes")
    with pytest.raises(RequestError, match=r"rows\.csv\.resume is a file of yours"):
        RowFile(path, plan).__enter__()
    assert mark.read_text() == "my notes"
    mark.unlink()
    path.write_text("x,error\n1,\n")
    before.write_text("my notes")
    with pytest.raises(RequestError, match="but that is a file of yours"):
        RowFile(path, plan).__enter__()
    assert (before.read_text(), path.read_text(), mark.exists()) == ("my notes", "x,error\n1,\n", False)


def test_another_sweep_never_replaces_an_interrupted_one(drop, tmp_path):
    path = tmp_path / "rows.csv"
    with RowFile(path, grid(drop, "launch.height=0.5:2:40")) as file:
        file.append([{"launch.height": 9.0, "error": ""}])
    kept = path.read_bytes()
    other = grid(drop, "launch.height=0.5:2:3")
    with pytest.raises(RequestError, match=r"rows\.csv: contains rows of another interrupted sweep"):
        swept(other, path)
    assert path.read_bytes() == kept
    path.with_name("rows.csv.resume").unlink()
    assert whole(other, path) == whole(other, tmp_path / "fresh.csv")
    changed = Plan(load(DROP, {"gravity": 1.0}), other.axes)
    assert changed.fingerprint != other.fingerprint


def test_rows_of_another_sweep_are_kept_as_a_backup(drop, tmp_path):
    path, before = tmp_path / "rows.csv", tmp_path / "rows.csv~"
    first, other = grid(drop, "launch.height=0.5:2:3"), grid(drop, "launch.height=0.5:2:4")
    found = whole(first, path)
    again = swept(first, path)
    assert (again.resumed, again.as_text()) == (3, "3 points, all already in the file: the sweep is complete")
    path.with_name(".rows.csv.complete").unlink()
    assert (swept(first, path).resumed, before.exists()) == (0, False)  # the same rows are not kept twice
    path.write_bytes(found.replace(b"1.25", b"1.35"))  # no longer what the sweep wrote
    assert swept(first, path).resumed == 0
    assert (path.read_bytes(), before.exists()) == (found, True)
    before.unlink()
    done = swept(other, path)
    assert (before.read_bytes(), done.before) == (found, before)
    assert f"the previous rows are in {before}" in done.as_text()
    assert path.read_bytes() == whole(other, tmp_path / "fresh.csv") != found


def test_a_sweep_that_was_complete_is_not_said_to_be_written(tmp_path, capsys):
    command = ["sweep", str(DROP), "--over", "launch.height=1,2", "--out", str(tmp_path / "rows.csv")]
    said = [(main(command), "wrote" in capsys.readouterr().out) for _ in range(2)]
    assert said == [(0, True), (0, False)]


def test_all_that_rows_depend_on_makes_another_sweep(tmp_path, monkeypatch):
    """Two models must never meet in one file: files that a scene reads, modules beside it, versions, the program."""
    (tmp_path / "physics_of_mine").mkdir()
    (package_of_mine := tmp_path / "physics_of_mine" / "__init__.py").write_text("")
    helper = tmp_path / "physics_of_mine" / "helper.py"
    helper.write_text("K = 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    folder = own_scene(tmp_path, "    import physics_of_mine.helper\n    import json\n    from ..other import ball\n")
    (tmp_path / "data").mkdir()
    (folder / "linked").symlink_to(tmp_path / "data")
    (folder / "itself").symlink_to(folder)
    package = tmp_path / "package"
    shutil.copytree(resources.PACKAGE / "physics", package / "physics")
    known, its_place = provenances.is_of_library, resources.PACKAGE  # the program that runs has not moved
    monkeypatch.setattr(provenances, "is_of_library", lambda file: known(file) or file.is_relative_to(its_place))
    monkeypatch.setattr(resources, "PACKAGE", package)

    def found() -> str:
        return grid(load(folder), "launch.height=0.5:2:3").fingerprint

    seen = [found()]
    for file, text in (
        (folder / "scene.py", "# another\n"),
        (folder / "k.txt", "2"),
        (folder / "tables" / "k.csv", "1,2\n"),
        (folder / "linked" / "k.csv", "1,2\n"),
        (helper, "K = 2\n"),
        (package_of_mine, "K = 2\n"),
        (tmp_path / "other" / "ball.py", "K = 2\n"),
        (package / "physics" / "forces.py", "# another\n"),
        (package / "sport" / "new.py", ""),
    ):
        file.parent.mkdir(exist_ok=True)
        file.write_text((file.read_text("utf-8") if file.exists() else "") + text, "utf-8")
        assert found() not in seen, file
        seen.append(found())
    for name in (
        ".notes",
        "rows.csv~",
        "golf.png",
        "shot.replay.json",
        "__pycache__/scene.pyc",
        "golden/a.json",
        ".git/index",
    ):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text("made from it")
    for content in ("", "launch.height,carry,error\n"):  # a sweep into this folder before and after its first row
        (folder / "rows.csv").write_text(content)
        assert found() == seen[-1]
    for name in ("version", "platform.python_version", "platform.machine"):
        with monkeypatch.context() as patched:
            patched.setattr(f"sandbox.lab.provenance.{name}", lambda *args: "another")
            assert found() not in seen, name


def test_the_columns_are_those_of_the_plan_whatever_fails_first(drop, tmp_path):
    path, plan = tmp_path / "rows.csv", grid(drop, "launch.height=1,2,3")
    x = "launch.height"
    with RowFile(path, plan) as file:
        file.append([{x: 1.0, "error": "no way"}])
        file.append([{x: 2.0, "bounces": 3, "error": ""}])
    with RowFile(path, plan) as file:
        assert file.done == 2
        file.append([{x: 3.0, "bounced": True, "error": ""}])
    first = "launch.height,bounces,first_touch,bounced,final_height,ended,impacts,steps,refined_steps,error\n"
    assert path.read_text() == f"{first}1.0,,,,,,,,,no way\n2.0,3,,,,,,,,\n3.0,,,true,,,,,,\n"
    checked = Plan(plan.scene, plan.axes, check=True)
    (row,) = records(checked, 0, 1, alone=True)
    assert [name for name in checked.columns if name in row] == list(row)
    assert set(checked.columns) - set(plan.columns) == {
        "bounces_error",
        "first_touch_error",
        "final_height_error",
        CHANGED,
    }
    assert checked.block
    assert not any(isinstance(kept, Run) for kept in vars(checked).values())  # a plan is sent, and not every run can be


def test_a_full_disk_is_told(drop):
    if not Path("/dev/full").is_char_device():
        pytest.skip("needs /dev/full")
    with pytest.raises(RunError, match="--out /dev/full: cannot be written: no space left"):
        swept(grid(drop, "launch.height=0.5:2:3"), Path("/dev/full"))


def started(*args: object) -> subprocess.Popen[str]:
    """The program in a session of its own, as a terminal has it."""
    return subprocess.Popen(
        [*COMMAND, *map(str, args)], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    )


def everybody_gone(group: int) -> bool:
    for _ in range(100):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.05)
    return False


def test_few_shots_that_fly_together_do_without_processes(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sandbox.lab.sweep.cores", lambda: 4)
    few, many = (grid(load("golf"), f"launch.angle=5:40:{n}") for n in (3, 3000))
    table = grid(load("billiards"), "cue.angle=-5:5:3")  # its balls meet: one shot at a time
    assert [worthwhile_jobs(plan) for plan in (few, many, table)] == [1, 4, 3]


@pytest.mark.parametrize("jobs", [1, 2])
def test_ctrl_c_keeps_what_is_done_and_the_same_command_resumes(tmp_path, jobs):
    scene = own_scene(tmp_path, "    import time\n    time.sleep(0.015)\n")
    path = tmp_path / "rows.csv"
    one_by_one = {"accuracy.method": "plain", "accuracy.step": 0.02}  # not in one block, which is kept as a whole
    command = ["sweep", scene, "--over", "launch.height=0.5:2:120", "--jobs", jobs, "--out", path]
    command += [f"--set={key}={value}" for key, value in one_by_one.items()]
    process = started(*command)
    deadline = time.monotonic() + 60
    while not (path.exists() and path.read_bytes().count(b"\n") > 10):
        assert time.monotonic() < deadline, process.poll()
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)  # as timeout does, which then tells the group
    os.killpg(process.pid, signal.SIGINT)  # a terminal tells all processes
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out) == (130, "")
    kept = len(table(path))
    assert 10 <= kept < 120
    assert err == f"stopped: {kept} of 120 points are kept in {path}; run the same command to resume\n"
    assert everybody_gone(process.pid)

    finished = subprocess.run([*COMMAND, *map(str, command)], capture_output=True, text=True, check=True)
    assert f"120 points, {kept} already in the file" in finished.stdout
    assert path.read_bytes() == whole(grid(load(scene, one_by_one), "launch.height=0.5:2:120"), tmp_path / "again.csv")


@pytest.fixture
def one_at_a_time(monkeypatch):
    """Shots that do not fly together."""
    monkeypatch.setattr("sandbox.lab.plan.fly_together", lambda *args: False)


def test_what_is_done_is_handed_in_by_time(tmp_path, monkeypatch, one_at_a_time):
    """However long a point takes after quick ones: an interrupt loses what the last moments computed, no more."""
    monkeypatch.setattr("sandbox.lab.sweep.CALL", 0.05)
    slow = "    if parameters.launch.height > 1.0:\n        import time\n        time.sleep(0.03)\n"
    plan = grid(load(own_scene(tmp_path, slow)), "launch.height=0.5:1.2:60")
    with workers(1) as pool:
        handed_in = list(RowsInOrder(plan, pool))
    assert [row["launch.height"] for rows in handed_in for row in rows] == [height for (height,) in plan.points(0, 60)]
    assert max(len(rows) for rows in handed_in if rows[-1]["launch.height"] > 1.1) <= 2


def test_an_interrupt_takes_in_what_others_have_finished(drop, one_at_a_time):
    class Others:
        width = 4

        def submit(self, work, *args):
            return SimpleNamespace(done=lambda: args[1] < 5, result=lambda: work(*args))

    handout = RowsInOrder(grid(drop, "launch.height=0.5:2:40"), Others())
    first = next(iter(handout))
    assert len(first) == 1
    assert [row["launch.height"] for rows in handout.finished(1) for row in rows] == pytest.approx(
        [0.5 + 1.5 * point / 39 for point in (1, 2, 3, 4)]
    )
    assert not list(handout.finished(1))


# Workers that go away -------------------------------------------------------------------------------------------------


def test_a_killed_process_loses_nothing(tmp_path):
    once = (
        "    import os, pathlib, signal\n"
        f"    mark = pathlib.Path({str(tmp_path / 'mark')!r})\n"
        "    if parameters.launch.height > 1.0 and not mark.exists():\n"
        "        mark.touch()\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    plan = grid(load(own_scene(tmp_path, once)), "launch.height=0.5:2:60")
    with workers(2) as pool:
        rows = [row for some in RowsInOrder(plan, pool) for row in some]
    assert (tmp_path / "mark").exists()
    assert [row["launch.height"] for row in rows] == [height for (height,) in plan.points(0, 60)]
    assert not any(row["error"] for row in rows)


def test_processes_end_with_the_one_that_began_them():
    """However that ends: they hold its output open as long as they live."""
    code = (
        "import os; from sandbox.workers import Processes; processes = Processes(1);"
        "print(processes.submit(os.getppid).result() == os.getpid(), flush=True); import time;"
        "processes.submit(time.sleep, 0.1); time.sleep(0.1); os._exit(0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.stderr) == ("True\n", "")


def test_a_point_that_kills_its_process_is_a_row(tmp_path):
    deadly = (
        "    import os, signal\n    if parameters.launch.height == 1.0:\n        os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    plan = grid(load(own_scene(tmp_path, deadly)), "launch.height=0.5,0.75,1.0,1.25,1.5")
    with workers(2) as pool:
        rows = [row for some in RowsInOrder(plan, pool) for row in some]
    assert ["killed" in row["error"] for row in rows] == [False, False, True, False, False]
    assert all("final_height" in row for row in rows if not row["error"])


def local_cluster(workers: int, **how: Any) -> Any:
    """On loopback: nothing here may be reached from outside."""
    distributed = pytest.importorskip("distributed")
    quiet = {"host": "127.0.0.1", "dashboard_address": None, "silence_logs": 50}
    return distributed.LocalCluster(n_workers=workers, **quiet, **how)


#: Its workers are threads of this process.
THREADS = {"processes": False, "protocol": "tcp://"}


def test_a_cluster_that_loses_a_worker_loses_nothing():
    plan = grid(load("basketball"), "launch.speed=6:9:13", "launch.angle=40:60:5")
    with workers(1) as pool:
        expected = [row for some in RowsInOrder(plan, pool) for row in some]
    killed: list[int] = []
    with local_cluster(2, threads_per_worker=1) as cluster:

        def kill_one(done: int, total: int) -> None:
            if done > 5 and not killed:
                killed.append(next(iter(cluster.workers.values())).pid)
                os.kill(killed[0], signal.SIGKILL)

        with workers(1, cluster.scheduler_address) as pool:
            rows = [row for some in RowsInOrder(plan, pool, progress=kill_one) for row in some]
    assert killed
    assert rows == expected


@pytest.mark.parametrize("loss", ["workers", "scheduler"])
def test_a_cluster_that_goes_away_is_told_in_a_line(tmp_path, monkeypatch, one_at_a_time, loss):
    monkeypatch.setattr(cluster_of, "ARRIVAL", 0.5)
    plan = grid(load(own_scene(tmp_path, "    import time\n    time.sleep(0.02)\n")), "launch.height=0.5:2:400")
    path = tmp_path / "rows.csv"
    with local_cluster(1, **THREADS) as cluster:

        def lose(done: int, total: int) -> None:
            if done > 5:
                cluster.close() if loss == "scheduler" else cluster.scale(0)

        gone = (
            "the connection to the scheduler was lost"
            if loss == "scheduler"
            else "its workers were lost, and none came back within 0.5 s"
        )
        with pytest.raises(RunError, match=gone), workers(1, cluster.scheduler_address) as pool:
            sweep_to_file(plan, path, pool, lose)
    kept = table(path)
    assert 5 < len(kept) < 400
    assert [float(row["launch.height"]) for row in kept] == [height for (height,) in plan.points(0, len(kept))]


def test_a_cluster_that_cannot_compute_is_told_in_a_line(monkeypatch):
    nobody = local_cluster(0, **THREADS)
    monkeypatch.setattr(cluster_of, "ANSWER", 1.0)
    monkeypatch.setattr(cluster_of, "ARRIVAL", 0.5)
    with pytest.raises(RequestError, match="--scheduler no address: write it as"), workers(1, "no address"):
        pass
    with pytest.raises(RunError, match=r"no Dask scheduler there: .* refused"), workers(1, "tcp://127.0.0.1:1"):
        pass
    with socket.create_server(("127.0.0.1", 0)) as deaf:
        address = f"tcp://127.0.0.1:{deaf.getsockname()[1]}"
        with pytest.raises(RunError, match=f"--scheduler {address}: no Dask scheduler there"), workers(1, address):
            pass
    with nobody, pytest.raises(RunError, match="it has no workers, and none connected within"):
        workers(1, nobody.scheduler_address).__enter__()


def test_a_worker_with_other_code_is_refused_by_name(drop):
    plan = grid(drop, "launch.height=0.5:2:3")
    here = provenance(drop)
    other = here.parts | {"the sandbox": "with another gravity", "numpy": "1.0"}
    plan.__dict__["provenance"] = replace(here, parts=other)
    with pytest.raises(RunError) as refused, workers(2) as pool:
        list(RowsInOrder(plan, pool))
    assert f"it differs in: the sandbox, numpy {here.parts['numpy']} instead of 1.0" in str(refused.value)


def test_a_worker_with_the_scene_before_a_change_is_refused(tmp_path):
    """Its modules are loaded once: it would compute the old numbers, while the files on its disk are the new ones."""
    folder, pool = own_scene(tmp_path, "    factor = 1.0\n"), Processes(1)

    def heights() -> list[float]:
        with read_again(folder):
            plan = grid(load(folder), "launch.height=0.5:2:3")
        return [row["final_height"] for rows in RowsInOrder(plan, pool) for row in rows]

    try:
        before = heights()
        change(folder / "scene.py", "-self.mass * self.gravity", "-self.mass * self.gravity * 1.5")
        with pytest.raises(RunError, match="it differs in: the scene; restart it"):
            heights()
        change(folder / "scene.py", " * 1.5", "")
        assert heights() == before
    finally:
        pool.close(abandon=True)


# The command ---------------------------------------------------------------------------------------------------------


def test_the_values_of_a_range_have_no_digits_of_rounding():
    """-28.8, not -28.799999999999997; what has no short form keeps all its digits."""
    axis = parse_axis(sandbox.load("golf"), "--over", "launch.angle=-72:72:11")
    assert [cell(value) for value in axis.values[:5]] == ["-72.0", "-57.6", "-43.2", "-28.8", "-14.4"]
    assert axis.values[5] == 0.0
    thirds = parse_axis(sandbox.load("golf"), "--over", "launch.angle=7:8:4")
    assert thirds.values == tuple(np.linspace(7.0, 8.0, 4))


def test_the_command(tmp_path, capsys):
    out, plot = tmp_path / "rows.csv", tmp_path / "map.png"
    over = ["--over", "launch.speed=7:8:4", "--over", "launch.angle=45:60:3"]
    assert main(["sweep", "basketball", *over, "--jobs", "1", "--out", str(out), "--plot", str(plot)]) == 0
    told = capsys.readouterr()
    assert told.out.startswith("12 points; 12 in ")
    assert told.out.endswith(f"wrote {out}\nwrote {plot}\n")
    assert told.err == ""
    rows = table(out)
    assert list(rows[0])[:4] == ["launch.speed", "launch.angle", "made", "verdict"]
    assert list(rows[0])[-1] == "error"
    assert [(row["launch.speed"], row["launch.angle"]) for row in rows][:4] == [
        ("7.0", "45.0"), ("7.0", "52.5"), ("7.0", "60.0"), ("7.333333333333333", "45.0"),
    ]  # fmt: skip
    assert {row["made"] for row in rows} <= {"true", "false"}
    with Image.open(plot) as picture:
        assert picture.size[0] > 900


def test_rows_on_stdout(tmp_path):
    command = [*COMMAND, "sweep", str(DROP), "--over", "launch.height=1:2:3", "--jobs", "1", "--out", "/dev/stdout"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert len(done.stdout.splitlines()) == 4
    assert done.stdout.startswith("launch.height,bounces,")


ROWS = ("--over", "launch.speed=1:2:3", "--out", "x.csv")


@pytest.mark.parametrize(
    ("args", "told"),
    [
        (["--over", "launch.speed=1:2:3", "--out", "x.txt"], "must end in .csv"),
        (["--over", "launch.speed=1:2:3", "--out", "no/x.csv"], "there is no folder"),
        ([*ROWS, "--of", "carry"], "requires --plot"),
        ([*ROWS, "--plot", "x.jpg"], "must end in .png"),
        ([*ROWS, "--plot", "x.png", "--of", "aped"], "did you mean apex?"),
        (["--over", "launch.speed=1:2:1", "--out", "x.csv", "--plot", "x.png"], "two values or more"),
        ([*ROWS, "--samples", "0"], "'--samples': 0 is not in the range x>=1"),
        ([*ROWS, "--seed", "2"], "--seed 2: requires --samples"),
        ([*ROWS, "--plot", "x.png", "--of", "xyz"], "refined_steps\n"),
        (["--out", "x.csv"], "--over"),
        (["--over", "launch.speed=1:2:3"], "--out"),
    ],
)
def test_wrong_requests_are_told_before_any_work(tmp_path, monkeypatch, capsys, args, told):
    monkeypatch.chdir(tmp_path)
    assert main(["sweep", "basketball", *args]) == 2
    assert told in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_sweep_in_which_all_points_fail_says_so(tmp_path, capsys):
    scene = own_scene(tmp_path, "    raise ValueError('never')\n")
    out = tmp_path / "x.csv"
    assert main(["sweep", str(scene), "--over", "launch.height=1:2:3", "--jobs", "1", "--out", str(out)]) == 1
    errors = {row["error"] for row in table(out)}
    assert len(errors) == 1
    assert capsys.readouterr().err == f"error: every point failed, the first with: {(error := errors.pop())}\n"
    assert re.fullmatch(r"ValueError: never \(drop/scene\.py, line \d+\)", error)


@pytest.mark.parametrize(
    ("over", "more"),
    [
        (["launch.height=0.5:2:9"], []),
        (["launch.height=0.5:2:9"], ["--of", "bounced"]),
        (["launch.height=0.5:2:9", "launch.speed=0:2:8"], ["--of", "final_height"]),
        (["launch.height=2,1,0.5", "floor.present=true,false"], ["--of", "bounced"]),
        (["launch.height=0.5:2", "launch.speed=0:2"], ["--samples", "30", "--of", "bounced"]),
        (["launch.height=0.5:2", "launch.speed=0:2"], ["--samples", "30"]),
    ],
)
def test_pictures(tmp_path, over, more):
    plot = tmp_path / "x.png"
    options = [text for axis in over for text in ("--over", axis)]
    out = tmp_path / "x.csv"
    assert main(["sweep", str(DROP), *options, *more, "--jobs", "1", "--out", str(out), "--plot", str(plot)]) == 0
    with Image.open(plot) as picture:
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 20


@pytest.mark.parametrize("accuracy", [{}, {"accuracy.tolerance": 1e-12}, {"accuracy.integrator": "rk4"}])
def test_a_block_is_about_a_second_of_work(accuracy):
    """Rows are kept by blocks: an interrupted sweep must not lose many seconds."""
    scene = sandbox.load("basketball/rattle", accuracy)
    speeds = parse_axis(scene, "--over", "launch.speed=7:8:900")
    plan = Plan(scene, (speeds,))
    (run,) = runs(scene, plan.keys, [(7.5,)], asked=plan.asked)
    assert isinstance(run, Run)
    assert plan.block * run.numerics.force_evaluations < 1_000_000
