"""The window in three states, beside golden pictures."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

from sandbox.picture.path import simplify
from sandbox.window.stage import draw_line

SIZE = (640, 400)


def test_aiming(player, golden):
    player = player("golf/golf-game", SIZE)
    player.pull((-40, 22), let_go=False)
    player.frames(4)  # the numbers are those of the path
    golden.check("window-aiming", player.screen)


def test_watching_with_an_earlier_shot(player, golden):
    player = player("golf/golf-game", SIZE)
    for pull in ((-70, 40), (-90, 26)):
        player.key(pygame.K_RETURN)
        player.settle()
        player.pull(pull)
    player.move((400, 100))
    player.game.watching.playback.seek(3.0)
    player.game.watching.playback.playing = False
    player.settle()
    player.view.changed = True
    player.frames()
    golden.check("window-watching", player.screen)


def test_the_panel(player, golden):
    player = player("golf/putt", SIZE)
    player.key(pygame.K_TAB)
    player.move((100, 100))
    player.frames(3)
    golden.check("window-panel", player.screen)


def test_a_hoop_that_is_dragged(player, golden):
    player = player("basketball/free-throw", SIZE)
    x, y = next(at for grip, at, *_ in player.view.targets.visible_grips if "hoop.distance" in grip.keys)
    player.press((round(x), round(y)))
    player.move((round(x) + 40, round(y) - 20))
    player.settle()
    golden.check("window-handles", player.screen)


def test_the_table_of_shots_and_what_is_pinned(player, golden):
    player = player("basketball/free-throw", SIZE)
    for speed in (7.3, 7.5, 7.7):
        player.game.aiming.change({"launch.speed": speed})
        player.settle()
        player.game.aiming.shoot()
        player.game.aiming.again()
    player.game.watching.pin(player.game.shots.rows[1])
    player.key(pygame.K_q)
    player.view.shown.overlay.sort("launch.speed")
    player.view.shown.overlay.chosen = player.game.shots.rows[1]
    player.settle()
    player.view.draw()
    golden.check("window-shots", player.screen)


def test_where_the_tip_hits_and_what_can_be_aimed_at(player, golden):
    player = player("billiards/cut", SIZE)
    player.game.aiming.change({"cue.english": -0.3, "cue.follow": 0.2})
    player.settle()
    player.key(pygame.K_SLASH)
    player.settle()
    golden.check("window-find", player.screen)
    player.key(pygame.K_ESCAPE)
    player.settle()
    golden.check("window-tip", player.screen)


#: What is shown over a free throw that has been thrown, by the keys that show it.
SHOWN = {"charts": "w", "graphs": "alt w", "energy": "j", "tape": "t", "arrows": "o", "keys": "h"}


@pytest.mark.parametrize("name", SHOWN)
def test_what_a_key_shows(player, golden, name: str):
    player = player("basketball/rattle", SIZE)
    player.key(pygame.K_SPACE)
    player.game.watching.playback.seek(1.2)
    player.game.watching.playback.playing = False
    player.press_named(SHOWN[name])
    player.settle()
    player.view.changed = True
    player.frames(3)
    golden.check(f"window-{name}", player.screen)


def test_a_fan(player, golden):
    player = player("soccer-curl", SIZE)
    player.press_named("f")
    player.settle()
    player.view.changed = True
    player.frames(3)
    golden.check("window-fan", player.screen)


def test_a_line_is_as_wide_in_every_direction():
    for angle in np.radians([0, 20, 45, 70, 90]):
        surface = pygame.Surface((200, 200))
        ends = np.array([[100, 100], [100 + 80 * np.cos(angle), 100 + 80 * np.sin(angle)]])
        draw_line(surface, ends, 6.0, (255, 255, 255))
        area = pygame.surfarray.array3d(surface)[:, :, 0].sum() / 255
        assert area == pytest.approx(6.0 * 80, rel=0.15)


@pytest.mark.parametrize("width", [3, 4, 5, 6, 8, 11])
def test_nothing_shows_through_a_line(width):
    across, down = np.mgrid[0:100, 0:100]
    for angle in np.radians(np.arange(0.0, 180.0, 7.3)):
        surface = pygame.Surface((100, 100))
        ahead = np.array([np.cos(angle), np.sin(angle)])
        draw_line(surface, np.array([(50.3, 49.6) + along * ahead for along in (-40, -10, 15, 40)]), width, (255,) * 3)
        along = (across - 50.3) * ahead[0] + (down - 49.6) * ahead[1]
        off = np.abs((down - 49.6) * ahead[0] - (across - 50.3) * ahead[1])
        inside = (np.abs(along) < 38) & (off < width / 2 - 1)
        assert pygame.surfarray.array3d(surface)[inside].min() > 140


def test_few_points_keep_to_the_line_and_to_its_corners():
    angles = np.linspace(0, np.pi, 400)
    arch = np.column_stack([300 - 200 * np.cos(angles), 300 - 200 * np.sin(angles)])
    path = np.vstack([arch, arch + np.array([400, 0])])  # a bounce between
    points = simplify(path)
    assert len(points) < 0.2 * len(path)
    assert np.hypot(*(points - (500, 300)).T).min() < 3
    between = (points[1:] + points[:-1]) / 2
    away = [np.hypot(*(path - point).T).min() for point in between]
    assert max(away) < 2.5


@pytest.mark.parametrize("source", ["golf", "basketball", "billiards", "soccer"])
def test_a_shot_that_goes_nowhere_is_drawn(player, source, written):
    player = player(source, SIZE)
    player.game.aiming.change({player.game.session.controls.speed: 0.0})
    player.key(pygame.K_w)
    player.key(pygame.K_o)
    assert player.game.session.value(player.game.session.controls.speed) == 0.0
    for _ in ("aiming", "watching"):
        player.settle()
        assert not player.game.notices
        player.key(pygame.K_SPACE)
    assert not [text for text, _ in written if "cannot be drawn" in text]
