"""Parts that several commands share: arguments for a scene and changes to it, and printing."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import redirect_stdout
from functools import wraps
from typing import TYPE_CHECKING, Any

import click

from sandbox.errors import RequestError, RunError
from sandbox.text import printable

if TYPE_CHECKING:
    from sandbox.scene import Scene

Command = Callable[..., None]
LEVELS = ("fast", "balanced", "precise")

#: Where a command's context keeps stdout while what a scene prints goes elsewhere.
_STDOUT = "sandbox.stdout"

scene_argument = click.argument(
    "scene", metavar="SCENE", help="A scene (golf), a preset (golf/driver) or a scene file of your own."
)
optional_scene = click.argument(
    "scene", metavar="[SCENE]", required=False, help="A scene, preset or scene file.  [default: all scenes]"
)


def prints_to_stderr(context: click.Context, parameter: object = None, wanted: bool = True) -> bool:
    """Keep stdout for what the command itself says: what a scene prints goes to stderr. Returns whether ``wanted``."""
    if wanted and _STDOUT not in context.meta:
        context.meta[_STDOUT] = sys.stdout
        context.with_resource(redirect_stdout(sys.stderr))
    return wanted


json_option = click.option(
    "--json", "as_json", is_flag=True, help="Print JSON instead of text.", callback=prints_to_stderr
)


def table_options(command: Command) -> Command:
    """``--map``, ``--where``, ``--without`` and ``--strict``, given to the command as ``choices``."""

    @click.option(
        "--map",
        "mapping",
        metavar='"KEY=EXPRESSION [UNIT]"',
        multiple=True,
        help='What a parameter or result is: "launch.speed=Ball Speed [mph]", "launch.spin=Spin*cos(radians(Axis))", '
        '"t=Zeit [ms]"; repeatable.  [default: known names]',
    )
    @click.option(
        "--where",
        metavar="COLUMN=TEXT",
        multiple=True,
        help='Only rows with this: "Club=Driver", "launch.angle=15:50", also with !=, <, <=, >, >=; repeatable.',
    )
    @click.option(
        "--without",
        metavar="KEY",
        multiple=True,
        help="Do not use this column of a known table: air.density; repeatable.",
    )
    @click.option("--strict", is_flag=True, help="Refuse a table with a bad row.  [default: leave it out, and say why]")
    @wraps(command)
    def chosen(
        *, mapping: tuple[str, ...], where: tuple[str, ...], without: tuple[str, ...], strict: bool, **arguments: Any
    ) -> None:
        from sandbox.lab.formats import parse_entry
        from sandbox.lab.mapped import Choices
        from sandbox.lab.where import parse_condition

        entries, conditions = tuple(map(parse_entry, mapping)), tuple(map(parse_condition, where))
        command(choices=Choices(entries, conditions, without, strict), **arguments)

    return chosen


def changes_options(command: Command) -> Command:
    """``--set`` and ``--accuracy``, given to the command as ``changes``: values by dotted key."""

    @click.option(
        "--set",
        "settings",
        metavar="KEY=VALUE",
        multiple=True,
        help='Change a parameter; repeatable. A value may have a unit: "171 mph".',
    )
    @click.option(
        "--accuracy",
        type=click.Choice(LEVELS),
        help="Accuracy level; overrides the scene file's.",
    )
    @wraps(command)
    def changed(*, settings: tuple[str, ...], accuracy: str | None, **arguments: Any) -> None:
        from sandbox.parameters import parse_assignment

        changes = dict(map(parse_assignment, settings))
        if accuracy is not None:
            changes["accuracy.level"] = accuracy
        command(changes=changes, **arguments)

    return changed


def units_option(command: Command) -> Command:
    """``--units``: inside the command, numbers for people are in these units."""

    @click.option(
        "--units",
        metavar="us|UNIT,...",
        help="Numbers on cards, pictures and pages in US units, or in these: ft,mph. JSON and CSV stay in SI.",
    )
    @wraps(command)
    def in_units(*, units: str | None, **arguments: Any) -> None:
        from sandbox.sport.amounts import shown_in

        with shown_in(units):
            command(**arguments)

    return in_units


def load(source: str, changes: dict[str, Any]) -> Scene:
    """The scene with ``--set`` and ``--accuracy`` applied."""
    from sandbox import scene

    return scene.load(source, changes, overrides_from="--set")


def pairs(option: str, texts: tuple[str, ...]) -> dict[str, str]:
    """Names and values, given as ``NAME=VALUE``. Raises RequestError."""
    found = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not name or not equals or not value:
            raise RequestError(f"{option} {text}: write it as NAME=VALUE")
        found[name] = value
    return found


def say(text: str) -> None:
    """Print on stdout, at once. A full disk is reported."""
    context = click.get_current_context(silent=True)
    out = sys.stdout if context is None else context.meta.get(_STDOUT, sys.stdout)
    if out is None:
        raise RunError("stdout cannot be written: it is closed")
    try:
        click.echo(printable(text), out)
        out.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        from sandbox.files import reason

        raise RunError(f"stdout cannot be written: {reason(error)}") from None
