"""Every task as a Gymnasium environment: ``import sandbox.gym``, then ``gymnasium.make("sandbox/FreeThrow-v0")``.

The task ``free-throw`` is ``sandbox/FreeThrow-v0``. ``register`` does the same for a file of one's own. Needs
gymnasium: ``pip install 'sports-sandbox[gym]'``.
"""

from __future__ import annotations

from pathlib import Path

from sandbox.errors import RequestError
from sandbox.tasks import find_task, load, tasks

try:
    import gymnasium
except ImportError:
    raise RequestError("sandbox.gym needs gymnasium, which is not installed: pip install gymnasium") from None

from sandbox.gym.environment import TaskEnv
from sandbox.gym.vector import TaskVectorEnv

__all__ = ["TaskEnv", "TaskVectorEnv", "environment_id", "register"]


def environment_id(name: str) -> str:
    """The id of the environment of a task.

    >>> environment_id("free-throw")
    'sandbox/FreeThrow-v0'
    """
    return f"sandbox/{''.join(word[:1].upper() + word[1:] for word in name.replace('_', '-').split('-'))}-v0"


def register(source: str | Path) -> str:
    """Register the task of that name, or in that file, with Gymnasium; returns the environment's id.

    Raises RequestError for a file that is no task.
    """
    if source in tasks():
        name = environment_id(str(source))
    else:
        load(source)
        name = environment_id(find_task(source).stem)
    gymnasium.register(
        name,
        entry_point="sandbox.gym.environment:TaskEnv",
        vector_entry_point="sandbox.gym.vector:TaskVectorEnv",
        kwargs={"task": str(source)},
    )
    return name


for _name in tasks():
    register(_name)
