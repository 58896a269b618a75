"""A shot, which is a scene and its run; the clock of the one that is watched; and all shots: what each came to, the
paths of some of them, statistics."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import isclose, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from sandbox.files import atomic_write
from sandbox.parameters import value_at
from sandbox.physics.forces import Gravity
from sandbox.picture.path import moves, points, slow_motion
from sandbox.scene import Scene
from sandbox.sport.amounts import amount
from sandbox.window.history import Changes

if TYPE_CHECKING:
    from sandbox.picture.story import Camerawork
    from sandbox.scene.scene_run import SceneRun

#: So many paths are kept, apart from those that are pinned; and so many shots without their paths.
PATHS, _MOST = 20, 5000
#: Of a standard normal: 95 % lie within.
_Z = 1.96
#: How fast a shot is watched.
_RATES = (1 / 16, 1 / 8, 1 / 4, 1 / 2, 1.0, 2.0, 4.0, 8.0)
#: So many earlier shots are drawn, apart from those that are pinned.
SHOWN = 5
STEP = 1 / 60  # s of the shot, for one step by hand
#: Longest time in s that one frame moves the clock at rate 1: a late frame slows the shot down instead of skipping.
LONGEST_FRAME = 1 / 30


def _without(scene: Scene, keys: Iterable[str]) -> tuple[Any, ...]:
    """A scene without the parameters at some keys: equal for two scenes, of the same code, that differ only there."""
    values = scene.parameters.model_dump()
    for key in keys:
        *groups, last = key.split(".")
        node = values
        for group in groups:
            node = node.get(group, {})
        node.pop(last, None)
    return scene.folder, type(scene.parameters), values


def scene_without_controls(scene: Scene) -> tuple[Any, ...]:
    """A scene without what a player aims with: speed, angle, spins, how the shot begins, which keys are held."""
    controls = scene.controls
    return _without(
        scene,
        {
            controls.speed,
            controls.angle,
            *controls.set_on_pull,
            *(spin.key for spin in controls.spins),
            *(held.times for held in controls.held),
        },
    )


@dataclass(frozen=True, eq=False)
class Shot:
    """A scene and its run."""

    scene: Scene
    run: SceneRun
    changes: Changes = Changes("", {})
    number: int = 0  # from 1 in the order of shooting; 0 while aiming
    recorded: bool = False  # read from a replay
    called: str = "before saving"  # what it is labelled as, without a number

    @cached_property
    def start(self) -> tuple[Any, ...]:
        """Equal for shots of one scene file that begin from the same positions."""
        return self.scene.folder, *self.changes.start

    @cached_property
    def place(self) -> tuple[Any, ...]:
        """The scene without the parameters that a player aims with."""
        return scene_without_controls(self.scene)

    @cached_property
    def scene_without_aim(self) -> tuple[Any, ...]:
        """The scene without the speed and the angle of the shot."""
        return _without(self.scene, (self.scene.controls.speed, self.scene.controls.angle))

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
            if fact.final_when not in ("start", "end") and applies:
                return key
        return ""

    @cached_property
    def upright(self) -> bool:
        """True if y is height: seen from above, gravity does not act in the plane."""
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
        """The outcome, in a sentence."""
        return self.scene.verdict(self.run)

    @property
    def aimed(self) -> str:
        """Speed and direction that a pull has set."""
        speed, angle = self.aim
        return f"{amount(speed, 'm/s')} at {amount(angle, 'deg')}"


class Playback:
    """The current time in a shot."""

    def __init__(self, shot: Shot, rate: float | None = None) -> None:
        """``rate`` is the player's; without one a shot that is over too soon to be seen starts in slow motion."""
        self.shot, self.duration, self.chosen = shot, shot.run.duration, rate
        self.rate = self.usual = rate if rate is not None else 1.0 / slow_motion(shot.run, shot.ball)
        self.t, self.playing, self.rested = 0.0, True, 0.0  # rested: s since it is over
        self.story: Camerawork | None = None  # by which it is seen, and which sets its pace

    @property
    def over(self) -> bool:
        return self.t >= self.duration

    def advance(self, dt: float) -> None:
        """``dt`` s of real time have passed."""
        if self.playing:
            self.seek(self.t + min(dt, LONGEST_FRAME) * self.pace)
            self.playing = not self.over
        elif self.story is not None and self.moves_on:
            self.rested = min(self.rested + dt, self.story.goes_on)

    @property
    def pace(self) -> float:
        """The rate at which time passes now: that of the story, unless another is chosen."""
        if self.story is None or self.chosen is not None or self.rate != self.usual:
            return self.rate
        return 1.0 / self.story.slower(self.t)

    @property
    def camera_time(self) -> float:
        """The time in s that the camera knows: of the shot, and on after its end."""
        return self.t + self.rested

    @property
    def moves_on(self) -> bool:
        """True if the camera still moves after the end."""
        return self.story is not None and self.over and self.rested < self.story.goes_on

    def toggle(self) -> None:
        """Pause, resume, or start again at the end."""
        if self.over:
            self.restart()
        else:
            self.playing = not self.playing

    def step(self, steps: int) -> None:
        self.playing = False
        self.seek(self.t + steps * STEP)

    def restart(self) -> None:
        self.t, self.playing, self.rested = 0.0, True, 0.0

    def seek(self, t: float) -> None:
        self.t, self.rested = min(max(t, 0.0), self.duration), 0.0

    def change_rate(self, by: int) -> None:
        index = _RATES.index(self.rate) + by
        self.rate = self.chosen = _RATES[min(max(index, 0), len(_RATES) - 1)]

    @property
    def slowed(self) -> bool:
        """True if it is in slow motion that the player has not chosen."""
        return self.chosen is None and self.pace < 1.0


class Played:
    """A shot that was made, with its path for as long as that is kept."""

    def __init__(self, shot: Shot, title: str) -> None:
        """``title`` is that of its scene file."""
        self.shot: Shot | None = shot
        self.scene, self.changes, self.start, self.number = shot.scene, shot.changes, shot.start, shot.number
        self.title, self.verdict, self.aim, self.result = title, shot.verdict, shot.aim, shot.run.result
        self.scored = shot.scored if shot.scene.controls.scores else None  # None for a scene that does not score
        self.pinned = False

    @cached_property
    def numbers(self) -> dict[str, float]:
        """The numbers that can be compared: speed and angle, then the facts that are numbers, by their keys."""
        controls, found = self.scene.controls, {}
        for key, fact in self.scene.facts.items():
            value = self.result.get(key)
            if not fact.label or not isinstance(value, int | float) or isinstance(value, bool):
                continue
            if fact.final_when != "start" or not any(isclose(value, aim, rel_tol=1e-9) for aim in self.aim):
                found[key] = value  # and not speed or angle again
        return {controls.speed: self.aim[0], controls.angle: self.aim[1], **found}


class Shots:
    """All shots so far, in order."""

    def __init__(self) -> None:
        self.rows: list[Played] = []
        self.count = 0

    def add(self, shot: Shot, title: str) -> Shot:
        """Number a shot and keep it."""
        self.count += 1
        shot = replace(shot, number=self.count)
        self.rows.append(Played(shot, title))
        del self.rows[:-_MOST]
        self._drop_paths()
        return shot

    def _drop_paths(self) -> None:
        for row in [row for row in self.rows if row.shot is not None and not row.pinned][:-PATHS]:
            row.shot = None

    @property
    def paths(self) -> list[Shot]:
        """The shots whose paths are kept."""
        return [row.shot for row in self.rows if row.shot is not None]

    def earlier(self, start: tuple[Any, ...], but: Shot | None = None) -> list[Shot]:
        """The last shots of a scene file that began from the same place, and those that are pinned."""
        alike = [shot for shot in self.paths if shot.start[:2] == start[:2] and shot is not but]
        pinned = [shot for shot in alike if self.pinned(shot)]
        return pinned + [shot for shot in alike if shot.start == start and shot not in pinned][-SHOWN:]

    def pinned(self, shot: Shot) -> bool:
        """True if the path of a shot stays."""
        return any(row.pinned for row in self.rows if row.number == shot.number)

    def pin(self, row: Played) -> None:
        """Keep the path of a shot, or keep it no longer."""
        row.pinned = not row.pinned
        self._drop_paths()


def interval(scored: int, n: int) -> tuple[float, float]:
    """The 95 % interval of the true share of shots, of n of which so many scored: lower and upper end (Wilson 1927)."""
    p = scored / n
    middle, half = p + _Z**2 / (2 * n), _Z * sqrt(p * (1 - p) / n + _Z**2 / (4 * n**2))
    low, high = ((middle + sign * half) / (1 + _Z**2 / n) for sign in (-1, 1))
    return max(0.0, low), min(1.0, high)


def write_csv(rows: Sequence[Played], path: Path) -> None:
    """A row for each shot: what was changed in its scene file, speed and angle, and its results."""
    changed = list(dict.fromkeys(key for row in rows for key in row.changes.values))
    numbers = list(dict.fromkeys(key for row in rows for key in row.numbers if key not in changed))
    with atomic_write(path) as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["shot", "scene", *changed, *numbers, "scored", "verdict"])
        for row in rows:
            values = [row.changes.values.get(key, "") for key in changed]
            values += [row.numbers.get(key, "") for key in numbers]
            scored = "" if row.scored is None else str(row.scored).lower()
            writer.writerow([row.number, row.title, *values, scored, row.verdict])
