"""Playing for something: the first screen, tasks with their attempts and stars, the best list, matches of two."""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import wait
from dataclasses import replace
from datetime import date, timedelta
from pathlib import Path
from threading import Thread
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from sandbox import tasks
from sandbox.errors import RequestError
from sandbox.scene import simulate
from sandbox.scene.discovery import installed_folder, installed_folders
from sandbox.tasks.games import game_of
from sandbox.tasks.sports import TILE, TILE_FILE, sports
from sandbox.window import commands, keeping, opponent
from sandbox.window.app import play
from sandbox.window.background import Workers
from sandbox.window.banner import LASTS
from sandbox.window.best import MOST, Best, BestList, usual_file
from sandbox.window.contest import AtMatch, AtTask, AtTaskOfDay
from sandbox.window.decathlon import EVENTS, Decathlon
from sandbox.window.front import START_HERE, Front, entries_of, events, first_task
from sandbox.window.panel import SLIDER_OF
from sandbox.window.prediction import Prediction
from sandbox.window.referee import AFTER, COMPUTER, decided_at, deciding_ball
from sandbox.window.session import Session
from sandbox.window.shots import LONGEST_FRAME, SHOWN
from tests.own_scene import DROP, HANG, copy_of

from .conftest import Player
from .test_play import Unanswered
from .test_see import said

GOAL = "Make three of five free throws"
SEED = 1
DROPPED = """
goal = "Bounce once."
scene = "drop"
level = 1
attempts = 1
shown = "one metre"
score = { fact = "bounced", how = "sum" }
pass = 1
stars = [1, 1, 1]

[[controls]]
key = "launch.height"
low = 0.2
high = 5.0
default = 0.3
"""


def passes(player: Player, enough: Callable[[], bool]) -> None:
    """Time passes until it is enough, without drawing; then one frame."""
    for _ in range(5000):
        referee = player.game.referee
        under_way = [referee.work, *(job.work for job in player.game.jobs.waiting)]
        under_way += [referee.opponent.work] if referee.opponent is not None else []
        wait([work for work in under_way if work is not None], 60.0)
        player.game.advance(LONGEST_FRAME)
        if enough():
            player.frames()
            return
    raise AssertionError("that never happens")


def shoot(player: Player, **values: float) -> None:
    """Aim, shoot, and watch to the end of what is shown by itself."""
    game, referee = player.game, player.game.referee
    if values:
        assert game.aiming.change({key.replace("__", "."): value for key, value in values.items()})
    player.settle()
    shots = len(referee.shots)
    player.key(pygame.K_SPACE)
    passes(player, lambda: len(referee.shots) > shots and referee.tells and referee.again != "slow")
    passes(player, lambda: not game.banner.shows)  # and then the contest tells


#: The free throw of the preset that goes in.
IN = {"launch__speed": 7.391, "launch__angle": 52.0}


@pytest.fixture
def thrower(player) -> Player:
    """A player at the free throw's task, from the same height each time, whose hand does not tremble."""
    player = player("basketball", (900, 560))
    contest = AtTask(replace(tasks.load("free-throw"), start=()), seed=SEED)
    contest.sessions = [tasks.Session(contest.task, SEED, noise=False)]
    player.game.referee.begin(contest)
    player.settle()
    return player


class TestTheFirstScreen:
    def test_every_sport_has_a_small_tile(self):
        for name, folder in installed_folders().items():
            image = pygame.image.load(folder / TILE_FILE)
            assert image.get_size() == TILE, name
            assert (folder / TILE_FILE).stat().st_size < 20_000

    def test_tiles_lead_to_all_that_can_be_played(self):
        assert {sport.name for sport in sports()} == installed_folders().keys()
        assert {name for sport in sports() for name in sport.tasks} == set(tasks.tasks())
        entries = [entry for sport in sports() for entry in entries_of(sport)]
        assert {entry.source for entry in entries if entry.kind == "task"} == set(tasks.tasks())
        assert {"nine-ball", "ten-frames", "end"} <= {entry.game for entry in entries if entry.kind == "game"}

    def test_the_first_task_is_one_click_away(self, player):
        player = player("golf", (900, 560))
        player.key(pygame.K_1)
        assert START_HERE in said(player)
        front = player.view.shown.overlay
        player.click(next(rect.center for rect, what in front.places if what is front.first_sport))
        player.settle()
        assert player.view.shown.overlay is None
        assert player.game.referee.contest.name == first_task().name
        assert first_task().goal in said(player)

    def test_it_is_used_by_keys_alone(self, player):
        player = player("golf", (900, 560))
        player.game.best.add(first_task().name, 5.0, 3, lower_is_better=False)
        player.key(pygame.K_1)
        front = player.view.shown.overlay
        assert START_HERE not in said(player)  # it was played
        for key in (pygame.K_RIGHT, pygame.K_DOWN, pygame.K_UP, pygame.K_LEFT, pygame.K_RETURN):
            player.key(key)
        assert front.sport is front.all[0]
        player.key(pygame.K_ESCAPE)
        assert (player.view.shown.overlay, front.sport) == (front, None)
        player.key(pygame.K_RETURN)
        player.key(pygame.K_UP)
        player.key(pygame.K_RETURN)  # the last row: the scene itself
        player.settle()
        assert (player.game.session.title, player.game.referee.contest) == (front.all[0].name, None)

    def test_a_drag_on_a_sports_page_belongs_to_that_page(self, player):
        player = player("golf", (900, 560))
        player.game.referee.begin(AtTask(tasks.load("free-throw"), seed=SEED))
        player.settle()
        player.key(pygame.K_1)
        front = player.view.shown.overlay
        player.click(next(rect.center for rect, what in front.places if what.name == "golf"))
        assert front.sport.name == "golf"
        before = player.game.session.changes
        player.press((300, 480))  # where nothing can be chosen
        player.move((200, 500))
        player.release((200, 500))
        assert player.view.shown.overlay is front
        assert (player.game.session.changes, player.game.watching.playback) == (before, None)

    def test_a_damaged_task_says_so_in_its_row(self, tmp_path):
        (tmp_path / "tasks").mkdir()
        (tmp_path / "tasks" / "mine.toml").write_text("goal = 5\n", "utf-8")
        (tmp_path / "scene.py").write_text('"""A scene."""\n', "utf-8")
        file = tmp_path / "tasks" / "mine.toml"
        sport = sports()[0]._replace(folder=tmp_path, files=[file])
        file.with_name("added.toml").write_text(DROPPED, "utf-8")  # while the window is open: it stays as it was
        assert [entry.about for entry in entries_of(sport) if "mine.toml" in entry.about]
        assert [entry.source for entry in entries_of(sport) if entry.kind == "task"] == ["mine"]

    def test_scenes_and_tasks_of_ones_own_follow_the_others(self, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        folder = copy_of(DROP, tmp_path / "drop")
        (folder / "tasks").mkdir()
        (folder / "tasks" / "dropped.toml").write_text(DROPPED, "utf-8")
        own = sports()[-1]
        task, *_, scene = entries_of(own)
        assert (own.title, task.title, task.about, scene.source) == ("Drop", "Dropped", "Bounce once.", "./drop")
        assert tasks.load(task.source).scene.folder == folder


class TestATask:
    def test_nothing_tells_before_the_shot(self, thrower):
        verdict = thrower.game.shot.verdict
        assert verdict not in said(thrower)
        assert thrower.view.shown.until(thrower.game.shot) is not None  # not the whole path
        for name in sorted(commands.GIVE_AWAY | commands.FIXED):
            before = thrower.game.session.changes, set(thrower.view.shown.on)
            commands.do(thrower.view, name)
            assert (thrower.game.session.changes, set(thrower.view.shown.on)) == before
            assert thrower.view.shown.overlay is None
            assert thrower.game.notices[-1][0].startswith("not ")

    def test_an_old_shot_is_no_way_to_other_parameters(self, thrower):
        thrower.game.opening.open("basketball/free-throw")
        thrower.game.aiming.change({"gravity": 3.0, "launch.speed": 8.0})
        thrower.settle()
        thrower.key(pygame.K_SPACE)
        thrower.settle()
        (row,) = thrower.game.shots.rows
        thrower.game.referee.begin(AtTask(tasks.load("free-throw"), seed=SEED))
        thrower.settle()
        thrower.game.aiming.aim_as(row)
        assert thrower.game.session.changes.values == {"launch.speed": 8.0}

    def test_rules_that_fail_end_the_contest_with_a_line(self, thrower, monkeypatch):
        monkeypatch.setattr(AtTask, "record", lambda *_: 1 / 0)
        thrower.key(pygame.K_SPACE)
        passes(thrower, lambda: thrower.game.referee.contest is None)
        assert any("ZeroDivisionError" in text and bad for text, bad in thrower.game.notices)

    def test_only_its_controls_change_and_within_bounds(self, thrower):
        session = thrower.game.session
        for changes in ({"hoop.distance": 3.0}, {"gravity": 1.0}):
            assert not thrower.game.aiming.change(changes)
        assert session.changes.values == {}
        thrower.game.aiming.change({"launch.speed": 50.0, "gravity": 1.0})
        assert session.changes.values == {"launch.speed": 10.0}
        assert thrower.view.targets.visible_grips == []

    def test_a_miss_is_said_in_a_sentence_and_counts(self, thrower):
        referee = thrower.game.referee
        shoot(thrower, launch__speed=5.0)
        assert (referee.contest.good, referee.glow, referee.again) == (False, 0.0, "")
        assert referee.contest.said == referee.shots[0].verdict
        assert {referee.contest.said, "attempts left", "4"} <= said(thrower)
        thrower.click(thrower.view.screen.area.center)  # the next one
        thrower.settle()
        assert {GOAL, "attempt 2 of 5"} <= {part for text in said(thrower) for part in text.split("   ·   ")}

    def test_a_verdict_is_shown_for_a_second_when_it_is_known(self, thrower):
        game, seen = thrower.game, []

        def gone() -> bool:
            seen.append((game.watching.playback.t if game.watching.playback else 0.0, game.banner.left))
            return bool(seen[-2:-1] and seen[-2][1] and not game.banner.left)

        game.aiming.change({"launch.speed": 5.0})
        thrower.settle()
        thrower.key(pygame.K_SPACE)
        passes(thrower, lambda: game.banner.shows)
        assert 0.0 <= game.watching.playback.t - game.referee.decided < 2 * LONGEST_FRAME
        (shot,) = game.referee.shots
        assert game.banner.call == (shot.verdict, False)
        texts = said(thrower)
        assert {"Air ball", "Never as high as the ring", GOAL, "attempts left"} <= texts
        assert not {"time", "drag", "spin"} & texts  # of a laboratory
        assert game.referee.decided < shot.run.duration
        passes(thrower, gone)
        assert seen[-1][0] - game.referee.decided == pytest.approx(LASTS, abs=3 * LONGEST_FRAME)
        assert "Air ball" not in said(thrower)

    def test_a_success_glows_is_heard_and_shown_again_slowly(self, thrower):
        referee, watching, seen = thrower.game.referee, thrower.game.watching, []

        def still() -> bool:
            playback = watching.playback
            seen.append((playback.t, playback.rate, referee.glow, referee.calls) if playback else (0.0, 1.0, 0.0, []))
            return referee.again == "still"

        thrower.game.aiming.change({key.replace("__", "."): value for key, value in IN.items()})
        thrower.settle()
        thrower.key(pygame.K_SPACE)
        passes(thrower, still)
        assert referee.contest.good
        assert {rate for _, rate, *_ in seen} == {1.0, 0.25}
        first = next(t for t, _, glow, calls in seen if glow and calls == [True])
        assert first == pytest.approx(referee.decided, abs=0.05)
        floor = next(event.t for event in referee.shots[0].run.events if event.partner == "floor")
        assert referee.decided < floor  # in the ring
        assert watching.playback.t == pytest.approx(referee.decided + AFTER, abs=0.05)
        assert referee.contest.session.streak == 1
        assert referee.calls == []  # it was heard

    def test_a_miss_is_heard_and_does_not_glow(self, thrower):
        referee = thrower.game.referee
        thrower.game.aiming.change({"launch.speed": 5.0})
        thrower.settle()
        thrower.key(pygame.K_SPACE)
        passes(thrower, lambda: referee.calls == [False])
        assert (referee.glow, referee.calls) == (0.0, [])  # it was heard

    def test_stars_best_list_and_best_shots_at_the_end(self, thrower, tmp_path):
        game, referee = thrower.game, thrower.game.referee
        game.best.file = tmp_path / "data" / "best.json"
        for number in range(5):
            if number:
                thrower.key(pygame.K_RETURN)
                thrower.settle()
            shoot(thrower, **({**IN, "launch__speed": 5.0} if number == 4 else IN))
        contest = referee.contest
        assert (contest.over, contest.stars, contest.session.total) == (True, 2, 4.0)
        assert {"4 of 5 made: passed", "4 made"} <= said(thrower)
        kept = json.loads(game.best.file.read_text("utf-8"))["tasks"]["free-throw"]
        assert [(each["score"], each["stars"]) for each in kept] == [(4.0, 2)]
        assert kept[0]["flight"] == {key.replace("__", "."): value for key, value in IN.items()}
        shown = []

        def three() -> bool:
            number = game.watching.playback.shot.number
            shown.extend([number] * (referee.again == "best" and number not in shown))
            return len(shown) == 3 and game.watching.playback.over

        passes(thrower, three)
        assert referee.outcome == referee.shots[0].verdict != contest.said  # of what is shown, not of the last
        assert shown == [3, 2, 1]  # all went in; of equal ones the first is the best
        thrower.frames()
        buttons = thrower.view.targets.cards
        assert buttons.keys() >= {"again", "next_preset", "page", "front"}
        thrower.click(buttons["again"].center)
        thrower.settle()
        assert (game.record.called, game.record.scored, game.ghosts) == ("your best", True, [])  # it would tell
        game.watching.watch(game.record)
        assert game.ghosts == [game.record]
        game.watching.stop()
        assert (referee.contest is contest, referee.contest.session.left, referee.shots) == (False, 5, [])
        assert referee.contest.seed != contest.seed
        thrower.key(pygame.K_PAGEDOWN)
        assert referee.contest.name == contest.following != contest.name

    def test_the_task_of_a_day_is_the_same_for_everybody(self):
        day = date(2026, 11, 28)
        one, other = AtTaskOfDay(day), AtTaskOfDay(day).anew()
        assert (one.name, one.seed, one.scene) == (other.name, other.seed, other.scene)
        days = [AtTaskOfDay.name_of(day + timedelta(each)) for each in range(len(tasks.tasks()))]
        assert {name[11:] for name in days} == set(tasks.tasks())  # each once, and then again
        assert one.following == ""

    def test_a_decathlon_is_one_number_at_the_end(self):
        assert len(events()) == EVENTS == len({tasks.load(name).scene.name for name in events()})
        contest = Decathlon(["close-up", "short-putt"], seed=SEED)
        for number in range(6):
            run = simulate(
                contest.scene if number else contest.scene.changed({"launch.speed": 4.6, "launch.angle": 65})
            )
            contest.aimed(run.scene)
            contest.record(run)
            assert contest.event.task.name == contest.tasks[number // 3]  # what came of it can still be seen
            contest.go_on()
        assert run.scene.name == "minigolf"
        assert (contest.over, contest.points, contest.outcome[0]) == (True, [400, 0], "400 points")
        assert contest.kept[:2] == (400.0, 0)
        assert (contest.anew().total, contest.anew().place) == (0, 0)

    def test_where_a_distance_counts_it_is_said(self, thrower):
        score = tasks.load("stop-dead").score
        assert [score.shot_text(worth) for worth in (0.338, None)] == ["off by 0.34 m/s", ""]
        score = tasks.load("hold-over").score
        assert [score.shot_text(worth) for worth in (1.0, 5.0)] == ["counts 1 point", "counts 5 points"]
        contest = AtTask(tasks.load("stop-dead"), seed=SEED)
        thrower.game.referee.begin(contest)
        thrower.settle()
        shoot(thrower)
        assert any(contest.counts and text.startswith(contest.counts) for text in said(thrower))

    def test_only_shots_that_count_are_among_the_best(self, thrower):
        contest = thrower.game.referee.contest
        contest.worths = [0.0, 1.0, None, 0.0, 1.0]
        assert contest.best_shots == [1, 4]
        contest.task = tasks.load("closest-to-the-pin")
        contest.worths = [5.0, 0.0, 9.0]  # m
        assert contest.best_shots == [1, 0, 2]

    def test_a_pull_that_comes_too_early_does_not_move_the_picture(self, thrower):
        thrower.key(pygame.K_SPACE)
        passes(thrower, lambda: thrower.game.watching.playback is not None)
        thrower.settle()
        thrower.press((400, 300))
        thrower.move((300, 350))
        thrower.release((300, 350))
        assert thrower.view.stages.chosen is None
        assert thrower.game.notices[-1][0] == "Enter for the next shot, Space to pause"

    def test_a_page_has_the_attempts_so_far(self, thrower, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        thrower.key(pygame.K_F8)
        assert thrower.game.notices[-1][0] == keeping.NO_SHOTS
        shoot(thrower, launch__speed=5.0)
        thrower.key(pygame.K_F8)
        passes(thrower, lambda: ("wrote out/free-throw-1.html", False) in thrower.game.notices)
        page = (tmp_path / "out" / "free-throw-1.html").read_text("utf-8")
        assert thrower.game.referee.contest.said in page
        assert "Attempt 1" in page

    def test_escape_leads_to_the_tiles_and_a_scene_ends_it(self, thrower):
        thrower.key(pygame.K_ESCAPE)
        assert isinstance(thrower.view.shown.overlay, Front)
        thrower.key(pygame.K_ESCAPE)
        thrower.game.opening.open("golf")
        thrower.settle()
        assert (thrower.game.referee.contest, thrower.game.session.limits) == (None, None)
        thrower.key(pygame.K_F8)
        assert thrower.game.notices[-1][0] == "a page is made of a task that is played"
        assert thrower.game.aiming.change({"gravity": 5.0})

    def test_a_run_that_fails_costs_no_attempt(self, thrower, monkeypatch):
        game = thrower.game
        monkeypatch.setattr("sandbox.window.referee.unpacked", lambda *_: (_ for _ in ()).throw(RequestError("broken")))
        thrower.key(pygame.K_SPACE)
        thrower.settle()
        passes(thrower, lambda: ("broken", True) in game.notices)
        assert ("broken", True) in game.notices
        assert (game.referee.contest.session.left, game.watching.playback) == (5, None)

    def test_what_no_pull_sets_has_its_slider(self, player):
        player = player("golf", (900, 560))
        contest = AtTask(tasks.load("leap"), seed=SEED)
        player.game.referee.begin(contest)
        player.settle()
        player.frames()
        (row,) = player.view.panel.rows
        assert (row.key, row.span, player.view.shown.has_panel) == ("balls[0].mass", (0.02, 0.4), True)
        assert any("set the sliders and press Space" in text for text in said(player))
        (slider,) = [
            rect for rect, what in player.view.panel.places if isinstance(what, tuple) and what[1] == SLIDER_OF
        ]
        player.press((slider.right - 2, slider.centery))
        player.release((slider.right - 2, slider.centery))
        player.settle()
        assert player.game.session.value("balls[0].mass") == pytest.approx(0.4)
        assert not any(text == "aimed" for text in said(player))

    def test_earlier_shots_are_drawn_where_the_start_is_the_same(self, player):
        player = player("golf", (640, 480))
        contest = AtMatch(installed_folder("golf"), "nearest-the-pin", seed=1)
        player.game.referee.begin(contest)
        shoot(player)
        player.key(pygame.K_RETURN)
        player.settle()
        assert player.game.ghosts == player.game.referee.shots
        player.game.referee.shots *= 9
        assert len(player.game.ghosts) == SHOWN
        player.game.referee.begin(AtMatch(installed_folder("billiards"), "nine-ball", seed=1))
        shoot(player)
        player.key(pygame.K_RETURN)
        player.settle()
        assert player.game.ghosts == []
        assert contest.match.best[0] is not None

    def test_two_take_turns_at_the_same_starts(self, player):
        player = player("basketball", (900, 560))
        contest = AtTask(tasks.load("free-throw"), 2, seed=SEED)
        player.game.referee.begin(contest)
        starts = []
        for number in range(4):
            if number:
                player.key(pygame.K_RETURN)
            player.settle()
            assert contest.turn == number % 2
            starts.append(player.game.session.value("release.height"))
            shoot(player, launch__speed=5.0)
        assert starts[0] == starts[1] != starts[2] == starts[3]
        assert {"Player 1", "Player 2"} <= said(player)
        assert contest.said.startswith("Player 2: ")
        assert contest.outcome == ["A draw: 0 to 0"]


def test_a_task_of_ones_own_has_its_own_best_list(tmp_path):
    mine = tmp_path / "free-throw.toml"
    mine.write_text(tasks.find_task("free-throw").read_text("utf-8"), "utf-8")
    assert AtTask(tasks.load(mine)).name == str(mine)
    assert AtTask(tasks.load("free-throw")).name == "free-throw"


class TestAMatch:
    def test_a_foul_is_called_a_foul_and_which(self):
        contest = AtMatch(installed_folder("billiards"), "eight-ball")
        contest.match = replace(contest.match, balls={"cue": (0.0, 0.0), "1": (0.5, 0.3)})
        run = SimpleNamespace(result={"scratch": False, "first_contact": None, "potted": [], "positions": {}})
        assert contest.call(run) == ("Foul: no ball hit. Ball in hand", False)

    def test_the_ball_in_hand_is_dragged_and_the_rules_go_on(self, player):
        player = player("billiards/bank", (800, 500))
        player.game.referee.begin(AtMatch(installed_folder("billiards"), "eight-ball", seed=1))
        player.settle()
        game, session = player.game, player.game.session
        assert any("ball in hand" in text and "pull back elsewhere" in text for text in said(player))
        (grip,) = player.view.targets.visible_grips
        assert grip.at == pytest.approx(player.view.stages.latest.ball_at(game.shot), abs=1.0)  # no pull begins there
        x, y = (round(value) for value in grip.at)
        player.press((x, y))
        player.move((x + 400, y + 30))  # beyond the head string
        player.release((x + 400, y + 30))
        player.settle()
        assert session.value("balls[0].x") == pytest.approx(-0.635)
        assert session.value("balls[0].y") < 0.2
        assert session.value("rack") == "eight-ball"
        shoot(player, cue__speed=9.0, cue__angle=0.0)
        match = game.referee.contest.match
        assert match.said
        assert {"Player 1", "Player 2", match.scores[0]} <= said(player)
        player.key(pygame.K_RETURN)
        player.settle()
        assert session.value("rack") == ("none" if match.balls else "eight-ball")
        assert any(match.status in text for text in said(player))

    def test_a_game_that_is_not_there_is_said(self):
        with pytest.raises(RequestError, match="golf has no game chess; it has nearest-the-pin"):
            AtMatch(installed_folder("golf"), "chess")
        with pytest.raises(RequestError, match="tennis has no game chess; it has none"):
            AtMatch(installed_folder("tennis"), "chess")


class TestAgainstTheComputer:
    def test_it_takes_its_shot_by_itself_and_nobody_else_does(self, player, monkeypatch):
        monkeypatch.setattr(opponent, "_TRIED", 24)
        player = player("soccer-curl", (640, 400))
        game, referee = player.game, player.game.referee
        referee.begin(AtMatch(installed_folder("soccer-curl"), "penalty-kicks", seed=1, opponent=3))
        player.settle()
        contest = referee.contest
        assert (contest.match.players, contest.width, referee.computers_turn) == (("Player 1", "Computer"), 1.0, False)
        contest.match = replace(contest.match, turn=1)  # it begins
        for aims in (player.key, lambda key: player.press((300, 200))):
            aims(pygame.K_SPACE)
            assert "Computer to play" in said(player)
            assert game.notices[-1][0] == COMPUTER
        passes(player, lambda: len(referee.shots) == 1)
        passes(player, lambda: referee.tells and referee.again != "slow")
        assert (contest.match.turn, contest.said) == (0, "Computer scored: 0 to 1")

    def test_a_goal_is_seen_to_its_end_before_it_is_shown_again(self, player):
        player = player("soccer-curl", (480, 400))
        player.view.shown.on.add("view")  # the camera goes with the shot
        game, referee = player.game, player.game.referee
        referee.begin(AtMatch(installed_folder("soccer-curl"), "penalty-kicks", seed=1))
        player.settle()
        game.aiming.set({"launch.angle": 15.0, "launch.speed": 26.0})
        game.settle()
        player.key(pygame.K_SPACE)
        passes(player, lambda: game.watching.playback is not None)
        player.frames(2)
        assert game.watching.playback.story is not None
        passes(player, lambda: game.watching.playback.over)
        assert (referee.again, referee.pending.run.result["goal"]) == ("", True)  # the net is seen to bulge
        passes(player, lambda: referee.again == "slow")
        assert game.watching.playback.t < referee.decided

    def test_its_strength_is_its_scatter_and_its_keeper(self):
        strengths = range(1, 4)
        contests = [AtMatch(installed_folder("soccer-curl"), "penalty-kicks", opponent=each) for each in strengths]
        late = [contest.scene.parameters.keeper.dive.reaction for contest in contests]
        assert late == sorted(late, reverse=True)
        assert (
            late[1] == AtMatch(installed_folder("soccer-curl"), "penalty-kicks").scene.parameters.keeper.dive.reaction
        )
        kicks = [contests[0].aimed(contests[0].scene).parameters.keeper.dive.reaction for _ in range(20)]
        assert len(set(kicks)) == 20  # s: it is not always as fast
        assert abs(np.mean(kicks) - late[0]) < 0.05
        for contest in contests:
            contest.match = replace(contest.match, turn=1)
        assert [contest.width for contest in contests] == [6.0, 2.5, 0.7]
        assert contests[0].match.scatter == {}  # of a person's keeper, and what the computer does itself
        assert [contest.anew().match.opponent for contest in contests] == [1, 2, 3]

    def test_what_a_shot_is_worth_to_it(self):
        match = game_of(installed_folder("billiards"), "eight-ball")(balls={"cue": (0.0, 0.0), "1": (0.5, 0.0)})
        legal = {"first_contact": "1", "potted": ["1"], "scratch": False, "rails": 1, "touches": ["1"], "driven": 0}
        outcome = {**legal, "positions": {"cue": (0.2, 0.0)}}
        assert match.value(outcome) == 1.0  # its turn again
        assert match.value({**outcome, "potted": []}) == 0.0
        assert match.value({**outcome, "scratch": True}) == -1.0
        assert match.value({**outcome, "potted": ["8"]}) == -2.0  # too early: lost

    def test_it_aims_only_at_balls_of_its_own(self):
        spots = {"cue": (0.0, 0.0), "1": (0.6, 0.3), "9": (0.6, -0.3), "8": (-0.6, 0.0)}
        match = game_of(installed_folder("billiards"), "eight-ball")(balls=spots, groups=("stripes", "solids"), turn=1)
        session = Session("billiards")
        session.show(session.base.changed(match.start, "eight-ball"), "billiards", None)
        computer = opponent.Opponent(session, match, 1.0, False, Workers(Unanswered(), Unanswered(), 0.0), seed=1)
        angles = [angle for (angle,) in [*computer.asked, *computer.left]]
        assert len(angles) >= 80
        assert all(0.0 < angle < 45.0 for angle in angles)  # deg: at the 1

    def test_nearer_the_pin_is_worth_more_to_it(self):
        match = game_of(installed_folder("golf"), "nearest-the-pin")()
        dry = {"ended": "rest", "holed": False}
        ends = [{"ended": "water", "holed": False, "distance_to_pin": 1.0}, {**dry, "distance_to_pin": 9.0},
                {**dry, "distance_to_pin": 2.0}, {"ended": "cup", "holed": True, "distance_to_pin": 0.0}]  # fmt: skip
        values = [match.value(end) for end in ends]
        assert values == sorted(set(values))


class TestPredictFirst:
    def test_errors_of_marks_are_collected(self, player):
        player = player("golf", (900, 560))
        player.key(pygame.K_3)
        player.settle()
        game, contest = player.game, player.game.referee.contest
        assert {"Click where it will land"} <= said(player)
        assert player.view.shown.until(game.shot) == 0.0  # nothing of the path
        player.key(pygame.K_SPACE)
        assert (game.watching.playback, game.notices[-1][0]) == (None, "first click where it will land")
        carry, off = game.shot.run.result["carry"], []
        for far in (carry - 40.0, carry + 5.0):
            camera = player.view.viewpoint.camera
            player.click(tuple(round(px) for px in camera.pixel(far, 0.0)))
            player.settle()
            off.append(abs(contest.mark[0] - carry))
            shoot(player)
            player.frames()
            if len(off) == 1:
                assert contest.said.endswith(" m beyond your mark")
                assert not contest.good
                player.key(pygame.K_RETURN)
                player.settle()
                assert game.ghosts == []
        assert (contest.good, contest.said.endswith(" m short of your mark")) == (True, True)
        assert contest.errors == pytest.approx(off, abs=0.5)
        assert {"prediction 1", "prediction 2", "mean"} <= said(player)

    def test_from_above_it_is_where_the_ball_stops(self, player):
        player = player("curling", (900, 560))
        player.game.referee.begin(Prediction(player.game.session.scene))
        contest = player.game.referee.contest
        player.settle()
        run = player.game.shot.run
        x, y, *_ = run.state("stone", run.duration)
        contest.put((x + 3.0, y - 4.0))
        contest.record(run)
        assert contest.errors == [pytest.approx(5.0)]
        assert contest.said == "It lands 5.00 m from your mark"


@pytest.mark.parametrize("source", ["billiards/cut", "billiards/bank", "billiards/eight-ball-break"])
def test_the_first_contact_may_be_named_by_the_other_ball(player, source):
    player = player(source, (640, 480))
    player.view.shown.show_more_ahead()
    shot = player.game.shot
    met = next(event.t for event in shot.run.events if "cue" in (event.ball, event.partner) and event.kind == "impact")
    assert player.view.shown.until(shot) == met


def test_a_shot_is_decided_where_its_score_is_final(shot_of, player):
    player = player("billiards/bank", (640, 480))
    shot = player.game.shot
    caught = next(event for event in shot.run.events if event.kind == "caught")
    assert decided_at(shot) == caught.t
    assert deciding_ball(shot, caught.t) == caught.ball != shot.ball
    assert deciding_ball(shot, caught.t - 0.5) == shot.ball


def test_a_point_in_carom_is_decided_by_the_last_ball_met(player):
    shot = player("billiards/three-rail-carom", (640, 480)).game.shot
    met = [event for event in shot.run.events if {event.ball, event.partner} & {"red", "yellow"}]
    last = max(event.t for event in met if event.kind == "impact" and shot.ball in (event.ball, event.partner))
    assert decided_at(shot) == last < shot.run.events[-1].t


class TestTheBestList:
    def test_the_best_come_first_and_few_are_kept(self, tmp_path):
        best = BestList(tmp_path / "deep" / "best.json")
        places = [best.add("far", score, 1, lower_is_better=False) for score in (1.0, 3.0, 2.0, 3.0, 0.5, 0.1)]
        assert places == [1, 1, 2, 2, 5, 0]
        assert [each.score for each in BestList(best.file).of("far")] == [3.0, 3.0, 2.0, 1.0, 0.5]
        assert [best.add("near", score, 2, lower_is_better=True) for score in (1.0, 3.0, 0.2)] == [1, 2, 1]
        assert (best.stars("near"), best.stars("never"), len(best.of("far"))) == (2, 0, MOST)

    def test_two_windows_lose_nothing_of_each_other(self, tmp_path):
        one, other = BestList(tmp_path / "best.json"), BestList(tmp_path / "best.json")
        one.add("a", 1.0, 1, lower_is_better=False)
        other.add("b", 2.0, 2, lower_is_better=False)
        assert set(BestList(tmp_path / "best.json").tasks) == {"a", "b"}

    def test_two_windows_that_write_at_once_wait_for_each_other(self, tmp_path, monkeypatch):
        monkeypatch.setattr("sandbox.window.best.PATIENCE", HANG)
        one, other = BestList(tmp_path / "best.json"), BestList(tmp_path / "best.json")
        write, meanwhile = one._write, Thread(target=lambda: other.add("b", 2.0, 2, lower_is_better=False))

        def written_later():
            meanwhile.start()
            meanwhile.join(0.1)
            write()

        monkeypatch.setattr(one, "_write", written_later)
        one.add("a", 1.0, 1, lower_is_better=False)
        meanwhile.join()
        assert set(BestList(tmp_path / "best.json").tasks) == {"a", "b"}

    def test_what_cannot_be_written_is_written_with_the_next_score(self, tmp_path):
        best = BestList(tmp_path / "best.json")
        best.add("a", 1.0, 1, lower_is_better=False)
        (tmp_path / "best.json").unlink()
        (tmp_path / "best.json").mkdir()  # stands for a full disk
        best._read = lambda: None  # which can be read
        best.add("a", 2.0, 1, lower_is_better=False)
        assert "cannot be written" in best.problem
        (tmp_path / "best.json").rmdir()
        assert best.add("b", 1.0, 1, lower_is_better=False) == 1
        assert [each.score for each in BestList(best.file).of("a")] == [2.0, 1.0]

    @pytest.mark.parametrize(
        "text",
        [
            "",
            "{",
            '{"format": "sandbox best list", "version": 1, "tasks": {"a": [{"score": 1%s, "stars": 1, "day": ""}]}}'
            % (400 * "0"),
            "[1]",
            "\x00",
            '{"format": "sandbox best list", "version": 2, "tasks": {}}',
            '{"format": "sandbox best list", "version": 1, "tasks": {"a": [{"score": "x"}]}}',
            '{"format": "sandbox best list", "version": 1, "tasks": {"a": [{"score": NaN, "stars": 1, "day": ""}]}}',
        ],
    )
    def test_a_damaged_one_is_set_aside_with_a_line(self, tmp_path, text):
        file = tmp_path / "best.json"
        (tmp_path / "best.damaged-1.json").write_text("before", "utf-8")
        file.write_text(text, "utf-8")
        best = BestList(file)
        aside = tmp_path / "best.damaged-2.json"
        assert aside.read_text("utf-8") == text
        assert best.problem == f"the best list was damaged: it is kept as {aside}, and a new one begins"
        best.add("a", 1.0, 1, lower_is_better=False)
        assert BestList(file).of("a") == [Best(1.0, 1, best.of("a")[0].day)]

    def test_one_that_cannot_be_written_is_said(self, tmp_path):
        (tmp_path / "file").write_text("", "utf-8")
        best = BestList(tmp_path / "file" / "best.json")
        assert best.add("a", 1.0, 1, lower_is_better=False) == 1
        assert "best list cannot be written" in best.problem or "cannot be read" in best.problem

    def test_the_window_says_what_was_wrong(self, player, tmp_path):
        player = player("golf", (640, 480))
        player.game.best = BestList(tmp_path / "best.json")
        player.game.best.problem = "something"
        player.game.referee.ended(AtTask(first_task(), 2))
        assert ("something", True) in player.game.notices

    @pytest.mark.parametrize(
        ("known", "home"),
        [({"XDG_DATA_HOME": "/data"}, "/data"), ({"LOCALAPPDATA": "/local"}, "/local"), ({}, None)],
    )
    def test_it_is_where_programs_keep_data(self, monkeypatch, known, home):
        for name in ("XDG_DATA_HOME", "LOCALAPPDATA"):
            monkeypatch.delenv(name, raising=False)
        for name, place in known.items():
            monkeypatch.setenv(name, place)
        assert usual_file() == Path(home or Path.home() / ".local" / "share") / "sports-sandbox" / "best.json"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"source": "golf", "players": 2}, "--two: requires a task"),
        ({"source": None, "game": "nine-ball"}, "--game nine-ball: name its scene, too"),
        ({"source": "golf", "game": "chess"}, "golf has no game chess"),
        ({"source": "free-throw", "changes": {"gravity": 1.0}}, "--set: does not go with free-throw"),
        ({"source": "free-thrw"}, "free-thrw"),
    ],
)
def test_what_cannot_be_played_is_said_before_a_window_opens(arguments, said):
    with pytest.raises(RequestError, match=said):
        play(**arguments)
