"""The window of a new user: hints that go when followed, thumbnails and descriptions in the menu, recent files."""

from __future__ import annotations

import json
from concurrent.futures import Future
from pathlib import Path

import pygame
import pytest

from sandbox.cli.new import new_scene
from sandbox.scene import listings
from sandbox.scene.discovery import installed_folders
from sandbox.tasks.sports import sports
from sandbox.window.app import App
from sandbox.window.game import Game
from sandbox.window.memory import HINTS, MOST, Memory, usual_place
from sandbox.window.menu import THUMBNAIL, thumbnail, tile_of
from sandbox.window.screen import SMALLEST, size_for
from sandbox.window.session import Session

from .test_play import Unanswered
from .test_see import said


@pytest.fixture
def remembering(player, tmp_path):
    player = player("golf", (900, 560))
    player.game.memory = Memory(tmp_path / "state" / "window.json")
    player.game.memory.opened("golf")
    return player


def test_hints_go_when_they_are_followed_and_do_not_come_back(remembering):
    game = remembering.game
    assert set(HINTS.values()) <= said(remembering)
    remembering.key(pygame.K_SPACE)
    remembering.frames(1)
    assert HINTS["shoot"] not in game.memory.hints.values()
    remembering.key(pygame.K_l)
    remembering.frames(1)
    remembering.key(pygame.K_ESCAPE)
    assert set(said(remembering)) & set(HINTS.values()) == {HINTS["drag"]}
    assert Memory(game.memory.file).hints.keys() == {"drag"}


def test_a_hand_shows_the_pull_until_the_first_shot(remembering):
    game, view, pictures = remembering.game, remembering.view, []
    for game.still in (0.6, 1.5):
        view.draw()
        pictures.append(pygame.image.tobytes(view.screen.canvas, "RGB"))
    assert pictures[0] != pictures[1]  # it moves
    assert (view.drawing.shows_how, remembering.app.busy) == (True, True)
    remembering.press((400, 300))
    assert not view.drawing.shows_how
    remembering.release((400, 300))
    remembering.key(pygame.K_SPACE)
    assert not view.drawing.shows_how


def test_the_laboratory_is_behind_one_key_and_remembered(remembering):
    laboratory = {"time", "drag", "gravity"}
    remembering.key(pygame.K_SPACE)
    remembering.frames(2)
    assert remembering.game.watching.playback.playing
    assert not laboratory & said(remembering)
    assert "speed" in said(remembering)
    remembering.key(pygame.K_4)
    assert laboratory <= said(remembering)
    assert remembering.view.switched >= {"lab", "arrows", "charts"}
    kept = Memory(remembering.game.memory.file)
    assert (kept.lab, kept.in_lab) == (True, ["arrows", "charts"])
    remembering.key(pygame.K_4)
    assert not laboratory & said(remembering)
    remembering.key(pygame.K_o)  # what belongs to it opens it
    assert laboratory <= said(remembering)


def test_the_windows_size_is_remembered_as_far_as_there_is_room(remembering):
    remembering.app.close()
    kept = Memory(remembering.game.memory.file)
    assert kept.size == (900, 560)
    assert size_for((1920, 1080), kept.size) == (900, 560)
    assert size_for((800, 600), (1280, 720)) == (784, 520)
    assert size_for((1920, 1080), (10, 10)) == SMALLEST


def test_the_dark_start_says_that_it_loads(written):
    pygame.display.init()
    screen = pygame.display.set_mode((640, 400))
    app = App(Game(Session("golf"), Unanswered()), screen)
    app.view.draw()
    assert "loading golf ..." in [text for text, _ in written]
    app.close()


def test_recent_files_are_remembered_the_last_first(tmp_path):
    memory = Memory(tmp_path / "window.json")
    (tmp_path / "mine.toml").write_text("", "utf-8")
    for source in ("golf", "soccer", "golf", str(tmp_path / "mine.toml")):
        memory.opened(source)
    assert Memory(memory.file).recent == [str(tmp_path / "mine.toml"), "golf", "soccer"]
    for number in range(2 * MOST):
        memory.opened(f"golf/{number}")
    assert len(memory.recent) == MOST


def test_less_motion_as_the_desktop_asks_until_chosen(tmp_path):
    file = tmp_path / "window.json"
    memory = Memory(file, less_motion=True)
    assert (memory.still, memory.calm) == (True, True)
    memory.calm = False
    memory.save()
    again, elsewhere = Memory(file, less_motion=True), Memory(file, less_motion=False)
    assert (again.still, again.calm) == (True, False)
    assert (elsewhere.still, elsewhere.calm) == (False, False)


def test_nothing_that_is_hit_answers_with_confetti_off(remembering):
    shown, game = remembering.view.shown, remembering.game
    shown.on.add("view")
    remembering.key(pygame.K_SPACE)
    assert shown.answering == game.watching.playback.camera_time
    remembering.key(pygame.K_5)
    assert shown.answering is None
    remembering.key(pygame.K_5)
    shown.on.discard("view")  # the camera stands still: less motion
    assert shown.answering is None


@pytest.mark.parametrize("text", ["", "[1]", '{"recent": 5}', '{"recent": [5], "followed": null}'])
def test_a_damaged_memory_is_no_matter(tmp_path, text):
    file = tmp_path / "window.json"
    file.write_text(text, "utf-8")
    memory = Memory(file)
    assert memory.recent == []
    memory.opened("golf")
    assert json.loads(file.read_text("utf-8"))["recent"] == ["golf"]


def test_the_menu_shows_thumbnails_texts_and_own_files(remembering, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    new_scene(tmp_path / "ours")
    remembering.key(pygame.K_l)
    menu = remembering.view.shown.overlay
    assert {"recent", "in this folder", "golf"} <= menu.groups.keys()
    assert [row.action for row in menu.groups["in this folder"]] == ["./ours", "./ours/still"]
    remembering.settle()
    names = [sport.name for sport in sports() if not sport.own]  # in the order of the tiles
    assert [what.action for _, what in menu.places if not isinstance(what, str)] == names[: menu.seen]
    assert menu.across > 2
    assert menu.chosen.action == "golf"
    remembering.click(next(rect.center for rect, what in menu.places if what == "golf"))
    remembering.settle()
    assert menu.pictures
    assert all(len(picture.result()) == 3 * THUMBNAIL[0] * THUMBNAIL[1] for picture in menu.pictures.values())
    about = next(listing.about for listing in listings() if listing.name == "golf")
    assert any(about.startswith(text.removesuffix(" ...")) and len(text) > 20 for text in said(remembering))
    remembering.click(next(rect.center for rect, what in menu.places if what == "in this folder"))
    remembering.settle()
    assert menu.pictures["./ours"].result() == b""  # no code runs only because it lies here


def test_sports_in_the_menu_have_their_pictures_at_once(remembering):
    remembering.key(pygame.K_l)
    menu = remembering.view.shown.overlay
    shown = [what.action for _, what in menu.places if not isinstance(what, str)]
    assert len(shown) > 10
    assert [name for name in shown if not menu.pictures[name].done()] == []


def test_until_there_is_a_thumbnail_the_sport_is_seen(remembering, monkeypatch):
    waiting: Future[bytes] = Future()
    remembering.key(pygame.K_l)
    menu = remembering.view.shown.overlay
    monkeypatch.setattr(menu, "picture_of", lambda source: waiting)
    menu.turn_to("golf")
    remembering.frames(1)
    remembering.view.draw()
    tile = tile_of(installed_folders()["golf"], THUMBNAIL)
    row = next(rect for rect, what in menu.places if not isinstance(what, str))
    sky, ground = (menu.sheet.surface.get_at((row.left + 20, row.centery + dy)) for dy in (-25, 25))
    assert tile.get_at((20, 20))[2] > tile.get_at((20, 70))[2]
    assert sky[2] > ground[2]


def test_thumbnails_that_nobody_waits_for_are_not_drawn(remembering):
    waiting = [Future(), Future()]
    waiting[1].set_result(b"")
    remembering.view.thumbnails.made.update(zip(("golf", "soccer"), waiting, strict=True))
    remembering.frames(1)
    assert waiting[0].cancelled()
    assert list(remembering.view.thumbnails.made) == ["soccer"]


def test_a_scene_that_cannot_be_drawn_has_no_thumbnail(tmp_path):
    new_scene(tmp_path / "ours")
    (tmp_path / "ours" / "picture.py").write_text("raise ValueError", "utf-8")
    assert thumbnail(str(tmp_path / "ours")) == b""


@pytest.mark.parametrize(
    "known", [{"XDG_STATE_HOME": "/state", "LOCALAPPDATA": "/data"}, {"LOCALAPPDATA": "/data"}, {}]
)
def test_what_is_remembered_is_where_programs_keep_such_things(monkeypatch, known):
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    for name, place in known.items():
        monkeypatch.setenv(name, place)
    kept = Path(next(iter(known.values()), Path.home() / ".local" / "state"))
    assert usual_place() == kept / "sports-sandbox" / "window.json"
