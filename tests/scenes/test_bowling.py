"""Bowling: strikes, spares and what is left, the hook, and the ball's speed and spin."""

from __future__ import annotations

from math import cos, pi, radians
from typing import Any

import numpy as np
import pygame
import pytest

import sandbox
from sandbox.picture.painter import Painter
from tests.scenes.play import playing, run_of

HEAD, INCH = 18.288, 0.0254

bowl = playing("bowling")


def test_pins_are_counted_as_they_fall():
    presets = ("straight", "ten-pin-spare", "split", "house-pattern", "gutter-ball")
    assert [bowl(f"bowling/{preset}").result["pins"] for preset in presets] == [8, 1, 2, 10, 0]


def test_the_pins_stand_as_in_the_rules():
    """Ten in an equilateral triangle of 36 in, the 7 at the left and the 10 at the right of the last row."""
    spots = {ball.name: ball.position for ball in bowl().setup.balls[1:]}
    assert spots["1"] == (HEAD, 0.0)
    assert spots["7"] == pytest.approx((HEAD + 36 * INCH * 3**0.5 / 2, 18 * INCH), abs=1e-4)
    assert spots["10"] == pytest.approx((HEAD + 36 * INCH * 3**0.5 / 2, -18 * INCH), abs=1e-4)
    assert spots["5"] == pytest.approx((HEAD + 12 * INCH * 3**0.5, 0.0), abs=1e-4)


def test_a_left_hander_is_the_mirror_image():
    left = bowl(launch__angle=2.46, launch__axis=-60, launch__aside=0.1)
    mirrored = {"2": "3", "3": "2", "4": "6", "6": "4", "7": "10", "10": "7", "8": "9", "9": "8"}
    assert left.result["offset"] == pytest.approx(-bowl().result["offset"], abs=1e-9)
    assert [mirrored.get(pin, pin) for pin in left.result["met"]] == bowl().result["met"]


def test_the_ball_rolls_in_the_end_whatever_the_lane():
    """Its angular momentum about a line on the lane stays: v (1 + k) = v0 + k r w, k of its radius of gyration."""
    launch = {"launch__axis": 0, "launch__angle": 0, "launch__spin": 100, "pin__standing": "7", "oil": []}
    k = (2.55 / 4.28) ** 2
    v0, w, r = 19 * 0.44704, 100 * pi / 30, 4.28 * INCH
    run = bowl(**launch, dry=0.3)
    assert run.state("ball", 2.0)[2] == pytest.approx((v0 + k * r * w) / (1 + k), rel=1e-9)


def test_more_side_spin_and_drier_lanes_hook_more():
    def hook(**changes: Any) -> float:
        return bowl(launch__angle=0.0, launch__aside=-0.4, pin__standing="7", **changes).state("ball", 2.0)[1]

    assert hook(launch__axis=0) == pytest.approx(-0.4)
    assert -0.4 < hook(launch__axis=30) < hook(launch__axis=60)
    assert hook() < hook(dry=0.3)


def test_oil_keeps_the_hook_for_the_end():
    """On the oil the ball bends by less than a fifth of what it bends beyond it, on half the way."""
    run = bowl()
    slopes = [state[3] / state[2] for x in (0.01, 12.192, 18.1) for _, state in run.crossings("ball", (x, 0), (-1, 0))]
    on_oil, beyond = slopes[1] - slopes[0], slopes[2] - slopes[1]
    assert 0.0 < on_oil / 12.192 < 0.3 * beyond / 5.9


def test_a_gutter_keeps_a_ball_and_takes_no_pins():
    run = bowl("bowling/gutter-ball")
    (caught,) = (event for event in run.events if event.kind == "caught")
    assert (caught.ball, caught.partner) == ("ball", "gutter")
    assert caught.y == pytest.approx(0.52705, abs=1e-9)
    assert not [event for event in bowl().events if event.partner == "gutter"]


def test_a_pin_that_is_barely_touched_stands():
    """A push of less than 0.2 m/s."""
    slow = {"launch__spin": 0, "launch__axis": 0, "oil": [], "dry": 0.0, "pin__standing": "1", "launch__angle": 0.0}
    still = bowl(**slow, launch__speed=0.12, launch__aside=0.0)
    assert still.ended == "duration"
    graze = 4.28 * INCH + 2.383 * INCH - 1e-5
    run = bowl(**slow, launch__speed=6.0, launch__aside=graze)
    assert run.result["met"] == ["1"]
    assert run.scene.verdict(run) == "No pin falls"


def test_the_next_ball_finds_what_is_left():
    scene = sandbox.load("bowling/straight")
    following = scene.controls.next_start(sandbox.simulate(scene), scene.parameters)
    assert following == {"pin.standing": "4 6"}
    after_strike = sandbox.load("bowling")
    run = sandbox.simulate(after_strike)
    assert len(after_strike.controls.next_start(run, after_strike.parameters)["pin.standing"].split()) == 10


def test_the_order_of_the_oil_does_not_matter():
    oil = [{"end": 12.0, "friction": 0.04}, {"end": 5.0, "friction": 0.1}]
    assert bowl(oil=oil).result == bowl(oil=oil[::-1]).result


def test_the_axis_turns_with_the_launch():
    """A ball launched 10 deg to the left with its axis straight rolls without hook."""
    run = bowl(launch__angle=1.0, launch__axis=0.0, launch__spin=200, launch__aside=-0.3, pin__standing="7")
    vx, vy = run.state("ball", 1.0)[2:4]
    assert vy / vx == pytest.approx(radians(1.0), rel=1e-3)
    assert cos(radians(1.0)) == pytest.approx(vx / (vx * vx + vy * vy) ** 0.5)


def test_fallen_pins_are_drawn_lying_as_the_verdict_counts():
    """Once six pins were drawn as if standing for "leaves the 4, 6", and two after a strike."""
    for name, left in (("bowling/straight", ["4", "6"]), ("bowling", [])):
        run = run_of(name)
        picture = run.scene.picture(run, (640, 360))
        there = [pin for pin in picture.present(picture.story_end) if pin != "ball"]
        assert [pin for pin in there if pin not in picture.falls] == left == run.result["leaves"]
        lying = next(pin for pin in there if pin in picture.falls)
        tall = {pin: _drawn_size(picture, pin, 20.0) for pin in (lying, *left)}
        assert tall[lying] > 100  # px: a pin is over six radii long
        assert all(tall[pin] < 60 for pin in left)


def _drawn_size(picture, name, radius):
    """The larger side in px of what is drawn for a ball in the end."""
    surface = pygame.Surface((400, 400))
    picture.draw_ball(Painter(surface), picture.camera, name, picture.story_end, (200.0, 200.0), radius)
    seen = np.argwhere(pygame.surfarray.array3d(surface).max(axis=2) > 120)
    return int(np.hypot(*np.ptp(seen, axis=0)))


def test_a_ball_in_the_gutter_is_seen_from_near():
    run = run_of("bowling/gutter-ball")
    picture = run.scene.picture(run, (1280, 720))
    picture.poster()
    assert "ball" in picture.present(run.duration)
    at = picture.near_camera.pixel(*run.state("ball", run.duration)[:2])
    assert picture.lens.collidepoint(at)
