"""The panel, and a scene file that is saved while the window is open."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pygame
import pytest

from sandbox.parameters import walk
from sandbox.picture.lettering import Lettering
from sandbox.scene import listings, load
from sandbox.window.panel import FAVOURITES, FIELD_OF, RESET_ALL, RESET_OF, SLIDER_OF, Panel

SCENE = """# A putt of mine.
scene = "golf"

[launch]
speed = 60.0   # m/s
angle = 12.0
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", [listing.name for listing in listings() if "/" not in listing.name])
def test_the_panel_has_a_row_for_each_slider_of_a_scene(name: str):
    scene = load(name)
    parameters = {each.key: each for each in walk(scene.parameters, entries=True)}
    session = SimpleNamespace(scene=scene, parameters=parameters, controls=scene.controls, limits=None)
    game: Any = SimpleNamespace(session=session)
    keys = [each.key for each in Panel(game, lambda board: None).groups[FAVOURITES]]
    both = [key.partition("[")[0] if key.startswith("air.wind") else key for key in keys]
    assert list(dict.fromkeys(both)) == list(scene.controls.sliders) or not scene.controls.sliders


def row(player, key: str):
    return next(row for row in player.view.panel.rows if row.key == key)


def place(player, key: str, part: str) -> pygame.Rect:
    """The place of a part of a parameter's row."""
    parts = {what: rect for rect, what in player.view.panel.places if isinstance(what, tuple)}
    return next(rect for (row, name), rect in parts.items() if row.key == key and name == part)


def write(player, key: str, text: str) -> None:
    """Type a text into the field of a parameter, and Enter."""
    player.click(place(player, key, FIELD_OF).center)
    letters(player, text)
    player.key(pygame.K_RETURN)


def letters(player, text: str) -> None:
    for letter in text:
        player.send(pygame.KEYDOWN, key=ord(letter.lower()), mod=0, unicode=letter, scancode=0)
        player.send(pygame.KEYUP, key=ord(letter.lower()), mod=0, unicode=letter, scancode=0)


def turn_to(player, group: str) -> None:
    """Another group, by key."""
    for _ in player.view.panel.groups:
        if player.view.panel.group != group:
            player.key(pygame.K_PAGEDOWN, pygame.KMOD_CTRL)
    assert player.view.panel.group == group


def test_an_entry_of_a_list_has_a_slider_too(player):
    """The masses of the bench."""
    player = player("collisions")
    player.key(pygame.K_TAB)
    write(player, "balls[0].mass", "2")
    assert [ball.mass for ball in player.game.session.scene.parameters.balls] == [2.0, 0.17]
    player.click(place(player, "balls[0].mass", RESET_OF).center)
    assert player.game.session.scene.parameters.balls[0].mass == 0.17


class TestThePanel:
    @pytest.fixture
    def player(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        return player

    def test_a_slider_changes_the_shot_at_once(self, player):
        before = player.game.shot.run.result["carry"]
        slider = place(player, "launch.speed", SLIDER_OF)
        player.press(slider.center)
        at_middle = player.game.session.value("launch.speed")
        player.move((slider.right - 30, slider.top - 40))
        assert player.game.session.value("launch.speed") > at_middle + 40
        player.release((slider.right - 30, slider.top - 40))
        assert player.game.shot.run.result["carry"] > before + 5
        assert not player.game.shots.paths

    def test_one_reset_takes_back_one_parameter_and_the_other_all(self, player):
        player.game.aiming.change({"launch.speed": 50.0, "launch.angle": 20.0})
        player.frames(2)
        player.click(place(player, "launch.speed", RESET_OF).center)
        player.frames(2)
        assert player.game.session.changes.values == {"launch.angle": 20.0}
        player.click(next(rect.center for rect, what in player.view.panel.places if what == RESET_ALL))
        assert player.game.session.changes.values == {}
        assert player.game.session.value("launch.angle") == pytest.approx(10.4)

    def test_a_field_takes_units_and_says_what_is_wrong(self, player):
        write(player, "launch.speed", "100 mph")
        assert player.game.session.value("launch.speed") == pytest.approx(44.704)
        write(player, "launch.speed", "9000")
        assert player.game.session.value("launch.speed") == pytest.approx(44.704)
        assert "from 0 to 340 m/s" in player.game.notices[-1][0]
        assert row(player, "launch.speed").written == "44.704"
        write(player, "launch.speed", "50")
        assert not player.game.notices, "what was wrong is no longer said"

    def test_a_field_is_edited_left_and_taken_by_a_click_elsewhere(self, player):
        player.click(place(player, "launch.speed", FIELD_OF).center)
        panel = player.view.panel
        before = panel.before
        player.key(pygame.K_SPACE)  # no command, and no letter
        assert player.game.watching.playback is None
        letters(player, "1243")
        for key in (pygame.K_BACKSPACE, pygame.K_LEFT, pygame.K_DELETE, pygame.K_HOME, pygame.K_RIGHT):
            player.key(key)
        letters(player, ".")
        assert (panel.before, panel.after) == ("1.", "2")
        player.key(pygame.K_a, pygame.KMOD_CTRL)
        letters(player, "7")
        assert panel.before + panel.after == "7"
        player.key(pygame.K_ESCAPE)
        assert row(player, "launch.speed").written == before
        player.click(place(player, "launch.speed", FIELD_OF).center)
        letters(player, "9")
        player.click(place(player, "launch.angle", FIELD_OF).center)
        assert player.game.session.value("launch.speed") == 9.0

    def test_tab_goes_to_the_next_field_and_shows_the_end_of_text(self, player, written):
        player.click(place(player, "launch.speed", FIELD_OF).center)
        letters(player, "60")
        player.key(pygame.K_TAB)
        letters(player, "30")
        player.key(pygame.K_TAB, pygame.KMOD_SHIFT)
        values = player.game.session.value("launch.speed"), player.game.session.value("launch.angle")
        assert values == (60.0, 30.0)
        assert player.view.panel.typing.key == "launch.speed"
        letters(player, "1 very long text 9")
        assert any(text.endswith("text 9|") for text, _ in written)

    def test_fields_take_pasted_texts_vector_parts_and_nonsense(self, player, monkeypatch):
        player.click(place(player, "air.wind[0]", FIELD_OF).center)
        monkeypatch.setattr(pygame.scrap, "get_text", lambda: "-3.5 ")
        player.key(pygame.K_v, pygame.KMOD_CTRL)
        player.key(pygame.K_KP_ENTER)
        assert player.game.session.value("air.wind") == (-3.5, 0.0)
        for text in ("nan", "1e999", "7 parsec", "[1]"):
            write(player, "launch.angle", text)
            assert player.game.notices[-1][1], text
            assert player.game.session.value("launch.angle") == 10.4

    def test_what_is_selected_may_be_copied_and_cut(self, player, monkeypatch):
        copied = []
        monkeypatch.setattr(pygame.scrap, "put_text", copied.append)
        panel = player.view.panel
        player.click(place(player, "launch.angle", FIELD_OF).center)
        player.key(pygame.K_c, pygame.KMOD_CTRL)
        assert (copied, panel.before) == (["10.4"], "10.4")
        player.key(pygame.K_x, pygame.KMOD_CTRL)
        assert (copied, panel.before) == (["10.4", "10.4"], "")
        player.key(pygame.K_c, pygame.KMOD_CTRL)  # nothing is selected
        assert len(copied) == 2

    def test_a_slider_that_goes_while_it_is_dragged_is_no_matter(self, player):
        slider = place(player, "launch.speed", SLIDER_OF)
        player.press(slider.center)
        player.view.panel.turn_to("air")
        player.view.changed = True
        for key in (pygame.K_TAB, pygame.K_TAB):
            player.key(key)
            player.move((slider.right, slider.top))
        player.release(slider.center)
        assert player.game.running

    def test_every_group_of_every_kind_of_parameter_can_be_shown(self, player):
        panel = player.view.panel
        assert {"launch", "air", "ball.drag", "ground.green", "accuracy"} <= set(panel.groups)
        seen = []
        for _ in panel.groups:
            seen.append(panel.group)
            assert {what[0].key for _, what in panel.places if isinstance(what, tuple)} <= {
                row.key for row in panel.rows
            }
            assert panel.places
            player.key(pygame.K_PAGEDOWN, pygame.KMOD_CTRL)
        assert seen == list(panel.groups)
        assert panel.group == seen[0]

    def test_a_group_is_chosen_from_a_list(self, player):
        player.click(next(rect.center for rect, what in player.view.panel.places if what == FAVOURITES))
        player.frames(1)
        assert "golf" in (actions := {row.text: row.action for row in player.view.shown.overlay.rows})
        assert not player.view.switched & set(actions.values()), "the scene is on, its group is not"
        player.click(next(rect.center for rect, row in player.view.shown.overlay.places if row.text == "launch"))
        assert player.view.panel.group == "launch"
        assert player.view.shown.overlay is None

    def test_a_choice_changes_the_rows_and_undo_restores_them(self, player):
        turn_to(player, "ball.drag")
        before = [row.key for row in player.view.panel.rows]
        player.view.panel.set(row(player, "ball.drag.model"), "constant")
        assert "ball.drag.coefficient" in {row.key for row in player.view.panel.rows}
        player.key(pygame.K_z, pygame.KMOD_CTRL)
        assert [row.key for row in player.view.panel.rows] == before

    def test_what_a_parameter_means_is_said_under_the_mouse(self, player):
        turn_to(player, "ball.drag")
        player.move(place(player, "ball.drag.model", FIELD_OF).center)
        from .test_see import said

        assert any(text.startswith("ball.drag.model: ") for text in said(player))


class TestThePanelByKey:
    """Ctrl and arrows do what the mouse does."""

    def test_the_first_key_opens_it(self, player):
        player = player("golf")
        player.key(pygame.K_DOWN, pygame.KMOD_CTRL)
        assert player.view.shown.has_panel
        assert player.game.session.changes.values == {}

    def test_a_row_is_chosen_and_changed_and_taken_back(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        for _ in range(2):
            player.key(pygame.K_DOWN, pygame.KMOD_CTRL)
        assert player.view.panel.chosen.key == "launch.angle"
        low, high = row(player, "launch.angle").span
        player.key(pygame.K_RIGHT, pygame.KMOD_CTRL)
        player.key(pygame.K_LEFT, pygame.KMOD_CTRL | pygame.KMOD_SHIFT)
        assert player.game.session.value("launch.angle") == pytest.approx(10.4 + 0.009 * (high - low), rel=1e-3)
        player.key(pygame.K_BACKSPACE, pygame.KMOD_CTRL)
        assert player.game.session.changes.values == {}
        assert player.view.panel.chosen.key == "launch.angle"

    def test_switches_and_words_too(self, player):
        player = player("soccer")
        player.key(pygame.K_TAB)
        panel = player.view.panel
        for group, kind in ((panel.group, bool), ("ball.drag", str)):
            turn_to(player, group)
            panel.chosen = before = next(row for row in panel.rows if isinstance(row.value, kind))
            player.key(pygame.K_RIGHT, pygame.KMOD_CTRL)
            assert player.game.session.value(before.key) != before.value
        assert row(player, panel.chosen.key).value in panel.chosen.parameter.choices

    def test_a_row_out_of_sight_is_scrolled_to(self, player, monkeypatch):
        monkeypatch.setattr(Lettering, "larger", 1.5)
        player = player("golf", (640, 400))
        player.key(pygame.K_TAB)
        turn_to(player, "club")
        panel = player.view.panel
        player.key(pygame.K_UP, pygame.KMOD_CTRL)
        assert panel.chosen == panel.rows[-1]
        assert panel.seen < len(panel.rows)
        shown = {what[0]: rect for rect, what in panel.places if isinstance(what, tuple)}
        assert shown[panel.chosen].bottom <= panel.rect.bottom
        player.move(shown[panel.chosen].center)
        player.send(pygame.MOUSEWHEEL, x=0, y=1, flipped=False)
        assert panel.first == len(panel.rows) - panel.seen - 1


class TestSaving:
    def wait(self, player) -> None:
        player.frames(3, dt=0.11)
        player.settle()

    def test_a_saved_file_is_read_and_the_old_path_stays(self, player, file):
        player = player(str(file))
        before = player.game.shot
        file.write_text(SCENE.replace("60.0", "70.0"), encoding="utf-8")
        self.wait(player)
        assert player.game.session.value("launch.speed") == 70.0
        assert player.game.path.before_save is before
        assert player.game.shot.run.result["carry"] > before.run.result["carry"]

    def test_files_in_between_are_watched_too(self, player, file):
        first, between = file.with_name("first.toml"), file.with_name("between.toml")
        first.write_text(SCENE, encoding="utf-8")
        between.write_text('scene = "./first.toml"\nlaunch.angle = 20', encoding="utf-8")
        file.write_text('scene = "./between.toml"\nlaunch.spin = 0', encoding="utf-8")
        player = player(str(file))
        between.write_text('scene = "./first.toml"\nlaunch.angle = 25', encoding="utf-8")
        self.wait(player)
        assert player.game.session.value("launch.angle") == 25.0
        file.write_text('scene = "./first.toml"\nlaunch.spin = 0', encoding="utf-8")
        self.wait(player)
        first.write_text(SCENE.replace("60.0", "70.0"), encoding="utf-8")
        self.wait(player)
        assert player.game.session.value("launch.speed") == 70.0

    @pytest.mark.parametrize("broken", ["scene = [", SCENE.replace("60.0", "-1.0"), SCENE + "spin_up = 3\n"])
    def test_a_broken_file_shows_its_error_and_the_window_goes_on(self, player, file, broken):
        player = player(str(file))
        before = player.game.session.scene
        file.write_text(broken, encoding="utf-8")
        self.wait(player)
        assert player.game.session.scene is before
        assert player.game.notices[-1][1]
        assert "mine.toml" in player.game.notices[-1][0]
        player.frames(5, dt=10)
        assert player.game.notices
        file.write_text(SCENE.replace("60.0", "71.0"), encoding="utf-8")
        self.wait(player)
        assert player.game.session.value("launch.speed") == 71.0
        assert not player.game.notices[-1][1]

    def test_what_was_changed_in_the_window_stays_changed(self, player, file):
        player = player(str(file))
        player.game.aiming.change({"launch.angle": 33.0})
        file.write_text(SCENE.replace("60.0", "70.0"), encoding="utf-8")
        self.wait(player)
        assert player.game.session.value("launch.angle") == 33.0
        assert player.game.session.value("launch.speed") == 70.0

    def test_another_scene_in_the_file_replaces_all_of_the_old_one(self, player, file):
        player = player(str(file))
        player.key(pygame.K_TAB)
        player.game.aiming.change({"launch.angle": 33.0})
        player.key(pygame.K_SPACE)
        file.write_text('scene = "soccer"\n', encoding="utf-8")
        self.wait(player)
        game, view = player.game, player.view
        assert game.notices[0][0].startswith("read ")
        assert game.session.base.name == "soccer"
        assert game.shot.scene is game.session.scene
        assert view.stages.latest.shot is game.shot
        assert game.watching.playback is game.path.before_save is None
        assert game.session.changes.values == {}
        assert not game.ghosts
        assert "wall.height" in {row.key for row in view.panel.rows}
