"""Arguments that several commands share: a scene, changes to it, whole numbers; read and checked."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

import typer

from sandbox.errors import RequestError

if TYPE_CHECKING:
    from sandbox.scene import Scene

SceneArgument = Annotated[
    str,
    typer.Argument(
        metavar="SCENE", help="A scene (golf), a preset (golf/driver) or a scene file of your own.", show_default=False
    ),
]
OptionalScene = Annotated[
    str | None,
    typer.Argument(metavar="[SCENE]", help="A scene, preset or scene file; all scenes if none.", show_default=False),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help='Change a parameter; repeatable. A value may have a unit: "171 mph".'
    ),
]
JsonList = Annotated[bool, typer.Option("--json", help="Print one JSON list in place of the tables.")]
LEVELS = ("fast", "balanced", "precise")
Level = Annotated[
    str | None,
    typer.Option(
        "--accuracy",
        metavar="|".join(LEVELS),
        help="Speed against accuracy, in place of the scene file's accuracy.level.",
        show_default=False,
    ),
]


def whole_number(option: str, low: int, high: float = float("inf"), unit: str = "") -> Callable[[str], int]:
    """A parser for the whole number of an option; its bounds are in ``unit``."""
    bounds = f"of {low} or more" if high == float("inf") else f"from {low} to {high}"

    def read(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            number = low - 1
        if not low <= number <= high:
            raise RequestError(f"{option} {text}: must be a whole number {bounds} {unit}".rstrip())
        return number

    return read


def load(source: str, settings: list[str] | None, accuracy: str | None) -> Scene:
    """The scene with ``--set`` and ``--accuracy`` applied."""
    from sandbox import scene

    return scene.load(source, changes(settings, accuracy), overrides_from="--set")


def changes(settings: list[str] | None, accuracy: str | None) -> dict[str, Any]:
    """``--set`` and ``--accuracy`` as values by dotted key."""
    from sandbox.parameters import parse_assignment

    changed = dict(parse_assignment(text) for text in settings or [])
    if accuracy is not None:
        if accuracy not in LEVELS:
            raise RequestError(f"--accuracy {accuracy}: must be {', '.join(LEVELS[:-1])} or {LEVELS[-1]}")
        changed["accuracy.level"] = accuracy
    return changed


def loaded(source: str | None, settings: list[str] | None, accuracy: str | None) -> list[Scene]:
    """One scene, or all that come with the sandbox."""
    from sandbox.scene import listings

    sources = [source] if source is not None else [found.name for found in listings() if "/" not in found.name]
    return [load(name, settings, accuracy) for name in sources]
