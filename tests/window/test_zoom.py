"""Every scene is drawn wherever the camera can be zoomed and moved to."""

from __future__ import annotations

from types import SimpleNamespace

import pygame
import pytest

from sandbox.scene import listings
from sandbox.shots import run_of
from sandbox.window.canvas import Canvas
from sandbox.window.shots import Shot
from sandbox.window.shown import Shown
from sandbox.window.stage import Stage
from sandbox.window.stages import Stages
from sandbox.window.viewpoint import Viewpoint

SIZE = (320, 240)
SCENES = sorted(item.name for item in listings() if "/" not in item.name)
#: Far to each side, in px.
AWAY = ((0, 0), (3000, 0), (-6000, 0), (0, 3000), (0, -6000))


def viewpoint_of(shot: Shot) -> Viewpoint:
    """The camera of a shot that is aimed."""
    game = SimpleNamespace(shot=shot, watching=SimpleNamespace(playback=None), memory=SimpleNamespace(in_lab=[]))
    screen = SimpleNamespace(area=pygame.Rect((0, 0), SIZE))
    stages = Stages(game, screen, None, 0.0)
    stages.latest = Stage(shot, SIZE)
    return Viewpoint(game, screen, Shown(game), stages)


@pytest.mark.parametrize("source", SCENES)
@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_any_camera_has_a_picture(source, factor):
    run = run_of(source)
    shot = Shot(run.scene, run)
    view = viewpoint_of(shot)
    view.zoom(factor, (SIZE[0] / 2, SIZE[1] / 2))
    nearest = view.stages.chosen
    for across, down in AWAY:
        view.stages.chosen = nearest
        view.pan(across, down)
        stage = Stage(shot, SIZE, view.stages.chosen)
        sheet = Canvas(stage.backdrop)
        stage.draw_path(sheet, shot)
        stage.draw_balls(sheet, shot, 0.0)
