"""The file of a sweep: every row once, in order, whatever happened to it, and nothing of the user is lost."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sandbox import resources
from sandbox.cli import main
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError
from sandbox.lab import provenance as provenances
from sandbox.lab.plan import CHANGED, Plan, Rows, records
from sandbox.lab.report import as_text
from sandbox.lab.row_file import RowFile
from sandbox.lab.sweep import SweepSummary, sweep_to_file, workers
from sandbox.scene import load
from tests.lab.sweeping import grid, own_scene, swept, table, whole
from tests.own_scene import DROP


def test_two_processes_write_the_same_file_as_one(falling, tmp_path):
    plan = grid(falling, "launch.height=0.5:2:31", "launch.speed=0:2:7")
    expected = whole(plan, tmp_path / "one.csv")
    with workers(2) as pool:
        done = sweep_to_file(plan, tmp_path / "two.csv", pool)
    assert (tmp_path / "two.csv").read_bytes() == expected
    assert len(table(tmp_path / "two.csv")) == done.points == plan.size


def text_of(done: SweepSummary) -> str:
    return " ".join(" ".join(as_text(done.report())).split())


def resumed(plan: Plan, path: Path, left: bytes) -> SweepSummary:
    """A sweep into a file in which an interrupted one left this."""
    path.write_bytes(left)
    path.with_name(f"{path.name}.resume").write_text(plan.fingerprint + "\n")
    return swept(plan, path)


@pytest.mark.parametrize("kept", [0.05, 0.3, 0.61, 0.98])
def test_a_file_cut_off_anywhere_is_gone_on_with(falling, tmp_path, kept):
    plan, path = grid(falling, "launch.height=0.5:2:40"), tmp_path / "rows.csv"
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
def test_damaged_rows_are_computed_again(falling, tmp_path, kind):
    plan, path = grid(falling, "launch.height=0.5:2:40"), tmp_path / "rows.csv"
    expected = whole(plan, path)
    lines = expected[: len(expected) * 4 // 5].splitlines(keepends=True)
    lines[len(lines) // 2] = DAMAGE[kind](lines[len(lines) // 2])
    done = resumed(plan, path, b"".join(lines))
    assert path.read_bytes() == expected
    assert (tmp_path / "rows.csv~").read_bytes() == b"".join(lines)
    assert done.damaged == done.resumed + 1
    assert f"row {done.damaged} was damaged: computed again" in text_of(done)


def test_what_is_before_or_after_the_rows_is_mended(falling, tmp_path):
    """A first line without rows is written again, rows beyond the last point are dropped, another header is refused."""
    plan, path = grid(falling, "launch.height=0.5:2:5"), tmp_path / "rows.csv"
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


def test_one_sweep_at_a_time_writes_a_file(falling, tmp_path, capsys):
    path, link = tmp_path / "rows.csv", tmp_path / "link.csv"
    link.symlink_to(path)
    command = ["sweep", str(DROP), "--over", "launch.height=0.5:2:3", "--jobs", "1", "--out"]
    with RowFile(path, grid(falling, "launch.height=0.5:2:3")):
        for name in (path, link):
            assert main([*command, str(name)]) == 2
            told = f"error: --out {name}: another sweep is writing to this file; choose another name\n"
            assert capsys.readouterr().err == told
    assert main([*command, str(link)]) == 0
    assert {file.name for file in tmp_path.iterdir()} == {"rows.csv", "link.csv", ".rows.csv.complete"}


def test_files_of_the_users_are_kept(falling, tmp_path):
    plan = grid(falling, "launch.height=0.5:2:3")
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


def test_another_sweep_never_replaces_an_interrupted_one(falling, tmp_path):
    path = tmp_path / "rows.csv"
    with RowFile(path, grid(falling, "launch.height=0.5:2:40")) as file:
        file.append(Rows.of([{"launch.height": 9.0, "error": ""}]))
    kept = path.read_bytes()
    other = grid(falling, "launch.height=0.5:2:3")
    with pytest.raises(RequestError, match=r"rows\.csv: contains rows of another interrupted sweep"):
        swept(other, path)
    assert path.read_bytes() == kept
    path.with_name("rows.csv.resume").unlink()
    assert whole(other, path) == whole(other, tmp_path / "fresh.csv")
    changed = Plan(load(DROP, {"gravity": 1.0}), other.axes)
    assert changed.fingerprint != other.fingerprint


def test_rows_of_another_sweep_are_kept_as_a_backup(falling, tmp_path):
    path, before = tmp_path / "rows.csv", tmp_path / "rows.csv~"
    first, other = grid(falling, "launch.height=0.5:2:3"), grid(falling, "launch.height=0.5:2:4")
    found = whole(first, path)
    again = swept(first, path)
    assert (again.resumed, text_of(again)) == (3, "3 points, all already in the file: the sweep is complete")
    path.with_name(".rows.csv.complete").unlink()
    assert (swept(first, path).resumed, before.exists()) == (0, False)  # the same rows are not kept twice
    path.write_bytes(found.replace(b"1.25", b"1.35"))  # no longer what the sweep wrote
    assert swept(first, path).resumed == 0
    assert (path.read_bytes(), before.exists()) == (found, True)
    before.unlink()
    done = swept(other, path)
    assert (before.read_bytes(), done.before) == (found, before)
    assert f"the previous rows are in {before}" in text_of(done)
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


def test_the_columns_are_those_of_the_plan_whatever_fails_first(falling, tmp_path):
    path, plan = tmp_path / "rows.csv", grid(falling, "launch.height=1,2,3")
    x = "launch.height"
    with RowFile(path, plan) as file:
        file.append(Rows.of([{x: 1.0, "error": "no way"}]))
        file.append(Rows.of([{x: 2.0, "bounces": 3, "error": ""}]))
    with RowFile(path, plan) as file:
        assert file.done == 2
        file.append(Rows.of([{x: 3.0, "bounced": True, "error": ""}]))
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
