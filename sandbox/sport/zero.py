"""Sights: the angle at which what is fired meets the line of sight."""

from __future__ import annotations

from collections.abc import Callable

from sandbox.engine import simulate
from sandbox.engine.accuracy import LEVELS
from sandbox.engine.setup import Setup

#: Nearer than this (m) is on the line; so many secants find it if there is one.
MET, SECANTS = 1e-9, 20


def zeroed(fired_at: Callable[[float], Setup]) -> float | None:
    """The angle in rad at which the first ball ends at height 0, near the horizontal; None if it does not get there.

    ``fired_at(angle)`` is a run that its own condition ends, at the distance of the zero.
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
            return None
        if abs(missed) < MET or missed == miss:
            return angle
        before, angle, miss = angle, angle - missed * (angle - before) / (missed - miss), missed
    return None
