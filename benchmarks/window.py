"""Cost of a frame of the window in every scene and preset: aiming by mouse, with fan and map, watching, near the ball,
paused.

Run ``python benchmarks/window.py [SCENE ...] [--json F]``. The window is 1280x720 and drawn in memory (SDL's dummy
driver), as without a GPU; frames are paced at 60 per second, and a frame's time is from its events to its picture.
"processor" is the window process' processor time for a frame, and "share" its fraction of 16.7 ms, which is repeatable
on a busy machine, unlike the time; scenes run in another process, on the other core. While aiming, the mouse moves in
every frame; "path" is the share of frames whose path belongs to the mouse position of the same frame, and not to an
earlier one; "fans" is how many new fans are shown in a second while the mouse moves, and "whole" the time by the clock
in which the fan of an aim at rest is complete, from its first frame to its last shot. Presets get a third of the frames
of scenes, and a line for the fan alone. The last line is the share of all frames in time.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from math import cos, pi, radians, sin
from statistics import median
from time import perf_counter, process_time, sleep
from typing import Any

from measured import command_line, keep, say, show

os.environ |= {"SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"}

import pygame

from sandbox.scene import listings
from sandbox.window.app import App
from sandbox.window.background import steady
from sandbox.window.game import Game
from sandbox.window.session import Session
from sandbox.window.stages import AT_REST
from sandbox.workers import Processes

SIZE, FRAME = (1280, 720), 1 / 60  # px, s
#: The mouse: distance from the ball in px, amplitude in px along the pull and in rad, and number of swings.
PULL, SWING, TURN, SWINGS = 170.0, 45.0, 0.25, 2.0


def timed(
    app: App, frames: int, before: Callable[[int], object] = lambda frame: None
) -> Iterator[tuple[float, float, bool, bool]]:
    """For each frame: time and processor time in s, whether its path belongs to its parameters, and whether its fan is
    new."""
    fan = app.view.fan.job.value
    for frame in range(frames):
        before(frame)
        started, used = perf_counter(), process_time()
        app.tick(FRAME)
        spent, current = perf_counter() - started, app.game.path.settled
        sleep(max(0.0, FRAME - spent))
        known, fan = fan, app.view.fan.job.value
        yield spent, process_time() - used, current, fan is not known


def post(kind: int, at: tuple[int, int]) -> None:
    values: dict[str, Any] = {"rel": (0, 0), "buttons": (1, 0, 0)} if kind == pygame.MOUSEMOTION else {"button": 1}
    pygame.event.post(pygame.event.Event(kind, pos=at, **values))


def measure(source: str, frames: int, worker: Processes, helper: Processes) -> dict[str, dict[str, float]]:
    """For each activity: median and 95th percentile in ms, shares of frames, and fans per second."""
    game = Game(Session(source), worker, helper=helper)
    app = App(game, pygame.display.set_mode(SIZE))
    while not app.view.stages.complete:
        app.tick(FRAME)
    assert app.view.stages.latest is not None
    assert game.shot is not None
    x, y = (round(value) for value in app.view.stages.latest.ball_at(game.shot))
    angle = radians(game.session.value(game.session.controls.angle) or 0.0)
    whole = whole_fan(app)
    post(pygame.MOUSEBUTTONDOWN, (x, y))
    app.tick(FRAME)
    steady()

    def pull(frame: int) -> None:
        turn = sin(2 * pi * SWINGS * frame / frames)
        length, towards = PULL + SWING * turn, angle + TURN * turn
        post(pygame.MOUSEMOTION, (round(x - length * cos(towards)), round(y + length * sin(towards))))

    found = {"aiming": summarised(timed(app, frames, pull))}
    app.view.shown.on |= {"fan"}
    found["with a fan"] = summarised(timed(app, frames, pull)) | {"whole_s": whole}
    app.view.shown.on = {"ghosts", "map"}
    found["with the map"] = summarised(timed(app, frames, pull))
    app.view.shown.on = {"ghosts"}
    post(pygame.MOUSEBUTTONUP, (x, y))
    found["watching"] = summarised(timed(app, frames))
    app.view.shown.on.add("view")
    found["near the ball"] = summarised(timed(app, frames))
    if game.watching.playback is not None:
        game.watching.playback.playing = False
    found["paused"] = summarised(timed(app, frames // 2))
    app.close()
    return found


def whole_fan(app: App) -> float:
    """Return the time in s by the clock until the fan of an aim at rest is complete, in frames as a player has them."""
    while app.game.still < AT_REST:
        app.tick(FRAME)
    app.view.shown.on.add("fan")
    started = perf_counter()
    while (fan := app.view.fan.job.value) is None or fan.left > 0:
        for _ in timed(app, 1):
            pass
    app.view.shown.on.remove("fan")
    return perf_counter() - started


def summarised(rows: Iterator[tuple[float, float, bool, bool]]) -> dict[str, float]:
    times, used, current, fans = zip(*rows, strict=True)
    ordered = sorted(times)
    return {
        "median_ms": 1e3 * median(times),
        "p95_ms": 1e3 * ordered[int(0.95 * (len(ordered) - 1))],
        "processor_ms": 1e3 * median(used),
        "in_time": sum(t <= FRAME for t in times) / len(times),
        "path": sum(current) / len(current),
        "fans": sum(fans) / sum(max(FRAME, t) for t in times),
        "frames": len(times),
    }


def main() -> None:
    options = {
        "scenes": {"nargs": "*", "help": "scenes and presets; default: all, with the most demanding presets"},
        "--frames": {"type": int, "default": 180},
    }
    arguments = command_line(__doc__, options=options)
    sources = arguments.scenes or [item.name for item in listings()]
    pygame.display.init()
    rows: dict[str, dict[str, dict[str, float]]] = {}
    worker, helper = Processes(1), Processes(1)
    for source in sources:
        few = not arguments.scenes and "/" in source
        rows[source] = measure(source, arguments.frames // 3 if few else arguments.frames, worker, helper)
    worker.close(abandon=True)
    helper.close(abandon=True)
    columns = {
        "scene": "{scene}",
        "": "{activity}",
        "median": "{median_ms:.1f} ms",
        "95 %": "{p95_ms:.1f} ms",
        "processor": "{processor_ms:.1f} ms",
        "share": "{share:.0%}",
        "in time": "{in_time:.0%}",
        "path": "{path:.0%}",
        "fans": "{fans:.1f} /s",
        "whole": "{whole_s:.2f} s",
    }
    measures = [
        row
        | {"scene": source, "activity": name, "share": row["processor_ms"] / FRAME / 1e3}
        | {"path": row["path"] if name == "aiming" else None, "fans": row["fans"] if name == "with a fan" else None}
        for source, found in rows.items()
        for name, row in found.items()
        if name == "with a fan" or arguments.scenes or "/" not in source
    ]
    show("frames", measures, columns)
    every = [row for found in rows.values() for row in found.values()]
    in_time = sum(row["in_time"] * row["frames"] for row in every) / sum(row["frames"] for row in every)
    say(f"{in_time:.1%} of all frames in time")
    keep(arguments.json, rows)


if __name__ == "__main__":
    main()
