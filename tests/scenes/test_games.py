"""Games written down move by move: whose turn it is, and how each stands after every shot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import sandbox
from sandbox import resources
from sandbox.errors import RequestError
from sandbox.scene.discovery import installed_folder
from sandbox.tasks.games import game_names, game_of
from sandbox.tasks.match import Match
from sandbox.toml import read_toml

WRITTEN = sorted((Path(__file__).parent / "games").glob("*.toml"))
GAMES = [(file.parent.parent, file.stem.replace("_", "-")) for file in resources.folder("scenes").glob("*/games/*.py")]


def written(file: Path) -> tuple[Match, Path, dict[str, Any]]:
    """A match at its start, the folder of its scene, and the whole file."""
    game = read_toml(file)
    scene, _, name = game["game"].partition("/")
    folder = installed_folder(scene)
    assert folder is not None
    rules = game_of(folder, name)
    return rules(*([tuple(game["players"])] if "players" in game else [])), folder, game


def moves_of(game: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """All moves; those before the ``last`` are repeated."""
    moves, last = game["moves"], game.get("last", 0)
    yield from moves[: len(moves) - last] * game.get("repeat", 1)
    yield from moves[len(moves) - last :]


def begun(match: Match, folder: Path, known: dict[str, sandbox.Setup] = {}) -> sandbox.Setup:  # noqa: B006
    """The setup of the next shot: what the rules ask for can be built."""
    name = "/".join(filter(None, [folder.name, match.preset]))
    key = f"{name} {match.start}"
    if key not in known:
        known[key] = sandbox.load(name, match.start).build()
    return known[key]


def full(outcome: dict[str, Any], match: Match, setup: sandbox.Setup) -> dict[str, Any]:
    """The facts of a move, with those of a legal shot for what is not written."""
    potted, first = outcome.get("potted", []), outcome.get("first_contact")
    usual = {"first_contact": None, "potted": [], "scratch": "cue" in potted, "touches": [first], "point": None}
    usual |= {"rails": 1, "driven": 4}
    usual["positions"] = {ball.name: [*ball.position] for ball in setup.balls if ball.name not in potted}
    return {key: value for key, value in {**usual, **outcome}.items() if key in match.facts}


@pytest.mark.parametrize("file", WRITTEN, ids=lambda file: file.stem)
def test_a_game_goes_as_it_is_written(file: Path):
    match, folder, game = written(file)
    for number, move in enumerate(moves_of(game), 1):
        where = f"move {number}: {move}"
        assert (match.finished, match.turn) == (False, move["by"]), where
        setup = begun(match, folder)
        match = match.after(full(move["outcome"], match, setup))
        assert list(match.scores) == move.get("scores", list(match.scores)), where
        assert match.foul == move.get("foul", ""), where
        assert match.said == move.get("said", match.said), where
        assert bool(match.free) == move.get("in_hand", bool(match.free)), where
        assert (match.placement_area is not None) == move.get("behind", match.placement_area is not None), where
        there = {spot["name"] for spot in match.start.get("balls", []) if "name" in spot}
        assert set(move.get("on_table", [])) <= there, where
        assert len(match.start.get("stones", [])) == move.get("stones", len(match.start.get("stones", [])))
    assert match.finished
    assert match.winner == game.get("winner")
    assert match.status == ("A draw" if game.get("draw") else f"{match.players[game['winner']]} wins")


@pytest.mark.parametrize(("folder", "name"), GAMES, ids=lambda value: value if isinstance(value, str) else value.name)
def test_a_game_is_written_down_and_reads_facts_of_its_scene(folder: Path, name: str):
    rules = game_of(folder, name)
    assert set(rules.facts) <= sandbox.load(folder.name).facts.keys()
    assert rules.title
    assert rules.goal
    assert f"{folder.name}/{name}" in {read_toml(file)["game"] for file in WRITTEN}
    match = rules()
    assert set(match.free) <= {"balls[0].x", "balls[0].y"}
    assert begun(match, folder)


#: What comes of the first shot as it stands before the player aims, in the games whose shots begin alike.
AS_IT_STANDS = {
    "basketball/free-throws": "Player 1 missed: 0 to 0",
    "soccer-curl/penalty-kicks": "Player 1 missed: 0 to 0",
    "golf/nearest-the-pin": "Player 1: 38 m from the pin",
    "curling/end": "Red's stone: nobody lies in the house",
    "bowling/ten-frames": "Player 1: no pin down",
    "billiards/three-cushion": "White: no point, misses a ball",
}


@pytest.mark.parametrize("game", AS_IT_STANDS)
def test_a_game_is_not_won_without_aiming(game: str):
    scene, _, name = game.partition("/")
    folder = installed_folder(scene)
    assert folder is not None
    match = game_of(folder, name)()
    run = sandbox.simulate(sandbox.load("/".join(filter(None, [scene, match.preset])), match.start))
    assert match.after(run.result).said == AS_IT_STANDS[game]


def test_a_real_break_is_a_shot_of_the_game():
    folder = installed_folder("billiards")
    assert folder is not None
    match = game_of(folder, "eight-ball")()
    run = sandbox.simulate(sandbox.load("billiards/eight-ball-break", match.start))
    after = match.after(run.result)
    assert after.said.startswith("Player 1 ")
    assert sandbox.load("billiards", after.start).build()


def test_a_module_without_rules_is_said(tmp_path: Path):
    (tmp_path / "games").mkdir()
    (tmp_path / "games" / "mine.py").write_text("GAME = 5\n", "utf-8")
    (tmp_path / "scene.py").write_text("", "utf-8")
    assert game_names(tmp_path) == ["mine"]
    with pytest.raises(RequestError, match="GAME must be a Match"):
        game_of(tmp_path, "mine")
