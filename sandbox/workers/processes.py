"""Processes of this machine.

A pool of our own in place of ProcessPoolExecutor: a process that dies takes its own call with it and no other, one that
hangs can be killed and another takes its place, and there are no semaphores to leak where the program itself is killed.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from threading import Lock, Thread
from typing import Any

from sandbox.workers.pool import WorkerLost

_CONTEXT = multiprocessing.get_context("spawn")  # nothing of this process' state leaks into the others

_Asked = tuple["Future[Any]", Callable[..., Any], tuple[Any, ...]]


class Processes:
    """``jobs`` processes, each begun with its first call."""

    def __init__(self, jobs: int) -> None:
        self.width = jobs
        self._asked: SimpleQueue[_Asked | None] = SimpleQueue()
        self._processes = [_Process(self._asked) for _ in range(jobs)]

    def submit(self, work: Callable[..., Any], *args: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self._asked.put((future, work, args))
        return future

    def kill(self) -> None:
        """End the processes, whatever they do: calls under way end in WorkerLost, later ones get new processes."""
        for process in self._processes:
            process.kill()

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
    """One process, and the thread that hands it one call after the other."""

    def __init__(self, asked: SimpleQueue[_Asked | None]) -> None:
        self._asked = asked
        self._process: Any = None
        self._line: Connection | None = None
        self._is_over = False
        self._changing = Lock()
        self.thread = Thread(target=self._hand_over, daemon=True)
        self.thread.start()

    def kill(self, for_good: bool = False) -> None:
        """End it in the middle of its call; the next call begins another, unless that was for good."""
        with self._changing:
            self._is_over = for_good
            if self._process is not None:
                self._process.kill()

    def _hand_over(self) -> None:
        while (asked := self._asked.get()) is not None:
            future, work, args = asked
            if not future.set_running_or_notify_cancel():
                continue
            try:
                succeeded, answer = self._answer((work, args))
            except Exception as error:
                succeeded, answer = False, error
            if succeeded:
                future.set_result(answer)
            else:
                future.set_exception(answer)
        self._end()

    def _answer(self, call: tuple[Callable[..., Any], tuple[Any, ...]]) -> tuple[bool, Any]:
        """What the process says: whether it succeeded, and the result or the exception."""
        try:
            self._begun().send(call)
        except OSError:  # it was killed while it waited: this call is the first to notice
            self._end()
            self._begun().send(call)
        try:
            answer: tuple[bool, Any] = self._begun().recv()
            return answer
        except (EOFError, OSError):
            code = self._end()
            raise WorkerLost(f"its process ended with {code}") from None

    def _begun(self) -> Connection:
        with self._changing:
            if self._is_over:
                raise WorkerLost("no more calls")
            if self._line is None:
                # Ctrl-C goes to all processes of a terminal, and is for the one that asked to handle: a signal that is
                # blocked here stays blocked in what is started here. (Starting the tracker would unblock it again.)
                resource_tracker.ensure_running()
                if hasattr(signal, "pthread_sigmask"):
                    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
                self._line, other = _CONTEXT.Pipe()
                self._process = _CONTEXT.Process(target=_serve, args=(other,), daemon=True)
                self._process.start()
                other.close()
            return self._line

    def _end(self) -> int | None:
        with self._changing:
            if self._line is None:
                return None
            self._line.close()  # which a process that waits for calls takes as the end
            self._process.join()
            code: int | None = self._process.exitcode
            self._process = self._line = None
            return code


# ---------------------------------------------------------------------------------------------------------------------
# In the other process
# ---------------------------------------------------------------------------------------------------------------------


def _serve(line: Connection) -> None:
    """Compute what is sent, until nothing comes any more."""
    _end_with_parent()
    while True:
        try:
            work, args = line.recv()
        except EOFError:
            return
        except Exception as error:  # it cannot be read here
            _send(line, (False, error))
            continue
        try:
            answer = (True, work(*args))
        except Exception as error:
            answer = (False, error)
        except BaseException as error:  # a scene's sys.exit() ends the call, not the process
            answer = (False, RuntimeError(f"{type(error).__name__}: {error}"))
        _send(line, answer)


def _send(line: Connection, answer: tuple[bool, Any]) -> None:
    """Send what can be sent and read at the other end; of an exception of a kind that cannot, what it says."""
    try:
        packed = pickle.dumps(answer)
        if not answer[0]:
            pickle.loads(packed)
    except Exception as error:
        told = answer[1] if not answer[0] else error
        packed = pickle.dumps((False, RuntimeError(f"{type(told).__name__}: {told}")))
    line.send_bytes(packed)


def _end_with_parent() -> None:
    """End even in the middle of a call when the process that asked is gone."""
    parent = multiprocessing.parent_process()

    def follow() -> None:
        if parent is not None:
            parent.join()
        os._exit(1)

    Thread(target=follow, daemon=True).start()
