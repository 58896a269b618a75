"""The lane from above: what it is made of. Balls, paths, marks, numbers, frames and comparisons come from the view."""

from __future__ import annotations

from functools import cached_property

from sandbox.kit import AboveView, Look, plan, seams, table

from .scene import Parameters

STONE, WOOD = ((58, 66, 70), (62, 71, 75)), ((158, 118, 82), (132, 94, 62), (98, 66, 42))
FELT, CHALK, CUP = ((56, 132, 92), (60, 138, 97)), (206, 226, 206), (12, 20, 16)


class Picture(AboveView[Parameters]):
    LOOK, TRACE = Look((250, 250, 246), seams((200, 90, 60))), (240, 176, 64)
    STANDS_UPRIGHT = True  # where a picture is taller than wide

    @cached_property
    def plan(self) -> plan.Plan:
        """The parts of the place, the lowest first."""
        lane, (cup,) = self.parameters.lane, self.run.setup.traps
        half, tee = (0.5 * lane.length, 0.5 * lane.width), self.run.state("ball", 0.0)[0]
        return (
            plan.Stripes(table.around((50.0, 50.0)), STONE, 0.5, along=True),
            table.Rails(half, (half[0] + 0.09, half[1] + 0.09), WOOD, WOOD[0]),
            plan.Stripes(table.around(half), FELT, 0.25),
            plan.Line(((tee, -0.15), (tee, 0.15)), 0.02, CHALK),
            plan.Spot(cup.center, cup.radius, CUP),
            plan.Line(((0.0, -0.5 * lane.block), (0.0, 0.5 * lane.block)), 0.08, WOOD[0]),
        )
