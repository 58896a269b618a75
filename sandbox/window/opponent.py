"""An opponent at the computer: it tries shots at whatever can be aimed at, takes the one that is worth most to it with
the scatter of its own aim, and shoots with that scatter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from time import perf_counter
from typing import Any

import numpy as np

from sandbox.lab.runs import columns_at
from sandbox.lab.scatter import scattered
from sandbox.scene import Scene
from sandbox.tasks.match import Match
from sandbox.window.background import Workers
from sandbox.window.find import questions
from sandbox.window.session import Session

#: The most shots that it tries, so many at a time; and of how many of them it finds out what its scatter makes of them,
#: by as many shots of each.
_TRIED, _AT_A_TIME, _BEST = 90, 10, 6
#: It takes the best so far after so many s.
_PATIENCE = 4.0


def outcomes(
    scene: Scene, keys: Sequence[str], rows: Sequence[Sequence[float]], facts: Sequence[str]
) -> list[dict[str, Any] | None]:
    """The facts of a scene with the values of each row at these keys; None for a run that failed."""
    return columns_at(scene, keys, rows, asked=facts).results()


class Opponent:
    """Looks for the next shot of a match, in the helper; ``values`` has it once it is found."""

    def __init__(
        self, session: Session, match: Match, width: float, upright: bool, workers: Workers, seed: int
    ) -> None:
        """Its scatter is ``width`` times that of a practised player."""
        self.scene, self.match, self.width, self.workers = session.scene, match, width, workers
        self.random = np.random.default_rng(seed)
        self.values: dict[str, float] | None = None
        goals = [goal for question in questions(session, upright) for goal in question.goals]
        ranges = [goal.vary for goal in goals if match.allows(goal.wanted)] or [goal.vary for goal in goals]
        self.keys = list(ranges[0]) if ranges else []
        ranges = [vary for vary in ranges if list(vary) == self.keys]
        self.left = self._tries(ranges, max(2, _TRIED // max(1, len(ranges))))
        self.tried: list[tuple[float, list[float]]] = []  # what each is worth, and its values
        self.work: Future[Any] | None = None
        self.scatters, self.asked = False, self.left
        self._until = perf_counter() + _PATIENCE
        if self.left:
            self._ask()
        else:
            self.values = {}  # as the match has it at first

    def _tries(self, ranges: Sequence[Mapping[str, tuple[float, float]]], each: int) -> list[list[float]]:
        """So many shots in each of some ranges, spread over them evenly; the first of all before the second."""
        parts = [{key: self.random.permutation(each) for key in self.keys} for _ in ranges]
        return [
            [low + (high - low) * float(part[key][place] + self.random.random()) / each
             for key, (low, high) in vary.items()]
            for place in range(each) for part, vary in zip(parts, ranges, strict=True)
        ]  # fmt: skip

    def _ask(self) -> None:
        """Have the next few shots computed."""
        self.asked, self.left = self.left[:_AT_A_TIME], self.left[_AT_A_TIME:]
        self.work = self.workers.helper.submit(outcomes, self.scene, self.keys, self.asked, self.match.facts)

    def advance(self) -> None:
        """Go on with what was computed."""
        if self.work is None or not self.work.done():
            return
        found, self.work = self.work.result(), None
        worths = [self.match.value(each) if each is not None else -np.inf for each in found]
        if self.scatters:
            self.tried.append((float(np.mean(worths)), self.asked[0]))  # the first is without scatter
        else:
            self.tried += zip(worths, self.asked, strict=True)
        if not self.left and not self.scatters:
            best = sorted(self.tried, key=lambda tried: -tried[0])[:_BEST]
            self.left = [self._scattered(row, count) for _, row in best for count in range(_AT_A_TIME)]
            self.scatters, self.tried = True, []
        if self.left and (perf_counter() < self._until or not self.tried):
            self._ask()
        else:
            self._take(max(self.tried, key=lambda tried: tried[0])[1])

    def _scattered(self, row: Sequence[float], count: int) -> list[float]:
        values = dict(zip(self.keys, row, strict=True))
        if count:
            values |= scattered(self.scene.changed(values), self.random, self.width, self.keys)
        return [values[key] for key in self.keys]

    def _take(self, row: Sequence[float]) -> None:
        self.values = {**self.scene.controls.set_on_pull, **dict(zip(self.keys, row, strict=True))}
