"""Errors that are meant for people: one or two plain lines, and the exit code they lead to."""


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
