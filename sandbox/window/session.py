"""A scene file with what was changed over it, and the way back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from sandbox import parameters as declared
from sandbox.scene import Scene, load
from sandbox.scene.modules import read_again
from sandbox.sport.controls import Controls
from sandbox.window.shot import Shot, place_of, value_at

#: So many changes can be undone.
UNDOABLE = 100


class Changes(NamedTuple):
    """What was changed over the scene file."""

    values: dict[str, Any]  # by key
    positions: frozenset[str]  # the keys that were changed because a shot began where one before it ended

    @property
    def moved(self) -> dict[str, Any]:
        """What was changed at these keys."""
        return {key: self.values.get(key) for key in self.positions}


class Session:
    """One scene file with changes over it. Raises SandboxError for a scene or a change that is invalid."""

    def __init__(self, source: str, changes: Mapping[str, Any] | None = None) -> None:
        self._declared: dict[str, declared.Parameter] = {}  # walking takes longer than a frame has
        self.open(source, changes)

    def open(self, source: str, changes: Mapping[str, Any] | None = None) -> None:
        """Play another scene; if that is invalid, this one stays."""
        base = load(source)
        scene = load(source, changes or {}, overrides_from="--set")
        scene.build()  # reports values that are invalid together
        self.source, self.base, self.scene = source, base, scene
        self.changes = Changes(dict(changes or {}), frozenset())
        self.undoable: list[tuple[frozenset[str], Changes]] = []  # what each change was of, and what was before it
        self._place: tuple[Scene | None, tuple[Any, ...]] = (None, ())
        self._declared.clear()

    @property
    def controls(self) -> Controls:
        return self.scene.controls

    @property
    def file(self) -> Path | None:
        """The scene file behind all this."""
        if Path(self.source).is_file():
            return Path(self.source)
        if self.base.preset is not None:
            return self.base.folder / "presets" / f"{self.base.preset}.toml"
        file = self.base.folder / f"{self.base.name}.toml"
        return file if file.is_file() else None

    @property
    def files(self) -> list[Path]:
        """All files that the scene is made from: the scene file, its scene's own, and the code."""
        folder = self.base.folder
        files = [self.file, folder / f"{folder.name}.toml", *sorted(folder.glob("*.py"))]
        return list(dict.fromkeys(file for file in files if file is not None))

    @property
    def title(self) -> str:
        """``golf``, ``golf/putt``, or the name of a file of one's own."""
        path = Path(self.source)
        if path.suffix == ".toml" and path.is_file():
            return path.name
        return f"{self.base.name}/{self.base.preset}" if self.base.preset else self.base.name

    def value(self, key: str) -> Any:
        """The value of a parameter now; None for a key that the scene does not know."""
        return value_at(self.scene.parameters, key)

    def base_value(self, key: str) -> Any:
        """The value of a parameter in the scene file."""
        return value_at(self.base.parameters, key)

    def parameter(self, key: str) -> declared.Parameter | None:
        """A parameter with its value now."""
        if key not in self._declared:
            self._declared = {p.key: p for p in declared.walk(self.scene.parameters)}
        found = self._declared.get(key)
        return found._replace(value=self.value(key)) if found is not None else None

    @property
    def place(self) -> tuple[Any, ...]:
        """What the scene is apart from what a player aims with."""
        if self._place[0] is not self.scene:
            self._place = self.scene, place_of(self.scene)
        return self._place[1]

    # Changing

    def _with(self, values: Mapping[str, Any]) -> Scene:
        parameters = declared.validate(
            type(self.base.parameters), self.base.parameters.model_dump(), "", values, "the window's"
        )
        return replace(self.base, parameters=parameters)

    def _set(self, changes: Changes, what: frozenset[str]) -> None:
        """Take over other changes; ``what`` says of what, and a run of changes of the same is undone at once."""
        scene = self._with(changes.values)
        same = what and self.undoable and self.undoable[-1][0] == what
        if changes.values != self.changes.values and not same:
            self.undoable.append((what, self.changes))
            del self.undoable[:-UNDOABLE]
        self.scene, self.changes = scene, changes

    def change(self, values: Mapping[str, Any]) -> None:
        """Keep these changes too."""
        self._set(Changes({**self.changes.values, **values}, self.changes.positions), frozenset(values))

    def end_change(self) -> None:
        """What is changed from here on is undone by itself, even if it is of the same keys."""
        if self.undoable:
            self.undoable[-1] = frozenset(), self.undoable[-1][1]

    def reset(self, key: str | None = None) -> None:
        """Back to the file: one parameter, or all of them."""
        values = {} if key is None else {k: v for k, v in self.changes.values.items() if k != key}
        self._set(Changes(values, self.changes.positions & values.keys()), frozenset())

    def restore(self, changes: Changes) -> None:
        """These changes and no others, as they once were."""
        self.scene, self.changes = self._with(changes.values), changes

    def undo(self) -> bool:
        """Take back the last change; whether there was one."""
        if not self.undoable:
            return False
        _, before = self.undoable[-1]
        self.restore(before)
        self.undoable.pop()
        return True

    def go_on(self, shot: Shot) -> bool:
        """Let the next shot begin where the balls of one came to rest, in scenes that offer it; whether they do."""
        if self.controls.next_start is None:
            return False
        values = dict(self.controls.next_start(shot.run, shot.scene.parameters))
        positions = self.changes.positions | values.keys()
        self._set(Changes({**self.changes.values, **values}, positions), frozenset())
        return True

    def begin_again(self) -> None:
        """Take back what ``go_on`` changed."""
        values = {key: value for key, value in self.changes.values.items() if key not in self.changes.positions}
        self._set(Changes(values, frozenset()), frozenset())

    def reload(self, code: bool = False) -> None:
        """Read the scene file again, and with ``code`` the scene's modules too. What was changed here stays changed,
        where it is still the same scene."""
        if code:
            with read_again(self.base.folder):
                self.reload()
                self.scene.picture_module()
            return
        base = load(self.source)
        if base.folder != self.base.folder:
            self.open(self.source)
            return
        before, self.base = self.base, base
        try:
            scene = self._with(self.changes.values)
            scene.build()
        except BaseException:
            self.base = before
            raise
        self.scene = scene
        self._declared.clear()

    def command(self) -> str:
        """The command line that runs this."""
        import shlex

        settings = []
        for key, value in self.changes.values.items():
            settings += ["--set", f"{key}={value if isinstance(value, str) else _toml(value)}"]
        return shlex.join(["sandbox", "run", self.source, *settings])


def _toml(value: Any) -> str:
    """A value as TOML writes it on a line."""
    import tomlkit

    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return str(tomlkit.item(value).as_string())
