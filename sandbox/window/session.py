"""What is being played, without a picture: the scene, what was changed in it, and the shots so far."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox import parameters as declared
from sandbox.controls import Controls, controls_of
from sandbox.errors import SandboxError
from sandbox.scene import Scene, load, simulate

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

    @property
    def scored(self) -> bool:
        return bool(self.run.result.get(controls_of(self.scene.module).scores))

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
        wanted = {**self.changes, **changes}
        values = self.base.parameters.model_dump()
        parameters = declared.validate(type(self.base.parameters), values, "", wanted, "")
        return replace(self.scene, parameters=parameters)

    def change(self, changes: Mapping[str, Any]) -> None:
        """Keep the changes; those that agree with the file are forgotten."""
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

    def reload(self) -> None:
        """Read the scene file again. What was changed here stays changed."""
        base = load(self.source)
        before, self.base = self.base, base
        try:
            scene = self.changed({})
            scene.build()
        except SandboxError:
            self.base = before
            raise
        self.scene = scene

    def predict(self, quick: bool = False) -> Shot:
        """The run of the scene as it stands; ``quick`` at the level fast."""
        scene = self.scene
        if quick:
            scene = self.changed({"accuracy.level": "fast"})
        return Shot(self.scene, simulate(scene), dict(self.changes))

    def command(self) -> str:
        """The command line that plays this."""
        import json
        import shlex

        settings = []
        for key, value in self.changes.items():
            text = value if isinstance(value, str) else json.dumps(value)
            settings += ["--set", f"{key}={text}"]
        return shlex.join(["sandbox", "run", self.source, *settings])
