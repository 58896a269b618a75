"""Billiards goes on from where the balls rest."""

from __future__ import annotations

import shlex

import pygame
import pytest

import sandbox
from sandbox.parameters import parse_assignment
from sandbox.window import export
from sandbox.window.session import Session


@pytest.fixture
def watched(player):
    """A shot that has come to rest."""
    player = player("billiards", (640, 400))
    player.game.aiming.change({"cue.speed": 3.0, "cue.angle": 10.0})
    player.key(pygame.K_SPACE)
    player.game.watching.playback.seek(1e9)
    player.frames(1)
    return player


def places(session: Session) -> dict[str, list[float]]:
    return {ball.name: list(ball.position) for ball in session.scene.build().balls}


def laid_out(**balls: tuple[float, float]) -> dict[str, object]:
    """The changes that put balls on the table."""
    return {"rack": "none", "balls": [{"name": name, "x": x, "y": y} for name, (x, y) in balls.items()]}


def test_the_next_shot_begins_where_the_balls_rest(watched):
    resting = watched.game.shot.run.result["positions"]
    watched.key(pygame.K_RETURN)
    found = places(watched.game.session)
    assert found.keys() == resting.keys()
    for name, place in resting.items():
        assert found[name] == pytest.approx(place, abs=2e-5)
    assert watched.game.shot.run.setup.balls[0].position in [tuple(place) for place in found.values()]
    assert watched.game.ghosts == []


def test_a_pull_after_the_end_goes_on_too(watched):
    before = places(watched.game.session)
    watched.pull((-60, 20))
    assert places(watched.game.session) != before
    assert len(watched.game.shots.paths) == 2


def test_in_mid_shot_the_same_is_aimed_again(watched):
    before = places(watched.game.session)
    watched.game.watching.playback.seek(0.5)
    watched.key(pygame.K_RETURN)
    assert places(watched.game.session) == before


def test_a_key_racks_again(watched):
    before = places(watched.game.session)
    watched.key(pygame.K_RETURN)
    watched.key(pygame.K_b)
    assert places(watched.game.session) == before
    assert watched.game.session.changes.values == {"cue.speed": 3.0, "cue.angle": 10.0}
    watched.key(pygame.K_b)
    assert "where they began" in watched.game.notices[-1][0]


def test_potted_balls_stay_away_and_a_potted_cue_ball_is_spotted(shot_of):
    session = Session("billiards", {"cue.speed": 3.0, **laid_out(cue=(0.5, 0.0), one=(0.7, 0.02))})
    shot = shot_of(session)
    shot.run.result["positions"] = {"9": [-0.635, 0.035]}
    session.start_from(shot)
    found = places(session)
    assert found.keys() == {"cue", "9"}
    assert found["cue"][0] == pytest.approx(-0.635)
    radius = shot.scene.parameters.ball.radius
    assert abs(found["cue"][1] - 0.035) > 2 * radius
    assert abs(found["cue"][1]) < 1.1 * radius  # the nearest place with room
    shot.run.result["positions"] = {"cue": [0.0, 0.0]}
    session.start_from(shot)
    assert len(places(session)) == 10  # a cleared table is racked


def test_command_line_and_scene_file_keep_where_balls_lie(watched, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    watched.key(pygame.K_RETURN)
    session = watched.game.session
    _, _, source, *settings = shlex.split(session.command())
    again = sandbox.load(source, dict(parse_assignment(text) for text in settings[1::2]))
    assert again.parameters == session.scene.parameters
    assert sandbox.load(export.scene_file(session)).parameters == session.scene.parameters


def test_a_scratch_is_no_score(shot_of):
    session = Session("billiards", {"cue.speed": 3.0, "cue.angle": 90.0, **laid_out(cue=(0.0, 0.3))})
    shot = shot_of(session)
    assert shot.run.result["scratch"]
    assert not shot.scored
