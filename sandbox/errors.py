"""Errors shown to the user: one or two lines, and the exit code."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager


class SandboxError(Exception):
    """An error with a message for the user; the command line prints it without a traceback.

    >>> import sandbox
    >>> issubclass(sandbox.RequestError, sandbox.SandboxError)
    True
    """

    exit_code = 1


class RequestError(SandboxError):
    """The request was wrong: unknown scene or key, bad value, unreadable file.

    >>> import sandbox
    >>> sandbox.load("gulf")
    Traceback (most recent call last):
    sandbox.errors.RequestError: unknown scene gulf; did you mean golf?
    """

    exit_code = 2


class RunError(SandboxError):
    """The run could not be completed: diverged, stalled, left the world.

    >>> import sandbox
    >>> from sandbox import Ball, Setup
    >>> runaway = Ball("ball", mass=1.0, radius=0.1, position=(0, 0), forces=[lambda t, x, v, spin: (1e9, 0.0)])
    >>> sandbox.simulate(Setup([runaway]))
    Traceback (most recent call last):
    sandbox.errors.RunError: t = ...
    """


class Stopped(SandboxError):
    """Stopped by Ctrl-C; the message says what was kept."""

    exit_code = 130


class ExitCalled(Exception):
    """A scene's own code called ``sys.exit`` or raised another exception that is not an Exception: a failure, whatever
    its exit code."""


@contextmanager
def sys_exit_as_error() -> Iterator[None]:
    """Turn ``sys.exit`` and its like in a scene's own code into an ExitCalled, so that it cannot end the program or a
    worker as if nothing were wrong."""
    try:
        yield
    except (Exception, KeyboardInterrupt):
        raise
    except BaseException as error:
        if isinstance(error, GeneratorExit) and _is_left_half_way(error):  # as a run without memory
            raise
        raise ExitCalled(f"{error!r}: a scene must not end the program").with_traceback(error.__traceback__) from None


def _is_left_half_way(error: GeneratorExit) -> bool:
    """Return True if Python has closed a generator at its ``yield``, and no code has raised this."""
    from dis import opname  # here, not above: no run without this error needs it
    from inspect import CO_GENERATOR

    last = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    if last is None:
        return True
    code = last.tb_frame.f_code
    return bool(code.co_flags & CO_GENERATOR) and opname[code.co_code[last.tb_lasti]] != "RAISE_VARARGS"


def no_forks() -> None:
    """Make ``os.fork`` raise RuntimeError in this process from now on: a copy of the program would write each file and
    answer each call of a worker a second time. Starting other programs stays possible."""

    def refuse(event: str, arguments: tuple[object, ...]) -> None:
        if event in ("os.fork", "os.forkpty"):
            raise RuntimeError(f"{event}: a scene must not copy the program; the module subprocess starts another one")

    sys.addaudithook(refuse)
