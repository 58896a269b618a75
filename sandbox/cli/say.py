"""What the program prints on stdout, and JSON of what it found."""

from __future__ import annotations

import sys
from typing import Any

import typer

from sandbox.errors import RunError
from sandbox.text import printable


def say(text: str) -> None:
    """Print on stdout, at once. The reader of a pipe may go when it likes; a full disk is reported."""
    if sys.stdout is None:
        raise RunError("stdout cannot be written: it is closed")
    try:
        typer.echo(printable(text))
        sys.stdout.flush()
    except BrokenPipeError:
        raise typer.Exit(1) from None
    except OSError as error:
        from sandbox.files import reason

        raise RunError(f"stdout cannot be written: {reason(error)}") from None


def json_text(value: Any) -> str:
    """JSON of plain values; what is not finite is null."""
    import json

    from sandbox.files import plain

    return json.dumps(plain(value), allow_nan=False, ensure_ascii=False)
