"""Files that the window writes: replays, scene files, pictures, command lines; and the sound."""

from __future__ import annotations

import json
import shlex
import tomllib

import numpy as np
import pygame
import pytest
from PIL import Image

import sandbox
from sandbox import Ball, Gravity, Moving, Segment, Setup, Surface, Swinging
from sandbox.engine.ledger import ledger
from sandbox.engine.paths.phase import InCluster, InHeap
from sandbox.errors import RequestError
from sandbox.scene.setup_scene import with_scene
from sandbox.window import export, replay, sound
from sandbox.window.canvas import Canvas
from sandbox.window.session import Session
from sandbox.window.stage import Stage


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def recorded(tmp_path, shot_of):
    session = Session("golf/putt", {"launch.speed": 2.5})
    shot = shot_of(session)
    path = tmp_path / f"putt{replay.SUFFIX}"
    replay.save(shot, path)
    return shot, path


class TestReplays:
    def test_it_plays_back_exactly_what_was_recorded(self, recorded):
        shot, path = recorded
        again = replay.read(path)
        for t in np.linspace(0, shot.run.duration, 97):
            assert again.run.state("ball", t) == shot.run.state("ball", t)
        assert again.run.events == shot.run.events
        assert again.run.result == shot.run.result
        assert again.scene.parameters == shot.scene.parameters
        assert again.changes.values == {"launch.speed": 2.5}
        assert ledger(again.run) == ledger(shot.run)
        assert again.run.numerics == shot.run.numerics

    @pytest.mark.parametrize("source", ["collisions/tumbling-box", "collisions/cradle-3"])
    def test_it_knows_what_pressed_on_what(self, source, shot_of):
        run = shot_of(Session(source)).run
        again = replay.run_of(run.scene, json.loads(json.dumps(replay.data_of(run))))
        contacts = [[arc.contact for path in each.arcs.values() for arc in path] for each in (run, again)]
        assert sum(isinstance(contact, InCluster | InHeap) for contact in contacts[1]) > 10
        assert [*map(type, contacts[1])] == [*map(type, contacts[0])]
        assert ledger(again) == ledger(run)

    def test_it_knows_what_carried_a_ball(self):
        """A lift: it rests, it is driven, and it flies off."""
        floor = Surface("lift", Segment((-9.0, 0.0), (9.0, 0.0)), 0.3, 0.4)
        ball = Ball("ball", 1.0, 0.1, (0.0, 0.3), forces=[Gravity(9.81)])
        lift = Moving(floor, Swinging((0.0, 0.0), 0.0, 1.0, shift=(0.0, 0.2)))
        run = with_scene(sandbox.simulate(Setup([ball], [lift], duration=3.0)))
        again = replay.run_of(run.scene, json.loads(json.dumps(replay.data_of(run))))
        assert any(arc.contact for arc in again.arcs["ball"])
        assert ledger(again).work == pytest.approx(ledger(run).work, rel=1e-7)
        assert ledger(again).contacts == pytest.approx(ledger(run).contacts, abs=1e-7)

    def test_simulated_again_it_is_the_same(self, recorded):
        assert "identical to the last bit" in replay.compared(recorded[0].run, replay.read(recorded[1]).run)

    def test_another_shot_is_told_from_it(self, recorded, shot_of):
        shot = replay.read(recorded[1])
        other = shot_of(Session("golf/putt", {"launch.speed": 2.4}))
        assert "m apart" in replay.compared(shot.run, other.run)

    @pytest.mark.parametrize(
        ("damage", "told"),
        [
            (lambda text: text[: len(text) // 2], "not complete JSON"),
            (lambda text: text.replace('"launch.speed": 2.5', '"launch.speed": 2.6'), "do not match its checksum"),
            (lambda text: text.replace('"version": 2', '"version": 99'), "version 99"),
            (lambda text: "[1, 2]", "not a replay"),
            (lambda text: "\x80\x81", "damaged"),
        ],
    )
    def test_a_damaged_one_says_so(self, recorded, damage, told):
        path = recorded[1]
        path.write_text(damage(path.read_text("utf-8")), encoding="utf-8")
        with pytest.raises(RequestError, match=told) as error:
            replay.read(path)
        assert str(path) in str(error.value)

    @pytest.mark.parametrize(
        "forge",
        [
            lambda body: body["run"].pop("arcs"),
            lambda body: body.update(parameters=5),
            lambda body: body.update(changes=[1]),
            lambda body: body["run"].update(arcs={"ball": []}),
            lambda body: body["run"]["arcs"]["ball"][0].__setitem__(2, [None] * 5),
            lambda body: body["run"].update(duration=1e999),
            lambda body: body["run"].update(duration=1e30),
            lambda body: body["run"]["events"][0].__setitem__(0, "later"),
            lambda body: body["run"]["events"][0].__setitem__(3, None),
            lambda body: body["run"]["arcs"]["ball"][0].__setitem__(2, []),
            lambda body: body["run"]["arcs"]["ball"][0].__setitem__(3, {}),
            lambda body: body["run"]["arcs"]["ball"][0][3].__setitem__(0, [1e300]),
            lambda body: body["run"]["result"].update(total=None),
        ],
    )
    def test_one_that_was_written_with_other_contents_says_so(self, recorded, forge):
        path = recorded[1]
        record = json.loads(path.read_text("utf-8"))
        forge(record["body"])
        record["check"] = replay.checksum(record["body"])
        path.write_text(json.dumps(record), encoding="utf-8")
        with pytest.raises(RequestError, match="damaged"):
            replay.read(path)

    def test_dropped_on_the_window_it_plays(self, player, recorded):
        player = player("golf")
        player.send(pygame.DROPFILE, file=str(recorded[1]))
        assert player.game.watching.playback.playing
        assert player.game.session.title == "golf/putt"
        player.frames(5)

    def test_a_key_writes_one_and_a_key_opens_the_newest(self, player, elsewhere):
        player = player("golf/putt")
        player.key(pygame.K_F5)
        assert not list(elsewhere.glob("out/*"))
        player.key(pygame.K_F7)
        assert "no replays" in player.game.notices[-1][0]
        player.key(pygame.K_SPACE)
        player.key(pygame.K_F5)
        assert replay.read(elsewhere / "out" / f"golf-putt-1{replay.SUFFIX}").run.duration > 0
        player.key(pygame.K_PAGEDOWN)
        assert player.game.session.title != "golf/putt"
        player.key(pygame.K_F7)
        assert player.game.session.title == "golf/putt"
        assert player.game.watching.playback.playing
        player.key(pygame.K_F6)
        player.settle()
        assert "identical to the last bit" in player.game.notices[-1][0]


def test_a_scene_file_keeps_its_comments(elsewhere):
    session = Session("golf/putt")
    session.change({"launch.speed": 2.25, "air.wind": [1.0, 0.0], "accuracy.level": "fast"})
    path = export.scene_file(session)
    text = path.read_text("utf-8")
    original = session.file.read_text("utf-8")
    for line in original.splitlines():
        if line.startswith("#"):
            assert line in text
    again = sandbox.load(path)
    assert again.parameters == session.scene.parameters
    assert tomllib.loads(text)["launch"]["speed"] == 2.25


def test_measured_points_are_on_stage_and_stay_with_a_new_file(elsewhere, shot_of):
    (elsewhere / "throw.csv").write_text("t,x,y,ball\n0.1,0.5,2.5,ball\n0.2,1.0,2.9,ball\n")
    (elsewhere / "throw.toml").write_text('scene = "basketball"\n[measured]\ntrack = "throw.csv"\n')
    stages = [Stage(shot_of(Session(source)), (640, 360)) for source in (str(elsewhere / "throw.toml"), "basketball")]
    for stage, (least, most) in zip(stages, ((3, 200), (0, 0)), strict=True):
        canvas = Canvas(pygame.Surface((640, 360)))
        stage.draw_measured(canvas)
        assert least <= pygame.surfarray.array3d(canvas.surface).any(axis=2).sum() <= most
    session = Session(str(elsewhere / "throw.toml"))
    session.change({"launch.speed": 7.0})
    again = sandbox.load(export.scene_file(session))  # in another folder
    assert again.measured is not None
    assert again.measured.positions.tolist() == [[0.5, 2.5], [1.0, 2.9]]


def test_the_command_line_gives_the_same_shot():
    session = Session("golf", {"launch.speed": 61.25, "air.wind": [-3.0, 0.0], "ball.drag.model": "lyu"})
    _, _, source, *settings = shlex.split(session.command())
    from sandbox.parameters import parse_assignment

    again = sandbox.load(source, dict(parse_assignment(text) for text in settings[1::2]))
    assert again.parameters == session.scene.parameters


def test_pictures_and_animations(player, elsewhere):
    player = player("volleyball/spike")
    player.key(pygame.K_F12)
    with Image.open(elsewhere / "out" / "volleyball-spike-1.png") as image:
        assert image.size == (1280, 720)
    player.key(pygame.K_SPACE)
    player.key(pygame.K_F9)
    player.settle()
    with Image.open(elsewhere / "out" / "volleyball-spike-1.gif") as image:
        assert image.n_frames > 10


class TestSound:
    def test_a_knock_begins_and_ends_in_silence(self):
        samples = sound.knock(sound.DULL)
        assert samples.shape[1] == 2
        assert abs(samples[0]).max() == 0
        assert abs(samples[-1]).max() < 400
        assert abs(samples).max() > 15000

    def test_faster_is_louder(self, player):
        player = player("golf")
        speaker = sound.Sound()
        assert speaker.knocks
        heard = []
        for speed in (1.0, 5.0, 15.0):
            speaker.impact(speed, of_balls=False)
            heard.append(speaker.knocks[0].get_volume())
        assert heard == sorted(set(heard))
        pygame.mixer.quit()

    def test_without_a_device_there_is_silence(self, monkeypatch):
        pygame.mixer.quit()
        monkeypatch.setenv("SDL_AUDIODRIVER", "none such")
        speaker = sound.Sound()
        assert not speaker.on
        speaker.impact(10.0, of_balls=True)
