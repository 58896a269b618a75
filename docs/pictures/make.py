"""The pictures of README.md, and the tiles of the window's first screen, made anew: ``make pictures``."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

os.environ |= {"SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"}

import pygame
from PIL import Image

import sandbox
from sandbox.cli import main as program
from sandbox.picture.frames import to_image
from sandbox.scene.finding import installed_folders
from sandbox.window.app import App
from sandbox.window.canvas import Canvas
from sandbox.window.front import TILE
from sandbox.window.game import Game
from sandbox.window.menu import TILE_FILE
from sandbox.window.session import Session
from sandbox.window.shots import Shot
from sandbox.window.stage import Stage
from sandbox.workers import Processes

HERE = Path(__file__).resolve().parent

#: What is shown of the sports, in rows of two.
SPORTS = ("golf", "basketball/bank-shot", "billiards/nine-ball-break", "soccer/dipping-free-kick")
SIZE, GAP = (720, 405), 6  # px
WINDOW, FRAME = (1280, 720), 1 / 60  # px, s
#: The pull of the free throw that goes in, in px.
PULL = (-111, 142)
QUALITY = 88  # of JPEG: the smallest at which letters stay clean

SWEEP = ("sweep", "basketball", "--over", "launch.speed=6.8:8.6:73", "--over", "launch.angle=40:70:61")
NEW = "beachvolley"
COMPARE = ("run", "golf", "--compare", "golf/headwind")


def poster(name: str) -> Image.Image:
    """The poster of a scene or preset, drawn twice as large and scaled down."""
    scene = sandbox.load(name)
    large = to_image(scene.picture(sandbox.simulate(scene), (2 * SIZE[0], 2 * SIZE[1])).poster())
    return large.resize(SIZE, Image.Resampling.LANCZOS)


def sports() -> None:
    """One poster of each sport on a sheet."""
    rows = len(SPORTS) // 2
    sheet = Image.new("RGB", (2 * SIZE[0] + GAP, rows * SIZE[1] + (rows - 1) * GAP), "white")
    for i, name in enumerate(SPORTS):
        sheet.paste(poster(name), (i % 2 * (SIZE[0] + GAP), i // 2 * (SIZE[1] + GAP)))
    sheet.save(HERE / "sports.jpg", quality=QUALITY, subsampling=0, optimize=True, progressive=True)


def free_throws() -> None:
    """The map that the README shows, by the command that it names; few colours need few bytes."""
    with tempfile.TemporaryDirectory() as folder:
        plot = Path(folder, "map.png")
        program([*SWEEP, "--out", str(Path(folder, "map.csv")), "--plot", str(plot)])
        with Image.open(plot) as image:
            image.convert("RGB").quantize(64, dither=Image.Dither.NONE).save(HERE / "free-throws.png", optimize=True)


def compare() -> None:
    """The comparison that the README shows, by the command that it names."""
    with tempfile.TemporaryDirectory() as folder:
        plot = Path(folder, "compare.png")
        program([*COMPARE, "--poster", str(plot)])
        with Image.open(plot) as image:
            image.save(HERE / "compare.jpg", quality=QUALITY, subsampling=0, optimize=True, progressive=True)


def new_scene() -> None:
    """What ``sandbox new`` writes, by the commands that the README shows."""
    with tempfile.TemporaryDirectory() as folder:
        plot = Path(folder, "new.png")
        program(["new", str(Path(folder, NEW))])
        program(["run", str(Path(folder, NEW)), "--poster", str(plot), "--size", f"{SIZE[0]}x{SIZE[1]}"])
        with Image.open(plot) as image:
            image.save(HERE / "new-scene.jpg", quality=QUALITY, subsampling=0, optimize=True, progressive=True)


def window() -> None:
    """The window while a free throw is aimed, with its fan and the panel open: by events, without a display."""
    pygame.display.init()
    worker = Processes(1)
    game = Game(Session("basketball"), worker, patience=60.0)
    app = App(game, pygame.display.set_mode(WINDOW), patience=60.0)
    view = app.view
    while not view.stages.complete:
        app.tick(FRAME)
    for key in (pygame.K_TAB, pygame.K_f):
        post(app, pygame.KEYDOWN, key=key, mod=0, unicode="", scancode=0)
    x, y = (round(value) for value in view.stages.latest.ball_at(game.shot))
    across, down = PULL
    post(app, pygame.MOUSEBUTTONDOWN, pos=(x, y), button=1)
    for share in (0.4, 0.7, 1.0):
        place = round(x + share * across), round(y + share * down)
        post(app, pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(1, 0, 0))
    while view.fan.job.key is None or view.fan.job.key[0] is not game.shot:
        app.tick(FRAME)
    app.close()
    worker.close(abandon=True)
    to_image(view.screen.surface).save(
        HERE / "window.jpg", quality=QUALITY, subsampling=0, optimize=True, progressive=True
    )


def tiles(names: Sequence[str] = ()) -> None:
    """One small picture of each sport, or of these, its shot without words, into the scene's folder."""
    for name, folder in sorted(installed_folders().items()):
        if names and name not in names:
            continue
        scene = sandbox.load(name)
        stage = Stage(Shot(scene, sandbox.simulate(scene)), (3 * TILE[0], 3 * TILE[1]))
        sheet = Canvas(stage.backdrop.copy())
        stage.draw_path(sheet, stage.shot)
        stage.draw_balls(sheet, stage.shot, stage.story)
        small = to_image(sheet.surface).resize(TILE, Image.Resampling.LANCZOS)
        small.save(folder / TILE_FILE, quality=QUALITY, optimize=True, progressive=True)


def post(app: App, kind: int, **values: object) -> None:
    """One event, and one frame."""
    pygame.event.post(pygame.event.Event(kind, values))
    app.tick(FRAME)


if __name__ == "__main__":
    if sys.argv[1:2] == ["tiles"]:
        tiles(sys.argv[2:])
    else:
        for make in (sports, free_throws, compare, new_scene, window, tiles):
            make()
