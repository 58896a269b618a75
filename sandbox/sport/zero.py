"""Sights: their height, and the angle at which what is fired meets the line of sight."""

from __future__ import annotations

from collections.abc import Callable

from sandbox.engine import simulate
from sandbox.engine.accuracy import LEVELS
from sandbox.engine.setup import Setup
from sandbox.errors import RequestError
from sandbox.parameters import Group, quantity

#: Nearer than this (m) is on the line; so many secants find it if there is one.
MET, SECANTS = 1e-9, 20


class Zero(Group):
    """The distance at which the bullet crosses the line of sight on its way down."""

    distance: float = quantity(..., "m", 0, 2000, "0: launch.angle counts instead")


class Sight(Group):
    """The sight."""

    height: float = quantity(..., "m", 0, 0.5, "above the barrel")


def zeroed(zero: Zero, fired_at: Callable[[float], Setup]) -> float:
    """The angle in rad at which the first ball ends at height 0, near the horizontal.

    ``fired_at(angle)`` is a run that its own condition ends, at the distance of the zero. Raises RequestError if
    the ball does not get there.
    """

    def height(angle: float) -> float | None:
        setup = fired_at(angle)
        run = simulate(setup, LEVELS["precise"])
        return run.state(setup.balls[0].name, run.duration)[1] if run.ended == "until" else None

    before, angle = 0.0, 1e-3
    miss = height(before)
    for _ in range(SECANTS):
        missed = height(angle)
        if missed is None or miss is None:
            break
        if abs(missed) < MET or missed == miss:
            return angle
        before, angle, miss = angle, angle - missed * (angle - before) / (missed - miss), missed
    raise RequestError(f"zero.distance = {zero.distance:g} m: the bullet does not get there")
