"""The game without a picture: aiming, watching, what fails, what never ends, undo."""

from __future__ import annotations

import ast
import subprocess
import sys
from concurrent.futures import Future
from graphlib import TopologicalSorter
from pathlib import Path
from typing import Any

import pytest

import sandbox.window
from sandbox.cli.new import new_scene
from sandbox.engine.model.accuracy import LEVELS
from sandbox.window.aim import nudged
from sandbox.window.background import LatestJob
from sandbox.window.game import Game
from sandbox.window.handles import grips
from sandbox.window.history import DEPTH
from sandbox.window.path import LATE, LONG
from sandbox.window.session import Session
from sandbox.window.shots import PATHS
from sandbox.window.worker import computed
from sandbox.workers import WorkerLost
from tests.own_scene import HANG

STUCK = "\n\ndef stuck(t, position, velocity, spin):\n    while velocity[0] > 9:\n        pass\n    return 0.0, 0.0\n"
PLAIN = "\n\ndef stuck(t, position, velocity, spin):\n    return 0.0, 0.0\n"
LAMBDA = "\n\nstuck = lambda t, position, velocity, spin: (0.0, 0.0)\n"
COUNTED = """

def counted(parameters, build=build):
    with open(__file__ + ".built", "a") as file:
        file.write("x")
    return build(parameters)


build = counted
"""
RAISES = "\n\ndef stuck(t, position, velocity, spin):\n    return 1 / (velocity[0] < 9), 0.0\n"


class Here:
    """Computes at once, in this process."""

    def __init__(self) -> None:
        self.stopped = 0
        self.stuck: list[Future] = []
        self.never = False  # what is asked for next never ends

    def submit(self, work, *args):
        future: Future = Future()
        if self.never and work is computed:
            future.set_running_or_notify_cancel()
            self.stuck.append(future)
            return future
        try:
            future.set_result(work(*args))
        except Exception as error:
            future.set_exception(error)
        return future

    def abandon(self, call) -> None:
        self.stopped, self.never = self.stopped + 1, False
        while self.stuck:
            self.stuck.pop().set_exception(WorkerLost("killed"))


@pytest.fixture
def game() -> Game:
    one = Game(Session("golf/putt"), Here())
    one.settle()
    return one


@pytest.fixture
def own(tmp_path):
    """A scene of one's own, with a force of one's own."""

    def make(force: str, worker: Any = None) -> Game:
        new_scene(tmp_path / "own")
        file = tmp_path / "own" / "scene.py"
        code = file.read_text("utf-8")
        assert "fan.push))" in code
        file.write_text(code.replace("fan.push))", "fan.push), stuck)") + force, "utf-8")
        return Game(Session(str(file.parent), {"launch.speed": 8.0}), worker or Here())

    return make


def test_it_draws_nothing():
    code = "import sys, sandbox.window.game; sys.exit('pygame' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=HANG)


def test_a_game_aims_is_watched_pauses_and_aims_again(game):
    assert game.watching.playback is None
    game.aiming.shoot()
    assert game.watching.playback.playing
    game.watching.playback.toggle()
    assert not game.watching.playback.playing
    game.aiming.again()
    assert game.watching.playback is None
    assert [shot.number for shot in game.shots.paths] == [1]


def test_nudges_leave_a_shot_that_is_watched_alone(game):
    game.aiming.shoot()
    for end in (False, True):
        if end:
            game.watching.playback.seek(1e9)
        assert not game.aiming.nudge(nudged(game.session, push=1))
        assert game.watching.playback is not None
        assert "Enter" in game.notices[-1][0]
    assert game.session.changes.values == {}


def test_only_the_last_shots_are_kept(game):
    for _ in range(PATHS + 5):
        game.aiming.shoot()
        game.aiming.again()
        game.settle()
        game.watching.pin(game.shots.rows[0]) if len(game.shots.rows) == 1 else None
    assert [shot.number for shot in game.shots.paths] == [1, *range(6, PATHS + 6)]
    assert [row.number for row in game.shots.rows] == list(range(1, PATHS + 6))
    game.watching.watch_other(-1)
    assert game.shot.number == PATHS + 5


class TestAFailure:
    def test_a_failed_run_leaves_no_shot_and_names_file_and_line(self, own):
        game = own(RAISES)
        game.settle()
        assert game.failure is None
        game.aiming.change({"launch.speed": 60.0})
        game.settle()
        game.advance(100.0)
        ((text, bad),) = [notice for notice in game.notices if "ZeroDivisionError" in notice[0]]
        assert bad
        line = (game.session.base.folder / "scene.py").read_text("utf-8").splitlines().index(
            "    return 1 / (velocity[0] < 9), 0.0"
        )  # fmt: skip
        assert f"scene.py, line {line + 1})" in text
        game.aiming.shoot()
        assert game.watching.playback is None
        game.aiming.change({"launch.speed": 8.0})
        game.settle()
        assert game.failure is None
        assert not game.notices

    def test_invalid_values_are_said_and_the_last_good_ones_stay(self, game):
        before = game.session.scene
        assert not game.aiming.change({"launch.speed": -3.0})
        assert game.notices == [("the window's launch.speed = -3.0: must be from 0 to 340 m/s", True)]
        assert game.session.scene is before


class TestARunThatNeverEnds:
    @pytest.fixture
    def stuck(self, game, monkeypatch) -> Game:
        game.workers.path.never = True
        game.aiming.change({"launch.speed": 2.0})
        game.advance(0.0)
        assert game.path.runs.work is not None
        game.path.runs.began -= 1.01 * LONG
        game.advance(0.0)
        return game

    def test_time_goes_on_and_it_may_be_stopped(self, stuck):
        assert "Esc stops it" in stuck.notices[-1][0]
        assert stuck.stop()
        assert stuck.workers.path.stopped == 1
        assert stuck.path.settled
        assert stuck.failure is not None
        stuck.aiming.shoot()
        assert stuck.watching.playback is None

    def test_another_aim_stops_it_by_itself(self, stuck):
        stuck.aiming.change({"launch.speed": 1.5})
        stuck.advance(0.0)
        assert stuck.workers.path.stopped == 1
        stuck.settle()
        assert stuck.shot.scene is stuck.session.scene

    def test_the_next_is_left_twice_as_long_until_one_ends(self):
        """Or a new process, which has to import all again, would be stopped before its first run ends."""
        abandoned: list[Future] = []
        latest: LatestJob[None] = LatestJob(abandoned.append, hung=2.0)
        for key, patience in ((1, 2.0), (2, 4.0), (3, 8.0), (5, 2.0)):
            latest.follow(key, lambda key: Future())
            before = len(abandoned)
            for waited, stopped in ((0.9, before), (0.2, before + 1)):
                latest.began -= waited * patience
                latest.follow(key + 1, lambda key: Future())
                assert len(abandoned) == stopped
            if key == 3:
                latest.work.set_result(None)
                assert latest.take()

    def test_an_old_path_is_not_shown_for_a_slow_new_one(self, game):
        game.workers.path.never = True
        game.aiming.change({"launch.speed": 2.0})
        game.advance(0.0)
        assert not game.late
        seen, game.path.runs.began = game.visible_state, game.path.runs.began - LATE
        game.advance(0.0)
        assert game.late
        assert game.visible_state != seen
        game.workers.path.abandon(None)
        game.advance(0.0)
        assert not game.late

    def test_a_short_one_is_not_stopped(self, game):
        assert not game.stop()

    def test_a_real_one_ends_with_its_process(self, own, worker):
        game = own(STUCK, worker)
        game.settle()
        game.aiming.change({"launch.speed": 60.0})
        game.advance(0.0)
        game.path.runs.began -= 1.01 * LONG
        assert game.stop()
        game.aiming.change({"launch.speed": 8.0})
        game.settle()
        assert game.failure is None
        assert game.shot.scene is game.session.scene


@pytest.mark.parametrize(("force", "times"), [(PLAIN, 1), (LAMBDA, 2)])
def test_a_setup_is_built_once_where_it_is_run(own, worker, force, times):
    """Again in the window only if it cannot be pickled."""
    game = own(force + COUNTED, worker)
    game.settle()
    builds = game.session.base.folder / "scene.py.built"
    assert len(builds.read_text("utf-8")) == 1 + times  # it is checked where it is opened
    (fan,) = [grip for grip in grips(game.session) if "fan.place" in grip.keys]
    for count, change in enumerate(
        (
            lambda: game.aiming.change({"launch.speed": 9.0}),
            lambda: game.aiming.set(fan.changes((fan.place[0] + 1.0, 0.0), 0.1)),
            game.aiming.undo,
            lambda: game.aiming.reset(),
        ),
        1,
    ):
        if count == 1:
            builds.unlink()
        change()
        game.settle()
        assert game.shot.scene is game.session.scene
        assert builds.read_text("utf-8") == "x" * times * count
    game.aiming.shoot()
    assert len(builds.read_text("utf-8")) == 4 * times


def test_parameters_that_cannot_be_built_are_no_step_of_undo(worker):
    game = Game(Session("billiards/cut"), worker)
    game.settle()
    game.aiming.change({"cue.angle": 12.0})
    game.settle()
    shot = game.shot
    for values in ({"cue.follow": 0.9}, {"balls[1].x": game.session.value("balls[0].x"), "balls[1].y": 0.0}):
        game.aiming.change(values)
        game.settle()
        assert game.notices[-1][1]
        assert game.failure is None
        assert game.shot is shot
        assert game.session.changes.values == {"cue.angle": 12.0}
    game.aiming.undo()
    assert game.session.changes.values == {}


class TestUndo:
    def test_a_reset_can_be_undone(self, game):
        game.aiming.change({"launch.speed": 2.0})
        game.aiming.change({"gravity": 5.0})
        game.aiming.reset()
        assert game.session.changes.values == {}
        game.aiming.undo()
        assert game.session.changes.values == {"launch.speed": 2.0, "gravity": 5.0}
        game.aiming.undo()
        game.aiming.undo()
        assert game.session.changes.values == {}
        game.aiming.undo()
        assert game.notices[-1][0] == "nothing to undo"

    def test_what_is_dragged_is_undone_at_once(self, game):
        for speed in (2.0, 2.1, 2.2):
            game.aiming.change({"launch.speed": speed})
        game.aiming.undo()
        assert game.session.changes.values == {}

    def test_redo_lasts_until_something_else_is_done(self, game):
        for key in ("gravity", "pin.distance"):
            game.aiming.change({key: 3.0})
        for _ in range(3):
            game.aiming.undo()
        game.aiming.redo()
        assert game.session.changes.values == {"gravity": 3.0}
        game.aiming.change({"launch.speed": 2.0})
        game.aiming.redo()
        assert game.notices[-1][0] == "nothing to redo"
        assert game.session.changes.values == {"gravity": 3.0, "launch.speed": 2.0}

    def test_a_shot_and_another_scene_are_undone_and_done_again(self, game):
        game.aiming.change({"launch.speed": 2.0})
        game.settle()
        game.aiming.shoot()
        game.aiming.undo()
        assert game.watching.playback is None
        assert game.session.value("launch.speed") == 2.0
        game.aiming.redo()
        assert game.shot is game.shots.paths[0]
        game.opening.open("golf/moon")
        game.aiming.undo()
        assert (game.session.title, game.session.value("launch.speed")) == ("golf/putt", 2.0)
        game.aiming.redo()
        assert game.session.title == "golf/moon"

    def test_the_last_200_are_kept(self, game):
        for number in range(DEPTH + 50):
            game.aiming.change({"gravity": 1.0 + 0.01 * (number // 2), "launch.angle": 0.01 * number})
            game.aiming.history.end()
        for _ in range(DEPTH + 50):
            game.aiming.undo()
        assert game.notices[-1][0] == "nothing to undo"
        assert game.session.value("launch.angle") == pytest.approx(0.5)

    def test_two_pulls_are_two_changes(self, game):
        for at in ((100, 300), (50, 300)):
            game.grasp.begin_pull((300, 300), (1280, 720), 600, 1.0)
            game.grasp.pull_to((200, 300))
            game.grasp.pull_to(at)
            game.settle()
            game.grasp.release()
            game.aiming.again()
        strong = game.session.value("launch.speed")
        game.aiming.undo()
        assert 0 < game.session.value("launch.speed") < strong
        weak = game.session.changes
        game.grasp.begin_pull((300, 300), (1280, 720), 600, 1.0)
        game.grasp.pull_to((100, 250))
        game.grasp.cancel()
        assert game.session.changes == weak
        game.aiming.undo()
        assert game.session.changes.values == {}


def test_a_full_pull_suits_the_shot():
    for source, fastest in (("golf/putt", 10.0), ("golf", 110.0), ("billiards", 20.0)):
        game = Game(Session(source), Here())
        game.grasp.begin_pull((300, 300), (1280, 720), 600, 1.0)
        game.grasp.pull_to((-600, 300))
        speed, before = game.session.value(game.session.controls.speed), game.session.base_value(
            game.session.controls.speed
        )  # fmt: skip
        assert before * 1.1 < speed < fastest


def test_earlier_shots_are_of_the_same_file_and_start(game):
    game.aiming.shoot()
    game.aiming.again()
    assert len(game.ghosts) == 1
    game.opening.open("golf/moon")
    assert game.ghosts == []
    assert len(game.shots.paths) == 1


@pytest.mark.parametrize("level", LEVELS)
def test_it_says_what_an_accuracy_costs(game, level):
    from sandbox.window.worker import cost_and_errors

    game.aiming.change({"accuracy.level": level})
    assert " ms a run; " in cost_and_errors(game.session.scene)


def test_modules_of_the_window_import_in_one_direction():
    room = Path(sandbox.window.__file__).parent
    known = {file.stem for file in room.glob("*.py")} - {"__init__"}
    uses: dict[str, set[str]] = {}
    for name in known:
        tree = ast.parse((room / f"{name}.py").read_text("utf-8"))
        found = set()
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module == "sandbox.window":
                found |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("sandbox.window."):
                found.add(node.module.rpartition(".")[2])
        uses[name] = found & known
    order = list(TopologicalSorter(uses).static_order())  # raises CycleError
    chain = [order.index(name) for name in ("game", "view", "commands", "pointer", "app")]
    assert chain == sorted(chain)
