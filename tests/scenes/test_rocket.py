"""Rockets: rail, wind, fuse, and what is refused."""

from __future__ import annotations

from math import atan2, degrees, radians, sin

import pytest

import sandbox
from sandbox.picture.places.things import Post
from tests.scenes.play import playing

fly = playing("rocket")


def test_the_rail_guides_until_its_end():
    run = fly(launch__angle=60.0)
    left = next(event for event in run.events if (event.kind, event.partner) == ("leave", "rail"))
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


LATE = [(8.0, 0.0), (8.3, 10.0), (10.1, 10.0), (10.2, 0.0)]


@pytest.mark.parametrize("angle", [60.0, 88.0, 90.0])
def test_it_stands_until_thrust_exceeds_its_weight(angle: float):
    """F(t) = m g sin(angle) on the first piece of a curve that begins after 8 s."""
    run = fly(launch__angle=angle, motor__curve=LATE)
    rocket = run.scene.parameters.ball
    lifts = 8.0 + 0.3 * rocket.mass * 9.81 * sin(radians(angle)) / 10.0
    assert run.state("rocket", lifts - 1e-3)[:4] == pytest.approx((0.0, 0.2, 0.0, 0.0), abs=1e-9)
    x, y = run.state("rocket", lifts + 0.02)[:2]
    assert y > 0.2001
    assert run.result["apex"] > 250.0


def test_a_slow_motor_does_not_let_it_sink():
    run = fly(motor__curve=[(0.0, 0.0), (0.2, 0.0), (0.3, 10.0), (2.1, 10.0), (2.2, 0.0)])
    assert min(run.state("rocket", 0.01 * i).y for i in range(60)) >= 0.2 - 1e-9
    assert run.result["apex"] == pytest.approx(410.0, abs=1.0)


def test_a_motor_that_never_lifts_it_says_so():
    run = fly(motor__curve=[(0.0, 0.0), (0.3, 1.0), (2.0, 1.0), (2.2, 0.0)])
    assert run.scene.verdict(run) == "its motor never lifts it: 1 N at most, and it weighs 1.21 N"
    assert (run.ended, run.result["apex"]) == ("rest", 0.2)


@pytest.mark.parametrize("angle", [30.0, 75.0, 90.0])
def test_the_rail_is_drawn_as_it_points(angle: float):
    run = sandbox.simulate(sandbox.load("rocket", {"launch.angle": angle, "launch.speed": 0.0}))
    (rail,) = (thing for thing in run.scene.picture(run, (320, 180)).place.things if isinstance(thing, Post))
    (left, low, _), (right, high, _) = rail.points
    assert degrees(atan2(high - low, right - left)) == pytest.approx(angle)
