"""Tennis: in, long, net and short; what the court and the racket make of the ball."""

from __future__ import annotations

from typing import Any

import pytest

import sandbox
from sandbox.errors import RequestError


def shot(preset: str = "tennis", **changes: Any) -> dict[str, Any]:
    scene = sandbox.load(preset, {key.replace("__", "."): value for key, value in changes.items()})
    return sandbox.simulate(scene).result


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({}, "in"),
        ({"launch__angle": -3.0}, "long"),
        ({"launch__angle": -3.0, "shot": "rally"}, "in"),
        ({"launch__angle": -8.0}, "net"),
        ({"launch__speed": 10.0}, "short"),
        ({"gravity": 0.0, "air__density": 0.0, "launch__angle": 5.0}, "gone"),
    ],
)
def test_the_verdict_is_where_the_ball_comes_down(changes: dict[str, Any], word: str):
    result = shot(**changes)
    assert (result["verdict"], result["in"]) == (word, word == "in")


@pytest.mark.parametrize(
    "preset",
    ["kick-serve", "topspin-forehand", "slice", "lob", "clay", "grass", "table-tennis", "table-tennis-smash"],
)
def test_every_stroke_of_a_preset_is_in(preset: str):
    assert shot(f"tennis/{preset}")["in"]


def test_grass_is_faster_and_lower_than_clay():
    clay, grass = shot("tennis/clay"), shot("tennis/grass")
    assert grass["baseline_speed"] > clay["baseline_speed"] + 2.0
    assert grass["bounce_angle"] < clay["bounce_angle"] - 3.0


def test_a_ball_that_grips_springs_back_along_the_court():
    """v' = v (1 - (1 + t) a / (1 + a)), with a = 0.55 and t = 0.1."""
    steep = {"launch__angle": -60.0, "launch__spin": 0.0, "launch__speed": 20.0, "release__place": 5.0}
    kept = shot(**steep, air__density=0.0, gravity=1e-3)["speed_kept"]
    assert kept == pytest.approx(1.0 - 1.1 * 0.55 / 1.55, abs=1e-4)


def test_a_table_ends_where_it_ends():
    result = shot("tennis/table-tennis", launch__angle=14.0)
    assert result["verdict"] == "long"
    assert result["landing"] > 2.74


def test_a_face_that_moves_away_is_refused():
    with pytest.raises(RequestError, match=r"racket\.face = 80 deg: the face moves away"):
        shot(start="racket", racket__face=80.0, racket__ball_speed=0.0, racket__angle=-60.0)
