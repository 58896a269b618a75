"""Bowling from above: the whole lane, wider than it is, and the pins from near by."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import numpy as np

from sandbox.picture.palette import Colour, scene_colours
from sandbox.picture.places import Shape, plan
from sandbox.picture.views import Box, LongView, Look, Mark, near

from .scene import HEAD, KICKBACK, LANE, PIT, ROW, SPOTS, Parameters

COLOURS = scene_colours(__file__)
BOARD, ARROWS = 2 * LANE / 39, 4.6  # m: width of a board; where the arrows are
SWIRL = near(np.array([(0.6, 0.5, 0.62), (-0.7, -0.3, 0.65), (0.1, -0.8, -0.6), (-0.3, 0.6, -0.74)]), 0.5)
HOLES = near(np.array([(0.1, 0.24, 0.966), (-0.12, 0.22, 0.968), (0.0, -0.1, 0.995)]), 0.1)
BALL = Look(COLOURS["ball"], Mark(COLOURS["swirl"], SWIRL), Mark(COLOURS["holes"], HOLES, 7.0), gloss=0.9)
NECK = Mark(COLOURS["neck"], lambda at: (abs(np.hypot(at[..., 0], at[..., 1]) - 0.52) < 0.09).astype(float))
PIN = Look(COLOURS["pin"], NECK)


class Picture(LongView[Parameters]):
    TRACE, ROOM, EARLIER, WIDER = COLOURS["trace"], COLOURS["hall"], COLOURS["earlier"], 2.0
    SOFT, CAVEAT = 0.65, "what the pins do is not validated"
    whole = Box(-0.7, -KICKBACK - 0.05, HEAD + PIT + 0.25, KICKBACK + 0.05)
    near = Box(HEAD - 0.6, -LANE - 0.1, HEAD + PIT + 0.15, LANE + 0.1)
    datum = (HEAD, 0.0), "the head pin"

    @property
    def lines(self) -> dict[str, float]:
        return {"arrows": ARROWS, "oil ends": max([0.0, *(oil.end for oil in self.parameters.oil)]), "head pin": HEAD}

    @cached_property
    def plan(self) -> plan.Plan:
        """Kickbacks, gutters, boards, oil, foul line, arrows, the deck and its spots, the pit, the light."""
        end, dry = HEAD + PIT, self.parameters.dry or 1.0
        lane = Box(-0.7, -LANE, end, LANE)
        arrows = [(ARROWS - 0.12 * abs(i), -5 * i * BOARD) for i in range(-3, 4)]
        oils = sorted((oil.end, oil.friction) for oil in self.parameters.oil)
        ends = [0.0, *(end for end, _ in oils)]
        oiled = [((a, -LANE), (b, -LANE), (b, LANE), (a, LANE)) for a, b in pairwise(ends)]
        slick = [max(0.0, 0.42 * (1.0 - friction / dry)) for _, friction in oils]
        return (
            plan.Ground(Box(-0.7, -KICKBACK - 0.1, end + 1.0, KICKBACK + 0.1), COLOURS["kickback"]),
            plan.Ground(Box(-0.7, -KICKBACK, end, KICKBACK), COLOURS["gutter"]),
            plan.Stripes(lane, COLOURS["lane"], BOARD, -LANE, along=True),
            plan.Stripes(lane._replace(left=HEAD - 0.3), COLOURS["deck"], BOARD, -LANE, along=True),
            *(Shape(part, COLOURS["oil"], dim) for part, dim in zip(oiled, slick, strict=True)),
            *(plan.Worn((x, 0.2 * LANE), 1.6, 0.5 * LANE, COLOURS["lamp"], 0.3) for x in (1.5, 5.5, 9.5, 13.5)),
            plan.Worn((HEAD + ROW, 0.0), 0.7, 0.45, COLOURS["lamp"], 0.35),
            plan.Ground(Box(end, -KICKBACK, end + 1.0, KICKBACK), COLOURS["pit"]),
            plan.Line(((0.0, -LANE), (0.0, LANE)), 0.03, COLOURS["mark"]),
            *(Shape(((x, y - 0.02), (x + 0.15, y), (x, y + 0.02)), COLOURS["mark"]) for x, y in arrows),
            *(plan.Spot(spot, 0.028, COLOURS["spot"]) for spot in SPOTS.values()),
        )

    def look_of(self, name: str) -> Look:
        return BALL if name == "ball" else PIN

    def colour_of(self, name: str) -> Colour:
        return self.TRACE if name == "ball" else COLOURS["way"]
