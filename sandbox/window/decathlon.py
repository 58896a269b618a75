"""A decathlon: a task in each of ten sports, one after the other, and one number at the end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun
from sandbox.tasks import load
from sandbox.window.contest import AtTask, Contest, Entries, Kept

#: The number of its events.
EVENTS = 10


class Decathlon(Contest):
    """Tasks in turn; what each is worth is ``Task.points``, 1000 at most."""

    name = "decathlon"
    goal = "Ten sports, one number"

    def __init__(self, tasks: Sequence[str], seed: int | None = None) -> None:
        """``tasks`` are the names of the events."""
        self.tasks, self.seed = tasks, seed
        self.place = 0  # of the event that is played, or was last
        self.points: list[int] = []  # of the events that are over
        self.event = self._event()

    def _event(self) -> AtTask:
        return AtTask(load(self.tasks[self.place]), seed=self.seed)

    def go_on(self) -> None:
        if self.event.over and not self.over:
            self.place += 1
            self.event = self._event()

    @property
    def path_shown(self) -> str:  # type: ignore[override]
        """The part of the path that its event shows."""
        return self.event.path_shown

    @property
    def scene(self) -> Scene:
        return self.event.scene

    @property
    def limits(self) -> Mapping[str, tuple[float, float]]:
        return self.event.limits

    def aimed(self, scene: Scene) -> Scene:
        return self.event.aimed(scene)

    def would_score(self, run: SceneRun) -> bool:
        return self.event.would_score(run)

    def record(self, run: SceneRun) -> None:
        event = self.event
        event.record(run)
        self.said, self.good, self.counts = event.said, event.good, event.counts
        if event.over:
            self.points.append(event.task.points(event.session.total))
            self.counts = f"{self.points[-1]} points in event {len(self.points)} of {len(self.tasks)}"

    def anew(self) -> Decathlon:
        return Decathlon(self.tasks, self.seed)

    @property
    def over(self) -> bool:
        return len(self.points) == len(self.tasks)

    @property
    def total(self) -> int:
        """The points so far."""
        return sum(self.points)

    @property
    def headline(self) -> str:
        return self.event.headline

    @property
    def stand(self) -> str:
        return f"event {self.place + 1} of {len(self.tasks)}, {self.event.stand}"

    @property
    def entries(self) -> Entries:
        return [*self.event.entries, ("points", f"{self.total:,}")]

    @property
    def outcome(self) -> list[str]:
        each = ", ".join(f"{points:,}" for points in self.points)
        return [self.score_text(self.total), f"{each}, of {1000 * len(self.tasks):,}"]

    @property
    def kept(self) -> Kept:
        return Kept(float(self.total), 0, lower_is_better=False)

    def score_text(self, score: float) -> str:
        return f"{score:,.0f} points"
