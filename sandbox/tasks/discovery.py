"""Discovery of tasks: those in the folders of installed scenes, and files of one's own."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from sandbox.errors import RequestError
from sandbox.scene.discovery import installed_folder, installed_folders
from sandbox.tasks.file import looks_like_task, read_task_file
from sandbox.text import nearest, shortened
from sandbox.toml import read_toml


@lru_cache(maxsize=1)
def _files() -> dict[str, Path]:
    """The files of all installed tasks by name, scene by scene in rising order of difficulty."""
    found: dict[str, Path] = {}
    for _, folder in sorted(installed_folders().items()):
        files = [(read_task_file(file).level, file.stem, file) for file in (folder / "tasks").glob("*.toml")]
        found |= {name: file for _, name, file in sorted(files) if name not in found}
    return found


def tasks() -> list[str]:
    """The names of all installed tasks, scene by scene in rising order of difficulty."""
    return list(_files())


def _installed(name: str) -> Path | None:
    """The file of an installed task; None for any other name. No file is read."""
    if Path(name).name != name:
        return None
    files = (folder / "tasks" / f"{name}.toml" for _, folder in sorted(installed_folders().items()))
    return next((file for file in files if file.is_file()), None)


def find_task(source: str | Path) -> Path:
    """The file of the task with that name, or at that path. Raises RequestError."""
    known = _installed(source) if isinstance(source, str) else None
    if known is not None:
        return known
    path = Path(source)
    if path.suffix == ".toml" or path.is_file():
        return path
    near = nearest(str(source), tasks())
    hint = f"did you mean {near}?" if near else "sandbox tasks lists them all"
    raise RequestError(f"unknown task {shortened(str(source))}; {hint}")


def is_task(source: str | Path) -> bool:
    """True if a name or file is that of a task and not of a scene."""
    if isinstance(source, str) and "/" not in source and not source.endswith(".toml"):
        return installed_folder(source) is None and _installed(source) is not None
    path = Path(source)
    try:
        return path.suffix == ".toml" and path.is_file() and looks_like_task(read_toml(path))
    except (OSError, RequestError):
        return False
