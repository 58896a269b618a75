"""A session: the attempts of one player at a task, scored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from sandbox.errors import RequestError
from sandbox.scene import simulate
from sandbox.tasks.task import Task

if TYPE_CHECKING:
    from sandbox.scene.scene import Scene
    from sandbox.scene.scene_run import SceneRun

#: The stream of random numbers of a player's aim, next to those of the starts.
_AIM = 1


@dataclass(frozen=True)
class Shot:
    """One shot that was played."""

    values: Mapping[str, float]  # what the player set, by key
    run: SceneRun  # of what became of it, with the noise of his aim
    worth: float | None  # what it counts, see Score
    made: bool

    @property
    def verdict(self) -> str:
        """The verdict, in a sentence."""
        return self.run.scene.verdict(self.run)


@dataclass
class Attempt:
    """One attempt: a start and the shots from there, most often one."""

    number: int  # from 1
    start: Mapping[str, Any]  # what was drawn
    shots: list[Shot] = field(default_factory=list)
    worth: float | None = None
    over: bool = False

    @property
    def made(self) -> bool:
        """True if its last shot was a success."""
        return bool(self.shots) and self.shots[-1].made


class Session:
    """The attempts of one player at a task.

    The same seed gives the same starts, so that two players with a session each meet the same; ``player`` has the
    noise of his own aim. The window computes runs by itself: ``aimed`` gives the scene to run and ``record`` takes the
    run; ``shoot`` does both.

    >>> from sandbox.tasks import Session, load
    >>> session = Session(load("free-throw"), seed=7)
    >>> shot = session.shoot({"launch.speed": 5.0, "launch.angle": 50.0})
    >>> shot.made, session.left, session.total
    (False, 4, 0.0)
    """

    def __init__(self, task: Task, seed: int = 0, player: int = 0, *, noise: bool = True) -> None:
        self.task, self.seed, self.player, self.noise = task, seed, player, noise
        self.attempts: list[Attempt] = []  # those begun, the last may not be over
        self.scene: Scene  # of the next shot, with the controls at their defaults
        self._begin()

    def _begin(self) -> None:
        number = len(self.attempts) + 1
        self.scene = self.task.at_start(self.seed, number)
        self.attempts.append(Attempt(number, self.task.drawn_for(self.seed, number)))

    @property
    def attempt(self) -> Attempt:
        """The one that is played, or the last."""
        return self.attempts[-1]

    @property
    def over(self) -> bool:
        """True if no attempt is left."""
        return self.attempt.over and len(self.attempts) == self.task.attempts

    @property
    def left(self) -> int:
        """The number of attempts that are not over yet."""
        return self.task.attempts - sum(attempt.over for attempt in self.attempts)

    @property
    def total(self) -> float | None:
        """The score so far."""
        return self.task.score.total([attempt.worth for attempt in self.attempts if attempt.over])

    @property
    def streak(self) -> int:
        """The number of shots in a row, up to the last, that were made."""
        count = 0
        for shot in reversed([shot for attempt in self.attempts for shot in attempt.shots]):
            if not shot.made:
                break
            count += 1
        return count

    @property
    def result(self) -> str:
        """The score in words, and at the end whether it passes: ``4 of 5 made: passed``."""
        score, played = self.task.score, [attempt.worth for attempt in self.attempts if attempt.over]
        said = score.total_text(played, self.task.shots)
        if not self.over:
            return f"{said} so far"
        enough = score.number(self.task.passing) + " or less" * score.lower_is_better
        return f"{said}: passed" if self.passed else f"{said}: {enough} needed to pass"

    @property
    def passed(self) -> bool:
        """True if the task is passed: at its end, since then alone a score is final."""
        return self.over and self.task.passed(self.total)

    @property
    def stars(self) -> int:
        """The stars, 0 to 3: those for the score at the end, and none before."""
        return self.task.stars_for(self.total) if self.over else 0

    def aimed(self, values: Mapping[str, float]) -> Scene:
        """The scene of the next shot with what becomes of these values; the same again if asked again. Raises
        RequestError if the session is over, or for a control that the task does not have."""
        from numpy.random import default_rng

        if self.over:
            raise RequestError(f"{self.task.name}: all {self.task.attempts} attempts are played")
        place = [self.seed, self.attempt.number, len(self.attempt.shots), self.player, _AIM]
        return self.scene.changed(self.task.aimed(values, default_rng(place) if self.noise else None), "controls")

    def record(self, values: Mapping[str, float], run: SceneRun) -> Shot:
        """Count a shot: the run of ``aimed(values)``; then the next attempt begins, or the next shot of this one."""
        task, attempt = self.task, self.attempt
        worth = task.score.of_shot(run.result)
        shot = Shot(dict(values), run, worth, task.is_made(worth))
        attempt.shots.append(shot)
        attempt.over = task.is_over(run.result, len(attempt.shots))
        if attempt.over:
            attempt.worth = task.score.of_attempt([shot.worth for shot in attempt.shots], task.shots)
            if len(self.attempts) < task.attempts:
                self._begin()
        else:
            self.scene = task.after(run)
        return shot

    def shoot(self, values: Mapping[str, float]) -> Shot:
        """Play the next shot with these values of the controls. Raises RequestError."""
        return self.record(values, simulate(self.aimed(values)))
