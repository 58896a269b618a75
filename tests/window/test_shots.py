"""The table of shots: what it keeps, its order, its statistics, what it writes; through real events."""

from __future__ import annotations

import csv

import numpy as np
import pygame
import pytest

from sandbox.window.shots import PATHS, interval

SPEEDS = (2.5, 2.95, 2.0, 6.0)


@pytest.fixture
def table(player):
    """A table of four putts, one of which goes in."""
    player = player("golf/putt", (1000, 600))
    for speed in SPEEDS:
        player.game.aiming.change({"launch.speed": speed})
        player.settle()
        player.key(pygame.K_SPACE)
        player.key(pygame.K_RETURN)
    player.settle()
    player.key(pygame.K_q)
    player.frames(1)
    return player


def numbers(player) -> list[int]:
    return [row.number for row in player.view.shown.overlay.rows]


def place(player, what):
    return next(rect.center for rect, each in player.view.shown.overlay.places if each == what)


def test_it_is_sorted_by_a_click_or_a_key_and_says_the_mean(table):
    assert numbers(table) == [4, 3, 2, 1]
    table.click(place(table, "=launch.speed"))
    assert numbers(table) == [4, 2, 1, 3]
    table.click(place(table, "=launch.speed"))
    assert numbers(table) == [3, 1, 2, 4]
    for _ in range(3):
        table.key(pygame.K_LEFT)
    assert table.view.shown.overlay.by == table.view.shown.overlay.columns[-2]
    from .test_see import said

    table.view.shown.overlay.by = "launch.speed"
    mean, spread = np.mean(SPEEDS), np.std(SPEEDS, ddof=1)
    written = said(table)
    assert f"speed: mean {mean:.2f} m/s, standard deviation {spread:.2f} m/s" in written
    assert "1 of 4 score: 25 %, 5 to 70 % with 95 % confidence" in written


def test_the_interval_is_wilsons():
    assert interval(10, 10) == pytest.approx((0.7225, 1.0), abs=1e-4)
    assert interval(5, 20) == pytest.approx((0.1119, 0.4687), abs=1e-4)


def test_a_shot_is_pinned_deleted_and_gone_back_to(table):
    game = table.game
    table.click(place(table, game.shots.rows[1]))
    table.key(pygame.K_p)
    assert game.shots.rows[1].pinned
    table.key(pygame.K_UP)
    table.key(pygame.K_DELETE)
    assert [row.number for row in game.shots.rows] == [1, 2, 4]
    table.key(pygame.K_RETURN)
    assert table.view.shown.overlay is None
    table.settle()
    assert game.session.value("launch.speed") == SPEEDS[1]
    assert game.shot.run.result == game.shots.rows[1].result
    table.key(pygame.K_z, pygame.KMOD_CTRL)
    assert game.session.value("launch.speed") == SPEEDS[-1]


def test_a_pinned_path_stays_and_a_dropped_one_is_recomputed(table, monkeypatch):
    game, view = table.game, table.view
    table.key(pygame.K_q)
    first, second = game.shots.rows[:2]
    game.watching.pin(second)
    for _ in range(PATHS):
        game.aiming.shoot()
        game.aiming.again()
    assert first.shot is None
    assert second.shot in game.ghosts
    game.watching.pin(first)
    table.settle()
    assert first.shot.run.result == first.result
    drawn = []
    monkeypatch.setattr(view.stages.latest, "draw_ghosts", lambda sheet, ghosts: drawn.append(ghosts))
    view.draw()
    assert [shot.number for shot in drawn[-1]][:2] == [1, 2]
    game.watching.pin(first)
    assert first.shot is None


def test_it_is_written_as_csv(table, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    table.click(place(table, "csv"))
    with (tmp_path / "out" / "golf-putt-shots-1.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["shot"] for row in rows] == ["1", "2", "3", "4"]
    assert [float(row["launch.speed"]) for row in rows] == list(SPEEDS)
    assert [row["scored"] for row in rows] == ["false", "true", "false", "false"]
    assert [float(row["total"]) for row in rows] == [row.result["total"] for row in table.game.shots.rows]


def test_it_is_of_this_scene_and_scrolls(table):
    for _ in range(40):
        table.game.aiming.shoot()
        table.game.aiming.again()
    table.frames(1)
    over = table.view.shown.overlay
    assert over.seen < 44
    shown = [each for _, each in over.places if not isinstance(each, str)]
    table.move(place(table, shown[0]))
    table.send(pygame.MOUSEWHEEL, x=0, y=-1, flipped=False)
    assert place(table, shown[1])
    with pytest.raises(StopIteration):
        place(table, shown[0])
    for _ in range(45):
        table.key(pygame.K_PAGEDOWN)
    assert over.chosen is table.game.shots.rows[0]
    table.key(pygame.K_ESCAPE)
    table.game.opening.open("golf/moon")
    table.key(pygame.K_q)
    assert table.view.shown.overlay is None
    assert "no shots yet" in table.game.notices[-1][0]
