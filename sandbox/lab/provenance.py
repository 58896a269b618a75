"""All that the rows of a sweep depend on apart from its plan: the program's code, the scene's files, versions, the
platform.

Rows from different days or machines are combined only if all of these are the same.
"""

from __future__ import annotations

import ast
import hashlib
import os
import platform
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from itertools import accumulate
from pathlib import Path

from sandbox import resources
from sandbox.files import is_our_table
from sandbox.scene import Scene
from sandbox.tracebacks import is_of_library

#: Files that the program writes; one of these kinds that a scene reads is not noticed.
_OUTPUTS = (".png", ".gif", ".webp", ".replay.json", ".resume", ".part", "~")

#: Folders and files that no run depends on.
_IGNORED = {"__pycache__", "golden", "out", "published", "shots.toml", "tasks"}

_LIBRARIES = ("numpy", "pymunk")


@dataclass(frozen=True)
class Provenance:
    """Digests and versions by name, and the location of the files."""

    folder: Path  # of the scene
    user_modules: tuple[Path, ...]  # user modules that the scene imports from elsewhere
    parts: dict[str, str]

    def differences(self) -> list[str]:
        """The parts that differ in this process, which may be on another machine. A file counts as it was when this
        process first compared it, since a module is loaded only once."""
        here = _parts(self.folder, self.user_modules, _first_content)
        return [
            f"{name} {here[name]} instead of {part}" if name in (*_LIBRARIES, "Python", "platform") else name
            for name, part in self.parts.items()
            if here[name] != part
        ]


def provenance(scene: Scene) -> Provenance:
    """The provenance of a scene loaded in this process."""
    folder = scene.folder.resolve()
    user_modules = tuple(sorted(_user_modules(folder)))
    return Provenance(folder, user_modules, _parts(folder, user_modules, _content))


def _parts(folder: Path, user_modules: Iterable[Path], content: Callable[[Path], str]) -> dict[str, str]:
    return {
        "the sandbox": _digest(resources.PACKAGE, resources.PACKAGE.rglob("*.py"), content),
        "the scene": _digest(folder, [*_files(folder), *user_modules], content),
        **{name: version(name) for name in _LIBRARIES},
        "Python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
    }


def _digest(root: Path, files: Iterable[Path], content: Callable[[Path], str]) -> str:
    """A digest of the names and contents of files."""
    inside = f"{root}{os.sep}"
    names = ((str(file).removeprefix(inside).replace(os.sep, "/"), file) for file in sorted(files))
    lines = (f"{name}\0{content(file)}\0" for name, file in names)
    return hashlib.sha256("".join(lines).encode(errors="surrogateescape")).hexdigest()


def _content(file: Path) -> str:
    """The digest of a file; of one that is missing or unreadable, why."""
    try:
        return hashlib.sha256(file.read_bytes()).hexdigest()
    except OSError as error:
        return type(error).__name__


_first_content = cache(_content)


def _files(folder: Path) -> Iterator[Path]:
    """All files of a scene except its outputs, golden files, caches and hidden files."""
    seen = set()  # links may lead back
    for place, folders, names in os.walk(folder, followlinks=True):
        seen.add(os.path.realpath(place))
        folders[:] = [
            name
            for name in folders
            if not name.startswith(".") and name not in _IGNORED and os.path.realpath(f"{place}/{name}") not in seen
        ]
        kept = (name for name in names if not name.startswith(".") and not name.endswith(_OUTPUTS))
        for file in (Path(place, name) for name in kept if name not in _IGNORED):
            if file.is_file() and not is_our_table(file):
                yield file


def _user_modules(folder: Path) -> set[Path]:
    """The user's modules that the sources of a folder import, and theirs in turn, if they are
    loaded or next to the folder."""
    found: set[Path] = set()
    seen: set[tuple[str, Path | None]] = set()
    waiting = list(folder.rglob("*.py"))
    while waiting:
        new = {*_imported(waiting.pop())} - seen
        seen |= new
        for name, above in new:
            file = _module_file(folder, name) if above is None else _source(above, name)
            if file is not None and file not in found and not file.is_relative_to(folder) and _is_users(file):
                found.add(file)
                waiting.append(file)
    return found


def _imported(source: Path) -> Iterator[tuple[str, Path | None]]:
    """Dotted names that a module may import; of a relative import also the folder that it begins from."""
    try:
        tree = ast.parse(source.read_bytes())
    except (SyntaxError, ValueError, OSError):
        return
    for node in _statements(tree):
        above = None
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module or ''}.{alias.name}".strip(".") for alias in node.names]
            above = source.parents[node.level - 1] if node.level else None
        else:
            continue
        for name in names:
            yield from ((package, above) for package in accumulate(name.split("."), "{}.{}".format))


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """The statements in a node, at any depth: a fraction of all nodes."""
    for field in ("body", "orelse", "handlers", "finalbody", "cases"):
        inside = getattr(node, field, ())
        for statement in inside if isinstance(inside, list) else ():
            yield statement
            yield from _statements(statement)


def _module_file(folder: Path, name: str) -> Path | None:
    file = getattr(sys.modules.get(name), "__file__", None)
    return Path(file).resolve() if file is not None else _source(folder.parent, name)


def _source(place: Path, name: str) -> Path | None:
    path = place.joinpath(*name.split("."))
    return next((file for file in (path.with_suffix(".py"), path / "__init__.py") if file.is_file()), None)


def _is_users(file: Path) -> bool:
    """True if a module belongs neither to the sandbox nor to Python or an installed package."""
    return file.suffix == ".py" and not file.is_relative_to(resources.PACKAGE) and not is_of_library(file)
