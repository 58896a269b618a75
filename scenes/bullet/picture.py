"""A shooting range from the side, over a slope that falls to the target; the line of sight is dashed."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from sandbox.picture.ball import Look, seams
from sandbox.picture.camera import Box
from sandbox.picture.palette import scene_colours
from sandbox.picture.places import Ground, Landscape, Post, Shape, Stripes
from sandbox.picture.side import Place, SideView

from .scene import Parameters

COLOURS = scene_colours(__file__)
GROUND = COLOURS["ground"]
PRONE, TARGET = 0.4, 1.5  # m: the muzzle above the slope, and half the target


class Picture(SideView[Parameters]):
    LOOK = Look(COLOURS["ball"]["colour"], seams(COLOURS["ball"]["mark"]))
    TRACE, EARLIER = COLOURS["trace"], COLOURS["earlier"]
    LENGTHS, STRETCHES, FROM, LEVEL, LEAST_PATH = 0, True, "from the muzzle", 110, 0.0

    @property
    def on_dark(self) -> bool:
        return False

    @property
    def target(self) -> Box:
        far = self.parameters.range.distance
        return Box(-0.02 * far, self._lowest, 1.02 * far, 0.03 * far)

    @cached_property
    def _lowest(self) -> float:
        return float(self.path.points[:, 1].min()) - 2.0 * TARGET

    def ground(self, x: np.ndarray) -> np.ndarray:
        return np.zeros_like(x) + self._lowest

    @cached_property
    def place(self) -> Place:
        far, low, high = self.parameters.range.distance, self._lowest, -self.parameters.sight.height - PRONE
        end = float(self.path.points[-1, 1])
        slope = Shape([(-far, low, 0.0), (-far, high, 0.0), (0.0, high, 0.0), (far, low, 0.0)], GROUND["slope"])
        starts = far * np.arange(0.0, 1.0, 0.025)
        dashes = [Post([(x, 0.0, 0.0), (x + 0.012 * far, 0.0, 0.0)], 0.0, GROUND["sight"]) for x in starts]
        board = Post([(far, end - TARGET, 0.0), (far, end + TARGET, 0.0)], 0.3, GROUND["target"])
        ground = Ground(Stripes(GROUND["grass"], 60.0), GROUND["soil"], edges=[(GROUND["edge"], 5)])
        return Place(Landscape(**COLOURS["landscape"]), ground, [slope, *dashes, board])
