"""Errors caused by what a scene passed to the engine, as one line that names the cause."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox.errors import RunError, no_exit

_PACKAGE = Path(__file__).resolve().parent.parent

if TYPE_CHECKING:
    from sandbox.engine.setup import Setup


@contextmanager
def setup_errors_named(setup: Setup) -> Iterator[None]:
    """Context of a run of the setup. A TypeError from a function of the setup with the wrong arguments becomes a
    RunError that names the function, and ``sys.exit`` in one becomes a failure. Overflow in Python or pymunk, caused
    by absurd masses, lengths or speeds, becomes a RunError too."""
    try:
        with no_exit():
            yield
    except TypeError as error:
        for what, function, arguments in _functions(setup):
            mistake = _mismatch(function, arguments)
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
    """Whether it was raised by the engine, sandbox.physics or pymunk, and not by a scene's own code."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    file = Path(trace.tb_frame.f_code.co_filename) if trace is not None else Path()
    return (
        file.is_relative_to(_PACKAGE / "engine") or file.is_relative_to(_PACKAGE / "physics") or "pymunk" in file.parts
    )


def _functions(setup: Setup) -> Iterator[tuple[str, Callable[..., Any], tuple[str, ...]]]:
    """The functions of a setup: name, function and the names of its arguments."""
    if callable(setup.until):
        yield "until", setup.until, ("event",)
    for one, other, law in setup.pairs:
        yield f"the law of {one} and {other}", law, ("normal_speed", "slip_speed")
    yield "between_balls", setup.between_balls, ("normal_speed", "slip_speed")
    for surface in setup.surfaces:
        if surface.law is not None:
            yield "law", surface.law, ("normal_speed", "tangential_speed")


def _mismatch(function: Callable[..., Any], arguments: tuple[str, ...]) -> str | None:
    """Why a function cannot take these arguments; None if it can, or if Python cannot tell."""
    try:
        inspect.signature(function).bind(*arguments)
    except TypeError as error:
        return str(error)
    except ValueError:  # a builtin without a signature
        return None
    return None
