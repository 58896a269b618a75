"""Solves every task, and measures how hard it is: ``python docs/measure_tasks.py``, half an hour on an idle machine.

Or only some of them, by name. Each start is solved by random shots, of which that one is kept that the noise of a
player's aim, drawn 16 times, spoils least. ``tests/tasks/solutions.json`` gets the shots of the first attempt, which
the tests play again, and docs/tasks.md the table: how many random shots are a success, and how many of the player
who aims at the best one.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sandbox.lab.runs import runs
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun
from sandbox.tasks import Session, Task, load, tasks

DOCS = Path(__file__).resolve().parent
PAGE, SOLUTIONS = DOCS / "tasks.md", DOCS.parent / "tests" / "tasks" / "solutions.json"
START, END = "<!-- tasks -->", "<!-- end of tasks -->"

#: Random shots of a search, which is repeated until one is a success, and how often at most.
SHOTS, SEARCHES = 300, 12
#: How many shots are tried with noise, and how often.
BEST, NOISY = 4, 16
#: Attempts that are measured.
ATTEMPTS = 2


def played(task: Task, scene: Scene, rows: Sequence[Sequence[float]]) -> list[float | None]:
    """What shots with these values of the controls are worth; as nothing what ends an attempt that ought to go on."""
    found: list[float | None] = []
    for run in runs(scene, list(task.defaults), rows, asked=task.facts):
        worth = task.score.of_shot(run.result) if isinstance(run, SceneRun) else None
        over = worth is None or task.is_over(run.result, 1)
        found.append(0.0 if over and task.goes_on and len(scene.build().balls) > 2 else worth)
    return found


def better(task: Task, worths: Sequence[float | None]) -> list[int]:
    """The places of shots that are a success, the best first."""
    return [place for place in task.score.best_shots(worths) if task.is_made(worths[place])]


def solved(task: Task, scene: Scene, random: np.random.Generator) -> tuple[list[float] | None, float, float]:
    """The shot that noise spoils least, and the shares of successes: of random shots, and of that one with noise."""
    tried = made = 0
    candidates: list[list[float]] = []
    for _ in range(SEARCHES):
        rows = [[random.uniform(control.low, control.high) for control in task.controls] for _ in range(SHOTS)]
        worths = played(task, scene, rows)
        places = better(task, worths)
        tried, made = tried + SHOTS, made + sum(map(task.is_made, worths))
        candidates += [rows[place] for place in places[:BEST]]
        if len(candidates) >= BEST:
            break
    best: list[float] | None = None
    share = -1.0
    for row in candidates[:BEST]:
        values = dict(zip(task.defaults, row, strict=True))
        noisy = [list(task.aimed(values, random).values()) for _ in range(NOISY)]
        good = sum(map(task.is_made, played(task, scene, noisy))) / NOISY
        if good > share:
            best, share = row, good
    return best, made / tried, max(share, 0.0)


def measured(name: str) -> tuple[list[dict[str, float]], float, float]:
    """The shots that solve a task's first attempt, and the mean shares of successes over some attempts' first shots."""
    task, random = load(name), np.random.default_rng(1)
    session, shots = Session(task, noise=False), list[dict[str, float]]()
    while session.attempt.number == 1 and not session.over:
        row, _, _ = solved(task, session.scene, random)
        if row is None:
            raise SystemExit(f"{name}: no solution was found")
        shots.append({key: round(value, 5) for key, value in zip(task.defaults, row, strict=True)})
        session.shoot(shots[-1])
    shares = []
    for number in range(1, min(task.attempts, ATTEMPTS) + 1):
        row, by_chance, practised = solved(task, task.at_start(0, number), random)
        if row is None:
            raise SystemExit(f"{name}: attempt {number} has no solution")
        shares.append((by_chance, practised))
    by_chance, practised = np.mean(shares, axis=0)
    return shots, float(by_chance), float(practised)


def main() -> None:
    known: dict[str, Any] = json.loads(SOLUTIONS.read_text("utf-8")) if SOLUTIONS.is_file() else {}
    for name in sys.argv[1:] or tasks():
        shots, by_chance, practised = measured(name)
        known[name] = {"shots": shots, "by_chance": round(by_chance, 4), "practised": round(practised, 3)}
        sys.stderr.write(f"{name}: by chance {100 * by_chance:.1f} %, practised {100 * practised:.0f} %\n")
        kept = {each: known[each] for each in tasks() if each in known}
        SOLUTIONS.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    write_page(known)


def write_page(known: dict[str, Any]) -> None:
    """The table of docs/tasks.md."""
    rows = []
    for name in tasks():
        task, found = load(name), known.get(name)
        if found is not None:
            shares = f"{100 * found['by_chance']:.1f} %", f"{100 * found['practised']:.0f} %"
            rows.append((task.scene.name, name, task.goal, *shares))
    lines = ["| sport | task | goal | by chance | practised |", "|---|---|---|---|---|"]
    lines += [
        f"| {sport} | `{name}` | {goal} | {chance} | {practised} |" for sport, name, goal, chance, practised in rows
    ]
    text = PAGE.read_text("utf-8")
    before, _, rest = text.partition(START)
    after = rest.partition(END)[2]
    PAGE.write_text("\n".join([before + START, *lines, END]) + after, "utf-8")


if __name__ == "__main__":
    main()
