"""Sessions of players in tasks, in a process that computes: found again from the values of each shot."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

from sandbox.files import json_text
from sandbox.picture.path import first_impact, points, time_after
from sandbox.scene.scene_run import SceneRun
from sandbox.serve.calls import Ask, Game
from sandbox.tasks import Session, Task, load

#: So many sessions are kept; another is played again up to where it is.
_KEPT = 64

_sessions: dict[tuple[str, str], Session] = {}  # by task and game


@lru_cache(maxsize=64)
def task_of(source: str) -> Task:
    """The task of that name, or in that file. Raises RequestError."""
    return load(source)


def session_of(ask: Ask) -> Session | None:
    """The player's session, at the shot that comes next; None for a scene."""
    if ask.game is None:
        return None
    shots, played = ask.game.shots, len(ask.game.shots)
    while played >= 0 and _key(ask, played) not in _sessions:
        played -= 1
    if played >= 0:
        session = _sessions.pop(_key(ask, played))
    else:
        played, session = 0, Session(task_of(ask.source), ask.game.seed, ask.game.player)
    for values in shots[played:]:
        session.shoot(dict(values))
        _drop_runs(session)
    _keep(_key(ask, len(shots)), session)
    return session


def recorded(ask: Ask, session: Session, run: SceneRun) -> None:
    """Count a shot: ``run`` is that of what the player asks for."""
    assert ask.game is not None
    _sessions.pop(_key(ask, len(ask.game.shots)), None)
    session.record(dict(ask.changes), run)
    _drop_runs(session)
    game = Game(ask.game.seed, ask.game.player, (*ask.game.shots, ask.changes))
    _keep(_key(ask._replace(game=game), len(game.shots)), session)


def _drop_runs(session: Session) -> None:
    """Forget the runs of shots that were scored: a class of players would fill the memory with them."""
    for attempt in session.attempts[-2:]:
        attempt.shots[:] = [replace(shot, run=None) for shot in attempt.shots]  # type: ignore[arg-type]


def _key(ask: Ask, shots: int) -> tuple[str, str]:
    assert ask.game is not None
    return ask.source, json_text([ask.game.seed, ask.game.player, list(ask.game.shots[:shots])])


def _keep(key: tuple[str, str], session: Session) -> None:
    _sessions[key] = session
    while len(_sessions) > _KEPT:
        del _sessions[next(iter(_sessions))]


def task_document(task: Task) -> dict[str, Any]:
    """A task, in words for people."""
    return {"goal": task.goal, "attempts": task.attempts, "score": task.score.summary, "shown": task.shown}


def standing(session: Session) -> dict[str, Any]:
    """Return the player's standing: the attempt, the score so far, and at the end the stars and if it is passed."""
    return {
        "attempt": session.attempt.number,
        "attempts": session.task.attempts,
        "total": session.task.score.text(session.total),
        "over": session.over,
        "passed": session.passed,
        "stars": session.stars,
    }


def shown_until(session: Session | None, run: SceneRun, ball: str) -> float | None:
    """The time in s until which a task shows the path while the player aims; None for all of it."""
    visible = session.task.shown if session is not None else "all"
    if visible == "first contact":
        return first_impact(run, ball)
    if visible == "one metre":
        return time_after(1.0, points([(run, ball)])[0])
    return 0.0 if visible == "nothing" else None
