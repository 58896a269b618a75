"""Processes of this machine."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from threading import Thread
from typing import Any


class Processes:
    """Processes beside this one, started afresh, so that nothing of this one's state leaks into them."""

    def __init__(self, jobs: int) -> None:
        self.width = jobs
        self._pool = self._fresh()

    def _fresh(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(self.width, multiprocessing.get_context("spawn"), initializer=_end_with_parent)

    def submit(self, work: Callable[..., Any], *args: Any) -> Future[Any]:
        with _undisturbed():
            try:
                return self._pool.submit(work, *args)
            except BrokenProcessPool:
                self._pool.shutdown(wait=False)
                self._pool = self._fresh()
                return self._pool.submit(work, *args)

    def lost(self, error: BaseException) -> bool:
        return isinstance(error, BrokenProcessPool)

    def close(self, abandon: bool) -> None:
        if abandon:  # ProcessPoolExecutor.terminate_workers is for Python 3.14 and later
            for process in list((self._pool._processes or {}).values()):
                process.terminate()
        self._pool.shutdown(cancel_futures=True)


def _end_with_parent() -> None:
    """A process whose parent was killed would wait for work for ever."""
    parent = multiprocessing.parent_process()

    def follow() -> None:
        if parent is not None:
            parent.join()
        os._exit(1)

    Thread(target=follow, daemon=True).start()


@contextmanager
def _undisturbed() -> Iterator[None]:
    """Processes started here never see Ctrl-C, which goes to all processes of a terminal: the one that asked handles
    it. A blocked signal stays blocked in the processes that one starts."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
