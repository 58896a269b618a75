"""A progress bar on stderr for work that takes a while."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.progress import Progress

#: Work that takes less than this shows no bar, in s.
PATIENCE = 2.0
#: Seconds between two refreshes of the bar.
INTERVAL = 0.1


@contextmanager
def bar(what: str) -> Iterator[Callable[[float, float], None]]:
    """Yield a function to call with the amount done and the total; the bar shows on a terminal only.

    Rate and time left are measured from its first call, which may already count work done earlier, and again from one
    that has less done than the call before: the next piece of work.
    """
    begun = time.monotonic()
    refreshed = latest = 0.0
    first: tuple[float, float] | None = None
    progress: Progress | None = None
    task: Any = None

    def show(done: float, total: float) -> None:
        nonlocal refreshed, first, latest, progress, task
        now = time.monotonic()
        first = first if first is not None and done >= latest else (now, done)
        latest = done
        if now - begun < PATIENCE or now - refreshed < INTERVAL:
            return
        refreshed = now
        if progress is None:
            progress = _bar()
            progress.start()
            task = progress.add_task(what, total=total, pace="")
        progress.update(task, completed=done, total=total, pace=_pace(done - first[1], now - first[0], total - done))
        progress.refresh()

    try:
        yield show if sys.stderr is not None and sys.stderr.isatty() else lambda done, total: None
    finally:
        if progress is not None:
            progress.stop()  # which clears the line


def _bar() -> Progress:
    """The bar, drawn only when it is refreshed, without a thread of its own."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[pace]}")
    console = Console(file=sys.stderr, force_terminal=True)
    return Progress(*columns, console=console, transient=True, auto_refresh=False)


def _pace(done: float, seconds: float, left: float) -> str:
    """Rate and time left, as ``"1,240/s  12 s left"``."""
    if done <= 0 or seconds <= 0.0:
        return ""
    rate = done / seconds
    wait = left / rate
    remaining = f"{wait:.0f} s" if wait < 100.0 else f"{wait / 60:.0f} min" if wait < 6000.0 else f"{wait / 3600:.1f} h"
    return f"{rate:,.0f}/s  {remaining} left" if rate >= 10.0 else f"{rate:.2g}/s  {remaining} left"
