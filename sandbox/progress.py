"""A progress bar on stderr for work that takes a while."""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

#: Work that takes less than this shows no bar, in s.
PATIENCE = 2.0
#: Seconds between two refreshes of the bar.
INTERVAL = 0.1
#: Length of the bar, in characters.
LENGTH = 30


@contextmanager
def bar(what: str) -> Iterator[Callable[[float, float], None]]:
    """Yield a function to call with the amount done and the total; the bar shows on a terminal only.

    Rate and time left are measured from its first call, which may already count work done earlier, and again from one
    that has less done than the call before: the next piece of work.
    """
    begun = time.monotonic()
    refreshed = latest = 0.0
    first: tuple[float, float] | None = None

    def show(done: float, total: float) -> None:
        nonlocal refreshed, first, latest
        now = time.monotonic()
        first = first if first is not None and done >= latest else (now, done)
        latest = done
        if now - begun < PATIENCE or now - refreshed < INTERVAL:
            return
        refreshed = now
        full = round(LENGTH * min(1.0, done / total)) if total else LENGTH
        pace = _pace(done - first[1], now - first[0], total - done)
        _write(f"{what} {'━' * full}{'─' * (LENGTH - full)} {int(done)}/{int(total)} {pace}")

    try:
        yield show if sys.stderr is not None and sys.stderr.isatty() else lambda done, total: None
    finally:
        if refreshed:
            _write("")


def _write(line: str) -> None:
    """Over the line before, within the terminal's width; an empty one leaves the line empty."""
    width = shutil.get_terminal_size((80, 24)).columns - 1
    sys.stderr.write("\r" + line[:width].ljust(width) + "\r" * (not line))
    sys.stderr.flush()


def _pace(done: float, seconds: float, left: float) -> str:
    """Rate and time left, as ``"1,240/s  12 s left"``."""
    if done <= 0 or seconds <= 0.0:
        return ""
    rate = done / seconds
    wait = left / rate
    remaining = f"{wait:.0f} s" if wait < 100.0 else f"{wait / 60:.0f} min" if wait < 6000.0 else f"{wait / 3600:.1f} h"
    return f"{rate:,.0f}/s  {remaining} left" if rate >= 10.0 else f"{rate:.2g}/s  {remaining} left"
