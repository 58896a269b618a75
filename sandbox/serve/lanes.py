"""Processes that compute for many players: one job a player at a time, the newest wins, and long ones never keep short
ones waiting."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Coroutine, Hashable
from contextlib import suppress
from dataclasses import dataclass, field
from time import monotonic
from typing import Any

from sandbox.serve.calls import Reply
from sandbox.serve.limits import LONG, RUN
from sandbox.workers.pool import WorkerLost, cores
from sandbox.workers.processes import Processes

#: More processes than cores: as many long jobs may run at once.
SPARE = 2
#: By so much those for long jobs give way to the others.
NICE = 10
#: Share of the last time in the time that a job is expected to take.
LEARNED = 0.5


@dataclass(eq=False)
class Job:
    """A call for a player, who is waiting for ``reply``; it is None if a newer one took its place."""

    turn: Hashable  # of jobs with the same one, one runs at a time
    alike: Hashable  # what takes about as long
    work: Callable[..., Reply]
    args: tuple[Any, ...]
    reply: asyncio.Future[Reply | None]
    began: float = field(default=0.0)  # s, on the clock of monotonic


class Lanes:
    """``width`` processes. In the loop that runs where it is made. Each calls ``warm(*args)`` before its first job, and
    again after it was ended: how long a process takes to start does not count as a job's time."""

    def __init__(self, width: int | None, warm: Callable[..., Any] = dict, *args: Any) -> None:
        self.width = width or cores() + SPARE
        self._warm = warm, args
        self._processes = [Processes(1) for _ in range(self.width)]
        self._slow = self._processes[cores() :] or self._processes[-1:]  # those for long jobs
        self._idle: list[Processes] = []
        self._running: dict[Hashable, Job] = {}  # by turn
        self._waiting: dict[Hashable, Job] = {}  # the newest of each want, in the order in which they came
        self._takes: dict[Hashable, float] = {}  # s, by what takes about as long
        self._tasks: set[asyncio.Task[None]] = set()
        for process in self._processes:
            self._follow(self._warm_up(process))

    async def compute(
        self, turn: Hashable, want: Hashable, alike: Hashable, work: Callable[..., Reply], *args: Any
    ) -> Reply | None:
        """The reply of ``work(*args)``, computed once no other job with this ``turn`` runs; None if something newer was
        wanted by then, of the same ``want``. One that takes too long is ended, which its reply says. Jobs that are
        ``alike`` take about as long."""
        job = Job(turn, alike, work, args, asyncio.get_running_loop().create_future())
        older = self._waiting.get((turn, want))
        if older is not None and not older.reply.done():
            older.reply.set_result(None)
        self._waiting[turn, want] = job  # in the place of the older one
        self._start()
        return await job.reply

    def forget(self, turn: Hashable) -> None:
        """Drop what is waited for with this turn: who wanted it has left."""
        for key in [key for key, job in self._waiting.items() if job.turn == turn]:
            job = self._waiting.pop(key)
            if not job.reply.done():
                job.reply.set_result(None)

    def close(self) -> None:
        """End all processes, whatever they compute."""
        for process in self._processes:
            process.close(abandon=True)

    def _start(self) -> None:
        """Start what can be started: long jobs only as long as enough processes are left for short ones."""
        now = monotonic()
        long = sum(self._is_long(job, now) for job in self._running.values())
        for key, job in list(self._waiting.items()):
            if not self._idle:
                return
            is_long = self._is_long(job, now)
            if job.turn in self._running or (is_long and long >= max(1, self.width - cores())):
                continue
            del self._waiting[key]
            long += is_long
            job.began = now
            self._running[job.turn] = job
            process = max(self._idle, key=lambda each: (each in self._slow) == is_long)
            self._idle.remove(process)
            self._follow(self._run(job, process))

    def _follow(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _warm_up(self, process: Processes) -> None:
        """Have a process import what it needs; then it takes jobs."""
        work, args = self._warm
        with suppress(Exception):  # what is wrong is said where it is asked for
            if process in self._slow and self.width > cores():
                await asyncio.wrap_future(process.submit(os.nice, NICE))
            await asyncio.wrap_future(process.submit(work, *args))
        self._idle.append(process)
        self._start()

    def _is_long(self, job: Job, now: float) -> bool:
        """True if a job is expected to take long, or has done so."""
        return self._takes.get(job.alike, 0.0) > LONG or (job.began > 0.0 and now - job.began > LONG)

    async def _run(self, job: Job, process: Processes) -> None:
        reply: Reply
        lost = False
        call = process.submit(job.work, *job.args)
        ending = asyncio.get_running_loop().call_later(RUN, process.abandon, call)
        try:
            reply = await asyncio.wrap_future(call)
        except WorkerLost:
            lost, late = True, monotonic() - job.began >= RUN
            why = f"this takes more than {RUN:g} s to compute, and was ended"
            reply = {"error": why if late else "the process that computed this was lost; try again"}
        except Exception as error:
            reply = {"error": f"this could not be computed: {type(error).__name__}"}
        ending.cancel()
        took = monotonic() - job.began
        self._takes[job.alike] = LEARNED * took + (1 - LEARNED) * self._takes.get(job.alike, took)
        del self._running[job.turn]
        if not job.reply.done():
            job.reply.set_result(reply)
        if lost:
            await self._warm_up(process)
        else:
            self._idle.append(process)
            self._start()
