"""Start-up time of help, list, a run and the window's first frame, and the imports that cause it.

Run ``python benchmarks/start.py [--json F] [--repeats N] [--quick]``. Each is a new process, from its start to its end,
the median of interleaved repeats; the window ends with its first frame, drawn in memory (SDL's dummy driver). Files
are cached and compiled, as from the second start on.

Each has a limit, a process that does only what is unavoidable: Python alone for help and list; Python and ``import
pymunk`` for a run; these, pygame and an empty window of the same size for the first frame.

"clock" is wall time, "processor" the processor time of all threads; "over limit" is the ratio of processor times, which
are repeatable on a busy machine too. Imports are from ``python -X importtime``: each package's own time, without the
other packages it imports.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections import defaultdict
from resource import RUSAGE_CHILDREN, getrusage
from statistics import median
from time import perf_counter
from typing import Any

from measured import command_line, keep, show

PROGRAM = "import sys; sys.argv[1:] = {}; from sandbox.cli import main; sys.exit(main())"
HELP, LIST, RUN = map(PROGRAM.format, (["--help"], ["list"], ["run", "golf", "--json"]))
WINDOW = """
import os, pygame
flip = pygame.display.flip
def first():
    flip()
    os._exit(0)
pygame.display.flip = first
from sandbox.cli import main
main(['play', 'golf'])
"""
EMPTY = """
import pygame, pymunk
pygame.display.init()
pygame.display.set_mode((1280, 720), pygame.RESIZABLE)
pygame.display.flip()
"""

#: The measured programs and their limits: name and code of each.
STARTS = {
    "sandbox --help": (HELP, "python", "pass"),
    "sandbox list": (LIST, "python", "pass"),
    "sandbox run golf --json": (RUN, "python, pymunk", "import pymunk"),
    "window's first frame": (WINDOW, "python, pymunk, empty window", EMPTY),
}
#: The target of the processor time, in s.
TARGETS = {"sandbox list": 0.15, "sandbox run golf --json": 0.2}
#: Number of packages listed; the others share one line.
LISTED = 10

UNSEEN = os.environ | {
    "PYTHONDONTWRITEBYTECODE": "",
    "SDL_VIDEODRIVER": "dummy",
    "SDL_AUDIODRIVER": "dummy",
    "PYGAME_HIDE_SUPPORT_PROMPT": "1",
}


def started(program: str, *options: str) -> tuple[float, float, str]:
    """Wall time and processor time of a process in s, and its stderr."""
    before, began = getrusage(RUSAGE_CHILDREN), perf_counter()
    command = [sys.executable, *options, "-c", program]
    done = subprocess.run(command, env=UNSEEN, capture_output=True, text=True)
    clock, after = perf_counter() - began, getrusage(RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise SystemExit(f"{command} failed:\n{done.stderr}")
    return clock, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stderr


def starts(repeats: int) -> list[dict[str, Any]]:
    """A row for each start."""
    programs = {name: program for name, (program, *_) in STARTS.items()}
    programs |= {limit: program for _, limit, program in STARTS.values()}
    if repeats > 1:
        for program in programs.values():
            started(program)  # compiled and cached from here on
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in programs}
    for _ in range(repeats):
        for name, program in programs.items():
            times[name].append(started(program)[:2])
    clock = {name: median(one for one, _ in found) for name, found in times.items()}
    processor = {name: median(one for _, one in found) for name, found in times.items()}
    return [
        {
            "start": name,
            "clock_s": clock[name],
            "processor_s": processor[name],
            "limit": limit,
            "limit_clock_s": clock[limit],
            "limit_processor_s": processor[limit],
            "over_limit": processor[name] / processor[limit],
            "target_s": TARGETS.get(name),
        }
        for name, (_, limit, _) in STARTS.items()
    ]


def imports(program: str, repeats: int) -> dict[str, float]:
    """Milliseconds of each package's own modules, the median of repeats."""
    found = [_by_package(started(program, "-X", "importtime")[2]) for _ in range(repeats)]
    return {package: median(times.get(package, 0.0) for times in found) for package in found[0]}


def _by_package(text: str) -> dict[str, float]:
    times: dict[str, float] = defaultdict(float)
    for line in text.splitlines():
        own, _, rest = line.removeprefix("import time:").partition("|")
        if line.startswith("import time:") and own.strip().isdigit():
            times[_package(rest.partition("|")[2].strip())] += int(own) / 1e3
    return dict(times)


def _package(module: str) -> str:
    top = module.partition(".")[0]
    if top in ("sandbox", "sandbox_scenes"):
        return "the sandbox and its scenes"
    return "standard library" if top in sys.stdlib_module_names else top.removeprefix("_").removesuffix("_cffi")


def report(found: dict[str, Any]) -> None:
    columns = {
        "": "{start}",
        "clock": "{clock_s:.0f ms}",
        "processor": "{processor_s:.0f ms}",
        "target": "{target_s:.0f ms}",
        "over limit": "{over_limit:.1f}",
        "the limit's clock": "{limit_clock_s:.0f ms}",
        "processor ": "{limit_processor_s:.0f ms}",
        "the limit": "{limit}",
    }
    show("from start to end", found["starts"], columns)
    starts = found["imports"]
    packages = {name for times in starts.values() for name in times}
    listed = sorted(packages, key=lambda name: -max(times.get(name, 0.0) for times in starts.values()))
    parts = {name: [name] for name in listed[:LISTED]}
    parts |= {f"{len(listed[LISTED:])} others": listed[LISTED:], "all": listed}
    rows = [
        {"package": name} | {start: sum(times.get(each, 0.0) for each in part) for start, times in starts.items()}
        for name, part in parts.items()
    ]
    heads = {name.removeprefix("sandbox "): f"{{{name}:.1f}}" for name in starts}
    show("own time of imports, ms", rows, {"": "{package}", **heads})


def main() -> None:
    arguments = command_line(__doc__, repeats=9)
    found = {
        "starts": starts(arguments.repeats),
        "imports": {name: imports(program, min(arguments.repeats, 3)) for name, (program, *_) in STARTS.items()},
    }
    report(found)
    keep(arguments.json, found)


if __name__ == "__main__":
    main()
