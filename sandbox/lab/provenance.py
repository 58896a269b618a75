"""What the rows of a sweep depend on apart from its plan: the program's code, the scene's files, versions, the
platform.

Rows from different days or machines are combined only if all of these are the same.
"""

from __future__ import annotations

import ast
import hashlib
import platform
import sys
import sysconfig
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from sandbox import resources
from sandbox.lab.row_file import is_of_a_sweep
from sandbox.scene import Scene

#: Pictures and tables that the program writes; a file of these kinds that a scene reads is not noticed.
_OUTPUTS = {".png", ".gif", ".webp", ".parquet", ".resume", ".part"}

#: Folders that no run depends on.
_IGNORED = {"__pycache__", "golden", "out"}

_LIBRARIES = ("numpy", "pymunk")


@dataclass(frozen=True)
class Provenance:
    """Digests and versions by name, and the location of the files."""

    folder: Path  # of the scene
    user_modules: tuple[Path, ...]  # user modules that the scene imports from elsewhere
    parts: dict[str, str]

    def differences(self) -> list[str]:
        """The parts that differ in this process, which may be another process or machine."""
        here = _parts(self.folder, self.user_modules)
        return [
            f"{name} {here[name]} instead of {part}" if name in (*_LIBRARIES, "Python", "platform") else name
            for name, part in self.parts.items()
            if here[name] != part
        ]


def provenance(scene: Scene) -> Provenance:
    """The provenance of a scene loaded in this process."""
    folder = scene.folder.resolve()
    user_modules = tuple(sorted(_user_modules(folder)))
    return Provenance(folder, user_modules, _parts(folder, user_modules))


def _parts(folder: Path, user_modules: Iterable[Path]) -> dict[str, str]:
    return {
        "the sandbox": _digest(resources.PACKAGE, resources.PACKAGE.rglob("*.py")),
        "the scene": _digest(folder, [*_files(folder), *user_modules]),
        **{name: _version(name) for name in _LIBRARIES},
        "Python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
    }


def _version(library: str) -> str:
    try:
        return version(library)
    except PackageNotFoundError:
        return "unknown"


def _digest(root: Path, files: Iterable[Path]) -> str:
    """A digest of the names and contents of files; a missing file counts as missing."""
    total = hashlib.sha256()
    for file in sorted(files):
        name = file.relative_to(root) if file.is_relative_to(root) else file
        content = file.read_bytes() if file.is_file() else b"nothing"
        total.update(f"{name.as_posix()}\0{len(content)}\0".encode(errors="surrogateescape"))
        total.update(content)
    return total.hexdigest()


def _files(folder: Path) -> Iterator[Path]:
    """All files of a scene except its outputs, golden files, caches and hidden files."""
    for file in folder.rglob("*"):
        parts = file.relative_to(folder).parts
        if any(part.startswith(".") or part in _IGNORED for part in parts) or not file.is_file():
            continue
        if file.suffix not in _OUTPUTS and not file.name.endswith("~") and not is_of_a_sweep(file):
            yield file


def _user_modules(folder: Path) -> set[Path]:
    """The user's modules that the sources of a folder import, and theirs in turn, if they are
    loaded or next to the folder."""
    found: set[Path] = set()
    waiting = list(folder.rglob("*.py"))
    while waiting:
        for name in _imported(waiting.pop()):
            file = _module_file(folder, name)
            if file is not None and file not in found and not file.is_relative_to(folder) and _is_users(file):
                found.add(file)
                waiting.append(file)
    return found


def _imported(source: Path) -> Iterator[str]:
    """Dotted names that a module may import."""
    try:
        tree = ast.parse(source.read_bytes())
    except (SyntaxError, ValueError, OSError):
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _module_file(folder: Path, name: str) -> Path | None:
    file = getattr(sys.modules.get(name), "__file__", None)
    if file is not None:
        return Path(file).resolve()
    place = folder.parent.joinpath(*name.split("."))
    return next((path for path in (place.with_suffix(".py"), place / "__init__.py") if path.is_file()), None)


def _is_users(file: Path) -> bool:
    """Whether a module belongs neither to the sandbox nor to Python or an installed package."""
    installed = {Path(sysconfig.get_path(name)) for name in ("stdlib", "purelib", "platlib")}
    return (
        file.suffix == ".py"
        and {"site-packages", "dist-packages"}.isdisjoint(file.parts)
        and not any(file.is_relative_to(place) for place in (resources.PACKAGE, *installed))
    )
