"""Work in another thread or process: how long a frame waits for it, and its latest result."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import wait as wait_for
from dataclasses import dataclass
from functools import partial
from math import inf
from queue import SimpleQueue
from threading import Thread
from time import perf_counter
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from sandbox.workers import Processes

_T = TypeVar("_T")

#: How long a frame waits for a run, in s: the rest of a frame is for drawing.
PATIENCE = 0.005
#: A fan or map that takes longer than this, in s, is taken for one that never ends once the aim has changed.
HUNG = 10.0
#: How often Python switches between threads, in s: its default of 5 ms would be a third of a frame.
_SWITCH_INTERVAL = 0.0005


@dataclass
class Workers:
    """The processes in which scenes are loaded and run, and how long a frame waits for the first."""

    path: Processes  # for the path that is aimed
    helper: Processes  # for what takes longer; maybe the same
    patience: float  # s


def steady() -> None:
    """Make garbage collection skip all objects that exist now: going through them takes two frames."""
    gc.unfreeze()
    gc.collect()
    gc.freeze()


class Background:
    """A thread that works through a queue while the window draws. The program may end before it is done."""

    def __init__(self) -> None:
        sys.setswitchinterval(_SWITCH_INTERVAL)
        self.queue: SimpleQueue[tuple[Future[Any], Callable[[], Any]] | None] = SimpleQueue()
        Thread(target=self._work, name="background", daemon=True).start()

    def submit(self, work: Callable[..., Any], *args: Any) -> Future[Any]:
        """Do the work once everything submitted before is done."""
        future: Future[Any] = Future()
        self.queue.put((future, partial(work, *args)))
        return future

    def close(self) -> None:
        """End when everything submitted is done."""
        self.queue.put(None)

    def _work(self) -> None:
        while (item := self.queue.get()) is not None:
            future, work = item
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(work())
            except Exception as error:  # reported where the result is asked for
                future.set_exception(error)


class LatestJob(Generic[_T]):
    """The result of work that is done again whenever what it is done for changes, one after the other."""

    def __init__(self, abandon: Callable[[Future[_T]], object] | None = None, hung: float = inf) -> None:
        """Work that takes longer than ``hung`` s is abandoned once it is wanted for something else; after each time the
        next may take twice as long, until some has ended: on a busy machine a new process needs that long to start."""
        self.abandon, self.hung, self.abandoned = abandon, hung, 0
        self.key: Any = None  # what the value is of
        self.value: _T | None = None  # None if there is none yet, or if the work failed
        self.error: BaseException | None = None
        self.work: Future[_T] | None = None
        self.work_for: Any = None
        self.began = 0.0  # perf_counter, in s

    @property
    def takes(self) -> float:
        """For how long the work has been going on, in s."""
        return perf_counter() - self.began if self.work is not None else 0.0

    def take(self, patience: float | None = 0.0) -> bool:
        """Take the result if it is there within ``patience`` s (None: wait); returns whether there is a new one."""
        if self.work is None or not wait_for([self.work], patience).done:
            return False
        work, self.work, self.key, self.abandoned = self.work, None, self.work_for, 0
        try:
            self.value, self.error = work.result(), None
        except BaseException as error:  # such as a process that was killed
            self.value, self.error = None, error
        return True

    def follow(self, key: Any, submit: Callable[[Any], Future[_T]]) -> None:
        """Begin the work for ``key``, unless it is None or it was done for that, or other work has not ended yet."""
        if key != self.work_for and self.takes > self.hung * 2**self.abandoned:
            self.abandoned += 1
            self.give_up(None)
        if key is not None and key != self.key and self.work is None:
            self.work, self.work_for, self.began = submit(key), key, perf_counter()

    def give_up(self, why: BaseException | None) -> None:
        """End the work without a result; ``why`` is the error of what it was done for, if given."""
        if self.work is not None and self.abandon is not None:
            self.abandon(self.work)
        self.work = None
        if why is not None:
            self.key, self.value, self.error = self.work_for, None, why

    def forget(self) -> None:
        """Drop the value."""
        self.key = self.value = self.error = None


class KeyedCache:
    """Values that are made once for what they are made of, and again when that changes."""

    def __init__(self) -> None:
        self._made: dict[str, tuple[Any, Any]] = {}

    def __call__(self, name: str, of: Any, make: Callable[[], Any]) -> Any:
        """The value of this name for ``of``."""
        if name not in self._made or self._made[name][0] != of:
            self._made[name] = of, make()
        return self._made[name][1]
