"""A shot: a scene and its run."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from sandbox.physics.forces import Gravity
from sandbox.picture.lines import moves, points
from sandbox.scene import Scene
from sandbox.sport.amounts import amount
from sandbox.window.history import Changes

if TYPE_CHECKING:
    from sandbox.engine.run import Run


def value_at(parameters: Any, key: str) -> Any:
    """The value at a dotted key; None where there is none."""
    for part in key.replace("[", ".").replace("]", "").split("."):
        if isinstance(parameters, list | tuple):
            parameters = parameters[int(part)] if int(part) < len(parameters) else None
        else:
            parameters = getattr(parameters, part, None)
    return parameters


def without(scene: Scene, keys: Iterable[str]) -> tuple[Any, ...]:
    """A scene without the parameters at some keys: equal for two scenes that differ only there."""
    values = scene.parameters.model_dump()
    for key in keys:
        *groups, last = key.split(".")
        node = values
        for group in groups:
            node = node.get(group, {})
        node.pop(last, None)
    return scene.folder, values


def place_of(scene: Scene) -> tuple[Any, ...]:
    """A scene without what a player aims with: speed, angle, spins, and how the shot begins."""
    controls = scene.controls
    return without(scene, {controls.speed, controls.angle, *controls.also, *(spin.key for spin in controls.spins)})


@dataclass(frozen=True, eq=False)
class Shot:
    """A scene and its run."""

    scene: Scene
    run: Run
    changes: Changes = Changes("", {})
    number: int = 0  # from 1 in the order of shooting; 0 while aiming
    recorded: bool = False  # read from a replay

    @cached_property
    def start(self) -> tuple[Any, ...]:
        """Equal for shots of one scene file that begin from the same positions."""
        return self.scene.folder, *self.changes.start

    @cached_property
    def place(self) -> tuple[Any, ...]:
        """The scene without the parameters that a player aims with."""
        return place_of(self.scene)

    @cached_property
    def unaimed(self) -> tuple[Any, ...]:
        """The scene without the speed and the angle of the shot."""
        return without(self.scene, (self.scene.controls.speed, self.scene.controls.angle))

    @cached_property
    def aim(self) -> tuple[float, float]:
        """The speed and the angle of the shot, in their units."""
        controls = self.scene.controls
        return value_at(self.scene.parameters, controls.speed), value_at(self.scene.parameters, controls.angle)

    @cached_property
    def ball(self) -> str:
        """Name of the ball that is played."""
        ball = self.scene.controls.ball
        names = [b.name for b in self.run.setup.balls]
        named = value_at(self.scene.parameters, ball) or ball
        return named if named in names else names[0]

    @cached_property
    def scored(self) -> bool:
        return bool(self.run.result.get(self.scene.controls.scores))

    @cached_property
    def early(self) -> str:
        """The first fact that is known before the end, such as where the ball lands; "" if there is none."""
        for key, fact in self.scene.facts.items():
            applies = fact.where is None or fact.where(self.run, self.scene.parameters)
            if fact.settled not in ("start", "end") and applies:
                return key
        return ""

    @cached_property
    def upright(self) -> bool:
        """Whether y is height: seen from above, gravity does not act in the plane."""
        return any(isinstance(force, Gravity) for ball in self.run.setup.balls for force in ball.forces)

    @cached_property
    def movers(self) -> list[str]:
        """Names of the balls that move, the played one last."""
        others = [b.name for b in self.run.setup.balls if b.name != self.ball and moves(self.run, b.name)]
        return [*others, self.ball]

    def track(self, ball: str) -> np.ndarray:
        """Points along a ball's path, shape (n, 3): t in s, x and y in m."""
        if ball not in self._tracks:
            self._tracks[ball] = points([(self.run, ball)])[0]
        return self._tracks[ball]

    @cached_property
    def _tracks(self) -> dict[str, np.ndarray]:
        return {}

    @cached_property
    def card(self) -> list[tuple[str, str]]:
        """The facts as labels and texts."""
        return self.scene.rows(self.run)

    @cached_property
    def verdict(self) -> str:
        """What happened, in a sentence."""
        return self.scene.verdict(self.run)

    @property
    def aimed(self) -> str:
        """Speed and direction that a pull has set."""
        speed, angle = self.aim
        return f"{amount(speed, 'm/s')} at {amount(angle, 'deg')}"
