"""Keepers who dive: they see where the ball goes, need some time to react, and go there at an even speed.

Valid for the way along the goal line only. Left out: how a dive begins and ends, how high it goes, and what is guessed
from the shooter before the ball moves. Who dives is a surface that is driven, and gives way to nothing.
"""

from __future__ import annotations

from collections.abc import Sequence

from sandbox.engine.model.motion import Sliding
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Circle, Moving, Surface
from sandbox.parameters import Group, quantity, switch


class Dive(Group):
    """The dive of a keeper."""

    dives: bool = switch(..., "whether he goes where he sees the ball go; otherwise he does as he is told")
    reaction: float = quantity(..., "s", 0, 5, "from the shot until he moves")
    speed: float = quantity(..., "m/s", 0.01, 30, "along the goal line")
    reach: float = quantity(..., "m", 0, 20, "how far he goes at most")

    def aside(self, stand: Vector, ball: Vector, velocity: Vector, low: float, high: float) -> float:
        """Return how far in m he goes, along y, from where he stands: to where a ball that is seen to have this place
        and velocity (m, m/s) comes past him, if it went straight; no farther than from ``low`` to ``high`` (m)."""
        away = stand[0] - ball[0]
        if velocity[0] <= 0.0 or away <= 0.0:
            return 0.0
        wanted = min(max(ball[1] + away * velocity[1] / velocity[0], low), high) - stand[1]
        return min(max(wanted, -self.reach), self.reach)

    def diving(self, surface: Surface, aside: float) -> Surface:
        """He as a surface, from where he stands so far (m) along y."""
        if aside == 0.0:
            return surface
        velocity = self.speed if aside > 0.0 else -self.speed
        stops = self.reaction + aside / velocity
        return Moving(surface, Sliding([(self.reaction, (0.0, velocity)), (stops, (0.0, 0.0))]))


def place_of(surfaces: Sequence[Surface], name: str, t: float) -> Vector | None:
    """Return the middle in m of the round surface of this name at time t in s; None if there is none."""
    shape = next((surface.at(t).shape for surface in surfaces if surface.name == name), None)
    return shape.center if isinstance(shape, Circle) else None
