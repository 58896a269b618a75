"""Runs computed beside the drawing: a frame waits a little for the path, and is not late where it takes longer."""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import wait as wait_for
from typing import Any

#: How long a frame waits for a run, in s: most runs end in this time, and the rest of a frame is for drawing.
PATIENCE = 0.009
#: How often Python lets threads take turns, in s: its own 5 ms would be a third of a frame.
TURNS = 0.0005


class Ahead:
    """One thread that does one thing after the other."""

    def __init__(self) -> None:
        sys.setswitchinterval(TURNS)
        self.pool = ThreadPoolExecutor(1, "runs")

    def start(self, work: Callable[[], Any]) -> Future[Any]:
        """Do it as soon as what was asked for before is done."""
        return self.pool.submit(work)

    def close(self) -> None:
        """Leave what has not begun."""
        self.pool.shutdown(wait=False, cancel_futures=True)


def ready(future: Future[Any], patience: float | None) -> bool:
    """Whether it is done, after waiting for at most so many s (None: until it is)."""
    return bool(wait_for([future], patience).done)
