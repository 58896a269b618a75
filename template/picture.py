"""The hall from the side: a place made of parts, and one drawing of its own, the fan's air.

Poster, frames, comparisons and the window's view come from SideView; its options are listed at the top of view.py and
side.py in sandbox/picture.
"""

from __future__ import annotations

from functools import cached_property

from sandbox.picture.ball import Look, seams
from sandbox.picture.camera import Box, Camera
from sandbox.picture.figures import SHOOTING
from sandbox.picture.painter import Painter
from sandbox.picture.places import Ground, Hall, Person, Planks
from sandbox.picture.side import Length, Place, SideView
from sandbox.sport.amounts import metres

from .scene import Parameters

HALL = Hall(wall=((34, 62, 78), (74, 112, 126)), light=(110, 150, 160), crowd=(), padding=(52, 92, 108))
FLOOR, BENEATH = Planks(((190, 140, 92), (214, 166, 112), (198, 148, 98))), ((58, 42, 36), (40, 30, 28), (26, 20, 20))
PERSON = {"body": (150, 166, 170), "far": (116, 134, 140), "shirt": (236, 196, 92), "shorts": (84, 104, 112)}
MAT, AIR = (38, 139, 120), (160, 214, 232)


class Picture(SideView[Parameters]):
    """One toss."""

    LOOK = Look((255, 200, 50), seams((38, 84, 160)))

    @property
    def company(self) -> Box:
        return Box(-0.8, 0.0, 0.0, 2.0)

    @property
    def target(self) -> Box:
        floor = self.parameters.floor
        return Box(floor.mat - floor.mat_length / 2, 0.0, floor.mat + floor.mat_length / 2, 0.0)

    @cached_property
    def place(self) -> Place:
        left, _, right, _ = self.target
        mat = [(left, 0.0), (right, 0.0), (right, 1.5), (left, 1.5)]
        tall = max(0.8, self.parameters.launch.height)  # m; the pose holds the ball at its own height
        ground = Ground(FLOOR, BENEATH, edges=[((120, 82, 52), 6)], areas=[(mat, MAT)])
        return Place(HALL, ground, [Person(-0.15 * tall, tall, PERSON, SHOOTING)])

    def lengths(self) -> list[Length]:
        mat = self.parameters.floor.mat
        return [Length(f"mat {metres(mat)}", 0.0, mat)]

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """The fan's air, in streaks that rise and spread."""
        fan = self.parameters.fan
        for i in range(40):
            side, age = i * 0.7549 % 1 * 2 - 1, (i * 0.5698 + 0.5 * t) % 1  # these two numbers scatter evenly
            x, y = camera.pixel(fan.place + side * fan.width * (0.7 + 0.6 * age), 3.2 * age)
            painter.fading([(x, y), (x, y - min(12 * fan.push, 90) * self.unit)], 5 * self.unit, AIR, 1 - age)
