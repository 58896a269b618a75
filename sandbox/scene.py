"""Scenes: what one is, how it is found, and how it is run.

A scene is a folder with a ``scene.py`` that offers ``Parameters``, ``build``, ``result`` and ``card``, a scene file
``<name>.toml``, presets in ``presets/*.toml`` and, if it likes, a ``picture.py``. It may come with the sandbox, with an
installed package (entry point group ``sandbox.scenes``), or stand anywhere on disk.
"""

from __future__ import annotations

import ast
import hashlib
import importlib
import importlib.util
import inspect
import math
import os
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from sandbox import parameters as declared
from sandbox import resources
from sandbox.controls import Controls, controls_of
from sandbox.errors import RequestError, RunError
from sandbox.files import reason

if TYPE_CHECKING:
    from sandbox.engine.accuracy import Accuracy
    from sandbox.engine.run import Run
    from sandbox.engine.setup import Setup

#: Scene folders are imported as packages below this name, which nothing else can have taken.
NAMESPACE = "sandbox_scenes"
ENTRY_POINTS = "sandbox.scenes"
#: Draws any scene that has no picture.py.
PLAIN_PICTURE = "sandbox.picture.plain"
OFFERS = ("Parameters", "build", "result", "card")
#: How the functions of a scene, and its picture, are called.
CALLS = {
    "build": (("parameters",),),
    "result": (("run", "parameters"),),
    "card": (("result", "parameters"),),
    "Picture": (("run", "parameters", "size"), ("run", "parameters")),
    "Picture.poster": (("self",),),
    "Picture.frame": (("self", "t"),),
}


@dataclass(frozen=True)
class Scene:
    """A sport with all its numbers, ready to run."""

    name: str
    preset: str | None
    parameters: Any  # the scene's own Parameters
    folder: Path
    note: str = field(default="", compare=False)  # the first comment of a scene file that stands elsewhere

    @property
    def module(self) -> ModuleType:
        """The scene's ``scene.py``."""
        return _module(self.folder, "scene")

    @property
    def about(self) -> str:
        """What it is, in a line: of the preset if there is one, of a scene file elsewhere, else of the scene."""
        if self.preset is not None:
            return _first_comment(self.folder / "presets" / f"{self.preset}.toml")
        return self.note or _docstring(self.folder / "scene.py")

    def picture_module(self) -> ModuleType:
        """The scene's ``picture.py``, or a plain one for a scene without; imported when first asked for: it brings
        pygame with it."""
        os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # its greeting on stdout, which belongs to --json
        if not (self.folder / "picture.py").is_file():
            return importlib.import_module(PLAIN_PICTURE)
        module = _module(self.folder, "picture")
        picture = getattr(module, "Picture", None)
        _check_calls(self.folder / "picture.py", "Picture", picture)
        for name in ("poster", "frame") if isinstance(picture, type) else ():
            _check_calls(self.folder / "picture.py", f"Picture.{name}", getattr(picture, name, None))
        return module

    def picture(self, run: Run, size: tuple[int, int] | None = None, ghosts: Mapping[str, Run] | None = None) -> Any:
        """The scene's picture of a run, with ``poster()`` and ``frame(t)``; ``size`` in px, or what the scene likes.

        ``ghosts`` are other runs of the scene by what they are called, to be drawn pale behind this one. Raises
        RequestError where the scene's picture shows none.
        """
        picture = self.picture_module().Picture
        chosen: dict[str, Any] = {} if size is None else {"size": size}
        if ghosts:
            if "ghosts" not in inspect.signature(picture).parameters:
                raise RequestError(f"{self.name} shows one run alone: its Picture has no parameter ghosts")
            chosen["ghosts"] = ghosts
        return picture(run, self.parameters, **chosen)

    def build(self) -> Setup:
        """The setup that the engine simulates."""
        from sandbox.engine.setup import Setup

        setup = self.module.build(self.parameters)
        if not isinstance(setup, Setup):
            raise self._wrong("build", "a Setup", setup)
        return setup

    def result(self, run: Run) -> dict[str, Any]:
        """The numbers and the verdict that the scene reads from a run."""
        result = self.module.result(run, self.parameters)
        if not isinstance(result, dict):
            raise self._wrong("result", "a dict", result)
        missing = controls_of(self.module).missing(result)
        if missing is not None:
            raise RunError(f"{_shown(self.folder / 'scene.py')}: CONTROLS {missing}")
        return result

    def card(self, result: dict[str, Any]) -> list[tuple[str, str]]:
        """The result for people: labels and texts."""
        rows = self.module.card(result, self.parameters)
        if not isinstance(rows, list) or not all(isinstance(row, tuple) and len(row) == 2 for row in rows):
            raise self._wrong("card", "a list of pairs of label and text", rows)
        return rows

    @property
    def units(self) -> Mapping[str, str]:
        """The units of the result's numbers, by their names, as far as the scene names them in ``UNITS``."""
        units: Mapping[str, str] = getattr(self.module, "UNITS", {})
        return units

    def _wrong(self, function: str, expected: str, value: Any) -> RunError:
        """A scene's function handed back something else: mostly a forgotten return."""
        file = _shown(self.folder / "scene.py")
        return RunError(f"{file}: {function} must return {expected}, and returned {_shortened(repr(value))}")

    @property
    def title(self) -> str:
        """``golf`` or ``golf/driver``."""
        return f"{self.name}/{self.preset}" if self.preset else self.name

    def __reduce__(self) -> tuple[Any, ...]:
        # By value, so that a process that never imported this scene's module can read it.
        return _revived, (self.name, self.preset, self.folder, self.parameters.model_dump())


def _revived(name: str, preset: str | None, folder: Path, values: dict[str, Any]) -> Scene:
    return Scene(name, preset, _parameters_class(folder).model_validate(values), folder)


# ---------------------------------------------------------------------------------------------------------------------
# Running
# ---------------------------------------------------------------------------------------------------------------------


def simulate(scene: Scene | str | Path) -> Run:
    """Run the scene to its end at the accuracy that its parameters ask for; ``run.result`` holds its numbers."""
    from sandbox.engine.accuracy import resolve

    chosen = as_scene(scene)
    return _simulate_at(chosen, resolve(**chosen.parameters.accuracy.model_dump()))


def _simulate_at(scene: Scene, accuracy: Accuracy) -> Run:
    from sandbox.engine import simulate as run_setup

    run = run_setup(scene.build(), accuracy)
    run.scene = scene
    run.result = scene.result(run)
    return run


@dataclass(frozen=True)
class Check:
    """How far a result is to be trusted, by a second run at a finer accuracy."""

    finer: Run
    errors: dict[str, float] = field(default_factory=dict)  # estimated, for each number of the result, in its unit
    changed: dict[str, tuple[Any, Any]] = field(default_factory=dict)  # what else differs: in the run, in the finer one


def check(scene: Scene | str | Path, run: Run | None = None) -> Check:
    """Estimate the errors of the scene's result: run it again, finer, and compare."""
    chosen = as_scene(scene)
    run = run or simulate(chosen)
    return compare(run, _simulate_at(chosen, run.accuracy.finer()))


def compare(run: Run, finer: Run) -> Check:
    """The estimated errors of a run's result, by those of a finer run of the same scene."""
    outcome = Check(finer)
    for name, value in run.result.items():
        other = outcome.finer.result.get(name)
        form, numbers = _taken_apart(value)
        other_form, other_numbers = _taken_apart(other)
        if form != other_form:
            outcome.changed[name] = (value, other)
        elif numbers:
            outcome.errors[name] = max(abs(a - b) for a, b in zip(numbers, other_numbers, strict=True))
    return outcome


def _taken_apart(value: Any) -> tuple[Any, list[float]]:
    """The form of a value with its numbers left out, and those numbers in order."""
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float, [float(value)]
    if isinstance(value, Mapping):
        items, forms = list(value.values()), list(value)
    elif isinstance(value, list | tuple):
        items, forms = list(value), []
    else:
        return value if value == value else None, []  # NaN is a result that is not there
    parts = [_taken_apart(item) for item in items]
    return [*forms, *(form for form, _ in parts)], [number for _, numbers in parts for number in numbers]


# ---------------------------------------------------------------------------------------------------------------------
# Finding
# ---------------------------------------------------------------------------------------------------------------------


def load(source: str | Path, overrides: Mapping[str, Any] | None = None, *, overrides_from: str = "override") -> Scene:
    """The scene named by ``source``, with ``overrides`` (by keys such as ``"air.wind"``, or ``"air.wind[0]"`` for one
    of a list) over its scene file.

    ``source`` is a scene (``"golf"``), a preset (``"golf/driver"``), or a path to a scene file or a scene's folder.
    Raises RequestError for what cannot be found, read or accepted; ``overrides_from`` names the overrides in it.
    """
    name, folder, file = _find(source)
    values: dict[str, Any] = {}
    where = _shown(folder) if file is None else _shown(file)
    preset = file.stem if file is not None and file.resolve().parent == folder / "presets" else None
    schema = _parameters_class(folder)
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
    return Scene(name, preset, parameters, folder, _first_comment(file) if file is not None and elsewhere else "")


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
    return name, _parameters_class(folder)


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
        name = _shown(folder) if Path(_shown(folder)).is_absolute() else f"./{_shown(folder)}"
    return list(_listed(name, folder))


def _listed(name: str, folder: Path) -> Iterator[Listing]:
    yield Listing(name, _docstring(folder / "scene.py"))
    for preset in _presets(folder):
        yield Listing(f"{name}/{preset.stem}", _first_comment(preset))


def _find(source: str | Path) -> tuple[str, Path, Path | None]:
    """Name of the scene, its folder, and the scene file to read (None for a folder without one)."""
    if not isinstance(source, str | Path):
        raise RequestError(f"{_shortened(repr(source))} is no scene: name one as text, or give the path of its file")
    try:
        return _named(source) if isinstance(source, str) else _at(source)
    except OSError as error:  # a name too long, a folder that may not be entered
        raise RequestError(f"{_shortened(str(source))}: cannot be read: {reason(error)}") from None


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
    return f"unknown scene {_shortened(name)}; " + (
        f"did you mean {near}?" if near else "sandbox list shows all there are"
    )


def _shortened(text: str) -> str:
    return text if len(text) <= 80 else text[:77] + "..."


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


def _shown(path: Path) -> str:
    """A path as short as it can be said from the current folder."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except (ValueError, OSError):
        return str(path)


def _docstring(file: Path) -> str:
    """The first line of a module's docstring, without importing the module."""
    try:
        return (ast.get_docstring(ast.parse(file.read_bytes())) or "").partition("\n")[0]
    except (SyntaxError, ValueError, OSError):
        return ""


def _first_comment(file: Path) -> str:
    """The first comment of a scene file that is meant for people, before all keys."""
    try:
        lines = file.read_text(encoding="utf-8").splitlines()
    except (UnicodeDecodeError, OSError):
        return ""
    head = takewhile(lambda line: not line.strip() or line.startswith("#"), lines)
    return next((line.lstrip("# ").rstrip() for line in head if line.startswith("# ")), "")


# ---------------------------------------------------------------------------------------------------------------------
# Importing
# ---------------------------------------------------------------------------------------------------------------------


def _parameters_class(folder: Path) -> type[declared.Group]:
    module = _module(folder, "scene")
    missing = [name for name in OFFERS if not callable(getattr(module, name, None))]
    if missing:
        raise RequestError(f"{folder / 'scene.py'}: a scene offers {', '.join(OFFERS)}; {missing[0]} is missing")
    for name in OFFERS[1:]:
        _check_calls(folder / "scene.py", name, getattr(module, name))
    parameters = module.Parameters
    if not (isinstance(parameters, type) and issubclass(parameters, declared.Group)):
        raise RequestError(f"{folder / 'scene.py'}: Parameters must be a sandbox.parameters.Group")
    accuracy = parameters.model_fields.get("accuracy")
    if accuracy is None or not isinstance(accuracy.default, declared.Accuracy):
        raise RequestError(
            f'{folder / "scene.py"}: Parameters needs a line accuracy: Accuracy = group(Accuracy(), "...")'
        )
    controls = getattr(module, "CONTROLS", Controls())
    if not isinstance(controls, Controls):
        raise RequestError(f"{folder / 'scene.py'}: CONTROLS must be a sandbox.controls.Controls")
    mistake = controls.mistake(parameters)
    if mistake is not None:
        raise RequestError(f"{folder / 'scene.py'}: CONTROLS {mistake}")
    return parameters


def _check_calls(file: Path, name: str, function: Any) -> None:
    """Raise RequestError unless the function can be called as the sandbox is going to."""
    for arguments in CALLS[name]:
        call = f"{name}({', '.join(arguments)})"
        if not callable(function):
            raise RequestError(f"{file}: {call} is missing")
        try:
            inspect.signature(function).bind(*arguments)
        except TypeError as error:
            raise RequestError(f"{file}: {name} is called as {call}: {error}") from None


def _module(folder: Path, name: str) -> ModuleType:
    """``folder/name.py``, imported as part of a package, so that relative imports and pickling work in it."""
    built_in = resources.folder("scenes")
    _package(NAMESPACE, built_in)
    package = f"{NAMESPACE}.{re.sub(r'[^0-9A-Za-z_]', '_', folder.name)}"
    if folder.parent != built_in:
        # Two folders of one name may be in use at once.
        package += "_" + hashlib.sha256(str(folder).encode()).hexdigest()[:12]
    _package(package, folder)
    try:
        return importlib.import_module(f"{package}.{name}")
    except (SyntaxError, ValueError):  # of NUL bytes Python says neither where nor always as a SyntaxError
        file = folder / f"{name}.py"
        if b"\0" in file.read_bytes():
            raise RequestError(f"{file}: not a text file, it holds NUL bytes") from None
        raise


def _package(name: str, folder: Path) -> None:
    """Make ``folder`` importable under ``name``."""
    if name in sys.modules:
        return
    init = folder / "__init__.py"
    if not init.is_file():
        package = sys.modules[name] = ModuleType(name)
        package.__path__ = [str(folder)]
        return
    spec = importlib.util.spec_from_file_location(name, init, submodule_search_locations=[str(folder)])
    assert spec is not None
    assert spec.loader is not None  # a .py file always has one
    package = sys.modules[name] = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(package)
    except BaseException:
        del sys.modules[name]
        raise
