"""A scene file with the changes made in the window, and whether it was saved meanwhile."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from sandbox import parameters as declared
from sandbox.scene import Scene, load
from sandbox.scene.discovery import find
from sandbox.scene.modules import read_again
from sandbox.sport.controls import Controls
from sandbox.text import command_line
from sandbox.window.background import KeyedCache
from sandbox.window.history import Changes
from sandbox.window.shots import Shot, scene_without_controls

#: Files are checked so often, in s.
_EVERY = 0.2


class _Watch:
    """Checks the time and size of files at intervals; a file that is missing for a moment is being saved."""

    def __init__(self, files: Sequence[Path]) -> None:
        self.seen = {file: _state(file) for file in files}
        self.waited = 0.0

    def saved(self, dt: float) -> list[Path]:
        """The files that changed since the last call, ``dt`` s ago."""
        self.waited += dt
        if self.waited < _EVERY:
            return []
        self.waited = 0.0
        changed = []
        for file, before in self.seen.items():
            now = _state(file)
            if now is not None and now != before:
                self.seen[file] = now
                changed.append(file)
        return changed


def _state(file: Path) -> tuple[int, int] | None:
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size


def _within(values: Mapping[str, Any], limits: Mapping[str, tuple[float, float]]) -> dict[str, Any]:
    """Those of some changes that are allowed, within their bounds."""
    bounds = {key: limits[key] for key in values if key in limits}
    return {key: min(max(float(values[key]), low), high) for key, (low, high) in bounds.items()}


class Session:
    """One scene file with changes. Raises SandboxError for an invalid scene or change."""

    def __init__(self, source: str, changes: Mapping[str, Any] | None = None) -> None:
        self._once = KeyedCache()
        self.limits: Mapping[str, tuple[float, float]] | None = None  # what may be changed, and how far; None: all
        self.open(source, changes)
        self.scene.build()  # reports values that are invalid together

    def open(self, source: str, changes: Mapping[str, Any] | None = None) -> None:
        """Switch to another scene; if that is invalid, keep this one."""
        base = load(source)
        scene = base.changed(changes, "--set") if changes else base
        self.base, self.scene = base, scene
        self.changes = Changes(source, dict(changes or {}))
        self.watch, self.limits = _Watch(self.files), None

    def show(self, scene: Scene, source: str, limits: Mapping[str, tuple[float, float]] | None) -> None:
        """Begin with a scene as it stands, of which no more than this may be changed, each within its bounds (None: all
        may); its files are no longer watched."""
        self.base = self.scene = scene
        self.changes, self.watch, self.limits = Changes(source, {}), _Watch([]), limits

    @property
    def source(self) -> str:
        """The scene file, as it was opened."""
        return self.changes.source

    @property
    def controls(self) -> Controls:
        return self.scene.controls

    @property
    def file(self) -> Path | None:
        """The scene file, if there is one."""
        if Path(self.source).is_file():
            return Path(self.source)
        if self.base.preset is not None:
            return self.base.folder / "presets" / f"{self.base.preset}.toml"
        file = self.base.folder / f"{self.base.name}.toml"
        return file if file.is_file() else None

    @property
    def files(self) -> list[Path]:
        """All files that the scene is made from: the scene file and those that it begins from, its scene's own, and
        the code."""
        folder, own = self.base.folder, self.base.folder / f"{self.base.folder.name}.toml"
        files = [*(file for file, _ in find(self.source).files), own, *sorted(folder.glob("*.py"))]
        return list({file.resolve(): file for file in files if file != own or own.is_file()}.values())

    @property
    def title(self) -> str:
        """``golf``, ``golf/putt``, or the name of the user's file."""
        path = Path(self.source)
        if path.suffix == ".toml" and path.is_file():
            return path.name
        return f"{self.base.name}/{self.base.preset}" if self.base.preset else self.base.name

    def value(self, key: str) -> Any:
        """The current value of a parameter; None for a key that the scene does not have."""
        return declared.value_at(self.scene.parameters, key)

    def base_value(self, key: str) -> Any:
        """The value of a parameter in the scene file."""
        return declared.value_at(self.base.parameters, key)

    @property
    def parameters(self) -> dict[str, declared.Parameter]:
        """All parameters by key with their current values, those of lists one by one."""
        found: dict[str, declared.Parameter] = self._once(
            "parameters", (self.scene,), lambda: {p.key: p for p in declared.walk(self.scene.parameters, entries=True)}
        )
        return found

    @property
    def place(self) -> tuple[Any, ...]:
        """The scene without the parameters that a player aims with."""
        place: tuple[Any, ...] = self._once("place", (self.scene,), lambda: scene_without_controls(self.scene))
        return place

    # Changing

    def may_change(self, keys: Collection[str]) -> bool:
        """True if the player may change one of these, at least."""
        return self.limits is None or any(key in self.limits for key in keys)

    def with_changes(self, values: Mapping[str, Any]) -> Scene:
        """The scene of the file with these changes."""
        return self.base.changed(values, "the window's")

    def _set(self, values: dict[str, Any], positions: frozenset[str]) -> None:
        self.scene, self.changes = self.with_changes(values), Changes(self.source, values, positions & values.keys())

    def change(self, values: Mapping[str, Any]) -> None:
        """Add these changes, or what of them is allowed."""
        values = values if self.limits is None else _within(values, self.limits)
        if any("[" in key for key in values):
            values = declared.without_indices(self.scene.parameters, values, "the window's")
        self._set({**self.changes.values, **values}, self.changes.positions)

    def _take_back(self, keys: Collection[str]) -> None:
        kept = {key: value for key, value in self.changes.values.items() if key not in keys}
        self._set(kept, self.changes.positions)

    def reset(self, key: str | None = None) -> None:
        """Back to the file: one parameter, or all of them."""
        if key is not None and "[" in key:
            self.change({key: self.base_value(key)})
        else:
            self._take_back(self.changes.values if key is None else {key})

    def restore(self, changes: Changes) -> None:
        """Return to these changes, maybe of another scene file."""
        if changes.source != self.source:
            self.open(changes.source)
        values = changes.values if self.limits is None else _within(changes.values, self.limits)
        self._set(dict(values), changes.positions)

    def start_from(self, shot: Shot) -> None:
        """Begin the next shot where the balls of ``shot`` came to rest, if the scene supports it."""
        if self.controls.next_start is not None:
            values = dict(self.controls.next_start(shot.run, shot.scene.parameters))
            self._set({**self.changes.values, **values}, self.changes.positions | values.keys())

    def begin_again(self) -> None:
        """Take back what ``start_from`` changed."""
        self._take_back(self.changes.positions)

    def reload(self, code: bool = False) -> None:
        """Read the scene file again, and with ``code`` the scene's modules too. Changes are kept if it is still the
        same scene."""
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
            self.scene = self.with_changes(self.changes.values)
        except BaseException:
            self.base = before
            raise
        if [*self.watch.seen] != self.files:  # it begins from other files now
            self.watch = _Watch(self.files)

    def command(self) -> str:
        """The command line that runs this."""
        return command_line(self.source, self.changes.values)
