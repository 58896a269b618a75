"""The interface of workers, as in concurrent.futures, and this process as the simplest one."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, Protocol


class WorkerLost(Exception):
    """The worker of a call died; the call itself may be repeated."""


class Call(Protocol):
    """A submitted computation."""

    def result(self) -> Any:
        """The result, or raises the exception of the call; waits until it is finished."""
        ...

    def done(self) -> bool:
        """True if ``result`` returns without waiting."""
        ...


class Workers(Protocol):
    """A place to compute. A call whose worker dies raises WorkerLost."""

    width: int  # number of calls that run at once

    def submit(self, work: Callable[..., Any], *args: Any) -> Call:
        """Submit ``work(*args)``."""
        ...

    def close(self, abandon: bool) -> None:
        """Accept no more calls; ``abandon`` drops running ones."""
        ...


def cores() -> int:
    """The number of processor cores available to this process."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class InTurn:
    """This process: a call is computed when its result is requested."""

    width = 1

    def submit(self, work: Callable[..., Any], *args: Any) -> Call:
        return _Later(work, args)

    def close(self, abandon: bool) -> None:
        pass


class _Later:
    def __init__(self, work: Callable[..., Any], args: tuple[Any, ...]) -> None:
        self._work = work
        self._args = args

    def result(self) -> Any:
        return self._work(*self._args)

    def done(self) -> bool:
        return False
