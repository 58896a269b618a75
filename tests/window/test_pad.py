"""The ball on which spin is set, dragged through real events."""

from __future__ import annotations

from math import hypot

import pygame
import pytest


def drag(player, across: float, up: float) -> None:
    """Press in the middle of the ball, and drag so many radii."""
    pad = player.view.targets.pad
    x, y = pad.centre
    player.press((round(x), round(y)))
    player.move((round(x + across * pad.radius), round(y - up * pad.radius)))
    player.release((round(x), round(y)))
    player.settle()


def test_the_tip_of_the_cue_is_dragged_up_to_a_miscue(player):
    player = player("billiards/cut")
    value = player.game.session.value
    drag(player, 0.2, -0.3)
    assert (value("cue.english"), value("cue.follow")) == pytest.approx((0.2, -0.3), abs=0.03)
    assert not player.game.shots.paths
    drag(player, 0.9, 0.9)
    assert hypot(value("cue.english"), value("cue.follow")) == pytest.approx(0.5, abs=0.02)
    assert player.game.failure is None
    assert player.view.targets.pad.texts[-1] == "level cue"
    player.key(pygame.K_2)
    assert player.view.targets.pad is None


def test_rate_and_tilt_are_set_on_it_where_a_spin_has_both(player):
    player = player("soccer-curl")
    drag(player, -0.5, 0.4)
    value = player.game.session.value
    assert value("launch.spin") == pytest.approx(-500.0, abs=40.0)
    assert value("launch.tilt") == pytest.approx(40.0, abs=3.0)
    player.key(pygame.K_z, pygame.KMOD_CTRL)
    assert player.game.session.changes.values == {}


def test_where_there_is_one_spin_it_is_shown_by_key(player):
    player = player("golf")
    assert player.view.targets.pad is None
    player.key(pygame.K_2)
    pad = player.view.targets.pad
    drag(player, 0.5, 0.9)
    assert player.game.session.value("launch.spin") == pytest.approx(0.5 * pad.reaches[0], rel=0.05)
    player.key(pygame.K_SPACE)
    assert player.view.targets.pad is None
