"""A scene as a scene file: its preset or scene, and what differs from it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sandbox.parameters import walk
from sandbox.scene.discovery import as_path, is_installed, reference
from sandbox.scene.scene import Scene, load
from sandbox.scene.setup_scene import SetupScene
from sandbox.text import command_line


def source_of(scene: Scene) -> str:
    """The name by which a command line calls the scene, or the preset that it begins from."""
    if is_installed(scene.folder):
        return scene.title
    return f"{as_path(scene.folder)}/{scene.preset}" if scene.preset else as_path(scene.folder)


def differences(scene: Scene) -> dict[str, Any]:
    """The values by key in which a scene differs from the file of its preset or scene."""
    usual = {parameter.key: parameter.value for parameter in walk(load(source_of(scene)).parameters)}
    values = {parameter.key: parameter.value for parameter in walk(scene.parameters)}
    return {key: value for key, value in values.items() if value is not None and usual.get(key) != value}


def command(scene: Scene, does: str = "run", *options: str) -> str:
    """The command line that runs a scene with these parameters, or ``does`` something else with it; "" for a setup."""
    if isinstance(scene, SetupScene):
        return ""
    return command_line(source_of(scene), differences(scene), does, *options)


def scene_text(scene: Scene, folder: Path, about: str = "", track: str = "") -> str:
    """The text of a scene file in a folder; ``about`` is its first comment, ``track`` a file with measured points."""
    import tomlkit

    document = tomlkit.document()
    for line in about.splitlines():
        document.add(tomlkit.comment(line))
    own = reference(scene.folder, folder)
    document["scene"] = f"{own}/{scene.preset}" if scene.preset else own
    for key, value in differences(scene).items():
        _put(document, key.split("."), _plain(value))
    if track:
        _put(document, ["measured", "track"], track)
    return tomlkit.dumps(document)


def _put(table: Any, path: list[str], value: Any) -> None:
    import tomlkit

    *groups, last = path
    for name in groups:
        if name not in table:
            table[name] = tomlkit.table()
        table = table[name]
    table[last] = value


def _plain(value: Any) -> Any:
    """A value as TOML has it: groups of parameters as tables."""
    if hasattr(value, "model_dump"):
        return value.model_dump(mode="json", exclude_none=True)
    return [_plain(each) for each in value] if isinstance(value, list | tuple) else value
