"""The hall from the side, made of parts. Poster, frames, comparisons and the window's view come from SideView."""

from __future__ import annotations

from functools import cached_property

from sandbox.kit import Ground, Hall, Look, Person, Place, SideView, seams

from .scene import Parameters


class Picture(SideView[Parameters]):
    LOOK = Look((255, 200, 50), seams((38, 84, 160)))

    @cached_property
    def place(self) -> Place:
        """The hall, the ground, and the things on it, the farthest first; x along the plane of play, in m."""
        fan, tall = self.parameters.fan, max(0.8, self.parameters.launch.height)  # m; the pose holds the ball there
        grille = [
            (fan.place + x, z) for x, z in ((-fan.width, 0.0), (fan.width, 0.0), (fan.width, 1.0), (-fan.width, 1.0))
        ]
        return Place(Hall(), Ground(areas=[(grille, (40, 52, 60))]), [Person(-0.15 * tall, tall, pose="shooting")])
