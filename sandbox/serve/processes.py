"""Processes that compute for many players: one job a player at a time, the newest wins, long ones never keep short ones
waiting, and whoever has had the least of the time is next."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Coroutine, Hashable
from contextlib import suppress
from dataclasses import dataclass, field
from time import monotonic
from typing import Any

from sandbox.serve.calls import Reply, timed
from sandbox.serve.limits import LONG, RUN
from sandbox.workers.pool import WorkerLost, cores
from sandbox.workers.processes import Processes

#: More processes than cores: as many long jobs may run at once.
_SPARE = 2
#: By so much those for long jobs give way to the others.
_NICE = 10
#: Share of the last time in the time that a job is expected to take; and of how many kinds of jobs that is kept.
_LEARNED, _KINDS = 0.5, 4096
#: What a player has had counts half after so long, in s.
_HALF_LIFE = 20.0
#: What is wanted besides the rest: of a player, one of these and one of the others run at a time.
_ASIDE = {"fan"}


@dataclass(eq=False)
class _Job:
    """A call for a player, who is waiting for ``reply``; it is None if a newer one took its place."""

    player: Hashable
    want: Hashable
    alike: Hashable  # what takes about as long
    work: Callable[..., Reply]
    args: tuple[Any, ...]
    reply: asyncio.Future[Reply | None]
    began: float = field(default=0.0)  # s, on the clock of monotonic

    @property
    def turn(self) -> Hashable:
        """The key of jobs that take turns: of those that share it, one runs at a time."""
        return self.player, self.want in _ASIDE


class JobProcesses:
    """``width`` processes. In the loop that runs where it is made. Each calls ``warm(*args)`` before its first job, and
    again after it was ended: how long a process takes to start does not count as a job's time."""

    def __init__(self, width: int | None, warm: Callable[..., Any] = dict, *args: Any) -> None:
        self.width = width or cores() + _SPARE
        self._warm = warm, args
        self._processes = [Processes(1) for _ in range(self.width)]
        self._slow = self._processes[cores() :] or self._processes[-1:]  # those for long jobs
        self._idle: list[Processes] = []
        self._running: dict[Hashable, _Job] = {}  # by turn
        self._waiting: dict[Hashable, _Job] = {}  # the newest of each want, in the order in which they came
        self._takes: dict[Hashable, float] = {}  # s, of what is alike, of a player or of anybody; the oldest first
        self._had: dict[Hashable, tuple[float, float]] = {}  # s of computing by player, when that was true
        self._tasks: set[asyncio.Task[None]] = set()
        for process in self._processes:
            self._follow(self._warm_up(process))

    async def compute(
        self, player: Hashable, want: Hashable, alike: Hashable, work: Callable[..., Reply], *args: Any
    ) -> Reply | None:
        """The reply of ``work(*args)``, computed once no other job runs for this ``player``; None if something newer
        was wanted by then, of the same ``want``. One that takes too long is ended, which its reply says. Jobs that are
        ``alike`` take about as long, above all for the same player."""
        job = _Job(player, want, alike, work, args, asyncio.get_running_loop().create_future())
        older = self._waiting.get((player, want))
        if older is not None and not older.reply.done():
            older.reply.set_result(None)
        self._waiting[player, want] = job  # in the place of the older one
        self._start()
        return await job.reply

    def forget(self, player: Hashable) -> None:
        """Drop what a player waits for, who has left."""
        for key in [key for key, job in self._waiting.items() if job.player == player]:
            job = self._waiting.pop(key)
            if not job.reply.done():
                job.reply.set_result(None)

    def close(self) -> None:
        """End all processes, whatever they compute."""
        for process in self._processes:
            process.close(abandon=True)

    def _start(self) -> None:
        """Start what can be started, first for whoever has had the least. Of long jobs so many run at once as there are
        more processes than cores; they, and what its player has not tried, never take the last of the quick processes.
        """
        now = monotonic()
        long = sum(self._is_long(job, now) for job in self._running.values())
        for key, job in sorted(self._waiting.items(), key=lambda each: self._share(each[1].player, now)):
            if not self._idle:
                return
            is_long = self._is_long(job, now)
            is_short = not is_long and self._expected(job) is not None
            if job.turn in self._running or (is_long and long >= max(1, self.width - cores())):
                continue
            process = max(self._idle, key=lambda each: (each in self._slow) != is_short)
            if not is_short and process not in self._slow and sum(each not in self._slow for each in self._idle) < 2:
                continue
            del self._waiting[key]
            long += is_long
            job.began = now
            self._running[job.turn] = job
            self._idle.remove(process)
            self._follow(self._run(job, process))

    def _share(self, player: Hashable, now: float) -> float:
        """The time in s that was computed for a player; what was long ago counts less."""
        had, then = self._had.get(player, (0.0, now))
        return had * 0.5 ** ((now - then) / _HALF_LIFE)

    def _learn(self, job: _Job, took: float) -> None:
        """Note how long a job took: for its player and for all, and what its player has had."""
        now = monotonic()
        for key in ((job.player, job.alike), (None, job.alike)):
            self._takes[key] = _LEARNED * took + (1 - _LEARNED) * self._takes.pop(key, took)
        self._takes[job.player, job.want, "last"] = took
        self._had[job.player] = self._share(job.player, now) + took, now
        for kept in (self._takes, self._had):
            while len(kept) > _KINDS:
                del kept[next(iter(kept))]

    def _expected(self, job: _Job) -> float | None:
        """The time in s that a job is expected to take: as this player's that were alike; else as his last one or as
        anybody's, if that was long. None for what may be short."""
        known = self._takes.get((job.player, job.alike))
        if known is not None:
            return known
        others = self._takes.get((job.player, job.want, "last"), 0.0), self._takes.get((None, job.alike), 0.0)
        return max(others) if max(others) > LONG else None

    def _follow(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _warm_up(self, process: Processes) -> None:
        """Have a process import what it needs; then it takes jobs."""
        work, args = self._warm
        with suppress(Exception):  # what is wrong is said where it is asked for
            if process in self._slow and self.width > cores() and hasattr(os, "nice"):  # not on Windows
                await asyncio.wrap_future(process.submit(os.nice, _NICE))
            await asyncio.wrap_future(process.submit(work, *args))
        self._idle.append(process)
        self._start()

    def _is_long(self, job: _Job, now: float) -> bool:
        """True if a job is expected to take long, or has done so."""
        return (self._expected(job) or 0.0) > LONG or (job.began > 0.0 and now - job.began > LONG)

    async def _run(self, job: _Job, process: Processes) -> None:
        reply: Reply
        lost, took = False, None
        call = process.submit(timed, job.work, *job.args)
        ending = asyncio.get_running_loop().call_later(RUN, process.abandon, call)
        try:
            reply, took = await asyncio.wrap_future(call)
        except WorkerLost:
            lost, late = True, monotonic() - job.began >= RUN
            why = f"this takes more than {RUN:g} s to compute, and was ended"
            reply = {"error": why if late else "the process that computed this was lost; try again"}
        except Exception as error:
            reply = {"error": f"this could not be computed: {type(error).__name__}"}
        ending.cancel()
        self._learn(job, monotonic() - job.began if took is None else took)
        del self._running[job.turn]
        if not job.reply.done():
            job.reply.set_result(reply)
        if lost:
            await self._warm_up(process)
        else:
            self._idle.append(process)
            self._start()
