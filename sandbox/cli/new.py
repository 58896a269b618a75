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
from sandbox.files import check_name, check_writable, folder_of_parts, reason
from sandbox.scene import listings, load, parameters_of, simulate
from sandbox.scene.discovery import find
from sandbox.schema import json_schema

#: The folder of each template, which is also the name of its scene, in file names and in the files.
FROM_SIDE, FROM_ABOVE = "template", "template_above"


def new_scene(folder: Path, template: str = FROM_SIDE, copied: str | None = None) -> list[Path]:
    """Write a working scene into ``folder``, which must not exist yet; returns its files.

    It is made from a template, or is the scene that is ``copied``, by name or path. Raises RequestError for an invalid
    name, RunError if the folder cannot be written. Writes all files or none.
    """
    name = folder.name
    _check(folder, name)
    source = resources.folder(template) if copied is None else _to_copy(copied)
    try:
        with folder_of_parts(folder.parent, name) as part:
            scene = part / name
            for file in _files(source, has_tests=copied is None):
                _copy(file, scene / file.relative_to(source).parent, source.name, name)
            schema = json_schema(parameters_of(scene)[1], name)
            (scene / f"{name}.schema.json").write_text(
                json.dumps(schema, indent=2) + "\n", encoding="utf-8", newline="\n"
            )
            _make_golden(scene, name)
            shutil.rmtree(scene / "__pycache__", ignore_errors=True)
            scene.rename(folder)
    except OSError as error:
        raise RunError(f"{folder}: cannot be written: {reason(error)}") from None
    return sorted(file for file in folder.rglob("*") if file.is_file())


def _to_copy(source: str) -> Path:
    """The folder of a scene that was named. Raises RequestError."""
    found = find(source)
    if found.preset is not None or (found.files and found.files[-1][0].parent.resolve() != found.folder):
        raise RequestError(f"--from {source}: name a scene, such as {found.name}: its presets come with it")
    return found.folder


def _files(source: Path, has_tests: bool) -> list[Path]:
    """The files of a scene that make a new one: its code, numbers and data, without what is made from them."""
    made = (".schema.json", ".pyc", *(() if has_tests else ("tile.jpg", "tile.toml", "shots.toml")))
    files = [file for file in source.rglob("*") if file.is_file() and not file.name.endswith(made)]
    kept = [file for file in files if {"golden", "tasks"}.isdisjoint(file.relative_to(source).parts)]
    return [file for file in kept if has_tests or not file.name.startswith("test_")]


def _make_golden(scene: Path, name: str) -> None:
    """Write the golden files with which the scene's tests pass at once; its shots where it has none."""
    from sandbox import record
    from sandbox.picture.difference import SIZE, as_png, coarser
    from sandbox.picture.frames import to_image

    loaded = load(scene)
    run = simulate(loaded)
    diverges = record.diverges(run)
    until = None if diverges is None else float(f"{0.8 * diverges:.2g}")
    if not (scene / "shots.toml").exists():
        given = "" if until is None else f"until = {until}  # s; later, rounding decides\n"
        _write(scene / "shots.toml", f'# pytest checks these shots.\n\n[[shot]]\ngolden = "{name}"\n{given}')
    picture = loaded.picture(run, SIZE)
    image = coarser(to_image(picture.poster() if until is None else picture.frame(until)))
    (scene / "golden").mkdir()
    (scene / "golden" / f"{name}.png").write_bytes(as_png(image))
    (scene / "golden" / f"{name}.json").write_text(
        record.as_text(record.record(run, until)), encoding="utf-8", newline="\n"
    )


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
    check_name("new", folder)
    check_writable(f"new {folder}", folder.parent)


def _copy(file: Path, folder: Path, source: str, name: str) -> None:
    """Copy a file, in whose name and text the scene's own name becomes the new one: everywhere in a template, as in
    ``template.toml``, and where scene files name their scene and schema in a scene that is copied."""
    own = name.replace("-", "_") if file.suffix == ".py" else name  # a test's must be importable
    is_template = source in (FROM_SIDE, FROM_ABOVE)
    folder.mkdir(parents=True, exist_ok=True)
    if file.suffix not in (".py", ".toml"):
        shutil.copyfile(file, folder / file.name)
        return
    text = file.read_text(encoding="utf-8")
    if is_template:
        text = re.sub(rf"\b{source}\b", name, text)
    elif file.suffix == ".toml":
        named = rf'^(scene = "|#:schema (?:\./|\.\./)?){re.escape(source)}(?=["/.])'
        text = re.sub(named, rf"\g<1>{name}", text, flags=re.MULTILINE)
    named_after = is_template or file.name == f"{source}.toml"
    (folder / (file.name.replace(source, own) if named_after else file.name)).write_text(
        text, encoding="utf-8", newline="\n"
    )


def _write(file: Path, text: str) -> None:
    """Write a file with the same ends of lines on every system."""
    file.write_text(text, encoding="utf-8", newline="\n")
