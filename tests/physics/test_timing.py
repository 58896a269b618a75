"""Which forces depend on time: by what they say, or by their code."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import inf
from typing import Any, ClassVar

import pytest

from sandbox import Ball, Drag, Gravity, LogWind, Magnus, SpinDecay, UniformWind
from sandbox.physics.rocket import Motor, Thrust
from sandbox.physics.timing import STEADY, TIME_SCALE, Timing


def timing(*forces: Any, **more: Any) -> Timing:
    return Ball("ball", mass=1.0, radius=0.1, position=(0.0, 0.0), forces=forces, **more).timing


def breeze(t, position):
    return 3.0, 0.0


def gusts(t, position):
    return 3.0 * (t > 1.0), 0.0


class Fan:
    def __init__(self, power: float) -> None:
        self.power = power

    def __call__(self, t, position, velocity, spin):
        return self.power, 0.0

    def late(self, t, position, velocity, spin):
        return self.power * t, 0.0

    @staticmethod
    def later(more, t, position, velocity, spin):
        return more * t, 0.0


@dataclass(frozen=True)
class Half:
    """Half of another force."""

    timed: ClassVar = ("force",)
    force: Any

    def __call__(self, t, position, velocity, spin):
        fx, fy = self.force(t, position, velocity, spin)
        return 0.5 * fx, 0.5 * fy


class Gusty(Drag):
    def __call__(self, t, position, velocity, spin):
        return (t % 1.0, 0.0)


def inside(t, position, velocity, spin):
    return tuple(t * each for each in velocity)


@pytest.mark.parametrize(
    "force",
    [
        Gravity(9.81),
        Drag(wind=UniformWind(1.0, 0.0)),
        Magnus(wind=LogWind((3.0, 0.0), 10.0, 0.03)),
        Drag(wind=breeze),
        Fan(2.0),
        Half(Drag(wind=breeze)),
        lambda t, position, velocity, spin: (position[0], 0.0),
        partial(lambda power, t, position, velocity, spin: (power, 0.0), 2.0),
    ],
)
def test_what_does_not_depend_on_time(force):
    assert timing(Gravity(9.81), force) == STEADY


@pytest.mark.parametrize(
    "force",
    [
        Drag(wind=gusts),
        Fan(2.0).late,
        Half(Drag(wind=gusts)),
        lambda t, position, velocity, spin: (t, 0.0),
        lambda *arguments: (0.0, 0.0),
        partial(Fan.later, 2.0),
        Gusty(),
        inside,
        min,
    ],
)
def test_what_uses_time(force):
    assert timing(Gravity(9.81), force) == (True, TIME_SCALE, ())


def test_a_force_may_say_so_itself():
    def push(t, position, velocity, spin):
        return 1.0 * (0.4 <= t < 0.5), 0.0

    push.discontinuities = (0.4, 0.5)
    assert timing(push, Gravity(9.81)) == (True, TIME_SCALE, (0.4, 0.5))
    push.time_scale = 0.2
    assert timing(push) == (True, 0.2, (0.4, 0.5))
    assert timing(push, inside) == (True, TIME_SCALE, (0.4, 0.5))
    push.depends_on_time = False
    assert timing(push) == STEADY


def test_torques_and_lost_mass_count():
    motor = Motor((0.0, 0.5, 1.0), (0.0, 5.0, 0.0), 0.1)
    assert timing(torques=[SpinDecay(wind=gusts)]).depends
    assert timing(Gravity(9.81), loss=motor) == (True, inf, 2 * (0.0, 0.5, 1.0))
    assert timing(Thrust(motor, (0.0, 0.0), (0.0, 1.0), 1.0)) == (True, inf, (0.0, 0.5, 1.0))


@pytest.mark.parametrize(("name", "value"), [("time_scale", 0.0), ("time_scale", "1"), ("discontinuities", ["1"])])
def test_times_must_be_times(name, value):
    def push(t, position, velocity, spin):
        return t, 0.0

    setattr(push, name, value)
    with pytest.raises(ValueError, match=f"push[^=]*: {name} = [^=]*in s"):
        timing(push)


def test_the_fields_that_are_timed_are_a_tuple():
    class Push:
        timed = "wind"

    with pytest.raises(ValueError, match=r"Push: timed = 'wind' must be a tuple: \('wind',\)"):
        timing(Push())
