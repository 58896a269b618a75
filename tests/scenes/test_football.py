"""American football: the kick is good or not, the drag follows the angle, and the bounce is not to be predicted."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import sandbox
from sandbox.engine.motion.forces_on_ball import Turned
from sandbox.lab.runs import runs
from sandbox.physics.spheroid import DragByAngle
from tests.scenes.play import playing

run_of = playing("football")


def test_without_air_the_distance_is_that_of_a_parabola():
    run = run_of("football/punt", air__density=0.0, launch__speed=20.0, launch__angle=45.0, launch__nose=0.0)
    moment = run.result
    t = moment["hang_time"]
    assert moment["distance"] == pytest.approx(20.0 * t * 0.5**0.5, rel=1e-9)
    assert moment["apex"] == pytest.approx(0.9 + 20.0**2 * 0.5 / (2 * 9.81), rel=1e-9)


@pytest.mark.parametrize(("turned", "coefficient"), [(0.0, 0.15), (pi / 2, 0.5), (pi / 4, 0.325)])
def test_drag_follows_the_angle_to_the_wind(turned: float, coefficient: float):
    position = Turned((0.0, 0.0))
    position.angle = turned
    drag = DragByAngle(1.2, 0.02, 0.15, 0.5, None, spiral=False)
    assert drag(0.0, position, (10.0, 0.0), 0.0) == pytest.approx((-0.5 * 1.2 * 0.02 * coefficient * 100.0, 0.0))


def test_a_spiral_lands_nose_first_and_goes_farther():
    spiral, over = (
        run_of("football/punt", launch__turns=turns, launch__spin=200) for turns in ("spiral", "end-over-end")
    )
    assert spiral.result["distance"] > over.result["distance"] + 1.0
    assert spiral.result["nose"] == pytest.approx(-spiral.result["landing_angle"], abs=12.0)


def test_bounces_spread_as_those_of_kicks_that_differ_by_degrees():
    """End over end the hang time of such kicks differs by enough for any angle of the nose at the landing."""
    kicks = [(nose, 52.0 + 0.1 * (nose - 20.0)) for nose in np.linspace(14.0, 26.0, 8)]
    bounces = [run_of("football/bounce", launch__nose=nose, launch__angle=angle).result for nose, angle in kicks]
    apart = np.std([result["bounce"] for result in bounces])
    assert apart > 3.0
    assert 0.5 * apart < np.mean([result["bounce_spread"] for result in bounces]) < 2.0 * apart


def test_bounces_spread_less_for_a_spiral_and_none_for_a_ball():
    punt, ball = run_of("football/punt"), run_of("football/bounce", ball__width=0.286, ball__nose_drag=0.5)
    assert 0.1 < punt.result["bounce_spread"] < 3.0
    assert ball.result["bounce_spread"] == pytest.approx(0.0, abs=1e-6)
    assert run_of().result["bounce_spread"] is None


def test_a_disc_in_a_gale_comes_to_lie_on_the_grass():
    """Its bounces fade to less than the overlap by which a touch is found: then it slides."""
    ball = {"ball.width": 0.7278343070087627, "ball.length": 0.05, "ball.mass": 1.0, "ball.side_drag": 0.7381}
    grass = {"ground.restitution": 0.9430186938354834, "ground.friction": 0.0, "gravity": 0.0, "air.density": 1.0}
    kick = {"launch.speed": 0.0, "launch.angle": 0.0, "launch.height": 1.0, "launch.turns": "spiral"}
    wind = {"air.wind": (-100.0, -44.49979139293444), "ball.nose_drag": 0.7645127703036383, "goal.present": False}
    run = sandbox.simulate(sandbox.load("football", ball | grass | kick | wind | {"accuracy.level": "precise"}))
    assert run.events[-1].kind == "contact"
    assert run.numerics.impacts < 400


def test_a_step_that_is_far_too_long_is_made_again():
    """The trial speed is beyond 1e154 m/s, whose square no number holds."""
    light = {"ball.mass": 0.1, "ball.width": 1.0, "ball.side_drag": 0.0, "ball.length": 0.33, "air.density": 1100.0}
    kick = {"launch.speed": 1e-9, "launch.angle": 0.0, "launch.height": 3.0, "launch.turns": "spiral"}
    changes = light | kick | {"air.wind": (89.3, 89.3), "ball.nose_drag": 0.19863759836037037}
    assert run_of(**changes).duration > 0.0


def test_a_kick_is_decided_as_it_passes_the_goal():
    """Then it ends, if no more is asked for; over the bar, under it, and short of it."""
    scene = sandbox.load("football")
    speeds = [30.0, 26.0, 12.0]
    found = list(runs(scene, ["launch.speed"], [[speed] for speed in speeds], asked=("good", "over")))
    whole = [sandbox.simulate(scene.changed({"launch.speed": speed}, "test")) for speed in speeds]
    assert [run.result["good"] for run in found] == [run.result["good"] for run in whole]
    assert [run.result["over"] for run in found[:2]] == pytest.approx([8.652971, 0.925349], abs=1e-5)
    assert [run.result["over"] for run in whole] == [pytest.approx(run.result["over"], abs=1e-6) for run in found]
    assert found[1].duration < 0.5 * whole[1].duration
