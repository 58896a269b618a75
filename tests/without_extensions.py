"""Runs the core in copies of the package, each without the folders of some extensions; prints what came of it as JSON.

The copies are links. Each is used in a process of its own, forked from one that has imported the libraries.
"""

from __future__ import annotations

import importlib
import io
import json
import os
import sys
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
LIBRARIES = ("click", "numpy", "pydantic", "pymunk", "pygame", "PIL.Image", "pytest", "scipy.optimize")


def copy_without(folders: Sequence[str], place: Path) -> None:
    """A copy of the package and what lies beside it, without these folders of the package."""
    for name in ("scenes", "assets", "template", "template_above"):
        (place / name).symlink_to(ROOT / name)
    for folder in ("sandbox", "sandbox/lab"):
        (place / folder).mkdir()
        for path in (ROOT / folder).iterdir():
            if path != ROOT / "sandbox" / "lab" and str(path.relative_to(ROOT / "sandbox")) not in folders:
                (place / folder / path.name).symlink_to(path)


def called(*args: str) -> tuple[int, str]:
    """The exit code of a command, and what it prints."""
    main = importlib.import_module("sandbox.cli").main
    out = io.StringIO()
    with redirect_stdout(out), redirect_stderr(out):
        code = main(list(args))
    return code, out.getvalue()


def plotted(path: Path) -> bool:
    """True if the charts of a result are written."""
    aim = importlib.import_module("sandbox").aim
    aim("golf", {"launch.angle": (8, 12)}, {"carry": 230}).plot(path)
    return path.stat().st_size > 1000


def outcome(place: Path, thorough: bool) -> dict[str, Any]:
    """What the copy in a folder does: its commands and parts, a run of golf and, if ``thorough``, more of the core."""
    os.chdir(place)
    sys.path.insert(0, str(place))
    entries = importlib.import_module("sandbox.entries")
    program = importlib.import_module("sandbox.cli.program")
    commands = program.app.list_commands(None)
    core = {"run": ("run", "golf", "--json")}
    if thorough:
        importlib.import_module("sandbox.golden")
        core |= {
            "pictures": ("run", "golf", "--poster", "golf.png", "--graph", "graph.png"),
            "schema": ("schema", "golf"),
            "sweep": ("sweep", "golf", "--over", "launch.angle=8:12:3", "--out", "sweep.csv", "--jobs", "1"),
        }
    refused = {"--html": ("run", "golf", "--html", "golf.html"), "--attempt": ("run", "golf", "--attempt", "2"),
               "--tasks": ("schema", "golf", "--tasks")}  # fmt: skip
    return {
        "at": sys.modules["sandbox"].__file__,
        "commands": commands,
        "dead": [name for name in commands if program.app.get_command(None, name) is None],
        "parts": [part for part in entries.added("PARTS") if thorough and entries.find(part) is not None],
        "core": {name: called(*args)[0] for name, args in core.items()},
        "chart": thorough and plotted(place / "chart.png"),
        "refused": {option: called(*args) for option, args in refused.items()} if thorough else {},
    }


def main(folder: Path, *groups: str) -> None:
    """For each group of folders, such as ``lab/fit,page``, a line with the outcome of a copy without them."""
    os.environ.update(SDL_VIDEODRIVER="dummy", PYGAME_HIDE_SUPPORT_PROMPT="1")
    for name in LIBRARIES:
        importlib.import_module(name)
    for number, group in enumerate(groups):
        place = folder / str(number)
        place.mkdir()
        copy_without(group.split(","), place)
        sys.stdout.flush()
        if os.fork() == 0:
            print(json.dumps(outcome(place, "," in group)), flush=True)
            os._exit(0)
        os.wait()


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
