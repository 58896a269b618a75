"""Sweeps in other processes and on clusters: interrupted, killed, lost, or with other code."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

import sandbox
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError, RunError
from sandbox.lab.axes import parse_axis
from sandbox.lab.plan import Plan
from sandbox.lab.provenance import provenance
from sandbox.lab.runs import runs
from sandbox.lab.sweep import RowsInOrder, sweep_to_file, workers, worthwhile_jobs
from sandbox.scene import load
from sandbox.scene.modules import read_again
from sandbox.workers import Processes
from sandbox.workers import cluster as cluster_of
from tests.lab.sweeping import grid, own_scene, table, whole
from tests.own_scene import COMMAND, HANG, change


def started(*args: object) -> subprocess.Popen[str]:
    """The program in a session of its own, as a terminal has it."""
    return subprocess.Popen(
        [*COMMAND, *map(str, args)], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    )


def everybody_gone(group: int) -> bool:
    end = time.monotonic() + HANG
    while time.monotonic() < end:
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
    """The last points are not computed before it: there is something to resume, however busy the machine is."""
    go, path = tmp_path / "go", tmp_path / "rows.csv"
    waits = (
        "    import pathlib, time\n"
        f"    go = pathlib.Path({str(go)!r})\n"
        "    if not go.exists():\n"
        "        time.sleep(0.01)\n"
        "    while parameters.launch.height > 1.5 and not go.exists():\n"
        "        time.sleep(0.01)\n"
    )
    scene = own_scene(tmp_path, waits)
    one_by_one = {"accuracy.method": "plain", "accuracy.step": 0.02}  # not in one block, which is kept as a whole
    command = ["sweep", scene, "--over", "launch.height=0.5:2:120", "--jobs", jobs, "--out", path]
    command += [f"--set={key}={value}" for key, value in one_by_one.items()]
    process = started(*command)
    deadline = time.monotonic() + HANG
    while not (path.exists() and path.read_bytes().count(b"\n") > 10):
        assert time.monotonic() < deadline, process.poll()
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)  # a terminal tells all processes
    out, err = process.communicate(timeout=HANG)
    assert (process.returncode, out) == (130, "")
    kept = len(table(path))
    assert 10 <= kept < 120
    *progress, last = err.splitlines()
    assert last == f"stopped: {kept} of 120 points are kept in {path}; run the same command to resume"
    assert all(line.startswith("sweep: ") for line in progress)  # how far it is, on a slow machine
    assert everybody_gone(process.pid)

    go.touch()
    finished = subprocess.run([*COMMAND, *map(str, command)], capture_output=True, text=True, check=True)
    assert f"120 points, {kept} already in the file" in finished.stdout
    assert path.read_bytes() == whole(grid(load(scene, one_by_one), "launch.height=0.5:2:120"), tmp_path / "again.csv")


def test_what_is_done_is_handed_in_by_time(tmp_path, monkeypatch, one_at_a_time):
    """However long a point takes after quick ones: an interrupt loses what the last moments computed, no more."""
    monkeypatch.setattr("sandbox.lab.sweep.CALL", 0.05)
    slow = "    if parameters.launch.height > 1.0:\n        import time\n        time.sleep(0.03)\n"
    plan = grid(load(own_scene(tmp_path, slow)), "launch.height=0.5:1.2:60")
    with workers(1) as pool:
        handed_in = list(RowsInOrder(plan, pool))
    assert [row["launch.height"] for rows in handed_in for row in rows] == [height for (height,) in plan.points(0, 60)]
    assert max(len(rows) for rows in handed_in if rows[-1]["launch.height"] > 1.1) <= 2


def test_an_interrupt_takes_in_what_others_have_finished(falling, one_at_a_time):
    class Others:
        width = 4

        def submit(self, work, *args):
            return SimpleNamespace(done=lambda: args[1] < 5, result=lambda: work(*args))

    handout = RowsInOrder(grid(falling, "launch.height=0.5:2:40"), Others())
    first = next(iter(handout))
    assert len(first) == 1
    assert [row["launch.height"] for rows in handout.finished(1) for row in rows] == pytest.approx(
        [0.5 + 1.5 * point / 39 for point in (1, 2, 3, 4)]
    )
    assert not list(handout.finished(1))


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
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=HANG)
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


def test_a_worker_with_other_code_is_refused_by_name(falling):
    plan = grid(falling, "launch.height=0.5:2:3")
    here = provenance(falling)
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


@pytest.mark.parametrize("accuracy", [{}, {"accuracy.tolerance": 1e-12}, {"accuracy.integrator": "rk4"}])
def test_a_block_is_about_a_second_of_work(accuracy):
    """Rows are kept by blocks: an interrupted sweep must not lose many seconds."""
    scene = sandbox.load("basketball/rattle", accuracy)
    speeds = parse_axis(scene, "--over", "launch.speed=7:8:900")
    plan = Plan(scene, (speeds,))
    (run,) = runs(scene, plan.keys, [(7.5,)], asked=plan.facts_read)
    assert isinstance(run, Run)
    assert plan.block * run.numerics.force_evaluations < 1_000_000
