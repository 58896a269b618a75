"""What is being played, without a picture: the scene, what was changed in it, and the shots so far."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from sandbox import parameters as declared
from sandbox.controls import Controls, controls_of
from sandbox.errors import SandboxError
from sandbox.physics.forces import Gravity
from sandbox.scene import Scene, load
from sandbox.window.path import moves, points

if TYPE_CHECKING:
    from sandbox.engine.run import Run


@dataclass(frozen=True)
class Shot:
    """A scene and its run."""

    scene: Scene
    run: Run
    changes: dict[str, Any] = field(default_factory=dict)  # over the scene file

    @cached_property
    def ball(self) -> str:
        """Name of the ball that is played."""
        ball = controls_of(self.scene.module).ball
        names = [b.name for b in self.run.setup.balls]
        named = _at(self.scene.parameters, ball) or ball
        return named if named in names else names[0]

    @cached_property
    def scored(self) -> bool:
        return bool(self.run.result.get(controls_of(self.scene.module).scores))

    @cached_property
    def upright(self) -> bool:
        """Whether y is height: seen from above, no weight pulls along the picture."""
        return any(isinstance(force, Gravity) for ball in self.run.setup.balls for force in ball.forces)

    @cached_property
    def movers(self) -> list[str]:
        """Names of the balls that leave their place, the played one last."""
        others = [b.name for b in self.run.setup.balls if b.name != self.ball and moves(self.run, b.name)]
        return [*others, self.ball]

    def track(self, ball: str) -> np.ndarray:
        """Points along a ball's path, shape (n, 3): t in s, x and y in m."""
        if ball not in self._tracks:
            self._tracks[ball] = points(self.run, ball)
        return self._tracks[ball]

    @cached_property
    def _tracks(self) -> dict[str, np.ndarray]:
        return {}

    @cached_property
    def card(self) -> list[tuple[str, str]]:
        """The result for people, without the verdict."""
        return [entry for entry in self._card if entry[0] != "verdict"]

    @cached_property
    def verdict(self) -> str:
        """What happened, in a line."""
        text = next((text for label, text in self._card if label == "verdict"), self.run.ended)
        return text[:1].upper() + text[1:]

    @cached_property
    def _card(self) -> list[tuple[str, str]]:
        return list(self.scene.module.card(self.run.result, self.scene.parameters))


def _toml(value: Any) -> str:
    """A value as TOML writes it on a line."""
    import tomlkit

    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return str(tomlkit.item(value).as_string())


def _at(parameters: Any, key: str) -> Any:
    """What stands at a dotted key; None where nothing does."""
    for part in key.split("."):
        parameters = getattr(parameters, part, None)
    return parameters


class Session:
    """One scene file with changes over it; raises SandboxError where a scene or a change will not do."""

    def __init__(self, source: str, changes: Mapping[str, Any] | None = None) -> None:
        self.shots: list[Shot] = []
        self._declared: dict[str, declared.Parameter] = {}  # walking takes longer than a frame has
        self.open(source, changes)

    def open(self, source: str, changes: Mapping[str, Any] | None = None) -> None:
        """Play another scene; this one stays where the other will not do."""
        base = load(source)
        scene = load(source, changes or {}, overrides_from="--set")
        scene.build()  # what makes no sense together is told now
        other = not self.shots or self.shots[-1].scene.folder != scene.folder
        self.source, self.base, self.scene = source, base, scene
        self.changes: dict[str, Any] = dict(changes or {})
        self.laid: set[str] = set()  # what was changed so that a shot goes on from the one before
        self.fresh = 0  # of the shots, the first that began where the next one does
        self._declared.clear()
        if other:
            self.shots.clear()

    @property
    def controls(self) -> Controls:
        return controls_of(self.scene.module)

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
    def title(self) -> str:
        return f"{self.base.name}/{self.base.preset}" if self.base.preset else self.base.name

    def value(self, key: str) -> Any:
        """The value of a parameter now; None for a key that the scene does not know."""
        return _at(self.scene.parameters, key)

    def parameter(self, key: str) -> declared.Parameter | None:
        """A parameter with its value now."""
        if key not in self._declared:
            self._declared = {p.key: p for p in declared.walk(self.scene.parameters)}
        found = self._declared.get(key)
        return found._replace(value=self.value(key)) if found is not None else None

    def changed(self, changes: Mapping[str, Any]) -> Scene:
        """The scene with further changes, which are not kept."""
        return self._with({**self.changes, **changes})

    def _with(self, changes: Mapping[str, Any]) -> Scene:
        values = self.base.parameters.model_dump()
        parameters = declared.validate(type(self.base.parameters), values, "", changes, "the window's")
        return replace(self.base, parameters=parameters)

    def change(self, changes: Mapping[str, Any]) -> None:
        """Keep the changes."""
        self.scene = self.changed(changes)
        self.changes |= changes

    def reset(self, key: str | None = None) -> None:
        """Back to the file: one parameter, or all of them."""
        kept = {} if key is None else {k: v for k, v in self.changes.items() if k != key}
        before, self.changes = self.changes, kept
        try:
            self.scene = self.changed({})
        except SandboxError:
            self.changes = before
            raise
        self.laid.intersection_update(kept)

    def go_on(self, shot: Shot) -> bool:
        """Let the next shot begin where one of them ended, where the scene knows how; whether it does."""
        if self.controls.goes_on is None:
            return False
        changes = dict(self.controls.goes_on(shot.run, shot.scene.parameters))
        self.change(changes)
        self.laid.update(changes)
        self.fresh = len(self.shots)
        return True

    def restore(self, changes: Mapping[str, Any]) -> None:
        """These changes and no others."""
        self.scene, self.changes = self._with(changes), dict(changes)

    def begin_again(self) -> None:
        """Take back what ``go_on`` changed."""
        self.restore({key: value for key, value in self.changes.items() if key not in self.laid})
        self.laid.clear()
        self.fresh = len(self.shots)

    def reload(self) -> None:
        """Read the scene file again. What was changed here stays changed, where it is still the same scene."""
        base = load(self.source)
        if base.folder != self.base.folder:
            self.open(self.source)
            return
        before, self.base = self.base, base
        try:
            scene = self.changed({})
            scene.build()
        except SandboxError:
            self.base = before
            raise
        self.scene = scene

    @property
    def recent(self) -> list[Shot]:
        """The shots that began where the next one does."""
        return self.shots[self.fresh :]

    def command(self) -> str:
        """The command line that plays this."""
        import shlex

        settings = []
        for key, value in self.changes.items():
            settings += ["--set", f"{key}={value if isinstance(value, str) else _toml(value)}"]
        return shlex.join(["sandbox", "run", self.source, *settings])
