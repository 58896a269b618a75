"""Fans, readings, charts, arrows, the tape and the energy beside the shot; and the lists of commands."""

from __future__ import annotations

import re
from concurrent.futures import Future
from itertools import combinations
from math import hypot, inf
from time import sleep
from unittest import mock

import numpy as np
import pygame
import pytest

from sandbox.errors import RunError
from sandbox.lab.runs import runs
from sandbox.lab.scatter import players_spread
from sandbox.lab.statistics import wilson
from sandbox.picture.camera import Camera
from sandbox.picture.lettering import Lettering
from sandbox.scene import load, simulate
from sandbox.window import actions, commands
from sandbox.window.background import HUNG
from sandbox.window.canvas import Canvas
from sandbox.window.charts import Charts
from sandbox.window.commands import GROUPS, HINTS, TABLE
from sandbox.window.fan import FEWEST, SHOTS, cloud, density, short, shots_from_end
from sandbox.window.measure import away_from, reading
from sandbox.window.path import LONG
from sandbox.window.score_map import COARSE, FINER, score_map
from sandbox.window.session import Session
from sandbox.window.shown import AHEAD
from sandbox.window.stage import Stage
from sandbox.window.stages import AT_REST
from sandbox.workers import Processes

PUTT = "golf/putt"


def picture(player) -> np.ndarray:
    return pygame.surfarray.array3d(player.screen)


def differ(a: np.ndarray, b: np.ndarray) -> float:
    """The share of pixels that differ."""
    return float((a != b).any(axis=2).mean())


def said(player) -> set[str]:
    """All that is written in the window."""
    written = set()
    write = Lettering.write

    def noted(self, surface, text, *arguments, **named):
        written.add(text)
        return write(self, surface, text, *arguments, **named)

    with mock.patch.object(Lettering, "write", noted):
        player.settle()
        player.view.draw()
    return written


class TestTheFan:
    def test_spreads_are_told_without_powers_of_ten(self):
        assert [short(sigma) for sigma in (0.0874, 1.13, 36.4, 372.0, 1240.0)] == ["0.087", "1.1", "36", "370", "1200"]

    def test_it_gives_the_scoring_fraction_and_what_is_varied(self, player):
        player = player("basketball")
        player.key(pygame.K_f)
        player.settle()
        fan = player.view.fan.job.value
        assert fan.shots == SHOTS
        assert 0 < fan.scored < SHOTS
        share, spread = fan.said
        low, high = wilson(fan.scored / SHOTS, SHOTS)
        assert share == f"{fan.scored} of {SHOTS} score: {100 * low:.0f} to {100 * high:.0f} %"
        assert "angle ± 1 deg" in spread
        assert "side ± 0.8 deg" in spread
        assert (sum(fan.bars.good), sum(fan.bars.rest)) == (fan.scored, SHOTS - fan.scored)
        assert fan.bars.title.startswith("entry angle 4")

    def test_its_shots_score_as_often_as_they_do_alone(self):
        session = Session("basketball", {"launch.speed": 7.5})
        spread = players_spread(session.scene, 1.0)
        draws = np.random.default_rng(1).standard_normal((SHOTS, len(spread)))[:30]
        made = 0
        for row in draws:
            values = {key: p.value + sigma * draw for (key, (p, sigma)), draw in zip(spread.items(), row, strict=True)}
            session.change(values)
            made += simulate(session.scene).result["made"]
        camera = Camera((0.0, 0.0), (100.0, 300.0), 50.0)
        session.reset()
        session.change({"launch.speed": 7.5})
        with mock.patch("sandbox.window.fan.SHOTS", 30), mock.patch("sandbox.window.fan.QUICK", inf):
            found = cloud(session.scene, 1.0, camera, False, "", (640, 360), ((0, 255, 0), (255, 255, 255)))
        assert 0 < found.scored == made < 30

    def test_slow_shots_are_shown_as_they_come(self, monkeypatch):
        session, camera = Session("billiards/cut"), Camera((0.0, 0.0), (300.0, 200.0), 150.0)
        monkeypatch.setattr("sandbox.window.fan.QUICK", 0.0)
        monkeypatch.setattr("sandbox.window.fan._begun", {})
        asked = 1.0, camera, False, "", (640, 360), ((0, 255, 0), (255, 255, 255))
        clouds = [cloud(session.scene, *asked) for _ in range(2)]
        other = cloud(session.scene.changed({"cue.speed": 2.0}), *asked)
        assert [(one.shots, one.left) for one in (*clouds, other)] == [
            (count, SHOTS - count) for count in (FEWEST, 2 * FEWEST, FEWEST)
        ]
        assert clouds[1].said[0].startswith(f"{clouds[1].scored} of {2 * FEWEST} score")

    def test_two_processes_share_the_shots_of_one_that_takes_long(self, monkeypatch):
        def some_fail(scene, keys, points, **how):
            for (speed, *_), run in zip(points, runs(scene, keys, points, **how), strict=False):
                yield RunError("too fast") if speed > session.value("cue.speed") else run

        session, camera = Session("billiards/cut"), Camera((0.0, 0.0), (300.0, 200.0), 150.0)
        monkeypatch.setattr("sandbox.window.fan.SHOTS", 12)
        monkeypatch.setattr("sandbox.window.fan._begun", {})
        monkeypatch.setattr("sandbox.window.fan.runs", some_fail)
        asked = session.scene, 1.0, camera, False, "", (640, 360), ((0, 255, 0), (255, 255, 255))
        monkeypatch.setattr("sandbox.window.fan.QUICK", inf)
        alone = cloud(*asked)
        assert 0 < alone.shots < 12
        assert alone.left == 0
        monkeypatch.setattr("sandbox.window.fan._begun", {})
        monkeypatch.setattr("sandbox.window.fan.QUICK", 0.0)
        assert cloud(*asked).left == 12 - FEWEST
        assert shots_from_end(Session("basketball").scene, 1.0, SHOTS - FEWEST) == []  # which is computed at once
        known = shots_from_end(session.scene, 1.0, 12 - FEWEST)
        assert 0 < len(known) <= 12 - FEWEST
        while len(known) < 12 - FEWEST:
            known = shots_from_end(session.scene, 1.0, 12 - FEWEST - len(known))
        assert cloud(*asked, known) == alone
        assert cloud(*asked).left == 0
        assert cloud(*asked, known) == alone  # none of those that both have computed counts twice

    def test_the_process_of_the_path_helps_with_a_slow_fan(self, player, monkeypatch):
        player = player("billiards/nine-ball-break", (640, 400))
        player.game.workers.helper = Processes(1)
        try:
            player.key(pygame.K_f)
            while not player.view.fan.elsewhere.value:
                player.wait()
                sleep(0.01)
            assert FEWEST <= player.view.fan.job.value.shots < SHOTS
            asked, submit = [], player.game.workers.helper.submit
            monkeypatch.setattr(player.game.workers.helper, "submit", lambda *call: asked.append(call) or submit(*call))
            player.key(pygame.K_UP)
            while not any(work is cloud and not quick for work, _, _, _, quick, *_ in asked):
                player.wait()
                sleep(0.01)
            assert all(scene == player.game.shot.scene for _, scene, *_ in asked)
            assert not any(known for *_, known in asked)  # shots of the fan from before
        finally:
            player.game.workers.helper.close(abandon=True)

    def test_it_stops_early_while_aiming_and_is_complete_at_rest(self, player):
        player = player("golf")
        player.key(pygame.K_f)
        player.game.aiming.nudge({"launch.speed": 70.0})
        player.frames(1, dt=0.0)
        while player.view.fan.job.work is not None:
            player.frames(1, dt=0.0)
        assert player.view.fan.job.value.said[0].startswith(f"{SHOTS} shots; carry 2")
        player.frames(1, dt=AT_REST)
        player.settle()
        assert f" of {SHOTS} score: " in player.view.fan.job.value.said[0]

    def test_it_is_drawn_and_put_away(self, player):
        player = player(PUTT)
        plain = picture(player)
        player.key(pygame.K_f)
        player.settle()
        assert differ(picture(player), plain) > 0.005
        player.key(pygame.K_f)
        assert differ(picture(player), plain) == 0

    @pytest.mark.parametrize("made", [True, False])
    def test_those_that_score_are_green(self, made):
        session = Session("basketball", {} if made else {"launch.speed": 5.0})
        camera = Camera((0.0, 0.0), (100.0, 300.0), 60.0)
        found = cloud(session.scene, 1e-6, camera, False, "", (640, 360), ((0, 200, 0), (250, 250, 250)))
        pixels = np.frombuffer(found.pixels, np.uint8).reshape(found.size[1], found.size[0], 4)
        drawn = pixels[pixels[..., 3] > 60].astype(int)
        assert len(drawn) > 100
        assert np.mean(drawn[:, 1] > drawn[:, 0] + 40) == int(made)

    @pytest.mark.parametrize("source", ["golf", "tennis", "bowling"])
    def test_its_shots_are_where_the_path_is_drawn(self, source, shot_of):
        shot = shot_of(Session(source))
        stage = Stage(shot, (640, 360))
        found = cloud(shot.scene, 1e-9, stage.camera, False, "", stage.size, ((0, 200, 0), (250, 250, 250)))
        rows, columns = np.nonzero(np.frombuffer(found.pixels, np.uint8).reshape(*found.size[::-1], 4)[..., 3] > 128)
        drawn = np.column_stack([columns, rows])[:: max(1, len(rows) // 50)] + found.at + 0.5
        assert max(away_from(stage.line(shot), at)[0] for at in drawn.tolist()) < 2.2  # px; a fan's ends are 3 px wide

    def test_lines_are_where_they_are_and_smooth(self):
        line = np.array([[10.0, 10.0], [90.0, 40.0]])
        drawn = density([line], (100, 50))
        assert (density([line[:1] - 5.0, line[1:]], (100, 50)) > 0.0).sum() <= 32  # two ends, and nothing between
        assert drawn[:, 20:80].sum(axis=0) == pytest.approx(np.hypot(80, 30) / 80, rel=0.15)  # of 1 px
        rows = (drawn[:, 20:80] * np.arange(50)[:, None]).sum(axis=0) / drawn[:, 20:80].sum(axis=0)
        assert rows + 0.5 == pytest.approx(10 + (np.arange(20, 80) + 0.5 - 10) * 3 / 8, abs=0.4)

    def test_it_follows_the_aim_and_is_of_no_other_place(self, player, written):
        player = player(PUTT)
        player.key(pygame.K_f)
        player.settle()
        first = player.view.fan.job.value
        player.key(pygame.K_UP)
        player.settle()
        assert player.view.fan.job.value is not first
        assert player.view.fan.job.key[0] is player.game.shot
        player.view.fan.job.work = Future()  # the next one takes for ever
        player.game.aiming.change({"pin.distance": 6.0})
        player.frames(20)
        assert "the fan ..." in [text for text, _ in written]

    def test_it_can_be_made_wider_and_narrower(self, player):
        player = player(PUTT)
        player.key(pygame.K_RIGHTBRACKET)
        player.settle()
        assert player.view.fan.job.value.said[1].startswith(f"speed ± {short(2 * 0.015 * 2.95)} m/s")
        for _ in range(9):
            player.key(pygame.K_LEFTBRACKET)
        assert player.view.shown.fan_width == 1 / 16

    def test_a_shot_that_does_not_begin_as_a_players_has_none(self, player):
        player = player("golf/club-head")
        player.key(pygame.K_f)
        player.key(pygame.K_m)
        player.frames(2, dt=0.2)
        player.settle()
        assert "no fan" in player.view.fan.job.value.said[0]
        assert "does not start from the player's controls" in str(player.view.map.job.error)

    def test_a_shot_is_watched_with_its_fan(self, player, written):
        player = player(PUTT)
        player.key(pygame.K_f)
        player.key(pygame.K_SPACE)
        player.frames(12)
        player.settle()
        assert player.game.watching.playback is not None
        assert player.view.fan.job.value.shots == SHOTS
        assert player.view.fan.job.value.said[0] in [text for text, _ in written]

    def test_an_endless_shot_is_killed_when_the_aim_changes(self, player, monkeypatch, clock):
        player = player(PUTT)
        player.key(pygame.K_f)
        player.settle()
        killed = []
        view = player.view
        for latest in (view.fan.job, view.map.job):
            monkeypatch.setattr(latest, "abandon", killed.append)
            latest.work, latest.began, latest.work_for = Future(), clock.now - 3.0, "before"
        player.key(pygame.K_UP)
        player.frames(1)
        assert not killed  # a break takes so long
        for latest in (view.fan.job, view.map.job):
            latest.began -= HUNG
        player.frames(1)
        assert len(killed) == 2
        assert view.map.job.work is None
        player.settle()
        assert view.fan.job.key[0] is player.game.shot
        assert view.fan.job.value.shots

    def test_the_path_does_not_wait_for_endless_shots_of_the_fan(self, player, monkeypatch, clock):
        player = player(PUTT)
        player.key(pygame.K_f)
        player.settle()
        killed, latest = [], player.view.fan.elsewhere
        monkeypatch.setattr(latest, "abandon", killed.append)
        latest.work, latest.began, latest.work_for = Future(), clock.now, "before"
        player.game.workers.path.never = True
        player.key(pygame.K_UP)
        player.frames(1)
        assert not killed
        latest.began -= 1.01 * LONG
        player.frames(1)
        assert len(killed) == 1


class TestTheMap:
    def test_its_middle_is_the_shot_and_its_cells_are_outcomes(self):
        session = Session("basketball/free-throw")
        session.change({"launch.aside": 0.0})
        found = score_map(session.scene)
        assert found.place(session.value("launch.speed"), session.value("launch.angle")) == pytest.approx((0.5, 0.5))
        assert 0.02 < found.share < 0.6
        columns, rows = found.cells.shape
        assert found.cells[columns // 2, rows // 2] == 1.0  # as the shot itself does
        for column, row in ((columns // 2, rows // 2), (0, 0), (columns - 1, 4), (8, rows - 1)):
            speed, angle = found.aim((column + 0.5) / columns, (row + 0.5) / rows)
            session.change({"launch.speed": speed, "launch.angle": angle})
            assert simulate(session.scene).result["made"] == (found.cells[column, row] == 1.0)

    def test_its_cells_are_shares_where_shots_scatter_aside(self):
        scene = load("basketball/free-throw")
        straight, aside = (score_map(scene.changed({"launch.aside": sd})) for sd in (0.0, 0.8))
        assert set(np.unique(straight.cells)) == {0.0, 1.0}
        assert {0.8, 0.6} <= set(np.unique(aside.cells).round(3))
        assert 0.6 * straight.share < aside.share < 0.9 * straight.share

    def test_it_is_drawn_refined_and_a_drag_on_it_aims_there(self, player):
        player = player(PUTT)
        plain = picture(player)
        player.key(pygame.K_m)
        player.frames(2, dt=0.2)
        player.settle()
        known = player.view.map.job.value
        assert known.cells.shape in (COARSE, (FINER * COARSE[0], FINER * COARSE[1]))
        assert differ(picture(player), plain) > 0.02
        rect = player.view.targets.cards["map"]
        at = rect.left + rect.width // 4, rect.top + rect.height // 3
        player.move(at)
        player.press(rect.center)
        player.move(at)  # the aim follows
        player.release(at)
        assert player.game.watching.playback is None
        assert player.game.grasp.pull is None
        speed, angle = known.aim((at[0] - rect.left) / rect.width, (rect.bottom - at[1]) / rect.height)
        assert player.game.session.value("launch.speed") == pytest.approx(speed, rel=1e-3)
        assert player.game.session.value("launch.angle") == pytest.approx(angle, abs=0.01)
        player.frames(5, dt=0.2)
        player.settle()
        assert player.view.map.job.value is known  # the aim is on it
        player.key(pygame.K_m)
        player.move((5, player.view.screen.bar.rect.bottom - 5))
        player.game.aiming.reset()
        player.settle()
        player.frames(2, dt=9.0)
        assert differ(picture(player), plain) == 0


class TestReading:
    def test_the_mouse_on_the_trace_reads_the_ball_there(self, player):
        player = player("golf")
        game, view = player.game, player.view
        t = 0.4 * game.shot.run.duration
        stage = view.stages.latest
        at = stage.ball_at(game.shot, t)
        mouse = round(at[0]), round(at[1]) - 3
        read = reading(game.shot, stage.pixels, mouse, 12.0, None)
        assert read.t == pytest.approx(t, rel=0.02)
        assert hypot(read.at[0] - mouse[0], read.at[1] - mouse[1]) < 5
        assert away_from(stage.line(game.shot), read.at)[0] < 1.0  # a picture draws the path of a small ball higher
        plain = picture(player)
        player.move(mouse)
        assert differ(picture(player), plain) > 0.01

        for away, until in (((600, 20), None), (mouse, 0.5 * t)):  # or where it has not flown yet
            assert reading(game.shot, stage.pixels, away, 12.0, until) is None

    def test_of_many_balls_the_nearest_is_read(self, player):
        player = player("billiards")
        game, view = player.game, player.view
        run, ball = game.shot.run, "5"  # which leaves the axis that the cue ball stays on
        x, y, *_ = run.state(ball, run.duration)
        stage = view.stages.latest
        at = stage.camera.pixel(x, y)
        assert reading(game.shot, stage.pixels, (round(at[0]), round(at[1])), 12.0, None).ball == ball


def test_the_player_may_have_to_predict_what_happens(player):
    player = player("basketball", (640, 400))
    view, shot = player.view, player.game.shot
    (card,) = [text for label, text in shot.card if label == "entry angle"]
    contact = next(event.t for event in shot.run.events if event.kind == "impact")
    untils = []
    player.key(pygame.K_f)
    for _ in AHEAD:
        untils.append(view.shown.until(shot))
        player.frames(1)
        written = said(player)
        assert (card in written) == (shot.verdict in written) == (view.shown.ahead == "all")
        assert any("score" in text for text in written) == (view.shown.ahead == "all")
        player.key(pygame.K_y)
    everything, to_contact, metre, nothing = untils
    assert (everything, to_contact, nothing) == (None, contact, 0.0)
    x, y = np.subtract(shot.run.state("ball", metre)[:2], shot.run.state("ball", 0.0)[:2])
    assert hypot(x, y) == pytest.approx(1.0, rel=0.02)
    player.key(pygame.K_y)
    player.key(pygame.K_SPACE)
    player.game.watching.playback.seek(1e9)
    player.frames(1)
    assert shot.verdict in said(player)  # watched, it is shown


class TestTheTape:
    def test_it_measures_metres(self, player):
        player = player("basketball")
        camera = player.view.stages.latest.camera
        ends = [tuple(map(round, camera.pixel(*place))) for place in ((1.0, 1.0), (4.0, 5.0))]
        player.key(pygame.K_t)
        player.press(ends[0])
        player.move(ends[1])
        player.release(ends[1])
        assert player.view.shown.tape.length == pytest.approx(5.0, abs=2 / camera.scale)
        assert player.game.grasp.pull is None
        player.move((5, 5))
        assert player.view.shown.tape.length == pytest.approx(5.0, abs=2 / camera.scale)
        player.key(pygame.K_ESCAPE)
        assert player.view.shown.tape is None
        assert "tape" not in player.view.shown.on

    def test_arrows_move_one_end_and_k_takes_the_other(self, player):
        player = player("basketball")
        aimed = player.game.session.changes
        player.key(pygame.K_t)
        start, end = player.view.shown.tape.start, player.view.shown.tape.end
        assert start == player.game.shot.run.state("ball", 0.0)[:2]
        player.key(pygame.K_RIGHT)
        player.key(pygame.K_UP)
        along, up = np.subtract(player.view.shown.tape.end, end)
        assert along == pytest.approx(up)
        assert up == pytest.approx(actions.STEP / player.view.stages.latest.camera.scale)
        player.key(pygame.K_k)
        player.key(pygame.K_LEFT)
        assert player.view.shown.tape.end[0] < start[0]
        player.key(pygame.K_t)
        assert player.view.shown.tape is None
        assert player.game.session.changes == aimed

    def test_the_right_button_lays_it_without_a_key(self, player):
        player = player("basketball")
        player.send(pygame.MOUSEBUTTONDOWN, pos=(300, 300), button=3, touch=False)
        player.move((500, 300))
        player.send(pygame.MOUSEBUTTONUP, pos=(500, 300), button=3, touch=False)
        assert player.view.shown.tape.length == pytest.approx(200 / player.view.stages.latest.camera.scale)
        assert player.game.watching.playback is None


@pytest.mark.parametrize(("key", "least"), [(pygame.K_o, 0.0005), (pygame.K_w, 0.05), (pygame.K_F3, 0.002)])
def test_arrows_charts_and_costs_are_switched(player, key, least):
    player = player("golf")
    plain = picture(player)
    player.key(key)
    assert differ(picture(player), plain) > least
    player.key(key)
    assert differ(picture(player), plain) == 0


def test_the_charts_show_the_state_at_the_time(player, written):
    player = player("golf")
    player.key(pygame.K_w)
    player.key(pygame.K_SPACE)
    player.game.watching.playback.playing = False
    player.game.watching.playback.seek(1.5)
    written.clear()
    player.frames(1)
    texts = [text for text, _ in written]
    _, y, vx, vy, _ = player.game.shot.run.state("ball", 1.5)
    height = y - player.game.shot.run.setup.balls[0].radius
    for text in (f"{hypot(vx, vy):.1f} m/s", f"{height:.1f} m"):
        assert texts.count(text) == 2  # over the strips, and on the card
    assert {"speed (m/s)", "height (m)", "spin (rpm)", "0 s", "2000"} <= set(texts)
    player.click(player.view.targets.cards["charts"].center)
    assert player.view.shown.overlay is not None  # the same, large
    player.settle()  # it is drawn in another thread


@pytest.mark.parametrize("size", [(640, 400), (960, 1080), (1280, 720)])
@pytest.mark.parametrize("source", ["golf", "billiards"])
def test_what_is_written_on_the_charts_does_not_overlap(shot_of, written, size, source):
    shot = shot_of(Session(source))
    charts = Charts(shot, shot.scene.picture(shot.run, size))
    for t in (None, 0.5):
        form = charts.forms(Canvas(pygame.Surface(size)), t)[0]
        form.draw(pygame.Rect((0, 0), form.size))
        placed = [rect for _, rect in written]
        assert len(placed) > 12  # with the numbers on the axes
        assert not any(a.colliderect(b) for a, b in combinations(placed, 2))
        written.clear()


def test_graphs_lie_over_the_picture_with_earlier_shots(player, written):
    player = player("throws")
    for _ in range(2):
        player.key(pygame.K_SPACE)
        player.settle()
        player.key(pygame.K_RETURN)
    plain = picture(player)
    player.press_named("alt w")
    player.settle()
    assert differ(picture(player), plain) > 0.5
    texts = {text for text, _ in written}
    assert {"forces (N)", "acceleration (m/s^2)"} <= texts
    assert any(text.startswith("shot ") for text in texts)
    player.click((600, 300))
    assert differ(picture(player), plain) < 0.2


def test_the_energy_chart_is_an_overlay_until_a_click(player):
    player = player(PUTT)
    player.key(pygame.K_TAB)
    plain = picture(player)
    player.key(pygame.K_j)
    player.settle()
    assert differ(picture(player), plain) > 0.5
    whole = 1280, player.view.screen.area.height  # over the panel too
    assert player.view.shown.overlay.pictures["chart"].result().get_size() == whole
    player.click((600, 300))
    assert differ(picture(player), plain) < 0.2
    assert not player.game.shots.paths


class TestTheLists:
    def test_every_key_has_one_command(self):
        assert set(HINTS) < {group.lower() for group in GROUPS}
        keys = [key for command in TABLE for key in command.keys]
        assert len(keys) == len(set(keys))

    @pytest.mark.parametrize("group", HINTS)
    def test_every_command_of_a_group_can_be_clicked(self, player, group, monkeypatch):
        done = []
        player = player(PUTT)
        do = commands.do
        monkeypatch.setattr(commands, "do", lambda view, command: done.append(command))
        rows = [command for command in TABLE if command.group.lower() == group and command.meaning]
        for number, command in enumerate(rows):
            player.view.shown.overlay = None
            do(player.view, group)
            player.frames(1)
            player.click(player.view.shown.overlay.places[number][0].center)
            assert done[-1] == command.name

    def test_a_button_toggles_it_and_it_survives_resizing(self, player):
        player = player(PUTT)
        player.button("see")
        assert player.view.shown.overlay.name == "see"
        player.button("see")
        assert player.view.shown.overlay is None
        player.button("keep")
        player.key(pygame.K_ESCAPE)
        assert player.view.shown.overlay is None
        player.button("more")
        player.key(pygame.K_TAB)
        assert player.view.shown.has_panel
        player.screen = pygame.display.set_mode((900, 600), pygame.RESIZABLE)
        player.send(pygame.VIDEORESIZE, size=(900, 600), w=900, h=600)
        foot = max(place.bottom for place, _ in player.view.shown.overlay.places)
        assert 0 < player.view.screen.bar.rect.top - foot < 20

    def test_the_mouse_switches_what_is_shown_and_marks_it(self, player):
        player = player(PUTT)
        assert player.view.switched == {"ghosts", PUTT}
        player.button("see")
        place = next(rect for rect, row in player.view.shown.overlay.places if row.action == "charts")
        player.click(place.center)
        assert "charts" in player.view.shown.on
        player.click((300, 100))
        assert player.view.shown.overlay is None
        assert player.game.grasp.pull is None
        player.key(pygame.K_o)
        assert player.view.switched == {"ghosts", "charts", "arrows", "lab", PUTT}

    def test_help_and_menu_can_be_clicked_with_the_panel_open(self, player):
        player = player(PUTT, (640, 400))
        player.key(pygame.K_TAB)
        player.key(pygame.K_l)
        place, row = max(player.view.shown.overlay.places, key=lambda each: each[0].left)
        assert player.view.panel.rect.collidepoint(place.center)
        player.click(place.center)
        assert player.game.session.title == row.action


def test_accuracy_tells_its_cost_and_its_error(player):
    player = player("golf")
    told, tell = [], player.game.messages.tell
    player.game.messages.tell = lambda *said: (told.append(said[0]), tell(*said))
    player.key(pygame.K_a)
    while player.game.jobs.waiting:
        player.frames(1)
    assert "accuracy precise ..." in told  # at once; what it costs takes a while
    assert player.game.session.value("accuracy.level") == "precise"
    text = player.game.notices[-1][0]
    assert text.startswith("accuracy precise: ")
    assert " ms a run; " in text
    assert re.search(r"carry ± [-e.0-9]+ m, total ± [-e.0-9]+ m,", text)
    assert "flight time ± " in text
