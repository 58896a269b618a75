"""Who is computed when: the newest wins, one at a time, and long jobs keep nobody waiting."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from sandbox.serve import processes
from sandbox.serve.processes import JobProcesses
from tests.own_scene import HANG


def kept(**what: Any) -> Any:
    return {"kept": what}


def held_until(file: str) -> None:
    """Compute until there is a file of this name."""
    while not Path(file).exists():
        time.sleep(0.01)


def run(play: Callable[[JobProcesses], Awaitable[Any]], width: int) -> Any:
    async def played() -> Any:
        made = JobProcesses(width)
        try:
            while len(made._idle) < width:  # until all processes are there
                await asyncio.sleep(0.01)
            return await play(made)
        finally:
            made.close()

    return asyncio.run(played())


def test_the_newest_wins_and_one_runs_at_a_time(tmp_path: Path):
    async def play(made: JobProcesses) -> Any:
        first = asyncio.create_task(made.compute("ann", "path", "slow", held_until, str(tmp_path / "go")))
        await asyncio.sleep(0)
        later = [asyncio.create_task(made.compute("ann", "path", "x", dict, [("kept", n)])) for n in range(5)]
        other = asyncio.create_task(made.compute("ann", "stage", "x", dict, [("kept", "stage")]))
        await asyncio.sleep(0)
        assert not later[-1].done()  # although there is a process to spare
        (tmp_path / "go").touch()
        await first
        return [await each for each in later], await other

    later, other = run(play, 2)
    assert later == [None, None, None, None, {"kept": 4}]
    assert other == {"kept": "stage"}


def test_long_jobs_never_keep_others_waiting(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """With three processes on two cores, one of three breaks runs at a time once it is known how long they take: putts
    are computed while none of them ends."""
    monkeypatch.setattr(processes, "cores", lambda: 2)
    monkeypatch.setattr(processes, "RUN", 2 * HANG)
    go = str(tmp_path / "go")

    async def play(made: JobProcesses) -> None:
        await made.compute("first", "path", "break", time.sleep, 1.1 * processes.LONG)
        breaks = [asyncio.create_task(made.compute(f"break {n}", "path", "break", held_until, go)) for n in range(3)]
        for n in range(20):
            putt = made.compute(f"putt {n}", "path", "putt", dict, [("kept", n)])
            assert await asyncio.wait_for(putt, HANG) == {"kept": n}
        assert sum(job.alike == "break" for job in made._running.values()) == 1
        assert not any(each.done() for each in breaks)
        Path(go).touch()
        await asyncio.gather(*breaks)

    run(play, 3)


def test_slow_players_keep_no_quiet_one_waiting(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """Six whose paths of the same scene never end, and one whose paths are known to be short: he waits for none."""
    monkeypatch.setattr(processes, "cores", lambda: 2)
    monkeypatch.setattr(processes, "RUN", 2 * HANG)
    go = str(tmp_path / "go")

    async def play(made: JobProcesses) -> None:
        await made.compute("quiet", "path", "golf", dict, [("kept", 0)])
        await made.compute("slow 0", "path", "golf", time.sleep, 1.1 * processes.LONG)
        alike = ["golf", "golf", "golf", "storm 1", "storm 2", "storm 3"]
        slow = [asyncio.create_task(made.compute(f"slow {n}", "path", alike[n], held_until, go)) for n in range(6)]
        for n in range(20):
            path = made.compute("quiet", "path", "golf", dict, [("kept", n)])
            assert await asyncio.wait_for(path, HANG) == {"kept": n}
        assert len(made._running) >= 2
        assert not any(each.done() for each in slow)
        Path(go).touch()
        await asyncio.gather(*slow)

    run(play, 4)


def test_whoever_has_had_the_least_is_next(tmp_path: Path):
    async def play(made: JobProcesses) -> list[str]:
        order: list[str] = []

        async def ask(player: str, want: str) -> None:
            await made.compute(player, want, "x", dict, [("kept", 1)])
            order.append(player)

        await made.compute("greedy", "path", "x", time.sleep, 0.05)
        first = asyncio.create_task(made.compute("holder", "path", "hold", held_until, str(tmp_path / "go")))
        asked = [asyncio.create_task(ask("greedy", want)) for want in ("path", "stage")]
        await asyncio.sleep(0)
        asked.append(asyncio.create_task(ask("new", "path")))
        await asyncio.sleep(0)
        (tmp_path / "go").touch()
        await asyncio.gather(first, *asked)
        return order

    assert run(play, 1) == ["new", "greedy", "greedy"]


def test_what_takes_too_long_or_breaks_is_ended(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(processes, "RUN", 0.2)

    async def play(made: JobProcesses) -> list[Any]:
        slow = await made.compute("ann", "path", "slow", time.sleep, 60)
        monkeypatch.setattr(processes, "RUN", HANG)
        lost = await made.compute("ann", "path", "lost", os._exit, 3)
        raised = await made.compute("ann", "path", "raised", int, "x")
        good = await made.compute("ann", "path", "good", dict, [("kept", 1)])
        return [slow, lost, raised, good]

    slow, lost, raised, good = run(play, 1)
    assert slow == {"error": "this takes more than 0.2 s to compute, and was ended"}
    assert "lost" in lost["error"]
    assert raised == {"error": "this could not be computed: ValueError"}
    assert good == {"kept": 1}
