"""The user's part of a traceback."""

from __future__ import annotations

from pathlib import Path
from types import CodeType

from sandbox import resources
from sandbox.errors import SandboxError
from sandbox.text import one_line, printable, shortened

#: Most characters of an error's own text, which a scene may have made of anything.
_LONGEST = 500


def of_user_code(error: BaseException) -> str | None:
    """The traceback from the first frame of the user's code, without the sandbox's own frames; None without any."""
    import traceback  # here, as others below: no start of the program needs it

    if isinstance(error, RuntimeError) and isinstance(error.__cause__, StopIteration):
        error = error.__cause__  # raised in a generator of the sandbox's, which Python reports instead
    frames = traceback.extract_tb(error.__traceback__)
    first = next((index for index, frame in enumerate(frames) if not is_ours(frame.filename)), None)
    is_users_syntax = isinstance(error, SyntaxError) and error.filename is not None and not is_ours(error.filename)
    if first is None and not is_users_syntax:
        return None
    own = [frame for frame in frames[first:] if not is_hidden(frame.filename)] if first is not None else []
    head = ["your scene failed\n", "Traceback (most recent call last):\n"] if own else ["your scene failed\n"]
    last = [_short(line) for line in traceback.format_exception_only(error)]
    return "".join([*head, *traceback.format_list(own), *last])


def one_line_error(error: BaseException) -> str:
    """The error on one line, for a table cell; for a user's code with file and line: ``"ZeroDivisionError: division by
    zero (volleyball/scene.py, line 12)"``."""
    import traceback

    text = shortened(one_line(" ".join(str(error).split())), _LONGEST)
    if isinstance(error, SandboxError):
        return text
    own = [frame for frame in traceback.extract_tb(error.__traceback__) if not is_ours(frame.filename)]
    place = f" ({_place(own[-1].filename)}, line {own[-1].lineno})" if own else ""
    return f"{type(error).__name__}{': ' if text else ''}{text}{place}"


def defined_at(function: object) -> str:
    """The place of a user's function, as the end of a message: ``" (hall/scene.py, line 12)"``; "" for others."""
    code = code_of(function)
    return "" if code is None else f" ({_place(code.co_filename)}, line {code.co_firstlineno})"


def code_of(function: object) -> CodeType | None:
    """The code of a function, or of the ``__call__`` of an object, that is the user's; None for others."""
    function = getattr(function, "func", function)  # of a partial
    called = function if hasattr(function, "__code__") else getattr(type(function), "__call__", None)  # noqa: B004
    code = getattr(called, "__code__", None)
    return code if isinstance(code, CodeType) and not is_ours(code.co_filename) else None


def _place(filename: str) -> str:
    return "/".join(Path(filename).parts[-2:])


def _short(line: str) -> str:
    """A line of an error's text, without control characters and not longer than LONGEST."""
    return shortened(printable(line.rstrip()), _LONGEST) + "\n"


def is_ours(filename: str) -> bool:
    """True if a file came with the sandbox, Python or an installed package, in this environment or another."""
    return filename.startswith("<") or _is_sandbox(filename) or is_of_library(filename)


def is_of_library(filename: str | Path) -> bool:
    """True if a file came with Python or an installed package, in this environment or another."""
    import sysconfig

    if not {"site-packages", "dist-packages"}.isdisjoint(Path(filename).parts):
        return True
    return any(_inside(filename, sysconfig.get_path(name)) for name in ("stdlib", "purelib", "platlib"))


def is_hidden(filename: str) -> bool:
    """True if a file is the sandbox's, generated code, or pydantic's, which validates a scene's parameters."""
    import pydantic

    return filename.startswith("<") or _is_sandbox(filename) or _inside(filename, Path(pydantic.__file__).parent)


def _is_sandbox(filename: str) -> bool:
    return _inside(filename, resources.PACKAGE) or _inside(filename, resources.folder("scenes"))


def _inside(filename: str | Path, folder: str | Path) -> bool:
    return Path(filename).resolve().is_relative_to(Path(folder).resolve())
