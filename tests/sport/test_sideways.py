"""The drift out of the plane of a ball with a tilted axis, held against its flight in three dimensions."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import sandbox
from sandbox.physics.forces import SpinDecay
from sandbox.sport import sideways
from sandbox.sport.flight import RPM
from sandbox.sport.readings import Moment
from sandbox.sport.sideways import ground_track

IRON = {"launch.speed": 55.0, "launch.angle": 16.1, "launch.spin": 7097.0}
WEDGE = {"launch.speed": 46.5, "launch.angle": 23.7, "launch.spin": 9316.0}


def in_space(scene: sandbox.Scene, upright: bool = False, falls: bool = True) -> float:
    """z in m where a ball comes down, or passes the goal line, by Newton's equations in three dimensions: drag along
    the air, lift along axis x velocity, the axis fixed in space and square to the launch, or partly ``upright``."""
    it, ball = scene.parameters, scene.build().balls[0]
    air, launch, r = it.air.air, it.launch, it.ball.radius
    drag, lift = (model.coefficient_in(air, it.ball) for model in (it.ball.drag, it.ball.lift))
    (vx, vy), half = ball.velocity, 0.5 * air.density * np.pi * r * r
    square = np.array([-vy, vx, 0.0]) / np.hypot(vx, vy)
    tilt = np.radians(launch.axis or 0.0)
    whole = launch.spin * RPM * (np.cos(tilt) * np.array([0, 0, 1.0]) - np.sin(tilt) * square)
    if upright:
        whole = RPM * np.array([0.0, -launch.sidespin, launch.spin])
    size, wind = float(np.linalg.norm(whole)), np.array([*air.wind, air.crosswind or 0.0])
    decay = sum(torque.rate for torque in ball.torques if isinstance(torque, SpinDecay))

    def rate(t: float, at: np.ndarray) -> list[float]:
        through, spin = at[3:6] - wind, at[6]
        u = float(np.linalg.norm(through))
        about = 2.0 * r * air.density * u / air.viscosity, r * spin / u
        force = half * u * (lift(*about) * np.cross(whole / size, through) - drag(*about) * through)
        return [*at[3:6], *(force / it.ball.mass - [0.0, it.gravity, 0.0]), -decay * u * spin / r]

    def end(t: float, at: np.ndarray) -> float:
        return at[1] - (r if scene.name == "baseball" else ball.position[1]) if falls else it.goal.distance - at[0]

    end.terminal, end.direction = True, -1
    start = [*ball.position, 0.0, vx, vy, 0.0, size]
    return float(solve_ivp(rate, (1e-9, 20.0), start, events=end, rtol=1e-8, atol=1e-8).y[2, -1])


@pytest.mark.parametrize(
    ("shot", "most"),
    [
        ({"launch.axis": 40.0}, 0.002),
        ({**IRON, "launch.axis": -40.0}, 0.004),
        ({**WEDGE, "launch.axis": 20.0}, 0.004),
        ({**WEDGE, "launch.axis": 75.0}, 0.02),
        ({**IRON, "air.crosswind": 10.0}, 0.02),
        ({**IRON, "launch.axis": 20.0, "air.crosswind": 5.0, "air.wind": [-5.0, 0.0]}, 0.02),
    ],
)
def test_a_golf_ball_drifts_as_in_space(shot: dict[str, float], most: float):
    scene = sandbox.load("golf", shot)
    assert sandbox.simulate(scene).result["side"] == pytest.approx(in_space(scene), rel=most)


def test_a_free_kick_curls_as_in_space():
    scene = sandbox.load("soccer", {"launch.axis": -40.0, "launch.spin": 500.0, "wall.present": False})
    assert sandbox.simulate(scene).result["side"] == pytest.approx(in_space(scene, falls=False), rel=0.005)


def test_sidespin_about_an_upright_axis_bends_a_fly_ball():
    scene = sandbox.load("baseball", {"launch.direction": 0.0})
    side = sandbox.simulate(scene).result["side"]
    assert side == pytest.approx(in_space(scene, upright=True), rel=0.01)
    assert side > 5.0


def test_the_scene_says_what_the_bend_takes_of_the_distance():
    def taken(sidespin: float) -> float:
        run = sandbox.simulate(sandbox.load("baseball", {"launch.sidespin": sidespin, "launch.direction": 0.0}))
        landed = Moment(run.duration, *run.before("ball", run.duration))
        return (run.result["distance"] - np.hypot(*ground_track(run, run.scene.parameters, landed)[-1])) / 0.3048

    said = f"({taken(849.0):.0f} ft of an average ball's, {taken(2500.0):.0f} ft with 2,500"
    assert said in (sandbox.load("baseball").folder / "scene.py").read_text("utf-8")


@pytest.mark.parametrize("name", ["golf", "soccer", "tennis", "baseball"])
def test_a_level_axis_changes_nothing(name: str):
    changes = {"launch.sidespin": 0.0} if name == "baseball" else {}
    plain = sandbox.simulate(sandbox.load(name, changes))
    level = sandbox.simulate(sandbox.load(name, {**changes, "launch.axis": 0.0, "launch.direction": 0.0}))
    assert plain.result["side"] is None
    assert level.result == {**plain.result, "side": 0.0}


def test_direction_turns_the_plane():
    calm = sandbox.simulate(sandbox.load("golf", {"launch.direction": 30.0})).result
    assert calm["side"] == pytest.approx(0.5 * calm["carry"], rel=1e-12)
    across = sandbox.simulate(sandbox.load("golf", {"launch.direction": 30.0, "air.crosswind": 6.0})).result
    with_wind = sandbox.simulate(sandbox.load("golf", {"air.wind": [3.0, 0.0]})).result  # 6 m/s times sin 30 deg
    assert across["carry"] == pytest.approx(with_wind["carry"], rel=1e-12)


def test_a_mirrored_axis_mirrors_the_drift_and_topspin_turns_it():
    def side(axis: float, spin: float) -> float:
        return sandbox.simulate(sandbox.load("golf", {"launch.axis": axis, "launch.spin": spin})).result["side"]

    assert side(-15.0, 2545.0) == -side(15.0, 2545.0) < 0.0
    assert side(15.0, -500.0) < 0.0


def test_a_ball_rolls_with_its_own_part_of_the_spin():
    run = sandbox.simulate(sandbox.load("golf", {"launch.axis": 60.0}))
    assert run.state("ball", 0.0).spin == pytest.approx(0.5 * 2545.0 * RPM)
    assert run.result["launch_spin"] == 2545.0


def test_a_shot_to_the_side_is_not_holed():
    result = sandbox.simulate(sandbox.load("golf/putt")).result
    assert result["holed"]
    result = sandbox.simulate(sandbox.load("golf/putt", {"launch.direction": 5.0})).result
    assert not result["holed"]
    assert result["distance_to_pin"] > 0.3


@pytest.mark.parametrize(
    ("name", "changes", "key", "facts"),
    [
        ("golf", {}, "launch.axis", ("side", "carry")),
        ("golf", {"air.wind": [-3.0, 0.0], "air.crosswind": 2.0}, "launch.direction", ("side", "carry")),
        ("baseball", {}, "launch.direction", ("side", "distance")),
    ],
)
def test_many_shots_drift_together_as_each_alone(name, changes, key, facts, monkeypatch):
    tracks = []
    rates, angles, scene = sideways._rates, np.linspace(-30.0, 30.0, 41), sandbox.load(name, changes)
    monkeypatch.setattr(sideways, "_rates", lambda *given: tracks.append(1) or rates(*given))
    many = sandbox.simulate_many(scene, {key: angles}, facts=facts)
    assert len(tracks) < len(angles)
    for place in (0, 20, 33):
        alone = sandbox.simulate(scene.changed({key: angles[place]})).result
        assert [many[fact][place] for fact in facts] == pytest.approx([alone[fact] for fact in facts], abs=1e-9)


def test_a_shot_that_does_not_come_down_has_no_drift():
    far = sandbox.load("golf", {"launch.axis": 10.0, "gravity": 0.001, "air.density": 0.0})
    speeds = {"launch.speed": [0.05, *[70.0] * 19]}
    assert np.isnan(sandbox.simulate_many(far, speeds, facts=("side",))["side"]).tolist() == [False, *[True] * 19]
