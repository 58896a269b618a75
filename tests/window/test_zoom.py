"""Every scene is drawn wherever the camera can be zoomed and moved to."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from sandbox.scene import listings, load, simulate
from sandbox.window.canvas import Canvas
from sandbox.window.shots import Shot
from sandbox.window.stage import Stage
from sandbox.window.view import View

SIZE = (320, 240)
SCENES = sorted(item.name for item in listings() if "/" not in item.name)
#: Far to each side, in px.
AWAY = ((0, 0), (3000, 0), (-6000, 0), (0, 3000), (0, -6000))


class Camera(View):
    """Only the part of a view that chooses the camera."""

    def __init__(self, shot: Shot) -> None:
        watching = SimpleNamespace(playback=None)
        self.game, self.stage = SimpleNamespace(shot=shot, watching=watching), Stage(shot, SIZE)
        self.area, self.chosen, self.on = self.stage.backdrop.get_rect(), None, set()


@pytest.mark.parametrize("source", SCENES)
@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_any_camera_has_a_picture(source, factor):
    scene = load(source)
    shot = Shot(scene, simulate(scene))
    view = Camera(shot)
    view.zoom(factor, view.area.center)
    nearest = view.chosen
    for across, down in AWAY:
        view.chosen = nearest
        view.pan(across, down)
        stage = Stage(shot, SIZE, view.chosen)
        sheet = Canvas(stage.backdrop)
        stage.draw_path(sheet, shot)
        stage.draw_balls(sheet, shot, 0.0)
