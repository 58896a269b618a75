"""What soccer from the side and from above have in common: the ball, the wall of players, and the goal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from sandbox.engine.run import Run
from sandbox.engine.setup import Segment, Surface, Vector
from sandbox.parameters import quantity, switch
from sandbox.physics.coefficients import SOCCER_DRAG, SOCCER_LIFT
from sandbox.physics.integrators import State
from sandbox.sport.controls import Spread
from sandbox.sport.flight import Sphere
from sandbox.sport.solids import Solid

SPREAD = (Spread("launch.speed", 0.02), Spread("launch.angle", least=1.0), Spread("launch.spin", 0.1))  # assumed


class SoccerBall(Sphere, drag=SOCCER_DRAG, lift=SOCCER_LIFT):
    """The soccer ball, a hollow sphere."""


class Wall(Solid):
    """The wall of players."""

    present: bool = switch(..., "whether there is a wall of players")
    distance: float = quantity(..., "m", 0, 2000, "from the ball straight to the middle of the wall")
    thickness: float = quantity(..., "m", 0.01, 5, "how deep a player is")

    @property
    def sides(self) -> Vector:
        """Its front and its back, in m from the ball."""
        return self.distance - 0.5 * self.thickness, self.distance + 0.5 * self.thickness


class Goal(Solid):
    """The goal: bar, posts and net."""

    distance: float = quantity(..., "m", 0, 2000, "from the ball straight to the middle of the goal line's width")
    post_radius: float = quantity(..., "m", 0.001, 1, "radius of bar and posts; the goal line is as wide")
    depth: float = quantity(..., "m", 0.5, 10, "from the goal line to the back of the net, a box")
    net_restitution: float = quantity(..., "", 0, 1, "of ball and net")
    net_friction: float = quantity(..., "", 0, 10, "of ball and net")

    def net(self, corners: Sequence[Vector]) -> list[Surface]:
        """The net along a line through the corners, in m."""
        return [Surface("net", Segment(*ends), self.net_restitution, self.net_friction) for ends in pairwise(corners)]

    def over_line(self, radius: float) -> float:
        """Where in m a ball of that radius is, the whole of which is over the whole of the line, as in the Laws."""
        return self.distance + self.post_radius + radius

    def entries(self, run: Run, radius: float) -> Iterator[tuple[float, State]]:
        """Each time and state at which the ball comes there."""
        return run.crossings("ball", (self.over_line(radius), 0.0), (-1.0, 0.0))
