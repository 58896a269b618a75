"""Errors caused by what a scene passed to the engine, as one line that names the cause."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sandbox.errors import RunError, sys_exit_as_error
from sandbox.tracebacks import defined_at

_PACKAGE = Path(__file__).resolve().parents[2]


class UserFunctionError(RunError):
    """A function of the scene, such as a contact law, does not take what it is called with, or returns what it must
    not."""


class MethodFailed(RunError):
    """The plain method failed: the message begins with how."""

    @property
    def name(self) -> str:
        """ "tunnelled" or "exploded"."""
        return str(self).partition(":")[0]


def call_user_function(function: Callable[..., Any], form: str, *arguments: Any) -> Any:
    """Return what a function of the scene returns. Raises UserFunctionError with the ``form`` in which it is called if
    it does not take these arguments."""
    try:
        return function(*arguments)
    except TypeError as error:
        if is_from_inside(error):
            raise
        raise UserFunctionError(f"{form}: {error}{defined_at(function)}") from None


def failed(t: float, ball: str, what: str) -> RunError:
    """An error of a run at time t in s, by the name of the ball."""
    return RunError(f"t = {t:.6g} s, ball {ball!r}: {what}")


def is_from_inside(error: Exception) -> bool:
    """Return True if an error, caught where a function is called, comes from the function, not from the call."""
    return error.__traceback__ is not None and error.__traceback__.tb_next is not None


@contextmanager
def setup_errors_named() -> Iterator[None]:
    """Context of a run: ``sys.exit`` in a function of the scene becomes a failure. Overflow in Python or pymunk, caused
    by absurd masses, lengths or speeds, becomes a RunError."""
    try:
        with sys_exit_as_error():
            yield
    except (ArithmeticError, AssertionError) as error:
        if not _is_ours(error):
            raise
        said = str(error.args[-1] if error.args else error).partition(". ")[0]
        raise RunError(
            f"masses, lengths, speeds or forces are too large or too small to compute with at t = 0 s or later: {said}"
        ) from error


def _is_ours(error: BaseException) -> bool:
    """Return True if it was raised by the engine, sandbox.physics or pymunk, and not by a scene's own code."""
    from traceback import walk_tb  # here, not above: no run without an error needs it

    *_, (frame, _) = walk_tb(error.__traceback__)
    file = Path(frame.f_code.co_filename)
    return any(file.is_relative_to(_PACKAGE / room) for room in ("engine", "physics")) or "pymunk" in file.parts
