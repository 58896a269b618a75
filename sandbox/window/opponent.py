"""An opponent at the computer: it tries shots at whatever can be aimed at, takes the one that is worth most to it with
the scatter of its own aim, and shoots with that scatter."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Future
from typing import Any

import numpy as np

from sandbox.lab.runs import runs
from sandbox.lab.scatter import scattered
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun
from sandbox.tasks.match import Match
from sandbox.window.background import Workers
from sandbox.window.find import questions
from sandbox.window.session import Session

#: The most shots that it tries, and of how many of them it finds out what its scatter makes of them, by so many shots.
_TRIED, _BEST, _SCATTERED = 90, 4, 5


def outcomes(
    scene: Scene, keys: Sequence[str], rows: Sequence[Sequence[float]], facts: Sequence[str]
) -> list[dict[str, Any] | None]:
    """The facts of a scene with the values of each row at these keys; None for a run that failed."""
    found = runs(scene, keys, rows, asked=facts)
    return [{fact: run.result[fact] for fact in facts} if isinstance(run, SceneRun) else None for run in found]


class Opponent:
    """Looks for the next shot of a match, in the helper; ``values`` has it once it is found."""

    def __init__(
        self, session: Session, match: Match, width: float, upright: bool, workers: Workers, seed: int
    ) -> None:
        """Its scatter is ``width`` times that of a practised player."""
        self.scene, self.match, self.width, self.workers = session.scene, match, width, workers
        self.random = np.random.default_rng(seed)
        self.values: dict[str, float] | None = None
        goals = [goal.vary for question in questions(session, upright) for goal in question.goals]
        keys = list(goals[0]) if goals else []
        goals = [vary for vary in goals if list(vary) == keys]
        each = max(2, _TRIED // max(1, len(goals)))
        self.keys = keys
        self.rows = [[float(self.random.uniform(*vary[key])) for key in keys] for vary in goals for _ in range(each)]
        self.work: Future[Any] | None = None
        self._scatters = False
        if self.rows:
            self._ask()
        else:
            self.values = {}  # as the match has it at first

    def _ask(self) -> None:
        self.work = self.workers.helper.submit(outcomes, self.scene, self.keys, self.rows, self.match.facts)

    def advance(self) -> None:
        """Go on with what was computed."""
        if self.work is None or not self.work.done():
            return
        found, self.work = self.work.result(), None
        worths = [self.match.value(each) if each is not None else -np.inf for each in found]
        if self._scatters:
            means = np.mean(np.reshape(worths, (-1, _SCATTERED)), axis=1)
            self._take(self.rows[int(np.argmax(means)) * _SCATTERED])  # of each the first is without scatter
            return
        best = np.argsort(worths)[::-1][:_BEST]
        self.rows = [self._scattered(self.rows[place], count) for place in best for count in range(_SCATTERED)]
        self._scatters = True
        self._ask()

    def _scattered(self, row: Sequence[float], count: int) -> list[float]:
        values = dict(zip(self.keys, row, strict=True))
        if count:
            values |= scattered(self.scene.changed(values), self.random, self.width, self.keys)
        return [values[key] for key in self.keys]

    def _take(self, row: Sequence[float]) -> None:
        self.values = {**self.scene.controls.set_on_pull, **dict(zip(self.keys, row, strict=True))}
