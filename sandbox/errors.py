"""Errors that are meant for people: one or two plain lines, and the exit code they lead to."""

from collections.abc import Iterator
from contextlib import contextmanager


class SandboxError(Exception):
    """Anything the program can explain; the command line prints it without a traceback."""

    exit_code = 1


class RequestError(SandboxError):
    """The request was wrong: unknown scene or key, bad value, unreadable file."""

    exit_code = 2


class RunError(SandboxError):
    """The run could not be completed: diverged, stalled, left the world."""


class Stopped(SandboxError):
    """Ctrl-C, with something to say about what is kept."""

    exit_code = 130


class ExitCalled(Exception):
    """A scene's own code called ``sys.exit``: it failed, whatever code it gave."""


@contextmanager
def no_exit() -> Iterator[None]:
    """Around a scene's own code: ``sys.exit`` in it is an ExitCalled at the same place, so that it does not end the
    program, or a worker, as if all were well."""
    try:
        yield
    except SystemExit as error:
        raise ExitCalled(f"sys.exit({error.code!r}) : a scene must not end the program").with_traceback(
            error.__traceback__
        ) from None
