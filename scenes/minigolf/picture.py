"""Minigolf from above: boards, felt, the hole, and the posts of the windmills; what moves is drawn by the view."""

from __future__ import annotations

from functools import cached_property
from math import sin

import numpy as np

from sandbox.kit import (
    AboveView,
    Area,
    Box,
    Look,
    Relief,
    Story,
    mix,
    plan,
    scene_colours,
    seams,
    table,
)
from sandbox.sport.putting import PERCENT

from .scene import BOARD, Parameters

COLOURS = scene_colours(__file__)
#: Width in m of the boards around the lane, and radius of the post of a windmill.
FRAME, POST = 0.09, 0.04
#: So much of the lane is seen behind tee and hole, and behind where the ball turns round, in m.
AROUND = 0.65
#: Slabs lie so far around the lane, and the middle of a hedge is so far from it, in m.
PAVED, HEDGE = 0.32, 1.15
#: Shades of a ramp.
BANDS = 24


class Picture(AboveView[Parameters]):
    LOOK, TRACE, OTHER_TRACES = Look(COLOURS["ball"], seams(COLOURS["seam"])), COLOURS["trace"], COLOURS["earlier"]
    DRIVEN, CAVEAT, STANDS_UPRIGHT = COLOURS["driven"], "boards and blades not validated", True

    @property
    def area(self) -> Area:
        """As wide as the picture: the lane is long."""
        side = 0.03 * self.size[0]
        return super().area._replace(left=side, right=self.size[0] - side)

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (0.0, 0.0), "the middle of the lane"

    @property
    def aims(self) -> list[Box]:
        """The hole."""
        hole = self.parameters.hole
        return [Box(hole.x - hole.radius, hole.y - hole.radius, hole.x + hole.radius, hole.y + hole.radius)]

    @property
    def story(self) -> Story:
        """The hole, or where the ball ends up."""
        return self.meeting(*self.aims, share=0.22, spot=0.4)

    @cached_property
    def must_show(self) -> np.ndarray:
        """The lane with its boards, from behind the tee to behind the hole, and to where the ball goes."""
        it = self.parameters
        half = np.array([0.5 * it.lane.length + FRAME, 0.5 * it.lane.width + FRAME])
        along = [it.ball.x, it.hole.x, *self.points[:, 0]]
        (left, low), (right, high) = -half, half
        return np.array([(max(left, min(along) - AROUND), low), (min(right, max(along) + AROUND), high)])

    def position_of(self, name: str, t: float) -> tuple[float, float]:
        """A ball that the hole has caught lies in its middle."""
        hole = self.parameters.hole
        return (hole.x, hole.y) if t >= self.caught[name] else super().position_of(name, t)

    @cached_property
    def plan(self) -> plan.Plan:
        """The parts of the place, the lowest first."""
        it, lane, hole = self.parameters, self.parameters.lane, self.parameters.hole
        x, y = half = (0.5 * lane.length, 0.5 * lane.width)
        felt, (start, end) = it.felt, np.clip((it.felt.rough_start, it.felt.rough_end), -x, x).tolist()
        tee = it.ball.x, it.ball.y
        return (
            *_garden(half),
            table.Rails(half, (x + FRAME, y + FRAME), COLOURS["wood"], COLOURS["wood"][0]),
            _bed(it, table.around(half)),
            *([plan.Ground(Box(start, -y, end, y), COLOURS["rough"])] if felt.rough_end > felt.rough_start else []),
            *_ramp(felt.ramp_start, felt.ramp_end, felt.ramp_rise, (x, y)),
            plan.Spot(tee, 2.2 * it.ball.radius, COLOURS["chalk"], 0.006),
            plan.Spot((hole.x, hole.y), hole.radius, COLOURS["rim"], 0.008),
            plan.Spot((hole.x, hole.y), hole.radius - 0.006, COLOURS["hole"]),
            *(plan.Line(((wall.x1, wall.y1), (wall.x2, wall.y2)), 2 * BOARD, COLOURS["board"]) for wall in it.walls),
            *(plan.Spot((mill.x, mill.y), POST, COLOURS["post"]) for mill in it.mills),
        )


def _bed(it: Parameters, box: Box) -> plan.Stripes | Relief:
    """The felt: in stripes, or with contour lines if the lane is tilted."""
    along, across = PERCENT * it.felt.grade, PERCENT * it.felt.cross
    if along == across == 0.0:
        return plan.Stripes(box, COLOURS["felt"], 0.3)
    return Relief(box, box, along, across, 0.0, (COLOURS["low"], COLOURS["high"]), COLOURS["arrow"], COLOURS["chalk"])


def _garden(half: tuple[float, float]) -> plan.Plan:
    """A path of slabs around the lane, on a lawn with a hedge of bushes along either side."""
    x, y = (side + FRAME for side in half)
    paved = Box(-x - PAVED, -y - PAVED, x + PAVED, y + PAVED)
    bushes = [
        plan.Spot((along, side * (y + HEDGE + 0.06 * sin(2.3 * i + side))), 0.25 + 0.07 * sin(1.7 * i + side), colour)
        for side in (-1, 1)
        for i, along in enumerate(np.arange(-x - 1.0, x + 1.0, 0.36).tolist())
        for colour in [COLOURS["bush"][i % 2]]
    ]
    lit = [plan.Spot((cx - 0.3 * r, cy + 0.3 * r), 0.55 * r, COLOURS["leaves"])
           for (cx, cy), r in ((bush.centre, bush.radius) for bush in bushes)]  # fmt: skip
    return (
        plan.Stripes(table.around((60.0, 60.0)), COLOURS["lawn"], 0.5),
        plan.Stripes(paved, COLOURS["path"], 0.6),
        *bushes,
        *lit,
    )


def _ramp(start: float, end: float, rise: float, half: tuple[float, float]) -> plan.Plan:
    """A ramp across the lane: lighter the higher it is, with arrows that point up."""
    if end <= start or rise == 0.0:
        return ()
    low, high = COLOURS["low"], COLOURS["high"]
    edges = np.linspace(start, end, BANDS + 1).tolist()
    shades = [mix(low, high, (i + 0.5) / BANDS) for i in range(BANDS)][:: 1 if rise > 0.0 else -1]
    bands = [
        plan.Ground(Box(a, -half[1], b, half[1]), shade) for a, b, shade in zip(edges, edges[1:], shades, strict=False)
    ]
    way, size, middle = (1.0 if rise > 0.0 else -1.0), min(0.09, 0.15 * (end - start)), 0.5 * (start + end)
    arrows = [
        plan.Line(((at - way * size, y - size), (at, y), (at - way * size, y + size)), 0.022, COLOURS["arrow"])
        for at in (middle - 0.25 * (end - start), middle, middle + 0.25 * (end - start))
        for y in (-0.5 * half[1], 0.5 * half[1])
    ]
    return (*bands, *arrows)
