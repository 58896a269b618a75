"""Work for the player that takes longer than a frame, and what is done with its results."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, NamedTuple

from sandbox.window.background import Workers
from sandbox.window.messages import Messages


class _Job(NamedTuple):
    """Work under way."""

    work: Future[Any]
    then: Callable[[Any], object]  # what is done with its result
    said: str  # what the player is told until then; "" for nothing


class Jobs:
    """Holds what is under way, in the helper or in a thread of the window."""

    def __init__(self, workers: Workers, messages: Messages) -> None:
        self.workers, self.messages = workers, messages
        self.waiting: list[_Job] = []

    def ask(self, work: Future[Any], then: Callable[[Any], object], said: str = "") -> None:
        """Do something with a result once it is there; until then the player is told what is being done."""
        self.waiting.append(_Job(work, then, said))

    def stop(self) -> bool:
        """Stop what the player is told is being done; returns whether there was anything."""
        stopped = [job for job in self.waiting if job.said]
        for job in stopped:
            self.waiting.remove(job)
            self.workers.helper.abandon(job.work)
        return bool(stopped)

    def advance(self) -> None:
        """Go on with the results that are there."""
        for job in [job for job in self.waiting if job.work.done()]:
            self.waiting.remove(job)
            if not job.work.cancelled():
                self.messages.reporting_errors(lambda job=job: job.then(job.work.result()))  # type: ignore[misc]
