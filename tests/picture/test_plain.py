"""The picture of a scene that has none of its own."""

from __future__ import annotations

import shutil
from math import dist
from pathlib import Path

import numpy as np
import pygame
import pytest

import sandbox
from sandbox import Ball, Gravity, Segment, Setup, Surface, Touches, Trap
from sandbox.picture import plain
from sandbox.scene.setup_scene import with_scene
from tests.own_scene import DROP, copy_of
from tests.picture.legible import assert_legible

SCENES = Path(__file__).resolve().parents[2] / "scenes"
SIZE = (640, 360)


@pytest.fixture
def bare(tmp_path: Path):
    """A scene that came with the sandbox, without its picture."""

    def load(name: str) -> sandbox.Scene:
        folder, _, preset = name.partition("/")
        skip = shutil.ignore_patterns("picture.py", "__pycache__")
        return sandbox.load(shutil.copytree(SCENES / folder, tmp_path / folder, ignore=skip) / preset)

    return load


def colour(surface: pygame.Surface, at: tuple[float, float]) -> tuple[int, ...]:
    return tuple(surface.get_at((int(at[0]), int(at[1]))))[:3]


@pytest.mark.parametrize("name", ["basketball", "golf", "soccer-curl", "billiards/nine-ball-break"])
def test_everything_is_in_the_picture(bare, name: str):
    scene = bare(name)
    run = sandbox.simulate(scene)
    picture = scene.picture(run, SIZE)
    assert isinstance(picture, plain.Picture)
    poster, stage = picture.poster(), picture.stage()
    for ball in run.setup.balls:
        pixels = picture.camera.pixels(run.trajectory(ball.name)[:, 1:3])
        assert np.all((pixels > 0) & (pixels < SIZE))
        end = picture.camera.pixel(*run.state(ball.name, run.duration)[:2])
        assert colour(poster, end) != colour(stage, end)
    half = pygame.surfarray.array3d(picture.frame(0.5 * run.duration))
    assert (half != pygame.surfarray.array3d(poster)).any()


def test_what_takes_balls_is_seen(bare):
    run = sandbox.simulate(bare("billiards"))
    picture = run.scene.picture(run, SIZE)
    ground = colour(picture.stage(), picture.camera.pixel(0.0, 0.3))
    for trap in run.setup.traps:
        assert colour(picture.stage(), picture.camera.pixel(*trap.center)) != pytest.approx(ground, abs=20)


@pytest.mark.parametrize("name", ["basketball", "billiards"])
def test_another_run_is_drawn_beside_this_one(bare, name: str):
    scene = bare(name)
    key = "launch.speed" if name == "basketball" else "cue.speed"
    run, other = (sandbox.simulate(sandbox.load(scene.folder, {key: speed})) for speed in (7.4, 5.0))
    alone, beside = scene.picture(run, SIZE), scene.picture(run, SIZE, {"slower": other})
    for ball in other.setup.balls:
        pixels = beside.camera.pixels(other.trajectory(ball.name)[:, 1:3])
        assert np.all((pixels > 0) & (pixels < SIZE))
    for t in (0.4, run.duration):
        assert (pygame.surfarray.array3d(alone.frame(t)) != pygame.surfarray.array3d(beside.frame(t))).any()
    at = beside.camera.pixel(*other.state(other.setup.balls[0].name, 0.4)[:2])
    assert colour(beside.frame(0.4), at) != colour(alone.frame(0.4), at)


@pytest.mark.parametrize("duration", [0.5, 0.55, 0.6])
def test_a_floor_that_is_not_reached_is_not_behind_the_card(tmp_path: Path, duration: float):
    folder = copy_of(DROP, tmp_path / "drop")
    (folder / "picture.py").unlink()
    scene = sandbox.load(folder, {"duration": duration})
    picture = scene.picture(sandbox.simulate(scene), SIZE)
    assert picture.camera.pixel(0.0, 0.0)[1] < picture.card_row


def test_surfaces_are_where_they_are(bare):
    scene = bare("basketball")
    picture = scene.picture(sandbox.simulate(scene), SIZE)
    hoop, stage = scene.parameters.hoop, picture.stage()
    paper = colour(stage, (3, 3))
    ring = picture.camera.pixel(hoop.distance - 0.5 * hoop.inner_diameter - hoop.tube_radius, hoop.height)
    for at in (ring, picture.camera.pixel(1.0, 0.0), (1, picture.camera.pixel(0.0, 0.0)[1])):
        assert sum(paper) - sum(colour(stage, at)) > 200
    middle = picture.camera.pixel(hoop.distance, hoop.height)
    assert abs(sum(paper) - sum(colour(stage, middle))) < 50


PLANK = '''"""A plank that flies and slides along its length."""
from sandbox.engine.model.ball import Body
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Segment, Surface
from sandbox.engine.model.shapes import box
from sandbox.parameters import SceneParameters as Parameters
from sandbox.physics.forces import Gravity


def build(it):
    plank = Body("plank", position=(0.0, 0.5), velocity=(12.0, 0.5), shape=box(1.0, 0.01), mass=1.0,
                 forces=[Gravity(9.81, 1.0)])
    return Setup([plank], [Surface("floor", Segment((-20.0, 0.0), (20.0, 0.0)), 0.3, 0.5)], 1.0)
'''


def test_a_thin_body_is_called_one_and_stands_out_on_its_path(tmp_path: Path):
    (tmp_path / "plank").mkdir()
    (tmp_path / "plank" / "scene.py").write_text(PLANK)
    run = sandbox.simulate(sandbox.load(tmp_path / "plank"))
    picture = run.scene.picture(run, (1280, 720))
    poster = picture.poster()
    assert "a body every 0.05 s   ·   a bead where bodies would overlap" in [text for text, _ in picture.sheet.written]
    assert picture.thickness("plank") < 1.0
    x, y, *_ = run.state("plank", run.duration)
    across, middle = picture.camera.pixel(x - 0.35, y)  # over the path that it came along
    column = [colour(poster, (across, middle + i)) for i in range(-8, 9)]
    light, dark = (max(column[6:11], key=sum), min(column[6:11], key=sum))
    assert sum(light) - sum(dark) > 200
    assert dist(light, picture.LOOK.colour) < 60


def archery() -> sandbox.Run:
    """An arrow past eleven rings of a target, and into a trap behind them."""
    arrow = Ball("arrow", 0.02, 0.01, (0.0, 1.5), (50.0, 4.0), forces=[Gravity(9.81)])
    rings = [Surface(f"ring {i}", Segment((30.0, 0.2 + 0.1 * i), (30.0, 0.3 + 0.1 * i)), 0.0, 0.5) for i in range(11)]
    butts = Trap("butts", (31.0, 2.12), 0.3)
    return sandbox.simulate(Setup([arrow], rings, duration=3.0, traps=[butts]))


def test_a_target_at_the_edge_is_named_over_its_top():
    """To its right the picture ends; to its left is the path, and below it the ground."""
    arrow = Ball("ball", 0.02, 0.01, (0.0, 1.5), (57.0, 3.9), forces=[Gravity(9.81)])
    ground = Surface("ground", Segment((-1e4, 0.0), (1e4, 0.0)), 0.1, 0.8)
    target = Surface("target", Segment((50.0, 0.7), (50.0, 1.9), 0.01), 0.0, 0.5)
    shown = with_scene(sandbox.simulate(Setup([arrow], [ground, target], duration=3.0, until=Touches("target", 1))))
    view = shown.scene.picture(shown, (1280, 720))
    view.poster()
    assert dict(view.sheet.written)["target"].bottom < view.camera.pixel(50.0, 1.9)[1]


def test_targets_are_named_and_in_sight():
    """Of many, those that were touched; a trap is one, too."""
    shown = with_scene(archery())
    view = shown.scene.picture(shown, SIZE)
    view.poster()
    assert "butts" in dict(view.sheet.written)
    x, y = view.camera.pixel(31.0, 2.12)
    assert 0 < x < SIZE[0]
    assert view.sheet.top_row < y < view.card_row


OWN = '''"""A ball tossed in the open."""
from sandbox.kit import AboveView, Landscape, Look, Person, Place, SideView, Stands

class Picture({kind}):
    LOOKS = {{"ball": Look((200, 30, 40))}}
    {place}
'''
OUTSIDE = "place = Place(Landscape(), things=[Person(-0.3, 1.8)])"


@pytest.mark.parametrize(("kind", "place", "dark"), [("SideView", OUTSIDE, False), ("AboveView", "DUSK = None", True)])
def test_text_is_legible_by_itself_and_balls_by_name(tmp_path: Path, kind: str, place: str, dark: bool):
    folder = copy_of(DROP, tmp_path / "drop")
    (folder / "picture.py").write_text(OWN.format(kind=kind, place=place))
    scene = sandbox.load(folder)
    run = sandbox.simulate(scene)
    picture = scene.picture(run, SIZE)
    poster = picture.poster()
    assert_legible(picture.sheet)
    assert picture.on_dark == dark
    assert dist(colour(poster, picture.camera.pixel(*run.state("ball", run.duration)[:2])), (200, 30, 40)) < 90
