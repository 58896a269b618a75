"""Handles that a scene declares, dragged: through real events, in all scenes."""

from __future__ import annotations

from dataclasses import replace

import pygame
import pytest

from sandbox.cli.new import new_scene
from sandbox.scene import listings
from sandbox.window.handles import WIND, grips
from sandbox.window.session import Session

from .test_game import Here

SCENES = [listing.name for listing in listings() if "/" not in listing.name]
WIND_KEYS = (WIND.x, WIND.y)


def spot(player, key: str):
    """The place of the handle of a parameter, in px."""
    return next(tuple(map(round, spot.at)) for spot in player.view.targets.visible_grips if key in spot.grip.keys)


def drag(player, key: str, by: tuple[int, int], let_go: bool = True) -> None:
    x, y = spot(player, key)
    player.move((x, y))
    player.press((x, y))
    for part in (0.5, 1.0):
        player.move((round(x + part * by[0]), round(y + part * by[1])))
    if let_go:
        player.release((x + by[0], y + by[1]))
    player.settle()


@pytest.mark.parametrize("source", SCENES)
def test_what_is_dragged_is_where_the_mouse_is_and_can_be_undone(player, source):
    player = player(source, (640, 400))
    game, view = player.game, player.view
    places = {key for grip, *_ in view.targets.visible_grips for key in grip.keys if key and grip.keys != WIND_KEYS}
    assert places, "a scene has something to drag"
    inside = [
        (grip, at)
        for grip, at, *_ in view.targets.visible_grips
        if grip.keys != WIND_KEYS and view.screen.area.contains((*at, 40, 40))
    ]
    grip, at = inside[-1]
    by = tuple(px if key and slope else 0 for px, key, slope in zip((8, -8), grip.keys, grip.slopes, strict=True))
    drag(player, next(filter(None, grip.keys)), by, let_go=False)
    now = next(place for each, place, *_ in view.targets.visible_grips if each.keys == grip.keys)
    assert now == pytest.approx((at[0] + by[0], at[1] + by[1]), abs=1.1)
    assert game.shot.scene is game.session.scene
    assert not game.shots.paths
    player.release(now)
    player.settle()
    player.key(pygame.K_z, pygame.KMOD_CTRL)
    assert game.session.changes.values == {}


def test_a_hoop_that_is_dragged_up_takes_its_board_along(player):
    player = player("basketball")
    value = player.game.session.value
    before = {key: value(key) for key in ("hoop.height", "backboard.bottom", "backboard.top")}
    drag(player, "hoop.distance", (20, -40))
    rises = [value(key) - was for key, was in before.items()]
    assert rises[0] > 0.2
    assert rises == pytest.approx([rises[0]] * 3)
    player.key(pygame.K_z, pygame.KMOD_CTRL)
    assert {key: value(key) for key in before} == before


def test_a_drag_snaps_by_key_and_shows_its_number(player, monkeypatch):
    player = player("basketball")
    monkeypatch.setattr(pygame.key, "get_mods", lambda: pygame.KMOD_SHIFT)
    drag(player, "hoop.distance", (35, -22), let_go=False)
    distance, height = (player.game.session.value(f"hoop.{name}") for name in ("distance", "height"))
    grip = player.game.grasp.grip
    step = next(spot for spot in player.view.targets.visible_grips if spot.grip.keys == grip.keys).step(snap=True)
    assert distance / step == pytest.approx(round(distance / step), abs=1e-6)
    assert height / step == pytest.approx(round(height / step), abs=1e-6)
    assert grip.value_text(player.game.session) == f"hoop distance {distance:.2f} m, height {height:.2f} m"
    player.key(pygame.K_ESCAPE)
    assert player.game.session.changes.values == {}


def test_the_camera_stays_during_a_drag_and_then_shows_all(player):
    player = player("basketball")
    camera = player.view.stages.latest.camera
    drag(player, "hoop.distance", (200, 0), let_go=False)
    assert player.view.stages.latest.camera == camera
    player.release((0, 0))
    player.settle()
    assert player.view.stages.chosen is None
    assert player.view.stages.latest.whole == player.view.stages.latest.camera


def test_the_wind_is_an_arrow(player):
    player = player("golf")
    drag(player, WIND.x, (-40, -8))
    along, up = player.game.session.value("air.wind")
    scale = 4.0 * player.sheet.unit
    assert (along, up) == pytest.approx((-40 / scale, 8 / scale), abs=0.3)
    assert player.game.shot.scene is player.game.session.scene


def test_racked_balls_are_put_anywhere_but_on_another(player):
    player = player("billiards")
    player.pull((-60, 0), let_go=False)
    player.key(pygame.K_ESCAPE)
    player.release((5, 5))
    drag(player, "balls[8].x", (0, -150))
    session = player.game.session
    balls = {ball.name: ball.position for ball in session.scene.build().balls}
    assert len(balls) == 10
    assert balls["8"][1] > 0.3
    before = session.changes
    (x, y), (to_x, to_y) = (spot(player, f"balls[{index}].x") for index in (8, 0))
    drag(player, "balls[8].x", (to_x - x, to_y - y))
    assert "overlap" in player.game.notices[-1][0]
    now = {ball.name: ball.position for ball in session.scene.build().balls}
    assert now["1"] == balls["1"]
    assert session.changes != before  # half way was free
    assert player.game.failure is None


def test_by_key_alone(player):
    player = player("basketball")
    value = player.game.session.value
    before = value("hoop.distance"), value("hoop.height"), value("launch.angle")
    player.key(pygame.K_k)
    player.key(pygame.K_RIGHT)
    player.key(pygame.K_UP)
    player.settle()
    assert value("hoop.distance") > before[0]
    assert value("hoop.height") > before[1]
    assert value("launch.angle") == before[2]
    player.key(pygame.K_ESCAPE)
    player.key(pygame.K_LEFT)
    assert value("launch.angle") > before[2]


def test_the_label_of_a_handle_leaves_the_ball_in_sight(player, written):
    player = player("tennis")
    while "release.height" not in (player.view.targets.picked_keys or ()):
        player.key(pygame.K_k)
    (where,) = [rect for text, rect in written[-200:] if "height 2.75 m" in text][-1:]
    assert not where.inflate(16, 16).collidepoint(player.view.stages.latest.ball_at(player.game.shot))


@pytest.mark.parametrize(
    ("template", "key", "axis"), [("template", "fan.place", 0), ("template_above", "lane.block", 1)]
)
def test_scenes_of_ones_own_have_them(tmp_path, template, key, axis):
    new_scene(tmp_path / "own", template)
    session = Session(str(tmp_path / "own"))
    found = {key: grip for grip in grips(session) for key in grip.keys}
    grip = found[key]
    to = grip.place[0] + 0.1, grip.place[1] + 0.1
    session.change(grip.changes(to, 0.001))
    again = next(each for each in grips(session) if key in each.keys)
    assert again.place[axis] == pytest.approx(to[axis], abs=0.001)


def test_what_is_not_there_has_no_handle():
    session = Session("soccer", {"wall.present": False})
    assert not any("wall.distance" in grip.keys for grip in grips(session))
    grip = next(grip for grip in grips(session) if "goal.distance" in grip.keys)
    assert replace(grip, slopes=(0.0, 1.0)).changes((1.0, 9.0), 0.1).keys() == {"goal.height"}


def test_dragging_never_waits_for_a_run(player):
    player = player("golf")
    player.game.workers.path = Here()
    player.game.workers.path.never = True
    player.game.workers.patience = 0.0
    grip = next(grip for grip, *_ in player.view.targets.visible_grips if "pin.distance" in grip.keys)
    player.game.grasp.begin_drag(grip)
    player.game.grasp.drag_to((200.0, 0.0), 1.0)
    player.frames(2)
    assert player.game.session.value("pin.distance") == 200.0
    assert not player.game.path.settled
    player.game.workers.path.abandon(None)
