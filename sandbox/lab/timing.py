"""Several runs timed in turns, so that whatever else the machine does affects all of them alike."""

from __future__ import annotations

import gc
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from time import perf_counter
from typing import Generic, TypeVar

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.setup import Setup
from sandbox.engine.paths.run import Run
from sandbox.lab.runs import Progress, no_progress
from sandbox.tracebacks import one_line_error

#: Most runs of each that count, after a first one that only warms caches. The shortest counts, since other load only
#: adds time.
REPEATS = 15

Seen = TypeVar("Seen")


@dataclass
class Timed(Generic[Seen]):
    """A setup to run several times: how long that takes, and what ``look`` saw in the first run."""

    setup: Setup
    accuracy: Accuracy
    look: Callable[[Run], Seen]
    seen: Seen | None = None
    walls: list[float] = field(default_factory=list)  # s, of all runs, the first among them
    problem: str = ""  # why it could not be completed

    def run(self) -> None:
        started = perf_counter()
        try:
            run = simulate(self.setup, self.accuracy)
        except Exception as error:  # of the scene's own code, too
            self.problem = one_line_error(error)
            return
        finally:
            self.walls.append(perf_counter() - started)
        if self.seen is None:
            self.seen = self.look(run)

    @property
    def warm(self) -> list[float]:
        """The times in s that count: all but the first, unless there is no other."""
        return self.walls[1:] or self.walls

    @property
    def wall(self) -> float:
        """The shortest time in s."""
        return min(self.warm)

    @property
    def noise(self) -> float:
        """The fraction by which the third shortest time is longer than the shortest."""
        first, *others = sorted(self.warm)[:3]
        return others[-1] / first - 1.0 if others else 0.0


def repeat(trials: Sequence[Timed[Seen]], patience: float = float("inf"), progress: Progress = no_progress) -> None:
    """Run each several times, for ``patience`` s at most, except those that fail.

    Each turn starts with another trial: the first run after the garbage is collected takes longer than the same run
    later in the turn. Collections skip what is there already: going through it takes longer than most turns.
    """
    frozen_before = gc.get_freeze_count() > 0
    gc.freeze()
    gc.disable()
    try:
        for turn in range(REPEATS + 1):
            progress(turn, REPEATS + 1)
            first = turn % len(trials)
            gc.collect()
            for trial in (*trials[first:], *trials[:first]):
                if not trial.problem and len(trial.walls) <= REPEATS and sum(trial.walls) < patience:
                    trial.run()
    finally:
        gc.enable()
        if not frozen_before:
            gc.unfreeze()
