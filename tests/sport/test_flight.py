"""What launches, controls and net games share."""

from __future__ import annotations

from typing import Any

import pytest

import sandbox
from sandbox.physics.spheroid import Follows
from sandbox.sport.controls import Spread
from sandbox.sport.net_game import outcome
from tests.scenes.play import run_of


class _Position(tuple[float, float]):
    angle = 0.0


@pytest.mark.parametrize("height", [0.0, 0.02, 0.5])
def test_a_ball_is_released_no_lower_than_it_lies(height: float):
    scene = sandbox.load("baseball", {"release.height": height})
    (ball,) = scene.build().balls
    assert ball.position[1] == max(height, scene.parameters.ball.radius)


@pytest.mark.parametrize(("value", "expected"), [(100.0, 2.0), (-100.0, 2.0), (10.0, 0.5), (0.0, 0.5)])
def test_a_spread_is_a_share_of_the_size_of_a_value_or_its_least(value: float, expected: float):
    assert Spread("launch.spin", share=0.02, minimum=0.5).sigma(value) == expected


def test_what_turns_a_nose_into_its_path_is_damped_critically():
    """Torque over inertia: rate^2 times the angle off the path, less 2 rate times the spin; none below 0.4 m."""
    follows = Follows(inertia=0.002, rate=10.0)
    aside, along = (20.0, 20.0 * 1e-3), (20.0, 0.0)
    assert follows(0.0, _Position((0.0, 1.0)), aside, 0.0) / 0.002 == pytest.approx(100.0 * 1e-3, rel=1e-5)
    assert follows(0.0, _Position((0.0, 1.0)), along, 0.5) / 0.002 == pytest.approx(-2.0 * 10.0 * 0.5)
    assert follows(0.0, _Position((0.0, 0.39)), along, 0.5) == 0.0
    assert follows(0.0, _Position((0.0, 0.5)), along, 0.5) / 0.002 == pytest.approx(-0.5 * 2.0 * 10.0 * 0.5)


@pytest.mark.parametrize(("below", "expected"), [(-0.01, "in"), (0.9, "in"), (1.1, "net")])
def test_the_net_lets_pass_up_to_a_radius_below_its_edge(below: float, expected: str):
    """A ball that brushes the net may come over it; one that passes the middle of the court deeper went under."""
    play = run_of("volleyball")
    parameters: Any = play.scene.parameters
    edge = parameters.net.height + play.result["net_clearance"] + below * parameters.ball.radius
    net = parameters.net.model_copy(update={"height": edge})
    assert outcome(play, parameters.model_copy(update={"net": net})) == expected
