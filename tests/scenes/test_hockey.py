"""Hockey: goals, saves and passes, off the boards, round the corners, and on an air table."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, radians, sin
from typing import Any

import pytest

import sandbox
from sandbox.engine.ledger import ledger
from sandbox.engine.run import Run
from sandbox.errors import RequestError

ALONE: dict[str, Any] = {"players": []}


def shoot(scene: str = "hockey", **changes: Any) -> Run:
    return sandbox.simulate(sandbox.load(scene, {key.replace("__", "."): value for key, value in changes.items()}))


@pytest.mark.parametrize(
    ("preset", "word", "said"),
    [
        ("hockey", "goal", "Goal at 42.0 m/s"),
        ("hockey/bank-pass", "received", "Received at 10.0 m/s, off the boards"),
        ("hockey/rim", "received", "Received at 8.6 m/s, off the boards"),
        ("hockey/off-the-post", "post", "Off the post"),
        ("hockey/air-hockey", "goal", "Goal at 4.4 m/s, off the boards"),
    ],
)
def test_presets_are_what_they_say_at_every_accuracy(preset, word, said):
    for level in ("fast", "balanced", "precise"):
        run = shoot(preset, accuracy__level=level)
        assert (run.result["verdict"], run.scene.verdict(run)) == (word, said)
    assert run.result["goal"] is (word == "goal")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"players": [{"role": "goalie", "x": 26.2, "y": -0.8}]}, "Saved by the goalie"),
        ({"players": [{"role": "defender", "x": 16.0, "y": -3.2}]}, "Stopped by the defender"),
        ({"launch.angle": 20.0, **ALONE}, "Wide of the goal"),
        ({"launch.speed": 3.0, **ALONE}, "Stops 15 m before the goal line"),
    ],
)
def test_what_else_becomes_of_a_shot(changes, said):
    run = sandbox.simulate(sandbox.load("hockey", changes))
    assert run.scene.verdict(run) == said
    assert not run.result["goal"]


def test_a_goal_is_a_puck_wholly_over_the_line_between_the_posts():
    run = shoot()
    assert run.ended == "until"
    x, y = run.state("puck", run.duration)[:2]
    assert x - 0.0381 == pytest.approx(30.48 - 3.3528, abs=1e-6)
    assert abs(y) < 0.9144


def test_a_goal_from_behind_the_net_does_not_count():
    run = shoot(**ALONE, launch__x=29.5, launch__aside=0.2, launch__angle=180, launch__speed=10)
    assert run.result["touches"][0] == "net"
    assert not run.result["goal"]


def test_the_puck_glides_as_far_as_its_energy_goes():
    """v^2 / (2 mu g), in v / (mu g)."""
    run = shoot(**ALONE, launch__speed=6.0, launch__angle=0.0, launch__x=-20, launch__aside=3)
    assert run.state("puck", run.duration)[0] == pytest.approx(-20 + 36 / (2 * 0.1 * 9.81), rel=1e-9)
    assert run.duration == pytest.approx(6 / (0.1 * 9.81), rel=1e-9)


def test_smooth_elastic_boards_return_the_puck_as_a_mirror():
    level = {"puck.restitution": 1.0, "puck.friction": 0.0, "rink.sliding": 0.0, "duration": 1.0}
    changes = {**ALONE, **level, "launch.angle": 50.0, "launch.speed": 20.0, "launch.x": 0.0, "launch.aside": 0.0}
    run = sandbox.simulate(sandbox.load("hockey", changes))
    assert run.state("puck", 1.0)[2:4] == pytest.approx((20 * cos(radians(50)), -20 * sin(radians(50))), rel=1e-9)


def test_corners_are_round():
    """A puck from a corner's middle in any direction comes back to it: off by the chords' 0.7 deg at most."""
    level = {"puck.restitution": 1.0, "puck.friction": 0.0, "rink.sliding": 0.0, "duration": 2.0}
    middle = {"launch.x": 30.48 - 8.5344, "launch.aside": 12.954 - 8.5344, "launch.speed": 10.0}
    for angle in (10.0, 33.0, 61.0, 85.0):
        run = sandbox.simulate(sandbox.load("hockey", {**ALONE, **level, **middle, "launch.angle": angle}))
        hit = next(event for event in run.events if event.kind == "impact")
        away = hypot(hit.x - middle["launch.x"], hit.y - middle["launch.aside"])
        assert away == pytest.approx(8.5344 - 0.0381, abs=1e-3)
        vx, vy = run.state("puck", hit.t)[2:4]
        assert degrees(atan2(vy, vx)) % 360.0 == pytest.approx(angle + 180.0, abs=1.45)


def test_an_air_table_takes_no_energy():
    book = ledger(shoot("hockey/air-hockey", players=[], launch__angle=70.0, duration=3.0))
    assert book.contacts["ice"] == pytest.approx(0.0, abs=1e-15)
    assert book.end < book.start  # to the rails
    assert book.start + sum(book.impacts.values()) == pytest.approx(book.end, abs=1e-12)


def test_a_mallet_strikes_the_puck():
    """An elastic smooth blow of a mallet of mass M on a puck at rest: 2 M v / (M + m)."""
    blow = {"players": [{"role": "mallet", "x": -1.0, "y": 0.0, "vx": 3.0}], "launch.speed": 0.0, "duration": 0.3}
    run = sandbox.simulate(
        sandbox.load("hockey/air-hockey", {**blow, "player.restitution": 1.0, "player.friction": 0.0})
    )
    assert run.state("puck", 0.29)[2] == pytest.approx(2 * 0.3 * 3.0 / 0.342, rel=1e-9)


def test_who_stands_holds_ground_and_who_skates_keeps_speed():
    players = [{"role": "defender", "x": 0.0, "y": 9.0, "vx": 2.0}, {"role": "goalie", "x": 26.2, "y": 0.15}]
    run = shoot(players=players, duration=3.0, launch__angle=40.0)
    assert run.state("defender 1", 2.0)[0] == pytest.approx(4.0)
    assert run.state("goalie 2", 2.0)[:2] == (26.2, 0.15)


@pytest.mark.parametrize(
    ("x", "y", "said"),
    [
        (30.45, 0.0, r"puck at \(30.45, 0\) m is outside the boards"),
        (0.0, -12.95, "outside the boards"),
        (29.0, 11.5, "outside the boards"),  # in the rounding of a corner
        (29.0, 7.0, None),
    ],
)
def test_who_starts_outside_the_boards_is_refused(x, y, said):
    if said is None:
        shoot(**ALONE, launch__x=x, launch__aside=y, duration=0.1)
        return
    with pytest.raises(RequestError, match=said):
        shoot(**ALONE, launch__x=x, launch__aside=y)
