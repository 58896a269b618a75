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
    except (Exception, KeyboardInterrupt, GeneratorExit):  # the last: a run without memory may be left half way
        raise
    except BaseException as error:
        raise ExitCalled(f"{error!r}: a scene must not end the program").with_traceback(error.__traceback__) from None


def no_forks() -> None:
    """Make ``os.fork`` raise RuntimeError in this process from now on: a copy of the program would write each file and
    answer each call of a worker a second time. Starting other programs stays possible."""

    def refuse(event: str, arguments: tuple[object, ...]) -> None:
        if event in ("os.fork", "os.forkpty"):
            raise RuntimeError(f"{event}: a scene must not copy the program; the module subprocess starts another one")

    sys.addaudithook(refuse)
