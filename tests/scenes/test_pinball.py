"""Pinball: flippers follow their buttons from wherever they are, hits score, and no game ends with an error."""

from __future__ import annotations

from math import pi

import pytest

import sandbox
from sandbox.engine.ledger import ledger
from sandbox.errors import RequestError
from sandbox.scene.world import World
from tests.scenes.play import playing, results_of

game, result_of = playing("pinball"), results_of("pinball")
STILL = {"flippers__left": [], "flippers__right": []}


def angles(held: list[list[float]], *times: float, side: str = "left") -> list[float]:
    """How far in deg a flipper is turned at these times, if its button is held so."""
    scene = sandbox.load("pinball", {"flippers.left": [], "flippers.right": [], f"flippers.{side}": held})
    flipper = next(each for each in scene.build().surfaces if each.name == f"{side} flipper")
    assert flipper.motion is not None
    return [flipper.motion.place(t).angle * 180.0 / pi for t in times]


def test_a_stroke_takes_its_time_and_stays_while_held():
    """54 deg in 50 ms, held, and back in 80 ms."""
    times = 0.99, 1.0, 1.025, 1.05, 1.5, 1.54, 1.58, 9.0
    assert angles([[1.0, 1.5]], *times) == pytest.approx([-28, -28, -1, 26, 26, -1, -28, -28])
    assert angles([[1.0, 1.5]], *times, side="right") == pytest.approx([28, 28, 1, -26, -26, 1, 28, 28])


def test_a_flipper_turns_round_in_the_middle_of_a_stroke():
    """Let go after 25 ms, and pressed again 20 ms later: it goes on from where it is."""
    held = [[1.0, 1.025], [1.045, 2.0]]
    assert angles(held, 1.025, 1.035, 1.045, 1.055, 1.3) == pytest.approx([-1, -7.75, -14.5, -3.7, 26])


def test_times_that_do_not_follow_are_refused():
    with pytest.raises(RequestError, match=r"flippers\.left = \[\[2\.0, 1\.0\]\] s: each time must be after"):
        game(flippers__left=[[2.0, 1.0]])


def test_a_flipper_that_is_raised_in_time_strikes_the_ball():
    """A ball that comes down on a flipper at rest, and up the table from one on its way up."""
    rolls = game(**STILL, launch__speed=2.7)
    touched = next(event.t for event in rolls.events if event.partner.endswith("flipper"))
    side = next(event.partner.split()[0] for event in rolls.events if event.partner.endswith("flipper"))
    assert rolls.result["flips"] == 0
    struck = game(**{**STILL, f"flippers__{side}": [[touched - 0.02, touched + 0.2]]}, launch__speed=2.7)
    assert struck.result["flips"] > 0
    assert struck.state("ball", touched + 0.05).vy > rolls.state("ball", touched + 0.05).vy + 0.5
    assert ledger(struck).work[f"driven by {side} flipper"] > 0.0


def test_points_are_those_of_all_hits():
    points = {"points__bumper": 1, "points__sling": 100, "points__target": 10000}
    result = result_of(**STILL, **points)
    assert result["score"] == result["bumpers"] + 100 * result["slings"] + 10000 * result["targets"]
    assert result["score"] > 10000


def test_what_comes_down_the_lane_is_sent_back():
    """Too soft to leave the lane, it falls back on the spring, which sends it into play."""
    result = result_of(**STILL, launch__speed=0.6)
    assert result["lost"]
    assert result_of(**STILL, launch__speed=0.6, kicks__plunger=0.0)["ended"] == "rest"


def test_a_game_that_was_played_live_is_a_game_of_its_times():
    """Pressed at once in a world and given beforehand, to the same last bit for as long as both know of the keys."""
    world = World(sandbox.load("pinball", {"flippers.left": [], "flippers.right": []}))
    world.step(1.0)
    world.apply({"flippers.left": [[1.0, 600.0]]})
    world.step(0.25)
    world.apply({"flippers.left": [[1.0, 1.25]]})
    world.step(0.25)
    given = game(**{**STILL, "flippers__left": [[1.0, 1.25]]})
    assert world.state["ball"] == pytest.approx(given.state("ball", 1.5), abs=1e-9)
    assert world.run().result["score"] == sum(
        {"bumper": 100, "sling": 10, "target": 500}.get(event.partner, 0) for event in given.events if event.t <= 1.5
    )
