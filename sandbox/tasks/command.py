"""``sandbox tasks``, and a task's attempt as the scene of ``sandbox run``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sandbox.cli.arguments import json_option, say
from sandbox.errors import RequestError
from sandbox.text import with_noun
from sandbox.toml import read_toml

if TYPE_CHECKING:
    from sandbox.scene import Scene
    from sandbox.scene.scene_run import SceneRun
    from sandbox.tasks import Task


@click.command()
@json_option
def tasks(as_json: bool) -> None:
    """List all tasks: a goal, and how often you may try.

    \b
    Examples:
      sandbox tasks
      sandbox play free-throw
      sandbox run free-throw --attempt 3 --set launch.speed=7.4
    """
    from sandbox.files import json_text
    from sandbox.lab.tables import table
    from sandbox.tasks import listed

    found = list(listed())
    if as_json:
        say(json_text([vars(task) for task in found]))
        return
    rows = [
        (task.name, str(task.level), f"{task.goal} ({task.scene}, {with_noun(task.attempts, 'attempt')})")
        for task in found
    ]
    say("\n".join(table(("", "level", ""), rows, "lll", indent="")))


@dataclass(frozen=True)
class Tried:
    """One attempt at a task, as ``sandbox run`` computes it: without the noise of a player's aim."""

    task: Task
    number: int
    seed: int
    start: Mapping[str, Any]
    scene: Scene

    def report(self, run: SceneRun) -> dict[str, Any]:
        """Return what the attempt was, and what it is worth, for JSON."""
        worth = self.task.score.of_shot(run.result)
        return {
            "task": self.task.name,
            "goal": self.task.goal,
            "attempt": self.number,
            "seed": self.seed,
            "start": dict(self.start),
            "controls": {key: _value(self.scene, key) for key in self.task.defaults},
            "score": self.task.score.summary,
            "worth": worth,
            "made": self.task.is_made(worth),
        }

    def lines(self, run: SceneRun) -> list[str]:
        """Return the same as lines for people."""
        from sandbox.lab.tables import table

        units = {start.key: start.unit for start in self.task.start}
        units |= {control.key: control.unit for control in self.task.controls}
        score = self.task.score
        worth = score.of_shot(run.result)
        counts = "nothing" if worth is None else score.number(worth)
        rows = [("goal", self.task.goal), ("counts", f"{counts} ({score.summary})")]
        drawn = [("start", key) for key in self.start] + [("set", key) for key in self.task.defaults]
        for what, key in drawn:
            value = _value(self.scene, key)
            said = f"{value:.4g} {units[key]}".rstrip() if isinstance(value, float) else str(value)
            rows.append((what, f"{key} = {said}"))
        return ["", *table((f"{self.task.name}, attempt {self.number}", ""), rows, "ll")]


def _value(scene: Scene, key: str) -> Any:
    from sandbox.parameters import value_at

    return value_at(scene.parameters, key)


def played_in(folder: Path) -> list[tuple[str, list[str]]]:
    """The tasks of a scene's folder in rising order, and its games for two, by name; only kinds that there are."""
    levels = {}
    for file in sorted((folder / "tasks").glob("*.toml")):
        try:
            levels[file.stem] = float(read_toml(file)["level"])
        except (RequestError, KeyError, TypeError, ValueError):  # a damaged one comes last
            levels[file.stem] = inf
    games = sorted(file.stem.replace("_", "-") for file in (folder / "games").glob("[a-z]*.py"))
    found = [("tasks", sorted(levels, key=lambda name: levels[name])), ("games", games)]
    return [(kind, names) for kind, names in found if names]


def tried(source: str, changes: dict[str, Any], attempt: int | None, seed: int | None) -> Tried | None:
    """The attempt at a task that ``sandbox run`` is asked for; None for a scene. Raises RequestError."""
    from sandbox.scene import load
    from sandbox.tasks import is_task
    from sandbox.tasks import load as load_task

    if not is_task(source):
        if attempt is not None or seed is not None:
            load(source)  # says what is wrong with a file that there is not
            option = "--seed" if attempt is None else "--attempt"
            raise RequestError(
                f"{option}: only a task has attempts, and {source} is a scene; sandbox tasks lists tasks"
            )
        return None
    task, number, drawn_by = load_task(source), attempt or 1, seed or 0
    if number > task.attempts:
        raise RequestError(f"--attempt {number}: {task.name} has {with_noun(task.attempts, 'attempt')}")
    scene = task.at_start(drawn_by, number).changed(changes, "--set")
    return Tried(task, number, drawn_by, task.drawn_for(drawn_by, number), scene)
