"""The air as a scene describes it."""

from __future__ import annotations

from sandbox.parameters import quantity
from sandbox.physics.air import moist_density
from sandbox.sport.air import Weather


class Gusty(Weather):
    """Weather with a parameter of its own."""

    gusts: float = quantity(0.0, "m/s", 0, 50, "speed of gusts")


def test_weather_gives_the_density_and_keeps_all_else():
    weather = {"temperature": 20.0, "pressure": 1013.25, "humidity": 0.5, "elevation": 300.0}
    gusty = Gusty(wind=(3.0, 1.0), gusts=4.0, **weather)
    assert gusty.air == gusty.model_copy(update={"density": moist_density(293.15, 101325.0, 0.5, 300.0)})
    assert gusty.model_copy(update={"density": 1.0}).air.density == 1.0
