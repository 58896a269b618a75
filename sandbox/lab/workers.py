"""Who computes: this process, others beside it, or a cluster; each behind one submit, as in concurrent.futures."""

from __future__ import annotations

import multiprocessing
import os
import signal
import socket
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from threading import Thread
from typing import Any, Protocol

from sandbox.errors import RequestError

#: Time in s that a scheduler has to answer, and then for a worker to be there.
_ANSWER, _ARRIVAL = 10.0, 30.0


class Call(Protocol):
    """Something that is computed, or will be."""

    def result(self) -> Any:
        """What it gives, or the exception that it ended in; waits for either."""
        ...


class Workers(Protocol):
    """Somewhere to compute."""

    width: int  # how many calls run at once

    def submit(self, work: Callable[..., Any], *args: Any) -> Call:
        """Have ``work(*args)`` computed."""
        ...

    def lost(self, error: BaseException) -> bool:
        """Whether a call failed because its worker went away, which says nothing about the call."""
        ...

    def close(self, abandon: bool) -> None:
        """No more calls; ``abandon`` drops those that are under way."""
        ...


def cores() -> int:
    """The processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class InTurn:
    """This process: a call is computed when its result is asked for."""

    width = 1

    def submit(self, work: Callable[..., Any], *args: Any) -> Call:
        return _Later(work, args)

    def lost(self, error: BaseException) -> bool:
        return False

    def close(self, abandon: bool) -> None:
        pass


class _Later:
    def __init__(self, work: Callable[..., Any], args: tuple[Any, ...]) -> None:
        self._work = work
        self._args = args

    def result(self) -> Any:
        return self._work(*self._args)


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


class Cluster:
    """The workers of a Dask scheduler at ``address``, which somebody else runs. They need this package, and a scene of
    one's own at the same place. Nothing listens here. Raises RequestError where nobody answers."""

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise RequestError("--scheduler needs Dask, which is not installed: pip install distributed") from None
        try:
            # first by hand: a Client that finds nobody takes half a minute to give up
            host, port = distributed.comm.parse_host_port(distributed.comm.parse_address(address)[1])
            socket.create_connection((host, port), timeout=_ANSWER).close()
            self._client = distributed.Client(address, timeout=_ANSWER, set_as_default=False)
        except (OSError, ValueError) as error:
            why = " ".join(str(error).split()) or "no answer"
            raise RequestError(f"--scheduler {address}: no Dask scheduler there: {why}") from None
        try:
            self._client.wait_for_workers(1, timeout=_ARRIVAL)
        except TimeoutError:
            self._client.close()
            raise RequestError(f"--scheduler {address}: it has no workers") from None
        self._killed = distributed.KilledWorker
        self._executor = self._client.get_executor(pure=False)
        self.width = max(1, sum(self._client.ncores().values()))

    def submit(self, work: Callable[..., Any], *args: Any) -> Future[Any]:
        future: Future[Any] = self._executor.submit(work, *args)
        return future

    def lost(self, error: BaseException) -> bool:
        # Dask gives a task to other workers by itself; this is one that took several with it
        return isinstance(error, self._killed)

    def close(self, abandon: bool) -> None:
        self._executor.shutdown(wait=not abandon)
        self._client.close()
