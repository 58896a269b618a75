"""The ``sandbox`` program. This file imports almost nothing, so that Ctrl-C works from the start."""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading

from sandbox.cli.interrupts import Interrupts, is_interrupt

#: Exit code after Ctrl-C, SIGTERM, or if the terminal was closed.
_STOPPED = 130


def main(args: list[str] | None = None) -> int:
    """Run one command; an error becomes a line on stderr and an exit code.

    Called as the program (without ``args``), it cleans up when Ctrl-C, SIGTERM or a closed terminal stops it.
    """
    interrupts = Interrupts()
    gc.set_threshold(100_000)  # to look for cycles after each 700 new objects would take a tenth of a start or a sweep
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy's threads take longer to start than they could save
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # to look for them reads every installed package
    try:
        if args is None:
            interrupts.begin()
        from sandbox.cli.program import call
        from sandbox.errors import no_forks

        if args is None:
            no_forks()
        code = call(args)
        interrupts.is_over = True
    except BaseException as error:
        interrupts.is_over = True  # first: another one must not end this clause
        if not is_interrupt(error):
            raise
        from contextlib import suppress  # only here, so that signals are handled early

        if sys.stderr is not None:
            with suppress(OSError):  # the terminal may be closed
                sys.stderr.write("stopped\n")
        code = _STOPPED
    if args is None and code == _STOPPED and _threads_go_on():
        _leave(code)
    interrupts.end(signal.SIG_DFL if _threads_go_on() else signal.SIG_IGN)
    if args is None:
        gc.freeze()  # the process ends here: to look for cycles once more would take a fifth of a run
    if code == _STOPPED:
        # without it Python would end by SIGINT, not with this code, if it was interrupted in an exec
        eval("0")
    return code


def _threads_go_on() -> bool:
    """True if threads of a scene are left, for which Python would wait before the process ends."""
    return any(not thread.daemon for thread in threading.enumerate() if thread is not threading.main_thread())


def _leave(code: int) -> None:
    """End the process now, whatever its threads do."""
    for stream in (sys.stdout, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except (OSError, ValueError):  # the terminal may be closed
            pass
    os._exit(code)
