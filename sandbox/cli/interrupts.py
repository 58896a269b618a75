"""Ctrl-C and SIGTERM as one KeyboardInterrupt, at a place where it is not lost."""

from __future__ import annotations

import os
import signal
import time
from types import FrameType

#: Signals within so many s of each other are one request: Ctrl-C goes to a process and to its group.
_ONE = 0.3

#: An interrupt that would be lost waits so long, in s, and comes again; a callback that lasts longer than the second
#: is held up by a user's force, and the engine keeps what that raises.
_AGAIN, _AT_MOST = 0.01, 0.3


class Interrupts:
    """The handler of both signals; between ``begin`` and ``end`` in the program's main thread."""

    def __init__(self) -> None:
        self.code = 128 + signal.SIGINT  # what the program ends with if it is interrupted
        self._last = -_ONE
        self._waits_since: float | None = None
        self._heard: list[int] = []

    def begin(self) -> None:
        """Handle the signals that nobody else handles or ignores."""
        for number, default in ((signal.SIGINT, signal.default_int_handler), (signal.SIGTERM, signal.SIG_DFL)):
            if signal.getsignal(number) is default:
                signal.signal(number, self)
                self._heard.append(number)

    def end(self) -> None:
        """Nothing is left to interrupt: Python puts its things away."""
        for number in self._heard:
            signal.signal(number, signal.SIG_IGN)

    def __call__(self, number: int, frame: FrameType | None) -> None:
        now = time.monotonic()
        if now - self._last < _ONE:
            return
        self._waits_since = self._waits_since or now
        if _is_lost(frame) and now - self._waits_since < _AT_MOST:
            from threading import Timer

            Timer(_AGAIN, os.kill, (os.getpid(), number)).start()  # which comes here again
            return
        self._last, self._waits_since = now, None
        self.code = 128 + number
        raise KeyboardInterrupt


def _is_lost(frame: FrameType | None) -> bool:
    """Whether an exception would be lost here: cffi prints what a callback of pymunk raises, and goes on."""
    while frame is not None:
        file, function = frame.f_code.co_filename, frame.f_code.co_name
        if "pymunk" in file and (file.endswith("_callbacks.py") or function.endswith("free")):
            return True
        frame = frame.f_back
    return False
