"""A scene: its parameters, and what its modules define.

A scene is a folder with a ``scene.py`` that defines ``Parameters`` and ``build``, and optionally ``FACTS``, ``verdict``
and ``CONTROLS``; a scene file ``<name>.toml``; presets in ``presets/*.toml``; and optionally a ``picture.py``.
"""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import isfinite
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from sandbox import display
from sandbox import parameters as declared
from sandbox.engine.model.setup import Setup
from sandbox.errors import RequestError, RunError, sys_exit_as_error
from sandbox.files import from_here, is_given
from sandbox.scene.discovery import SceneSource, default_file, docstring, find, first_comment
from sandbox.scene.modules import module_in
from sandbox.sport.controls import Controls
from sandbox.sport.facts import ENDED, FALLBACK_FACTS, Fact, FinalWhen, fallback_verdict, problem_with
from sandbox.text import check_mapping, shortened
from sandbox.toml import read_toml
from sandbox.tracebacks import code_of, is_of_library

if TYPE_CHECKING:
    from sandbox.engine.paths.run import Run
    from sandbox.scene.points import Points
    from sandbox.scene.scene_run import SceneRun

_REQUIRED = ("Parameters", "build")
#: Keys of a scene file beside its parameters.
_NOT_PARAMETERS = ("scene", "measured")
#: Files of a scene's folder that hold none of its parameters.
_NO_SCENE_FILES = ("colours.toml", "shots.toml", "tile.toml")
#: Types of facts that hold others.
_CONTAINERS = (Mapping, list, tuple)
#: Most characters of a fact or a verdict, for which cards and pictures have room.
_LONGEST_TEXT = 400
_REPORTABLE = f"a number, a text of at most {_LONGEST_TEXT} characters, true or false, or a list or dictionary of those"
#: The arguments with which the functions of a scene, and its picture, are called.
_CALLS = {
    "build": (("parameters",),),
    "verdict": (("run", "parameters"),),
    "Picture": (("run", "parameters", "size", "ghosts"), ("run", "parameters")),
    "Picture.poster": (("self",),),
    "Picture.frame": (("self", "t"),),
}


@dataclass(frozen=True)
class Scene:
    """A sport with all its parameters, ready to run.

    >>> import sandbox
    >>> scene = sandbox.load("golf/driver")
    >>> scene.title, len(scene.build().balls)
    ('golf/driver', 1)
    """

    name: str
    preset: str | None
    parameters: declared.SceneParameters  # of the scene's own class
    folder: Path
    note: str = field(default="", compare=False)  # the first comment of a scene file outside the scene's folder
    measured: Points | None = field(default=None, compare=False)  # points that its file names, which pictures show

    @property
    def module(self) -> ModuleType:
        """The scene's ``scene.py``."""
        return module_in(self.folder, "scene")

    @property
    def about(self) -> str:
        """One line on what it is: from the preset, a scene file elsewhere, or the scene itself."""
        if self.preset is not None:
            return first_comment(self.folder / "presets" / f"{self.preset}.toml")
        return self.note or docstring(self.folder / "scene.py")

    def changed(self, changes: Mapping[str, Any], by: str = "override") -> Scene:
        """The scene with some of its parameters changed, by dotted key. Raises RequestError for an invalid value."""
        return replace(self, parameters=declared.changed(self.parameters, changes, by))

    def picture_module(self) -> Any:
        """The scene's ``picture.py``, or a simple one for a scene without; imported on first use, as it imports
        pygame."""
        os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # no greeting on stdout, which is for --json
        file = self.folder / "picture.py"
        if not is_given(file):
            return display.pictures()
        module = module_in(self.folder, "picture")
        picture = getattr(module, "Picture", None)
        if isinstance(picture, type) and not issubclass(picture, display.pictures().View):
            raise RequestError(f"{file}: Picture must be a SideView or an AboveView of sandbox.kit")
        _check_calls(file, "Picture", picture)
        for name in ("poster", "frame"):
            _check_calls(file, f"Picture.{name}", getattr(picture, name, None))
        return module

    def picture(
        self, run: SceneRun, size: tuple[int, int] | None = None, ghosts: Mapping[str, SceneRun] | None = None
    ) -> Any:
        """The scene's picture of a run, a View; ``size`` in px, or the scene's own choice.

        ``ghosts`` are other runs of the scene by name, drawn pale behind this one.
        """
        chosen: dict[str, Any] = {} if size is None else {"size": size}
        return self.picture_module().Picture(run, self.parameters, **chosen, ghosts=ghosts)

    def build(self) -> Setup:
        """The setup that the engine simulates."""
        with sys_exit_as_error():
            setup = self.module.build(self.parameters)
        if not isinstance(setup, Setup):
            raise self._wrong(self.module.build, "build", "a Setup", setup)
        known = ("start", "end", *setup.names)
        for fact in self.facts.values():
            if isinstance(fact.final_when, str) and fact.final_when not in known:
                file, there = from_here(self.folder / "scene.py"), ", ".join(known)
                raise RequestError(f'{file}: {fact.key} has final_when="{fact.final_when}"; choose from {there}')
        return setup

    @property
    def facts(self) -> Mapping[str, Fact]:
        """The facts of a run of this scene, by their names in its result, the most important first."""
        facts: Sequence[Fact] = getattr(self.module, "FACTS", FALLBACK_FACTS)
        return {fact.key: fact for fact in facts}

    @property
    def facts_except_ended(self) -> list[str]:
        """The facts that many runs report: such a run ends when these are final, and not as a full run would end."""
        return [key for key, fact in self.facts.items() if fact is not ENDED]

    @property
    def units(self) -> Mapping[str, str]:
        """The unit of each fact, "" for a fact without one."""
        return {key: fact.unit for key, fact in self.facts.items()}

    def result(self, run: Run, asked: Collection[str] | None = None) -> dict[str, Any]:
        """The facts of a run, or those in ``asked``, in their units; None for what did not happen."""
        return self.reader(asked)(run, self.parameters)

    def reader(self, asked: Collection[str] | None = None) -> Callable[[Run, Any], dict[str, Any]]:
        """The function that reads these facts from a run of this scene with any parameters; all facts by default."""
        facts = {key: fact for key, fact in self.facts.items() if asked is None or key in asked}

        def read(run: Run, parameters: Any) -> dict[str, Any]:
            with sys_exit_as_error():
                result = {key: fact.compute(run, parameters) for key, fact in facts.items()}
            for key, value in result.items():
                if type(value) is float:
                    if not isfinite(value):
                        result[key] = None
                elif value is not None and (type(value) is not bool or facts[key].unit):
                    result[key] = self._reported(facts[key], value)
            return result

        return read

    def _reported(self, fact: Fact, value: Any) -> Any:
        """The value of a fact as a result has it. Raises RunError if it cannot be shown."""
        if hasattr(value, "tolist"):  # numpy's numbers and arrays
            value = value.tolist()
        if isinstance(value, float) and not isfinite(value):
            return None
        if not _is_reportable(value):
            raise self._wrong(fact.compute, f"the fact {fact.key}", _REPORTABLE, value)
        if fact.unit and not (_is_numeric(value) and not (fact.label and isinstance(value, Mapping))):
            expected = f"a number in {fact.unit}, a list of them, or None"
            raise self._wrong(fact.compute, f"the fact {fact.key}", expected, value)
        return value

    def final_when(self, asked: Collection[str]) -> frozenset[FinalWhen] | None:
        """The conditions that must hold for all these facts to be final; None if one is not until the end."""
        conditions = frozenset(self.facts[key].final_when for key in asked if key in self.facts) - {"start"}
        return None if "end" in conditions or not set(asked) <= self.facts.keys() else conditions

    def rows(
        self, run: SceneRun, errors: Mapping[str, float] | None = None, also: bool = False
    ) -> list[tuple[str, str]]:
        """Label and text of each fact that happened, for a card.

        With estimated errors if there are any and, if ``also``, in a second unit where the sport has one.
        """
        rows = []
        for key, fact in self.facts.items():
            if fact.label and (fact.where is None or fact.where(run, self.parameters)):
                rows.append((fact.label, fact.text(run.result[key], (errors or {}).get(key), also)))
        return [(label, text) for label, text in rows if text]

    def verdict(self, run: SceneRun) -> str:
        """The verdict: one sentence on what happened."""
        with sys_exit_as_error():
            verdict = (function := getattr(self.module, "verdict", fallback_verdict))(run, self.parameters)
        if not isinstance(verdict, str):
            raise self._wrong(function, "verdict", "text", verdict)
        if len(verdict) > _LONGEST_TEXT:
            raise self._wrong(function, "verdict", f"text of at most {_LONGEST_TEXT} characters", verdict)
        return verdict

    @property
    def controls(self) -> Controls:
        """The controls of a player."""
        controls: Controls = getattr(self.module, "CONTROLS", Controls())
        return controls

    def _wrong(self, function: Any, name: str, expected: str, value: Any) -> RunError:
        """A scene's function returned something else, often because of a missing return."""
        file, code = from_here(self.folder / "scene.py"), code_of(function)
        line = f", line {code.co_firstlineno}" if code is not None and Path(code.co_filename).name == "scene.py" else ""
        return RunError(f"{file}{line}: {name} must return {expected}, but returned {_as_text(value)}")

    def _repr_html_(self) -> str:
        return display.notebook().scene_html(self)

    @property
    def title(self) -> str:
        """``golf`` or ``golf/driver``."""
        return f"{self.name}/{self.preset}" if self.preset else self.name

    def __reduce__(self) -> tuple[Any, ...]:
        # By value, so that a process that never imported this scene's module can read it.
        return _revived, (self.name, self.preset, self.folder, self.parameters.model_dump(), self.measured)


def _as_text(value: Any) -> str:
    """A value for a message; of an integer with more digits than Python writes out only its type."""
    try:
        return shortened(repr(value))
    except ValueError:
        return f"a value of type {type(value).__name__} that is too long to write"


def _is_reportable(value: Any, deepest: int = 9) -> bool:
    """True if cards, JSON and tables can show a value; one that contains itself has no end."""
    if isinstance(value, str):
        return len(value) <= _LONGEST_TEXT
    if isinstance(value, _CONTAINERS):
        inside = [*value, *value.values()] if isinstance(value, Mapping) else value
        return deepest > 0 and all(_is_reportable(item, deepest - 1) for item in inside)
    if isinstance(value, int) and not isinstance(value, bool):
        return value.bit_length() < 1000  # a float holds it
    return value is None or isinstance(value, bool | float) or hasattr(value, "tolist")  # numpy's


def _is_numeric(value: Any) -> bool:
    """True if a value is a number, or holds only numbers, as one in a unit must."""
    if isinstance(value, _CONTAINERS):
        return all(map(_is_numeric, value.values() if isinstance(value, Mapping) else value))
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


def _revived(
    name: str, preset: str | None, folder: Path, values: dict[str, Any], measured: Points | None = None
) -> Scene:
    return Scene(name, preset, _parameters_class(folder).model_validate(values), folder, measured=measured)


def _parameters_class(folder: Path) -> type[declared.SceneParameters]:
    """The Parameters of the scene in a folder. Raises RequestError where the scene is not as the sandbox uses it."""
    return _checked(folder / "scene.py", module_in(folder, "scene"))


@lru_cache(maxsize=64)
def _checked(file: Path, module: ModuleType) -> type[declared.SceneParameters]:
    """The same, checked once for each module: a scene that is read again is another one."""
    missing = [name for name in _REQUIRED if not callable(getattr(module, name, None))]
    if missing:
        raise RequestError(f"{file}: a scene needs {', '.join(_REQUIRED)}; {missing[0]} is missing")
    for name in ("build", "verdict"):
        if hasattr(module, name):
            _check_calls(file, name, getattr(module, name))
    parameters: Any = module.Parameters
    facts, controls = getattr(module, "FACTS", FALLBACK_FACTS), getattr(module, "CONTROLS", Controls())
    if not (isinstance(parameters, type) and issubclass(parameters, declared.SceneParameters)):
        wrong = "Parameters must be a sandbox.parameters.SceneParameters"
    elif problem := declared.problem_with(parameters):
        wrong = f"Parameters: {problem}"
    elif problem := problem_with(facts):
        wrong = f"FACTS{problem}"
    elif not isinstance(controls, Controls):
        wrong = "CONTROLS must be a sandbox.sport.controls.Controls"
    elif problem := controls.problem(parameters, [fact.key for fact in facts]):
        wrong = f"CONTROLS {problem}"
    else:
        return parameters
    raise RequestError(f"{file}: {wrong}")


def load(source: str | Path, overrides: Mapping[str, Any] | None = None, *, overrides_from: str = "override") -> Scene:
    """The scene named by ``source``, with ``overrides`` of its scene file, by keys such as ``"air.wind"``, or
    ``"air.wind[0]"`` for one entry of a list.

    ``source`` is a scene (``"golf"``), a preset (``"golf/driver"``), or a path to a scene file or a scene's folder.
    Raises RequestError if it is not found, not readable or invalid; ``overrides_from`` names the overrides in messages.

    >>> import sandbox
    >>> sandbox.load("golf", {"launch.speed": "150 mph"}).parameters.launch.speed  # m/s
    67.056
    """
    check_mapping("overrides", overrides or {}, '{"air.wind": [5, 0]}')
    found = find(source)
    parameters = _parameters(found, overrides, overrides_from)
    file = found.files[-1][0] if found.files else found.folder
    note = "" if file.resolve().is_relative_to(found.folder) else first_comment(file)
    return Scene(found.name, found.preset, parameters, found.folder, note, _measured(found))


def _measured(found: SceneSource) -> Points | None:
    """The points that the file of a scene, or one on which it is based, names. Raises RequestError."""
    named = next(((file, layer["measured"]) for file, layer in reversed(found.files) if "measured" in layer), None)
    if named is None:
        return None
    from sandbox.scene.points import points_of

    return points_of(*named)


def as_scene(scene: Scene | str | Path) -> Scene:
    """The scene itself, or the one that is named."""
    if not isinstance(scene, Scene | str | Path):
        raise RequestError(f"{shortened(repr(scene))}: must be a setup, a scene, its name, or the path of its file")
    return scene if isinstance(scene, Scene) else load(scene)


def _parameters(
    found: SceneSource, overrides: Mapping[str, Any] | None = None, overrides_from: str = ""
) -> declared.SceneParameters:
    """The parameters in the scene's own file and in the files that were found, each over the ones before. Raises
    RequestError, which names the first file that is invalid."""
    schema, own, files = _parameters_class(found.folder), default_file(found.folder), list(found.files)
    if own is not None and own not in (file.resolve() for file, _ in files):
        files.insert(0, (own, read_toml(own)))

    def first(count: int) -> dict[str, Any]:
        values: dict[str, Any] = {}
        for _, layer in files[:count]:
            values = schema.layered(values, {key: value for key, value in layer.items() if key not in _NOT_PARAMETERS})
        return values

    last = files[-1][0] if files else found.folder
    try:
        return declared.validate(schema, first(len(files)), last, overrides, overrides_from)
    except RequestError:
        for count, (file, _) in enumerate(files[:-1], 1):
            declared.validate(schema, first(count), file)
        where, expected = from_here(last), f"{found.folder.resolve().name}.toml"
        others = sorted({file.name for file in found.folder.glob("*.toml")}.difference(_NO_SCENE_FILES))
        if files:
            raise
        if not others and is_of_library(found.folder):
            reason = f"it was installed without its file of numbers, {expected}: declare it as package data"
        else:
            reason = f"its numbers belong in {expected}; {f'is {others[0]} that file?' if others else 'there is none'}"
        raise RequestError(f"{where}: {reason}") from None


def parameters_of(source: str | Path) -> tuple[str, declared.SceneParameters]:
    """Name and default parameters of the scene that ``source`` names; only the key ``scene`` of a file matters."""
    found = find(source)
    return found.name, _parameters(SceneSource(found.name, found.folder))


def _check_calls(file: Path, name: str, function: Any) -> None:
    """Raise RequestError unless the function can be called the way the sandbox calls it."""
    for arguments in _CALLS[name]:
        call = f"{name}({', '.join(arguments)})"
        if not callable(function):
            raise RequestError(f"{file}: {call} is missing")
        try:
            inspect.signature(function).bind(*arguments)
        except TypeError as error:
            raise RequestError(f"{file}: {name} is called as {call}: {error}") from None
