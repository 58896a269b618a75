"""Aiming, shooting and watching, through real events."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import Future
from itertools import pairwise

import numpy as np
import pygame
import pytest

import sandbox
from sandbox.scene import Scene, listings
from sandbox.tasks.sports import sports
from sandbox.window.commands import TABLE
from sandbox.window.screen import SMALLEST
from sandbox.window.shots import LONGEST_FRAME, STEP
from tests.own_scene import HANG

from .conftest import Player
from .test_game import Here


class Slow:
    """Workers that give no result before they are let go."""

    def __init__(self, workers):
        self.workers, self.calls = workers, []

    def submit(self, work, *args):
        self.calls.append((Future(), self.workers.submit(work, *args)))
        return self.calls[-1][0]

    def let_go(self):
        for shown, call in self.calls:
            shown.set_result(call.result())


class Unanswered:
    """Workers that are asked in vain."""

    def submit(self, work, *args):
        return Future()

    def abandon(self, call):
        pass


def picture(player) -> np.ndarray:
    return pygame.surfarray.array3d(player.screen)


def test_a_pull_aims_opposite_and_shows_the_path(player):
    player = player("golf")
    before = player.game.shot
    player.pull((-150, 60), let_go=False)
    assert player.game.watching.playback is None
    assert player.game.shot is not before
    angle = player.game.session.value("launch.angle")
    stretch = player.view.stages.latest.camera.stretch
    assert angle == pytest.approx(np.degrees(np.arctan2(60 / stretch, 150)), abs=0.5)
    assert player.game.shot.run.setup.balls[0].velocity[0] > 0


def test_letting_go_shoots_what_was_shown(player):
    player = player("golf")
    player.pull((-150, 60))
    shot = player.game.shots.paths[-1]
    assert player.game.watching.playback.playing
    again = sandbox.simulate(shot.scene)
    assert again.result == shot.run.result


def test_no_pull_is_taken_while_another_scene_loads(player, monkeypatch):
    """Nor while the picture is still that of the one before; files that are read again do not get in the way."""
    player = player("golf")
    game, at = player.game, (300, 300)
    monkeypatch.setattr(game.workers, "path", Unanswered())
    monkeypatch.setattr(game.workers, "patience", 0.0)
    game.opening.open("soccer")
    player.press(at)
    player.move((200, 320))
    assert game.grasp.pull is None
    assert game.notices[-1][0] == "the scene is still loading"
    player.release((200, 320))
    assert game.watching.playback is None
    game.opening.loading = game.opening.loading._replace(again=True)
    player.press(at)
    assert game.grasp.pull is not None


def test_with_shift_a_pull_aims_ten_times_as_finely(player, monkeypatch):
    player = player("curling")
    session, (x, y) = player.game.session, (600, 300)

    def aim():
        return session.value("launch.angle"), session.value("launch.speed")

    def pulled(by, modifiers):
        """The changes of angle and speed by one more move of the mouse."""
        (angle, speed), (across, down) = aim(), by
        monkeypatch.setattr(pygame.key, "get_mods", lambda: modifiers)
        player.move((x - 150 + across, y + down))
        now = aim()
        player.move((x - 150, y))
        assert aim() == (angle, speed)  # on its way back, the same
        return now[0] - angle, now[1] - speed

    player.press((x, y))
    player.move((x - 150, y))
    usual, fine = pulled((0, 10), pygame.KMOD_NONE), pulled((0, 10), pygame.KMOD_SHIFT)
    assert usual[0] == pytest.approx(np.degrees(np.arctan2(10, 150)), abs=0.01)
    assert fine[0] == pytest.approx(np.degrees(np.arctan2(1, 150)), abs=0.01)
    usual, fine = pulled((-10, 0), pygame.KMOD_NONE), pulled((-10, 0), pygame.KMOD_SHIFT)
    assert 0.05 * usual[1] < fine[1] < 0.15 * usual[1]
    player.move((x - 150, y + 10))
    monkeypatch.setattr(pygame.key, "get_mods", lambda: pygame.KMOD_NONE)
    before = aim()
    player.move((x - 150, y + 10))
    assert aim() == before  # nothing jumps when Shift is released
    player.release((x - 150, y + 10))
    assert player.game.shots.paths[-1].scene.parameters.launch.angle == before[0]


def test_a_longer_pull_is_stronger_and_escape_leaves_it(player):
    player = player("golf")
    speeds = []
    before = player.game.shot.run.result
    for length in (20, 50, 90):
        player.pull((-length, 0), let_go=False)
        speeds.append(player.game.session.value("launch.speed"))
        player.key(pygame.K_ESCAPE)
        assert player.game.shot.run.result == before
    assert speeds == sorted(set(speeds))
    assert not player.game.shots.paths
    player.release((5, 5))
    assert not player.game.shots.paths


@pytest.mark.parametrize("source", [listing.name for listing in listings() if "/" not in listing.name])
class TestPullsInEveryScene:
    """From the ball itself, opposite to the scene's own shot, as far as the window reaches."""

    @pytest.fixture
    def pull(self, source):
        """Gives the speed of a pull by so many px."""
        player = Player(Here(), source)
        stage, shot, game = player.view.stages.latest, player.game.shot, player.game
        angle = np.radians(shot.aim[1])
        way = np.array([-np.cos(angle), np.sin(angle) * stage.camera.stretch])
        game.grasp.begin_pull(
            tuple(map(round, stage.ball_at(shot))),
            player.screen.get_size(),
            player.view.screen.area.height,
            stage.camera.stretch,
        )

        def speed_of(length):
            game.grasp.pull.vector = tuple(length * way / np.hypot(*way))
            return game.grasp.pull.changes(game.session)[game.session.controls.speed]

        game.grasp.pull.vector = tuple(way)
        yield speed_of, game.grasp.pull.full, shot.aim[0], game.session.controls
        player.app.close()

    def test_a_pull_reaches_the_default_softer_and_stronger_shots(self, pull):
        speed_of, full, own, controls = pull
        speeds = [speed_of(length) for length in np.arange(8.0, full + 0.5, 0.5)]
        assert min(abs(speed / own - 1.0) for speed in speeds) < 0.01
        assert speeds == sorted(speeds)
        assert speeds[0] == pytest.approx(controls.softest * own, rel=0.1)
        assert speeds[-1] == pytest.approx(min(2.0 * own, controls.full_pull_speed), rel=0.05)
        assert speed_of(2.0 * full) == speed_of(full + 5.0)

    def test_a_few_px_change_little(self, pull):
        speed_of, full, own, _ = pull
        speeds = [speed_of(length) / own for length in np.arange(8.0, full, 3.0)]
        assert max(np.diff(speeds)) < 0.18
        near = [speed_of(length) / own for length in np.arange(0.6 * full, 0.75 * full, 3.0)]
        assert max(np.diff(near)) < 0.06


def test_a_pull_from_rest_has_a_strength_too(player):
    """A cradle's ball is let go from rest: its own speed is 0."""
    player = player("collisions/cradle-5")
    player.pull((-150, 0), let_go=False)
    assert 0.5 < player.game.session.value("launch.speed") < 2.0


def test_the_strongest_pull_is_what_strings_allow(player):
    """One ball of a cradle, 0.25 m long, hangs 0.05 m aside: 1.53 m/s lifts it as high as its string is long."""
    player = player("collisions/cradle-5")
    player.pull((-2000, 0))
    assert player.game.session.value("launch.speed") == pytest.approx(0.99 * 1.534, rel=1e-3)
    assert not (player.game.messages.message and player.game.messages.message.bad)


def test_a_click_is_no_shot_and_wheel_and_keys_aim(player):
    player = player("golf")
    player.click((400, 300))
    assert not player.game.shots.paths
    value = player.game.session.value
    for key, parameter, by in (
        (pygame.K_LEFT, "launch.angle", 1),
        (pygame.K_RIGHT, "launch.angle", -1),
        (pygame.K_UP, "launch.speed", 1),
        (pygame.K_DOWN, "launch.speed", -1),
        (pygame.K_e, "launch.spin", 1),
        (pygame.K_d, "launch.spin", -1),
    ):
        before = value(parameter)
        player.key(key)
        assert np.sign(value(parameter) - before) == by
    before = value("launch.spin")
    player.send(pygame.MOUSEWHEEL, x=0, y=2, flipped=False)
    assert value("launch.spin") == pytest.approx(before + 200)


@pytest.mark.parametrize("source", [listing.name for listing in listings() if "/" not in listing.name])
def test_what_is_drawn_was_built_once(source, monkeypatch):
    """For each set of parameters, however they were changed; and once more to check a file that is opened."""
    built, build = [], Scene.build
    monkeypatch.setattr(Scene, "build", lambda scene: built.append(scene.parameters) or build(scene))
    player = Player(Here(), source, SMALLEST)
    try:
        assert len(built) == 2
        player.key(pygame.K_UP)
        for x, y in [spot.at for spot in player.view.targets.visible_grips][:1]:
            player.press((round(x), round(y)))
            player.move((round(x) + 9, round(y) + 7))
            player.release((round(x) + 9, round(y) + 7))
        player.key(pygame.K_z, pygame.KMOD_CTRL)
        player.settle()
        assert len(built) > 3
        assert all(one != other for one, other in pairwise(built[1:]))
    finally:
        player.app.close()


def test_a_short_run_starts_in_slow_motion_and_says_so(player, written):
    player = player("volleyball/spike")
    player.key(pygame.K_SPACE)
    player.settle()
    assert player.game.watching.playback.rate == 1 / 4
    assert any("slow motion, 4 times slower" in text for text, _ in written)
    player.key(pygame.K_PLUS)
    player.key(pygame.K_RETURN)
    player.key(pygame.K_SPACE)
    player.settle()
    assert player.game.watching.playback.rate == 1 / 4
    player.key(pygame.K_PLUS)
    player.game.watching.watch(player.game.shot)
    assert player.game.watching.playback.rate == 1 / 2  # the player's own choice


class TestWatching:
    @pytest.fixture
    def player(self, player):
        player = player("golf")
        player.key(pygame.K_SPACE)
        return player

    def test_the_clock_pauses_steps_restarts_and_waits_for_frames(self, player):
        playback = player.game.watching.playback
        player.frames(10)
        player.key(pygame.K_SPACE)
        t = playback.t
        assert t > 0
        player.frames(5)
        assert playback.t == t
        player.key(pygame.K_PERIOD)
        assert playback.t == pytest.approx(t + STEP)
        player.key(pygame.K_COMMA)
        assert playback.t == pytest.approx(t)
        player.key(pygame.K_r)
        assert playback.t < t
        t = playback.t
        player.frames(1, dt=2.0)
        assert playback.t == pytest.approx(t + LONGEST_FRAME)

    def test_speeds_are_1_16_to_8_and_the_time_line_can_be_dragged(self, player):
        playback, line = player.game.watching.playback, player.view.screen.bar.line
        for key, rate in ((pygame.K_MINUS, 1 / 16), (pygame.K_EQUALS, 8)):
            for _ in range(12):
                player.key(key)
            assert playback.rate == rate
        player.press(line.center)
        assert playback.t == pytest.approx(playback.duration / 2, rel=0.02)
        player.move((line.right, line.centery))
        assert playback.over
        player.release((line.right, line.centery))

    def test_earlier_shots_can_be_seen_again(self, player):
        player.key(pygame.K_RETURN)
        for length in (-100, -160):
            player.pull((length, 40))
            player.key(pygame.K_RETURN)
        _, first, second = player.game.shots.paths
        player.key(pygame.K_p)
        assert player.game.shot is second
        player.key(pygame.K_p)
        assert player.game.shot is first
        player.key(pygame.K_n)
        assert player.game.shot is second


class TestScenes:
    def test_presets_follow_each_other(self, player):
        player = player("golf")
        player.key(pygame.K_PAGEDOWN)
        assert player.game.session.title.startswith("golf/")
        player.key(pygame.K_PAGEUP)
        assert player.game.session.title == "golf"

    def test_the_menu_opens_another_scene_by_mouse(self, player):
        player = player("golf")
        player.button("menu")
        player.click(next(rect.center for rect, what in player.view.shown.overlay.places if what == "billiards"))
        rows = [place for place in player.view.shown.overlay.places if not isinstance(place[1], str)]
        player.move(rows[0][0].center)
        player.send(pygame.MOUSEWHEEL, x=0, y=-1, flipped=False)
        rect, row = [place for place in player.view.shown.overlay.places if not isinstance(place[1], str)][1]
        player.click(rect.center)
        assert row.action.startswith("billiards/")
        assert player.game.session.title == row.action
        assert player.view.shown.overlay is None

    def test_the_menu_opens_another_scene_by_key(self, player):
        player = player("golf")
        player.key(pygame.K_l)
        player.key(pygame.K_DOWN)
        names = [sport.name for sport in sports()]
        assert player.view.shown.overlay.chosen.action == names[names.index("golf") + 1]
        player.key(pygame.K_UP)
        player.key(pygame.K_UP)
        assert player.view.shown.overlay.chosen.action == names[names.index("golf") - 1]
        player.key(pygame.K_LEFT)
        player.key(pygame.K_UP)
        chosen = player.view.shown.overlay.chosen.action
        assert chosen.startswith(f"{names[-1]}/")
        assert not chosen.startswith("golf")
        player.key(pygame.K_RETURN)
        assert player.game.session.title == chosen
        assert player.view.shown.overlay is None


def test_impossible_parameters_are_reported_and_not_taken(player):
    player = player("golf")
    before = player.game.session.scene
    assert not player.game.aiming.change({"launch.speed": -3.0})
    ((text, bad),) = player.game.notices
    assert bad
    assert text == "the window's launch.speed = -3.0: must be from 0 to 340 m/s"
    assert player.game.session.scene is before
    player.frames(3)


@pytest.mark.parametrize("size", [(640, 400), (1920, 1080), (500, 300)])
def test_any_size_is_drawn(player, size):
    player = player("golf")
    player.screen = pygame.display.set_mode(size, pygame.RESIZABLE)
    player.send(pygame.VIDEORESIZE, size=size, w=size[0], h=size[1])
    bar = player.view.screen.bar
    scale = min(1.0, *(px / least for px, least in zip(size, SMALLEST, strict=True)))  # all of it is seen
    assert bar.rect.bottom * scale == pytest.approx(size[1], abs=1)
    assert player.view.stages.latest.size[0] * scale == pytest.approx(size[0], abs=1)
    assert picture(player)[:, : round(scale * bar.rect.top)].std() > 10
    assert picture(player)[:, round(scale * bar.rect.top) + 1 :].std() > 10
    player.click(tuple(round(scale * px) for px in bar.buttons["see"].center))
    assert player.view.shown.overlay.name == "see"
    player.key(pygame.K_ESCAPE)
    player.pull((-60, 20))
    player.frames(3)
    player.key(pygame.K_h)
    player.key(pygame.K_l)


def test_every_key_does_something_harmless_in_every_state(player, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some of them write files
    player = player("golf/putt", (640, 400))
    player.game.workers.helper = Unanswered()  # fans, maps and what is found have tests of their own, and take seconds
    for state in ("aiming", "playing", "over"):
        for command, key in [(each, key) for each in TABLE for key in each.keys]:
            if command.name in ("quit", "next_preset", "fullscreen", "animation", "mark"):
                continue  # they have tests of their own
            if state != "aiming" and command.group not in ("Play", "Watch", "See"):
                continue  # the others do the same
            if state != "aiming" and player.game.watching.playback is None:
                player.game.aiming.shoot()
            if state == "over":
                player.game.watching.playback.seek(1e9)
            player.press_named(key)
            assert player.game.running
        for _ in range(5):
            player.key(pygame.K_ESCAPE)


def test_full_screen_and_back(player):
    player = player("golf/putt", (800, 500))
    display = pygame.display.get_desktop_sizes()[0]
    for size in (display, (800, 500)):
        player.key(pygame.K_F11)
        player.frames(2)
        assert player.view.screen.canvas.get_size() == size
        assert player.view.screen.bar.rect.bottom == size[1]


def test_the_key_for_leaving_leaves(player):
    player = player("golf/putt")
    player.key(pygame.K_q)
    assert player.game.running
    player.key(pygame.K_q, pygame.KMOD_CTRL)
    assert not player.game.running


class TestASlowRun:
    """A frame that does not wait for the path of its shot."""

    @pytest.fixture
    def slow(self, player):
        player = player("golf/putt")
        player.game.workers.path, player.game.workers.patience = Slow(player.game.workers.path), 0.0
        return player

    def test_shows_the_path_before_until_it_is_there(self, slow):
        before = slow.game.shot
        slow.key(pygame.K_UP)
        slow.frames(3)
        assert slow.game.shot is before
        slow.game.workers.path.let_go()
        slow.game.settle()
        assert slow.game.shot.scene is slow.game.session.scene

    def test_a_shot_begins_as_soon_as_it_is_there(self, slow):
        slow.key(pygame.K_UP)
        slow.key(pygame.K_SPACE)
        assert slow.game.watching.playback is None
        slow.game.workers.path.let_go()
        slow.frames(2)
        assert slow.game.watching.playback.playing
        assert slow.game.shots.paths[-1].scene is slow.game.session.scene

    def test_a_process_that_is_killed_is_begun_again(self, player):
        player = player("golf/putt")
        player.game.workers.path.kill()
        player.key(pygame.K_UP)
        player.key(pygame.K_UP)
        player.settle()
        assert player.game.shot.scene is player.game.session.scene


def test_closing_in_mid_flight_ends_it(player):
    player = player("golf")
    player.key(pygame.K_SPACE)
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    player.app.run()
    assert not player.game.running


def test_without_a_display_it_says_so(tmp_path):
    hidden = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "XDG_RUNTIME_DIR")
    environment = {key: value for key, value in os.environ.items() if key not in hidden}
    code = "import sys; from sandbox.cli import main; sys.exit(main(['play', 'golf']))"
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=HANG, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "no display" in done.stderr
    assert "sandbox run" in done.stderr
