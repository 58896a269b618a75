"""What becomes of a shot, in a word and in a sentence; and what makes no sense is refused."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest

import sandbox
from sandbox.errors import RequestError
from sandbox.scene import listings
from sandbox.scene.scene_run import SceneRun
from tests.scenes.play import run_of
from tests.test_golden_runs import RUNS

#: Without wall and keeper.
ALONE = {"wall.present": False, "keeper.present": False}
#: What is said of presets without a golden record, in a word of their result where they have one.
PRESETS = {
    "basketball/free-throw": ("swish", "In, nothing but net"),
    "basketball/three-pointer": ("swish", "In, nothing but net"),
    "basketball/hook": ("swish", "In, nothing but net"),
    "basketball/rattle": ("rim", "In, off the rim"),
    "soccer/dipping-free-kick": ("goal", "Goal, 1.6 m under the bar"),
    "soccer-curl/beckham-2001": ("goal", "Goal, bent 3.0 m to the left"),
    "hockey/bank-pass": ("received", "Received at 9.1 m/s, off the boards"),
    "hockey/off-the-post": ("post", "Off the post"),
    "tennis/kick-serve": ("in", "In, 0.25 m before the service line"),
    "tennis/slice": ("in", "In, 6.5 m before the baseline"),
    "tennis/lob": ("in", "In, 0.65 m before the baseline"),
    "tennis/clay": ("in", "In, 0.52 m before the service line"),
    "tennis/pace-test": ("in", "In, 11 m before the baseline; court pace 36, medium"),
    "tennis/grass": ("in", "In, 0.52 m before the service line"),
    "tennis/table-tennis-smash": ("in", "In, 0.33 m before the end of the table"),
    "volleyball/float-serve": ("in", "In, 0.83 m before the end line"),
    "volleyball/jump-serve": ("in", "In, 1.3 m before the end line"),
    "volleyball/spike": ("in", "In, 2.0 m before the end line"),
    "volleyball/set": ("short", "Comes down on its own side, 1.1 m from the net"),
    "bowling/ten-pin-spare": ("", "Spare"),
    "bowling/split": ("", "Spare"),
    "bowling/house-pattern": ("", "Strike"),
    "bowling/gutter-ball": ("", "Gutter ball"),
    "minigolf/bank-shot": ("", "Hole in one, off 2 boards"),
    "minigolf/over-and-back": ("", "Hole in one, off 1 board"),
    "minigolf/rough": ("", "Hole in one"),
    "minigolf/tap-in": ("", "Hole in one"),
    "pinball/no-hands": ("", "1,640 points, lost after 7 s"),
    "pinball/soft-plunge": ("", "840 points, lost after 11 s"),
    "curling/guard": ("", "Lies 3.6 m from the tee; red lies 1"),
    "curling/take-out": ("", "Takes out 1 and stays; red lies 1"),
    "curling/swept-draw": ("", "Lies 0.40 m from the tee; red lies 1"),
    "curling/raise": ("", "Lies 1.9 m from the tee; red lies 2"),
    "baseball/bat": ("", "Off the fence, 0.22 m below its top"),
    "baseball/denver": ("", "Home run, 136 m"),
    "soccer-curl/mencke-2020": ("goal", "Goal, bent 3.6 m to the right"),
    "soccer-curl/dive": ("saved", "Saved by the keeper"),
    "baseball-pitch/changeup": ("", "Strike, 0.61 m over the plate"),
    "baseball-pitch/curve": ("", "Strike, 0.68 m over the plate"),
    "baseball-pitch/sinker": ("", "Strike, 0.65 m over the plate"),
    "baseball-pitch/slider": ("", "Strike, 0.61 m over the plate"),
    "billiards/newtons-cradle": ("", "Nothing potted, the 5 rolls 2.1 m"),
    "football": ("", "Good, from 45 yd, 7.0 m over the bar"),
    "football/into-the-wind": ("", "Good, from 50 yd, 2.0 m over the bar"),
}
#: Presets whose word and sentence are in their golden record and on its poster.
RECORDED = [name for name, until in RUNS.items() if until is None]
#: Of a scene with changes, at its own accuracy.
OTHERS: list[tuple[str, dict[str, Any], str, str]] = [
    ("soccer", {"launch.spin": 0}, "over", "Over the bar by 1.2 m"),
    ("soccer", {"launch.angle": 12}, "wall", "Into the wall"),
    ("soccer", {"launch.angle": 22, "launch.speed": 29.6}, "bar", "Off the bar"),
    ("soccer", {"launch.speed": 6, "wall.present": False}, "short", "Short, 9.8 m from the goal"),
    ("soccer", {"launch.speed": 0}, "short", "Short, 21 m from the goal"),
    ("soccer", {"launch.speed": 0, "air.wind": [-30, 0], "wall.present": False}, "short", "Ends 30 m behind the kick"),
    ("soccer", {"goal.present": False}, "past", "30 m up the field"),
    ("soccer", {"wall.present": False, "launch.angle": 5}, "goal", "Goal, 2.2 m under the bar"),
    ("soccer/dipping-free-kick", {"launch.spin": 0}, "over", "Over the bar by"),
    ("soccer-curl", {"wall.offset": -1.4}, "wall", "Into the wall"),
    ("soccer-curl", {"keeper.offset": -1.4}, "saved", "Saved by the keeper"),
    ("soccer-curl", {"keeper.offset": 2.0, "keeper.speed": -3.7}, "saved", "Saved by the keeper"),
    ("soccer-curl", {"keeper.offset": 2.0, "keeper.speed": -2.0}, "goal", "Goal, bent 3.5 m to the left"),
    ("soccer-curl", {"launch.angle": -18.8}, "post", "Off the post"),
    ("soccer-curl", {"launch.angle": -25.0}, "wide", "Wide by "),
    ("soccer-curl", {"launch.speed": 0.0}, "short", "Short of the goal line"),
    ("soccer-curl", {"launch.angle": 180.0}, "short", "Short of the goal line"),
    ("hockey", {"players": [{"role": "goalie", "x": 26.2, "y": -0.8}]}, "saved", "Saved by the goalie"),
    ("hockey", {"players": [{"role": "defender", "x": 16.0, "y": -3.2}]}, "defender", "Stopped by the defender"),
    ("hockey", {"launch.angle": 20.0, "players": []}, "wide", "Wide of the goal"),
    ("hockey", {"launch.speed": 3.0, "players": []}, "short", "Stops 15 m before the goal line"),
    ("hockey", {"players": [], "launch.x": 29.0, "launch.aside": 7.0}, "wide", "Wide of the goal"),  # in a corner
    ("tennis", {"launch.angle": -3.0}, "long", "Fault: out, 2.7 m beyond the service line"),
    ("tennis", {"launch.angle": -3.0, "shot": "rally"}, "in", "In, "),
    ("tennis", {"launch.angle": -8.0}, "net", "Fault: into the net"),
    ("tennis", {"launch.speed": 10.0}, "short", "Fault: comes down on its own side"),
    ("tennis", {"gravity": 0.0, "air.density": 0.0, "launch.angle": 5.0}, "gone", "Fault: did not come down"),
    ("tennis/table-tennis", {"launch.angle": 14.0}, "long", "Out, "),
    ("volleyball", {"launch.spin": 0.0}, "long", "Out, "),
    ("volleyball", {"launch.angle": 2.0}, "net", "Into the net"),
    ("volleyball", {"launch.speed": 8.0}, "short", "Comes down on its own side"),
    ("volleyball", {"net.depth": 0.3, "launch.angle": -8.0}, "net", "Into the net"),  # under it
    ("volleyball", {"gravity": 0.0, "air.density": 0.0}, "gone", "Did not come down"),
    ("football", {"launch.speed": 22.0}, "", "No good: short"),
    ("football", {"launch.speed": 25.0}, "", "No good: under the bar"),
    ("baseball", {"fence.height": 15.0}, "", "Off the fence, "),
    ("baseball", {"launch.speed": 30.0}, "", "short of the fence"),
    ("baseball-pitch", {"launch.angle": 1.0}, "", "too high"),
    ("baseball-pitch", {"launch.angle": -4.5}, "", "too low"),
    ("baseball-pitch", {"launch.angle": -30.0}, "", "in the dirt"),
    ("billiards/bank", {"cue.angle": 3.0}, "", "Scratch in the left head corner pocket"),
    ("billiards/bank", {"cue.angle": 90.0}, "", "Hits no ball"),
    ("billiards/bank", {"cue.speed": 0.5}, "", "Nothing potted, the 1 rolls 0.14 m"),
]
#: The result that says whether a shot scored, and the words, or how a sentence begins, with which it does.
SCORES = {
    "basketball": ("made", ("swish", "bank", "rim")),
    "soccer": ("goal", ("goal",)),
    "soccer-curl": ("goal", ("goal",)),
    "hockey": ("goal", ("goal",)),
    "tennis": ("in", ("in",)),
    "volleyball": ("in", ("in",)),
    "bowling": ("strike", ("Strike",)),
    "baseball": ("home_run", ("Home run",)),
    "baseball-pitch": ("strike", ("Strike",)),
}


def check(run: SceneRun, word: str, said: str) -> None:
    assert run.result.get("verdict", "") == word
    assert said in run.scene.verdict(run)
    if run.scene.name in SCORES:
        key, good = SCORES[run.scene.name]
        assert run.result[key] is (word or run.scene.verdict(run)).startswith(good)


@pytest.mark.parametrize("source", PRESETS)
def test_presets_are_what_they_say(source: str):
    check(run_of(source), *PRESETS[source])


@pytest.mark.parametrize("source", [*PRESETS, *RECORDED])
def test_presets_are_the_same_at_every_accuracy(source: str):
    run = run_of(source)
    for level in ("fast", "precise"):
        check(run_of(source, {"accuracy.level": level}), run.result.get("verdict", ""), run.scene.verdict(run))


@pytest.mark.parametrize(("source", "changes", "word", "said"), OTHERS)
def test_what_becomes_of_other_shots(source: str, changes: dict[str, Any], word: str, said: str):
    check(run_of(source, changes), word, said)


def test_every_preset_of_a_sport_that_scores_is_here():
    wanted = {listing.name for listing in listings() if listing.name.partition("/")[0] in SCORES}
    assert wanted - {"baseball/de-la-cruz-2024"} <= {*PRESETS, *RECORDED}


DRIVERS = "than TrackMan measures with tour players' drivers"


@pytest.mark.parametrize(
    ("source", "changes", "said"),
    [
        ("basketball/rattle", {}, {"ball speed": "7.59 m/s", "launch": "52.7°", "spin": "250 rpm backspin"}),
        ("basketball/rattle", {}, {"touches": "rim back, rim front, backboard, rim front, rim back, rim front"}),
        ("soccer", {}, {"ball speed": "27.0 m/s", "spin": "300 rpm topspin", "over the wall": "0.28 m"}),
        ("soccer", {"wall.present": False}, {"height at wall": None, "over the wall": None}),
        ("soccer-curl/roberto-carlos-1997", {}, {"launch": "17.0° right", "spin": "840 rpm left"}),
        ("golf/topped", {}, {"spin": "3000 rpm topspin", "landing spin": "2947 rpm topspin"}),
        ("golf/club-head", {"club.loft": 0.0, "club.attack": 0.0}, {"smash factor": "1.5"}),
        ("golf/club-head", {"club.restitution": 0.83}, {"compared": f"2 % slower {DRIVERS}"}),
        ("golf/club-head", {"club.restitution": 0.9}, {"compared": f"2 % faster {DRIVERS}"}),
        ("golf/club-head", {"club.restitution": 0.87}, {"compared": None}),
        ("golf/club-head", {"club.depth": 0.0}, {"compared": None}),  # an iron
        ("golf", {}, {"compared": None}),
    ],
)
def test_the_card_speaks_to_players(source: str, changes: dict[str, Any], said: dict[str, str | None]):
    run = sandbox.simulate(sandbox.load(source, changes))
    card = dict(run.scene.rows(run))
    assert {label: card.get(label) for label in said} == said


@pytest.mark.parametrize(
    ("source", "changes", "key", "values", "grows", "least"),
    [
        ("soccer", {"wall.present": False}, "launch.spin", [-300, -150, 0, 300], "height_at_goal", 0.1),
        ("soccer/goal-kick-in-a-gale", {}, "air.wind", [[-10, 0], [-5, 0], [0, 0], [5, 0], [10, 0]], "carry", 2.0),
        ("soccer-curl", ALONE, "launch.spin", [-600, -300, 0, 300, 600], "deviation", 0.5),
        ("soccer-curl", ALONE, "air.density", [0.9, 1.2], "deviation", 0.1),
        ("rocket", {}, "ball.mass", [0.15, 0.1], "top_speed", 1.0),
        ("bullet", {}, "air.wind", [[-10, 0], [0, 0]], "speed", 1.0),
        ("bullet", {}, "air.elevation", [0, 2000], "speed", 1.0),
        ("golf", {}, "ground.fairway.give", [1.5, 1.0, 0.3], "total", 5.0),
        ("golf/topped", {}, "launch.spin", [-3000, 0], "carry", 5.0),
        ("golf/blow-up", {}, "launch.spin", [2545, 8000], "apex", 10.0),
        ("golf/blow-up", {}, "launch.spin", [8000, 2545], "carry", 5.0),
        ("baseball", {}, "air.elevation", [0, 1600], "distance", 7.0),
        ("baseball", {"air.density": 1.0}, "air.elevation", [0, 3000], "distance", 0.0),  # not by the weather
        ("throws", {}, "record", [23.0, 21.0], "record_beaten", 1),
        ("tennis", {}, "court.friction", [0.8, 0.5], "bounce_speed", 0.5),
        ("football", {}, "launch.speed", [22.0, 28.0], "good", 1),
    ],
)
def test_more_of_one_is_more_of_another(
    source: str, changes: dict[str, Any], key: str, values: list[Any], grows: str, least: float
):
    """From value to value, by ``least`` or more; 0 for not at all."""
    found = [sandbox.simulate(sandbox.load(source, {**changes, key: value})).result[grows] for value in values]
    steps = [after - before for before, after in pairwise(found)]
    assert min(steps) >= least if least else steps == pytest.approx([0.0] * len(steps))


@pytest.mark.parametrize(
    ("source", "changes", "names"),
    [
        ("basketball", {}, "Gravity Drag NetDrag"),
        ("basketball", {"ball.lift.model": "none", "net.slows": False}, "Gravity Drag"),
        ("soccer", {"ball.lift.model": "none", "ball.drag.model": "none"}, "Gravity"),
        ("soccer", {"air.density": 0, "gravity": 0}, ""),
    ],
)
def test_an_effect_left_out_is_an_absent_term(source: str, changes: dict[str, Any], names: str):
    forces = sandbox.load(source, changes).build().balls[0].forces
    assert " ".join(type(force).__name__ for force in forces) == names


@pytest.mark.parametrize(
    ("source", "changes", "named"),
    [
        (
            "basketball",
            {"release.height": 3.2, "hoop.distance": 0, "backboard.gap": 0.05, "hoop.inner_diameter": 0.1},
            ["release.height = 3.2 m", "backboard.bottom = 2.9 m"],
        ),
        (
            "basketball",
            {"release.height": 3.05, "hoop.distance": 0.2},
            ["release.height = 3.05 m", "hoop.height = 3.05 m"],
        ),
        ("basketball", {"backboard.gap": 0.01}, ["backboard.gap = 0.01 m", "hoop.tube_radius = 0.009 m"]),
        ("basketball", {"backboard.top": 2.5}, ["backboard.top = 2.5 m", "backboard.bottom = 2.9 m"]),
        (
            "basketball",
            {"hoop.height": 0.1, "hoop.tube_radius": 0.2, "backboard.gap": 1},
            ["hoop.height = 0.1 m", "hoop.tube_radius"],
        ),
        ("soccer", {"wall.distance": 30}, ["wall.distance = 30 m", "goal.distance = 22 m"]),
        ("soccer", {"wall.distance": 21.9}, ["wall.distance = 21.9 m", "goal.distance = 22 m"]),
        ("soccer", {"wall.distance": 0.2}, ["wall.distance = 0.2 m", "ball.radius = 0.11 m"]),
        ("soccer", {"goal.distance": 0.1, "wall.present": False}, ["goal.distance = 0.1 m", "ball.radius = 0.11 m"]),
        ("soccer-curl", {"wall.distance": 30}, ["wall.distance = 30 m", "goal.distance = 22 m"]),
        ("soccer-curl", {"wall.distance": 0.2}, ["wall.distance = 0.2 m", "ball.radius = 0.11 m"]),
        ("soccer-curl", {"goal.distance": 0.1}, ["goal.distance = 0.1 m", "ball.radius = 0.11 m"]),
        ("soccer-curl", {"keeper.distance": 12.8}, ["keeper.distance = 12.8 m", "wall.distance = 9.15 m"]),
        (
            "soccer-curl",
            {"goal.distance": 15, "keeper.distance": 14.8, "keeper.offset": 0},
            ["keeper.distance = 14.8 m", "ball.radius = 0.11 m"],
        ),
        (
            "soccer-curl",
            {"keeper.distance": 0.2, "keeper.offset": 3.5},
            ["keeper.offset = 3.5 m", "goal.width = 7.32 m"],
        ),
        ("golf", {"pin.distance": 0.01}, ["pin.distance: the cup at 0.01 m is where the ball starts"]),
        ("golf", {"ground.heights": [[10, 0], [10, 5]]}, ["ground.heights: x must grow"]),
        (
            "golf",
            {"ground.strips": [{"kind": "rough", "start": 9, "end": 3}]},
            ["the rough from 9 m to 3 m has no length"],
        ),
        (
            "golf",
            {
                "ground.strips": [
                    {"kind": "bunker", "start": 230, "end": 242},
                    {"kind": "water", "start": 235, "end": 250},
                    {"kind": "rough", "start": 200, "end": 236},
                ]
            },
            ["ground.strips: the bunker from 230 m to 242 m lies under later ones"],
        ),
        ("golf", {"start": "club", "club.loft": 80, "club.attack": -45}, ["the face moves away from the ball"]),
        (
            "tennis",
            {"start": "racket", "racket.face": 80.0, "racket.ball_speed": 0.0, "racket.angle": -60.0},
            ["racket.face = 80 deg: the face moves away"],
        ),
        ("volleyball", {"launch.place": 9.0, "launch.height": 2.0}, ["launch.place = 9 m puts the ball on the net"]),
        ("bullet", {"launch.speed": 20.0, "zero.distance": 2000.0}, ["zero.distance = 2000 m: the bullet does not"]),
        ("rocket", {"motor.curve": [[0.0, 5.0]]}, ["motor.curve: needs two points"]),
        ("rocket", {"motor.curve": [[0.0, 5.0], [0.0, 5.0]]}, ["each later than the last"]),
        ("rocket", {"motor.curve": [[0.0, 0.0], [1.0, 0.0]]}, ["and some thrust"]),
        ("rocket", {"motor.curve": []}, ["needs two points"]),
        ("rocket", {"motor.propellant": 0.2}, ["must be less than ball.mass"]),
        ("rocket", {"ball.radius": 0.5}, ["launch.height = 0.2 m", "the rocket and the ground overlap"]),
        ("bowling", {"pin.standing": "1 11"}, ["pin.standing: there is no pin 11"]),
        ("bowling", {"launch.aside": 0.6}, ["launch.aside = 0.6 m: must be between -0.527 and 0.527 m"]),
        ("collisions/tumbling-box", {"contact.model": "hertz"}, ['contact.model = "hertz"', "boxes"]),
        ("minigolf", {"walls": [{"x1": 1.0, "y1": 0.0, "x2": 1.0, "y2": 0.0}]}, ["walls[0]", "(1, 0) m", "a length"]),
        ("curling", {"launch.aside": 2.3}, ["launch.aside = 2.3 m: must be between -2.23 and 2.23 m"]),
        ("curling", {"stones": [{"x": 0.0, "y": 2.3}]}, ["stones[0].y = 2.3"]),
        ("curling", {"stones": [{"x": 1.99, "y": 0.0}]}, ["stones[0].x = 1.99"]),
        (
            "curling",
            {"stones": [{"x": 0.0, "y": 0.0}, {"x": 0.2, "y": 0.0, "team": "red"}]},
            ["overlaps", "at the start"],
        ),
        (
            "hockey",
            {"players": [], "launch.x": 30.45, "launch.aside": 0.0},
            ["puck at (30.45, 0) m is outside the boards"],
        ),
        ("hockey", {"players": [], "launch.x": 0.0, "launch.aside": -12.95}, ["outside the boards"]),
        ("hockey", {"players": [], "launch.x": 29.0, "launch.aside": 11.5}, ["outside the boards"]),  # in a corner
    ],
)
def test_what_makes_no_sense_is_refused_in_a_line_that_names_it(source: str, changes: dict[str, Any], named: list[str]):
    with pytest.raises(RequestError) as refused:
        sandbox.simulate(sandbox.load(source, changes))
    assert all(part in str(refused.value) for part in named)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("scene", "key"),
    [
        ("basketball", "release.height"),
        ("football", "launch.height"),
        ("volleyball", "launch.height"),
        ("throws", "release.height"),
        ("baseball", "release.height"),
        ("tennis", "release.height"),
    ],
)
def test_a_launch_from_height_0_begins_on_the_ground(scene: str, key: str):
    """As the first lesson on a parabola does."""
    run = sandbox.simulate(sandbox.load(scene, {key: 0.0}))
    assert 0.0 <= run.state("ball", 0.0)[1] <= 0.15


def test_a_launch_is_told_as_it_was_given():
    """Though its velocity is a sine and a cosine of it."""
    values = {"launch.angle": -28.8, "launch.speed": 28.7, "launch.spin": 2801.1}
    result = sandbox.simulate(sandbox.load("golf", values | {"ball.radius": 0.02})).result
    assert (result["launch_angle"], result["ball_speed"], result["launch_spin"]) == (-28.8, 28.7, 2801.1)
