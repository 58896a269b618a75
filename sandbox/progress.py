"""A progress bar on stderr for work that takes a while."""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

#: Work that takes less than this shows no bar, in s.
PATIENCE = 2.0
#: Work of which more than this is left after that time says so in a line, on a terminal or not, in s.
_LONG = 20.0
#: Seconds between two refreshes of the bar.
_INTERVAL = 0.1
#: Length of the bar, in characters.
_LENGTH = 30


@contextmanager
def bar(what: str) -> Iterator[Callable[[float, float], None]]:
    """Yield a function to call with the amount done and the total.

    The bar shows on a terminal only. Work that takes long is announced in a line, in a log, too; and again if it has
    become more than twice as much. Rate and time left are measured from the first call, which may already count work
    done earlier, and again from one that has less done than the call before: the next piece of work.
    """
    begun = time.monotonic()
    refreshed = latest = announced = 0.0
    first: tuple[float, float] | None = None
    terminal = sys.stderr is not None and sys.stderr.isatty()

    def show(done: float, total: float) -> None:
        nonlocal refreshed, first, latest, announced
        now = time.monotonic()
        first = first if first is not None and done >= latest else (now, done)
        latest = done
        if now - begun < PATIENCE or now - refreshed < _INTERVAL:
            return
        refreshed = now
        worked, seconds = done - first[1], now - first[0]
        wait = (total - done) * seconds / worked if worked > 0 and seconds > 0.0 else 0.0
        if wait > _LONG and total > 2.0 * announced:
            announced = total
            _write(f"{what}: {total:,.0f} in all, about {_time(wait)} left", "\n", terminal)
        if terminal:
            full = round(_LENGTH * min(1.0, done / total)) if total else _LENGTH
            pace = f"{_rate(worked / seconds)}/s  {_time(wait)} left" if worked > 0 and seconds > 0.0 else ""
            _write(f"{what} {'━' * full}{'─' * (_LENGTH - full)} {int(done)}/{int(total)} {pace}")

    try:
        yield show if sys.stderr is not None else lambda done, total: None
    finally:
        if refreshed and terminal:
            _write("", "\r")


def _write(line: str, end: str = "", over: bool = True) -> None:
    """Write within the terminal's width, over the line before if there may be one."""
    width = shutil.get_terminal_size((80, 24)).columns - 1
    sys.stderr.write("\r" + line[:width].ljust(width) + end if over else line + end)
    sys.stderr.flush()


def _rate(rate: float) -> str:
    return f"{rate:,.0f}" if rate >= 10.0 else f"{rate:.2g}"


def _time(wait: float) -> str:
    """A time in s, as ``"12 s"``."""
    return f"{wait:.0f} s" if wait < 100.0 else f"{wait / 60:.0f} min" if wait < 6000.0 else f"{wait / 3600:.1f} h"
