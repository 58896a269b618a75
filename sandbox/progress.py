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
    """Gives a function to call with how much is done and how much there is; a bar shows on a terminal only."""
    begun = time.monotonic()
    shown = 0.0  # when last, 0 for never

    def show(done: int, total: int) -> None:
        nonlocal shown
        now = time.monotonic()
        if now - begun < PATIENCE or now - shown < INTERVAL:
            return
        shown = now
        filled = WIDTH * done // max(total, 1)
        sys.stderr.write(f"\r{what} [{'#' * filled}{'.' * (WIDTH - filled)}] {done}/{total}")
        sys.stderr.flush()

    try:
        yield show if sys.stderr.isatty() else lambda done, total: None
    finally:
        if shown:
            sys.stderr.write("\r\x1b[K")  # back to the start of the line, and clear it
            sys.stderr.flush()
