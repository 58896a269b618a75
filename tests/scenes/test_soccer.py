"""Soccer in side view."""

from __future__ import annotations

from math import cos, radians, sin, tan

import pytest

from sandbox.engine.paths.run import Run
from tests.scenes.play import playing

VACUUM = {"air.density": 0.0, "wall.present": False}
kick = playing("soccer")


def touched(run: Run) -> set[str]:
    return {event.partner for event in run.events}


# Presets ------------------------------------------------------------------------------------------------------------


def test_the_gale_brings_the_goal_kick_back():
    calm = kick("soccer/goal-kick-in-a-gale", air__wind=[0, 0])
    gale = kick("soccer/goal-kick-in-a-gale")
    assert calm.result["carry"] == pytest.approx(58.0, abs=1.0)
    assert 0.0 < gale.result["carry"] < 20.0
    assert gale.state("ball", gale.duration)[0] < 0.0


def test_the_net_keeps_the_ball_in():
    """A coach expects a ball that scored to lie in the net, not to run back on to the pitch."""
    for angle in (18.5, 19, 20, 21, 22):
        run = kick(launch__angle=angle)
        assert run.result["goal"]
        assert 22.06 < run.state("ball", run.duration)[0] < 24.0


# Exact cases --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("speed", "angle"), [(20.0, 25.0), (26.0, 15.0), (30.0, 10.0)])
def test_in_vacuum_heights_and_times_are_those_of_the_parabola(speed: float, angle: float):
    """y = r + x tan a - g x^2 / (2 v^2 cos^2 a); apex v^2 sin^2 a / 2 g; flight 2 v sin a / g; carry v^2 sin 2a / g."""
    run = kick(launch__speed=speed, launch__angle=angle, goal__present=False, goal__distance=12.0, **VACUUM)
    a = radians(angle)

    def height(x: float) -> float:
        return 0.11 + x * tan(a) - 9.81 * x * x / (2.0 * (speed * cos(a)) ** 2)

    result = run.result
    assert result["height_at_wall"] == pytest.approx(height(9.15), abs=1e-9)
    assert result["height_at_goal"] == pytest.approx(height(12.0), abs=1e-9)
    falling = speed * sin(a) - 9.81 * 12.0 / (speed * cos(a))
    assert result["speed_at_goal"] == pytest.approx(((speed * cos(a)) ** 2 + falling**2) ** 0.5, abs=1e-9)
    assert result["apex"] == pytest.approx((speed * sin(a)) ** 2 / (2.0 * 9.81), abs=1e-9)
    assert result["flight_time"] == pytest.approx(2.0 * speed * sin(a) / 9.81, abs=1e-8)
    assert result["carry"] == pytest.approx(speed**2 * sin(2.0 * a) / 9.81, abs=1e-7)
    assert result["verdict"] == "past"


def test_a_rolling_ball_comes_to_rest_where_it_should():
    """A ball that rolls at v with resistance c stops after v^2 / (2 c g)."""
    spin = -5.0 / 0.11 * 30.0 / 3.141592653589793
    run = kick(launch__speed=5, launch__angle=0, launch__spin=spin, goal__distance=60, **VACUUM)
    assert run.ended == "rest"
    assert run.state("ball", run.duration)[0] == pytest.approx(25.0 / (2.0 * 0.1 * 9.81), abs=1e-6)
    assert run.result["flight_time"] == 0.0


def test_a_goal_is_the_whole_ball_over_the_whole_line():
    """Around the speeds that meet the bar: over the line only if the centre came 0.06 + 0.11 m past its middle."""
    verdicts = set()
    for speed in [29.0 + 0.05 * i for i in range(21)]:
        run = kick(launch__speed=speed, launch__angle=22)
        across = [state[1] for _, state in run.crossings("ball", (22.17, 0.0), (-1.0, 0.0))]
        assert run.result["goal"] is any(y < 2.44 for y in across)
        verdicts.add(run.result["verdict"])
    assert verdicts == {"goal", "bar"}


@pytest.mark.parametrize(("rolls", "verdict"), [(21.9, "short"), (22.1, "short"), (22.16, "short"), (22.2, "goal")])
def test_a_ball_that_stops_on_the_line_is_no_goal(rolls: float, verdict: str):
    """Rolling at v it stops after v^2 / (2 c g): on the line, up to where all of it is over the line's far edge."""
    speed = (2.0 * 0.1 * 9.81 * rolls) ** 0.5
    rolling = {"launch__speed": speed, "launch__angle": 0, "launch__spin": f"{-speed / 0.11} rad/s"}
    run = kick(air__density=0, wall__present=False, **rolling)
    assert run.state("ball", run.duration)[0] == pytest.approx(rolls, abs=1e-6)
    assert run.result["verdict"] == verdict


def test_heights_are_none_where_the_ball_never_comes():
    result = kick(launch__angle=8).result
    assert result["verdict"] == "wall"
    assert result["height_at_wall"] is result["height_at_goal"] is result["speed_at_goal"] is None


def test_a_wall_behind_no_goal_is_no_error():
    assert kick(wall__distance=30, goal__present=False).result["verdict"] in ("wall", "past")


def test_a_ball_driven_into_the_net_by_friction_rests_soon():
    """It spins in the corner between ground and net; each faint impact on the net used to be followed by the next."""
    far = {"goal__height": 33.772926162821314, "goal__depth": 1.9101895905816813}
    run = kick(air__density=0.0, goal__net_friction=0.0, **far)
    assert run.ended == "rest"
    assert len(run.events) < 100
