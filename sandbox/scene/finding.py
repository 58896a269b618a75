"""Finding scenes: those that come with the sandbox, with an installed package (entry point group ``sandbox.scenes``),
and those anywhere on disk.

Opening data runs only the code of installed scenes: a name, on the command line or in a file, always means one of them.
A user's own ``scene.py`` runs only if its folder is given as a path: ``./volleyball``, ``../volleyball`` or an absolute
one; on the command line, or as ``scene = "./volleyball"`` in a scene file, relative to that file.
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Iterator, Mapping
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
    """What a name or a path refers to."""

    name: str
    folder: Path
    file: Path | None  # the scene file to read; None for a folder without one
    base: Path | None = None  # the preset that the file begins from
    preset: str | None = None  # which preset the file is


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
    elsewhere = found.file is not None and found.folder not in found.file.resolve().parents
    note = first_comment(found.file) if found.file is not None and elsewhere else ""
    return Scene(found.name, found.preset, parameters, found.folder, note)


def as_scene(scene: Scene | str | Path) -> Scene:
    """The scene itself, or the one that is named."""
    return scene if isinstance(scene, Scene) else load(scene)


def _parameters(found: Found, overrides: Mapping[str, Any] | None = None, overrides_from: str = "") -> declared.Group:
    """The parameters in the scene's own file, in the preset that the file begins from, and in the file, each over the
    one before."""
    own, where = _default_file(found.folder), shown(found.file or found.folder)
    files = {file.resolve(): file for file in (own, found.base, found.file) if file is not None}
    layers = [(shown(file) if file is own else where, declared.read_toml(file)) for file in files.values()]
    for _, values in layers:
        values.pop("scene", None)
    return _read(parameters_class(found.folder), layers, where, overrides, overrides_from)


def _read(
    schema: type[declared.Group],
    layers: list[tuple[str, dict[str, Any]]],
    where: str,
    overrides: Mapping[str, Any] | None,
    overrides_from: str,
) -> declared.Group:
    """The parameters in these layers. Raises RequestError, which names the first layer that is invalid."""
    values: dict[str, Any] = {}
    for _, layer in layers:
        values = declared.over(schema, values, layer)
    try:
        return declared.validate(schema, values, where, overrides, overrides_from)
    except RequestError:
        for count in range(1, len(layers)):
            _read(schema, layers[:count], layers[count - 1][0], None, "")
        raise


def parameters_of(source: str | Path) -> tuple[str, declared.Group]:
    """Name and default parameters of the scene that ``source`` names; only the key ``scene`` of a file matters."""
    found = _find(source)
    return found.name, _parameters(Found(found.name, found.folder, _default_file(found.folder)))


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
    if folder is not None and not preset:
        return Found(name, folder, _default_file(folder))
    if folder is not None and _is_word(preset):
        return Found(name, folder, _preset(name, folder, preset), preset=preset)
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
        return _in_folder(path)
    if path.is_file() or (path.suffix == ".toml" and not path.is_dir()):
        return _of_file(path)
    if (path.parent / "scene.py").is_file() and not path.exists():  # ./volleyball/float, as golf/driver
        return _in_folder(path.parent, path.name)
    if path.is_dir():
        raise RequestError(f"{path}: a folder without scene.py is not a scene")
    raise RequestError(_unknown(str(path)))


def _in_folder(path: Path, preset: str = "") -> Found:
    """The scene in a folder that was given by its path, or a preset of it."""
    folder = path.resolve()
    file = _preset(folder.name, path, preset) if preset else _default_file(path)
    if file is not None:
        written = declared.read_toml(file).get("scene", folder.name)
        if written != folder.name and not _leads_to(folder, file, written):
            raise RequestError(
                f"{shown(file)}: scene = {declared.shown(written)}, but a file in this folder is for {folder.name}"
            )
    return Found(folder.name, folder, file, preset=preset or None)


def _leads_to(folder: Path, file: Path, written: Any) -> bool:
    """Whether a scene file names its scene by a path to this folder."""
    return isinstance(written, str) and _is_path(written) and (file.parent / written).resolve() == folder


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
    """The scene that a scene file is for. A name means an installed scene, whatever is next to the file; a path means
    the user's own."""
    values = declared.read_toml(path)
    if "scene" not in values:
        raise RequestError(f'{path}: needs a line that names its scene, such as scene = "golf"{_own_folder(path)}')
    written = values["scene"]
    if isinstance(written, str) and _is_path(written):
        return _by_path(path, written)
    name, slash, preset = written.partition("/") if isinstance(written, str) else ("", "", "")
    if not _is_word(name) or (slash and not _is_word(preset)):
        raise RequestError(
            f'{path}: scene = {declared.shown(written)}: must be the name of a scene or preset, such as "golf" or '
            '"golf/moon", or the path of a scene of your own, such as "./volleyball"'
        )
    folder = installed_folder(name)
    if folder is None:
        own = path.parent / name
        if (own / "scene.py").is_file():
            raise RequestError(
                f'{path}: {_unknown(name)}; for the folder next to this file write scene = "./{written}"'
            )
        raise RequestError(f"{path}: {_unknown(name)}{_own_folder(path)}")
    if preset and path.resolve().parent == folder / "presets":
        raise RequestError(f'{path}: scene = "{written}", but a file in this folder is for {name}')
    return _based(path, name, folder, preset)


def _by_path(path: Path, written: str) -> Found:
    """The scene of a scene file that gives the path of its folder."""
    place = path.parent / written
    folder, preset = (place, "") if (place / "scene.py").is_file() else (place.parent, place.name)
    if not (folder / "scene.py").is_file():
        raise RequestError(f"{path}: scene = {declared.shown(written)}: there is no scene.py in that folder")
    folder = folder.resolve()
    return _based(path, folder.name, folder, preset)


def _based(path: Path, name: str, folder: Path, preset: str) -> Found:
    """A scene and the file for it, which begins from one of its presets, if any."""
    base = _preset(name, folder, preset, f"{path}: ") if preset else None
    is_preset = path.resolve().parent == folder / "presets"
    return Found(name, folder, path, base, path.stem if is_preset else None)


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
