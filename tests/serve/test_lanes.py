"""Who is computed when: the newest wins, one at a time, and long jobs keep nobody waiting."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from sandbox.serve import lanes
from sandbox.serve.lanes import Lanes


def kept(**what: Any) -> Any:
    return {"kept": what}


def run(play: Callable[[Lanes], Awaitable[Any]], width: int) -> Any:
    async def played() -> Any:
        made = Lanes(width)
        try:
            while len(made._idle) < width:  # until all processes are there
                await asyncio.sleep(0.01)
            return await play(made)
        finally:
            made.close()

    return asyncio.run(played())


def test_the_newest_wins_and_one_runs_at_a_time():
    async def play(made: Lanes) -> Any:
        first = asyncio.create_task(made.compute("ann", "path", "slow", time.sleep, 0.3))
        await asyncio.sleep(0.05)
        later = [asyncio.create_task(made.compute("ann", "path", "x", dict, [("kept", n)])) for n in range(5)]
        other = asyncio.create_task(made.compute("ann", "stage", "x", dict, [("kept", "stage")]))
        await asyncio.sleep(0.05)
        assert not later[-1].done()  # although there is a process to spare
        await first
        return [await each for each in later], await other

    later, other = run(play, 2)
    assert later == [None, None, None, None, {"kept": 4}]
    assert other == {"kept": "stage"}


def test_long_jobs_never_keep_others_waiting(monkeypatch: pytest.MonkeyPatch):
    """With three processes on two cores, one of ten breaks runs at a time once it is known how long they take."""
    monkeypatch.setattr(lanes, "cores", lambda: 2)
    monkeypatch.setattr(lanes, "LONG", 0.1)

    async def play(made: Lanes) -> list[float]:
        await made.compute("first", "path", "break", time.sleep, 0.15)
        breaks = [asyncio.create_task(made.compute(f"break {n}", "path", "break", time.sleep, 0.6)) for n in range(3)]
        waits = []
        for n in range(20):
            began = time.monotonic()
            assert await made.compute(f"putt {n}", "path", "putt", dict, [("kept", n)]) == {"kept": n}
            waits.append(time.monotonic() - began)
        assert not breaks[-1].done()
        await asyncio.gather(*breaks)
        return waits

    assert max(run(play, 3)) < 0.5


def test_what_takes_too_long_or_breaks_is_ended(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(lanes, "RUN", 0.2)

    async def play(made: Lanes) -> list[Any]:
        slow = await made.compute("ann", "path", "slow", time.sleep, 60)
        monkeypatch.setattr(lanes, "RUN", 20.0)
        lost = await made.compute("ann", "path", "lost", os._exit, 3)
        raised = await made.compute("ann", "path", "raised", int, "x")
        good = await made.compute("ann", "path", "good", dict, [("kept", 1)])
        return [slow, lost, raised, good]

    slow, lost, raised, good = run(play, 1)
    assert slow == {"error": "this takes more than 0.2 s to compute, and was ended"}
    assert "lost" in lost["error"]
    assert raised == {"error": "this could not be computed: ValueError"}
    assert good == {"kept": 1}
