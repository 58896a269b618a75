"""The sports of a first screen: scenes in the order of their tiles, each with its tasks and its games."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import inf
from pathlib import Path
from typing import NamedTuple

from sandbox.scene.discovery import installed_folders, listings_in
from sandbox.tasks.file import read_task_file
from sandbox.text import title_of
from sandbox.toml import read_toml

#: Pictures of sports, in their folders; their size in px.
TILE_FILE, TILE = "tile.jpg", (320, 180)


class Sport(NamedTuple):
    """A scene on a first screen."""

    name: str  # or the path of a user's own, such as ./beachvolley
    folder: Path
    files: Sequence[Path]  # of its tasks, in no order
    own: bool  # a user's, whose tasks are known by their paths

    @property
    def tasks(self) -> list[str]:
        """The names of its tasks, or the paths of a user's own."""
        return [str(file) if self.own else file.stem for file in self.files]

    @property
    def title(self) -> str:
        """Its name for people."""
        return title_of(self.folder.name)


def sports() -> list[Sport]:
    """All installed scenes, in the order of their tiles, and after them the user's own in this folder."""
    installed = sorted(installed_folders().items(), key=lambda item: (_place(item[1]), item[0]))
    own = [(item.name, Path(item.name).resolve()) for item in listings_in(Path()) if item.name.count("/") == 1]
    return [
        *(Sport(name, folder, _task_files(folder), own=False) for name, folder in installed),
        *(Sport(name, folder, _task_files(folder), own=True) for name, folder in own),
    ]


def easiest(sport: Sport) -> str:
    """The name or path of the easiest task of a sport that has tasks."""
    return min(zip(sport.tasks, sport.files, strict=True), key=lambda task: read_task_file(task[1]).level)[0]


def _task_files(folder: Path) -> list[Path]:
    return sorted((folder / "tasks").glob("*.toml"))


@cache
def _place(folder: Path) -> float:
    """The place of an installed scene's tile in ``tile.toml``; after all others without one."""
    file = folder / "tile.toml"
    place = read_toml(file).get("place") if file.is_file() else None
    return float(place) if isinstance(place, int | float) else inf
