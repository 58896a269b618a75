"""What is shown beside the shot: fans, readings, charts, arrows, the tape, the energy; and the lists of commands."""

from __future__ import annotations

import re
from concurrent.futures import wait
from itertools import combinations
from math import hypot

import numpy as np
import pygame
import pytest

from sandbox.picture.sheet import Sheet
from sandbox.window import commands
from sandbox.window.canvas import Canvas
from sandbox.window.charts import Charts
from sandbox.window.fan import SHOTS, Fan, _short
from sandbox.window.fan_layer import FanLayer
from sandbox.window.keys import BINDINGS, LISTED, listed
from sandbox.window.measure import reading
from sandbox.window.session import Session
from sandbox.window.worker import FanShot

PUTT = "golf/putt"


def picture(player) -> np.ndarray:
    return pygame.surfarray.array3d(player.screen)


def differ(a: np.ndarray, b: np.ndarray) -> float:
    """The share of pixels that differ."""
    return float((a != b).any(axis=2).mean())


def wait_for_fan(player) -> Fan:
    player.frames(10)
    fan = player.game.fan
    while not fan.complete:
        wait([fan.work])
        player.frames(1)
    return fan


class TestTheFan:
    def test_spreads_are_told_without_powers_of_ten(self):
        assert [_short(sigma) for sigma in (0.0874, 1.13, 36.4, 372.0, 1240.0)] == ["0.087", "1.1", "36", "370", "1200"]

    def test_it_tells_the_share_that_scores_and_by_what_the_shots_differ(self, player):
        player = player("basketball")
        player.key(pygame.K_f)
        fan = wait_for_fan(player)
        made = sum(shot.scored for shot in fan.shots)
        assert len(fan.shots) == SHOTS
        assert 0 < made < SHOTS
        share, spread = fan.summary()
        assert share.startswith(f"{made} of {SHOTS} score: {100 * made / SHOTS:.0f} ±")
        assert "angle ± 1 deg" in spread
        steps = [shot.points[shot.points[:, 0] > 0.0][0] - shot.points[0] for shot in fan.shots]
        sigma = np.std([hypot(x, y) / t for t, x, y in steps])
        assert sigma == pytest.approx(fan.spread["launch.speed"], rel=0.2)

    def test_it_is_drawn_and_put_away(self, player):
        player = player(PUTT)
        plain = picture(player)
        player.key(pygame.K_f)
        wait_for_fan(player)
        player.frames(SHOTS // 6 + 1)
        assert player.view._fan.drawn == SHOTS
        assert differ(picture(player), plain) > 0.005
        player.key(pygame.K_f)
        assert player.game.fan is None
        assert differ(picture(player), plain) == 0

    @pytest.mark.parametrize("made", [True, False])
    def test_those_that_score_are_green(self, shot_of, made):
        session = Session("basketball", {} if made else {"launch.speed": 5.0})
        shot = shot_of(session)
        fan = Fan(shot)
        fan.shots = [FanShot(shot.track(shot.ball), shot.scored, None)] * 3
        sheet = Sheet((640, 360))
        layer = FanLayer(fan, fan.shot.scene.picture(fan.shot.run, (640, 360)).camera, sheet.size)
        layer.draw(sheet)
        drawn = pygame.surfarray.array3d(layer.surface)[pygame.surfarray.array_alpha(layer.surface) > 60].astype(int)
        assert len(drawn) > 100
        assert np.mean(drawn[:, 1] > drawn[:, 0] + 40) == pytest.approx(int(made), abs=0.05)

    def test_another_aim_has_a_fan_of_its_own(self, player):
        player = player(PUTT)
        player.key(pygame.K_f)
        player.frames(10)
        fan = player.game.fan
        player.key(pygame.K_UP)
        assert player.game.fan is None
        player.frames(10)
        assert player.game.fan.shot is player.game.shot is not fan.shot

    def test_it_can_be_made_wider_and_narrower(self, player):
        player = player(PUTT)
        player.key(pygame.K_RIGHTBRACKET)
        player.frames(10)
        assert player.game.fan.spread["launch.speed"] == pytest.approx(
            2 * 0.015 * player.game.session.value("launch.speed")
        )
        for _ in range(9):
            player.key(pygame.K_LEFTBRACKET)
        assert player.game.fan_width == 1 / 16

    def test_a_shot_that_does_not_begin_as_a_players_has_none(self, shot_of):
        fan = Fan(shot_of(Session("golf/club-head")))
        assert fan.complete
        assert "no fan" in fan.summary()[0]

    def test_a_shot_is_watched_with_its_fan(self, player):
        player = player(PUTT)
        player.key(pygame.K_f)
        player.key(pygame.K_SPACE)
        player.frames(10)
        assert player.game.playback is not None
        assert player.game.fan.shot is player.game.shots[0]


class TestReading:
    def test_the_mouse_on_the_trace_reads_the_ball_there(self, player):
        player = player("golf")
        game, view = player.game, player.view
        t = 0.4 * game.shot.run.duration
        at = view.stage.camera.pixel(*game.shot.run.state("ball", t)[:2])
        mouse = round(at[0]), round(at[1]) - 3
        read = reading(game.shot, view.stage.camera, mouse, 12.0, None)
        assert read.t == pytest.approx(t, rel=0.02)
        assert hypot(read.at[0] - mouse[0], read.at[1] - mouse[1]) < 5
        plain = picture(player)
        player.move(mouse)
        assert differ(picture(player), plain) > 0.01

    def test_away_from_it_nothing_is_read(self, player):
        player = player("golf")
        assert reading(player.game.shot, player.view.stage.camera, (600, 20), 12.0, None) is None

    def test_what_has_not_been_flown_is_not_read(self, player):
        player = player("golf")
        game, view = player.game, player.view
        t = 0.4 * game.shot.run.duration
        at = view.stage.camera.pixel(*game.shot.run.state("ball", t)[:2])
        assert reading(game.shot, view.stage.camera, (round(at[0]), round(at[1])), 12.0, 0.5 * t) is None

    def test_of_many_balls_the_nearest_is_read(self, player):
        player = player("billiards")
        game, view = player.game, player.view
        run, ball = game.shot.run, "5"  # which leaves the axis that the cue ball stays on
        x, y, *_ = run.state(ball, run.duration)
        at = view.stage.camera.pixel(x, y)
        assert reading(game.shot, view.stage.camera, (round(at[0]), round(at[1])), 12.0, None).ball == ball


class TestTheTape:
    def test_it_measures_metres(self, player):
        player = player("basketball")
        camera = player.view.stage.camera
        ends = [tuple(map(round, camera.pixel(*place))) for place in ((1.0, 1.0), (4.0, 5.0))]
        player.key(pygame.K_t)
        player.press(ends[0])
        player.move(ends[1])
        player.release(ends[1])
        assert player.view.tape.length == pytest.approx(5.0, abs=2 / camera.scale)
        assert player.game.pull is None
        player.move((5, 5))
        assert player.view.tape.length == pytest.approx(5.0, abs=2 / camera.scale)
        player.key(pygame.K_ESCAPE)
        assert player.view.tape is None
        assert "tape" not in player.view.on

    def test_the_right_button_lays_it_without_a_key(self, player):
        player = player("basketball")
        player.send(pygame.MOUSEBUTTONDOWN, pos=(300, 300), button=3, touch=False)
        player.move((500, 300))
        player.send(pygame.MOUSEBUTTONUP, pos=(500, 300), button=3, touch=False)
        assert player.view.tape.length == pytest.approx(200 / player.view.stage.camera.scale)
        assert player.game.playback is None


@pytest.mark.parametrize(("key", "least"), [(pygame.K_o, 0.0005), (pygame.K_w, 0.05), (pygame.K_F3, 0.002)])
def test_arrows_charts_and_costs_are_switched(player, key, least):
    player = player("golf")
    plain = picture(player)
    player.key(key)
    assert differ(picture(player), plain) > least
    player.key(key)
    assert differ(picture(player), plain) == 0


def test_the_charts_show_the_state_at_the_time(player, monkeypatch):
    from sandbox.picture.lettering import Lettering

    written = []
    write = Lettering.write
    monkeypatch.setattr(
        Lettering, "write", lambda self, s, text, *a, **k: (written.append(text), write(self, s, text, *a, **k))[1]
    )
    player = player("golf")
    player.key(pygame.K_w)
    player.key(pygame.K_SPACE)
    player.game.playback.playing = False
    player.game.playback.seek(1.5)
    written.clear()
    player.frames(1)
    _, y, vx, vy, _ = player.game.shot.run.state("ball", 1.5)
    height = y - player.game.shot.run.setup.balls[0].radius
    assert {f"{hypot(vx, vy):.2f} m/s", f"{height:.2f} m"} <= set(written)  # over the strips
    assert {f"{hypot(vx, vy):.1f} m/s", f"{height:.1f} m"} <= set(written)  # on the card


@pytest.mark.parametrize("size", [(640, 400), (960, 1080), (1280, 720)])
@pytest.mark.parametrize("source", ["golf", "billiards"])
def test_what_is_written_on_the_charts_does_not_overlap(shot_of, monkeypatch, size, source):
    from sandbox.picture.lettering import Lettering

    placed = []
    write = Lettering.write
    monkeypatch.setattr(Lettering, "write", lambda self, *a, **k: placed.append(write(self, *a, **k)))
    charts = Charts(shot_of(Session(source)))
    for t in (None, 0.5):
        charts.draw(Canvas(pygame.Surface(size)), 20.0, t, pygame.Rect(0, 0, 0, 0))
        assert len(placed) == 6
        assert not any(a.colliderect(b) for a, b in combinations(placed, 2))
        placed.clear()


def test_where_the_energy_goes_lies_over_the_picture_until_a_click(player):
    player = player(PUTT)
    plain = picture(player)
    player.key(pygame.K_j)
    player.settle()
    assert differ(picture(player), plain) > 0.5
    player.click((600, 300))
    assert differ(picture(player), plain) < 0.2
    assert not player.game.shots


class TestTheLists:
    def test_every_key_has_its_command(self):
        known = {*commands.COMMANDS, *commands.NUDGES, *commands.PANEL, *commands.SWITCHES}
        assert {binding.command for binding in BINDINGS} <= known

    @pytest.mark.parametrize("group", LISTED)
    def test_every_command_of_a_group_can_be_clicked(self, player, group, monkeypatch):
        done = []
        monkeypatch.setattr("sandbox.window.pointer.commands.do", lambda view, command: done.append(command))
        player = player(PUTT)
        for number, binding in enumerate(listed(group)):
            commands.COMMANDS[group.lower()](player.view)
            player.frames(1)
            player.click(player.view.choices.places[number][0].center)
            assert done[-1] == binding.command
            player.view.choices = None

    def test_a_button_opens_it_and_closes_it(self, player):
        player = player(PUTT)
        player.button("see")
        assert player.view.choices.group == "see"
        player.button("see")
        assert player.view.choices is None
        player.button("keep")
        player.key(pygame.K_ESCAPE)
        assert player.view.choices is None

    def test_it_stays_open_while_the_window_changes(self, player):
        player = player(PUTT)
        player.button("more")
        player.key(pygame.K_TAB)
        assert player.view.panel is not None
        player.screen = pygame.display.set_mode((900, 600), pygame.RESIZABLE)
        player.send(pygame.VIDEORESIZE, size=(900, 600), w=900, h=600)
        foot = max(place.bottom for place, _ in player.view.choices.places)
        assert 0 < player.view.bar.rect.top - foot < 20

    def test_what_is_shown_is_switched_by_mouse(self, player):
        player = player(PUTT)
        player.button("see")
        row = next(rect for rect, command in player.view.choices.places if command == "charts")
        player.click(row.center)
        assert "charts" in player.view.on
        player.click((300, 100))
        assert player.view.choices is None
        assert player.game.pull is None

    def test_it_says_what_is_on(self, player):
        player = player(PUTT)
        assert player.view.switched == {"ghosts"}
        player.key(pygame.K_TAB)
        player.key(pygame.K_o)
        assert player.view.switched == {"ghosts", "panel", "arrows"}

    def test_with_the_panel_open_the_help_and_the_menu_can_still_be_clicked(self, player):
        player = player(PUTT, (640, 400))
        player.key(pygame.K_TAB)
        player.key(pygame.K_m)
        place, name = player.view.menu.places[-1]
        assert player.view.panel.rect.collidepoint(place.center)
        player.click(place.center)
        assert player.game.session.title == name


def test_accuracy_tells_its_cost_and_its_error(player):
    player = player("golf")
    player.key(pygame.K_a)
    while player.game.jobs:
        player.frames(1)
    assert player.game.session.value("accuracy.level") == "precise"
    text = player.game.notices[-1][0]
    assert text.startswith("accuracy precise: ")
    assert " ms a run; " in text
    assert re.search(r"carry ± [-e.0-9]+ m, total ± [-e.0-9]+ m,", text)
    assert "flight time ± " in text
