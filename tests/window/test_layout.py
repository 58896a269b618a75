"""Nothing that lies over the picture covers the ball, what is aimed at, or another text."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pygame
import pytest

from sandbox.scene import listings
from sandbox.window import commands
from sandbox.window.app import App
from sandbox.window.fan import Cloud
from sandbox.window.fan_card import Bars
from sandbox.window.fan_of_shot import FanKey, FanOfShot
from sandbox.window.game import Game
from sandbox.window.layout import Form, Layout
from sandbox.window.map_of_shot import MapKey, MapOfShot
from sandbox.window.score_map import ScoreMap
from sandbox.window.session import Session
from sandbox.window.view import View

from .test_game import Here

SCENES = sorted(item.name for item in listings() if "/" not in item.name)
#: One of 1920x1080 is laid out as that of 1280x720: all sizes go with the height.
SIZES = ((1280, 720), (640, 400))
SAID = "37 of 100 score: 28 to 47 %", "speed ± 0.087 m/s, angle ± 0.62 deg"
BARS = Bars("entry angle 45.2°, 90 % 42.1° to 48.0°", ("41.0°", "49.5°"), (1, 4, 9, 3), (3, 2, 0, 5), 0.48)
CELLS = np.arange(13 * 9, dtype=np.uint8).reshape(13, 9) % 2


def known(view: View) -> None:
    """A fan and a map as if they had been computed."""
    shot, camera = view.game.shot, view.stages.latest.camera
    cloud = Cloud((0, 0), (0, 0), b"", SAID, 100, 37, 0, BARS)
    view.fan.job.key, view.fan.job.value = FanKey(shot, 1.0, camera, False, 0), cloud
    speed, angle = shot.aim
    view.map.job.key = MapKey(shot.scene_without_aim, shot.scene, 1)
    view.map.job.value = ScoreMap((speed - 1, speed + 1), (angle - 9, angle + 9), ("m/s", "deg"), CELLS, 0.1)


def check(view: View) -> None:
    """Draw, and compare all rectangles with each other."""
    game, stage = view.game, view.stages.latest
    view.draw()
    t = game.watching.playback.t if game.watching.playback is not None else 0.0
    placed, sheet = view.drawing.layout.placed, view.screen.sheet
    kept = stage.kept_clear(game.shot, t)
    numbers = pygame.Rect(sheet.frame.left, sheet.card_row(), sheet.frame.width, sheet.frame.bottom - sheet.card_row())
    for (one, rect), (other, beside) in combinations(placed.items(), 2):
        assert not rect.colliderect(beside), (one, rect, other, beside)
    for name, rect in placed.items():
        assert sheet.frame.contains(rect), (name, rect)
        assert not rect.colliderect(numbers), (name, rect)
        assert rect.collidelist(kept) < 0, (name, rect, kept[rect.collidelist(kept)])
    assert "headline" in placed


@pytest.mark.parametrize("source", SCENES)
def test_nothing_covers_anything_in_any_scene_and_size(source, monkeypatch):
    for part in (FanOfShot, MapOfShot):
        monkeypatch.setattr(part, "next_key", None)
    pygame.display.init()
    app = App(
        Game(Session(source), Here(), patience=60.0), pygame.display.set_mode(SIZES[0], pygame.RESIZABLE), patience=60.0
    )
    view = app.view
    try:
        for size in SIZES:
            pygame.display.set_mode(size, pygame.RESIZABLE)
            for panel in (set(), {"panel"}):
                app.game.memory.lab, view.shown.on = True, {"ghosts", "fan", "map", "charts", "cost", *panel}
                view.resized()
                view.lay_out()
                for _ in range(200):
                    app.game.settle()
                    app.tick(0.1)
                    if not view.busy and app.game.shot is not None:
                        break
                known(view)
                check(view)
                if size == SIZES[-1]:
                    app.game.messages.tell("a message of some length, as of what was written to a file somewhere")
                    spins, view.shown.on = app.game.session.controls.spins, view.shown.on ^ {"pad"}
                    check(view)
                    assert ("pad" in view.drawing.layout.placed) <= bool(spins)
                    line = view.stages.latest.line(app.game.shot)
                    for at in line[:: max(7, len(line) // 8)].tolist():
                        view.targets.mouse = round(at[0]), round(at[1])
                        check(view)
                    view.targets.mouse = (-1, -1)
                    app.game.notices.clear() if isinstance(app.game.notices, list) else None
        app.game.aiming.shoot()
        for share in (0.0, 0.3, 0.6, 1.0):
            app.game.watching.playback.seek(share * app.game.watching.playback.duration)
            app.game.watching.playback.playing = False
            app.tick(0.0)
            if view.stages.up_to_date:
                known(view)
                check(view)
    finally:
        app.close()
        pygame.display.quit()


@pytest.mark.parametrize(("source", "name"), [("billiards/cut", "find"), ("basketball", "shots"), ("golf", "see")])
@pytest.mark.parametrize("size", SIZES)
def test_a_list_leaves_the_ball_and_what_is_aimed_at_in_sight(player, source, name, size):
    player = player(source, size)
    player.game.aiming.shoot()
    player.game.aiming.again()
    commands.do(player.view, name)
    player.settle()
    view = player.view
    view.draw()
    rect = view.shown.overlay.place(view.screen.whole)
    assert view.shown.overlay.name == name
    assert rect.collidelist(view.stages.latest.clear_of(view.game.shot, 0.0)) < 0
    assert rect.collidelist(list(view.drawing.layout.placed.values())) < 0


class TestALayout:
    room = pygame.Rect(0, 0, 100, 60)

    def drawn(self, sizes, kept=(), path=(), at=(100, 0)):
        layout = Layout(self.room, 2, kept, path)
        return layout, layout.put("card", [Form(size, lambda rect: None) for size in sizes], at, "topright")

    def test_what_has_room_is_where_it_is_wanted(self):
        assert self.drawn([(30, 20)])[1] == (70, 0, 30, 20)

    def test_it_goes_to_the_nearest_place_off_what_is_kept(self):
        assert self.drawn([(30, 20)], [pygame.Rect(80, 5, 10, 10)])[1] == (70, 17, 30, 20)

    def test_it_becomes_smaller_and_then_is_left_out(self):
        middle = pygame.Rect(30, 10, 40, 40)
        assert self.drawn([(60, 40), (28, 20)], [middle])[1] == (72, 0, 28, 20)
        layout, rect = self.drawn([(60, 40)], [middle])
        assert rect is None
        assert not layout.placed

    def test_a_path_is_left_free_if_it_can_be(self):
        path = [pygame.Rect(60, 0, 40, 10)]
        assert self.drawn([(30, 20)], path=path)[1] == (70, 12, 30, 20)
        assert self.drawn([(30, 20)], path=[self.room])[1] == (70, 0, 30, 20)
