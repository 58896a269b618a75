"""Finding scenes: those that come with the sandbox, with an installed package (entry point group ``sandbox.scenes``),
and those anywhere on disk.

Opening data runs only the code of installed scenes: a name, on the command line or in a file, always means one of them.
A user's own ``scene.py`` runs only if its folder is given as a path: ``./volleyball``, ``../volleyball`` or an absolute
one; on the command line, or as ``scene = "./volleyball"`` in a scene file, relative to that file.
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sandbox import parameters as declared
from sandbox import resources
from sandbox.errors import RequestError
from sandbox.files import reason
from sandbox.scene.scene import Scene, docstring, first_comment, parameters_class, shown
from sandbox.text import shortened

ENTRY_POINTS = "sandbox.scenes"

#: A TOML file larger than this, in bytes, is not a scene file.
LARGEST_FILE = 1_000_000


@dataclass(frozen=True)
class Found:
    """What a name or a path refers to: a scene, and a file for it after the presets that this begins from."""

    name: str
    folder: Path
    files: Sequence[tuple[Path, dict[str, Any]]] = ()  # with what is written in them; none for a folder without one
    preset: str | None = None  # which preset the last file is


def load(source: str | Path, overrides: Mapping[str, Any] | None = None, *, overrides_from: str = "override") -> Scene:
    """The scene named by ``source``, with ``overrides`` of its scene file, by keys such as ``"air.wind"``, or
    ``"air.wind[0]"`` for one entry of a list.

    ``source`` is a scene (``"golf"``), a preset (``"golf/driver"``), or a path to a scene file or a scene's folder.
    Raises RequestError if it is not found, not readable or invalid; ``overrides_from`` names the overrides in messages.
    """
    if not isinstance(overrides, Mapping | None):
        raise RequestError(
            f'overrides = {shortened(repr(overrides))}: must be a dictionary such as {{"air.wind": [5, 0]}}'
        )
    found = _find(source)
    parameters = _parameters(found, overrides, overrides_from)
    file = found.files[-1][0] if found.files else found.folder
    note = "" if file.resolve().is_relative_to(found.folder) else first_comment(file)
    return Scene(found.name, found.preset, parameters, found.folder, note)


def as_scene(scene: Scene | str | Path) -> Scene:
    """The scene itself, or the one that is named."""
    return scene if isinstance(scene, Scene) else load(scene)


def _parameters(
    found: Found, overrides: Mapping[str, Any] | None = None, overrides_from: str = ""
) -> declared.SceneParameters:
    """The parameters in the scene's own file and in the files that were found, each over the ones before. Raises
    RequestError, which names the first file that is invalid."""
    schema, own, files = parameters_class(found.folder), _default_file(found.folder), list(found.files)
    if own is not None and own not in (file.resolve() for file, _ in files):
        files.insert(0, (own, declared.read_toml(own)))

    def first(count: int) -> dict[str, Any]:
        values: dict[str, Any] = {}
        for _, layer in files[:count]:
            values = declared.over(schema, values, {key: value for key, value in layer.items() if key != "scene"})
        return values

    where = shown(files[-1][0] if files else found.folder)
    try:
        return declared.validate(schema, first(len(files)), where, overrides, overrides_from)
    except RequestError:
        for count, (file, _) in enumerate(files[:-1], 1):
            declared.validate(schema, first(count), shown(file))
        raise


def parameters_of(source: str | Path) -> tuple[str, declared.SceneParameters]:
    """Name and default parameters of the scene that ``source`` names; only the key ``scene`` of a file matters."""
    found = _find(source)
    return found.name, _parameters(Found(found.name, found.folder))


def folder_of(source: str | Path) -> Path | None:
    """The folder of the scene that ``source`` names, without importing anything from it; None if there is none."""
    try:
        return _find(source).folder
    except RequestError:
        return None


def is_installed(folder: Path) -> bool:
    """Whether a scene came with the sandbox or with an installed package."""
    return installed_folder(folder.name) == folder or folder in _named_folders().values()


def installed_folder(name: str) -> Path | None:
    """The folder of a scene that came with the sandbox or an installed package; None for any other name."""
    if not _is_word(name):
        return None
    folder = resources.folder("scenes") / name
    return folder if (folder / "scene.py").is_file() else _offered(name).get(name)


def reference(folder: Path, place: Path) -> str:
    """How a scene file in ``place`` names the scene in ``folder``: by its name if it is installed, else by a path."""
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
    for name, folder in sorted(_named_folders().items()):
        yield from _listed(name, folder)


def listings_in(place: Path) -> Iterator[Listing]:
    """The scenes with folders in ``place``, each followed by its presets; named by paths from there."""
    ours = (resources.PACKAGE, *map(resources.folder, ("template", "template_above")))  # in a checkout
    for folder in sorted(file.parent for file in place.glob("*/scene.py")):
        if folder.resolve() not in ours:
            yield from _listed(f"./{folder.name}", folder)


def scene_files_in(place: Path) -> Iterator[Listing]:
    """The scene files in ``place``: TOML files that name their scene."""
    for file in sorted(place.glob("*.toml")):
        try:
            if file.is_file() and file.stat().st_size <= LARGEST_FILE and "scene" in declared.read_toml(file):
                yield Listing(file.name, first_comment(file))
        except (OSError, RequestError):
            continue  # it could not be run


def listings_of(source: str) -> list[Listing]:
    """The scene that ``source`` names, followed by its presets."""
    found = _find(source)
    is_known = installed_folder(found.name) == found.folder
    return list(_listed(found.name if is_known else _as_path(found.folder), found.folder))


def _listed(name: str, folder: Path) -> Iterator[Listing]:
    yield Listing(name, docstring(folder / "scene.py"))
    for preset in _presets(folder):
        yield Listing(f"{name}/{preset.stem}", first_comment(preset))


def _find(source: str | Path) -> Found:
    """The scene that is meant, and the scene file to read."""
    if not isinstance(source, str | Path):
        raise RequestError(f"{shortened(repr(source))} is not a scene: give its name as text, or the path of its file")
    try:
        return _named(source) if isinstance(source, str) else _at(source)
    except OSError as error:  # a name too long, a folder that may not be entered
        raise RequestError(f"{shortened(str(source))}: cannot be read: {reason(error)}") from None
    except ValueError:
        raise RequestError(f"{shortened(repr(source))}: a name or path cannot contain a NUL character") from None


def _named(source: str) -> Found:
    name, _, preset = source.partition("/")
    folder = installed_folder(name)
    if folder is not None and (not preset or _is_word(preset)):
        return _in_folder(name, folder, preset)
    if not source:
        raise RequestError(_unknown('""'))
    path = Path(source)
    if not _is_path(source) and path.suffix != ".toml":
        here = path if (path / "scene.py").is_file() else path.parent
        if here != Path() and (here / "scene.py").is_file():
            raise RequestError(f"unknown scene {shortened(source)}; for the one in this folder write ./{source}")
        if not path.exists():
            raise RequestError(_unknown(source))
    return _at(path)


def _is_path(text: str) -> bool:
    """Whether a text is a path and not a name: ``.``, ``..``, ``./volleyball``, ``../volleyball``, ``/scenes/golf``."""
    return text in (".", "..") or text.startswith(("./", "../")) or Path(text).is_absolute()


def _at(path: Path) -> Found:
    if (path / "scene.py").is_file():
        return _in_folder(path.resolve().name, path)
    if path.is_file() or (path.suffix == ".toml" and not path.is_dir()):
        return _of_file(path)
    if (path.parent / "scene.py").is_file() and not path.exists():  # ./volleyball/float, as golf/driver
        return _in_folder(path.parent.resolve().name, path.parent, path.name)
    if path.is_dir():
        raise RequestError(f"{path}: a folder without scene.py is not a scene")
    raise RequestError(_unknown(str(path)))


def _in_folder(name: str, path: Path, preset: str = "") -> Found:
    """The scene of that name in a folder, or a preset of it."""
    folder, file = path.resolve(), _preset(name, path, preset) if preset else _default_file(path)
    return Found(name, folder, [] if file is None else _files(file, name, folder), preset or None)


def _is_word(name: str) -> bool:
    return bool(name) and all(character.isalnum() or character in "-_" for character in name)


def _unknown(name: str) -> str:
    near = declared.nearest(name, [listing.name for listing in listings()])
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

    points = entry_points(group=ENTRY_POINTS, name=name) if name else entry_points(group=ENTRY_POINTS)
    folders = {point.name: _folder_of(point.value) for point in points}
    return {found: folder for found, folder in folders.items() if folder is not None}


def _named_folders() -> dict[str, Path]:
    """The folders of all installed scenes, by their names."""
    return _offered() | {path.parent.name: path.parent for path in resources.folder("scenes").glob("*/scene.py")}


def _default_file(folder: Path) -> Path | None:
    file = folder / f"{folder.resolve().name}.toml"
    return file if file.is_file() else None


def _presets(folder: Path) -> list[Path]:
    return sorted((folder / "presets").glob("*.toml"))


def _preset(name: str, folder: Path, preset: str, where: str = "") -> Path:
    file = folder / "presets" / f"{preset}.toml"
    if file.is_file():
        return file
    known = [path.stem for path in _presets(folder)]
    near = declared.nearest(preset, known)
    presets = f"it has {', '.join(known) or 'none'}" if len(known) <= 6 else f"sandbox list shows its {len(known)}"
    hint = f"did you mean {name}/{near}?" if near else presets
    raise RequestError(f"{where}{name} has no preset {preset}; {hint}")


def _of_file(path: Path) -> Found:
    """The scene that a scene file is for."""
    values = declared.read_toml(path)
    if "scene" not in values:
        raise RequestError(f'{path}: needs a line that names its scene, such as scene = "golf"{_own_folder(path)}')
    name, folder, _ = _meant(path, values["scene"])
    is_preset = path.resolve().parent == folder / "presets"
    return Found(name, folder, _files(path, name, folder), path.stem if is_preset else None)


def _files(file: Path, name: str, folder: Path, after: Sequence[Path] = ()) -> list[tuple[Path, dict[str, Any]]]:
    """A file for the scene in a folder, with what is written in it, after those of the preset that it begins from."""
    values = declared.read_toml(file)
    written = values.get("scene", name)
    _, meant, preset = _meant(file, written, (name, folder))
    if meant != folder:
        raise RequestError(f"{shown(file)}: scene = {declared.shown(written)}, but a file in this folder is for {name}")
    if not preset:
        return [(file, values)]
    base = _preset(name, folder, preset, f"{file}: ")
    if base in (*after, file.resolve()):
        raise RequestError(f"{shown(file)}: scene = {declared.shown(written)}: begins from itself")
    return [*_files(base, name, folder, (*after, file.resolve())), (file, values)]


def _meant(file: Path, written: Any, own: tuple[str, Path] = ("", Path())) -> tuple[str, Path, str]:
    """Name, folder and preset of the scene that a file names. A name means an installed scene, whatever is next to the
    file, or the file's ``own``; a path means the user's own."""
    if isinstance(written, str) and _is_path(written):
        place = file.parent / written
        folder, preset = (place, "") if (place / "scene.py").is_file() else (place.parent, place.name)
        if not (folder / "scene.py").is_file():
            raise RequestError(f"{file}: scene = {declared.shown(written)}: there is no scene.py in that folder")
        return folder.resolve().name, folder.resolve(), preset
    name, slash, preset = written.partition("/") if isinstance(written, str) else ("", "", "")
    if not _is_word(name) or (slash and not _is_word(preset)):
        raise RequestError(
            f'{file}: scene = {declared.shown(written)}: must be the name of a scene or preset, such as "golf" or '
            '"golf/moon", or the path of a scene of your own, such as "./volleyball"'
        )
    if name == own[0]:
        return *own, preset
    installed = installed_folder(name)
    if installed is None:
        if (file.parent / name / "scene.py").is_file():
            raise RequestError(
                f'{file}: {_unknown(name)}; for the folder next to this file write scene = "./{written}"'
            )
        raise RequestError(f"{file}: {_unknown(name)}{_own_folder(file)}")
    return name, installed, preset


def _as_path(folder: Path) -> str:
    """How a user may write the path of a folder, so that it is not taken for a name."""
    path = shown(folder)
    return path if Path(path).is_absolute() or path == "." else f"./{path}"


def _own_folder(path: Path) -> str:
    """How to name a file in the folder of a user's own scene, as the end of a message; "" for any other file."""
    parent = path.parent
    folder = parent.parent if parent.name == "presets" else parent
    if not (folder / "scene.py").is_file():
        return ""
    name = f"{_as_path(folder)}/{path.stem}" if parent.name == "presets" else _as_path(folder)
    return f"; a file alone does not run the scene.py of its folder: ask for {name}"
