"""A run that failed by what a scene handed to the engine: said in a line that names it."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from sandbox.errors import RunError, no_exit

if TYPE_CHECKING:
    from sandbox.engine.setup import Setup


@contextmanager
def blamed(setup: Setup) -> Iterator[None]:
    """Around a run of the setup: a TypeError because one of its functions cannot be called as the engine calls it is a
    RunError that names the function, and ``sys.exit`` in one of them a failure."""
    try:
        with no_exit():
            yield
    except TypeError as error:
        for what, function, arguments in _functions(setup):
            mistake = _cannot_be_called(function, arguments)
            if mistake is not None:
                raise RunError(f"{what} is called as {what}({', '.join(arguments)}): {mistake}") from error
        raise


def _functions(setup: Setup) -> Iterator[tuple[str, Callable[..., Any], tuple[str, ...]]]:
    """The functions of a setup by their names, with what they are called with."""
    if setup.until is not None:
        yield "until", setup.until, ("event",)
    yield "between_balls", setup.between_balls, ("normal_speed", "slip_speed")
    for surface in setup.surfaces:
        if surface.law is not None:
            yield "law", surface.law, ("normal_speed", "tangential_speed")


def _cannot_be_called(function: Callable[..., Any], arguments: tuple[str, ...]) -> str | None:
    """Why a function does not take so many arguments; None where it does, or Python does not know."""
    try:
        inspect.signature(function).bind(*arguments)
    except TypeError as error:
        return str(error)
    except ValueError:  # a builtin without a signature
        return None
    return None
