"""Soccer in side view."""

from __future__ import annotations

from math import cos, radians, sin, tan
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sandbox
from sandbox.engine.run import Run
from sandbox.errors import RequestError

VACUUM = {"air.density": 0.0, "wall.present": False}
VERDICTS = {"soccer": "goal", "soccer/dipping-free-kick": "goal", "soccer/goal-kick-in-a-gale": "short"}


def kick(scene: str = "soccer", **changes: Any) -> Run:
    """A run with changed parameters: ``launch__speed=20`` stands for launch.speed."""
    return sandbox.simulate(sandbox.load(scene, {key.replace("__", "."): value for key, value in changes.items()}))


def touched(run: Run) -> set[str]:
    return {event.partner for event in run.events}


def test_the_card_says_nothing_of_a_wall_that_is_not_there():
    there, gone = (dict((run := kick(wall__present=present)).scene.rows(run)) for present in (True, False))
    assert set(there) - set(gone) == {"height at wall", "over the wall"}


# Presets ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("level", ["fast", "balanced", "precise"])
@pytest.mark.parametrize("name", VERDICTS)
def test_presets_end_as_they_say_at_every_accuracy(name: str, level: str):
    result = kick(name, accuracy__level=level).result
    assert result["verdict"] == VERDICTS[name]
    assert result["goal"] is (result["verdict"] == "goal")


def test_the_dipping_free_kick_would_go_over_without_its_spin():
    assert kick("soccer/dipping-free-kick", launch__spin=0).result["verdict"] == "over"


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


# Verdicts -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "verdict", "met", "said"),
    [
        ({}, "goal", "net", "Goal, 1.1 m under the bar"),
        ({"launch.spin": 0}, "over", "ground", "Over the bar by 1.2 m"),
        ({"launch.angle": 12}, "wall", "wall", "Into the wall"),
        ({"launch.angle": 22, "launch.speed": 28.2}, "bar", "bar", "Off the bar"),
        ({"launch.speed": 6, "wall.present": False}, "short", "ground", "Short, 9.6 m from the goal"),
        ({"launch.speed": 0}, "short", "ground", "Short, 21 m from the goal"),
        (
            {"launch.speed": 0, "air.wind": [-30, 0], "wall.present": False},
            "short",
            "ground",
            "Ends 30 m behind the kick",
        ),
        ({"goal.present": False}, "past", "ground", "30 m up the field"),
        ({"wall.present": False, "launch.angle": 5}, "goal", "net", "Goal, 2.2 m under the bar"),
    ],
)
def test_verdicts(changes: dict[str, Any], verdict: str, met: str, said: str):
    run = sandbox.simulate(sandbox.load("soccer", changes))
    assert run.result["verdict"] == verdict
    assert run.result["goal"] is (verdict == "goal")
    assert met in touched(run)
    assert run.ended in ("rest", "until")
    assert run.scene.verdict(run) == said


def test_a_goal_is_the_whole_ball_over_the_whole_line():
    """Around the speeds that meet the bar: over the line only if the centre came 0.06 + 0.11 m past its middle."""
    verdicts = set()
    for speed in [27.9 + 0.05 * i for i in range(21)]:
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


# Properties ---------------------------------------------------------------------------------------------------------


def test_more_topspin_comes_lower():
    heights = [kick(launch__spin=spin, wall__present=False).result["height_at_goal"] for spin in (300, 0, -150, -300)]
    assert heights == sorted(heights, reverse=True)


def test_headwind_shortens_and_tailwind_lengthens():
    carries = [kick("soccer/goal-kick-in-a-gale", air__wind=[w, 0]).result["carry"] for w in (-10, -5, 0, 5, 10)]
    assert carries == sorted(carries)


@settings(max_examples=15, deadline=None)
@given(speed=st.floats(5, 40), angle=st.floats(5, 60), spin=st.floats(-800, 800))
def test_still_air_only_takes_energy(speed: float, angle: float, spin: float):
    """Drag takes, lift does no work: 1/2 v^2 + g y never grows in flight."""
    run = kick(launch__speed=speed, launch__angle=angle, launch__spin=spin, goal__present=False, wall__present=False)
    path = run.trajectory("ball")
    flight = path[path[:, 0] < run.result["flight_time"]]
    energy = 0.5 * (flight[:, 3] ** 2 + flight[:, 4] ** 2) + 9.81 * flight[:, 2]
    assert (energy[1:] <= energy[:-1] * (1.0 + 1e-9)).all()


def test_an_effect_left_out_is_an_absent_term():
    scene = sandbox.load("soccer", {"ball.lift.model": "none", "ball.drag.model": "none"})
    assert [type(force).__name__ for force in scene.build().balls[0].forces] == ["Gravity"]
    assert sandbox.load("soccer", {"air.density": 0, "gravity": 0}).build().balls[0].forces == []


# Bad input ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"wall.distance": 30}, ("wall.distance = 30 m", "goal.distance = 22 m")),
        ({"wall.distance": 21.9}, ("wall.distance = 21.9 m", "goal.distance = 22 m")),
        ({"wall.distance": 0.2}, ("wall.distance = 0.2 m", "ball.radius = 0.11 m")),
        ({"goal.distance": 0.1, "wall.present": False}, ("goal.distance = 0.1 m", "ball.radius = 0.11 m")),
    ],
)
def test_what_makes_no_sense_is_refused_in_a_line_that_names_both(changes: dict[str, Any], named: tuple[str, ...]):
    scene = sandbox.load("soccer", changes)
    with pytest.raises(RequestError) as refused:
        sandbox.simulate(scene)
    assert all(part in str(refused.value) for part in named)
    assert "\n" not in str(refused.value)


def test_a_wall_behind_no_goal_is_no_error():
    assert kick(wall__distance=30, goal__present=False).result["verdict"] in ("wall", "past")


def test_the_card_speaks_to_players():
    run = sandbox.simulate("soccer")
    card = dict(run.scene.rows(run))
    assert (card["ball speed"], card["launch"], card["spin"]) == ("27.0 m/s", "20.0°", "300 rpm topspin")
    assert card["over the wall"] == "0.36 m"
    assert run.scene.verdict(run) == "Goal, 1.1 m under the bar"


def test_a_ball_that_friction_drives_into_the_net_comes_to_rest_soon():
    """It spins in the corner between ground and net; each faint impact on the net used to be followed by the next."""
    far = {"goal__height": 33.772926162821314, "goal__depth": 1.9101895905816813}
    run = kick(air__density=0.0, goal__net_friction=0.0, **far)
    assert run.ended == "rest"
    assert len(run.events) < 100
