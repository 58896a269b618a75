"""Many attempts at a task at once: first shots are computed together, as arrays, like those of ``simulate_many``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.utils.seeding import np_random
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from sandbox.errors import RequestError, RunError
from sandbox.gym.course import Course, seed_of
from sandbox.lab.many import as_array
from sandbox.lab.runs import Outcome, outcomes
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from sandbox.tasks import Task


class TaskVectorEnv(VectorEnv[Any, Any, Any]):
    """``num_envs`` attempts at a task, each as in ``TaskEnv``: with ``reset(seed=7)`` the first has the starts and the
    noise of a ``TaskEnv`` that was reset with seed 7, the next those of seed 8, and so on.

    ``autoreset_mode`` says what becomes of an attempt that is over, as in Gymnasium's own vector environments:
    ``"NextStep"`` (the default), the next step begins it anew, without a shot; ``"SameStep"``, the step that ends it
    does, ``infos["final_obs"]`` has its last observation and ``infos["final_info"]`` its last infos; ``"Disabled"``,
    ``reset(options={"reset_mask": mask})`` does. ``infos`` has the facts of the shots as arrays: those of the score,
    and those that ``facts`` names, since each takes time.

    >>> import gymnasium, sandbox.gym
    >>> envs = gymnasium.make_vec("sandbox/FreeThrow-v0", num_envs=3)
    >>> observations, infos = envs.reset(seed=1)
    >>> observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
    >>> rewards.shape, terminations.all(), infos["made"].shape
    ((3,), np.True_, (3,))
    """

    def __init__(
        self,
        num_envs: int,
        task: str | Task,
        noise: bool = True,
        facts: Sequence[str] = (),
        render_mode: None = None,
        accuracy: str | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
    ) -> None:
        if not isinstance(num_envs, int | np.integer) or num_envs < 1:
            raise RequestError(f"num_envs = {num_envs!r:.60}: must be a whole number, 1 or more")
        try:
            self._mode = AutoresetMode(autoreset_mode)
        except ValueError:
            modes = ", ".join(repr(mode.value) for mode in AutoresetMode)
            raise RequestError(f"autoreset_mode = {autoreset_mode!r:.60}: must be one of {modes}") from None
        if render_mode is not None:
            raise RequestError("render_mode: the vector environment draws nothing; gymnasium.make gives one that does")
        self.metadata = {"render_modes": [], "autoreset_mode": self._mode}
        self.course = Course(task, facts, noise, accuracy)
        self.num_envs = int(num_envs)
        self.single_action_space, self.single_observation_space = (
            self.course.action_space,
            self.course.observation_space,
        )
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._is_begun = False
        self._randoms = [np_random(None)[0] for _ in range(num_envs)]  # of each attempt
        self._drawn: list[list[Any]] = [[] for _ in range(num_envs)]
        self._later: list[Scene | None] = [None] * num_envs
        self._shots = np.zeros(num_envs, int)
        self._over = np.zeros(num_envs, bool)  # attempts that are over and not begun anew

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | NDArray[np.integer[Any]] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin all attempts, or those where ``options["reset_mask"]`` is True, an array of shape (num_envs,); the
        seeds of all, or that of the first. The other ``options`` are those of ``TaskEnv``. Raises RequestError."""
        seeds, chosen = self._seeds(seed), np.ones(self.num_envs, bool)
        start = dict(options or {})
        if "reset_mask" in start:
            chosen = np.asarray(start.pop("reset_mask"))
            if chosen.dtype != bool or chosen.shape != (self.num_envs,) or not chosen.any():
                said = f"must be an array of {self.num_envs} booleans, one at least True"
                raise RequestError(f"options, reset_mask = {chosen.tolist()!r:.60}: {said}")
            if not self._is_begun and not chosen.all():
                raise ResetNeeded("reset all attempts first: reset_mask begins some of them anew")
        for place in np.flatnonzero(chosen).tolist():
            if seeds[place] is not None:
                self._randoms[place] = np_random(seeds[place])[0]
            self._begin(place, start)
        self._is_begun = True
        return self._observations(range(self.num_envs)), {}

    def _seeds(self, given: Any) -> list[int | None]:
        """The seed of each attempt, None for one that goes on with its random numbers. Raises RequestError."""
        if not isinstance(given, list | tuple | np.ndarray) or np.ndim(given) == 0:
            first = seed_of(given)
            return [None if first is None else first + place for place in range(self.num_envs)]
        if len(given) != self.num_envs:
            raise RequestError(f"seed: {len(given)} seeds for {self.num_envs} attempts")
        return [seed_of(each) for each in given]

    def _begin(self, place: int, options: Mapping[str, Any] | None = None) -> None:
        """Draw the start of an attempt."""
        self._drawn[place] = self.course.drawn(self._randoms[place], options)
        self._later[place], self._shots[place], self._over[place] = None, 0, False

    def _observations(self, places: Sequence[int]) -> NDArray[np.float32]:
        """The observations of these attempts, shape (places, ...)."""
        return self.course.observations(
            [self._drawn[place] for place in places], [self._later[place] for place in places]
        )

    def _aimed(self, actions: Any, playing: NDArray[np.bool_]) -> NDArray[Any]:
        """The values that shots have, in the controls' units, with the noise of the aim where an attempt is played;
        shape (attempts, controls)."""
        values = self.course.controls_of(actions, (self.num_envs,))
        if not self.course.noise:
            return values
        controls = self.course.task.controls
        sd = np.column_stack([control.deviation(values[:, i]) for i, control in enumerate(controls)])
        noisy, errors = (sd > 0.0) & playing[:, np.newaxis], np.zeros_like(values)
        counts = noisy.sum(axis=1).tolist()
        errors[noisy] = np.concatenate(
            [random.standard_normal(count) for random, count in zip(self._randoms, counts, strict=True)]
        )
        low, high = np.array([control.bounds for control in controls]).T
        return np.where(noisy, np.clip(values + sd * errors, low, high), values)

    def step(
        self, actions: Any
    ) -> tuple[NDArray[np.float32], NDArray[Any], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Play a shot of each attempt; in the mode ``NEXT_STEP`` begin those that are over anew instead. Raises
        RequestError for actions that are none, and ResetNeeded where an attempt must be reset first."""
        if not self._is_begun:
            raise ResetNeeded("reset the environment before its first step")
        playing = ~self._over
        if self._mode is AutoresetMode.DISABLED and self._over.any():
            which = f"attempts {', '.join(map(str, np.flatnonzero(self._over)))} are over"
            raise ResetNeeded(f'{which}: begin them anew by reset(options={{"reset_mask": mask}})')
        aimed = self._aimed(actions, playing)
        for place in np.flatnonzero(self._over).tolist():
            self._begin(place)
        self._shots[playing] += 1
        task = self.course.task
        rewards, (made, over) = np.zeros(self.num_envs), np.zeros((2, self.num_envs), bool)
        results: list[Mapping[str, Any] | None] = [None] * self.num_envs
        errors = [""] * self.num_envs
        for place, run in self._played(aimed, np.flatnonzero(playing).tolist()):  # and dropped, one after another
            if isinstance(run, Exception):
                worth, over[place], errors[place] = None, True, str(run)
            else:
                results[place] = run.result
                worth = task.score.of_shot(run.result)
                over[place] = task.is_over(run.result, int(self._shots[place]))
                if not over[place]:
                    self._later[place] = task.after(run.of(task.scene) if isinstance(run, Outcome) else run)
            made[place] = task.is_made(worth)
            rewards[place] = task.reward(worth, bool(over[place]))
        values = self._values(results, errors, made, aimed)
        if self._mode is AutoresetMode.SAME_STEP:
            infos = _held(values, ~over)
            if over.any():
                self._begin_anew(over, infos, _held(values, over))
        else:
            self._over, infos = over.copy(), _held(values, playing)
        return self._observations(range(self.num_envs)), rewards, over, np.zeros(self.num_envs, bool), infos

    def _begin_anew(self, over: NDArray[np.bool_], infos: dict[str, Any], final: dict[str, Any]) -> None:
        """Begin the attempts that are over again, and note how they ended."""
        infos["final_obs"], infos["final_info"] = np.full(self.num_envs, None, object), final
        places = np.flatnonzero(over).tolist()
        for place, observation in zip(places, self._observations(places), strict=True):
            infos["final_obs"][place] = observation
        infos["_final_obs"], infos["_final_info"] = over.copy(), over.copy()
        for place in places:
            self._begin(place)

    def _played(
        self, aimed: NDArray[Any], places: Sequence[int]
    ) -> Iterator[tuple[int, Outcome | SceneRun | Exception]]:
        """The runs of the attempts at these places: of first shots together, of later ones one by one."""
        course, rows, later = self.course, aimed.tolist(), [*self._later]
        first = [place for place in places if self._later[place] is None]
        points = [[*self._drawn[place], *rows[place]] for place in first]
        if first:  # a run is made only for an attempt that goes on after it
            yield from zip(first, outcomes(course.task.scene, course.keys, points, asked=course.facts), strict=True)
        for place in (place for place in places if later[place] is not None):
            values: Mapping[str, float] = dict(zip(course.task.defaults, rows[place], strict=True))
            try:
                yield place, course.shot(later[place], self._drawn[place], values)
            except (RunError, RequestError) as error:
                yield place, error

    def _values(
        self,
        results: Sequence[Mapping[str, Any] | None],
        errors: Sequence[str],
        made: NDArray[np.bool_],
        aimed: NDArray[Any],
    ) -> dict[str, Any]:
        """Facts and controls of all attempts, as arrays."""
        values: dict[str, Any] = {
            fact: as_array([None if result is None else result[fact] for result in results])
            for fact in self.course.facts
        }
        values["is_success"] = made
        values["controls"] = {key: aimed[:, column] for column, key in enumerate(self.course.task.defaults)}
        if any(errors):
            values["error"] = np.array(errors, object)
        return values


def _held(values: dict[str, Any], mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Values as Gymnasium has them in infos: each with a mask of the attempts for which it holds."""
    return values | {f"_{key}": mask.copy() for key in values} if mask.any() else {}
