"""A new scene for the user to edit: a copy of the template for its view, renamed."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import shutil
from pathlib import Path

from sandbox import resources
from sandbox.errors import RequestError, RunError
from sandbox.files import check_writable, folder_of_parts, reason
from sandbox.scene import listings, load, parameters_of, simulate
from sandbox.schema import json_schema

#: The folder of each template, which is also the name of its scene, in file names and in the files.
FROM_SIDE, FROM_ABOVE = "template", "template_above"


def new_scene(folder: Path, template: str = FROM_SIDE) -> list[Path]:
    """Write a working scene into ``folder``, which must not exist yet; returns its files.

    Raises RequestError for an invalid name, RunError if the folder cannot be written. Writes all files or none.
    """
    name = folder.name
    _check(folder, name)
    try:
        with folder_of_parts(folder.parent, name) as part:
            scene, source = part / name, resources.folder(template)
            for file in (*source.glob("*.py"), *source.rglob("*.toml")):
                _copy(file, scene / file.relative_to(source).parent, template, name)
            schema = json_schema(parameters_of(scene)[1], name)
            (scene / f"{name}.schema.json").write_text(json.dumps(schema, indent=2) + "\n", encoding="utf-8")
            _make_golden(scene, name)
            shutil.rmtree(scene / "__pycache__", ignore_errors=True)
            scene.rename(folder)
    except OSError as error:
        raise RunError(f"{folder}: cannot be written: {reason(error)}") from None
    return sorted(file for file in folder.rglob("*") if file.is_file())


def _make_golden(scene: Path, name: str) -> None:
    """Write the golden files with which the scene's test passes at once."""
    from sandbox import record
    from sandbox.picture.difference import SIZE, as_png, coarser
    from sandbox.picture.frames import to_image

    loaded = load(scene)
    run = simulate(loaded)
    picture = coarser(to_image(loaded.picture(run, SIZE).poster()))
    (scene / "golden").mkdir()
    (scene / "golden" / f"{name}.png").write_bytes(as_png(picture))
    (scene / "golden" / f"{name}.json").write_text(record.as_text(record.record(run)), encoding="utf-8")


def next_steps(folder: Path) -> list[str]:
    """Return what to try with the new scene, one line each."""
    shown = folder if folder.is_absolute() or folder.parts[0] == ".." else f"./{folder}"
    installed = importlib.util.find_spec("pytest") is not None
    return [
        "now try:",
        f"  sandbox run {shown} --poster {folder.name}.png",
        f"  sandbox play {shown}    # the window: shows what you save at once",
        *([] if installed else ["  python -m pip install pytest    # for the next line"]),
        f"  pytest {folder}    # compares it with its golden picture; after a change: pytest {folder} --golden-update",
    ]


def _check(folder: Path, name: str) -> None:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]{0,63}", name):
        raise RequestError(f'new {folder}: a scene\'s name has letters, digits, "-" and "_", and begins with a letter')
    if name == "sandbox":
        raise RequestError(
            f"new {folder}: Python would import that folder in place of the sandbox; choose another name"
        )
    if name in {listing.name for listing in listings()}:
        raise RequestError(f"new {folder}: a scene named {name} already exists; choose another name")
    if os.path.lexists(folder):
        raise RequestError(f"new {folder}: already exists; choose another name, or remove it first")
    check_writable(f"new {folder}", folder.parent)


def _copy(file: Path, folder: Path, template: str, name: str) -> None:
    """Copy a file as ``<name>.toml`` for ``template.toml``, with the name in it; a test's must be importable."""
    own = name.replace("-", "_") if file.suffix == ".py" else name
    folder.mkdir(parents=True, exist_ok=True)
    text = re.sub(rf"\b{template}\b", name, file.read_text(encoding="utf-8"))
    (folder / file.name.replace(template, own)).write_text(text, encoding="utf-8")
