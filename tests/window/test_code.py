"""Code of one's own: saved while the window is open it is read again; a replay brings none."""

from __future__ import annotations

import json
import re
import time

import pygame
import pytest

from sandbox.cli.new import new_scene
from sandbox.errors import RequestError, RunError
from sandbox.scene.discovery import installed_folder
from sandbox.window import replay
from sandbox.window.app import play
from sandbox.window.opening import LOADING, limit_of
from sandbox.window.session import Session
from tests.own_scene import HANG

from .conftest import Player


@pytest.fixture
def own(player, tmp_path) -> Player:
    new_scene(tmp_path / "own")
    return player(str(tmp_path / "own"))


def edit(player: Player, name: str, before: str, after: str) -> None:
    file = player.game.session.base.folder / name
    code = file.read_text("utf-8")
    assert before in code
    file.write_text(code.replace(before, after, 1), "utf-8")
    player.frames(3, dt=0.11)
    player.settle()


class TestSaving:
    def test_the_physics_changes_with_scene_py(self, own):
        before = own.game.shot.run.result
        edit(own, "scene.py", "fan.push))", "10 * fan.push))")
        assert own.game.shot.run.result["apex"] > before["apex"] + 1
        assert own.game.path.before_save.run.result == before

    def test_the_picture_changes_with_picture_py(self, own):
        kind = type(own.view.stages.latest.picture)
        edit(own, "picture.py", "\n\nclass Picture", "\n\nMINE = True\n\n\nclass Picture")
        assert type(own.view.stages.latest.picture) is not kind
        assert own.view.stages.latest.shot is own.game.shot

    def test_an_error_in_verdict_has_file_and_line(self, own):
        edit(own, "scene.py", '    landed = run.result["distance"]', '    landed = run.result["distance"] + None')
        assert any(re.search(r"TypeError: .*own/scene.py, line \d+", text) for text, bad in own.game.notices if bad)
        edit(own, "scene.py", '    landed = run.result["distance"] + None', '    landed = run.result["distance"]')
        assert [text for text, bad in own.game.notices if bad] == []

    @pytest.mark.parametrize("name", ["scene.py", "picture.py"])
    def test_a_syntax_error_is_shown_with_its_line_until_mended(self, own, name):
        before = own.game.session.scene.module
        edit(own, name, "\nfrom ", "\nimport (\nfrom ")
        own.frames(2, dt=20.0)
        ((text, bad),) = own.game.notices
        assert bad
        assert f"{name}, line " in text
        assert own.game.session.scene.module is before
        own.key(pygame.K_UP)
        own.settle()
        assert own.game.failure is None
        edit(own, name, "\nimport (\nfrom ", "\nfrom ")
        assert [bad for _, bad in own.game.notices] == [False]  # that it was read again
        assert own.game.session.scene.module is not before
        edit(own, name, "\nfrom ", "\nimport (\nfrom ")
        assert [bad for _, bad in own.game.notices] == [True]


#: Code that never ends, and leaves the processor to others.
LOOP = "import time\nwhile True:\n    time.sleep(0.01)\n"
IN_BUILD = "\n\ndef build(parameters):\n    import time\n    while True:\n        time.sleep(0.01)\n"


class TestCodeThatNeverEnds:
    """At the level of a module, in ``build`` and in ``verdict``; the window goes on."""

    @pytest.fixture
    def own(self, player, tmp_path):
        new_scene(tmp_path / "own")
        player = player(str(tmp_path / "own"))
        player.game.workers.patience = 0.001
        return player

    @pytest.fixture(autouse=True)
    def time_passes(self, clock):
        """What never ends is given up by the clock."""
        clock.stands = False

    @staticmethod
    def frames_until(player, done):
        end = time.monotonic() + HANG
        while not done():
            player.frames(1, dt=0.11)
            assert time.monotonic() < end
            time.sleep(0.005)

    @pytest.mark.parametrize(("name", "code"), [("scene.py", LOOP), ("scene.py", IN_BUILD), ("picture.py", LOOP)])
    def test_saved_it_is_given_up_and_mended_it_is_played_again(self, own, name, code, monkeypatch):
        monkeypatch.setattr("sandbox.window.opening.LOADING", 1.0)
        file, game = own.game.session.base.folder / name, own.game
        good, before = file.read_text("utf-8"), game.session.scene.module
        file.write_text(good + code, "utf-8")
        self.frames_until(own, lambda: game.messages.unreadable is not None)
        assert "given up after 1 s: does its code ever end?" in game.notices[0][0]
        assert game.session.scene.module is before
        assert game.shot is not None
        monkeypatch.setattr("sandbox.window.opening.LOADING", 1e6)
        file.write_text(good, "utf-8")
        self.frames_until(own, lambda: game.messages.unreadable is None and game.opening.loading is None)
        own.key(pygame.K_UP)
        own.settle()
        assert game.failure is None

    @pytest.mark.parametrize("code", [LOOP, IN_BUILD])
    def test_opened_it_can_be_stopped_and_the_scene_so_far_stays(self, own, code, tmp_path):
        new_scene(tmp_path / "endless")
        with (tmp_path / "endless" / "scene.py").open("a") as file:
            file.write(code)
        game, title = own.game, own.game.session.title
        game.opening.open(str(tmp_path / "endless"))
        self.frames_until(own, lambda: any("Esc stops it" in text for text, _ in game.notices))
        own.key(pygame.K_ESCAPE)
        assert game.opening.loading is None
        assert "stopped" in game.notices[-1][0]
        assert game.session.title == title
        own.key(pygame.K_UP)
        game.workers.patience = HANG
        own.settle()
        assert game.failure is None

    def test_a_verdict_runs_in_the_worker_first(self, own):
        game = own.game
        file = game.session.base.folder / "scene.py"
        file.write_text(file.read_text("utf-8") + "\n\ndef verdict(run, parameters):\n    while True:\n        pass\n")
        self.frames_until(own, lambda: game.path.runs.takes > 0.3 and game.opening.loading is None)
        own.frames(3)
        assert game.path.runs.work is not None
        game.path.runs.give_up(None)

    def test_a_window_is_not_opened_on_it(self, tmp_path, monkeypatch):
        monkeypatch.setattr("sandbox.window.opening.LOADING", 1.0)
        new_scene(tmp_path / "endless")
        with (tmp_path / "endless" / "scene.py").open("a") as file:
            file.write(LOOP)
        with pytest.raises(RunError, match=r"given up after 1 s: does its code ever end\?"):
            play(str(tmp_path / "endless"))

    def test_what_came_with_the_sandbox_may_take_longer(self, tmp_path):
        assert limit_of(tmp_path) == limit_of(None) == LOADING < limit_of(installed_folder("golf"))


class TestReplays:
    @pytest.fixture
    def recorded(self, own, tmp_path, shot_of):
        """A replay of a scene of one's own, whose code says so when it runs."""
        path = tmp_path / f"own{replay.SUFFIX}"
        replay.save(shot_of(own.game.session), path)
        folder = tmp_path / "elsewhere" / "own"
        folder.parent.mkdir()
        (tmp_path / "own").rename(folder)
        with (folder / "scene.py").open("a") as file:
            file.write("\nfrom pathlib import Path\nPath(__file__).with_name('ran').touch()\n")
        record = json.loads(path.read_text("utf-8"))
        record["body"]["scene"] = str(folder)
        record["check"] = replay.checksum(record["body"])
        path.write_text(json.dumps(record), "utf-8")
        return path, folder

    def test_one_of_somebodys_own_scene_runs_none_of_its_code(self, recorded, player):
        path, folder = recorded
        with pytest.raises(RequestError, match="not an installed scene; sandbox play --scene FOLDER"):
            replay.read(path)
        player = player("golf")
        player.send(pygame.DROPFILE, file=str(path))
        assert "not an installed scene" in player.game.notices[-1][0]
        assert player.game.session.title == "golf"
        assert not (folder / "ran").exists()

    def test_the_player_may_name_the_scene(self, recorded):
        path, folder = recorded
        shot = replay.read(path, str(folder))
        assert shot.scene.folder == folder
        assert shot.changes.source == str(folder)
        assert shot.recorded
        assert (folder / "ran").exists()

    def test_the_scene_that_is_played_may_replay_its_own(self, recorded):
        path, folder = recorded
        shot = replay.read(path, running=folder)
        assert shot.scene.folder == folder

    def test_scene_is_for_replays(self):
        with pytest.raises(RequestError, match="golf is not a replay"):
            play("golf", scene="soccer")


class TestWhatIsOpen:
    def test_a_file_of_ones_own_has_its_name_and_can_be_returned_to(self, player, tmp_path):
        file = tmp_path / "mine.toml"
        file.write_text('scene = "golf"\n', "utf-8")
        player = player(str(file))
        assert player.game.session.title == "mine.toml"
        assert "mine.toml" in pygame.display.get_caption()[0]
        player.game.opening.open("soccer")
        player.settle()
        assert "soccer" in pygame.display.get_caption()[0]
        player.button("menu")
        player.click(next(rect.center for rect, what in player.view.shown.overlay.places if what == "recent"))
        rect = next(
            rect for rect, what in player.view.shown.overlay.places if getattr(what, "action", None) == str(file)
        )
        player.click(rect.center)
        assert player.game.session.title == "mine.toml"

    def test_one_thing_at_a_time_lies_over_the_picture(self, player):
        player = player("golf/putt")
        for key, name in ((pygame.K_l, "menu"), (pygame.K_h, "help"), (pygame.K_j, "energy"), (pygame.K_l, "menu")):
            player.key(key)
            assert player.view.shown.overlay.name == name
        player.key(pygame.K_ESCAPE)
        assert player.view.shown.overlay is None

    def test_a_click_on_a_shot_that_is_watched_leaves_it(self, player):
        player = player("billiards")
        player.key(pygame.K_SPACE)
        player.settle()
        shot = player.game.shot
        for _ in ("playing", "over"):
            player.click((500, 300))
            assert player.game.shot is shot
            assert player.game.watching.playback is not None
            player.game.watching.playback.seek(1e9)


def test_without_a_sound_device_nothing_claims_sound(player, monkeypatch, capfd):
    from sandbox.window.sound import Sound

    pygame.mixer.quit()
    monkeypatch.setenv("SDL_AUDIODRIVER", "alsa")
    monkeypatch.setenv("ALSA_CONFIG_PATH", "/nowhere")
    player = player("golf/putt")
    player.view.sound = Sound()
    player.key(pygame.K_u)
    assert player.game.notices[-1][0] == "no sound: there is no sound device"
    assert not player.view.sound.on
    assert capfd.readouterr().err == ""


def test_a_scene_loads_by_the_path_that_is_shown(tmp_path):
    new_scene(tmp_path / "own")
    assert Session(str(tmp_path / "own")).files[0].name == "own.toml"
