"""A finished game as a page: its score, and each shot as a replay."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

from sandbox.files import from_here
from sandbox.page.parts import filled, html, save
from sandbox.page.replay import page_of
from sandbox.tasks import Attempt, Session, Shot, Task, find_task, tasks
from sandbox.text import command_line, title_of


def save_page(session: Session, path: Path) -> None:
    """Write the page of what a player did at a task."""
    save(session_page(session), path)


def session_page(session: Session) -> str:
    """The page of the attempts that a player has made so far, one file without network: each shot plays in a frame."""
    task = session.task
    stars = "★" * session.stars + "☆" * (3 - session.stars) if session.over else ""
    return filled(
        "task.html",
        title=html(title_of(task.name)),
        goal=html(task.goal),
        score=html(session.result),
        stars=stars,
        attempts="\n".join(_attempt(session, attempt) for attempt in session.attempts if attempt.shots),
        seed=str(session.seed),
        command=html(command_line(_source(task), {}, "run", "--seed", str(session.seed), "--attempt", "1")),
    )


def _source(task: Task) -> str:
    """The task as a command takes it: its name, or the file of one that is not installed."""
    return task.name if task.name in tasks() and find_task(task.name) == task.file else from_here(task.file)


def _attempt(session: Session, attempt: Attempt) -> str:
    """One attempt: what was drawn, and its shots."""
    drawn = _listed(attempt.start, {start.key: start.unit for start in session.task.start})
    shots = "\n".join(_shot(session, shot) for shot in attempt.shots)
    return f"<section><h2>Attempt {attempt.number}</h2>\n<p>{html(drawn)}</p>\n{shots}\n</section>"


def _shot(session: Session, shot: Shot) -> str:
    """One shot: what it was worth and what the player set; its replay in a frame that is filled when it is opened."""
    aim = _listed(shot.values, {control.key: control.unit for control in session.task.controls})
    head = f"{'✓' if shot.made else '·'} {shot.verdict} ({session.task.score.text(shot.worth)}; {aim})"
    page = escape(page_of(shot.run))
    return (
        f"<details><summary>{html(head)}</summary>\n"
        f'<iframe title="{html(shot.verdict)}" loading="lazy" srcdoc="{page}"></iframe></details>'
    )


def _listed(values: Mapping[str, Any], units: Mapping[str, str]) -> str:
    """Parameters with their values, numbers with four digits."""
    said = {key: f"{value:.4g}" if isinstance(value, float) else str(value) for key, value in values.items()}
    return ", ".join(f"{key} = {text} {units[key]}".rstrip() for key, text in said.items())
