"""The picture of a scene that has none of its own: surfaces, balls and their paths, as the setup has them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from sandbox.engine.run import Run
from sandbox.engine.setup import Circle
from sandbox.parameters import Group
from sandbox.picture.ball import Look, seams
from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.painter import Painter, from_colours
from sandbox.picture.palette import palette
from sandbox.picture.sheet import Sheet
from sandbox.picture.view import NEAR, View

COLOURS, TRACES = palette("plain"), palette("trace")["colours"]
#: Of a ball alone, and of several, each in the colour of its path.
ALONE, *SEVERAL = (Look(colour, seams(COLOURS["marks"])) for colour in (COLOURS["ball"], *TRACES))

#: The place shown goes so far beyond what is in it, as a share.
BEYOND = 0.06


class Picture(View[Group]):
    """One run, seen by a camera that stands still."""

    LEAST_IMPACT = np.inf  # in a heap, marks would hide the balls

    @property
    def on_dark(self) -> bool:
        return False

    @cached_property
    def camera(self) -> Camera:
        """Shows all paths, and the surfaces that do not reach far beyond them."""
        (low, high), radius = self.surroundings, max(self.radii.values())
        more = BEYOND * (high - low) + 0.5 * np.maximum(0.0, NEAR * radius - (high - low))
        (left, bottom), (right, top) = low - more, high + more
        side, bottom_row = 0.07 * self.size[0], self.card_row - 89 * self.unit
        area = Area(side, 150 * self.unit, self.size[0] - side, bottom_row)
        return Camera.fit(Box(left, bottom, right, top), area)

    def look_of(self, name: str) -> Look:
        return ALONE if len(self.balls) == 1 else SEVERAL[self.balls.index(name) % len(SEVERAL)]

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """A light ground, and every surface as a line or a disc."""
        top, foot = np.array(COLOURS["ground"], float)
        ground = np.broadcast_to(np.linspace(top, foot, self.size[1]), (*self.size, 3))
        painter.surface.blit(from_colours(ground), (0, 0))
        for shape in (surface.shape for surface in self.run.setup.surfaces):
            thick = max(shape.radius * camera.scale, 1.5 * self.unit)
            if isinstance(shape, Circle):
                painter.disc(camera.pixel(*shape.center), thick, COLOURS["surface"])
                continue
            seen = clipped(camera.pixel(*shape.a), camera.pixel(*shape.b), self.size)
            if seen is not None:
                painter.line(seen, 2 * thick, COLOURS["surface"])

    def scale(self, sheet: Sheet, camera: Camera) -> None:
        sheet.scale_bar(camera, sheet.frame.left, self.card_row - 28 * self.unit, 0.2 * self.size[0])


def view_of(run: Run, size: tuple[int, int], ghosts: Mapping[str, Run] | None = None) -> View[Any]:
    """The scene's picture of a run; a plain one where its own draws posters and frames only."""
    picture = run.scene.picture(run, size, ghosts)
    return picture if isinstance(picture, View) else Picture(run, run.scene.parameters, size, ghosts)


def clipped(
    a: tuple[float, float], b: tuple[float, float], size: tuple[int, int], edge: float = 50.0
) -> list[tuple[float, float]] | None:
    """The part of a line that is on a picture of ``size`` px, or no more than ``edge`` px outside; None if none is."""
    first, last = 0.0, 1.0
    for start, end, most in zip(a, b, size, strict=True):
        for along, room in ((start - end, start + edge), (end - start, most + edge - start)):
            if along == 0.0:
                if room < 0.0:
                    return None
            elif along > 0.0:
                last = min(last, room / along)
            else:
                first = max(first, room / along)
    if first >= last:
        return None
    return [(a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1])) for u in (first, last)]
