"""Ctrl-C, SIGTERM and a closed terminal as one KeyboardInterrupt that is never lost.

A scene may be inside a call of C that never ends, such as ``sum(range(10**12))``: Python cannot raise anything there,
and a second signal ends the program.
"""

from __future__ import annotations

import _thread
import ctypes
import os
import signal
import sys
import time

TYPE_CHECKING = False  # not from typing, which is slow to import
if TYPE_CHECKING:
    from types import FrameType

#: Signals within this time of each other, in s, are one request: Ctrl-C goes to a process and to its group.
_ONE = 0.3

#: Time in s after which an interrupt that was lost is raised again.
_AGAIN = 0.01


#: The signals, with the handler that each has if nobody handles or ignores it. Windows has no SIGHUP.
_HANDLED = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
if hasattr(signal, "SIGHUP"):
    _HANDLED[signal.SIGHUP] = signal.SIG_DFL


def is_interrupt(error: BaseException) -> bool:
    """True if an error is an interrupt; Python 3.11 makes a RuntimeError of what ``__set_name__`` raises."""
    return isinstance(error, KeyboardInterrupt) or isinstance(error.__cause__, KeyboardInterrupt)


class Interrupts:
    """The handler of the signals; between ``begin`` and ``end`` in the program's main thread."""

    def __init__(self) -> None:
        self._number = signal.SIGINT.value  # the last one
        self._last = -_ONE  # s
        self.is_over = False  # the command is done: what it said and its exit code stay

    def begin(self) -> None:
        """Handle the signals that nobody else handles or ignores."""
        for number, default in _HANDLED.items():
            if signal.getsignal(number) is default:
                self._handle_once(number)
        sys.unraisablehook = self._lost

    def end(self, then: signal.Handlers = signal.SIG_IGN) -> None:
        """Ignore the signals while Python shuts down, or handle them as said ``then``."""
        for number in _HANDLED:
            if signal.getsignal(number) is self:
                signal.signal(number, then)

    def _handle_once(self, number: int) -> None:
        """Handle a signal; from when it is received until Python calls this handler, another one ends the program. So
        it is where the C library has ``sysv_signal``; elsewhere another one has no effect until then."""
        signal.signal(number, self)
        handle = getattr(ctypes.CDLL(None), "sysv_signal", None) if os.name == "posix" else None
        if handle is not None:
            handler = ctypes.pythonapi.PyOS_getsig  # Python's own, in C
            handler.restype = ctypes.c_void_p
            handle(number, ctypes.c_void_p(handler(number)))

    def __call__(self, number: int, frame: FrameType | None) -> None:
        if self.is_over:
            return
        self._handle_once(number)
        now = time.monotonic()
        if now - self._last >= _ONE:
            self._last = now
            self._number = number
            raise KeyboardInterrupt

    def _lost(self, error: sys.UnraisableHookArgs) -> None:
        """Python drops what is raised in ``__del__``, for a weak reference or in a callback of C, and reports it here:
        raise an interrupt again soon."""
        if error.exc_type is not KeyboardInterrupt:
            sys.__unraisablehook__(error)
            return
        self._last = -_ONE
        # threading.Thread.start waits until its thread runs: long enough to lose the interrupt in here once more
        _thread.start_new_thread(self._again, ())

    def _again(self) -> None:
        time.sleep(_AGAIN)
        if os.name == "posix":
            os.kill(os.getpid(), self._number)
        else:  # where kill ends the process, whatever the signal
            signal.raise_signal(self._number)
