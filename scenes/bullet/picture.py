"""A shooting range from the side, with the line of sight dashed, and how far below it the bullet is."""

from __future__ import annotations

from functools import cached_property
from math import ceil, inf

import numpy as np

from sandbox.picture.palette import scene_colours
from sandbox.picture.places import Landscape, Post, turf
from sandbox.picture.sheet import ROWS_FOR_LENGTHS, YARD
from sandbox.picture.views import Box, Camera, Entry, Look, Place, Sheet, SideView
from sandbox.sport.amounts import amount

from .scene import Parameters, table

COLOURS = scene_colours(__file__)
GROUND = COLOURS["ground"]
GRASS, DASH = 0.25, 0.012  # room below, as a share of the heights that are seen; a dash, as a share of the range


class Picture(SideView[Parameters]):
    LOOK, THING = Look(COLOURS["ball"], gloss=0.45), "bullet"
    TRACE, EARLIER, ON_DARK = COLOURS["trace"], COLOURS["earlier"], False
    LENGTHS, HEADROOM, FROM, LEVEL, LEAST_PATH, STRETCHES = 0, 92, "from the muzzle", 60, 0.0, inf

    @cached_property
    def target(self) -> Box:
        far, heights = self.parameters.range.distance, [*self.points[:, 1], 0.0, -0.02]
        low, high = float(min(heights)), float(max(heights))
        return Box(-0.02 * far, low - GRASS * (high - low), 1.02 * far, high)

    def ground(self, x: np.ndarray) -> np.ndarray:
        return np.zeros_like(x) + self.target.bottom

    def position(self, t: float) -> list[Entry]:
        return [("over sight line", amount(self.run.state(self.ball, t)[1], "m"))]

    @cached_property
    def place(self) -> Place:
        far = self.parameters.range.distance
        starts = far * np.arange(-0.05, 1.0, 2.0 * DASH)
        sight = [Post([(x, 0.0, 0.0), (x + DASH * far, 0.0, 0.0)], 0.0, GROUND["sight"]) for x in starts]
        face = Post([(far, self.target.bottom, 0.0), (far, 0.0, 0.0)], 0.0, GROUND["target"])
        ground = turf(GROUND, 60.0)
        return Place(Landscape(**COLOURS["landscape"]), ground, [face, *sight])

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The line of sight's name and height and speed every hundred yards, or so often as there is room."""
        if sheet.rows < ROWS_FOR_LENGTHS:
            return
        tall, top = sheet.lettering.height("small"), round(self.area.top - 2.0 * sheet.gap)
        line = camera.pixel(0.0, 0.0)[1]
        spots = ((line - 2 * sheet.gap, "bottomleft"), (line + 2 * sheet.gap, "topleft"))
        sheet.label("sight line", "small", [(sheet.frame.left, *spot) for spot in spots], sheet.ink)
        room = sheet.lettering.width("−000.0 cm", "small", bold=True) + 2.0 * sheet.gap
        every = ceil(room / (100.0 * YARD * camera.scale))
        for row in table(self.run, self.parameters)[every::every]:
            (x, at), drop = camera.pixel(row["range"], row["height"]), amount(row["height"], "m")
            sheet.painter.line([(x, top), (x, max(at, line))], sheet.unit, sheet.quiet_ink, 0.5)
            sheet.write(f"{row['range'] / YARD:.0f} yd", "small", (x, top - 2 * tall), sheet.quiet_ink, "midbottom")
            sheet.write(drop, "small", (x, top - tall), sheet.ink, "midbottom", bold=True)
            sheet.write(f"{row['speed']:.0f} m/s", "small", (x, top), sheet.quiet_ink, "midbottom")
