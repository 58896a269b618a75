"""The common part of the single and the vector environment: spaces of a task, and shots played as fast as possible."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.errors import RequestError
from sandbox.lab.axes import Varied
from sandbox.lab.runs import builder
from sandbox.parameters import Group, value_at
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun
from sandbox.tasks import Start, Task
from sandbox.tasks import load as load_task
from sandbox.text import check_mapping

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from sandbox.engine.model.setup import Setup

#: Room around what stands in a scene, as a share of its extent, in which balls are observed; and the half width in m of
#: the room where nothing stands.
_MARGIN, _OPEN = 0.1, 1_000.0


class Course:
    """A task as an environment sees it.

    Actions are from -1 to 1 for each control, between its bounds. An observation has what was drawn at the start, in
    the parameters' units (for a word its place in the list of values); where an attempt has several shots, what is
    drawn of balls is left out, and for each ball of the first shot there are x and y in m, and 1 while it is in play.
    """

    def __init__(
        self, task: str | Task, facts: Sequence[str] | None = None, noise: bool = True, accuracy: str | None = None
    ) -> None:
        self._made_with = task, facts, noise, accuracy
        self.task = task if isinstance(task, Task) else load_task(task)
        if accuracy is not None:
            self.task = replace(self.task, scene=self.task.scene.changed({"accuracy.level": accuracy}, "accuracy"))
        self.noise, scene = noise, self.task.scene
        self.several = self.task.shots > 1
        self.facts = self._free(scene) if facts is None else tuple(dict.fromkeys((*self.task.facts, *facts)))
        if self.several:  # the next shot is made from any of them
            self.facts = tuple(scene.facts)
        unknown = next((fact for fact in facts or () if fact not in scene.facts), None)
        if unknown is not None:
            raise RequestError(f"facts: {scene.name} has no {unknown}; choose from {', '.join(scene.facts)}")
        self.low = np.array([control.low for control in self.task.controls])
        self.high = np.array([control.high for control in self.task.controls])
        self.keys = [*(start.key for start in self.task.start), *self.task.defaults]
        self.observed = [start for start in self.task.start if not (self.several and self._is_of_list(start))]
        self._observed = [(self.keys.index(start.key), start) for start in self.observed]
        self._varied = Varied(scene, self.keys)
        self._build, self._read = builder(scene, self.facts), scene.reader(self.facts)
        self._accuracy = resolve(**scene.parameters.accuracy.model_dump())
        self.action_space = spaces.Box(-1.0, 1.0, (len(self.low),), np.float32)
        self.observation_space = self._observation_space()

    def __reduce__(self) -> tuple[type[Course], tuple[Any, ...]]:
        return type(self), self._made_with  # the rest is made from it, and partly cannot be pickled

    def _free(self, scene: Scene) -> tuple[str, ...]:
        """The facts that are final when those of the task are, so that a run need not go on for them."""
        conditions = scene.final_when(self.task.facts)
        if conditions is None:
            return tuple(scene.facts)
        known = {"start", *conditions}
        return tuple(key for key, fact in scene.facts.items() if key in self.task.facts or fact.final_when in known)

    def _is_of_list(self, start: Start) -> bool:
        """True for a parameter of one of several things, such as balls[0].x."""
        found = value_at(self.task.scene.parameters, start.key.partition("[")[0])
        return isinstance(found, list) and all(isinstance(each, Group) for each in found)

    def _observation_space(self) -> spaces.Box:
        low = [start.low if not start.values else min(_numbers(start.values)) for start in self.observed]
        high = [start.high if not start.values else max(_numbers(start.values)) for start in self.observed]
        if self.several:
            (left, bottom), (right, top) = self._extent
            low += [left, bottom, 0.0] * len(self.names)
            high += [right, top, 1.0] * len(self.names)
        if not low:  # nothing is drawn: a space needs a number
            low, high = [0.0], [1.0]
        # Rounded outwards, so that what is rounded to single precision stays inside.
        lower = np.nextafter(np.array(low, np.float32), np.float32(-np.inf))
        upper = np.nextafter(np.array(high, np.float32), np.float32(np.inf))
        return spaces.Box(lower, upper, dtype=np.float32)

    @cached_property
    def _first(self) -> Setup:
        """A first shot of the task."""
        return self.task.at_start().build()

    @cached_property
    def names(self) -> list[str]:
        """The balls of the first shot."""
        return [ball.name for ball in self._first.balls]

    @cached_property
    def _extent(self) -> tuple[NDArray[Any], NDArray[Any]]:
        """The lower left and upper right corner, in m, of the room in which balls are observed."""
        places = [ball.position for ball in self._first.balls]
        for surface in self._first.surfaces:
            shape = surface.shape
            places += [getattr(shape, name) for name in ("a", "b", "center") if hasattr(shape, name)]
        low, high = np.min(places, axis=0), np.max(places, axis=0)
        margin = _MARGIN * max(high - low) if len(places) > len(self.names) else _OPEN
        return low - margin, high + margin

    def drawn(self, random: np.random.Generator, options: Mapping[str, Any] | None = None) -> list[Any]:
        """Draw the start of an attempt, in the order of the task; ``options={"start": {key: value}}`` sets some of it.
        Raises RequestError."""
        if not options:
            return [start.drawn(random) for start in self.task.start]
        for key in options:
            if key != "start":
                raise RequestError(f'options: there is no {key!r}; write options={{"start": {{key: value}}}}')
        drawn = [start.drawn(random) for start in self.task.start]
        given = options.get("start", {})
        check_mapping("options, start", given, '{"release.height": 2.1}')
        places = {start.key: place for place, start in enumerate(self.task.start)}
        for key, value in given.items():
            if key not in places:
                raise RequestError(f"options, start: {key} is not drawn; choose from {', '.join(places)}")
            start = self.task.start[places[key]]
            if not start.allows(value):
                raise RequestError(f"options, start: {key} = {value!r}: must be {start.range}")
            drawn[places[key]] = value
        return drawn

    def controls_of(self, action: Any, shape: tuple[int, ...] = ()) -> NDArray[Any]:
        """The values of the controls, in their units, for actions of shape (*shape, controls). Raises RequestError for
        other shapes, and for what is no number."""
        try:
            found = np.asarray(action, float)
        except (TypeError, ValueError):
            found = np.array(np.nan)
        wanted, keys = (*shape, len(self.low)), ", ".join(self.task.defaults)
        if found.shape != wanted:
            raise RequestError(
                f"action: has shape {found.shape}, must have {wanted}: a number from -1 to 1 for each of {keys}"
            )
        if np.isnan(found).any():
            raise RequestError(f"action: has nan, must have a number from -1 to 1 for each of {keys}")
        share = 0.5 * (np.clip(found, -1.0, 1.0) + 1.0)
        return np.asarray(self.low + share * (self.high - self.low))

    def action_of(self, values: Mapping[str, float]) -> NDArray[np.float32]:
        """The action that sets the controls to these values, by key; those left out stand at their defaults."""
        chosen = np.array([{**self.task.defaults, **values}[key] for key in self.task.defaults])
        return np.asarray(2.0 * (chosen - self.low) / (self.high - self.low) - 1.0, np.float32)

    def observation(self, drawn: Sequence[Any], setup: Setup | None = None) -> NDArray[np.float32]:
        """The observation of a start, and of balls as they lie in a setup: of the first shot, or of a later one."""
        found = [_number(start, drawn[place]) for place, start in self._observed]
        if self.several and setup is not None:
            (left, bottom), (right, top) = self._extent
            places = {ball.name: ball.position for ball in setup.balls}
            for name in self.names:
                x, y = places.get(name, (0.0, 0.0))
                found += [min(max(x, left), right), min(max(y, bottom), top), float(name in places)]
        return np.array(found or [0.0], np.float32)

    def observations(self, drawn: Sequence[Sequence[Any]], later: Sequence[Scene | None]) -> NDArray[np.float32]:
        """The observations of many attempts before a shot, shape (attempts, ...)."""
        if self.several or not self._observed:
            return np.array([self.next_observation(*each) for each in zip(drawn, later, strict=True)], np.float32)
        columns = ([_number(start, each[place]) for each in drawn] for place, start in self._observed)
        return np.array([*columns], np.float32).T

    def next_observation(self, drawn: Sequence[Any], later: Scene | None) -> NDArray[np.float32]:
        """The observation of an attempt before a shot: the first, or one from where balls lie in a ``later`` scene."""
        if not self.several:
            return self.observation(drawn)
        scene = later or self.scene_of(self.parameters(drawn, list(self.task.defaults.values())))
        return self.observation(drawn, scene.build())

    def parameters(self, drawn: Sequence[Any], aimed: Sequence[float]) -> Any:
        """The parameters of a first shot."""
        return self._varied.parameters([*drawn, *aimed])

    def scene_of(self, parameters: Any) -> Scene:
        """The scene with these parameters."""
        return replace(self.task.scene, parameters=parameters)

    def shot(self, later: Scene | None, drawn: Sequence[Any], aimed: Mapping[str, float]) -> SceneRun:
        """A shot from where balls lie in a ``later`` scene, or the first from what is drawn.

        Its run ends when the facts are final. Raises RunError and RequestError.
        """
        if later is None:
            parameters = self.parameters(drawn, list(aimed.values()))
        else:
            parameters = later.changed(aimed, "action").parameters
        scene, run = self.scene_of(parameters), simulate(self._build(parameters), self._accuracy)
        return SceneRun.of(run, scene, self._read(run, parameters))


def seed_of(given: Any) -> int | None:
    """The seed as Python's whole number, or None for none. Raises RequestError for what is no seed."""
    try:
        seed = None if given is None else operator.index(given)
    except TypeError:
        seed = -1
    if seed is not None and seed < 0:
        raise RequestError(f"seed = {given!r:.60}: must be a whole number, not negative")
    return seed


def _numbers(values: Sequence[Any]) -> list[float]:
    return [float(value) if _is_number(value) else float(place) for place, value in enumerate(values)]


def _number(start: Start, value: Any) -> float:
    return float(value) if _is_number(value) else float(start.values.index(value))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float)
