"""The program: its commands, their errors and exit codes."""

from __future__ import annotations

import sys
from io import TextIOWrapper
from itertools import pairwise
from typing import Annotated

import typer

import sandbox
from sandbox.cli import lab, run, scenes
from sandbox.cli.say import say
from sandbox.errors import SandboxError, Stopped
from sandbox.text import printable

app = typer.Typer(
    name="sandbox",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        say(f"sandbox {sandbox.__version__}")
        raise typer.Exit


@app.callback()
def _program(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """A 2D sports sandbox: pick a sport, let go, and see real physics.

    \b
    Begin with:
      sandbox list                                  # all scenes and presets
      sandbox run golf                              # one shot, and its numbers
      sandbox run golf --set launch.speed="150 mph" --poster golf.png
    """


app.command("list")(scenes.list_scenes)
app.command("schema")(scenes.schema)
app.command("new")(scenes.new_scene)
app.command("run")(run.run)
app.command("play")(scenes.play)
app.command("aim")(lab.aim)
app.command("sweep")(lab.sweep)
app.command("trade")(lab.trade)
app.command("stress")(lab.stress)
app.command("validate")(lab.validate)


def call(args: list[str] | None) -> int:
    """Run one command; an error becomes a line on stderr and an exit code. Ctrl-C is a KeyboardInterrupt."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without "±" shows "?"
    try:
        given = sys.argv[1:] if args is None else args
        code: int = app(given or ["--help"], prog_name="sandbox", standalone_mode=False) or 0
        if code == Stopped.exit_code:  # what typer makes of a KeyboardInterrupt
            raise KeyboardInterrupt
        return code
    except typer.TyperException as error:  # unknown command, missing argument, bad option
        hint = _unquoted(given, error.format_message()) or f"{_command_of(error, given)} --help shows its arguments"
        return _fail(f"{error.format_message()}\n{hint}", error.exit_code)
    except Stopped as error:
        typer.echo(printable(str(error)), err=True)
        return error.exit_code
    except SandboxError as error:
        return _fail(str(error), error.exit_code)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a scene's own picture may raise a SystemExit
        from sandbox.tracebacks import of_user_code

        text = of_user_code(error)
        if text is None:
            raise
        return _fail(text, 1)


def _unquoted(args: list[str], message: str) -> str:
    """A hint for a unit that is separated from its number, as in ``--set launch.speed=150 mph``, or ""."""
    from sandbox.units import suggestion

    for value, unit in pairwise(args):
        if "=" in value and value[-1].isdigit() and unit in message and suggestion(unit):
            key, _, number = value.partition("=")
            return f'a value with a space goes in quotes: {key}="{number} {suggestion(unit)}"'
    return ""


def _command_of(error: typer.TyperException, args: list[str]) -> str:
    """The program or the command that had the wrong arguments."""
    context = getattr(error, "ctx", None)
    if context is not None:
        return str(context.command_path)
    first = args[0]  # an error about a missing value has no context
    return "sandbox" if first.startswith("-") else f"sandbox {first}"


def _fail(message: str, code: int) -> int:
    typer.echo(printable(f"error: {message}".rstrip()), err=True)
    return code
