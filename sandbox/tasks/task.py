"""A task: starts are drawn, controls aimed, shots scored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox.errors import RequestError
from sandbox.tasks.scoring import Condition, Score

if TYPE_CHECKING:
    from numpy.random import Generator

    from sandbox.scene.scene import Scene
    from sandbox.scene.scene_run import SceneRun


@dataclass(frozen=True)
class Start:
    """A parameter that is drawn anew for each attempt: evenly from low to high, or one of the values."""

    key: str
    unit: str
    low: float = 0.0
    high: float = 0.0
    values: tuple[Any, ...] = ()

    def drawn(self, random: Generator) -> Any:
        """A value for one attempt."""
        if self.values:
            return self.values[int(random.integers(len(self.values)))]
        return float(random.uniform(self.low, self.high))

    def allows(self, value: Any) -> bool:
        """True for a value that may be drawn."""
        if self.values:
            return value in self.values
        return isinstance(value, int | float) and self.low <= value <= self.high

    @property
    def range(self) -> str:
        """Return what may be drawn, in words, such as ``between 2 and 2.3 m``."""
        if self.values:
            return f"one of {', '.join(map(repr, self.values))}"
        return f"between {self.low:g} and {self.high:g} {self.unit}".rstrip()


@dataclass(frozen=True)
class Control:
    """A parameter that the player sets, in its unit: bounds, where it stands at first, and how exact he is."""

    key: str
    unit: str
    meaning: str
    low: float
    high: float
    default: float
    sd: float = 0.0  # standard deviation of his aim
    share: float = 0.0  # or as a share of the value
    bounds: tuple[float, float] = (-inf, inf)  # of the scene

    def within(self, value: float) -> float:
        """The value, or the bound that it exceeds."""
        return min(max(float(value), self.low), self.high)

    def deviation(self, value: Any) -> Any:
        """The standard deviation of the player's aim at a value, or at each of an array."""
        return self.sd + self.share * abs(value)

    def aimed(self, value: float, random: Generator | None) -> float:
        """The value of a shot whose player sets this one: normally distributed around it, within the scene's bounds."""
        sd, value = self.deviation(value), self.within(value)
        if random is None or sd == 0.0:
            return value
        low, high = self.bounds
        return min(max(float(random.normal(value, sd)), low), high)


@dataclass(frozen=True)
class Task:
    """A task: what is drawn at the start, what the player sets, what counts, and how often he may try.

    >>> from sandbox.tasks import load
    >>> task = load("free-throw")
    >>> task.attempts, [control.key for control in task.controls]
    (5, ['launch.speed', 'launch.angle'])
    """

    name: str
    goal: str
    level: int  # from 1, the easiest of its scene, to 5
    scene: Scene  # as it is before anything is drawn
    start: tuple[Start, ...]
    controls: tuple[Control, ...]
    shown: str  # "all", "first contact", "one metre" or "nothing"
    attempts: int
    shots: int  # most shots of one attempt
    score: Score
    stars: tuple[float, float, float]
    passing: float
    goes_on: tuple[Condition, ...]
    ends: tuple[Condition, ...]
    file: Path

    @cached_property
    def defaults(self) -> dict[str, float]:
        """The values of the controls before the player sets them, by key."""
        return {control.key: control.default for control in self.controls}

    @cached_property
    def facts(self) -> tuple[str, ...]:
        """The facts of the scene that score and rules of the task read."""
        others = (wanted.fact for wanted in (*self.goes_on, *self.ends))
        return tuple(dict.fromkeys((*self.score.facts, *others)))

    def drawn(self, random: Generator) -> dict[str, Any]:
        """Draw the start of one attempt: values by key."""
        return {start.key: start.drawn(random) for start in self.start}

    def drawn_for(self, seed: int, attempt: int) -> dict[str, Any]:
        """Draw the start of an attempt, counted from 1: the same for the same seed."""
        from numpy.random import default_rng

        return self.drawn(default_rng([attempt, seed]))

    def at_start(self, seed: int = 0, attempt: int = 1) -> Scene:
        """The scene with what is drawn for an attempt and all controls at their defaults."""
        return self.scene.changed({**self.drawn_for(seed, attempt), **self.defaults}, "start")

    def aimed(self, values: Mapping[str, float], random: Generator | None = None) -> dict[str, float]:
        """The values of a shot whose player sets these: within bounds, and with the noise of his aim unless ``random``
        is None; a control that he leaves out stands at its default. Raises RequestError."""
        unknown = next((key for key in values if key not in self.defaults), None)
        if unknown is not None:
            raise RequestError(f"{self.name}: {unknown} is no control of this task; set {', '.join(self.defaults)}")
        chosen = {**self.defaults, **values}
        return {control.key: control.aimed(chosen[control.key], random) for control in self.controls}

    def after(self, run: SceneRun) -> Scene:
        """The scene of the next shot of an attempt: from where the balls lie, with all controls at their defaults."""
        next_start = self.scene.controls.next_start
        assert next_start is not None  # of a task with several shots
        return run.scene.changed({**next_start(run, run.scene.parameters), **self.defaults}, "next shot")

    def is_over(self, result: Mapping[str, Any], shots: int) -> bool:
        """True if an attempt ends with a shot that has these facts, its ``shots``-th."""
        if shots >= self.shots or not all(wanted.met(result) for wanted in self.goes_on):
            return True
        if self.score.ends_attempt(self.score.of_shot(result)):
            return True
        return bool(self.ends) and all(wanted.met(result) for wanted in self.ends)

    def is_made(self, worth: float | None) -> bool:
        """True if a shot of this worth is a success."""
        return self.score.is_made(worth, self.passing, self.attempts)

    def reward(self, worth: float | None, over: bool) -> float:
        """The reward of a shot of this worth, with which its attempt is ``over`` or not."""
        return self.score.reward(worth, self.passing, over and not self.is_made(worth))

    def passed(self, total: float | None) -> bool:
        """True if a session with this score passes."""
        return self.score.reaches(total, self.passing)

    def points(self, total: float | None) -> int:
        """The points of a session with this score in a decathlon: 400, 700 and 1000 for one, two and three stars, in
        proportion between them, and less for less than one."""
        if total is None:
            return 0
        sign = -1.0 if self.score.lower_is_better else 1.0
        first, *others = zip((sign * stars for stars in self.stars), (400.0, 700.0, 1000.0), strict=True)
        score, (x, y) = sign * total, first
        if score < x:
            share = x / score if self.score.lower_is_better else score / x if x > 0.0 else 0.0
            return round(y * max(0.0, share))
        for x1, y1 in others:
            if score < x1:
                return round(y + (y1 - y) * (score - x) / (x1 - x))
            x, y = x1, y1
        return round(y)

    def stars_for(self, total: float | None) -> int:
        """The stars for a session with this score: 0 to 3."""
        return sum(self.score.reaches(total, threshold) for threshold in self.stars)
