"""Work in another thread, and how long a frame waits for such work."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import wait as wait_for
from functools import partial
from queue import SimpleQueue
from threading import Thread
from typing import Any

#: How long a frame waits for a run, in s: the rest of a frame is for drawing.
PATIENCE = 0.005
#: How often Python switches between threads, in s: its default of 5 ms would be a third of a frame.
SWITCH_INTERVAL = 0.0005


def steady() -> None:
    """Make garbage collection skip all objects that exist now: going through them takes two frames."""
    gc.unfreeze()
    gc.collect()
    gc.freeze()


class Background:
    """A thread that works through a queue while the window draws. The program may end before it is done."""

    def __init__(self) -> None:
        sys.setswitchinterval(SWITCH_INTERVAL)
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
            try:
                future.set_result(work())
            except Exception as error:  # reported where the result is asked for
                future.set_exception(error)


def ready(future: Future[Any], patience: float | None) -> bool:
    """Whether it is done, after waiting for at most ``patience`` s (None: until it is)."""
    return bool(wait_for([future], patience).done)
