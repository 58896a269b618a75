"""What soccer from the side and from above have in common: the ball, the wall of players, and the goal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Literal

from sandbox.engine.run import Run
from sandbox.engine.setup import Segment, Surface, Vector
from sandbox.parameters import choice, either, quantity, switch
from sandbox.physics.coefficients import SOCCER_DRAG, SOCCER_LIFT
from sandbox.physics.integrators import State
from sandbox.sport.air import ConstantDrag, ConstantLift, Lift, Measured, NoDrag, NoLift, SpinRatioLift
from sandbox.sport.controls import Spread
from sandbox.sport.flight import Sphere
from sandbox.sport.solids import Solid

SPREAD = (Spread("launch.speed", 0.02), Spread("launch.angle", least=1.0), Spread("launch.spin", 0.1))  # assumed


class SoccerDrag(Measured):
    """Drag of a soccer ball by its source."""

    LAWS = SOCCER_DRAG
    model: Literal["goff-carre", "textbook"] = choice("goff-carre", "drag coefficient by its source")


class SoccerLift(Measured, Lift):
    """Magnus force on a soccer ball by its source."""

    LAWS = SOCCER_LIFT
    model: Literal["asai", "power-law"] = choice("asai", "lift coefficient by its source")


class SoccerBall(Sphere):
    """The soccer ball, a hollow sphere."""

    drag: SoccerDrag | ConstantDrag | NoDrag = either(..., "drag of the air")
    lift: SoccerLift | ConstantLift | SpinRatioLift | NoLift = either(..., "Magnus force")


class Wall(Solid):
    """The wall of players."""

    present: bool = switch(..., "whether there is a wall of players")
    distance: float = quantity(..., "m", 0, 2000, "from the ball straight to the middle of the wall")
    thickness: float = quantity(..., "m", 0.01, 5, "how deep a player is")


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

    def entries(self, run: Run, radius: float) -> Iterator[tuple[float, State]]:
        """Each time and state at which the whole of the ball is over the whole of the line, as in the Laws."""
        return run.crossings("ball", (self.distance + self.post_radius + radius, 0.0), (-1.0, 0.0))
