"""The air as a scene describes it."""

from __future__ import annotations

import pytest

import sandbox
from sandbox.parameters import quantity
from sandbox.physics.air import Gusts, LogWind, moist_density
from sandbox.sport.air import OutdoorAir, Weather, wind_in


class Gusty(Weather):
    """Weather with a parameter of its own."""

    gusts: float = quantity(0.0, "m/s", 0, 50, "speed of gusts")


def test_weather_gives_the_density_and_keeps_all_else():
    weather = {"temperature": 20.0, "pressure": 1013.25, "humidity": 0.5, "elevation": 300.0}
    gusty = Gusty(wind=(3.0, 1.0), gusts=4.0, **weather)
    assert gusty.air == gusty.model_copy(update={"density": moist_density(293.15, 101325.0, 0.5, 300.0)})
    assert gusty.model_copy(update={"density": 1.0}).air.density == 1.0


OUTDOORS = {"density": 1.19, "viscosity": 1.8e-5, "wind": (3.0, 1.0), "profile": "uniform", "reference_height": 10.0,
            "roughness": 0.03}  # fmt: skip


def test_temperature_or_elevation_stand_for_the_density():
    """Dry air of 20 C at the sea has 1.204 kg/m^3, and half of it at 8,217 m ln 2."""
    assert OutdoorAir(**OUTDOORS).air.density == 1.19
    assert OutdoorAir(**OUTDOORS, elevation=0.0).air.density == pytest.approx(1.204, abs=1e-4)
    assert OutdoorAir(**OUTDOORS, elevation=5695.6).air.density == pytest.approx(0.602, abs=1e-4)
    assert OutdoorAir(**OUTDOORS, temperature=5.0).air.density == pytest.approx(1.204 * 293.15 / 278.15, abs=1e-4)


def test_gusts_are_on_the_wind_of_the_profile():
    air = OutdoorAir(**OUTDOORS | {"profile": "log"}, gusts=1.5, gust_seed=2)
    assert wind_in(air) == Gusts(LogWind((3.0, 1.0), 10.0, 0.03), 1.5, 10.0, 2)


def test_a_batch_of_shots_in_gusts_is_each_of_them_alone():
    scene = sandbox.load("golf", {"air.gusts": 1.5})
    found = sandbox.simulate_many(scene, {"air.gust_seed": [1, 2]}, facts=("carry",))["carry"].tolist()
    alone = [sandbox.simulate(scene.changed({"air.gust_seed": seed})).result["carry"] for seed in (1, 2)]
    assert found == pytest.approx(alone, rel=1e-9)
    assert abs(found[1] - found[0]) > 0.1
