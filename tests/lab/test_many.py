"""Many runs at any points: in order, as arrays, and what is wrong with a point."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import sandbox
from sandbox import RequestError, simulate_many

RNG = np.random.default_rng(3)
THROWS = {"launch.speed": RNG.uniform(6.8, 8.6, 40), "launch.angle": RNG.uniform(40.0, 65.0, 40)}


def plain(value: Any) -> Any:
    """A value of an array as a result has it."""
    return None if isinstance(value, float) and np.isnan(value) else value


@pytest.mark.parametrize(
    ("name", "points"),
    [
        ("basketball", THROWS),
        ("golf", {"launch.speed": RNG.uniform(40.0, 75.0, 40), "launch.spin": RNG.uniform(1000.0, 6000.0, 40)}),
        ("billiards", {"cue.speed": [1.0, 2.0]}),
    ],
)
def test_each_point_has_the_facts_of_its_own_run(name, points):
    found = simulate_many(name, points)
    assert len(found) == len(next(iter(points.values())))
    for place in range(0, len(found), 5):
        alone = sandbox.simulate(sandbox.load(name, {key: float(values[place]) for key, values in points.items()}))
        for fact, column in found.facts.items():
            value = plain(column[place])
            if isinstance(alone.result[fact], float):
                assert value == pytest.approx(alone.result[fact], rel=1e-7, abs=1e-7), fact
            else:
                assert value == alone.result[fact], fact


def test_points_are_computed_in_order_and_always_alike():
    found = simulate_many("basketball", THROWS, facts=("made", "apex"))
    assert list(found.facts) == ["made", "apex"]
    assert [found["made"].dtype, found["apex"].dtype] == [bool, float]
    assert found["apex"].tolist() == simulate_many("basketball", THROWS, facts=("apex",))["apex"].tolist()
    backwards = simulate_many("basketball", {key: values[::-1] for key, values in THROWS.items()}, facts=("apex",))
    assert backwards["apex"][::-1] == pytest.approx(found["apex"], abs=1e-9)
    assert np.ptp(found["apex"]) > 0.5
    assert found.points["launch.speed"].tolist() == THROWS["launch.speed"].tolist()


def test_a_shot_alone_has_the_same_numbers_as_among_thousands():
    speeds = np.linspace(7.0, 8.0, 3000)
    found = simulate_many("basketball", {"launch.speed": speeds}, facts=("entry_angle",))
    (alone,) = simulate_many("basketball", {"launch.speed": speeds[-1:]}, facts=("entry_angle",))["entry_angle"]
    assert found["entry_angle"][-1] == pytest.approx(alone, abs=1e-9)


def test_kept_runs_are_whole():
    found = simulate_many("basketball", THROWS, facts=("apex",), paths=True)
    alone = sandbox.simulate(sandbox.load("basketball", {key: float(values[7]) for key, values in THROWS.items()}))
    run = found.runs[7]
    assert run is not None
    assert run.duration == pytest.approx(alone.duration, abs=1e-9)
    assert run.state("ball", 0.5) == pytest.approx(alone.state("ball", 0.5), abs=1e-9)
    assert run.result.keys() == alone.result.keys()
    assert simulate_many("basketball", THROWS, facts=("apex",)).runs == []


def test_words_units_and_switches_may_be_points():
    points = {"launch.speed": ["7 m/s", 7.4, "25 km/h"], "ball.drag.model": ["none", "constant", "none"]}
    found = simulate_many("basketball", {**points, "net.slows": [True, False, True]})
    assert found.points["launch.speed"] == pytest.approx([7.0, 7.4, 25 / 3.6])
    assert found.points["ball.drag.model"].tolist() == points["ball.drag.model"]
    assert found.points["net.slows"].tolist() == [True, False, True]


def test_a_point_that_fails_is_nan_or_none_with_its_error():
    found = simulate_many("basketball", {"backboard.top": [3.95, 2.0, 3.9]}, facts=("made", "apex"), paths=True)
    assert found.errors == {1: "backboard.top = 2 m is not above backboard.bottom = 2.9 m: swap them"}
    assert [np.isnan(value) for value in found["apex"]] == [False, True, False]
    assert found["made"].tolist() == [True, None, True]
    assert [run is None for run in found.runs] == [False, True, False]
    assert "3 points over backboard.top, 1 failed" in repr(found)


@pytest.mark.parametrize(
    ("points", "told"),
    [
        ({"launch.sped": [7.0]}, "launch.sped: unknown key; did you mean launch.speed?"),
        ({"launch.speed": [7.0, 8.0], "launch.angle": [50.0]}, "launch.angle has 1 values, but launch.speed has 2"),
        ({"launch.speed": [7.0, 8.0, -1.0, 9.0]}, "point 2, launch.speed = -1.0: must be from 0 to 340 m/s"),
        ({"launch.speed": np.array([7.0, 1e4, 9.0])}, "point 1, launch.speed = 10000.0: must be from 0 to 340 m/s"),
        ({"launch.speed": np.array([7.0, 8.0, np.nan, 9.0])}, "point 2, launch.speed = nan: must be a finite number"),
        ({"launch.speed": [7.0, 8.0, np.inf]}, "point 2, launch.speed = inf: must be a finite number"),
        ({"launch.speed": [7.0, "9 kg"]}, "point 1, launch.speed = \"9 kg\": kg is a unit of mass"),
        ({"ball.drag.model": ["none", "nine"]}, 'point 1, ball.drag.model = "nine": must be'),
        ({"launch.speed": np.ones((2, 3))}, "launch.speed: an array of shape (2, 3); its shape must be (points,)"),
        ({"launch.speed": 7.0}, "launch.speed = 7.0: must be an array or a list"),
        ({"launch.speed": []}, "launch.speed: no values"),
        ({}, "nothing to sweep over"),
        ([7.0], "points = [7.0]: must be a dictionary"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_the_points_is_told_in_a_line(points, told):
    with pytest.raises(RequestError) as refused:
        simulate_many("basketball", points)
    assert told in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_fact_that_is_unknown_or_was_not_asked_for_is_told():
    with pytest.raises(RequestError, match=r"'entry_angel': no such result; did you mean entry_angle\?"):
        simulate_many("basketball", THROWS, facts=("entry_angel",))
    with pytest.raises(RequestError, match=r'must be a tuple of names; write \("made",\)'):
        simulate_many("basketball", THROWS, facts="made")
    with pytest.raises(RequestError, match=r"'aex': no such result; did you mean apex\?"):
        simulate_many("basketball", THROWS, facts=("apex",))["aex"]
