"""Many attempts at a task at once: first shots are computed together, as arrays, like those of ``simulate_many``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.utils.seeding import np_random
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from sandbox.errors import RequestError, RunError
from sandbox.gym.course import Course
from sandbox.lab.many import as_array
from sandbox.lab.runs import runs
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from sandbox.tasks import Task


class TaskVectorEnv(VectorEnv[Any, Any, Any]):
    """``num_envs`` attempts at a task, each as in ``TaskEnv``: with ``reset(seed=7)`` the first has the starts and the
    noise of a ``TaskEnv`` that was reset with seed 7, the next those of seed 8, and so on.

    An attempt that ends begins anew in the same step (``AutoresetMode.SAME_STEP``): ``infos["final_obs"]`` has its last
    observation, and ``infos["final_info"]`` the facts of its last shot, as arrays: those of the score, and those that
    ``facts`` names, since each takes time.

    >>> import gymnasium, sandbox.gym
    >>> envs = gymnasium.make_vec("sandbox/FreeThrow-v0", num_envs=3, vectorization_mode="vector_entry_point")
    >>> observations, infos = envs.reset(seed=1)
    >>> observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
    >>> rewards.shape, terminations.all(), infos["final_info"]["made"].shape
    ((3,), np.True_, (3,))
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": [],
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }

    def __init__(
        self,
        num_envs: int,
        task: str | Task,
        noise: bool = True,
        facts: Sequence[str] = (),
        render_mode: None = None,
        accuracy: str | None = None,
    ) -> None:
        if render_mode is not None:
            raise RequestError("render_mode: the vector environment draws nothing; gymnasium.make gives one that does")
        self.course = Course(task, facts, noise, accuracy)
        self.num_envs = num_envs
        self.single_action_space, self.single_observation_space = (
            self.course.action_space,
            self.course.observation_space,
        )
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._randoms: list[np.random.Generator] = []  # of each attempt
        self._drawn: list[list[Any]] = []
        self._later: list[Scene | None] = []
        self._shots = np.zeros(num_envs, int)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin all attempts; the seeds of all, or that of the first. ``options`` are those of ``TaskEnv``."""
        if seed is None:
            seeds: Sequence[int | None] = [] if self._randoms else [None] * self.num_envs
        else:
            seeds = [seed + place for place in range(self.num_envs)] if isinstance(seed, int) else seed
            if len(seeds) != self.num_envs:
                raise RequestError(f"seed: {len(seeds)} seeds for {self.num_envs} attempts")
        self._randoms = [np_random(each)[0] for each in seeds] or self._randoms
        self._drawn = [self.course.drawn(random, options) for random in self._randoms]
        self._later, self._shots = [None] * self.num_envs, np.zeros(self.num_envs, int)
        return self._observations(range(self.num_envs)), {}

    def _observations(self, places: Sequence[int]) -> NDArray[np.float32]:
        """The observations of these attempts, shape (places, ...)."""
        return np.array([self.course.seen(self._drawn[place], self._later[place]) for place in places], np.float32)

    def _aimed(self, actions: Any) -> NDArray[Any]:
        """The values that shots have, in the controls' units, with the noise of the aim; shape (attempts, controls)."""
        values = self.course.controls_of(actions, (self.num_envs,))
        if not self.course.noise:
            return values
        controls = self.course.task.controls
        sd = np.column_stack([control.deviation(values[:, i]) for i, control in enumerate(controls)])
        noisy, errors = sd > 0.0, np.zeros_like(values)
        counts = noisy.sum(axis=1).tolist()
        errors[noisy] = np.concatenate(
            [random.standard_normal(count) for random, count in zip(self._randoms, counts, strict=True)]
        )
        low, high = np.array([control.bounds for control in controls]).T
        return np.where(noisy, np.clip(values + sd * errors, low, high), values)

    def step(
        self, actions: Any
    ) -> tuple[NDArray[np.float32], NDArray[Any], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Play a shot of each attempt. Raises RequestError for actions that are none."""
        if not self._drawn:
            raise ResetNeeded("reset the environment before its first step")
        aimed = self._aimed(actions)
        found = self._played(aimed)
        self._shots += 1
        task = self.course.task
        results = [None if isinstance(run, Exception) else run.result for run in found]
        worths = [None if result is None else task.score.of_shot(result) for result in results]
        made = np.array([task.is_made(worth) for worth in worths])
        over = np.array(
            [result is None or task.is_over(result, shots) for result, shots in zip(results, self._shots, strict=True)]
        )
        rewards = np.array([task.reward(*each) for each in zip(worths, over, strict=True)])
        for place in np.flatnonzero(~over):
            run = found[place]
            assert isinstance(run, SceneRun)
            self._later[place] = task.after(run)
        infos = self._infos(found, made, aimed, ~over)
        if over.any():
            self._begin_anew(np.flatnonzero(over), infos, self._infos(found, made, aimed, over))
        return self._observations(range(self.num_envs)), rewards, over, np.zeros(self.num_envs, bool), infos

    def _begin_anew(self, over: NDArray[Any], infos: dict[str, Any], final: dict[str, Any]) -> None:
        """Begin the attempts that are over again, and note how they ended."""
        infos["final_obs"], infos["final_info"] = np.full(self.num_envs, None, object), final
        for place, observation in zip(over, self._observations(over.tolist()), strict=True):
            infos["final_obs"][place] = observation
        mask = np.zeros(self.num_envs, bool)
        mask[over] = True
        infos["_final_obs"], infos["_final_info"] = mask, mask.copy()
        for place in over:
            self._drawn[place], self._later[place] = self.course.drawn(self._randoms[place]), None
        self._shots[over] = 0

    def _played(self, aimed: NDArray[Any]) -> list[SceneRun | Exception]:
        """The runs of all attempts: of first shots together, of later ones one by one."""
        course, rows = self.course, aimed.tolist()
        found: dict[int, SceneRun | Exception] = {}
        first = [place for place, later in enumerate(self._later) if later is None]
        points = [[*self._drawn[place], *rows[place]] for place in first]
        found |= zip(first, runs(course.task.scene, course.keys, points, asked=course.facts), strict=True)
        for place in (place for place, later in enumerate(self._later) if later is not None):
            values: Mapping[str, float] = dict(zip(course.task.defaults, rows[place], strict=True))
            try:
                found[place] = course.shot(self._later[place], self._drawn[place], values)
            except (RunError, RequestError) as error:
                found[place] = error
        return [found[place] for place in range(self.num_envs)]

    def _infos(
        self, found: Sequence[SceneRun | Exception], made: NDArray[Any], aimed: NDArray[Any], mask: NDArray[Any]
    ) -> dict[str, Any]:
        """Facts as arrays, as Gymnasium has them: each with a mask of the attempts for which it holds."""
        if not mask.any():
            return {}
        infos: dict[str, Any] = {}
        for fact in self.course.facts:
            infos[fact] = as_array([None if isinstance(run, Exception) else run.result[fact] for run in found])
        infos["is_success"] = made
        infos["controls"] = {key: aimed[:, column] for column, key in enumerate(self.course.task.defaults)}
        if any(isinstance(run, Exception) for run in found):
            infos["error"] = np.array([str(run) if isinstance(run, Exception) else "" for run in found], object)
        return infos | {f"_{key}": mask.copy() for key in infos}
