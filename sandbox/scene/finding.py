"""Finding scenes: those that come with the sandbox, with an installed package (entry point group ``sandbox.scenes``),
and those that stand anywhere on disk."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sandbox import parameters as declared
from sandbox import resources
from sandbox.errors import RequestError
from sandbox.files import reason
from sandbox.scene.scene import Scene, docstring, first_comment, parameters_class, shortened, shown

ENTRY_POINTS = "sandbox.scenes"


def load(source: str | Path, overrides: Mapping[str, Any] | None = None, *, overrides_from: str = "override") -> Scene:
    """The scene named by ``source``, with ``overrides`` (by keys such as ``"air.wind"``, or ``"air.wind[0]"`` for one
    of a list) over its scene file.

    ``source`` is a scene (``"golf"``), a preset (``"golf/driver"``), or a path to a scene file or a scene's folder.
    Raises RequestError for what cannot be found, read or accepted; ``overrides_from`` names the overrides in it.
    """
    name, folder, file = _find(source)
    values: dict[str, Any] = {}
    where = shown(folder) if file is None else shown(file)
    preset = file.stem if file is not None and file.resolve().parent == folder / "presets" else None
    schema = parameters_class(folder)
    if file is not None:
        values = declared.read_toml(file)
        written = str(values.pop("scene", name))
        based_on = written.removeprefix(f"{name}/")
        if written != name and (based_on == written or preset is not None):
            raise RequestError(f'{where}: scene = "{written}", but here it is a file for {name}')
        if written != name:
            values = declared.over(schema, _preset_values(name, folder, based_on, where), values)
    parameters = declared.validate(schema, values, where, overrides, overrides_from)
    elsewhere = file is not None and folder not in file.resolve().parents
    return Scene(name, preset, parameters, folder, first_comment(file) if file is not None and elsewhere else "")


def as_scene(scene: Scene | str | Path) -> Scene:
    """The scene itself, or the one that is named."""
    return scene if isinstance(scene, Scene) else load(scene)


def _preset_values(name: str, folder: Path, preset: str, where: str) -> dict[str, Any]:
    """What stands in the preset that a scene file begins from."""
    try:
        values = declared.read_toml(_preset(name, folder, preset))
    except RequestError as error:
        raise RequestError(f"{where}: {error}") from None
    values.pop("scene", None)
    return values


def parameters_of(source: str | Path) -> tuple[str, type[declared.Group]]:
    """Name and Parameters class of the scene that ``source`` names; of a file only the key ``scene`` matters."""
    name, folder, _ = _find(source)
    return name, parameters_class(folder)


@dataclass(frozen=True)
class Listing:
    """One scene or preset as ``sandbox list`` shows it."""

    name: str
    about: str


def listings() -> Iterator[Listing]:
    """Every scene that can be named, each followed by its presets."""
    for name, folder in sorted(_named_folders().items()):
        yield from _listed(name, folder)


def listings_in(place: Path) -> Iterator[Listing]:
    """The scenes whose folders stand in ``place``, each followed by its presets; named as found from there."""
    ours = (resources.PACKAGE, resources.folder("template"))  # in a checkout
    for folder in sorted(file.parent for file in place.glob("*/scene.py")):
        if folder.resolve() not in ours:
            yield from _listed(f"./{folder.name}", folder)


def listings_of(source: str) -> list[Listing]:
    """The scene that ``source`` names, followed by its presets."""
    name, folder, _ = _find(source)
    if (_built_in(name) or _installed(name)) != folder:
        name = shown(folder) if Path(shown(folder)).is_absolute() else f"./{shown(folder)}"
    return list(_listed(name, folder))


def _listed(name: str, folder: Path) -> Iterator[Listing]:
    yield Listing(name, docstring(folder / "scene.py"))
    for preset in _presets(folder):
        yield Listing(f"{name}/{preset.stem}", first_comment(preset))


def _find(source: str | Path) -> tuple[str, Path, Path | None]:
    """Name of the scene, its folder, and the scene file to read (None for a folder without one)."""
    if not isinstance(source, str | Path):
        raise RequestError(f"{shortened(repr(source))} is no scene: name one as text, or give the path of its file")
    try:
        return _named(source) if isinstance(source, str) else _at(source)
    except OSError as error:  # a name too long, a folder that may not be entered
        raise RequestError(f"{shortened(str(source))}: cannot be read: {reason(error)}") from None


def _named(source: str) -> tuple[str, Path, Path | None]:
    name, _, preset = source.partition("/")
    folder = _built_in(name) or _installed(name)
    if folder is not None and not preset:
        return name, folder, _default_file(folder)
    if folder is not None and _is_word(preset):
        return name, folder, _preset(name, folder, preset)
    if not source:
        raise RequestError(_unknown('""'))
    return _at(Path(source))


def _at(path: Path) -> tuple[str, Path, Path | None]:
    if (path / "scene.py").is_file():
        folder = path.resolve()
        return folder.name, folder, _default_file(path)
    if path.is_file() or (path.suffix == ".toml" and not path.is_dir()):
        return *_scene_of_file(path), path
    if (path.parent / "scene.py").is_file() and not path.exists():  # ./volleyball/float, as golf/driver
        folder = path.parent.resolve()
        return folder.name, folder, _preset(folder.name, path.parent, path.name)
    if path.is_dir():
        raise RequestError(f"{path}: a folder without scene.py is not a scene")
    raise RequestError(_unknown(str(path)))


def _is_word(name: str) -> bool:
    return bool(name) and all(character.isalnum() or character in "-_" for character in name)


def _unknown(name: str) -> str:
    near = declared.nearest(name, [listing.name for listing in listings()])
    return f"unknown scene {shortened(name)}; " + (
        f"did you mean {near}?" if near else "sandbox list shows all there are"
    )


def _built_in(name: str) -> Path | None:
    if not _is_word(name):
        return None
    folder = resources.folder("scenes") / name
    return folder if (folder / "scene.py").is_file() else None


def _installed(name: str) -> Path | None:
    """The folder of a scene that another installed package offers."""
    if not _is_word(name):
        return None
    from importlib.metadata import entry_points

    for point in entry_points(group=ENTRY_POINTS, name=name):
        return _folder_of(point.value)
    return None


def _folder_of(module_name: str) -> Path | None:
    """Where the module ``package.scene`` of an installed package stands."""
    try:
        spec = importlib.util.find_spec(module_name.partition(":")[0])
    except ModuleNotFoundError:
        return None
    return Path(spec.origin).resolve().parent if spec is not None and spec.origin else None


def _named_folders() -> dict[str, Path]:
    from importlib.metadata import entry_points

    folders = {point.name: _folder_of(point.value) for point in entry_points(group=ENTRY_POINTS)}
    built_in = {path.parent.name: path.parent for path in resources.folder("scenes").glob("*/scene.py")}
    return {name: folder for name, folder in (folders | built_in).items() if folder is not None}


def _default_file(folder: Path) -> Path | None:
    file = folder / f"{folder.resolve().name}.toml"
    return file if file.is_file() else None


def _presets(folder: Path) -> list[Path]:
    return sorted((folder / "presets").glob("*.toml"))


def _preset(name: str, folder: Path, preset: str) -> Path:
    file = folder / "presets" / f"{preset}.toml"
    if file.is_file():
        return file
    known = [path.stem for path in _presets(folder)]
    near = declared.nearest(preset, known)
    few = f"it has {', '.join(known) or 'none'}" if len(known) <= 6 else f"sandbox list shows its {len(known)}"
    hint = f"did you mean {name}/{near}?" if near else few
    raise RequestError(f"{name} has no preset {preset}; {hint}")


def _scene_of_file(path: Path) -> tuple[str, Path]:
    """Name and folder of the scene that a scene file is for; the nearest wins: around it, beside it, by its name."""
    values = declared.read_toml(path)
    written = values.get("scene")
    parent = path.resolve().parent
    around = parent.parent if parent.name == "presets" else parent
    if (around / "scene.py").is_file():
        return around.name, around
    if "scene" not in values:
        raise RequestError(f'{path}: needs a line that names its scene, such as scene = "golf"')
    name, slash, preset = written.partition("/") if isinstance(written, str) else ("", "", "")
    if not _is_word(name) or (slash and not _is_word(preset)):
        raise RequestError(
            f'{path}: scene = {declared.shown(written)}: must be the name of a scene or preset, such as "golf" or '
            '"golf/moon"; a scene of your own stands beside this file'
        )
    beside = parent / name
    folder = beside if (beside / "scene.py").is_file() else _built_in(name) or _installed(name)
    if folder is None:
        raise RequestError(f"{path}: {_unknown(name)}")
    return name, folder
