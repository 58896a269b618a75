"""Measures how large pictures show what decides a run: ``python -m docs.framing [--write]``, over all scenes, presets,
tasks and games; with ``--write`` into ``docs/framing.md``.

At 1280x720, by the camera of frames, films, window and pages: at the moment that decides, how many px across the ball
is, how many of them it would be to scale, and how large what decides is; at the start, the share of the picture that is
in its commonest colour, such as a room around a table.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import sandbox
from sandbox.picture.frames import to_image
from sandbox.picture.long import LongView
from sandbox.picture.view import View
from sandbox.scene import listings
from sandbox.scene.discovery import installed_folders
from sandbox.scene.scene_run import SceneRun
from sandbox.tasks import load as load_task
from sandbox.tasks.discovery import tasks
from sandbox.tasks.games import game_names, game_of

SIZE = (1280, 720)
#: What decides is at least so large, and the ball, in px.
LEAST, LEAST_BALL = SIZE[1] / 6, 12.0
PAGE = Path(__file__).with_name("framing.md")
HEAD = """# How large pictures show what decides

Made by `python -m docs.framing --write`, at 1280x720: at the moment that decides, the size of the ball as it is drawn,
and to scale, and of what decides, the larger side; at the start, the share of the picture in its commonest colour. A
dash is where no moment decides, and the camera stays where it is.

| | what decides | ball | to scale | one colour |
|---|--:|--:|--:|--:|
"""


@dataclass(frozen=True)
class Framing:
    """Sizes in the picture of one run, in px; None for what decides if nothing does."""

    ball: float
    to_scale: float
    decides: float | None

    @property
    def large(self) -> bool:
        """True if all is as large as it should be."""
        return self.ball >= LEAST_BALL and (self.decides is None or self.decides >= LEAST - 0.5)


def framing(view: View[Any]) -> Framing:
    """Measure a picture at the moment that decides."""
    camera = view.near_camera if isinstance(view, LongView) else view.closest
    ball = view.ball if view.story is None or not view.story.balls else view.story.balls[-1][0]
    to_scale = 2.0 * view.radii[ball] * camera.scale
    side = None
    if view.story is not None:
        place = view.story.place
        side = camera.scale * max(place.right - place.left, (place.top - place.bottom) * camera.stretch)
    return Framing(max(to_scale, 2.0 * view.least_in_frames), to_scale, side)


def empty(view: View[Any]) -> float:
    """The share of the first frame that is in its commonest colour."""
    pixels = np.asarray(to_image(view.frame(0.0))).reshape(-1, 3) >> 3
    counts = np.bincount(pixels.astype(np.int64) @ np.array([1 << 10, 1 << 5, 1]))
    return float(counts.max() / len(pixels))


def runs() -> Iterator[tuple[str, SceneRun]]:
    """The runs of all scenes and presets, and of the first shot of each game and task, each with its name."""
    for listing in listings():
        yield listing.name, sandbox.simulate(listing.name)
    for folder in installed_folders().values():
        for name in game_names(folder):
            rules = game_of(folder, name)()
            scene = sandbox.load("/".join(filter(None, (folder.name, rules.preset))))
            yield f"game {name}", sandbox.simulate(scene.changed(rules.start, rules.title))
    for name in tasks():
        yield f"task {name}", sandbox.simulate(load_task(name).at_start())


def main() -> None:
    """Print the table, or write it."""
    os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
    rows = []
    for name, run in runs():
        view = run.scene.picture(run, SIZE)
        found = framing(view)
        decides = "–" if found.decides is None else f"{found.decides:.0f}"
        row = f"| {name} | {decides} | {found.ball:.0f} | {found.to_scale:.0f} | {100 * empty(view):.0f} % |"
        rows.append(row + " small" * (not found.large))
        sys.stdout.write(f"{rows[-1]}\n")
        sys.stdout.flush()
    if "--write" in sys.argv:
        PAGE.write_text(HEAD + "\n".join(rows) + "\n", "utf-8")


if __name__ == "__main__":
    main()
