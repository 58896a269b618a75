"""The games that are played in a scene: the modules in its folder ``games``, each with the rules of one."""

from __future__ import annotations

from pathlib import Path

from sandbox.errors import RequestError
from sandbox.files import from_here
from sandbox.scene.modules import module_in
from sandbox.tasks.match import Match

FOLDER = "games"


def game_names(folder: Path) -> list[str]:
    """The names of the games of the scene in a folder, such as ``eight-ball``; nothing is imported."""
    return sorted(file.stem.replace("_", "-") for file in (folder / FOLDER).glob("[a-z]*.py") if file.is_file())


def game_of(folder: Path, name: str) -> type[Match]:
    """The rules of a game, by its name. Raises RequestError for a module without a ``GAME``."""
    module = module_in(folder, f"{FOLDER}.{name.replace('-', '_')}")
    game = getattr(module, "GAME", None)
    if not (isinstance(game, type) and issubclass(game, Match)):
        file = from_here(folder / FOLDER / f"{name.replace('-', '_')}.py")
        raise RequestError(f"{file}: GAME must be a Match of sandbox.tasks.match")
    return game
