"""A ball on a plane that forces, or the plane's slope, press against straight sides of fixed surfaces, such as a puck
that wind blows along boards: it stays there until they no longer do, or the side ends.

The sides hold back what pushes the ball into them, and are smooth meanwhile: their friction is left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import inf

from sandbox.engine.contact.touch import SIDE, Near, Obstacle
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Surface
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.phase import ArcContact, Phase
from sandbox.physics.integrators import Acceleration, State
from sandbox.physics.plane import Applied, Plane
from sandbox.physics.slope import pull_of

#: Acceleration in m/s^2, or speed in m/s, into a side that is rounding; leaving speed over the slowest hop that is.
_INTO, _AT_MOST = 1e-9, 1.0 + 1e-9


@dataclass(frozen=True)
class Leaning(ArcContact):
    """Value of ``Arc.contact`` for a ball that leans on the straight sides of these obstacles, with their normals."""

    obstacles: Sequence[Obstacle]
    normals: Sequence[Vector]

    @classmethod
    def on(cls, near: Iterable[Near], state: State, acceleration: Vector, slowest: float) -> Leaning | None:
        """The sides that a ball in this state stays on: it leaves them no faster than the ``slowest`` hop (m/s), and
        its acceleration (m/s^2) presses it on them. None if there are none."""
        kept = [
            (obstacle, (touch.nx, touch.ny))
            for obstacle, touch in near
            if not obstacle.moves
            and obstacle.next_feature(touch, *state[:4]).feature == SIDE
            and state[2] * touch.nx + state[3] * touch.ny <= _AT_MOST * slowest
            and acceleration[0] * touch.nx + acceleration[1] * touch.ny < -_INTO
        ]
        return cls(*zip(*kept, strict=True)) if kept else None

    @property
    def obstacle(self) -> Obstacle:
        """The first of the obstacles."""
        return self.obstacles[0]

    @property
    def phase(self) -> Phase:
        return Phase.SLIDING

    @property
    def surface(self) -> Surface:
        return self.obstacles[0].surface

    def held_back(self, ax: float, ay: float) -> Vector:
        """Return what is left of a velocity or an acceleration into the sides: nothing in a corner."""
        for nx, ny in self.normals:
            into = min(0.0, ax * nx + ay * ny)
            ax, ay = ax - into * nx, ay - into * ny
        in_corner = any(ax * nx + ay * ny < -_INTO for nx, ny in self.normals)
        return (0.0, 0.0) if in_corner else (ax, ay)

    def applied(self, forces: Applied, plane: Plane) -> Applied:
        """The acceleration that the forces leave it, less what of the pull of a slope the sides hold back."""

        def applied(t: float, state: State) -> Acceleration:
            px, py, torque = forces(t, state)
            gx, gy = pull_of(plane, state[0], state[1])
            ax, ay = self.held_back(px + gx, py + gy)
            return ax - gx, ay - gy, torque

        return applied

    def projected(self, state: State) -> State:
        """The state without speed off the sides, or into them."""
        x, y, vx, vy, *spins = state
        for nx, ny in self.normals:
            off = vx * nx + vy * ny
            vx, vy = vx - off * nx, vy - off * ny
        return (x, y, *self.held_back(vx, vy), *spins)

    def longest(self, state: State) -> float:
        """Longest step in s that follows the sides."""
        return inf

    def edge(self, arc: Arc) -> float | None:
        """The time in s at which the ball reaches the end of a side, or None."""
        found = (obstacle.edge(SIDE, arc) for obstacle in self.obstacles)
        return min((arc.t0 + u * (arc.t1 - arc.t0) for u in found if u is not None), default=None)
