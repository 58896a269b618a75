"""Tasks and matches that are being played, in a process that computes: found again from the shots so far."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

from sandbox.files import json_text
from sandbox.picture.path import first_impact, points, time_after
from sandbox.scene import Scene
from sandbox.scene import load as load_scene
from sandbox.scene.scene_run import SceneRun
from sandbox.serve.calls import Ask, Duel, Game
from sandbox.tasks import Session, Task, load
from sandbox.tasks.games import game_of
from sandbox.window.contest import AtMatch

#: So many sessions are kept; another is played again up to where it is.
_KEPT = 64

_sessions: dict[tuple[str, str], Session] = {}  # by task and game


@lru_cache(maxsize=64)
def task_of(source: str) -> Task:
    """The task of that name, or in that file. Raises RequestError."""
    return load(source)


class InTask:
    """A player's session at a task, at the shot that comes next."""

    def __init__(self, ask: Ask, game: Game) -> None:
        self.ask, self.game, self.session = ask, game, _session_of(ask, game)
        self.path_shown: str = self.session.task.shown

    def scene(self) -> Scene:
        """The scene of the shot that is aimed, without the noise of the aim. Raises RequestError."""
        return self.session.scene.changed(self.session.task.aimed(dict(self.ask.changes)), "")

    def aimed(self) -> Scene:
        """The scene of the shot that is let go. Raises RequestError."""
        return self.session.aimed(dict(self.ask.changes))

    def call(self, run: SceneRun) -> tuple[str, bool]:
        """The verdict on a shot, and whether it is a success, before it is recorded."""
        score = self.session.task.score
        return run.scene.verdict(run), self.session.task.is_made(score.of_shot(run.result))

    def record(self, run: SceneRun) -> None:
        """Count a shot."""
        game, session = self.game, self.session
        _sessions.pop(_key(self.ask.source, game, len(game.shots)), None)
        session.record(dict(self.ask.changes), run)
        _drop_runs(session)
        after = game._replace(shots=(*game.shots, self.ask.changes))
        _keep(_key(self.ask.source, after, len(after.shots)), session)

    @property
    def standing(self) -> dict[str, Any]:
        """The player's standing: the attempt, the score so far, what is needed, and at the end the stars."""
        session = self.session
        task, number = session.task, session.task.score.number
        return {
            "attempt": session.attempt.number,
            "attempts": task.attempts,
            "total": task.score.text(session.total),
            "result": session.result,
            "to_pass": number(task.passing),
            "for_stars": [number(stars) for stars in task.stars],
            "over": session.over,
            "passed": session.passed,
            "stars": session.stars,
        }


class InMatch:
    """A match of two, at the shot that comes next; it is found again from what came of each shot."""

    def __init__(self, ask: Ask, duel: Duel) -> None:
        folder = load_scene(ask.source).folder
        match = game_of(folder, duel.game)(players=duel.players)
        for outcome in duel.outcomes:
            match = match.after(outcome)
        self.ask = ask
        self.contest = AtMatch(folder, duel.game, match, seed=duel.seed + len(duel.outcomes))
        self.path_shown = self.contest.path_shown

    def scene(self) -> Scene:
        """The scene of the shot that is aimed, without the noise of the aim. Raises RequestError."""
        return self.contest.scene.changed(self.ask.changes, "")

    def aimed(self) -> Scene:
        """The scene of the shot that is let go. Raises RequestError."""
        return self.contest.aimed(self.scene())

    def call(self, run: SceneRun) -> tuple[str, bool]:
        """The verdict on a shot, and whether it is a success, before it is recorded."""
        return self.contest.call(run)

    def record(self, run: SceneRun) -> None:
        """Count a shot."""
        self.contest.record(run)

    @property
    def standing(self) -> dict[str, Any]:
        """The state of the match: players, scores, whose turn it is, and how it ended."""
        match = self.contest.match
        return {
            "players": match.players,
            "turn": match.turn,
            "scores": match.scores,
            "said": match.said,
            "status": match.status,
            "placing": match.placing,
            "over": match.finished,
            "winner": match.winner,
        }


def contest_of(ask: Ask) -> InTask | InMatch | None:
    """The task or match that the player is in the middle of; None for a scene."""
    if isinstance(ask.game, Duel):
        return InMatch(ask, ask.game)
    return None if ask.game is None else InTask(ask, ask.game)


def _session_of(ask: Ask, game: Game) -> Session:
    """The player's session at a task, played up to here."""
    shots, played = game.shots, len(game.shots)
    while played >= 0 and _key(ask.source, game, played) not in _sessions:
        played -= 1
    if played >= 0:
        session = _sessions.pop(_key(ask.source, game, played))
    else:
        played, session = 0, Session(task_of(ask.source), game.seed, game.player)
    for values in shots[played:]:
        session.shoot(dict(values))
        _drop_runs(session)
    _keep(_key(ask.source, game, len(shots)), session)
    return session


def _drop_runs(session: Session) -> None:
    """Forget the runs of shots that were scored: a class of players would fill the memory with them."""
    for attempt in session.attempts[-2:]:
        attempt.shots[:] = [replace(shot, run=None) for shot in attempt.shots]  # type: ignore[arg-type]


def _key(source: str, game: Game, shots: int) -> tuple[str, str]:
    return source, json_text([game.seed, game.player, list(game.shots[:shots])])


def _keep(key: tuple[str, str], session: Session) -> None:
    _sessions[key] = session
    while len(_sessions) > _KEPT:
        del _sessions[next(iter(_sessions))]


def task_document(task: Task) -> dict[str, Any]:
    """A task, in words for people."""
    return {"goal": task.goal, "attempts": task.attempts, "score": task.score.summary, "shown": task.shown}


def shown_until(contest: InTask | InMatch | None, run: SceneRun, ball: str) -> float | None:
    """The time in s until which the path is shown while the player aims; None for all of it."""
    visible = contest.path_shown if contest is not None else "all"
    if visible == "first contact":
        return first_impact(run, ball)
    if visible == "one metre":
        return time_after(1.0, points([(run, ball)])[0])
    return 0.0 if visible == "nothing" else None
