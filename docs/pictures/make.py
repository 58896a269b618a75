"""The pictures of README.md, and the tiles of the window's first screen, made anew: ``make pictures``."""

from __future__ import annotations

import os
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import ceil, dist
from pathlib import Path
from typing import Any

os.environ |= {"SDL_VIDEODRIVER": "dummy", "SDL_AUDIODRIVER": "dummy"}

import numpy as np
import pygame
from PIL import Image

import sandbox
from sandbox.cli import main as program
from sandbox.picture.camera import Box, Camera, Eye
from sandbox.picture.frames import save_png, to_image
from sandbox.picture.lettering import Lettering
from sandbox.picture.long import LongView
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import scene_colours
from sandbox.picture.places.plan import Ground, Kit, draw_moving
from sandbox.picture.places.plan import Person as Above
from sandbox.picture.places.things import Person as Side
from sandbox.picture.places.things import poses as all_poses
from sandbox.picture.sheet import Sheet
from sandbox.picture.view import View
from sandbox.scene.discovery import installed_folders
from sandbox.tasks.sports import TILE, TILE_FILE
from sandbox.window.app import App
from sandbox.window.canvas import Canvas
from sandbox.window.game import Game
from sandbox.window.session import Session
from sandbox.window.shots import Shot
from sandbox.window.stage import Stage
from sandbox.workers import Processes

HERE = Path(__file__).resolve().parent

#: What is shown of the sports, in rows of two.
SPORTS = ("golf", "basketball/bank-shot", "billiards/nine-ball-break", "soccer/dipping-free-kick")
SIZE, GAP = (832, 468), 12  # px
#: On the sheet of all sports posters are so high, in px, before their foot is cut off, where their numbers would be.
WITH_FOOT = 528
#: A page shows pictures so wide, in px, in which letters have this height at least.
SHOWN, LETTERS = 838, 14
WINDOW, FRAME = (1280, 720), 1 / 60  # px, s
#: The pull of the free throw that goes in, in px.
PULL = (-111, 142)
#: On a tile what decides and the ball fill this share of it, and the ball is so far away, in sides of what decides.
FILLS, AWAY = 0.72, 0.7
#: The ground's row from the side, as a share of the height; the least radius of the ball in px of twice the tile; what
#: lies around a place from above.
GROUND, LEAST, DARK, EVERYWHERE = 0.82, 18.0, (22, 30, 38), Box(-1e3, -1e3, 1e3, 1e3)
#: Whose kits the sheet of figures shows, and what of those kits have not; its squares in px and their ground.
FIGURES = {"tennis": "player", "basketball": "thrower", "volleyball": "players", "soccer": "kicker"}
SPARE = {"racket": (40, 46, 54), "rifle": (40, 46, 54)}
FIGURE, ACROSS, FIGURE_GROUND = 150, 6, (92, 132, 104)
QUALITY = 88  # of JPEG: the smallest at which letters stay clean

SWEEP = ("sweep", "basketball", "--over", "launch.speed=6.8:8.6:73", "--over", "launch.angle=40:70:61")
NEW = "beachvolley"
COMPARE = ("run", "golf", "--compare", "golf/headwind")


@contextmanager
def legible(size: tuple[int, int], across: int) -> Iterator[None]:
    """Letters so large that they can be read where a page shows a picture ``across`` px wide, of which this is the size
    of a part, in px."""
    least = LETTERS * max(1.0, across / SHOWN)
    Lettering.larger = max(1.0, least / Lettering(size[1]).pixels["small"])
    yield
    Lettering.larger = 1.0


def sports() -> None:
    """A picture of each sport on a sheet: its shot and the headline, without the numbers of a poster, which would be
    too small to read."""
    rows, wide = len(SPORTS) // 2, 2 * SIZE[0] + GAP
    sheet = Image.new("RGB", (wide, rows * SIZE[1] + (rows - 1) * GAP), "white")
    for i, name in enumerate(SPORTS):
        scene = sandbox.load(name)
        run = sandbox.simulate(scene)
        view = scene.picture(run, (SIZE[0], WITH_FOOT))
        for layer in view.layers():
            if layer == "balls":
                break
        view.before(view.sheet.painter, view.camera, view.moment)
        with legible(SIZE, wide):
            words = Sheet(SIZE, view.on_dark, view.sheet.surface.subsurface((0, 0), SIZE))
            words.write(
                scene.verdict(run), "small", (view.sheet.frame.left, view.sheet.frame.top), words.ink, bold=True
            )
        sheet.paste(to_image(words.surface), (i % 2 * (SIZE[0] + GAP), i // 2 * (SIZE[1] + GAP)))
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
        with legible(WINDOW, WINDOW[0]):
            program([*COMPARE, "--poster", str(plot)])
        with Image.open(plot) as image:
            image.save(HERE / "compare.jpg", quality=QUALITY, subsampling=0, optimize=True, progressive=True)


def new_scene() -> None:
    """What ``sandbox new`` writes, by the commands that the README shows."""
    with tempfile.TemporaryDirectory() as folder:
        plot = Path(folder, "new.png")
        program(["new", str(Path(folder, NEW))])
        with legible(SIZE, SIZE[0]):
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
        chosen = tomllib.loads((folder / "tile.toml").read_text("utf-8"))
        scene = sandbox.load("/".join(filter(None, (name, chosen.get("shot", "")))))
        view = scene.picture(sandbox.simulate(scene), (2 * TILE[0], 2 * TILE[1]))
        surface = _hero(view, **{key: chosen[key] for key in ("larger", "moment", "wide") if key in chosen})
        small = to_image(surface).resize(TILE, Image.Resampling.LANCZOS)
        small.save(folder / TILE_FILE, quality=QUALITY, optimize=True, progressive=True)


def _hero(view: View[Any], larger: float = 1.0, moment: float = 0.0, wide: float = 0.0) -> pygame.Surface:
    """The thing that decides a run, and the ball on its way there, so large that both are known at a glance; or the
    ball at a ``moment`` in s, in a picture ``wide`` m across."""
    story, (width, height), ball = view.story, view.size, view.ball
    if story is None and not wide:
        return _whole(Shot(view.run.scene, view.run))
    if story is None or wide:
        t, places = moment, np.array([np.add(view.run.state(ball, moment)[:2], side * wide / 2) for side in (-1, 1)])
    else:
        ball = story.balls[-1][0] if story.balls else ball
        end, t = view.run.state(ball, story.at)[:2], story.at
        while t > 0.0 and dist(view.run.state(ball, t)[:2], end) < AWAY * story.side / larger:
            t -= 0.002
        places = np.array([story.place[:2], story.place[2:], view.run.state(ball, t)[:2]])
    low, high = places.min(axis=0), places.max(axis=0)
    scale = larger * FILLS * min(width / (high[0] - low[0]), height / (high[1] - low[1]))
    if wide:
        scale = width / wide
    (x, y), level = (low + high) / 2, view.camera.at[1]
    top = (y if wide else high[1]) - level
    on_ground = view.floor is not None and top * scale < (GROUND - 0.08) * height
    foot = GROUND * height if on_ground else height / 2 + (y - level) * scale
    camera = Camera((x, level), (width / 2, foot), scale)
    if view.floor is None:
        surface = blank(view.size)
        draw_moving(surface, (Ground(EVERYWHERE, getattr(view, "ROOM_COLOUR", DARK)), *view.plan), camera)
    else:
        surface = view.backdrop_of(camera)
    painter = Painter(surface)
    view.behind(painter, camera, t)
    view.draw_driven(painter, camera, t)
    view.trail(painter, camera, ball, t)
    for name in view.present(t):
        radius = max(view.radii[name] * camera.scale, LEAST if name == ball else view.min_radius)
        at = view.spots(camera, np.array([view.position_of(name, t)]), radius, name)[0]
        view.shadow(painter, camera, name, t, at, radius)
        view.looks[name].draw(painter, at, radius, view.turn(name, t), view.unit)
    if not isinstance(view, LongView):
        view.before(painter, camera, t)
    return surface


def figures() -> None:
    """All poses of people, from the side in kits of some sports and from above, into ``docs/figures.png``."""
    colours = {name: scene_colours(installed_folders()[name] / "picture.py") for name in (*FIGURES, "soccer-curl")}
    rows = ceil(len(all_poses()) / ACROSS)
    surface = blank((ACROSS * FIGURE, (rows + 1) * FIGURE))
    surface.fill(FIGURE_GROUND)
    painter = Painter(surface)
    for i, pose in enumerate(all_poses()):
        (row, column), name = divmod(i, ACROSS), list(FIGURES)[i % len(FIGURES)]
        at, tall = ((column + 0.2) * FIGURE, (row + 0.9) * FIGURE), 0.58 * FIGURE
        person = Side(0.0, 1.8, {**SPARE, **colours[name][FIGURES[name]]}, pose)
        person.draw(painter, Eye(Camera((0.0, 0.0), at, tall / 1.8), at[0], at[1] - tall, 50.0))
    above = colours["soccer-curl"]
    kits = [Kit(**above["person"], shirt=shirt) for shirt in above["shirts"]]
    forms: list[dict[str, Any]] = [{}, {"behind": 0.2}, {"arms": 0.9}, {"stretched": True}]
    for column, form in enumerate(forms):
        at = (column + 0.5) * FIGURE, (rows + 0.5) * FIGURE
        kit = kits[min(column, len(kits) - 1)]
        Above((0.0, 0.0), 0.0, kit, **form).draw(painter, Camera((0.0, 0.0), at, 0.45 * FIGURE))
    save_png(surface, HERE.parent / "figures.png")


def _whole(shot: Shot) -> pygame.Surface:
    """A shot with its path, of a scene in which no moment decides."""
    stage = Stage(shot, (3 * TILE[0], 3 * TILE[1]))
    sheet = Canvas(stage.backdrop.copy())
    stage.draw_path(sheet, shot)
    stage.draw_balls(sheet, shot, stage.story)
    return sheet.surface


def post(app: App, kind: int, **values: object) -> None:
    """One event, and one frame."""
    pygame.event.post(pygame.event.Event(kind, values))
    app.tick(FRAME)


if __name__ == "__main__":
    if sys.argv[1:2] == ["tiles"]:
        tiles(sys.argv[2:])
    elif sys.argv[1:2] == ["figures"]:
        figures()
    else:
        for make in (sports, free_throws, compare, new_scene, window, tiles, figures):
            make()
