"""Discovery of scenes: those that come with the sandbox, with an installed package (entry point group
``sandbox.scenes``), and those anywhere on disk.

Opening data runs only the code of installed scenes: a name, on the command line or in a file, always means one of them.
A user's own ``scene.py`` runs only if its folder is given as a path: ``./volleyball``, ``../volleyball`` or an absolute
one; on the command line, or as ``scene = "./volleyball"`` in a scene file, relative to that file.
"""

from __future__ import annotations

import ast
import importlib.util
import os
import tokenize
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import Any

from sandbox import resources
from sandbox.errors import RequestError
from sandbox.files import from_here, is_given, reason
from sandbox.text import nearest, shortened
from sandbox.toml import read_toml, short_toml

_ENTRY_POINTS = "sandbox.scenes"

#: What is said of a task where a scene is wanted.
_TASK = "is a task, not a scene: sandbox play and sandbox run take it"

#: Most scene files that are based on one another.
_MOST_FILES = 30


@dataclass(frozen=True)
class SceneSource:
    """The scene that a name or a path refers to, and its scene file, after the presets on which that is based."""

    name: str
    folder: Path
    files: Sequence[tuple[Path, Mapping[str, Any]]] = ()  # with what is written in them; none for a folder without one
    preset: str | None = None  # which preset the last file is


def folder_of(source: str | Path) -> Path | None:
    """The folder of the scene that ``source`` names, without importing anything from it; None if there is none."""
    try:
        return find(source).folder
    except RequestError:
        return None


def is_installed(folder: Path) -> bool:
    """True if a scene came with the sandbox or with an installed package."""
    return installed_folder(folder.name) == folder or folder in installed_folders().values()


def installed_folder(name: str) -> Path | None:
    """The folder of a scene that came with the sandbox or an installed package; None for any other name."""
    if not _is_word(name):
        return None
    folder = resources.folder("scenes") / name
    return folder if (folder / "scene.py").is_file() else _offered(name).get(name)


def reference(folder: Path, place: Path) -> str:
    """The text by which a scene file in ``place`` names the scene in ``folder``: its name if installed, else a path."""
    if installed_folder(folder.name) == folder:
        return folder.name
    path = Path(os.path.relpath(folder, place.resolve())).as_posix()
    return path if path.startswith("../") or path in (".", "..") else f"./{path}"


@dataclass(frozen=True)
class Listing:
    """One scene or preset as ``sandbox list`` shows it."""

    name: str
    about: str


def listings() -> Iterator[Listing]:
    """Every installed scene, each followed by its presets."""
    for name, folder in sorted(installed_folders().items()):
        yield from _listed(name, folder)


def listings_in(place: Path) -> Iterator[Listing]:
    """The scenes with folders in ``place``, each followed by its presets, named by paths from there; and the scene
    files in it: TOML files that name their scene."""
    ours = (resources.PACKAGE, *map(resources.folder, ("template", "template_above")))  # in a checkout
    for folder in sorted(file.parent for file in place.glob("*/scene.py")):
        if folder.resolve() not in ours:
            yield from _listed(f"./{folder.name}", folder)
    for file in sorted(place.glob("*.toml")):
        try:
            if file.is_file() and "scene" in read_toml(file):
                yield Listing(file.name, first_comment(file))
        except (OSError, RequestError):
            continue  # it could not be run


def listings_of(source: str) -> list[Listing]:
    """The scene that ``source`` names, followed by its presets."""
    found = find(source)
    is_known = installed_folder(found.name) == found.folder
    return list(_listed(found.name if is_known else as_path(found.folder), found.folder))


def _listed(name: str, folder: Path) -> Iterator[Listing]:
    yield Listing(name, docstring(folder / "scene.py"))
    for preset in _presets(folder):
        yield Listing(f"{name}/{preset.stem}", first_comment(preset))


def find(source: str | Path) -> SceneSource:
    """The scene that is meant, and the scene file to read."""
    if not isinstance(source, str | Path):
        raise RequestError(f"{shortened(repr(source))} is not a scene: give its name as text, or the path of its file")
    try:
        return _named(source) if isinstance(source, str) else _at(source)
    except OSError as error:  # a name too long, a folder that may not be entered
        raise RequestError(f"{shortened(str(source))}: cannot be read: {reason(error)}") from None
    except ValueError:
        raise RequestError(f"{shortened(repr(source))}: a name or path cannot contain a NUL character") from None


def _named(source: str) -> SceneSource:
    name, _, preset = source.partition("/")
    folder = installed_folder(name)
    if folder is not None and (not preset or _is_word(preset)):
        return _in_folder(name, folder, preset)
    if not source:
        raise RequestError(_unknown('""'))
    path = Path(source)
    if not is_path(source) and path.suffix != ".toml":
        here = path if (path / "scene.py").is_file() else path.parent
        if here != Path() and (here / "scene.py").is_file():
            raise RequestError(f"unknown scene {shortened(source)}; for the one in this folder write ./{source}")
        if not path.exists():
            raise RequestError(_unknown(source))
    return _at(path, source)


def is_path(text: str) -> bool:
    """True if a text is a path and not a name: ``.``, ``..``, ``./volleyball``, ``../volleyball``, ``/scenes/golf``."""
    return text in (".", "..") or text.startswith(("./", "../")) or Path(text).is_absolute()


def _at(path: Path, given: str = "") -> SceneSource:
    """The scene that a path refers to; messages call it ``given``."""
    path = path.parent if path.name == "scene.py" else path
    if is_given(path / "scene.py"):
        return _in_folder(path.resolve().name, path)
    if path.is_file() or (path.suffix == ".toml" and not path.is_dir()):
        return _of_file(path)
    if (path.parent / "scene.py").is_file() and not path.exists():  # ./volleyball/float, as golf/driver
        return _in_folder(path.parent.resolve().name, path.parent, path.name)
    if path.is_dir():
        raise RequestError(f"{path}: a folder without scene.py is not a scene")
    is_given(path)
    raise RequestError(f"{shortened(given or str(path))}: there is no such folder or file")


def _in_folder(name: str, path: Path, preset: str = "") -> SceneSource:
    """The scene of that name in a folder, or a preset of it."""
    folder, file = path.resolve(), _preset(name, path, preset) if preset else default_file(path)
    return SceneSource(name, folder, [] if file is None else _files(file, (name, folder))[2], preset or None)


def _is_word(name: str) -> bool:
    return bool(name) and all(character.isalnum() or character in "-_" for character in name)


def _unknown(name: str) -> str:
    if _is_word(name) and any((folder / "tasks" / f"{name}.toml").is_file() for folder in installed_folders().values()):
        return f"{name}: {_TASK}"
    from importlib.metadata import entry_points

    for point in entry_points(group=_ENTRY_POINTS):
        if point.name == name.partition("/")[0]:
            package, where = point.dist.name if point.dist else "a package", point.value.partition(":")[0]
            return f"scene {point.name}: {package} offers it as {where}, but that module is not installed with it"
    near = nearest(name, [listing.name for listing in listings()])
    return f"unknown scene {shortened(name)}; " + (f"did you mean {near}?" if near else "sandbox list shows them all")


def _folder_of(module_name: str) -> Path | None:
    """The folder of the module ``package.scene`` of an installed package."""
    try:
        spec = importlib.util.find_spec(module_name.partition(":")[0])
    except ModuleNotFoundError:
        return None
    return Path(spec.origin).resolve().parent if spec is not None and spec.origin else None


def _offered(name: str = "") -> dict[str, Path]:
    """The folders of all scenes that other installed packages offer, or of one, by their names."""
    from importlib.metadata import entry_points

    points = entry_points(group=_ENTRY_POINTS)
    folders = {point.name: _folder_of(point.value) for point in points if name in ("", point.name)}
    return {found: folder for found, folder in folders.items() if folder is not None}


def installed_folders() -> dict[str, Path]:
    """The folders of all installed scenes, by their names."""
    return _offered() | {path.parent.name: path.parent for path in resources.folder("scenes").glob("*/scene.py")}


def default_file(folder: Path) -> Path | None:
    file = folder / f"{folder.resolve().name}.toml"
    return file if file.exists() else None  # a pipe is refused where it is read


def _presets(folder: Path) -> list[Path]:
    return sorted(file for file in (folder / "presets").glob("*.toml") if file.is_file())


def _preset(name: str, folder: Path, preset: str, where: str = "") -> Path:
    file = folder / "presets" / f"{preset}.toml"
    if file.is_file():
        return file
    known = [path.stem for path in _presets(folder)]
    near = nearest(preset, known)
    presets = f"it has {', '.join(known) or 'none'}" if len(known) <= 6 else f"sandbox list shows its {len(known)}"
    hint = f"did you mean {name}/{near}?" if near else presets
    raise RequestError(f"{where}{name} has no preset {preset}; {hint}")


def _of_file(path: Path) -> SceneSource:
    """The scene that a scene file is for."""
    name, folder, files = _files(path)
    is_preset = path.resolve().parent == folder / "presets"
    return SceneSource(name, folder, files, path.stem if is_preset else None)


def _files(
    file: Path, own: tuple[str, Path] | None = None, after: Sequence[Path] = ()
) -> tuple[str, Path, list[tuple[Path, Mapping[str, Any]]]]:
    """Name and folder of the scene that a file is for, and the file with what is written in it, after those of the
    preset or the file that it begins from. In the folder of its ``own`` scene it need not name it."""
    values = read_toml(file)
    if "scene" not in values and own is None:
        raise RequestError(f'{file}: needs a line that names its scene, such as scene = "golf"{_own_folder(file)}')
    if isinstance(values.get("goal"), str) and "attempts" in values:
        raise RequestError(f"{file}: {_TASK}")
    written = values.get("scene", own and own[0])
    if isinstance(written, str) and is_path(written) and written.endswith(".toml"):
        base: Path | None = file.parent / written
        name, folder = own or ("", Path())
        if not is_given(file.parent / written):
            raise RequestError(f"{file}: scene = {short_toml(written)}: there is no such file")
    else:
        name, folder, preset = _meant(file, written, own or ("", Path()))
        base = _preset(name, folder, preset, f"{file}: ") if preset else None
    if base is not None:
        if base.resolve() in (*after, file.resolve()):
            raise RequestError(f"{from_here(file)}: scene = {short_toml(written)}: is based on itself")
        if len(after) == _MOST_FILES:
            raise RequestError(f"{from_here(after[0])}: is based on more than {_MOST_FILES} files, one on the other")
        name, folder, files = _files(base, (name, folder) if name else None, (*after, file.resolve()))
    else:
        files = []
    if own is not None and folder != own[1]:
        raise RequestError(
            f"{from_here(file)}: scene = {short_toml(written)}, but a file in this folder is for {own[0]}"
        )
    return name, folder, [*files, (file, values)]


def _meant(file: Path, written: Any, own: tuple[str, Path]) -> tuple[str, Path, str]:
    """Name, folder and preset of the scene that a file names. A name means an installed scene, whatever is next to the
    file, or the file's ``own``; a path means the user's own."""
    if isinstance(written, str) and is_path(written):
        place = file.parent / written
        folder, preset = (place, "") if (place / "scene.py").is_file() else (place.parent, place.name)
        if not (folder / "scene.py").is_file():
            raise RequestError(f"{file}: scene = {short_toml(written)}: there is no scene.py in that folder")
        return folder.resolve().name, folder.resolve(), preset
    name, slash, preset = written.partition("/") if isinstance(written, str) else ("", "", "")
    if not _is_word(name) or (slash and not _is_word(preset)):
        raise RequestError(
            f'{file}: scene = {short_toml(written)}: must be the name of a scene or preset, such as "golf" or '
            '"golf/moon", or the path of a scene or scene file of your own, such as "./volleyball" or "./shot.toml"'
        )
    if name == own[0]:
        return *own, preset
    installed = installed_folder(name)
    if installed is None:
        if (file.parent / name / "scene.py").is_file():
            raise RequestError(
                f'{file}: {_unknown(name)}; for the folder next to this file write scene = "./{written}"'
            )
        here = f"; a file in this folder is for {own[0]}" if own[0] else _own_folder(file)
        raise RequestError(f"{file}: {_unknown(name)}{here}")
    return name, installed, preset


def as_path(folder: Path) -> str:
    """The path of a folder as a user may write it, so that it is not taken for a name."""
    path = from_here(folder)
    return path if Path(path).is_absolute() or path == "." else f"./{path}"


def _own_folder(path: Path) -> str:
    """A hint on how to name a file in a user's own scene, as the end of a message; "" for any other file."""
    parent = path.parent
    folder = parent.parent if parent.name == "presets" else parent
    if not (folder / "scene.py").is_file():
        return ""
    name = f"{as_path(folder)}/{path.stem}" if parent.name == "presets" else as_path(folder)
    return f"; a file alone does not run the scene.py of its folder: ask for {name}"


def docstring(file: Path) -> str:
    """The first line of a module's docstring. The module is neither imported nor parsed, since it may be untrusted."""
    passed = (tokenize.ENCODING, tokenize.COMMENT, tokenize.NL)
    try:
        if not file.is_file():  # reading a pipe would wait for ever
            return ""
        with file.open("rb") as source:
            first = next((token for token in tokenize.tokenize(source.readline) if token.type not in passed), None)
        text = ast.literal_eval(first.string) if first is not None and first.type == tokenize.STRING else ""
    except (SyntaxError, ValueError, OSError, RecursionError, tokenize.TokenError):
        return ""
    return text.strip().partition("\n")[0] if isinstance(text, str) else ""


def first_comment(file: Path) -> str:
    """The first comment for people in a scene file, before all keys."""
    try:
        lines = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
    except (UnicodeDecodeError, OSError):
        return ""
    head = takewhile(lambda line: not line.strip() or line.startswith("#"), lines)
    return next((line.lstrip("# ").rstrip() for line in head if line.startswith("# ")), "")
