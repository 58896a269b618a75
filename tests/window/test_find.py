"""Shots that are found: what can be aimed at, that they get there, and how one is chosen; through real events."""

from __future__ import annotations

import sys
from concurrent.futures import Future

import pygame
import pytest

from sandbox.scene import listings, simulate
from sandbox.window.find import find, questions
from sandbox.window.session import Session

from .test_game import Here


class Slow(Here):
    """Never gets there."""

    def submit(self, work, *args):
        return Future()


SCENES = [listing.name for listing in listings() if "/" not in listing.name]


@pytest.mark.parametrize("source", SCENES)
def test_what_is_looked_for_is_a_result_and_may_be_varied(source):
    session = Session(source)
    for question in questions(session, upright=True):
        for goal in question.goals:
            assert goal.wanted.keys() <= session.scene.facts.keys()
            for key, (low, high) in goal.vary.items():
                assert session.parameters.get(key) is not None
                assert low < high


@pytest.mark.parametrize("source", SCENES)
def test_after_a_weak_shot_the_scenes_own_is_still_looked_for(source):
    session = Session(source)
    controls, own = session.controls, session.parameters
    session.change({controls.speed: 0.2 * own[controls.speed].value})
    for goal in (goal for question in questions(session, upright=True) for goal in question.goals):
        for key in goal.vary.keys() & {controls.speed}:
            low, high = goal.vary[key]
            assert low < own[key].value < high


def test_it_is_said_in_which_ranges_shots_are_looked_for(player):
    player = player("basketball")
    player.game.workers.helper = Slow()
    player.key(pygame.K_SLASH)
    player.frames()
    ((text, bad),) = [notice for notice in player.game.notices if "looking" in notice[0]]
    assert "speed 0.372 to 14.9 m/s, angle 2 to 85 deg" in text
    assert not bad


def test_a_map_on_which_nothing_scores_says_where_to_look(player, written):
    player = player("basketball")
    player.game.aiming.change({"launch.speed": 1.0})
    player.key(pygame.K_m)
    player.settle()
    assert any("/ looks farther" in text for text, _ in written)


def test_shots_found_for_the_ring_score_most_forgiving_first(monkeypatch):
    monkeypatch.setattr("sandbox.window.find.REFINED", 1)
    monkeypatch.setattr(sys.modules["sandbox.lab.aim.regions"], "SCAN_EACH", 21)
    session = Session("basketball")
    (question,) = questions(session, upright=True)
    found = find(session.scene, question.goals)
    assert found
    assert all(simulate(each.scene).result["made"] for each in found)
    margins = [each.margin for each in found]
    assert margins == sorted(margins, reverse=True)
    assert margins[0] > 0


class TestInBilliards:
    @pytest.fixture
    def asking(self, player, monkeypatch):
        monkeypatch.setattr(sys.modules["sandbox.lab.aim.shots"], "DENSE_ALONE", 33)
        monkeypatch.setattr(sys.modules["sandbox.lab.aim.shots"], "_HALVINGS", 3)  # 0.01 deg
        monkeypatch.setattr("sandbox.window.score_map.COARSE", (3, 3))
        player = player("billiards/cut", (900, 560))
        player.game.workers.helper = Here()
        player.key(pygame.K_SLASH)
        return player

    def test_a_click_on_a_ball_finds_pots_and_on_a_path_aims(self, asking):
        game, view = asking.game, asking.view
        angle = game.session.value("cue.angle")
        game.aiming.change({"cue.angle": angle + 30.0})
        asking.settle()
        assert not game.shot.scored
        asking.key(pygame.K_ESCAPE)
        asking.key(pygame.K_SLASH)
        assert view.shown.overlay.name == "find"
        x, y = game.session.value("balls[1].x"), game.session.value("balls[1].y")
        asking.click(tuple(map(round, view.stages.latest.camera.pixel(x, y))))
        asking.settle()
        assert view.shown.overlay.name == "found"
        (mark,) = view.shown.overlay.marks()
        middle = mark.line[len(mark.line) // 2]
        asking.click((round(middle[0]), round(middle[1])))
        asking.settle()
        assert view.shown.overlay is None
        assert game.session.value("cue.angle") == pytest.approx(angle, abs=0.2)
        assert game.shot.scored
        asking.key(pygame.K_z, pygame.KMOD_CTRL)
        assert game.session.value("cue.angle") == angle + 30.0

    def test_by_key_alone_or_not_at_all(self, asking):
        over = asking.view.shown.overlay
        assert over.chosen.action == "ball 1"
        asking.key(pygame.K_DOWN)
        assert over.chosen.action == "left head corner pocket"
        asking.key(pygame.K_UP)
        asking.game.workers.helper = Slow()
        asking.key(pygame.K_RETURN)
        assert "looking for shots at ball 1" in asking.game.notices[0][0]
        asking.key(pygame.K_ESCAPE)
        assert not asking.game.jobs.waiting
        asking.settle()
        assert asking.view.shown.overlay is None


def test_a_scene_that_does_not_score_says_so(player):
    player = player("bullet", (640, 400))
    player.key(pygame.K_SLASH)
    assert "defines no scoring" in player.game.notices[-1][0]
