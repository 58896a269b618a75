"""A golf ball that is putted, seen from above: the stroke, the ball, and the putt after it."""

from __future__ import annotations

from typing import Any

from sandbox.engine.model.setup import Ball
from sandbox.engine.paths.run import Run
from sandbox.parameters import Group, quantity
from sandbox.sport.flight import Directed

PERCENT = 0.01


class Putt(Directed):
    """The ball as it leaves the putter."""

    speed: float = quantity(..., "m/s", 0, 20, "ball speed")
    angle: float = quantity(..., "deg", -180, 180, "direction, counter-clockwise from along the lane or green")
    roll: float = quantity(..., "", -1, 1, "share of its roll that the ball has at once; 1 does not slide at all")


class GolfBall(Group):
    """The ball, a solid sphere, and where it lies."""

    mass: float = quantity(..., "kg", 0.005, 1, "mass")
    radius: float = quantity(..., "m", 0.005, 0.1, "radius")
    x: float = quantity(..., "m", -25, 25, "where it lies, along the lane or green")
    y: float = quantity(..., "m", -10, 10, "where it lies, to the left")

    def putted(self, putt: Putt) -> Ball:
        """The ball just after the stroke."""
        vx, vy = putt.velocity
        roll = (-putt.roll * vy / self.radius, putt.roll * vx / self.radius)  # rad/s, about x and about y
        return Ball("ball", self.mass, self.radius, (self.x, self.y), (vx, vy), rolling_spin=roll)


def holed(run: Run, parameters: Any) -> bool:
    """True if the ball is in the hole."""
    return run.caught_at("ball") is not None


def next_putt(run: Run, parameters: Any) -> dict[str, Any]:
    """The next putt, from where the ball stopped; from the same place as the first if it is in the hole."""
    if holed(run, parameters):
        return {"putt": 1}
    x, y = run.state("ball", run.duration)[:2]
    return {"ball.x": x, "ball.y": y, "putt": parameters.putt + 1}
