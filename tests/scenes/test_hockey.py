"""Hockey: goals, saves and passes, off the boards, round the corners, and on an air table."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, radians, sin
from typing import Any

import pytest

import sandbox
from sandbox.engine.ledger import ledger
from sandbox.engine.model.surface import Segment
from tests.scenes.play import playing

ALONE: dict[str, Any] = {"players": [], "air.density": 0.0}  # without air

shoot = playing("hockey")


def test_a_goal_is_a_puck_wholly_over_the_line_between_the_posts():
    run = shoot()
    assert run.ended == "until"
    x, y = run.state("puck", run.duration)[:2]
    assert x - 0.0381 == pytest.approx(30.48 - 3.3528, abs=1e-6)
    assert abs(y) < 0.9144


def test_corners_may_be_sharper_than_the_puck_is_round():
    """0.01 m is less than the radius of the puck, 0.0381 m."""
    assert shoot(rink__corner=0.01).result["goal"]


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
    run = shoot(**changes)
    assert run.state("puck", 1.0)[2:4] == pytest.approx((20 * cos(radians(50)), -20 * sin(radians(50))), rel=1e-9)


def test_corners_are_round():
    """A puck from a corner's middle in any direction comes back to it: off by the chords' 0.7 deg at most."""
    level = {"puck.restitution": 1.0, "puck.friction": 0.0, "rink.sliding": 0.0, "duration": 2.0}
    middle = {"launch.x": 30.48 - 8.5344, "launch.aside": 12.954 - 8.5344, "launch.speed": 10.0}
    for angle in (10.0, 33.0, 61.0, 85.0):
        run = shoot(**{**ALONE, **level, **middle, "launch.angle": angle})
        hit = next(event for event in run.events if event.kind == "impact")
        away = hypot(hit.x - middle["launch.x"], hit.y - middle["launch.aside"])
        assert away == pytest.approx(8.5344 - 0.0381, abs=1e-3)
        vx, vy = run.state("puck", hit.t)[2:4]
        assert degrees(atan2(vy, vx)) % 360.0 == pytest.approx(angle + 180.0, abs=1.45)


def test_an_air_table_takes_no_energy():
    book = ledger(shoot("hockey/air-hockey", players=[], air__density=0.0, launch__angle=70.0, duration=3.0))
    assert book.contacts["ice"] == pytest.approx(0.0, abs=1e-15)
    assert book.end < book.start  # to the rails
    assert book.start + sum(book.impacts.values()) == pytest.approx(book.end, abs=1e-12)


def test_a_mallet_strikes_the_puck():
    """An elastic smooth blow of a mallet of mass M on a puck at rest: 2 M v / (M + m)."""
    blow = {
        "players": [{"role": "mallet", "x": -1.0, "y": 0.0, "vx": 3.0}],
        "launch.speed": 0.0,
        "duration": 0.3,
        "air.density": 0.0,
    }
    run = sandbox.simulate(
        sandbox.load("hockey/air-hockey", {**blow, "player.restitution": 1.0, "player.friction": 0.0})
    )
    assert run.state("puck", 0.29)[2] == pytest.approx(2 * 0.3 * 3.0 / 0.342, rel=1e-9)


def test_who_stands_holds_ground_and_who_skates_keeps_speed():
    players = [{"role": "defender", "x": 0.0, "y": 9.0, "vx": 2.0}, {"role": "goalie", "x": 26.2, "y": 0.15}]
    run = shoot(players=players, duration=3.0, launch__angle=40.0)
    assert run.state("defender 1", 2.0)[0] == pytest.approx(4.0)
    assert run.state("goalie 2", 2.0)[:2] == (26.2, 0.15)


def test_a_goalie_who_dives_saves_what_he_reaches_in_time():
    """With reaction t and speed u: he covers u (T - t), to the side that he sees the puck go to."""
    dives = {"dive.dives": True, "dive.reaction": 0.2}
    assert not shoot("hockey/glove-save", **{"dive.dives": False}).result["saved"]
    saved = shoot("hockey/glove-save", **dives)
    assert saved.result["saved"]
    assert saved.result["touches"][0] == "goalie 1"
    assert saved.setup.surfaces[-1].at(0.3).shape.center == pytest.approx((26.2, 0.4 - 3.0 * 0.1))
    assert shoot("hockey/glove-save", **dives | {"dive.reaction": 0.45}).result["goal"]


def test_a_pass_that_misses_says_by_how_much():
    """Straight on, past a receiver who stands aside, between the edges of the discs."""
    receiver = {"role": "receiver", "x": 0.0, "y": 4.0}
    run = shoot(**ALONE | {"players": [receiver]}, launch__x=-10, launch__aside=0.0, launch__angle=0.0, launch__speed=6)
    gap = 4.0 - run.scene.parameters.puck.radius - run.scene.parameters.player.radius
    assert run.scene.verdict(run) == f"Misses the receiver by {gap:.1f} m"


def test_the_corners_of_a_rink_may_meet():
    boards = [each.shape for each in sandbox.load("hockey", {"rink.corner": 15.0}).build().surfaces]
    assert min(shape.length for shape in boards if isinstance(shape, Segment)) > 0.01
