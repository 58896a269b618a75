"""Bullets: drag by Mach number, the zero of the sights, and the table of the flight."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import sandbox
from tests.scenes.play import results_of

fire = results_of("bullet")


@pytest.mark.parametrize("distance", [50.0, 91.44, 400.0])
def test_the_bullet_meets_the_line_of_sight_at_the_zero(distance: float):
    result = fire(zero__distance=distance, range__distance=distance)
    assert result["height"] == pytest.approx(0.0, abs=1e-6)


def test_the_table_has_a_row_every_hundred_yards():
    table = fire()["table"]
    assert [row["range"] for row in table] == pytest.approx([91.44 * i for i in range(11)])
    assert table[0]["height"] == pytest.approx(-0.0508)
    assert all(before["speed"] > after["speed"] for before, after in pairwise(table))
    assert fire(range__distance=300.0)["table"][3] == pytest.approx(table[3], rel=1e-6)


def test_at_mach_5_the_target_is_hit_on_its_face():
    """Without air x = v t."""
    result = fire(launch__speed=1700.0, air__density=0.0, range__distance=3000.0, zero__distance=0.0)
    assert result["flight_time"] == pytest.approx(3000.0 / 1700.0, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "10.2 m low at 914.4 m: hold 38.3 arcmin over"),
        ({"bullet__drag__model": "G1", "bullet__coefficient": 0.462}, "9.72 m low at 914.4 m"),
        ({"range__distance": 91.44}, "On the line of sight at 91.4 m"),
        ({"range__distance": 91.44, "zero__distance": 300.0}, "high at 91.4 m: hold"),
        ({"launch__speed": 20.0, "zero__distance": 0.0, "launch__angle": 80.0}, "Does not reach 914.4 m"),
    ],
)
def test_the_verdict_says_how_to_hold(changes: dict[str, Any], said: str):
    run = sandbox.simulate(sandbox.load("bullet", {key.replace("__", "."): value for key, value in changes.items()}))
    assert said in run.scene.verdict(run)
    if run.result["hold"] is not None:
        far, off = run.scene.parameters.range.distance, run.result["height"]
        assert run.result["hold"] == pytest.approx(-off / far * 180.0 * 60.0 / np.pi, rel=1e-3, abs=1e-6)


@pytest.mark.parametrize("distance", [30.0, 914.4, 2000.0])
def test_the_poster_draws_heights_as_large_as_there_is_room(distance: float):
    run = sandbox.simulate(sandbox.load("bullet", {"range.distance": distance, "launch.speed": 1700.0}))
    picture = run.scene.picture(run)
    picture.poster()
    rows = picture.camera.pixels(picture.points)[:, 1]
    assert np.ptp([*rows, picture.camera.pixel(0.0, 0.0)[1]]) > 0.3 * (picture.area.bottom - picture.area.top)
    assert f"heights drawn {picture.camera.stretch:g} times" in picture.notes(picture.camera)[0]
    assert "sight line" in [text for text, _ in picture.sheet.written]


@pytest.mark.parametrize("name", ["bullet", "bullet-water"])
def test_no_card_says_that_a_ball_is_fired(name: str):
    assert "ball" not in " ".join(fact.label for fact in sandbox.load(name).facts.values())


def test_the_default_is_the_bullet_of_the_number():
    """0.223 lb/in^2 is this bullet's coefficient for G7; in the spark range it was 4 % less (McCoy 1988)."""
    scene = sandbox.load("bullet")
    assert (scene.parameters.bullet.drag.model, scene.parameters.bullet.coefficient) == ("G7", 0.223)
    assert fire(launch__speed=752.7, zero__distance=0.0)["drag_coefficient"] == pytest.approx(0.3371, rel=0.05)


def test_the_drag_coefficient_is_that_of_the_force():
    """F = 1/2 rho Cd A v^2."""
    scene = sandbox.load("bullet", {"zero.distance": 0.0, "gravity": 0.0})
    setup, bullet = scene.build(), scene.parameters.bullet
    ball = setup.balls[0]
    fx, fy = ball.forces[-1](0.0, ball.position, ball.velocity, 0.0)
    speed = scene.parameters.launch.speed
    area = np.pi * bullet.radius**2
    drag = 0.5 * scene.parameters.air.air.density * fire(zero__distance=0.0)["drag_coefficient"] * area * speed**2
    assert np.hypot(fx, fy) == pytest.approx(drag, rel=1e-12)
