"""A scene that is played live: held keys move the flippers at once, and what was played can be played again."""

from __future__ import annotations

from collections.abc import Iterator

import pygame
import pytest

import sandbox
from sandbox.window.live import Live
from sandbox.workers import Processes
from tests.window.conftest import Player


@pytest.fixture(scope="module")
def window(worker: Processes) -> Player:
    return Player(worker, "pinball")


@pytest.fixture
def player(window: Player) -> Iterator[Player]:
    yield window
    window.key(pygame.K_RETURN)


def live_of(player: Player) -> Live:
    live = player.game.watching.live
    assert live is not None
    return live


def flipper_angle(player: Player) -> float:
    """In rad, of the left one, as it is drawn."""
    live = live_of(player)
    flipper = next(each for each in live.shot.run.setup.surfaces if each.name == "left flipper")
    assert flipper.motion is not None
    return flipper.motion.place(live.t).angle


def send(player: Player, kind: int, key: int) -> None:
    player.send(kind, key=key, mod=0, unicode="", scancode=0)


def test_a_held_key_moves_a_flipper_until_it_is_let_go(player: Player):
    player.key(pygame.K_SPACE)
    player.frames(5)
    rest = flipper_angle(player)
    send(player, pygame.KEYDOWN, pygame.K_LEFT)
    player.frames(1)
    assert flipper_angle(player) > rest + 0.1
    player.frames(10)
    up = flipper_angle(player)
    send(player, pygame.KEYUP, pygame.K_LEFT)
    player.frames(20)
    assert (up, flipper_angle(player)) == pytest.approx((0.4538, rest), abs=1e-4)
    assert len(live_of(player).shot.changes.values["flippers.left"]) == 1


def test_a_key_that_is_tapped_within_a_frame_is_let_go(player: Player):
    player.key(pygame.K_SPACE)
    for kind in (pygame.KEYDOWN, pygame.KEYUP):
        pygame.event.post(pygame.event.Event(kind, key=pygame.K_LEFT, mod=0, unicode="", scancode=0))
    player.frames(30)
    assert flipper_angle(player) == pytest.approx(-0.4887, abs=1e-4)


def test_keys_are_let_go_when_the_window_loses_focus(player: Player):
    player.key(pygame.K_SPACE)
    send(player, pygame.KEYDOWN, pygame.K_LEFT)
    player.frames(10)
    player.send(pygame.WINDOWFOCUSLOST)
    player.frames(20)
    assert flipper_angle(player) == pytest.approx(-0.4887, abs=1e-4)


def test_space_pauses_and_goes_on(player: Player):
    player.key(pygame.K_SPACE)
    player.frames(5)
    player.key(pygame.K_SPACE)
    t = live_of(player).t
    player.frames(5)
    assert live_of(player).t == t
    player.key(pygame.K_SPACE)
    player.frames(5)
    assert live_of(player).t > t


def test_a_lost_ball_is_a_shot_and_space_launches_another(player: Player):
    """It counts with the times of the keys; Space launches another ball."""
    before = player.game.shots.count
    player.key(pygame.K_SPACE)
    player.frames(60)
    send(player, pygame.KEYDOWN, pygame.K_RIGHT)
    send(player, pygame.KEYUP, pygame.K_RIGHT)
    for _ in range(1200):
        if player.game.watching.live is None:
            break
        player.wait(1 / 30)
    player.settle()
    shot = player.game.shot
    assert shot is not None
    assert player.game.shots.count == before + 1
    assert shot.run.result["lost"]
    assert len(shot.changes.values["flippers.right"]) == 1
    assert shot.run.result["score"] == sandbox.simulate(sandbox.load("pinball", shot.changes.values)).result["score"]
    player.key(pygame.K_SPACE)
    assert live_of(player).t < 0.1
