"""A shot that is simulated as it is played: keys that the player holds move something at once."""

from __future__ import annotations

import numpy as np

from sandbox.errors import RunError, SandboxError
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun
from sandbox.scene.world import World
from sandbox.window.history import Changes
from sandbox.window.shots import LONGEST_FRAME, STEP, Playback, Shot

#: So much of the path is drawn behind the ball, in s, at so many points.
_TRAIL, _POINTS = 0.25, 16


class _LiveShot(Shot):
    """A shot so far."""

    def track(self, ball: str) -> np.ndarray:
        """Points of the last part of a ball's path."""
        end = self.run.duration
        times = np.linspace(max(0.0, end - _TRAIL), end, _POINTS)
        return np.column_stack([times, self.run.states(ball, times)[:, :2]])


class Live(Playback):
    """The clock of a shot that is played live: its time is that of a world."""

    def __init__(self, scene: Scene, changes: Changes) -> None:
        """The keys are not held yet, whatever the scene file says."""
        self._held: dict[str, list[tuple[float, float]]] = {held.times: [] for held in scene.controls.held}
        self._down = dict.fromkeys(self._held, False)
        self._changes = changes
        self._world = World(scene.changed(self._held, "the window's"))
        self.error: SandboxError | None = None  # by which it ended
        super().__init__(self._shot(), 1.0)

    def _shot(self) -> Shot:
        run = self._world.run()
        assert isinstance(run, SceneRun)
        times = {key: [list(pair) for pair in held] for key, held in self._held.items()}
        return _LiveShot(run.scene, run, self._changes._replace(values={**self._changes.values, **times}))

    @property
    def whole(self) -> Shot:
        """The shot, once it is over."""
        return Shot(self.shot.scene, self.shot.run, self.shot.changes)

    @property
    def over(self) -> bool:
        world = self._world
        caught = not world.state
        return self.error is not None or caught or world.ended in ("until", "duration")

    def hold(self, key: str, down: bool) -> bool:
        """The player presses a key, or lets it go; returns whether it is one that moves something."""
        scene = self.shot.scene
        name = next((held.times for held in scene.controls.held if held.key == key), None)
        if name is None:
            return False
        self._down[name] = down
        self._move(name)
        return True

    def let_go(self) -> None:
        """The player lets go of all keys."""
        for held in self.shot.scene.controls.held:
            self.hold(held.key, down=False)

    def _move(self, name: str) -> None:
        """Move what a key moves, if that is not done; what was pressed at this very time is let go a frame later."""
        times, t, down = self._held[name], self._world.t, self._down[name]
        was_down = bool(times) and times[-1][1] > t
        if down == was_down or self.over or (times and t <= times[-1][0 if was_down else 1]):
            return
        new = [*times, (t, self.shot.run.setup.duration)] if down else [*times[:-1], (times[-1][0], t)]
        try:
            self._world.apply({name: new})
        except SandboxError as error:
            self.error = error
        else:
            self._held[name] = new

    def advance(self, dt: float) -> None:
        if self.playing and not self.over:
            self._go_on(min(dt, LONGEST_FRAME) * self.rate)
        self.playing = self.playing and not self.over

    def _go_on(self, dt: float) -> None:
        try:
            self._world.step(dt)
        except RunError as error:
            self.error = error
        for name in self._held:
            self._move(name)
        self.shot = self._shot()
        self.t = self.duration = self.shot.run.duration

    def step(self, steps: int) -> None:
        """On only: what is played live has not happened yet."""
        self.playing = False
        if steps > 0 and not self.over:
            self._go_on(steps * STEP)

    def restart(self) -> None:
        self.playing = True

    def seek(self, t: float) -> None:
        """Not before it is over."""
