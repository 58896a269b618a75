"""A shooting range from the side, with the line of sight dashed, and how far below it the bullet is."""

from __future__ import annotations

from functools import cached_property
from math import ceil, floor, log10

import numpy as np

from sandbox.picture.ball import Look
from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.palette import scene_colours
from sandbox.picture.places import Ground, Landscape, Post, Stripes
from sandbox.picture.sheet import ROWS_FOR_LENGTHS, YARD, Entry, Sheet
from sandbox.picture.side import Place, SideView
from sandbox.sport.amounts import amount

from .scene import Parameters, table

COLOURS = scene_colours(__file__)
GROUND = COLOURS["ground"]
GRASS = 0.25  # of the heights that are seen, below the lowest that matters
DASH = 0.012  # of the range


class Picture(SideView[Parameters]):
    LOOK = Look(COLOURS["ball"], gloss=0.45)
    TRACE, EARLIER = COLOURS["trace"], COLOURS["earlier"]
    LENGTHS, HEADROOM, FROM, LEVEL, LEAST_PATH = 0, 92, "from the muzzle", 60, 0.0

    @property
    def on_dark(self) -> bool:
        return False

    @cached_property
    def target(self) -> Box:
        far, (low, high) = self.parameters.range.distance, self._heights
        return Box(-0.02 * far, low - GRASS * (high - low), 1.02 * far, high)

    @cached_property
    def _heights(self) -> tuple[float, float]:
        """From the lowest to the highest of paths, line of sight and barrel, in m; at least 2 cm."""
        heights = self.points[:, 1]
        low = min(float(heights.min()), -self.parameters.sight.height)
        return low, max(float(heights.max()), 0.0, low + 0.02)

    def ground(self, x: np.ndarray) -> np.ndarray:
        return np.zeros_like(x) + self.target.bottom

    def fitted(self, area: Area) -> Camera:
        """Heights as much larger than lengths as there is room, a number with one digit or half a one."""
        box = self.subject
        lengths = (area.right - area.left) / (box.right - box.left)
        most = (area.bottom - area.top) / (box.top - box.bottom) / lengths
        step = 0.5 * 10.0 ** floor(log10(most))
        return Camera.fit(box, area, max(1.0, step * floor(most / step)))

    def view(self, t: float) -> Camera:
        return self.camera

    def position(self, t: float) -> list[Entry]:
        return [("over sight line", amount(self.run.state(self.ball, t)[1], "m"))]

    def spots(self, camera: Camera, points: np.ndarray, radius: float) -> np.ndarray:
        """Where they are, for what counts is how far from the line of sight that is."""
        return camera.pixels(points)

    @cached_property
    def place(self) -> Place:
        far = self.parameters.range.distance
        starts = far * np.arange(-0.05, 1.0, 2.0 * DASH)
        sight = [Post([(x, 0.0, 0.0), (x + DASH * far, 0.0, 0.0)], 0.0, GROUND["sight"]) for x in starts]
        face = Post([(far, self.target.bottom, 0.0), (far, 0.0, 0.0)], 0.0, GROUND["target"])
        ground = Ground(Stripes(GROUND["grass"], 60.0), GROUND["soil"], edges=[(GROUND["edge"], 5)])
        return Place(Landscape(**COLOURS["landscape"]), ground, [face, *sight])

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The line of sight's name and height and speed every hundred yards, or so often as there is room."""
        if sheet.rows < ROWS_FOR_LENGTHS:
            return
        tall, top = sheet.lettering.height("small"), self.area.top - 2.0 * sheet.gap
        line = camera.pixel(0.0, 0.0)[1]
        sheet.write("line of sight", "small", (sheet.frame.left, line - sheet.gap), sheet.ink, "bottomleft")
        rows = table(self.run, self.parameters)[1:]
        room = sheet.lettering.width("−000.0 cm", "small", bold=True) + 2.0 * sheet.gap
        every = ceil(room / (100.0 * YARD * camera.scale))
        for row in rows[every - 1 :: every]:
            (x, at), drop = camera.pixel(row["range"], row["height"]), amount(row["height"], "m")
            sheet.painter.line([(x, top), (x, max(at, line))], sheet.unit, sheet.quiet_ink, 0.5)
            words = f"{row['range'] / YARD:.0f} yd", drop, f"{row['speed']:.0f} m/s"
            for i, text in enumerate(words):
                bold, ink = i == 1, sheet.ink if i == 1 else sheet.quiet_ink
                sheet.write(text, "small", (x, top - (2 - i) * tall), ink, "midbottom", bold)
