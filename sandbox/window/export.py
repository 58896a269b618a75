"""Files that the window writes: a screenshot, an animation of a shot, a scene file with the changes."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from sandbox.errors import RunError
from sandbox.files import atomic_write, forbidden, reason, writing
from sandbox.picture.frames import save_gif
from sandbox.scene import reference
from sandbox.window.session import Session
from sandbox.window.shots import Shot

FOLDER = Path("out")
FPS = 25
_GIF_SIZE = (640, 360)  # px


def new_file(stem: str, suffix: str, write: Callable[[Path], object]) -> Path:
    """The first file in the folder of outputs whose name is not taken, with what ``write`` writes; the folder is
    made."""
    try:
        FOLDER.mkdir(exist_ok=True)
    except OSError as error:
        raise RunError(f"{FOLDER}: cannot be made: {reason(error)}") from None
    stem = "".join("-" if forbidden(letter) or letter == "/" else letter for letter in stem.replace(".toml", ""))
    number = 1
    while (path := FOLDER / f"{stem}-{number}{suffix}").exists():
        number += 1
    with writing("", path):
        write(path)
    return path


def animate(shot: Shot, path: Path) -> None:
    """Write a shot as an animated GIF."""
    save_gif(shot.scene.picture(shot.run, _GIF_SIZE), shot.run, path, FPS)


def scene_file(session: Session) -> Path:
    """A new scene file: a copy of the scene's, with its comments, and the changes."""
    import tomlkit

    try:
        text = session.file.read_text("utf-8-sig") if session.file is not None else ""
    except OSError as error:
        raise RunError(f"{session.file}: cannot be read: {reason(error)}") from None
    if not re.search(r"(?m)^\s*scene\s*=", text):  # a preset, whose folder is that of its scene
        text = f'scene = ""\n\n{text}'
    document = tomlkit.parse(text)
    document["scene"] = _named(session, str(document["scene"]))
    if "measured" in document and session.file is not None:  # its points stay where they are
        track = session.file.parent / str(document["measured"]["track"])
        _put(document, ["measured", "track"], Path(os.path.relpath(track, FOLDER)).as_posix())
    for key, value in session.changes.values.items():
        _put(document, key.split("."), value)

    def write(path: Path) -> None:
        with atomic_write(path) as file:
            file.write(tomlkit.dumps(document))

    return new_file(session.title, ".toml", write)


def _named(session: Session, written: str) -> str:
    """The name of its scene in a new scene file; it keeps the preset that the session's own file begins from."""
    scene = session.base
    own = reference(scene.folder, FOLDER)
    begins_from = written.rpartition("/")[2]
    names_a_preset = begins_from != written and (scene.folder / "presets" / f"{begins_from}.toml").is_file()
    return f"{own}/{begins_from}" if names_a_preset else own


def _put(table: Any, path: list[str], value: Any) -> None:
    """Set a dotted key; a comment on its line stays there."""
    import tomlkit

    *groups, last = path
    for name in groups:
        if not isinstance(table.get(name), Mapping):
            table[name] = tomlkit.table()
        table = table[name]
    if value is None:
        table.pop(last, None)
        return
    item = tomlkit.item(list(value) if isinstance(value, tuple) else value)
    old = table.get(last)
    if old is not None and hasattr(old, "trivia"):
        item.trivia.comment_ws, item.trivia.comment = old.trivia.comment_ws, old.trivia.comment
        item.trivia.trail = old.trivia.trail
    table[last] = item
