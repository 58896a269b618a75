"""What all workers offer, as in concurrent.futures; and this process as the simplest of them."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, Protocol


class WorkerLost(Exception):
    """The worker of a call went away, which says nothing about the call: it may be repeated."""


class Call(Protocol):
    """Something that is computed, or will be."""

    def result(self) -> Any:
        """What it gives, or the exception that it ended in; waits for either."""
        ...

    def done(self) -> bool:
        """Whether ``result`` would not wait."""
        ...


class Workers(Protocol):
    """Somewhere to compute. A call whose worker goes away ends in WorkerLost."""

    width: int  # how many calls run at once

    def submit(self, work: Callable[..., Any], *args: Any) -> Call:
        """Have ``work(*args)`` computed."""
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
