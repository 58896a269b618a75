"""Worker processes on this machine.

A process pool that, unlike ProcessPoolExecutor, loses only one call when a process dies, can kill and replace a process
that hangs, and has no semaphores to leak if the program itself is killed.
"""

from __future__ import annotations

import gc
import multiprocessing
import os
import pickle
import signal
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from threading import Lock, Thread
from typing import Any
from weakref import WeakSet

from sandbox.errors import RunError, no_forks
from sandbox.workers.pool import WorkerLost

_CONTEXT = multiprocessing.get_context("spawn")  # no state of this process leaks into the others

#: The variable that keeps modules in the current folder from replacing those of Python, and a lock while it is set.
_SAFE_PATH, _STARTING = "PYTHONSAFEPATH", Lock()

_Asked = tuple["Future[Any]", Callable[..., Any], tuple[Any, ...]]


class Processes:
    """``jobs`` processes, each started at its first call."""

    def __init__(self, jobs: int) -> None:
        self.width = jobs
        self._asked: SimpleQueue[_Asked | None] = SimpleQueue()
        self._abandoned: WeakSet[Future[Any]] = WeakSet()
        self._processes = [_Process(self._asked, self._abandoned) for _ in range(jobs)]

    def submit(self, work: Callable[..., Any], *args: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self._asked.put((future, work, args))
        return future

    def kill(self) -> None:
        """Kill the processes: running calls raise WorkerLost, later ones get new processes."""
        for process in self._processes:
            process.kill()

    def abandon(self, call: Future[Any]) -> None:
        """Cancel a call, or kill the processes if one of them computes it."""
        if not call.cancel() and not call.done():
            self._abandoned.add(call)
            self.kill()

    def close(self, abandon: bool) -> None:
        if abandon:
            with suppress(Empty):
                while True:
                    asked = self._asked.get_nowait()
                    if asked is not None:
                        asked[0].cancel()
            for process in self._processes:
                process.kill(for_good=True)
        for _ in self._processes:
            self._asked.put(None)
        for process in self._processes:
            process.thread.join()


class _Process:
    """One process, and the thread that sends it one call after the other."""

    def __init__(self, asked: SimpleQueue[_Asked | None], abandoned: WeakSet[Future[Any]]) -> None:
        self._asked, self._abandoned = asked, abandoned
        self._process: Any = None
        self._line: Connection | None = None
        self._is_over = False
        self._changing = Lock()
        self.thread = Thread(target=self._send_calls, daemon=True)
        self.thread.start()

    def kill(self, for_good: bool = False) -> None:
        """Kill the process during its call; the next call starts another, unless ``for_good``."""
        with self._changing:
            self._is_over = for_good
            if self._process is not None:
                self._process.kill()

    def _send_calls(self) -> None:
        while (asked := self._asked.get()) is not None:
            future, work, args = asked
            if not future.set_running_or_notify_cancel():
                continue
            try:
                succeeded, reply = self._reply(future, (work, args))
            except Exception as error:
                succeeded, reply = False, error
            if succeeded:
                future.set_result(reply)
            else:
                future.set_exception(reply)
        self._end()

    def _reply(self, future: Future[Any], call: tuple[Callable[..., Any], tuple[Any, ...]]) -> tuple[bool, Any]:
        """The process' reply: whether the call succeeded, and its result or exception."""
        try:
            self._send(future, call)
        except OSError:  # it was killed while idle: this call is the first to notice
            self._end()
            self._send(future, call)
        try:
            reply: tuple[bool, Any] = self._connection().recv()
            return reply
        except (EOFError, OSError):
            code = self._end()
            raise WorkerLost(f"its process ended with {code}") from None

    def _send(self, future: Future[Any], call: tuple[Callable[..., Any], tuple[Any, ...]]) -> None:
        line = self._connection()
        if future in self._abandoned:  # before this process was there to be killed
            raise WorkerLost("abandoned")
        line.send(call)

    def _connection(self) -> Connection:
        with self._changing:
            if self._is_over:
                raise WorkerLost("no more calls")
            if self._line is None:
                self._process, self._line = _started()
            return self._line

    def _end(self) -> int | None:
        with self._changing:
            if self._line is None:
                return None
            self._line.close()  # which tells an idle process to exit
            self._process.join()
            code: int | None = self._process.exitcode
            self._process = self._line = None
            return code


def _started() -> tuple[Any, Connection]:
    """A new process that computes calls, and the line to it. Raises RunError if there is no room for one."""
    try:
        line, other = _CONTEXT.Pipe()
        with other:
            process = _CONTEXT.Process(target=_serve, args=(other,), daemon=True)
            with _starting():
                process.start()
            return process, line
    except OSError as error:
        raise RunError(f"a worker process cannot be started: {(error.strerror or str(error)).lower()}") from None


@contextmanager
def _starting() -> Iterator[None]:
    """Set what processes that are started inside inherit."""
    with _STARTING:
        before = os.environ.get(_SAFE_PATH)
        os.environ[_SAFE_PATH] = "1"
        try:
            # Ctrl-C reaches all processes of a terminal, but only the main one should handle it: a signal blocked here
            # stays blocked in a process started here. (Starting the tracker would unblock it again.)
            resource_tracker.ensure_running()
            if hasattr(signal, "pthread_sigmask"):
                signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            yield
        finally:
            del os.environ[_SAFE_PATH]
            if before is not None:
                os.environ[_SAFE_PATH] = before


# ---------------------------------------------------------------------------------------------------------------------
# In the other process
# ---------------------------------------------------------------------------------------------------------------------


def _serve(line: Connection) -> None:
    """Compute the calls received, until the connection is closed."""
    _end_with_parent()
    no_forks()
    if not hasattr(signal, "pthread_sigmask"):  # Windows: Ctrl-C reaches this process, too
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.stdout = sys.stderr  # what a scene prints: the program's stdout may be JSON
    gc.set_threshold(100_000)  # as in the program itself
    while True:
        try:
            work, args = line.recv()
        except (EOFError, OSError):  # the parent process is gone
            return
        except Exception as error:  # it cannot be unpickled here
            _send(line, (False, error))
            continue
        try:
            reply = (True, work(*args))
        except Exception as error:
            reply = (False, error)
        except BaseException as error:  # a scene's sys.exit() ends the call, not the process
            reply = (False, RuntimeError(f"{type(error).__name__}: {error}"))
        _send(line, reply)


def _send(line: Connection, reply: tuple[bool, Any]) -> None:
    """Send a reply, unless nobody is left to receive it; an exception that cannot be pickled or unpickled is sent as
    its message."""
    try:
        packed = pickle.dumps(reply)
        if not reply[0]:
            pickle.loads(packed)
    except Exception as error:
        unsendable = reply[1] if not reply[0] else error
        packed = pickle.dumps((False, RuntimeError(f"{type(unsendable).__name__}: {unsendable}")))
    with suppress(OSError):
        line.send_bytes(packed)


def _end_with_parent() -> None:
    """Exit, even during a call, when the parent process is gone."""
    parent = multiprocessing.parent_process()

    def follow() -> None:
        if parent is not None:
            parent.join()
        os._exit(1)

    Thread(target=follow, daemon=True).start()
