"""The task of a day: from the date alone, so that it is the same for everybody with the same tasks installed."""

from __future__ import annotations

from datetime import date

from sandbox.tasks.discovery import tasks

#: A prime number greater than the number of tasks: each comes once before any comes again, in no order that is seen.
_STEP = 7919


def task_of_day(day: date) -> str:
    """The name of the task of a day."""
    names = tasks()
    return names[day.toordinal() * _STEP % len(names)]


def seed_of_day(day: date) -> int:
    """The seed of its starts."""
    return day.toordinal()
