"""Rockets: rail, wind, fuse, and what is refused."""

from __future__ import annotations

from math import atan2, degrees

import pytest

import sandbox
from sandbox.picture.places.things import Post
from tests.scenes.play import playing

fly = playing("rocket")


def test_the_rail_guides_until_its_end():
    run = fly(launch__angle=60.0)
    left = next(event for event in run.events if event.kind == "leave")
    x, y, vx, vy, _ = run.state("rocket", left.t)
    assert (x**2 + (y - 0.2) ** 2) ** 0.5 == pytest.approx(1.0, abs=1e-6)
    assert vy / vx == pytest.approx(3.0**0.5, rel=1e-6)


def test_left_and_right_are_alike():
    right, left = fly(launch__angle=70.0), fly(launch__angle=110.0)
    assert left.result["distance"] == pytest.approx(-right.result["distance"], rel=1e-6)
    assert left.result["apex"] == pytest.approx(right.result["apex"], rel=1e-9)


def test_its_nose_turns_into_the_wind_while_the_motor_burns():
    assert fly(launch__angle=90.0, air__wind=[-4.0, 0.0]).result["distance"] > 50.0


@pytest.mark.parametrize("integrator", ["explicit-euler", "rk4"])
def test_thrust_from_rest_without_weight_is_not_stiff(integrator: str):
    fixed, controlled = (
        fly(gravity=0.0, duration=10.0, accuracy__integrator=how) for how in (integrator, "dormand-prince")
    )
    assert fixed.result["top_speed"] == pytest.approx(controlled.result["top_speed"], rel=1e-3)


def test_a_grenade_ends_itself():
    assert fly("rocket/grenade").result["flight_time"] == 4.5
    assert "away after 4.5 s" in fly("rocket/grenade").scene.verdict(fly("rocket/grenade"))


@pytest.mark.parametrize("angle", [30.0, 75.0, 90.0])
def test_the_rail_is_drawn_as_it_points(angle: float):
    run = sandbox.simulate(sandbox.load("rocket", {"launch.angle": angle, "launch.speed": 0.0}))
    (rail,) = (thing for thing in run.scene.picture(run, (320, 180)).place.things if isinstance(thing, Post))
    (left, low, _), (right, high, _) = rail.points
    assert degrees(atan2(high - low, right - left)) == pytest.approx(angle)
