"""Ctrl-C and SIGTERM as one KeyboardInterrupt, raised where it is not lost."""

from __future__ import annotations

import os
import signal
import time
from types import FrameType

#: Signals within this time of each other, in s, are one request: Ctrl-C goes to a process and to its group.
_ONE = 0.3

#: An interrupt that would be lost is sent again after the first time, in s; a callback that lasts longer than the
#: second is in a user's force, and the engine keeps the exception that is raised there.
_AGAIN, _AT_MOST = 0.01, 0.3


class Interrupts:
    """The handler of both signals; between ``begin`` and ``end`` in the program's main thread."""

    def __init__(self) -> None:
        self.code = 128 + signal.SIGINT  # exit code if interrupted
        self._last = -_ONE
        self._waits_since: float | None = None
        self._handled: list[int] = []

    def begin(self) -> None:
        """Handle the signals that nobody else handles or ignores."""
        for number, default in ((signal.SIGINT, signal.default_int_handler), (signal.SIGTERM, signal.SIG_DFL)):
            if signal.getsignal(number) is default:
                signal.signal(number, self)
                self._handled.append(number)

    def end(self) -> None:
        """Ignore the signals while Python shuts down."""
        for number in self._handled:
            signal.signal(number, signal.SIG_IGN)

    def __call__(self, number: int, frame: FrameType | None) -> None:
        now = time.monotonic()
        if now - self._last < _ONE:
            return
        self._waits_since = self._waits_since or now
        if _is_lost(frame) and now - self._waits_since < _AT_MOST:
            from threading import Timer

            Timer(_AGAIN, os.kill, (os.getpid(), number)).start()  # which calls this again
            return
        self._last, self._waits_since = now, None
        self.code = 128 + number
        raise KeyboardInterrupt


def _is_lost(frame: FrameType | None) -> bool:
    """Whether an exception would be lost here: cffi prints what a callback of pymunk raises, and continues."""
    while frame is not None:
        file, function = frame.f_code.co_filename, frame.f_code.co_name
        if "pymunk" in file and (file.endswith("_callbacks.py") or function.endswith("free")):
            return True
        frame = frame.f_back
    return False
