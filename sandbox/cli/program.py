"""The program: its commands, their errors and exit codes."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from io import TextIOWrapper
from itertools import pairwise

import click

from sandbox import __version__, entries
from sandbox.cli.interrupts import is_interrupt
from sandbox.errors import SandboxError, Stopped
from sandbox.text import one_line, printable

#: The option of every command that ignores the compiled kernel, by setting this in the environment.
_NO_COMPILED, IGNORED = "--no-compiled", "SANDBOX_NO_COMPILED"

#: The core's commands by module, which is imported when one of them is needed.
COMMANDS = {
    "scenes": ("list", "schema", "new"),
    "run": ("run",),
    "lab": ("aim", "coefficients", "sweep", "trade", "stress"),
    "validate": ("validate",),
    "compiling": ("compile",),
}


@cache
def modules() -> dict[str, str]:
    """The module of each command, of the core and of the entries."""
    core = {name: f"sandbox.cli.{module}" for module, names in COMMANDS.items() for name in names}
    return {**core, **entries.added("COMMANDS")}


class Commands(click.Group):
    """The commands of those modules."""

    def list_commands(self, context: click.Context) -> list[str]:
        return sorted(modules())

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        every = vars(import_module(modules()[name])).values() if name in modules() else ()
        return next((each for each in every if isinstance(each, click.Command) and each.name == name), None)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(__version__, message="sandbox %(version)s")
@click.option(_NO_COMPILED, is_flag=True, help="Do without what sandbox compile has built; with any command.")
def app(no_compiled: bool) -> None:
    """A 2D sports sandbox: pick a sport, let go, and see real physics.

    \b
    Begin with:
      sandbox list                                  # all scenes and presets
      sandbox run golf                              # one shot, and its numbers
      sandbox run golf --set launch.speed="150 mph" --poster golf.png
    """
    if no_compiled:
        os.environ[IGNORED] = "1"  # for the processes that compute, too


def call(args: Sequence[str] | None) -> int:
    """Run one command; an error becomes a line on stderr and an exit code. Ctrl-C is a KeyboardInterrupt."""
    from sandbox.files import inputs_are_kept

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without "±" shows "?"
    given = list(sys.argv[1:] if args is None else args) or ["--help"]
    if _NO_COMPILED in given:  # wherever it stands
        given = [_NO_COMPILED, *(each for each in given if each != _NO_COMPILED)]
    try:
        with inputs_are_kept(), app.make_context("sandbox", [*given]) as context:
            app.invoke(context)
        return 0
    except click.exceptions.Exit as done:  # after --help
        return done.exit_code
    except click.ClickException as error:  # unknown command, missing argument, bad option
        hint = _unquoted(given, error.format_message()) or f"{_command_of(error, given)} --help shows its arguments"
        return _fail(f"{error.format_message()}\n{hint}", error.exit_code)
    except Stopped as error:
        click.echo(printable(str(error)), err=True)
        return error.exit_code
    except SandboxError as error:
        return _fail(str(error), error.exit_code)
    except BaseException as error:  # a scene's own picture may raise a SystemExit
        from sandbox.tracebacks import of_user_code

        if is_interrupt(error) and (before := _stopped_before(error)) is not None:
            click.echo(printable(str(before)), err=True)
            return before.exit_code
        text = None if is_interrupt(error) else of_user_code(error)
        if text is not None:
            return _fail(text, 1)
        if isinstance(error, BrokenPipeError):  # nobody reads what is printed
            return 1
        text = _of_the_machine(error)
        if text is None:
            raise
        return _fail(text, 1)


def _stopped_before(error: BaseException) -> Stopped | None:
    """Return what a first Ctrl-C has stopped, if a second one interrupts the work that was left then; else None."""
    found: BaseException | None = error
    while found is not None and not isinstance(found, Stopped):
        found = found.__context__
    return found


def _of_the_machine(error: BaseException) -> str | None:
    """Return what the machine lacks, if that is why a command failed: memory, room on a disk, open files; else None."""
    first = error
    while first.__cause__ or first.__context__:
        first = first.__cause__ or first.__context__ or first
    if isinstance(first, MemoryError) or str(first) == "Out of memory":  # Python's, and pygame's
        return "there is not enough memory"
    if isinstance(error, OSError):
        from sandbox.files import reason

        return f"{error.filename or 'stdout'}: {reason(error)}"
    if isinstance(error, ImportError) and ".so" in str(first):
        return f"a library cannot be loaded: {one_line(str(first))}"
    return None


def _unquoted(args: list[str], message: str) -> str:
    """A hint for a unit that is separated from its number, as in ``--set launch.speed=150 mph``, or ""."""
    from sandbox.units import suggestion

    for value, unit in pairwise(args):
        if "=" in value and value[-1].isdigit() and unit in message and suggestion(unit):
            key, _, number = value.partition("=")
            return f'a value with a space goes in quotes: {key}="{number} {suggestion(unit)}"'
    return ""


def _command_of(error: click.ClickException, args: list[str]) -> str:
    """The program or the command that had the wrong arguments."""
    context = getattr(error, "ctx", None)
    if context is not None:
        return str(context.command_path)
    first = args[0]  # an error about a missing value has no context
    return "sandbox" if first.startswith("-") else f"sandbox {first}"


def _fail(message: str, code: int) -> int:
    click.echo(printable(f"error: {message}".rstrip()), err=True)
    return code
