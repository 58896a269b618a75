"""A run that failed by what a scene handed to the engine: said in a line that names it."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox.errors import RunError, no_exit

_ROOMS = Path(__file__).resolve().parent.parent

if TYPE_CHECKING:
    from sandbox.engine.setup import Setup


@contextmanager
def blamed(setup: Setup) -> Iterator[None]:
    """Around a run of the setup: a TypeError because one of its functions cannot be called as the engine calls it is a
    RunError that names the function, and ``sys.exit`` in one of them a failure. So are numbers that a float, or
    pymunk, cannot hold: they come from masses, lengths or speeds of absurd sizes."""
    try:
        with no_exit():
            yield
    except TypeError as error:
        for what, function, arguments in _functions(setup):
            mistake = _cannot_be_called(function, arguments)
            if mistake is not None:
                raise RunError(f"{what} is called as {what}({', '.join(arguments)}): {mistake}") from error
        raise
    except (ArithmeticError, AssertionError) as error:
        if not _is_ours(error):
            raise
        said = str(error.args[-1] if error.args else error).partition(". ")[0]
        raise RunError(
            f"masses, lengths, speeds or forces are too large or too small to compute with at t = 0 s or later: {said}"
        ) from error


def _is_ours(error: BaseException) -> bool:
    """Whether it was raised by the engine, the laws of physics or pymunk, not by a scene's own code."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    file = Path(trace.tb_frame.f_code.co_filename) if trace is not None else Path()
    return file.is_relative_to(_ROOMS / "engine") or file.is_relative_to(_ROOMS / "physics") or "pymunk" in file.parts


def _functions(setup: Setup) -> Iterator[tuple[str, Callable[..., Any], tuple[str, ...]]]:
    """The functions of a setup by their names, with what they are called with."""
    if callable(setup.until):
        yield "until", setup.until, ("event",)
    for one, other, law in setup.pairs:
        yield f"the law of {one} and {other}", law, ("normal_speed", "slip_speed")
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
