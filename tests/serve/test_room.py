"""Players and the teacher over WebSocket, without a browser."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
import time
import urllib.request
import zlib
from math import hypot
from pathlib import Path

import numpy as np
import pytest

import sandbox
from sandbox import tasks
from sandbox.serve import calls, command, server, sessions, tokens, work
from sandbox.serve.limits import AWAY, PLAYERS
from sandbox.serve.room import Listed, Player, Room
from tests.own_scene import DROP, copy_of
from tests.serve.conftest import Client, serving


def test_a_path_is_that_of_python(player):
    """With every number to 1 um, for changes within bounds."""
    client = player(source="basketball")
    client.hear("scene")
    changes = {"launch.speed": 7.6, "launch.angle": 55.0, "air.wind[0]": -2.0}
    n = client.ask("path", changes)
    run = client.hear("path", n=n)["run"]
    expected = sandbox.simulate(sandbox.load("basketball", changes))
    assert run["verdict"] == expected.scene.verdict(expected)
    assert run["rows"] == [list(row) for row in expected.scene.rows(expected)]
    (ball,) = run["balls"]
    assert ball["path"]["until"] == pytest.approx(expected.arcs["ball"][-1].t1, abs=1e-6)
    for (times, x, y, *_), arc in zip(ball["path"]["arcs"], expected.arcs["ball"], strict=True):
        assert (times[0] if isinstance(times, list) else times) == pytest.approx(arc.t0, abs=1e-6)
        assert x == pytest.approx(list(arc.x), abs=1e-6)
        assert y == pytest.approx(list(arc.y), abs=1e-6)


def test_place_fan_and_shot_come_as_asked(player):
    client = player(source="basketball")
    stage = client.hear("stage", n=client.ask("stage", room=[390, 700]))["stage"]
    assert stage["room"] == [390, 700]
    assert stage["view"]["size"] == [780, 780]  # a side view is no taller than wide
    assert stage["view"]["place"].startswith("data:image/webp;base64,")
    fan = client.hear("fan", n=client.ask("fan"))
    assert len(fan["lines"]) == 100
    assert fan["said"].startswith(f"{sum(scored for scored, _ in fan['lines'])} of 100 score")
    run = client.hear("shot", n=client.ask("shoot"))["run"]
    assert run["energy"]["bands"]
    assert len(run["event_rows"]) == len(run["events"]) > 0
    assert run["forces"]["causes"]


def test_a_path_may_take_so_much_processor_time(monkeypatch: pytest.MonkeyPatch):
    """A balloon in a storm: its path takes many seconds. The process goes on with the next one."""
    monkeypatch.setattr(work, "PATH", 0.05)
    storm = {"ball.radius": 0.19, "air.wind[0]": -100.0, "air.wind[1]": -14.0}
    said = {"error": "this path takes more than 0.05 s to compute: let go to see the shot"}
    assert work.path(calls.Ask("golf", storm, 1)) == said
    monkeypatch.setattr(work, "PATH", 60.0)
    assert "message" in work.path(calls.Ask("golf", {}, 2))


def test_who_left_is_soon_gone_from_the_teachers_list():
    """And for an hour still the same player for whoever comes back."""
    sent = []

    class Teacher:
        def send(self, kind, message):
            sent.append(message)

    room = Room({"golf": Listed("golf", "")}, None, "si")
    for number, ago in ((1, AWAY + 1.0), (2, 1.0)):
        gone = Player(number, f"session {number}", f"player {number}", "golf", {}, seen=time.monotonic() - ago)
        room.players[gone.session] = gone
    room.teachers[Teacher()] = ""
    room._tell_teachers()
    room._forget()
    assert [(each["name"], each["here"]) for each in sent[-1]["players"]] == [("player 2", False)]
    assert list(room.players) == ["session 1", "session 2"]


def test_players_who_left_make_room_for_new_ones():
    """Before one more comes there are fewer than four times as many as may play: the first who left are forgotten."""
    room = Room({"golf": Listed("golf", "")}, None, "si")
    for number in range(4 * PLAYERS):
        seen = time.monotonic() - 60.0 + 0.01 * number
        room.players[str(number)] = Player(number, str(number), f"player {number}", "golf", {}, seen=seen)
    room._forget()
    assert list(room.players) == [str(number) for number in range(1, 4 * PLAYERS)]


def test_a_teacher_may_look_at_another_scene(player):
    """Which no pupil notices."""
    teacher, ann = player(teacher=True), player(name="Ann", source="basketball")
    assert teacher.hear("scene")["source"] == ann.hear("scene")["source"] == "basketball"
    teacher.say(do="see", source="golf")
    assert teacher.hear("scene")["source"] == "golf"
    run = teacher.hear("path", n=teacher.ask("path", {"launch.angle": 20.0}))["run"]
    assert "carry" in run["verdict"]
    ann.hear("path", n=ann.ask("path", {"launch.angle": 55.0}))  # of basketball, without another scene before it
    teacher.say(do="see", source="nowhere")
    assert teacher.hear("error")["text"] == "this scene is not played here"


def test_a_link_and_a_lost_connection_give_the_state_back(player):
    first = player(source="golf/driver", changes={"launch.angle": 15.5}, name="Ann")
    session = first.hear("welcome")["session"]
    scene = first.hear("scene")
    assert (scene["source"], scene["changes"]) == ("golf/driver", {"launch.angle": 15.5})
    n = first.ask("path", {"launch.angle": 17.0})
    first.hear("path", n=n)
    first.socket.socket.close()  # the network is gone
    again = player(session=session)
    welcome = again.hear("welcome")
    assert (welcome["session"], welcome["name"]) == (session, "Ann")
    assert again.hear("scene")["changes"] == {"launch.angle": 17.0}


@pytest.mark.parametrize(
    ("source", "changes", "expected", "said"),
    [
        ("golf", {"launch.speed": "150 mph", "launch.angle": 15}, {"launch.speed": 67.056, "launch.angle": 15}, ""),
        ("golf", {"launch.speed": "900 mph"}, {}, "launch.speed: must be a number from 0 to 340 m/s"),
        ("golf", {"nothing": 1.0}, {}, "nothing: cannot be changed here"),
        ("free-throw", {"launch.speed": 99}, {}, "launch.speed: must be a number from 4 to 10 m/s"),
    ],
)
def test_a_link_is_read_as_far_as_it_can_be(player, source: str, changes: dict, expected: dict, said: str):
    """Amounts in any unit; of one that cannot be, the scene as it is, and why."""
    client = player(source=source, changes=changes)
    if said:
        assert client.hear("error")["text"] == said
    scene = client.hear("scene")
    assert scene["source"] == source
    assert scene["changes"] == pytest.approx(expected)


def test_the_addresses_stay_for_some_hours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Where nobody else can read them, and only for as long as it is said."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    file = tmp_path / "sports-sandbox" / "serve.json"
    first = tokens.tokens()
    assert len(set(first)) == 2
    assert tokens.tokens() == first
    assert file.stat().st_mode & 0o777 == 0o600
    fresh = tokens.tokens(fresh=True)
    assert not set(fresh) & set(first)
    assert tokens.tokens() == fresh
    long_ago = time.time() - tokens.KEPT - 1.0
    os.utime(file, (long_ago, long_ago))
    later = tokens.tokens()
    assert not set(later) & set(fresh)
    file.chmod(0o644)  # others may have read them
    assert not set(tokens.tokens()) & set(later)
    for text in ("", "{}", '{"play": "x", "teach": "x"}', '{"play": "x/../../aaaa", "teach": "bbbbbbbbbbbb"}', "[]"):
        file.write_text(text, "utf-8")
        assert all(len(each) == 12 for each in tokens.tokens())
    monkeypatch.setenv("XDG_STATE_HOME", os.devnull)  # nothing can be kept
    assert tokens.tokens() != tokens.tokens()


def test_the_teacher_leads_freezes_and_sees_the_shots(player):
    teacher, ann, ben = player(teacher=True), player(name="Cleo"), player(name="=Ben()")
    for client in (ann, ben):
        client.hear("welcome")
    teacher.say(do="clear")
    teacher.say(do="lead", source="golf", changes={"launch.angle": 20.0})
    for client in (ann, ben):
        assert client.hear("scene", source="golf")["changes"] == {"launch.angle": 20.0}
    ann.say(do="play", source="billiards")
    assert "the teacher has chosen" in ann.hear("error")["text"]
    teacher.say(do="predict", fact="carry")
    assert ann.hear("lead", predict="carry")["source"] == "golf"
    hidden = ann.hear("path", n=ann.ask("path", {"launch.angle": 25.0}))["run"]
    assert hidden["hidden"]
    assert hidden["duration"] == hidden["balls"][0]["path"]["until"] == 0.0
    assert (hidden["verdict"], hidden["rows"]) == ("", [])
    for client, angle, guess in ((ann, 25.0, 200.0), (ben, 30.0, 250.0)):
        client.hear("shot", n=client.ask("shoot", {"launch.angle": angle}, predicted=guess))
    room = teacher.hear("room", counted=2)
    assert [each["last"]["scored"] for each in room["players"] if each["name"] in ("Cleo", "=Ben()")] == [False, False]
    assert [(row["name"], row["predicted"]) for row in room["rows"]] == [("Cleo", 200.0), ("=Ben()", 250.0)]
    address = teacher.socket.request.headers["Origin"] + teacher.socket.request.path.removesuffix("talk")
    with urllib.request.urlopen(f"{address}shots.csv") as table:
        rows = list(csv.DictReader(io.StringIO(table.read().decode())))
    expected = sandbox.simulate(sandbox.load("golf", {"launch.angle": 30.0})).result
    assert rows[1]["name"] == "'=Ben()"  # no formula
    assert float(rows[1]["carry"]) == pytest.approx(expected["carry"], abs=1e-5)
    assert (rows[1]["launch.angle"], rows[1]["predicted_result"], rows[1]["predicted"]) == ("30.0", "carry", "250.0")
    teacher.say(do="freeze", on=True)
    ann.hear("lead", frozen=True)
    n = ann.ask("shoot")
    assert "stopped the game" in ann.hear("error")["text"]
    assert ann.hear("path", n=ann.ask("path", {"launch.angle": 25.0}))  # such as that of a page which was opened again
    n = ann.ask("path", {"launch.angle": 26.0})
    assert "stopped the game" in ann.hear("error", n=None)["text"]
    teacher.say(do="freeze", on=False)
    teacher.say(do="lead", source="")
    teacher.say(do="clear")
    ann.hear("lead", source="", frozen=False)
    assert ann.hear("path", n=ann.ask("path"))["n"] == n + 1


def test_a_task_is_played_to_its_end(player):
    """Attempt by attempt, with starts, noise and score as a session in Python has them; after a lost connection too."""
    client = player(source="free-throw")
    session = client.hear("welcome")["session"]
    scene = client.hear("scene")
    task = tasks.load("free-throw")
    assert [each["key"] for each in scene["parameters"]] == [control.key for control in task.controls]
    assert (scene["about"], scene["task"]["attempts"]) == (task.goal, task.attempts)
    low, high = next((each["low"], each["high"]) for each in scene["parameters"] if each["key"] == "launch.speed")
    client.ask("path", {"launch.speed": low - 1.0})
    assert "must be a number from" in client.hear("error")["text"]
    # from far too short to far too long, wherever it starts
    aims = [{"launch.speed": float(speed), "launch.angle": 52.0} for speed in np.linspace(low, high, task.attempts)]
    told = [client.hear("shot", n=client.ask("shoot", aim))["run"] for aim in aims[:2]]
    client.socket.socket.close()  # the network is gone
    client = player(session=session, source="free-throw")
    client.hear("scene")
    assert client.hear("path", n=client.ask("path"))["run"]["task"]["attempt"] == 3
    told += [client.hear("shot", n=client.ask("shoot", aim))["run"] for aim in aims[2:]]
    client.ask("shoot")
    assert f"all {task.attempts} attempts are played" in client.hear("error")["text"]
    verdicts = [run["verdict"] for run in told]
    assert [run["task"]["over"] for run in told] == [False] * (task.attempts - 1) + [True]
    assert len(set(verdicts)) > 1
    assert told[-1]["task"]["total"].endswith(" made")
    client.say(do="play", source="free-throw")
    client.hear("scene")
    standing = client.hear("path", n=client.ask("path"))["run"]["task"]
    assert (standing["attempt"], standing["over"], standing["stars"]) == (1, False, 0)
    assert (standing["to_pass"], standing["for_stars"][2]) == ("3", "5")


def test_two_browsers_play_a_match_in_turn(player):
    """Each sees both scores and every shot; who is not to shoot cannot; and who leaves ends it."""
    game = "billiards/games/nine-ball"
    ann, ben = player(name="Ann", source=game), player(name="Ben")
    assert ann.hear("waits")["title"] == "Nine ball"
    ben.say(do="play", source=game)
    both = {client.hear("scene", source=game)["you"]: client for client in (ann, ben)}
    assert both == {0: ann, 1: ben}
    ben.ask("shoot")
    assert ben.hear("error")["text"] == "it is not your turn"
    ann.ask("path", {"table.length": 3.0})
    assert ann.hear("error")["text"] == "table.length: cannot be changed here"
    softly = {"cue.speed": 0.5, "cue.angle": 90.0}  # at no ball: a foul
    n = ann.ask("shoot", softly)
    runs = [client.hear("shot", n=n)["run"] for client in (ann, ben)]
    assert runs[0]["verdict"] == runs[1]["verdict"] == "Foul: no ball hit. Ball in hand"
    for client in (ann, ben):
        match = client.hear("scene", shots=1)["match"]
        assert (match["turn"], match["status"], match["over"]) == (1, "Ben to play", False)
    assert ben.hear("path", n=ben.ask("path", {"balls[0].y": 0.3}))["run"]["hidden"]  # in hand, as far as is shown
    ann.say(do="play", source="golf")
    assert ben.hear("left")["text"] == "Ann has left the match."


@pytest.mark.parametrize("kind", [kind for kind in server._scenes_of([]).values() if kind.game])
def test_each_game_begins_in_a_browser(kind: Listed):
    """With the controls of a player, and no more, for the one whose turn it is."""
    duel = calls.Duel(kind.game, ("Ann", "Ben"), 7)
    described = work.described(kind.source, False, duel)["kept"]
    assert described["match"]["players"] == ("Ann", "Ben")
    assert {described["pull"]["speed"], described["pull"]["angle"]} <= {p["key"] for p in described["parameters"]}


@pytest.mark.parametrize(("room", "turned"), [((390, 700), True), ((940, 680), False)])
def test_a_table_stands_upright_where_there_is_room(room, turned: bool):
    """And its balls are at least 10 px wide."""
    reply = work.WORKS["stage"](calls.Ask("billiards", {}, 1, room))
    view = json.loads(zlib.decompress(reply["message"]))["stage"]["view"]
    wide, tall = reversed(view["size"]) if turned else view["size"]
    assert (view["turned"], wide > tall) == (turned, not turned)
    shown = min(room[0] / wide, room[1] / tall)  # px of the page for each of the picture
    assert 2 * 0.028575 * view["scale"] * shown >= 10.0


def test_a_session_is_found_again_from_its_shots():
    """In a process that has never seen it, with the same starts and the same noise."""
    aims = [{"launch.speed": 7.0 + 0.1 * n, "launch.angle": 52.0} for n in range(3)]
    session = tasks.Session(tasks.load("free-throw"), seed=7, player=3)
    for n, aim in enumerate(aims):
        sessions._sessions.clear()
        reply = work.shot(calls.Ask("free-throw", aim, 1, game=calls.Game(7, 3, tuple(aims[:n]))))
        assert reply["kept"]["verdict"] == session.shoot(aim).verdict
        assert reply["kept"]["task"]["attempt"] == session.attempt.number == n + 2


@pytest.mark.parametrize(("shown", "task"), [("one metre", "at-the-knees"), ("first contact", "curve-for-a-strike")])
def test_a_path_that_a_task_hides_is_not_sent(shown: str, task: str):
    known = tasks.load(task)
    assert known.shown == shown
    ask = calls.Ask(task, {}, 1, game=calls.Game(7, 1))
    run = json.loads(zlib.decompress(work.path(ask)["message"]))["run"]
    expected = sandbox.simulate(known.at_start(7, 1))
    (ball,) = run["balls"]
    end = ball["path"]["until"]
    assert (run["verdict"], run["rows"], run["events"]) == ("", [], [])
    x, y, *_ = expected.state("ball", end)
    if shown == "one metre":
        assert hypot(x - expected.state("ball", 0.0)[0], y - expected.state("ball", 0.0)[1]) == pytest.approx(
            1.0, abs=0.02
        )
    else:
        assert end == pytest.approx(next(event.t for event in expected.events if event.kind == "impact"), abs=1e-6)
    assert ball["path"]["arcs"][-1][1][-1] == pytest.approx(x, abs=1e-4)


def test_no_code_of_a_scene_runs_in_the_server_itself(tmp_path):
    """A scene of one's own is imported where it is computed; and what never ends there is ended."""
    scene = copy_of(DROP, tmp_path / "drop")
    text = (scene / "scene.py").read_text("utf-8")
    mark = f"\nimport os, pathlib\npathlib.Path({str(tmp_path)!r}, f'imported-{{os.getpid()}}').touch()\n"
    (scene / "scene.py").write_text(text + mark, "utf-8")
    with serving("./drop", "--jobs", "1", cwd=tmp_path) as drop:
        client = Client(drop.url)
        assert client.hear("scene")["source"] == "./drop"
        assert client.hear("path", n=client.ask("path"))["run"]["verdict"]
        client.close()
        pids = {int(file.name.rpartition("-")[2]) for file in tmp_path.glob("imported-*")}
        assert pids
        assert drop.pid not in pids
        assert os.getpid() not in pids
        assert drop.stop() == 130


def test_a_verdict_with_half_a_character_reaches_the_browser(tmp_path: Path):
    drop = copy_of(DROP, tmp_path / "drop")
    text = (drop / "scene.py").read_text("utf-8").replace('return "Bounced"', 'return "\\ud83d bounced"')
    (drop / "scene.py").write_text(text, "utf-8")
    reply = work.shot(calls.Ask(str(drop), {}, 1))
    assert json.loads(zlib.decompress(reply["message"]))["run"]["verdict"] == "\ud83d bounced"


def test_the_server_itself_imports_no_scenes_and_no_pictures():
    code = "import sys, sandbox.serve.server; print(*sys.modules)"
    modules = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.split()
    assert "sandbox.serve.app" in modules
    assert {"sandbox.scene.scene", "sandbox.engine", "pygame", "pymunk", "numpy"} & set(modules) == set()


def test_sharing_says_what_it_means(capsys: pytest.CaptureFixture[str]):
    """Without it the server listens to this computer only."""
    for shared, host in ((False, "127.0.0.1"), (True, "0.0.0.0")):
        with server._listening(0, shared) as listener:
            assert listener.getsockname()[0] == host
        url = f"http://192.168.100.100:54321/{'x' * 12}/"
        command._text(server.Address(url, url, 54321, shared))
        said = capsys.readouterr().out
        assert ("not encrypted" in said, "Only browsers on this computer" in said) == (shared, not shared)
        assert url in said
        assert max(map(len, said.splitlines())) <= 80
        assert sum("█" in line for line in said.splitlines()) > 10


@pytest.mark.parametrize(
    ("args", "expected"),
    [
        (["nowhere"], "unknown scene nowhere"),
        (["golf/nothing"], "golf has no preset nothing"),
        (["golf", "--port", "70000"], "70000"),
    ],
)
def test_what_cannot_be_served_is_refused(call, args: list[str], expected: str):
    code, out, err = call("serve", *args)
    assert (code, out) == (2, "")
    assert expected in err
