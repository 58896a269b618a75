"""A scene that ``sandbox new`` wrote plays like those that come with the sandbox."""

from __future__ import annotations

from pathlib import Path

import pygame

from sandbox.cli.new import new_scene


def test_it_plays(player, tmp_path: Path):
    new_scene(tmp_path / "beachvolley")
    player = player(str(tmp_path / "beachvolley"))
    player.pull((-120, 160), let_go=False)
    aimed = pygame.surfarray.array3d(player.screen)
    assert 45 < player.game.session.value("launch.angle") < 60
    player.release((5, 600))
    assert len(player.game.shots.paths) == 1
    player.frames(90)
    assert (pygame.surfarray.array3d(player.screen) != aimed).any()


def test_saving_its_file_changes_the_path(player, tmp_path: Path):
    new_scene(tmp_path / "beachvolley")
    file = tmp_path / "beachvolley" / "beachvolley.toml"
    player = player(str(tmp_path / "beachvolley"))
    before = player.game.shot.run.result["distance"]
    file.write_text(file.read_text("utf-8").replace("push = 4.0", "push = 0.0"), "utf-8")
    player.frames(120)
    assert player.game.shot.run.result["distance"] < before - 1
