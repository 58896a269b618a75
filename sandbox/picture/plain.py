"""The picture of a scene that has none of its own: surfaces, traps, balls and paths, as the setup has them."""

from __future__ import annotations

import numpy as np
import pygame

from sandbox.engine.model.surface import Circle
from sandbox.parameters import Group
from sandbox.picture.above import AboveView
from sandbox.picture.ball import Look, seams
from sandbox.picture.camera import Camera
from sandbox.picture.painter import Painter, gradient
from sandbox.picture.palette import palette
from sandbox.picture.view import View

COLOURS, TRACES = palette("plain"), palette("trace")["colours"]
#: The looks of several balls, each in the colour of its path.
SEVERAL = [Look(colour, seams(COLOURS["marks"])) for colour in TRACES]


class Picture(AboveView[Group]):
    """One run, seen by a camera that stands still."""

    MIN_IMPACT = np.inf  # in a heap, marks would hide the balls
    SPIN_NAMES = View.SPIN_NAMES
    ON_DARK = False

    def look_of(self, name: str) -> Look:
        return self.LOOK if len(self.balls) == 1 else SEVERAL[self.balls.index(name) % len(SEVERAL)]

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """A light ground, and as a line or a disc every surface and, paler, what takes balls."""
        painter.surface.blit(gradient(self.size, COLOURS["ground"]), (0, 0))
        near = pygame.FRect((0, 0), self.size).inflate(100, 100)
        setup = self.run.setup
        for shape, colour in (
            *((trap.shape, COLOURS["catch"]) for trap in setup.traps),
            *((surface.shape, COLOURS["surface"]) for surface in setup.surfaces),
        ):
            thick = max(shape.radius * camera.scale, 1.5 * self.unit)
            if isinstance(shape, Circle):
                painter.disc(camera.pixel(*shape.center), thick, colour)
            elif seen := near.clipline(camera.pixel(*shape.a), camera.pixel(*shape.b)):
                painter.line(seen, 2 * thick, colour)
