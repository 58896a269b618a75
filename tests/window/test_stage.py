"""A path is only drawn on the stage that was composed for it, whatever the player does; and how the stage is seen."""

from __future__ import annotations

import os
from concurrent.futures import Future
from itertools import pairwise
from pathlib import Path

os.environ.setdefault("SDL_VIDEODRIVER", "dummy")

import pygame
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sandbox.scene import listings, load, simulate
from sandbox.window import commands
from sandbox.window.app import App
from sandbox.window.canvas import Canvas
from sandbox.window.fan_of_shot import OUTDATED, FanOfShot
from sandbox.window.game import Game
from sandbox.window.pointer import NOTCH
from sandbox.window.screen import SMALLEST
from sandbox.window.session import Session
from sandbox.window.shots import LONGEST_FRAME, PATHS, Shot
from sandbox.window.stage import Stage
from sandbox.window.view import CARD, View

from .test_game import Here

SIZE = (480, 400)

#: What a player does, by what it is called when it fails.
ACTIONS = {
    "place": lambda view: view.game.aiming.change(PLACES[view.game.session.base.name][0]),
    "other place": lambda view: view.game.aiming.change(PLACES[view.game.session.base.name][1]),
    "gravity": lambda view: view.game.aiming.change({"accuracy.level": "fast"}),
    "stronger": lambda view: commands.do(view, "push"),
    "turned": lambda view: commands.do(view, "turn"),
    "reset": lambda view: commands.do(view, "reset"),
    "undo": lambda view: commands.do(view, "undo"),
    "redo": lambda view: commands.do(view, "-undo"),
    "shoot": lambda view: view.game.aiming.shoot(),
    "to the end": lambda view: view.game.watching.playback and view.game.watching.playback.seek(1e9),
    "Enter": lambda view: commands.do(view, "again"),
    "Esc": lambda view: commands.do(view, "back"),
    "B": lambda view: commands.do(view, "rack"),
    "P": lambda view: commands.do(view, "-next_shot"),
    "N": lambda view: commands.do(view, "next_shot"),
    "V": lambda view: commands.do(view, "view"),
    "next preset": lambda view: commands.do(view, "next_preset"),
    "saved": lambda view: setattr(view.game.session, "watch", Saved([view.game.session.file])),
    "Tab": lambda view: commands.do(view, "panel"),
    "zoomed": lambda view: commands.do(view, "zoom"),
    "fit": lambda view: commands.do(view, "fit"),
    "pull": lambda view: view.pull_for_test(),
    "drag": lambda view: view.drag_for_test(),
    "aim as the first": lambda view: view.game.shots.rows and view.game.aiming.aim_as(view.game.shots.rows[0]),
    "another scene": lambda view: view.game.opening.open("golf/putt"),
}
PLACES = {
    "golf": ({"pin.distance": 60.0}, {"pin.distance": 200.0, "air.wind": [-4.0, 0.0]}),
    "billiards": ({"rack": "eight-ball"}, {"cue.speed": 1.0, "ball.friction": 0.2}),
}


class Saved(list):
    """Files that somebody has just saved."""

    def saved(self, dt: float) -> list[Path]:
        files = self[:]
        self.clear()
        return files


class Watched(View):
    """Checks each time that it draws a shot that the stage under it is that shot's."""

    def pull_for_test(self) -> None:
        area = self.screen.area
        self.game.grasp.begin_pull((200, 200), area.size, area.height, 1.0)
        self.game.grasp.pull_to((150, 210))

    def drag_for_test(self) -> None:
        for grip, *_ in self.targets.visible_grips[-2:-1]:
            self.viewpoint.hold()
            self.game.grasp.begin_drag(grip)
            self.game.grasp.drag_to((grip.place[0] + 0.1, grip.place[1] + 0.1), 0.01)

    def draw(self):
        draw_path = Stage.draw_path

        def on_its_own(stage, sheet, shot, until):
            if self.game.watching.playback is not None:
                assert stage.shot.scene.parameters == shot.scene.parameters
            else:
                assert stage.shot.place == shot.place == self.game.session.place
            draw_path(stage, sheet, shot, until)

        def raised(error):  # what the window would only report
            raise error

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Stage, "draw_path", on_its_own)
            patch.setattr("sandbox.window.drawing.reason", raised)
            super().draw()


@pytest.fixture(scope="module")
def screen():
    pygame.display.init()
    yield pygame.display.set_mode(SIZE, pygame.RESIZABLE)
    pygame.display.quit()


def settled(app: App) -> None:
    for _ in range(2000):
        app.game.settle()
        app.tick(0.2)
        if not app.view.busy and app.game.path.settled and not app.game.watching.awaited:
            return
    raise AssertionError("never at rest")


@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    source=st.sampled_from(["golf/pond", "billiards"]), actions=st.lists(st.sampled_from(sorted(ACTIONS)), max_size=9)
)
def test_the_stage_belongs_to_the_shot(screen, source, actions):
    app = App(Game(Session(source), Here(), patience=5.0), screen)
    app.view = app.pointer.view = Watched(app.game, screen, patience=5.0)
    try:
        settled(app)
        for action in actions:
            if app.game.grasp.holds:
                app.game.grasp.release()
                app.view.viewpoint.release()
            if app.game.session.base.name not in PLACES:
                app.game.opening.open(source)
            ACTIONS[action](app.view)
            app.tick(0.016)
        app.game.grasp.release()
        app.view.viewpoint.release()
        settled(app)
        stage, shot = app.view.stages.latest, app.game.shot
        assert stage.shot.scene.parameters == shot.scene.parameters
        assert stage.shot.scene.folder == shot.scene.folder
        if app.game.watching.playback is None:
            assert shot.scene.parameters == app.game.session.scene.parameters
    finally:
        app.close()


class TestTheCamera:
    def test_it_zooms_out_for_a_strong_pull_and_in_for_a_weak_one(self, player):
        player = player("golf/putt")
        scale = player.view.stages.latest.camera.scale
        player.game.aiming.change({"launch.speed": 30.0})
        player.settle()
        far = player.view.stages.latest.camera.scale
        assert far < 0.5 * scale
        player.game.aiming.change({"launch.speed": 2.9})
        player.settle()
        assert player.view.stages.latest.camera.scale > 0.8 * scale

    def test_a_little_change_of_the_aim_leaves_it_alone(self, player):
        player = player("golf")
        camera = player.view.stages.latest.camera
        for _ in range(3):
            player.key(pygame.K_DOWN)
            player.settle()
        assert player.view.stages.latest.camera == camera
        assert player.view.stages.latest.shot is player.game.shot

    def test_ctrl_and_wheel_or_keys_zoom_drag_moves_and_a_key_fits(self, player, monkeypatch):
        player = player("golf")
        whole = player.view.stages.latest.camera
        monkeypatch.setattr(pygame.key, "get_mods", lambda: pygame.KMOD_CTRL)
        player.move((640, 300))
        player.send(pygame.MOUSEWHEEL, x=0, y=3, flipped=False)
        player.settle()
        near = player.view.stages.latest.camera
        assert near.scale > 1.4 * whole.scale
        assert near.world(640, 300) == pytest.approx(whole.world(640, 300))
        assert player.game.session.changes.values == {}
        player.press((640, 300))
        player.move((700, 280))
        player.release((700, 280))
        player.settle()
        assert player.view.stages.latest.camera.world(700, 280) == pytest.approx(near.world(640, 300))
        player.key(pygame.K_EQUALS, pygame.KMOD_CTRL)
        player.key(pygame.K_RIGHT, pygame.KMOD_ALT)
        player.key(pygame.K_0, pygame.KMOD_CTRL)
        player.settle()
        assert player.view.stages.latest.camera == whole

    def test_it_keeps_zoom_and_place_in_play_pause_and_replay(self, player):
        player = player("basketball", (640, 400))
        player.view.viewpoint.zoom(3.0, (200, 150))
        player.settle()
        near = player.view.stages.latest.camera
        for keys in ([pygame.K_SPACE], [pygame.K_SPACE], [pygame.K_RETURN, pygame.K_p]):
            for key in keys:
                player.key(key)
            player.settle()
            assert player.view.stages.latest.camera == player.view.viewpoint.camera == near
        player.move((200, 150))
        player.send(pygame.MOUSEWHEEL, x=0, y=1, precise_x=0.0, precise_y=0.5, flipped=False)
        player.settle()
        assert player.view.viewpoint.camera.scale == pytest.approx(NOTCH**0.5 * near.scale)
        assert player.view.viewpoint.camera.world(200, 150) == pytest.approx(near.world(200, 150))
        player.game.watching.playback.playing = False
        place = player.view.viewpoint.camera.world(300, 200)
        player.press((300, 200))
        player.move((330, 190))
        player.release((330, 190))
        player.settle()
        assert player.view.viewpoint.camera.world(330, 190) == pytest.approx(place)
        assert player.game.watching.playback is not None

    def test_it_goes_in_with_the_story_and_not_out_before(self, player):
        player = player("soccer-curl/dive", (640, 400))
        aimed = player.view.viewpoint.camera
        player.key(pygame.K_v)
        player.key(pygame.K_SPACE)
        player.settle()
        playback, scales = player.game.watching.playback, [aimed.scale]
        decided = playback.story.decided
        while playback.t < decided:
            player.wait(LONGEST_FRAME)
            scales.append(player.view.viewpoint.camera.scale)
        assert all(after >= before * (1 - 1e-6) for before, after in pairwise(scales))
        assert scales[-1] > 4 * aimed.scale
        assert playback.pace == pytest.approx(1 / playback.story.slowest)  # and time has slowed
        player.view.viewpoint.zoom(0.5, (300, 200))
        player.settle()
        assert player.view.viewpoint.camera.scale == pytest.approx(scales[-1] / 2, rel=0.1)  # it is the player's now
        assert playback.story is None

    def test_it_comes_back_after_the_end_and_then_nothing_is_drawn(self, player):
        player = player("soccer-curl/dive", (640, 400))
        player.key(pygame.K_v)
        player.key(pygame.K_SPACE)
        player.settle()
        playback = player.game.watching.playback
        playback.seek(playback.story.decided)
        while playback.moves_on or not playback.over:
            player.wait()
        player.frames(2)
        assert player.view.viewpoint.camera == player.view.stages.latest.camera
        assert not player.view.needs_drawing(False)

    def test_two_fingers_zoom_and_move_it_and_one_pulls(self, player):
        player = player("golf", (640, 400))

        def finger(kind: int, number: int, at: tuple[float, float]) -> None:
            player.send(kind, finger_id=number, touch_id=1, x=at[0] / 640, y=at[1] / 400, dx=0.0, dy=0.0, pressure=1.0)

        whole = player.view.stages.latest.camera
        finger(pygame.FINGERDOWN, 1, (200, 150))
        player.send(pygame.MOUSEBUTTONDOWN, pos=(200, 150), button=1, touch=True)
        assert player.game.grasp.pull is not None
        finger(pygame.FINGERDOWN, 2, (300, 150))
        assert player.game.grasp.pull is None
        finger(pygame.FINGERMOTION, 2, (400, 150))
        player.send(pygame.MOUSEMOTION, pos=(210, 150), rel=(0, 0), buttons=(1, 0, 0), touch=True)
        for number in (1, 2):
            finger(pygame.FINGERUP, number, (400, 150))
        player.send(pygame.MOUSEBUTTONUP, pos=(210, 150), button=1, touch=True)
        player.settle()
        assert player.view.stages.latest.camera.scale == pytest.approx(2 * whole.scale)
        assert player.view.stages.latest.camera.world(300, 150) == pytest.approx(whole.world(250, 150))
        assert not player.game.shots.paths
        assert player.game.session.changes.values == {}


def test_the_picture_stays_until_the_new_stage_is_composed(player):
    player = player("golf")
    before = pygame.surfarray.array3d(player.screen)[:600, :600]
    player.view.stages.patience, player.view.stages.job.work = 0.0, Future()  # a stage that takes for ever
    player.key(pygame.K_TAB)
    while not player.view.shown.has_panel:
        player.frames(1)
    assert (pygame.surfarray.array3d(player.screen)[:600, :600] == before).mean() > 0.9


def test_until_then_it_fills_a_window_that_grows(player):
    player = player("golf", SMALLEST)
    player.view.stages.patience, player.view.stages.job.work = 0.0, Future()
    pygame.display.set_mode((960, 600), pygame.RESIZABLE)
    player.view.resized()
    player.frames(1)
    ground = pygame.surfarray.array3d(player.screen)[-200:, :400]
    assert (ground == CARD["background"]).all(axis=2).mean() < 0.5


def test_nothing_is_drawn_while_nothing_changes(player):
    player = player("golf")
    player.app.tick(0.016)
    assert not any(player.app.tick(0.016) for _ in range(100))
    assert not player.app.busy
    player.key(pygame.K_SPACE)
    assert any(player.app.tick(0.016) for _ in range(3))
    player.send(pygame.WINDOWMINIMIZED)
    t = player.game.watching.playback.t
    assert not any(player.app.tick(0.016) for _ in range(20))
    assert player.game.watching.playback.t == t
    player.send(pygame.WINDOWRESTORED)
    assert player.app.tick(0.016)


def test_only_nudges_and_steps_repeat(player):
    player = player("golf")
    for _ in range(3):
        player.send(pygame.KEYDOWN, key=pygame.K_TAB, mod=0, unicode="", scancode=0)
    assert player.view.shown.has_panel
    player.send(pygame.KEYUP, key=pygame.K_TAB, mod=0, unicode="", scancode=0)
    before = player.game.session.value("launch.angle")
    for _ in range(3):
        player.send(pygame.KEYDOWN, key=pygame.K_LEFT, mod=0, unicode="", scancode=0)
    assert player.game.session.value("launch.angle") == pytest.approx(before + 3.0)
    for _ in range(10):  # piled up during a long frame
        pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_LEFT, mod=0, unicode="", scancode=0))
    player.frames()
    assert player.game.session.value("launch.angle") == pytest.approx(before + 4.0)


@pytest.mark.parametrize("source", ["curling", "bowling"])
def test_the_near_part_shows_the_shot_that_is_aimed_and_no_other(source):
    scene = load(source)
    shot, other = (Shot(each, simulate(each)) for each in (scene, scene.changed({"launch.angle": 1.0})))
    stage, pictures = Stage(shot, SIZE), []
    for run, before in ((other, stage), (other, Stage(other, SIZE, stage.camera)), (shot, stage)):
        sheet = Canvas(pygame.Surface(SIZE))
        before.draw_balls(sheet, run, 0.0)
        pictures.append(pygame.surfarray.array3d(sheet.surface))
    assert (pictures[0] == pictures[1]).mean() > 0.995
    assert (pictures[0] != pictures[2]).any()


def test_a_fan_of_another_aim_is_dim_until_its_own_comes(player, monkeypatch):
    alphas, image = [], FanOfShot.image

    def noted(*of):
        found = image(*of)
        alphas.append(found[0].get_alpha())
        return found

    player = player("basketball", (640, 400))
    player.key(pygame.K_f)
    player.frames(2, dt=0.2)
    player.settle()
    view = player.view
    monkeypatch.setattr(FanOfShot, "image", noted)
    view.draw()
    player.game.aiming.change({"launch.angle": 60.0})
    player.game.settle()
    view.fan.job.work = Future()  # a fan that takes for ever
    view.draw()
    view.fan.job.work = None
    assert alphas == [255, OUTDATED]


def test_shots_whose_paths_are_kept_have_colours_of_their_own():
    for source in sorted(item.name for item in listings() if "/" not in item.name):
        scene = load(source)
        stage = Stage(Shot(scene, simulate(scene)), SIZE)
        assert len({stage.colour_of(number) for number in range(1, PATHS + 1)}) == PATHS, source


@pytest.mark.parametrize(
    ("source", "changes"),
    [
        *((listing.name, {}) for listing in listings() if "/" not in listing.name or "tennis/" in listing.name),
        ("tennis", {"launch.speed": 30.9, "launch.angle": 12.5}),  # long: the bounce is behind the other player
        ("baseball/green-monster", {}),
        ("basketball/brick", {}),
    ],
)
def test_the_story_is_in_the_picture(source, changes, shot_of):
    size = (960, 500)
    shot = shot_of(Session(source, changes))
    stage = Stage(shot, size)
    track = shot.track(shot.ball)
    places = stage.camera.pixels(track[track[:, 0] <= stage.story, 1:])
    assert (places >= 0.0).all()
    assert (places <= size).all()
    if "tennis" in source:
        assert stage.story == shot.run.duration
