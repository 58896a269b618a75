"""Limits of the machine and of files: memory, open files, room on a disk, pipes, endless chains of files."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from sandbox.errors import ExitCalled, sys_exit_as_error
from sandbox.files import write_together
from sandbox.lab.plan import Rows
from sandbox.lab.sweep import InTurn, RowsInOrder
from tests.own_scene import BUILD, COMMAND, DROP, HANG, Outcome, assert_refused, change, wait_for_work

Call = Callable[..., Outcome]


def limited(limits: dict[int, int], *args: object) -> Outcome:
    """Of the program in a process with these limits."""
    done = subprocess.run(
        [*COMMAND, *map(str, args)],
        capture_output=True,
        text=True,
        preexec_fn=lambda: [resource.setrlimit(which, (most, most)) for which, most in limits.items()] and None,
    )
    return Outcome(done.returncode, done.stdout, done.stderr)


def test_too_little_memory_is_a_line(tmp_path: Path):
    outcome = limited({resource.RLIMIT_AS: 80_000_000}, "run", DROP, "--poster", tmp_path / "x.png")
    assert_refused(outcome, "", 1)
    assert not (tmp_path / "x.png").exists()


def test_too_few_files_for_workers_is_a_line(tmp_path: Path):
    sweep = ("sweep", DROP, "--over", "launch.height=1:2:3", "--out", tmp_path / "x.csv", "--jobs", 2)
    assert_refused(limited({resource.RLIMIT_NOFILE: 9}, *sweep), "a worker process cannot be started: too many", 1)


def test_help_on_a_full_disk_is_a_line():
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([*COMMAND, "run", "--help"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert (done.returncode, done.stderr) == (1, "error: stdout: no space left on device\n")


def test_a_pipe_is_no_scene_file(call: Call, tmp_path: Path):
    os.mkfifo(tmp_path / "pipe.toml")
    assert_refused(call("run", tmp_path / "pipe.toml"), "pipe.toml: is a pipe or a device; a file is needed")
    (tmp_path / "link.toml").symlink_to("/dev/zero")
    assert_refused(call("run", tmp_path / "link.toml"), "is a pipe or a device; a file is needed")


def test_a_pipe_is_no_part_of_a_scene(call: Call, drop: Path):
    """As a preset it is not listed; where the scene's own values should be it is refused, not passed over."""
    os.mkfifo(drop / "presets" / "hose.toml")
    assert "hose" not in call("list", drop).out
    assert_refused(call("run", drop / "hose"), "drop has no preset hose; ")
    (drop / "drop.toml").unlink()
    os.mkfifo(drop / "drop.toml")
    assert_refused(call("run", drop), "drop.toml: is a pipe or a device; a file is needed")


@pytest.mark.parametrize("name", ["picture.py", "scene.py", "__init__.py"])
def test_a_pipe_is_no_module_of_a_scene(call: Call, drop: Path, name: str):
    (drop / name).unlink(missing_ok=True)
    os.mkfifo(drop / name)
    said = f"{name}: is a pipe or a device; a file is needed"
    assert_refused(call("run", drop, "--poster", "drop.png"), said)


def test_a_device_is_no_scene(call: Call):
    assert_refused(call("run", "/dev/zero"), "/dev/zero: is a pipe or a device; a file is needed")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x = " + "9" * 900_000, "a number in it has 900,000 digits, too many"),
        ("x = " + "[" * 100_000 + "]" * 100_000, "its lists or tables are nested too deeply"),
        ("[" + "a." * 100_000 + "b]", "line 2: a key has at most 100 parts"),
        ("a." * 100_000 + "b = 1", "line 2: a key has at most 100 parts"),
    ],
    ids=["digits", "lists", "table", "key"],
)
def test_a_scene_file_beyond_all_measure_is_a_line(call: Call, tmp_path: Path, text: str, said: str):
    (tmp_path / "x.toml").write_text(f'scene = "drop"\n{text}', "utf-8")
    assert_refused(call("run", tmp_path / "x.toml"), f"x.toml: {said}")


def test_a_sweep_without_room_leaves_all_as_it_was(tmp_path: Path):
    """No mark, and the file of before under its name; files of any size are too large here."""
    sweep = "sweep", DROP, "--over", "launch.height=1:2:3", "--out", tmp_path / "x.csv"
    assert_refused(limited({resource.RLIMIT_FSIZE: 0}, *sweep), "x.csv: cannot be written: file too large", 1)
    assert not [*tmp_path.iterdir()]
    assert limited({}, *sweep).code == 0
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    other = *sweep, "--set", "gravity=5"
    assert_refused(limited({resource.RLIMIT_FSIZE: 0}, *other), "x.csv: cannot be written: file too large", 1)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_huge_scene_file_is_refused_unread(call: Call, tmp_path: Path):
    with (tmp_path / "huge.toml").open("wb") as file:
        file.truncate(100_000_000)
    assert_refused(call("run", tmp_path / "huge.toml"), "huge.toml: has 100 MB; such a file has at most 1 MB")


def test_a_chain_of_scene_files_has_an_end(call: Call, drop: Path):
    for number in range(1_200):
        (drop / "presets" / f"p{number}.toml").write_text(f'scene = "drop/p{number + 1}"', "utf-8")
    assert_refused(call("run", drop / "p0"), "p0.toml: is based on more than 30 files, one on the other")


def test_a_new_scene_needs_a_folder_that_can_be_written(call: Call):
    assert_refused(call("new", "/proc/mine"), "new /proc/mine: cannot write into /proc: ")


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_scene_cannot_copy_the_program(drop: Path, tmp_path: Path, jobs: int):
    change(drop / "scene.py", BUILD, f"{BUILD}    import os; os.fork()\n")
    sweep = ("--over", "launch.height=1:2:3", "--out", tmp_path / "x.csv", "--jobs", jobs)
    script = "import sys; sys.argv[0] = 'sandbox'; from sandbox.cli import main; sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", script, "sweep", *map(str, (drop, *sweep))], capture_output=True, text=True
    )
    assert done.returncode == 1
    assert done.stderr.count("RuntimeError: os.fork: a scene must not copy the program") == 1


def test_a_second_ctrl_c_ends_a_call_of_c_without_an_end(drop: Path, tmp_path: Path):
    endless = f"    open({str(tmp_path / 'there')!r}, 'w').close(); sum(range(10**12))\n"
    change(drop / "scene.py", BUILD, BUILD + endless)
    process = subprocess.Popen([*COMMAND, "run", str(drop)], start_new_session=True)
    while not (tmp_path / "there").exists():
        time.sleep(0.01)
    wait_for_work(process, 0.1)  # until it is in that call
    process.send_signal(signal.SIGINT)
    wait_for_work(process, 0.1)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    assert process.wait(HANG) == -signal.SIGINT


def test_threads_of_a_scene_end_with_ctrl_c(drop: Path, tmp_path: Path):
    thread = "    import threading, time; threading.Thread(target=time.sleep, args=(600,)).start()\n"
    there = f"    open({str(tmp_path / 'there')!r}, 'w').close(); time.sleep(600)\n"
    change(drop / "scene.py", BUILD, BUILD + thread + there)
    process = subprocess.Popen([*COMMAND, "run", str(drop)], start_new_session=True, stderr=subprocess.PIPE, text=True)
    while not (tmp_path / "there").exists():
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    assert (process.communicate(timeout=HANG)[1], process.returncode) == ("stopped\n", 130)


@pytest.mark.parametrize(("wanted", "code"), [("list", 0), ("nonsense", 2)])
def test_ctrl_c_after_the_work_changes_nothing(wanted: str, code: int):
    """It comes as soon as the command has ended, as while the memory of a failed run is freed."""
    script = (
        "import signal, sys; from sandbox import cli\n"
        "end = cli.Interrupts.end\n"
        "def interrupted(self, *then): signal.raise_signal(signal.SIGINT); end(self, *then)\n"
        "cli.Interrupts.end = interrupted\n"
        f"sys.argv = ['sandbox', '{wanted}']; sys.exit(cli.main())"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == code
    assert "KeyboardInterrupt" not in done.stderr


def test_a_run_that_is_left_half_way_is_no_exit():
    """As Python leaves the generators of a run for which there was no memory."""

    def running() -> Iterator[None]:
        with sys_exit_as_error():
            yield

    run = running()
    next(run)
    run.close()  # raises nothing
    assert not [*run]


def test_a_generator_that_raises_its_own_exit_is_an_exit():
    def of_a_scene() -> Iterator[None]:
        yield
        raise GeneratorExit

    with pytest.raises(ExitCalled, match="GeneratorExit"), sys_exit_as_error():
        list(of_a_scene())


@pytest.mark.parametrize("where", ["finished", "close"])
def test_a_second_ctrl_c_still_says_what_a_sweep_has_kept(
    call: Call, drop: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str
):
    """The first comes after one point; the second while its rows are written, or while the workers end."""

    def interrupted(*_: Any, **__: Any) -> Any:
        raise KeyboardInterrupt

    def rows_of_one(self: RowsInOrder) -> Iterator[Rows]:
        self._queue_calls()
        yield self._next()[:1]
        raise KeyboardInterrupt

    monkeypatch.setattr(RowsInOrder, "__iter__", rows_of_one)
    monkeypatch.setattr(*((RowsInOrder, "finished") if where == "finished" else (InTurn, "close")), interrupted)
    sweep = ("sweep", drop, "--over", "launch.height=1:2:3", "--out", tmp_path / "x.csv", "--jobs", 1)
    outcome = call(*sweep)
    assert (outcome.code, outcome.out) == (130, "")
    assert outcome.err.startswith("stopped: 1 of 3 points are kept in ")
    assert len(outcome.err.splitlines()) == 1


def test_files_written_together_are_all_there_or_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """A full disk while the second is written; and Ctrl-C between the two renames."""
    (tmp_path / "file").touch()
    with pytest.raises(OSError, match="ot a directory"):
        write_together({tmp_path / "a.png": b"a", tmp_path / "file" / "b.json": b"b"})
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    replace = Path.replace

    def interrupted(part: Path, target: Path) -> Path:
        os.kill(os.getpid(), signal.SIGINT)
        return replace(part, target)

    monkeypatch.setattr(Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_together({tmp_path / "a.png": b"a", tmp_path / "b.json": b"b"})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.png", "b.json", "file"]
