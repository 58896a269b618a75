"""Minigolf from above: boards, felt, the hole, and the posts of the windmills; what moves is drawn by the view."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from sandbox.kit import AboveView, Box, Look, plan, scene_colours, seams, table

from .scene import BOARD, Parameters

COLOURS = scene_colours(__file__)
#: Width in m of the boards around the lane, and radius of the post of a windmill.
FRAME, POST = 0.09, 0.04


class Picture(AboveView[Parameters]):
    LOOK, TRACE, OTHER_TRACES = Look(COLOURS["ball"], seams(COLOURS["seam"])), COLOURS["trace"], COLOURS["earlier"]
    DRIVEN, CAVEAT = COLOURS["driven"], "boards and blades not validated"

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (0.0, 0.0), "the middle of the lane"

    @property
    def aims(self) -> list[Box]:
        """The hole."""
        hole = self.parameters.hole
        return [Box(hole.x - hole.radius, hole.y - hole.radius, hole.x + hole.radius, hole.y + hole.radius)]

    @cached_property
    def seen(self) -> np.ndarray:
        """The whole lane with its boards."""
        half = np.array([0.5 * self.parameters.lane.length + FRAME, 0.5 * self.parameters.lane.width + FRAME])
        return np.array([-half, half])

    @cached_property
    def plan(self) -> plan.Plan:
        """The parts of the place, the lowest first."""
        it, lane, hole = self.parameters, self.parameters.lane, self.parameters.hole
        x, y = half = (0.5 * lane.length, 0.5 * lane.width)
        felt, (start, end) = it.felt, np.clip((it.felt.rough_start, it.felt.rough_end), -x, x).tolist()
        tee = it.ball.x, it.ball.y
        return (
            plan.Stripes(table.around((60.0, 60.0)), COLOURS["path"], 0.6, along=True),
            table.Rails(half, (x + FRAME, y + FRAME), COLOURS["wood"], COLOURS["wood"][0]),
            plan.Stripes(table.around(half), COLOURS["felt"], 0.3),
            *([plan.Ground(Box(start, -y, end, y), COLOURS["rough"])] if felt.rough_end > felt.rough_start else []),
            plan.Spot(tee, 2.2 * it.ball.radius, COLOURS["chalk"], 0.006),
            plan.Spot((hole.x, hole.y), hole.radius, COLOURS["rim"], 0.008),
            plan.Spot((hole.x, hole.y), hole.radius - 0.006, COLOURS["hole"]),
            *(plan.Line(((wall.x1, wall.y1), (wall.x2, wall.y2)), 2 * BOARD, COLOURS["board"]) for wall in it.walls),
            *(plan.Spot((mill.x, mill.y), POST, COLOURS["post"]) for mill in it.mills),
        )
