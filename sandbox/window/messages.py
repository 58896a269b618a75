"""Messages for the player: what is said for a while, and what stays said until it is mended."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from sandbox.tracebacks import one_line_error
from sandbox.workers import WorkerLost

#: How long a message stays, in s.
_MESSAGE = 6.0


class _Message(NamedTuple):
    """A line for the player."""

    text: str
    bad: bool
    left: float  # s that it stays


def reason(error: BaseException) -> str:
    """An error in a line or two."""
    if isinstance(error, WorkerLost):
        return "the process that ran it was killed: out of memory?"
    return one_line_error(error)


class Messages:
    """Holds the message of the moment, and what is wrong with files that were saved."""

    def __init__(self) -> None:
        self.message: _Message | None = None
        self.unreadable: str | None = None  # what is wrong with the files as last saved

    def tell(self, text: str, bad: bool = False) -> None:
        """Say something for a while."""
        self.message = _Message(text, bad, _MESSAGE)

    def tell_error(self, error: BaseException) -> None:
        """Say for a while what went wrong."""
        self.tell(reason(error), bad=True)

    def reporting_errors(self, action: Callable[[], object]) -> bool:
        """Do something that may fail because of the input; a failure is reported and the game continues."""
        try:
            action()
        except Exception as error:
            self.tell_error(error)
            return False
        return True

    def files_are_bad(self, error: BaseException) -> None:
        """Say what is wrong with saved files until they can be read."""
        self.unreadable, self.message = reason(error), None

    def forget_error(self) -> None:
        """Drop the message of the moment if it reports an error, which no longer matters."""
        if self.message is not None and self.message.bad:
            self.message = None

    def advance(self, dt: float) -> None:
        """``dt`` s have passed."""
        if self.message is not None:
            text, bad, left = self.message
            self.message = _Message(text, bad, left - dt) if left > dt else None
