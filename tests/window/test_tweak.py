"""The panel, and a scene file that is saved while the window is open."""

from __future__ import annotations

import pygame
import pytest

from sandbox.window.panel import Switch, Word

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


def row(player, key: str):
    return next(row for row in player.view.panel.rows if row.parameter.key == key)


def write(player, key: str, text: str) -> None:
    """Type a text into the field of a parameter, and Enter."""
    entry = row(player, key).entry
    player.click(entry.rect.center)
    entry.set_text(text)
    player.key(pygame.K_RETURN)
    player.frames(2)


def drag(player, element, by: int) -> None:
    x, y = element.sliding_button.rect.center
    player.move((x, y))
    player.press((x, y))
    for part in (by // 2, by):
        player.move((x + part, y))
        player.frames(2)
    player.release((x + by, y))
    player.frames(2)


class TestThePanel:
    def test_a_slider_changes_the_shot_at_once(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        before = player.game.shot.run.result["carry"]
        drag(player, row(player, "launch.speed").slider, 40)
        assert player.game.session.value("launch.speed") > 80
        assert player.game.shot.run.result["carry"] > before + 5
        assert not player.game.shots

    def test_one_reset_takes_back_one_parameter_and_the_other_all(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        player.game.change({"launch.speed": 50.0, "launch.angle": 20.0})
        player.frames(2)
        player.click(row(player, "launch.speed").reset.rect.center)
        player.frames(2)
        assert player.game.session.changes.values == {"launch.angle": 20.0}
        player.click(player.view.panel.reset_all.rect.center)
        player.frames(2)
        assert player.game.session.changes.values == {}
        assert player.game.session.value("launch.angle") == pytest.approx(10.4)

    def test_a_field_takes_units_and_says_what_is_wrong(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        write(player, "launch.speed", "100 mph")
        assert player.game.session.value("launch.speed") == pytest.approx(44.704)
        write(player, "launch.speed", "9000")
        assert player.game.session.value("launch.speed") == pytest.approx(44.704)
        assert "from 0 to 340 m/s" in player.game.notices[-1][0]
        assert row(player, "launch.speed").entry.get_text() == "44.704"

    def test_every_group_of_every_kind_of_parameter_can_be_shown(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        panel = player.view.panel
        assert {"launch", "air", "ball.drag", "ground.green", "accuracy"} <= set(panel.groups)
        for _ in panel.groups:
            player.key(pygame.K_PAGEDOWN, pygame.KMOD_CTRL)
            player.frames(2)
            assert player.view.panel.rows
        assert player.view.panel.group == panel.group
        assert player.view.panel is not panel

    def test_a_word_that_brings_other_parameters_changes_the_rows_and_undo_changes_them_back(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        player.turn_to("ball.drag")
        player.frames(2)
        before = [row.parameter.key for row in player.view.panel.rows]
        player.view.panel.set(row(player, "ball.drag.model"), "constant")
        player.frames(2)
        assert "ball.drag.coefficient" in {row.parameter.key for row in player.view.panel.rows}
        player.key(pygame.K_z, pygame.KMOD_CTRL)
        player.frames(2)
        assert [row.parameter.key for row in player.view.panel.rows] == before
        assert row(player, "ball.drag.model").shown == player.game.session.value("ball.drag.model")

    def test_keys_typed_into_a_field_are_no_commands(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        player.click(row(player, "launch.speed").entry.rect.center)
        assert player.view.panel.typing
        player.key(pygame.K_SPACE)
        assert player.game.playback is None


class TestThePanelByKey:
    """Ctrl and arrows do what the mouse does."""

    def test_the_first_key_opens_it(self, player):
        player = player("golf")
        player.key(pygame.K_DOWN, pygame.KMOD_CTRL)
        assert player.view.panel is not None
        assert player.game.session.changes.values == {}

    def test_a_row_is_chosen_and_changed_and_taken_back(self, player):
        player = player("golf")
        player.key(pygame.K_TAB)
        for _ in range(2):
            player.key(pygame.K_DOWN, pygame.KMOD_CTRL)
        row = player.view.panel.rows[player.view.panel.chosen]
        assert row.parameter.key == "launch.angle"
        low, high = row.slider.value_range
        player.key(pygame.K_RIGHT, pygame.KMOD_CTRL)
        player.key(pygame.K_LEFT, pygame.KMOD_CTRL | pygame.KMOD_SHIFT)
        assert player.game.session.value("launch.angle") == pytest.approx(10.4 + 0.009 * (high - low), rel=1e-3)
        assert float(row.entry.get_text()) == player.game.session.value("launch.angle")
        player.key(pygame.K_BACKSPACE, pygame.KMOD_CTRL)
        player.frames(2)
        assert player.game.session.changes.values == {}
        assert player.view.panel.chosen == 1

    def test_switches_and_words_too(self, player):
        player = player("soccer")
        player.key(pygame.K_TAB)
        panel = player.view.panel
        panel.chosen = next(i for i, row in enumerate(panel.rows) if isinstance(row, Switch))
        key = panel.rows[panel.chosen].parameter.key
        before = player.game.session.value(key)
        player.key(pygame.K_RIGHT, pygame.KMOD_CTRL)
        assert player.game.session.value(key) is not before
        while panel.group != "ball.drag":
            player.key(pygame.K_PAGEDOWN, pygame.KMOD_CTRL)
            player.frames(2)
            panel = player.view.panel
        panel.chosen = next(i for i, row in enumerate(panel.rows) if isinstance(row, Word))
        parameter = panel.rows[panel.chosen].parameter
        player.key(pygame.K_RIGHT, pygame.KMOD_CTRL)
        after = player.game.session.value(parameter.key)
        assert after != parameter.value
        assert after in parameter.choices

    def test_a_row_out_of_sight_is_scrolled_to(self, player):
        player = player("golf", (640, 400))
        player.key(pygame.K_TAB)
        player.key(pygame.K_UP, pygame.KMOD_CTRL)
        player.frames(3)
        label = player.view.panel.rows[player.view.panel.chosen].label
        assert player.view.panel.chosen == len(player.view.panel.rows) - 1
        assert label.rect.bottom <= player.view.panel.rect.bottom


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
        assert player.game.before_save is before
        assert player.game.shot.run.result["carry"] > before.run.result["carry"]

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
        player.game.change({"launch.angle": 33.0})
        file.write_text(SCENE.replace("60.0", "70.0"), encoding="utf-8")
        self.wait(player)
        assert player.game.session.value("launch.angle") == 33.0
        assert player.game.session.value("launch.speed") == 70.0

    def test_another_scene_in_the_file_is_opened_and_nothing_of_the_one_before_is_left(self, player, file):
        player = player(str(file))
        player.key(pygame.K_TAB)
        player.game.change({"launch.angle": 33.0})
        player.key(pygame.K_SPACE)
        file.write_text('scene = "soccer"\n', encoding="utf-8")
        self.wait(player)
        game, view = player.game, player.view
        assert game.notices[0][0].startswith("read ")
        assert game.session.base.name == "soccer"
        assert game.shot.scene is game.session.scene
        assert view.stage.shot is game.shot
        assert game.playback is game.before_save is None
        assert game.session.changes.values == {}
        assert not game.recent
        assert "wall.height" in {row.parameter.key for row in view.panel.rows}
