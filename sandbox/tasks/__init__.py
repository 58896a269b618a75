"""Tasks: a scene, what varies at the start, what the player may choose, what counts, and how often he may try.

A task is data: a TOML file in ``tasks`` of a scene's folder, or anywhere. The same task is a game for a person, a
lesson for a class and an environment for a program, as in dm_control, where ``Environment(physics, task)`` keeps what
moves apart from what is wanted: here a ``Scene`` is the physics, a ``Task`` draws starts, aims and scores, and a
``Session`` counts the attempts.
"""

from __future__ import annotations

from importlib import import_module

_TYPE_CHECKING = False
if _TYPE_CHECKING:
    from typing import Any

    from sandbox.tasks.discovery import find_task, is_task, tasks
    from sandbox.tasks.parsing import TaskListing, listed, load
    from sandbox.tasks.scoring import Score
    from sandbox.tasks.session import Attempt, Session, Shot
    from sandbox.tasks.task import Control, Start, Task

#: The names of each module, which is imported on first use.
_MODULES = {
    "discovery": ("find_task", "is_task", "tasks"),
    "parsing": ("TaskListing", "listed", "load"),
    "scoring": ("Score",),
    "session": ("Attempt", "Session", "Shot"),
    "task": ("Control", "Start", "Task"),
}

__all__ = [
    "Attempt",
    "Control",
    "Score",
    "Session",
    "Shot",
    "Start",
    "Task",
    "TaskListing",
    "find_task",
    "is_task",
    "listed",
    "load",
    "tasks",
]


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"sandbox.tasks.{module}"), name)
    raise AttributeError(f"module 'sandbox.tasks' has no attribute {name!r}")
