"""Volleyball: in, long, net and short, and how the ball gets there."""

from __future__ import annotations

from typing import Any

import pytest

import sandbox
from sandbox.errors import RequestError


def hit(**changes: Any) -> dict[str, Any]:
    scene = sandbox.load("volleyball", {key.replace("__", "."): value for key, value in changes.items()})
    return sandbox.simulate(scene).result


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({}, "in"),
        ({"launch__spin": 0.0}, "long"),
        ({"launch__angle": 2.0}, "net"),
        ({"launch__speed": 8.0}, "short"),
        ({"net__depth": 0.3, "launch__angle": -8.0}, "net"),  # under it
        ({"gravity": 0.0, "air__density": 0.0}, "gone"),
    ],
)
def test_the_verdict_is_where_the_ball_comes_down(changes: dict[str, Any], word: str):
    result = hit(**changes)
    assert (result["verdict"], result["in"]) == (word, word == "in")


def test_without_air_it_falls_as_a_stone():
    """h = g t^2 / 2 from a level hit, and x = v t."""
    result = hit(air__density=0.0, launch__angle=0.0, launch__speed=20.0, net__height=1.2)
    fall = (2.0 * (3.1 - 0.105) / 9.81) ** 0.5
    assert result["flight_time"] == pytest.approx(fall, rel=1e-9)
    assert result["landing"] == pytest.approx(20.0 * fall, rel=1e-9)
    assert result["net_clearance"] == pytest.approx(3.1 - 0.5 * 9.81 * (9.0 / 20.0) ** 2 - 0.105 - 1.2, rel=1e-9)


def test_a_fast_ball_has_less_drag_than_half_the_speed_would_give():
    """Past the drag crisis the force falls though the speed grows."""
    from sandbox.scene import load

    drag = load("volleyball").build().balls[0].forces[1]
    slow, fast = (-drag(0.0, (0.0, 3.0), (speed, 0.0), 0.0)[0] for speed in (13.0, 19.0))
    assert fast < slow


@pytest.mark.parametrize(
    ("preset", "word"), [("float-serve", "in"), ("jump-serve", "in"), ("spike", "in"), ("set", "short")]
)
def test_presets_do_what_they_say(preset: str, word: str):
    assert sandbox.simulate(f"volleyball/{preset}").result["verdict"] == word


def test_a_ball_in_the_net_is_refused():
    with pytest.raises(RequestError, match=r"launch\.place = 9 m puts the ball on the net"):
        sandbox.simulate(sandbox.load("volleyball", {"launch.place": 9.0, "launch.height": 2.0}))
