"""Contests in the window: a task, alone or by two, or a match by the rules of a game.

A contest gives the scene of the next shot, what the player may set and how much of the path he sees; it has the noise
of his aim, and is told what came of each shot. It knows nothing of the window.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sandbox import tasks
from sandbox.errors import RequestError
from sandbox.lab.scatter import scattered
from sandbox.parameters import value_at, walk
from sandbox.scene import Scene, load
from sandbox.scene.discovery import is_installed
from sandbox.scene.scene_run import SceneRun
from sandbox.tasks.daily import seed_of_day, task_of_day
from sandbox.tasks.games import game_names, game_of
from sandbox.tasks.match import PLAYERS, Match

#: What the player may set, by key: bounds, in the parameter's unit.
_Limits = Mapping[str, tuple[float, float]]
#: How strong an opponent at the computer may be, and how many times as wide as a practised player's its scatter is.
STRENGTHS = {"easy": 6.0, "medium": 2.5, "hard": 0.7}
#: Labels and texts of a card.
Entries = list[tuple[str, str]]


def source_of(scene: Scene) -> str:
    """The name by which a scene can be opened again: its own, or the folder it is in."""
    return scene.title if is_installed(scene.folder) else str(scene.folder)


class Kept(NamedTuple):
    """The entry that the best list keeps of a contest."""

    score: float
    stars: int
    lower_is_better: bool
    flight: Mapping[str, Any] | None = None  # the changes of the scene that make its best shot


class Contest:
    """Something that is played for, shot by shot."""

    name = ""  # of the task, or scene and game
    goal = ""  # in one sentence
    path_shown = "all"  # of the path: as tasks have it
    said = ""  # what came of the last shot, in a sentence
    good = False  # whether that was a success
    counts = ""  # what the last shot counts, where its sentence may not say so
    takes_marks = False  # whether the player marks where the ball will land, before he shoots
    mark: tuple[float, float] | None = None  # m
    landed: tuple[float, float] | None = None  # m, of the shot that is over

    @property
    def title(self) -> str:
        """Its name for people."""
        return Path(self.name).stem if Path(self.name).is_absolute() else self.name

    @property
    def scene(self) -> Scene:
        """The scene of the next shot, before the player aims."""
        raise NotImplementedError

    @property
    def limits(self) -> _Limits | None:
        """The parameters that the player may set, with their bounds; None for everything."""
        raise NotImplementedError

    @property
    def aimed_by_panel(self) -> bool:
        """True if the player sets something that no pull, wheel or handle does."""
        controls = self.scene.controls
        easy = {controls.speed, controls.angle, *(spin.key for spin in controls.spins)}
        dragged = {key for handle in controls.handles for key in (handle.x, handle.y)}
        return any(key not in easy and re.sub(r"\[\d+\]", "[*]", key) not in dragged for key in self.limits or ())

    @property
    def in_hand(self) -> bool:
        """True if the player may place the ball that he plays."""
        return False

    @property
    def missing(self) -> str:
        """An instruction for the player before he may shoot, "" if there is none."""
        return ""

    def go_on(self) -> None:
        """Turn to the next shot: what came of the last one was seen."""

    def put(self, place: tuple[float, float]) -> None:
        """Mark a place, in m."""

    def aimed(self, scene: Scene) -> Scene:
        """The scene of the shot that the player has aimed, with the noise of his aim."""
        raise NotImplementedError

    def would_score(self, run: SceneRun) -> bool:
        """True if a shot is a success, before it is recorded."""
        raise NotImplementedError

    def call(self, run: SceneRun) -> tuple[str, bool]:
        """The verdict on a shot before it is recorded, in a sentence, and whether it is a success."""
        return run.scene.verdict(run), self.would_score(run)

    def decided_at(self, run: SceneRun) -> float | None:
        """The time in s at which a shot is decided; None for when the scene's score is final."""
        return None

    def record(self, run: SceneRun) -> None:
        """Count a shot."""
        raise NotImplementedError

    def anew(self) -> Contest:
        """The same from its beginning, with other starts."""
        raise NotImplementedError

    @property
    def over(self) -> bool:
        """True if no shot is left."""
        raise NotImplementedError

    @property
    def headline(self) -> str:
        """The task at hand, in a sentence."""
        return self.goal

    @property
    def stand(self) -> str:
        """The attempt that it is, or what else the player should know now, in a few words."""
        raise NotImplementedError

    @property
    def entries(self) -> Entries:
        """Scores, as labels and texts."""
        raise NotImplementedError

    @property
    def marked(self) -> int:
        """The place among the scores of the one that is highlighted: of two players that whose turn it is."""
        return 0

    @property
    def table(self) -> Entries:
        """More of what was collected."""
        return []

    @property
    def following(self) -> str:
        """The name of the task that comes next, "" if there is none."""
        return ""

    @property
    def best_shots(self) -> Sequence[int]:
        """The best shots by number, from 0, the best first: three at most."""
        return ()

    @property
    def stars(self) -> int | None:
        """The stars at the end, from 0 to 3; None where there are none."""
        return None

    @property
    def outcome(self) -> list[str]:
        """The result at the end, in lines."""
        return [self.said]

    @property
    def kept(self) -> Kept | None:
        """The entry for the best list at the end; None for nothing."""
        return None

    def score_text(self, score: float) -> str:
        """A score of the best list, in words."""
        return f"{score:g}"


class AtTask(Contest):
    """A task, played alone, or by two who take turns at the same starts."""

    def __init__(self, task: tasks.Task, players: int = 1, seed: int | None = None) -> None:
        self.task, self.players = task, players
        self.seed = int(np.random.default_rng().integers(2**31)) if seed is None else seed
        self.sessions = [tasks.Session(task, self.seed, player) for player in range(players)]
        self.turn = 0
        installed = task.name in tasks.tasks() and tasks.find_task(task.name) == task.file
        self.name = task.name if installed else str(task.file.resolve())  # by which its best list is kept
        self.goal, self.path_shown = task.goal, task.shown
        self.worths: list[float | None] = []  # of each shot
        self._flights: list[dict[str, Any]] = []  # the changes of the task's scene that make each
        self._set: dict[str, float] = {}  # by the player, for the shot that is on its way

    @property
    def session(self) -> tasks.Session:
        """The one whose turn it is."""
        return self.sessions[self.turn]

    @property
    def scene(self) -> Scene:
        return self.session.scene

    @property
    def limits(self) -> _Limits:
        return {control.key: (control.low, control.high) for control in self.task.controls}

    def _values(self, scene: Scene) -> dict[str, float]:
        return {key: value_at(scene.parameters, key) for key in self.task.defaults}

    def aimed(self, scene: Scene) -> Scene:
        self._set = self._values(scene)
        return self.session.aimed(self._set)

    def would_score(self, run: SceneRun) -> bool:
        return self.task.is_made(self.task.score.of_shot(run.result))

    def record(self, run: SceneRun) -> None:
        session, attempt = self.session, self.session.attempt
        shot = session.record(self._set, run)
        self.worths.append(shot.worth)
        keys = [*(start.key for start in self.task.start), *self.task.defaults]
        first = len(attempt.shots) == 1  # a later one begins where the balls lie
        self._flights.append({key: value_at(run.scene.parameters, key) for key in keys} if first else {})
        self.said, self.good, self.counts = shot.verdict, shot.made, self.task.score.shot_text(shot.worth)
        if self.players > 1:
            self.said = f"{PLAYERS[self.turn]}: {self.said}"
        if attempt.over and not self.over:
            self.turn = next(
                other for step in range(1, self.players + 1)
                if not self.sessions[other := (self.turn + step) % self.players].over
            )  # fmt: skip

    def anew(self) -> AtTask:
        return AtTask(self.task, self.players)

    @property
    def over(self) -> bool:
        return all(session.over for session in self.sessions)

    @property
    def stand(self) -> str:
        session, task = self.session, self.task
        said = f"attempt {session.attempt.number} of {task.attempts}"
        if task.shots > 1:
            said += f", shot {len(session.attempt.shots) + 1} of at most {task.shots}"
        return said

    @property
    def headline(self) -> str:
        return self.goal if self.players == 1 else f"{PLAYERS[self.turn]}: {self.goal[0].lower()}{self.goal[1:]}"

    def written(self, score: float | None) -> str:
        """A score as a number."""
        return "-" if score is None else self.task.score.number(score)

    @property
    def entries(self) -> Entries:
        if self.players > 1:
            return [(PLAYERS[i], self.written(session.total)) for i, session in enumerate(self.sessions)]
        session = self.session
        return [
            ("attempts left", str(session.left)),
            ("score", self.written(session.total)),
            ("to pass", self.written(self.task.passing)),
            ("for 1, 2, 3 stars", ", ".join(map(self.written, self.task.stars))),
        ]

    @property
    def marked(self) -> int:
        return self.turn

    @property
    def best_shots(self) -> Sequence[int]:
        return self.task.score.best_shots(self.worths)[:3]

    @property
    def following(self) -> str:
        names = tasks.tasks()
        after = names[names.index(self.name) + 1 :] if self.players == 1 and self.name in names else []
        return next((name for name in after if tasks.find_task(name).parent == self.task.file.parent), "")

    @property
    def stars(self) -> int | None:
        return self.sessions[0].stars if self.players == 1 else None

    @property
    def outcome(self) -> list[str]:
        totals, score = [session.total for session in self.sessions], self.task.score
        if self.players == 1:
            return [self.session.result]
        first, second = totals
        ahead = [second is None or (first is not None and score.reaches(first, second)),
                 first is None or (second is not None and score.reaches(second, first))]  # fmt: skip
        said = "A draw" if all(ahead) else f"{PLAYERS[ahead.index(True)]} wins"
        return [f"{said}: {self.written(first)} to {self.written(second)}"]

    @property
    def kept(self) -> Kept | None:
        session = self.session
        if self.players > 1 or session.total is None:
            return None
        best = next((self._flights[place] for place in self.best_shots if self._flights[place]), None)
        return Kept(session.total, session.stars, self.task.score.lower_is_better, best)

    def score_text(self, score: float) -> str:
        return self.task.score.text(score)


class AtTaskOfDay(AtTask):
    """The task of a day, with the same starts for everybody."""

    def __init__(self, day: date) -> None:
        super().__init__(tasks.load(task_of_day(day)), seed=seed_of_day(day))
        self.day, self.name = day, self.name_of(day)

    @staticmethod
    def name_of(day: date) -> str:
        """The name by which its best list is kept."""
        return f"{day.isoformat()} {task_of_day(day)}"

    def anew(self) -> AtTaskOfDay:
        return AtTaskOfDay(self.day)


class AtMatch(Contest):
    """A match of two, by the rules of a game of a scene, each with the aim of a practised player."""

    def __init__(
        self, folder: Path, game: str, match: Match | None = None, seed: int | None = None, opponent: int = 0
    ) -> None:
        """Against a person, or an ``opponent`` at the computer, by its strength from 1 to 3. Raises RequestError for a
        game that the scene does not have, and a module that is none."""
        known = game_names(folder)
        if game not in known:
            raise RequestError(
                f"{folder.name} has no game {game}; " + (f"it has {', '.join(known)}" if known else "it has none")
            )
        self.folder, self.game = folder, game
        rules = game_of(folder, game)
        players = (PLAYERS[0], "Computer") if opponent else rules.players  # such as Red and Yellow
        self.match = rules(players=players, opponent=opponent) if match is None else match
        self.random = np.random.default_rng(seed)
        here = source_of(load(folder.name if is_installed(folder) else str(folder)))
        self.base = load("/".join(filter(None, (here, rules.preset))))
        self.name, self.goal, self.path_shown = f"{folder.name}/{game}", rules.goal, rules.shown

    @property
    def scene(self) -> Scene:
        return self.base.changed(self.match.start, self.match.title)

    @property
    def limits(self) -> _Limits:
        controls, known = self.base.controls, {it.key: it for it in walk(self.scene.parameters, entries=True)}
        keys = [controls.speed, controls.angle, *(spin.key for spin in controls.spins), *self.match.free]
        found = {key: known[key].bounds for key in keys if key in known}
        if self.match.placement_area is not None:
            x0, y0, x1, y1 = self.match.placement_area
            found |= dict(zip(self.match.free, ((x0, x1), (y0, y1)), strict=False))
        return found

    def aimed(self, scene: Scene) -> Scene:
        values = scattered(scene, self.random, self.width)
        for key, sd in self.match.scatter.items():
            known = next(it for it in walk(scene.parameters) if it.key == key)
            values[key] = known.within(float(self.random.normal(known.value, sd)))
        return scene.changed(values, "aim")

    @property
    def width(self) -> float:
        """The scatter of the player whose turn it is, in that of a practised one."""
        return [*STRENGTHS.values()][self.match.opponent - 1] if self.match.by_computer else 1.0

    @property
    def in_hand(self) -> bool:
        return bool(self.match.free)

    def would_score(self, run: SceneRun) -> bool:
        after = self.match.after(run.result)
        return bool(run.result.get(run.scene.controls.scores)) and not after.foul

    def call(self, run: SceneRun) -> tuple[str, bool]:
        after = self.match.after(run.result)
        if not after.foul:
            return super().call(run)
        follows = after.placing.partition(":")[0]
        return f"Foul: {after.foul}" + (f". {follows[0].upper()}{follows[1:]}" if follows else ""), False

    def record(self, run: SceneRun) -> None:
        self.good = self.would_score(run)
        self.match = self.match.after(run.result)
        self.said = self.match.said

    def anew(self) -> AtMatch:
        new = replace(game_of(self.folder, self.game)(), players=self.match.players, opponent=self.match.opponent)
        return AtMatch(self.folder, self.game, new)

    @property
    def over(self) -> bool:
        return self.match.finished

    @property
    def stand(self) -> str:
        return self.match.placing or self.goal

    @property
    def headline(self) -> str:
        return self.match.status

    @property
    def entries(self) -> Entries:
        return list(zip(self.match.players, self.match.scores, strict=True))

    @property
    def marked(self) -> int:
        return self.match.turn if self.match.winner is None else self.match.winner

    @property
    def outcome(self) -> list[str]:
        return [self.match.status, self.match.said]
