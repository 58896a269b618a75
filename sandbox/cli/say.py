"""Printing on stdout."""

from __future__ import annotations

import sys

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
