"""The window in three states, beside golden pictures."""

from __future__ import annotations

import pygame

SIZE = (640, 400)


def test_aiming(player, golden):
    player = player("golf/golf-game", SIZE)
    player.pull((-40, 22), let_go=False)
    player.frames(4)  # the numbers are those of the path
    golden.check("window-aiming", player.screen)


def test_watching_with_an_earlier_shot(player, golden):
    player = player("golf/golf-game", SIZE)
    for pull in ((-70, 40), (-90, 26)):
        player.pull(pull)
        player.key(pygame.K_SPACE)
    player.move((400, 100))
    player.app.playback.seek(3.0)
    player.frames()
    golden.check("window-watching", player.screen)


def test_the_panel(player, golden):
    player = player("golf/putt", SIZE)
    player.key(pygame.K_TAB)
    player.move((100, 100))
    player.frames(3)
    golden.check("window-panel", player.screen)
