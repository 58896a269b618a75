"""Printing on stdout, and JSON text."""

from __future__ import annotations

import sys
from typing import Any

import click

from sandbox.errors import RunError
from sandbox.text import printable


def say(text: str) -> None:
    """Print on stdout, at once. A full disk is reported."""
    if sys.stdout is None:
        raise RunError("stdout cannot be written: it is closed")
    try:
        click.echo(printable(text))
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        from sandbox.files import reason

        raise RunError(f"stdout cannot be written: {reason(error)}") from None


def json_text(value: Any) -> str:
    """JSON of numbers, words and lists; NaN and infinities are null."""
    import json

    from sandbox.files import json_ready

    return json.dumps(json_ready(value), allow_nan=False, ensure_ascii=False)
