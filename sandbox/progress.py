"""A progress bar on stderr for work that takes a while."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

#: Work that is done within so many seconds shows no bar.
PATIENCE = 2.0
#: Seconds between two looks of the bar.
INTERVAL = 0.1
WIDTH = 32  # characters


@contextmanager
def bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """Gives a function to call with how much is done and how much there is; a bar shows on a terminal only.

    Rate and time left are reckoned from its first call on, which may come with work that was done before.
    """
    begun = time.monotonic()
    shown = 0.0  # when last, 0 for never
    first: tuple[float, int] | None = None

    def show(done: int, total: int) -> None:
        nonlocal shown, first
        now = time.monotonic()
        first = first or (now, done)
        if now - begun < PATIENCE or now - shown < INTERVAL:
            return
        shown = now
        filled = WIDTH * done // max(total, 1)
        pace = _pace(done - first[1], now - first[0], total - done)
        sys.stderr.write(f"\r{what} [{'#' * filled}{'.' * (WIDTH - filled)}] {done}/{total}{pace}\x1b[K")
        sys.stderr.flush()

    try:
        yield show if sys.stderr is not None and sys.stderr.isatty() else lambda done, total: None
    finally:
        if shown:
            sys.stderr.write("\r\x1b[K")  # back to the start of the line, and clear it
            sys.stderr.flush()


def _pace(done: int, seconds: float, left: int) -> str:
    """Rate and time left, as ``"  1,240/s  12 s left"``."""
    if done <= 0 or seconds <= 0.0:
        return ""
    rate = done / seconds
    wait = left / rate
    remaining = f"{wait:.0f} s" if wait < 100.0 else f"{wait / 60:.0f} min" if wait < 6000.0 else f"{wait / 3600:.1f} h"
    return f"  {rate:,.0f}/s  {remaining} left" if rate >= 10.0 else f"  {rate:.2g}/s  {remaining} left"
