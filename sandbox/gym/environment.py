"""A task as a Gymnasium environment: an episode is an attempt, a step is a shot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.error import ResetNeeded

from sandbox.errors import RequestError, RunError
from sandbox.files import check_size
from sandbox.gym.course import Course, seed_of
from sandbox.scene import simulate

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from sandbox.scene import Scene
    from sandbox.scene.scene_run import SceneRun
    from sandbox.tasks import Task

#: The size of frames in px.
_SIZE = (640, 360)


class TaskEnv(gymnasium.Env["NDArray[np.float32]", "NDArray[np.float32]"]):
    """An attempt at a task.

    ``reset`` draws the start; ``options={"start": {key: value}}`` sets some of it. Actions are from -1 to 1 between the
    bounds of each control (``action_of`` and ``controls_of`` convert); the noise of a player's aim is added unless
    ``noise`` is False. The reward is what a shot is worth, or minus the distance where the nearest counts. ``info`` has
    the facts of the run, ``is_success``, and ``controls``: what became of the action. A run ends when the facts of the
    score are final; ``facts`` names those in ``info`` besides them, by default all that are final then. ``accuracy`` is
    a level such as ``"fast"``, by default the scene's.

    >>> import gymnasium, sandbox.gym
    >>> env = gymnasium.make("sandbox/FreeThrow-v0")
    >>> observation, info = env.reset(seed=1)
    >>> action = env.unwrapped.course.action_of({"launch.speed": 7.4, "launch.angle": 52.0})
    >>> observation, reward, terminated, truncated, info = env.step(action)
    >>> terminated, "entry_angle" in info
    (True, True)
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array"], "render_fps": 1}  # type: ignore[misc]

    def __init__(
        self,
        task: str | Task,
        render_mode: str | None = None,
        noise: bool = True,
        facts: Sequence[str] | None = None,
        size: tuple[int, int] = _SIZE,
        accuracy: str | None = None,
    ) -> None:
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise RequestError(f'render_mode = {render_mode!r}: must be "rgb_array", or None')
        check_size(f"size = {size}", size)
        self.course = Course(task, facts, noise, accuracy)
        self.render_mode, self._size = render_mode, size
        self.action_space: Any = self.course.action_space
        self.observation_space: Any = self.course.observation_space
        self._is_going_on = False
        self._drawn: list[Any] = []  # what is drawn at the start, in the order of the task
        self._scene: Scene | None = None  # of the next shot of an attempt; None before its first
        self._shots = 0
        self._run: SceneRun | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an attempt; the same seed draws the same start, and the same noise after it. Raises RequestError for a
        start that the task does not draw, and for a seed that is none."""
        super().reset(seed=seed_of(seed))
        self._drawn = self.course.drawn(self.np_random, options)
        self._is_going_on, self._scene, self._shots, self._run = True, None, 0, None
        return self.course.next_observation(self._drawn, self._scene), {}

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Play a shot. A run that cannot be completed ends the attempt, and ``info["error"]`` says why. Raises
        RequestError for an action that is none, and ResetNeeded before an attempt and after its end."""
        if not self._is_going_on:
            raise ResetNeeded("reset the environment before its first step, and where an attempt is over")
        course, task = self.course, self.course.task
        values = dict(zip(task.defaults, course.controls_of(action).tolist(), strict=True))
        aimed = task.aimed(values, self.np_random if course.noise else None)
        self._shots += 1
        try:
            run = course.shot(self._scene, self._drawn, aimed)
        except (RunError, RequestError) as error:
            self._is_going_on = False
            info = {"error": str(error), "is_success": False, "controls": aimed}
            return course.next_observation(self._drawn, self._scene), task.reward(None, over=True), True, False, info
        self._run = run
        worth = task.score.of_shot(run.result)
        over, made = task.is_over(run.result, self._shots), task.is_made(worth)
        self._is_going_on = not over
        if not over:
            self._scene = task.after(run)
        info = {**run.result, "is_success": made, "controls": aimed}
        return course.next_observation(self._drawn, self._scene), task.reward(worth, over), over, False, info

    def render(self) -> Any:
        """The frame of the last shot, at its end; before the first, of the start. Array of shape (height, width, 3)."""
        if self.render_mode is None:
            return None
        run, t = self._run, 0.0
        if run is None:
            defaults = list(self.course.task.defaults.values())
            run = simulate(self._scene or self.course.scene_of(self.course.parameters(self._drawn, defaults)))
        else:
            t = run.duration
        return np.asarray(run.frame(t, self._size).convert("RGB"))
